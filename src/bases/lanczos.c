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

#include "base/alloc.h"
#include "base/tolerances.h"
#include "bases/columns.h"
#include "gramians/modes.h"
#include "linear/general.h"
#include "linear/orthonormal.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* The component of the request in states, less the shift. */
static ritz_status find_states(const ritz_request *request, ritz_states *out)
{
    const ritz_choice *choice = &request->choice;
    ritz_damping damping = {0};
    double alpha = 0.0;

    RITZ_REFUSE_IF(request->up_to_hz > 0.0, RITZ_ERR_ARGUMENT,
                   "states are asked for by their number, not by a frequency: "
                   "--modes, not --up-to-hz");
    RITZ_REFUSE_IF(request->modes < 1, RITZ_ERR_ARGUMENT,
                   "no states are asked for, one at least is needed: --modes");
    RITZ_REFUSE_IF(choice->num_shifts > 1, RITZ_ERR_ARGUMENT,
                   "the states are shifted by one frequency, not by several");
    RITZ_CHECK(ritz_request_damping(request, &damping));
    if (choice->num_shifts > 0)
        alpha = 2.0 * RITZ_PI * choice->shift_hz[0];
    return ritz_states_new(request->component, &damping, alpha, out);
}

/* G = A and b = B, or G = A^-1 and b = G B if @p inverse. */
static ritz_status choose_operator(const ritz_dense *A, const ritz_dense *B,
                                   bool inverse, ritz_dense *G, ritz_dense *b)
{
    ritz_status status = RITZ_OK;

    if (!inverse) {
        RITZ_CHECK(ritz_dense_copy(A, G));
        return ritz_dense_copy(B, b);
    }
    RITZ_CHECK(ritz_dense_identity(A->nrow, G));
    status = ritz_general_solve(A, false, G);
    RITZ_REFUSE_IF(status == RITZ_ERR_SINGULAR, RITZ_ERR_SINGULAR,
                   "the matrix of states has no inverse: a motion that nothing "
                   "holds, give a shift above 0 Hz");
    RITZ_CHECK(status);
    return ritz_dense_mul(G, B, b);
}

/*
 * A system, or its dual (A', C') as (A, B), and its reduction. With the Gramian
 * W = U U' and U = Z Sigma X', cut to r values: Q = Z Sigma, V = Z Sigma^-1.
 */
typedef struct one_sided {
    ritz_dense A, B;
    double damping;      /* least -Re s of A */
    int64_t reached;     /* values of U above the tolerance */
    ritz_dense Q, V;     /* n x r, r <= reached: as rounding allows */
    ritz_dense A_r, B_r; /* V'A Q, V'B */
    ritz_dense G, b;     /* operator and start, r x r and r x inputs */
    double rounding;     /* |G + G' + b b'| */
    ritz_dense P;        /* r x number of vectors */
    int64_t uncertain;   /* vectors left out at the end */
} one_sided;

static void one_sided_free(one_sided *s)
{
    ritz_dense *const all[9] = {&s->A,   &s->B, &s->Q, &s->V, &s->A_r,
                                &s->B_r, &s->G, &s->b, &s->P};

    for (int k = 0; k < 9; k++)
        ritz_dense_free(all[k]);
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
        return ritz_general_transpose(&states->C, &s->B);
    }
    RITZ_CHECK(ritz_dense_copy(&states->A, &s->A));
    return ritz_dense_copy(&states->B, &s->B);
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

/* Q, V, A_r and B_r of the first r values. */
static ritz_status transform_system(const ritz_dense *Z, const double *sigma,
                                    int64_t r, one_sided *s)
{
    RITZ_OWN(ritz_dense) AQ = {0};

    ritz_dense_free(&s->Q);
    ritz_dense_free(&s->V);
    ritz_dense_free(&s->A_r);
    ritz_dense_free(&s->B_r);
    RITZ_CHECK(scale_columns(Z, sigma, r, 1.0, &s->Q));
    RITZ_CHECK(scale_columns(Z, sigma, r, -1.0, &s->V));
    RITZ_CHECK(ritz_dense_mul(&s->A, &s->Q, &AQ));
    RITZ_CHECK(ritz_dense_mul_tn(&s->V, &AQ, &s->A_r));
    return ritz_dense_mul_tn(&s->V, &s->B, &s->B_r);
}

/*
 * The controllable states of the Gramian, in coordinates in which it is I, cut
 * until its rounding is small against the least damping.
 *
 * @return RITZ_ERR_ARGUMENT if the Gramian is zero, or a pole is not stable;
 *         RITZ_ERR_CONVERGENCE if nothing is left
 */
static ritz_status find_range(double tolerance, one_sided *s)
{
    RITZ_OWN(ritz_dense) U = {0}, Z = {0};
    RITZ_OWN_ARRAY double *sigma = NULL;
    int64_t n = s->A.nrow;
    int64_t r = 0;
    double least = fmax(tolerance, (double)n * DBL_EPSILON);
    double norm = 0.0;

    RITZ_CHECK(ritz_general_gramian(&s->A, &s->B, &U));
    RITZ_CHECK(ritz_general_svd(&U, &Z, &sigma, NULL));
    while (s->reached < n && sigma[s->reached] > least * sigma[0])
        s->reached++;
    RITZ_REFUSE_IF(s->reached == 0, RITZ_ERR_ARGUMENT,
                   "no flexible state is controllable, the Gramian is zero: do "
                   "the inputs and outputs act on rigid motion alone?");
    RITZ_CHECK(transform_system(&Z, sigma, s->reached, s));
    r = count_accurate(&s->A_r, &s->B_r, RITZ_LANCZOS_SMALL * s->damping,
                       &norm);
    RITZ_REFUSE_IF(r == 0, RITZ_ERR_CONVERGENCE,
                   "rounding of the Gramian is as large as the least damping");
    return r < s->reached ? transform_system(&Z, sigma, r, s) : RITZ_OK;
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

    RITZ_CHECK(ritz_dense_mul(&s->Q, &s->P, own));
    if (!inverse) {
        RITZ_CHECK(ritz_dense_mul(&s->V, &s->P, other));
        return RITZ_OK;
    }
    RITZ_CHECK(ritz_dense_mul_tn(&s->P, &s->G, &GP)); /* P'G */
    RITZ_CHECK(ritz_general_solve(Gr, false, &GP));
    RITZ_CHECK(ritz_general_transpose(&GP, &Y));
    return ritz_dense_mul(&s->V, &Y, other);
}

/* Say which requested vectors do not exist, and why. */
static void add_remark(const ritz_request *request, const one_sided *s,
                       ritz_basis *basis)
{
    const bool outputs = request->choice.gramian == RITZ_GRAMIAN_OUTPUTS;
    int64_t found = s->P.ncol + s->uncertain;
    char rounding[RITZ_NAME_SIZE] = "";
    char uncertain[RITZ_NAME_SIZE] = "";

    if (s->G.nrow < s->reached)
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
                 request->modes, outputs ? "outputs observe" : "inputs control",
                 s->reached, s->A.nrow, rounding, s->P.ncol, uncertain);
    else if (s->uncertain > 0)
        snprintf(basis->remark, sizeof basis->remark,
                 "the last %" PRId64 " state(s) left out: rounding would "
                 "decide on their stability",
                 s->uncertain);
}

static ritz_status make_one_sided(const ritz_request *request, ritz_basis *out)
{
    bool inverse = request->choice.inverse;
    bool outputs = request->choice.gramian == RITZ_GRAMIAN_OUTPUTS;
    RITZ_OWN(ritz_states) states = {0};
    RITZ_OWN(one_sided) s = {0};
    RITZ_OWN(ritz_dense) Gr = {0}, own = {0}, other = {0};

    RITZ_CHECK(find_states(request, &states));
    RITZ_CHECK(start_one_sided(request, &states, &s));
    RITZ_CHECK(check_poles(&states, &s));
    RITZ_CHECK(find_range(request->tolerance, &s));
    RITZ_CHECK(choose_operator(&s.A_r, &s.B_r, inverse, &s.G, &s.b));
    (void)count_accurate(&s.G, &s.b, HUGE_VAL, &s.rounding);
    RITZ_CHECK(find_vectors(request, &s));
    RITZ_CHECK(drop_uncertain(&s, &Gr));
    RITZ_CHECK(find_bases(&s, inverse, &Gr, &own, &other));
    RITZ_CHECK(ritz_states_basis(&states, outputs ? &other : &own,
                                 outputs ? &own : &other, out));
    snprintf(out->origin.engine, sizeof out->origin.engine,
             "dense LAPACK + SLICOT");
    add_remark(request, &s, out);
    return RITZ_OK;
}

const ritz_method ritz_method_lanczos_one_sided = {
    .name = "lanczos-one-sided",
    .summary = "Lanczos vectors of states, stable by construction",
    .reference = "CraigSuKim1992",
    .when = "small damped models for control, in states",
    .cost = "a dense Gramian: O(n^3), 1500 states",
    .holds = "stability, whatever the order",
    .fails = "free bodies; states that are not controllable",
    .uses = RITZ_USES_MODES | RITZ_USES_SHIFTS | RITZ_USES_GRAMIAN |
            RITZ_USES_OPERATOR | RITZ_USES_DAMPING,
    .make = make_one_sided,
};

/*
 * Two-sided block Lanczos: right vectors from B and left ones from C',
 *
 *     W'V = I,   W'A V block tridiagonal,
 *
 * spanning [B, A B, ...] and [C', A'C', ...] [KimCraig1988], [CraigSuKim1992,
 * section 5]. Of k full blocks on both sides the first 2k Markov parameters are
 * kept; on A^-1 the first 2k moments about 0 Hz, the reduced model being
 * (W'A^-1 V)^-1, with left vectors to that end.
 *
 * The reduced model may be unstable: this method is kept to show that, and the
 * stability check reports it. So that failures are due to the method alone,
 * vectors are biorthogonalised against all others, twice.
 *
 * A step joins candidates X and Y, orthonormal, by Y'X = L diag(s) R': vectors
 * are X R s^-1/2 and Y L s^-1/2 where s is above the tolerance. Directions of
 * either side that are not paired wait for the next block. If none is paired
 * the method ends: this is a serious breakdown, unless one side is exhausted.
 */
/* How a sequence of blocks ends. */
typedef enum ending {
    COMPLETE,  /* as many vectors as were asked for */
    EXHAUSTED, /* the controllable, or the observable states are spanned */
    BREAKDOWN, /* both have more, but orthogonal to each other */
} ending;

/* One side: vectors so far, and candidates for the next block. */
typedef struct lanczos_side {
    ritz_dense vectors; /* as many columns as are asked for */
    ritz_dense next;    /* operator times the last block; the start at first */
    ritz_dense waiting; /* candidates that were not paired */
} lanczos_side;

typedef struct two_sided {
    ritz_dense G; /* A or A^-1 */
    lanczos_side right, left;
    int64_t used; /* columns of both sides' vectors */
    ending end;
} two_sided;

static void two_sided_free(two_sided *t)
{
    lanczos_side *const sides[] = {&t->right, &t->left};

    ritz_dense_free(&t->G);
    for (int k = 0; k < 2; k++) {
        ritz_dense_free(&sides[k]->vectors);
        ritz_dense_free(&sides[k]->next);
        ritz_dense_free(&sides[k]->waiting);
    }
}

/* All candidates, each of unit length or zero. */
static ritz_status gather_candidates(const lanczos_side *s, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_beside(&s->next, &s->waiting, out));
    for (int64_t j = 0; j < out->ncol; j++) {
        double *x = ritz_dense_col(out, j);
        double size = 0.0;

        for (int64_t i = 0; i < out->nrow; i++)
            size = hypot(size, x[i]);
        for (int64_t i = 0; size > 0.0 && i < out->nrow; i++)
            x[i] /= size;
    }
    return RITZ_OK;
}

/*
 * Candidates, orthogonal to the vectors so far and orthonormal; dependent ones
 * left out.
 */
static ritz_status prepare_candidates(const lanczos_side *own,
                                      const lanczos_side *other, int64_t used,
                                      double tolerance, ritz_dense *out)
{
    const ritz_dense V = ritz_dense_part(&own->vectors, 0, used);
    const ritz_dense W = ritz_dense_part(&other->vectors, 0, used);
    RITZ_OWN(ritz_dense) X = {0}, U = {0};
    RITZ_OWN_ARRAY double *s = NULL;
    int64_t rank = 0;

    RITZ_CHECK(gather_candidates(own, &X));
    RITZ_CHECK(ritz_dense_take_out(&V, &W, &X));
    RITZ_CHECK(ritz_dense_take_out(&V, &W, &X)); /* twice is enough */
    RITZ_CHECK(ritz_general_svd(&X, &U, &s, NULL));
    while (rank < U.ncol && s[rank] > tolerance)
        rank++;
    return ritz_dense_columns(&U, 0, rank, out);
}

/* X R s^-1/2 of the first columns become vectors, the others wait. */
static ritz_status accept_vectors(const ritz_dense *X, const ritz_dense *R,
                                  const double *s, int64_t joined, int64_t used,
                                  lanczos_side *own)
{
    RITZ_OWN(ritz_dense) turned = {0};

    RITZ_CHECK(ritz_dense_mul(X, R, &turned));
    for (int64_t j = 0; j < joined; j++)
        for (int64_t i = 0; i < turned.nrow; i++)
            ritz_dense_col(&own->vectors, used + j)[i] =
                ritz_dense_col(&turned, j)[i] / sqrt(s[j]);
    ritz_dense_free(&own->waiting);
    return ritz_dense_columns(&turned, joined, turned.ncol - joined,
                              &own->waiting);
}

/* Pair candidates X of the right and Y of the left; possibly none. */
static ritz_status pair_candidates(const ritz_dense *X, const ritz_dense *Y,
                                   double tolerance, two_sided *t,
                                   int64_t *joined)
{
    int64_t most = t->right.vectors.ncol - t->used;
    RITZ_OWN(ritz_dense) YX = {0}, L = {0}, R = {0};
    RITZ_OWN_ARRAY double *s = NULL;

    *joined = 0;
    RITZ_CHECK(ritz_dense_mul_tn(Y, X, &YX));
    RITZ_CHECK(ritz_general_svd(&YX, &L, &s, &R));
    while (*joined < most && *joined < L.ncol && *joined < R.ncol &&
           s[*joined] > tolerance)
        ++*joined;
    RITZ_CHECK(accept_vectors(X, &R, s, *joined, t->used, &t->right));
    return accept_vectors(Y, &L, s, *joined, t->used, &t->left);
}

/* G times the last block, on either side. */
static ritz_status advance_blocks(two_sided *t, int64_t joined)
{
    const ritz_dense right =
        ritz_dense_part(&t->right.vectors, t->used, joined);
    const ritz_dense left = ritz_dense_part(&t->left.vectors, t->used, joined);

    ritz_dense_free(&t->right.next);
    ritz_dense_free(&t->left.next);
    RITZ_CHECK(ritz_dense_mul(&t->G, &right, &t->right.next));
    RITZ_CHECK(ritz_dense_mul_tn(&t->G, &left, &t->left.next));
    t->used += joined;
    return RITZ_OK;
}

static ritz_status advance_step(double tolerance, two_sided *t, bool *going)
{
    RITZ_OWN(ritz_dense) X = {0}, Y = {0};
    int64_t joined = 0;

    RITZ_CHECK(prepare_candidates(&t->right, &t->left, t->used, tolerance, &X));
    RITZ_CHECK(prepare_candidates(&t->left, &t->right, t->used, tolerance, &Y));
    *going = X.ncol > 0 && Y.ncol > 0;
    t->end = EXHAUSTED;
    if (!*going)
        return RITZ_OK;
    RITZ_CHECK(pair_candidates(&X, &Y, tolerance, t, &joined));
    RITZ_CHECK(advance_blocks(t, joined));
    t->end = joined > 0 ? COMPLETE : BREAKDOWN;
    *going = joined > 0 && t->used < t->right.vectors.ncol;
    return RITZ_OK;
}

/* Right start B, or A^-1 B; left start C'. */
static ritz_status start_blocks(const ritz_request *request,
                                const ritz_states *states, two_sided *t)
{
    int64_t n = states->count;
    int64_t most = request->modes < n ? request->modes : n;

    RITZ_REFUSE_IF(states->B.ncol == 0 || states->C.nrow == 0,
                   RITZ_ERR_ARGUMENT,
                   "the component has no %s, vectors of both sides need some",
                   states->B.ncol == 0 ? "inputs" : "outputs");
    RITZ_CHECK(choose_operator(&states->A, &states->B, request->choice.inverse,
                               &t->G, &t->right.next));
    RITZ_CHECK(ritz_general_transpose(&states->C, &t->left.next));
    RITZ_CHECK(ritz_dense_new(n, most, &t->right.vectors));
    return ritz_dense_new(n, most, &t->left.vectors);
}

/* A first block is required. */
static ritz_status check_start(const ritz_request *request, const two_sided *t)
{
    RITZ_REFUSE_IF(t->used == 0 && t->end == EXHAUSTED, RITZ_ERR_ARGUMENT,
                   "no flexible state is both controllable and observable");
    RITZ_REFUSE_IF(
        t->used == 0 && !request->choice.inverse, RITZ_ERR_SINGULAR,
        "serious breakdown at the first block: C B is zero, no output "
        "moves at once, as those of displacement never do; the "
        "inverse operator begins with the static response");
    RITZ_REFUSE_IF(t->used == 0, RITZ_ERR_SINGULAR,
                   "serious breakdown at the first block: C A^-1 B is zero, no "
                   "output has a static response");
    return RITZ_OK;
}

/* On A^-1: W := G'W (W'G V)^-T, with which W'A V = (W'G V)^-1. */
static ritz_status invert_left(two_sided *t)
{
    RITZ_OWN(ritz_dense) WG = {0}, Gr = {0};
    ritz_status status = RITZ_OK;

    RITZ_CHECK(ritz_dense_mul_tn(&t->left.vectors, &t->G, &WG));
    RITZ_CHECK(ritz_dense_mul(&WG, &t->right.vectors, &Gr));
    status = ritz_general_solve(&Gr, false, &WG);
    RITZ_REFUSE_IF(status == RITZ_ERR_SINGULAR, RITZ_ERR_SINGULAR,
                   "breakdown: with %" PRId64
                   " states the reduced A^-1 is singular, ask for another "
                   "number",
                   t->used);
    RITZ_CHECK(status);
    ritz_dense_free(&t->left.vectors);
    return ritz_general_transpose(&WG, &t->left.vectors);
}

static void add_end(const ritz_request *request, const two_sided *t,
                    ritz_basis *basis)
{
    if (t->used >= request->modes)
        return;
    snprintf(basis->remark, sizeof basis->remark,
             t->end == BREAKDOWN
                 ? "%" PRId64 " states asked for: serious breakdown after "
                   "%" PRId64 ", what is left on both sides is orthogonal"
                 : "%" PRId64 " states asked for: %" PRId64
                   " are controllable and observable",
             request->modes, t->used);
}

static ritz_status make_two_sided(const ritz_request *request, ritz_basis *out)
{
    RITZ_OWN(ritz_states) states = {0};
    RITZ_OWN(two_sided) t = {0};
    bool going = true;

    RITZ_CHECK(find_states(request, &states));
    RITZ_CHECK(start_blocks(request, &states, &t));
    while (going)
        RITZ_CHECK(advance_step(request->tolerance, &t, &going));
    RITZ_CHECK(check_start(request, &t));
    t.right.vectors.ncol = t.left.vectors.ncol = t.used;
    if (request->choice.inverse)
        RITZ_CHECK(invert_left(&t));
    RITZ_CHECK(
        ritz_states_basis(&states, &t.right.vectors, &t.left.vectors, out));
    add_end(request, &t, out);
    return RITZ_OK;
}

const ritz_method ritz_method_lanczos_two_sided = {
    .name = "lanczos-two-sided",
    .summary = "left and right Lanczos vectors of states; often unstable",
    .reference = "KimCraig1988",
    .when = "to compare with",
    .cost = "as lanczos-one-sided",
    .holds = "moments, twice as many as one-sided",
    .fails = "instability and breakdown, often with outputs elsewhere",
    .uses = RITZ_USES_MODES | RITZ_USES_SHIFTS | RITZ_USES_OPERATOR |
            RITZ_USES_DAMPING,
    .make = make_two_sided,
};
