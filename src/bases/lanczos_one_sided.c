#include <ritz/matrix.h>

#include "base/alloc.h"
#include "base/tolerances.h"
#include "bases/balance_asked.h"
#include "linear/eigenvalues.h"
#include "linear/general.h"
#include "linear/orthonormal.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/*
 * The controllable states of a Gramian, in coordinates in which the Gramian is
 * I.
 */

/*
 * With A W + W A' + B B' = 0, W = U U' and U = Z Sigma X', cut to r values:
 * Q = Z Sigma, V = Z Sigma^-1 and A~ = V'A Q, B~ = V'B, for which
 * A~ + A~' = -B~ B~'.
 */
typedef struct ritz_gramian_range {
    int64_t reached; /* values above the tolerance */
    ritz_dense Q, V; /* n x r, r <= reached: as rounding allows */
    ritz_dense A, B; /* r x r, r x inputs */
    double rounding; /* |A + A' + B B'| of Frobenius */
} ritz_gramian_range;

/* Entry (i, j) of A + A' + B B'. */
static double defect_entry(const ritz_dense *A, const ritz_dense *B, int64_t i,
                           int64_t j)
{
    double sum = ritz_dense_col(A, j)[i] + ritz_dense_col(A, i)[j];

    for (int64_t k = 0; k < B->ncol; k++)
        sum += ritz_dense_col(B, k)[i] * ritz_dense_col(B, k)[j];
    return sum;
}

/*
 * The number of leading rows and columns in which the defect's norm is below
 * the limit.
 */
static int64_t count_accurate(const ritz_dense *A, const ritz_dense *B,
                              double limit, double *norm)
{
    double sum = 0.0;

    *norm = 0.0;
    for (int64_t j = 0; j < A->nrow; j++) {
        for (int64_t i = 0; i <= j; i++)
            sum += (i < j ? 2.0 : 1.0) * pow(defect_entry(A, B, i, j), 2.0);
        if (sqrt(sum) > limit)
            return j;
        *norm = sqrt(sum);
    }
    return A->nrow;
}

/* |A + A' + B B'|, Frobenius. */
static double gramian_defect(const ritz_dense *A, const ritz_dense *B)
{
    double norm = 0.0;

    (void)count_accurate(A, B, HUGE_VAL, &norm);
    return norm;
}

/* Columns k < r of Z times s^power. */
static ritz_status scale_columns(const ritz_dense *Z, const double *s,
                                 int64_t r, double power, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_columns(Z, 0, r, out));
    for (int64_t j = 0; j < r; j++)
        for (int64_t i = 0; i < Z->nrow; i++)
            ritz_dense_col(out, j)[i] *= pow(s[j], power);
    return RITZ_OK;
}

static void free_gramian_range(ritz_gramian_range *range)
{
    ritz_dense_free(&range->Q);
    ritz_dense_free(&range->V);
    ritz_dense_free(&range->A);
    ritz_dense_free(&range->B);
    *range = (ritz_gramian_range){0};
}

/* Q, V, A and B of the first r values. */
static ritz_status transform_system(const ritz_dense *A, const ritz_dense *B,
                                    const ritz_dense *Z, const double *s,
                                    int64_t r, ritz_gramian_range *range)
{
    ritz_status status = RITZ_OK;
    ritz_gramian_range made = {.reached = range->reached,
                               .rounding = range->rounding};
    ritz_dense AQ = {0};

    RITZ_TRY(scale_columns(Z, s, r, 1.0, &made.Q));
    RITZ_TRY(scale_columns(Z, s, r, -1.0, &made.V));
    RITZ_TRY(ritz_dense_mul(A, &made.Q, &AQ));
    RITZ_TRY(ritz_dense_mul_tn(&made.V, &AQ, &made.A));
    RITZ_TRY(ritz_dense_mul_tn(&made.V, B, &made.B));
    free_gramian_range(range);
    RITZ_MOVE(*range, made);
done:
    free_gramian_range(&made);
    ritz_dense_free(&AQ);
    return status;
}

/*
 * @param[in] tolerance  relative, of singular values of U
 * @param[in] limit      of `rounding`: the range is cut until it is below
 * @return RITZ_ERR_ARGUMENT if the Gramian is zero, or a pole is not stable;
 *         RITZ_ERR_CONVERGENCE if nothing is left
 */
static ritz_status find_gramian_range(const ritz_dense *A, const ritz_dense *B,
                                      double tolerance, double limit,
                                      ritz_gramian_range *out)
{
    ritz_status status = RITZ_OK;
    ritz_gramian_range range = {0};
    ritz_dense U = {0}, Z = {0};
    double *s = NULL;
    int64_t n = A->nrow;
    int64_t r = 0;
    double least = fmax(tolerance, (double)n * DBL_EPSILON);

    RITZ_TRY(ritz_general_gramian(A, B, &U));
    RITZ_TRY(ritz_general_svd(&U, &Z, &s, NULL));
    while (r < n && s[r] > least * s[0])
        r++;
    RITZ_FAIL_IF(r == 0, RITZ_ERR_ARGUMENT,
                 "no flexible state is reached, the Gramian is zero: do the "
                 "inputs and outputs act on rigid motion alone?");
    range.reached = r;
    RITZ_TRY(transform_system(A, B, &Z, s, r, &range));
    r = count_accurate(&range.A, &range.B, limit, &range.rounding);
    RITZ_FAIL_IF(r == 0, RITZ_ERR_CONVERGENCE,
                 "rounding of the Gramian is as large as the least damping");
    if (r < range.reached)
        RITZ_TRY(transform_system(A, B, &Z, s, r, &range));
    RITZ_MOVE(*out, range);
done:
    free_gramian_range(&range);
    ritz_dense_free(&U);
    ritz_dense_free(&Z);
    free(s);
    return status;
}

/*
 * One-sided Lanczos vectors of x' = A x + B u in the inner product of the
 * inverse of a Gramian [CraigSuKim1992, section 5]. With
 *
 *     A W + W A' + B B' = 0,   Q' W^-1 Q = I,   span Q = [B, A B, A^2 B, ...]
 *
 * the reduced A_r = Q' W^-1 A Q is block tridiagonal and skew-symmetric but for
 * its first block:
 *
 *     A_r + A_r' = -B_r B_r'
 *
 * so I is its own Gramian and no pole is right of the axis. The factor W = U U'
 * is found without W, and U = Z Sigma X' says where W is more than rounding:
 * the vectors are Q = Z Sigma P, Z and Sigma cut to that range, with P
 * orthonormal for
 *
 *     A~ = Sigma^-1 Z'A Z Sigma,   B~ = Sigma^-1 Z'B,   A~ + A~' = -B~ B~'
 *
 * For Krylov vectors of A^-1 the operator is G = A~^-1 with b = G B~, for which
 * G + G' = -b b'; then A_r = (P'G P)^-1, whose moments about 0 Hz are those of
 * A, not its Markov parameters. With the observability Gramian the same is
 * applied to (A', C').
 *
 * The residual A~ + A~' + B~ B~' is rounding, and is measured: the range is cut
 * until it is small against the least damping, and vectors whose poles it could
 * still move across the axis are left out (on A^-1, where an odd number of them
 * has one pole far out).
 */

/* A system, or its dual (A', C') as (A, B), and its reduction. */
typedef struct one_sided {
    ritz_dense A, B;
    double damping; /* least -Re s of A */
    ritz_gramian_range range;
    ritz_dense G, b;   /* operator and start, in the range */
    double rounding;   /* |G + G' + b b'| */
    ritz_dense P;      /* range x number of vectors */
    int64_t uncertain; /* vectors left out at the end */
} one_sided;

static void release_one_sided(one_sided *s)
{
    ritz_dense_free(&s->A);
    ritz_dense_free(&s->B);
    free_gramian_range(&s->range);
    ritz_dense_free(&s->G);
    ritz_dense_free(&s->b);
    ritz_dense_free(&s->P);
}

static ritz_status start_one_sided(const ritz_request *request,
                                   const ritz_states *states, one_sided *s)
{
    bool outputs = request->choice.gramian == RITZ_GRAMIAN_OUTPUTS;

    RITZ_REFUSE_IF(
        (outputs ? states->C.nrow : states->B.ncol) == 0, RITZ_ERR_ARGUMENT,
        "the component has no %s, and the Gramian of %s is none",
        outputs ? "outputs" : "inputs", outputs ? "outputs" : "inputs");
    if (outputs) {
        RITZ_CHECK(ritz_general_transpose(&states->A, &s->A));
        RITZ_CHECK(ritz_general_transpose(&states->C, &s->B));
    } else {
        RITZ_CHECK(ritz_dense_copy(&states->A, &s->A));
        RITZ_CHECK(ritz_dense_copy(&states->B, &s->B));
    }
    return RITZ_OK;
}

/* A Gramian is finite if every pole is stable, those of A less the shift. */
static ritz_status check_poles(const ritz_states *states, one_sided *s)
{
    RITZ_OWN(ritz_eigenvalues) poles = {0};
    int64_t k = 0;
    double growth = 0.0;
    double rounding = 0.0;

    RITZ_CHECK(ritz_eigenvalues_of(&s->A, &poles));
    k = ritz_eigenvalues_worst(&poles, RITZ_POLE_BOUND_FACTOR);
    s->damping = -poles.re[k];
    growth = poles.re[k] + states->alpha;
    rounding = RITZ_POLE_BOUND_FACTOR * poles.error[k];
    RITZ_REFUSE_IF(s->damping <= rounding &&
                       (s->damping < -rounding || states->alpha > 0.0),
                   RITZ_ERR_ARGUMENT,
                   "a pole grows at %.4g rad/s (%.4g Hz), the Gramian is "
                   "infinite: shift by more than that",
                   growth, growth / (2.0 * RITZ_PI));
    RITZ_REFUSE_IF(s->damping <= rounding, RITZ_ERR_ARGUMENT,
                   "the Gramian is infinite: motion at %.4g Hz has no damping, "
                   "give some or a shift above 0 Hz",
                   hypot(poles.re[k], poles.im[k]) / (2.0 * RITZ_PI));
    return RITZ_OK;
}

/* G and b, restricted to where the Gramian is more than rounding. */
static ritz_status choose_operator(const ritz_request *request, one_sided *s)
{
    const ritz_gramian_range *range = &s->range;

    RITZ_CHECK(find_gramian_range(&s->A, &s->B, request->tolerance,
                                  RITZ_LANCZOS_SMALL * s->damping, &s->range));
    RITZ_CHECK(ritz_states_operator(&range->A, request->choice.inverse, &s->G));
    if (request->choice.inverse)
        RITZ_CHECK(ritz_dense_mul(&s->G, &range->B, &s->b));
    else
        RITZ_CHECK(ritz_dense_copy(&range->B, &s->b));
    s->rounding = gramian_defect(&s->G, &s->b);
    return RITZ_OK;
}

/* P, with the requested number of columns or as many as there are. */
static ritz_status find_vectors(const ritz_request *request, one_sided *s)
{
    int64_t first = 0;
    RITZ_OWN(ritz_orthonormal) P = {0};
    RITZ_OWN(ritz_dense) X = {0};

    RITZ_CHECK(ritz_orthonormal_new(s->G.nrow, NULL, request->tolerance, &P));
    RITZ_CHECK(ritz_dense_copy(&s->b, &X));
    do {
        ritz_dense last = {0};

        first = P.count;
        RITZ_CHECK(
            ritz_orthonormal_append(&P, &X, request->modes - first, NULL));
        ritz_dense_free(&X);
        last = ritz_dense_part(&P.V, first, P.count - first);
        RITZ_CHECK(ritz_dense_mul(&s->G, &last, &X));
    } while (P.count > first && P.count < request->modes);
    return ritz_dense_columns(&P.V, 0, P.count, &s->P);
}

/* P'G P of the first columns. */
static ritz_status reduce_operator(const one_sided *s, int64_t columns,
                                   ritz_dense *out)
{
    const ritz_dense P = ritz_dense_part(&s->P, 0, columns);
    RITZ_OWN(ritz_dense) GP = {0};

    RITZ_CHECK(ritz_dense_mul(&s->G, &P, &GP));
    return ritz_dense_mul_tn(&P, &GP, out);
}

/*
 * Leave out last vectors until no pole can be moved across the axis by
 * rounding.
 */
static ritz_status drop_uncertain(one_sided *s, ritz_dense *Gr)
{
    RITZ_OWN(ritz_eigenvalues) poles = {0};
    bool certain = false;

    while (s->P.ncol > 0 && !certain) {
        int64_t k = 0;

        ritz_dense_free(Gr);
        ritz_eigenvalues_free(&poles);
        RITZ_CHECK(reduce_operator(s, s->P.ncol, Gr));
        RITZ_CHECK(ritz_eigenvalues_of(Gr, &poles));
        k = ritz_eigenvalues_worst(&poles, RITZ_POLE_BOUND_FACTOR);
        certain = poles.re[k] < -RITZ_POLE_BOUND_FACTOR * poles.error[k] &&
                  poles.re[k] < -RITZ_LANCZOS_SAFE * s->rounding;
        if (!certain) {
            s->P.ncol--;
            s->uncertain++;
        }
    }
    RITZ_REFUSE_IF(s->P.ncol == 0, RITZ_ERR_CONVERGENCE,
                   "no states are left whose stability rounding leaves alone");
    return RITZ_OK;
}

/*
 * T = Z Sigma P and W = Z Sigma^-1 P; for A^-1 the latter is Z Sigma^-1 G'P
 * (P'G P)^-T, with which W'A T = (P'G P)^-1.
 */
static ritz_status find_bases(const one_sided *s, bool inverse,
                              const ritz_dense *Gr, ritz_dense *own,
                              ritz_dense *other)
{
    RITZ_OWN(ritz_dense) GP = {0}, Y = {0};

    RITZ_CHECK(ritz_dense_mul(&s->range.Q, &s->P, own));
    if (!inverse) {
        RITZ_CHECK(ritz_dense_mul(&s->range.V, &s->P, other));
        return RITZ_OK;
    }
    RITZ_CHECK(ritz_dense_mul_tn(&s->P, &s->G, &GP)); /* P'G */
    RITZ_CHECK(ritz_general_solve(Gr, false, &GP));
    RITZ_CHECK(ritz_general_transpose(&GP, &Y));
    return ritz_dense_mul(&s->range.V, &Y, other);
}

/* Say which requested vectors do not exist, and why. */
static void add_remark(const ritz_request *request, const one_sided *s,
                       ritz_basis *basis)
{
    const bool outputs = request->choice.gramian == RITZ_GRAMIAN_OUTPUTS;
    int64_t found = s->P.ncol + s->uncertain;
    char rounding[RITZ_NAME_SIZE] = "";
    char uncertain[RITZ_NAME_SIZE] = "";

    if (s->G.nrow < s->range.reached)
        snprintf(rounding, sizeof rounding,
                 ", %" PRId64 " of them above rounding", s->G.nrow);
    if (s->uncertain > 0)
        snprintf(uncertain, sizeof uncertain,
                 "; of the last %" PRId64 " rounding would decide",
                 s->uncertain);
    if (found < request->modes)
        snprintf(basis->remark, sizeof basis->remark,
                 "%" PRId64 " states asked for: the %s %" PRId64 " of %" PRId64
                 "%s; there are %" PRId64 "%s",
                 request->modes, outputs ? "outputs see" : "inputs reach",
                 s->range.reached, s->A.nrow, rounding, s->P.ncol, uncertain);
    else if (s->uncertain > 0)
        snprintf(basis->remark, sizeof basis->remark,
                 "the last %" PRId64 " state(s) left out: rounding would "
                 "decide on their stability",
                 s->uncertain);
}

static ritz_status make_one_sided(const ritz_request *request, ritz_basis *out)
{
    ritz_status status = RITZ_OK;
    bool inverse = request->choice.inverse;
    bool outputs = request->choice.gramian == RITZ_GRAMIAN_OUTPUTS;
    ritz_states states = {0};
    one_sided s = {0};
    ritz_dense Gr = {0}, own = {0}, other = {0};

    RITZ_TRY(ritz_states_asked(request, &states));
    RITZ_TRY(start_one_sided(request, &states, &s));
    RITZ_TRY(check_poles(&states, &s));
    RITZ_TRY(choose_operator(request, &s));
    RITZ_TRY(find_vectors(request, &s));
    RITZ_TRY(drop_uncertain(&s, &Gr));
    RITZ_TRY(find_bases(&s, inverse, &Gr, &own, &other));
    RITZ_TRY(ritz_states_basis(&states, outputs ? &other : &own,
                               outputs ? &own : &other, out));
    snprintf(out->origin.engine, sizeof out->origin.engine,
             "dense LAPACK + SLICOT");
    add_remark(request, &s, out);
done:
    ritz_states_free(&states);
    release_one_sided(&s);
    ritz_dense_free(&Gr);
    ritz_dense_free(&own);
    ritz_dense_free(&other);
    return status;
}

const ritz_method ritz_method_lanczos_one_sided = {
    .name = "lanczos-one-sided",
    .summary = "Lanczos vectors of states, stable by construction",
    .reference = "CraigSuKim1992",
    .when = "small damped models for control, in states",
    .cost = "a dense Gramian: O(n^3), 1500 states",
    .holds = "stability, whatever the order",
    .fails = "free bodies; what a Gramian does not see",
    .uses = RITZ_USES_MODES | RITZ_USES_SHIFTS | RITZ_USES_GRAMIAN |
            RITZ_USES_OPERATOR | RITZ_USES_DAMPING,
    .make = make_one_sided,
};
