/* Quantities over time that are recovered from coordinates, and their
   maxima. */
#include "testing.h"

#include "spring_chain.h"

#include <ritz/basis.h>
#include <ritz/recover.h>

#include <float.h>
#include <stdio.h>

enum { MASSES = 8, SPRINGS = MASSES - 1 };

/* A chain pushed at its end, with dampers, D and the strains of its springs,
   reduced to all of its dofs, mode acceleration without ports. */
typedef struct fixture {
    ritz_component chain;
    ritz_reduced reduced;
} fixture;

static void add_strains(ritz_component *c)
{
    int64_t row[2 * SPRINGS], col[2 * SPRINGS];
    double val[2 * SPRINGS];
    ritz_quantity *q = ritz_zalloc(1, sizeof *q);

    assert_non_null(q);
    c->quantity = q;
    c->num_quantities = 1;
    snprintf(q->name, sizeof q->name, "strain");
    snprintf(q->kind, sizeof q->kind, "stress");
    q->count = SPRINGS;
    q->place = ritz_zalloc(SPRINGS, sizeof *q->place);
    q->part = ritz_zalloc(SPRINGS, sizeof *q->part);
    assert_true(q->place && q->part);
    for (int64_t k = 0; k < 2 * SPRINGS; k++) {
        row[k] = k / 2;
        col[k] = k / 2 + k % 2;
        val[k] = k % 2 ? 1.0 : -1.0;
        q->place[k / 2] = 10 + k / 2;
    }
    assert_ok(ritz_sparse_from_triplets(SPRINGS, MASSES, 2 * SPRINGS, row, col,
                                        val, &q->S));
}

static void make_chain(ritz_component *c)
{
    const int64_t spring[] = {2, 5};

    assert_ok(spring_chain(MASSES, false, c));
    assert_ok(spring_chain_damp(c, 2, spring, 9.0, 120.0));
    assert_ok(ritz_sparse_copy(&c->M, &c->D));
    for (int64_t p = 0; p < c->D.colptr[MASSES]; p++)
        c->D.val[p] *= 0.3;
    ritz_io_free(&c->io);
    assert_ok(ritz_io_new(MASSES, 1, 0, &c->io));
    snprintf(c->io.input[0], RITZ_NAME_SIZE, "push");
    c->io.B.val[MASSES - 1] = 1.0;
    add_strains(c);
    assert_ok(ritz_component_settle(c, false));
}

static int set_up(void **state)
{
    static fixture f;
    RITZ_OWN(ritz_basis) basis = {0};
    ritz_mode_accelerations made = {0};

    f = (fixture){0};
    make_chain(&f.chain);
    assert_ok(ritz_basis_new(MASSES, MASSES, &basis));
    for (int64_t j = 0; j < MASSES; j++)
        ritz_dense_col(&basis.T, j)[j] = 1.0;
    assert_ok(ritz_reduce(&f.chain, &basis, &f.reduced));
    assert_ok(
        ritz_mode_acceleration(&f.chain, &basis.T, "", &f.reduced, &made));
    assert_int_equal(made.count, 1);
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;

    ritz_component_free(&f->chain);
    ritz_reduced_free(&f->reduced);
    return 0;
}

static const ritz_signal push = {
    .kind = RITZ_SIGNAL_SINE, .amplitude = 5.0, .hertz = {1.2, 0.0}};

/* Simulate the chain with retuned dampers and keep its coordinates. */
static void simulate(const fixture *f, const ritz_damping *damping,
                     ritz_simulation *out)
{
    ritz_simulation_request request = RITZ_SIMULATION_NONE;
    RITZ_OWN(ritz_reduced) copy = {0};
    RITZ_OWN(ritz_dense) T = {0};

    assert_ok(ritz_dense_identity(MASSES, &T));
    assert_ok(ritz_reduced_project(&f->reduced, &T, &copy));
    assert_ok(ritz_reduced_install(&copy));
    request.seconds = 1.5;
    request.step = 0.01;
    request.signal = &push;
    request.coordinates = true;
    assert_ok(
        ritz_simulate(ritz_model_of_reduced(&copy, damping), &request, out));
}

static ritz_instant instant_of(const ritz_simulation *s, int64_t k)
{
    const int64_t n = s->num_coordinates;

    return (ritz_instant){s->seconds[k], s->q + k * n, s->v + k * n,
                          s->a + k * n, s->u + k * s->num_inputs};
}

/*
 * A basis of all dofs is in equilibrium with its forces, so that mode
 * acceleration gives what mode displacement does: with dampers retuned, and any
 * stated damping.
 */
static void
mode_displacement_and_acceleration_agree_in_a_full_basis(void **state)
{
    static const char *const dampings[] = {
        "", "rayleigh 0.2 0.001", "modal 0.03", "bands 0 3 0.01 3 50 0.2",
        "fit 1 0.01 4 0.03"};
    fixture *f = *state;

    assert_ok(ritz_dampers_tune(&f->reduced.dampers, "damper 5=25*-80"));
    for (size_t d = 0; d < sizeof dampings / sizeof *dampings; d++) {
        RITZ_OWN(ritz_simulation) s = {0};
        RITZ_OWN(ritz_recoverer) by_modes = {0}, by_forces = {0};
        ritz_damping damping = {0};
        double largest = 0.0, y[SPRINGS], z[SPRINGS];

        assert_ok(ritz_damping_parse(dampings[d], &damping));
        simulate(f, &damping, &s);
        assert_ok(ritz_recoverer_new(&f->reduced, &damping, false, &by_modes));
        assert_ok(ritz_recoverer_new(&f->reduced, &damping, true, &by_forces));
        for (int64_t k = 0; k < s.count; k++) {
            const ritz_instant now = instant_of(&s, k);

            assert_ok(ritz_recoverer_check(&by_forces, &now));
            ritz_recoverer_rows(&by_modes, 0, &now, y);
            ritz_recoverer_rows(&by_forces, 0, &now, z);
            for (int64_t i = 0; i < SPRINGS; i++) {
                assert_near(y[i], now.q[i + 1] - now.q[i], DBL_EPSILON);
                /* forces of 1e3 times displacements below 0.1, over stiffnesses
                   of 1e3: a hundred roundings each */
                assert_near(z[i], y[i], 1e2 * 1e2 * DBL_EPSILON);
                largest = fmax(largest, fabs(y[i]));
            }
        }
        assert_true(largest > 1e-3);
    }
}

/* Accelerations of modes above the frequencies of all columns are left out. */
static void accelerations_above_all_frequencies_are_left_out(void **state)
{
    fixture *f = *state;
    RITZ_OWN(ritz_pairs) pairs = {0};
    RITZ_OWN(ritz_recoverer) all = {0}, some = {0};
    RITZ_OWN(ritz_dense) due = {0}, got = {0};

    assert_ok(ritz_eigen_dense(&f->reduced.K, &f->reduced.M, &pairs));
    f->reduced.dampers.c[0] = f->reduced.dampers.c[1] = 0.0;
    f->reduced.dampers.k[0] = f->reduced.dampers.k[1] = 0.0;
    assert_ok(ritz_recoverer_new(&f->reduced, NULL, true, &all));
    f->reduced.columns.hertz[3] = ritz_eigen_hertz(pairs.lambda[2]);
    assert_ok(ritz_recoverer_new(&f->reduced, NULL, true, &some));
    assert_ok(ritz_dense_mul(&all.rule->Ca, &pairs.Phi, &due));
    assert_ok(ritz_dense_mul(&some.rule->Ca, &pairs.Phi, &got));
    for (int64_t k = 0; k < MASSES; k++)
        for (int64_t i = 0; i < SPRINGS; i++)
            assert_near(ritz_dense_col(&got, k)[i],
                        k < 3 ? ritz_dense_col(&due, k)[i] : 0.0,
                        MASSES * 1e2 * DBL_EPSILON);
}

static void a_history_that_lacks_something_is_refused(void **state)
{
    fixture *f = *state;
    RITZ_OWN(ritz_recoverer) r = {0}, none = {0};
    RITZ_OWN(ritz_reduced) bare = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    double zero[MASSES] = {0.0};
    ritz_instant now = {.q = zero};

    assert_ok(ritz_recoverer_new(&f->reduced, NULL, true, &r));
    assert_fails(ritz_recoverer_check(&r, &now), RITZ_ERR_ARGUMENT,
                 "the history has no velocities, which 'strain' needs");
    now.v = zero;
    assert_fails(ritz_recoverer_check(&r, &now), RITZ_ERR_ARGUMENT,
                 "has no accelerations");
    now.a = zero;
    assert_fails(ritz_recoverer_check(&r, &now), RITZ_ERR_ARGUMENT,
                 "has no inputs");
    assert_ok(ritz_basis_new(MASSES, 1, &basis));
    basis.T.val[0] = 1.0;
    assert_ok(ritz_reduce(&f->chain, &basis, &bare));
    assert_fails(ritz_recoverer_new(&bare, NULL, true, &none),
                 RITZ_ERR_ARGUMENT, "no quantity has mode acceleration");
}

static void peaks_have_their_sign_and_their_time(void **state)
{
    fixture *f = *state;
    RITZ_OWN(ritz_recoverer) r = {0};
    RITZ_OWN(ritz_recovered) peaks = {0};
    double y[SPRINGS] = {0.0};
    char name[RITZ_QUANTITY_NAME_SIZE];

    assert_ok(ritz_recoverer_new(&f->reduced, NULL, false, &r));
    assert_ok(ritz_recovered_new(&r, &peaks));
    for (int k = 0; k < 4; k++) {
        y[1] = k == 2 ? -7.0 : 3.0;
        y[2] = 5.0; /* reached first at the beginning */
        assert_ok(ritz_recovered_note(0, 0.5 * k, y, &peaks));
        ritz_recovered_step(0.5 * k, &peaks);
    }
    assert_int_equal(peaks.count, 4);
    assert_near(peaks.end, 1.5, 0.0);
    assert_near(peaks.quantity->value[1], -7.0, 0.0);
    assert_near(peaks.quantity->seconds[1], 1.0, 0.0);
    assert_near(peaks.quantity->seconds[2], 0.0, 0.0);
    assert_string_equal(peaks.quantity->by, "mode displacement");
    assert_string_equal(ritz_peaks_name(peaks.quantity, 1, name), "element 11");
    y[0] = nan("");
    assert_fails(ritz_recovered_note(0, 2.0, y, &peaks), RITZ_ERR_CONVERGENCE,
                 "'element 10' of 'strain' is not finite at 2 s");
}

static ritz_status prepare_once(const ritz_reduced *reduced,
                                const ritz_damping *damping)
{
    RITZ_OWN(ritz_recoverer) r = {0};
    RITZ_OWN(ritz_recovered) peaks = {0};

    RITZ_CHECK(ritz_recoverer_new(reduced, damping, true, &r));
    return ritz_recovered_new(&r, &peaks);
}

static void all_allocations_may_fail(void **state)
{
    fixture *f = *state;
    ritz_damping damping = {0};

    assert_ok(ritz_damping_parse("modal 0.01", &damping));
    f->reduced.columns.hertz[0] = 5.0;
    assert_survives_every_allocation(prepare_once(&f->reduced, &damping));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup_teardown(
        mode_displacement_and_acceleration_agree_in_a_full_basis, set_up,
        tear_down),
    cmocka_unit_test_setup_teardown(
        accelerations_above_all_frequencies_are_left_out, set_up, tear_down),
    cmocka_unit_test_setup_teardown(a_history_that_lacks_something_is_refused,
                                    set_up, tear_down),
    cmocka_unit_test_setup_teardown(peaks_have_their_sign_and_their_time,
                                    set_up, tear_down),
    cmocka_unit_test_setup_teardown(all_allocations_may_fail, set_up,
                                    tear_down),
};

TEST_MODULE(recover, tests, NULL, NULL)
