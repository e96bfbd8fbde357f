#include "modes.h"

#include "assess.h"
#include "base/alloc.h"
#include "base/tolerances.h"
#include "blocks.h"
#include "krylov.h"
#include "lanczos.h"
#include "linear/first_shift.h"
#include "linear/requested.h"
#include "ranks.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* The numbers of src/linear/eigen_sparse.c, where they are explained. */
enum { ATTEMPTS = 12, BODY = 6, GUESS = 20, BEHIND = 2, SPARE = 4 };
enum { MISSES = 3, POLISHES = 3 };

typedef struct rank_search {
    rank_pencil *p;
    const ritz_span *span;
    double limit;
    int64_t target;
    double sigma;  /* shift of the iteration; a count factors at other values */
    double broken; /* -sigma at which the factor broke down */
    int64_t ask, misses;
    bool indefinite; /* the lowest eigenvalue is negative */
    bool by_blocks;  /* block Lanczos found them, not Krylov-Schur */
    modes found;
} rank_search;

static void rank_search_free(rank_search *s)
{
    modes_free(&s->found);
}

void modes_free(modes *m)
{
    ritz_pairs_free(&m->pairs);
    ranks_expect(MatDestroy(&m->X));
}

/* --- shifts --------------------------------------------------------------- */

ritz_status modes_foresee(rank_pencil *p, const ritz_span *span, double *limit,
                          int64_t *target)
{
    const double above[] = RITZ_COUNT_ABOVE;
    const double lambda = ritz_eigen_lambda(span->up_to_hz);
    ritz_status status = RITZ_ERR_SINGULAR;

    *limit = 0.0;
    *target = 0;
    if (span->modes >= 0)
        return RITZ_OK;
    *limit = lambda * (1.0 + above[0]);
    *target = BODY + GUESS;
    if (span->uncounted)
        return RITZ_OK;
    for (size_t i = 0; i < 3 && status == RITZ_ERR_SINGULAR; i++) {
        *limit = lambda * (1.0 + above[i]);
        status = rank_pencil_count(p, *limit, target);
    }
    return status;
}

/* Factor K - sigma M, and refuse it if an eigenvalue is below sigma. */
static ritz_status factor_below(void *pencil, double sigma)
{
    rank_pencil *p = pencil;

    RITZ_CHECK(rank_pencil_factor(p, sigma));
    RITZ_REFUSE_IF(p->negative > 0, RITZ_ERR_SINGULAR,
                   "stiffness and mass together are not positive definite");
    return RITZ_OK;
}

ritz_status modes_shift(rank_pencil *p, bool held, double limit)
{
    double sigma = -RITZ_FIRST_SHIFT * p->typical;

    if (held)
        return factor_below(p, 0.0);
    if (limit > 0.0)
        sigma = -fmax(fmin(-sigma, 0.1 * limit), -RITZ_LEAST_SHIFT * sigma);
    return ritz_first_factor(p->typical, sigma, factor_below, p);
}

/* --- pairs ---------------------------------------------------------------- */

/* Gather the whole matrix in rank 0. Other ranks get one without rows. */
static ritz_status gather_matrix(Mat A, ritz_sparse *out)
{
    const PetscInt *start = NULL;
    const PetscInt *column = NULL;
    const double *value = NULL;
    ritz_status status = RITZ_OK;
    PetscInt n = 0;
    PetscBool done = PETSC_FALSE;
    Mat *whole = NULL;
    IS all = NULL;

    ranks_expect(MatGetSize(A, &n, NULL));
    n = ranks_own() == 0 ? n : 0;
    ranks_expect(ISCreateStride(PETSC_COMM_SELF, n, 0, 1, &all));
    ranks_expect(
        MatCreateSubMatrices(A, 1, &all, &all, MAT_INITIAL_MATRIX, &whole));
    ranks_expect(MatGetRowIJ(whole[0], 0, PETSC_FALSE, PETSC_FALSE, &n, &start,
                             &column, &done));
    ranks_expect(MatSeqAIJGetArrayRead(whole[0], &value));
    status = ritz_sparse_new(n, n, n > 0 ? start[n] : 0, out);
    for (PetscInt j = 0; status == RITZ_OK && j < n; j++)
        for (PetscInt k = start[j]; k < start[j + 1]; k++) {
            out->rowind[k] = column[k];
            out->val[k] = value[k];
            out->colptr[j + 1] = k + 1;
        }
    for (PetscInt j = 0; status == RITZ_OK && j < n; j++)
        if (start[j + 1] == start[j])
            out->colptr[j + 1] = out->colptr[j];
    ranks_expect(MatSeqAIJRestoreArrayRead(whole[0], &value));
    ranks_expect(MatRestoreRowIJ(whole[0], 0, PETSC_FALSE, PETSC_FALSE, &n,
                                 &start, &column, &done));
    ranks_expect(MatDestroySubMatrices(1, &whole));
    ranks_expect(ISDestroy(&all));
    return status;
}

/* Broadcast the pairs that rank 0 has found alone, without their vectors. */
static ritz_status share_pairs(ritz_pairs *P)
{
    int64_t sizes[] = {P->Phi.ncol, P->num_rigid};
    double values[] = {P->sigma, P->proven_to};

    ranks_share(sizes, sizeof sizes);
    ranks_share(values, sizeof values);
    if (ranks_own() > 0) {
        P->lambda = ritz_zalloc(sizes[0], sizeof *P->lambda);
        P->residual = ritz_zalloc(sizes[0], sizeof *P->residual);
    }
    RANKS_CHECK(P->lambda && P->residual ? RITZ_OK : RITZ_ERR_MEMORY);
    ranks_share(P->lambda, sizes[0] * (int64_t)sizeof *P->lambda);
    ranks_share(P->residual, sizes[0] * (int64_t)sizeof *P->residual);
    P->Phi.ncol = sizes[0];
    P->num_rigid = sizes[1];
    P->sigma = values[0];
    P->proven_to = values[1];
    return RITZ_OK;
}

/* For so many modes that a Krylov space would be nearly the whole space, rank 0
   finds them as a single process does. */
static ritz_status find_alone(const rank_pencil *p, const ritz_span *span,
                              modes *out)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    ritz_status status = RITZ_OK;

    RANKS_CHECK(gather_matrix(p->K, &K));
    RANKS_CHECK(gather_matrix(p->M, &M));
    if (ranks_own() == 0)
        status = ritz_eigen_sparse(&K, &M, span, &pairs);
    RANKS_CHECK(status);
    RITZ_CHECK(share_pairs(&pairs));
    RITZ_MOVE(out->pairs, pairs);
    return RITZ_OK;
}

/* Whether the lowest eigenvalue is negative beyond its error, which is that of
   its residual. */
static bool is_negative(const ritz_pairs *P, const double *energy)
{
    return P->Phi.ncol > 0 && P->num_rigid == 0 &&
           P->lambda[0] < -P->residual[0] * energy[0];
}

/* Improve the pairs by inverse iteration until their residuals are small
   enough. The vectors are then M-orthonormal and the eigenvalues ascend. */
static ritz_status refine_pairs(rank_search *s)
{
    ritz_pairs *P = &s->found.pairs;
    RITZ_OWN(assessor) a = {0};
    RITZ_OWN_ARRAY double *energy = NULL;
    Mat X = s->found.X;
    double worst = HUGE_VAL;

    RANKS_CHECK_NEW(P->residual, P->Phi.ncol);
    RANKS_CHECK_NEW(energy, P->Phi.ncol);
    RITZ_CHECK(assessor_new(s->p->K, s->p->M, &a));
    if (s->by_blocks)
        RITZ_CHECK(assessor_residuals(&a, X, P, energy, &worst));
    for (int k = 0; k < POLISHES && !(worst <= RITZ_EIGEN_RESIDUAL); k++) {
        RITZ_CHECK(block_polish(s->p, X, P->lambda));
        RITZ_CHECK(assessor_residuals(&a, X, P, energy, &worst));
    }
    s->indefinite = is_negative(P, energy);
    if (s->indefinite)
        return RITZ_OK;
    RITZ_REFUSE_IF(!(worst <= RITZ_EIGEN_RESIDUAL), RITZ_ERR_CONVERGENCE,
                   "a residual of %.1e stays above %.0e", worst,
                   RITZ_EIGEN_RESIDUAL);
    return assessor_sharpen(&a, X, energy, P);
}

/* Number of Krylov vectors for so many pairs. */
static int64_t count_room(int64_t ask)
{
    return 2 * ask > ask + 20 ? 2 * ask : ask + 20;
}

/* Fill s->found. If too few pairs converge it stays empty, and s->ask grows. */
static ritz_status find_pairs(rank_search *s)
{
    ritz_pairs *P = &s->found.pairs;
    int64_t found = 0;

    modes_free(&s->found);
    if (s->p->sigma != s->sigma)
        RITZ_CHECK(factor_below(s->p, s->sigma));
    RITZ_CHECK(lanczos_lowest(s->p, s->ask, &s->found.X, &P->lambda, &found));
    s->by_blocks = found == s->ask;
    if (!s->by_blocks)
        RITZ_CHECK(krylov_lowest(s->p, s->ask, count_room(s->ask), &s->found.X,
                                 &P->lambda, &found));
    P->Phi.ncol = found;
    if (found == s->ask)
        return refine_pairs(s);
    modes_free(&s->found);
    s->ask += s->ask / 2 + SPARE;
    return RITZ_OK;
}

/* If |sigma| is much larger than the first flexible eigenvalue, that has lost
   digits: move sigma closer to 0, unless the factor breaks down there. */
static ritz_status come_closer(rank_search *s, bool *moved)
{
    const ritz_pairs *P = &s->found.pairs;
    const double first =
        P->num_rigid < P->Phi.ncol ? P->lambda[P->num_rigid] : 0.0;
    ritz_status status = RITZ_OK;

    *moved = first > 0.0 && s->sigma < -RITZ_SHIFT_BLURRED * first &&
             first > s->broken;
    if (!*moved)
        return RITZ_OK;
    status = factor_below(s->p, -first);
    if (status == RITZ_OK)
        s->sigma = -first;
    if (status != RITZ_ERR_SINGULAR)
        return status;
    s->broken = fmax(s->broken, first);
    *moved = false;
    return RITZ_OK;
}

/* --- proof ---------------------------------------------------------------- */

/* Count the modes below a value between eigenvalues k - 1 and k. Other values
   are tried if an eigenvalue lies there. */
static ritz_status count_below(rank_search *s, int64_t k, int64_t *out)
{
    const double parts[] = {0.5, RITZ_COUNT_PLACE, 0.7};
    ritz_status status = RITZ_ERR_SINGULAR;

    for (size_t i = 0; i < 3 && status == RITZ_ERR_SINGULAR; i++)
        status = rank_pencil_count(
            s->p, ritz_pairs_between(&s->found.pairs, k, parts[i]), out);
    return status;
}

static ritz_status ask_more(rank_search *s, int64_t more)
{
    RITZ_REFUSE_IF(++s->misses > MISSES, RITZ_ERR_CONVERGENCE,
                   "%" PRId64 " mode(s) below the last one are still missing "
                   "after %d searches",
                   more, MISSES + 1);
    s->ask += more + SPARE;
    return RITZ_OK;
}

static ritz_status refuse_excess(int64_t found, int64_t counted)
{
    RITZ_REFUSE_IF(found > counted, RITZ_ERR_CONVERGENCE,
                   "%" PRId64 " modes were found where there are %" PRId64,
                   found, counted);
    return RITZ_OK;
}

/* If a number of modes is requested: count below a value in a gap after
   them. */
static ritz_status prove_number(rank_search *s, int64_t *end, bool *done)
{
    ritz_pairs *P = &s->found.pairs;
    int64_t at = 0;
    int64_t count = 0;

    *end = ritz_pairs_wanted(P, s->span, 0.0);
    if (*end >= P->Phi.ncol) {
        s->ask += P->num_rigid + SPARE;
        return RITZ_OK;
    }
    at = ritz_pairs_gap(P, *end);
    count = at;
    if (!s->span->uncounted)
        RITZ_CHECK(count_below(s, at, &count));
    RITZ_CHECK(refuse_excess(at, count));
    *done = count == at;
    P->proven_to = s->span->uncounted
                       ? (double)NAN
                       : ritz_pairs_between(P, *end, RITZ_COUNT_PLACE);
    return *done ? RITZ_OK : ask_more(s, count - at);
}

/* If modes up to a frequency are requested: compare with modes_foresee(). */
static ritz_status prove_frequency(rank_search *s, int64_t *end, bool *done)
{
    ritz_pairs *P = &s->found.pairs;
    int64_t below = 0;

    while (below < P->Phi.ncol && P->lambda[below] <= s->limit)
        below++;
    *end = ritz_pairs_wanted(P, s->span, s->limit);
    if (s->span->uncounted) {
        P->proven_to = (double)NAN;
        *done = below < P->Phi.ncol;
        s->ask *= *done ? 1 : 2;
        return RITZ_OK;
    }
    RITZ_CHECK(refuse_excess(below, s->target));
    *done = below == s->target;
    P->proven_to = s->limit;
    return *done ? RITZ_OK : ask_more(s, s->target - below);
}

/* Search until a count verifies the pairs. *alone if there are so many that
   find_alone() must find them. */
static ritz_status search_proven(rank_search *s, int64_t *end, bool *alone)
{
    bool done = false;
    bool moved = false;

    for (int k = 0; k < ATTEMPTS && !done; k++) {
        *alone = count_room(s->ask) >= s->p->heavy;
        if (*alone)
            return RITZ_OK;
        RITZ_CHECK(find_pairs(s));
        if (!s->found.X)
            continue;
        if (s->indefinite) {
            *end = 1; /* enough for the caller to refuse it */
            return RITZ_OK;
        }
        RITZ_CHECK(come_closer(s, &moved));
        if (moved)
            continue;
        if (s->span->modes < 0)
            RITZ_CHECK(prove_frequency(s, end, &done));
        else
            RITZ_CHECK(prove_number(s, end, &done));
    }
    RITZ_REFUSE_IF(!done, RITZ_ERR_CONVERGENCE,
                   "the iteration for %" PRId64 " modes does not converge",
                   s->ask);
    return RITZ_OK;
}

ritz_status modes_find(rank_pencil *p, const ritz_span *span, double limit,
                       int64_t target, modes *out)
{
    RITZ_OWN(rank_search)
    s = {.p = p,
         .span = span,
         .limit = limit,
         .target = target,
         .sigma = p->sigma};
    ritz_pairs *P = &s.found.pairs;
    bool alone = false;
    int64_t end = 0;

    s.ask = (s.sigma < 0.0 ? BODY : 0) + BEHIND +
            (span->modes < 0 ? target : span->modes);
    RITZ_CHECK(search_proven(&s, &end, &alone));
    if (alone) {
        modes_free(&s.found);
        RITZ_CHECK(find_alone(p, span, &s.found));
    } else {
        P->Phi.ncol = end;
        P->num_rigid = P->num_rigid < end ? P->num_rigid : end;
        P->sigma = s.sigma;
    }
    snprintf(P->engine, sizeof P->engine, "%s",
             alone         ? "dense, in rank 0"
             : s.by_blocks ? "block Lanczos, PETSc"
                           : "SLEPc Krylov-Schur");
    RITZ_MOVE(*out, s.found);
    return RITZ_OK;
}
