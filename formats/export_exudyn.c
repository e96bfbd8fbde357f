/*
 * A body for Exudyn: the HDF5 file that its ObjectFFRFreducedOrderInterface
 * loads [Gerstmayr2023], as release 1.13.6 saves it. Nodes carry translations
 * only, along basic axes, and come in the order of grid ids.
 */
#include "base/alloc.h"
#include "formats/certificate.h"
#include "formats/exudyn.h"
#include "formats/floating_report.h"
#include "formats/sink.h"

#include <string.h>

/* ---- constant matrices -------------------------------------------------- */

/*
 * Exudyn's constant matrices from inertia invariants. With skew(v) w = v x w,
 * x a node's place, psi_k its motion in mode k, and sums over all pairs of
 * nodes with their mass m, block k of columns (or of rows) is
 *
 *     mPsiTildePsi        skew(psi_k)' m psi_l   =  psi_l x psi_k
 *     mPsiTildePsiTilde   skew(psi_k)' m skew(psi_l)
 *                                     =  (psi_k . psi_l) I - psi_l psi_k'
 *     mXRefTildePsi       skew(x)' m psi_l       =  -(x x psi_l)
 *     mXRefTildePsiTilde  skew(x)' m skew(psi_l) =  (x . psi_l) I - psi_l x'
 *     mPhitTPsi           m psi_l
 *     mPhitTPsiTilde      m skew(psi_l)
 *
 * [ZwolferGerstmayr2021]. The terms that do not change with deformation are
 * computed from all of M: mass, inertia, and the momenta R'M Psi. The equations
 * of motion conserve momentum only if the other terms agree with these. So
 * m skew(psi_l) is set to the skew matrix of the linear momentum S_l, and the
 * antisymmetric part of (x . psi) I - psi x' to that of the angular momentum
 * C_l. If the invariants are exact, this changes nothing.
 */

/* The permutation symbol e_abc. */
static double permutation(int a, int b, int c)
{
    return (a - b) * (b - c) * (c - a) / 2.0;
}

/* skew(v)_ab = -e_abc v_c, put at column `col`. */
static void put_skew(const double *v, int64_t col, ritz_dense *out)
{
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            double sum = 0.0;

            for (int c = 0; c < 3; c++)
                sum -= permutation(a, b, c) * v[c];
            ritz_dense_col(out, col + b)[a] = sum;
        }
}

static void put_rigid(const ritz_invariants *of, const ritz_inertia *inertia,
                      exudyn_terms *t)
{
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            ritz_dense_col(&t->Mtt, b)[a] = of->rigid[a + 6 * b];
            ritz_dense_col(&t->inertiaLocal, b)[a] =
                of->rigid[a + 3 + 6 * (b + 3)];
        }
    put_skew(inertia->centre, 0, &t->chiUtilde);
}

static void put_momenta(const ritz_invariants *of, exudyn_terms *t)
{
    for (int64_t l = 0; l < of->momentum.ncol; l++) {
        const double *momentum = ritz_dense_col(&of->momentum, l);

        for (int a = 0; a < 3; a++) {
            ritz_dense_col(&t->mPhitTPsi, l)[a] = momentum[a];
            ritz_dense_col(&t->mXRefTildePsi, l)[a] = -momentum[3 + a];
        }
        put_skew(momentum, 3 * l, &t->mPhitTPsiTilde);
    }
}

/* (x . psi_l) I - sym(psi_l x') - skew(C_l) / 2 */
static void put_first_order(const ritz_invariants *of, exudyn_terms *t)
{
    int64_t m = of->momentum.ncol;

    for (int64_t l = 0; l < m; l++) {
        double *C = ritz_dense_col(&of->momentum, l) + 3;
        double trace = 0.0;

        put_skew(C, 3 * l, &t->mXRefTildePsiTilde);
        for (int a = 0; a < 3; a++)
            trace += ritz_dense_col(&of->position, a * m + l)[a];
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++) {
                double *at =
                    &ritz_dense_col(&t->mXRefTildePsiTilde, 3 * l + b)[a];
                double x_psi = ritz_dense_col(&of->position, b * m + l)[a] +
                               ritz_dense_col(&of->position, a * m + l)[b];

                *at = (a == b ? trace : 0.0) - (x_psi + *at) / 2.0;
            }
    }
}

/* mPsiTildePsi and mPsiTildePsiTilde of one pair of modes. */
static void put_pair(const ritz_dense *product, int64_t m, int64_t k, int64_t l,
                     exudyn_terms *t)
{
    double P[3][3]; /* psi_k, axis a, times psi_l, axis b */

    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            P[a][b] = ritz_dense_col(product, b * m + l)[a * m + k];
    for (int b = 0; b < 3; b++) {
        int c = (b + 1) % 3;
        int d = (b + 2) % 3;

        ritz_dense_col(&t->mPsiTildePsi, l)[3 * k + b] = P[d][c] - P[c][d];
        for (int f = 0; f < 3; f++)
            ritz_dense_col(&t->mPsiTildePsiTilde, 3 * l + f)[3 * k + b] =
                (b == f ? P[0][0] + P[1][1] + P[2][2] : 0.0) - P[f][b];
    }
}

ritz_status exudyn_terms_of(const ritz_invariants *invariants,
                            const ritz_inertia *inertia, exudyn_terms *out)
{
    int64_t m = invariants->momentum.ncol;
    RITZ_OWN(exudyn_terms) t = {0};

    RITZ_CHECK(ritz_dense_new(3, 3, &t.inertiaLocal));
    RITZ_CHECK(ritz_dense_new(3, 3, &t.Mtt));
    RITZ_CHECK(ritz_dense_new(3, 3, &t.chiUtilde));
    RITZ_CHECK(ritz_dense_new(3 * m, m, &t.mPsiTildePsi));
    RITZ_CHECK(ritz_dense_new(3 * m, 3 * m, &t.mPsiTildePsiTilde));
    RITZ_CHECK(ritz_dense_new(3, m, &t.mPhitTPsi));
    RITZ_CHECK(ritz_dense_new(3, 3 * m, &t.mPhitTPsiTilde));
    RITZ_CHECK(ritz_dense_new(3, m, &t.mXRefTildePsi));
    RITZ_CHECK(ritz_dense_new(3, 3 * m, &t.mXRefTildePsiTilde));
    put_rigid(invariants, inertia, &t);
    put_momenta(invariants, &t);
    put_first_order(invariants, &t);
    for (int64_t l = 0; l < m; l++)
        for (int64_t k = 0; k < m; k++)
            put_pair(&invariants->product, m, k, l, &t);
    RITZ_MOVE(*out, t);
    return RITZ_OK;
}

void exudyn_terms_free(exudyn_terms *terms)
{
    ritz_dense_free(&terms->inertiaLocal);
    ritz_dense_free(&terms->Mtt);
    ritz_dense_free(&terms->chiUtilde);
    ritz_dense_free(&terms->mPsiTildePsi);
    ritz_dense_free(&terms->mPsiTildePsiTilde);
    ritz_dense_free(&terms->mPhitTPsi);
    ritz_dense_free(&terms->mPhitTPsiTilde);
    ritz_dense_free(&terms->mXRefTildePsi);
    ritz_dense_free(&terms->mXRefTildePsiTilde);
    *terms = (exudyn_terms){0};
}

/* ---- the body ----------------------------------------------------------- */

void exudyn_body_free(exudyn_body *b)
{
    ritz_floating_free(&b->floating);
    exudyn_terms_free(&b->terms);
    *b = (exudyn_body){0};
}

ritz_status exudyn_body_of(const ritz_reduced *reduced,
                           const ritz_floating_request *request,
                           exudyn_body *out)
{
    RITZ_OWN(exudyn_body) b = {0};

    RITZ_CHECK(ritz_floating_of(reduced, request, &b.floating));
    RITZ_CHECK(
        exudyn_terms_of(&b.floating.invariants, &b.floating.inertia, &b.terms));
    RITZ_MOVE(*out, b);
    return RITZ_OK;
}

ritz_status exudyn_body_say(const exudyn_body *b, ritz_export_report *report)
{
    const ritz_floating *f = &b->floating;
    int64_t turning = 0;

    RITZ_CHECK(ritz_floating_say(f, report));
    for (int64_t k = 0; k < f->count; k++)
        turning += f->rotates[k];
    if (turning > 0)
        RITZ_CHECK(ritz_export_say(
            report,
            "rotations of %lld grids left out: they count in all terms of "
            "inertia and stiffness, not in shapes",
            (long long)turning));
    if (f->D.val || f->structural)
        RITZ_CHECK(ritz_export_say(report, "damping left out: the file has no "
                                           "place for it"));
    return ritz_export_say(report, "inputs, outputs and ports are left out; "
                                   "numbers keep every bit");
}

/* ---- its file ----------------------------------------------------------- */

/* Exudyn compares `datatype` with str: only text of variable length is one. */
static hid_t text_type(void)
{
    hid_t type = ritz_h5_string(1);

    if (H5Tset_size(type, H5T_VARIABLE) >= 0)
        return type;
    ritz_h5_close(type);
    return -1;
}

static ritz_status label_object(hid_t at, const char *datatype)
{
    RITZ_OWN(hid_t) type = text_type();

    return ritz_h5_set(at, "datatype", type, ritz_h5_scalar(), &datatype);
}

static ritz_status label_set(hid_t file, const char *name, const char *datatype)
{
    RITZ_OWN(hid_t) set = H5Dopen2(file, name, H5P_DEFAULT);

    RITZ_REFUSE_IF(set < 0, RITZ_ERR_FILE, "cannot open '%s'", name);
    return label_object(set, datatype);
}

static ritz_status write_text(hid_t file, const char *name, const char *text)
{
    RITZ_OWN(hid_t) type = text_type();

    RITZ_CHECK(ritz_h5_write(file, name, type, ritz_h5_scalar(), &text));
    return label_set(file, name, "str");
}

/* Values that are no matrix, then matrices. */
static ritz_status write_arrays(hid_t file, const exudyn_body *b)
{
    const exudyn_terms *t = &b->terms;
    const ritz_floating *f = &b->floating;
    const int64_t m = f->V.ncol;
    const int64_t version = 1;
    const int64_t info[6] = {m, f->count, 3, 4, 7, 7 + m};
    const struct {
        const char *name, *datatype;
        hid_t type;
        ritz_h5_shape shape;
        const void *values;
    } list[] = {
        {"fileVersion", "int", H5T_STD_I64LE, ritz_h5_scalar(), &version},
        {"infoList", "ndarray", H5T_STD_I64LE, ritz_h5_vector(6), info},
        {"xRef", "ndarray", H5T_IEEE_F64LE, ritz_h5_vector(3 * f->count),
         f->position},
        {"totalMass", "float64", H5T_IEEE_F64LE, ritz_h5_scalar(),
         &f->inertia.mass},
        {"chiU", "ndarray", H5T_IEEE_F64LE, ritz_h5_vector(3),
         f->inertia.centre},
        {"trigList", "ndarray", H5T_IEEE_F64LE, ritz_h5_vector(0), f->position},
    };
    const struct {
        const char *name;
        const ritz_dense *A;
    } matrix[] = {
        {"modeBasis", &f->shape},
        {"massMatrixReduced", &f->M},
        {"stiffnessMatrixReduced", &f->K},
        {"inertiaLocal", &t->inertiaLocal},
        {"Mtt", &t->Mtt},
        {"chiUtilde", &t->chiUtilde},
        {"mPsiTildePsi", &t->mPsiTildePsi},
        {"mPsiTildePsiTilde", &t->mPsiTildePsiTilde},
        {"mPhitTPsi", &t->mPhitTPsi},
        {"mPhitTPsiTilde", &t->mPhitTPsiTilde},
        {"mXRefTildePsi", &t->mXRefTildePsi},
        {"mXRefTildePsiTilde", &t->mXRefTildePsiTilde},
    };

    for (size_t k = 0; k < sizeof list / sizeof *list; k++) {
        RITZ_CHECK(ritz_h5_write(file, list[k].name, list[k].type,
                                 list[k].shape, list[k].values));
        RITZ_CHECK(label_set(file, list[k].name, list[k].datatype));
    }
    for (size_t k = 0; k < sizeof matrix / sizeof *matrix; k++) {
        RITZ_CHECK(ritz_h5_write_dense(file, matrix[k].name, matrix[k].A));
        RITZ_CHECK(label_set(file, matrix[k].name, "ndarray"));
    }
    return RITZ_OK;
}

/* What the file is made of. */
typedef struct exudyn_parts {
    const exudyn_body *body;
    const char *certificate;
} exudyn_parts;

static ritz_status write_file(hid_t file, const void *what)
{
    const exudyn_parts *parts = what;
    const exudyn_body *body = parts->body;
    RITZ_OWN(hid_t) group = 0;

    RITZ_CHECK(write_arrays(file, body));
    RITZ_CHECK(write_text(file, "type", "ObjectFFRFreducedOrderInterface"));
    RITZ_CHECK(write_text(file, "rigidBodyNodeType",
                          "NodeType.RotationEulerParameters"));
    RITZ_CHECK(ritz_h5_group(file, "postProcessingModes", &group));
    RITZ_CHECK(label_object(group, "dict"));
    return ritz_h5_set_text(file, "certificate", parts->certificate);
}

/* Cut a text after the last line that fits into an attribute of HDF5. */
static void cut_lines(char *text)
{
    enum { ROOM = 32768 };

    if (strlen(text) >= ROOM) {
        text[ROOM] = '\0';
        strrchr(text, '\n')[1] = '\0';
    }
}

static ritz_status write_body(const ritz_export_object *object,
                              const ritz_export_request *request,
                              ritz_export_report *report)
{
    RITZ_OWN(exudyn_body) b = {0};
    RITZ_OWN(ritz_draft) draft = {0};
    RITZ_OWN_ARRAY char *certificate = NULL;
    exudyn_parts parts = {&b, NULL};
    const ritz_floating_request asked = ritz_floating_asked(request);

    RITZ_CHECK(exudyn_body_of(object->reduced, &asked, &b));
    RITZ_CHECK(exudyn_body_say(&b, report));
    RITZ_CHECK(ritz_certificate(object, request->stamp, &certificate));
    cut_lines(certificate);
    parts.certificate = certificate;
    RITZ_CHECK_IN(request->output, ritz_draft_new(request->output, &draft));
    RITZ_CHECK(ritz_sink_fill_h5(&draft, write_file, &parts));
    return ritz_draft_publish(&draft);
}

const ritz_exporter ritz_exporter_exudyn = {
    .name = "exudyn",
    .summary = "a flexible body for Exudyn (FFRF, reduced order), HDF5",
    .reference = "Gerstmayr2023",
    .kind = "reduced",
    .takes = RITZ_EXPORT_REDUCED | RITZ_EXPORT_FRAME,
    .write = write_body,
};
