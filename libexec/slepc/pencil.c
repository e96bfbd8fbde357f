#include "pencil.h"

#include "base/alloc.h"
#include "base/search.h"
#include "ranks.h"

#include <stdlib.h>
#include <string.h>

/* --- survey --------------------------------------------------------------- */

/* K_jj / M_jj of the rows of this rank where both are positive. */
static ritz_status find_ratios(Mat K, Mat M, double **ratio, int *count)
{
    const PetscScalar *k = NULL;
    const PetscScalar *m = NULL;
    ritz_status status = RITZ_OK;
    PetscInt own = 0;
    Vec K_d = NULL;
    Vec M_d = NULL;

    ranks_expect(MatCreateVecs(K, NULL, &K_d));
    ranks_expect(VecDuplicate(K_d, &M_d));
    ranks_expect(MatGetDiagonal(K, K_d));
    ranks_expect(MatGetDiagonal(M, M_d));
    ranks_expect(VecGetLocalSize(K_d, &own));
    ranks_expect(VecGetArrayRead(K_d, &k));
    ranks_expect(VecGetArrayRead(M_d, &m));
    *ratio = ritz_zalloc(own, sizeof **ratio);
    for (PetscInt j = 0; *ratio && j < own; j++)
        if (k[j] > 0.0 && m[j] > 0.0)
            (*ratio)[(*count)++] = k[j] / m[j];
    if (!*ratio)
        status = RITZ_ERR_MEMORY;
    ranks_expect(VecRestoreArrayRead(K_d, &k));
    ranks_expect(VecRestoreArrayRead(M_d, &m));
    ranks_expect(VecDestroy(&K_d));
    ranks_expect(VecDestroy(&M_d));
    return status;
}

/* Gather the ratios of all ranks in rank 0; *total is their number there. */
static ritz_status gather_ratios(const double *own, int count, double **all,
                                 int64_t *total)
{
    RITZ_OWN_ARRAY int *counts = NULL, *at = NULL;
    const int ranks = ranks_count();

    counts = ritz_zalloc(ranks, sizeof *counts);
    at = ritz_zalloc(ranks, sizeof *at);
    RANKS_CHECK(counts && at ? RITZ_OK : RITZ_ERR_MEMORY);
    MPI_Gather(&count, 1, MPI_INT, counts, 1, MPI_INT, 0, PETSC_COMM_WORLD);
    for (int r = 0; r < ranks; r++) {
        at[r] = (int)*total;
        *total += counts[r];
    }
    *all = ritz_zalloc(ranks_own() == 0 ? *total : 0, sizeof **all);
    RANKS_CHECK(*all ? RITZ_OK : RITZ_ERR_MEMORY);
    MPI_Gatherv(own, count, MPI_DOUBLE, *all, counts, at, MPI_DOUBLE, 0,
                PETSC_COMM_WORLD);
    return RITZ_OK;
}

static ritz_status find_typical(rank_pencil *p)
{
    RITZ_OWN_ARRAY double *own = NULL, *all = NULL;
    int count = 0;
    int64_t total = 0;

    RANKS_CHECK(find_ratios(p->K, p->M, &own, &count));
    RITZ_CHECK(gather_ratios(own, count, &all, &total));
    if (ranks_own() == 0 && total > 0) {
        qsort(all, (size_t)total, sizeof *all, ritz_ascending);
        p->typical = all[total / 2];
    }
    ranks_share(&p->typical, sizeof p->typical);
    return RITZ_OK;
}

/* Number of rows of M, and so of columns, with an entry that is not zero. */
static int64_t count_heavy(Mat M)
{
    PetscInt from = 0;
    PetscInt to = 0;
    int64_t own = 0;

    ranks_expect(MatGetOwnershipRange(M, &from, &to));
    for (PetscInt i = from; i < to; i++) {
        const PetscScalar *value = NULL;
        PetscInt count = 0;
        bool heavy = false;

        ranks_expect(MatGetRow(M, i, &count, NULL, &value));
        for (PetscInt k = 0; k < count; k++)
            heavy = heavy || value[k] != 0.0;
        ranks_expect(MatRestoreRow(M, i, &count, NULL, &value));
        own += heavy;
    }
    return ranks_total(own);
}

ritz_status rank_pencil_new(Mat K, Mat M, rank_pencil *out)
{
    RITZ_OWN(rank_pencil) p = {.K = K, .M = M, .typical = 1.0, .room = 30};

    RITZ_CHECK(find_typical(&p));
    p.heavy = count_heavy(M);
    RITZ_MOVE(*out, p);
    return RITZ_OK;
}

/* --- factors -------------------------------------------------------------- */

/*
 * Controls of MUMPS, ICNTL, by their numbers in its manual. Rows are ordered by
 * METIS; null pivots are counted; ScaLAPACK does not factor the last front, as
 * it does not count negative pivots. Options in PETSC_OPTIONS, such as
 * -mat_mumps_icntl_28 2, override them.
 */
enum { ORDERING = 7, ROOT_SEQUENTIAL = 13, ROOM_PERCENT = 14 };
enum { NULL_PIVOTS = 24, METIS = 5, OUTCOME = 1 };

static void set_controls(Mat F, int room)
{

    ranks_expect(MatMumpsSetIcntl(F, ORDERING, METIS));
    ranks_expect(MatMumpsSetIcntl(F, ROOT_SEQUENTIAL, 1));
    ranks_expect(MatMumpsSetIcntl(F, ROOM_PERCENT, room));
    ranks_expect(MatMumpsSetIcntl(F, NULL_PIVOTS, 1));
}

/* A := K - sigma M, in the union of both patterns. It is computed from K each
   time, so that rounding of earlier shifts does not add up. */
static void shift_matrix(rank_pencil *p, double sigma)
{
    if (!p->A) {
        ranks_expect(MatDuplicate(p->K, MAT_COPY_VALUES, &p->A));
        ranks_expect(MatAXPY(p->A, 1.0, p->M, UNKNOWN_NONZERO_PATTERN));
        ranks_expect(MatSetOption(p->A, MAT_SYMMETRIC, PETSC_TRUE));
        ranks_expect(MatSetOption(p->A, MAT_SYMMETRY_ETERNAL, PETSC_TRUE));
    }
    ranks_expect(MatZeroEntries(p->A));
    ranks_expect(MatAXPY(p->A, 1.0, p->K, SUBSET_NONZERO_PATTERN));
    ranks_expect(MatAXPY(p->A, -sigma, p->M, SUBSET_NONZERO_PATTERN));
    p->sigma = sigma;
}

static void analyse_pattern(rank_pencil *p)
{
    MatFactorInfo info;

    ranks_expect(MatDestroy(&p->F));
    ranks_expect(
        MatGetFactor(p->A, MATSOLVERMUMPS, MAT_FACTOR_CHOLESKY, &p->F));
    set_controls(p->F, p->room);
    ranks_expect(MatFactorInfoInitialize(&info));
    ranks_expect(MatCholeskyFactorSymbolic(p->F, p->A, NULL, &info));
}

/* Whether the last factorisation failed as its workspace was too small: -8 and
   -9 of INFOG(1). */
static bool needs_room(const rank_pencil *p)
{
    PetscInt outcome = 0;

    ranks_expect(MatMumpsGetInfog(p->F, OUTCOME, &outcome));
    return outcome == -8 || outcome == -9;
}

/* Factor A. If delayed pivots need more workspace than the analysis predicted,
   repeat with twice as much in addition. */
static void factor_matrix(rank_pencil *p)
{
    enum { MOST_ROOM = 2000 }; /* percent */
    bool again = p->F == NULL;
    MatFactorInfo info;

    ranks_expect(MatFactorInfoInitialize(&info));
    do {
        if (again)
            analyse_pattern(p);
        ranks_expect(MatCholeskyFactorNumeric(p->F, p->A, &info));
        again = needs_room(p) && p->room < MOST_ROOM;
        p->room *= again ? 2 : 1;
    } while (again);
}

/* The outcome as a status, from INFOG(1), which is the same in every rank. */
static ritz_status report_failure(const rank_pencil *p)
{
    enum { SINGULAR = -10 };
    static const int memory[] = {-5, -7, -8, -9, -13, -17, -19, -20};
    MatFactorError error = MAT_FACTOR_NOERROR;
    PetscInt outcome = 0;

    ranks_expect(MatFactorGetError(p->F, &error));
    ranks_expect(MatMumpsGetInfog(p->F, OUTCOME, &outcome));
    for (size_t k = 0; k < sizeof memory / sizeof *memory; k++)
        RITZ_REFUSE_IF(outcome == memory[k], RITZ_ERR_MEMORY,
                       "one of %d ranks has no memory for its part of the "
                       "factor: take more ranks, on more machines",
                       ranks_count());
    RITZ_REFUSE_IF(outcome == SINGULAR, RITZ_ERR_SINGULAR,
                   "the matrix is singular");
    RITZ_REFUSE_IF(
        outcome < 0 || error != MAT_FACTOR_NOERROR, RITZ_ERR_CONVERGENCE,
        "the matrix cannot be factored, MUMPS says %d", (int)outcome);
    return RITZ_OK;
}

ritz_status rank_pencil_factor(rank_pencil *p, double sigma)
{
    PetscInt negative = 0;
    PetscInt null = 0;

    shift_matrix(p, sigma);
    factor_matrix(p);
    RITZ_CHECK(report_failure(p));
    ranks_expect(MatGetInertia(p->F, &negative, &null, NULL));
    p->negative = negative;
    RITZ_REFUSE_IF(null > 0, RITZ_ERR_SINGULAR,
                   "the matrix is singular, %d pivots are zero", (int)null);
    return RITZ_OK;
}

void rank_pencil_solve(const rank_pencil *p, Mat B, Mat X)
{
    ranks_expect(MatMatSolve(p->F, B, X));
}

void rank_pencil_solve_vector(const rank_pencil *p, Vec b, Vec x)
{
    ranks_expect(MatSolve(p->F, b, x));
}

void rank_pencil_free(rank_pencil *p)
{
    ranks_expect(MatDestroy(&p->A));
    ranks_expect(MatDestroy(&p->F));
    *p = (rank_pencil){0};
}
