/*
 * A flexible body input file of Radioss [Altair2021], in the order and the
 * fields in which OpenRadioss reads it [OpenRadioss2026, hm_read_fxb.F]. The
 * displacement of a node at X in the frame is, along global axes,
 *
 *     u = sum_i X_i a_i + (1 - X_1 - X_2 - X_3) a_0 + P Phi alpha
 *
 * where a_i is the displacement of the point at distance one on axis i and a_0
 * that of the origin. P is the matrix with which the a_i turn the axes; six
 * constraints make it a rotation. With X_0 = 1 - X_1 - X_2 - X_3, the mass
 * matrices of these global modes and their couplings to the local modes are
 *
 *     M_R   (i j, i' j)  int X_i X_i'
 *     M_C^kl  (i k, alpha)  int X_i Phi_l
 *
 * The integrals Q = int X X' follow from the inertia J about the origin, Q =
 * tr(J) I / 2 - J, and so contain the rotary inertia of nodes. The three global
 * modes that rotate nodes with the frame (Irot) therefore have no mass; a
 * constraint ties them to P.
 *
 * K_C^kl, the forces of deformation on a_0 ... a_3, is written as zero: since
 * K R = 0, these forces do no work in motions that the constraints admit, and
 * the multipliers of the constraints balance them.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "formats/certificate.h"
#include "formats/large_field.h"
#include "formats/normal_body.h"
#include "formats/sink.h"
#include "model/inertia_terms.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

enum {
    POINTS = 4,          /* one on each axis, and the origin */
    GLOBAL = 3 * POINTS, /* global modes without those of Irot */
    NUMBERS_PER_LINE = 5,
    NODES_PER_LINE = 10,
    NODE_MOST = 99999999, /* eight columns */
    COMMENT_WIDTH = 96
};

typedef struct fxbody {
    const ritz_reduced *reduced;
    ritz_normal_body normal;
    bool held;                /* the body has no rigid motion (Iblo 1) */
    bool turns;               /* some nodes have rotations (Irot 1) */
    double alpha, beta;       /* D = alpha M + beta K */
    double Q[POINTS][POINTS]; /* int X_i X_i', the origin last */
    ritz_dense C; /* 4 x 3m; entry (i, 3 k + l) is int X_i Phi_l of mode k */
    char *certificate;
} fxbody;

static void fxbody_free(fxbody *b)
{
    ritz_normal_body_free(&b->normal);
    ritz_dense_free(&b->C);
    free(b->certificate);
}

/* ---- inertia ------------------------------------------------------------ */

/* Products Q of X_1, X_2, X_3 and, in the last row and column, X_0. */
static void find_products(const ritz_sid_terms *t, fxbody *b)
{
    static const int of_J[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
    const double *J = t->J.m0.val, *s = t->mdCM.m0.val;
    const double half = (J[0] + J[1] + J[2]) / 2.0;
    double all = 0.0;

    b->Q[3][3] = t->mass;
    for (int i = 0; i < 3; i++) {
        double row = 0.0;

        for (int j = 0; j < 3; j++) {
            b->Q[i][j] = (i == j ? half : 0.0) - J[of_J[i][j]];
            row += b->Q[i][j];
        }
        b->Q[i][3] = b->Q[3][i] = s[i] - row;
        b->Q[3][3] -= 2.0 * s[i];
        all += row;
    }
    b->Q[3][3] += all;
}

/* With the tensor N = int (x.u) I - u x' of a mode u,
   int u_l x_i = tr(N) / 2 delta_li - N_li. */
static ritz_status find_couplings(const ritz_sid_terms *t, fxbody *b)
{
    const int64_t m = b->normal.num_modes;

    RITZ_CHECK(ritz_dense_new(POINTS, 3 * m, &b->C));
    for (int64_t k = 0; k < m; k++) {
        double N[3][3], trace = 0.0;

        for (int64_t l = 0; l < 3; l++)
            for (int64_t i = 0; i < 3; i++)
                N[l][i] = ritz_dense_col(&t->Gr.m0, 3 * k + i)[l] / 2.0;
        trace = N[0][0] + N[1][1] + N[2][2];
        for (int64_t l = 0; l < 3; l++) {
            double *C = ritz_dense_col(&b->C, 3 * k + l);

            C[3] = ritz_dense_col(&t->Ct.m0, l)[k];
            for (int64_t i = 0; i < 3; i++) {
                C[i] = (l == i ? trace / 2.0 : 0.0) - N[l][i];
                C[3] -= C[i];
            }
        }
    }
    return RITZ_OK;
}

static ritz_status find_inertia(fxbody *b)
{
    static const double here[3] = {0.0, 0.0, 0.0};
    RITZ_OWN(ritz_dense) unit = {0};
    RITZ_OWN(ritz_sid_terms) terms = {0};

    RITZ_CHECK(ritz_dense_identity(b->normal.num_modes, &unit));
    RITZ_CHECK(ritz_sid_terms_of(&b->normal.invariants, &unit, here, &terms));
    find_products(&terms, b);
    return find_couplings(&terms, b);
}

/* ---- damping ------------------------------------------------------------ */

/* Fit D_kk = alpha + beta w_k^2 by least squares. */
static void fit_rayleigh(fxbody *b)
{
    const ritz_normal_body *n = &b->normal;
    const double m = (double)n->num_modes;
    double mean_K = 0.0, mean_D = 0.0, KK = 0.0, KD = 0.0;

    for (int64_t k = 0; k < n->num_modes; k++) {
        mean_K += n->K[k] / m;
        mean_D += ritz_dense_col(&n->D, k)[k] / m;
    }
    for (int64_t k = 0; k < n->num_modes; k++) {
        const double rest = n->K[k] - mean_K;

        KK += rest * rest;
        KD += rest * (ritz_dense_col(&n->D, k)[k] - mean_D);
    }
    b->beta = KK > 0.0 ? KD / KK : 0.0;
    b->alpha = mean_D - b->beta * mean_K;
}

/* Whether D is alpha M + beta K. If not, alpha and beta are set to 0. */
static bool is_rayleigh(fxbody *b)
{
    const ritz_dense *D = &b->normal.D;
    double worst = 0.0;

    fit_rayleigh(b);
    for (int64_t j = 0; j < D->ncol; j++)
        for (int64_t i = 0; i < D->nrow; i++) {
            const double fitted =
                i == j ? b->alpha + b->beta * b->normal.K[j] : 0.0;

            worst = fmax(worst, fabs(ritz_dense_col(D, j)[i] - fitted));
        }
    /* squares of large numbers are not finite, and fmax ignores NaN */
    if (isfinite(b->alpha) && isfinite(b->beta) &&
        worst <= RITZ_SAME * ritz_dense_max(D))
        return true;
    b->alpha = b->beta = 0.0;
    return false;
}

/* ---- the body ----------------------------------------------------------- */

static ritz_status find_body(const ritz_reduced *reduced,
                             const ritz_export_request *request, fxbody *b)
{
    const ritz_floating_request wanted = {
        request->frame ? request->frame : "centre", request->reference};
    const ritz_floating *f = &b->normal.floating;

    b->reduced = reduced;
    RITZ_CHECK(ritz_normal_body_of(reduced, &wanted, &b->normal));
    RITZ_REFUSE_IF(f->num_rigid != 0 && f->num_rigid != 6, RITZ_ERR_ARGUMENT,
                   "Radioss takes a body that moves freely or not at all, and "
                   "of this %" PRId64 " of six rigid motions are free",
                   f->num_rigid);
    RITZ_REFUSE_IF(f->id[f->count - 1] > NODE_MOST, RITZ_ERR_ARGUMENT,
                   "Radioss holds eight digits of a node's number, and grid "
                   "%" PRId64 " has more",
                   f->id[f->count - 1]);
    b->held = f->num_rigid == 0;
    for (int64_t i = 0; i < f->count; i++)
        b->turns = b->turns || f->rotates[i];
    return find_inertia(b);
}

/* ---- its file ----------------------------------------------------------- */

/* A list of numbers of 16 columns, five in each line. */
typedef struct fx_row {
    FILE *file;
    int count;
} fx_row;

static void put_number(fx_row *row, double x)
{
    char text[RITZ_LARGE_FIELD_SIZE];

    ritz_large_field_print(x, text);
    fprintf(row->file, "%16s", text);
    if (++row->count == NUMBERS_PER_LINE) {
        fputc('\n', row->file);
        row->count = 0;
    }
}

static void end_row(fx_row *row)
{
    if (row->count > 0)
        fputc('\n', row->file);
    row->count = 0;
}

static void put_numbers(FILE *file, const char *title, int64_t count,
                        const double *x)
{
    fx_row row = {file, 0};

    fprintf(file, "# %s\n", title);
    for (int64_t k = 0; k < count; k++)
        put_number(&row, x ? x[k] : 1.0);
    end_row(&row);
}

static void put_head(FILE *file, const fxbody *b)
{
    const ritz_floating *f = &b->normal.floating;
    const bool damped = b->alpha != 0.0 || b->beta != 0.0;

    fprintf(file,
            "#  Nbmod  Nbstat   Nbnod    Irot   Idamp    Iblo   Ifile\n"
            "%8" PRId64 "%8d%8" PRId64 "%8d%8d%8d%8d\n# Nodes\n",
            b->normal.num_modes, 0, f->count, (int)b->turns, (int)damped,
            (int)b->held, 0);
    for (int64_t i = 0; i < f->count; i++)
        fprintf(file, "%8" PRId64 "%s", f->id[i],
                (i + 1) % NODES_PER_LINE == 0 || i + 1 == f->count ? "\n" : "");
    put_numbers(file, "Rotation matrix by rows, highest frequency", 10,
                (const double[]){1, 0, 0, 0, 1, 0, 0, 0, 1,
                                 b->normal.hertz[b->normal.num_modes - 1]});
    if (damped)
        put_numbers(file, "Rayleigh damping, alpha and beta", 2,
                    (const double[]){b->alpha, b->beta});
}

/* Translations and rotations of a node. */
static void put_motion(FILE *file, const double *u, const double *turn)
{
    fx_row row = {file, 0};

    for (int a = 0; a < 6; a++)
        put_number(&row, a < 3 ? u[a] : turn ? turn[a - 3] : 0.0);
    end_row(&row);
}

/* The global modes X_i e_j and, with Irot, unit rotations of nodes. */
static void put_global_modes(FILE *file, const fxbody *b)
{
    const ritz_floating *f = &b->normal.floating;

    for (int k = 0; k < GLOBAL + (b->turns ? 3 : 0); k++) {
        fprintf(file, "# Global mode %d\n", k + 1);
        for (int64_t n = 0; n < f->count; n++) {
            const double *X = f->position + 3 * n;
            double u[3] = {0}, turn[3] = {0};

            if (k < 9)
                u[k % 3] = X[k / 3];
            else if (k < GLOBAL)
                u[k % 3] = 1.0 - X[0] - X[1] - X[2];
            else if (f->rotates[n])
                turn[k % 3] = 1.0;
            put_motion(file, u, turn);
        }
    }
}

static void put_local_modes(FILE *file, const ritz_normal_body *n)
{
    for (int64_t k = 0; k < n->num_modes; k++) {
        const double *turn = n->turn.val ? ritz_dense_col(&n->turn, k) : NULL;

        fprintf(file, "# Local mode %" PRId64 "\n", k + 1);
        for (int64_t i = 0; i < n->floating.count; i++)
            put_motion(file, ritz_dense_col(&n->shape, k) + 3 * i,
                       turn ? turn + 3 * i : NULL);
    }
}

/* The upper triangle of M_R by rows. The modes of Irot have no mass. */
static void put_global_mass(FILE *file, const fxbody *b)
{
    const int count = GLOBAL + (b->turns ? 3 : 0);
    fx_row row = {file, 0};

    fputs("# Mass of global modes\n", file);
    for (int p = 0; p < count; p++)
        for (int q = p; q < count; q++)
            put_number(&row,
                       q < GLOBAL && p % 3 == q % 3 ? b->Q[p / 3][q / 3] : 0.0);
    end_row(&row);
}

/* M_C^kl, or zeros if `mass` is false, for the nine elements kl of P by
   rows. */
static void put_coupling(FILE *file, const char *title, const fxbody *b,
                         bool mass)
{
    const int count = GLOBAL + (b->turns ? 3 : 0);

    for (int k = 0; k < 3; k++)
        for (int l = 0; l < 3; l++) {
            fx_row row = {file, 0};

            fprintf(file, "# %s %d%d\n", title, k + 1, l + 1);
            for (int p = 0; p < count; p++)
                for (int64_t mode = 0; mode < b->normal.num_modes; mode++) {
                    const double *C = ritz_dense_col(&b->C, 3 * mode + l);

                    put_number(&row, mass && p < GLOBAL && p % 3 == k ? C[p / 3]
                                                                      : 0.0);
                }
            end_row(&row);
        }
}

static ritz_status print_file(FILE *file, const void *what)
{
    const fxbody *b = what;
    const ritz_normal_body *n = &b->normal;
    const double *o = n->floating.origin;

    ritz_comment_put(file, "# ", COMMENT_WIDTH, b->certificate);
    fprintf(file, "# frame at %.17g %.17g %.17g, along global axes\n", o[0],
            o[1], o[2]);
    put_head(file, b);
    if (!b->held)
        put_global_modes(file, b);
    put_local_modes(file, n);
    put_numbers(file, "Mass of local modes", n->num_modes, NULL);
    put_numbers(file, "Stiffness of local modes", n->num_modes, n->K);
    if (b->held)
        return RITZ_OK;
    put_global_mass(file, b);
    put_coupling(file, "Coupling of mass", b, true);
    put_coupling(file, "Coupling of stiffness", b, false);
    return RITZ_OK;
}

/* ---- exporter ----------------------------------------------------------- */

static ritz_status say_losses(const fxbody *b, bool fits,
                              ritz_export_report *report)
{
    const double *o = b->normal.floating.origin;

    RITZ_CHECK(ritz_export_say(
        report, "numbers have 13 to 15 digits, as 16 columns allow"));
    if (b->held)
        RITZ_CHECK(ritz_export_say(report, "the body is held (Iblo 1)"));
    else
        RITZ_CHECK(ritz_export_say(
            report,
            "the main node of /FXBODY is to be at (%.9g, %.9g, %.9g); the "
            "couplings of stiffness are zero, as constraints of the frame "
            "take these forces",
            o[0], o[1], o[2]));
    if (!fits)
        RITZ_CHECK(ritz_export_say(
            report, "warning: damping is not alpha M + beta K, which is all "
                    "that the file holds: it is left out"));
    else if (b->alpha != 0.0 || b->beta != 0.0)
        RITZ_CHECK(ritz_export_say(report,
                                   "Rayleigh damping, alpha %.9g, beta %.9g",
                                   b->alpha, b->beta));
    return ritz_export_say(report, "inputs, outputs and ports are left out");
}

static ritz_status write_fxbody(const ritz_export_object *object,
                                const ritz_export_request *request,
                                ritz_export_report *report)
{
    RITZ_OWN(fxbody) b = {0};
    bool fits = true;

    RITZ_CHECK(find_body(object->reduced, request, &b));
    if (b.normal.D.val)
        fits = is_rayleigh(&b);
    RITZ_CHECK(ritz_certificate(object, request->stamp, &b.certificate));
    RITZ_CHECK(ritz_sink_write(request->output, print_file, &b));
    RITZ_CHECK(ritz_normal_body_say(b.reduced, &b.normal, report));
    return say_losses(&b, fits, report);
}

const ritz_exporter ritz_exporter_fxbody = {
    .name = "fxbody",
    .summary = "a flexible body for Radioss (/FXBODY)",
    .reference = "Altair2021",
    .kind = "reduced",
    .takes = RITZ_EXPORT_REDUCED | RITZ_EXPORT_FRAME,
    .write = write_fxbody,
};
