/*
 * Matrices that public and commercial solvers made of one structure, an inboard
 * and an outboard frame that meet at the grids 3, 11, 19 and 27, and what those
 * solvers and an independent computation say of them (third-party files,
 * RITZ_EXTERNAL_DATA).
 */
#include "testing.h"

#include "scenes.h"
#include "solvers.h"

#include <ritz/assembly.h>
#include <ritz/basis.h>
#include <ritz/matrix.h>

#include <float.h>
#include <stdio.h>

/* The two in a basis, joined; modes of -1 where the method takes none. */
static bool join(const solvers_source from[2], const ritz_method *method,
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
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};

    for (int k = 0; k < 2; k++) {
        RITZ_OWN(ritz_component) component = {0};

        if (!solvers_import(&from[k], &component))
            return false;
        assert_ok(reduce_with(&component, method, modes[k], &body[k]));
    }
    assert_ok(ritz_scene_parse("frames.yaml", text, &scene));
    assert_ok(ritz_stage_from(&scene, body, &stage));
    assert_ok(ritz_stage_assemble(&stage, NULL, out));
    assert_int_equal(out->rank, 24);
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
    RITZ_OWN(ritz_configuration) c = {0};

    (void)state;
    if (!join(solvers_nastran95, &ritz_method_full, -1, -1, &c)) {
        skip();
        return;
    }
    /* ten turns about members have neither mass nor a frequency */
    assert_int_equal(c.K.ncol, 2 * 156 - 24 - 10);
    assert_hertz(&c, 0, 6, whole, 5e-9);
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
        RITZ_OWN(ritz_configuration) c = {0};

        if (!join(solvers_nastran95, &ritz_method_craig_bampton,
                  lines[n].inboard, lines[n].outboard, &c)) {
            skip();
            return;
        }
        assert_int_equal(c.K.ncol, 24 + lines[n].inboard + lines[n].outboard);
        assert_hertz(&c, lines[n].from, lines[n].count, lines[n].hertz, 5e-9);
    }
}

/*
 * Of equal order: 24 + 2 and 24 + 16 columns against 6 + 24 + 0 and 6 + 24 + 6.
 * A basis gives frequencies from above; their errors are measured.
 */
static void macneal_rubin_stands_beside_craig_bampton(void **state)
{
    static const double measured[] = {0.0, 0.0, 1.7e-7, 1.5e-7, 1.4e-7, 0.0};
    RITZ_OWN(ritz_configuration) fixed = {0}, free_ends = {0};

    (void)state;
    if (!join(solvers_nastran95, &ritz_method_craig_bampton, 2, 16, &fixed) ||
        !join(solvers_nastran95, &ritz_method_macneal_rubin, 0, 6,
              &free_ends)) {
        skip();
        return;
    }
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
}

/* clients.md: what NASTRAN-95 and MYSTRAN print with the four grids held. */
static void interface_held_each_solver_has_its_modes(void **state)
{
    static const struct line {
        const solvers_source *from;
        int count;
        double hertz[6];
        double unit[2]; /* half, of numbers below and above 10 Hz */
    } lines[] = {
        {&solvers_nastran95[0],
         3,
         {6.129345, 6.130134, 23.63188},
         {5e-7, 5e-6}},
        {&solvers_nastran95[1],
         6,
         {1.650001, 1.650249, 1.674265, 1.674687, 7.025351, 7.025411},
         {5e-7, 5e-6}},
        {&solvers_mystran[0], 3, {6.053712, 6.057301, 19.75145}, {5e-7, 5e-6}},
        {&solvers_mystran[1],
         5,
         {1.621517, 1.621756, 1.656978, 1.657391, 5.709531},
         {5e-7, 5e-6}},
    };

    (void)state;
    for (size_t n = 0; n < sizeof lines / sizeof *lines; n++) {
        RITZ_OWN(ritz_component) component = {0};
        RITZ_OWN(ritz_reduced) reduced = {0};

        if (!solvers_import(lines[n].from, &component)) {
            skip();
            return;
        }
        assert_ok(
            reduce_with(&component, &ritz_method_craig_bampton, 6, &reduced));
        for (int k = 0; k < lines[n].count; k++)
            assert_near(reduced.columns.hertz[24 + k], lines[n].hertz[k],
                        lines[n].unit[lines[n].hertz[k] > 10.0]);
    }
}

/* NASTRAN-95's sparse and dense files of one component, bit for bit. */
static void spellings_make_the_same_component(void **state)
{
    static const solvers_source dense = {
        SOLVERS "nastran95_inboard_dense.op4:KGG",
        SOLVERS "nastran95_inboard_dense.op4:MGG",
        SOLVERS "nastran95_inboard.deck",
        NULL,
    };
    RITZ_OWN(ritz_component) a = {0}, b = {0};

    (void)state;
    if (!solvers_import(&solvers_nastran95[0], &a) ||
        !solvers_import(&dense, &b)) {
        skip();
        return;
    }
    for (int m = 0; m < 2; m++) {
        const ritz_sparse *A = m == 0 ? &a.K : &a.M;
        const ritz_sparse *B = m == 0 ? &b.K : &b.M;
        const size_t nnz = (size_t)A->colptr[A->ncol];

        assert_int_equal(A->ncol, B->ncol);
        assert_int_equal(nnz, B->colptr[B->ncol]);
        assert_memory_equal(A->rowind, B->rowind, nnz * sizeof *A->rowind);
        assert_memory_equal(A->val, B->val, nnz * sizeof *A->val);
    }
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
    const solvers_source from[2] = {
        {CSUPER "inboard.op4:KXX", CSUPER "inboard.op4:MXX",
         CSUPER "inboard.dat", NULL},
        {CSUPER "nas2cam.op4:KAA#1", CSUPER "nas2cam.op4:MAA#1",
         CSUPER "exse101.bulk", "outboard.dofs"}};
    RITZ_OWN(ritz_configuration) c = {0};
    RITZ_OWN(ritz_dense) lambda = {0};
    bool joined = false;

    (void)state;
    write_dofs("outboard.dofs", 1995001, 22);
    joined = join(from, &ritz_method_full, -1, -1, &c);
    assert_int_equal(remove("outboard.dofs"), 0);
    if (!joined) {
        skip();
        return;
    }
    assert_int_equal(c.K.ncol, 54);
    assert_hertz(&c, 0, 3, printed, 5e-7);
    solvers_read(CSUPER "nas2cam.op4:LAMBDA#3", &lambda);
    for (int k = 6; k < 54; k++)
        assert_near(c.lambda[k], lambda.val[k],
                    0x1p-24 * c.lambda[k] +
                        DBL_EPSILON * c.lambda[53] /* of our own */);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(joined_frames_have_the_published_frequencies),
    cmocka_unit_test(craig_bampton_gives_the_published_frequencies),
    cmocka_unit_test(macneal_rubin_stands_beside_craig_bampton),
    cmocka_unit_test(interface_held_each_solver_has_its_modes),
    cmocka_unit_test(spellings_make_the_same_component),
    cmocka_unit_test(commercial_reduction_is_joined_as_it_was),
};

TEST_MODULE(public_solvers, tests, NULL, NULL)
