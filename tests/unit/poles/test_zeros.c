/* Zeros: closed forms, poles of held structures, cancellation, pencils. */
#include "masses.h"
#include "model/modal.h"
#include "poles/poles.h"
#include "spaces.h"
#include "testing.h"

#include <ritz/matrix.h>
#include <ritz/poles.h>

#include <complex.h>
#include <float.h>
#include <stdlib.h>

/* A row of masses as dense matrices. */
typedef struct chain {
    ritz_component component;
    ritz_structure dense;
    ritz_second_order model;
    int64_t count; /* of the zeros that were found last */
    double _Complex *zero;
} chain;

static void chain_new(int64_t n, const double *m, const double *k,
                      const double *c, chain *out)
{
    static const ritz_dense none = {0};

    *out = (chain){0};
    assert_ok(masses_component(n, m, k, c, &out->component));
    assert_ok(ritz_structure_of_component(&out->component, &out->dense));
    out->model = (ritz_second_order){
        .K = &out->dense.K, .M = &out->dense.M, .D = c ? &out->dense.D : &none};
}

static void chain_ends(chain *s, int64_t ins, const int64_t *in, int64_t outs,
                       const int64_t *seen)
{
    ritz_io_free(&s->component.io);
    assert_ok(masses_io(&s->component, ins, in, outs, seen));
    s->model.io = &s->component.io;
}

/* Of the first channel, or of all: @p due of them. */
static void chain_zeros(chain *s, int64_t channel, int64_t due)
{
    free(s->zero);
    assert_ok(ritz_zeros_of(ritz_model_of_dense(&s->model, NULL), channel,
                            channel, &s->count, &s->zero));
    assert_int_equal(s->count, due);
}

static void chain_free_all(chain *s)
{
    free(s->zero);
    ritz_structure_free(&s->dense);
    ritz_component_free(&s->component);
}

static void uneven(int64_t n, double *m, double *k, double *c)
{
    for (int64_t i = 0; i < n; i++) {
        m[i] = 1.0 + 0.1 * (double)(7 * i % 5);
        k[i] = 100.0 * (1.0 + 0.2 * (double)(3 * i % 4));
        c[i] = 0.01 * (double)(1 + 5 * i % 3);
    }
}

/* k1 / m2 of the part behind the driven mass, on the axis exactly. */
static void two_masses_have_the_zero_of_the_second_alone(void **state)
{
    const double m[] = {2.0, 0.5}, k[] = {30.0, 8.0};
    const int64_t first = 0, second = 1;
    chain s;

    (void)state;
    chain_new(2, m, k, NULL, &s);
    chain_ends(&s, 1, &first, 1, &first);
    chain_zeros(&s, 0, 2);
    /* a sum of two terms: a few roundings */
    assert_near(cimag(s.zero[0]), 4.0, 16 * DBL_EPSILON * 4.0);
    assert_near(creal(s.zero[0]), 0.0, 0.0);
    assert_true(s.zero[1] == conj(s.zero[0]));
    chain_ends(&s, 1, &first, 1, &second);
    chain_zeros(&s, 0, 0);
    chain_free_all(&s);
}

/* c s + k across the spring between, (m2 s^2 + c s + k) at its end. */
static void a_damped_pair_has_the_zeros_of_its_link(void **state)
{
    const double m[] = {2.0, 0.5}, k[] = {30.0, 8.0}, c[] = {0.3, 0.2};
    const int64_t first = 0, second = 1;
    double _Complex due = 0.0;
    chain s;

    (void)state;
    chain_new(2, m, k, c, &s);
    chain_ends(&s, 1, &first, 1, &second);
    chain_zeros(&s, 0, 1);
    /* far beyond the poles, where two modes all but cancel: measured 1.2e-13 */
    assert_near(cabs(s.zero[0] + 40.0), 0.0, 1e-12);
    chain_ends(&s, 1, &first, 1, &first);
    chain_zeros(&s, 0, 2);
    due = -0.2 + (double _Complex)_Complex_I * sqrt(16.0 - 0.04);
    assert_near(cabs(s.zero[0] - due), 0.0, 100 * DBL_EPSILON * cabs(due));
    assert_near(cabs(s.zero[1] - conj(due)), 0.0,
                100 * DBL_EPSILON * cabs(due));
    chain_free_all(&s);
}

/* What is left of a row whose mass `at` is held. */
static double *held_frequencies(int64_t n, const double *m, const double *k,
                                int64_t at)
{
    double *w = calloc((size_t)n, sizeof *w);
    RITZ_OWN(ritz_structure) left = {0};
    RITZ_OWN(ritz_component) row = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    int64_t keep[MASSES_MOST], count = 0;
    ritz_dense K = {0}, M = {0};

    assert_ok(masses_component(n, m, k, NULL, &row));
    assert_ok(ritz_structure_of_component(&row, &left));
    for (int64_t i = 0; i < n; i++)
        if (i != at)
            keep[count++] = i;
    assert_ok(ritz_dense_new(count, count, &K));
    assert_ok(ritz_dense_new(count, count, &M));
    for (int64_t j = 0; j < count; j++)
        for (int64_t i = 0; i < count; i++) {
            ritz_dense_col(&K, j)[i] =
                ritz_dense_col(&left.K, keep[j])[keep[i]];
            ritz_dense_col(&M, j)[i] =
                ritz_dense_col(&left.M, keep[j])[keep[i]];
        }
    assert_ok(ritz_eigen_dense(&K, &M, &pairs));
    assert_non_null(w);
    for (int64_t i = 0; i < count; i++)
        w[i] = sqrt(pairs.lambda[i]);
    ritz_dense_free(&K);
    ritz_dense_free(&M);
    return w;
}

/* Of 12 uneven masses, the sixth held. */
static void collocated_zeros_are_poles_of_the_held_structure(void **state)
{
    enum { N = 12 };
    double m[N], k[N], c[N];
    const int64_t at = 5;
    double *held = NULL;
    double _Complex *zero = NULL;
    int64_t count = 0;
    RITZ_OWN(ritz_pairs) pairs = {0};
    chain s;

    (void)state;
    uneven(N, m, k, c);
    held = held_frequencies(N, m, k, at);
    chain_new(N, m, k, NULL, &s);
    chain_ends(&s, 1, &at, 1, &at);
    assert_ok(ritz_zeros_of(ritz_model_of_dense(&s.model, NULL), 0, 0, &count,
                            &zero));
    assert_ok(ritz_eigen_dense(s.model.K, s.model.M, &pairs));
    assert_int_equal(count, 2 * (N - 1));
    for (int64_t j = 0; j < N - 1; j++) {
        assert_near(creal(zero[2 * j]), 0.0, 0.0);
        /* the eigensolver's n eps of the largest lambda, over 2 w */
        assert_near(cimag(zero[2 * j]), held[j],
                    N * DBL_EPSILON * pairs.lambda[N - 1] / held[j]);
        assert_true(zero[2 * j + 1] == conj(zero[2 * j]));
        assert_true(sqrt(pairs.lambda[j]) < cimag(zero[2 * j]));
        assert_true(cimag(zero[2 * j]) < sqrt(pairs.lambda[j + 1]));
    }
    free(zero);
    free(held);
    chain_free_all(&s);
}

/* Force at a, displacement at b > a: what hangs before a and behind b, each
   held there; n - 1 - (b - a) of them. */
static void zeros_between_are_those_of_both_ends(void **state)
{
    enum { N = 12 };
    double m[N], k[N], c[N];
    const int64_t a = 3, b = 7;
    double *before = NULL, *behind = NULL;
    chain s;

    (void)state;
    uneven(N, m, k, c);
    before = held_frequencies(a + 1, m, k, a);
    behind = held_frequencies(N - b, m + b, k + b, 0);
    chain_new(N, m, k, NULL, &s);
    chain_ends(&s, 1, &a, 1, &b);
    chain_zeros(&s, 0, 2 * (a + N - 1 - b));
    for (int64_t j = 0; j < s.count; j += 2) {
        double w = cimag(s.zero[j]), nearest = HUGE_VAL;

        for (int64_t i = 0; i < a; i++)
            nearest = fmin(nearest, fabs(w - before[i]));
        for (int64_t i = 0; i < N - 1 - b; i++)
            nearest = fmin(nearest, fabs(w - behind[i]));
        assert_near(creal(s.zero[j]), 0.0, 0.0);
        /* twelve terms that cancel each other: measured 2.4e-15 w */
        assert_near(nearest, 0.0, 1e-13 * w);
    }
    free(before);
    free(behind);
    chain_free_all(&s);
}

/* 60 masses apart the response above its band is below all rounding. */
static void a_wave_guide_has_no_zeros_of_rounding(void **state)
{
    enum { N = 60 };
    double m[N], k[N];
    const int64_t a = 0, b = N - 1;
    chain s;

    (void)state;
    for (int i = 0; i < N; i++) {
        m[i] = 1.0;
        k[i] = 1.0;
    }
    chain_new(N, m, k, NULL, &s);
    chain_ends(&s, 1, &a, 1, &b);
    chain_zeros(&s, 0, 0);
    chain_free_all(&s);
}

/* Three masses between two walls, equal ends: the mode in which the middle
   stands still is seen of no output there, and its pole is no zero. */
static void a_mode_that_is_not_seen_makes_no_zero(void **state)
{
    const double m[] = {1.0, 2.0, 1.0}, k[] = {5.0, 3.0, 3.0};
    const int64_t middle = 1;
    chain s;

    (void)state;
    chain_new(3, m, k, NULL, &s);
    ritz_dense_col(&s.dense.K, 2)[2] += 5.0;
    chain_ends(&s, 1, &middle, 1, &middle);
    chain_zeros(&s, 0, 2);
    assert_near(cimag(s.zero[0]), sqrt(8.0), 32 * DBL_EPSILON * sqrt(8.0));
    /* of all channels it is an invariant zero too */
    chain_zeros(&s, RITZ_ALL_CHANNELS, 4);
    for (int j = 0; j < 4; j++)
        /* measured 0; a few roundings */
        assert_near(cabs(s.zero[j]), sqrt(8.0), 32 * DBL_EPSILON * sqrt(8.0));
    chain_free_all(&s);
}

/* A row that is the same from both ends, without and with D of K and M. */
static void mirrored(int64_t n, ritz_dense *K, ritz_dense *M, ritz_dense *D)
{
    assert_ok(ritz_dense_new(n, n, K));
    assert_ok(ritz_dense_new(n, n, M));
    assert_ok(ritz_dense_new(n, n, D));
    for (int64_t i = 0; i < n; i++) {
        ritz_dense_col(K, i)[i] = 2.0;
        ritz_dense_col(M, i)[i] =
            1.0 + 0.1 * (double)(7 * llabs(i - n / 2) % 5);
        if (i > 0)
            ritz_dense_col(K, i)[i - 1] = ritz_dense_col(K, i - 1)[i] = -1.0;
    }
    for (int64_t k = 0; k < n * n; k++)
        D->val[k] = 0.05 * M->val[k] + 0.01 * K->val[k];
}

/* Half the modes stand still in the middle; what eigenvectors say of it there
   is up to 4e-10 of the largest entry, not a few eps. */
static void what_the_middle_does_not_see_is_not_summed(void **state)
{
    enum { N = 191 };
    RITZ_OWN(ritz_structure) row = {0};
    RITZ_OWN(ritz_io) io = {0};
    ritz_dense none = {0};
    ritz_second_order model = {.K = &row.K, .M = &row.M, .io = &io};

    (void)state;
    mirrored(N, &row.K, &row.M, &row.D);
    assert_ok(ritz_io_new(N, 1, 1, &io));
    io.B.val[N / 2] = 1.0;
    io.C.val[N / 2] = 1.0;
    for (int damped = 0; damped < 2; damped++) {
        RITZ_OWN(ritz_channel) channel = {0};

        model.D = damped ? &row.D : &none;
        assert_ok(ritz_channel_dense(&model, NULL, 0, 0, &channel));
        assert_true(damped ? channel.blocks : channel.squared);
        assert_int_equal(channel.A.nrow, (1 + damped) * (N + 1) / 2);
    }
}

/* Derivatives add zeros at rest; a free body's poles there cancel them. */
static void derivatives_have_zeros_at_rest(void **state)
{
    const double m[] = {2.0, 0.5}, held[] = {30.0, 8.0}, loose[] = {0.0, 8.0};
    const int64_t first = 0;

    (void)state;
    for (int is_free = 0; is_free < 2; is_free++)
        for (int order = 0; order < 3; order++) {
            int64_t rest = is_free ? 0 : order;
            ritz_dense kept;
            ritz_io *io = NULL;
            chain s;

            chain_new(2, m, is_free ? loose : held, NULL, &s);
            chain_ends(&s, 1, &first, 1, &first);
            io = &s.component.io;
            kept = io->C;
            if (order == 1) {
                io->C = io->Cv;
                io->Cv = kept;
            } else if (order == 2) {
                io->C = io->Ca;
                io->Ca = kept;
            }
            chain_zeros(&s, 0, 2 + rest);
            for (int64_t j = 0; j < rest; j++)
                assert_true(s.zero[j] == 0.0);
            assert_near(cimag(s.zero[rest]), 4.0, 64 * DBL_EPSILON);
            chain_free_all(&s);
        }
}

/* Modal ratios, a matrix that is proportional and one that is not, as
   second-order model and as state space. */
static void both_forms_have_the_same_zeros(void **state)
{
    enum { N = 9 };
    const ritz_damping ratios = {.kind = RITZ_DAMPING_MODAL, .zeta = 0.02};
    double m[N], k[N], c[N];
    const int64_t a = 2, b = 6;
    ritz_state_space states = {0};
    double _Complex *zero = NULL, *same = NULL;
    int64_t count = 0, again = 0;
    chain s;

    (void)state;
    uneven(N, m, k, c);
    for (int damped = 0; damped < 2; damped++) {
        chain_new(N, m, k, damped ? c : NULL, &s);
        chain_ends(&s, 1, &a, 1, &b);
        assert_ok(ritz_zeros_of(ritz_model_of_dense(&s.model, &ratios), 0, 0,
                                &count, &zero));
        assert_ok(
            ritz_state_space_of_component(&s.component, &ratios, &states));
        assert_ok(
            ritz_zeros_of(ritz_model_of_states(&states), 0, 0, &again, &same));
        assert_true(count >= 2 * (a + N - 1 - b));
        assert_int_equal(count, again);
        for (int64_t j = 0; j < count; j++) {
            double nearest = HUGE_VAL;

            for (int64_t i = 0; i < again; i++)
                nearest = fmin(nearest, cabs(zero[j] - same[i]));
            /* measured 2.9e-13 */
            assert_near(nearest, 0.0, 1e-11 * cabs(zero[j]));
            if (cimag(zero[j]) > 0.0)
                assert_true(zero[j + 1] == conj(zero[j]));
        }
        free(zero);
        free(same);
        ritz_state_space_free(&states);
        chain_free_all(&s);
    }
}

/* Two masses held of five: what is left of the row, n - 2 of them. */
static void all_channels_collocated_have_poles_of_what_is_held(void **state)
{
    enum { N = 5 };
    double m[N], k[N], c[N];
    const int64_t at[] = {1, 3};
    double *before = NULL, *behind = NULL;
    double due[3];
    chain s;

    (void)state;
    uneven(N, m, k, c);
    before = held_frequencies(2, m, k, 1);
    behind = held_frequencies(2, m + 3, k + 3, 0);
    due[0] = before[0];
    due[1] = sqrt((k[2] + k[3]) / m[2]);
    due[2] = behind[0];
    chain_new(N, m, k, NULL, &s);
    chain_ends(&s, 2, at, 2, at);
    chain_zeros(&s, RITZ_ALL_CHANNELS, 6);
    for (int j = 0; j < 6; j++) {
        double nearest = HUGE_VAL;

        for (int i = 0; i < 3; i++)
            nearest = fmin(nearest, fabs(fabs(cimag(s.zero[j])) - due[i]));
        assert_near(creal(s.zero[j]), 0.0, 0.0);
        /* measured 0: they are well apart; a few roundings */
        assert_near(nearest, 0.0, 32 * DBL_EPSILON * cabs(s.zero[j]));
    }
    free(before);
    free(behind);
    chain_free_all(&s);
}

/* (s - 3)(s + 2) / ((s + 1)(s + 4)(s + 5)), in control form. */
static void a_state_space_has_the_zeros_of_its_numerator(void **state)
{
    static const double A[] = {-10, -29, -20, 1, 0, 0, 0, 1, 0};
    static const double B[] = {1, 0, 0};
    static const double C[] = {1, -1, -6};
    static const spaces_rows rows = {3, 1, 1, A, B, C, NULL, NULL};
    RITZ_OWN(ritz_state_space) model = {0};
    double _Complex *zero = NULL;
    int64_t count = 0;

    (void)state;
    assert_ok(spaces_make(&rows, &model));
    assert_ok(ritz_zeros_of(ritz_model_of_states(&model), 0, 0, &count, &zero));
    assert_int_equal(count, 2);
    assert_near(cabs(zero[0] + 2.0), 0.0, 1e-13); /* measured 2.7e-15 */
    assert_near(cabs(zero[1] - 3.0), 0.0, 1e-13);
    free(zero);
}

static void what_has_no_zeros_is_refused(void **state)
{
    const double m[] = {2.0, 0.5}, k[] = {30.0, 8.0}, apart[] = {30.0, 0.0};
    const int64_t ends[] = {0, 1};
    double _Complex *zero = NULL;
    ritz_dense K4 = {0};
    int64_t count = 0;
    chain s;

    (void)state;
    chain_new(2, m, k, NULL, &s);
    chain_ends(&s, 2, ends, 1, ends);
    assert_fails(
        ritz_zeros_of(ritz_model_of_dense(&s.model, NULL), 1, 0, &count, &zero),
        RITZ_ERR_ARGUMENT, "there is no output 2, there are 1");
    assert_fails(
        ritz_zeros_of(ritz_model_of_dense(&s.model, NULL), 0, 2, &count, &zero),
        RITZ_ERR_ARGUMENT, "there is no input 3, there are 2");
    assert_fails(
        ritz_zeros_of(ritz_model_of_dense(&s.model, NULL), RITZ_ALL_CHANNELS,
                      RITZ_ALL_CHANNELS, &count, &zero),
        RITZ_ERR_ARGUMENT, "as many outputs as inputs, not of 1 and 2");
    assert_ok(ritz_dense_new(2, 2, &K4));
    s.model.K4 = &K4;
    assert_fails(
        ritz_zeros_of(ritz_model_of_dense(&s.model, NULL), 0, 0, &count, &zero),
        RITZ_ERR_ARGUMENT, "structural damping is of harmonic motion");
    chain_free_all(&s);
    ritz_dense_free(&K4);
    chain_new(2, m, apart, NULL, &s);
    chain_ends(&s, 1, ends, 1, ends + 1);
    assert_fails(
        ritz_zeros_of(ritz_model_of_dense(&s.model, NULL), 0, 0, &count, &zero),
        RITZ_ERR_SINGULAR, "nothing passes");
    chain_free_all(&s);
}

static ritz_status forget(const chain *s, const ritz_state_space *states)
{
    ritz_status status = RITZ_OK;
    double _Complex *zero = NULL;
    int64_t count = 0;

    RITZ_TRY(ritz_zeros_of(ritz_model_of_dense(&s->model, NULL), 0, 0, &count,
                           &zero));
    free(zero);
    zero = NULL;
    RITZ_TRY(ritz_zeros_of(ritz_model_of_states(states), 0, 0, &count, &zero));
done:
    free(zero);
    return status;
}

static void zeros_survive_every_allocation(void **state)
{
    const double m[] = {2.0, 0.5}, k[] = {30.0, 8.0}, c[] = {0.3, 0.2};
    const int64_t first = 0;
    const ritz_damping none = {0};
    RITZ_OWN(ritz_state_space) states = {0};
    chain s;

    (void)state;
    chain_new(2, m, k, c, &s);
    chain_ends(&s, 1, &first, 1, &first);
    assert_ok(ritz_state_space_of_component(&s.component, &none, &states));
    assert_survives_every_allocation(forget(&s, &states));
    chain_free_all(&s);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(two_masses_have_the_zero_of_the_second_alone),
    cmocka_unit_test(a_damped_pair_has_the_zeros_of_its_link),
    cmocka_unit_test(collocated_zeros_are_poles_of_the_held_structure),
    cmocka_unit_test(zeros_between_are_those_of_both_ends),
    cmocka_unit_test(a_wave_guide_has_no_zeros_of_rounding),
    cmocka_unit_test(a_mode_that_is_not_seen_makes_no_zero),
    cmocka_unit_test(what_the_middle_does_not_see_is_not_summed),
    cmocka_unit_test(derivatives_have_zeros_at_rest),
    cmocka_unit_test(both_forms_have_the_same_zeros),
    cmocka_unit_test(all_channels_collocated_have_poles_of_what_is_held),
    cmocka_unit_test(a_state_space_has_the_zeros_of_its_numerator),
    cmocka_unit_test(what_has_no_zeros_is_refused),
    cmocka_unit_test(zeros_survive_every_allocation),
};

TEST_MODULE(zeros, tests, NULL, NULL)
