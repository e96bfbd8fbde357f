/*
 * Two-sided block Lanczos: right vectors from B and left ones from C',
 *
 *     W'V = I,   W'A V block tridiagonal,
 *
 * spanning [B, A B, ...] and [C', A'C', ...] [KimCraig1988], [CraigSuKim1992,
 * section 5]. With k full blocks on both sides the reduced model keeps the
 * first 2k Markov parameters. With A^-1 as operator it keeps the first 2k
 * moments about 0 Hz: A is then reduced to (W'A^-1 V)^-1, by left vectors that
 * invert_left changes accordingly.
 *
 * The reduced model may be unstable. The method is included to demonstrate
 * that, and the stability check reports it. Vectors are biorthogonalised
 * against all others, in two passes, so that failures are due to the method and
 * not to rounding.
 *
 * A step pairs orthonormal candidates X and Y by Y'X = L diag(s) R': the new
 * vectors are X R s^-1/2 and Y L s^-1/2 for each s above the tolerance.
 * Directions that are not paired stay candidates for the next block. If none is
 * paired the method ends with a serious breakdown, unless one side is
 * exhausted.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "bases/columns.h"
#include "bases/lanczos.h"
#include "bases/space.h"
#include "linear/general.h"
#include "linear/orthonormal.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

ritz_status ritz_lanczos_shift(const ritz_choice *choice, double *alpha)
{
    RITZ_REFUSE_IF(choice->num_shifts > 1, RITZ_ERR_ARGUMENT,
                   "the states are shifted by one frequency, not by several");
    *alpha = choice->num_shifts > 0 ? 2.0 * RITZ_PI * choice->shift_hz[0] : 0.0;
    return RITZ_OK;
}

ritz_status ritz_lanczos_states(const ritz_request *request, ritz_states *out)
{
    ritz_damping damping = {0};
    double alpha = 0.0;

    RITZ_CHECK(ritz_states_asked(request));
    RITZ_CHECK(ritz_lanczos_shift(&request->choice, &alpha));
    RITZ_CHECK(ritz_request_damping(request, &damping));
    return ritz_states_new(request->component, &damping, alpha, out);
}

ritz_status ritz_lanczos_operator(const ritz_dense *A, const ritz_dense *B,
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

/* How the sequence of blocks ended. */
typedef enum ending {
    COMPLETE,  /* as many vectors as requested */
    EXHAUSTED, /* the vectors span all controllable, or all observable states */
    BREAKDOWN, /* both sides have candidates left, but these are orthogonal */
} ending;

/* One side: its vectors, and candidates for the next block. */
typedef struct lanczos_side {
    ritz_dense vectors; /* room for as many columns as requested */
    ritz_dense next;    /* operator times the last block; at first the starting
                           block */
    ritz_dense waiting; /* candidates that were not paired */
} lanczos_side;

typedef struct two_sided {
    ritz_dense G; /* operator, A or A^-1 */
    lanczos_side right, left;
    int64_t used; /* number of vectors found on each side */
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

/* All candidates, scaled to unit length; zero ones stay zero. */
static ritz_status gather_candidates(const lanczos_side *s, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_beside(&s->next, &s->waiting, out));
    for (int64_t j = 0; j < out->ncol; j++)
        (void)ritz_general_unit(out->nrow, ritz_dense_col(out, j));
    return RITZ_OK;
}

/*
 * Orthonormal candidates, biorthogonalised against the vectors found so far,
 * without dependent ones.
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
    RITZ_CHECK(ritz_dense_take_out(&V, &W, &X)); /* a second pass suffices */
    RITZ_CHECK(ritz_general_svd(&X, &U, &s, NULL));
    while (rank < U.ncol && s[rank] > tolerance)
        rank++;
    return ritz_dense_columns(&U, 0, rank, out);
}

/* The first columns of X R s^-1/2 become vectors; the other columns of X R
   wait. */
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

/* Pair candidates X of the right side with Y of the left; *joined may be 0. */
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

/* Operator times the last block, on both sides. */
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

/* Starting blocks: B, or A^-1 B with the inverse operator, and C'. */
static ritz_status start_blocks(const ritz_request *request,
                                const ritz_states *states, two_sided *t)
{
    int64_t n = states->count;
    int64_t most = request->modes < n ? request->modes : n;

    RITZ_REFUSE_IF(states->B.ncol == 0 || states->C.nrow == 0,
                   RITZ_ERR_ARGUMENT,
                   "the component has no %s, vectors of both sides need some",
                   states->B.ncol == 0 ? "inputs" : "outputs");
    RITZ_CHECK(ritz_lanczos_operator(&states->A, &states->B,
                                     request->choice.inverse, &t->G,
                                     &t->right.next));
    RITZ_CHECK(ritz_general_transpose(&states->C, &t->left.next));
    RITZ_CHECK(ritz_dense_new(n, most, &t->right.vectors));
    return ritz_dense_new(n, most, &t->left.vectors);
}

/* Refuse a sequence that ended before its first block. */
static ritz_status check_start(const ritz_request *request, const two_sided *t)
{
    RITZ_REFUSE_IF(t->used == 0 && t->end == EXHAUSTED, RITZ_ERR_ARGUMENT,
                   "no flexible state is both controllable and observable");
    RITZ_REFUSE_IF(
        t->used == 0 && !request->choice.inverse, RITZ_ERR_SINGULAR,
        "serious breakdown at the first block: C B is zero, no output follows "
        "an input at once, and displacements never do; the inverse operator "
        "begins with the static response");
    RITZ_REFUSE_IF(t->used == 0, RITZ_ERR_SINGULAR,
                   "serious breakdown at the first block: C A^-1 B is zero, no "
                   "output has a static response");
    return RITZ_OK;
}

/* With A^-1 as operator G: W := G'W (W'G V)^-T, so that W'A V = (W'G V)^-1. */
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

    RITZ_CHECK(ritz_lanczos_states(request, &states));
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
