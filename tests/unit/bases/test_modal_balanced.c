#include "testing.h"

#include "balancing.h"
#include "masses.h"
#include "project.h"

#include <ritz/matrix.h>
#include <ritz/model.h>

#include <float.h>
#include <stdio.h>
#include <stdlib.h>

static const ritz_method *const method = &ritz_method_modal_balanced;

/*
 * Masses that nothing joins, each on a spring of its own: mode k is mass k, and
 * its value |b||c| / (4 zeta w^2) (sqrt(1 + zeta^2) + zeta) is known.
 */
static void apart(int64_t n, const double *w, const double *b,
                  ritz_component *out)
{
    double k[MASSES_MOST], one[MASSES_MOST];
    int64_t at[MASSES_MOST];

    for (int64_t i = 0; i < n; i++) {
        at[i] = i;
        one[i] = 1.0;
        k[i] = w[i] * w[i];
    }
    assert_ok(masses_component(n, one, one, NULL, out));
    ritz_sparse_free(&out->K);
    assert_ok(ritz_sparse_from_triplets(n, n, n, at, at, k, &out->K));
    assert_ok(masses_io(out, 1, at, 1, at));
    for (int64_t i = 0; i < n; i++) {
        out->io.B.val[i] = b[i];
        out->io.C.val[i] = 1.0;
    }
    snprintf(out->damping, sizeof out->damping, "modal 0.02");
}

/* Values b / w^2: 1, 4/4, 3/9 ... the third best is the last in frequency. */
static void the_best_modes_are_kept_in_order_of_frequency(void **state)
{
    static const double w[] = {1.0, 2.0, 3.0, 4.0, 5.0};
    static const double b[] = {1.0, 0.4, 9.9, 0.1, 20.0};
    RITZ_OWN(ritz_component) masses = {0};
    ritz_request request = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    static const int64_t kept[] = {0, 2, 4};
    /* of modes 2 and 4: 2 (sigma_+ + sigma_-) = b / (zeta w^2)
       sqrt(1+zeta^2) */
    const double rest = (0.4 / 4.0 + 0.1 / 16.0) / 0.02 * sqrt(1.0004);
    const char *said = NULL;

    (void)state;
    apart(5, w, b, &masses);
    request = balancing_asking(&masses, 3);
    assert_ok(ritz_basis_make(method, &request, &basis));
    assert_int_equal(basis.T.ncol, 3);
    for (int64_t j = 0; j < 3; j++) {
        double hertz = ritz_eigen_hertz(w[kept[j]] * w[kept[j]]);

        assert_int_equal(basis.columns.kind[j], RITZ_COLUMN_NORMAL);
        assert_near(basis.columns.hertz[j], hertz, 8 * DBL_EPSILON * hertz);
        for (int64_t i = 0; i < 5; i++)
            assert_near(fabs(ritz_dense_col(&basis.T, j)[i]), i == kept[j],
                        8 * DBL_EPSILON);
    }
    assert_non_null(said = strstr(basis.remark, "at most "));
    assert_near(strtod(said + 8, NULL), rest, 1e-3 * rest); /* four digits */
}

/* Below 0.4 Hz, 2.5 rad/s, the first two count; the best of all do not. */
static void a_band_changes_the_order(void **state)
{
    static const double w[] = {1.0, 2.0, 3.0, 4.0, 5.0};
    static const double b[] = {1.0, 0.4, 9.9, 0.1, 20.0};
    RITZ_OWN(ritz_component) masses = {0};
    ritz_request request = {0};
    ritz_basis basis = {0};

    (void)state;
    apart(5, w, b, &masses);
    request = balancing_asking(&masses, 1);
    assert_ok(ritz_basis_make(method, &request, &basis));
    assert_near(basis.columns.hertz[0], ritz_eigen_hertz(9.0), 1e-12);
    ritz_basis_free(&basis);
    request.choice.band_hz[1] = 0.2;
    request.choice.given = RITZ_USES_BAND;
    assert_ok(ritz_basis_make(method, &request, &basis));
    assert_near(basis.columns.hertz[0], ritz_eigen_hertz(1.0), 1e-12);
    ritz_basis_free(&basis);
}

/* Three equal masses are one cluster: all three, or a sentence. */
static void equal_modes_are_kept_whole(void **state)
{
    static const double w[] = {1.0, 1.0, 1.0, 4.0};
    static const double b[] = {1.0, 1.0, 1.0, 1.0};
    RITZ_OWN(ritz_component) masses = {0};
    ritz_request request = {0};
    RITZ_OWN(ritz_basis) basis = {0};

    (void)state;
    apart(4, w, b, &masses);
    request = balancing_asking(&masses, 2);
    assert_fails(ritz_basis_make(method, &request, &basis), RITZ_ERR_ARGUMENT,
                 "3 modes at 0.159155 Hz are one cluster");
    request.modes = 3;
    assert_ok(ritz_basis_make(method, &request, &basis));
    assert_int_equal(basis.T.ncol, 3);
}

/*
 * What is left out answers at most what the remark says, and the reduced model
 * is symmetric, its modes those of the component.
 */
static void the_error_is_within_what_the_remark_says(void **state)
{
    enum { MASSES = 10 };
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_state_space) full = {0};

    (void)state;
    balancing_chain(MASSES, false, 9, 0, "modal 0.05", &chain);
    balancing_full(&chain, &full);
    for (int64_t kept = 1; kept < MASSES; kept++) {
        ritz_request request = balancing_asking(&chain, kept);
        const ritz_damping damping = {.kind = RITZ_DAMPING_MODAL, .zeta = 0.05};
        RITZ_OWN(ritz_basis) basis = {0};
        RITZ_OWN(ritz_reduced) reduced = {0};
        RITZ_OWN(ritz_state_space) made = {0};
        const ritz_state_space *states = NULL;
        const char *said = NULL;

        assert_ok(ritz_basis_make(method, &request, &basis));
        assert_non_null(said = strstr(basis.remark, "at most "));
        assert_ok(ritz_reduce(&chain, &basis, &reduced));
        for (int64_t j = 0; j < kept; j++) {
            double lambda = ritz_eigen_lambda(basis.columns.hertz[j]);

            assert_near(ritz_dense_col(&reduced.K, j)[j], lambda,
                        1e-12 * lambda);
        }
        assert_ok(ritz_model_states(ritz_model_of_reduced(&reduced, &damping),
                                    &made, &states));
        /* printed with four digits */
        assert_true(balancing_error(&full, &made) <=
                    strtod(said + 8, NULL) * 1.001);
    }
}

static void rigid_modes_are_all_kept(void **state)
{
    enum { MASSES = 7 };
    ritz_component chain = {0};
    ritz_request request = {0};
    ritz_basis basis = {0};

    (void)state;
    for (int among = 0; among < 2; among++) {
        balancing_chain(MASSES, true, 6, 0, "modal 0.05", &chain);
        request = balancing_asking(&chain, 100);
        request.choice.among_hz = among ? 7.0 : 0.0;
        assert_ok(ritz_basis_make(method, &request, &basis));
        assert_int_equal(basis.columns.kind[0], RITZ_COLUMN_RIGID);
        assert_int_equal(basis.columns.kind[1], RITZ_COLUMN_NORMAL);
        if (among)
            assert_true(basis.T.ncol < MASSES &&
                        basis.columns.hertz[basis.T.ncol - 1] <= 7.0);
        else
            assert_int_equal(basis.T.ncol, MASSES);
        assert_non_null(strstr(basis.remark, "of 100 asked for"));
        ritz_basis_free(&basis);
        ritz_component_free(&chain);
    }
}

static void requests_that_make_no_sense_are_refused(void **state)
{
    static const double m[] = {1.0, 2.0, 1.0}, k[] = {300.0, 200.0, 100.0};
    static const double c[] = {0.0, 1.0, 0.0};
    static const int64_t in = 2, seen = 0;
    RITZ_OWN(ritz_component) row = {0};
    ritz_request request = {0};
    ritz_basis none = {0};

    (void)state;
    assert_ok(masses_component(3, m, k, c, &row));
    request = balancing_asking(&row, 1);
    assert_fails(ritz_basis_make(method, &request, &none), RITZ_ERR_ARGUMENT,
                 "no inputs");
    assert_ok(masses_io(&row, 1, &in, 1, &seen));
    assert_fails(ritz_basis_make(method, &request, &none), RITZ_ERR_ARGUMENT,
                 ", and others that damping joins, are one cluster");
    ritz_sparse_free(&row.D);
    assert_fails(ritz_basis_make(method, &request, &none), RITZ_ERR_ARGUMENT,
                 "no damping");
    request.modes = 0;
    assert_fails(ritz_basis_make(method, &request, &none), RITZ_ERR_ARGUMENT,
                 "one at least");
    request.modes = -1;
    request.up_to_hz = 1.0;
    assert_fails(ritz_basis_make(method, &request, &none), RITZ_ERR_ARGUMENT,
                 "not by a frequency");
    request = balancing_asking(&row, 1);
    strcpy(row.damping, "modal 0.02");
    row.io.B.val[2] = 0.0;
    assert_fails(ritz_basis_make(method, &request, &none), RITZ_ERR_ARGUMENT,
                 "no mode is both controllable and observable");
}

static void no_allocation_failure_leaks(void **state)
{
    RITZ_OWN(ritz_component) chain = {0};
    ritz_request request = {0};
    RITZ_OWN(ritz_basis) basis = {0};

    (void)state;
    balancing_chain(5, true, 4, 0, "modal 0.05", &chain);
    request = balancing_asking(&chain, 2);
    request.choice.band_hz[1] = 3.0;
    request.choice.given = RITZ_USES_BAND;
    assert_survives_every_allocation(method->make(&request, &basis));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_best_modes_are_kept_in_order_of_frequency),
    cmocka_unit_test(a_band_changes_the_order),
    cmocka_unit_test(equal_modes_are_kept_whole),
    cmocka_unit_test(the_error_is_within_what_the_remark_says),
    cmocka_unit_test(rigid_modes_are_all_kept),
    cmocka_unit_test(requests_that_make_no_sense_are_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(modal_balanced, tests, NULL, NULL)
