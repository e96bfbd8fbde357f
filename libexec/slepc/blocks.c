#include "blocks.h"

#include "base/alloc.h"
#include "linear/general.h"
#include "ranks.h"

#include <math.h>
#include <string.h>

void block_new(Mat A, int64_t columns, Mat *out)
{
    PetscInt rows = 0;
    PetscInt own = 0;

    ranks_expect(MatGetSize(A, &rows, NULL));
    ranks_expect(MatGetLocalSize(A, &own, NULL));
    ranks_expect(MatCreateDense(PETSC_COMM_WORLD, own, PETSC_DECIDE, rows,
                                (PetscInt)columns, NULL, out));
}

ritz_dense block_take(Mat X)
{
    PetscInt own = 0;
    PetscInt columns = 0;
    double *values = NULL;

    ranks_expect(MatGetLocalSize(X, &own, NULL));
    ranks_expect(MatGetSize(X, NULL, &columns));
    ranks_expect(MatDenseGetArray(X, &values));
    return (ritz_dense){own, columns, values};
}

void block_return(Mat X, ritz_dense *rows)
{
    ranks_expect(MatDenseRestoreArray(X, &rows->val));
}

ritz_status block_product(Mat X, Mat Y, ritz_dense *out)
{
    ritz_dense x = block_take(X);
    ritz_dense y = block_take(Y);
    const ritz_status status = ritz_dense_mul_tn(&x, &y, out);

    block_return(X, &x);
    block_return(Y, &y);
    RANKS_CHECK(status);
    ranks_sum(out->val, out->nrow * out->ncol);
    return RITZ_OK;
}

void block_multiply(Mat A, Mat X, Mat *out)
{
    ranks_expect(MatMatMult(A, X, MAT_INITIAL_MATRIX, PETSC_DEFAULT, out));
}

/* --- Rayleigh-Ritz -------------------------------------------------------- */

/* Scale rows and columns of both so that M_r has a unit diagonal, and make both
   exactly symmetric. */
static void balance_projection(ritz_dense *A_r, ritz_dense *M_r, double *scale)
{
    const int64_t k = A_r->ncol;

    for (int64_t j = 0; j < k; j++) {
        const double size = sqrt(ritz_dense_col(M_r, j)[j]);

        scale[j] = size > 0.0 ? 1.0 / size : 1.0;
    }
    for (int64_t j = 0; j < k; j++)
        for (int64_t i = 0; i < k; i++) {
            A_r->val[i + j * k] *= scale[i] * scale[j];
            M_r->val[i + j * k] *= scale[i] * scale[j];
        }
    ritz_dense_symmetrise(A_r);
    ritz_dense_symmetrise(M_r);
}

/* Solve A_r q = theta M_r q, in rank 0 alone. Q is scaled back to the columns
   before balancing. */
static ritz_status solve_projection(ritz_dense *A_r, ritz_dense *M_r,
                                    double *theta, ritz_dense *Q)
{
    RITZ_OWN_ARRAY double *scale = NULL;
    RITZ_OWN(ritz_pairs) small = {0};

    RITZ_CHECK_NEW(scale, A_r->ncol);
    balance_projection(A_r, M_r, scale);
    RITZ_CHECK(ritz_eigen_dense(A_r, M_r, &small));
    RITZ_REFUSE_IF(small.Phi.ncol < A_r->ncol, RITZ_ERR_CONVERGENCE,
                   "some eigenvectors are linearly dependent");
    RITZ_CHECK(ritz_eigen_quotients(A_r, &small.Phi, theta));
    ritz_dense_scale_rows(scale, &small.Phi);
    memcpy(Q->val, small.Phi.val, (size_t)(Q->nrow * Q->ncol) * sizeof *Q->val);
    return RITZ_OK;
}

/* X := Y Q, each rank its own rows. */
static ritz_status combine_columns(Mat Y, const ritz_dense *Q, Mat X)
{
    RITZ_OWN(ritz_dense) product = {0};
    ritz_dense y = block_take(Y);
    ritz_dense x = block_take(X);
    const ritz_status status = ritz_dense_mul(&y, Q, &product);

    if (status == RITZ_OK)
        memcpy(x.val, product.val, (size_t)(x.nrow * x.ncol) * sizeof *x.val);
    block_return(X, &x);
    block_return(Y, &y);
    return ranks_agree(status);
}

/* Rayleigh-Ritz in the span of Y: X := Y Q and theta, from M X and M Y. */
static ritz_status project_pencil(Mat Y, Mat MX, Mat MY, double *theta, Mat X)
{
    RITZ_OWN(ritz_dense) A_r = {0}, M_r = {0}, Q = {0};
    ritz_status status = RITZ_OK;

    RITZ_CHECK(block_product(Y, MX, &A_r));
    RITZ_CHECK(block_product(Y, MY, &M_r));
    RANKS_CHECK(ritz_dense_new(A_r.ncol, A_r.ncol, &Q));
    if (ranks_own() == 0)
        status = solve_projection(&A_r, &M_r, theta, &Q);
    RANKS_CHECK(status);
    ranks_share(theta, A_r.ncol * (int64_t)sizeof *theta);
    ranks_share(Q.val, Q.nrow * Q.ncol * (int64_t)sizeof *Q.val);
    return combine_columns(Y, &Q, X);
}

ritz_status block_polish(const rank_pencil *p, Mat X, double *lambda)
{
    ritz_status status = RITZ_OK;
    PetscInt columns = 0;
    Mat MX = NULL;
    Mat MY = NULL;
    Mat Y = NULL;

    ranks_expect(MatGetSize(X, NULL, &columns));
    block_multiply(p->M, X, &MX);
    ranks_expect(MatDuplicate(X, MAT_DO_NOT_COPY_VALUES, &Y));
    status = rank_pencil_solve(p, MX, Y);
    if (status == RITZ_OK) {
        block_multiply(p->M, Y, &MY);
        status = project_pencil(Y, MX, MY, lambda, X);
    }
    ranks_expect(MatDestroy(&MX));
    ranks_expect(MatDestroy(&MY));
    ranks_expect(MatDestroy(&Y));
    for (PetscInt j = 0; j < columns; j++)
        lambda[j] += p->sigma;
    return status;
}

/* --- M-orthogonality --------------------------------------------------- */

/* X := X - Phi h, each rank its own rows. */
static ritz_status subtract_product(Mat Phi, const ritz_dense *h, Mat X)
{
    RITZ_OWN(ritz_dense) product = {0};
    ritz_dense phi = block_take(Phi);
    ritz_dense x = block_take(X);
    const ritz_status status = ritz_dense_mul(&phi, h, &product);

    for (int64_t k = 0; status == RITZ_OK && k < x.nrow * x.ncol; k++)
        x.val[k] -= product.val[k];
    block_return(X, &x);
    block_return(Phi, &phi);
    return ranks_agree(status);
}

ritz_status block_remove(const rank_pencil *p, Mat of, int64_t count, Mat X)
{
    ritz_status status = RITZ_OK;
    Mat MPhi = NULL;
    Mat Phi = NULL;

    ranks_expect(MatDenseGetSubMatrix(of, PETSC_DECIDE, PETSC_DECIDE, 0,
                                      (PetscInt)count, &Phi));
    block_multiply(p->M, Phi, &MPhi);
    for (int pass = 0; pass < 2 && status == RITZ_OK; pass++) {
        RITZ_OWN(ritz_dense) h = {0};

        status = block_product(MPhi, X, &h);
        if (status == RITZ_OK)
            status = subtract_product(Phi, &h, X);
    }
    ranks_expect(MatDestroy(&MPhi));
    ranks_expect(MatDenseRestoreSubMatrix(of, &Phi));
    return status;
}

/* --- gathering ------------------------------------------------------------ */

/* In rank 0: the number of rows of each rank, and the first of them. */
static ritz_status find_layout(int own, int *counts, int *at)
{
    MPI_Gather(&own, 1, MPI_INT, counts, 1, MPI_INT, 0, PETSC_COMM_WORLD);
    for (int r = 1; r < ranks_count(); r++)
        at[r] = at[r - 1] + counts[r - 1];
    return RITZ_OK;
}

ritz_status block_scatter(Mat A, int64_t count,
                          void (*give)(const void *state, int64_t column,
                                       double *x),
                          const void *state, Mat *out)
{
    RITZ_OWN_ARRAY int *counts = NULL, *at = NULL;
    RITZ_OWN_ARRAY double *all = NULL;
    ritz_dense x = {0};
    PetscInt rows = 0;

    ranks_expect(MatGetSize(A, &rows, NULL));
    counts = ritz_zalloc(ranks_count(), sizeof *counts);
    at = ritz_zalloc(ranks_count(), sizeof *at);
    all = ritz_zalloc(ranks_own() == 0 ? rows : 0, sizeof *all);
    RANKS_CHECK(counts && at && all ? RITZ_OK : RITZ_ERR_MEMORY);
    block_new(A, count, out);
    x = block_take(*out);
    RITZ_CHECK(find_layout((int)x.nrow, counts, at));
    for (int64_t j = 0; j < count; j++) {
        if (ranks_own() == 0)
            give(state, j, all);
        MPI_Scatterv(all, counts, at, MPI_DOUBLE, ritz_dense_col(&x, j),
                     (int)x.nrow, MPI_DOUBLE, 0, PETSC_COMM_WORLD);
    }
    block_return(*out, &x);
    return RITZ_OK;
}

ritz_status block_gather(Mat X, int64_t count,
                         void (*take)(void *state, int64_t column,
                                      const double *x),
                         void *state)
{
    RITZ_OWN_ARRAY int *counts = NULL, *at = NULL;
    RITZ_OWN_ARRAY double *all = NULL;
    ritz_dense x = {0};
    PetscInt rows = 0;

    ranks_expect(MatGetSize(X, &rows, NULL));
    counts = ritz_zalloc(ranks_count(), sizeof *counts);
    at = ritz_zalloc(ranks_count(), sizeof *at);
    all = ritz_zalloc(ranks_own() == 0 ? rows : 0, sizeof *all);
    RANKS_CHECK(counts && at && all ? RITZ_OK : RITZ_ERR_MEMORY);
    x = block_take(X);
    RITZ_CHECK(find_layout((int)x.nrow, counts, at));
    for (int64_t j = 0; j < count; j++) {
        MPI_Gatherv(ritz_dense_col(&x, j), (int)x.nrow, MPI_DOUBLE, all, counts,
                    at, MPI_DOUBLE, 0, PETSC_COMM_WORLD);
        if (ranks_own() == 0)
            take(state, j, all);
    }
    block_return(X, &x);
    return RITZ_OK;
}
