#include "testing.h"

#include "frame.h"
#include "masses.h"

#include <ritz/basis.h>
#include <ritz/import.h>
#include <ritz/matrix.h>

#include <stdio.h>
#include <stdlib.h>

enum { MASSES = 12, STATES = 2 * MASSES, PATH_SIZE = 1024 };

/* What a chain of MASSES has that is not usual. */
enum {
    FREE = 1,     /* nothing holds it */
    MASSLESS = 2, /* its middle has no mass */
    REPEATED = 4, /* two equal halves that nothing joins */
    RATES = 8,    /* outputs are velocities and accelerations too */
};

/* Inputs at either end and beside the middle, outputs there. */
static void set_chain(int what, ritz_component *out)
{
    static const int64_t in[] = {0, 7, 11}, seen[] = {0, 3, 7, 11};
    double m[MASSES], k[MASSES];

    for (int i = 0; i < MASSES; i++) {
        m[i] = 1.0 + 0.1 * (7 * i % 5);
        k[i] = 100.0 * (1.0 + 0.2 * (3 * i % 4));
        if (what & REPEATED && i >= MASSES / 2) {
            m[i] = m[i - MASSES / 2];
            k[i] = i == MASSES / 2 ? 0.0 : k[i - MASSES / 2];
        }
    }
    if (what & FREE || what & REPEATED)
        k[0] = 0.0;
    if (what & MASSLESS)
        m[5] = 0.0;
    assert_ok(masses_component(MASSES, m, k, NULL, out));
    assert_ok(masses_io(out, 3, in, 4, seen));
    for (int64_t j = 0; what & RATES && j < MASSES; j++) {
        ritz_dense_col(&out->io.Cv, j)[1] = ritz_dense_col(&out->io.C, j)[1];
        ritz_dense_col(&out->io.C, j)[1] = 0.0;
        ritz_dense_col(&out->io.Ca, j)[2] = 0.3 * (double)(j == 7);
    }
}

static double col(const ritz_dense *A, int64_t i, int64_t j)
{
    return ritz_dense_col(A, j)[i];
}

static ritz_gramians_request asking(const ritz_component *component,
                                    ritz_engine engine, const char *damping)
{
    ritz_gramians_request request = {.component = component, .engine = engine};

    assert_ok(ritz_damping_parse(damping, &request.damping));
    return request;
}

/* Hankel values by one engine; how many there are. */
static int64_t values(const ritz_gramians_request *request, double *sigma,
                      int64_t most)
{
    RITZ_OWN(ritz_gramians) gramians = {0};
    double *found = NULL;
    int64_t count = 0;

    assert_ok(ritz_gramians_of_component(request, &gramians));
    assert_ok(ritz_gramians_hankel(&gramians, &count, &found));
    for (int64_t k = 0; k < most; k++)
        sigma[k] = k < count ? found[k] : 0.0;
    free(found);
    return count;
}

/*
 * m u'' + 2 zeta sqrt(k m) u' + k u = f, m = 2, w = 3: as in hankel.md, with
 * b = c = 1 / sqrt(m), over the limit.
 */
static void one_mass_has_the_closed_form_pair(void **unused)
{
    static const ritz_engine engine[] = {RITZ_ENGINE_DENSE, RITZ_ENGINE_MODAL,
                                         RITZ_ENGINE_AUTO};
    static const double m[] = {2.0}, k[] = {18.0};
    static const int64_t at[] = {0};
    RITZ_OWN(ritz_component) mass = {0};

    (void)unused;
    assert_ok(masses_component(1, m, k, NULL, &mass));
    assert_ok(masses_io(&mass, 1, at, 1, at));
    mass.io.limit[0] = 0.25;
    for (int t = 0; t < 3; t++) {
        ritz_gramians_request request = asking(&mass, engine[t], "modal 0.1");
        double light = 0.5 / (4.0 * 0.1 * 9.0) / 0.25;
        double sigma[2];

        assert_int_equal(values(&request, sigma, 2), 2);
        /* a few roundings of terms no larger than the first value */
        assert_near(sigma[0], light * (sqrt(1.01) + 0.1), 1e-14 * light);
        assert_near(sigma[1], light * (sqrt(1.01) - 0.1), 1e-14 * light);
    }
}

/* Both are backward stable, and move a pole by eps / zeta of its damping. */
static void dense_and_closed_form_agree(void **unused)
{
    static const int what[] = {0,
                               RATES,
                               FREE,
                               FREE | RATES,
                               MASSLESS,
                               MASSLESS | RATES,
                               REPEATED | RATES,
                               FREE | MASSLESS};
    static const char *const damping[] = {"modal 0.3", "modal 0.01",
                                          "modal 0.0001", "rayleigh 0.1 0.5",
                                          "modes 0.5 0.02 0.9999 0.001"};

    (void)unused;
    for (int t = 0; t < 40; t++) {
        RITZ_OWN(ritz_component) chain = {0};
        ritz_gramians_request request = {0};
        double dense[STATES], modal[STATES];

        set_chain(what[t / 5], &chain);
        request = asking(&chain, RITZ_ENGINE_DENSE, damping[t % 5]);
        if (what[t / 5] & MASSLESS) /* what has no mass cannot be damped */
            request.damping.b = 0.0;
        (void)values(&request, dense, STATES);
        request.engine = RITZ_ENGINE_MODAL;
        (void)values(&request, modal, STATES);
        assert_true(dense[0] > 0.0);
        for (int k = 0; k < STATES; k++) /* measured: 9e-13, at 1e-4 */
            assert_near(modal[k], dense[k], 1e-11 * dense[0]);
    }
}

/* E Z of Z = [u; u'], of a diagonal mass matrix. */
static double with_mass(const ritz_component *c, const ritz_dense *Z, int64_t i,
                        int64_t j)
{
    int64_t n = c->num_dofs;

    return col(Z, i, j) * (i < n ? 1.0 : ritz_sparse_diagonal(&c->M, i - n));
}

static double largest(const ritz_dense *A, const ritz_dense *B)
{
    return ritz_dense_max(A) * ritz_dense_max(B);
}

/* W'E T = I, and neither sees anything of the Gramians. */
static void rigid_modes_stand_apart(void **unused)
{
    static const ritz_engine engine[] = {RITZ_ENGINE_DENSE, RITZ_ENGINE_MODAL};

    (void)unused;
    for (int t = 0; t < 4; t++) {
        RITZ_OWN(ritz_component) chain = {0};
        RITZ_OWN(ritz_gramians) g = {0};
        ritz_gramians_request request = {0};
        RITZ_OWN(ritz_dense) WT = {0}, WZ = {0}, ZT = {0}, ET = {0};
        int64_t apart = t < 2 ? 2 : 4;

        set_chain(t < 2 ? FREE : REPEATED, &chain);
        request = asking(&chain, engine[t % 2], "modal 0.02");
        assert_ok(ritz_gramians_of_component(&request, &g));
        assert_int_equal(g.T.ncol, apart);
        assert_ok(ritz_dense_copy(&g.T, &ET));
        for (int64_t k = 0; k < STATES * apart; k++)
            ET.val[k] = with_mass(&chain, &g.T, k % STATES, k / STATES);
        for (int64_t k = 0; k < STATES * g.Zc.ncol; k++)
            assert_near(g.EZc.val[k],
                        with_mass(&chain, &g.Zc, k % STATES, k / STATES),
                        1e-13 * ritz_dense_max(&g.EZc));
        assert_ok(ritz_dense_mul_tn(&g.W, &ET, &WT));
        assert_ok(ritz_dense_mul_tn(&g.W, &g.EZc, &WZ));
        assert_ok(ritz_dense_mul_tn(&g.Zo, &ET, &ZT));
        for (int64_t k = 0; k < apart * apart; k++) /* STATES terms */
            assert_near(WT.val[k], k % apart == k / apart ? 1.0 : 0.0, 1e-13);
        assert_near(ritz_dense_max(&WZ), 0.0, 1e-13 * largest(&g.W, &g.EZc));
        assert_near(ritz_dense_max(&ZT), 0.0, 1e-13 * largest(&g.Zo, &ET));
    }
}

/* A Z of Z = [u; u'], A = [0 I; -K -D], D = a M + b K; or A'Z. */
static ritz_status apply(const ritz_component *c, const double ab[2],
                         bool transposed, const ritz_dense *Z, ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    int64_t n = c->num_dofs;
    ritz_dense half[2] = {{0}, {0}}, K[2] = {{0}, {0}};

    RITZ_TRY(ritz_dense_new(2 * n, Z->ncol, out));
    for (int h = 0; h < 2; h++) {
        RITZ_TRY(ritz_dense_new(n, Z->ncol, &half[h]));
        for (int64_t k = 0; k < n * Z->ncol; k++)
            half[h].val[k] = col(Z, h * n + k % n, k / n);
        RITZ_TRY(ritz_sparse_mul(&c->K, &half[h], &K[h]));
    }
    for (int64_t k = 0; k < n * Z->ncol; k++) {
        int64_t i = k % n;
        double m = ritz_sparse_diagonal(&c->M, i);
        double d = ab[0] * m * half[1].val[k] + ab[1] * K[1].val[k];
        double *x = ritz_dense_col(out, k / n);

        x[i] = transposed ? -K[1].val[k] : half[1].val[k];
        x[n + i] = transposed ? half[0].val[k] - d : -K[0].val[k] - d;
    }
done:
    for (int h = 0; h < 2; h++) {
        ritz_dense_free(&half[h]);
        ritz_dense_free(&K[h]);
    }
    return status;
}

/* Largest entry of X Y' + Y X' + F F' over that of F F'. */
static double residual(const ritz_dense *X, const ritz_dense *Y,
                       const ritz_dense *F)
{
    RITZ_OWN(ritz_dense) XY = {0}, FF = {0};
    double worst = 0.0, due = 0.0;

    assert_ok(ritz_dense_mul_nt(X, Y, &XY));
    assert_ok(ritz_dense_mul_nt(F, F, &FF));
    due = ritz_dense_max(&FF);
    for (int64_t k = 0; k < STATES * STATES; k++)
        worst = fmax(worst, fabs(XY.val[k] + col(&XY, k / STATES, k % STATES) +
                                 FF.val[k]));
    return worst / due;
}

/* In the component's own coordinates, outputs over their limits. */
static void factors_satisfy_the_lyapunov_equations(void **unused)
{
    static const ritz_engine engine[] = {RITZ_ENGINE_DENSE, RITZ_ENGINE_MODAL};
    const double ab[] = {0.05, 0.002};

    (void)unused;
    for (int t = 0; t < 2; t++) {
        RITZ_OWN(ritz_component) chain = {0};
        RITZ_OWN(ritz_gramians) g = {0};
        ritz_gramians_request request = {0};
        ritz_dense AZ = {0}, EZ = {0}, B = {0}, C = {0};

        set_chain(0, &chain);
        for (int64_t j = 0; j < MASSES; j++)
            ritz_dense_col(&chain.io.Cv, j)[2] = 0.5 * (double)(j == 4);
        chain.io.limit[1] = 0.2;
        request = asking(&chain, engine[t], "rayleigh 0.05 0.002");
        assert_ok(ritz_gramians_of_component(&request, &g));
        assert_ok(ritz_dense_new(STATES, 3, &B));
        assert_ok(ritz_dense_new(STATES, 4, &C));
        for (int64_t i = 0; i < MASSES; i++) {
            for (int64_t j = 0; j < 3; j++)
                ritz_dense_col(&B, j)[MASSES + i] = col(&chain.io.B, i, j);
            for (int64_t j = 0; j < 4; j++) {
                double by = j == 1 ? 0.2 : 1.0;

                ritz_dense_col(&C, j)[i] = col(&chain.io.C, j, i) / by;
                ritz_dense_col(&C, j)[MASSES + i] = col(&chain.io.Cv, j, i);
            }
        }
        assert_ok(apply(&chain, ab, false, &g.Zc, &AZ));
        /* measured: 2e-14 and 7e-15, of sums of terms 100 times larger */
        assert_true(residual(&AZ, &g.EZc, &B) < 1e-12);
        ritz_dense_free(&AZ);
        assert_ok(apply(&chain, ab, true, &g.Zo, &AZ));
        assert_ok(ritz_dense_copy(&g.Zo, &EZ));
        for (int64_t k = 0; k < STATES * EZ.ncol; k++)
            EZ.val[k] = with_mass(&chain, &g.Zo, k % STATES, k / STATES);
        assert_true(residual(&AZ, &EZ, &C) < 1e-12);
        ritz_dense_free(&AZ);
        ritz_dense_free(&EZ);
        ritz_dense_free(&B);
        ritz_dense_free(&C);
    }
}

/* D between two masses of a chain couples its modes. */
static void auto_takes_the_engine_that_damping_allows(void **unused)
{
    static const int64_t row[] = {1, 1, 2, 2}, at[] = {1, 2, 1, 2};
    static const double d[] = {3.0, -3.0, -3.0, 3.0};
    const ritz_damping ratio = {.kind = RITZ_DAMPING_MODAL, .zeta = 0.01};
    RITZ_OWN(ritz_component) chain = {0};
    ritz_gramians_request request = {0};
    ritz_gramians g = {0};
    RITZ_OWN(ritz_state_space) space = {0};
    double *due = NULL;
    double sigma[STATES];
    int64_t count = 0;

    (void)unused;
    set_chain(RATES, &chain);
    request = asking(&chain, RITZ_ENGINE_AUTO, "modal 0.01");
    assert_ok(ritz_gramians_of_component(&request, &g));
    assert_string_equal(g.engine, "closed form");
    assert_string_equal(g.damping, "modal 0.01");
    ritz_gramians_free(&g);
    assert_ok(
        ritz_sparse_from_triplets(MASSES, MASSES, 4, row, at, d, &chain.D));
    assert_ok(ritz_gramians_of_component(&request, &g));
    assert_string_equal(g.engine, "SLICOT SB03OD");
    ritz_gramians_free(&g);
    (void)values(&request, sigma, STATES);
    assert_ok(ritz_state_space_of_component(&chain, &ratio, &space));
    assert_ok(ritz_gramians_of_space(&space, &g));
    assert_ok(ritz_gramians_hankel(&g, &count, &due));
    for (int k = 0; k < STATES; k++) /* other states, the same values */
        assert_near(sigma[k], due[k], 1e-12 * due[0]);
    free(due);
    ritz_gramians_free(&g);
    request.engine = RITZ_ENGINE_MODAL;
    assert_fails(ritz_gramians_of_component(&request, &g), RITZ_ERR_ARGUMENT,
                 "couples the modes at");
    assert_non_null(strstr(ritz_error_message(), "engine 'dense' takes any"));
}

/* Two equal masses, each on its spring, with a damper between them. */
static void set_twins(ritz_component *out)
{
    static const double m[] = {2.0, 2.0}, k[] = {0.0, 0.0};
    static const int64_t row[] = {0, 1}, in[] = {0}, seen[] = {0, 1};
    static const double spring[] = {18.0, 18.0};

    assert_ok(masses_component(2, m, k, NULL, out));
    ritz_sparse_free(&out->K);
    assert_ok(ritz_sparse_from_triplets(2, 2, 2, row, row, spring, &out->K));
    assert_ok(masses_io(out, 1, in, 2, seen));
    assert_ok(ritz_dampers_new(2, 1, &out->dampers));
    out->dampers.c[0] = 0.3;
    out->dampers.B.val[0] = 1.0;
    out->dampers.B.val[1] = -1.0;
}

/*
 * Modes of one frequency can be chosen so that the damper acts on one of them:
 * by 2 c / m, beside the ratio.
 */
static void a_damper_within_a_cluster_is_no_coupling(void **unused)
{
    RITZ_OWN(ritz_component) twins = {0};
    double sigma[3][4];

    (void)unused;
    set_twins(&twins);
    for (int t = 0; t < 3; t++) {
        ritz_gramians_request request = asking(
            &twins, t ? RITZ_ENGINE_AUTO : RITZ_ENGINE_DENSE, "modal 0.05");
        RITZ_OWN(ritz_gramians) g = {0};

        request.among_hz = t == 2 ? 10.0 : 0.0;
        assert_ok(ritz_gramians_of_component(&request, &g));
        assert_string_equal(g.engine, t ? "closed form" : "SLICOT SB03OD");
        assert_int_equal(values(&request, sigma[t], 4), 4);
        for (int k = 0; k < 4; k++) /* measured: 1e-14 */
            assert_near(sigma[t][k], sigma[0][k], 1e-13 * sigma[0][0]);
    }
    /* less than of the one without the damper, b = 1 / 2, c = 1 / m */
    assert_true(sigma[0][0] < 0.5 / (4.0 * 0.05 * 9.0) * 1.06);
}

/* A dashpot to ground holds nothing: where it comes to rest is a pole at 0. */
static void what_does_not_decay_stands_apart(void **unused)
{
    static const int64_t row[] = {0};
    static const double d[] = {0.5};
    RITZ_OWN(ritz_component) chain = {0};
    ritz_gramians_request request = {0};
    RITZ_OWN(ritz_gramians) g = {0};

    (void)unused;
    set_chain(FREE, &chain);
    assert_ok(
        ritz_sparse_from_triplets(MASSES, MASSES, 1, row, row, d, &chain.D));
    request = asking(&chain, RITZ_ENGINE_AUTO, "modal 0.01");
    assert_ok(ritz_gramians_of_component(&request, &g));
    assert_string_equal(g.engine, "SLICOT SB03OD");
    assert_int_equal(g.T.ncol, 1);
    for (int64_t i = 0; i < MASSES; i++) {
        /* translation, and at rest; measured: 1e-14 */
        assert_near(g.T.val[i], g.T.val[0], 1e-12 * fabs(g.T.val[0]));
        assert_near(g.T.val[MASSES + i], 0.0, 1e-12 * fabs(g.T.val[0]));
    }
}

/* All modes by sparse matrices are all modes; some are fewer. */
static void modes_up_to_a_frequency_are_all_that_is_taken(void **unused)
{
    static const int what[] = {0, FREE | RATES, REPEATED};
    ritz_component chain = {0};
    ritz_gramians g = {0};
    int64_t count = 0;

    (void)unused;
    for (int t = 0; t < 3; t++) {
        ritz_gramians_request request = {0};
        double all[STATES], sparse[STATES];

        set_chain(what[t], &chain);
        request = asking(&chain, RITZ_ENGINE_MODAL, "modal 0.02");
        (void)values(&request, all, STATES);
        request.among_hz = 100.0;
        (void)values(&request, sparse, STATES);
        for (int k = 0; k < STATES; k++) /* two ways to the same modes */
            assert_near(sparse[k], all[k], 1e-12 * all[0]);
        ritz_component_free(&chain);
    }
    set_chain(0, &chain);
    assert_ok(
        ritz_eigen_count(&chain.K, &chain.M, ritz_eigen_lambda(1.0), &count));
    assert_in_range(count, 2, MASSES - 2);
    for (int t = 0; t < 2; t++) {
        ritz_gramians_request request = asking(
            &chain, t ? RITZ_ENGINE_MODAL : RITZ_ENGINE_AUTO, "modal 0.02");

        request.among_hz = 1.0;
        assert_ok(ritz_gramians_of_component(&request, &g));
        assert_int_equal(g.Zc.ncol, 2 * count);
        ritz_gramians_free(&g);
    }
    ritz_component_free(&chain);
}

/* The same as of the modal model, through the component's coordinates. */
static void a_band_is_heeded(void **unused)
{
    RITZ_OWN(ritz_component) chain = {0};
    ritz_gramians_request request = {0};
    double full[STATES], wide[STATES], narrow[STATES];

    (void)unused;
    set_chain(FREE | RATES, &chain);
    request = asking(&chain, RITZ_ENGINE_AUTO, "modal 0.02");
    (void)values(&request, full, STATES);
    request.band_hz[1] = HUGE_VAL;
    (void)values(&request, wide, STATES);
    request.band_hz[0] = 0.9;
    request.band_hz[1] = 1.5;
    (void)values(&request, narrow, STATES);
    for (int k = 0; k < STATES - 2; k++) {
        /* by squares: eps over the relative value */
        assert_near(wide[k], full[k], 1e-13 * full[0] * (full[0] / full[k]));
        /* less of both Gramians is less of each value, but for that rounding */
        assert_true(narrow[k] < full[k] * (1.0 + 1e-9));
    }
    assert_true(narrow[0] > 0.0 && narrow[STATES - 3] < full[STATES - 3]);
}

/* 100 M + 0.01 K: low modes are light, high ones overdamped. */
static void the_engines_agree_on_lf10(void **unused)
{
    const char *folder = getenv("RITZ_EXTERNAL_DATA");
    const char *const at[] = {"u=2:2"}, *const name[] = {"K", "M", "D"};
    char path[3][PATH_SIZE];
    const ritz_import_request files = {.stiffness = path[0],
                                       .mass = path[1],
                                       .damping = path[2],
                                       .num_inputs = 1,
                                       .input = at,
                                       .num_outputs = 1,
                                       .output = at};
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) beam = {0};
    ritz_gramians_request request = {0};
    double dense[36], modal[36];
    FILE *file = NULL;

    (void)unused;
    for (int k = 0; k < 3; k++)
        snprintf(path[k], PATH_SIZE, "%s/second_order/LF10/%s.mtx",
                 folder ? folder : "", name[k]);
    file = fopen(path[0], "r");
    if (!file) {
        printf("%s is not there\n", path[0]);
        skip();
    }
    fclose(file);
    assert_ok(ritz_import(&files, &beam, &report));
    request = asking(&beam, RITZ_ENGINE_DENSE, "");
    assert_int_equal(values(&request, dense, 36), 36);
    request.engine = RITZ_ENGINE_MODAL;
    (void)values(&request, modal, 36);
    for (int k = 0; k < 36; k++)
        assert_near(modal[k], dense[k], 1e-8 * dense[0]); /* seen: 3e-12 */
}

static void assert_refused(const ritz_gramians_request *request,
                           const char *words)
{
    ritz_gramians none = {0};

    assert_fails(ritz_gramians_of_component(request, &none), RITZ_ERR_ARGUMENT,
                 words);
}

static void what_does_not_fit_an_engine_is_refused(void **unused)
{
    RITZ_OWN(ritz_component) chain = {0};
    ritz_gramians_request request = {0};

    (void)unused;
    set_chain(FREE, &chain);
    request = asking(&chain, RITZ_ENGINE_AUTO, "");
    assert_refused(&request, "has no damping");
    request.engine = RITZ_ENGINE_DENSE;
    assert_refused(&request, "no motion of the component decays");
    request.band_hz[1] = 2.0;
    assert_refused(&request, "a band is of engine 'modal', not of 'dense'");
    request.band_hz[1] = 0.0;
    request.among_hz = 2.0;
    assert_refused(&request, "of engine 'modal', not of 'dense'");
    request = asking(&chain, RITZ_ENGINE_LOW_RANK, "modal 0.1");
    request.band_hz[1] = 2.0;
    assert_refused(&request, "a band is of engine 'modal', not of 'low-rank'");
    request = asking(&chain, RITZ_ENGINE_MODAL, "modal 0.1");
    request.band_hz[0] = 2.0;
    assert_refused(&request, "not from 2 to 0");
    request.band_hz[0] = 0.0;
    request.among_hz = 0.01;
    assert_refused(&request, "no flexible modes up to that frequency");
    request.among_hz = -1.0;
    assert_refused(&request, "cannot be taken up to -1 Hz");
    request.among_hz = 0.0;
    chain.io.limit[2] = 0.0;
    assert_refused(&request, "'y3' has the limit 0");
    chain.io.limit[2] = nan("");
    assert_ok(ritz_sparse_copy(&chain.K, &chain.K4));
    assert_refused(&request, "structural damping");
    request.among_hz = 2.0;
    assert_refused(&request, "structural damping");
}

static void inputs_and_outputs_are_needed(void **unused)
{
    static const int64_t at[] = {0};
    RITZ_OWN(ritz_component) chain = {0};
    ritz_gramians_request request = {0};

    (void)unused;
    set_chain(0, &chain);
    request = asking(&chain, RITZ_ENGINE_AUTO, "modal 0.1");
    assert_ok(masses_io(&chain, 0, at, 1, at));
    assert_refused(&request, "the component has no inputs");
    assert_ok(masses_io(&chain, 1, at, 0, at));
    assert_refused(&request, "the component has no outputs");
}

/* A dof that nothing joins, and more of those than dense matrices take. */
static void rigid_and_large_components_are_refused(void **unused)
{
    static const double m[] = {2.0}, k[] = {0.0};
    static const int64_t at[] = {0};
    RITZ_OWN(ritz_component) mass = {0};
    ritz_gramians_request request = {0};

    (void)unused;
    assert_ok(masses_component(1, m, k, NULL, &mass));
    assert_ok(masses_io(&mass, 1, at, 1, at));
    for (int t = RITZ_ENGINE_DENSE; t <= RITZ_ENGINE_MODAL; t++) {
        request = asking(&mass, (ritz_engine)t, "modal 0.1");
        assert_refused(&request, "rigid modes are all there is");
        mass.num_dofs = RITZ_STATE_DOFS + 1;
        assert_refused(&request, t == RITZ_ENGINE_DENSE
                                     ? "1501 dofs are too many"
                                     : "1501 dofs have too many modes");
        mass.num_dofs = 1;
    }
}

static ritz_status once(const ritz_gramians_request *request)
{
    RITZ_OWN(ritz_gramians) gramians = {0};

    RITZ_CHECK(ritz_gramians_of_component(request, &gramians));
    return RITZ_OK;
}

static void engines_survive_every_allocation(void **unused)
{
    RITZ_OWN(ritz_component) chain = {0};
    ritz_gramians_request request = {0};

    (void)unused;
    set_chain(REPEATED | RATES, &chain);
    assert_ok(ritz_sparse_copy(&chain.K, &chain.D));
    request = asking(&chain, RITZ_ENGINE_DENSE, "modal 0.02");
    assert_survives_every_allocation(once(&request));
    request.engine = RITZ_ENGINE_AUTO;
    assert_survives_every_allocation(once(&request));
    request.band_hz[1] = 2.0;
    assert_survives_every_allocation(once(&request));
    request.among_hz = 2.0;
    assert_survives_every_allocation(once(&request));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(one_mass_has_the_closed_form_pair),
    cmocka_unit_test(dense_and_closed_form_agree),
    cmocka_unit_test(rigid_modes_stand_apart),
    cmocka_unit_test(factors_satisfy_the_lyapunov_equations),
    cmocka_unit_test(auto_takes_the_engine_that_damping_allows),
    cmocka_unit_test(a_damper_within_a_cluster_is_no_coupling),
    cmocka_unit_test(what_does_not_decay_stands_apart),
    cmocka_unit_test(modes_up_to_a_frequency_are_all_that_is_taken),
    cmocka_unit_test(a_band_is_heeded),
    cmocka_unit_test(the_engines_agree_on_lf10),
    cmocka_unit_test(what_does_not_fit_an_engine_is_refused),
    cmocka_unit_test(inputs_and_outputs_are_needed),
    cmocka_unit_test(rigid_and_large_components_are_refused),
    cmocka_unit_test(engines_survive_every_allocation),
};

TEST_MODULE(gramians_component, tests, NULL, NULL)
