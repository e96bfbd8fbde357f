/* The composite set in order: what its first directions hold. */
#include "testing.h"

#include "dualspin.h"
#include "scenes.h"

#include <ritz/assembly.h>
#include <ritz/matrix.h>

#include <float.h>
#include <stdlib.h>

/* The clamped beam of two components, each with all of its modes. */
static void open_beams(double band, ritz_scene *scene, ritz_stage *stage)
{
    assert_ok(scene_of_two_beams(false, scene));
    scene->band_hz[1] = band;
    scene->select = RITZ_SELECT_BAND;
    assert_ok(stage_of_two_beams(scene, &ritz_method_full, -1, stage));
}

/* Modes up to a frequency that do not move rigidly. */
static int64_t count_band(const ritz_configuration *c, double hertz)
{
    int64_t count = 0;

    for (int64_t k = c->num_rigid; k < c->K.ncol; k++)
        count += c->lambda[k] <= ritz_eigen_lambda(hertz);
    return count;
}

/* The bodies in their rigid motions and the first `count` directions. */
static void cut(const ritz_stage *stage, const ritz_composite *composite,
                int64_t count, ritz_stage *out)
{
    ritz_reduced *body = calloc((size_t)stage->count, sizeof *body);

    assert_non_null(body);
    for (int64_t b = 0; b < stage->count; b++) {
        int64_t all = composite->V[b].ncol;
        int64_t first = composite->rigid[b] + count;
        ritz_dense V = {0};

        assert_ok(ritz_dense_columns(&composite->V[b], 0,
                                     first < all ? first : all, &V));
        assert_ok(ritz_reduced_project(&stage->body[b], &V, &body[b]));
        ritz_dense_free(&V);
    }
    assert_ok(ritz_stage_from(stage->scene, body, out));
    free(body);
}

/*
 * At one configuration the directions of m modes are m at most, and the modes
 * are motions of the bodies in them: Rayleigh-Ritz returns their frequencies,
 * to what rounding allows, 20 e eps lambda_max / lambda (compare_measure.c).
 */
static void the_modes_of_the_band_are_in_as_many_directions(void **)
{
    const double band = 0.5;
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0}, second = {0};
    RITZ_OWN(ritz_composite) composite = {0};
    RITZ_OWN(ritz_configuration) one = {0}, two = {0};
    int64_t count = 0;

    open_beams(band, &scene, &stage);
    assert_ok(ritz_composite_new(&stage, &composite));
    assert_ok(ritz_stage_assemble(&stage, NULL, &one));
    count = count_band(&one, band);
    assert_true(count > 2 && count < composite.V[0].ncol);
    cut(&stage, &composite, count, &second);
    assert_ok(ritz_stage_assemble(&second, NULL, &two));
    assert_int_equal(two.num_rigid, one.num_rigid);
    for (int64_t k = one.num_rigid; k < one.num_rigid + count; k++) {
        double least = HUGE_VAL;

        for (int64_t j = two.num_rigid; j < two.K.ncol; j++)
            least = fmin(least, fabs(two.lambda[j] / one.lambda[k] - 1.0));
        assert_true(least <= 20.0 * (double)one.K.ncol * DBL_EPSILON *
                                 one.lambda[one.K.ncol - 1] / one.lambda[k]);
    }
    ritz_configuration_free(&two);
    ritz_stage_free(&second);
}

/* V' (M + K / lambda) V = I, to the rounding of the factor of M + K / lambda,
   eps times a condition of 1e6 or so (measured). */
static void directions_are_orthonormal_by_energy(void **)
{
    const double band = 0.5;
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_composite) composite = {0};

    open_beams(band, &scene, &stage);
    assert_ok(ritz_composite_new(&stage, &composite));
    for (int64_t b = 0; b < 2; b++) {
        ritz_dense K = {0}, M = {0};

        assert_ok(ritz_dense_congruence(&stage.body[b].K, &composite.V[b], &K));
        assert_ok(ritz_dense_congruence(&stage.body[b].M, &composite.V[b], &M));
        for (int64_t j = 0; j < K.ncol; j++)
            for (int64_t i = 0; i < K.ncol; i++) {
                double e = ritz_dense_col(&M, j)[i] +
                           ritz_dense_col(&K, j)[i] / ritz_eigen_lambda(band);

                assert_near(e, i == j ? 1.0 : 0.0, 1e-10);
            }
        ritz_dense_free(&K);
        ritz_dense_free(&M);
    }
}

/* Every direction of every body has one step; none is left over. */
static void steps_are_all_directions_of_all_bodies(void **)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_composite) composite = {0};
    int64_t steps[2] = {0};

    open_beams(0.5, &scene, &stage);
    assert_ok(ritz_composite_new(&stage, &composite));
    for (int64_t t = 0; t < composite.num_steps; t++)
        steps[composite.step[t]]++;
    for (int64_t b = 0; b < 2; b++) {
        assert_int_equal(composite.V[b].ncol, stage.body[b].K.ncol);
        assert_int_equal(steps[b], composite.V[b].ncol - composite.rigid[b]);
    }
}

/* How long the modes of the band are along a direction of a body, by energy. */
static double carried(const ritz_reduced *body, const ritz_configuration *at,
                      int64_t b, double lambda, const double *v)
{
    double sum = 0.0;

    for (int64_t k = at->num_rigid; k < at->K.ncol; k++) {
        const double *w = ritz_dense_col(&at->P[b], k);
        double product = 0.0;

        for (int64_t j = 0; j < body->K.ncol && at->lambda[k] <= lambda; j++)
            for (int64_t i = 0; i < body->K.ncol; i++)
                product += v[i] * w[j] *
                           (ritz_dense_col(&body->M, j)[i] +
                            ritz_dense_col(&body->K, j)[i] / lambda);
        sum += product * product;
    }
    return sqrt(sum);
}

/* Those are the singular values: they fall from step to step, but for the first
   of each body; 1e-9 is the least of the largest that is no rounding. */
static void steps_go_from_what_carries_most(void **)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_composite) composite = {0};
    RITZ_OWN(ritz_configuration) at = {0};
    int64_t used[2] = {0};
    double before = HUGE_VAL;

    open_beams(0.5, &scene, &stage);
    assert_ok(ritz_composite_new(&stage, &composite));
    assert_ok(ritz_stage_assemble(&stage, NULL, &at));
    for (int64_t t = 0; t < composite.num_steps; t++) {
        int64_t b = composite.step[t];
        double now = carried(
            &stage.body[b], &at, b, ritz_eigen_lambda(0.5),
            ritz_dense_col(&composite.V[b], composite.rigid[b] + used[b]));

        if (used[b]++ == 0)
            continue;
        assert_true(now <= before * (1.0 + 1e-9) + 1e-9);
        before = now;
    }
    assert_true(used[0] > 2 && used[1] > 2);
}

/* Joined to a wall a body has no rigid motion of the system, and would not
   move: each has its first direction before any has a second, however stiff. */
static void bodies_that_are_held_begin_with_one_direction_each(void **)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_composite) composite = {0};
    ritz_dense *K = NULL;

    open_beams(0.5, &scene, &stage);
    K = &stage.body[0].K;
    for (int64_t k = 0; k < K->nrow * K->ncol; k++)
        K->val[k] *= 1e6;
    assert_ok(ritz_composite_new(&stage, &composite));
    for (int64_t b = 0; b < 2; b++)
        assert_int_equal(composite.rigid[b], 0);
    assert_true(composite.step[0] != composite.step[1]);
    assert_int_equal(composite.step[2], 1); /* all that moves is there */
}

/*
 * Weighed, what the gyro sees of the motor comes first: with as many directions
 * the static gain and the frequencies that matter are nearer. Here the first
 * directions alone are looked at: they differ.
 */
static void weights_change_what_comes_first(void **)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_composite) plain = {0}, weighed = {0};
    double most = 0.0;

    dualspin_or_skip();
    assert_ok(dualspin_stage(&scene, &stage));
    assert_ok(ritz_composite_new(&stage, &weighed));
    scene.select = RITZ_SELECT_BAND;
    assert_ok(ritz_composite_new(&stage, &plain));
    assert_int_equal(plain.rigid[0], 6);
    assert_int_equal(weighed.rigid[0], 6);
    for (int64_t i = 0; i < plain.V[0].nrow; i++)
        most = fmax(most, fabs(fabs(ritz_dense_col(&plain.V[0], 6)[i]) -
                               fabs(ritz_dense_col(&weighed.V[0], 6)[i])));
    assert_true(most > 1e-2);
    ritz_composite_free(&weighed);
}

static void without_a_band_it_is_refused(void **)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    ritz_composite none = {0};

    open_beams(0.0, &scene, &stage);
    assert_fails(ritz_composite_new(&stage, &none), RITZ_ERR_ARGUMENT,
                 "the scene has no band: which modes are to be kept");
}

static ritz_status order_anew(const ritz_stage *stage)
{
    ritz_composite composite = {0};
    ritz_status status = ritz_composite_new(stage, &composite);

    ritz_composite_free(&composite);
    return status;
}

static void ordering_survives_every_allocation(void **)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};

    open_beams(1.5, &scene, &stage);
    assert_survives_every_allocation(order_anew(&stage));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_modes_of_the_band_are_in_as_many_directions),
    cmocka_unit_test(directions_are_orthonormal_by_energy),
    cmocka_unit_test(steps_are_all_directions_of_all_bodies),
    cmocka_unit_test(steps_go_from_what_carries_most),
    cmocka_unit_test(bodies_that_are_held_begin_with_one_direction_each),
    cmocka_unit_test(weights_change_what_comes_first),
    cmocka_unit_test(without_a_band_it_is_refused),
    cmocka_unit_test(ordering_survives_every_allocation),
};

TEST_MODULE(composite_order, tests, NULL, NULL)
