/*
 * A basis as a function of the setting of a joint. At equally spaced x_i, V_i =
 * P Phi are the lowest r modes of the system, in the coordinates of all bodies
 * along their own axes. Each V_i is aligned with the basis at the knot before,
 *
 *     T_i+1 = V_i+1 O,   O = U W' of V_i+1'M T_i = U s W'
 *
 * which is Procrustes' rotation [Schoenemann1966]: it chooses signs, turns
 * modes within clusters and exchanges modes that cross. T_i+1'M T_i is then
 * symmetric. If the smallest s is small, the space of r modes is not
 * continuous, because mode r changes places with mode r + 1. A hinge that turns
 * by more than 360 degrees has the knots of one turn.
 */
#include "assembly/swept.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Number of intervals from which on a basis that changes too much between knots
   is refused. */
enum { ENOUGH = 128 };

static ritz_status choose_order(const ritz_sweeper *w,
                                const ritz_sweep_grid *grid, int64_t *out)
{
    const ritz_sweep_request *asked = w->asked;
    const ritz_sweep_knot *first = &grid->knot[0];

    *out = first->V.ncol;
    if (asked->modes > 0)
        *out = asked->modes;
    else if (asked->up_to_hz > 0.0)
        *out = ritz_sweep_count_modes(first, asked->up_to_hz);
    RITZ_REFUSE_IF(*out > first->V.ncol, RITZ_ERR_ARGUMENT,
                   "%" PRId64
                   " modes are asked for, and the system has %" PRId64,
                   *out, first->V.ncol);
    RITZ_REFUSE_IF(*out < first->rigid || *out < 1, RITZ_ERR_ARGUMENT,
                   "%" PRId64 " modes are fewer than the %" PRId64
                   " rigid motions",
                   *out, first->rigid);
    return RITZ_OK;
}

/* O = U W' of A = U s W', and the smallest s. */
static ritz_status find_rotation(const ritz_dense *A, double *least,
                                 ritz_dense *O)
{
    RITZ_OWN(ritz_dense) U = {0}, W = {0};
    RITZ_OWN_ARRAY double *s = NULL;

    RITZ_CHECK(ritz_general_svd(A, &U, &s, &W));
    *least = s[A->ncol - 1];
    return ritz_dense_mul_nt(&U, &W, O);
}

/* O'diag(d) O, d the damping that ratios give to each mode of a knot. */
static ritz_status turn_ratios(const ritz_sweeper *w, const ritz_sweep_knot *k,
                               const ritz_dense *O, ritz_dense *out)
{
    const ritz_damping *damping = w->asked->damping;
    RITZ_OWN(ritz_dense) scaled = {0};
    RITZ_OWN_ARRAY double *d = NULL;

    RITZ_CHECK_NEW(d, O->nrow);
    for (int64_t j = 0; j < O->nrow; j++) {
        const double lambda = j < k->rigid ? 0.0 : k->lambda[j];
        const double omega = sqrt(lambda);

        if (ritz_damping_is_rayleigh(damping))
            d[j] = damping->a + damping->b * lambda;
        else if (j >= k->rigid)
            d[j] = 2.0 * omega *
                   ritz_damping_of_mode(damping, j - k->rigid, omega);
    }
    RITZ_CHECK(ritz_dense_copy(O, &scaled));
    ritz_dense_scale_rows(d, &scaled);
    return ritz_dense_mul_tn(O, &scaled, out);
}

/* [V O; SV O; O'dO] of r modes of a knot. */
static ritz_status turn_knot(const ritz_sweeper *w, const ritz_swept_model *m,
                             const ritz_sweep_knot *k, const ritz_dense *O,
                             ritz_dense *out)
{
    const ritz_dense V = ritz_dense_part(&k->V, 0, m->order);
    const ritz_dense SV = ritz_dense_part(&k->SV, 0, m->order);
    RITZ_OWN(ritz_dense) T = {0}, ST = {0}, ratios = {0};

    RITZ_CHECK(ritz_dense_mul(&V, O, &T));
    RITZ_CHECK(ritz_dense_mul(&SV, O, &ST));
    RITZ_CHECK(ritz_dense_new(m->F.nrow, m->order, out));
    ritz_dense_put(&T, 0, 0, out);
    ritz_dense_put(&ST, T.nrow, 0, out);
    if (!m->has_ratios)
        return RITZ_OK;
    RITZ_CHECK(turn_ratios(w, k, O, &ratios));
    ritz_dense_put(&ratios, T.nrow + ST.nrow, 0, out);
    return RITZ_OK;
}

/* Smallest overlap of the bases of two neighbouring knots, and which they
   are. */
typedef struct sweep_gap {
    double overlap;
    int64_t at;
} sweep_gap;

/* Find the rotation of T in a whole turn, T_last = T_first O. */
static ritz_status close_turn(const ritz_sweeper *w, ritz_swept_model *m)
{
    const int64_t r = m->order, Q = m->M.nrow;
    RITZ_OWN(ritz_dense) first = {0}, last = {0}, A = {0};
    double least = 1.0;

    RITZ_CHECK(ritz_dense_block(&m->F, 0, Q, 0, r, &first));
    RITZ_CHECK(ritz_dense_block(&m->F, 0, Q, (m->count - 1) * r, r, &last));
    RITZ_CHECK(ritz_sweep_correlate(&first, &m->M, &last, &A));
    ritz_dense_free(&m->turn);
    RITZ_CHECK(find_rotation(&A, &least, &m->turn));
    RITZ_REFUSE_IF(least < 1.0 - RITZ_SWEPT_AXIS, RITZ_ERR_ARGUMENT,
                   "after a whole turn of '%s' the space of %" PRId64
                   " modes is another one: turn it by 360 degrees at most, or "
                   "keep more modes",
                   ritz_sweep_name(w), r);
    return ritz_swept_bend_around(m);
}

/* F of all knots, each aligned with the knot before. */
static ritz_status align_knots(const ritz_sweeper *w,
                               const ritz_sweep_grid *grid, ritz_swept_model *m,
                               sweep_gap *gap)
{
    const int64_t r = m->order, Q = m->M.nrow;
    const int64_t rows = Q + m->num_springs + (m->has_ratios ? r : 0);
    RITZ_OWN(ritz_dense) T = {0};

    m->count = grid->count;
    m->first = w->first;
    m->spacing = (w->last - w->first) / (double)(grid->count - 1);
    ritz_dense_free(&m->F);
    RITZ_CHECK(ritz_dense_new(rows, r * grid->count, &m->F));
    *gap = (sweep_gap){1.0, 0};
    for (int64_t k = 0; k < grid->count; k++) {
        const ritz_dense V = ritz_dense_part(&grid->knot[k].V, 0, r);
        RITZ_OWN(ritz_dense) A = {0}, O = {0}, made = {0};
        double least = 1.0;

        if (k == 0) {
            RITZ_CHECK(ritz_dense_identity(r, &O));
        } else {
            RITZ_CHECK(ritz_sweep_correlate(&V, &m->M, &T, &A));
            RITZ_CHECK(find_rotation(&A, &least, &O));
        }
        if (least < gap->overlap)
            *gap = (sweep_gap){least, k};
        RITZ_CHECK(turn_knot(w, m, &grid->knot[k], &O, &made));
        ritz_dense_put(&made, 0, k * r, &m->F);
        ritz_dense_free(&T);
        RITZ_CHECK(ritz_dense_block(&made, 0, Q, 0, r, &T));
    }
    return w->whole ? close_turn(w, m) : ritz_swept_bend(m);
}

/* Largest sqrt(x'A x) of the columns of X. */
static double longest_column(const ritz_dense *X, const ritz_dense *AX)
{
    double most = 0.0;

    for (int64_t j = 0; j < X->ncol; j++)
        most = fmax(most, ritz_dense_dot(X, j, AX, j));
    return sqrt(fmax(most, 0.0));
}

/* Error of the spline at a knot that it does not interpolate; @p out becomes
   the larger of both. */
static ritz_status measure_middle(const ritz_sweeper *w,
                                  const ritz_swept_model *m,
                                  const ritz_sweep_knot *k, double *out)
{
    const int64_t r = m->order, Q = m->M.nrow;
    const ritz_dense V = ritz_dense_part(&k->V, 0, r);
    RITZ_OWN(ritz_dense) F = {0}, T = {0}, A = {0}, O = {0}, off = {0};
    RITZ_OWN(ritz_dense) D = {0}, MD = {0}, KD = {0}, rest = {0}, size = {0};
    const double last = k->lambda[r - 1] > 0.0 ? k->lambda[r - 1] : 1.0;
    double least = 1.0;

    RITZ_CHECK(ritz_swept_values(m, k->x, &F));
    RITZ_CHECK(ritz_dense_block(&F, 0, Q, 0, r, &T));
    RITZ_CHECK(ritz_sweep_correlate(&V, &m->M, &T, &A));
    RITZ_CHECK(find_rotation(&A, &least, &O));
    RITZ_CHECK(turn_knot(w, m, k, &O, &off));
    RITZ_CHECK(ritz_dense_block(&off, Q, off.nrow - Q, 0, r, &size));
    ritz_dense_add(-1.0, &F, &off);
    RITZ_CHECK(ritz_dense_block(&off, 0, Q, 0, r, &D));
    RITZ_CHECK(ritz_dense_block(&off, Q, off.nrow - Q, 0, r, &rest));
    RITZ_CHECK(ritz_dense_mul(&m->M, &D, &MD));
    RITZ_CHECK(ritz_dense_mul(&m->K, &D, &KD));
    *out = fmax(*out, longest_column(&D, &MD));
    *out = fmax(*out, longest_column(&D, &KD) / sqrt(last));
    if (ritz_dense_max(&size) > 0.0)
        *out = fmax(*out, ritz_dense_max(&rest) / ritz_dense_max(&size));
    return RITZ_OK;
}

/* Refuse a basis whose mode r changes places with mode r + 1: this happens
   where two neighbouring bases overlap least. */
static ritz_status refuse_gap(const ritz_sweeper *w,
                              const ritz_sweep_grid *grid, int64_t r,
                              const sweep_gap *gap)
{
    const ritz_sweep_knot *k = &grid->knot[gap->at];

    return ritz_fail(
        RITZ_ERR_ARGUMENT,
        "the basis of %" PRId64 " modes is not continuous: near %s=%.4g mode "
        "%" PRId64 ", %.4g Hz, changes places with the next one. Keep more "
        "modes, or fewer",
        r, ritz_sweep_name(w), k->x / w->unit, r,
        sqrt(fmax(k->lambda[r - 1], 0.0)) / (2.0 * RITZ_PI));
}

/* Add knots until the spline between them is accurate. */
static ritz_status refine(const ritz_sweeper *w, ritz_sweep_grid *grid,
                          ritz_swept_model *m)
{
    while (true) {
        RITZ_OWN(ritz_sweep_grid) middles = {0};
        sweep_gap gap;

        RITZ_CHECK(align_knots(w, grid, m, &gap));
        if (grid->count > ENOUGH && gap.overlap < RITZ_SWEPT_OVERLAP)
            return refuse_gap(w, grid, m->order, &gap);
        RITZ_CHECK(ritz_sweep_middles(w, grid, &middles));
        RITZ_CHECK(ritz_sweep_check(w, &middles));
        m->error = 0.0;
        for (int64_t k = 0; k < middles.count; k++)
            RITZ_CHECK(measure_middle(w, m, &middles.knot[k], &m->error));
        if (m->error <= RITZ_SWEPT_ERROR)
            return RITZ_OK;
        RITZ_REFUSE_IF(grid->count > RITZ_SWEEP_MOST, RITZ_ERR_CONVERGENCE,
                       "the basis of %" PRId64 " modes changes so fast with %s "
                       "that %" PRId64 " settings interpolate it to %.1e only",
                       m->order, ritz_sweep_name(w), grid->count, m->error);
        RITZ_CHECK(ritz_sweep_merge(grid, &middles));
    }
}

/* Matrices of all bodies, and the joints' springs. */
static ritz_status stack_bodies(const ritz_sweeper *w, ritz_swept_model *m)
{
    const ritz_stage *stage = w->stage;
    const int64_t Q = stage->num_coordinates;

    RITZ_CHECK(ritz_dense_new(Q, Q, &m->M));
    RITZ_CHECK(ritz_dense_new(Q, Q, &m->K));
    for (int64_t k = 0; k < stage->count; k++) {
        const ritz_reduced *body = &stage->body[k];
        const int64_t first = stage->first[k];

        RITZ_REFUSE_IF(body->K4.val, RITZ_ERR_ARGUMENT,
                       "structural damping of '%s' is of harmonic motion alone",
                       stage->scene->component[k].name);
        ritz_dense_put(&body->M, first, first, &m->M);
        ritz_dense_put(&body->K, first, first, &m->K);
        if (body->D.val && !m->D.val)
            RITZ_CHECK(ritz_dense_new(Q, Q, &m->D));
        if (body->D.val)
            ritz_dense_put(&body->D, first, first, &m->D);
    }
    return ritz_io_copy(&stage->io, &m->io);
}

static ritz_status list_springs(const ritz_sweeper *w, ritz_swept_model *m)
{
    RITZ_OWN(ritz_springs) springs = {0};

    RITZ_CHECK(ritz_stage_springs(w->stage, w->asked->setting, &springs));
    m->num_springs = springs.S.nrow;
    RITZ_CHECK_NEW(m->stiffness, m->num_springs);
    RITZ_CHECK_NEW(m->damping, m->num_springs);
    for (int64_t k = 0; k < m->num_springs; k++) {
        m->stiffness[k] = springs.of.item[k].freedom->stiffness;
        m->damping[k] = springs.of.item[k].freedom->damping;
    }
    return RITZ_OK;
}

static ritz_status check_sweep(const ritz_stage *stage,
                               const ritz_sweep_request *asked)
{
    RITZ_REFUSE_IF(stage->scene->spin.given, RITZ_ERR_ARGUMENT,
                   "no joint is turned in a scene that spins");
    RITZ_REFUSE_IF(asked->sweep < 0 || asked->sweep >= stage->scene->num_sweeps,
                   RITZ_ERR_ARGUMENT, "the scene has no such joint");
    RITZ_REFUSE_IF(!(asked->range[1] > asked->range[0]), RITZ_ERR_ARGUMENT,
                   "'%s' does not move from %g to %g: the range is empty",
                   stage->scene->sweep[asked->sweep].name, asked->range[0],
                   asked->range[1]);
    RITZ_REFUSE_IF(asked->modes > 0 && asked->up_to_hz > 0.0, RITZ_ERR_ARGUMENT,
                   "a number of modes or a band, one of them");
    return ritz_dual_refuse(stage);
}

ritz_status ritz_stage_sweep(const ritz_stage *stage,
                             const ritz_sweep_request *asked,
                             ritz_swept_model *out)
{
    RITZ_OWN(ritz_swept_model) m = {0};
    RITZ_OWN(ritz_sweep_grid) grid = {0};
    ritz_sweeper w = {.stage = stage, .asked = asked, .unit = 1.0};

    RITZ_CHECK(check_sweep(stage, asked));
    if (stage->scene->sweep[asked->sweep].turns)
        w.unit = RITZ_PI / 180.0;
    w.first = w.unit * asked->range[0];
    w.last = w.unit * asked->range[1];
    if (w.unit != 1.0 && asked->range[1] - asked->range[0] > 360.0) {
        w.whole = true;
        w.last = w.first + 2.0 * RITZ_PI;
    }
    m.unit = w.unit;
    memcpy(m.sweep, ritz_sweep_name(&w), sizeof m.sweep);
    m.has_ratios = asked->damping && asked->damping->kind != RITZ_DAMPING_NONE;
    RITZ_CHECK(stack_bodies(&w, &m));
    RITZ_CHECK(list_springs(&w, &m));
    RITZ_CHECK(ritz_sweep_begin(&w, &grid));
    RITZ_CHECK(ritz_sweep_check(&w, &grid));
    RITZ_CHECK(choose_order(&w, &grid, &m.order));
    RITZ_CHECK(ritz_sweep_turning(&w, &grid, &m));
    RITZ_CHECK(refine(&w, &grid, &m));
    RITZ_CHECK(ritz_sweep_start(&w, &m));
    RITZ_MOVE(*out, m);
    return RITZ_OK;
}
