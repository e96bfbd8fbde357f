/*
 * A closed loop by one matrix exponential. With z = [x; v; w] and
 *
 *     z' = A z + B r,   exp([A B/s 0; 0 0 I/h; 0 0 0] h) = [E G/s H/s; ...]
 *
 * of plant and controller together, z_1 = E z_0 + G r_0 + H (r_1 - r_0), where
 * s is the largest entry of B. The energy that damping dissipates over a step,
 * the work of all forces and that of the controller are quadratic forms of
 * [z_0; s r_0; s (r_1 - r_0)], which are integrated with the exponential.
 *
 * All are kept as step_matrix.h has them, and cost O(N k) a step as long as the loop
 * couples the modes by k terms.
 */
#include "simulate/controlled.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"
#include "response/loop.h"
#include "simulate/step_matrix.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Quadratic forms that are integrated: power of damping, of all forces, and of
   the forces of the controller. */
enum { FORMS = 3 };

RITZ_ARRAY_OF(ritz_dense);

typedef struct exact {
    int64_t n, states; /* rows of z; of w, its last part */
    double scale;
    ritz_step_matrix E; /* z_1 over [z; s r; s dr] */
    ritz_step_matrix W[FORMS];
    ritz_dense C, D; /* of the closed loop */
    ritz_dense v;    /* outputs of the controller over [z; r] */
    double *memory;  /* w, work */
    double *z, *z1;
    ritz_loop_notes notes;
} exact;

static void release_exact(void *own)
{
    exact *s = own;
    ritz_step_matrix_free(&s->E);
    for (int f = 0; f < FORMS; f++)
        ritz_step_matrix_free(&s->W[f]);
    ritz_dense_free(&s->C);
    ritz_dense_free(&s->D);
    ritz_dense_free(&s->v);
    ritz_loop_notes_free(&s->notes);
    RITZ_FREE(s->memory, s->z, s->z1, s);
}

/* z = [x; v; w; r] */
static void gather(const ritz_march *march, const double *r, exact *s)
{
    const int64_t n = march->motion->n;
    double *z = s->z;

    memcpy(z, march->x, (size_t)n * sizeof *z);
    if (march->v)
        memcpy(z + n, march->v, (size_t)n * sizeof *z);
    z += s->n - s->states;
    memcpy(z, s->memory, (size_t)s->states * sizeof *z);
    memcpy(z + s->states, r, (size_t)march->motion->B.ncol * sizeof *z);
}

static void scatter(ritz_march *march, const exact *s)
{
    const int64_t n = march->motion->n;
    const double *z = s->z1;

    memcpy(march->x, z, (size_t)n * sizeof *z);
    if (march->v)
        memcpy(march->v, z + n, (size_t)n * sizeof *z);
    memcpy(s->memory, z + s->n - s->states, (size_t)s->states * sizeof *z);
}

static ritz_status advance_exact(ritz_march *march, const double *u0,
                                 const double *u1)
{
    exact *s = march->own;
    const int64_t p = march->motion->B.ncol;

    gather(march, u0, s);
    for (int64_t j = 0; j < p; j++) {
        s->z[s->n + j] = s->scale * u0[j];
        s->z[s->n + p + j] = s->scale * (u1[j] - u0[j]);
    }
    if (s->notes.work) {
        march->dissipated += ritz_step_matrix_value(&s->W[0], s->z);
        march->work += ritz_step_matrix_value(&s->W[1], s->z);
        s->memory[s->states] += ritz_step_matrix_value(&s->W[2], s->z);
    }
    ritz_step_matrix_apply(&s->E, s->z, s->z1);
    scatter(march, s);
    return RITZ_OK;
}

static void output_exact(const ritz_march *march, const double *u, double *y)
{
    exact *s = march->own;

    gather(march, u, s);
    memset(y, 0, (size_t)s->C.nrow * sizeof *y);
    ritz_motion_gemv(&s->C, 1.0, s->z, y);
    ritz_motion_gemv(&s->D, 1.0, u, y);
    memset(s->notes.acting, 0, (size_t)s->v.nrow * sizeof *y);
    ritz_motion_gemv(&s->v, 1.0, s->z, s->notes.acting);
}

static void diagnose_exact(const ritz_march *march, double *out)
{
    const exact *s = march->own;

    ritz_loop_notes_fill(&s->notes, out);
}

/* The matrix whose exponential propagates [z; s r; s (r_1 - r_0)]. */
static ritz_status exact_matrix(const ritz_state_space *closed, double step,
                                exact *s, ritz_dense *out)
{
    const int64_t n = s->n, p = closed->B.ncol;

    s->scale = fmax(ritz_dense_max(&closed->B), RITZ_LEAST_SCALE);
    RITZ_CHECK(ritz_dense_new(n + 2 * p, n + 2 * p, out));
    ritz_dense_put(&closed->A, 0, 0, out);
    for (int64_t j = 0; j < p; j++) {
        for (int64_t i = 0; i < n; i++)
            ritz_dense_col(out, n + j)[i] =
                ritz_dense_col(&closed->B, j)[i] / s->scale;
        ritz_dense_col(out, n + p + j)[n + j] = 1.0 / step;
    }
    return RITZ_OK;
}

/* Q += factor v'R z, made symmetric; v is in rows n to 2 n of z. */
static void add_power(double factor, int64_t n, const ritz_dense *R,
                      ritz_dense *Q)
{
    for (int64_t j = 0; j < R->ncol; j++)
        for (int64_t i = 0; i < n; i++) {
            const double half = 0.5 * factor * ritz_dense_col(R, j)[n + i];

            ritz_dense_col(Q, j)[n + i] += half;
            ritz_dense_col(Q, n + i)[j] += half;
        }
}

/* v'D v, v'(all forces) and v'(forces of the controller). All forces are those
   that change the rate of v from that of the plant without inputs; those of the
   controller are the same without the inputs of the loop. */
static ritz_status exact_forms(const ritz_motion *m,
                               const ritz_state_space *plant,
                               const ritz_dense *A, double scale,
                               ritz_dense Q[FORMS])
{
    const int64_t n = m->n, first = A->nrow - 2 * m->B.ncol;
    RITZ_OWN(ritz_dense) own = {0}, inputs = {0};

    for (int f = 0; f < FORMS; f++)
        RITZ_CHECK(ritz_dense_new(A->nrow, A->nrow, &Q[f]));
    for (int64_t j = 0; j < n; j++)
        for (int64_t i = 0; i < n; i++)
            ritz_dense_col(&Q[0], n + j)[n + i] =
                0.5 *
                (ritz_dense_col(&m->D, j)[i] + ritz_dense_col(&m->D, i)[j]);
    RITZ_CHECK(ritz_dense_new(A->nrow, A->nrow, &own));
    ritz_dense_put(&plant->A, 0, 0, &own);
    RITZ_CHECK(ritz_dense_new(A->nrow, A->nrow, &inputs));
    ritz_dense_put(&plant->B, 0, first, &inputs);
    for (int f = 1; f < FORMS; f++) {
        add_power(1.0, n, A, &Q[f]);
        add_power(-1.0, n, &own, &Q[f]);
    }
    add_power(-1.0 / scale, n, &inputs, &Q[2]);
    return RITZ_OK;
}

static ritz_status fill_exact(const ritz_motion *motion,
                              const ritz_state_space *plant,
                              const ritz_state_space *closed, double step,
                              exact *s)
{
    const int count = motion->energies ? FORMS : 0;
    const bool modal = motion->form == RITZ_FORM_MODAL;
    RITZ_OWN(ritz_dense) A = {0};
    RITZ_OWN(ritz_dense_array) Q = {.count = FORMS};
    const ritz_step_matrix_modes modes = {modal ? motion->n : 0, motion->lambda,
                                          &motion->D, s->n};

    RITZ_CHECK_NEW(Q.at, FORMS);
    RITZ_CHECK(exact_matrix(closed, step, s, &A));
    if (count > 0)
        RITZ_CHECK(exact_forms(motion, plant, &A, s->scale, Q.at));
    RITZ_CHECK(ritz_step_matrices(&modes, &A, step, count, Q.at, &s->E, s->W));
    RITZ_CHECK(ritz_dense_copy(&closed->C, &s->C));
    RITZ_CHECK(ritz_dense_copy(&closed->D, &s->D));
    RITZ_CHECK_NEW(s->memory, s->states + 1);
    RITZ_CHECK_NEW(s->z, A.nrow);
    RITZ_CHECK_NEW(s->z1, A.nrow);
    return RITZ_OK;
}

/* Close the loop, and refuse one that is too large. */
static ritz_status close_plant(const ritz_state_space *plant,
                               const ritz_controlled *controlled,
                               ritz_state_space *out)
{
    const int64_t order = plant->A.nrow + controlled->controller->A.nrow;

    RITZ_REFUSE_IF(order > RITZ_LOOP_EXACT, RITZ_ERR_ARGUMENT,
                   "a closed loop of %" PRId64
                   " states is too large for one exponential, which takes %d: "
                   "use split",
                   order, RITZ_LOOP_EXACT);
    RITZ_CHECK(
        ritz_closed_loop(plant, controlled->controller, controlled->loop, out));
    if (!out->E.val)
        return RITZ_OK;
    RITZ_CHECK_IN("E", ritz_general_solve(&out->E, false, &out->A));
    return ritz_context(ritz_general_solve(&out->E, false, &out->B), "E");
}

ritz_status ritz_exact_start(const ritz_motion *motion,
                             const ritz_state_space *plant,
                             const ritz_controlled *controlled, double step,
                             ritz_march *out)
{
    RITZ_OWN(ritz_march) march = {.motion = motion, .step = step};
    RITZ_OWN(ritz_state_space) closed = {0};
    exact *s = NULL;

    RITZ_CHECK(close_plant(plant, controlled, &closed));
    RITZ_CHECK_NEW(s, 1);
    march.own = s;
    march.free = release_exact;
    RITZ_CHECK_NEW(march.x, motion->n);
    if (motion->form != RITZ_FORM_STATES)
        RITZ_CHECK_NEW(march.v, motion->n);
    s->states = controlled->controller->A.nrow;
    s->n = closed.A.nrow;
    RITZ_CHECK(fill_exact(motion, plant, &closed, step, s));
    RITZ_CHECK(ritz_loop_output(&plant->C, &plant->D, controlled->controller,
                                controlled->loop, &s->v));
    RITZ_CHECK(ritz_loop_notes_new(controlled->controller, motion->energies,
                                   &s->notes));
    s->notes.states = s->memory;
    s->notes.work = motion->energies ? s->memory + s->states : NULL;
    march.memory = s->memory;
    march.num_memory = s->states + 1;
    march.advance = advance_exact;
    march.outputs = output_exact;
    march.diagnose = diagnose_exact;
    march.num_diagnostics = s->notes.count;
    march.diagnostic = s->notes.list;
    RITZ_MOVE(*out, march);
    return RITZ_OK;
}
