/*
 * Responses where there is little to find: a rest without mass, poles that are
 * not damped, channels that are rounding. All in closed form.
 */
#include "responses.h"
#include "testing.h"

#include "masses.h"
#include "response/responder.h"
#include "verify/sides.h"

#include <ritz/response.h>

#include <complex.h>

static const double pi = 3.14159265358979323846;

/* Mode j of `count` free masses m joined by springs k: its value at mass i. */
static double free_mode(int64_t count, int64_t j, int64_t i)
{
    double norm = (j == 0 ? 1.0 : 2.0) / (double)count;

    return sqrt(norm) * cos(pi * (double)j * ((double)i + 0.5) / (double)count);
}

static double free_lambda(int64_t count, int64_t j, double k)
{
    return 2.0 * k * (1.0 - cos(pi * (double)j / (double)count));
}

enum { POINTS = 12, MASSES = POINTS / 2, ENDS = 3 };

/* At a mass, between two, and at the free end. */
static const int64_t ends[ENDS] = {0, 5, POINTS - 1};
static const double stiff = 100.0;

/* Springs and points in a row, free, every second point and the last without
 * mass: two springs between masses are one of half the stiffness. */
static void open_row(ritz_component *row)
{
    double m[POINTS], k[POINTS];

    for (int64_t i = 0; i < POINTS; i++) {
        m[i] = i % 2 == 0 ? 1.0 : 0.0;
        k[i] = i > 0 ? stiff : 0.0;
    }
    assert_ok(masses_component(POINTS, m, k, NULL, row));
    assert_ok(masses_io(row, ENDS, ends, ENDS, ends));
}

/* Of mode j at a point: that of the mass, or the mean of those beside. */
static double row_mode(int64_t j, int64_t point)
{
    int64_t i = point / 2;
    double here = free_mode(MASSES, j, i);

    if (point % 2 == 0 || i == MASSES - 1)
        return here;
    return 0.5 * (here + free_mode(MASSES, j, i + 1));
}

/* Modes damped by a ratio, and the static flexibility of the springs at a point
 * without mass. */
static double _Complex row_response(int64_t to, int64_t from, double hertz,
                                    double zeta)
{
    double w = 2.0 * pi * hertz;
    double _Complex sum = 0.0;

    for (int64_t j = 0; j < MASSES; j++) {
        double lambda = free_lambda(MASSES, j, 0.5 * stiff);
        double rate = 2.0 * zeta * sqrt(fmax(lambda, 0.0));

        sum += row_mode(j, to) * row_mode(j, from) /
               ritz_complex(lambda - w * w, rate * w);
    }
    if (to == from && to % 2 == 1)
        sum += to == POINTS - 1 ? 1.0 / stiff : 0.5 / stiff;
    return sum;
}

/* Largest error of nine channels, of the largest |H|, 0.17 here or more. */
static double row_apart(int64_t count, const double *hertz, double zeta,
                        const double _Complex *H)
{
    double worst = 0.0, largest = 0.0;

    for (int64_t k = 0; k < count; k++)
        for (int64_t i = 0; i < ENDS; i++)
            for (int64_t j = 0; j < ENDS; j++) {
                double _Complex exact =
                    row_response(ends[i], ends[j], hertz[k], zeta);

                largest = fmax(largest, cabs(exact));
                worst = fmax(worst, cabs(H[(k * ENDS + i) * ENDS + j] - exact));
            }
    return worst / largest;
}

/*
 * Modes at 0, 0.58, 1.13, 1.59, 1.95 and 2.17 Hz. With modes up to 1 Hz the
 * rest has both, up to 3 Hz nothing that has mass. lambda_max = 200 and what is
 * nearest to a pole is 0.05 off of 0.5: rounding is 1e-13 or less.
 */
static void a_rest_without_mass_answers_by_its_springs(void **state)
{
    const double up_to[] = {1.0, 1.7, 3.0, 100.0};
    const double hertz[] = {0.1, 0.33, 0.47, 0.5};
    const ritz_grid grid = {.hertz = hertz, .count = 4};
    RITZ_OWN(ritz_component) row = {0};

    (void)state;
    open_row(&row);
    for (size_t k = 0; k < sizeof up_to / sizeof *up_to; k++) {
        RITZ_OWN(ritz_response) r = {0};

        assert_ok(modal_response(&row, NULL, up_to[k], &grid, &r));
        assert_true(row_apart(r.count, r.hertz, 0.0, r.H) < 1e-11);
    }
}

/* What ritz-verify measures by, in bands at and beyond the last mode. */
static void a_reference_may_have_no_mass_left(void **state)
{
    const double bands[][2] = {
        {0.3, 0.6}, {1.0, 2.24}, {0.1, 2.24}, {3.0, 9.0}};
    const double hertz[] = {0.4, 1.3, 2.0, 4.1};
    RITZ_OWN(ritz_component) row = {0};

    (void)state;
    open_row(&row);
    for (size_t k = 0; k < sizeof bands / sizeof *bands; k++) {
        const ritz_reference_request request = {
            .band_hz = {bands[k][0], bands[k][1]},
            .damping = {.kind = RITZ_DAMPING_MODAL, .zeta = 0.01}};
        RITZ_OWN(ritz_reference) *reference = NULL;
        double at = hertz[k];
        ritz_reference_sweep sweep = {.count = 1, .hertz = &at};

        assert_ok(ritz_reference_new(&row, &request, &reference));
        assert_ok(ritz_reference_respond(reference, &sweep));
        assert_true(row_apart(1, &at, 0.01, sweep.full) < 1e-11);
        sweep.hertz = NULL;
        ritz_sweep_free(&sweep);
    }
}

enum { LENGTH = 30 };

static const double spin = 0.05, ground = 1.0, link = 1e7;

/* A stiff chain on soft springs that moves along y and z and turns about
 * itself: D = spin (y z' - z y'). Forces along y at its end; both motions. */
static void open_whirl(ritz_component *whirl)
{
    const int64_t in = LENGTH - 1, out[] = {LENGTH - 1, 2 * LENGTH - 1};
    int64_t row[2 * LENGTH], col[2 * LENGTH];
    double m[2 * LENGTH], k[2 * LENGTH], d[2 * LENGTH];

    for (int64_t i = 0; i < 2 * LENGTH; i++) {
        m[i] = 1.0;
        k[i] = i % LENGTH == 0 ? 0.0 : link;
        row[i] = i;
        col[i] = (i + LENGTH) % (2 * LENGTH);
        d[i] = i < LENGTH ? spin : -spin;
    }
    assert_ok(masses_component(2 * LENGTH, m, k, NULL, whirl));
    for (int64_t j = 0; j < 2 * LENGTH; j++)
        for (int64_t p = whirl->K.colptr[j]; p < whirl->K.colptr[j + 1]; p++)
            whirl->K.val[p] += whirl->K.rowind[p] == j ? ground : 0.0;
    assert_ok(ritz_sparse_from_triplets(2 * LENGTH, 2 * LENGTH, 2 * LENGTH, row,
                                        col, d, &whirl->D));
    assert_ok(masses_io(whirl, 1, &in, 2, out));
}

/* z = lambda_j - w^2 of each mode; y: z / det, z: i w spin / det,
 * det = z^2 - w^2 spin^2. */
static void whirl_response(double hertz, double _Complex H[2])
{
    double w = 2.0 * pi * hertz;

    H[0] = H[1] = 0.0;
    for (int64_t j = 0; j < LENGTH; j++) {
        double end = free_mode(LENGTH, j, LENGTH - 1);
        double z = ground + free_lambda(LENGTH, j, link) - w * w;
        double det = z * z - w * w * spin * spin;

        H[0] += end * end * z / det;
        H[1] += ritz_complex(0.0, w * spin) * end * end / det;
    }
}

/*
 * Nothing damps it: full responses at a pole are rounding. Poles come in pairs
 * 0.008 Hz apart, at 0.16, 53, 105 Hz; they are 1e-3 of their frequency off
 * these points or more. lambda_max / lambda = 4e7 of the first: rounding is
 * 4e7 eps / 1e-3 = 1e-5 at worst of what it answers; measured 2e-9.
 */
static void a_small_gyroscopic_model_is_answered(void **state)
{
    const double tolerance[] = {1e-5, 1e-7, 1e-9};
    RITZ_OWN(ritz_component) whirl = {0};

    (void)state;
    open_whirl(&whirl);
    for (size_t t = 0; t < sizeof tolerance / sizeof *tolerance; t++) {
        const ritz_response_request request = {
            .model = ritz_model_of_component(&whirl, NULL),
            .from_hz = 0.05,
            .to_hz = 90.0,
            .tolerance = tolerance[t]};
        RITZ_OWN(ritz_responder) *r = NULL;
        double worst = 0.0, largest = 0.0;

        assert_ok(ritz_responder_new(ritz_response_engine_find("krylov"),
                                     &request, &r));
        for (int k = 0; k < 981; k++) {
            const double hertz = 0.05 + 0.0917 * k;
            double _Complex exact[2], H[2];

            whirl_response(hertz, exact);
            assert_ok(ritz_responder_at(r, hertz, H));
            for (int v = 0; v < 2; v++) {
                largest = fmax(largest, cabs(exact[v]));
                worst = fmax(worst, cabs(H[v] - exact[v]));
            }
        }
        print_message("# %.0e: %s; error %.1e\n", tolerance[t],
                      ritz_responder_remark(r), worst / largest);
        assert_true(worst <= fmax(tolerance[t], 1e-8) * largest);
        /* one at the worst point, one beside the pole: nothing was amiss */
        assert_non_null(strstr(ritz_responder_remark(r), " 2 full responses"));
    }
}

static ritz_status give_up(const ritz_response_request *request,
                           ritz_responder *out)
{
    (void)request;
    (void)out;
    return ritz_fail(RITZ_ERR_CONVERGENCE, "no space is enough");
}

/* One that never converges stands for the chosen one. */
static void where_an_engine_gives_up_direct_answers(void **state)
{
    const ritz_response_engine futile = {
        .name = "futile", .takes = RITZ_MODEL_COMPONENT, .make = give_up};
    RITZ_OWN(ritz_component) row = {0};
    ritz_response_request request = {
        .model = ritz_model_of_component(&row, NULL), .to_hz = 1.0};
    ritz_responder *r = NULL;
    double _Complex H[ENDS * ENDS];
    const double hertz = 0.3;

    (void)state;
    open_row(&row);
    assert_ok(ritz_responder_or_direct(&futile, &request, &r));
    assert_string_equal(ritz_responder_remark(r),
                        "futile gave up, direct instead: no space is enough");
    assert_ok(ritz_responder_at(r, hertz, H));
    assert_true(row_apart(1, &hertz, 0.0, H) < 1e-11);
    ritz_responder_free(&r);
    /* of a dense model there is no direct */
    request.model =
        ritz_model_of_dense(&(ritz_second_order){.io = &row.io}, NULL);
    assert_fails(ritz_responder_or_direct(&futile, &request, &r),
                 RITZ_ERR_ARGUMENT, "not for");
}

enum { TWIN = 12 };

/* Of what drives the first, what drives the second. */
static const double less = 0.3;

/* Two free chains, alike, joined by nothing. The first output is that of the
 * first; in the second, what both answer cancels. */
static void open_twins(ritz_component *twins)
{
    const int64_t in = 0, out[] = {3, TWIN + 3};
    double m[2 * TWIN], k[2 * TWIN];

    for (int64_t i = 0; i < 2 * TWIN; i++) {
        m[i] = 1.0;
        k[i] = i % TWIN == 0 ? 0.0 : 1e4;
    }
    assert_ok(masses_component(2 * TWIN, m, k, NULL, twins));
    assert_ok(masses_io(twins, 1, &in, 2, out));
    twins->io.B.val[TWIN] = less;
    ritz_dense_col(&twins->io.C, 3)[1] = -less;
}

static double _Complex twin_response(double hertz, double zeta)
{
    double w = 2.0 * pi * hertz;
    double _Complex sum = 0.0;

    for (int64_t j = 0; j < TWIN; j++) {
        double lambda = free_lambda(TWIN, j, 1e4);

        sum += free_mode(TWIN, j, 0) * free_mode(TWIN, j, 3) /
               ritz_complex(lambda - w * w, 2.0 * zeta * sqrt(lambda) * w);
    }
    return sum;
}

/* less H - H less: rounding at every frequency anew. */
static void an_output_of_rounding_holds_up_nothing(void **state)
{
    static const char *const engines[] = {"modal", "krylov", "rational",
                                          "direct"};
    const double tolerance = 1e-6;
    const ritz_damping modal = {.kind = RITZ_DAMPING_MODAL, .zeta = 0.01};
    const ritz_grid grid = {.from_hz = 1.0, .to_hz = 20.0, .count = 20};
    RITZ_OWN(ritz_component) twins = {0};

    (void)state;
    open_twins(&twins);
    for (size_t e = 0; e < sizeof engines / sizeof *engines; e++) {
        RITZ_OWN(ritz_response) r = {0};
        double worst = 0.0, largest = 0.0, other = 0.0;

        assert_ok(ritz_response_of(ritz_model_of_component(&twins, &modal),
                                   ritz_response_engine_find(engines[e]), 100.0,
                                   tolerance, &grid, &r));
        for (int64_t k = 0; k < r.count; k++) {
            double _Complex exact = twin_response(r.hertz[k], modal.zeta);

            largest = fmax(largest, cabs(exact));
            worst = fmax(worst, cabs(r.H[2 * k] - exact));
            other = fmax(other, cabs(r.H[2 * k + 1]));
        }
        print_message("# %s: %d points, error %.1e, rounding %.1e\n",
                      engines[e], (int)r.count, worst / largest,
                      other / largest);
        assert_true(worst <= 0.1 * tolerance * largest);
        assert_true(other > 0.0 && other <= 1e-12 * largest);
        assert_true(r.count < 2000);
    }
}

static ritz_status follow_twins(const ritz_component *twins)
{
    const ritz_damping modal = {.kind = RITZ_DAMPING_MODAL, .zeta = 0.05};
    const ritz_grid grid = {.from_hz = 1.0, .to_hz = 5.0, .count = 3};
    ritz_status status = RITZ_OK;
    RITZ_OWN(ritz_response) r = {0};

    RITZ_TRY(ritz_response_of(ritz_model_of_component(twins, &modal), NULL,
                              100.0, 0.4, &grid, &r));
done:
    return status;
}

static void points_survive_every_allocation(void **state)
{
    RITZ_OWN(ritz_component) twins = {0};

    (void)state;
    open_twins(&twins);
    assert_survives_every_allocation(follow_twins(&twins));
}

/*
 * Two masses of 1 Hz joined by a spring of 1e-10 of theirs: what passes is the
 * difference of two poles as good as equal, 5e-9 of the rest and no rounding.
 * Eigenvectors of a gap of 2e-10 are good to 1e-6 of that.
 */
static void a_faint_link_between_equals_shows_both_poles(void **state)
{
    const double lambda = 4.0 * pi * pi, weak = 1e-10 * lambda;
    const double m[] = {1.0, 1.0};
    const double k[] = {lambda, weak};
    const int64_t in = 0, out[] = {0, 1};
    const ritz_damping modal = {.kind = RITZ_DAMPING_MODAL, .zeta = 0.01};
    const ritz_grid grid = {.from_hz = 0.2, .to_hz = 3.0, .count = 50};
    double w1 = 2.0 * pi, w2 = sqrt(lambda + 2.0 * weak);
    RITZ_OWN(ritz_component) pair = {0};
    RITZ_OWN(ritz_response) r = {0};
    double worst = 0.0, largest = 0.0;

    (void)state;
    assert_ok(masses_component(2, m, k, NULL, &pair));
    pair.K.val[pair.K.colptr[2] - 1] +=
        lambda; /* to the ground, as the first */
    assert_ok(masses_io(&pair, 1, &in, 2, out));
    assert_ok(ritz_response_of(ritz_model_of_component(&pair, &modal),
                               ritz_response_engine_find("rational"), 10.0, 0.0,
                               &grid, &r));
    for (int64_t p = 0; p < r.count; p++) {
        double w = 2.0 * pi * r.hertz[p];
        double rate = 2.0 * modal.zeta * w;
        double _Complex d1 = ritz_complex(lambda - w * w, rate * w1);
        double _Complex d2 =
            ritz_complex(lambda + 2.0 * weak - w * w, rate * w2);
        double _Complex gap =
            ritz_complex(2.0 * weak, rate * 2.0 * weak / (w1 + w2));
        double _Complex exact = 0.5 * gap / (d1 * d2);

        largest = fmax(largest, cabs(exact));
        worst = fmax(worst, cabs(r.H[2 * p + 1] - exact));
    }
    print_message("# error %.1e of %.1e\n", worst / largest, largest);
    assert_true(worst < 1e-5 * largest);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_rest_without_mass_answers_by_its_springs),
    cmocka_unit_test(a_reference_may_have_no_mass_left),
    cmocka_unit_test(a_small_gyroscopic_model_is_answered),
    cmocka_unit_test(where_an_engine_gives_up_direct_answers),
    cmocka_unit_test(an_output_of_rounding_holds_up_nothing),
    cmocka_unit_test(points_survive_every_allocation),
    cmocka_unit_test(a_faint_link_between_equals_shows_both_poles),
};

TEST_MODULE(response_limits, tests, NULL, NULL)
