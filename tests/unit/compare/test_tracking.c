/*
 * Modes followed over configurations: systems of one body with unit mass, whose
 * modes are given; two oscillators that avoid each other, in closed form; and
 * the dual-spin spacecraft.
 */
#include "testing.h"

#include "dualspin.h"

#include <ritz/assembly.h>
#include <ritz/matrix.h>

#include <stdlib.h>

enum { MOST = 4 }; /* configurations, and modes */

/* n modes of a body of n coordinates at each of some settings. */
typedef struct fixture {
    ritz_stage stage;
    ritz_reduced body;
    ritz_system system;
    ritz_configuration configuration[MOST];
    double setting[MOST][2];
    double lambda[MOST][MOST];
    ritz_dense P[MOST];
} fixture;

static void make(fixture *f, int n, int count)
{
    *f = (fixture){0};
    f->stage.count = 1;
    f->stage.body = &f->body;
    assert_ok(ritz_dense_new(n, n, &f->body.M));
    f->system.num_configurations = count;
    f->system.configuration = f->configuration;
    for (int j = 0; j < n; j++)
        ritz_dense_col(&f->body.M, j)[j] = 1.0;
    for (int k = 0; k < count; k++) {
        ritz_configuration *c = &f->configuration[k];

        assert_ok(ritz_dense_new(n, n, &f->P[k]));
        c->num_settings = 1;
        c->setting = f->setting[k];
        c->setting[0] = k;
        c->lambda = f->lambda[k];
        c->K.ncol = n;
        c->P = &f->P[k];
        c->num_blocks = 1;
        for (int j = 0; j < n; j++) {
            ritz_dense_col(&f->P[k], j)[j] = 1.0;
            f->lambda[k][j] = ritz_eigen_lambda(1.0 + j);
        }
    }
}

static void release(fixture *f)
{
    for (int k = 0; k < MOST; k++)
        ritz_dense_free(&f->P[k]);
    ritz_dense_free(&f->body.M);
}

/* Columns i and j of P of configuration k, turned by an angle in degrees. */
static void turn(fixture *f, int k, int i, int j, double degrees)
{
    double c = cos(degrees * acos(-1.0) / 180.0);
    double s = sin(degrees * acos(-1.0) / 180.0);

    for (int64_t q = 0; q < f->P[k].nrow; q++) {
        double a = ritz_dense_col(&f->P[k], i)[q];
        double b = ritz_dense_col(&f->P[k], j)[q];

        ritz_dense_col(&f->P[k], i)[q] = c * a + s * b;
        ritz_dense_col(&f->P[k], j)[q] = c * b - s * a;
    }
}

static int count_of(const ritz_tracking *t, ritz_track_kind kind)
{
    int count = 0;

    for (int64_t k = 0; k < t->num_events; k++)
        count += t->event[k].kind == kind;
    return count;
}

static void modes_that_stay_have_a_track_each(void **)
{
    ritz_tracking t = {0};
    fixture f;

    make(&f, 3, 3);
    turn(&f, 1, 0, 1, 10.0);
    for (int64_t q = 0; q < 3; q++) /* the sign of a mode says nothing */
        ritz_dense_col(&f.P[2], 1)[q] *= -1.0;
    assert_ok(ritz_track(&f.stage, &f.system, 0.0, &t));
    assert_int_equal(t.num_tracks, 3);
    assert_int_equal(t.num_events, 0);
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < 3; j++)
            assert_int_equal(t.track[t.first[k] + j], j);
    assert_true(isnan(t.mac[0]));
    assert_near(t.mac[t.first[1]], pow(cos(acos(-1.0) / 18.0), 2.0), 1e-15);
    ritz_tracking_free(&t);
    release(&f);
}

static void modes_that_change_places_are_reported(void **)
{
    ritz_tracking t = {0};
    fixture f;

    make(&f, 3, 2);
    turn(&f, 1, 0, 1, 90.0);
    assert_ok(ritz_track(&f.stage, &f.system, 0.0, &t));
    assert_int_equal(t.num_tracks, 3);
    assert_int_equal(t.track[t.first[1]], 1);
    assert_int_equal(t.track[t.first[1] + 1], 0);
    assert_int_equal(t.num_events, 1);
    assert_int_equal(t.event[0].kind, RITZ_TRACK_SWAP);
    assert_int_equal(t.event[0].from, 0);
    assert_int_equal(t.event[0].to, 1);
    assert_int_equal(t.event[0].mode[1], 1);
    assert_int_equal(t.event[0].other[0], 1);
    assert_near(t.event[0].hertz, 1.0, 1e-12);
    ritz_tracking_free(&t);
    /* nothing above the band is reported, and it is followed all the same */
    assert_ok(ritz_track(&f.stage, &f.system, 0.5, &t));
    assert_int_equal(t.num_events, 0);
    assert_int_equal(t.track[t.first[1]], 1);
    ritz_tracking_free(&t);
    release(&f);
}

/*
 * K(t) = [1 + t, c; c, 1 - t]: its vectors turn by atan2(c, t) / 2 as t passes
 * 0, where the frequencies come no nearer than sqrt(1 -+ c). In four steps of
 * 27, 36 and 27 degrees the two mix; in one of 90 they have changed places.
 */
static void oscillators_that_avoid_each_other_are_reported(void **)
{
    static const double t[MOST] = {-1.0, -0.25, 0.25, 1.0};
    const double c = 0.25;
    ritz_tracking tracks = {0};
    fixture f;

    make(&f, 2, 4);
    for (int k = 0; k < 4; k++) {
        double half = 0.5 * atan2(c, t[k]);
        double root = hypot(c, t[k]);

        ritz_dense_col(&f.P[k], 0)[0] = -sin(half);
        ritz_dense_col(&f.P[k], 0)[1] = cos(half);
        ritz_dense_col(&f.P[k], 1)[0] = cos(half);
        ritz_dense_col(&f.P[k], 1)[1] = sin(half);
        f.lambda[k][0] = 4.0 - root;
        f.lambda[k][1] = 4.0 + root;
    }
    assert_ok(ritz_track(&f.stage, &f.system, 0.0, &tracks));
    assert_int_equal(count_of(&tracks, RITZ_TRACK_SWAP), 0);
    assert_int_equal(count_of(&tracks, RITZ_TRACK_AVOIDED), 3);
    assert_near(tracks.event[0].shared, 1.0, 1e-15);
    ritz_tracking_free(&tracks);
    f.system.num_configurations = 2; /* from -1 to 1 at once */
    f.configuration[1] = f.configuration[3];
    assert_ok(ritz_track(&f.stage, &f.system, 0.0, &tracks));
    assert_int_equal(count_of(&tracks, RITZ_TRACK_SWAP), 1);
    ritz_tracking_free(&tracks);
    release(&f);
}

/* A pair of one frequency: whatever its basis, it is one track and no event. */
static void a_repeated_pair_is_one_track(void **)
{
    ritz_tracking t = {0};
    fixture f;

    make(&f, 4, 4);
    for (int k = 0; k < 4; k++) {
        turn(&f, k, 1, 2, 25.0 * k);
        f.lambda[k][2] = f.lambda[k][1] * (1.0 + 1e-9);
    }
    f.lambda[3][2] = ritz_eigen_lambda(2.5); /* apart at last, and still one */
    assert_ok(ritz_track(&f.stage, &f.system, 0.0, &t));
    assert_int_equal(t.num_events, 0);
    assert_int_equal(t.num_tracks, 3);
    for (int k = 0; k < 4; k++) {
        const int64_t *track = t.track + t.first[k];

        assert_int_equal(track[0], 0);
        assert_int_equal(track[1], 1);
        assert_int_equal(track[2], 1);
        assert_int_equal(track[3], 2);
        assert_int_equal(t.cluster[t.first[k] + 2], k < 3 ? 1 : 2);
        if (k > 0)
            assert_near(t.mac[t.first[k] + 1], 1.0, 1e-14);
    }
    ritz_tracking_free(&t);
    release(&f);
}

/* Two that cross are one track if they meet elsewhere: there is no order. */
static void what_happens_within_a_track_is_no_event(void **)
{
    ritz_tracking t = {0};
    fixture f;

    make(&f, 3, 3);
    turn(&f, 1, 0, 1, 90.0);
    turn(&f, 2, 0, 1, 90.0);
    f.lambda[2][1] = f.lambda[2][0];
    assert_ok(ritz_track(&f.stage, &f.system, 0.0, &t));
    assert_int_equal(t.num_tracks, 2);
    assert_int_equal(t.num_events, 0);
    ritz_tracking_free(&t);
    release(&f);
}

static void a_mode_that_is_half_like_two_is_a_near_tie(void **)
{
    ritz_tracking t = {0};
    fixture f;

    make(&f, 3, 2);
    turn(&f, 1, 0, 2, 44.0); /* MAC 0.517 and 0.483 */
    assert_ok(ritz_track(&f.stage, &f.system, 0.0, &t));
    assert_int_equal(count_of(&t, RITZ_TRACK_TIE), 2); /* of both modes */
    assert_int_equal(t.event[0].mode[0], 0);
    assert_int_equal(t.event[0].other[0], 0);
    assert_int_equal(t.event[0].other[1], 2);
    assert_near(t.event[0].mac[0] + t.event[0].mac[1], 1.0, 1e-14);
    ritz_tracking_free(&t);
    release(&f);
}

/*
 * I - 2 v v' with v = (1, 1, 1) / sqrt(3) spreads each mode over three, MAC
 * 1/9, 4/9 and 4/9: nothing is like it, and an angle between is wanted.
 */
static void a_mode_that_is_like_none_is_lost(void **)
{
    ritz_tracking t = {0};
    fixture f;

    make(&f, 3, 2);
    for (int k = 0; k < 9; k++)
        f.P[1].val[k] -= 2.0 / 3.0;
    assert_ok(ritz_track(&f.stage, &f.system, 0.0, &t));
    assert_int_equal(t.num_events, 3);
    assert_int_equal(count_of(&t, RITZ_TRACK_LOST), 3);
    assert_near(t.event[0].mac[0], 4.0 / 9.0, 1e-15);
    assert_int_equal(t.num_tracks, 6); /* three end, three begin */
    assert_true(isnan(t.mac[t.first[1]]));
    ritz_tracking_free(&t);
    release(&f);
}

/* Two sweeps, the last fastest: the row's first is next to that above it. */
static void a_configuration_goes_on_from_its_nearest(void **)
{
    static const double grid[MOST][2] = {{0, 0}, {0, 40}, {5, 0}, {5, 40}};
    ritz_tracking t = {0};
    fixture f;

    make(&f, 2, 4);
    for (int k = 0; k < 4; k++) {
        f.configuration[k].num_settings = 2;
        f.setting[k][0] = grid[k][0];
        f.setting[k][1] = grid[k][1];
    }
    assert_ok(ritz_track(&f.stage, &f.system, 0.0, &t));
    assert_int_equal(t.before[0], -1);
    assert_int_equal(t.before[1], 0);
    assert_int_equal(t.before[2], 0);
    assert_int_equal(t.before[3], 1); /* 5 away, not 40 */
    ritz_tracking_free(&t);
    release(&f);
}

/*
 * Modes 19 and 20 of the spacecraft cross between 60 and 120 degrees: 9.927 and
 * 10.286 become 10.371 and 9.694 Hz; all below 2.7 Hz keep their places.
 */
static void modes_of_the_spacecraft_cross_where_they_should(void **)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_system) system = {0};
    RITZ_OWN(ritz_tracking) t = {0};
    int found = 0;

    dualspin_or_skip();
    assert_ok(dualspin_stage(&scene, &stage));
    assert_ok(ritz_assemble(&stage, NULL, &system));
    assert_ok(ritz_track(&stage, &system, 10.0, &t));
    for (int64_t k = 0; k < t.num_events; k++) {
        const ritz_track_event *e = &t.event[k];

        found += e->kind == RITZ_TRACK_SWAP && e->from == 1 && e->to == 2 &&
                 e->mode[0] == 18 && e->mode[1] == 19;
        assert_true(e->hertz <= 10.0);
        assert_true(e->hertz > 2.7);
    }
    assert_int_equal(found, 1);
    for (int64_t k = 0; k < 6; k++)
        for (int64_t j = 0; j < 7; j++)
            assert_int_equal(t.track[t.first[k] + j], j);
}

static void one_configuration_has_nothing_to_say(void **)
{
    ritz_tracking t = {0};
    fixture f;

    make(&f, 2, 1);
    assert_ok(ritz_track(&f.stage, &f.system, 0.0, &t));
    assert_int_equal(t.num_tracks, 2);
    assert_int_equal(t.num_events, 0);
    ritz_tracking_free(&t);
    release(&f);
}

static ritz_status track_anew(const fixture *f)
{
    ritz_tracking t = {0};
    ritz_status status = ritz_track(&f->stage, &f->system, 0.0, &t);

    ritz_tracking_free(&t);
    return status;
}

static void no_allocation_failure_leaks(void **)
{
    fixture f;

    make(&f, 4, 4);
    turn(&f, 1, 0, 1, 90.0);
    turn(&f, 2, 0, 3, 45.0);
    turn(&f, 3, 1, 2, 60.0);
    assert_survives_every_allocation(track_anew(&f));
    release(&f);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(modes_that_stay_have_a_track_each),
    cmocka_unit_test(modes_that_change_places_are_reported),
    cmocka_unit_test(oscillators_that_avoid_each_other_are_reported),
    cmocka_unit_test(a_repeated_pair_is_one_track),
    cmocka_unit_test(what_happens_within_a_track_is_no_event),
    cmocka_unit_test(a_mode_that_is_half_like_two_is_a_near_tie),
    cmocka_unit_test(a_mode_that_is_like_none_is_lost),
    cmocka_unit_test(a_configuration_goes_on_from_its_nearest),
    cmocka_unit_test(modes_of_the_spacecraft_cross_where_they_should),
    cmocka_unit_test(one_configuration_has_nothing_to_say),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(tracking, tests, NULL, NULL)
