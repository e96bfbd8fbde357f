#include "assess.h"

#include "base/alloc.h"
#include "blocks.h"
#include "linear/residuals.h"
#include "linear/sharpen.h"
#include "linear/tiles.h"
#include "ranks.h"

#include <math.h>
#include <string.h>

enum {
    WIDTH = RITZ_TILE, /* vectors at a time */
    CHUNK = 32,        /* rows of K X and M X that are held at a time */
};

void assessor_free(assessor *a)
{
    ranks_expect(VecScatterDestroy(&a->fetch));
    ranks_expect(VecDestroy(&a->mine));
    ranks_expect(VecDestroy(&a->others));
    ritz_sparse_free(&a->K);
    ritz_sparse_free(&a->M);
    RITZ_FREE(a->x);
    *a = (assessor){0};
}

/* --- rows ----------------------------------------------------------------- */

/* The rows of a distributed matrix in this rank, in compressed form: the part
   with the columns of this rank, and the part with those of other ranks, whose
   column k is column far[k] of the matrix; far ascends. */
typedef struct local_part {
    Mat of;
    PetscInt rows;
    const PetscInt *start, *column;
    const double *value;
} local_part;

typedef struct local_rows {
    local_part part[2];
    PetscInt num_far;
    const PetscInt *far;
} local_rows;

static void take_rows(Mat A, local_rows *out)
{
    Mat parts[2] = {NULL, NULL};

    ranks_expect(MatMPIAIJGetSeqAIJ(A, &parts[0], &parts[1], &out->far));
    ranks_expect(MatGetSize(parts[1], NULL, &out->num_far));
    for (int k = 0; k < 2; k++) {
        local_part *p = &out->part[k];
        PetscBool done = PETSC_FALSE;

        p->of = parts[k];
        ranks_expect(MatGetRowIJ(p->of, 0, PETSC_FALSE, PETSC_FALSE, &p->rows,
                                 &p->start, &p->column, &done));
        ranks_expect(MatSeqAIJGetArrayRead(p->of, &p->value));
    }
}

static void return_rows(local_rows *r)
{
    for (int k = 0; k < 2; k++) {
        local_part *p = &r->part[k];
        PetscBool done = PETSC_FALSE;

        ranks_expect(MatSeqAIJRestoreArrayRead(p->of, &p->value));
        ranks_expect(MatRestoreRowIJ(p->of, 0, PETSC_FALSE, PETSC_FALSE,
                                     &p->rows, &p->start, &p->column, &done));
    }
}

/* The columns of other ranks that K or M has, ascending. place[0][k] is the
   place of column k of K's part among them, place[1][k] of M's. */
static int64_t unite_far(const local_rows both[2], PetscInt *far,
                         int64_t *const place[2])
{
    PetscInt at[2] = {0, 0};
    int64_t count = 0;

    while (at[0] < both[0].num_far || at[1] < both[1].num_far) {
        PetscInt least = PETSC_MAX_INT;

        for (int k = 0; k < 2; k++)
            if (at[k] < both[k].num_far && both[k].far[at[k]] < least)
                least = both[k].far[at[k]];
        for (int k = 0; k < 2; k++)
            if (at[k] < both[k].num_far && both[k].far[at[k]] == least)
                place[k][at[k]++] = count;
        far[count++] = least;
    }
    return count;
}

/* A := the rows as columns, with rows `own` first and then those at `place`. */
static ritz_status copy_rows(const local_rows *r, int64_t own, int64_t all,
                             const int64_t *place, ritz_sparse *A)
{
    const local_part *p = r->part;
    const int64_t entries = (int64_t)p[0].start[own] + p[1].start[own];
    int64_t at = 0;

    RITZ_CHECK(ritz_sparse_new(all, own, entries, A));
    for (int64_t j = 0; j < own; j++) {
        for (PetscInt k = p[0].start[j]; k < p[0].start[j + 1]; k++) {
            A->rowind[at] = p[0].column[k];
            A->val[at++] = p[0].value[k];
        }
        for (PetscInt k = p[1].start[j]; k < p[1].start[j + 1]; k++) {
            A->rowind[at] = own + place[p[1].column[k]];
            A->val[at++] = p[1].value[k];
        }
        A->colptr[j + 1] = at;
    }
    return RITZ_OK;
}

/* Copy the rows of both matrices. @param[out] far  rows of other ranks; room for
   those of both matrices */
static ritz_status copy_both(const local_rows both[2], PetscInt *far,
                             assessor *a)
{
    RITZ_OWN_ARRAY int64_t *of_K = NULL, *of_M = NULL;
    ritz_sparse *const A[2] = {&a->K, &a->M};
    int64_t *place[2];

    RITZ_CHECK_NEW(of_K, both[0].num_far);
    RITZ_CHECK_NEW(of_M, both[1].num_far);
    place[0] = of_K;
    place[1] = of_M;
    a->far = unite_far(both, far, place);
    for (int k = 0; k < 2; k++)
        RITZ_CHECK(
            copy_rows(&both[k], a->own, a->own + a->far, place[k], A[k]));
    RITZ_CHECK_NEW(a->x, (a->own + a->far) * WIDTH);
    return RITZ_OK;
}

/* Plan which rows of eight numbers are fetched from other ranks. */
static void plan_fetch(const PetscInt *far, assessor *a)
{
    IS from = NULL;

    ranks_expect(VecCreateMPIWithArray(PETSC_COMM_WORLD, WIDTH,
                                       (PetscInt)(WIDTH * a->own), PETSC_DECIDE,
                                       a->x, &a->mine));
    ranks_expect(VecCreateSeqWithArray(PETSC_COMM_SELF, WIDTH,
                                       (PetscInt)(WIDTH * a->far),
                                       a->x + WIDTH * a->own, &a->others));
    ranks_expect(ISCreateBlock(PETSC_COMM_SELF, WIDTH, (PetscInt)a->far, far,
                               PETSC_COPY_VALUES, &from));
    ranks_expect(VecScatterCreate(a->mine, from, a->others, NULL, &a->fetch));
    ranks_expect(ISDestroy(&from));
}

ritz_status assessor_new(Mat K, Mat M, assessor *out)
{
    RITZ_OWN(assessor) a = {0};
    RITZ_OWN_ARRAY PetscInt *far = NULL;
    local_rows both[2];
    ritz_status status = RITZ_OK;

    take_rows(K, &both[0]);
    take_rows(M, &both[1]);
    a.own = both[0].part[0].rows;
    far = ritz_zalloc((int64_t)both[0].num_far + both[1].num_far, sizeof *far);
    status = far ? copy_both(both, far, &a) : RITZ_ERR_MEMORY;
    return_rows(&both[1]);
    return_rows(&both[0]);
    RANKS_CHECK(status);
    plan_fetch(far, &a);
    RITZ_MOVE(*out, a);
    return RITZ_OK;
}

/* Put columns [first, first + count) of X, at most eight, into a->x, with zeros
   for the rest, and fetch the rows of other ranks. Collective. */
static void load_columns(const assessor *a, const ritz_dense *X, int64_t first,
                         int64_t count)
{
    for (int64_t i = 0; i < a->own; i++)
        for (int64_t c = 0; c < WIDTH; c++)
            a->x[i * WIDTH + c] =
                c < count ? X->val[i + (first + c) * X->nrow] : 0.0;
    ranks_expect(VecScatterBegin(a->fetch, a->mine, a->others, INSERT_VALUES,
                                 SCATTER_FORWARD));
    ranks_expect(VecScatterEnd(a->fetch, a->mine, a->others, INSERT_VALUES,
                               SCATTER_FORWARD));
}

/* Columns from `first` on that are treated at a time. */
static int64_t count_next(int64_t first, int64_t end)
{
    return end - first < WIDTH ? end - first : WIDTH;
}

/* --- residuals ------------------------------------------------------------ */

/* Sums over the rows of this rank, for each of eight pairs:
     gap     |K x - lambda M x|^2
     size    | |K||x| + |lambda||M||x| |^2
     energy  |x|'|K||x| */
enum { GAP, SIZE, ENERGY, SUMS };

typedef double sums[SUMS][WIDTH];

static void add_row(const double *x, const double *K[2], const double *M[2],
                    const double *lambda, sums s)
{
    for (int c = 0; c < WIDTH; c++) {
        const double gap = K[0][c] - lambda[c] * M[0][c];
        const double size = K[1][c] + fabs(lambda[c]) * M[1][c];

        s[GAP][c] += gap * gap;
        s[SIZE][c] += size * size;
        s[ENERGY][c] += fabs(x[c]) * K[1][c];
    }
}

static void add_rows(const assessor *a, const double lambda[WIDTH], sums s)
{
    const ritz_tiles *tiles = ritz_tiles_here();

    for (int64_t r = 0; r < a->own; r += CHUNK) {
        const int64_t end = r + CHUNK < a->own ? r + CHUNK : a->own;
        double Kx[2][CHUNK * WIDTH], Mx[2][CHUNK * WIDTH];

        tiles->of[0].terms(r, end, &a->K, a->x, Kx[0], Kx[1]);
        tiles->of[0].terms(r, end, &a->M, a->x, Mx[0], Mx[1]);
        for (int64_t i = 0; i < (end - r) * WIDTH; i += WIDTH)
            add_row(a->x + r * WIDTH + i,
                    (const double *[]){Kx[0] + i, Kx[1] + i},
                    (const double *[]){Mx[0] + i, Mx[1] + i}, lambda, s);
    }
}

/* total[SUMS j + k] := sum k of pair j, over the rows of all ranks. */
static void sum_pairs(const assessor *a, const ritz_dense *X,
                      const ritz_pairs *P, double *total)
{
    const int64_t pairs = P->Phi.ncol;

    for (int64_t first = 0; first < pairs; first += WIDTH) {
        const int64_t count = count_next(first, pairs);
        double lambda[WIDTH] = {0.0};
        sums s = {0};

        load_columns(a, X, first, count);
        memcpy(lambda, P->lambda + first, (size_t)count * sizeof *lambda);
        add_rows(a, lambda, s);
        for (int64_t c = 0; c < count; c++)
            for (int k = 0; k < SUMS; k++)
                total[SUMS * (first + c) + k] = s[k][c];
    }
    ranks_sum(total, SUMS * pairs);
}

ritz_status assessor_residuals(const assessor *a, Mat X, ritz_pairs *P,
                               double *energy, double *worst)
{
    RITZ_OWN_ARRAY double *total = NULL, *size = NULL;
    ritz_dense x;

    RANKS_CHECK_NEW(total, SUMS * P->Phi.ncol);
    RANKS_CHECK_NEW(size, P->Phi.ncol);
    x = block_take(X);
    sum_pairs(a, &x, P, total);
    block_return(X, &x);
    for (int64_t j = 0; j < P->Phi.ncol; j++) {
        const double *s = total + SUMS * j;

        P->residual[j] = sqrt(s[GAP]);
        size[j] = sqrt(s[SIZE]);
        energy[j] = s[ENERGY];
    }
    ritz_pairs_relate(P, size, energy, worst);
    return RITZ_OK;
}

/* --- Rayleigh-Ritz -------------------------------------------------------- */

/* Working memory of the products, and the sums of this rank. */
typedef struct projection {
    ritz_sparse border; /* columns of other ranks in the rank's rows of K */
    double *y, *low;    /* room for own + far rows of eight numbers */
    ritz_dense product; /* the rank's rows of K X or M X, eight columns */
    ritz_dense some_K, some_M; /* columns of Phi'K Phi and Phi'M Phi */
} projection;

static void projection_free(projection *p)
{
    ritz_sparse_free(&p->border);
    ritz_dense_free(&p->product);
    ritz_dense_free(&p->some_K);
    ritz_dense_free(&p->some_M);
    RITZ_FREE(p->y, p->low);
}

/* Column k of the border has the entries of the rank's rows of K in column k of
   those of other ranks. */
static ritz_status copy_border(const assessor *a, ritz_sparse *out)
{
    const ritz_sparse *K = &a->K;
    RITZ_OWN_ARRAY int64_t *next = NULL;
    int64_t entries = 0;

    RITZ_CHECK_NEW(next, a->far + 1);
    for (int64_t p = 0; p < K->colptr[a->own]; p++)
        if (K->rowind[p] >= a->own) {
            next[K->rowind[p] - a->own + 1]++;
            entries++;
        }
    RITZ_CHECK(ritz_sparse_new(a->own, a->far, entries, out));
    for (int64_t k = 0; k < a->far; k++)
        out->colptr[k + 1] = next[k + 1] += next[k];
    for (int64_t i = 0; i < a->own; i++)
        for (int64_t p = K->colptr[i]; p < K->colptr[i + 1]; p++)
            if (K->rowind[p] >= a->own) {
                const int64_t at = next[K->rowind[p] - a->own]++;

                out->rowind[at] = i;
                out->val[at] = K->val[p];
            }
    return RITZ_OK;
}

static ritz_status allocate_projection(const assessor *a, int64_t pairs,
                                       int64_t lost, projection *p)
{
    RITZ_CHECK(copy_border(a, &p->border));
    RITZ_CHECK_NEW(p->y, (a->own + a->far) * WIDTH);
    RITZ_CHECK_NEW(p->low, (a->own + a->far) * WIDTH);
    RITZ_CHECK(ritz_dense_new(a->own, WIDTH, &p->product));
    RITZ_CHECK(ritz_dense_new(pairs, lost, &p->some_K));
    return ritz_dense_new(pairs, lost, &p->some_M);
}

/* The rank's rows of K X with twice the digits, to p->y. The first product uses
   that K is symmetric; what it adds to rows of other ranks is not used. */
static void multiply_stiffness(const assessor *a, projection *p)
{
    const size_t size = (size_t)((a->own + a->far) * WIDTH) * sizeof *p->y;
    const ritz_tiles *tiles = ritz_tiles_here();

    memset(p->y, 0, size);
    memset(p->low, 0, size);
    tiles->twofold(&a->K, a->x, p->y, p->low);
    tiles->twofold(&p->border, a->x + a->own * WIDTH, p->y, p->low);
    for (int64_t k = 0; k < a->own * WIDTH; k++)
        p->y[k] += p->low[k];
}

static void multiply_mass(const assessor *a, projection *p)
{
    ritz_tiles_here()->of[0].symmetric(0, a->own, &a->M, a->x, p->y);
}

/* Columns `at` and following of `out`: Phi'y over the rows of this rank. */
static ritz_status project_product(const ritz_dense *Phi, int64_t count,
                                   int64_t at, projection *p, ritz_dense *out)
{
    const ritz_dense y = ritz_dense_part(&p->product, 0, count);
    RITZ_OWN(ritz_dense) part = {0};

    for (int64_t c = 0; c < count; c++)
        for (int64_t i = 0; i < y.nrow; i++)
            ritz_dense_col(&y, c)[i] = p->y[i * WIDTH + c];
    RITZ_CHECK(ritz_dense_mul_tn(Phi, &y, &part));
    ritz_dense_put(&part, 0, at, out);
    return RITZ_OK;
}

/* Fill p->some_K and p->some_M, summed over all ranks. Every rank takes part in
   each load_columns(), also after a failure. */
static ritz_status project_pairs(const assessor *a, const ritz_dense *Phi,
                                 int64_t first, projection *p)
{
    const int64_t end = first + p->some_K.ncol;
    const int64_t entries = p->some_K.nrow * p->some_K.ncol;
    ritz_status status = RITZ_OK;

    for (int64_t j = first; j < end; j += WIDTH) {
        const int64_t count = count_next(j, end);

        load_columns(a, Phi, j, count);
        multiply_stiffness(a, p);
        if (status == RITZ_OK)
            status = project_product(Phi, count, j - first, p, &p->some_K);
        multiply_mass(a, p);
        if (status == RITZ_OK)
            status = project_product(Phi, count, j - first, p, &p->some_M);
    }
    RANKS_CHECK(status);
    ranks_sum(p->some_K.val, entries);
    ranks_sum(p->some_M.val, entries);
    return RITZ_OK;
}

/* Eigenvalues, and coefficients of the vectors, from rank 0 in every rank. */
static ritz_status turn_pairs(const projection *p, ritz_pairs *P, ritz_dense *Q)
{
    RITZ_OWN(ritz_pairs) found = {0};
    const int64_t pairs = P->Phi.ncol;
    ritz_status status = RITZ_OK;

    RANKS_CHECK(ritz_dense_new(pairs, pairs, Q));
    if (ranks_own() == 0)
        status = ritz_pairs_turn(P, &p->some_K, &p->some_M, &found);
    RANKS_CHECK(status);
    if (ranks_own() == 0 && found.lambda) {
        memcpy(P->lambda, found.lambda, (size_t)pairs * sizeof *P->lambda);
        ritz_dense_put(&found.Phi, 0, 0, Q);
    }
    ranks_share(P->lambda, pairs * (int64_t)sizeof *P->lambda);
    ranks_share(Q->val, pairs * pairs * (int64_t)sizeof *Q->val);
    return RITZ_OK;
}

ritz_status assessor_sharpen(const assessor *a, Mat X, const double *energy,
                             ritz_pairs *P)
{
    int64_t lost = ritz_pairs_lost(P, energy) - P->num_rigid;
    double scale = 0.0; /* as of ritz_pairs_relate() */
    RITZ_OWN(projection) p = {0};
    RITZ_OWN(ritz_dense) Q = {0};
    ritz_status status = RITZ_OK;
    ritz_dense x;

    ranks_share(&lost, (int64_t)sizeof lost); /* sums may differ by rounding */
    if (lost == 0)
        return RITZ_OK;
    RANKS_CHECK(allocate_projection(a, P->Phi.ncol, lost, &p));
    x = block_take(X);
    status = project_pairs(a, &x, P->num_rigid, &p);
    if (status == RITZ_OK)
        status = turn_pairs(&p, P, &Q);
    if (status == RITZ_OK)
        status = ranks_agree(ritz_dense_times(&Q, &x));
    block_return(X, &x);
    RITZ_CHECK(status);
    for (int64_t j = 0; j < P->Phi.ncol; j++)
        scale = fmax(scale, energy[j]);
    P->num_rigid = ritz_eigen_rigid(P->Phi.ncol, P->lambda, scale);
    ranks_share(&P->num_rigid, (int64_t)sizeof P->num_rigid);
    return RITZ_OK;
}
