/*
 * Coordinates that runs of all kinds store: constrained bodies, switched models,
 * closed loops, a rate of spin that changes, a joint that moves. Outputs follow
 * from them, and a run that ended early is continued with the same bits.
 */
#include "testing.h"

#include "joined.h"
#include "motions.h"
#include "rigs.h"
#include "spaces.h"
#include "swept_scenes.h"

#include <ritz/controlled.h>
#include <ritz/switched.h>

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const ritz_signal push = {
    .kind = RITZ_SIGNAL_SINE, .amplitude = 2.0, .hertz = {1.5, 0.0}};

/* One of several kinds of runs of a model with n coordinates. */
typedef struct kind {
    ritz_status (*run)(const void *of, const ritz_simulation_request *request,
                       ritz_simulation *out);
    const void *of;
    const ritz_io *io;
    ritz_simulation_request request; /* with coordinates */
} kind;

static ritz_simulation_request asking(const ritz_integrator *integrator)
{
    ritz_simulation_request request = RITZ_SIMULATION_NONE;

    request.integrator = integrator;
    request.seconds = 1.0;
    request.step = 0.01;
    request.every = 4;
    request.signal = &push;
    request.coordinates = true;
    return request;
}

/* Row i of A times x, and the sum of the sizes of its terms. */
static double row_of(const ritz_dense *A, int64_t i, const double *x,
                     double *size)
{
    double sum = 0.0;

    for (int64_t j = 0; j < A->ncol; j++) {
        const double term = ritz_dense_col(A, j)[i] * x[j];

        sum += term;
        *size += fabs(term);
    }
    return sum;
}

/* y = C q + Cv q' + Ca q'' to rounding of these terms. */
static void assert_outputs(const ritz_io *io, const ritz_simulation *s)
{
    const int64_t n = s->num_coordinates, p = s->num_outputs;

    assert_int_equal(io->num_outputs, p);
    for (int64_t k = 0; k < s->count; k++)
        for (int64_t i = 0; i < p; i++) {
            double size = 0.0;
            const double due = row_of(&io->C, i, s->q + k * n, &size) +
                               row_of(&io->Cv, i, s->v + k * n, &size) +
                               row_of(&io->Ca, i, s->a + k * n, &size);

            /* accelerations are differences of forces up to 1e3 times as large,
               in other orders for y and for q'' */
            assert_near(s->y[k * p + i], due,
                        DBL_EPSILON * (1e4 + 8.0 * (double)n * size));
        }
}

/* Outputs and energies are those of a run without coordinates. */
static void assert_without(const kind *of, const ritz_simulation *s)
{
    ritz_simulation_request request = of->request;
    RITZ_OWN(ritz_simulation) without = {0};

    request.coordinates = false;
    assert_ok(of->run(of->of, &request, &without));
    assert_int_equal(without.num_coordinates, 0);
    assert_null(without.q);
    assert_int_equal(without.count, s->count);
    assert_int_equal(without.num_outputs, s->num_outputs);
    for (int64_t i = 0; i < s->num_outputs; i++)
        assert_string_equal(without.output[i], s->output[i]);
    for (int64_t k = 0; k < s->count * s->num_outputs; k++)
        assert_near(without.y[k], s->y[k],
                    1e4 * DBL_EPSILON * (1.0 + fabs(s->y[k])));
    for (int64_t k = 0; k < s->count; k++)
        assert_near(without.kinetic[k], s->kinetic[k],
                    1e3 * DBL_EPSILON * (1.0 + s->kinetic[k]));
}

static bool count_down(void *context)
{
    int *left = context;

    return (*left)-- == 0;
}

static void assert_same(const double *a, const double *b, int64_t count)
{
    assert_true(count > 0);
    assert_memory_equal(a, b, (size_t)count * sizeof *a);
}

/* End the run after 37 of 100 steps, and continue it. */
static void assert_continues(const kind *of, const ritz_simulation *whole)
{
    ritz_simulation_request request = of->request;
    const int64_t times = whole->count, n = whole->num_coordinates;
    RITZ_OWN(ritz_simulation) part = {0}, rest = {0};
    int left = 37;

    request.stop = count_down;
    request.context = &left;
    assert_ok(of->run(of->of, &request, &part));
    assert_int_equal(part.count, 10);
    assert_int_equal(part.num_coordinates, n);
    request.stop = NULL;
    request.from = &part;
    assert_ok(of->run(of->of, &request, &rest));
    assert_int_equal(rest.count, times);
    assert_int_equal(rest.num_state, 0);
    assert_same(whole->y, rest.y, times * whole->num_outputs);
    assert_same(whole->q, rest.q, times * n);
    assert_same(whole->v, rest.v, times * n);
    assert_same(whole->a, rest.a, times * n);
    assert_same(whole->balance, rest.balance, times);
    if (whole->num_diagnostics > 0)
        assert_same(whole->diagnosis, rest.diagnosis,
                    times * whole->num_diagnostics);
}

static void assert_kind(const kind *of, int64_t n)
{
    RITZ_OWN(ritz_simulation) s = {0};
    double most = 0.0;

    assert_ok(of->run(of->of, &of->request, &s));
    assert_int_equal(s.num_coordinates, n);
    assert_int_equal(s.count, 26);
    for (int64_t k = 0; k < s.count * n; k++)
        most = fmax(most, fabs(s.q[k]));
    assert_true(most > 1e-3);
    assert_outputs(of->io, &s);
    assert_without(of, &s);
    assert_continues(of, &s);
}

static ritz_status run_short(const kind *of)
{
    ritz_simulation_request request = of->request;
    RITZ_OWN(ritz_simulation) s = {0};

    request.seconds = 0.1;
    return of->run(of->of, &request, &s);
}

/* --- constrained bodies --------------------------------------------------- */

typedef struct held {
    const joined *j;
    ritz_constrained_request how;
} held;

static ritz_status run_held(const void *of,
                            const ritz_simulation_request *request,
                            ritz_simulation *out)
{
    const held *h = of;

    return ritz_simulate_constrained(&h->j->bodies, &h->how, request, NULL,
                                     out);
}

/* All methods; those of the joined bodies satisfy C q = 0. */
static void constrained_bodies_keep_their_own_coordinates(void **)
{
    RITZ_OWN(joined) j = {0};

    assert_ok(joined_new(true, &j));
    for (const ritz_stabilisation *const *m = ritz_stabilisations; *m; m++) {
        held h = {.j = &j};
        const kind k = {run_held, &h, &j.bodies.io,
                        asking(&ritz_integrator_trapezoidal)};

        assert_ok(ritz_constrained_parse((*m)->name, &h.how));
        assert_kind(&k, JOINED_COORDINATES);
    }
}

/* q = T y with the coordinates y of the eliminated system, by the same
   integrator: multipliers cancel forces to rounding. */
static void constrained_bodies_move_as_those_of_the_eliminated_system(void **)
{
    RITZ_OWN(joined) j = {0};
    RITZ_OWN(ritz_simulation) s = {0}, due = {0};
    held h = {.j = &j};
    const ritz_simulation_request request =
        asking(&ritz_integrator_trapezoidal);

    assert_ok(joined_new(true, &j));
    assert_ok(ritz_constrained_parse("none", &h.how));
    assert_ok(run_held(&h, &request, &s));
    assert_ok(ritz_simulate(j.eliminated, &request, &due));
    for (int64_t k = 0; k < s.count; k++)
        for (int64_t i = 0; i < JOINED_COORDINATES; i++) {
            const double *const have[] = {s.q, s.v, s.a};
            const double *const want[] = {due.q, due.v, due.a};

            for (int p = 0; p < 3; p++) {
                double size = 0.0;
                const double x =
                    row_of(&j.T, i, want[p] + k * due.num_coordinates, &size);

                /* 100 steps with forces of 1e3 times displacements below 1 */
                assert_near(have[p][k * JOINED_COORDINATES + i], x,
                            1e5 * DBL_EPSILON * (1.0 + size));
            }
        }
}

/* --- switched models ------------------------------------------------------ */

typedef struct choice {
    motions m;
    ritz_dense library;
    ritz_switched switched;
} choice;

static void choice_free(choice *c)
{
    motions_free(&c->m);
    ritz_dense_free(&c->library);
}

static ritz_status run_choice(const void *of,
                              const ritz_simulation_request *request,
                              ritz_simulation *out)
{
    const choice *c = of;

    return ritz_simulate_switched(c->m.dense, request, &c->switched, NULL, out);
}

/* Six masses with D = 0.8 M and a library of modes. */
static ritz_status choice_new(choice *c)
{
    static const double m[] = {1.0, 2.0, 1.5, 0.7, 1.0, 3.0};
    static const double k[] = {100.0, 50.0, 80.0, 60.0, 200.0, 90.0};
    RITZ_OWN(ritz_pairs) pairs = {0};

    RITZ_CHECK(motions_row(6, m, k, NULL, &c->m));
    RITZ_CHECK(ritz_dense_copy(&c->m.M, &c->m.D));
    for (int64_t i = 0; i < 36; i++)
        c->m.D.val[i] = 0.8 * c->m.M.val[i];
    c->m.model.D = &c->m.D;
    c->m.dense = ritz_model_of_dense(&c->m.model, NULL);
    RITZ_CHECK(ritz_eigen_dense(&c->m.K, &c->m.M, &pairs));
    RITZ_MOVE(c->library, pairs.Phi);
    c->switched = (ritz_switched){.num_libraries = 1,
                                  .library = &c->library,
                                  .interval = 0.05,
                                  .indicator = 0.9};
    return RITZ_OK;
}

/* Initial values and vectors that are held are among the coordinates. */
static void switched_models_keep_coordinates_of_the_model(void **)
{
    static const double x0[] = {1.0, -1.0, 0.5, 1.0, -0.3, 0.2};
    RITZ_OWN(choice) c = {0};
    RITZ_OWN(ritz_simulation) s = {0};
    kind k = {run_choice, &c, NULL, asking(&ritz_integrator_modal)};

    assert_ok(choice_new(&c));
    k.io = c.m.dense.dense.io;
    k.request.x0 = x0;
    assert_ok(run_choice(&c, &k.request, &s));
    for (int i = 0; s.q && i < 6; i++) /* sums of six modes */
        assert_near(s.q[i], x0[i], 100.0 * DBL_EPSILON);
    assert_kind(&k, 6);
    c.switched.jump = RITZ_SWITCH_PROJECT;
    assert_kind(&k, 6);
    c.switched.jump = RITZ_SWITCH_OFFSET;
    c.switched.redundant = true; /* vectors that are not modes */
    for (int i = 0; i < 36; i++)
        c.library.val[i] += 0.3 * cos((double)i);
    assert_kind(&k, 6);
}

/* --- closed loops --------------------------------------------------------- */

typedef struct loop {
    motions row;
    ritz_state_space controller;
    ritz_loop loop;
    ritz_controlled way;
} loop;

static void loop_free(loop *l)
{
    motions_free(&l->row);
    ritz_state_space_free(&l->controller);
    ritz_loop_free(&l->loop);
}

static ritz_status run_loop(const void *of,
                            const ritz_simulation_request *request,
                            ritz_simulation *out)
{
    const loop *l = of;

    return ritz_simulate_controlled(l->row.dense, request, &l->way, NULL, out);
}

/* A derivative with a lag from the place of the first mass to the force on the
   last. */
static void loop_new(loop *l)
{
    static const double a = -10.0, b = 1.0, c = -100.0, d = 10.0;
    const spaces_rows rows = {1, 1, 1, &a, &b, &c, &d, NULL};
    ritz_io plant = {0}, inner = {0};
    char there[2 * RITZ_NAME_SIZE + 2], back[2 * RITZ_NAME_SIZE + 2];
    const char *const pairs[] = {there, back};

    assert_ok(motions_new(true, &l->row));
    assert_ok(spaces_make(&rows, &l->controller));
    snprintf(l->controller.input[0], RITZ_NAME_SIZE, "in");
    snprintf(l->controller.output[0], RITZ_NAME_SIZE, "out");
    plant = ritz_model_io(l->row.dense);
    inner = ritz_model_io(ritz_model_of_states(&l->controller));
    snprintf(there, sizeof there, "%s=in", plant.output[0]);
    snprintf(back, sizeof back, "out=%s", plant.input[0]);
    assert_ok(ritz_loop_match(&plant, &inner, 2, pairs, &l->loop));
    l->way = (ritz_controlled){.controller = &l->controller, .loop = &l->loop};
}

static void closed_loops_keep_coordinates_of_the_plant(void **)
{
    static const struct {
        bool exact;
        double sample, delay;
        const ritz_integrator *by;
    } ways[] = {{true, 0.0, 0.0, &ritz_integrator_modal},
                {false, 0.0, 0.0, &ritz_integrator_generalised_alpha},
                {false, 0.05, 0.13, &ritz_integrator_modal}};

    for (int i = 0; i < 3; i++) {
        RITZ_OWN(loop) l = {0};
        ritz_io io = {0};
        const kind k = {run_loop, &l, &io, asking(ways[i].by)};

        loop_new(&l);
        io = ritz_model_io(l.row.dense); /* its outputs, and those of the
                                            controller are left out */
        l.way.exact = ways[i].exact;
        l.way.sample = ways[i].sample;
        l.way.delay = ways[i].delay;
        assert_kind(&k, 3);
    }
}

/* --- a rate of spin that changes ------------------------------------------ */

/* A unit mass at (1, 0) on springs of 30, as in test_simulate_spin. */
typedef struct point {
    double K[4], M[4], G[4], S[4], load[4];
    ritz_dense dense[2];
    ritz_io io;
    ritz_second_order model;
    ritz_spin_terms terms; /* borrowed */
} point;

static void point_free(point *p)
{
    ritz_io_free(&p->io);
}

static void point_new(point *p)
{
    const point filled = {.K = {30, 0, 0, 30},
                          .M = {1, 0, 0, 1},
                          .G = {0, 2, -2, 0},
                          .S = {-1, 0, 0, -1},
                          .load = {1, 0, 0, -1}};

    *p = filled;
    assert_ok(ritz_io_new(2, 1, 3, &p->io));
    p->io.B.val[1] = 1.0;
    snprintf(p->io.input[0], RITZ_NAME_SIZE, "push");
    for (int i = 0; i < 3; i++)
        snprintf(p->io.output[i], RITZ_NAME_SIZE, "y%d", i);
    ritz_dense_col(&p->io.C, 0)[0] = 1.0;
    ritz_dense_col(&p->io.Cv, 1)[1] = 1.0;
    ritz_dense_col(&p->io.Ca, 1)[2] = 1.0;
    p->dense[0] = (ritz_dense){2, 2, p->K};
    p->dense[1] = (ritz_dense){2, 2, p->M};
    p->model =
        (ritz_second_order){.K = &p->dense[0], .M = &p->dense[1], .io = &p->io};
    p->terms = (ritz_spin_terms){.G = {2, 2, p->G},
                                 .S = {2, 2, p->S},
                                 .load = {2, 2, p->load},
                                 .inertia = 1.0};
}

static ritz_status run_point(const void *of,
                             const ritz_simulation_request *request,
                             ritz_simulation *out)
{
    static double ramp_time = 1.5, ramp_to = 4.0;
    static const ritz_spin_rate ramp = {RITZ_SPIN_RAMP, 1, &ramp_time,
                                        &ramp_to};
    const point *p = of;

    return ritz_simulate_spun(
        (ritz_model){.kind = RITZ_MODEL_DENSE, .dense = p->model}, &p->terms,
        &ramp, request, out);
}

static void a_spin_that_changes_keeps_coordinates_of_its_frame(void **)
{
    RITZ_OWN(point) p = {0};
    const kind k = {run_point, &p, &p.io, asking(&ritz_integrator_trapezoidal)};

    point_new(&p);
    assert_kind(&k, 2);
}

/* --- a joint that moves --------------------------------------------------- */

typedef struct turn {
    moving m;
    ritz_swept_model model;
    ritz_path path;
    bool terms;
} turn;

static void turn_free(turn *t)
{
    ritz_path_free(&t->path);
    ritz_swept_model_free(&t->model);
    moving_free(&t->m);
}

static ritz_status run_turn(const void *of,
                            const ritz_simulation_request *request,
                            ritz_simulation *out)
{
    const turn *t = of;

    return ritz_simulate_swept(&t->model, &t->path, t->terms, request, out);
}

/* Two chains on a caged hinge from 20 to 65 degrees, with 12 modes. */
static void turn_new(turn *t)
{
    static const char hinge[] =
        "  - {name: p, between: [A/g3, B/g1], type: hinge, axis: [0, 0, 1], "
        "angles_deg: [20], state: caged, stiffness: 50, damping: 3}\n"
        "inputs: [{name: f, at: B/g3, component: 1}]\n"
        "outputs:\n"
        "  - {name: y, at: B/g3, component: 2}\n"
        "  - {name: v, at: A/g1, component: 3, quantity: velocity}\n"
        "  - {name: a, at: B/g1, component: 6, quantity: acceleration}\n";
    static const double start = 20.0;
    ritz_sweep_request asked = moving_sweep(&start, 20.0, 65.0);
    rig r = rig_of_chains(2);
    char text[RIG_TEXT];

    rig_scene(&r, hinge, text);
    assert_ok(ritz_scene_parse("rig.yaml", text, &t->m.scene));
    rig_stage(&r, &t->m.scene, &ritz_method_full, -1, &t->m.stage);
    rig_free(&r);
    asked.modes = 12;
    assert_ok(ritz_path_parse("20:65:1s:smooth", &t->path));
    assert_ok(ritz_stage_sweep(&t->m.stage, &asked, &t->model));
}

static void joints_that_move_keep_coordinates_of_the_bodies(void **)
{
    RITZ_OWN(turn) t = {0};
    const kind k = {run_turn, &t, &t.model.io,
                    asking(&ritz_integrator_trapezoidal)};

    turn_new(&t);
    for (int terms = 0; terms < 2; terms++) {
        t.terms = terms == 1;
        assert_kind(&k, 36);
    }
}

/* Bodies that were projected: V u, with an arbitrary V. */
static void coordinates_before_a_projection_are_stored(void **)
{
    enum { ROWS = 40, COLUMNS = 36 };
    const ritz_simulation_request request =
        asking(&ritz_integrator_trapezoidal);
    RITZ_OWN(turn) t = {.terms = true};
    RITZ_OWN(ritz_simulation) own = {0}, s = {0};

    turn_new(&t);
    assert_ok(run_turn(&t, &request, &own));
    assert_ok(ritz_dense_new(ROWS, COLUMNS, &t.model.V));
    for (int i = 0; i < ROWS * COLUMNS; i++)
        t.model.V.val[i] = cos((double)i);
    assert_ok(run_turn(&t, &request, &s));
    assert_int_equal(own.num_coordinates, COLUMNS);
    assert_int_equal(s.num_coordinates, ROWS);
    for (int64_t k = 0; k < s.count; k++)
        for (int64_t i = 0; i < ROWS; i++) {
            double size = 0.0;
            const double due =
                row_of(&t.model.V, i, own.a + k * COLUMNS, &size);

            assert_near(s.a[k * ROWS + i], due,
                        1e4 * DBL_EPSILON * (1.0 + size));
        }
}

static void bodies_have_blocks_of_their_coordinates(void **)
{
    RITZ_OWN(turn) t = {0};
    RITZ_OWN_ARRAY ritz_block *block = NULL;

    turn_new(&t);
    assert_ok(ritz_stage_blocks(&t.m.stage, &block));
    assert_string_equal(block[1].name, "B");
    assert_int_equal(block[0].first, 0);
    assert_int_equal(block[1].first, block[0].order);
    assert_int_equal(block[1].first + block[1].order, t.model.M.nrow);
    assert_int_equal(block[1].order_full, t.m.stage.body[1].num_dofs);
    assert_int_equal(t.model.num_bodies, 2);
    assert_true(!t.model.turns[0] && t.model.turns[1]);
}

static void all_allocations_may_fail(void **)
{
    RITZ_OWN(joined) j = {0};
    RITZ_OWN(choice) c = {0};
    RITZ_OWN(point) p = {0};
    RITZ_OWN(turn) t = {.terms = true};
    held h = {.j = &j};
    const ritz_simulation_request request =
        asking(&ritz_integrator_trapezoidal);
    const kind kinds[] = {{run_held, &h, NULL, request},
                          {run_choice, &c, NULL, request},
                          {run_point, &p, NULL, request},
                          {run_turn, &t, NULL, request}};

    assert_ok(joined_new(true, &j));
    assert_ok(ritz_constrained_parse("baumgarte", &h.how));
    assert_ok(choice_new(&c));
    point_new(&p);
    turn_new(&t);
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        assert_survives_every_allocation(run_short(&kinds[k]));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(constrained_bodies_keep_their_own_coordinates),
    cmocka_unit_test(constrained_bodies_move_as_those_of_the_eliminated_system),
    cmocka_unit_test(switched_models_keep_coordinates_of_the_model),
    cmocka_unit_test(closed_loops_keep_coordinates_of_the_plant),
    cmocka_unit_test(a_spin_that_changes_keeps_coordinates_of_its_frame),
    cmocka_unit_test(joints_that_move_keep_coordinates_of_the_bodies),
    cmocka_unit_test(coordinates_before_a_projection_are_stored),
    cmocka_unit_test(bodies_have_blocks_of_their_coordinates),
    cmocka_unit_test(all_allocations_may_fail),
};

TEST_MODULE(body_coordinates, tests, NULL, NULL)
