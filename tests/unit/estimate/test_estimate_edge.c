/*
 * Bounds at the end of a band, of pencils (diag lambda, I) whose every number
 * is known: full modes below it whose partners lie above, change places, or
 * are none; and what damps a mode to rounding only.
 */
#include "testing.h"

#include "masses.h"
#include "project.h"

#include <ritz/matrix.h>
#include <ritz/verify.h>

#include <math.h>

enum { MOST = 6 };

static void diagonal(int64_t n, const double *lambda, ritz_component *out)
{
    assert_ok(masses_apart(n, lambda, NULL, out));
    assert_ok(ritz_io_new(n, 1, 1, &out->io));
    out->io.B.val[0] = out->io.C.val[0] = 1.0;
}

static double said(const ritz_measures *m, const char *name)
{
    const ritz_measure *found = ritz_measures_find(m, name);

    return found ? found->value : 0.0;
}

/* Column j of T: sqrt(share) of unit vector `of`, the rest of another. */
typedef struct mixed {
    int64_t of;
    double share;
    int64_t other;
} mixed;

typedef struct edge_case {
    const char *text;
    int64_t n, columns;
    double lambda[MOST];
    mixed column[MOST];
    double end;      /* of the band, lambda */
    double error;    /* of the worst frequency */
    int64_t missing; /* full modes without a partner */
    double near;     /* bound over error at most, or itself if that is 0 */
} edge_case;

static const edge_case cases[] = {
    /* 0.95 of mode 2 at 4: theta = 8.8 */
    {"a partner above the band",
     3,
     2,
     {1, 4, 100},
     {{0, 1.0, 1}, {1, 0.95, 2}},
     6.0,
     0.4832396974,
     0,
     1.01},
    {"the only mode of the band",
     3,
     2,
     {3, 50, 100},
     {{0, 0.99, 2}, {1, 1.0, 0}},
     3.5,
     0.1503622618,
     0,
     1.01},
    {"modes that change places",
     4,
     3,
     {1, 4, 5, 100},
     {{0, 1.0, 1}, {2, 1.0, 1}, {1, 0.95, 3}},
     6.0,
     0.4832396974,
     0,
     1.01},
    {"less than half of a mode",
     3,
     2,
     {1, 4, 100},
     {{0, 1.0, 1}, {1, 0.45, 2}},
     6.0,
     0.0,
     1,
     1e-6},
    {"one of two equal modes",
     4,
     3,
     {1, 4, 4, 100},
     {{0, 1.0, 1}, {1, 1.0, 0}, {3, 1.0, 0}},
     6.0,
     0.0,
     1,
     1e-6},
    {"a mode that is orthogonal to all",
     5,
     3,
     {1, 4, 9, 16, 100},
     {{0, 1.0, 1}, {2, 1.0, 0}, {3, 1.0, 0}},
     6.0,
     0.0,
     1,
     1e-6},
};

static void open_case(const edge_case *c, ritz_component *full,
                      ritz_basis *basis, ritz_reduced *reduced)
{
    diagonal(c->n, c->lambda, full);
    assert_ok(ritz_basis_new(c->n, c->columns, basis));
    for (int64_t j = 0; j < c->columns; j++) {
        ritz_dense_col(&basis->T, j)[c->column[j].other] =
            sqrt(1.0 - c->column[j].share);
        ritz_dense_col(&basis->T, j)[c->column[j].of] =
            sqrt(c->column[j].share);
    }
    assert_ok(ritz_reduce(full, basis, reduced));
}

/* Numbers of the case, of verify and of the bounds agree. */
static void hold(const edge_case *c, const ritz_measures *found,
                 const ritz_measures *bounds)
{
    const double rounding = 1e-9;
    double error = said(found, "frequency-relative");
    double bound = said(bounds, "frequency-relative-bound");
    double least = said(bounds, "frequency-relative-least");

    if (!(fabs(error - c->error) <= rounding))
        fail_msg("%s: verify finds %.10g", c->text, error);
    if (!(bound >= error - rounding) || !(least <= error + rounding) ||
        !(bound <= (error > rounding ? c->near * error : c->near)))
        fail_msg("%s: %g is said to be %g at least and %g at most", c->text,
                 error, least, bound);
    if (!(least * c->near >= error - rounding))
        fail_msg("%s: %g is said to be but %g at least", c->text, error, least);
    assert_true(said(found, "missing-modes") == (double)c->missing);
    assert_non_null(ritz_measures_find(bounds, "missing-modes-bound"));
    if (said(bounds, "missing-modes-bound") != (double)c->missing)
        fail_msg("%s: %g modes are said to be missing", c->text,
                 said(bounds, "missing-modes-bound"));
}

static void bounds_are_of_what_verify_measures(void **)
{
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const edge_case *c = &cases[i];
        ritz_estimate_request request = {0};
        ritz_verify_request verify = RITZ_VERIFY_NONE;
        RITZ_OWN(ritz_component) full = {0};
        RITZ_OWN(ritz_basis) basis = {0};
        RITZ_OWN(ritz_reduced) reduced = {0};
        RITZ_OWN(ritz_measures) found = {0};

        open_case(c, &full, &basis, &reduced);
        request.band_hz[1] = verify.band_hz[1] = ritz_eigen_hertz(c->end);
        assert_ok(ritz_estimate(&full, &basis, &request, &reduced));
        assert_ok(verify_reduced(&full, &reduced, &verify, &found));
        hold(c, &found, &reduced.estimates);
    }
}

/* The full mode is at the very end of the band, which belongs to it. */
static void a_mode_at_the_end_of_the_band_is_in_it(void **)
{
    const double places[] = {1.0 - 1e-10, 1.0, 1.0 + 1e-10};

    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        ritz_estimate_request request = {0};
        RITZ_OWN(ritz_component) full = {0};
        RITZ_OWN(ritz_basis) basis = {0};
        RITZ_OWN(ritz_reduced) reduced = {0};

        open_case(&cases[0], &full, &basis, &reduced);
        request.band_hz[1] = ritz_eigen_hertz(4.0) * places[i];
        assert_ok(ritz_estimate(&full, &basis, &request, &reduced));
        assert_true(said(&reduced.estimates, "frequency-relative-bound") >=
                    cases[0].error - 1e-9);
    }
}

/* What rounding leaves of a damper in a mode that it does not move. */
static void damping_at_rounding_is_none(void **)
{
    enum { N = 3 };
    const double lambda[N] = {1.0, 2.0, 100.0};
    const double d[N] = {1e-2, 1e-28, 1.0};
    const int64_t at[N] = {0, 1, 2};
    const ritz_estimate_request request = {.band_hz = {0.0, 0.5}};

    for (int driven = 0; driven < 2; driven++) {
        RITZ_OWN(ritz_component) body = {0};
        RITZ_OWN(ritz_basis) basis = {0};
        RITZ_OWN(ritz_reduced) reduced = {0};
        double told = 0.0;

        diagonal(N, lambda, &body);
        body.io.B.val[1] = body.io.C.val[1] = driven;
        body.io.B.val[2] = body.io.C.val[2] = 1.0;
        assert_ok(ritz_sparse_from_triplets(N, N, N, at, at, d, &body.D));
        assert_ok(ritz_basis_new(N, 2, &basis));
        for (int64_t j = 0; j < 2; j++)
            ritz_dense_col(&basis.T, j)[j] = 1.0;
        assert_ok(ritz_reduce(&body, &basis, &reduced));
        assert_ok(ritz_estimate(&body, &basis, &request, &reduced));
        told = said(&reduced.estimates, "response-relative-estimate");
        /* without a force on it 1e-4: what is left out is 1 / (100 - w^2) of
           1 / 1e-2; it may resonate behind the band, at ratios of 5e-3 */
        if (driven ? !isinf(told) : !(told >= 1e-4 && told <= 2e-2))
            fail_msg("%d: %g", driven, told);
    }
}

static void judging_survives_every_allocation(void **)
{
    ritz_estimate_request request = {0};
    RITZ_OWN(ritz_component) full = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};

    open_case(&cases[2], &full, &basis, &reduced);
    request.band_hz[1] = ritz_eigen_hertz(cases[2].end);
    assert_survives_every_allocation(
        ritz_estimate(&full, &basis, &request, &reduced));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(bounds_are_of_what_verify_measures),
    cmocka_unit_test(a_mode_at_the_end_of_the_band_is_in_it),
    cmocka_unit_test(damping_at_rounding_is_none),
    cmocka_unit_test(judging_survives_every_allocation),
};

TEST_MODULE(estimate_edge, tests, NULL, NULL)
