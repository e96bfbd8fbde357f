#include "blocks.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"
#include "ranks.h"

#include <float.h>
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
    rank_pencil_solve(p, MX, Y);
    block_multiply(p->M, Y, &MY);
    status = project_pencil(Y, MX, MY, lambda, X);
    ranks_expect(MatDestroy(&MX));
    ranks_expect(MatDestroy(&MY));
    ranks_expect(MatDestroy(&Y));
    for (PetscInt j = 0; j < columns; j++)
        lambda[j] += p->sigma;
    return status;
}

/* --- residuals ------------------------------------------------------------ */

/* A := |A|, entry by entry. */
static void take_magnitudes(Mat A)
{
    Mat parts[2] = {NULL, NULL};
    const PetscInt *columns = NULL;

    ranks_expect(MatMPIAIJGetSeqAIJ(A, &parts[0], &parts[1], &columns));
    for (int k = 0; k < 2; k++) {
        MatInfo info;
        double *value = NULL;

        ranks_expect(MatGetInfo(parts[k], MAT_LOCAL, &info));
        ranks_expect(MatSeqAIJGetArray(parts[k], &value));
        for (int64_t p = 0; p < (int64_t)info.nz_used; p++)
            value[p] = fabs(value[p]);
        ranks_expect(MatSeqAIJRestoreArray(parts[k], &value));
    }
}

/* AX := A X and sizes := |A||X|, new blocks. */
static void multiply_both(Mat A, Mat X, Mat *AX, Mat *sizes)
{
    Mat magnitude = NULL;
    Mat lengths = NULL;
    ritz_dense x;

    block_multiply(A, X, AX);
    ranks_expect(MatDuplicate(A, MAT_COPY_VALUES, &magnitude));
    ranks_expect(MatDuplicate(X, MAT_COPY_VALUES, &lengths));
    take_magnitudes(magnitude);
    x = block_take(lengths);
    for (int64_t i = 0; i < x.nrow * x.ncol; i++)
        x.val[i] = fabs(x.val[i]);
    block_return(lengths, &x);
    block_multiply(magnitude, lengths, sizes);
    ranks_expect(MatDestroy(&magnitude));
    ranks_expect(MatDestroy(&lengths));
}

enum { GAP, SIZE, ENERGY, SUMS };

/* Sums over the rows of this rank of |K x - lambda M x|^2,
   | |K||x| + |lambda||M||x| |^2 and |x|'|K||x|, from of[] = K X, |K||X|, M X,
   |M||X|. Those of column j begin at sum[SUMS j]. */
static void sum_rows(const ritz_dense *x, const ritz_dense of[4],
                     const double *lambda, double *sum)
{
    for (int64_t j = 0; j < x->ncol; j++)
        for (int64_t i = 0; i < x->nrow; i++) {
            const int64_t at = i + j * x->nrow;
            const double gap = of[0].val[at] - lambda[j] * of[2].val[at];
            const double size = of[1].val[at] + fabs(lambda[j]) * of[3].val[at];

            sum[SUMS * j + GAP] += gap * gap;
            sum[SUMS * j + SIZE] += size * size;
            sum[SUMS * j + ENERGY] += fabs(x->val[at]) * of[1].val[at];
        }
}

ritz_status block_assess(const rank_pencil *p, Mat X, ritz_pairs *P,
                         double *worst)
{
    Mat products[4] = {NULL, NULL, NULL, NULL};
    ritz_dense of[4];
    ritz_dense x;
    RITZ_OWN_ARRAY double *sum = NULL;
    double scale = 0.0;

    RANKS_CHECK_NEW(sum, SUMS * P->Phi.ncol);
    multiply_both(p->K, X, &products[0], &products[1]);
    multiply_both(p->M, X, &products[2], &products[3]);
    x = block_take(X);
    for (int k = 0; k < 4; k++)
        of[k] = block_take(products[k]);
    sum_rows(&x, of, P->lambda, sum);
    for (int k = 0; k < 4; k++) {
        block_return(products[k], &of[k]);
        ranks_expect(MatDestroy(&products[k]));
    }
    block_return(X, &x);
    ranks_sum(sum, SUMS * P->Phi.ncol);
    *worst = 0.0;
    for (int64_t j = 0; j < P->Phi.ncol; j++) {
        const double *s = sum + SUMS * j;

        P->residual[j] = s[SIZE] == 0.0 ? 0.0 : sqrt(s[GAP] / s[SIZE]);
        if (!isnan(*worst) && !(P->residual[j] <= *worst))
            *worst = P->residual[j];
        scale = fmax(scale, s[ENERGY]);
    }
    P->num_rigid = ritz_eigen_rigid(P->Phi.ncol, P->lambda, scale);
    return RITZ_OK;
}

/* --- quotients ------------------------------------------------------------ */

/* The rows of a distributed matrix in this rank, in compressed form: either the
   part with the columns of this rank, or that with columns of other ranks, for
   which entries of x must be fetched. */
typedef struct local_rows {
    Mat part;
    PetscInt rows;
    const PetscInt *start, *column;
    const double *value;
} local_rows;

static void take_rows(Mat part, local_rows *out)
{
    PetscBool done = PETSC_FALSE;

    out->part = part;
    ranks_expect(MatGetRowIJ(part, 0, PETSC_FALSE, PETSC_FALSE, &out->rows,
                             &out->start, &out->column, &done));
    ranks_expect(MatSeqAIJGetArrayRead(part, &out->value));
}

static void return_rows(local_rows *r)
{
    PetscBool done = PETSC_FALSE;

    ranks_expect(MatSeqAIJRestoreArrayRead(r->part, &r->value));
    ranks_expect(MatRestoreRowIJ(r->part, 0, PETSC_FALSE, PETSC_FALSE, &r->rows,
                                 &r->start, &r->column, &done));
}

/* Add x'A y and |x|'|A||y| of these rows, the former with products and sums of
   64 bits instead of 53. */
static void sum_energy(const local_rows *r, const double *x, const double *y,
                       long double *energy, double *size)
{
    for (PetscInt i = 0; i < r->rows; i++) {
        long double sum = 0.0L;

        for (PetscInt k = r->start[i]; k < r->start[i + 1]; k++) {
            const long double part =
                (long double)r->value[k] * (long double)y[r->column[k]];

            sum += part;
            *size += fabs((double)part * x[i]);
        }
        *energy += (long double)x[i] * sum;
    }
}

/* out[0] + out[1] := x'A x and out[2] := |x|'|A||x|, summed over all ranks. */
static void find_energy(const local_rows part[2], Vec x, VecScatter fetch,
                        Vec others, double out[3])
{
    const double *own = NULL;
    const double *far = NULL;
    long double energy = 0.0L;

    out[2] = 0.0;
    ranks_expect(
        VecScatterBegin(fetch, x, others, INSERT_VALUES, SCATTER_FORWARD));
    ranks_expect(
        VecScatterEnd(fetch, x, others, INSERT_VALUES, SCATTER_FORWARD));
    ranks_expect(VecGetArrayRead(x, &own));
    ranks_expect(VecGetArrayRead(others, &far));
    sum_energy(&part[0], own, own, &energy, &out[2]);
    sum_energy(&part[1], own, far, &energy, &out[2]);
    ranks_expect(VecRestoreArrayRead(others, &far));
    ranks_expect(VecRestoreArrayRead(x, &own));
    out[0] = (double)energy;
    out[1] = (double)(energy - (long double)out[0]);
    ranks_sum(out, 3);
}

/* lambda := x'K x of the flexible modes, the lowest first, until one has not
   lost digits. x'M x = 1. */
static void sharpen_columns(const local_rows part[2], Mat X, VecScatter fetch,
                            Vec others, ritz_pairs *P)
{
    bool lost = true;

    for (int64_t j = P->num_rigid; lost && j < P->Phi.ncol; j++) {
        double energy[3];
        Vec x = NULL;

        ranks_expect(MatDenseGetColumnVecRead(X, (PetscInt)j, &x));
        find_energy(part, x, fetch, others, energy);
        ranks_expect(MatDenseRestoreColumnVecRead(X, (PetscInt)j, &x));
        lost = energy[2] * DBL_EPSILON > RITZ_DIGITS_LOST * P->lambda[j];
        if (lost)
            P->lambda[j] = energy[0] + energy[1];
        if (j > 0)
            P->lambda[j] = fmax(P->lambda[j], P->lambda[j - 1]);
    }
}

ritz_status block_sharpen(const rank_pencil *p, Mat X, ritz_pairs *P)
{
    Mat parts[2] = {NULL, NULL};
    const PetscInt *columns = NULL;
    local_rows part[2];
    VecScatter fetch = NULL;
    PetscInt count = 0;
    Vec x = NULL;
    Vec others = NULL;
    IS from = NULL;

    ranks_expect(MatMPIAIJGetSeqAIJ(p->K, &parts[0], &parts[1], &columns));
    ranks_expect(MatGetSize(parts[1], NULL, &count));
    ranks_expect(MatCreateVecs(p->K, &x, NULL));
    ranks_expect(VecCreateSeq(PETSC_COMM_SELF, count, &others));
    ranks_expect(ISCreateGeneral(PETSC_COMM_SELF, count, columns,
                                 PETSC_COPY_VALUES, &from));
    ranks_expect(VecScatterCreate(x, from, others, NULL, &fetch));
    for (int k = 0; k < 2; k++)
        take_rows(parts[k], &part[k]);
    sharpen_columns(part, X, fetch, others, P);
    for (int k = 0; k < 2; k++)
        return_rows(&part[k]);
    ranks_expect(VecScatterDestroy(&fetch));
    ranks_expect(ISDestroy(&from));
    ranks_expect(VecDestroy(&others));
    ranks_expect(VecDestroy(&x));
    return RITZ_OK;
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
