/*
 * Matrices that public and commercial solvers made of one structure, an inboard
 * and an outboard frame that meet at the grids 3, 11, 19 and 27, and what those
 * solvers and an independent computation say of them (third-party files,
 * RITZ_EXTERNAL_DATA).
 */
#include "testing.h"

#include "scenes.h"

#include <ritz/eigen.h>
#include <ritz/foreign.h>
#include <ritz/import.h>
#include <ritz/method.h>
#include <ritz/synthesis.h>

#include <float.h>
#include <stdio.h>
#include <stdlib.h>

#define SOLVERS "public_solvers/"
#define CSUPER  "nas2cam_csuper/"

/* Where a file of data/nastran is; false, and a reason, if nowhere. */
static bool find(const char *name, char path[static 512])
{
    const char *data = getenv("RITZ_EXTERNAL_DATA");

    if (!data) {
        print_message("skipped: no external data\n");
        return false;
    }
    snprintf(path, 512, "%s/nastran/%s", data, name);
    return true;
}

/* Files that make a component; `dofs` lies in the current folder. */
typedef struct source {
    const char *stiffness, *mass, *bulk, *dofs;
} source;

static const source nastran95[2] = {
    {SOLVERS "nastran95_inboard.op4:KGG", SOLVERS "nastran95_inboard.op4:MGG",
     SOLVERS "nastran95_inboard.deck", NULL},
    {SOLVERS "nastran95_outboard.op4:KGG", SOLVERS "nastran95_outboard.op4:MGG",
     SOLVERS "nastran95_outboard.deck", NULL}};
static const source mystran[2] = {
    {SOLVERS "mystran_inboard.op4:KGG", SOLVERS "mystran_inboard.op4:MGG",
     SOLVERS "mystran_inboard.dat", NULL},
    {SOLVERS "mystran_outboard.op4:KGG", SOLVERS "mystran_outboard.op4:MGG",
     SOLVERS "mystran_outboard.dat", NULL}};

static bool import(const source *from, ritz_component *out)
{
    const char *const ports[] = {"frame=3,11,19,27"};
    char K[512], M[512], bulk[512];
    ritz_import_request request = {.stiffness = K,
                                   .mass = M,
                                   .bulk = bulk,
                                   .dofs = from->dofs,
                                   .num_ports = 1,
                                   .port = ports};
    ritz_import_report report = {0};

    if (!find(from->stiffness, K))
        return false;
    find(from->mass, M);
    find(from->bulk, bulk);
    assert_ok(ritz_import(&request, out, &report));
    assert_int_equal(out->port[0].dofs.count, 24);
    ritz_import_report_free(&report);
    return true;
}

/* The two in a basis, joined; modes of -1 where the method takes none. */
static bool join(const source from[2], const ritz_method *method,
                 int64_t inboard, int64_t outboard, ritz_configuration *out)
{
    static const char text[] =
        "scene: two frames\n"
        "components:\n"
        "  inboard:  {model: inboard.h5,  basis: full}\n"
        "  outboard: {model: outboard.h5, basis: full}\n"
        "joints:\n"
        "  - {name: frame, between: [inboard/frame, outboard/frame],"
        " type: fixed}\n";
    const int64_t modes[2] = {inboard, outboard};
    ritz_reduced body[2] = {0};
    ritz_scene scene = {0};
    ritz_stage stage = {0};

    for (int k = 0; k < 2; k++) {
        ritz_component component = {0};

        if (!import(&from[k], &component))
            return false;
        assert_ok(reduce_with(&component, method, modes[k], &body[k]));
        ritz_component_free(&component);
    }
    assert_ok(ritz_scene_parse("frames.yaml", text, &scene));
    assert_ok(ritz_stage_from(&scene, body, &stage));
    assert_ok(ritz_stage_assemble(&stage, NULL, out));
    assert_int_equal(out->rank, 24);
    ritz_stage_free(&stage);
    ritz_scene_free(&scene);
    return true;
}

/*
 * oracles.md section 7. Printed digits are good to half a unit; rounding of a
 * dense solution adds eps lambda_max / lambda, relative, to eigenvalues: of the
 * whole system 3e-9 Hz at 1.7 Hz.
 */
static void assert_hertz(const ritz_configuration *c, int64_t from, int count,
                         const double *expected, double half)
{
    assert_int_equal(c->num_rigid, 6);
    for (int k = 0; k < count; k++)
        assert_near(ritz_eigen_hertz(c->lambda[6 + from + k]), expected[k],
                    half + 0.5 * expected[k] * DBL_EPSILON *
                               c->lambda[c->K.ncol - 1] /
                               c->lambda[6 + from + k]);
}

static const double whole[] = {1.69880011, 1.76748734, 1.85772039,
                               3.41961215, 7.02421123, 7.02540906};

static void joined_frames_have_the_published_frequencies(void **state)
{
    ritz_configuration c = {0};

    (void)state;
    if (!join(nastran95, &ritz_method_full, -1, -1, &c))
        skip();
    /* ten turns about members have neither mass nor a frequency */
    assert_int_equal(c.K.ncol, 2 * 156 - 24 - 10);
    assert_hertz(&c, 0, 6, whole, 5e-9);
    ritz_configuration_free(&c);
}

static void craig_bampton_gives_the_published_frequencies(void **state)
{
    static const struct line {
        int64_t inboard, outboard, from;
        int count;
        double hertz[5];
    } lines[] = {
        {2,
         16,
         0,
         5,
         {1.69880373, 1.76750137, 1.85773973, 3.42832946, 7.02422141}},
        {3, 16, 3, 1, {3.41982489}},
        {8, 22, 0, 4, {1.69880191, 1.76749685, 1.85773881, 3.41980035}},
    };

    (void)state;
    for (size_t n = 0; n < sizeof lines / sizeof *lines; n++) {
        ritz_configuration c = {0};

        if (!join(nastran95, &ritz_method_craig_bampton, lines[n].inboard,
                  lines[n].outboard, &c))
            skip();
        assert_int_equal(c.K.ncol, 24 + lines[n].inboard + lines[n].outboard);
        assert_hertz(&c, lines[n].from, lines[n].count, lines[n].hertz, 5e-9);
        ritz_configuration_free(&c);
    }
}

/*
 * Of equal order: 24 + 2 and 24 + 16 columns against 6 + 24 + 0 and 6 + 24 + 6.
 * A basis gives frequencies from above; their errors are measured.
 */
static void macneal_rubin_stands_beside_craig_bampton(void **state)
{
    static const double measured[] = {0.0, 0.0, 1.7e-7, 1.5e-7, 1.4e-7, 0.0};
    ritz_configuration fixed = {0}, free_ends = {0};

    (void)state;
    if (!join(nastran95, &ritz_method_craig_bampton, 2, 16, &fixed))
        skip();
    assert_true(join(nastran95, &ritz_method_macneal_rubin, 0, 6, &free_ends));
    assert_int_equal(fixed.K.ncol, free_ends.K.ncol);
    for (int k = 0; k < 6; k++) {
        const double one = ritz_eigen_hertz(fixed.lambda[6 + k]);
        const double other = ritz_eigen_hertz(free_ends.lambda[6 + k]);
        const double digits = 5e-9 + 3e-9; /* of `whole`, and rounding */

        print_message("%.8f Hz: Craig-Bampton %+.1e, MacNeal-Rubin %+.1e\n",
                      whole[k], one / whole[k] - 1, other / whole[k] - 1);
        assert_true(one >= whole[k] - digits);
        assert_true(other >= whole[k] - digits);
        assert_true(other <= whole[k] * (1.0 + 1.1 * measured[k]) + digits);
    }
    ritz_configuration_free(&fixed);
    ritz_configuration_free(&free_ends);
}

/* clients.md: what NASTRAN-95 and MYSTRAN print with the four grids held. */
static void interface_held_each_solver_has_its_modes(void **state)
{
    static const struct line {
        const source *from;
        int count;
        double hertz[6];
        double unit[2]; /* half, of numbers below and above 10 Hz */
    } lines[] = {
        {&nastran95[0], 3, {6.129345, 6.130134, 23.63188}, {5e-7, 5e-6}},
        {&nastran95[1],
         6,
         {1.650001, 1.650249, 1.674265, 1.674687, 7.025351, 7.025411},
         {5e-7, 5e-6}},
        {&mystran[0], 3, {6.053712, 6.057301, 19.75145}, {5e-7, 5e-6}},
        {&mystran[1],
         5,
         {1.621517, 1.621756, 1.656978, 1.657391, 5.709531},
         {5e-7, 5e-6}},
    };

    (void)state;
    for (size_t n = 0; n < sizeof lines / sizeof *lines; n++) {
        ritz_component component = {0};
        ritz_reduced reduced = {0};

        if (!import(lines[n].from, &component))
            skip();
        assert_ok(
            reduce_with(&component, &ritz_method_craig_bampton, 6, &reduced));
        for (int k = 0; k < lines[n].count; k++)
            assert_near(reduced.columns.hertz[24 + k], lines[n].hertz[k],
                        lines[n].unit[lines[n].hertz[k] > 10.0]);
        ritz_reduced_free(&reduced);
        ritz_component_free(&component);
    }
}

static void read_dense(const char *name, ritz_dense *out)
{
    char spec[512];
    ritz_matrix matrix = {0};

    assert_true(find(name, spec));
    assert_ok(ritz_foreign_select(spec, &matrix));
    assert_ok(ritz_sparse_dense(&matrix.A, out));
    ritz_matrix_free(&matrix);
}

/* G = |T|'|K||T|: eps of it is what rounding of K's entries does to T'KT. */
static void measure_rounding(const ritz_sparse *K, const ritz_dense *T,
                             ritz_dense *G)
{
    ritz_sparse size = {0};
    ritz_dense above = {0}, part = {0};

    assert_ok(ritz_sparse_copy(K, &size));
    assert_ok(ritz_dense_copy(T, &above));
    for (int64_t k = 0; k < size.colptr[size.ncol]; k++)
        size.val[k] = fabs(size.val[k]);
    for (int64_t k = 0; k < above.nrow * above.ncol; k++)
        above.val[k] = fabs(above.val[k]);
    assert_ok(ritz_sparse_mul(&size, &above, &part));
    assert_ok(ritz_dense_mul_tn(&above, &part, G));
    ritz_sparse_free(&size);
    ritz_dense_free(&above);
    ritz_dense_free(&part);
}

/* Largest of a column, and the sum of its sizes. */
static double largest(const ritz_dense *A, int64_t j)
{
    double most = 0.0;

    for (int64_t i = 0; i < A->nrow; i++)
        most = fmax(most, fabs(ritz_dense_col(A, j)[i]));
    return most;
}

static double total(const ritz_dense *A, int64_t j)
{
    double sum = 0.0;

    for (int64_t i = 0; i < A->nrow; i++)
        sum += fabs(ritz_dense_col(A, j)[i]);
    return sum;
}

/* Rounding of T'KT at i, j; an eigensolver rounds all modes as the worst. */
static double rounding(const ritz_dense *G, int64_t i, int64_t j)
{
    double most = ritz_dense_col(G, j)[i];

    for (int64_t k = 24; i >= 24 && j >= 24 && k < 40; k++)
        most = fmax(most, ritz_dense_col(G, k)[k]);
    return DBL_EPSILON * most;
}

/*
 * How far column i of T may be off: rounding dK turns it towards mode j by
 * x_i' dK x_j / (lambda_i - lambda_j); constraint modes answer at lambda = 0.
 * Measured: half to a fifth of that for constraint modes, 1/20 for modes.
 */
static double turn_of(const ritz_reduced *ours, const ritz_dense *G, int64_t i)
{
    const double own = i < 24 ? 0.0 : ritz_dense_col(&ours->K, i)[i];
    double sum = 0.0;

    for (int64_t j = 24; j < 40; j++)
        if (j != i)
            sum += rounding(G, i, j) /
                   fabs(own - ritz_dense_col(&ours->K, j)[j]) *
                   largest(&ours->T, j);
    return sum;
}

/* 1 or -1, as columns of PHIXG and T have it; constraint modes have no sign. */
static void find_signs(const ritz_dense *A, const ritz_dense *B, double *s)
{
    for (int64_t j = 0; j < A->ncol; j++) {
        double dot = 0.0;

        for (int64_t i = 0; i < A->nrow; i++)
            dot += ritz_dense_col(A, j)[i] * ritz_dense_col(B, j)[i];
        s[j] = dot < 0.0 ? -1.0 : 1.0;
        assert_true(j >= 24 || s[j] > 0.0);
    }
}

/*
 * MYSTRAN's coordinates are the 24 of the grids in ascending order, then 16
 * modes of unit mass: ours, but for the signs of modes.
 */
static void mystran_reduces_to_the_same_matrices(void **state)
{
    ritz_component component = {0};
    ritz_reduced ours = {0};
    ritz_dense K = {0}, M = {0}, T = {0}, G = {0}, MT = {0};
    double s[40], off[40];

    (void)state;
    if (!import(&mystran[1], &component))
        skip();
    assert_ok(reduce_with(&component, &ritz_method_craig_bampton, 16, &ours));
    read_dense(SOLVERS "mystran_outboard_cb.op4:KXX", &K);
    read_dense(SOLVERS "mystran_outboard_cb.op4:MXX", &M);
    read_dense(SOLVERS "mystran_outboard_cb.op4:PHIXG", &T);
    assert_int_equal(ours.K.ncol, 40);
    assert_int_equal(K.ncol, 40);
    find_signs(&T, &ours.T, s);
    measure_rounding(&component.K, &ours.T, &G);
    assert_ok(ritz_sparse_mul(&component.M, &ours.T, &MT));
    for (int64_t j = 0; j < 40; j++) {
        off[j] = turn_of(&ours, &G, j);
        for (int64_t i = 0; i < T.nrow; i++)
            assert_near(ritz_dense_col(&ours.T, j)[i] * s[j],
                        ritz_dense_col(&T, j)[i], off[j]);
    }
    for (int64_t j = 0; j < 40; j++)
        for (int64_t i = 0; i < 40; i++) {
            assert_near(ritz_dense_col(&ours.K, j)[i] * s[i] * s[j],
                        ritz_dense_col(&K, j)[i], rounding(&G, i, j));
            assert_near(ritz_dense_col(&ours.M, j)[i] * s[i] * s[j],
                        ritz_dense_col(&M, j)[i],
                        off[i] * total(&MT, j) + off[j] * total(&MT, i));
        }
    ritz_dense_free(&K);
    ritz_dense_free(&M);
    ritz_dense_free(&T);
    ritz_dense_free(&G);
    ritz_dense_free(&MT);
    ritz_reduced_free(&ours);
    ritz_component_free(&component);
}

/* NASTRAN-95's sparse and dense files of one component, bit for bit. */
static void spellings_make_the_same_component(void **state)
{
    static const source dense = {
        SOLVERS "nastran95_inboard_dense.op4:KGG",
        SOLVERS "nastran95_inboard_dense.op4:MGG",
        SOLVERS "nastran95_inboard.deck",
        NULL,
    };
    ritz_component a = {0}, b = {0};

    (void)state;
    if (!import(&nastran95[0], &a) || !import(&dense, &b))
        skip();
    for (int m = 0; m < 2; m++) {
        const ritz_sparse *A = m == 0 ? &a.K : &a.M;
        const ritz_sparse *B = m == 0 ? &b.K : &b.M;
        const size_t nnz = (size_t)A->colptr[A->ncol];

        assert_int_equal(A->ncol, B->ncol);
        assert_int_equal(nnz, B->colptr[B->ncol]);
        assert_memory_equal(A->rowind, B->rowind, nnz * sizeof *A->rowind);
        assert_memory_equal(A->val, B->val, nnz * sizeof *A->val);
    }
    ritz_component_free(&a);
    ritz_component_free(&b);
}

/* The 24 rows of the grids and then modal points, as the a-set orders them. */
static void write_dofs(const char *path, int64_t first_point, int points)
{
    static const int grids[] = {3, 11, 19, 27};
    FILE *file = fopen(path, "w");

    assert_non_null(file);
    for (int k = 0; k < 24; k++)
        fprintf(file, "%d %d\n", grids[k / 6], k % 6 + 1);
    for (int k = 0; k < points; k++)
        fprintf(file, "%d 0\n", (int)first_point + k);
    assert_int_equal(fclose(file), 0);
}

/*
 * The commercial code's own Craig-Bampton matrices, joined as it joined them:
 * 1.699652 1.768612 1.857731 Hz (oracles.md section 7), and all 54 values that
 * it printed in the third LAMBDA of the file, single precision. The inboard
 * mass has an eigenvalue of -6e-12, which the outboard's makes good.
 */
static void commercial_reduction_is_joined_as_it_was(void **state)
{
    static const double printed[] = {1.699652, 1.768612, 1.857731};
    const source from[2] = {{CSUPER "inboard.op4:KXX", CSUPER "inboard.op4:MXX",
                             CSUPER "inboard.dat", NULL},
                            {CSUPER "nas2cam.op4:KAA#1",
                             CSUPER "nas2cam.op4:MAA#1", CSUPER "exse101.bulk",
                             "outboard.dofs"}};
    ritz_configuration c = {0};
    ritz_dense lambda = {0};
    bool joined = false;

    (void)state;
    write_dofs("outboard.dofs", 1995001, 22);
    joined = join(from, &ritz_method_full, -1, -1, &c);
    assert_int_equal(remove("outboard.dofs"), 0);
    if (!joined)
        skip();
    assert_int_equal(c.K.ncol, 54);
    assert_hertz(&c, 0, 3, printed, 5e-7);
    read_dense(CSUPER "nas2cam.op4:LAMBDA#3", &lambda);
    for (int k = 6; k < 54; k++)
        assert_near(c.lambda[k], lambda.val[k],
                    0x1p-24 * c.lambda[k] +
                        DBL_EPSILON * c.lambda[53] /* of our own */);
    ritz_dense_free(&lambda);
    ritz_configuration_free(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(joined_frames_have_the_published_frequencies),
        cmocka_unit_test(craig_bampton_gives_the_published_frequencies),
        cmocka_unit_test(macneal_rubin_stands_beside_craig_bampton),
        cmocka_unit_test(interface_held_each_solver_has_its_modes),
        cmocka_unit_test(mystran_reduces_to_the_same_matrices),
        cmocka_unit_test(spellings_make_the_same_component),
        cmocka_unit_test(commercial_reduction_is_joined_as_it_was),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
