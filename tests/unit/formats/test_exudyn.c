/*
 * Bodies for Exudyn: terms of two point masses by their definition, what is
 * left to the frame, what is refused. tests/interop/with_exudyn.py holds whole
 * files to Exudyn's own.
 */
#include "testing.h"

#include "container/h5.h"
#include "formats/exudyn.h"

#include <ritz/container.h>

#include <float.h>
#include <stdio.h>
#include <unistd.h>

enum { MODES = 3, PATH_SIZE = 64 };

static const ritz_floating_request basic = {0};
static const double masses[2] = {2.0, 3.0};
static const double places[6] = {1.0, -2.0, 0.5, 4.0, -2.0, 0.5};
/* rows 0.8 -0.6 0, 0.6 0.8 0, 0 0 1: exact to rounding */
static const double axes[18] = {1.0, 0.0,  0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0,
                                0.8, -0.6, 0.0, 0.6, 0.8, 0.0, 0.0, 0.0, 1.0};

/* Motion of node i along basic axis a in mode k; all numbers are distinct. */
static double shape(int64_t k, int64_t i, int64_t a)
{
    return (double)(1 + 5 * k * k - 7 * i + (3 + k) * a * a) / 8.0;
}

static ritz_status make_grids(bool turned, ritz_grids *out)
{
    const int64_t id[] = {11, 12};
    const int64_t frame[] = {0, turned};

    out->count = 2;
    out->num_frames = 2;
    RITZ_CHECK_COPY(out->id, id, 2);
    RITZ_CHECK_COPY(out->position, places, 6);
    RITZ_CHECK_COPY(out->frame, frame, 2);
    RITZ_CHECK_COPY(out->axes, axes, 18);
    return RITZ_OK;
}

/* Two masses; `k` joins them along x, the line on which they lie: K = k b b'
 * with b the stretch of a unit motion along each displacement axis. */
static ritz_status make_pair(bool turned, double k, ritz_component *out)
{
    const double *last = axes + (turned ? 9 : 0);
    const double b[6] = {1.0, 0.0, 0.0, -last[0], -last[3], -last[6]};
    int64_t row[36], col[36];
    double val[36], m[6];

    out->num_dofs = 6;
    RITZ_CHECK_NEW(out->dof, 6);
    for (int i = 0; i < 36; i++) {
        row[i] = i % 6;
        col[i] = i / 6;
        val[i] = k * b[i % 6] * b[i / 6];
    }
    RITZ_CHECK(ritz_sparse_from_triplets(6, 6, 36, row, col, val, &out->K));
    for (int i = 0; i < 6; i++) {
        out->dof[i] = (ritz_dof){11 + i / 3, 1 + i % 3};
        m[i] = masses[i / 3];
    }
    RITZ_CHECK(ritz_sparse_from_triplets(6, 6, 6, row, row, m, &out->M));
    RITZ_CHECK(make_grids(turned, &out->grids));
    return ritz_component_settle(out, false);
}

/* The modes of shape() along the displacement axes of the grids. */
static void make_shapes(const ritz_component *pair, ritz_dense *T)
{
    assert_ok(ritz_dense_new(6, MODES, T));
    for (int64_t k = 0; k < MODES; k++)
        for (int64_t row = 0; row < 6; row++) {
            int64_t i = row / 3;
            const double *axis =
                axes + 9 * pair->grids.frame[i] + 3 * (row % 3);

            for (int a = 0; a < 3; a++)
                ritz_dense_col(T, k)[row] += axis[a] * shape(k, i, a);
        }
}

/* skew(v)_ab, written out. */
static double skew(const double v[3], int a, int b)
{
    const double S[3][3] = {
        {0.0, -v[2], v[1]}, {v[2], 0.0, -v[0]}, {-v[1], v[0], 0.0}};

    return S[a][b];
}

/* Fields of a node: 0-2 translation, 3-5 skew(x), then psi, then skew(psi). */
static double field(int column, int64_t i, int a)
{
    double psi[3];

    if (column < 3)
        return column == a ? 1.0 : 0.0;
    if (column < 6)
        return skew(places + 3 * i, a, column - 3);
    if (column < 6 + MODES)
        return shape(column - 6, i, a);
    column -= 6 + MODES;
    for (int b = 0; b < 3; b++)
        psi[b] = shape(column / 3, i, b);
    return skew(psi, a, column % 3);
}

/* Sum over nodes and axes of field p, mass and field q. */
static double product(int p, int q)
{
    double sum = 0.0;

    for (int64_t i = 0; i < 2; i++)
        for (int a = 0; a < 3; a++)
            sum += masses[i] * field(p, i, a) * field(q, i, a);
    return sum;
}

static void assert_products(const ritz_dense *A, int p, int q)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < A->nrow; i++)
            /* a dozen terms below 1000, each of a few roundings */
            assert_near(ritz_dense_col(A, j)[i],
                        product(p + (int)i, q + (int)j), 1e5 * DBL_EPSILON);
}

static void check_terms(bool turned)
{
    enum { MOVE = 0, SPIN = 3, PSI = 6, TILDE = 6 + MODES };
    RITZ_OWN(ritz_component) pair = {0};
    RITZ_OWN(ritz_dense) T = {0};
    ritz_inertia inertia = {0};
    RITZ_OWN(ritz_invariants) invariants = {0};
    RITZ_OWN(exudyn_terms) t = {0};

    assert_ok(make_pair(turned, 1.0, &pair));
    make_shapes(&pair, &T);
    assert_ok(ritz_inertia_of(&pair, &inertia));
    assert_ok(ritz_invariants_of(&pair, &T, &invariants));
    assert_ok(exudyn_terms_of(&invariants, &inertia, &t));
    assert_products(&t.Mtt, MOVE, MOVE);
    assert_products(&t.inertiaLocal, SPIN, SPIN);
    assert_products(&t.mPsiTildePsi, TILDE, PSI);
    assert_products(&t.mPsiTildePsiTilde, TILDE, TILDE);
    assert_products(&t.mPhitTPsi, MOVE, PSI);
    assert_products(&t.mPhitTPsiTilde, MOVE, TILDE);
    assert_products(&t.mXRefTildePsi, SPIN, PSI);
    assert_products(&t.mXRefTildePsiTilde, SPIN, TILDE);
    /* (2 * 1 + 3 * 4) / 5, and both lie at y = -2, z = 0.5 */
    assert_near(ritz_dense_col(&t.chiUtilde, 0)[2], 2.0, 1e2 * DBL_EPSILON);
    assert_near(ritz_dense_col(&t.chiUtilde, 1)[2], 2.8, 1e2 * DBL_EPSILON);
    assert_near(ritz_dense_col(&t.chiUtilde, 2)[0], -2.0, 1e2 * DBL_EPSILON);
}

static void terms_of_two_masses_are_what_defines_them(void **state)
{
    (void)state;
    check_terms(false);
}

static void axes_of_displacements_change_no_term(void **state)
{
    (void)state;
    check_terms(true);
}

/* Use the identity as basis. */
static ritz_status reduce(const ritz_component *component, ritz_reduced *out)
{
    RITZ_OWN(ritz_basis) basis = {0};
    int64_t n = component->num_dofs;

    RITZ_CHECK(ritz_basis_new(n, n, &basis));
    for (int64_t i = 0; i < n; i++)
        ritz_dense_col(&basis.T, i)[i] = 1.0;
    return ritz_reduce(component, &basis, out);
}

static ritz_status reduce_pair(bool turned, double k, ritz_reduced *out)
{
    ritz_component pair = {0};
    ritz_status status = make_pair(turned, k, &pair);

    if (status == RITZ_OK)
        status = reduce(&pair, out);
    ritz_component_free(&pair);
    return status;
}

/* Two masses on a spring: five rigid motions and a stretch. */
static void rigid_motion_is_left_to_the_frame(void **state)
{
    (void)state;
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(exudyn_body) body = {0};
    const double k = 30.0;
    /* w^2 = k (1/m1 + 1/m2); psi = (m2, -m1) sqrt(1 / (m1 m2 (m1 + m2))) */
    const double lambda = k * (1.0 / 2.0 + 1.0 / 3.0);
    const double unit = 1.0 / sqrt(2.0 * 3.0 * 5.0);

    assert_ok(reduce_pair(false, k, &reduced));
    assert_ok(exudyn_body_of(&reduced, &basic, &body));
    assert_int_equal(body.floating.num_rigid, 5);
    assert_int_equal(body.floating.V.ncol, 1);
    /* LAPACK on six dofs: some tens of roundings of the largest */
    assert_near(body.floating.K.val[0], lambda, 1e3 * DBL_EPSILON * lambda);
    assert_near(body.floating.M.val[0], 1.0, 1e3 * DBL_EPSILON);
    assert_near(body.floating.shape.val[0], 3.0 * unit, 1e3 * DBL_EPSILON);
    assert_near(body.floating.shape.val[3], -2.0 * unit, 1e3 * DBL_EPSILON);
    assert_near(body.floating.lowest_hz, sqrt(lambda) / (2.0 * acos(-1.0)),
                1e3 * DBL_EPSILON);
    /* x.psi = 2 * 1 * 3u - 3 * 4 * 2u = -18 u, on the axes across */
    assert_near(ritz_dense_col(&body.terms.mXRefTildePsiTilde, 1)[1],
                -18.0 * unit, 1e4 * DBL_EPSILON);
}

/* Rigid columns 0-4 and two others; the first of those may be rigid too. */
static void make_marked(double spare, ritz_reduced *out)
{
    RITZ_OWN(ritz_component) pair = {0};
    RITZ_OWN(ritz_basis) basis = {0};

    assert_ok(make_pair(false, 30.0, &pair));
    assert_ok(ritz_basis_new(6, 6, &basis));
    for (int64_t j = 0; j < 5; j++)
        basis.columns.kind[j] = RITZ_COLUMN_RIGID;
    for (int a = 0; a < 3; a++) /* translations */
        for (int i = 0; i < 2; i++)
            ritz_dense_col(&basis.T, a)[3 * i + a] = 1.0;
    for (int a = 1; a < 3; a++) /* rotations about the first mass */
        ritz_dense_col(&basis.T, 2 + a)[3 + a] = 1.0;
    ritz_dense_col(&basis.T, 5)[0] = 0.75;
    ritz_dense_col(&basis.T, 5)[4] = spare;
    assert_ok(ritz_reduce(&pair, &basis, out));
}

static void columns_beside_rigid_ones_stay_as_they_are(void **state)
{
    (void)state;
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(exudyn_body) body = {0};

    make_marked(0.25, &reduced);
    assert_ok(exudyn_body_of(&reduced, &basic, &body));
    assert_true(body.floating.kept);
    assert_int_equal(body.floating.num_rigid, 5);
    assert_near(body.floating.shape.val[0], 0.75, 0.0);
    assert_near(body.floating.shape.val[4], 0.25, 0.0);
}

static void a_loose_part_is_refused(void **state)
{
    (void)state;
    RITZ_OWN(ritz_component) pair = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    exudyn_body body = {0};
    const int64_t row[1] = {0};
    const double val[1] = {30.0};
    ritz_sparse K = {0};

    /* held along x at one mass, the other is free of it */
    assert_ok(make_pair(false, 30.0, &pair));
    assert_ok(ritz_sparse_from_triplets(6, 6, 1, row, row, val, &K));
    ritz_sparse_free(&pair.K);
    pair.K = K;
    assert_ok(reduce(&pair, &reduced));
    assert_fails(exudyn_body_of(&reduced, &basic, &body), RITZ_ERR_ARGUMENT,
                 "a part is loose");
}

/* A mass that turns too, on the second grid: R1 R2 R3, with inertia 0.7. */
static void make_turning(ritz_reduced *out)
{
    ritz_component c = {.num_dofs = 9};
    int64_t row[13], col[13];
    double m[9], k[13];

    c.dof = ritz_zalloc(9, sizeof *c.dof);
    assert_non_null(c.dof);
    for (int i = 0; i < 9; i++) {
        c.dof[i] = i < 3 ? (ritz_dof){11, 1 + i} : (ritz_dof){12, i - 2};
        m[i] = i < 6 ? masses[i / 3] : 0.7;
        row[i] = col[i] = i;
        k[i] = 10.0 + i; /* held: nothing is rigid */
    }
    for (int i = 0; i < 2; i++) { /* T2 of 11 and R3 of 12 move together */
        row[9 + i] = col[10 - i] = i == 0 ? 1 : 8;
        k[9 + i] = 5.0;
    }
    assert_ok(ritz_sparse_from_triplets(9, 9, 9, row, row, m, &c.M));
    assert_ok(ritz_sparse_from_triplets(9, 9, 11, row, col, k, &c.K));
    assert_ok(make_grids(true, &c.grids));
    assert_ok(ritz_component_settle(&c, false));
    assert_ok(reduce(&c, out));
    ritz_component_free(&c);
}

static bool says(const ritz_export_report *report, const char *words)
{
    for (int64_t k = 0; k < report->count; k++)
        if (strstr(report->line[k], words))
            return true;
    return false;
}

/*
 * Linear momentum must agree with m skew(psi), and the antisymmetric part of
 * mXRefTildePsiTilde with the angular momentum: the equations of motion keep
 * momentum by it.
 */
static void assert_consistent(const exudyn_terms *t, int64_t k)
{
    const ritz_dense *N = &t->mXRefTildePsiTilde;
    const double *S = ritz_dense_col(&t->mPhitTPsi, k);
    const double *C = ritz_dense_col(&t->mXRefTildePsi, k); /* times -1 */

    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            double ab = ritz_dense_col(N, 3 * k + b)[a];
            double ba = ritz_dense_col(N, 3 * k + a)[b];

            assert_near(ritz_dense_col(&t->mPhitTPsiTilde, 3 * k + b)[a],
                        skew(S, a, b), 0.0);
            /* halves of entries below 20 are added and subtracted */
            assert_near(ab - ba, skew(C, a, b), 100.0 * DBL_EPSILON);
        }
}

static void rotations_count_in_all_terms(void **state)
{
    (void)state;
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(exudyn_body) body = {0};
    RITZ_OWN(ritz_export_report) report = {0};

    make_turning(&reduced);
    assert_ok(exudyn_body_of(&reduced, &basic, &body));
    assert_int_equal(body.floating.V.ncol, 9);
    for (int64_t k = 0; k < 9; k++) {
        assert_consistent(&body.terms, k);
        assert_near(body.floating.M.val[k * 10], 1.0, 1e3 * DBL_EPSILON);
    }
    /* 2 (y^2 + z^2) + 3 (y^2 + z^2) + 0.7 about x */
    assert_near(body.terms.inertiaLocal.val[0], 5.0 * 4.25 + 0.7,
                1e2 * DBL_EPSILON);
    assert_ok(exudyn_body_say(&body, &report));
    assert_true(says(&report, "rotations of 1 grids left out"));
    /* a mass with inertia moves by its rotations too */
    assert_false(says(&report, "kinetic energy"));
}

static void make_path(const char *name, char path[PATH_SIZE])
{
    snprintf(path, PATH_SIZE, "/tmp/ritz-exudyn-%ld-%s", (long)getpid(), name);
}

static ritz_status export(const ritz_reduced *reduced, const char *path)
{
    ritz_export_report report = {0};
    const ritz_export_request request = {.output = path};
    ritz_status status = ritz_exporter_exudyn.write(
        &(ritz_export_object){.reduced = reduced}, &request, &report);

    ritz_export_report_free(&report);
    return status;
}

static void assert_same_bytes(const char *one, const char *other)
{
    FILE *a = fopen(one, "rb");
    FILE *b = fopen(other, "rb");
    int64_t count = 0;
    int c = 0;

    assert_non_null(a);
    assert_non_null(b);
    while ((c = fgetc(a)) != EOF) {
        assert_int_equal(c, fgetc(b));
        count++;
    }
    assert_int_equal(fgetc(b), EOF);
    assert_true(count > 1000);
    fclose(a);
    fclose(b);
}

static void a_file_written_twice_has_the_same_bytes(void **state)
{
    (void)state;
    RITZ_OWN(ritz_reduced) reduced = {0};
    char one[PATH_SIZE], other[PATH_SIZE];

    make_path("one.hdf5", one);
    make_path("two.hdf5", other);
    assert_ok(reduce_pair(true, 30.0, &reduced));
    assert_ok(export(&reduced, one));
    assert_ok(export(&reduced, other));
    assert_same_bytes(one, other);
    remove(one);
    remove(other);
}

static const char *const names[] = {"fileVersion",
                                    "type",
                                    "modeBasis",
                                    "trigList",
                                    "xRef",
                                    "massMatrixReduced",
                                    "infoList",
                                    "Mtt",
                                    "stiffnessMatrixReduced",
                                    "inertiaLocal",
                                    "totalMass",
                                    "postProcessingModes",
                                    "chiU",
                                    "chiUtilde",
                                    "rigidBodyNodeType",
                                    "mPhitTPsi",
                                    "mPsiTildePsi",
                                    "mPsiTildePsiTilde",
                                    "mXRefTildePsi",
                                    "mPhitTPsiTilde",
                                    "mXRefTildePsiTilde"};

static void a_file_holds_what_its_reader_asks_for(void **state)
{
    (void)state;
    const int64_t info[6] = {1, 2, 3, 4, 7, 8};
    int64_t found[6] = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    ritz_dense A = {0};
    hid_t file = 0;
    char path[PATH_SIZE];

    make_path("members.hdf5", path);
    assert_ok(reduce_pair(true, 30.0, &reduced));
    assert_ok(export(&reduced, path));
    assert_ok(ritz_h5_open(path, &file));
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        hid_t member = H5Oopen(file, names[k], H5P_DEFAULT);

        assert_true(member >= 0);
        assert_true(H5Aexists(member, "datatype") > 0);
        ritz_h5_close(member);
    }
    assert_ok(ritz_h5_read(file, "infoList", H5T_STD_I64LE, ritz_h5_vector(6),
                           found));
    assert_memory_equal(found, info, sizeof info);
    assert_ok(ritz_h5_read_dense(file, "modeBasis", 6, 1, &A));
    /* the stretch is along x, whatever the axes of the second grid */
    assert_near(A.val[3] / A.val[0], -2.0 / 3.0, 1e3 * DBL_EPSILON);
    assert_near(A.val[4], 0.0, 1e3 * DBL_EPSILON);
    ritz_dense_free(&A);
    ritz_h5_close(file);
    remove(path);
}

static void invariants_go_through_a_container(void **state)
{
    (void)state;
    RITZ_OWN(ritz_reduced) reduced = {0}, again = {0};
    const ritz_stamp stamp = {.command = "test"};
    char path[PATH_SIZE];

    make_path("reduced.h5", path);
    make_turning(&reduced);
    assert_ok(ritz_container_write_reduced(path, &reduced, &stamp));
    assert_ok(ritz_container_read_reduced(path, &again));
    assert_memory_equal(again.invariants.rigid, reduced.invariants.rigid,
                        sizeof again.invariants.rigid);
    assert_memory_equal(again.invariants.momentum.val,
                        reduced.invariants.momentum.val, 54 * sizeof(double));
    assert_memory_equal(again.invariants.position.val,
                        reduced.invariants.position.val, 81 * sizeof(double));
    assert_memory_equal(again.invariants.product.val,
                        reduced.invariants.product.val, 729 * sizeof(double));
    remove(path);
}

static void a_second_projection_takes_invariants_along(void **state)
{
    (void)state;
    RITZ_OWN(ritz_component) pair = {0};
    RITZ_OWN(ritz_reduced) reduced = {0}, second = {0};
    RITZ_OWN(ritz_invariants) direct = {0};
    RITZ_OWN(ritz_dense) T = {0};

    assert_ok(make_pair(true, 30.0, &pair));
    make_shapes(&pair, &T);
    assert_ok(reduce(&pair, &reduced));
    assert_ok(ritz_reduced_project(&reduced, &T, &second));
    assert_ok(ritz_invariants_of(&pair, &T, &direct));
    for (int64_t k = 0; k < 81; k++)
        /* sums of a dozen terms below 100, in two orders */
        assert_near(second.invariants.product.val[k], direct.product.val[k],
                    1e4 * DBL_EPSILON);
    for (int64_t k = 0; k < 27; k++)
        assert_near(second.invariants.position.val[k], direct.position.val[k],
                    1e4 * DBL_EPSILON);
}

/* What is wrong with an otherwise sound body. */
enum {
    NO_BASIS,
    NO_GRIDS,
    NO_MASS,
    NO_INVARIANTS,
    SCALAR_POINT,
    NO_PLACE,
    PARTIAL_GRID,
    ROTATIONS_ALONE,
    NO_STIFFNESS,
    DEFECTS
};

static void spoil_body(int defect, ritz_reduced *r)
{
    switch (defect) {
    case NO_BASIS:
        ritz_dense_free(&r->T);
        break;
    case NO_GRIDS:
        ritz_grids_free(&r->grids);
        break;
    case NO_MASS:
        r->inertia = (ritz_inertia){0};
        break;
    case NO_INVARIANTS:
        ritz_invariants_free(&r->invariants);
        break;
    case SCALAR_POINT:
        r->dof[2] = (ritz_dof){77, 0};
        break;
    case NO_PLACE:
        r->dof[2] = (ritz_dof){78, 3};
        break;
    case PARTIAL_GRID:
        r->dof[5] = (ritz_dof){11, 4};
        break;
    case ROTATIONS_ALONE:
        for (int i = 0; i < 6; i++)
            r->dof[i].component += 3;
        break;
    default:
        memset(r->K.val, 0, 36 * sizeof *r->K.val);
    }
}

static void what_is_no_body_is_refused(void **state)
{
    (void)state;
    static const char *const words[DEFECTS] = {
        [NO_BASIS] = "--without-basis",
        [NO_GRIDS] = "no grid has a position: import with --bulk",
        [NO_MASS] = "the body has no mass",
        [NO_INVARIANTS] = "kept of at most 400 columns, and it has 6",
        [SCALAR_POINT] = "point 77 is a scalar point",
        [NO_PLACE] = "grid 78 has no position",
        [PARTIAL_GRID] = "grid 12 has axes of its own",
        [ROTATIONS_ALONE] = "no grid has a translation",
        [NO_STIFFNESS] = "no mode is flexible",
    };
    char path[PATH_SIZE];

    make_path("refused.hdf5", path);
    for (int k = 0; k < DEFECTS; k++) {
        RITZ_OWN(ritz_reduced) reduced = {0};

        assert_ok(reduce_pair(true, 30.0, &reduced));
        spoil_body(k, &reduced);
        assert_fails(export(&reduced, path), RITZ_ERR_ARGUMENT, words[k]);
        assert_int_not_equal(access(path, F_OK), 0);
    }
}

static void of_many_columns_no_invariants_are_kept(void **state)
{
    (void)state;
    RITZ_OWN(ritz_component) pair = {0};
    RITZ_OWN(ritz_dense) T = {0};
    ritz_invariants none = {0};

    assert_ok(make_pair(false, 1.0, &pair));
    assert_ok(ritz_dense_new(6, RITZ_INVARIANT_COLUMNS + 1, &T));
    assert_ok(ritz_invariants_of(&pair, &T, &none));
    assert_null(none.momentum.val);
}

static ritz_status reduce_and_export(void *path)
{
    ritz_reduced reduced = {0};
    ritz_status status = reduce_pair(true, 30.0, &reduced);

    if (status == RITZ_OK)
        status = export(&reduced, path);
    ritz_reduced_free(&reduced);
    return status;
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    char path[PATH_SIZE];

    make_path("memory.hdf5", path);
    assert_survives_every_allocation(reduce_and_export(path));
    remove(path);
}

static void a_folder_that_is_not_there_is_said(void **state)
{
    (void)state;
    RITZ_OWN(ritz_reduced) reduced = {0};

    assert_ok(reduce_pair(false, 30.0, &reduced));
    assert_fails(export(&reduced, "/no/such/folder/body.hdf5"), RITZ_ERR_FILE,
                 "/no/such/folder");
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(terms_of_two_masses_are_what_defines_them),
    cmocka_unit_test(axes_of_displacements_change_no_term),
    cmocka_unit_test(rigid_motion_is_left_to_the_frame),
    cmocka_unit_test(columns_beside_rigid_ones_stay_as_they_are),
    cmocka_unit_test(a_loose_part_is_refused),
    cmocka_unit_test(rotations_count_in_all_terms),
    cmocka_unit_test(a_file_written_twice_has_the_same_bytes),
    cmocka_unit_test(a_file_holds_what_its_reader_asks_for),
    cmocka_unit_test(invariants_go_through_a_container),
    cmocka_unit_test(a_second_projection_takes_invariants_along),
    cmocka_unit_test(what_is_no_body_is_refused),
    cmocka_unit_test(of_many_columns_no_invariants_are_kept),
    cmocka_unit_test(every_allocation_may_fail),
    cmocka_unit_test(a_folder_that_is_not_there_is_said),
};

TEST_MODULE(exudyn, tests, NULL, NULL)
