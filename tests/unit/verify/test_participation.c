/*
 * Modes of systems are compared by their participations in inputs and outputs:
 * uncoupled oscillators, one a mode, whose participations are chosen.
 */
#include "testing.h"

#include "project.h"
#include "verify/sides.h"

#include <ritz/model.h>
#include <ritz/verify.h>

enum { MOST = 4, OUTPUTS = 2 };

/* Mode k has w = hertz[k] 2 pi, phi'b = b[k] and c phi = c[k]. */
typedef struct oscillators {
    int64_t count;
    double hertz[MOST], b[MOST], c[MOST][OUTPUTS];
} oscillators;

static const oscillators plain = {
    3, {1.0, 2.0, 4.0}, {1.0, 1.0, 1.0}, {{1.0, 2.0}, {2.0, 1.0}, {1.0, 1.0}}};

static void open_full(const oscillators *s, ritz_component *out)
{
    int64_t at[MOST] = {0, 1, 2, 3};
    double k[MOST], m[MOST];

    for (int64_t j = 0; j < s->count; j++) {
        k[j] = ritz_eigen_lambda(s->hertz[j]);
        m[j] = 1.0;
    }
    *out = (ritz_component){.num_dofs = s->count};
    assert_ok(ritz_sparse_from_triplets(s->count, s->count, s->count, at, at, k,
                                        &out->K));
    assert_ok(ritz_sparse_from_triplets(s->count, s->count, s->count, at, at, m,
                                        &out->M));
    assert_ok(ritz_io_new(s->count, 1, OUTPUTS, &out->io));
    for (int64_t j = 0; j < s->count; j++) {
        out->io.B.val[j] = s->b[j];
        for (int64_t i = 0; i < OUTPUTS; i++)
            ritz_dense_col(&out->io.C, j)[i] = s->c[j][i];
    }
}

static void open_reduced(const oscillators *s, ritz_configuration *out)
{
    RITZ_OWN(ritz_component) same = {0};

    open_full(s, &same);
    *out = (ritz_configuration){0};
    assert_ok(ritz_sparse_dense(&same.K, &out->K));
    assert_ok(ritz_sparse_dense(&same.M, &out->M));
    out->io = same.io;
    same.io = (ritz_io){0};
}

/* One system against the other, up to 5 Hz. */
static ritz_measures compare(const oscillators *full,
                             const oscillators *reduced)
{
    ritz_verify_request request = RITZ_VERIFY_NONE;
    RITZ_OWN(ritz_component) component = {0};
    RITZ_OWN(ritz_configuration) at = {0};
    ritz_measures found = {0};

    request.band_hz[1] = 5.0;
    open_full(full, &component);
    open_reduced(reduced, &at);
    assert_ok(verify_system(&component, &at, &request, &found));
    return found;
}

static void assert_mac(const oscillators *full, const oscillators *reduced,
                       double value, const char *where)
{
    ritz_measures found = compare(full, reduced);
    const ritz_measure *mac = find_measure(&found, "mac");

    /* a dozen products of numbers of size 1 */
    assert_near(mac->value, value, 1e-14);
    assert_string_equal(mac->where, where);
    ritz_measures_free(&found);
}

/* Mode 3, whose second output has the wrong sign, is [1, 1, 1/2] against
 * [1, 1, -1/2]; the largest are 1, 2 and 2: ((1/4 + 1 - 1/4) / (3/2))^2. */
static void inputs_and_outputs_are_scaled_by_their_largest(void **)
{
    oscillators full = plain, reduced = plain;
    const double by_hand = 4.0 / 9.0;

    reduced.c[2][1] = -1.0;
    assert_mac(&full, &reduced, by_hand, "mode 3, 4 Hz");
    /* other units of the input and of one output */
    for (int k = 0; k < 3; k++) {
        full.b[k] *= 1e-4;
        reduced.b[k] *= 1e-4;
        full.c[k][1] *= 1e3;
        reduced.c[k][1] *= 1e3;
    }
    assert_mac(&full, &reduced, by_hand, "mode 3, 4 Hz");
}

/*
 * The participations of mode 3 in both channels are multiplied by `part`, and
 * the second output of it has the wrong sign.
 */
static void only_observable_modes_decide(void **)
{
    static const struct {
        double part, hertz, zeta;
        bool observable;
    } cases[] = {
        {1e-7, 4.0, 0.01, false},  {1e-5, 4.0, 0.01, true},
        {1e-7, 0.1, 0.01, true},   /* low: statically it is 1e-5 of mode 1 */
        {1e-7, 0.5, 0.01, false},  /* 4e-7 */
        {1e-7, 4.0, 1e-4, true},   /* resonances 100 times as high */
        {1e-12, 4.0, 1e-9, false}, /* rounding */
        {0.0, 4.0, 0.01, false},
    };

    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        RITZ_OWN(ritz_component) component = {0};
        RITZ_OWN(ritz_reference) *r = ritz_zalloc(1, sizeof *r);
        oscillators s = plain;
        int64_t at = 2;

        s.hertz[2] = cases[k].hertz;
        s.c[2][0] *= cases[k].part;
        s.c[2][1] *= cases[k].part;
        open_full(&s, &component);
        assert_non_null(r);
        r->component = &component;
        r->band_hz[1] = 5.0;
        assert_ok(ritz_poles_of_component(&component, NULL, 15.0, &r->pairs,
                                          &r->poles));
        at = cases[k].hertz < 1.0 ? 0 : 2;
        for (int64_t j = 0; j < 3; j++)
            r->poles.rate[j] = 2.0 * sqrt(r->poles.lambda[j]) *
                               (j == at ? cases[k].zeta : 0.01);
        assert_ok(ritz_reference_observe(r));
        for (int64_t j = 0; j < 3; j++)
            assert_int_equal(r->part.observable[j],
                             j == at ? cases[k].observable : true);
    }
}

/* What noise is left of a mode in both models may point anywhere. */
static void noise_has_no_mac_and_is_counted(void **)
{
    oscillators full = plain, reduced = plain;

    full.b[1] = 3e-16;
    full.c[1][0] = 9e-17;
    full.c[1][1] = 1e-15;
    reduced.b[1] = 1e-16;
    reduced.c[1][0] = 0.0;
    reduced.c[1][1] = -1e-15;
    reduced.c[2][1] = -1.0;
    /* [1, 1, 1/2] as above: of the modes that are left the largest are 1, 1,
       2 */
    assert_mac(&full, &reduced, (1.75 / 2.25) * (1.75 / 2.25),
               "mode 3, 4 Hz, 1 not observable");
    reduced.c[2][1] = 1.0;
    assert_mac(&full, &reduced, 1.0, "mode 1, 1 Hz, 1 not observable");
}

/* An output in which no mode of the band takes part does not count. */
static void an_output_of_rounding_counts_for_nothing(void **)
{
    oscillators full = plain, reduced = plain;

    full.count = reduced.count = 4;
    full.hertz[3] = reduced.hertz[3] =
        9.0; /* beyond the band, observable in y2 */
    full.c[3][1] = reduced.c[3][1] = 1.0;
    for (int k = 0; k < 3; k++) {
        full.c[k][1] = 1e-16 * (k + 1);
        reduced.c[k][1] = 1e-16 * (2 - k);
    }
    assert_mac(&full, &reduced, 1.0, "mode 1, 1 Hz");
}

/* Two modes of different kinds have passed each other. */
static void modes_that_have_changed_places_are_found(void **)
{
    static const oscillators full = {
        2, {1.00, 1.03}, {1.0, 1.0}, {{1.0, 0.0}, {0.0, 1.0}}};
    static const oscillators reduced = {
        2, {1.01, 1.05}, {1.0, 1.0}, {{0.0, 1.0}, {1.0, 0.0}}};
    ritz_measures found = compare(&full, &reduced);

    assert_near(find_measure(&found, "mac")->value, 1.0, 1e-14);
    assert_near(find_measure(&found, "frequency-relative")->value, 0.05, 1e-12);
    assert_near(find_measure(&found, "missing-modes")->value, 0.0, 0.0);
    ritz_measures_free(&found);
}

/* An observable mode without partner has a MAC of 0, another one none. */
static void nothing_is_like_a_mode_that_is_missing(void **)
{
    oscillators full = plain, reduced = plain;

    reduced.count = 2;
    assert_mac(&full, &reduced, 0.0, "mode 3, 4 Hz");
    full.c[2][0] = full.c[2][1] = 0.0;
    assert_mac(&full, &reduced, 1.0, "mode 1, 1 Hz, 1 not observable");
}

static ritz_status verify_once(const ritz_component *full,
                               const ritz_configuration *at)
{
    ritz_verify_request request = RITZ_VERIFY_NONE;
    ritz_status status = RITZ_OK;
    RITZ_OWN(ritz_measures) found = {0};

    request.band_hz[1] = 5.0;
    RITZ_TRY(verify_system(full, at, &request, &found));
done:
    return status;
}

static void verifying_a_system_survives_every_allocation(void **)
{
    RITZ_OWN(ritz_component) full = {0};
    RITZ_OWN(ritz_configuration) at = {0};

    open_full(&plain, &full);
    open_reduced(&plain, &at);
    assert_survives_every_allocation(verify_once(&full, &at));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(inputs_and_outputs_are_scaled_by_their_largest),
    cmocka_unit_test(only_observable_modes_decide),
    cmocka_unit_test(noise_has_no_mac_and_is_counted),
    cmocka_unit_test(an_output_of_rounding_counts_for_nothing),
    cmocka_unit_test(modes_that_have_changed_places_are_found),
    cmocka_unit_test(nothing_is_like_a_mode_that_is_missing),
    cmocka_unit_test(verifying_a_system_survives_every_allocation),
};

TEST_MODULE(participation, tests, NULL, NULL)
