#include "testing.h"

#include "frame.h"
#include "gramians/modes.h"

#include <ritz/matrix.h>
#include <ritz/ranking.h>
#include <ritz/verify.h>

#include <lapacke.h>

enum { DOFS = 12, INPUTS = 3, OUTPUTS = 6 };

/*
 * [McDaniel2000] eq. 3.2.23 and following: the cantilever of four elements, its
 * inputs and outputs. Systems there are [1A 2A 1B 2B] and so are its rows here:
 * node 1, 2, 3, 4, each x, y, theta.
 */
static ritz_status mcdaniel(double zeta, ritz_dense *K, ritz_dense *M,
                            ritz_io *io, ritz_modal *modal)
{
    static const int64_t in[INPUTS] = {1, 4, 6};
    static const int64_t seen[OUTPUTS] = {2, 5, 7, 8, 10, 11};
    const ritz_damping damping = {.kind = RITZ_DAMPING_MODAL, .zeta = zeta};
    RITZ_OWN(ritz_component) beam = {0};

    RITZ_CHECK(frame_component(4, 0.5, &frame_mcdaniel, true, false, 1, &beam));
    RITZ_CHECK(frame_io(&beam, INPUTS, in, OUTPUTS, seen));
    RITZ_CHECK(ritz_sparse_dense(&beam.K, K));
    RITZ_CHECK(ritz_sparse_dense(&beam.M, M));
    *io = beam.io;
    beam.io = (ritz_io){0};
    RITZ_CHECK(ritz_modal_new(K, M, NULL, io, &damping, modal));
    return RITZ_OK;
}

/* Rank modes of which nothing else is known. */
static ritz_status rank(const ritz_ranker *ranker, const ritz_modal *modal,
                        ritz_ranking *out)
{
    const ritz_rank_request request = {.modal = *modal};

    return ritz_rank(ranker, &request, out);
}

/* What a test of the beam needs. */
typedef struct fixture {
    ritz_dense K, M;
    ritz_io io;
    ritz_modal modal;
} fixture;

static int set_up(void **state)
{
    static fixture f;

    f = (fixture){0};
    assert_ok(mcdaniel(0.01, &f.K, &f.M, &f.io, &f.modal));
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;

    ritz_dense_free(&f->K);
    ritz_dense_free(&f->M);
    ritz_io_free(&f->io);
    ritz_modal_free(&f->modal);
    return 0;
}

/* Table 3.1; printed to six digits after the point. */
static void the_cantilever_has_the_published_frequencies(void **state)
{
    static const double hertz[DOFS] = {0.015610, 0.097939, 0.276032, 0.487239,
                                       0.544552, 1.012841, 1.537065, 1.626627,
                                       2.578744, 2.792127, 4.037661, 4.231175};
    const fixture *f = *state;
    RITZ_OWN(ritz_ranking) ranking = {0};

    assert_int_equal(f->modal.count, DOFS);
    assert_ok(rank(&ritz_ranker_gregory, &f->modal, &ranking));
    for (int k = 0; k < DOFS; k++)
        assert_near(ranking.hertz[k], hertz[k], 0.6e-6);
}

/* zeta sigma of the modes that are seen; the others exactly are not. */
static void gregory_gives_the_published_values_in_order(void **state)
{
    static const int64_t mode[] = {1, 2, 3, 5, 6, 8, 9, 12};
    static const double value[] = {3.08885,  0.377962, 0.064418, 0.026642,
                                   0.006098, 0.006078, 0.002166, 0.001039};
    static const double digit[] = {1e-5, 1e-6, 1e-6, 1e-6,
                                   1e-6, 1e-6, 1e-6, 1e-6};
    static const int64_t unseen[] = {4, 7, 10, 11};
    const fixture *f = *state;
    RITZ_OWN(ritz_ranking) ranking = {0};

    assert_ok(rank(&ritz_ranker_gregory, &f->modal, &ranking));
    assert_string_equal(ranking.by, "gregory");
    for (int k = 0; k < 8; k++) {
        assert_near(0.01 * ranking.value[mode[k] - 1], value[k],
                    0.6 * digit[k]);
        assert_int_equal(ranking.order[k], mode[k] - 1);
    }
    /* axial modes: no bending output sees them but by rounding */
    for (int k = 0; k < 4; k++)
        assert_near(ranking.value[unseen[k] - 1], 0.0,
                    1e-12 * ranking.value[0]);
}

/* 24-state Lyapunov equations, digits as printed. */
static void exact_hankel_values_are_the_published_pairs(void **state)
{
    static const double sigma[] = {311.9906, 305.8131, 38.1731, 37.4174,
                                   6.50708,  6.37847,  2.68935, 2.63626,
                                   0.61677,  0.61255,  0.60423, 0.60051,
                                   0.21861,  0.21431,  0.10491, 0.10284};
    static const double digit[] = {1e-4, 1e-4, 1e-4, 1e-4, 1e-5, 1e-5,
                                   1e-5, 1e-5, 1e-5, 1e-5, 1e-5, 1e-5,
                                   1e-5, 1e-5, 1e-5, 1e-5};
    const fixture *f = *state;
    RITZ_OWN(ritz_ranking) ranking = {0};

    assert_ok(rank(&ritz_ranker_hankel, &f->modal, &ranking));
    assert_int_equal(ranking.num_system, 2 * DOFS);
    for (int k = 0; k < 16; k++)
        assert_near(ranking.system_value[k], sigma[k], 0.6 * digit[k]);
    for (int k = 16; k < 2 * DOFS; k++)
        assert_near(ranking.system_value[k], 0.0, 1e-12 * sigma[0]);
}

/* The value of the only mode. */
static double value_of(const ritz_ranker *ranker, const ritz_modal *modal)
{
    RITZ_OWN(ritz_ranking) ranking = {0};
    double value = 0.0;

    assert_ok(rank(ranker, modal, &ranking));
    value = ranking.value[0];
    return value;
}

/* sigma = |b||c| / (4 zeta w^2) (sqrt(1 + zeta^2) + zeta), and the other. */
static void one_mode_has_the_closed_form_pair(void **state)
{
    static const double zeta[] = {0.7, 0.3, 0.01, 1e-4};
    double omega = 2.5;
    double b[] = {3.0, 4.0};
    double c[] = {1.0, 2.0, 2.0};
    double none[] = {0.0, 0.0, 0.0};

    (void)state;
    for (int k = 0; k < 4; k++) {
        double z = zeta[k];
        const ritz_modal modal = {
            1, &omega, &z, {1, 2, b}, {3, 1, c}, {3, 1, none}, 0, {0}, {0}};
        double light = 5.0 * 3.0 / (4.0 * z * omega * omega);
        double root = sqrt(1.0 + z * z);
        double sigma[2];

        assert_ok(ritz_modal_hankel(&modal, NULL, sigma));
        /* a few roundings, the second by the difference of two terms */
        assert_near(sigma[0], light * (root + z), 1e-14 * light);
        assert_near(sigma[1], light * (root - z), 1e-14 * light);
        assert_near(value_of(&ritz_ranker_hankel, &modal), sigma[0], 0.0);
        assert_near(value_of(&ritz_ranker_gregory, &modal), light,
                    1e-14 * light);
        /* what a value of these two approaches, exactly so of one mode */
        assert_near(ritz_ranker_gregory.exact(sigma), light, 1e-13 * light);
        assert_near(ritz_ranker_hankel.exact(sigma), sigma[0], 0.0);
    }
}

/*
 * Two modes 0.1 apart at zeta = 0.3: sqrt of the eigenvalues of Wc Wo, which
 * LAPACK's general eigensolver finds another way. That product loses half of
 * the digits: the largest, to 1e-12; the smallest of these, to 1e-8.
 */
static void hankel_values_are_the_eigenvalues_of_the_product(void **state)
{
    double omega[] = {1.0, 1.1};
    double zeta[] = {0.3, 0.2};
    double b[] = {1.0, -0.5};
    double c[] = {0.7, 0.2, 0.4, 1.1};
    double cv[] = {0.1, -0.3, 0.2, 0.5};
    const ritz_modal modal = {2,          omega, zeta, {2, 1, b}, {2, 2, c},
                              {2, 2, cv}, 0,     {0},  {0}};
    RITZ_OWN(ritz_dense) Wc = {0};
    RITZ_OWN(ritz_dense) Wo = {0};
    RITZ_OWN(ritz_dense) W = {0};
    double sigma[4];
    double re[4];
    double im[4];

    (void)state;
    assert_ok(ritz_modal_hankel(&modal, NULL, sigma));
    assert_ok(ritz_modal_gramians(&modal, NULL, &Wc, &Wo));
    assert_ok(ritz_dense_mul(&Wc, &Wo, &W));
    assert_int_equal(LAPACKE_dgeev(LAPACK_COL_MAJOR, 'N', 'N', 4, W.val, 4, re,
                                   im, NULL, 1, NULL, 1),
                     0);
    for (int k = 0; k < 4; k++) {
        double nearest = HUGE_VAL;

        for (int j = 0; j < 4; j++)
            nearest = fmin(nearest, fabs(sqrt(fabs(re[j])) - sigma[k]));
        assert_near(nearest, 0.0, k == 0 ? 1e-12 : 1e-8);
    }
}

/* Two directions of one mode: any basis of them gives the same value. */
static void a_cluster_has_one_value_whatever_spans_it(void **state)
{
    static const double angle[] = {0.0, 0.3, 1.0};

    (void)state;
    for (int k = 0; k < 3; k++) {
        double co = cos(angle[k]);
        double si = sin(angle[k]);
        double omega[] = {2.0, 2.0, 5.0};
        double zeta[] = {0.01, 0.01, 0.01};
        double b[] = {3.0 * co, -3.0 * si, 1.0, si, co, 1.0};
        double c[] = {co, si, -si, co, 1.0, 1.0};
        double none[6] = {0.0};
        const ritz_modal modal = {
            3, omega, zeta, {3, 2, b}, {2, 3, c}, {2, 3, none}, 0, {0}, {0}};
        ritz_ranking ranking = {0};

        for (int r = 0; r < 2; r++) {
            assert_ok(rank(r ? &ritz_ranker_hankel : &ritz_ranker_gregory,
                           &modal, &ranking));
            assert_near(ranking.value[0], ranking.value[1], 0.0);
            /* |b||c| / (4 zeta w^2) of the stronger; hankel a zeta more */
            assert_near(ranking.value[0], 3.0 / 0.16 * (r ? 1.01005 : 1.0),
                        1e-4);
            assert_int_equal(ranking.cluster[1], 0);
            assert_int_equal(ranking.cluster[2], 2);
            assert_int_equal(ranking.order[0], 0);
            assert_int_equal(ranking.order[1], 1);
            assert_true(ranking.coupling < 0.1);
            ritz_ranking_free(&ranking);
        }
    }
}

/* At a gap of 2 zeta w Gregory's assumption is gone, at 1000 it holds. */
static void near_modes_are_flagged_and_named(void **state)
{
    double omega[] = {1.0, 10.0, 10.2};
    double zeta[] = {0.01, 0.01, 0.01};
    double one[] = {1.0, 1.0, 1.0};
    double none[3] = {0.0};
    const ritz_modal modal = {
        3, omega, zeta, {3, 1, one}, {1, 3, one}, {1, 3, none}, 0, {0}, {0}};
    ritz_ranking ranking = {0};

    (void)state;
    assert_ok(rank(&ritz_ranker_gregory, &modal, &ranking));
    assert_int_equal(ranking.coupled[0], 1);
    assert_int_equal(ranking.coupled[1], 2);
    assert_true(ranking.coupling > 0.5 && ranking.coupling <= 1.0);
    ritz_ranking_free(&ranking);
    omega[2] = 30.0;
    assert_ok(rank(&ritz_ranker_gregory, &modal, &ranking));
    assert_true(ranking.coupling < 0.05);
    ritz_ranking_free(&ranking);
}

/* Of a matrix and of ratios: zeta adds; limits divide; accelerations fold. */
static void damping_limits_and_accelerations_are_taken_in(void **state)
{
    double k[] = {0, 0, 0, 0, 4, 0, 0, 0, 9};
    double m[] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    double d[] = {0, 0, 0, 0, 0.08, 0, 0, 0, 0.06};
    const ritz_dense K = {3, 3, k};
    const ritz_dense M = {3, 3, m};
    const ritz_dense D = {3, 3, d};
    const ritz_damping damping = {.kind = RITZ_DAMPING_MODAL, .zeta = 0.01};
    RITZ_OWN(ritz_io) io = {0};
    RITZ_OWN(ritz_modal) modal = {0};

    (void)state;
    assert_ok(ritz_io_new(3, 1, 1, &io));
    io.B.val[0] = io.B.val[1] = io.B.val[2] = 1.0;
    io.Ca.val[1] = io.Ca.val[2] = 1.0;
    io.limit[0] = 0.5;
    assert_ok(ritz_modal_new(&K, &M, &D, &io, &damping, &modal));
    assert_int_equal(modal.count, 2); /* the rigid one is not ranked */
    assert_near(modal.zeta[0], 0.02 + 0.01, 1e-15);
    assert_near(modal.zeta[1], 0.01 + 0.01, 1e-15);
    assert_near(modal.C.val[0], -4.0 / 0.5, 1e-14);
    assert_near(modal.Cv.val[1], -2.0 * 0.02 * 3.0 / 0.5, 1e-14);
}

static void what_cannot_be_ranked_is_refused_in_words(void **state)
{
    double k[] = {4, 0, 0, 9};
    double m[] = {1, 0, 0, 1};
    double d[] = {0.1, 0.05, 0.05, 0.1};
    const ritz_dense K = {2, 2, k};
    const ritz_dense M = {2, 2, m};
    const ritz_dense D = {2, 2, d};
    RITZ_OWN(ritz_io) io = {0};
    RITZ_OWN(ritz_modal) modal = {0};
    ritz_ranking ranking = {0};

    (void)state;
    assert_ok(ritz_io_new(2, 1, 0, &io));
    assert_fails(ritz_modal_new(&K, &M, NULL, &io, NULL, &modal),
                 RITZ_ERR_ARGUMENT, "0.31831 Hz has no damping");
    d[1] = d[2] = d[3] = 0.0;
    assert_fails(ritz_modal_new(&K, &M, &D, &io, NULL, &modal),
                 RITZ_ERR_ARGUMENT, "0.477465 Hz has no damping");
    d[3] = 0.1;
    assert_ok(ritz_modal_new(&K, &M, &D, &io, NULL, &modal));
    assert_fails(rank(&ritz_ranker_hankel, &modal, &ranking), RITZ_ERR_ARGUMENT,
                 "at least one input and one output");
}

/*
 * Damping couples modes 1 and 3 of four by 0.5 of their own damping, and modes
 * 2 and 3 by 0.05: modes 1 and 3 are one cluster with one value, though mode 2
 * lies between them.
 */
static void modes_that_damping_couples_have_one_value(void **state)
{
    double omega[] = {1.0, 2.0, 3.0, 4.0};
    double zeta[] = {0.1, 0.05, 1.0 / 30.0, 0.025};
    double delta[] = {0.2, 0.0,  0.1,  0.0, 0.0, 0.2, 0.01, 0.0,
                      0.1, 0.01, 0.20, 0.0, 0.0, 0.0, 0.00, 0.2};
    double b[] = {1.0, 2.0, -1.0, 1.0}, c[] = {1.0, 1.0, 1.0, 0.5};
    double none[4] = {0.0};
    const ritz_modal modal = {4,         omega,         zeta,
                              {4, 1, b}, {1, 4, c},     {1, 4, none},
                              0,         {4, 4, delta}, {0}};
    static const bool both[] = {true, false, true, false};
    RITZ_OWN(ritz_modal) pair = {0};
    RITZ_OWN(ritz_ranking) ranking = {0}, light = {0}, cost = {0};
    double sigma[4];

    (void)state;
    assert_ok(ritz_modal_part(&modal, both, NULL, &pair));
    assert_ok(ritz_modal_hankel(&pair, NULL, sigma));
    assert_ok(rank(&ritz_ranker_hankel, &modal, &ranking));
    assert_int_equal(ranking.cluster[2], 0);
    assert_int_equal(ranking.cluster[1], 1);
    assert_near(ranking.value[0], sigma[0], 0.0);
    assert_near(ranking.value[2], sigma[0], 0.0);
    assert_int_equal(ranking.num_system, 8);
    /* modes in no cluster have their own damping: zeta of 0.05 and 0.025 */
    assert_near(ranking.value[1], 2.0 / 0.8 * (sqrt(1.0025) + 0.05), 1e-14);
    assert_near(ranking.value[3], 0.5 / 1.6 * (sqrt(1.000625) + 0.025), 1e-14);
    /* gregory and modal-cost rank each mode by itself */
    assert_ok(rank(&ritz_ranker_gregory, &modal, &light));
    assert_int_equal(light.cluster[2], 2);
    assert_near(light.value[0], 1.0 / 0.4, 1e-14);
    assert_ok(rank(&ritz_ranker_modal_cost, &modal, &cost));
    assert_int_equal(cost.cluster[2], 2);
    assert_near(cost.value[0] + cost.value[1] + cost.value[2] + cost.value[3],
                cost.total, 1e-13 * cost.total);
}

/* A damper that couples two modes leaves 1e-17 of damping on a third mode. This
   is rounding, and the mode counts as undamped. */
static void rounding_of_a_damper_is_no_damping(void **state)
{
    double k[] = {4, 0, 0, 0, 9, 0, 0, 0, 16};
    double m[] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    double d[] = {0.1, 0.05, 0, 0.05, 0.1, 0, 0, 0, 1e-17};
    const ritz_dense K = {3, 3, k}, M = {3, 3, m}, D = {3, 3, d};
    RITZ_OWN(ritz_io) io = {0};
    RITZ_OWN(ritz_modal) modal = {0};
    RITZ_OWN(ritz_ranking) ranking = {0};

    (void)state;
    assert_ok(ritz_io_new(3, 1, 1, &io));
    for (int i = 0; i < 3; i++)
        io.B.val[i] = io.C.val[i] = 1.0;
    assert_ok(ritz_modal_new(&K, &M, &D, &io, NULL, &modal));
    for (int by = 0; by < 2; by++)
        assert_fails(rank(by ? &ritz_ranker_gregory : &ritz_ranker_hankel,
                          &modal, &ranking),
                     RITZ_ERR_ARGUMENT,
                     "the mode at 0.63662 Hz has no damping");
}

static void rankings_are_found_by_name_or_nearly(void **state)
{
    (void)state;
    for (const ritz_ranker *const *r = ritz_rankers; *r; r++)
        assert_ptr_equal(ritz_ranker_find((*r)->name), *r);
    assert_null(ritz_ranker_find("hankle"));
    assert_non_null(strstr(ritz_error_message(), "is 'hankel' meant?"));
}

static ritz_status rank_once(const fixture *f)
{
    const ritz_damping damping = {.kind = RITZ_DAMPING_MODAL, .zeta = 0.01};
    RITZ_OWN(ritz_modal) modal = {0};
    RITZ_OWN(ritz_ranking) light = {0};
    RITZ_OWN(ritz_ranking) exact = {0};

    RITZ_CHECK(ritz_modal_new(&f->K, &f->M, NULL, &f->io, &damping, &modal));
    RITZ_CHECK(rank(&ritz_ranker_gregory, &modal, &light));
    RITZ_CHECK(rank(&ritz_ranker_hankel, &modal, &exact));
    return RITZ_OK;
}

static void ranking_survives_every_allocation(void **state)
{
    assert_survives_every_allocation(rank_once(*state));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_cantilever_has_the_published_frequencies),
    cmocka_unit_test(gregory_gives_the_published_values_in_order),
    cmocka_unit_test(exact_hankel_values_are_the_published_pairs),
    cmocka_unit_test(one_mode_has_the_closed_form_pair),
    cmocka_unit_test(hankel_values_are_the_eigenvalues_of_the_product),
    cmocka_unit_test(a_cluster_has_one_value_whatever_spans_it),
    cmocka_unit_test(near_modes_are_flagged_and_named),
    cmocka_unit_test(damping_limits_and_accelerations_are_taken_in),
    cmocka_unit_test(what_cannot_be_ranked_is_refused_in_words),
    cmocka_unit_test(modes_that_damping_couples_have_one_value),
    cmocka_unit_test(rounding_of_a_damper_is_no_damping),
    cmocka_unit_test(rankings_are_found_by_name_or_nearly),
    cmocka_unit_test(ranking_survives_every_allocation),
};

TEST_MODULE(ranking, tests, set_up, tear_down)
