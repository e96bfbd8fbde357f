/* COMPARE on the dual-spin spacecraft, whose modes move with the clock
   angle. */
#include "testing.h"

#include "dualspin.h"

#include <ritz/assembly.h>
#include <ritz/matrix.h>

#include <math.h>
#include <stdlib.h>

typedef struct fixture {
    ritz_scene scene;
    ritz_stage stage;
    ritz_comparison c;
} fixture;

static int set_up(void **state)
{
    static fixture f;

    *state = &f;
    if (!dualspin_is_there())
        return 0;
    assert_ok(dualspin_stage(&f.scene, &f.stage));
    assert_ok(ritz_compare(&f.stage, &f.c));
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;

    ritz_comparison_free(&f->c);
    ritz_stage_free(&f->stage);
    ritz_scene_free(&f->scene);
    return 0;
}

/* As ritz_stop: false as often as the context says, and then true. */
static bool is_enough(void *context)
{
    int *left = context;

    return --*left < 0;
}

static void assert_same_systems(int64_t count, const ritz_system *a,
                                const ritz_system *b)
{
    for (int64_t k = 0; k < count; k++) {
        const ritz_dense *K = &a->configuration[k].K;

        assert_string_equal(a->configuration[k].at, b->configuration[k].at);
        assert_int_equal(K->ncol, b->configuration[k].K.ncol);
        assert_memory_equal(K->val, b->configuration[k].K.val,
                            (size_t)(K->ncol * K->ncol) * sizeof *K->val);
    }
}

/* Compare the first configurations of the fixture alone. */
static ritz_status compare_first(const fixture *f, int64_t count,
                                 ritz_comparison *out)
{
    ritz_scene scene = f->scene;
    ritz_stage stage = f->stage;
    ritz_status status = RITZ_OK;

    scene.num_configurations = count;
    stage.scene = &scene;
    status = ritz_compare(&stage, out);
    out->second.scene = &f->scene;
    return status;
}

/* Stopped in stage one, after 3 of 6 configurations: what is left is the
   comparison of a scene with these three. */
static void a_stopped_first_stage_leaves_a_scene_of_fewer_angles(void **state)
{
    const fixture *f = *state;
    int left = 2;
    const ritz_stop stop = {is_enough, &left};
    RITZ_OWN(ritz_comparison) c = {0}, three = {0};

    dualspin_or_skip();
    assert_ok(ritz_compare_until(&f->stage, &stop, &c));
    assert_true(c.interrupted);
    assert_int_equal(c.num_composed, 3);
    assert_int_equal(c.num_rows, 3);
    assert_int_equal(c.second_system.num_configurations, 3);
    assert_ptr_equal(c.second.scene, &f->scene);
    assert_ok(compare_first(f, 3, &three));
    assert_same_systems(3, &c.first_system, &three.first_system);
    assert_same_systems(3, &c.second_system, &three.second_system);
    for (int k = 0; k < 3; k++)
        assert_true(c.row[k].listed &&
                    c.row[k].response_error == three.row[k].response_error);
}

/* Stopped between angles, or while errors are measured: bodies keep modes of
   all six configurations, and each configuration that is left is that of the
   whole comparison, with its errors. */
static void later_stops_leave_configurations_as_they_would_be(void **state)
{
    static const struct {
        int asked;     /* 5 times in stage one, 6 between, 11 for errors */
        int64_t rows;  /* left */
        int64_t there; /* configurations in the system */
    } cases[] = {{5, 6, 6}, {7, 8, 6}, {11, 1, 1}, {13, 3, 3}, {18, 8, 6}};
    const fixture *f = *state;

    dualspin_or_skip();
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        int left = cases[k].asked;
        const ritz_stop stop = {is_enough, &left};
        RITZ_OWN(ritz_comparison) c = {0};

        assert_ok(ritz_compare_until(&f->stage, &stop, &c));
        assert_true(c.interrupted);
        assert_int_equal(c.num_composed, 6);
        assert_int_equal(c.num_rows, cases[k].rows);
        assert_int_equal(c.second_system.num_configurations, cases[k].there);
        assert_same_systems(cases[k].there, &c.second_system,
                            &f->c.second_system);
        for (int64_t i = 0; i < c.num_rows; i++)
            assert_true(c.row[i].response_error == f->c.row[i].response_error);
    }
}

/* By three threads, stopped or not: the same bits as by one. */
static void threads_change_neither_bits_nor_stops(void **state)
{
    const fixture *f = *state;
    RITZ_OWN(ritz_comparison) c = {0};

    dualspin_or_skip();
    ritz_set_threads(3);
    assert_ok(ritz_compare(&f->stage, &c));
    a_stopped_first_stage_leaves_a_scene_of_fewer_angles(state);
    later_stops_leave_configurations_as_they_would_be(state);
    ritz_set_threads(1);
    assert_int_equal(c.num_rows, f->c.num_rows);
    assert_same_systems(6, &c.first_system, &f->c.first_system);
    assert_same_systems(6, &c.second_system, &f->c.second_system);
    for (int64_t i = 0; i < c.num_rows; i++)
        assert_true(c.row[i].response_error == f->c.row[i].response_error);
}

static void a_comparison_that_is_not_stopped_is_whole(void **state)
{
    const fixture *f = *state;
    int left = 22;
    const ritz_stop stop = {is_enough, &left};
    RITZ_OWN(ritz_comparison) c = {0};

    dualspin_or_skip();
    assert_ok(ritz_compare_until(&f->stage, &stop, &c));
    assert_int_equal(left, 0); /* it was asked 22 times */
    assert_false(c.interrupted);
    assert_int_equal(c.num_rows, f->c.num_rows);
    assert_same_systems(6, &c.second_system, &f->c.second_system);
}

/* 6 + 22 + 6 and 6 + 4 + 12 vectors; ten constraints, eight rigid modes. */
static void the_first_stage_has_the_orders_of_its_bases(void **state)
{
    fixture *f = *state;
    const ritz_system *system = &f->c.first_system;

    dualspin_or_skip();
    assert_int_equal(system->component[0].order_full, 243);
    assert_int_equal(system->component[1].order_full, 57);
    assert_int_equal(system->component[2].order_full, 6);
    assert_int_equal(system->component[0].order, 34);
    assert_int_equal(system->component[1].order, 22);
    assert_int_equal(system->component[2].order, 6);
    for (int k = 0; k < 6; k++) {
        assert_int_equal(system->configuration[k].rank, 10);
        assert_int_equal(system->configuration[k].num_rigid, 8);
    }
}

/* Within c eps lambda_max / lambda_k, c = 20 e: see compare_measure.c. */
static void kept_modes_are_exact_at_every_listed_angle(void **state)
{
    fixture *f = *state;

    dualspin_or_skip();
    for (int64_t k = 0; k < 6; k++) {
        const ritz_compare_row *row = &f->c.row[k];

        assert_true(row->listed && row->num_kept > 8);
        assert_true(row->frequency_error <= row->allowed);
        assert_true(row->allowed < 1e-6);
        assert_near(row->mac, 1.0, 1e-8); /* measured: 1e-12 */
    }
}

/* Every listed row by hand: some mode of stage two has the frequency. */
static void kept_frequencies_are_found_in_the_second_system(void **state)
{
    fixture *f = *state;

    dualspin_or_skip();
    for (int64_t k = 0; k < 6; k++) {
        const ritz_configuration *one = &f->c.first_system.configuration[k];
        const ritz_configuration *two = &f->c.second_system.configuration[k];

        for (int64_t j = 0; j < f->c.row[k].num_kept; j++) {
            double lambda = one->lambda[one->num_rigid + f->c.row[k].kept[j]];
            double nearest = HUGE_VAL;

            for (int64_t i = two->num_rigid; i < two->K.ncol; i++)
                nearest = fmin(nearest, fabs(two->lambda[i] / lambda - 1.0));
            assert_true(nearest <= 2.0 * f->c.row[k].allowed *
                                       one->lambda[one->K.ncol - 1] / lambda);
        }
    }
}

static void rigid_modes_stay_rigid(void **state)
{
    fixture *f = *state;

    dualspin_or_skip();
    for (int64_t k = 0; k < 6; k++) {
        assert_int_equal(f->c.second_system.configuration[k].num_rigid, 8);
        /* sqrt(eps lambda_max) / 2 pi of the stage-1 system is 1e-5 Hz */
        assert_true(f->c.row[k].rigid_error < 1e-4);
    }
}

static void flexible_static_gain_is_exact_after_augmentation(void **state)
{
    fixture *f = *state;

    dualspin_or_skip();
    for (int64_t k = 0; k < 6; k++)
        assert_true(f->c.row[k].gain_error <= 1e-9);
}

static void the_second_stage_removes_vectors(void **state)
{
    fixture *f = *state;

    dualspin_or_skip();
    assert_true(f->c.removed);
    assert_true(f->c.V[0].ncol < 34);
    assert_int_equal(f->c.V[2].ncol, 6);
    assert_true(f->c.second_system.configuration[0].K.ncol <
                f->c.first_system.configuration[0].K.ncol);
}

/* Six angles and the five between neighbours, and the one that closes. */
static void errors_are_known_between_angles_too(void **state)
{
    fixture *f = *state;

    dualspin_or_skip();
    assert_int_equal(f->c.num_rows, 12);
    assert_near(f->c.row[6].setting[0], 30.0, 1e-12);
    assert_near(f->c.row[11].setting[0], 330.0, 1e-12);
    for (int64_t k = 6; k < 12; k++) {
        assert_false(f->c.row[k].listed);
        assert_true(isnan(f->c.row[k].allowed));
        assert_true(f->c.row[k].num_kept > 0);
        assert_true(f->c.row[k].frequency_error < 1e-7); /* measured 1e-9 */
    }
}

/* Without static correction the gain misses what was truncated. */
static void without_augmentation_the_gain_is_wrong(void **state)
{
    fixture *f = *state;
    RITZ_OWN(ritz_comparison) c = {0};

    dualspin_or_skip();
    f->scene.augment = RITZ_AUGMENT_NONE;
    assert_ok(ritz_compare(&f->stage, &c));
    f->scene.augment = RITZ_AUGMENT_SYSTEM;
    assert_true(c.row[0].gain_error > 1e-9);
}

/* A composite of one angle is exact there and smaller, and wrong elsewhere. */
static void a_reference_angle_is_exact_there_alone(void **state)
{
    fixture *f = *state;
    RITZ_OWN(ritz_comparison) c = {0};
    int64_t reference[] = {5};

    dualspin_or_skip();
    f->scene.num_reference = 1;
    f->scene.reference = reference;
    assert_ok(ritz_compare(&f->stage, &c));
    f->scene.num_reference = 0;
    f->scene.reference = NULL;
    assert_true(c.V[0].ncol < f->c.V[0].ncol);
    assert_true(c.row[5].frequency_error <= c.row[5].allowed);
    assert_true(c.row[5].gain_error <= 1e-9);
    assert_true(c.row[1].frequency_error > c.row[1].allowed);
}

/* Everything kept: stage two has nothing to remove, and says so. */
static void keeping_everything_removes_nothing(void **state)
{
    fixture *f = *state;
    RITZ_OWN(ritz_comparison) c = {0};
    double tolerance = f->scene.select_tolerance;

    dualspin_or_skip();
    f->scene.select_tolerance = 0.0;
    assert_ok(ritz_compare(&f->stage, &c));
    f->scene.select_tolerance = tolerance;
    assert_false(c.removed);
}

static void a_looser_tolerance_gives_smaller_bodies(void **state)
{
    fixture *f = *state;
    RITZ_OWN(ritz_comparison) c = {0};
    double tolerance = f->scene.composite_tolerance;

    dualspin_or_skip();
    f->scene.composite_tolerance = 1e-3;
    assert_ok(ritz_compare(&f->stage, &c));
    f->scene.composite_tolerance = tolerance;
    assert_true(c.V[0].ncol < f->c.V[0].ncol);
    for (int64_t k = 0; k < 6; k++) { /* blurred modes, exact gain */
        assert_true(c.row[k].frequency_error > c.row[k].allowed);
        assert_true(c.row[k].gain_error <= 1e-9);
        assert_int_equal(c.second_system.configuration[k].num_rigid, 8);
    }
}

/* Largest error of a kept mode against the nearest mode of stage two. */
static double largest_error(const ritz_comparison *c, int64_t k)
{
    const ritz_configuration *one = &c->first_system.configuration[k];
    const ritz_configuration *two = &c->second_system.configuration[k];
    double largest = 0.0;

    for (int64_t i = 0; i < c->row[k].num_kept; i++) {
        double lambda = one->lambda[one->num_rigid + c->row[k].kept[i]];
        double least = HUGE_VAL;

        for (int64_t j = two->num_rigid; j < two->K.ncol; j++)
            least = fmin(least, fabs(sqrt(two->lambda[j] / lambda) - 1.0));
        largest = fmax(largest, least);
    }
    return largest;
}

/* Blurred modes, all beyond rounding: no worse one stands behind the figure. */
static void the_frequency_error_is_the_largest(void **state)
{
    fixture *f = *state;
    RITZ_OWN(ritz_comparison) c = {0};
    double tolerance = f->scene.composite_tolerance;

    dualspin_or_skip();
    f->scene.composite_tolerance = 1e-3;
    assert_ok(ritz_compare(&f->stage, &c));
    f->scene.composite_tolerance = tolerance;
    for (int64_t k = 0; k < 6; k++)
        assert_near(c.row[k].frequency_error, largest_error(&c, k), 1e-12);
}

/* Without inputs and damping there is no gain, response or damping ratio to
   measure, and no record holds a zero in its place. */
static void what_was_not_measured_is_not_recorded(void **state)
{
    fixture *f = *state;
    RITZ_OWN(ritz_comparison) c = {0};
    int64_t inputs = f->scene.num_inputs;
    ritz_damping_kind damping = f->scene.damping.kind;

    dualspin_or_skip();
    assert_int_equal(f->c.second.body[0].errors.count, 4);
    f->scene.num_inputs = 0;
    f->scene.damping.kind = RITZ_DAMPING_NONE;
    assert_ok(ritz_compare(&f->stage, &c));
    f->scene.num_inputs = inputs;
    f->scene.damping.kind = damping;
    for (int64_t k = 0; k < c.second.count; k++) {
        const ritz_measures *errors = &c.second.body[k].errors;

        assert_int_equal(errors->count, 1);
        assert_string_equal(errors->item[0].name, "stage1-frequency-relative");
    }
}

/* Ranking needs damping; none in scene or matrices is refused in words. */
static void a_ranking_without_damping_is_refused(void **state)
{
    fixture *f = *state;
    ritz_comparison none = {0};
    ritz_damping kept = f->scene.damping;

    dualspin_or_skip();
    f->scene.damping = (ritz_damping){0};
    assert_int_equal(ritz_compare(&f->stage, &none), RITZ_ERR_ARGUMENT);
    f->scene.damping = kept;
    assert_non_null(strstr(ritz_error_message(), "damping"));
    strcpy(f->scene.select_by, "hankle");
    assert_int_equal(ritz_compare(&f->stage, &none), RITZ_ERR_ARGUMENT);
    strcpy(f->scene.select_by, "hankel");
    assert_non_null(strstr(ritz_error_message(), "hankle"));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_stopped_first_stage_leaves_a_scene_of_fewer_angles),
    cmocka_unit_test(later_stops_leave_configurations_as_they_would_be),
    cmocka_unit_test(threads_change_neither_bits_nor_stops),
    cmocka_unit_test(a_comparison_that_is_not_stopped_is_whole),
    cmocka_unit_test(the_first_stage_has_the_orders_of_its_bases),
    cmocka_unit_test(kept_modes_are_exact_at_every_listed_angle),
    cmocka_unit_test(kept_frequencies_are_found_in_the_second_system),
    cmocka_unit_test(rigid_modes_stay_rigid),
    cmocka_unit_test(flexible_static_gain_is_exact_after_augmentation),
    cmocka_unit_test(the_second_stage_removes_vectors),
    cmocka_unit_test(errors_are_known_between_angles_too),
    cmocka_unit_test(without_augmentation_the_gain_is_wrong),
    cmocka_unit_test(a_reference_angle_is_exact_there_alone),
    cmocka_unit_test(keeping_everything_removes_nothing),
    cmocka_unit_test(a_looser_tolerance_gives_smaller_bodies),
    cmocka_unit_test(the_frequency_error_is_the_largest),
    cmocka_unit_test(what_was_not_measured_is_not_recorded),
    cmocka_unit_test(a_ranking_without_damping_is_refused),
};

TEST_MODULE(compare, tests, set_up, tear_down)
