/*
 * Block Krylov vectors of a state space. About each point s, with Z = A - s E
 * and loads F,
 *
 *     X_0 = Z^-1 F,   X_j = Z^-1 E Q_(j-1),   Q_j = independent part of X_j
 *
 * by Arnoldi's recurrence in complex arithmetic; T spans the real and imaginary
 * parts of all Q. W comes from (A', E', C') in the same way. About each point
 * the reduced model keeps as many moments as the whole blocks of T and W there,
 * counted together [Grimme1997]. With W = T the reduced model is stable if E
 * is symmetric and E and -(A + A') are definite. For a symmetric model with
 * inputs and outputs among F, W = T keeps as many moments as two sides.
 */
#include "bases/space.h"

#include "base/alloc.h"
#include "base/complex.h"
#include "base/tolerances.h"
#include "bases/columns.h"
#include "gramians/modes.h"
#include "linear/general.h"

#include <cblas.h>
#include <complex.h>
#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Orthonormal complex vectors of one point; the last block begins at column
   `last`. */
typedef struct arnoldi_space {
    int64_t n, count, last, room;
    double _Complex *Q; /* n x room */
} arnoldi_space;

static void arnoldi_space_free(arnoldi_space *a)
{
    free(a->Q);
}

/* x := x - Q Q^H x, in two passes; returns |x| relative to its former
   length. */
static double orthogonalise(const arnoldi_space *a, double _Complex *h,
                            double _Complex *x)
{
    const double _Complex one = 1.0, zero = 0.0, less = -1.0;
    const int n = (int)a->n, k = (int)a->count;
    double before = cblas_dznrm2(n, x, 1);

    for (int twice = 0; twice < 2 && k > 0; twice++) {
        cblas_zgemv(CblasColMajor, CblasConjTrans, n, k, &one, a->Q, n, x, 1,
                    &zero, h, 1);
        cblas_zgemv(CblasColMajor, CblasNoTrans, n, k, &less, a->Q, n, h, 1,
                    &one, x, 1);
    }
    return before > 0.0 ? cblas_dznrm2(n, x, 1) / before : 0.0;
}

/* Append the independent parts of the columns of X, n x m, as the new last
   block. */
static ritz_status append_complex(double tolerance, int64_t m,
                                  double _Complex *X, arnoldi_space *a)
{
    RITZ_OWN_ARRAY double _Complex *h = NULL;
    int64_t first = a->count;

    RITZ_CHECK_NEW(h, a->room);
    for (int64_t j = 0; j < m && a->count < a->room; j++) {
        double _Complex *x = X + j * a->n, *q = a->Q + a->count * a->n;
        double left = orthogonalise(a, h, x);
        double size = cblas_dznrm2((int)a->n, x, 1);

        if (!(left > tolerance))
            continue;
        for (int64_t i = 0; i < a->n; i++)
            q[i] = x[i] / size;
        a->count++;
    }
    a->last = first;
    return RITZ_OK;
}

/* Append the next block about the point whose matrix is factored. */
static ritz_status advance_block(const ritz_space_span *span, bool first,
                                 arnoldi_space *a)
{
    int64_t m = first ? span->F->ncol : a->count - a->last;
    RITZ_OWN_ARRAY double _Complex *X = NULL;

    RITZ_CHECK_NEW(X, a->n * m);
    if (first)
        for (int64_t k = 0; k < a->n * m; k++)
            X[k] = span->F->val[k];
    else
        ritz_pencil_times(ritz_pencil_descriptor(span->pencil, span->left), m,
                          a->Q + a->last * a->n, X);
    RITZ_CHECK(ritz_pencil_solve(span->pencil, span->left, m, X));
    return append_complex(span->tolerance, m, X, a);
}

/* Real parts of a point's vectors, followed by imaginary parts if the point is
   complex. */
static ritz_status take_parts(const arnoldi_space *a, bool complex_point,
                              ritz_dense *out)
{
    int64_t size = a->n * a->count;

    RITZ_CHECK(ritz_dense_new(a->n, (complex_point ? 2 : 1) * a->count, out));
    for (int64_t k = 0; k < size; k++) {
        out->val[k] = creal(a->Q[k]);
        if (complex_point)
            out->val[size + k] = cimag(a->Q[k]);
    }
    return RITZ_OK;
}

/* Vectors about one point: @p share real columns, or fewer if no independent
   ones are left. */
static ritz_status span_point(const ritz_space_span *span, double _Complex s,
                              int64_t share, ritz_dense *out, int64_t *whole)
{
    const bool complex_point = cimag(s) != 0.0;
    const int64_t parts = complex_point ? 2 : 1;
    RITZ_OWN(arnoldi_space) a = {.n = span->pencil->n};
    bool going = true;

    a.room = (share + parts - 1) / parts;
    a.room = a.room < a.n ? a.room : a.n;
    RITZ_CHECK_NEW(a.Q, a.n * a.room);
    RITZ_CHECK(ritz_pencil_factor(span->pencil, s));
    for (int64_t block = 0; going; block++) {
        int64_t due = block == 0 ? span->F->ncol : a.count - a.last;
        int64_t before = a.count;

        RITZ_CHECK(advance_block(span, block == 0, &a));
        if (whole && a.count > before &&
            (a.count < a.room || a.count - before == due))
            ++*whole;
        going = a.count > before && a.count < a.room &&
                (span->blocks == 0 || block + 1 < span->blocks);
    }
    return take_parts(&a, complex_point, out);
}

ritz_status ritz_space_krylov(const ritz_space_span *span, int64_t count,
                              const double _Complex *point, ritz_dense *out,
                              int64_t *whole)
{
    RITZ_OWN(ritz_orthonormal) set = {0};
    const int64_t n = span->pencil->n;
    const int64_t most = span->most < n ? span->most : n;

    RITZ_CHECK(ritz_orthonormal_new(n, NULL, span->tolerance, &set));
    for (int64_t k = 0; k < count && set.count < most; k++) {
        int64_t share = (most - set.count + count - k - 1) / (count - k);
        RITZ_OWN(ritz_dense) X = {0};
        ritz_status status =
            span_point(span, point[k], share, &X, whole ? &whole[k] : NULL);

        RITZ_REFUSE_IF(status == RITZ_ERR_SINGULAR, status,
                       "expansion point %g%+gi rad/s is a pole: move it",
                       creal(point[k]), cimag(point[k]));
        RITZ_CHECK(status);
        RITZ_CHECK(ritz_orthonormal_append(&set, &X, most - set.count, NULL));
    }
    return ritz_dense_columns(&set.V, 0, set.count, out);
}

ritz_status ritz_states_asked(const ritz_request *request)
{
    RITZ_REFUSE_IF(request->up_to_hz > 0.0, RITZ_ERR_ARGUMENT,
                   "states are asked for by their number, not by a frequency: "
                   "--modes, not --up-to-hz");
    RITZ_REFUSE_IF(request->modes < 1, RITZ_ERR_ARGUMENT,
                   "no states are asked for, one at least is needed: --modes");
    return RITZ_OK;
}

ritz_status ritz_space_request(const ritz_request *request, int uses)
{
    for (const ritz_choice_word *word = ritz_choice_words; word->key; word++)
        RITZ_REFUSE_IF(request->choice.given & word->uses & ~uses,
                       RITZ_ERR_ARGUMENT,
                       "of a state space there is no '%s' "
                       "to choose",
                       word->key);
    return ritz_states_asked(request);
}

void ritz_space_pair(ritz_dense *T, ritz_dense *W)
{
    int64_t count = T->ncol < W->ncol ? T->ncol : W->ncol;

    T->ncol = W->ncol = count;
}

ritz_status ritz_space_basis(const ritz_state_space *model, ritz_dense *T,
                             ritz_dense *W, ritz_basis *out)
{
    RITZ_OWN(ritz_basis) basis = {.states = true};

    RITZ_REFUSE_IF(T->ncol == 0, RITZ_ERR_ARGUMENT,
                   "nothing responds to the inputs, or nothing that an output "
                   "observes");
    RITZ_CHECK(ritz_columns_new(T->ncol, &basis.columns));
    for (int64_t j = 0; j < T->ncol; j++)
        basis.columns.kind[j] = RITZ_COLUMN_STATE;
    RITZ_MOVE(basis.T, *T);
    RITZ_MOVE(basis.W, *W);
    memcpy(basis.damping, model->damping, sizeof basis.damping);
    (void)snprintf(basis.origin.engine, sizeof basis.origin.engine, "MUMPS");
    RITZ_MOVE(*out, basis);
    return RITZ_OK;
}

/* Right-hand sides of T and, with two sides, of W; with one side W = T. */
typedef struct krylov_sides {
    bool two;
    ritz_dense right, left; /* n x loads */
} krylov_sides;

static void krylov_sides_free(krylov_sides *s)
{
    ritz_dense_free(&s->right);
    ritz_dense_free(&s->left);
}

/* Choose one side if the model is dissipative, since projection by T alone then
   keeps stability; otherwise two sides, which keep more moments. */
static ritz_status choose_sides(const ritz_request *request,
                                const ritz_pencil *pencil, krylov_sides *s)
{
    const ritz_choice *choice = &request->choice;
    const ritz_state_space *model = request->space;
    int loads = choice->loads;
    RITZ_OWN(ritz_dense) Ct = {0};
    bool stable = false;

    RITZ_REFUSE_IF(loads & ~(RITZ_LOADS_INPUTS | RITZ_LOADS_OUTPUTS),
                   RITZ_ERR_ARGUMENT,
                   "a state space has inputs and outputs, and no other loads");
    RITZ_CHECK(ritz_pencil_is_dissipative(pencil, &stable));
    s->two = choice->given & RITZ_USES_SIDES ? !choice->one_sided
                                             : !stable && loads == 0;
    RITZ_REFUSE_IF(
        s->two && loads, RITZ_ERR_ARGUMENT,
        "with two sides, right vectors come from the inputs and left "
        "ones from the outputs: a choice of loads needs one side");
    RITZ_CHECK(ritz_outputs_scaled(&model->C, model->limit, &Ct));
    if (s->two) {
        RITZ_CHECK(ritz_dense_copy(&model->B, &s->right));
        RITZ_MOVE(s->left, Ct);
        return RITZ_OK;
    }
    if (loads == RITZ_LOADS_INPUTS)
        return ritz_dense_copy(&model->B, &s->right);
    if (loads == RITZ_LOADS_OUTPUTS)
        return ritz_dense_copy(&Ct, &s->right);
    return ritz_dense_beside(&model->B, &Ct, &s->right);
}

/* Points i 2 pi f of the choice; 0 if it has none. */
static int64_t list_points(const ritz_choice *choice, double _Complex *point)
{
    point[0] = 0.0;
    for (int64_t k = 0; k < choice->num_shifts; k++)
        point[k] = ritz_complex(0.0, 2.0 * RITZ_PI * choice->shift_hz[k]);
    return choice->num_shifts > 0 ? choice->num_shifts : 1;
}

static void add_remark(const ritz_request *request, const krylov_sides *sides,
                       int64_t count, const double _Complex *point,
                       const int64_t *whole, ritz_basis *basis)
{
    for (int64_t k = 0; k < count; k++)
        ritz_remark_add(basis, k > 0 ? ", " : "; ",
                        "%" PRId64 " whole block(s) about %g Hz", whole[k],
                        cimag(point[k]) / (2.0 * RITZ_PI));
    ritz_remark_add(basis, "; ", "%s",
                    sides->two ? "left vectors of the outputs"
                               : "left and right vectors agree");
    if (basis->T.ncol < request->modes)
        ritz_remark_add(basis, "; ",
                        "%" PRId64 " vectors and not %" PRId64
                        ", nothing new is left",
                        basis->T.ncol, request->modes);
}

ritz_status ritz_krylov_of_space(const ritz_request *request, ritz_basis *out)
{
    enum { USES = RITZ_USES_SHIFTS | RITZ_USES_LOADS | RITZ_USES_SIDES };
    double _Complex point[RITZ_MOST_SHIFTS];
    int64_t whole[RITZ_MOST_SHIFTS] = {0};
    int64_t count = list_points(&request->choice, point);
    RITZ_OWN(ritz_pencil) pencil = {0};
    RITZ_OWN(krylov_sides) sides = {0};
    RITZ_OWN(ritz_dense) T = {0}, W = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    ritz_space_span span = {.pencil = &pencil,
                            .most = request->modes,
                            .tolerance = request->tolerance};

    RITZ_CHECK(ritz_space_request(request, USES));
    RITZ_CHECK(ritz_pencil_of_space(request->space, &pencil));
    RITZ_CHECK(choose_sides(request, &pencil, &sides));
    span.F = &sides.right;
    RITZ_CHECK(ritz_space_krylov(&span, count, point, &T, whole));
    if (sides.two) {
        span.F = &sides.left;
        span.left = true;
        RITZ_CHECK(ritz_space_krylov(&span, count, point, &W, NULL));
        ritz_space_pair(&T, &W);
    }
    RITZ_CHECK(ritz_space_basis(request->space, &T, &W, &basis));
    add_remark(request, &sides, count, point, whole, &basis);
    RITZ_MOVE(*out, basis);
    return RITZ_OK;
}
