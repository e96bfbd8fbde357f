#include "linear/block_lanczos.h"

#include "base/tolerances.h"
#include "linear/blas_threads.h"
#include "linear/blocks.h"
#include "linear/factor.h"

#include <inttypes.h>
#include <lapacke.h>
#include <limits.h>
#include <math.h>
#include <string.h>

enum {
    B = RITZ_BLOCK,
    SQUARE = RITZ_SQUARE,
    MORE_BLOCKS = 12, /* room beyond what convergence mostly takes */
    RESTARTS = 40,
    ALONE = 600, /* order of T up to which one thread of the BLAS is enough */
    SPARES = 8,  /* converged pairs beyond those asked for that are returned */
};

/* Blocks of n x 8, row by row, in the order of the factor. */
typedef struct block_lanczos {
    const ritz_shifted *S;
    ritz_blocks on; /* how blocks are computed with */
    ritz_row_matrix M;
    int64_t n, k;
    int64_t room, blocks; /* of V */
    double *V;            /* the blocks, and one more behind them */
    double *W, *MW, *MV;
    double *T;         /* (8 room) square, symmetric */
    double *C;         /* 8 x 8 for each block of V and the one behind */
    double *Z, *theta; /* of T, ascending */
    int64_t coupled;   /* the first block that the last one is coupled with */
    uint64_t noise;
} block_lanczos;

static void block_lanczos_free(block_lanczos *L)
{
    ritz_blocks_free(&L->on);
    ritz_row_matrix_free(&L->M);
    RITZ_FREE(L->V, L->W, L->MW, L->MV, L->T, L->C, L->Z, L->theta);
}

static double *block_at(const block_lanczos *L, int64_t j)
{
    return L->V + j * L->n * B;
}

static ritz_status allocate_lanczos(block_lanczos *L, int64_t room)
{
    const int64_t most = (L->n + B - 1) / B;
    int64_t order = 0;

    L->room = room > 0 ? room / B : (4 * L->k + B - 1) / B + MORE_BLOCKS;
    L->room = L->room < most ? L->room : most;
    order = L->room * B;
    RITZ_REFUSE_IF(order > INT_MAX / 8, RITZ_ERR_ARGUMENT,
                   "%" PRId64 " modes of %" PRId64
                   " dofs are more than can be found",
                   L->k, L->n);
    RITZ_CHECK_NEW(L->V, (L->room + 1) * L->n * B);
    RITZ_CHECK_NEW(L->W, L->n * B);
    RITZ_CHECK_NEW(L->MW, L->n * B);
    RITZ_CHECK_NEW(L->MV, L->n * B);
    RITZ_CHECK_NEW(L->T, order * order);
    RITZ_CHECK_NEW(L->Z, order * order);
    RITZ_CHECK_NEW(L->theta, order);
    RITZ_CHECK_NEW(L->C, (L->room + 1) * SQUARE);
    RITZ_CHECK(ritz_blocks_new(L->n, ritz_factor_threads(L->S->A), L->room + 1,
                               &L->on));
    return ritz_row_matrix_new(L->S->M, ritz_factor_order(L->S->A), &L->M);
}

/* Y := M X */
static void multiply_mass(const block_lanczos *L, const double *X, double *Y)
{
    ritz_blocks_multiply(&L->on, &L->M, X, Y);
}

/* L->C := V'X of blocks [first, first + count). */
static void project_blocks(const block_lanczos *L, int64_t first, int64_t count,
                           const double *X)
{
    ritz_blocks_project(&L->on, count, block_at(L, first), X, L->C);
}

/* X += V C of blocks [first, first + count). */
static void add_blocks(const block_lanczos *L, int64_t first, int64_t count,
                       const double *C, double *X)
{
    ritz_blocks_add(&L->on, count, block_at(L, first), C, X);
}

/* X -= V C of blocks [first, first + count), C in L->C. */
static void subtract_blocks(const block_lanczos *L, int64_t first,
                            int64_t count, double *X)
{
    for (int64_t i = 0; i < count * SQUARE; i++)
        L->C[i] = -L->C[i];
    add_blocks(L, first, count, L->C, X);
}

/* --- orthonormal blocks --------------------------------------------------- */

/* Cholesky of X'MX, twice; false, with X and MX unchanged, if a column depends
   on others or is no longer than `least`. */
static bool settle_block(block_lanczos *L, double least, double *X, double *MX,
                         double *R)
{
    double G[SQUARE], Q[SQUARE], U[SQUARE];

    ritz_blocks_inner(&L->on, X, MX, G);
    for (int j = 0; j < B; j++)
        if (!(G[j * B + j] > least * least))
            return false;
    if (!ritz_square_factor(G, R, RITZ_GRAM_DEPENDENT))
        return false;
    for (int pass = 0;; pass++) {
        ritz_square_invert(pass == 0 ? R : Q, U);
        ritz_blocks_transform(&L->on, U, X);
        ritz_blocks_transform(&L->on, U, MX);
        if (pass == 1)
            return true;
        ritz_blocks_inner(&L->on, X, MX, G);
        if (!ritz_square_factor(G, Q, 0.0)) /* of the unit matrix, nearly */
            return false;
        ritz_square_multiply(Q, R);
    }
}

/* Column j made orthonormal to the columns of `others`, twice; false, and zero,
   if no more than `least` of its length is left, or rounding: a vector without
   mass has some. R += its coefficients. */
static bool settle_column(block_lanczos *L, int j, const bool *others,
                          double least, double *X, double *MX, double *R)
{
    double size = 0.0;
    bool settled = false;

    for (int pass = 0; pass < 2; pass++)
        for (int k = 0; k < B; k++) {
            const double r =
                others[k] ? ritz_columns_inner(L->n, X, k, MX, j) : 0.0;

            if (r == 0.0)
                continue;
            ritz_columns_add(L->n, -r, k, j, X);
            ritz_columns_add(L->n, -r, k, j, MX);
            R[k * B + j] += r;
        }
    size = sqrt(fmax(ritz_columns_inner(L->n, X, j, MX, j), 0.0));
    settled =
        size > least &&
        size * size > RITZ_NO_DIRECTION * ritz_row_matrix_terms(&L->M, X, j);
    R[j * B + j] = settled ? size : 0.0;
    ritz_columns_scale(L->n, settled ? 1.0 / size : 0.0, j, X);
    ritz_columns_scale(L->n, settled ? 1.0 / size : 0.0, j, MX);
    return settled;
}

/* W := Q of W = Q R, column by column; those that are not settled are zero, and
   so are their rows of R. */
static void settle_columns(block_lanczos *L, double least, bool *settled,
                           double *R)
{
    memset(settled, 0, B * sizeof *settled);
    memset(R, 0, SQUARE * sizeof *R);
    for (int j = 0; j < B; j++)
        settled[j] = settle_column(L, j, settled, least, L->W, L->MW, R);
}

/* Take the parts in V out of X, and MX := M X. */
static void take_out_blocks(block_lanczos *L, double *X, double *MX)
{
    for (int pass = 0; pass < 2; pass++) {
        multiply_mass(L, X, MX);
        project_blocks(L, 0, L->blocks, MX);
        subtract_blocks(L, 0, L->blocks, X);
    }
    multiply_mass(L, X, MX);
}

/* W: random vectors in the range of A^-1 M, and MW := M W. */
static void start_block(block_lanczos *L)
{
    for (int64_t i = 0; i < L->n * B; i++)
        L->MW[i] = ritz_general_noise(&L->noise);
    multiply_mass(L, L->MW, L->W);
    ritz_factor_solve_rows(L->S->A, L->W);
    multiply_mass(L, L->W, L->MW);
}

/*
 * Random columns in the place of those that are not `settled`, orthonormal to
 * all others: they continue the iteration elsewhere. Where there is no further
 * direction, the column is zero, and so are its row and column of T.
 */
static ritz_status refill_block(block_lanczos *L, bool *settled)
{
    RITZ_OWN_ARRAY double *X = NULL, *MX = NULL;
    double G[SQUARE];

    RITZ_CHECK_COPY(X, L->W, L->n * B);
    RITZ_CHECK_COPY(MX, L->MW, L->n * B);
    start_block(L);
    ritz_blocks_inner(&L->on, L->W, L->MW, G);
    take_out_blocks(L, L->W, L->MW);
    for (int64_t i = 0; i < L->n * B; i++)
        if (settled[i % B]) {
            L->W[i] = X[i];
            L->MW[i] = MX[i];
        }
    for (int j = 0; j < B; j++) {
        const double length = sqrt(fmax(G[j * B + j], 0.0));
        double unused[SQUARE] = {0};

        if (!settled[j])
            settled[j] = settle_column(
                L, j, settled, RITZ_NO_DIRECTION * length, L->W, L->MW, unused);
    }
    return RITZ_OK;
}

static int count_settled(const bool *settled)
{
    int count = 0;

    for (int j = 0; j < B; j++)
        count += settled[j];
    return count;
}

/*
 * W := Q of W = Q R, and MW := M Q; `size` is that of what W is the rest of.
 * Columns that are only rounding of it are replaced; their rows of R are zero.
 *
 * A column of which little is left has become long by its division, and so has
 * the rounding in it, which lies in V, too: it is taken out once more.
 *
 * @param[out] exhausted  Q is zero
 */
static ritz_status orthonormalise(block_lanczos *L, double size, double *R,
                                  bool *exhausted)
{
    const double least = RITZ_NO_DIRECTION * size;
    bool settled[B] = {false};
    double Q[SQUARE];

    *exhausted = false;
    if (settle_block(L, least, L->W, L->MW, R))
        return RITZ_OK;
    settle_columns(L, least, settled, R);
    for (int pass = 0; pass < 2; pass++) {
        if (count_settled(settled) < B)
            RITZ_CHECK(refill_block(L, settled));
        take_out_blocks(L, L->W, L->MW);
        settle_columns(L, RITZ_MOSTLY_LEFT, settled, Q);
        ritz_square_multiply(Q, R);
    }
    *exhausted = count_settled(settled) == 0;
    return RITZ_OK;
}

/* --- the iteration -------------------------------------------------------- */

/* T's block at rows of block i and columns of block j. */
static double *place_projected(const block_lanczos *L, int64_t i, int64_t j)
{
    return L->T + i * B + j * B * (L->room * B);
}

/* Blocks of T := C and C', C row by row. */
static void put_projected(block_lanczos *L, int64_t i, int64_t j,
                          const double *C)
{
    const int64_t ld = L->room * B;

    for (int r = 0; r < B; r++)
        for (int c = 0; c < B; c++) {
            place_projected(L, i, j)[r + c * ld] = C[r * B + c];
            place_projected(L, j, i)[c + r * ld] = C[r * B + c];
        }
}

/* C := a block of T, row by row. */
static void take_projected(const block_lanczos *L, int64_t i, int64_t j,
                           double *C)
{
    for (int r = 0; r < B; r++)
        for (int c = 0; c < B; c++)
            C[r * B + c] = place_projected(L, i, j)[r + c * (L->room * B)];
}

/*
 * W := A^-1 M V_j without its parts in V, MW := M W: first the blocks that it
 * is coupled with, by the coefficients that are known, and then all of V once
 * more. *size: the length of what was taken out.
 */
static void expand_space(block_lanczos *L, double *size)
{
    const int64_t j = L->blocks - 1;
    double A[SQUARE];

    memcpy(L->W, L->MV, (size_t)(L->n * B) * sizeof *L->W);
    ritz_factor_solve_rows(L->S->A, L->W);
    *size = 0.0;
    for (int64_t p = L->coupled; p < j; p++) {
        take_projected(L, p, j, L->C + (p - L->coupled) * SQUARE);
        *size =
            hypot(*size, ritz_square_size(L->C + (p - L->coupled) * SQUARE));
    }
    subtract_blocks(L, L->coupled, j - L->coupled, L->W);
    ritz_blocks_inner(&L->on, L->MV, L->W, A);
    memcpy(L->C, A, sizeof A);
    subtract_blocks(L, j, 1, L->W);
    multiply_mass(L, L->W, L->MW);
    project_blocks(L, 0, L->blocks, L->MW);
    for (int i = 0; i < SQUARE; i++)
        A[i] += L->C[j * SQUARE + i];
    subtract_blocks(L, 0, L->blocks, L->W);
    multiply_mass(L, L->W, L->MW);
    for (int r = 0; r < B; r++)
        for (int c = 0; c < r; c++)
            A[r * B + c] = A[c * B + r] = 0.5 * (A[r * B + c] + A[c * B + r]);
    put_projected(L, j, j, A);
    *size = hypot(*size, ritz_square_size(A));
}

/* Eigenpairs of T. */
static ritz_status solve_projected(block_lanczos *L)
{
    const int64_t m = L->blocks * B;
    int before = 0;
    int info = 0;

    for (int64_t j = 0; j < m; j++)
        memcpy(L->Z + j * m, L->T + j * L->room * B, (size_t)m * sizeof *L->Z);
    /* threads of the BLAS that wait for each other cost more than they bring */
    if (m <= ALONE)
        before = ritz_blas_threads(1);
    info = LAPACKE_dsyevd(LAPACK_COL_MAJOR, 'V', 'U', (int)m, L->Z, (int)m,
                          L->theta);
    ritz_blas_threads(before);
    RITZ_REFUSE_IF(info == LAPACK_WORK_MEMORY_ERROR, RITZ_ERR_MEMORY,
                   "no memory for eigenvectors of order %" PRId64, m);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_CONVERGENCE,
                   "the eigenvectors of order %" PRId64 " cannot be found", m);
    return RITZ_OK;
}

/* q := R z_j of the c-th largest theta. */
static void last_part(const block_lanczos *L, int64_t c, const double *R,
                      double *q)
{
    const int64_t m = L->blocks * B;
    const double *z = L->Z + (m - 1 - c) * m + (m - B);

    for (int i = 0; i < B; i++) {
        q[i] = 0.0;
        for (int k = 0; k < B; k++)
            q[i] += R[i * B + k] * z[k];
    }
}

/* The number of largest theta, from the first, that have converged. */
static int64_t count_converged(const block_lanczos *L, int64_t most,
                               const double *R)
{
    const int64_t m = L->blocks * B;
    int64_t c = 0;

    for (c = 0; c < most && c < m; c++) {
        double q[B];
        double size = 0.0;

        last_part(L, c, R, q);
        for (int i = 0; i < B; i++)
            size = hypot(size, q[i]);
        if (!(size <= RITZ_LANCZOS_SETTLED * L->theta[m - 1 - c]) ||
            L->theta[m - 1 - c] <= RITZ_NO_DIRECTION * L->theta[m - 1])
            break;
    }
    return c;
}

/* Coefficients, in V and the block behind it, of eight Ritz vectors from the
   c-th on, up to `end`. */
static void combine_ritz(const block_lanczos *L, int64_t c, int64_t end,
                         const double *R, double *C)
{
    const int64_t m = L->blocks * B;

    memset(C, 0, (size_t)((L->blocks + 1) * SQUARE) * sizeof *C);
    for (int k = 0; k < B && c + k < end; k++) {
        const double *z = L->Z + (m - 1 - c - k) * m;
        double q[B];

        for (int64_t i = 0; i < m; i++)
            C[i * B + k] = z[i];
        if (!R)
            continue;
        last_part(L, c + k, R, q);
        for (int i = 0; i < B; i++)
            C[(m + i) * B + k] = q[i] / L->theta[m - 1 - c - k];
    }
}

/* Ritz vectors of the `count` largest theta, the last block of V being behind
   it. */
static ritz_status extract_vectors(block_lanczos *L, int64_t count,
                                   const double *R, ritz_dense *X)
{
    const int64_t *order = ritz_factor_order(L->S->A);

    RITZ_CHECK(ritz_dense_new(L->n, count, X));
    for (int64_t c = 0; c < count; c += B) {
        combine_ritz(L, c, count, R, L->C);
        memset(L->W, 0, (size_t)(L->n * B) * sizeof *L->W);
        add_blocks(L, 0, L->blocks + 1, L->C, L->W);
        for (int64_t i = 0; i < L->n; i++)
            for (int64_t k = 0; k < B && c + k < count; k++)
                X->val[order[i] + (c + k) * L->n] = L->W[i * B + k];
    }
    return RITZ_OK;
}

/* Blocks of Ritz vectors that a restart keeps. */
static int64_t blocks_kept(const block_lanczos *L)
{
    return (L->k + L->k / 4 + B - 1) / B + 1;
}

/*
 * Thick restart [WuSimon2000]: V becomes Ritz vectors of the largest theta, and
 * the block that was behind V, which is coupled with all of them by R z_j.
 */
static ritz_status restart_space(block_lanczos *L, const double *R)
{
    const int64_t m = L->blocks * B;
    const int64_t ld = L->room * B;
    const int64_t kept = blocks_kept(L);
    const int64_t part = (L->blocks + 1) * SQUARE;
    RITZ_OWN_ARRAY double *C = NULL, *room = NULL;

    RITZ_CHECK_NEW(C, kept * part);
    RITZ_CHECK_NEW(room, ritz_blocks_room(&L->on, kept));
    memset(L->T, 0, (size_t)(ld * ld) * sizeof *L->T);
    for (int64_t g = 0; g < kept; g++)
        combine_ritz(L, g * B, m, NULL, C + g * part);
    for (int64_t c = 0; c < kept * B; c++) {
        double q[B];

        last_part(L, c, R, q);
        L->T[c + c * ld] = L->theta[m - 1 - c];
        for (int i = 0; i < B; i++) {
            L->T[(kept * B + i) + c * ld] = q[i];
            L->T[c + (kept * B + i) * ld] = q[i];
        }
    }
    ritz_blocks_combine(&L->on, L->blocks, kept, part, C, room, L->V);
    memcpy(block_at(L, kept), block_at(L, L->blocks),
           (size_t)(L->n * B) * sizeof *L->V);
    L->blocks = kept + 1;
    L->coupled = 0;
    return RITZ_OK;
}

/* Blocks from which on convergence is looked at, and then every few. */
static bool is_time_to_look(const block_lanczos *L, int64_t *next)
{
    if (L->blocks < *next && L->blocks < L->room)
        return false;
    *next = L->blocks + 1 + L->blocks / 32;
    return true;
}

/* Expand V until k pairs have converged; R is of the last block. */
static ritz_status iterate_blocks(block_lanczos *L, double *R, int64_t *found,
                                  ritz_lanczos_end *end)
{
    int64_t next = (12 * L->k / 5 + B - 1) / B;
    int64_t steps = 0;
    int restarts = 0;
    bool exhausted = false;
    double size = 0.0;

    for (;;) {
        ritz_monitor_step("eigenvectors", ++steps, 0);
        expand_space(L, &size);
        RITZ_CHECK(orthonormalise(L, size, R, &exhausted));
        memcpy(block_at(L, L->blocks), L->W, (size_t)(L->n * B) * sizeof *L->V);
        memcpy(L->MV, L->MW, (size_t)(L->n * B) * sizeof *L->MV);
        if (exhausted || is_time_to_look(L, &next)) {
            RITZ_CHECK(solve_projected(L));
            *found = count_converged(L, L->k + SPARES, R);
            *end = exhausted && *found < L->k ? RITZ_LANCZOS_EXHAUSTED
                                              : RITZ_LANCZOS_FOUND;
            if (exhausted || *found >= L->k)
                return RITZ_OK;
        }
        *end = RITZ_LANCZOS_SLOW;
        if (L->blocks == L->room &&
            (restarts++ == RESTARTS || blocks_kept(L) + 2 > L->room))
            return RITZ_OK;
        if (L->blocks == L->room) {
            RITZ_CHECK(restart_space(L, R));
            next = L->blocks;
            continue;
        }
        put_projected(L, L->blocks, L->blocks - 1, R);
        L->coupled = L->blocks - 1;
        L->blocks++;
    }
}

/* Of the c-th largest theta; HUGE_VAL if that is rounding. */
static double eigenvalue_at(const block_lanczos *L, int64_t c)
{
    const int64_t m = L->blocks * B;
    const double theta = c < m ? L->theta[m - 1 - c] : 0.0;

    return theta > RITZ_NO_DIRECTION * L->theta[m - 1]
               ? L->S->sigma + 1.0 / theta
               : HUGE_VAL;
}

ritz_status ritz_block_lanczos(const ritz_shifted *S, int64_t k, int64_t room,
                               ritz_dense *X, double **lambda, double *next,
                               ritz_lanczos_end *end)
{
    RITZ_OWN(block_lanczos)
    L = {
        .S = S,
        .n = S->M->nrow,
        .k = k,
        .noise = 1998,
    };
    RITZ_OWN_ARRAY double *values = NULL;
    double R[SQUARE];
    int64_t found = 0;
    int64_t m = 0;
    bool exhausted = false;

    RITZ_CHECK(allocate_lanczos(&L, room));
    start_block(&L);
    ritz_blocks_inner(&L.on, L.W, L.MW, R);
    RITZ_CHECK(orthonormalise(&L, sqrt(ritz_square_size(R)), R, &exhausted));
    *end = RITZ_LANCZOS_EXHAUSTED;
    if (exhausted)
        return RITZ_OK;
    memcpy(L.V, L.W, (size_t)(L.n * B) * sizeof *L.V);
    memcpy(L.MV, L.MW, (size_t)(L.n * B) * sizeof *L.MV);
    L.blocks = 1;
    RITZ_CHECK(iterate_blocks(&L, R, &found, end));
    m = L.blocks * B;
    if (*end == RITZ_LANCZOS_SLOW)
        *next = eigenvalue_at(&L, k - 1);
    if (*end != RITZ_LANCZOS_FOUND)
        return RITZ_OK;
    *next = eigenvalue_at(&L, found);
    RITZ_CHECK_NEW(values, found);
    for (int64_t c = 0; c < found; c++)
        values[c] = S->sigma + 1.0 / L.theta[m - 1 - c];
    RITZ_CHECK(extract_vectors(&L, found, R, X));
    RITZ_MOVE(*lambda, values);
    return RITZ_OK;
}
