#include "testing.h"

#include "masses.h"

#include "poles/h2.h"
#include "spring_chain.h"

#include <ritz/basis.h>
#include <ritz/tuning.h>

#include <float.h>
#include <stdio.h>
#include <stdlib.h>

static const double eps = DBL_EPSILON;
static const ritz_disturbance white = {0};
#define KEEP ((double)NAN) /* not tuned */

/* --- Two masses ----------------------------------------------------------- */

/* Mass m_1 = 2 on a spring k_1 = 50 is pushed and observed; only the damper and
   its spring connect m_2 to it. */
typedef struct absorber {
    ritz_dense K, M;
    ritz_io io;
    ritz_dampers dampers;
    ritz_second_order matrices;
    ritz_model model;
} absorber;

static const double m_1 = 2.0, k_1 = 50.0;

static void make_absorber(double m_2, absorber *a)
{
    assert_ok(ritz_dense_new(2, 2, &a->K));
    assert_ok(ritz_dense_new(2, 2, &a->M));
    assert_ok(ritz_io_new(2, 1, 1, &a->io));
    assert_ok(ritz_dampers_new(2, 1, &a->dampers));
    a->K.val[0] = k_1;
    a->M.val[0] = m_1;
    a->M.val[3] = m_2;
    a->io.B.val[0] = a->io.C.val[0] = 1.0;
    a->dampers.B.val[0] = 1.0;
    a->dampers.B.val[1] = -1.0;
    (void)snprintf(a->dampers.name[0], RITZ_NAME_SIZE, "absorber");
    a->matrices = (ritz_second_order){&a->K, &a->M, NULL, NULL, &a->io};
    a->model = ritz_model_of_dense(&a->matrices, NULL);
    a->model.dampers = &a->dampers;
}

static void absorber_free(absorber *a)
{
    ritz_dense_free(&a->K);
    ritz_dense_free(&a->M);
    ritz_io_free(&a->io);
    ritz_dampers_free(&a->dampers);
}

static const int64_t first[] = {0};

/* Near its minimum a norm is flat: comparing norms finds c and k to the root of
   rounding only, slopes find them far better. 1e-6 was measured. */
enum { MEASURED = 1000000 };

/*
 * A tuned mass damper under white noise [Warburton1982]: with mu = m_2 / m_1,
 *
 *     w_2 / w_1 = sqrt(1 + mu / 2) / (1 + mu),
 *     zeta_2 = sqrt(mu (1 + 3 mu / 4) / (4 (1 + mu) (1 + mu / 2)))
 */
static void a_mass_damper_is_tuned_as_warburton_does(void **state)
{
    static const double mu[] = {0.01, 0.05, 0.2, 1.0};

    (void)state;
    for (int t = 0; t < 4; t++) {
        double m_2 = mu[t] * m_1, w_1 = sqrt(k_1 / m_1);
        double w = w_1 * sqrt(1.0 + 0.5 * mu[t]) / (1.0 + mu[t]);
        double zeta = sqrt(mu[t] * (1.0 + 0.75 * mu[t]) /
                           (4.0 * (1.0 + mu[t]) * (1.0 + 0.5 * mu[t])));
        double c = 2.0 * zeta * m_2 * w, k = m_2 * w * w;
        const ritz_tuned one = {1, first, {0.0, 100.0}, {0.01, 100.0}};
        RITZ_OWN(absorber) a = {0};
        RITZ_OWN(ritz_tuning) found = {0};
        ritz_tuning_request request = {.count = 1, .tuned = &one};
        ritz_variance v = {0};
        RITZ_OWN(ritz_plant) plant = {0};

        make_absorber(m_2, &a);
        request.model = a.model;
        assert_ok(ritz_tuning_of(&request, &found));
        assert_near(found.c[0], c, c / MEASURED);
        assert_near(found.k[0], k, k / MEASURED);
        assert_true(found.before == HUGE_VAL);
        assert_int_equal(found.modes, 0);
        assert_true(found.agreed >= 1 && found.agreed <= found.starts);
        assert_true(found.slope < 1e-4);
        /* the norm is that of the formula's values, to rounding */
        assert_ok(ritz_plant_new(a.model, &white, &plant));
        plant.dampers.c[0] = c;
        plant.dampers.k[0] = k;
        assert_ok(ritz_variance_of(&plant, &v));
        assert_near(found.norm, sqrt(v.square), 1e-11 * found.norm);
    }
}

/*
 * Without a spring (Lanchester's damper) the variance is
 *
 *     (k m_2^2 + c^2 (m_1 + m_2)) / (2 k^2 c m_2^2)
 *
 * and least at c = m_2 sqrt(k / (m_1 + m_2)).
 */
static void a_mass_on_a_dashpot_has_its_best_rate(void **state)
{
    const double m_2 = 0.7, c = m_2 * sqrt(k_1 / (m_1 + m_2));
    const double J = (m_1 + m_2) * c / (k_1 * k_1 * m_2 * m_2);
    const ritz_tuned one = {1, first, {0.0, 1e4}, {KEEP, KEEP}};
    RITZ_OWN(absorber) a = {0};
    RITZ_OWN(ritz_tuning) found = {0};
    ritz_tuning_request request = {.count = 1, .tuned = &one};

    (void)state;
    make_absorber(m_2, &a);
    a.dampers.c[0] = 2.0 * c;
    request.model = a.model;
    assert_ok(ritz_tuning_of(&request, &found));
    assert_near(found.c[0], c, c / MEASURED);
    assert_true(isnan(found.k[0]));
    assert_near(found.norm, sqrt(J), 1e-12 * sqrt(J));
    /* at twice the best rate the variance is (1 + 4) / (2 * 2) of the least */
    assert_near(found.before, sqrt(1.25 * J), 1e-12 * sqrt(J));
}

/* The variance 1 / (2 c k) falls with c and with k, up to their limits. */
static void a_falling_norm_ends_at_the_limits(void **state)
{
    double K = 50.0, M = 2.0;
    const ritz_dense A[] = {{1, 1, &K}, {1, 1, &M}};
    const ritz_tuned one = {1, first, {1.0, 8.0}, {-20.0, 30.0}};
    RITZ_OWN(ritz_io) io = {0};
    RITZ_OWN(ritz_dampers) dampers = {0};
    const ritz_second_order matrices = {&A[0], &A[1], NULL, NULL, &io};
    ritz_tuning_request request = {.count = 1, .tuned = &one};
    RITZ_OWN(ritz_tuning) found = {0};

    (void)state;
    assert_ok(ritz_io_new(1, 1, 1, &io));
    assert_ok(ritz_dampers_new(1, 1, &dampers));
    io.B.val[0] = io.C.val[0] = dampers.B.val[0] = 1.0;
    request.model = ritz_model_of_dense(&matrices, NULL);
    request.model.dampers = &dampers;
    assert_ok(ritz_tuning_of(&request, &found));
    assert_near(found.c[0], 8.0, 0.0);
    assert_near(found.k[0], 30.0, 0.0);
    assert_near(found.norm, 1.0 / sqrt(2.0 * 8.0 * 80.0), 20.0 * eps);
    assert_near(found.slope, 0.0, 0.0);
}

/* --- The damper chain ----------------------------------------------------- */

/* Computed by SciPy 1.10 as roots of the gradient, which takes two Lyapunov
   equations; low-pass filter of 2 Hz and order 6. */
static const ritz_disturbance low = {2.0, 6};
static const double best_c[3] = {688.90667744, 913.97088458, 876.47812947};
static const double best_norm = 0.0708066201363;
/* norm(c (1 + h)) = norm(c) (1 + curvature h^2 / 2); smallest of three */
static const double curvature = 0.0724;
static const double alike_c = 786.86550522, alike_norm = 0.0710585979998;
/* Tuned in a model of 12 modes without static responses: the norm of this model
   and, with the same dampers, that of the full model. */
static const double truncated_c[3] = {2427.12, 3637.51, 6088.26};
static const double truncated_norm = 0.03845141097, truncated_full = 0.1037881;

static const int64_t all[] = {0, 1, 2};
static const ritz_tuned each[] = {
    {1, all, {0.0, 10000.0}, {KEEP, KEEP}},
    {1, all + 1, {0.0, 10000.0}, {KEEP, KEEP}},
    {1, all + 2, {0.0, 10000.0}, {KEEP, KEEP}},
};

static void a_chain_is_tuned_in_full_and_in_its_space(void **state)
{
    RITZ_OWN(ritz_component) chain = {0};
    ritz_tuning_request request = {
        .noise = low, .count = 3, .tuned = each, .modes = 8};
    /* an error `off` of the norm moves its minimum by h */
    const double off = 1e-12, h = sqrt(2.0 * off / best_norm / curvature);

    (void)state;
    assert_ok(chain_component(30, &chain));
    request.model = ritz_model_of_component(&chain, NULL);
    for (int k = 0; k < 2; k++) {
        RITZ_OWN(ritz_tuning) found = {0};

        request.most_full = k == 0 ? 30 : 10;
        assert_ok(ritz_tuning_of(&request, &found));
        assert_int_equal(found.modes, k == 0 ? 0 : 8);
        assert_near(found.before, k == 0 ? 0.1165942546 : 0.1165941394,
                    5.1e-11);
        for (int j = 0; j < 3; j++)
            assert_near(found.c[j], best_c[j], k == 0 ? h * best_c[j] : 0.1);
        assert_near(found.norm, best_norm, k == 0 ? off : 1e-10);
        assert_near(found.tuned, k == 0 ? best_norm : 0.07080524664, 1e-11);
    }
}

/* Whether a damper is installed in the matrices or not, tuning gives the
   same. */
static void installed_dampers_are_tuned_too(void **state)
{
    const ritz_tuned alike = {3, all, {0.0, 10000.0}, {KEEP, KEEP}};
    ritz_tuning_request request = {.noise = low, .count = 1, .tuned = &alike};

    (void)state;
    for (int k = 0; k < 2; k++) {
        RITZ_OWN(ritz_component) chain = {0};
        RITZ_OWN(ritz_tuning) found = {0};

        assert_ok(chain_component(30, &chain));
        if (k == 1)
            assert_ok(ritz_component_install(&chain));
        request.model = ritz_model_of_component(&chain, NULL);
        assert_ok(ritz_tuning_of(&request, &found));
        assert_near(found.c[0], alike_c, 1e-4);
        assert_near(found.norm, alike_norm, 1e-12);
        assert_near(found.before, 0.1165942546, 5.1e-11);
    }
}

/* As [ChuMilman1992] found, a model of truncated modes asks for dampers that
   are far too strong, and promises a norm that the full model does not have. */
static void truncated_modes_mislead(void **state)
{
    ritz_tuning_request request = {.noise = low, .count = 3, .tuned = each};
    RITZ_OWN(ritz_component) chain = {0};
    ritz_request modes = RITZ_REQUEST_NONE;
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) small = {0};
    RITZ_OWN(ritz_tuning) found = {0};
    ritz_h2 h2 = {0};

    (void)state;
    assert_ok(chain_component(30, &chain));
    modes.component = &chain;
    modes.modes = 12;
    modes.choice.loads = RITZ_LOADS_ATTACHED; /* and not the dampers */
    modes.choice.given = RITZ_USES_LOADS;
    assert_ok(ritz_basis_make(&ritz_method_macneal_rubin, &modes, &basis));
    assert_ok(ritz_reduce(&chain, &basis, &small));
    request.model = ritz_model_of_reduced(&small, NULL);
    assert_ok(ritz_tuning_of(&request, &found));
    for (int j = 0; j < 3; j++)
        assert_near(found.c[j], truncated_c[j], 0.05);
    assert_near(found.norm, truncated_norm, 5.1e-11);
    assert_ok(ritz_h2_with(ritz_model_of_component(&chain, NULL), &low, found.c,
                           chain.dampers.k, &h2));
    assert_near(h2.value, truncated_full, 5.1e-8);
}

/* A space of modes and static responses that is too small for the noise is
   doubled. */
static void a_space_that_is_too_small_is_doubled(void **state)
{
    ritz_tuning_request request = {
        .noise = white, .count = 3, .tuned = each, .modes = 4, .most_full = 10};
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_tuning) found = {0};

    (void)state;
    assert_ok(chain_component(30, &chain));
    request.model = ritz_model_of_component(&chain, NULL);
    assert_ok(ritz_tuning_of(&request, &found));
    assert_int_equal(found.modes, 0); /* 4, 8, 16 modes, then the full model */
    /* computed by SciPy for the full model */
    assert_near(found.c[0], 694.27943448, 1e-3);
    assert_near(found.c[2], 79.88961158, 1e-3);
    assert_near(found.norm, 0.0800510044358, 1e-12);
}

/* --- Places --------------------------------------------------------------- */

enum { CANDIDATES = 6 };
static const int64_t spring[CANDIDATES] = {0, 3, 5, 8, 11, 14};

/* The chain with dampers across other springs, each of which is a candidate. */
static void make_candidates(ritz_component *chain, int64_t *index,
                            ritz_tuned *tuned)
{
    ritz_dampers dampers = {0};

    assert_ok(chain_component(30, chain));
    assert_ok(ritz_dampers_new(30, CANDIDATES, &dampers));
    for (int64_t j = 0; j < CANDIDATES; j++) {
        double *b = ritz_dense_col(&dampers.B, j);

        (void)snprintf(dampers.name[j], RITZ_NAME_SIZE, "s%d", (int)spring[j]);
        b[spring[j]] = 1.0;
        if (spring[j] > 0)
            b[spring[j] - 1] = -1.0;
        /* has no effect unless the candidate is taken */
        dampers.c[j] = 7.0;
        index[j] = j;
        tuned[j] = (ritz_tuned){1, index + j, {0.0, 4000.0}, {0.0, 0.0}};
    }
    ritz_dampers_free(&chain->dampers);
    chain->dampers = dampers;
}

/* Computed by SciPy 1.10: each candidate alone, and all pairs; damping ratio
   0.002. */
static const double alone_c[CANDIDATES] = {580.04851133, 696.77342595,
                                           932.64488459, 579.53387277,
                                           714.67265539, 822.36660255};
static const double alone_norm[CANDIDATES] = {0.0870801877557, 0.0971993560421,
                                              0.115015741518,  0.103444646474,
                                              0.118691473577,  0.131744454982};
static const double pair_c[2] = {588.39077706, 730.40346515};
static const double pair_norm[6] = {0.06525679846, 0.06552441152,
                                    0.06997252681, 0.07000458636,
                                    0.07038866023, 0.07393694777};
static const int64_t pair[6][2] = {{0, 1}, {0, 3}, {0, 4},
                                   {0, 2}, {1, 3}, {0, 5}};

static void places_are_those_of_an_exhaustive_search(void **state)
{
    int64_t index[CANDIDATES];
    ritz_tuned tuned[CANDIDATES];
    RITZ_OWN(ritz_component) chain = {0};
    ritz_damping damping = {0};
    ritz_placing_request request = {
        .tuning = {.noise = low, .count = CANDIDATES, .tuned = tuned},
        .places = 2};

    (void)state;
    make_candidates(&chain, index, tuned);
    assert_ok(ritz_damping_parse("modal 0.002", &damping));
    request.tuning.model = ritz_model_of_component(&chain, &damping);
    for (int k = 0; k < 2; k++) {
        RITZ_OWN(ritz_placing) found = {0};

        request.tuning.most_full = k == 0 ? 30 : 10;
        request.tuning.modes = 10;
        request.among = k == 0 ? CANDIDATES : 4;
        assert_ok(ritz_placing_of(&request, &found));
        assert_near(found.none, 0.29034472465, k == 0 ? 5.1e-11 : 1e-7);
        assert_int_equal(found.num_choices, k == 0 ? 15 : 6);
        for (int j = 0; j < CANDIDATES; j++) {
            assert_near(found.c[j], alone_c[j], k == 0 ? 1e-3 : 0.1);
            assert_near(found.alone[j], alone_norm[j],
                        k == 0 ? 1e-11 : 1e-5 * alone_norm[j]);
        }
        assert_int_equal(found.places, 2);
        assert_int_equal(found.num_next, 5);
        for (int j = 0; j < 2; j++) {
            assert_int_equal(found.taken[j], pair[0][j]);
            assert_near(found.tuning.c[j], pair_c[j], k == 0 ? 1e-3 : 0.1);
        }
        assert_near(found.tuning.norm, pair_norm[0], 5.1e-11);
        for (int j = 0; k == 0 && j < 5; j++) {
            assert_near(found.next_norm[j], pair_norm[j + 1], 5.1e-11);
            assert_memory_equal(found.next + 2 * j, pair[j + 1],
                                sizeof pair[0]);
        }
    }
}

/* --- Refusals and allocations --------------------------------------------- */

static void wrong_requests_are_refused(void **state)
{
    static const int64_t bad[] = {7};
    static const ritz_tuned cases[][2] = {
        {{1, all, {-1.0, 2.0}, {KEEP, KEEP}}, {0}},
        {{1, all, {3.0, 2.0}, {KEEP, KEEP}}, {0}},
        {{1, all, {KEEP, KEEP}, {3.0, 2.0}}, {0}},
        {{1, all, {KEEP, KEEP}, {KEEP, 2.0}}, {0}},
        {{1, all, {0.0, 2.0}, {KEEP, KEEP}},
         {1, all, {0.0, 2.0}, {KEEP, KEEP}}},
        {{1, bad, {0.0, 2.0}, {KEEP, KEEP}}, {0}},
        {{1, all, {2.0, 2.0}, {KEEP, KEEP}}, {0}},
    };
    static const char *const words[] = {
        "c of damper 'a' cannot be from -1 to 2",
        "c of damper 'a' cannot be from 3 to 2",
        "k of damper 'a' cannot be from 3 to 2",
        "k of damper 'a' cannot be from nan to 2",
        "damper 'a' is tuned twice",
        "there is no damper 8",
        "no value of a damper has a range to be tuned in",
    };
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_state_space) space = {0};
    RITZ_OWN(absorber) a = {0};
    ritz_tuning_request request = {.noise = low, .count = 2};
    ritz_placing_request places = {.places = 4};
    ritz_tuning found = {0};
    ritz_placing placing = {0};

    (void)state;
    assert_ok(chain_component(30, &chain));
    request.model = ritz_model_of_component(&chain, NULL);
    for (size_t t = 0; t < sizeof cases / sizeof *cases; t++) {
        request.tuned = cases[t];
        assert_fails(ritz_tuning_of(&request, &found), RITZ_ERR_ARGUMENT,
                     words[t]);
    }
    assert_ok(
        ritz_state_space_of_component(&chain, &(ritz_damping){0}, &space));
    request.model = ritz_model_of_states(&space);
    request.tuned = each;
    assert_fails(ritz_tuning_of(&request, &found), RITZ_ERR_ARGUMENT,
                 "the model has no dampers to tune");
    request.model = ritz_model_of_component(&chain, NULL);
    request.count = 3;
    places.tuning = request;
    assert_fails(ritz_placing_of(&places, &placing), RITZ_ERR_ARGUMENT,
                 "4 places of 3 candidates cannot be taken");
    places.places = 3;
    places.among = 2;
    assert_fails(ritz_placing_of(&places, &placing), RITZ_ERR_ARGUMENT,
                 "3 places among the 2 best candidates cannot be taken");
    make_absorber(0.5, &a); /* m_2 is observed; its spring is negative */
    a.io.C.val[1] = 1.0;
    request = (ritz_tuning_request){
        .count = 1,
        .tuned = (const ritz_tuned[]){{1, first, {0.0, 0.0}, {-3.0, -2.0}}}};
    request.model = a.model;
    assert_fails(ritz_tuning_of(&request, &found), RITZ_ERR_ARGUMENT,
                 "the H2 norm is infinite wherever it was tried");
}

static void a_norm_of_zero_is_not_tuned(void **)
{
    static const ritz_tuned tuned[] = {{1, first, {0.5, 2.0}, {3.0, 3.0}}};
    RITZ_OWN(absorber) a = {0};
    ritz_tuning_request request = {.count = 1, .tuned = tuned};
    ritz_tuning found = {0};

    make_absorber(0.5, &a);
    a.io.C.val[0] = 0.0;
    request.model = a.model;
    assert_fails(ritz_tuning_of(&request, &found), RITZ_ERR_ARGUMENT,
                 "the H2 norm is 0 whatever the dampers do: no output "
                 "observes what the inputs drive");
}

static void too_many_combinations_are_refused(void **state)
{
    enum { MANY = 24 };
    int64_t index[MANY];
    ritz_tuned tuned[MANY];
    RITZ_OWN(absorber) a = {0};
    RITZ_OWN(ritz_dampers) many = {0};
    ritz_placing_request request = {
        .tuning = {.count = MANY, .tuned = tuned, .most = 1},
        .places = 12,
        .among = MANY};
    ritz_placing found = {0};

    (void)state;
    make_absorber(0.5, &a);
    assert_ok(ritz_dampers_new(2, MANY, &many));
    for (int64_t j = 0; j < MANY; j++) {
        (void)snprintf(many.name[j], RITZ_NAME_SIZE, "d%d", (int)j);
        ritz_dense_col(&many.B, j)[0] = 1.0;
        ritz_dense_col(&many.B, j)[1] = -1.0;
        index[j] = j;
        tuned[j] = (ritz_tuned){1, index + j, {0.0, 9.0}, {0.0, 0.0}};
    }
    request.tuning.model = a.model;
    request.tuning.model.dampers = &many;
    assert_fails(ritz_placing_of(&request, &found), RITZ_ERR_ARGUMENT,
                 "12 places of 24 candidates are 2.7e+06 combinations, which "
                 "are too many");
}

/* As few evaluations as possible: each makes some seventy allocations, all of
   which fail in turn. */
static ritz_status place_one(const ritz_component *chain)
{
    const ritz_placing_request request = {
        .tuning = {.model = ritz_model_of_component(chain, NULL),
                   .count = 1,
                   .tuned = each,
                   .modes = 1,
                   .most = 1,
                   .most_full = 3},
        .places = 1};
    RITZ_OWN(ritz_placing) found = {0};

    return ritz_placing_of(&request, &found);
}

static void no_allocation_is_forgotten(void **state)
{
    static const int64_t two[] = {2}, end[] = {3};
    RITZ_OWN(ritz_component) chain = {0};

    (void)state;
    assert_ok(spring_chain(4, false, &chain));
    assert_ok(spring_chain_damp(&chain, 1, two, 5.0, 0.0));
    assert_ok(masses_io(&chain, 1, end, 1, end));
    assert_survives_allocations(4, place_one(&chain));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_mass_damper_is_tuned_as_warburton_does),
    cmocka_unit_test(a_mass_on_a_dashpot_has_its_best_rate),
    cmocka_unit_test(a_falling_norm_ends_at_the_limits),
    cmocka_unit_test(a_chain_is_tuned_in_full_and_in_its_space),
    cmocka_unit_test(installed_dampers_are_tuned_too),
    cmocka_unit_test(truncated_modes_mislead),
    cmocka_unit_test(a_space_that_is_too_small_is_doubled),
    cmocka_unit_test(places_are_those_of_an_exhaustive_search),
    cmocka_unit_test(wrong_requests_are_refused),
    cmocka_unit_test(a_norm_of_zero_is_not_tuned),
    cmocka_unit_test(too_many_combinations_are_refused),
    cmocka_unit_test(no_allocation_is_forgotten),
};

TEST_MODULE(tune, tests, NULL, NULL)
