/*
 * COMPACT drops the component vectors that make extraneous modes. Kept modes,
 * responses, rigid motion and static gain change by no more than the scene
 * allows, the bodies have fewer coordinates, and the modes do not return in
 * another assembly.
 */
#include "testing.h"

#include "beams.h"
#include "compared.h"
#include "dualspin.h"
#include "matrices.h"

#include <ritz/assembly.h>
#include <ritz/matrix.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct fixture {
    ritz_scene scene;
    ritz_stage stage;
    ritz_comparison kept, compact; /* without and with COMPACT */
} fixture;

static int set_up(void **state)
{
    static fixture f;

    *state = &f;
    if (!dualspin_is_there())
        return 0;
    assert_ok(dualspin_stage(&f.scene, &f.stage));
    assert_ok(ritz_compare(&f.stage, &f.kept));
    f.scene.extraneous = RITZ_EXTRANEOUS_COMPACT;
    f.scene.extraneous_tolerance = 1e-3;
    assert_ok(ritz_compare(&f.stage, &f.compact));
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;

    ritz_comparison_free(&f->kept);
    ritz_comparison_free(&f->compact);
    ritz_stage_free(&f->stage);
    ritz_scene_free(&f->scene);
    return 0;
}

static void bodies_and_systems_lose_as_many_coordinates(void **state)
{
    fixture *f = *state;
    int64_t dropped = f->compact.dropped;

    dualspin_or_skip();
    assert_true(dropped >= 6); /* measured: 8 */
    assert_int_equal(f->kept.dropped, 0);
    assert_int_equal(f->compact.second.num_coordinates,
                     f->kept.second.num_coordinates - dropped);
    for (int64_t k = 0; k < 6; k++) {
        const ritz_compare_row *before = &f->kept.row[k];
        const ritz_compare_row *after = &f->compact.row[k];

        assert_int_equal(after->num_kept, before->num_kept);
        assert_int_equal(after->order, before->order - dropped);
        assert_int_equal(after->num_strays, before->num_strays - dropped);
        for (int64_t i = 0; i < after->num_strays; i++)
            assert_false(after->stray[i].removed);
    }
}

static void what_is_kept_changes_within_the_tolerance(void **state)
{
    fixture *f = *state;
    double worst = 0.0;

    dualspin_or_skip();
    for (int64_t k = 0; k < 6; k++) {
        const ritz_compare_row *row = &f->compact.row[k];

        assert_true(row->frequency_error <= 1e-3);
        assert_true(row->response_error <= 1e-3);
        assert_near(row->allowed, 1e-3, 1e-15);
        assert_true(row->mac >= 1.0 - 1e-3);
        worst = fmax(worst, row->response_error);
    }
    assert_true(worst > 1e-5); /* dropping costs accuracy */
    assert_true(f->compact.next_drop > 1e-3);
}

static void rigid_motion_and_static_gain_are_not_touched(void **state)
{
    fixture *f = *state;

    dualspin_or_skip();
    for (int64_t k = 0; k < 6; k++) {
        assert_int_equal(f->compact.second_system.configuration[k].num_rigid,
                         8);
        assert_true(f->compact.row[k].rigid_error < 1e-4);
        assert_true(f->compact.row[k].gain_error < 1e-9);
    }
}

/* The largest entry of V'MV - I, which is rounding times the condition of M. */
static double lack_of_unity(const ritz_dense *M, const ritz_dense *V)
{
    RITZ_OWN(ritz_dense) MV = {0}, gram = {0};

    assert_ok(ritz_dense_mul(M, V, &MV));
    assert_ok(ritz_dense_mul_tn(V, &MV, &gram));
    for (int64_t j = 0; j < gram.ncol; j++)
        ritz_dense_col(&gram, j)[j] -= 1.0;
    return ritz_dense_max(&gram);
}

/*
 * Each V consists of combinations of at most 31 columns of the previous V, so
 * that its V'MV - I is at most 31 times that of the previous one.
 */
static void smaller_subspaces_lie_in_the_larger_ones(void **state)
{
    fixture *f = *state;

    dualspin_or_skip();
    for (int64_t c = 0; c < 2; c++) {
        const ritz_dense *before = &f->kept.V[c], *after = &f->compact.V[c];
        const ritz_dense *M = &f->stage.body[c].M;
        double bound = 31.0 * lack_of_unity(M, before);
        RITZ_OWN(ritz_dense) MV = {0}, share = {0};

        assert_true(bound < 1e-6);
        assert_true(lack_of_unity(M, after) <= bound);
        assert_ok(ritz_dense_mul(M, after, &MV));
        assert_ok(ritz_dense_mul_tn(before, &MV, &share));
        for (int64_t j = 0; j < share.ncol; j++) {
            double length = 0.0;

            for (int64_t i = 0; i < share.nrow; i++)
                length = hypot(length, ritz_dense_col(&share, j)[i]);
            assert_near(length, 1.0, bound);
        }
    }
}

/* Assembled at an angle that the scene does not list, the compact bodies have
   as few coordinates: those of the bodies less the rank of the joints. */
static void what_is_dropped_does_not_come_back(void **state)
{
    fixture *f = *state;
    const double setting[] = {37.0, 0.0};
    ritz_configuration at = {0};

    dualspin_or_skip();
    assert_ok(ritz_stage_assemble(&f->compact.second, setting, &at));
    assert_int_equal(at.K.ncol, f->compact.second.num_coordinates - at.rank);
    assert_int_equal(at.K.ncol, f->compact.row[0].order);
    ritz_configuration_free(&at);
}

/* Bodies of looser composite tolerances are made compact too, each from its own
   composite set. */
static void composite_tolerances_are_made_compact(void **state)
{
    static const double tolerance[] = {1e-6, 1e-3};
    fixture *f = *state;
    ritz_tolerance_row *row = NULL;

    dualspin_or_skip();
    assert_ok(
        ritz_compare_tolerances(&f->stage, &f->compact, 2, tolerance, &row));
    assert_true(row[0].total <= f->compact.second.num_coordinates);
    assert_true(row[1].total <= row[0].total);
    assert_true(row[0].response_error <= 1e-3);
    ritz_tolerances_free(2, &row);
}

/*
 * Four vectors of each half of the beam [McDaniel2000] represent four kept
 * modes: without any one of them a kept mode and its frequency are lost.
 */
static void what_kept_modes_need_is_not_dropped(void **)
{
    compared f;

    compared_reduce(false, beams_io,
                    "band_hz: [0, 2]\nselect: {modes: [1, 2, 3, 5]}\n"
                    "extraneous: {fate: compact, tolerance: 0.01}\n",
                    &f);
    assert_int_equal(f.c.dropped, 0);
    assert_true(f.c.next_drop > 0.01);
    assert_int_equal(f.c.row[0].order, 6);
    assert_int_equal(f.c.row[0].num_strays, 2);
    compared_release(&f);
}

/* A scene without a band has no response: vectors are dropped by the errors of
   frequencies alone. */
static void frequencies_alone_are_compared_without_a_response(void **)
{
    compared f;

    compared_reduce(false, beams_io,
                    "select: {modes: [1, 2, 3, 4, 5, 6, 7, 8, 9]}\n"
                    "extraneous: compact\n",
                    &f);
    assert_near(f.scene.extraneous_tolerance, 1e-3, 1e-18);
    assert_true(f.c.row[0].frequency_error <= 1e-3);
    assert_true(isnan(f.c.row[0].response_error));
    assert_true(f.c.dropped > 0 || f.c.next_drop > 1e-3);
    assert_int_equal(f.c.row[0].order, 9 + f.c.row[0].num_strays);
    compared_release(&f);
}

static void fates_that_make_no_sense_are_refused(void **)
{
    static const struct {
        const char *choice, *words;
    } cases[] = {
        {"extraneous: {tolerance: 0.1}\n", "key 'fate' is missing"},
        {"extraneous: {fate: remove, tolerance: 0.1}\n",
         "a tolerance goes with 'fate: compact' alone"},
        {"extraneous: {fate: compact, tolerance: 1}\n", "between 0 and 1"},
        {"extraneous: compcat\n",
         "unknown fate of extraneous modes 'compcat', is 'compact' meant?"},
        {"select: {by: krylov, vectors: 2}\nextraneous: compact\n",
         "Krylov vectors keep moments, not modes, so no mode is extraneous"},
    };

    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        ritz_scene scene = {0};
        ritz_stage stage = {0};
        char tail[1024];

        snprintf(tail, sizeof tail, "%s%s", beams_io, cases[k].choice);
        assert_fails(beams_stage(false, tail, &scene, &stage), RITZ_ERR_FORMAT,
                     cases[k].words);
    }
}

static void no_allocation_failure_leaks(void **)
{
    compared f;

    compared_reduce(false, beams_io,
                    "band_hz: [0, 0.3]\ndamping: {modal: 0.01}\n"
                    "select: {modes: [1, 3]}\nextraneous: compact\n",
                    &f);
    assert_survives_every_allocation(compared_anew(&f.stage));
    compared_release(&f);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(bodies_and_systems_lose_as_many_coordinates),
    cmocka_unit_test(what_is_kept_changes_within_the_tolerance),
    cmocka_unit_test(rigid_motion_and_static_gain_are_not_touched),
    cmocka_unit_test(smaller_subspaces_lie_in_the_larger_ones),
    cmocka_unit_test(what_is_dropped_does_not_come_back),
    cmocka_unit_test(composite_tolerances_are_made_compact),
    cmocka_unit_test(what_kept_modes_need_is_not_dropped),
    cmocka_unit_test(frequencies_alone_are_compared_without_a_response),
    cmocka_unit_test(fates_that_make_no_sense_are_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(compact, tests, set_up, tear_down)
