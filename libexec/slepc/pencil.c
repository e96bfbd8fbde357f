#include "pencil.h"

#include "base/alloc.h"
#include "base/search.h"
#include "base/tolerances.h"
#include "linear/general.h"
#include "ranks.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* --- survey --------------------------------------------------------------- */

/* K_jj / M_jj of the rows of this rank where both are positive. A mass may be
   negative by rounding of the largest, no more. */
static ritz_status find_ratios(Mat K, Mat M, double **ratio, int *count)
{
    const PetscScalar *k = NULL;
    const PetscScalar *m = NULL;
    ritz_status status = RITZ_OK;
    double largest = 0.0;
    PetscInt first = 0;
    PetscInt own = 0;
    Vec K_d = NULL;
    Vec M_d = NULL;

    ranks_expect(MatCreateVecs(K, NULL, &K_d));
    ranks_expect(VecDuplicate(K_d, &M_d));
    ranks_expect(MatGetDiagonal(K, K_d));
    ranks_expect(MatGetDiagonal(M, M_d));
    ranks_expect(VecGetLocalSize(K_d, &own));
    ranks_expect(VecGetOwnershipRange(K_d, &first, NULL));
    ranks_expect(VecMax(M_d, NULL, &largest));
    ranks_expect(VecGetArrayRead(K_d, &k));
    ranks_expect(VecGetArrayRead(M_d, &m));
    *ratio = ritz_zalloc(own, sizeof **ratio);
    for (PetscInt j = 0; *ratio && j < own; j++)
        if (k[j] > 0.0 && m[j] > 0.0)
            (*ratio)[(*count)++] = k[j] / m[j];
    status = *ratio ? ritz_eigen_check_mass(own, m, first,
                                            -RITZ_RIGID_DIGITS * largest)
                    : RITZ_ERR_MEMORY;
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
    RITZ_OWN(rank_pencil) p = {.K = K, .M = M, .typical = 1.0};

    RITZ_CHECK(find_typical(&p));
    p.heavy = count_heavy(M);
    RITZ_MOVE(*out, p);
    return RITZ_OK;
}

/* --- factors -------------------------------------------------------------- */

static ritz_status make_factor(rank_pencil *p, double sigma, const char *step)
{
    if (!p->F)
        RITZ_CHECK(rank_factor_new(p->K, p->M, &p->F));
    p->sigma = sigma;
    return rank_factor_make(p->F, sigma, step, &p->negative);
}

ritz_status rank_pencil_factor(rank_pencil *p, double sigma)
{
    return make_factor(p, sigma, "factor");
}

ritz_status rank_pencil_count(rank_pencil *p, double sigma, int64_t *out)
{
    const ritz_status status = make_factor(p, sigma, "count of modes");

    *out = p->negative;
    return status;
}

ritz_status rank_pencil_solve(const rank_pencil *p, Mat B, Mat X)
{
    ritz_status status = RITZ_OK;
    const double *b = NULL;
    double *x = NULL;
    PetscInt columns = 0;

    ranks_expect(MatGetSize(B, NULL, &columns));
    ranks_expect(MatDenseGetArrayRead(B, &b));
    ranks_expect(MatDenseGetArrayWrite(X, &x));
    status = rank_factor_solve(p->F, columns, b, x);
    ranks_expect(MatDenseRestoreArrayWrite(X, &x));
    ranks_expect(MatDenseRestoreArrayRead(B, &b));
    return status;
}

ritz_status rank_pencil_solve_vector(const rank_pencil *p, Vec b, Vec x)
{
    ritz_status status = RITZ_OK;
    const double *from = NULL;
    double *to = NULL;

    ranks_expect(VecGetArrayRead(b, &from));
    ranks_expect(VecGetArrayWrite(x, &to));
    status = rank_factor_solve(p->F, 1, from, to);
    ranks_expect(VecRestoreArrayWrite(x, &to));
    ranks_expect(VecRestoreArrayRead(b, &from));
    return status;
}

void rank_pencil_free(rank_pencil *p)
{
    rank_factor_free(&p->F);
    *p = (rank_pencil){0};
}
