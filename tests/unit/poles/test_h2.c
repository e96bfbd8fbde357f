#include "testing.h"

#include "masses.h"

#include "poles/h2.h"
#include "poles/poles.h"
#include "spring_chain.h"

#include <ritz/poles.h>
#include <ritz/tuning.h>

#include <float.h>
#include <stdio.h>
#include <stdlib.h>

static const double eps = DBL_EPSILON;
static const ritz_disturbance white = {0};

/* --- One mass ------------------------------------------------------------- */

/* m u'' + (d + c) u' + (k_0 + k) u = f; y is u, u' or u''. */
typedef struct one_mass {
    double m, d, k_0, c, k;
    int derivative;
    double limit; /* 0: none */
} one_mass;

static void make_plant(const one_mass *one, const ritz_disturbance *noise,
                       ritz_plant *out)
{
    ritz_dense *C[] = {&out->io.C, &out->io.Cv, &out->io.Ca};

    assert_ok(ritz_dense_new(1, 1, &out->base.K));
    assert_ok(ritz_dense_new(1, 1, &out->base.M));
    assert_ok(ritz_dense_new(1, 1, &out->base.D));
    assert_ok(ritz_io_new(1, 1, 1, &out->io));
    assert_ok(ritz_dampers_new(1, 1, &out->dampers));
    out->base.K.val[0] = one->k_0;
    out->base.M.val[0] = one->m;
    out->base.D.val[0] = one->d;
    out->io.B.val[0] = 1.0;
    C[one->derivative]->val[0] = 1.0;
    if (one->limit > 0.0)
        out->io.limit[0] = one->limit;
    out->dampers.B.val[0] = 1.0;
    out->dampers.c[0] = one->c;
    out->dampers.k[0] = one->k;
    (void)snprintf(out->dampers.name[0], RITZ_NAME_SIZE, "d");
    out->noise = *noise;
}

/* J of the output, and its derivatives by c and k of the damper. */
typedef struct single {
    double J, by_c, by_k;
} single;

static single variance_of(const one_mass *one, const ritz_disturbance *noise)
{
    RITZ_OWN(ritz_plant) plant = {0};
    single found = {0};
    ritz_variance v = {.by_c = &found.by_c, .by_k = &found.by_k};

    make_plant(one, noise, &plant);
    assert_ok(ritz_variance_of(&plant, &v));
    assert_true(v.finite);
    found.J = v.square;
    return found;
}

/* J is 1 / (2 c k) of the displacement and 1 / (2 c m) of the velocity. */
static void a_mass_has_its_variance_and_derivatives(void **state)
{
    const one_mass u = {2.0, 0.5, 30.0, 1.5, 20.0, 0, 0.0};
    const one_mass v = {2.0, 0.5, 30.0, 1.5, 20.0, 1, 4.0};
    double c = 2.0, k = 50.0;
    single found = variance_of(&u, &white);
    double J = 1.0 / (2.0 * c * k);

    (void)state;
    assert_near(found.J, J, 50.0 * eps * J);
    assert_near(found.by_c, -J / c, 100.0 * eps * J / c);
    assert_near(found.by_k, -J / k, 400.0 * eps * J / k);
    found = variance_of(&v, &white);
    J = 1.0 / (2.0 * c * 2.0) / 16.0; /* divided by the limit squared */
    assert_near(found.J, J, 50.0 * eps * J);
    assert_near(found.by_c, -J / c, 100.0 * eps * J / c);
    assert_near(found.by_k, 0.0, 100.0 * eps * J / k);
}

/*
 * An acceleration contains the noise itself, so that its variance is infinite
 * without a filter. With a filter of order 1, w / (s + w), it is that of a
 * system of order 3 [NewtonGouldKaiser1957, table E.2],
 *
 *     w^2 a_1 / (2 m (a_1 a_2 - a_0 a_3)),
 *     a = k w, k + c w, c + m w, m
 */
static double acceleration_variance(double m, double c, double k, double w)
{
    const double a[] = {k * w, k + c * w, c + m * w, m};

    return w * w * a[1] / (2.0 * m * (a[1] * a[2] - a[0] * a[3]));
}

static void an_acceleration_has_a_variance_through_a_filter(void **state)
{
    const one_mass a = {2.0, 0.5, 30.0, 1.5, 20.0, 2, 0.0};
    const double w = 7.0, h = 1e-4;
    const ritz_disturbance low = {w / (2.0 * 3.14159265358979323846), 1};
    single found = variance_of(&a, &low);
    double J = acceleration_variance(2.0, 2.0, 50.0, w);
    RITZ_OWN(ritz_plant) plant = {0};
    ritz_variance v = {0};

    (void)state;
    assert_near(found.J, J, 100.0 * eps * J);
    /* errors of a difference: h^2 / 6 times the third derivative, which is at
       most 6 J / c^3, and rounding, eps J / h */
    assert_near(found.by_c,
                (acceleration_variance(2.0, 2.0 + h, 50.0, w) -
                 acceleration_variance(2.0, 2.0 - h, 50.0, w)) /
                    (2.0 * h),
                (h * h + 2.0 * eps / h) * J);
    assert_near(found.by_k,
                (acceleration_variance(2.0, 2.0, 50.0 + h, w) -
                 acceleration_variance(2.0, 2.0, 50.0 - h, w)) /
                    (2.0 * h),
                (h * h + 2.0 * eps / h) * J);
    make_plant(&a, &white, &plant);
    assert_fails(ritz_variance_of(&plant, &v), RITZ_ERR_ARGUMENT,
                 "an output follows an input at once");
}

/* A stiff spring with k = 1 holds a small mass, whose displacement is the
   filtered noise. Its variance is w_c times a number that depends on the
   filter's order; here w_c = 1 rad/s. */
static void filters_are_of_unit_gain_and_their_order(void **state)
{
    /* (1 / pi) integral of 1 / (1 + x^2n) is 1 / (2 n sin(pi / 2 n)) */
    const one_mass stiff = {1e-6, 2e-3, 1.0, 0.0, 0.0, 0, 0.0};
    const double pi = 3.14159265358979323846;

    (void)state;
    for (int64_t n = 1; n <= RITZ_LOW_PASS_MOST; n++) {
        const ritz_disturbance low = {1.0 / (2.0 * pi), n};
        double J = 1.0 / (2.0 * (double)n * sin(pi / (2.0 * (double)n)));

        /* critically damped at 1000 rad/s: H is off by 2 s / 1000; a filter of
           order 1 passes noise up there */
        assert_near(variance_of(&stiff, &low).J, J,
                    n == 1 ? 2e-3 * J : 3e-6 * J);
    }
}

/* --- Chains --------------------------------------------------------------- */

typedef struct chain_case {
    int64_t n;
    const char *damping;
    bool acceleration, gyroscopic;
    ritz_disturbance noise;
} chain_case;

static void make_chain(const chain_case *given, ritz_plant *out)
{
    RITZ_OWN(ritz_component) chain = {0};
    ritz_damping damping = {0};

    assert_ok(chain_component(given->n, &chain));
    assert_ok(ritz_damping_parse(given->damping, &damping));
    if (given->acceleration)
        ritz_dense_col(&chain.io.Ca, 4)[0] = 0.25;
    chain.io.limit[0] = 0.5;
    assert_ok(ritz_plant_new(ritz_model_of_component(&chain, &damping),
                             &given->noise, out));
    if (!given->gyroscopic)
        return;
    assert_ok(ritz_dense_new(given->n, given->n, &out->base.D));
    ritz_dense_col(&out->base.D, 3)[7] = 9.0;
    ritz_dense_col(&out->base.D, 7)[3] = -9.0;
}

static double square_at(ritz_plant *plant, bool of_k, int64_t j, double value)
{
    double *at = of_k ? &plant->dampers.k[j] : &plant->dampers.c[j];
    double before = *at;
    ritz_variance v = {0};

    *at = value;
    assert_ok(ritz_variance_of(plant, &v));
    assert_true(v.finite);
    *at = before;
    return v.square;
}

/* Differences of fourth order are off by h^4 / 30 of the fifth derivative, and
   by the rounding of J, about n eps J, over h. */
static void gradients_are_what_differences_are(void **state)
{
    static const chain_case cases[] = {
        {20, "", false, false, {0.0, 0}},
        {20, "modal 0.02", false, false, {0.0, 0}},
        {20, "rayleigh 0.1 0.002", false, false, {0.0, 0}},
        {20, "bands 0 2 0.01 2 20 0.05", false, true, {0.0, 0}},
        {20, "modal 0.02", true, false, {1.5, 3}},
        {20, "rayleigh 0.1 0.002", true, true, {1.0, 6}},
    };

    (void)state;
    for (size_t t = 0; t < sizeof cases / sizeof *cases; t++) {
        RITZ_OWN(ritz_plant) plant = {0};
        double by_c[3] = {0}, by_k[3] = {0};
        ritz_variance v = {.by_c = by_c, .by_k = by_k};

        make_chain(&cases[t], &plant);
        assert_ok(ritz_variance_of(&plant, &v));
        for (int64_t j = 0; j < 3; j++)
            for (int of_k = 0; of_k < 2; of_k++) {
                double at = of_k ? plant.dampers.k[j] : plant.dampers.c[j];
                double h = 1.0, found = of_k ? by_k[j] : by_c[j];
                double f[] = {square_at(&plant, of_k, j, at - 2.0 * h),
                              square_at(&plant, of_k, j, at - h),
                              square_at(&plant, of_k, j, at + h),
                              square_at(&plant, of_k, j, at + 2.0 * h)};
                double slope =
                    (f[0] - 8.0 * f[1] + 8.0 * f[2] - f[3]) / (12.0 * h);

                assert_near(found, slope, 3e-9 * v.square);
                assert_true(fabs(found) > 1e-7 * v.square);
            }
    }
}

/* ritz_norm_two finds the same norm by SLICOT from the state space. */
static void a_state_space_has_the_norm_of_its_model(void **state)
{
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_state_space) space = {0};
    ritz_damping damping = {0};
    ritz_h2 whole = {0}, states = {0};
    ritz_norm norm = {0};
    const ritz_disturbance low = {2.0, 6};

    (void)state;
    assert_ok(chain_component(20, &chain));
    assert_ok(ritz_component_install(&chain));
    assert_ok(ritz_damping_parse("modal 0.01", &damping));
    assert_ok(ritz_state_space_of_component(&chain, &damping, &space));
    assert_ok(
        ritz_h2_of(ritz_model_of_component(&chain, &damping), &white, &whole));
    assert_ok(ritz_h2_of(ritz_model_of_states(&space), &white, &states));
    assert_ok(ritz_norm_two(&space, &norm));
    assert_near(whole.value, norm.value, 1e-12 * norm.value);
    assert_near(states.value, norm.value, 1e-12 * norm.value);
    assert_near(whole.change, 0.0, 0.0);
    assert_ok(
        ritz_h2_of(ritz_model_of_component(&chain, &damping), &low, &whole));
    assert_ok(ritz_h2_of(ritz_model_of_states(&space), &low, &states));
    assert_near(states.value, whole.value, 1e-12 * whole.value);
    assert_true(whole.value < norm.value);
}

/* Computed by SciPy 1.10 (solve_continuous_lyapunov, butter) for the chain of
   data/damper-chain and for its projection onto 8 or 12 modes and four static
   responses. */
static const struct {
    ritz_disturbance noise;
    double full, eight, twelve;
} chain_norms[] = {
    {{0.0, 0}, 0.1192920444, 0.1185611606, 0.1176224277},
    {{2.0, 6}, 0.1165942546, 0.1165941394, 0.1165941625},
    {{1.0, 6}, 0.1162533774, 0.1162533761, 0.1162533747},
};

static void the_damper_chain_has_the_norms_of_scipy(void **state)
{
    RITZ_OWN(ritz_component) chain = {0}, damped = {0};

    (void)state;
    assert_ok(chain_component(30, &chain));
    assert_ok(chain_component(30, &damped));
    assert_ok(ritz_component_install(&damped));
    for (size_t t = 0; t < sizeof chain_norms / sizeof *chain_norms; t++) {
        const ritz_model model = ritz_model_of_component(&chain, NULL);
        const double expected[] = {chain_norms[t].eight, chain_norms[t].twelve};
        ritz_h2 h2 = {0};

        assert_ok(ritz_h2_of(ritz_model_of_component(&damped, NULL),
                             &chain_norms[t].noise, &h2));
        assert_near(h2.value, chain_norms[t].full, 5.1e-11);
        for (int k = 0; k < 2; k++) {
            RITZ_OWN(ritz_static_space) space = {0};
            RITZ_OWN(ritz_plant) plant = {0};
            ritz_variance v = {0};

            assert_ok(ritz_static_space_new(model, 8 + 4 * k,
                                            &chain_norms[t].noise, &space));
            assert_ok(ritz_static_space_plant(&space, NULL, &plant));
            assert_int_equal(plant.base.K.nrow, 12 + 4 * k);
            assert_ok(ritz_variance_of(&plant, &v));
            assert_near(sqrt(v.square), expected[k], 5.1e-11);
        }
    }
}

/* A long chain of equal masses and springs, held at one end, with one damper
   between two masses at a third of its length. */
static void make_row(int64_t n, ritz_component *out)
{
    int64_t count = 0;
    RITZ_OWN_ARRAY int64_t *row = calloc((size_t)(3 * n), sizeof *row);
    RITZ_OWN_ARRAY int64_t *col = calloc((size_t)(3 * n), sizeof *col);
    RITZ_OWN_ARRAY double *val = calloc((size_t)(3 * n), sizeof *val);
    RITZ_OWN(ritz_component) c = {.num_dofs = n};

    for (int64_t i = 0; i < n; i++)
        for (int64_t j = i > 0 ? i - 1 : 0; j <= i + 1 && j < n; j++) {
            row[count] = i;
            col[count] = j;
            val[count++] = i == j ? (i == n - 1 ? 1.0 : 2.0) * 4e4 : -4e4;
        }
    assert_ok(ritz_sparse_from_triplets(n, n, count, row, col, val, &c.K));
    for (int64_t i = 0; i < n; i++) {
        row[i] = col[i] = i;
        val[i] = 1.0;
    }
    assert_ok(ritz_sparse_from_triplets(n, n, n, row, col, val, &c.M));
    c.dof = calloc((size_t)n, sizeof *c.dof);
    for (int64_t i = 0; i < n; i++)
        c.dof[i] = (ritz_dof){.grid = i + 1};
    assert_ok(ritz_io_new(n, 1, 1, &c.io));
    (void)snprintf(c.io.input[0], RITZ_NAME_SIZE, "f");
    (void)snprintf(c.io.output[0], RITZ_NAME_SIZE, "u");
    c.io.B.val[n - 1] = 1.0;
    ritz_dense_col(&c.io.C, n / 2)[0] = 1.0;
    assert_ok(ritz_dampers_new(n, 1, &c.dampers));
    (void)snprintf(c.dampers.name[0], RITZ_NAME_SIZE, "d");
    ritz_dense_col(&c.dampers.B, 0)[n / 3] = 1.0;
    ritz_dense_col(&c.dampers.B, 0)[n / 3 + 1] = -1.0;
    c.dampers.c[0] = 300.0;
    RITZ_MOVE(*out, c);
}

static void a_large_component_has_the_norm_of_its_dense_matrices(void **state)
{
    enum { N = RITZ_WHOLE_DOFS + 2 };
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_plant) plant = {0};
    ritz_damping damping = {0};
    const ritz_disturbance low = {2.0, 4};
    ritz_variance v = {0};
    ritz_h2 h2 = {0};
    ritz_model model;

    (void)state;
    make_row(N, &chain);
    assert_ok(ritz_damping_parse("rayleigh 0.05 0.001", &damping));
    assert_ok(ritz_component_install(&chain));
    model = ritz_model_of_component(&chain, &damping);
    assert_ok(ritz_h2_of(model, &low, &h2));
    assert_non_null(strstr(h2.engine, "modes and static responses"));
    assert_true(h2.change > 0.0 && h2.change <= 1e-6);
    assert_ok(ritz_plant_new(model, &low, &plant));
    assert_ok(ritz_variance_of(&plant, &v));
    assert_near(h2.value, sqrt(v.square), 1e-6 * h2.value);
}

/* One damper is the only damping: under white noise higher modes go on adding
   to the norm. */
static void a_norm_that_does_not_settle_is_refused(void **state)
{
    enum { N = 700 };
    RITZ_OWN(ritz_component) chain = {0};
    ritz_h2 h2 = {0};

    (void)state;
    make_row(N, &chain);
    ritz_dense_col(&chain.io.C, N / 2)[0] = 0.0;
    ritz_dense_col(&chain.io.Cv, N - 1)[0] = 1.0;
    assert_ok(ritz_component_install(&chain));
    assert_fails(ritz_h2_of(ritz_model_of_component(&chain, NULL), &white, &h2),
                 RITZ_ERR_CONVERGENCE,
                 "with 320 modes the H2 norm still changes by");
}

/* --- Free bodies ---------------------------------------------------------- */

/*
 * Two free masses, connected by k and c, with the reduced mass m_r = m_1 m_2 /
 * (m_1 + m_2). A force on the first drives their distance by m_r / m_1, so that
 * its variance is (m_r / m_1)^2 / (2 c k). The variance of a displacement is
 * infinite.
 */
static void a_free_body_has_the_variance_of_its_deformation(void **state)
{
    double K[] = {50.0, -50.0, -50.0, 50.0}, M[] = {2.0, 0.0, 0.0, 3.0};
    const ritz_dense A[] = {{2, 2, K}, {2, 2, M}};
    RITZ_OWN(ritz_io) io = {0};
    RITZ_OWN(ritz_dampers) dampers = {0};
    RITZ_OWN(ritz_plant) plant = {0};
    const ritz_second_order matrices = {&A[0], &A[1], NULL, NULL, &io};
    ritz_model model = ritz_model_of_dense(&matrices, NULL);
    double by_c = 0.0, by_k = 0.0, r = 6.0 / 5.0;
    ritz_variance v = {.by_c = &by_c, .by_k = &by_k};
    double J = r * r / 4.0 / (2.0 * 4.0 * 50.0);

    (void)state;
    assert_ok(ritz_io_new(2, 1, 1, &io));
    assert_ok(ritz_dampers_new(2, 1, &dampers));
    io.B.val[0] = 1.0;
    io.C.val[0] = -1.0;
    io.C.val[1] = 1.0;
    dampers.B.val[0] = -1.0;
    dampers.B.val[1] = 1.0;
    dampers.c[0] = 4.0;
    model.dampers = &dampers;
    assert_ok(ritz_plant_new(model, &white, &plant));
    assert_ok(ritz_variance_of(&plant, &v));
    assert_near(v.square, J, 100.0 * eps * J);
    assert_near(by_c, -J / 4.0, 100.0 * eps * J);
    assert_near(by_k, -J / 50.0, 100.0 * eps * J);
    plant.io.C.val[0] = 0.0; /* the displacement of mass 2 */
    assert_ok(ritz_variance_of(&plant, &v));
    assert_false(v.finite);
    assert_int_equal(v.unstable, 2);
    assert_fails(ritz_refuse_infinite(&v), RITZ_ERR_ARGUMENT,
                 "the H2 norm is infinite: of 4 poles 2 are not left of the "
                 "imaginary axis");
}

/* A free chain whose ends are pushed apart, as a full model and in modes and
   static responses about a shift. The two forces drive no rigid motion. */
static void a_free_chain_has_its_norm_in_its_space(void **state)
{
    static const int64_t two[] = {9, 17};
    static const int64_t end[] = {0};
    const ritz_disturbance slow = {1.0, 6};
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_plant) whole = {0}, small = {0};
    RITZ_OWN(ritz_static_space) space = {0};
    ritz_variance v[2] = {{0}};
    ritz_model model;

    (void)state;
    assert_ok(spring_chain(30, true, &chain));
    assert_ok(spring_chain_damp(&chain, 2, two, 150.0, -200.0));
    assert_ok(masses_io(&chain, 1, end, 1, end));
    chain.io.B.val[29] = -chain.io.B.val[0];
    ritz_dense_col(&chain.io.C, 29)[0] = -1.0;
    model = ritz_model_of_component(&chain, NULL);
    assert_ok(ritz_plant_new(model, &slow, &whole));
    assert_ok(ritz_variance_of(&whole, &v[0]));
    assert_ok(ritz_static_space_new(model, 10, &slow, &space));
    assert_true(space.sigma < 0.0);
    assert_int_equal(space.num_modes, 11); /* one of them is rigid */
    assert_ok(ritz_static_space_plant(&space, NULL, &small));
    assert_int_equal(small.base.K.nrow, 14);
    assert_ok(ritz_variance_of(&small, &v[1]));
    assert_true(v[0].finite && v[1].finite);
    /* measured 7e-8; without the responses to dampers 9e-2 */
    assert_near(v[1].square, v[0].square, 1e-6 * v[0].square);
    chain.io.B.val[29] = 0.0; /* one end alone is pushed, and observed */
    ritz_dense_col(&chain.io.C, 29)[0] = 0.0;
    ritz_plant_free(&whole);
    assert_ok(ritz_plant_new(model, &slow, &whole));
    assert_ok(ritz_variance_of(&whole, &v[0]));
    assert_false(v[0].finite);
}

/* Two masses, each on its own spring; only the first one has a damper. The norm
   is finite unless the second one is both driven and observed. */
static void undamped_motion_counts_only_if_driven_and_observed(void **state)
{
    double K[] = {50.0, 0.0, 0.0, 70.0}, M[] = {2.0, 0.0, 0.0, 3.0};
    double D[] = {4.0, 0.0, 0.0, 0.0};
    const ritz_dense A[] = {{2, 2, K}, {2, 2, M}, {2, 2, D}};
    RITZ_OWN(ritz_io) io = {0};
    const ritz_second_order matrices = {&A[0], &A[1], &A[2], NULL, &io};
    const ritz_model model = ritz_model_of_dense(&matrices, NULL);
    double norm = 1.0 / sqrt(2.0 * 4.0 * 50.0);
    ritz_h2 h2 = {0};

    (void)state;
    assert_ok(ritz_io_new(2, 1, 1, &io));
    for (int k = 0; k < 3; k++) {
        io.B.val[0] = io.C.val[0] = 1.0;
        io.B.val[1] = k == 1 ? 1.0 : 0.0;
        io.C.val[1] = k == 2 ? 1.0 : 0.0;
        assert_ok(ritz_h2_of(model, &white, &h2));
        assert_near(h2.value, norm, 100.0 * eps * norm);
    }
    io.B.val[1] = io.C.val[1] = 1.0;
    assert_fails(ritz_h2_of(model, &white, &h2), RITZ_ERR_ARGUMENT,
                 "of 4 poles 2 are not left of the imaginary axis, are driven "
                 "and observed");
}

/* --- Refusals and allocations --------------------------------------------- */

static void models_without_a_norm_are_refused(void **state)
{
    const one_mass u = {2.0, 0.5, 30.0, 1.5, 20.0, 0, 0.0};
    const ritz_disturbance bad[] = {
        {-1.0, 6}, {1.0, 0}, {1.0, 21}, {HUGE_VAL, 2}};
    RITZ_OWN(ritz_plant) plant = {0};
    RITZ_OWN(ritz_component) chain = {0};
    double K[] = {1.0, 0.0, 0.0, 2.0}, M[] = {1.0, 0.0, 0.0, 0.0};
    const ritz_dense A[] = {{2, 2, K}, {2, 2, M}};
    RITZ_OWN(ritz_io) io = {0};
    RITZ_OWN(ritz_dampers) dampers = {0};
    const ritz_second_order none = {&A[0], &A[1], NULL, NULL, NULL};
    const ritz_second_order loss = {&A[0], &A[1], NULL, &A[0], &io};
    const ritz_second_order half = {&A[0], &A[1], NULL, NULL, &io};
    ritz_model model = ritz_model_of_dense(&half, NULL);
    double by_c = 0.0, by_k = 0.0;
    ritz_variance v = {0};
    ritz_h2 h2 = {0};

    (void)state;
    make_plant(&u, &white, &plant);
    for (int k = 0; k < 4; k++) {
        plant.noise = bad[k];
        assert_fails(ritz_variance_of(&plant, &v), RITZ_ERR_ARGUMENT,
                     "is none: the frequency is positive");
    }
    assert_ok(spring_chain(10, false, &chain));
    assert_fails(ritz_h2_of(ritz_model_of_component(&chain, NULL), &white, &h2),
                 RITZ_ERR_ARGUMENT,
                 "the model has no inputs: an H2 norm is from noise");
    assert_fails(ritz_h2_of(ritz_model_of_dense(&none, NULL), &white, &h2),
                 RITZ_ERR_ARGUMENT, "the model has no inputs and outputs");
    assert_ok(ritz_io_new(2, 1, 1, &io));
    io.B.val[0] = io.C.val[0] = 1.0;
    assert_fails(ritz_h2_of(ritz_model_of_dense(&loss, NULL), &white, &h2),
                 RITZ_ERR_ARGUMENT, "structural damping");
    assert_ok(ritz_dampers_new(2, 1, &dampers));
    (void)snprintf(dampers.name[0], RITZ_NAME_SIZE, "d");
    dampers.B.val[1] = 1.0;
    model.dampers = &dampers;
    ritz_plant_free(&plant);
    assert_ok(ritz_plant_new(model, &white, &plant));
    v = (ritz_variance){.by_c = &by_c, .by_k = &by_k};
    assert_fails(ritz_variance_of(&plant, &v), RITZ_ERR_ARGUMENT,
                 "damper 'd' moves dofs without mass: condense them first");
}

static ritz_status measure_all(const ritz_component *chain)
{
    const ritz_disturbance low = {1.0, 3};
    const ritz_model model = ritz_model_of_component(chain, NULL);
    double by_c[3], by_k[3];
    const bool used[] = {true, false, true};
    RITZ_OWN(ritz_plant) plant = {0};
    RITZ_OWN(ritz_static_space) space = {0};
    RITZ_OWN(ritz_state_space) states = {0};
    ritz_variance v = {.by_c = by_c, .by_k = by_k};
    ritz_h2 h2 = {0};

    RITZ_CHECK(ritz_static_space_new(model, 4, &low, &space));
    RITZ_CHECK(ritz_static_space_plant(&space, used, &plant));
    RITZ_CHECK(ritz_variance_of(&plant, &v));
    RITZ_CHECK(
        ritz_state_space_of_component(chain, &(ritz_damping){0}, &states));
    return ritz_h2_of(ritz_model_of_states(&states), &low, &h2);
}

static void no_allocation_is_forgotten(void **state)
{
    RITZ_OWN(ritz_component) chain = {0};

    (void)state;
    assert_ok(chain_component(18, &chain));
    assert_survives_every_allocation(measure_all(&chain));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_mass_has_its_variance_and_derivatives),
    cmocka_unit_test(an_acceleration_has_a_variance_through_a_filter),
    cmocka_unit_test(filters_are_of_unit_gain_and_their_order),
    cmocka_unit_test(gradients_are_what_differences_are),
    cmocka_unit_test(a_state_space_has_the_norm_of_its_model),
    cmocka_unit_test(the_damper_chain_has_the_norms_of_scipy),
    cmocka_unit_test(a_large_component_has_the_norm_of_its_dense_matrices),
    cmocka_unit_test(a_norm_that_does_not_settle_is_refused),
    cmocka_unit_test(a_free_body_has_the_variance_of_its_deformation),
    cmocka_unit_test(a_free_chain_has_its_norm_in_its_space),
    cmocka_unit_test(undamped_motion_counts_only_if_driven_and_observed),
    cmocka_unit_test(models_without_a_norm_are_refused),
    cmocka_unit_test(no_allocation_is_forgotten),
};

TEST_MODULE(h2, tests, NULL, NULL)
