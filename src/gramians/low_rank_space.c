/*
 * Low-rank ADI for the Gramians of a state space,
 *
 *     A W E' + E W A' + B B' = 0:   v_j = (A + p_j E)^-1 W_(j-1),
 *     W_j = W_(j-1) - 2 p_j E v_j,  Z = [sqrt(-2 p_1) v_1, ...]
 *
 * with W_0 = B and the residual W_j W_j'. The Gramian of (A', C') uses the same
 * factorisations. A pair of complex shifts adds real columns
 * [BennerKuerschnerSaak2013]:
 *
 *     g v_+,  g sqrt(d^2 + 1) Im v,   v_+ = Re v + d Im v,   W += g^2 E v_+,
 *     g^2 = -4 Re p,   d = Re p / Im p
 *
 * Shifts are poles of A projected on the latest columns of Z and on the
 * residual factor W; those with the largest participation in W come first
 * [BennerKuerschnerSaak2014]. Projected poles that are not left of the axis are
 * mirrored.
 *
 * Engine projection solves the equation in the span of Z, a rational Krylov
 * space, and measures the residual of that solution (galerkin.c). It requires
 * that E and -(A + A') are definite: the projected model is then stable. At
 * equal columns its residual is smaller than that of ADI. The loop ends when it
 * is below the tolerance.
 *
 * Poles at 0 are decoupled before the iteration. Their part in v, which is
 * rounding, is subtracted at each shift.
 */
#include "gramians/space.h"

#include "base/alloc.h"
#include "base/complex.h"
#include "base/tolerances.h"
#include "gramians/galerkin.h"
#include "gramians/modes.h"
#include "linear/general.h"
#include "linear/orthonormal.h"

#include <complex.h>
#include <float.h>
#include <inttypes.h>
#include <lapacke.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    MOST_SHIFTS = 300,
    WINDOW = 72,  /* number of latest columns that shifts are computed from */
    TOGETHER = 3, /* shifts taken from one projection */
    SIDES = 2,    /* controllability and observability */
    PATIENCE = 60 /* number of shifts after which slow convergence is refused */
};

/* One Gramian. */
typedef struct adi_side {
    ritz_dense W; /* residual factor, at first B or C' */
    ritz_dense Z; /* room for `room` columns, ncol in use */
    int64_t room;
    ritz_dense load; /* engine projection: W at the start */
    ritz_dense X;    /* its factor of the Gramian, once this has converged */
    int64_t next;    /* columns of Z at which it solves the equation next */
    double first;    /* |W'W| at the start */
    double residual; /* |W'W|, or |R| of X, relative to that */
    bool open;
} adi_side;

typedef struct adi {
    ritz_pencil pencil;
    ritz_zero_poles zero;
    adi_side side[SIDES];
    ritz_dense window; /* n x WINDOW, a ring buffer */
    int64_t entered;   /* number of columns entered so far */
    double tolerance;
    int64_t shifts;
    bool projects; /* engine projection */
} adi;

static void adi_free(adi *a)
{
    ritz_pencil_free(&a->pencil);
    ritz_zero_poles_free(&a->zero);
    for (int k = 0; k < SIDES; k++) {
        ritz_dense_free(&a->side[k].W);
        ritz_dense_free(&a->side[k].Z);
        ritz_dense_free(&a->side[k].load);
        ritz_dense_free(&a->side[k].X);
    }
    ritz_dense_free(&a->window);
}

static ritz_status measure_left(const ritz_dense *W, double *out)
{
    RITZ_OWN(ritz_dense) WW = {0};

    RITZ_CHECK(ritz_dense_mul_tn(W, W, &WW));
    return ritz_general_norm(&WW, out);
}

/* Decouple the poles at 0 from B or C'. A side of which only rounding is left
   is not iterated. */
static ritz_status start_side(adi *a, int k)
{
    adi_side *side = &a->side[k];
    double whole = 0.0;

    RITZ_CHECK(measure_left(&side->W, &whole));
    RITZ_CHECK(ritz_zero_poles_of_loads(&a->zero, k == 1, &side->W));
    RITZ_CHECK(measure_left(&side->W, &side->first));
    side->open = side->first > RITZ_ADI_NOTHING * whole;
    side->residual = side->open ? 1.0 : 0.0;
    return a->projects ? ritz_dense_copy(&side->W, &side->load) : RITZ_OK;
}

/* V'A V of a stable A is stable for every V only if the model is dissipative. */
static ritz_status refuse_unstable(const adi *a)
{
    bool dissipative = false;

    if (!a->projects)
        return RITZ_OK;
    RITZ_CHECK(ritz_pencil_is_dissipative(&a->pencil, &dissipative));
    RITZ_REFUSE_IF(!dissipative, RITZ_ERR_ARGUMENT,
                   "E and -(A + A') are not both definite, without which "
                   "engine 'projection' can make a stable model unstable: take "
                   "engine 'low-rank'");
    return RITZ_OK;
}

static ritz_status start_adi(const ritz_state_space *model, double tolerance,
                             adi *a)
{
    RITZ_CHECK(ritz_pencil_of_space(model, &a->pencil));
    RITZ_CHECK(refuse_unstable(a));
    RITZ_CHECK_IN("poles at 0", ritz_zero_poles_find(&a->pencil, &a->zero));
    RITZ_CHECK(ritz_dense_copy(&model->B, &a->side[0].W));
    RITZ_CHECK(ritz_outputs_scaled(&model->C, model->limit, &a->side[1].W));
    RITZ_CHECK(ritz_dense_new(a->pencil.n, WINDOW, &a->window));
    a->tolerance = tolerance > 0.0 ? tolerance : RITZ_ADI_TOLERANCE;
    for (int k = 0; k < SIDES; k++)
        RITZ_CHECK(start_side(a, k));
    return RITZ_OK;
}

static bool is_open(const adi *a)
{
    return a->side[0].open || a->side[1].open;
}

static double worst_residual(const adi *a)
{
    return fmax(a->side[0].residual, a->side[1].residual);
}

/* Append columns, scaled to unit length; @p X does not change. */
static ritz_status append_unit(const ritz_dense *X, ritz_orthonormal *set)
{
    RITZ_OWN(ritz_dense) unit = {0};

    RITZ_CHECK(ritz_dense_copy(X, &unit));
    for (int64_t j = 0; j < unit.ncol; j++) {
        double *x = ritz_dense_col(&unit, j);
        double size = 0.0;

        for (int64_t i = 0; i < unit.nrow; i++)
            size = hypot(size, x[i]);
        for (int64_t i = 0; i < unit.nrow && size > 0.0; i++)
            x[i] /= size;
    }
    return ritz_orthonormal_append(set, &unit, unit.ncol, NULL);
}

/* Orthonormal basis U of the latest columns and the residual factors of both
   sides. */
static ritz_status span_window(adi *a, ritz_orthonormal *set)
{
    int64_t used = a->entered < WINDOW ? a->entered : WINDOW;
    const ritz_dense latest = ritz_dense_part(&a->window, 0, used);

    RITZ_CHECK(ritz_orthonormal_new(a->pencil.n, NULL, RITZ_DEPENDENT, set));
    if (used > 0)
        RITZ_CHECK(append_unit(&latest, set));
    for (int k = 0; k < SIDES; k++)
        if (a->side[k].open)
            RITZ_CHECK(append_unit(&a->side[k].W, set));
    return RITZ_OK;
}

/* The projected pencil and the projected residual factors. */
typedef struct small_pencil {
    ritz_dense A, w[SIDES]; /* U'A U and U'W of side 0, both multiplied by (U'E
                               U)^-1; U'W of side 1 */
    double *re, *im, *part;
    ritz_dense left, right;
} small_pencil;

static void small_pencil_free(small_pencil *s)
{
    ritz_dense_free(&s->A);
    ritz_dense_free(&s->w[0]);
    ritz_dense_free(&s->w[1]);
    RITZ_FREE(s->re, s->im, s->part);
    ritz_dense_free(&s->left);
    ritz_dense_free(&s->right);
}

static ritz_status project_pencil(const adi *a, const ritz_dense *U,
                                  small_pencil *s)
{
    RITZ_OWN(ritz_dense) AU = {0}, EU = {0}, E = {0};

    RITZ_CHECK(ritz_sparse_mul(&a->pencil.A, U, &AU));
    RITZ_CHECK(ritz_sparse_mul(&a->pencil.E, U, &EU));
    RITZ_CHECK(ritz_dense_mul_tn(U, &AU, &s->A));
    RITZ_CHECK(ritz_dense_mul_tn(U, &EU, &E));
    for (int k = 0; k < SIDES; k++)
        RITZ_CHECK(ritz_dense_mul_tn(U, &a->side[k].W, &s->w[k]));
    RITZ_CHECK_IN("shifts", ritz_general_solve(&E, false, &s->A));
    return ritz_general_solve(&E, false, &s->w[0]);
}

static ritz_status find_vectors(small_pencil *s)
{
    int n = (int)s->A.nrow;
    RITZ_OWN(ritz_dense) A = {0};
    int info = 0;

    RITZ_CHECK(ritz_dense_copy(&s->A, &A));
    RITZ_CHECK(ritz_dense_new(n, n, &s->left));
    RITZ_CHECK(ritz_dense_new(n, n, &s->right));
    RITZ_CHECK_NEW(s->re, n);
    RITZ_CHECK_NEW(s->im, n);
    RITZ_CHECK_NEW(s->part, n);
    if (n > 0)
        info = LAPACKE_dgeev(LAPACK_COL_MAJOR, 'V', 'V', n, A.val, n, s->re,
                             s->im, s->left.val, n, s->right.val, n);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_CONVERGENCE,
                   "no poles were found for shifts");
    return RITZ_OK;
}

static double _Complex entry_of(const small_pencil *s, const ritz_dense *V,
                                int64_t i, int64_t j)
{
    return s->im[j] == 0.0 ? ritz_dense_col(V, j)[i]
                           : ritz_complex(ritz_dense_col(V, j)[i],
                                          ritz_dense_col(V, j + 1)[i]);
}

/* |V_j^H w|^2, summed over the columns of w. */
static double part_of(const small_pencil *s, const ritz_dense *V, int64_t j,
                      const ritz_dense *w)
{
    double sum = 0.0;

    for (int64_t c = 0; c < w->ncol; c++) {
        double _Complex product = 0.0;

        for (int64_t i = 0; i < w->nrow; i++)
            product += conj(entry_of(s, V, i, j)) * ritz_dense_col(w, c)[i];
        sum += pow(cabs(product), 2.0);
    }
    return sum;
}

/* Participation of each pole: the sum over both sides of the square, relative
   to the largest square of the side. */
static ritz_status weigh_poles(const adi *a, small_pencil *s)
{
    const int64_t n = s->A.nrow;
    RITZ_OWN(ritz_dense) part = {0};

    RITZ_CHECK(ritz_dense_new(n, SIDES, &part));
    for (int64_t j = 0; j < n; j++) {
        double _Complex yx = 0.0;

        if (s->im[j] < 0.0)
            continue;
        for (int64_t i = 0; i < n; i++)
            yx += conj(entry_of(s, &s->left, i, j)) *
                  entry_of(s, &s->right, i, j);
        ritz_dense_col(&part, 0)[j] = part_of(s, &s->left, j, &s->w[0]) /
                                      fmax(pow(cabs(yx), 2.0), DBL_EPSILON);
        ritz_dense_col(&part, 1)[j] = part_of(s, &s->right, j, &s->w[1]);
    }
    for (int k = 0; k < SIDES; k++) {
        double most = ritz_dense_col_max(&part, k);

        for (int64_t j = 0; j < n && a->side[k].open && most > 0.0; j++)
            s->part[j] += ritz_dense_col(&part, k)[j] / most;
    }
    return RITZ_OK;
}

/* Move a projected pole away from 0 if it is nearer than all poles that are not
   decoupled. */
static void keep_away(const adi *a, small_pencil *s, int64_t k)
{
    const double size = hypot(s->re[k], s->im[k]);

    if (size >= a->zero.radius)
        return;
    s->re[k] =
        size > 0.0 ? s->re[k] * (a->zero.radius / size) : -a->zero.radius;
    s->im[k] = size > 0.0 ? s->im[k] * (a->zero.radius / size) : 0.0;
}

/* The next shifts: poles with the largest participation in the residuals. */
static ritz_status choose_shifts(adi *a, int64_t *count, double _Complex *out)
{
    RITZ_OWN(ritz_orthonormal) set = {0};
    RITZ_OWN(small_pencil) s = {0};
    ritz_dense U = {0};

    RITZ_CHECK(span_window(a, &set));
    U = ritz_dense_part(&set.V, 0, set.count);
    RITZ_CHECK(project_pencil(a, &U, &s));
    RITZ_CHECK(find_vectors(&s));
    RITZ_CHECK(weigh_poles(a, &s));
    for (*count = 0; *count < TOGETHER; ++*count) {
        int64_t best = -1;
        double size = 0.0;

        for (int64_t j = 0; j < s.A.nrow; j++)
            if (s.part[j] > 0.0 && (best < 0 || s.part[j] > s.part[best]))
                best = j;
        if (best < 0)
            break;
        keep_away(a, &s, best);
        size = hypot(s.re[best], s.im[best]);
        out[*count] = -fmax(fabs(s.re[best]), RITZ_SHIFT_DAMPED * size);
        if (fabs(s.im[best]) > RITZ_SHIFT_REAL * fabs(s.re[best]))
            out[*count] += ritz_complex(0.0, fabs(s.im[best]));
        s.part[best] = 0.0;
    }
    RITZ_REFUSE_IF(*count == 0, RITZ_ERR_CONVERGENCE,
                   "there is no shift for what the Gramians still miss");
    return RITZ_OK;
}

static ritz_status reserve_columns(int64_t n, int64_t more, adi_side *side)
{
    int64_t room = side->room > 0 ? side->room : 64;
    RITZ_OWN(ritz_dense) Z = {0};
    int64_t used = side->Z.ncol;

    if (used + more <= side->room)
        return RITZ_OK;
    while (room < used + more)
        room += room / 2;
    RITZ_REFUSE_IF((double)n * (double)room * 8.0 > RITZ_FACTOR_BYTES,
                   RITZ_ERR_CONVERGENCE,
                   "the Gramians have no low rank: %" PRId64
                   " columns of a factor are more than memory shall hold",
                   used + more);
    RITZ_CHECK(ritz_dense_new(n, room, &Z));
    if (used > 0)
        ritz_dense_put(&side->Z, 0, 0, &Z);
    ritz_dense_replace(&side->Z, &Z);
    side->Z.ncol = used;
    side->room = room;
    return RITZ_OK;
}

static void enter_window(adi *a, const double *x)
{
    memcpy(ritz_dense_col(&a->window, a->entered++ % WINDOW), x,
           (size_t)a->pencil.n * sizeof *x);
}

/* Append the columns of solution v to Z, and update the residual factor W. */
static ritz_status append_columns(adi *a, int k, double _Complex p,
                                  const double _Complex *v)
{
    adi_side *side = &a->side[k];
    const int64_t n = a->pencil.n, m = side->W.ncol;
    const bool pair = cimag(p) != 0.0;
    const double d = pair ? creal(p) / cimag(p) : 0.0;
    const double g = sqrt((pair ? -4.0 : -2.0) * creal(p));
    RITZ_OWN(ritz_dense) plus = {0}, Eplus = {0};

    RITZ_CHECK(reserve_columns(n, pair ? 2 * m : m, side));
    RITZ_CHECK(ritz_dense_new(n, m, &plus));
    for (int64_t i = 0; i < n * m; i++)
        plus.val[i] = creal(v[i]) + d * cimag(v[i]);
    for (int part = 0; part < (pair ? 2 : 1); part++)
        for (int64_t j = 0; j < m; j++) {
            double *z = ritz_dense_col(&side->Z, side->Z.ncol++);

            for (int64_t i = 0; i < n; i++)
                z[i] = part == 0 ? g * plus.val[i + j * n]
                                 : g * sqrt(d * d + 1.0) * cimag(v[i + j * n]);
            enter_window(a, z);
        }
    RITZ_CHECK(ritz_sparse_mul(ritz_pencil_descriptor(&a->pencil, k == 1),
                               &plus, &Eplus));
    ritz_dense_add(g * g, &Eplus, &side->W);
    return RITZ_OK;
}

static ritz_status take_shift(adi *a, double _Complex p)
{
    ritz_status status = ritz_pencil_factor(&a->pencil, -p);

    RITZ_REFUSE_IF(status == RITZ_ERR_SINGULAR, RITZ_ERR_CONVERGENCE,
                   "a pole at %.4g rad/s is not left of the axis, there is no "
                   "Gramian",
                   -creal(p));
    RITZ_CHECK(status);
    for (int k = 0; k < SIDES; k++) {
        adi_side *side = &a->side[k];
        int64_t size = side->W.nrow * side->W.ncol;
        RITZ_OWN_ARRAY double _Complex *v = NULL;
        double left = 0.0;

        if (!side->open)
            continue;
        RITZ_CHECK_NEW(v, size);
        for (int64_t i = 0; i < size; i++)
            v[i] = side->W.val[i];
        RITZ_CHECK(ritz_pencil_solve(&a->pencil, k == 1, side->W.ncol, v));
        RITZ_CHECK(
            ritz_zero_poles_of_states(&a->zero, k == 1, side->W.ncol, v));
        RITZ_CHECK(append_columns(a, k, p, v));
        RITZ_CHECK(measure_left(&side->W, &left));
        side->residual = left / side->first;
        side->open = a->projects || side->residual > a->tolerance;
    }
    ritz_monitor_step("shifts", ++a->shifts, 0);
    return RITZ_OK;
}

/* Refuse an iteration that converges too slowly, or diverges. */
static ritz_status refuse_slow(const adi *a, const double *history)
{
    int64_t half = a->shifts / 2;
    double worst = worst_residual(a);
    double rate =
        (log(history[half]) - log(worst)) / (double)(a->shifts - half);
    double total = (double)a->shifts + log(worst / a->tolerance) / rate;

    if (!is_open(a) || a->shifts < PATIENCE ||
        (rate > 0.0 && total < 5.0 * MOST_SHIFTS && a->shifts < MOST_SHIFTS))
        return RITZ_OK;
    return ritz_fail(RITZ_ERR_CONVERGENCE,
                     "the Gramians have no low rank, or a pole is not left of "
                     "the axis: after %" PRId64 " shifts the residual is %.1e",
                     a->shifts, worst);
}

/* Solve the equation in the span of Z if that is likely to end the iteration:
   the residual of ADI is not far from the tolerance, and either Z has grown by an
   eighth since the last time, or ADI has converged. */
static ritz_status project_side(adi *a, int k)
{
    adi_side *side = &a->side[k];
    RITZ_OWN(ritz_dense) X = {0};
    double left = 0.0;

    if (!side->open || side->residual > RITZ_GALERKIN_LEAD * a->tolerance ||
        (side->Z.ncol < side->next && side->residual > a->tolerance))
        return RITZ_OK;
    side->next = side->Z.ncol + side->Z.ncol / 8;
    RITZ_CHECK(ritz_galerkin_gramian(&a->pencil, k == 1, &side->Z, &side->load,
                                     &X, &left));
    if (left > a->tolerance * side->first)
        return RITZ_OK;
    side->residual = left / side->first;
    side->open = false;
    RITZ_MOVE(side->X, X);
    return RITZ_OK;
}

static ritz_status run_adi(adi *a)
{
    double history[MOST_SHIFTS + TOGETHER + 1] = {1.0};
    double _Complex shift[TOGETHER];

    while (is_open(a)) {
        int64_t count = 0;

        RITZ_CHECK(choose_shifts(a, &count, shift));
        for (int64_t k = 0; k < count && is_open(a); k++) {
            RITZ_CHECK(take_shift(a, shift[k]));
            history[a->shifts] = worst_residual(a);
            RITZ_CHECK(refuse_slow(a, history));
        }
        for (int k = 0; a->projects && k < SIDES; k++)
            RITZ_CHECK(project_side(a, k));
    }
    return RITZ_OK;
}

ritz_status ritz_factor_compress(ritz_dense *A)
{
    const int64_t n = A->nrow, k = A->ncol, r = n < k ? n : k;
    RITZ_OWN(ritz_dense) Q = {0}, R = {0}, V = {0}, out = {0};
    RITZ_OWN_ARRAY double *tau = NULL, *s = NULL, *super = NULL;
    int64_t kept = 0;
    int info = 0;

    if (k == 0 || n == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_copy(A, &Q));
    RITZ_CHECK(ritz_dense_new(r, k, &R));
    RITZ_CHECK_NEW(tau, r);
    RITZ_CHECK_NEW(s, r);
    RITZ_CHECK_NEW(super, r);
    info = LAPACKE_dgeqrf(LAPACK_COL_MAJOR, (int)n, (int)k, Q.val, (int)n, tau);
    for (int64_t j = 0; j < k; j++)
        for (int64_t i = 0; i <= j && i < r; i++)
            ritz_dense_col(&R, j)[i] = ritz_dense_col(&Q, j)[i];
    if (info == 0)
        info = LAPACKE_dgesvd(LAPACK_COL_MAJOR, 'N', 'O', (int)r, (int)k, R.val,
                              (int)r, s, NULL, 1, NULL, 1, super);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_CONVERGENCE,
                   "a factor could not be compressed");
    while (kept < r && s[kept] > RITZ_SHORT_COLUMN * s[0])
        kept++;
    RITZ_CHECK(ritz_dense_new(k, kept, &V));
    for (int64_t j = 0; j < kept; j++)
        for (int64_t i = 0; i < k; i++)
            ritz_dense_col(&V, j)[i] = ritz_dense_col(&R, i)[j];
    RITZ_CHECK(ritz_dense_mul(A, &V, &out));
    ritz_dense_replace(A, &out);
    return RITZ_OK;
}

static ritz_status take_factor(adi_side *side, int64_t n, ritz_dense *out)
{
    ritz_dense *Z = side->X.val ? &side->X : &side->Z;

    if (!Z->val)
        return ritz_dense_new(n, 0, out);
    RITZ_CHECK(ritz_factor_compress(Z));
    RITZ_MOVE(*out, *Z);
    return RITZ_OK;
}

static ritz_status find_gramians(const ritz_state_space *model,
                                 double tolerance, bool projects,
                                 ritz_gramians *out)
{
    const int64_t n = ritz_state_space_order(model);
    RITZ_OWN(adi) a = {.projects = projects};
    RITZ_OWN(ritz_gramians) g = {0};

    RITZ_CHECK(start_adi(model, tolerance, &a));
    RITZ_CHECK(run_adi(&a));
    RITZ_CHECK(take_factor(&a.side[0], n, &g.Zc));
    RITZ_CHECK(take_factor(&a.side[1], n, &g.Zo));
    if (!a.pencil.plain)
        RITZ_CHECK(ritz_sparse_mul(&a.pencil.E, &g.Zc, &g.EZc));
    RITZ_MOVE(g.T, a.zero.T);
    RITZ_MOVE(g.W, a.zero.W);
    g.residual[0] = a.side[0].residual;
    g.residual[1] = a.side[1].residual;
    (void)snprintf(g.engine, sizeof g.engine, "%s, %" PRId64 " shifts",
                   projects ? "projection" : "ADI", a.shifts);
    memcpy(g.damping, model->damping, sizeof g.damping);
    RITZ_MOVE(*out, g);
    return RITZ_OK;
}

ritz_status ritz_gramians_space_low_rank(const ritz_state_space *model,
                                         double tolerance, ritz_gramians *out)
{
    return find_gramians(model, tolerance, false, out);
}

ritz_status ritz_gramians_space_projection(const ritz_state_space *model,
                                           double tolerance, ritz_gramians *out)
{
    return find_gramians(model, tolerance, true, out);
}

/* |X'Y|^2 of the rows from @p first on. */
static ritz_status square_product(const ritz_dense *X, const ritz_dense *Y,
                                  int64_t first, double *out)
{
    RITZ_OWN(ritz_dense) x = {0}, y = {0}, XY = {0};
    const int64_t rows = X->nrow - first;

    *out = 0.0;
    if (!X->val || !Y->val)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_block(X, first, rows, 0, X->ncol, &x));
    RITZ_CHECK(ritz_dense_block(Y, first, rows, 0, Y->ncol, &y));
    RITZ_CHECK(ritz_dense_mul_tn(&x, &y, &XY));
    *out = pow(ritz_general_size(&XY), 2.0);
    return RITZ_OK;
}

ritz_status ritz_space_norm_two(const ritz_state_space *model, int64_t last,
                                double *whole, double *part)
{
    const int64_t first[] = {0, ritz_state_space_order(model) - last};
    double *const out[] = {whole, part};
    RITZ_OWN(adi) a = {0};
    RITZ_OWN(ritz_dense) Ct = {0};

    RITZ_CHECK(start_adi(model, 0.0, &a));
    RITZ_CHECK(ritz_dense_copy(&a.side[1].W, &Ct));
    RITZ_CHECK(run_adi(&a));
    for (int k = 0; k < 2; k++) {
        double met = 0.0, left = 0.0;

        RITZ_CHECK(square_product(&Ct, &a.side[0].Z, first[k], &met));
        RITZ_CHECK(square_product(&a.side[1].Z, &a.side[0].W, first[k], &left));
        *out[k] = sqrt(met + left);
    }
    return RITZ_OK;
}
