#include "testing.h"

#include "balancing.h"
#include "frame.h"
#include "masses.h"
#include "spaces.h"

#include "gramians/modes.h"
#include "linear/general.h"

#include <ritz/basis.h>
#include <ritz/model.h>
#include <ritz/poles.h>

#include <complex.h>
#include <float.h>
#include <stdio.h>
#include <stdlib.h>

/* SLICOT's example of AB09AD, AB09BD and AB13AD: data and results. */
enum { STATES = 7, INPUTS = 2, OUTPUTS = 3, ORDER = 5 };
static const double A7[STATES * STATES] = {
    -0.04165, 0,     4.92,  -4.92, 0,        0,     0,     /**/
    -5.21,    -12.5, 0,     0,     0,        0,     0,     /**/
    0,        3.33,  -3.33, 0,     0,        0,     0,     /**/
    0.545,    0,     0,     0,     -0.545,   0,     0,     /**/
    0,        0,     0,     4.92,  -0.04165, 0,     4.92,  /**/
    0,        0,     0,     0,     -5.21,    -12.5, 0,     /**/
    0,        0,     0,     0,     0,        3.33,  -3.33, /**/
};
static const double B7[STATES * INPUTS] = {0, 0, 12.5, 0, 0,    0, 0,
                                           0, 0, 0,    0, 12.5, 0, 0};
static const double C7[OUTPUTS * STATES] = {1, 0, 0, 0, 0, 0, 0, /**/
                                            0, 0, 0, 1, 0, 0, 0, /**/
                                            0, 0, 0, 0, 1, 0, 0};
static const spaces_rows slicot = {
    .states = STATES, .inputs = INPUTS, .outputs = OUTPUTS, A7, B7, C7};

static double hankel_error(const ritz_gramians *g, int64_t count,
                           const double *expected, double down_to, double *rest)
{
    int64_t found = 0;
    double *sigma = NULL;
    double worst = 0.0;

    *rest = 0.0;
    assert_ok(ritz_gramians_hankel(g, &found, &sigma));
    assert_true(found >= count);
    for (int64_t k = 0; k < count; k++) {
        double gap = fabs(sigma[k] - expected[k]);

        if (expected[k] >= down_to * expected[0])
            worst = fmax(worst, gap / expected[k]);
        else
            *rest = fmax(*rest, gap / expected[0]);
    }
    free(sigma);
    return worst;
}

/* 1e-9 down to 1e-8 of the largest, 1e-11 of the largest below. */
static void stored_hankel_values_are_found(void **unused)
{
    static const char *const name[] = {"building", "CDplayer", "heat-cont"};

    (void)unused;
    for (int k = 0; k < 3; k++) {
        RITZ_OWN(ritz_state_space) model = {0};
        RITZ_OWN(ritz_gramians) g = {0};
        double *stored = NULL;
        double worst = 0.0, rest = 0.0;
        int64_t count = 0;

        if (!spaces_read(name[k], &model))
            skip();
        count = spaces_numbers(name[k], "hsv_stored_by_authors.txt", &stored);
        assert_int_equal(count, model.A.nrow);
        assert_ok(ritz_gramians_of_space(&model, &g));
        assert_string_equal(g.engine, "SLICOT SB03OD");
        assert_int_equal(g.T.ncol, 0);
        worst = hankel_error(&g, count, stored, 1e-8, &rest);
        printf("%s: %.1e relative, %.1e of the largest below\n", name[k], worst,
               rest);
        assert_near(worst, 0.0, 1e-9);
        assert_near(rest, 0.0, 1e-11);
        free(stored);
    }
}

/* Printed with four decimals. */
static void slicot_publishes_these_hankel_values(void **unused)
{
    static const double printed[] = {2.5139, 2.0846, 1.9178, 0.7666,
                                     0.5473, 0.0253, 0.0246};
    RITZ_OWN(ritz_state_space) model = {0};
    RITZ_OWN(ritz_gramians) g = {0};
    int64_t count = 0;
    double *sigma = NULL;

    (void)unused;
    assert_ok(spaces_make(&slicot, &model));
    assert_ok(ritz_gramians_of_space(&model, &g));
    assert_ok(ritz_gramians_hankel(&g, &count, &sigma));
    assert_int_equal(count, STATES);
    for (int k = 0; k < STATES; k++)
        assert_near(sigma[k], printed[k], 5e-5);
    assert_near(sigma[0], 2.51388, 5e-6); /* AB13AD prints one more */
    free(sigma);
}

/* AB09AD's reduced model of order 5: every entry is rounded to 5e-5, and their
   effect on the response was measured to be 3e-4 of a norm of 5.5. */
static void slicot_publishes_this_reduced_model(void **unused)
{
    static const double A5[] = {
        1.3451,  5.0399,  0,       0,       4.5315,  /**/
        -4.0214, -3.6604, 0,       0,       -0.9056, /**/
        0,       0,       0.5124,  1.7910,  0,       /**/
        0,       0,       -4.2167, -2.9900, 0,       /**/
        1.2402,  1.6416,  0,       0,       -0.0586};
    static const double B5[] = {-0.3857, 0.3857,  -3.1753, 3.1753, -0.7447,
                                -0.7447, -3.6872, -3.6872, 1.8197, -1.8197};
    static const double C5[] = {-0.6704, 0.1828,  -0.6582, 0.2222, -0.0104,
                                0.1089,  0.4867,  0,       0,      0.8651,
                                0.6704,  -0.1828, -0.6582, 0.2222, 0.0104};
    static const spaces_rows printed = {
        .states = ORDER, .inputs = INPUTS, .outputs = OUTPUTS, A5, B5, C5};
    RITZ_OWN(ritz_state_space) model = {0}, theirs = {0}, ours = {0};
    RITZ_OWN(ritz_gramians) g = {0};
    RITZ_OWN(ritz_balanced) b = {0};

    (void)unused;
    assert_ok(spaces_make(&slicot, &model));
    assert_ok(spaces_make(&printed, &theirs));
    assert_ok(ritz_gramians_of_space(&model, &g));
    assert_ok(ritz_gramians_balance(&g, -1, 0.1 / 2.5139, &b));
    assert_int_equal(b.kept, ORDER);
    assert_int_equal(b.count, STATES);
    assert_ok(spaces_project(&model, &b.W, &b.T, &ours));
    assert_near(balancing_error(&ours, &theirs), 0.0, 1e-3);
}

/* b / (s + a) has b c / 2 a; a mode has |b||c|/(4 z w^2) (sqrt(1+z^2) +- z). */
static void small_models_have_their_closed_forms(void **unused)
{
    static const double zeta[] = {0.7, 0.01, 1e-4, 1e-6};
    const double w = 300.0, gain[] = {2.0}, lag[] = {-5.0}, seen[] = {3.0};
    const spaces_rows first = {1, 1, 1, lag, gain, seen, NULL, NULL};
    ritz_state_space model = {0};
    ritz_gramians g = {0};
    double rest = 0.0;

    (void)unused;
    assert_ok(spaces_make(&first, &model));
    assert_ok(ritz_gramians_of_space(&model, &g));
    assert_near(
        hankel_error(&g, 1, &(const double){2.0 * 3.0 / 10.0}, 0.0, &rest), 0.0,
        4 * DBL_EPSILON);
    ritz_gramians_free(&g);
    ritz_state_space_free(&model);
    for (size_t k = 0; k < sizeof zeta / sizeof *zeta; k++) {
        const double A[] = {0, 1, -w * w, -2 * zeta[k] * w};
        const double B[] = {0, 1}, C[] = {1, 0};
        const spaces_rows mode = {2, 1, 1, A, B, C, NULL, NULL};
        double size = 1.0 / (4.0 * zeta[k] * w * w);
        double root = sqrt(1.0 + zeta[k] * zeta[k]);
        const double pair[] = {size * (root + zeta[k]),
                               size * (root - zeta[k])};

        assert_ok(spaces_make(&mode, &model));
        assert_ok(ritz_gramians_of_space(&model, &g));
        assert_int_equal(g.T.ncol, 0);
        /* a pole at distance zeta w is known to eps w */
        assert_near(hankel_error(&g, 2, pair, 0.0, &rest), 0.0,
                    16 * DBL_EPSILON / zeta[k]);
        ritz_gramians_free(&g);
        ritz_state_space_free(&model);
    }
}

/* (s - 1)(s - 2) / (s + 1)(s + 2) passes all: values of 1, and a bound that is
   met where nothing is left. */
static void an_all_pass_has_equal_values_and_meets_its_bound(void **unused)
{
    static const double A[] = {0, 1, -2, -3}, B[] = {0, 1}, C[] = {0, -6},
                        D[] = {1};
    const spaces_rows rows = {2, 1, 1, A, B, C, D, NULL};
    RITZ_OWN(ritz_state_space) model = {0}, none = {0};
    RITZ_OWN(ritz_gramians) g = {0};
    RITZ_OWN(ritz_balanced) b = {0};
    ritz_norm norm = {0};

    (void)unused;
    assert_ok(spaces_make(&rows, &model));
    assert_ok(ritz_gramians_of_space(&model, &g));
    assert_ok(ritz_gramians_balance(&g, 1, 0.0, &b));
    assert_near(b.sigma[0], 1.0, 16 * DBL_EPSILON);
    assert_near(b.sigma[1], 1.0, 16 * DBL_EPSILON);
    assert_int_equal(b.kept, 0); /* not one without the other */
    assert_near(b.bound, 2.0, 32 * DBL_EPSILON);
    assert_ok(ritz_norm_infinity(&model, 1e-9, &norm));
    assert_near(norm.value, 1.0, 1e-9);
    assert_ok(spaces_project(&model, &b.W, &b.T, &none));
    assert_int_equal(none.A.nrow, 0);
    assert_near(balancing_error(&model, &none), 2.0, 1e-6);
}

/* [Moore1981]: sigma_(r+1) <= error <= 2 sum of the rest. */
static void the_error_is_within_its_bound(void **unused)
{
    static const int64_t order[] = {2, 4, 8, 15, 25, 40};
    RITZ_OWN(ritz_state_space) model = {0};
    RITZ_OWN(ritz_gramians) g = {0};

    (void)unused;
    if (!spaces_read("building", &model))
        skip();
    assert_ok(ritz_gramians_of_space(&model, &g));
    for (size_t k = 0; k < sizeof order / sizeof *order; k++) {
        RITZ_OWN(ritz_balanced) b = {0};
        RITZ_OWN(ritz_state_space) reduced = {0};
        double error = 0.0;

        assert_ok(ritz_gramians_balance(&g, order[k], 0.0, &b));
        assert_int_equal(b.kept, order[k]);
        assert_ok(spaces_project(&model, &b.W, &b.T, &reduced));
        error = balancing_error(&model, &reduced);
        assert_true(error <= b.bound);
        assert_true(error >= b.sigma[b.kept] * (1.0 - 1e-6));
    }
}

enum { MIXED = 11, APART = 6 };

/* A fixed sequence of numbers in (-1, 1), the same everywhere. */
static double noise(uint64_t *seed)
{
    *seed =
        *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(*seed >> 11) / 4503599627370496.0 - 1.0;
}

static void scatter(int64_t count, uint64_t *seed, double *out)
{
    for (int64_t k = 0; k < count; k++)
        out[k] = noise(seed);
}

/*
 * Poles -1, -3, -4, -0.1 +- 2i; 0 twice in one chain, +-3i, 0.5, and 0 alone:
 * behind E L (R states), L and R full. E {0}: L = R^-1.
 */
static void mix(bool with_E, ritz_state_space *out)
{
    static const double block[MIXED][3] = {
        {-1, 0, 0},    {-3, 0, 0},  {-4, 0, 0}, {-0.1, 2, 0},
        {-0.1, -2, 0}, {0, 1, 0},   {0, 0, 0},  {0, 3, 0},
        {0, -3, 0},    {0.5, 0, 0}, {0, 0, 0},
    };
    uint64_t seed = 11;
    double zero[MIXED * MIXED] = {0}, B[MIXED * 2], C[2 * MIXED], D[4];
    spaces_rows rows = {MIXED, 2, 2, zero, B, C, D, zero};
    RITZ_OWN(ritz_dense) R = {0}, L = {0}, J = {0}, JR = {0};

    scatter(MIXED * 2, &seed, B);
    scatter(MIXED * 2, &seed, C);
    scatter(4, &seed, D);
    rows.E = with_E ? zero : NULL;
    assert_ok(spaces_make(&rows, out));
    assert_ok(ritz_dense_new(MIXED, MIXED, &R));
    assert_ok(ritz_dense_new(MIXED, MIXED, &L));
    assert_ok(ritz_dense_new(MIXED, MIXED, &J));
    scatter(MIXED * MIXED, &seed, R.val);
    scatter(MIXED * MIXED, &seed, L.val);
    for (int64_t i = 0; i < MIXED; i++) {
        int64_t beside = i == 4 || i == 8 ? i - 1 : i + 1;

        ritz_dense_col(&R, i)[i] += 3.0;
        ritz_dense_col(&L, i)[i] += 3.0;
        ritz_dense_col(&J, i)[i] = block[i][0];
        if (beside < MIXED)
            ritz_dense_col(&J, beside)[i] = block[i][1];
    }
    assert_ok(ritz_dense_mul(&J, &R, &JR));
    ritz_dense_free(&out->A);
    if (with_E) {
        ritz_dense_free(&out->E);
        assert_ok(ritz_dense_mul(&L, &JR, &out->A));
        assert_ok(ritz_dense_mul(&L, &R, &out->E));
    } else {
        assert_ok(ritz_general_solve(&R, false, &JR));
        assert_ok(ritz_dense_copy(&JR, &out->A));
    }
}

/* |model - (stable + apart - D)| over |model| at a few frequencies. */
static double parts_error(const ritz_state_space *model,
                          const ritz_state_space *stable,
                          const ritz_state_space *apart)
{
    static const double hertz[] = {0.01, 0.2, 0.3183, 0.7, 3.0};
    double worst = 0.0;

    for (size_t k = 0; k < sizeof hertz / sizeof *hertz; k++) {
        double _Complex *H = balancing_response(model, hertz[k]);
        double _Complex *S = balancing_response(stable, hertz[k]);
        double _Complex *R = balancing_response(apart, hertz[k]);
        double size = 0.0, gap = 0.0;

        for (int i = 0; i < 4; i++) {
            size = fmax(size, cabs(H[i]));
            gap = fmax(gap, cabs(H[i] - S[i] - R[i] + model->D.val[i]));
        }
        worst = fmax(worst, gap / size);
        free(H);
        free(S);
        free(R);
    }
    return worst;
}

/* Largest |W'E T - I|. */
static double biorthogonality(const ritz_state_space *model,
                              const ritz_dense *W, const ritz_dense *T)
{
    RITZ_OWN(ritz_dense) ET = {0};
    double worst = 0.0;

    if (model->E.val)
        assert_ok(ritz_dense_mul(&model->E, T, &ET));
    else
        assert_ok(ritz_dense_copy(T, &ET));
    for (int64_t i = 0; i < W->ncol; i++)
        for (int64_t j = 0; j < ET.ncol; j++)
            worst = fmax(worst, fabs(ritz_dense_dot(W, i, &ET, j) -
                                     (i == j ? 1.0 : 0.0)));
    return worst;
}

/* Rounding of eigenvectors whose condition is some 100, of matrices of size
   ten, and of the chain at 0. */
static void what_is_not_stable_stands_apart_exactly(void **unused)
{
    (void)unused;
    for (int with_E = 0; with_E < 2; with_E++) {
        RITZ_OWN(ritz_state_space) model = {0}, stable = {0}, apart = {0};
        RITZ_OWN(ritz_gramians) g = {0};
        RITZ_OWN(ritz_balanced) b = {0};

        mix(with_E, &model);
        assert_ok(ritz_gramians_of_space(&model, &g));
        assert_string_equal(g.engine,
                            with_E ? "SLICOT SG03BD" : "SLICOT SB03OD");
        assert_int_equal(g.T.ncol, APART);
        assert_int_equal(g.W.ncol, APART);
        assert_near(biorthogonality(&model, &g.W, &g.T), 0.0, 1e-11);
        assert_ok(ritz_gramians_balance(&g, -1, 0.0, &b));
        assert_int_equal(b.kept, MIXED - APART);
        assert_near(biorthogonality(&model, &b.W, &b.T), 0.0, 1e-11);
        assert_ok(spaces_project(&model, &b.W, &b.T, &stable));
        assert_ok(spaces_project(&model, &g.W, &g.T, &apart));
        assert_near(parts_error(&model, &stable, &apart), 0.0, 1e-10);
    }
}

/* 1 / (s + 1)^n in its stages: a Jordan block of n, whose eigenvalues rounding
   may move past the axis by their own bound, but not as they are connected. */
static void a_cascade_of_equal_stages_is_stable(void **unused)
{
    enum { N = 30 };
    static double A[N * N], B[N], C[N];
    static const spaces_rows rows = {N, 1, 1, A, B, C, NULL, NULL};
    RITZ_OWN(ritz_state_space) model = {0};
    RITZ_OWN(ritz_gramians) g = {0};

    (void)unused;
    for (int i = 0; i < N; i++) {
        A[i * N + i] = -1.0;
        if (i > 0)
            A[i * N + i - 1] = 1.0;
    }
    B[0] = 1.0;
    C[N - 1] = 1.0;
    assert_ok(spaces_make(&rows, &model));
    assert_ok(ritz_gramians_of_space(&model, &g));
    assert_int_equal(g.T.ncol, 0);
}

/* Free masses: position and velocity of the whole, whatever the damping. */
static void a_rigid_motion_stands_apart(void **unused)
{
    static const double m[] = {1, 2, 3, 1}, k[] = {0, 90, 40, 70};
    static const double c[] = {0, 0.3, 0.1, 0.2};
    static const int64_t at[] = {0};
    const ritz_damping none = {0};
    RITZ_OWN(ritz_component) free_body = {0};
    RITZ_OWN(ritz_state_space) model = {0};
    RITZ_OWN(ritz_gramians) g = {0};

    (void)unused;
    assert_ok(masses_component(4, m, k, c, &free_body));
    assert_ok(masses_io(&free_body, 1, at, 1, at));
    assert_ok(ritz_state_space_of_component(&free_body, &none, &model));
    assert_ok(ritz_gramians_of_space(&model, &g));
    assert_int_equal(g.T.ncol, 2);
    for (int64_t j = 0; j < 2; j++) {
        const double *t = ritz_dense_col(&g.T, j);

        for (int i = 1; i < 4; i++) { /* all move alike */
            assert_near(t[i], t[0], 1e-7);
            assert_near(t[4 + i], t[4], 1e-7);
        }
    }
}

/* The cantilever of [McDaniel2000] eq. 3.2.23, its inputs and outputs. */
static void set_beam(const frame_section *section, ritz_component *out)
{
    static const int64_t in[] = {1, 4, 6}, seen[] = {2, 5, 7, 8, 10, 11};

    assert_ok(frame_component(4, 0.5, section, true, false, 1, out));
    assert_ok(frame_io(out, 3, in, 6, seen));
}

static void dense(const ritz_sparse *A, ritz_dense *out)
{
    assert_ok(ritz_sparse_dense(A, out));
}

/* E = [I 0; 0 M], A = [0 I; -K -D], D = M Phi diag(2 zeta w) Phi'M taken from
   the form without E. */
static void with_mass(const ritz_component *beam, const ritz_state_space *plain,
                      ritz_state_space *out)
{
    int64_t n = beam->M.nrow;
    RITZ_OWN(ritz_dense) M = {0};

    dense(&beam->M, &M);
    assert_ok(ritz_state_space_new(2 * n, &beam->io, out));
    assert_ok(ritz_dense_new(2 * n, 2 * n, &out->E));
    for (int64_t j = 0; j < n; j++) {
        ritz_dense_col(&out->E, j)[j] = 1.0;
        for (int64_t i = 0; i < n; i++)
            ritz_dense_col(&out->E, n + j)[n + i] = ritz_dense_col(&M, j)[i];
    }
    ritz_dense_free(&out->A);
    ritz_dense_free(&out->B);
    ritz_dense_free(&out->C);
    assert_ok(ritz_dense_mul(&out->E, &plain->A, &out->A));
    assert_ok(ritz_dense_mul(&out->E, &plain->B, &out->B));
    assert_ok(ritz_dense_copy(&plain->C, &out->C));
}

/* oracles: 24-state Lyapunov equation, zeta = 0.01, to the digits shown. */
static void the_beam_has_its_published_pairs(void **unused)
{
    static const double sigma[] = {311.9906, 305.8131, 38.1731, 37.4174,
                                   6.50708,  6.37847,  2.68935, 2.63626,
                                   0.61677,  0.61255,  0.60423, 0.60051,
                                   0.21861,  0.21431,  0.10491, 0.10284};
    static const double digit[] = {5e-5, 5e-5, 5e-5, 5e-5, 5e-6, 5e-6,
                                   5e-6, 5e-6, 5e-6, 5e-6, 5e-6, 5e-6,
                                   5e-6, 5e-6, 5e-6, 5e-6};
    const ritz_damping damping = {.kind = RITZ_DAMPING_MODAL, .zeta = 0.01};
    RITZ_OWN(ritz_component) beam = {0};
    ritz_state_space model[2] = {0};

    (void)unused;
    set_beam(&frame_mcdaniel, &beam);
    assert_ok(ritz_state_space_of_component(&beam, &damping, &model[0]));
    with_mass(&beam, &model[0], &model[1]);
    for (int k = 0; k < 2; k++) {
        RITZ_OWN(ritz_gramians) g = {0};
        int64_t count = 0;
        double *found = NULL;

        assert_ok(ritz_gramians_of_space(&model[k], &g));
        assert_ok(ritz_gramians_hankel(&g, &count, &found));
        for (int i = 0; i < 16; i++)
            assert_near(found[i], sigma[i], digit[i]);
        assert_near(found[16], 0.0, 1e-9 * found[0]); /* not seen: 4 modes */
        free(found);
        ritz_state_space_free(&model[k]);
    }
}

/* The same beam of steel, with and without E, at zeta = 1e-4: entries of A from
   1 to 1e12. Closed form against Lyapunov equations. */
static void a_stiff_beam_agrees_with_the_closed_form(void **unused)
{
    static const frame_section steel = {
        .rho = 7800.0, .area = 1e-4, .inertia = 8.3e-10, .modulus = 2.1e11};
    const ritz_damping damping = {.kind = RITZ_DAMPING_MODAL, .zeta = 1e-4};
    RITZ_OWN(ritz_component) beam = {0};
    RITZ_OWN(ritz_dense) K = {0}, M = {0};
    RITZ_OWN(ritz_modal) modal = {0};
    ritz_state_space model[2] = {0};
    double sigma[24], rest = 0.0;

    (void)unused;
    set_beam(&steel, &beam);
    dense(&beam.K, &K);
    dense(&beam.M, &M);
    assert_ok(ritz_modal_new(&K, &M, NULL, &beam.io, &damping, &modal));
    assert_ok(ritz_modal_hankel(&modal, NULL, sigma));
    assert_ok(ritz_state_space_of_component(&beam, &damping, &model[0]));
    with_mass(&beam, &model[0], &model[1]);
    for (int k = 0; k < 2; k++) {
        RITZ_OWN(ritz_gramians) g = {0};

        assert_ok(ritz_gramians_of_space(&model[k], &g));
        assert_int_equal(g.T.ncol, 0);
        assert_string_equal(g.engine, "SLICOT SB03OD");
        /* poles 1e-4 of their size away from the axis; measured: 2e-9 */
        assert_near(hankel_error(&g, 16, sigma, 1e-8, &rest), 0.0, 1e-8);
        ritz_state_space_free(&model[k]);
    }
}

/* Outputs over limits: a limit of 1/8 of all outputs is 8 times as much. */
static void outputs_are_divided_by_their_limits(void **unused)
{
    RITZ_OWN(ritz_state_space) model = {0};
    ritz_gramians g = {0};
    int64_t count = 0;
    double *sigma = NULL, *scaled = NULL;

    (void)unused;
    assert_ok(spaces_make(&slicot, &model));
    assert_ok(ritz_gramians_of_space(&model, &g));
    assert_ok(ritz_gramians_hankel(&g, &count, &sigma));
    ritz_gramians_free(&g);
    for (int i = 0; i < OUTPUTS; i++)
        model.limit[i] = 0.125;
    assert_ok(ritz_gramians_of_space(&model, &g));
    assert_ok(ritz_gramians_hankel(&g, &count, &scaled));
    for (int k = 0; k < STATES; k++)
        assert_near(scaled[k], 8.0 * sigma[k], 1e-13 * scaled[0]);
    free(sigma);
    free(scaled);
    ritz_gramians_free(&g);
}

static void expect_refusal(const spaces_rows *rows, double limit,
                           ritz_status code, const char *words)
{
    RITZ_OWN(ritz_state_space) model = {0};
    ritz_gramians g = {0};

    assert_ok(spaces_make(rows, &model));
    if (model.num_outputs > 0)
        model.limit[0] = limit;
    assert_fails(ritz_gramians_of_space(&model, &g), code, words);
}

static void what_has_no_gramians_is_refused_in_words(void **unused)
{
    static const double A[] = {-1, 0, 0, -2}, one[] = {1, 1, 1, 1};
    static const double wrong[] = {-1, HUGE_VAL, 0, -2};
    const double none = nan("");

    (void)unused;
    expect_refusal(&(spaces_rows){2, 0, 1, A, one, one, NULL, NULL}, none,
                   RITZ_ERR_ARGUMENT,
                   "the model has no inputs: nothing of it is controllable");
    expect_refusal(&(spaces_rows){2, 1, 0, A, one, one, NULL, NULL}, none,
                   RITZ_ERR_ARGUMENT,
                   "the model has no outputs: nothing of it is observable");
    expect_refusal(&(spaces_rows){0, 1, 1, A, one, one, NULL, NULL}, none,
                   RITZ_ERR_ARGUMENT, "the model has no states");
    expect_refusal(&(spaces_rows){2, 1, 1, wrong, one, one, NULL, NULL}, none,
                   RITZ_ERR_FORMAT, "'A' is not finite");
    expect_refusal(&(spaces_rows){2, 1, 1, A, one, one, NULL, one}, none,
                   RITZ_ERR_FORMAT, "'E' is singular");
    expect_refusal(&(spaces_rows){2, 1, 1, A, one, one, NULL, NULL}, -2.0,
                   RITZ_ERR_ARGUMENT,
                   "output 'y1' has the limit -2, which is not positive");
}

/* All poles apart: nothing to balance, and T and W are all there is. */
static void a_model_without_stable_poles_has_none_to_balance(void **unused)
{
    static const double A[] = {0, 1, 0, 0}, B[] = {0, 1}, C[] = {1, 0};
    const spaces_rows rows = {2, 1, 1, A, B, C, NULL, NULL};
    RITZ_OWN(ritz_state_space) model = {0};
    RITZ_OWN(ritz_gramians) g = {0};
    RITZ_OWN(ritz_balanced) b = {0};

    (void)unused;
    assert_ok(spaces_make(&rows, &model));
    assert_ok(ritz_gramians_of_space(&model, &g));
    assert_int_equal(g.T.ncol, 2);
    assert_int_equal(g.Zc.ncol, 0);
    assert_near(biorthogonality(&model, &g.W, &g.T), 0.0, 8 * DBL_EPSILON);
    assert_ok(ritz_gramians_balance(&g, -1, 0.0, &b));
    assert_int_equal(b.count, 0);
}

static ritz_status gramians_once(const ritz_state_space *model)
{
    RITZ_OWN(ritz_gramians) g = {0};

    RITZ_CHECK(ritz_gramians_of_space(model, &g));
    return RITZ_OK;
}

static void gramians_survive_every_allocation(void **unused)
{
    static const double A[] = {-1, 0, 1, -1}, E[] = {2, 1, 1, 3};
    static const double B[] = {0, 1}, C[] = {1, 0};
    const spaces_rows rows = {2, 1, 1, A, B, C, NULL, E};
    ritz_state_space model = {0};

    (void)unused;
    for (int with_E = 0; with_E < 2; with_E++) {
        mix(with_E, &model);
        assert_survives_every_allocation(gramians_once(&model));
        ritz_state_space_free(&model);
    }
    assert_ok(spaces_make(&rows, &model)); /* by Cholesky factor */
    assert_survives_every_allocation(gramians_once(&model));
    ritz_state_space_free(&model);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(stored_hankel_values_are_found),
    cmocka_unit_test(slicot_publishes_these_hankel_values),
    cmocka_unit_test(slicot_publishes_this_reduced_model),
    cmocka_unit_test(small_models_have_their_closed_forms),
    cmocka_unit_test(an_all_pass_has_equal_values_and_meets_its_bound),
    cmocka_unit_test(the_error_is_within_its_bound),
    cmocka_unit_test(what_is_not_stable_stands_apart_exactly),
    cmocka_unit_test(a_cascade_of_equal_stages_is_stable),
    cmocka_unit_test(a_rigid_motion_stands_apart),
    cmocka_unit_test(the_beam_has_its_published_pairs),
    cmocka_unit_test(a_stiff_beam_agrees_with_the_closed_form),
    cmocka_unit_test(outputs_are_divided_by_their_limits),
    cmocka_unit_test(what_has_no_gramians_is_refused_in_words),
    cmocka_unit_test(a_model_without_stable_poles_has_none_to_balance),
    cmocka_unit_test(gramians_survive_every_allocation),
};

TEST_MODULE(gramians_space, tests, NULL, NULL)
