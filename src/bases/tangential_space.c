/*
 * Tangential interpolation of a state space by two projections
 * [GugercinAntoulasBeattie2008],
 *
 *     span T = { (A - s_i E)^-1 B b_i },   span W = { (A - s_i E)^-T C' c_i }
 *
 * so that H_r(s_i) b_i = H(s_i) b_i, c_i'H_r(s_i) = c_i'H(s_i), and
 * c_i'H_r'(s_i) b_i = c_i'H'(s_i) b_i. In H2 the best points are the mirrored
 * poles of the reduced model, and the best directions are its residues,
 *
 *     H_r(s) = sum c_i b_i' / (s - p_i),   s_i = -p_i,
 *
 * IRKA takes both from the reduced model of the last iteration, until they
 * settle. The first ones are the most dominant poles, by |c||b| / sqrt(2 |Re
 * p|), of a Krylov model of twice as many states. Outputs are divided by their
 * limits.
 */
#include "bases/space.h"

#include "base/alloc.h"
#include "base/complex.h"
#include "base/tolerances.h"
#include "bases/columns.h"
#include "gramians/modes.h"
#include "linear/general.h"

#include <complex.h>
#include <inttypes.h>
#include <lapacke.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ROUNDS = 50 };

/* Interpolation points, one of each conjugate pair, and their tangential
   directions. */
typedef struct directions {
    int64_t count, inputs, outputs;
    double _Complex *s;
    double _Complex *b, *c; /* inputs x count, outputs x count */
    double *size;           /* H2 norm of each term, by which terms are
                               ordered */
} directions;

static void directions_free(directions *d)
{
    RITZ_FREE(d->s, d->b, d->c, d->size);
    *d = (directions){0};
}

static ritz_status directions_new(int64_t room, int64_t inputs, int64_t outputs,
                                  directions *out)
{
    out->inputs = inputs;
    out->outputs = outputs;
    RITZ_CHECK_NEW(out->s, room);
    RITZ_CHECK_NEW(out->b, room * inputs);
    RITZ_CHECK_NEW(out->c, room * outputs);
    RITZ_CHECK_NEW(out->size, room);
    return RITZ_OK;
}

typedef struct irka {
    const ritz_request *request;
    ritz_pencil pencil;
    ritz_dense B, Ct; /* n x m, n x p */
    ritz_dense T, W;
    directions points; /* the points that T and W interpolate */
    int rounds;
    double change;
} irka;

static void irka_free(irka *s)
{
    ritz_pencil_free(&s->pencil);
    ritz_dense_free(&s->B);
    ritz_dense_free(&s->Ct);
    ritz_dense_free(&s->T);
    ritz_dense_free(&s->W);
    directions_free(&s->points);
}

/* The reduced model of T and W: (W'E T)^-1 W'A T, (W'E T)^-1 W'B, and T'C'. */
typedef struct small_model {
    ritz_dense A, B, Ct;
} small_model;

static void small_model_free(small_model *m)
{
    ritz_dense_free(&m->A);
    ritz_dense_free(&m->B);
    ritz_dense_free(&m->Ct);
}

static ritz_status project_pencil(const irka *s, small_model *out)
{
    RITZ_OWN(ritz_dense) AT = {0}, ET = {0}, E = {0};
    ritz_status status = RITZ_OK;

    RITZ_CHECK(ritz_sparse_mul(&s->pencil.A, &s->T, &AT));
    RITZ_CHECK(ritz_sparse_mul(&s->pencil.E, &s->T, &ET));
    RITZ_CHECK(ritz_dense_mul_tn(&s->W, &AT, &out->A));
    RITZ_CHECK(ritz_dense_mul_tn(&s->W, &ET, &E));
    RITZ_CHECK(ritz_dense_mul_tn(&s->W, &s->B, &out->B));
    RITZ_CHECK(ritz_dense_mul_tn(&s->T, &s->Ct, &out->Ct));
    status = ritz_general_solve(&E, false, &out->A);
    RITZ_REFUSE_IF(status == RITZ_ERR_SINGULAR, status,
                   "left and right vectors of %" PRId64
                   " states are orthogonal in part: ask for another number",
                   s->T.ncol);
    RITZ_CHECK(status);
    return ritz_general_solve(&E, false, &out->B);
}

/* Entry i of eigenvector j in LAPACK's real storage, where columns j and j + 1
   hold the real and imaginary part of a conjugate pair. */
static double _Complex vector_entry(const ritz_dense *V, const double *im,
                                    int64_t i, int64_t j)
{
    if (im[j] == 0.0)
        return ritz_dense_col(V, j)[i];
    return ritz_complex(ritz_dense_col(V, j)[i], ritz_dense_col(V, j + 1)[i]);
}

/* Append the term of pole j, Im p >= 0: its mirrored point, residues and H2
   norm. */
static void add_term(const small_model *m, const ritz_dense *L,
                     const ritz_dense *R, const double *re, const double *im,
                     int64_t j, directions *out)
{
    int64_t k = out->count++, r = m->A.nrow;
    double _Complex *b = out->b + k * out->inputs;
    double _Complex *c = out->c + k * out->outputs;
    double _Complex yx = 0.0;
    double sizes[2] = {0.0, 0.0};

    for (int64_t i = 0; i < r; i++)
        yx += conj(vector_entry(L, im, i, j)) * vector_entry(R, im, i, j);
    for (int64_t a = 0; a < out->inputs; a++) {
        for (int64_t i = 0; i < r; i++)
            b[a] += conj(vector_entry(L, im, i, j)) *
                    ritz_dense_col(&m->B, a)[i] / yx;
        sizes[0] = hypot(sizes[0], cabs(b[a]));
    }
    for (int64_t a = 0; a < out->outputs; a++) {
        for (int64_t i = 0; i < r; i++)
            c[a] += vector_entry(R, im, i, j) * ritz_dense_col(&m->Ct, a)[i];
        sizes[1] = hypot(sizes[1], cabs(c[a]));
    }
    for (int64_t a = 0; a < out->inputs && sizes[0] > 0.0; a++)
        b[a] /= sizes[0];
    for (int64_t a = 0; a < out->outputs && sizes[1] > 0.0; a++)
        c[a] /= sizes[1];
    /* an unstable pole is mirrored as well, so that no point lies left of the
       axis */
    out->s[k] = ritz_complex(fabs(re[j]), -im[j]);
    out->size[k] =
        sizes[0] * sizes[1] /
        sqrt(2.0 * fmax(fabs(re[j]), RITZ_NEGLIGIBLE * hypot(re[j], im[j])));
}

static ritz_status find_terms(const small_model *m, directions *out)
{
    int n = (int)m->A.nrow;
    RITZ_OWN(ritz_dense) A = {0}, L = {0}, R = {0};
    RITZ_OWN(directions) found = {0};
    RITZ_OWN_ARRAY double *re = NULL, *im = NULL;
    int info = 0;

    RITZ_CHECK(ritz_dense_copy(&m->A, &A));
    RITZ_CHECK(ritz_dense_new(n, n, &L));
    RITZ_CHECK(ritz_dense_new(n, n, &R));
    RITZ_CHECK_NEW(re, n);
    RITZ_CHECK_NEW(im, n);
    RITZ_CHECK(directions_new(n, m->B.ncol, m->Ct.ncol, &found));
    info = LAPACKE_dgeev(LAPACK_COL_MAJOR, 'V', 'V', n, A.val, n, re, im, L.val,
                         n, R.val, n);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_CONVERGENCE,
                   "poles of the reduced model were not found");
    for (int64_t j = 0; j < n; j++)
        if (im[j] >= 0.0)
            add_term(m, &L, &R, re, im, j, &found);
    RITZ_MOVE(*out, found);
    return RITZ_OK;
}

static void swap_terms(directions *d, int64_t j, int64_t k)
{
    double _Complex s = d->s[j];
    double size = d->size[j];

    d->s[j] = d->s[k];
    d->s[k] = s;
    d->size[j] = d->size[k];
    d->size[k] = size;
    for (int64_t a = 0; a < d->inputs + d->outputs; a++) {
        double _Complex *v = a < d->inputs ? d->b + a : d->c + a - d->inputs;
        int64_t step = a < d->inputs ? d->inputs : d->outputs;
        double _Complex x = v[j * step];

        v[j * step] = v[k * step];
        v[k * step] = x;
    }
}

static int64_t parts_of(double _Complex s)
{
    return cimag(s) != 0.0 ? 2 : 1;
}

/* Move the largest terms to the front, as many as give at most @p most columns;
   a conjugate pair that does not fit is skipped. */
static void keep_dominant(int64_t most, directions *d)
{
    int64_t kept = 0, columns = 0;

    for (;;) {
        int64_t best = -1;

        for (int64_t k = kept; k < d->count; k++)
            if (columns + parts_of(d->s[k]) <= most && d->size[k] > 0.0 &&
                (best < 0 || d->size[k] > d->size[best] * RITZ_TIE))
                best = k;
        if (best < 0)
            break;
        swap_terms(d, kept, best);
        columns += parts_of(d->s[kept++]);
    }
    d->count = kept;
}

/* Largest relative distance of a point to the nearest of the previous
   points. */
static double measure_change(const directions *before, const directions *now)
{
    double worst = before->count == now->count ? 0.0 : HUGE_VAL;

    for (int64_t k = 0; k < now->count && worst < HUGE_VAL; k++) {
        double least = HUGE_VAL;

        for (int64_t j = 0; j < before->count; j++)
            least = fmin(least, cabs(before->s[j] - now->s[k]));
        worst = fmax(worst, least / fmax(cabs(now->s[k]), RITZ_LEAST_SCALE));
    }
    return worst;
}

/* x += F b, with x of n entries. */
static void combine_columns(const ritz_dense *F, const double _Complex *b,
                            double _Complex *x)
{
    for (int64_t j = 0; j < F->ncol; j++)
        for (int64_t i = 0; i < F->nrow; i++)
            x[i] += b[j] * ritz_dense_col(F, j)[i];
}

static ritz_status append_response(const double _Complex *x, int64_t n,
                                   int64_t parts, ritz_orthonormal *set)
{
    RITZ_OWN(ritz_dense) X = {0};

    RITZ_CHECK(ritz_dense_new(n, parts, &X));
    for (int64_t i = 0; i < n; i++) {
        X.val[i] = creal(x[i]);
        if (parts > 1)
            X.val[n + i] = cimag(x[i]);
    }
    return ritz_orthonormal_append(set, &X, parts, NULL);
}

RITZ_PAIR_OF(ritz_orthonormal);

/* T and W for the given points and directions. */
static ritz_status span_points(const directions *d, irka *s)
{
    const int64_t n = s->pencil.n;
    RITZ_OWN(ritz_orthonormal_pair) set = {0};
    RITZ_OWN_ARRAY double _Complex *x = NULL;

    RITZ_CHECK_NEW(x, n);
    for (int side = 0; side < 2; side++)
        RITZ_CHECK(
            ritz_orthonormal_new(n, NULL, s->request->tolerance, &set[side]));
    for (int64_t k = 0; k < d->count; k++) {
        RITZ_CHECK(ritz_pencil_factor(&s->pencil, d->s[k]));
        for (int side = 0; side < 2; side++) {
            memset(x, 0, (size_t)n * sizeof *x);
            if (side == 0)
                combine_columns(&s->B, d->b + k * d->inputs, x);
            else
                combine_columns(&s->Ct, d->c + k * d->outputs, x);
            RITZ_CHECK(ritz_pencil_solve(&s->pencil, side == 1, 1, x));
            RITZ_CHECK(append_response(x, n, parts_of(d->s[k]), &set[side]));
        }
    }
    ritz_dense_free(&s->T);
    ritz_dense_free(&s->W);
    RITZ_CHECK(ritz_dense_columns(&set[0].V, 0, set[0].count, &s->T));
    RITZ_CHECK(ritz_dense_columns(&set[1].V, 0, set[1].count, &s->W));
    ritz_space_pair(&s->T, &s->W);
    return RITZ_OK;
}

/* T and W of a Krylov model of twice as many states about 0, or about a point
   near 0 if 0 is a pole. */
static ritz_status span_start(irka *s)
{
    const double size =
        ritz_sparse_max(&s->pencil.A) / ritz_sparse_max(&s->pencil.E);
    ritz_space_span span = {.pencil = &s->pencil,
                            .F = &s->B,
                            .most = 2 * s->request->modes,
                            .tolerance = s->request->tolerance};
    double _Complex at = 0.0;
    double shift = RITZ_SHIFT_ASIDE * size;
    ritz_status status = RITZ_ERR_SINGULAR;

    while (status == RITZ_ERR_SINGULAR && shift < size) {
        status = ritz_space_krylov(&span, 1, &at, &s->T, NULL);
        if (status == RITZ_ERR_SINGULAR)
            at = shift;
        shift *= RITZ_SHIFT_FARTHER;
    }
    RITZ_CHECK(status);
    span.F = &s->Ct;
    span.left = true;
    RITZ_CHECK(ritz_space_krylov(&span, 1, &at, &s->W, NULL));
    ritz_space_pair(&s->T, &s->W);
    return RITZ_OK;
}

static ritz_status take_terms(const irka *s, directions *out)
{
    RITZ_OWN(small_model) m = {0};

    RITZ_CHECK(project_pencil(s, &m));
    RITZ_CHECK(find_terms(&m, out));
    keep_dominant(s->request->modes, out);
    return RITZ_OK;
}

static ritz_status iterate_points(irka *s)
{
    RITZ_CHECK(span_start(s));
    s->change = HUGE_VAL;
    for (s->rounds = 0; s->rounds < MOST_ROUNDS; s->rounds++) {
        RITZ_OWN(directions) next = {0};

        RITZ_REFUSE_IF(s->T.ncol == 0, RITZ_ERR_ARGUMENT,
                       "no state is both controllable and observable");
        RITZ_CHECK(take_terms(s, &next));
        RITZ_REFUSE_IF(next.count == 0, RITZ_ERR_ARGUMENT,
                       "one state cannot hold a pair of poles: ask for 2 or "
                       "more");
        if (s->rounds > 0)
            s->change = measure_change(&s->points, &next);
        if (s->change <= RITZ_SPACE_POINTS_SETTLED)
            break;
        directions_free(&s->points);
        RITZ_MOVE(s->points, next);
        RITZ_CHECK(span_points(&s->points, s));
        ritz_monitor_step("rounds", s->rounds + 1, 0);
    }
    return RITZ_OK;
}

/* T and W from responses to all inputs, and adjoint responses to all outputs,
   at the requested points. */
static ritz_status take_given(irka *s)
{
    const ritz_choice *choice = &s->request->choice;
    double _Complex point[RITZ_MOST_SHIFTS];
    ritz_space_span span = {.pencil = &s->pencil,
                            .F = &s->B,
                            .most = s->request->modes,
                            .blocks = 1,
                            .tolerance = s->request->tolerance};

    for (int64_t k = 0; k < choice->num_shifts; k++)
        point[k] = ritz_complex(0.0, 2.0 * RITZ_PI * choice->shift_hz[k]);
    RITZ_CHECK(
        ritz_space_krylov(&span, choice->num_shifts, point, &s->T, NULL));
    span.F = &s->Ct;
    span.left = true;
    RITZ_CHECK(
        ritz_space_krylov(&span, choice->num_shifts, point, &s->W, NULL));
    ritz_space_pair(&s->T, &s->W);
    return RITZ_OK;
}

static void add_remark(const irka *s, ritz_basis *basis)
{
    if (s->request->choice.num_shifts > 0)
        ritz_remark_add(basis, "; ",
                        "responses interpolated at %" PRId64 " point(s)",
                        s->request->choice.num_shifts);
    else if (s->change <= RITZ_SPACE_POINTS_SETTLED)
        ritz_remark_add(basis, "; ", "points settled after %d round(s)",
                        s->rounds);
    else
        ritz_remark_add(basis, "; ",
                        "points did not settle in %d rounds, the last moved "
                        "them by %.1e; interpolation is exact where they were",
                        s->rounds, s->change);
    if (basis->T.ncol < s->request->modes)
        ritz_remark_add(basis, "; ", "%" PRId64 " vector(s) fewer than asked",
                        s->request->modes - basis->T.ncol);
}

ritz_status ritz_tangential_of_space(const ritz_request *request,
                                     ritz_basis *out)
{
    const ritz_state_space *model = request->space;
    RITZ_OWN(irka) s = {.request = request};
    RITZ_OWN(ritz_basis) basis = {0};

    RITZ_CHECK(ritz_space_request(request, RITZ_USES_SHIFTS));
    RITZ_CHECK(ritz_ends_check("model", model->num_inputs, model->num_outputs,
                               model->limit, model->output));
    RITZ_CHECK(ritz_pencil_of_space(model, &s.pencil));
    RITZ_CHECK(ritz_dense_copy(&model->B, &s.B));
    RITZ_CHECK(ritz_outputs_scaled(&model->C, model->limit, &s.Ct));
    RITZ_CHECK(request->choice.num_shifts > 0 ? take_given(&s)
                                              : iterate_points(&s));
    RITZ_CHECK(ritz_space_basis(model, &s.T, &s.W, &basis));
    add_remark(&s, &basis);
    RITZ_MOVE(*out, basis);
    return RITZ_OK;
}
