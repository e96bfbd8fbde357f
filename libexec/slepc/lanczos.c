/*
 * With OP = (K - sigma M)^-1 M and blocks V_j of M-orthonormal vectors,
 *
 *     OP V_j = V_(j-1) B_(j-1)' + V_j A_j + V_(j+1) B_j
 *
 * A_j and B_j are the blocks of the block tridiagonal matrix T. Its eigenpairs
 * T s = theta s give x = V s and lambda = sigma + 1 / theta. The residual is
 * known without x:
 *
 *     OP x - theta x = V_(m+1) B_m s_m,   s_m the last rows of s,
 *
 * and so is a step of inverse iteration, OP x = theta x + V_(m+1) B_m s_m,
 * which needs no solve. Each block is orthogonalised to all before it, twice
 * [GrimesLewisSimon1994].
 */
#include "lanczos.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "blocks.h"
#include "ranks.h"
#include "rows.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

/* Vectors of a block. MUMPS solves for eight vectors in less than twice the
   time of four, but with blocks of four fewer vectors are needed in all. Blocks
   of four are faster by 7 to 15 % on models of 11 000 and 43 000 dofs, blocks
   of eight by 7 % on one of 55 000 (measured). */
enum { NARROW = 4, WIDE = 8, WIDE_FROM = 50000 };
enum { SPARE_VECTORS = 200 };

typedef struct rank_lanczos {
    const rank_pencil *p;
    int64_t width; /* of a block */
    int64_t ask;   /* pairs requested */
    int64_t most;  /* largest order of T */
    int64_t count; /* order of T, `width` for each block */
    ritz_dense V;  /* rows of this rank; `count` columns and those of V_(m+1) */
    ritz_dense T;  /* most x most, only the lower triangle is set */
    ritz_dense B;  /* B_m, which is not yet in T */
    Mat W, MW;     /* a new block, and M times it */
    Mat Y;         /* right-hand sides of the next solve, M V_(m+1) */
    bool broken;   /* vectors of a block are linearly dependent */
    /* eigenvectors and eigenvalues of T, the largest theta first */
    ritz_dense S;
    double *theta;
} rank_lanczos;

static void rank_lanczos_free(rank_lanczos *z)
{
    ritz_dense_free(&z->V);
    ritz_dense_free(&z->T);
    ritz_dense_free(&z->B);
    ritz_dense_free(&z->S);
    RITZ_FREE(z->theta);
    ranks_expect(MatDestroy(&z->MW));
    ranks_expect(MatDestroy(&z->W));
    ranks_expect(MatDestroy(&z->Y));
}

static void multiply_mass(rank_lanczos *z)
{
    ranks_expect(MatMatMult(z->p->M, z->W,
                            z->MW ? MAT_REUSE_MATRIX : MAT_INITIAL_MATRIX,
                            PETSC_DEFAULT, &z->MW));
}

/* h := V'M W, summed over all ranks, and W := W - V h, V its first `count`
   columns. */
static void remove_parts(rank_lanczos *z, int64_t count, double *h)
{
    ritz_dense W = block_take(z->W);
    ritz_dense MW = block_take(z->MW);
    const int n = (int)W.nrow;
    const int ld = n > 1 ? n : 1;

    memset(h, 0, (size_t)(count * z->width) * sizeof *h);
    cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, (int)count,
                (int)z->width, n, 1.0, z->V.val, ld, MW.val, ld, 0.0, h,
                (int)count);
    ranks_sum(h, count * z->width);
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, n, (int)z->width,
                (int)count, -1.0, z->V.val, ld, h, (int)count, 1.0, W.val, ld);
    block_return(z->MW, &MW);
    block_return(z->W, &W);
}

/* Add the last `width` rows of h to A_m, the last diagonal block of T. */
static void keep_diagonal(rank_lanczos *z, int64_t count, const double *h)
{
    for (int64_t j = 0; j < z->width; j++)
        for (int64_t i = 0; i < z->width; i++)
            ritz_dense_col(&z->T, count - z->width + j)[count - z->width + i] +=
                h[count - z->width + i + j * count];
}

/* X := X R^-1, each rank its own rows. */
static void divide_columns(Mat X, const ritz_dense *R)
{
    ritz_dense x = block_take(X);
    const int width = (int)R->ncol;

    cblas_dtrsm(CblasColMajor, CblasRight, CblasUpper, CblasNoTrans,
                CblasNonUnit, (int)x.nrow, width, 1.0, R->val, width, x.val,
                x.nrow > 1 ? (int)x.nrow : 1);
    block_return(X, &x);
}

/* R'R = W'M W, R upper triangular, from the W'M W of rank 0 in every rank.
   z->broken if it is not positive definite. */
static ritz_status factor_gram(rank_lanczos *z, ritz_dense *R)
{
    const int width = (int)z->width;

    RITZ_CHECK(block_product(z->W, z->MW, R));
    ranks_share(R->val, z->width * z->width * (int64_t)sizeof *R->val);
    z->broken =
        LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'U', width, R->val, width) != 0;
    /* processors of unequal kind may round unequally: rank 0 decides */
    ranks_share(&z->broken, sizeof z->broken);
    for (int64_t j = 0; j < z->width; j++)
        for (int64_t i = j + 1; i < z->width; i++)
            R->val[i + j * z->width] = 0.0;
    return RITZ_OK;
}

/* Factor W = V_(m+1) B_m. W becomes V_(m+1), and MW becomes M V_(m+1). A second
   factorisation corrects the rounding of the first. */
static ritz_status orthonormalise_block(rank_lanczos *z)
{
    RITZ_OWN(ritz_dense) R = {0}, again = {0};
    const int width = (int)z->width;

    RITZ_CHECK(factor_gram(z, &R));
    if (z->broken)
        return RITZ_OK;
    divide_columns(z->W, &R);
    divide_columns(z->MW, &R);
    RITZ_CHECK(factor_gram(z, &again));
    if (z->broken)
        return RITZ_OK;
    divide_columns(z->W, &again);
    divide_columns(z->MW, &again);
    cblas_dtrmm(CblasColMajor, CblasLeft, CblasUpper, CblasNoTrans,
                CblasNonUnit, width, width, 1.0, again.val, width, R.val,
                width);
    memcpy(z->B.val, R.val, (size_t)(z->width * z->width) * sizeof *R.val);
    return RITZ_OK;
}

/* Store W as block m + 1 of V, and M W as the next right-hand sides. */
static void append_block(rank_lanczos *z, int64_t count)
{
    ritz_dense W = block_take(z->W);

    memcpy(ritz_dense_col(&z->V, count), W.val,
           (size_t)(W.nrow * z->width) * sizeof *W.val);
    block_return(z->W, &W);
    ranks_expect(MatCopy(z->MW, z->Y, SAME_NONZERO_PATTERN));
}

/* Put B_m below the diagonal of T, before T gets the next block. */
static void keep_coupling(rank_lanczos *z, int64_t count)
{
    for (int64_t j = 0; j < z->width; j++)
        for (int64_t i = 0; i <= j; i++)
            ritz_dense_col(&z->T, count - z->width + j)[count + i] =
                ritz_dense_col(&z->B, j)[i];
}

/* The first block: OP applied to random vectors, so that it is in the range of
   OP, orthonormalised. */
static ritz_status begin(rank_lanczos *z)
{
    block_new(z->p->K, z->width, &z->W);
    block_new(z->p->K, z->width, &z->Y);
    for (int64_t j = 0; j < z->width; j++) {
        Vec x = NULL;

        ranks_expect(MatDenseGetColumnVecWrite(z->W, (PetscInt)j, &x));
        rows_fill(x, j);
        ranks_expect(MatDenseRestoreColumnVecWrite(z->W, (PetscInt)j, &x));
    }
    multiply_mass(z);
    ranks_expect(MatCopy(z->MW, z->Y, SAME_NONZERO_PATTERN));
    RITZ_CHECK(rank_pencil_solve(z->p, z->Y, z->W));
    multiply_mass(z);
    RITZ_CHECK(orthonormalise_block(z));
    append_block(z, 0);
    return RITZ_OK;
}

/* One step: T grows by A_m and the B before it, z->count by `width`, and V gets
   V_(m+1). `h` is working memory for count x width numbers. */
static ritz_status extend(rank_lanczos *z, double *h)
{
    const int64_t count = z->count + z->width;

    if (z->count > 0)
        keep_coupling(z, z->count);
    RITZ_CHECK(rank_pencil_solve(z->p, z->Y, z->W));
    /* the second pass changes W by rounding alone, so that M W is kept */
    for (int pass = 0; pass < 2; pass++) {
        multiply_mass(z);
        remove_parts(z, count, h);
        keep_diagonal(z, count, h);
    }
    RITZ_CHECK(orthonormalise_block(z));
    if (!z->broken)
        append_block(z, count);
    z->count = count;
    return RITZ_OK;
}

/* --- pairs of T ----------------------------------------------------------- */

/* In rank 0: the `ask` pairs of T with the largest theta, largest first. */
static ritz_status solve_small(rank_lanczos *z)
{
    const int64_t m = z->count;
    RITZ_OWN(ritz_dense) A = {0};
    RITZ_OWN_ARRAY double *value = NULL;

    RITZ_CHECK(ritz_dense_new(m, m, &A));
    RITZ_CHECK_NEW(value, m);
    for (int64_t j = 0; j < m; j++)
        memcpy(ritz_dense_col(&A, j), ritz_dense_col(&z->T, j),
               (size_t)m * sizeof *A.val);
    RITZ_REFUSE_IF(LAPACKE_dsyevd(LAPACK_COL_MAJOR, 'V', 'L', (int)m, A.val,
                                  (int)m, value) != 0,
                   RITZ_ERR_CONVERGENCE,
                   "eigenvalues of a small matrix did not converge");
    for (int64_t k = 0; k < z->ask; k++) {
        z->theta[k] = value[m - 1 - k];
        memcpy(ritz_dense_col(&z->S, k), ritz_dense_col(&A, m - 1 - k),
               (size_t)m * sizeof *A.val);
    }
    return RITZ_OK;
}

/* rest := B_m s_m of pair k, the coefficients of its residual in V_(m+1). */
static void find_remainder(const rank_lanczos *z, int64_t k, double rest[WIDE])
{
    const double *s = ritz_dense_col(&z->S, k) + z->count - z->width;

    for (int64_t i = 0; i < z->width; i++) {
        rest[i] = 0.0;
        for (int64_t j = i; j < z->width; j++)
            rest[i] += ritz_dense_col(&z->B, j)[i] * s[j];
    }
}

/* Whether all requested pairs have converged. */
static bool is_settled(const rank_lanczos *z)
{
    for (int64_t k = 0; k < z->ask; k++) {
        double rest[WIDE];

        find_remainder(z, k, rest);
        if (!(cblas_dnrm2((int)z->width, rest, 1) <=
              RITZ_KRYLOV_SETTLED * z->theta[k]))
            return false;
    }
    return true;
}

/* Eigenpairs of T, from rank 0 in every rank. */
static ritz_status find_ritz_pairs(rank_lanczos *z)
{
    ritz_status status = RITZ_OK;

    if (ranks_own() == 0)
        status = solve_small(z);
    RANKS_CHECK(status);
    ranks_share(z->theta, z->ask * (int64_t)sizeof *z->theta);
    ranks_share(z->S.val, z->S.nrow * z->S.ncol * (int64_t)sizeof *z->S.val);
    return RITZ_OK;
}

/* X = (V S theta + V_(m+1) B_m S_m) / theta, and lambda. */
static ritz_status combine_vectors(const rank_lanczos *z, Mat X, double *lambda)
{
    const int64_t m = z->count + z->width;
    RITZ_OWN(ritz_dense) C = {0};
    ritz_dense x = {0};
    const int n = (int)z->V.nrow;
    const int ld = n > 1 ? n : 1;

    RANKS_CHECK(ritz_dense_new(m, z->ask, &C));
    for (int64_t k = 0; k < z->ask; k++) {
        double *c = ritz_dense_col(&C, k);

        lambda[k] = z->p->sigma + 1.0 / z->theta[k];
        memcpy(c, ritz_dense_col(&z->S, k), (size_t)z->count * sizeof *c);
        find_remainder(z, k, c + z->count);
        for (int64_t i = z->count; i < m; i++)
            c[i] /= z->theta[k];
    }
    x = block_take(X);
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, n, (int)z->ask,
                (int)m, 1.0, z->V.val, ld, C.val, (int)m, 0.0, x.val, ld);
    block_return(X, &x);
    return RITZ_OK;
}

/* --- all ------------------------------------------------------------------ */

static ritz_status allocate(rank_lanczos *z)
{
    PetscInt own = 0;

    ranks_expect(MatGetLocalSize(z->p->K, &own, NULL));
    RITZ_CHECK(ritz_dense_new(own, z->most + z->width, &z->V));
    RITZ_CHECK(ritz_dense_new(z->most, z->most, &z->T));
    RITZ_CHECK(ritz_dense_new(z->width, z->width, &z->B));
    RITZ_CHECK(ritz_dense_new(z->most, z->ask, &z->S));
    RITZ_CHECK_NEW(z->theta, z->ask);
    return RITZ_OK;
}

/* Add blocks until all pairs have converged, V is full, or a block breaks
   down. */
static ritz_status iterate(rank_lanczos *z, bool *settled)
{
    const int64_t first = z->ask + z->ask / 2 + z->width;
    RITZ_OWN_ARRAY double *h = NULL;
    int steps = 0;

    RANKS_CHECK_NEW(h, z->most * z->width);
    RITZ_CHECK(begin(z));
    while (!z->broken && !*settled && z->count + z->width <= z->most) {
        RITZ_CHECK(extend(z, h));
        ritz_monitor_step("eigenvectors", ++steps, 0);
        if (z->broken || z->count < first || steps % 2 != 0)
            continue;
        RITZ_CHECK(find_ritz_pairs(z));
        *settled = is_settled(z);
        ranks_share(settled, sizeof *settled); /* as for z->broken */
    }
    return RITZ_OK;
}

ritz_status lanczos_lowest(const rank_pencil *p, int64_t ask, Mat *X,
                           double **lambda, int64_t *found)
{
    const int64_t room = 3 * ask + SPARE_VECTORS;
    const int64_t width = p->heavy < WIDE_FROM ? NARROW : WIDE;
    RITZ_OWN(rank_lanczos) z = {.p = p, .width = width, .ask = ask};
    bool settled = false;

    *found = 0;
    z.most = room < p->heavy - width ? room : p->heavy - width;
    z.most -= z.most % width;
    if (z.most < 2 * ask)
        return RITZ_OK;
    RANKS_CHECK(allocate(&z));
    RITZ_CHECK(iterate(&z, &settled));
    if (!settled)
        return RITZ_OK;
    RANKS_CHECK_NEW(*lambda, ask);
    block_new(p->K, ask, X);
    RITZ_CHECK(combine_vectors(&z, *X, *lambda));
    *found = ask;
    return RITZ_OK;
}
