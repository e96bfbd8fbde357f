/* Values of each ranking: closed forms, identities, refusals. */
#include "testing.h"

#include "dualspin.h"
#include "frame.h"
#include "gramians/modes.h"
#include "scenes.h"

#include <ritz/assembly.h>
#include <ritz/matrix.h>
#include <ritz/ranking.h>

#include <lapacke.h>
#include <stdlib.h>

enum { MODES = 9, INPUTS = 2, OUTPUTS = 3, STATES = 2 * MODES };

/* Numbers in (-1, 1), the same everywhere. */
static double noise(uint64_t *seed)
{
    *seed =
        *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(*seed >> 11) / 4503599627370496.0 - 1.0;
}

/* Modes of every sort: two that couple, two of one frequency, others apart. */
static ritz_status some_modes(ritz_modal *out)
{
    static const double omega[MODES] = {1.0, 2.0, 2.01, 5.0, 5.0,
                                        7.0, 9.0, 11.0, 30.0};
    uint64_t seed = 5;

    out->count = MODES;
    RITZ_CHECK_NEW(out->omega, MODES);
    RITZ_CHECK_NEW(out->zeta, MODES);
    RITZ_CHECK(ritz_dense_new(MODES, INPUTS, &out->B));
    RITZ_CHECK(ritz_dense_new(OUTPUTS, MODES, &out->C));
    RITZ_CHECK(ritz_dense_new(OUTPUTS, MODES, &out->Cv));
    for (int k = 0; k < MODES; k++) {
        out->omega[k] = omega[k];
        out->zeta[k] = k == 5 ? 0.3 : 0.01;
    }
    for (int k = 0; k < MODES * INPUTS; k++)
        out->B.val[k] = noise(&seed);
    for (int k = 0; k < MODES * OUTPUTS; k++) {
        out->C.val[k] = noise(&seed);
        out->Cv.val[k] = 0.2 * noise(&seed);
    }
    return RITZ_OK;
}

static int set_up(void **state)
{
    static ritz_modal modal;

    modal = (ritz_modal){0};
    assert_ok(some_modes(&modal));
    *state = &modal;
    return 0;
}

static int tear_down(void **state)
{
    ritz_modal_free(*state);
    return 0;
}

static ritz_status rank(const ritz_ranker *ranker, const ritz_modal *modal,
                        ritz_ranking *out)
{
    const ritz_rank_request request = {.modal = *modal};

    return ritz_rank(ranker, &request, out);
}

/* --- closed forms
   ----------------------------------------------------------- */

/* H2 squared of one mode is b^2 c^2 / (4 zeta w^3), however damped. */
static void one_mode_has_its_cost_and_its_norm(void **state)
{
    static const double zeta[] = {0.9, 0.3, 0.01, 1e-4};
    double omega = 2.5;
    double b[] = {3.0, 4.0};
    double c[] = {1.0, 2.0, 2.0};
    double none[] = {0.0, 0.0, 0.0};

    (void)state;
    for (int k = 0; k < 4; k++) {
        double z = zeta[k];
        double cost = 25.0 * 9.0 / (4.0 * z * pow(omega, 3.0));
        const ritz_modal modal = {
            1, &omega, &z, {1, 2, b}, {3, 1, c}, {3, 1, none}, 0, {0}, {0}};
        ritz_ranking ranking = {0};

        /* a few roundings of positive terms */
        assert_ok(rank(&ritz_ranker_modal_cost, &modal, &ranking));
        assert_near(ranking.value[0], cost, 1e-14 * cost);
        assert_near(ranking.total, cost, 1e-14 * cost);
        assert_int_equal(ranking.num_parts, 3);
        assert_near(ranking.parts.val[1], cost * 4.0 / 9.0, 1e-14 * cost);
        assert_string_equal(ranking.part[2], "y3");
        ritz_ranking_free(&ranking);
        assert_ok(rank(&ritz_ranker_h2, &modal, &ranking));
        assert_near(ranking.value[0], sqrt(cost), 1e-14 * sqrt(cost));
        ritz_ranking_free(&ranking);
        assert_ok(rank(&ritz_ranker_participation, &modal, &ranking));
        assert_near(ranking.value[0], 5.0, 1e-15 * 5.0);
        assert_near(ranking.parts.val[1], 4.0, 0.0);
        ritz_ranking_free(&ranking);
    }
}

/* --- identities
   ------------------------------------------------------------- */

/* (B B')(a, b) in states (q_1, q_1', ...). */
static double driven(const ritz_modal *modal, int64_t a, int64_t b)
{
    double sum = 0.0;

    for (int64_t j = 0; a % 2 == 1 && b % 2 == 1 && j < INPUTS; j++)
        sum += ritz_dense_col(&modal->B, j)[a / 2] *
               ritz_dense_col(&modal->B, j)[b / 2];
    return sum;
}

/* trace(B' W_o B), which modal costs, made of W_c, do not use. */
static double norm_squared(const ritz_modal *modal)
{
    RITZ_OWN(ritz_dense) Wc = {0}, Wo = {0};
    double sum = 0.0;

    assert_ok(ritz_modal_gramians(modal, NULL, &Wc, &Wo));
    for (int64_t a = 0; a < STATES; a++)
        for (int64_t b = 0; b < STATES; b++)
            sum += driven(modal, a, b) * ritz_dense_col(&Wo, b)[a];
    return sum;
}

static void modal_costs_sum_to_the_norm_squared(void **state)
{
    const ritz_modal *modal = *state;
    RITZ_OWN(ritz_ranking) ranking = {0};
    double h2 = norm_squared(modal);
    double sum = 0.0, parts = 0.0;

    assert_ok(rank(&ritz_ranker_modal_cost, modal, &ranking));
    for (int k = 0; k < MODES; k++)
        sum += ranking.value[k];
    for (int k = 0; k < MODES * OUTPUTS; k++)
        parts += ranking.parts.val[k];
    /* STATES^2 terms of either sign, cancelling by less than 100 */
    assert_near(sum, h2, 100.0 * STATES * 2.2e-16 * h2);
    assert_near(ranking.total, h2, 100.0 * STATES * 2.2e-16 * h2);
    assert_near(parts, h2, 100.0 * STATES * 2.2e-16 * h2);
    /* a cluster shares evenly */
    assert_near(ranking.value[3], ranking.value[4], 0.0);
    assert_int_equal(ranking.cluster[4], 3);
}

/*
 * Two near modes of opposite sense, the second a weak one: what both share
 * outweighs its own variance, and its cost is negative; by magnitude it still
 * comes before a third that hardly counts.
 */
static void a_negative_cost_is_said_and_ranked_by_magnitude(void **state)
{
    double omega[] = {1.0, 1.001, 3.0};
    double zeta[] = {0.01, 0.01, 0.01};
    double b[] = {1.0, -0.2, 1e-3};
    double c[] = {1.0, 1.0, 1e-3};
    double none[3] = {0.0};
    const ritz_modal modal = {
        3, omega, zeta, {3, 1, b}, {1, 3, c}, {1, 3, none}, 0, {0}, {0}};
    RITZ_OWN(ritz_ranking) ranking = {0};

    (void)state;
    assert_ok(rank(&ritz_ranker_modal_cost, &modal, &ranking));
    assert_true(ranking.value[1] < 0.0);
    assert_true(ranking.total > 0.0);
    assert_int_equal(ranking.order[1], 1);
}

/* Apart and lightly damped, what modes share is gone: V_k = (h2 of k)^2. */
static void light_costs_are_the_squares_of_the_norms(void **state)
{
    double omega[] = {1.0, 3.0, 10.0};
    double zeta[] = {1e-4, 2e-4, 1e-4};
    double b[] = {1.0, -2.0, 3.0};
    double c[] = {1.0, 1.0, 0.5};
    double none[3] = {0.0};
    const ritz_modal modal = {
        3, omega, zeta, {3, 1, b}, {1, 3, c}, {1, 3, none}, 0, {0}, {0}};
    RITZ_OWN(ritz_ranking) cost = {0}, norm = {0};

    (void)state;
    assert_ok(rank(&ritz_ranker_modal_cost, &modal, &cost));
    assert_ok(rank(&ritz_ranker_h2, &modal, &norm));
    /* shared: at most sqrt(V_j V_k) (d_j + d_k) / gap, 1e-3 / 1 relative to
     * the larger; the smallest here is 1/500 of the largest */
    for (int k = 0; k < 3; k++)
        assert_near(cost.value[k], norm.value[k] * norm.value[k],
                    1e-3 * cost.value[0]);
}

static void a_band_without_ends_gives_the_whole_value(void **state)
{
    const ritz_modal *modal = *state;
    ritz_rank_request request = {.modal = *modal, .band_hz = {0.0, HUGE_VAL}};
    ritz_ranking band = {0}, all = {0};

    assert_ok(ritz_rank(&ritz_ranker_hankel_band, &request, &band));
    assert_ok(ritz_rank(&ritz_ranker_hankel, &request, &all));
    for (int k = 0; k < MODES; k++)
        assert_near(band.value[k], all.value[k], 1e-12 * all.value[k]);
    ritz_ranking_free(&band);
    /* 0.2 to 1 Hz: 1.26 to 6.3 rad/s; the sixth, at 7 rad/s and heavily
     * damped, is partly in it */
    request.band_hz[0] = 0.2;
    request.band_hz[1] = 1.0;
    assert_ok(ritz_rank(&ritz_ranker_hankel_band, &request, &band));
    for (int k = 0; k < MODES; k++) {
        /* inside, all but the flanks; outside, flanks alone: a part zeta w /
         * (pi gap) of either, 0.03 at most */
        if (k >= 1 && k <= 4)
            assert_true(band.value[k] > 0.9 * all.value[k]);
        else if (k != 5)
            assert_true(band.value[k] < 0.1 * all.value[k]);
        assert_true(band.value[k] <= all.value[k] * (1.0 + 1e-12));
    }
    ritz_ranking_free(&band);
    ritz_ranking_free(&all);
}

/* --- masses
   ----------------------------------------------------------------- */

/* The beam clamped at its left end, every mode of it. */
static ritz_status clamped_beam(ritz_reduced *out)
{
    static const int64_t driven_row[] = {1};
    static const int64_t seen_row[] = {4};
    RITZ_OWN(ritz_component) beam = {0};

    RITZ_CHECK(frame_component(4, 0.5, &frame_mcdaniel, true, false, 1, &beam));
    RITZ_CHECK(frame_io(&beam, 1, driven_row, 1, seen_row));
    RITZ_CHECK(reduce_with(&beam, &ritz_method_normal_modes, 12, out));
    return RITZ_OK;
}

static void effective_masses_sum_to_the_mass_that_moves(void **state)
{
    const ritz_rank_choice choice = {.damping = {0}};
    RITZ_OWN(ritz_reduced) beam = {0};
    RITZ_OWN(ritz_rank_request) request = {0};
    RITZ_OWN(ritz_ranking) ranking = {0};
    static const int planar[] = {0, 1, 5};

    (void)state;
    assert_ok(clamped_beam(&beam));
    assert_ok(ritz_rank_request_of_reduced(
        &beam, &choice, ritz_ranker_effective_mass.needs, &request));
    assert_true(request.undamped);
    assert_ok(ritz_rank(&ritz_ranker_effective_mass, &request, &ranking));
    assert_int_equal(ranking.num_parts, 6);
    for (int i = 0; i < 3; i++) {
        int d = planar[i];
        double sum = 0.0;

        for (int k = 0; k < 12; k++)
            sum += ritz_dense_col(&ranking.parts, d)[k];
        /* sum over all modes of r'M phi phi'M r = r'M r: the conditioning of
         * the eigenvectors, measured 1e-14 */
        assert_near(sum, ranking.whole[d], 1e-11 * ranking.whole[d]);
    }
    /* x alone is axial: modes 4, 7, 10, 11 carry it, the rest none of it */
    for (int k = 0; k < 12; k++) {
        bool axial = k == 3 || k == 6 || k == 9 || k == 10;
        double x = ritz_dense_col(&ranking.parts, 0)[k];

        assert_true(axial == (x > 1e-9 * ranking.whole[0]));
    }
    /* without damping nothing exact stands beside, and ratios are none */
    assert_int_equal(ranking.num_system, 0);
    assert_near(ranking.zeta[0], 0.0, 0.0);
    assert_true(isnan(ranking.coupling));
}

/*
 * The first bending mode of a clamped beam takes 61.3 % of its mass, the second
 * 18.8 % [Blevins2016]; of the frame's four elements, which leave the mass of
 * the clamped node out, of what they have.
 */
static void a_cantilever_has_the_effective_masses_of_the_books(void **state)
{
    const ritz_rank_choice choice = {.damping = {0}};
    const double rho = frame_mcdaniel.rho * frame_mcdaniel.area * 2.0;
    RITZ_OWN(ritz_reduced) beam = {0};
    RITZ_OWN(ritz_rank_request) request = {0};
    RITZ_OWN(ritz_ranking) ranking = {0};

    (void)state;
    assert_ok(clamped_beam(&beam));
    assert_ok(ritz_rank_request_of_reduced(
        &beam, &choice, ritz_ranker_effective_mass.needs, &request));
    assert_ok(ritz_rank(&ritz_ranker_effective_mass, &request, &ranking));
    /* four elements and a lumped support: measured 0.04 of the mass off */
    assert_near(ritz_dense_col(&ranking.parts, 1)[0] / rho, 0.613, 0.06);
    assert_near(ritz_dense_col(&ranking.parts, 1)[1] / rho, 0.188, 0.06);
}

/* The free beam with its left end as interface, all fixed-interface modes. */
static ritz_status held_beam(int64_t modes, ritz_reduced *out)
{
    RITZ_OWN(ritz_component) beam = {0};

    RITZ_CHECK(
        frame_component(4, 0.5, &frame_mcdaniel, false, false, 1, &beam));
    RITZ_CHECK(add_port(&beam, "root", 1));
    RITZ_CHECK(reduce_with(&beam, &ritz_method_craig_bampton, modes, out));
    return RITZ_OK;
}

static ritz_status rank_held(const ritz_reduced *beam, ritz_ranking *out)
{
    const ritz_rank_choice choice = {.damping = {0}};
    const ritz_ranker *ranker = &ritz_ranker_effective_interface_mass;
    RITZ_OWN(ritz_rank_request) request = {0};

    RITZ_CHECK(
        ritz_rank_request_of_reduced(beam, &choice, ranker->needs, &request));
    RITZ_CHECK(ritz_rank(ranker, &request, out));
    return RITZ_OK;
}

/* trace(M_s^-1 (M_bb - M_bi M_ii^-1 M_ib)) of the beam, root rows first. */
static double held_by_the_root(const ritz_reduced *reduced)
{
    enum { ROOT = 3, REST = 12 };
    RITZ_OWN(ritz_component) beam = {0};
    RITZ_OWN(ritz_dense) M = {0};
    double M_ii[REST * REST], X[REST * ROOT], own[ROOT * ROOT];
    double M_s[ROOT * ROOT];

    assert_ok(frame_component(4, 0.5, &frame_mcdaniel, false, false, 1, &beam));
    assert_ok(ritz_sparse_dense(&beam.M, &M));
    for (int j = 0; j < REST; j++)
        for (int i = 0; i < REST; i++)
            M_ii[i + REST * j] = ritz_dense_col(&M, ROOT + j)[ROOT + i];
    for (int j = 0; j < ROOT; j++)
        for (int i = 0; i < REST; i++)
            X[i + REST * j] = ritz_dense_col(&M, j)[ROOT + i];
    assert_int_equal(
        LAPACKE_dposv(LAPACK_COL_MAJOR, 'L', REST, ROOT, M_ii, REST, X, REST),
        0);
    for (int j = 0; j < ROOT; j++)
        for (int i = 0; i < ROOT; i++) {
            own[i + ROOT * j] = ritz_dense_col(&M, j)[i];
            M_s[i + ROOT * j] = ritz_dense_col(&reduced->M, j)[i];
            for (int k = 0; k < REST; k++)
                own[i + ROOT * j] -=
                    ritz_dense_col(&M, i)[ROOT + k] * X[k + REST * j];
        }
    assert_int_equal(
        LAPACKE_dposv(LAPACK_COL_MAJOR, 'L', ROOT, ROOT, M_s, ROOT, own, ROOT),
        0);
    return own[0] + own[4] + own[8];
}

/*
 * All modes together give M_s less M_bb - M_bi M_ii^-1 M_ib, what the root
 * holds by itself.
 */
static void interface_masses_sum_to_what_the_interior_carries(void **state)
{
    RITZ_OWN(ritz_reduced) beam = {0};
    RITZ_OWN(ritz_ranking) ranking = {0};
    double sum = 0.0;

    (void)state;
    assert_ok(held_beam(12, &beam));
    assert_ok(rank_held(&beam, &ranking));
    assert_int_equal(ranking.count, 12);
    for (int k = 0; ranking.value && k < 12; k++)
        sum += ranking.value[k];
    assert_near(sum, ranking.total, 1e-14);
    /* the conditioning of M_s and of the eigenvectors: measured 1e-13 */
    assert_near(sum, 1.0 - held_by_the_root(&beam) / 3.0, 1e-11);
}

/* The 12 effective masses of the beam clamped there, but for its origin. */
static void held_modes_are_those_of_the_clamped_beam(void **state)
{
    const ritz_rank_choice choice = {.damping = {0}};
    RITZ_OWN(ritz_reduced) beam = {0}, clamped = {0};
    RITZ_OWN(ritz_rank_request) request = {0};
    RITZ_OWN(ritz_ranking) held = {0}, fixed = {0};

    (void)state;
    assert_ok(held_beam(12, &beam));
    assert_ok(clamped_beam(&clamped));
    assert_ok(rank_held(&beam, &held));
    assert_ok(ritz_rank_request_of_reduced(
        &clamped, &choice, ritz_ranker_effective_mass.needs, &request));
    assert_ok(ritz_rank(&ritz_ranker_effective_mass, &request, &fixed));
    for (int k = 0; held.hertz && fixed.hertz && k < 12; k++) {
        assert_near(held.hertz[k], fixed.hertz[k], 1e-9 * fixed.hertz[k]);
        /* phi'M r with r of the root too: its rows of M add what the clamped
         * beam leaves out, and both are found apart: not the same numbers but
         * of the same modes */
        assert_true(
            (ritz_dense_col(&held.parts, 0)[k] > 1e-9 * held.whole[0]) ==
            (ritz_dense_col(&fixed.parts, 0)[k] > 1e-9 * fixed.whole[0]));
    }
}

/*
 * The joined spacecraft moves freely, so that its rigid motions R are among its
 * modes: sum_k L_k L_k' = R'MR wherever the joint has turned the rotor. That
 * holds of no other placement of the bodies.
 */
static void a_joined_system_knows_its_mass_in_rigid_motion(void **state)
{
    static const double setting[] = {60.0, 0.0};
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_configuration) c = {0};
    RITZ_OWN(ritz_dense) sum = {0};

    (void)state;
    dualspin_or_skip();
    assert_ok(dualspin_stage(&scene, &stage));
    assert_ok(ritz_stage_assemble(&stage, setting, &c));
    assert_int_equal(c.momentum.nrow, 6);
    assert_ok(ritz_dense_mul_nt(&c.momentum, &c.momentum, &sum));
    for (int k = 0; k < 36; k++) /* rounding of inertias: measured 3e-15 */
        assert_near(sum.val[k], c.rigid[k], 1e-10 * ritz_dense_max(&sum));
}

/* --- weights
   ---------------------------------------------------------------- */

/* Q replaces 1 / limit^2; W is of intensities; both enter a cost as factors. */
static void weights_are_factors_of_costs(void **state)
{
    ritz_weights weights = {0};
    ritz_rank_choice choice = {
        .damping = {.kind = RITZ_DAMPING_MODAL, .zeta = 0.01}};
    RITZ_OWN(ritz_reduced) beam = {0};
    ritz_rank_request request = {0};
    ritz_ranking plain = {0}, weighed = {0};

    (void)state;
    assert_ok(clamped_beam(&beam));
    if (beam.io.limit)
        beam.io.limit[0] = 0.5;
    assert_ok(ritz_rank_request_of_reduced(
        &beam, &choice, ritz_ranker_modal_cost.needs, &request));
    assert_ok(ritz_rank(&ritz_ranker_modal_cost, &request, &plain));
    assert_string_equal(plain.part[0], "y1");
    ritz_rank_request_free(&request);
    assert_ok(ritz_weights_parse("u1=9", "y1=2", &weights));
    choice.weights = &weights;
    assert_ok(ritz_rank_request_of_reduced(
        &beam, &choice, ritz_ranker_modal_cost.needs, &request));
    assert_ok(ritz_rank(&ritz_ranker_modal_cost, &request, &weighed));
    for (int k = 0; k < 12; k++) /* 9 and 2 instead of 1 and 4 */
        assert_near(weighed.value[k], plain.value[k] * 4.5,
                    1e-13 * weighed.total);
    ritz_ranking_free(&plain);
    ritz_ranking_free(&weighed);
    ritz_weights_free(&weights);
    ritz_rank_request_free(&request);
    /* nothing is left of an output without weight */
    assert_ok(ritz_weights_parse(NULL, "y1=0", &weights));
    assert_ok(ritz_rank_request_of_reduced(
        &beam, &choice, ritz_ranker_modal_cost.needs, &request));
    assert_ok(ritz_rank(&ritz_ranker_modal_cost, &request, &weighed));
    assert_near(weighed.total, 0.0, 0.0);
    ritz_ranking_free(&weighed);
    ritz_rank_request_free(&request);
    ritz_weights_free(&weights);
}

static void weights_are_refused_in_words(void **state)
{
    static const struct {
        const char *text, *words;
    } bad[] = {
        {"u1", "'u1' is not NAME=WEIGHT"},
        {"u1=", "'' is no weight of 'u1'"},
        {"u1=-1", "'-1' is no weight of 'u1': a number, not negative"},
        {"u1=nan", "'nan' is no weight"},
        {"u1=1,u1=2", "'u1' has two weights"},
        {"u1=1,", "'' is not NAME=WEIGHT"},
        {"", "'' is not NAME=WEIGHT"},
        {"=1", "weights of outputs"},
    };
    RITZ_OWN(ritz_weights) weights = {0};
    ritz_rank_choice choice = {.weights = &weights};
    RITZ_OWN(ritz_reduced) beam = {0};
    ritz_rank_request request = {0};

    (void)state;
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++)
        assert_fails(ritz_weights_parse(NULL, bad[k].text, &weights),
                     RITZ_ERR_ARGUMENT, bad[k].words);
    assert_ok(clamped_beam(&beam));
    assert_ok(ritz_weights_parse("u2=1", NULL, &weights));
    assert_fails(ritz_rank_request_of_reduced(&beam, &choice, 0, &request),
                 RITZ_ERR_ARGUMENT,
                 "there is no input 'u2' to weigh, is 'u1' meant?");
}

/* --- refusals
   --------------------------------------------------------------- */

static void rankings_say_what_they_lack(void **state)
{
    const ritz_modal *modal = *state;
    ritz_rank_request request = {.modal = *modal};
    RITZ_OWN(ritz_ranking) ranking = {0};

    assert_fails(ritz_rank(&ritz_ranker_hankel_band, &request, &ranking),
                 RITZ_ERR_ARGUMENT, "hankel-band: there is no band");
    assert_fails(ritz_rank(&ritz_ranker_effective_mass, &request, &ranking),
                 RITZ_ERR_ARGUMENT, "does not know its mass in rigid motion");
    assert_fails(
        ritz_rank(&ritz_ranker_effective_interface_mass, &request, &ranking),
        RITZ_ERR_ARGUMENT, "not modes of an interface that is held");
    request.undamped = true;
    assert_fails(ritz_rank(&ritz_ranker_modal_cost, &request, &ranking),
                 RITZ_ERR_ARGUMENT, "modal-cost: the modes have no damping");
    assert_ok(ritz_rank(&ritz_ranker_participation, &request, &ranking));
    assert_int_equal(ranking.num_system, 0);
}

static void masses_of_other_models_are_refused(void **state)
{
    const ritz_rank_choice choice = {
        .damping = {.kind = RITZ_DAMPING_MODAL, .zeta = 0.01}};
    const ritz_configuration nothing = {0};
    RITZ_OWN(ritz_component) beam = {0};
    RITZ_OWN(ritz_reduced) free_beam = {0};
    ritz_rank_request request = {0};
    ritz_ranking ranking = {0};

    (void)state;
    assert_ok(frame_component(4, 0.5, &frame_mcdaniel, false, false, 1, &beam));
    assert_ok(reduce_with(&beam, &ritz_method_normal_modes, 9, &free_beam));
    assert_ok(ritz_rank_request_of_reduced(
        &free_beam, &choice, ritz_ranker_effective_mass.needs, &request));
    assert_fails(ritz_rank(&ritz_ranker_effective_mass, &request, &ranking),
                 RITZ_ERR_ARGUMENT, "rigid modes carry all of the mass");
    ritz_rank_request_free(&request);
    assert_fails(rank_held(&free_beam, &ranking), RITZ_ERR_ARGUMENT,
                 "the component has no constraint modes");
    assert_fails(ritz_rank_request_of_configuration(
                     &nothing, &choice,
                     ritz_ranker_effective_interface_mass.needs, &request),
                 RITZ_ERR_ARGUMENT, "a system has no interface to hold");
}

/* --- every allocation
   ------------------------------------------------------- */

static ritz_status rank_by_all(const ritz_modal *modal)
{
    const ritz_rank_request request = {.modal = *modal, .band_hz = {0.1, 1.0}};
    ritz_ranking ranking = {0};

    for (int r = 0; ritz_rankers[r]; r++) {
        if (ritz_rankers[r]->needs & (RITZ_RANK_MOMENTUM | RITZ_RANK_INTERFACE))
            continue;
        RITZ_CHECK(ritz_rank(ritz_rankers[r], &request, &ranking));
        ritz_ranking_free(&ranking);
    }
    return RITZ_OK;
}

static ritz_status rank_masses(const ritz_reduced *beam)
{
    RITZ_OWN(ritz_weights) weights = {0};
    const ritz_rank_choice choice = {
        .damping = {.kind = RITZ_DAMPING_MODAL, .zeta = 0.01},
        .weights = &weights};
    RITZ_OWN(ritz_rank_request) request = {0};
    RITZ_OWN(ritz_ranking) ranking = {0};

    RITZ_CHECK(ritz_weights_parse("u1=2", "y1=3", &weights));
    RITZ_CHECK(ritz_rank_request_of_reduced(
        beam, &choice, ritz_ranker_effective_mass.needs, &request));
    RITZ_CHECK(ritz_rank(&ritz_ranker_effective_mass, &request, &ranking));
    return RITZ_OK;
}

static ritz_status rank_held_once(const ritz_reduced *beam)
{
    RITZ_OWN(ritz_ranking) ranking = {0};

    RITZ_CHECK(rank_held(beam, &ranking));
    return RITZ_OK;
}

static void rankers_survive_every_allocation(void **state)
{
    RITZ_OWN(ritz_reduced) held = {0}, clamped = {0};

    assert_ok(held_beam(4, &held));
    assert_ok(clamped_beam(&clamped));
    assert_survives_every_allocation(rank_by_all(*state));
    assert_survives_every_allocation(rank_masses(&clamped));
    assert_survives_every_allocation(rank_held_once(&held));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(one_mode_has_its_cost_and_its_norm),
    cmocka_unit_test(modal_costs_sum_to_the_norm_squared),
    cmocka_unit_test(a_negative_cost_is_said_and_ranked_by_magnitude),
    cmocka_unit_test(light_costs_are_the_squares_of_the_norms),
    cmocka_unit_test(a_band_without_ends_gives_the_whole_value),
    cmocka_unit_test(effective_masses_sum_to_the_mass_that_moves),
    cmocka_unit_test(a_cantilever_has_the_effective_masses_of_the_books),
    cmocka_unit_test(interface_masses_sum_to_what_the_interior_carries),
    cmocka_unit_test(held_modes_are_those_of_the_clamped_beam),
    cmocka_unit_test(a_joined_system_knows_its_mass_in_rigid_motion),
    cmocka_unit_test(weights_are_factors_of_costs),
    cmocka_unit_test(weights_are_refused_in_words),
    cmocka_unit_test(rankings_say_what_they_lack),
    cmocka_unit_test(masses_of_other_models_are_refused),
    cmocka_unit_test(rankers_survive_every_allocation),
};

TEST_MODULE(rankers, tests, set_up, tear_down)
