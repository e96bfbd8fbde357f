/*
 * The motion of a system while a joint is turned or slid: with the setting x(t)
 * of the joint, the coordinates u of all bodies along their own axes and a
 * basis u = T(x) q of the motions that the joints allow at x,
 *
 *     u' = T q' + x' T_x q
 *     u'' = T q'' + 2 x' T_x q' + (x'^2 T_xx + x'' T_x) q
 *
 * Bodies that turn with x have the acceleration u'' + 2 x' N u' + x'' N u +
 * x'^2 N^2 u in space, N u = n x u. Let G = <phi, N phi> and H = <N phi, N phi>
 * in the inner product of the mass of the bodies, S = T'M T_x + T'G T, and R q
 * = S_k T q the elongations of the springs of joints. Virtual work on T dq
 * gives
 *
 *     M_r q'' + C q' + K q = T'B f
 *     M_r = T'M T
 *     C = 2 x' S + T'D T + R'c R
 *     K = T'K T + R'k R + x'^2 (T'M T_xx + 2 T'G T_x - T'H T) + x'' S
 *         + x' (T'D T_x + R'c R_x)
 *
 * Damping ratios add D_r to C and x' D_r S to K, as D = M Phi Delta Phi'M does.
 * In a run without the rates of T, x' and x'' are 0 in these matrices, while T
 * still changes.
 *
 * Forces that the commanded motion itself causes do not depend on q and are
 * left out: q is the motion relative to it.
 *
 * By the trapezoidal rule the end of each step is in equilibrium,
 *
 *     (M_1 + h/2 C_1 + h^2/4 K_1) a_1 = B_1 f_1 - C_1 v* - K_1 q*
 *     q* = q_0 + h v_0 + h^2/4 a_0,   v* = v_0 + h/2 a_0
 *
 * Energies are those of u. With E = (|u' + x' N u|^2_M + u'K u + k (R q)^2) / 2
 *
 *     E' = f'B'u' - u'D u' - c (R q)'^2 + x' P
 *     P = (T_x q + N T q)'M (acceleration) + (T_x q)'(D u' + K u - B f)
 *         + (R_x q)'(k R q + c (R q)')
 *
 * x' P is the power of the actuator, which is integrated by the trapezoidal
 * rule too. In a run without the rates of T, P is q'K_x q / 2 + q''M_x q' / 2,
 * which is what a program would compute that only exchanges matrices.
 */
#include "simulate/swept.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "simulate/motion.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct swept {
    const ritz_swept_model *model;
    const ritz_path *path;
    bool terms, settled;
    bool accelerations; /* there are outputs of acceleration */
    ritz_swept_piece piece;
    double w[3][4];
    double rate[2]; /* x' and x'' */
    double used[2]; /* x' and x'' in the equations; 0 without rates of T */
    ritz_dense M, C, K, S, B;
    ritz_dense R, Rx, Dr;
    ritz_dense push;       /* M_r^-1 B, if `accelerations` */
    double *memory;        /* holds a, last, along, power and actuator */
    double *a;             /* r */
    double *last;          /* inputs at the end of the last step */
    double *along;         /* B'T q, of each input */
    double *power;         /* of the actuator, and of damping */
    double *actuator;      /* its work */
    double *o, *p, *z, *y; /* 4r: u, T_x q, u' and u'' as X o, X p, ... */
    double *v;             /* r */
} swept;

static void release_swept(void *own)
{
    swept *s = own;
    enum { OWNED = 9 };
    ritz_dense *const all[OWNED] = {&s->M, &s->C,  &s->K,  &s->S,   &s->B,
                                    &s->R, &s->Rx, &s->Dr, &s->push};

    for (int k = 0; k < OWNED; k++)
        ritz_dense_free(all[k]);
    ritz_swept_piece_free(&s->piece);
    RITZ_FREE(s->memory, s->o, s->v, s);
}

static void clear(ritz_dense *A)
{
    memset(A->val, 0, (size_t)(A->nrow * A->ncol) * sizeof *A->val);
}

/* a'A b; 0 of {0}. */
static double bilinear(const ritz_dense *A, const double *a, const double *b)
{
    double sum = 0.0;

    for (int64_t j = 0; A->val && j < A->ncol; j++)
        sum += b[j] * ritz_motion_dot(A->nrow, ritz_dense_col(A, j), a);
    return sum;
}

/* out += factor sum_k d_k L(k,:)'R(k,:) */
static void add_springs(const ritz_dense *L, const double *d,
                        const ritz_dense *R, double factor, ritz_dense *out)
{
    for (int64_t j = 0; j < R->ncol; j++)
        for (int64_t i = 0; i < L->ncol; i++)
            for (int64_t k = 0; k < R->nrow; k++)
                ritz_dense_col(out, j)[i] += factor * d[k] *
                                             ritz_dense_col(L, i)[k] *
                                             ritz_dense_col(R, j)[k];
}

/* M_r, S, C and K, without the damping of ratios. */
static void fill_matrices(swept *s)
{
    const ritz_swept_model *m = s->model;
    const ritz_swept_piece *p = &s->piece;
    const double *w0 = s->w[0], *w1 = s->w[1], *w2 = s->w[2];
    const double x1 = s->used[0], x2 = s->used[1];

    clear(&s->M);
    clear(&s->C);
    clear(&s->K);
    clear(&s->S);
    ritz_swept_contract(&p->M, w0, w0, 1.0, &s->M);
    ritz_swept_contract(&p->M, w0, w1, 1.0, &s->S);
    ritz_swept_contract(&p->G, w0, w0, 1.0, &s->S);
    ritz_swept_contract(&p->D, w0, w0, 1.0, &s->C);
    add_springs(&s->R, m->damping, &s->R, 1.0, &s->C);
    ritz_dense_add(2.0 * x1, &s->S, &s->C);
    ritz_swept_contract(&p->K, w0, w0, 1.0, &s->K);
    add_springs(&s->R, m->stiffness, &s->R, 1.0, &s->K);
    ritz_swept_contract(&p->M, w0, w2, x1 * x1, &s->K);
    ritz_swept_contract(&p->G, w0, w1, 2.0 * x1 * x1, &s->K);
    ritz_swept_contract(&p->H, w0, w0, -x1 * x1, &s->K);
    ritz_swept_contract(&p->D, w0, w1, x1, &s->K);
    add_springs(&s->R, m->damping, &s->Rx, x1, &s->K);
    ritz_dense_add(x2, &s->S, &s->K);
}

/* Add the damping of ratios: D_r to C, and x' D_r S to K. */
static ritz_status add_ratios(swept *s)
{
    RITZ_OWN(ritz_dense) more = {0};

    if (!s->model->has_ratios)
        return RITZ_OK;
    ritz_swept_combine(&s->piece.ratios, s->w[0], &s->Dr);
    ritz_dense_add(1.0, &s->Dr, &s->C);
    RITZ_CHECK(ritz_dense_mul(&s->Dr, &s->S, &more));
    ritz_dense_add(s->used[0], &more, &s->K);
    return RITZ_OK;
}

/* Compute all matrices at time t. */
static ritz_status refresh(double t, swept *s)
{
    const ritz_swept_model *m = s->model;
    double at[3], turns = 0.0, x = 0.0;

    ritz_path_at(s->path, t, at);
    x = ritz_swept_within(m, m->unit * at[0], &turns);
    for (int k = 0; k < 2; k++) {
        s->rate[k] = m->unit * at[k + 1];
        s->used[k] = s->terms ? s->rate[k] : 0.0;
    }
    RITZ_CHECK(ritz_swept_piece_move(m, x, &s->piece));
    ritz_swept_weights(m, s->piece.at, x, s->w);
    ritz_swept_combine(&s->piece.ST, s->w[0], &s->R);
    ritz_swept_combine(&s->piece.ST, s->w[1], &s->Rx);
    fill_matrices(s);
    RITZ_CHECK(add_ratios(s));
    for (int64_t j = 0; j < s->B.ncol; j++)
        for (int64_t i = 0; i < m->order; i++) {
            const double *from = ritz_dense_col(&s->piece.B, j) + i;
            double sum = 0.0;

            for (int64_t k = 0; k < 4; k++)
                sum += s->w[0][k] * from[k * m->order];
            ritz_dense_col(&s->B, j)[i] = sum;
        }
    if (!s->accelerations)
        return RITZ_OK;
    ritz_dense_cut(&s->B, 0, 0, &s->push);
    return ritz_general_solve(&s->M, false, &s->push);
}

/* The coefficients of u, T_x q, u' and u'' over the columns of X, with rates of
   x in @p rate. */
static void spread_state(const ritz_march *march, const double *rate, swept *s)
{
    const int64_t r = s->model->order;
    const double x1 = rate[0], x2 = rate[1];
    const double *q = march->x, *v = s->v;

    memset(s->o, 0, (size_t)(16 * r) * sizeof *s->o);
    memcpy(s->v, march->v, (size_t)r * sizeof *s->v);
    if (!s->settled)
        ritz_motion_gemv(&s->S, -s->used[0], q, s->v);
    ritz_swept_spread(s->w[0], 1.0, r, q, s->o);
    ritz_swept_spread(s->w[1], 1.0, r, q, s->p);
    ritz_swept_spread(s->w[0], 1.0, r, v, s->z);
    ritz_swept_spread(s->w[1], x1, r, q, s->z);
    ritz_swept_spread(s->w[0], 1.0, r, s->a, s->y);
    ritz_swept_spread(s->w[1], 2.0 * x1, r, v, s->y);
    ritz_swept_spread(s->w[2], x1 * x1, r, q, s->y);
    ritz_swept_spread(s->w[1], x2, r, q, s->y);
}

/* |u' + x' N u|^2_M / 2 for the state of the last spread_state. */
static double kinetic_energy(const swept *s, double x1)
{
    const ritz_swept_piece *p = &s->piece;

    return 0.5 * bilinear(&p->M, s->z, s->z) +
           x1 * bilinear(&p->G, s->z, s->o) +
           0.5 * x1 * x1 * bilinear(&p->H, s->o, s->o);
}

/* Row k of A times x. */
static double row_times(const ritz_dense *A, int64_t k, const double *x)
{
    double sum = 0.0;

    for (int64_t j = 0; j < A->ncol; j++)
        sum += ritz_dense_col(A, j)[k] * x[j];
    return sum;
}

static void find_energy(const ritz_march *march, double *kinetic,
                        double *potential)
{
    swept *s = march->own;
    double springs = 0.0;

    spread_state(march, s->used, s);
    *kinetic = kinetic_energy(s, s->used[0]);
    for (int64_t k = 0; k < s->R.nrow; k++) {
        double e = row_times(&s->R, k, march->x);

        springs += s->model->stiffness[k] * e * e;
    }
    *potential = 0.5 * (bilinear(&s->piece.K, s->o, s->o) + springs);
}

/* (T_x q + N T q)'M (acceleration) */
static double inertia_power(const swept *s)
{
    const ritz_swept_piece *p = &s->piece;
    const double x1 = s->used[0], x2 = s->used[1];

    return bilinear(&p->M, s->p, s->y) +
           2.0 * x1 * bilinear(&p->G, s->p, s->z) +
           x2 * bilinear(&p->G, s->p, s->o) -
           x1 * x1 * bilinear(&p->H, s->p, s->o) - bilinear(&p->G, s->o, s->y) +
           2.0 * x1 * bilinear(&p->H, s->o, s->z) +
           x2 * bilinear(&p->H, s->o, s->o);
}

/* q''M_x q' / 2, in a run without rates of T. */
static double naive_power(const ritz_march *march, swept *s)
{
    const int64_t r = s->model->order;

    memset(s->y, 0, (size_t)(4 * r) * sizeof *s->y);
    ritz_swept_spread(s->w[1], 1.0, r, march->v, s->y);
    return bilinear(&s->piece.M, s->z, s->y);
}

/* Power of springs and dampers of joints; their losses are added to @p lost. */
static double spring_power(const ritz_march *march, const swept *s,
                           double *lost)
{
    const ritz_swept_model *m = s->model;
    double power = 0.0;

    for (int64_t k = 0; k < s->R.nrow; k++) {
        double moved = row_times(&s->Rx, k, march->x);
        double rate = row_times(&s->R, k, march->v) + s->used[0] * moved;

        *lost += m->damping[k] * rate * rate;
        power += moved * (m->stiffness[k] * row_times(&s->R, k, march->x) +
                          (s->terms ? m->damping[k] * rate : 0.0));
    }
    return power;
}

/* Power of the damping of ratios: D_r damps q' + x' S q. */
static double ratio_power(const ritz_march *march, swept *s, double *lost)
{
    const int64_t r = s->model->order;
    double *turned = s->y, *rate = s->y + r, *force = s->y + 2 * r;

    if (!s->model->has_ratios)
        return 0.0;
    memset(s->y, 0, (size_t)(4 * r) * sizeof *s->y);
    ritz_motion_gemv(&s->S, 1.0, march->x, turned);
    for (int64_t k = 0; k < r; k++)
        rate[k] = march->v[k] + s->used[0] * turned[k];
    ritz_motion_gemv(&s->Dr, 1.0, rate, force);
    *lost += ritz_motion_dot(r, rate, force);
    return s->terms ? ritz_motion_dot(r, turned, force) : 0.0;
}

/* Power of the actuator and of damping, with inputs u, once v is q'. */
static void find_powers(const ritz_march *march, const double *u, swept *s)
{
    const ritz_swept_piece *p = &s->piece;
    double power = 0.0, lost = 0.0;

    spread_state(march, s->used, s);
    lost = bilinear(&p->D, s->z, s->z);
    power = bilinear(&p->K, s->p, s->o);
    if (s->terms)
        power += inertia_power(s) + bilinear(&p->D, s->p, s->z);
    else
        power += naive_power(march, s);
    for (int64_t j = 0; j < p->B.ncol; j++)
        power -=
            u[j] * ritz_motion_dot(p->B.nrow, ritz_dense_col(&p->B, j), s->p);
    power += spring_power(march, s, &lost);
    power += ratio_power(march, s, &lost);
    s->power[0] = s->rate[0] * power;
    s->power[1] = lost;
}

/* The displacements B'T q along the inputs. */
static void find_along(const ritz_march *march, swept *s)
{
    for (int64_t j = 0; j < s->B.ncol; j++)
        s->along[j] =
            ritz_motion_dot(s->B.nrow, ritz_dense_col(&s->B, j), march->x);
}

/* a from equilibrium at the present x, with inputs u. */
static ritz_status find_acceleration(const ritz_march *march, const double *u,
                                     swept *s)
{
    const int64_t r = s->model->order;
    ritz_dense a = {r, 1, s->a};

    memset(s->a, 0, (size_t)r * sizeof *s->a);
    ritz_motion_gemv(&s->B, 1.0, u, s->a);
    ritz_motion_gemv(&s->C, -1.0, march->v, s->a);
    ritz_motion_gemv(&s->K, -1.0, march->x, s->a);
    return ritz_general_solve(&s->M, false, &a);
}

static ritz_status balance_start(ritz_march *march, const double *u, swept *s)
{
    RITZ_CHECK(find_acceleration(march, u, s));
    find_powers(march, u, s);
    find_along(march, s);
    memcpy(s->last, u, (size_t)s->B.ncol * sizeof *u);
    return RITZ_OK;
}

/* v was T'M u'; from here on it is q'. */
static ritz_status settle_swept(ritz_march *march, const double *u)
{
    swept *s = march->own;

    if (!s->settled)
        ritz_motion_gemv(&s->S, -s->used[0], march->x, march->v);
    s->settled = true;
    return balance_start(march, u, s);
}

/* Whether an input has changed since the end of the last step. */
static bool has_jumped(const swept *s, const double *u)
{
    for (int64_t j = 0; j < s->B.ncol; j++)
        if (u[j] != s->last[j])
            return true;
    return false;
}

/* a_1 by the matrices at the end, then q and v. */
static ritz_status move_step(ritz_march *march, const double *u1, swept *s)
{
    const int64_t r = s->model->order;
    const double h = march->step;
    RITZ_OWN(ritz_dense) F = {0};
    ritz_dense a = {r, 1, s->a};

    for (int64_t k = 0; k < r; k++) {
        march->x[k] += h * (march->v[k] + 0.25 * h * s->a[k]);
        march->v[k] += 0.5 * h * s->a[k];
    }
    RITZ_CHECK(ritz_dense_copy(&s->M, &F));
    ritz_dense_add(0.5 * h, &s->C, &F);
    ritz_dense_add(0.25 * h * h, &s->K, &F);
    memset(s->a, 0, (size_t)r * sizeof *s->a);
    ritz_motion_gemv(&s->B, 1.0, u1, s->a);
    ritz_motion_gemv(&s->C, -1.0, march->v, s->a);
    ritz_motion_gemv(&s->K, -1.0, march->x, s->a);
    RITZ_CHECK(ritz_general_solve(&F, false, &a));
    for (int64_t k = 0; k < r; k++) {
        march->x[k] += 0.25 * h * h * s->a[k];
        march->v[k] += 0.5 * h * s->a[k];
    }
    return RITZ_OK;
}

/* Express the state in the basis of the turn in which a step ends. */
static ritz_status turn_state(ritz_march *march, swept *s)
{
    const ritz_swept_model *m = s->model;
    const double h = march->step, t = (double)(march->steps + 1) * h;
    double *const state[] = {march->x, march->v, s->a};
    double before[3], after[3], turns[2];

    ritz_path_at(s->path, (double)march->steps * h, before);
    ritz_path_at(s->path, t, after);
    RITZ_REFUSE_IF(m->unit != 1.0 && fabs(after[0] - before[0]) > 90.0,
                   RITZ_ERR_ARGUMENT,
                   "'%s' turns by %.3g degrees in the step that ends at %g s: "
                   "take shorter steps",
                   m->sweep, fabs(after[0] - before[0]), t);
    (void)ritz_swept_within(m, m->unit * before[0], &turns[0]);
    (void)ritz_swept_within(m, m->unit * after[0], &turns[1]);
    for (int k = 0; k < 3 && turns[0] != turns[1]; k++)
        ritz_swept_turn(m, turns[1] < turns[0], state[k], s->o);
    return RITZ_OK;
}

static ritz_status advance_swept(ritz_march *march, const double *u0,
                                 const double *u1)
{
    swept *s = march->own;
    const double h = march->step;
    double before[2];

    s->settled = true;
    if (has_jumped(s, u0)) {
        RITZ_CHECK(refresh((double)march->steps * h, s));
        RITZ_CHECK(balance_start(march, u0, s));
    }
    memcpy(before, s->power, sizeof before);
    for (int64_t j = 0; j < s->B.ncol; j++)
        march->work -= 0.5 * (u0[j] + u1[j]) * s->along[j];
    RITZ_CHECK(turn_state(march, s));
    RITZ_CHECK(refresh((double)(march->steps + 1) * h, s));
    RITZ_CHECK(move_step(march, u1, s));
    find_powers(march, u1, s);
    find_along(march, s);
    for (int64_t j = 0; j < s->B.ncol; j++)
        march->work += 0.5 * (u0[j] + u1[j]) * s->along[j];
    *s->actuator += 0.5 * h * (before[0] + s->power[0]);
    march->work += 0.5 * h * (before[0] + s->power[0]);
    march->dissipated += 0.5 * h * (before[1] + s->power[1]);
    memcpy(s->last, u1, (size_t)s->B.ncol * sizeof *u1);
    return RITZ_OK;
}

/* y = C u + Cv u' + Ca u'' along the axes of the bodies. */
static void find_outputs(const ritz_march *march, const double *u, double *y)
{
    swept *s = march->own;
    const ritz_swept_piece *p = &s->piece;
    const int64_t r = s->model->order;

    spread_state(march, s->used, s);
    for (int64_t j = 0; s->accelerations && j < s->B.ncol; j++)
        ritz_swept_spread(s->w[0], u[j] - s->last[j], r,
                          ritz_dense_col(&s->push, j), s->y);
    memset(y, 0, (size_t)p->C.nrow * sizeof *y);
    ritz_motion_gemv(&p->C, 1.0, s->o, y);
    ritz_motion_gemv(&p->Cv, 1.0, s->z, y);
    ritz_motion_gemv(&p->Ca, 1.0, s->y, y);
}

static const char *const turning[] = {"angle_deg", "actuator_work",
                                      "terms_energy"};
static const char *const sliding[] = {"position", "actuator_work",
                                      "terms_energy"};

static void diagnose(const ritz_march *march, double *out)
{
    swept *s = march->own;
    const int64_t r = s->model->order;
    double at[3], whole = 0.0;

    ritz_path_at(s->path, (double)march->steps * march->step, at);
    out[0] = at[0];
    out[1] = *s->actuator;
    spread_state(march, s->rate, s);
    whole = kinetic_energy(s, s->rate[0]);
    memset(s->z, 0, (size_t)(4 * r) * sizeof *s->z);
    ritz_swept_spread(s->w[0], 1.0, r, s->v, s->z);
    out[2] = whole - 0.5 * bilinear(&s->piece.M, s->z, s->z);
}

static ritz_status make_room(swept *s, ritz_march *out)
{
    const ritz_swept_model *m = s->model;
    const int64_t r = m->order, inputs = m->io.num_inputs;
    enum { SQUARE = 5 };
    ritz_dense *const square[SQUARE] = {&s->M, &s->C, &s->K, &s->S, &s->Dr};

    for (int k = 0; k < SQUARE; k++)
        RITZ_CHECK(ritz_dense_new(r, r, square[k]));
    RITZ_CHECK(ritz_dense_new(r, inputs, &s->B));
    RITZ_CHECK(ritz_dense_new(r, inputs, &s->push));
    RITZ_CHECK(ritz_dense_new(m->num_springs, r, &s->R));
    RITZ_CHECK(ritz_dense_new(m->num_springs, r, &s->Rx));
    out->num_memory = r + 2 * inputs + 3;
    RITZ_CHECK_NEW(s->memory, out->num_memory);
    out->memory = s->memory;
    s->a = s->memory;
    s->last = s->a + r;
    s->along = s->last + inputs;
    s->power = s->along + inputs;
    s->actuator = s->power + 2;
    RITZ_CHECK_NEW(s->o, 16 * r);
    s->p = s->o + 4 * r;
    s->z = s->p + 4 * r;
    s->y = s->z + 4 * r;
    RITZ_CHECK_NEW(s->v, r);
    return RITZ_OK;
}

static ritz_status start_swept(const ritz_swept_model *model,
                               const ritz_path *path, bool terms,
                               ritz_march *out)
{
    swept *s = NULL;

    RITZ_CHECK_NEW(s, 1);
    out->own = s;
    out->free = release_swept;
    out->advance = advance_swept;
    out->settle = settle_swept;
    out->outputs = find_outputs;
    out->energy = find_energy;
    out->diagnose = diagnose;
    out->num_diagnostics = 3;
    out->diagnostic = model->unit == 1.0 ? sliding : turning;
    s->model = model;
    s->path = path;
    s->terms = terms;
    s->accelerations = ritz_dense_max(&model->io.Ca) > 0.0;
    s->piece.at = -1;
    RITZ_CHECK(make_room(s, out));
    return refresh(0.0, s);
}

/* The parts of a motion that ritz_march_run needs: its order, the map from x0
   to q, impulses, and numbers of inputs and outputs. */
static ritz_status fill_motion(const ritz_swept_model *model, ritz_motion *out)
{
    out->form = RITZ_FORM_DENSE;
    out->n = model->order;
    out->original = model->start.nrow;
    out->energies = true;
    RITZ_CHECK(ritz_dense_copy(&model->start, &out->to));
    return ritz_dense_new(model->io.num_outputs, model->io.num_inputs,
                          &out->feed);
}

static ritz_status check_request(const ritz_swept_model *model,
                                 const ritz_path *path,
                                 const ritz_simulation_request *request)
{
    const double ends[2] = {
        model->first / model->unit,
        (model->first + (double)(model->count - 1) * model->spacing) /
            model->unit};
    const double slack = RITZ_SAME * fmax(fabs(ends[0]), fabs(ends[1]));
    double range[2];

    ritz_path_range(path, range);
    RITZ_REFUSE_IF(!model->turn.val && (range[0] < ends[0] - slack ||
                                        range[1] > ends[1] + slack),
                   RITZ_ERR_ARGUMENT,
                   "'%s' goes from %g to %g, beyond the model's %g to %g",
                   model->sweep, range[0], range[1], ends[0], ends[1]);
    RITZ_REFUSE_IF(path->kind == RITZ_PATH_LINEAR &&
                       request->seconds > path->seconds * (1.0 + RITZ_SAME),
                   RITZ_ERR_ARGUMENT,
                   "'%s' moves for %g s and stops with a jump of its rate, and "
                   "the run takes %g s: end it there, or add ':smooth'",
                   model->sweep, path->seconds, request->seconds);
    RITZ_REFUSE_IF(request->integrator != &ritz_integrator_trapezoidal,
                   RITZ_ERR_ARGUMENT,
                   "a joint that moves is integrated by trapezoidal, not by %s",
                   request->integrator->name);
    return RITZ_OK;
}

/* Refuse an initial state that the basis does not span at all. */
static ritz_status check_start(const ritz_swept_model *model,
                               const ritz_simulation_request *request)
{
    ritz_swept_lost lost = {0};

    if (request->from)
        return RITZ_OK;
    RITZ_CHECK(ritz_swept_lost_state(model, request->x0, request->v0, &lost));
    RITZ_REFUSE_IF(lost.all, RITZ_ERR_ARGUMENT,
                   "nothing would move: the basis of %" PRId64 " modes has no "
                   "part of the initial state. Keep more modes",
                   model->order);
    return RITZ_OK;
}

/* Names of inputs and outputs. */
static ritz_status name_channels(const ritz_io *io, ritz_simulation *s)
{
    RITZ_CHECK_COPY(s->input, io->input, s->num_inputs);
    RITZ_CHECK_COPY(s->output, io->output, s->num_outputs);
    return RITZ_OK;
}

static ritz_status run_swept(const ritz_swept_model *model,
                             const ritz_path *path, bool terms,
                             const ritz_simulation_request *request,
                             ritz_simulation *out)
{
    RITZ_OWN(ritz_motion) motion = {0};
    RITZ_OWN(ritz_march) march = {0};
    RITZ_OWN(ritz_simulation) s = {0};

    RITZ_CHECK(check_request(model, path, request));
    RITZ_CHECK(check_start(model, request));
    RITZ_CHECK(fill_motion(model, &motion));
    march.motion = &motion;
    march.step = request->step;
    RITZ_CHECK_NEW(march.x, model->order);
    RITZ_CHECK_NEW(march.v, model->order);
    RITZ_CHECK(start_swept(model, path, terms, &march));
    RITZ_CHECK(ritz_dense_copy(&((swept *)march.own)->B, &motion.push));
    RITZ_CHECK(
        ritz_general_solve(&((swept *)march.own)->M, false, &motion.push));
    RITZ_CHECK(ritz_march_run(&march, request, NULL, &s));
    RITZ_CHECK(name_channels(&model->io, &s));
    RITZ_MOVE(*out, s);
    return RITZ_OK;
}

ritz_status ritz_simulate_swept(const ritz_swept_model *model,
                                const ritz_path *path, bool terms,
                                const ritz_simulation_request *request,
                                ritz_simulation *out)
{
    ritz_swept_model extended = *model; /* borrowed */
    RITZ_OWN(ritz_io) io = {0};
    RITZ_OWN(ritz_simulation) s = {0};

    if (!request->coordinates)
        return run_swept(model, path, terms, request, out);
    RITZ_CHECK(
        ritz_coordinates_add(&model->io, model->V.val ? &model->V : NULL, &io));
    extended.io = io;
    RITZ_CHECK(run_swept(&extended, path, terms, request, &s));
    RITZ_CHECK(ritz_coordinates_take(model->io.num_outputs, &s));
    RITZ_MOVE(*out, s);
    return RITZ_OK;
}
