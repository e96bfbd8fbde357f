/*
 * Krylov P&A, held to the clamped beam of two components [McDaniel2000, table
 * 3.5] with the frequencies recomputed to six digits, and its moments.
 */
#include "testing.h"

#include "beams.h"
#include "compared.h"

#include "compare/compare.h"

#include <ritz/matrix.h>

#include <stdio.h>

/*
 * One unit of the last digit printed: the first frequency is 0.09946050 in the
 * table of k = 4 and 5, and was rounded both ways.
 */
static const double printed = 1e-6;

static void make(const char *choice, ritz_scene *scene, ritz_stage *stage)
{
    char tail[1024];

    snprintf(tail, sizeof tail, "%s%s", beams_krylov_io, choice);
    assert_ok(beams_stage(true, tail, scene, stage));
}

static void reduce(int vectors, const char *start, ritz_scene *scene,
                   ritz_stage *stage, ritz_comparison *c)
{
    char choice[128];

    snprintf(choice, sizeof choice, "select: {by: krylov, vectors: %d%s}\n",
             vectors, start);
    make(choice, scene, stage);
    assert_ok(ritz_compare(stage, c));
}

static void free_all(ritz_scene *scene, ritz_stage *stage, ritz_comparison *c)
{
    ritz_comparison_free(c);
    ritz_stage_free(stage);
    ritz_scene_free(scene);
}

/* Rayleigh-Ritz frequencies of the Krylov vectors themselves. */
static void assert_vectors(const ritz_configuration *c, int vectors,
                           const double *expected)
{
    RITZ_OWN(ritz_dense) V = {0}, K = {0}, M = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    int64_t moments = 0;

    assert_ok(ritz_system_krylov(c, vectors, false, &V, &moments));
    assert_int_equal(V.ncol, vectors);
    assert_int_equal(moments, vectors);
    assert_ok(ritz_dense_congruence(&c->K, &V, &K));
    assert_ok(ritz_dense_congruence(&c->M, &V, &M));
    assert_ok(ritz_eigen_dense(&K, &M, &pairs));
    for (int k = 0; k < vectors; k++)
        assert_near(ritz_eigen_hertz(pairs.lambda[k]), expected[k], printed);
    ritz_dense_free(&K);
    ritz_dense_free(&M);
}

static void frequencies_are_those_published(void **)
{
    static const struct {
        int vectors;
        double krylov[5];
        int order;
        double reduced[7];
    } table[] = {
        {3, {0.099461, 0.276577, 1.314513}, 3, {0.099461, 0.276577, 1.314513}},
        {4,
         {0.099460, 0.276339, 0.767679, 1.670544},
         5,
         {0.099460, 0.276338, 0.691837, 1.169996, 2.340113}},
        {5,
         {0.099460, 0.276336, 0.548248, 1.036741, 2.760385},
         7,
         {0.099460, 0.276336, 0.548228, 1.012437, 1.037818, 1.716499,
          2.765452}},
    };

    for (size_t t = 0; t < sizeof table / sizeof *table; t++) {
        ritz_scene scene = {0};
        ritz_stage stage = {0};
        ritz_comparison c = {0};
        const ritz_configuration *second = NULL;

        reduce(table[t].vectors, "", &scene, &stage, &c);
        assert_vectors(&c.first_system.configuration[0], table[t].vectors,
                       table[t].krylov);
        second = &c.second_system.configuration[0];
        assert_int_equal(second->K.ncol, table[t].order);
        for (int k = 0; k < table[t].order; k++)
            assert_near(ritz_eigen_hertz(second->lambda[k]),
                        table[t].reduced[k], printed);
        free_all(&scene, &stage, &c);
    }
}

/* C Lambda^-i-1 B. */
static double moment(const ritz_configuration *c, int i)
{
    double sum = 0.0;

    for (int64_t k = 0; k < c->K.ncol; k++)
        sum += ritz_dense_col(&c->io.C, k)[0] * c->io.B.val[k] *
               pow(c->lambda[k], -1.0 - i);
    return sum;
}

static void moments_are_those_published(void **)
{
    static const double expected[] = {0.33467, 0.83204,  2.12857,
                                      5.45023, 13.95575, 35.73486};
    ritz_scene scene = {0};
    ritz_stage stage = {0};
    ritz_comparison c = {0};

    reduce(3, "", &scene, &stage, &c);
    for (int i = 0; i < 6; i++)
        assert_near(moment(&c.first_system.configuration[0], i), expected[i],
                    5e-6);
    free_all(&scene, &stage, &c);
}

/*
 * k vectors keep the first k moments, and no more; with the output in the
 * starting block, k blocks keep 2k. cond(K) of the beam is 4e4: 1e-10 is ample.
 */
static void the_first_moments_are_kept_and_no_more(void **)
{
    static const struct {
        const char *start;
        int vectors, kept;
    } cases[] = {
        {"", 1, 1},
        {"", 2, 2},
        {"", 3, 3},
        {"", 4, 4},
        {", start: both", 2, 2},
        {", start: both", 4, 4},
    };

    for (size_t t = 0; t < sizeof cases / sizeof *cases; t++) {
        ritz_scene scene = {0};
        ritz_stage stage = {0};
        ritz_comparison c = {0};
        const ritz_configuration *one = NULL, *two = NULL;

        reduce(cases[t].vectors, cases[t].start, &scene, &stage, &c);
        one = &c.first_system.configuration[0];
        two = &c.second_system.configuration[0];
        assert_int_equal(c.row[0].num_moments, cases[t].kept);
        assert_int_equal(c.row[0].num_vectors, cases[t].vectors);
        assert_true(c.row[0].moment_error < 1e-10);
        for (int i = 0; i < cases[t].kept; i++)
            assert_near(moment(two, i) / moment(one, i), 1.0, 1e-10);
        if (!*cases[t].start && cases[t].vectors == 1)
            assert_true(fabs(moment(two, 2) / moment(one, 2) - 1.0) > 1e-6);
        free_all(&scene, &stage, &c);
    }
}

/* The space that the input reaches has dimension 8 of 9: axial and bending
 * modes are reached, one antisymmetric in neither. */
static void the_sequence_ends_where_its_space_does(void **)
{
    ritz_scene scene = {0};
    ritz_stage stage = {0};
    ritz_comparison c = {0};
    ritz_dense V = {0};
    int64_t moments = 0;

    reduce(5, "", &scene, &stage, &c);
    assert_ok(ritz_system_krylov(&c.first_system.configuration[0], 20, false,
                                 &V, &moments));
    assert_int_equal(V.ncol, 8);
    ritz_dense_free(&V);
    free_all(&scene, &stage, &c);
}

/* V'KV = I however long the sequence: raw vectors have cond 9e9 at six. */
static void vectors_are_orthonormal_in_stiffness(void **)
{
    ritz_scene scene = {0};
    ritz_stage stage = {0};
    ritz_comparison c = {0};
    ritz_dense V = {0}, K = {0};
    int64_t moments = 0;

    reduce(5, "", &scene, &stage, &c);
    assert_ok(ritz_system_krylov(&c.first_system.configuration[0], 8, true, &V,
                                 &moments));
    assert_ok(
        ritz_dense_congruence(&c.first_system.configuration[0].K, &V, &K));
    for (int64_t j = 0; j < K.ncol; j++)
        for (int64_t i = 0; i < K.ncol; i++)
            assert_near(ritz_dense_col(&K, j)[i], i == j, 1e-13);
    ritz_dense_free(&V);
    ritz_dense_free(&K);
    free_all(&scene, &stage, &c);
}

/* Body B alone is free: its rigid motion stays, moments are of the rest. */
static void rigid_modes_are_kept_beside_the_vectors(void **)
{
    ritz_scene scene = {0};
    ritz_stage stage = {0};
    ritz_comparison c = {0};

    assert_ok(beams_stage(false,
                          "inputs: [{name: u, at: B/n4, component: 2}]\n"
                          "outputs: [{name: y, at: B/n3, component: 6}]\n"
                          "select: {by: krylov, vectors: 2}\n",
                          &scene, &stage));
    scene.num_joints = 0;
    assert_ok(ritz_compare(&stage, &c));
    scene.num_joints = 1;
    assert_int_equal(c.row[0].num_rigid, 3);
    assert_int_equal(c.second_system.configuration[0].num_rigid, 3);
    assert_int_equal(c.V[0].ncol, 0); /* nothing moves A */
    assert_int_equal(c.V[1].ncol, 5);
    assert_int_equal(c.row[0].num_moments, 2);
    assert_true(c.row[0].moment_error < 1e-10);
    free_all(&scene, &stage, &c);
}

static void vectors_that_no_input_drives_are_refused(void **)
{
    ritz_scene scene = {0};
    ritz_stage stage = {0};
    ritz_comparison c = {0};

    make("select: {by: krylov, vectors: 3}\n", &scene, &stage);
    for (int64_t k = 0; k < stage.num_coordinates; k++)
        stage.io.B.val[k] = 0.0;
    assert_fails(
        ritz_compare(&stage, &c), RITZ_ERR_ARGUMENT,
        "no flexible mode is controllable by an input, so there is no Krylov "
        "vector");
    free_all(&scene, &stage, &c);
}

static void no_allocation_failure_leaks(void **)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};

    make("select: {by: krylov, vectors: 3, start: both}\n", &scene, &stage);
    assert_survives_every_allocation(compared_anew(&stage));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(frequencies_are_those_published),
    cmocka_unit_test(moments_are_those_published),
    cmocka_unit_test(the_first_moments_are_kept_and_no_more),
    cmocka_unit_test(the_sequence_ends_where_its_space_does),
    cmocka_unit_test(vectors_are_orthonormal_in_stiffness),
    cmocka_unit_test(rigid_modes_are_kept_beside_the_vectors),
    cmocka_unit_test(vectors_that_no_input_drives_are_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(krylov_system, tests, NULL, NULL)
