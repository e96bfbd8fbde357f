/* Joints that move, against a full model that is integrated without the rates
   of its basis; what is refused. */
#include "simulate/swept.h"

#include "base/tolerances.h"
#include "linear/general.h"

#include "rigs.h"
#include "swept_scenes.h"
#include "testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double rig_start = 20.0;
static const char rig_hinge[] =
    "  - {name: p, between: [A/g3, B/g1], type: hinge, axis: [0, 0, 1], "
    "angles_deg: [20], state: caged, stiffness: 50, damping: 3}\n"
    "inputs: [{name: f, at: B/g3, component: 1}]\n"
    "outputs:\n"
    "  - {name: y, at: B/g3, component: 2}\n"
    "  - {name: z, at: A/g1, component: 3, quantity: velocity}\n";

/* Two bodies in space on a caged hinge that turns. */
static void make_rig(const char *joint, moving *m)
{
    rig r = rig_of_chains(2);
    char text[RIG_TEXT];

    rig_scene(&r, joint, text);
    assert_ok(ritz_scene_parse("rig.yaml", text, &m->scene));
    rig_stage(&r, &m->scene, &ritz_method_full, -1, &m->stage);
    rig_free(&r);
}

static const ritz_signal push = {
    .kind = RITZ_SIGNAL_SINE, .amplitude = 1.0, .hertz = {0.7, 0.0}};

static ritz_status run_rig(const moving *m, const ritz_damping *damping,
                           int64_t modes, bool terms, double step,
                           const ritz_simulation *from, ritz_simulation *out)
{
    ritz_sweep_request asked = moving_sweep(&rig_start, 20.0, 65.0);
    ritz_simulation_request request = moving_request(0.6, step);
    RITZ_OWN(ritz_swept_model) model = {0};
    RITZ_OWN(ritz_path) path = {0};

    asked.damping = damping;
    asked.modes = modes;
    request.signal = &push;
    request.from = from;
    RITZ_CHECK(ritz_path_parse("20:65:0.6s:smooth", &path));
    RITZ_CHECK(ritz_stage_sweep(&m->stage, &asked, &model));
    return ritz_simulate_swept(&model, &path, terms, &request, out);
}

/* Largest balance of energies, relative to the largest energy. */
static double imbalance(const ritz_simulation *s)
{
    double size = 0.0, off = 0.0;

    for (int64_t k = 0; k < s->count; k++) {
        size = fmax(size, s->kinetic[k] + s->potential[k]);
        off = fmax(off, fabs(s->balance[k]));
    }
    return off / size;
}

static void check_balance(const moving *m, bool terms)
{
    const ritz_damping ratios = {.kind = RITZ_DAMPING_MODAL, .zeta = 0.02};
    double last = 0.0;

    for (int k = 0; k < 5; k++) {
        RITZ_OWN(ritz_simulation) s = {0};
        double off = 0.0;

        assert_ok(run_rig(m, &ratios, 12, terms, 0.004 / (1 << k), NULL, &s));
        off = imbalance(&s);
        if (k > 0)
            assert_near(last / off, 4.0, 0.6);
        last = off;
    }
    assert_true(last < 1e-5);
}

static void energies_balance_to_the_order_of_the_step(void **state)
{
    RITZ_OWN(moving) m = {0};

    (void)state;
    make_rig(rig_hinge, &m);
    check_balance(&m, true);
    check_balance(&m, false);
}

/* u of all coordinates at a setting: T q. */
static void expand(const ritz_swept_model *model, double setting,
                   const double *q, ritz_dense *T, double *u)
{
    RITZ_OWN(ritz_dense) F = {0};
    const int64_t Q = model->M.nrow;

    assert_ok(ritz_swept_values(model, model->unit * setting, &F));
    ritz_dense_free(T);
    assert_ok(ritz_dense_block(&F, 0, Q, 0, model->order, T));
    memset(u, 0, (size_t)Q * sizeof *u);
    for (int64_t j = 0; j < model->order; j++)
        for (int64_t i = 0; i < Q; i++)
            u[i] += ritz_dense_col(T, j)[i] * q[j];
}

/* sum += factor T'A u */
static void add_load(const ritz_dense *T, const ritz_dense *A, double factor,
                     double *u, double *sum)
{
    RITZ_OWN(ritz_dense) Au = {0}, load = {0};

    assert_ok(ritz_dense_mul(A, &(ritz_dense){A->ncol, 1, u}, &Au));
    assert_ok(ritz_dense_mul_tn(T, &Au, &load));
    for (int64_t j = 0; j < T->ncol; j++)
        sum[j] += factor * load.val[j];
}

/* M exp(d N): products, in space, of motions at a setting with those at a
   setting larger by d. */
static void mass_across(const ritz_swept_model *m, double d, ritz_dense *out)
{
    assert_ok(ritz_dense_copy(&m->M, out));
    ritz_dense_add(sin(d), &m->G, out);
    ritz_dense_add(cos(d) - 1.0, &m->H, out);
}

/*
 * The full model without rates of T or of frames. With w = exp(x N) T q in
 * space and the bases T_n of all steps,
 *
 *     T_n'exp(x_n N)'M (w_n+1 - 2 w_n + w_n-1) / h^2 + T_n'K T_n q_n = T_n'B f
 *
 * which is solved for q_n+1, whose matrix is T_n'M_d T_n+1. The scheme is
 * explicit, of second order, and starts from rest.
 */
static double leap(const ritz_swept_model *m, const ritz_path *path, double h,
                   int64_t steps)
{
    const int64_t r = m->order, Q = m->M.nrow;
    RITZ_OWN(ritz_dense) T = {0}, next = {0}, A = {0}, q = {0};
    RITZ_OWN(ritz_dense) now = {0}, last = {0};
    double at[3], further[3], earlier[3];
    double *u = NULL, *before = NULL;

    assert_ok(ritz_dense_new(r, 1, &q));
    assert_ok(ritz_dense_new(Q, 1, &now));
    assert_ok(ritz_dense_new(Q, 1, &last));
    u = now.val;
    before = last.val;
    for (int64_t n = 0; n <= steps; n++) {
        RITZ_OWN(ritz_dense) ahead = {0}, back = {0}, MT = {0}, F = {0};
        RITZ_OWN(ritz_dense) Bf = {0};
        const double f = sin(2.0 * RITZ_PI * 0.7 * h * (double)n);

        ritz_path_at(path, h * (double)n, at);
        ritz_path_at(path, h * (double)(n + 1), further);
        ritz_path_at(path, fmax(h * (double)(n - 1), 0.0), earlier);
        expand(m, at[0], q.val, &T, u);
        if (n == steps)
            break;
        mass_across(m, m->unit * (further[0] - at[0]), &ahead);
        mass_across(m, m->unit * (earlier[0] - at[0]), &back);
        memset(q.val, 0, (size_t)r * sizeof *q.val);
        add_load(&T, &m->M, 2.0, u, q.val);
        add_load(&T, &back, -1.0, before, q.val);
        add_load(&T, &m->K, -h * h, u, q.val);
        assert_ok(ritz_dense_mul_tn(&T, &m->io.B, &Bf));
        for (int64_t j = 0; j < r; j++)
            q.val[j] += h * h * f * Bf.val[j] * (n == 0 ? 0.5 : 1.0);
        memcpy(before, u, (size_t)Q * sizeof *u);
        assert_ok(ritz_swept_values(m, m->unit * further[0], &F));
        assert_ok(ritz_dense_block(&F, 0, Q, 0, r, &next));
        assert_ok(ritz_dense_mul(&ahead, &next, &MT));
        ritz_dense_free(&A);
        assert_ok(ritz_dense_mul_tn(&T, &MT, &A));
        assert_ok(ritz_general_solve(&A, false, &q));
        ritz_dense_free(&next);
    }
    assert_ok(ritz_dense_mul(&m->io.C, &(ritz_dense){Q, 1, u}, &next));
    return next.val[0];
}

static const char rig_locked[] =
    "  - {name: p, between: [A/g3, B/g1], type: hinge, axis: [0, 0, 1], "
    "angles_deg: [20], state: locked}\n"
    "inputs: [{name: f, at: B/g3, component: 1}]\n"
    "outputs: [{name: y, at: B/g3, component: 2}]\n";

static void all_modes_with_the_terms_are_the_full_model(void **state)
{
    const ritz_sweep_request asked = moving_sweep(&rig_start, 20.0, 65.0);
    RITZ_OWN(moving) m = {0};
    RITZ_OWN(ritz_swept_model) model = {0};
    RITZ_OWN(ritz_path) path = {0};
    double last = 0.0;

    (void)state;
    make_rig(rig_locked, &m);
    assert_ok(ritz_path_parse("20:65:0.6s:smooth", &path));
    assert_ok(ritz_stage_sweep(&m.stage, &asked, &model));
    for (int k = 0; k < 3; k++) {
        const double h = 0.004 / (1 << k);
        ritz_simulation_request request = moving_request(0.6, h);
        RITZ_OWN(ritz_simulation) s = {0};
        double gap = 0.0, size = 0.0;

        request.signal = &push;
        assert_ok(ritz_simulate_swept(&model, &path, true, &request, &s));
        size = fabs(s.y[s.count - 1]);
        gap =
            fabs(s.y[s.count - 1] - leap(&model, &path, h, s.count - 1)) / size;
        /* both of order 2, more while the highest modes are not resolved */
        assert_true(k == 0 || last / gap > 3.5);
        last = gap;
    }
    assert_true(last < 1e-4);
}

static void without_the_terms_all_modes_are_another_model(void **state)
{
    const ritz_sweep_request asked = moving_sweep(&rig_start, 20.0, 65.0);
    ritz_simulation_request request = moving_request(0.6, 0.0005);
    RITZ_OWN(moving) m = {0};
    RITZ_OWN(ritz_swept_model) model = {0};
    RITZ_OWN(ritz_path) path = {0};
    RITZ_OWN(ritz_simulation) s = {0};
    double full = 0.0;

    (void)state;
    make_rig(rig_locked, &m);
    assert_ok(ritz_path_parse("20:65:0.6s:smooth", &path));
    assert_ok(ritz_stage_sweep(&m.stage, &asked, &model));
    request.signal = &push;
    assert_ok(ritz_simulate_swept(&model, &path, false, &request, &s));
    full = leap(&model, &path, 0.0005, s.count - 1);
    assert_true(fabs(s.y[s.count - 1] / full - 1.0) > 0.05);
}

static bool stop_half_way(void *context)
{
    int *left = context;

    return (*left)-- == 0;
}

static void a_run_continues_bit_for_bit(void **state)
{
    const ritz_sweep_request asked = moving_sweep(&rig_start, 20.0, 65.0);
    RITZ_OWN(moving) m = {0};
    RITZ_OWN(ritz_swept_model) model = {0};
    RITZ_OWN(ritz_path) path = {0};
    RITZ_OWN(ritz_simulation) whole = {0}, part = {0}, rest = {0};
    ritz_simulation_request request = moving_request(0.6, 0.01);
    int left = 31;

    (void)state;
    make_rig(rig_hinge, &m);
    assert_ok(ritz_path_parse("20:65:0.6s:smooth", &path));
    assert_ok(ritz_stage_sweep(&m.stage, &asked, &model));
    request.signal = &push;
    request.hold = RITZ_HOLD_ZERO;
    assert_ok(ritz_simulate_swept(&model, &path, true, &request, &whole));
    request.stop = stop_half_way;
    request.context = &left;
    assert_ok(ritz_simulate_swept(&model, &path, true, &request, &part));
    assert_int_equal(part.count, 32);
    request.stop = NULL;
    request.from = &part;
    assert_ok(ritz_simulate_swept(&model, &path, true, &request, &rest));
    assert_int_equal(rest.count, whole.count);
    assert_memory_equal(rest.y, whole.y,
                        (size_t)(2 * whole.count) * sizeof(double));
    assert_memory_equal(rest.balance, whole.balance,
                        (size_t)whole.count * sizeof(double));
    assert_memory_equal(rest.diagnosis, whole.diagnosis,
                        (size_t)(3 * whole.count) * sizeof(double));
}

/* y at the end, over a path from 100 to 300 degrees or back, of a model over a
   range of settings. */
static double run_in_range(const moving *m, double from, double to, bool back)
{
    const ritz_damping ratios = {.kind = RITZ_DAMPING_MODAL, .zeta = 0.02};
    const double start = back ? 300.0 : 100.0;
    ritz_sweep_request asked = moving_sweep(&start, from, to);
    ritz_simulation_request request = moving_request(0.6, 0.005);
    RITZ_OWN(ritz_swept_model) model = {0};
    RITZ_OWN(ritz_path) path = {0};
    RITZ_OWN(ritz_simulation) s = {0};

    asked.damping = &ratios;
    request.signal = &push;
    assert_ok(ritz_path_parse(
        back ? "300:100:0.6s:smooth" : "100:300:0.6s:smooth", &path));
    assert_ok(ritz_stage_sweep(&m->stage, &asked, &model));
    assert_int_equal(model.turn.val != NULL, to - from > 360.0);
    assert_ok(ritz_simulate_swept(&model, &path, true, &request, &s));
    return s.y[2 * (s.count - 1)];
}

/* The knots of one turn begin at -100 degrees, those of the next at 260. With
   springs, dampers and ratios a run does not feel the step from one turn to the
   next, either way, nor that it is a thousand turns further. */
static void turns_join_without_a_seam(void **state)
{
    RITZ_OWN(moving) m = {0};

    (void)state;
    make_rig(rig_hinge, &m);
    for (int back = 0; back < 2; back++) {
        const double one = run_in_range(&m, 100.0, 300.0, back);

        /* T_xx of either spline is off by the root of its 1e-7: measured 5e-6 */
        assert_near(run_in_range(&m, -100.0, 300.0, back) / one, 1.0, 2e-5);
        assert_near(run_in_range(&m, -360100.0, 300.0, back) / one, 1.0, 2e-5);
    }
}

static void steps_beyond_a_quarter_turn_are_refused(void **state)
{
    const ritz_sweep_request asked = moving_sweep(&rig_start, 20.0, 920.0);
    ritz_simulation_request request = moving_request(1.0, 0.125);
    RITZ_OWN(moving) m = {0};
    RITZ_OWN(ritz_swept_model) model = {0};
    RITZ_OWN(ritz_path) path = {0};
    RITZ_OWN(ritz_simulation) s = {0};

    (void)state;
    make_rig(rig_locked, &m);
    assert_ok(ritz_stage_sweep(&m.stage, &asked, &model));
    assert_ok(ritz_path_parse("20:920:1s", &path));
    assert_fails(ritz_simulate_swept(&model, &path, true, &request, &s),
                 RITZ_ERR_ARGUMENT,
                 "'p' turns by 112 degrees in the step that ends at 0.125 s: "
                 "take shorter steps");
}

/* Between knots the spline has the frequencies of the modes at that setting. */
static void the_spline_is_as_accurate_as_it_reports(void **state)
{
    const double between = 33.3;
    ritz_sweep_request asked = moving_sweep(&rig_start, 20.0, 65.0);
    RITZ_OWN(moving) m = {0};
    RITZ_OWN(ritz_swept_model) model = {0};
    RITZ_OWN(ritz_configuration) c = {0};
    RITZ_OWN(ritz_dense) T = {0}, K = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    RITZ_OWN(ritz_dense) M = {0};
    RITZ_OWN(ritz_dense) u = {0}, q = {0};

    (void)state;
    make_rig(rig_locked, &m);
    asked.modes = 14;
    assert_ok(ritz_stage_sweep(&m.stage, &asked, &model));
    assert_int_equal(model.order, 14);
    assert_true(model.error > 0.0 && model.error <= 1e-7);
    assert_ok(ritz_dense_new(model.M.nrow, 1, &u));
    assert_ok(ritz_dense_new(14, 1, &q));
    expand(&model, between, q.val, &T, u.val);
    assert_ok(ritz_dense_congruence(&model.K, &T, &K));
    assert_ok(ritz_dense_congruence(&model.M, &T, &M));
    assert_ok(ritz_eigen_dense(&K, &M, &pairs));
    assert_ok(ritz_stage_assemble(&m.stage, &between, &c));
    for (int64_t k = c.num_rigid; k < 14; k++) /* second order in the basis */
        assert_near(pairs.lambda[k] / c.lambda[k], 1.0, 1e-9);
}

/* The band ends between the frequencies that a mode has at the ends of the
   range. */
static void a_mode_that_leaves_the_band_is_named(void **state)
{
    const double ends[2] = {20.0, 65.0};
    ritz_sweep_request asked = moving_sweep(&rig_start, ends[0], ends[1]);
    RITZ_OWN(moving) m = {0};
    RITZ_OWN(ritz_swept_model) model = {0};
    RITZ_OWN(ritz_configuration) first = {0}, last = {0};
    double hz[2], other = ends[1];
    char words[2][64];

    (void)state;
    make_rig(rig_locked, &m);
    assert_ok(ritz_stage_assemble(&m.stage, &ends[0], &first));
    assert_ok(ritz_stage_assemble(&m.stage, &ends[1], &last));
    hz[0] = sqrt(first.lambda[7]) / (2.0 * RITZ_PI);
    hz[1] = sqrt(last.lambda[7]) / (2.0 * RITZ_PI);
    asked.up_to_hz = 0.5 * (hz[0] + hz[1]);
    snprintf(words[0], sizeof words[0], "mode 8 (flexible mode 2) %s the band",
             hz[0] < hz[1] ? "leaves" : "enters");
    snprintf(words[1], sizeof words[1], "mode 8 (flexible mode 2) %s the band",
             hz[0] < hz[1] ? "enters" : "leaves");
    assert_fails(ritz_stage_sweep(&m.stage, &asked, &model), RITZ_ERR_ARGUMENT,
                 words[0]);
    asked.setting = &other;
    assert_fails(ritz_stage_sweep(&m.stage, &asked, &model), RITZ_ERR_ARGUMENT,
                 words[1]);
}

static void requests_without_a_model_are_refused(void **state)
{
    ritz_sweep_request asked = moving_sweep(&rig_start, 20.0, 20.0);
    RITZ_OWN(moving) m = {0};
    RITZ_OWN(ritz_swept_model) model = {0};

    (void)state;
    make_rig(rig_locked, &m);
    assert_fails(ritz_stage_sweep(&m.stage, &asked, &model), RITZ_ERR_ARGUMENT,
                 "'p' does not move from 20 to 20: the range is empty");
    asked = moving_sweep(&rig_start, 20.0, 60.0);
    asked.sweep = 1;
    assert_fails(ritz_stage_sweep(&m.stage, &asked, &model), RITZ_ERR_ARGUMENT,
                 "the scene has no such joint");
    asked.sweep = 0;
    asked.modes = 100;
    assert_fails(ritz_stage_sweep(&m.stage, &asked, &model), RITZ_ERR_ARGUMENT,
                 "100 modes are asked for, and the system has 30");
    asked.modes = 3;
    assert_fails(ritz_stage_sweep(&m.stage, &asked, &model), RITZ_ERR_ARGUMENT,
                 "3 modes are fewer than the 6 rigid motions");
    asked.up_to_hz = 1.0;
    assert_fails(ritz_stage_sweep(&m.stage, &asked, &model), RITZ_ERR_ARGUMENT,
                 "a number of modes or a band, one of them");
    ritz_invariants_free(&m.stage.body[1].invariants);
    asked.modes = 12;
    asked.up_to_hz = 0.0;
    assert_fails(ritz_stage_sweep(&m.stage, &asked, &model), RITZ_ERR_ARGUMENT,
                 "'B' turns with 'p', and its inertia is not known");
    assert_ok(ritz_dense_new(18, 18, &m.stage.body[1].K4));
    assert_fails(ritz_stage_sweep(&m.stage, &asked, &model), RITZ_ERR_ARGUMENT,
                 "structural damping of 'B'");
}

static void paths_and_requests_without_a_run_are_refused(void **state)
{
    const ritz_sweep_request asked = moving_sweep(&rig_start, 20.0, 65.0);
    ritz_simulation_request request = moving_request(1.0, 0.01);
    RITZ_OWN(moving) m = {0};
    RITZ_OWN(ritz_swept_model) model = {0};
    RITZ_OWN(ritz_path) path = {0}, far = {0}, smooth = {0};
    RITZ_OWN(ritz_simulation) s = {0};

    (void)state;
    make_rig(rig_locked, &m);
    assert_ok(ritz_stage_sweep(&m.stage, &asked, &model));
    assert_ok(ritz_path_parse("20:65:0.6s", &path));
    assert_ok(ritz_path_parse("20:65:0.6s:smooth", &smooth));
    assert_ok(ritz_path_parse("20:66:0.6s:smooth", &far));
    assert_fails(ritz_simulate_swept(&model, &path, true, &request, &s),
                 RITZ_ERR_ARGUMENT,
                 "'p' moves for 0.6 s and stops with a jump of its rate");
    assert_fails(ritz_simulate_swept(&model, &far, true, &request, &s),
                 RITZ_ERR_ARGUMENT,
                 "'p' goes from 20 to 66, beyond the model's 20 to 65");
    request.integrator = &ritz_integrator_modal;
    assert_fails(ritz_simulate_swept(&model, &smooth, true, &request, &s),
                 RITZ_ERR_ARGUMENT,
                 "a joint that moves is integrated by trapezoidal, not by "
                 "modal");
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(energies_balance_to_the_order_of_the_step),
    cmocka_unit_test(all_modes_with_the_terms_are_the_full_model),
    cmocka_unit_test(without_the_terms_all_modes_are_another_model),
    cmocka_unit_test(a_run_continues_bit_for_bit),
    cmocka_unit_test(turns_join_without_a_seam),
    cmocka_unit_test(steps_beyond_a_quarter_turn_are_refused),
    cmocka_unit_test(the_spline_is_as_accurate_as_it_reports),
    cmocka_unit_test(a_mode_that_leaves_the_band_is_named),
    cmocka_unit_test(requests_without_a_model_are_refused),
    cmocka_unit_test(paths_and_requests_without_a_run_are_refused),
};

TEST_MODULE(swept_full, tests, NULL, NULL)
