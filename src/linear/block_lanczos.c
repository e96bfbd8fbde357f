#include "linear/block_lanczos.h"

#include "base/alloc.h"
#include "base/memory.h"
#include "base/tolerances.h"
#include "linear/blas_threads.h"
#include "linear/blocks.h"
#include "linear/factor.h"

#include <inttypes.h>
#include <lapacke.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    B = RITZ_BLOCK,
    SQUARE = RITZ_SQUARE,
    MORE_BLOCKS = 12, /* room in addition to 4 k vectors, for small k */
    RESTARTS = 40,
    ALONE = 600, /* order of T up to which LAPACK is fastest on one thread */
    SPARES = 8,  /* converged pairs returned in addition to the k requested */
};

/* Blocks are n x 8 as blocks.h has them, with rows in the factor's order. */
typedef struct block_lanczos {
    const ritz_shifted *S;
    ritz_blocks on;
    ritz_row_matrix M;
    int64_t n, k;
    int64_t room, blocks; /* of V: the most, and those it has */
    double *V;            /* room + 1 blocks, the next block included */
    double *W, *MW, *MV;
    double *T;         /* V'M A^-1 M V, of order 8 room, column-major */
    double *C;         /* 8 x 8 coefficients for each block of V */
    double *Z, *theta; /* eigenvectors and eigenvalues of T, ascending */
    int64_t *rank;     /* of theta, by magnitude, the largest first */
    int64_t coupled;   /* T has blocks of the last column from here on */
    uint64_t noise;
} block_lanczos;

static void block_lanczos_free(block_lanczos *L)
{
    ritz_blocks_free(&L->on);
    ritz_row_matrix_free(&L->M);
    RITZ_FREE(L->V, L->W, L->MW, L->MV, L->T, L->C, L->Z, L->theta, L->rank);
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
    RITZ_CHECK(ritz_memory_admit(
        "the Lanczos basis", (L->room + 1) * L->n * B * (int64_t)sizeof *L->V));
    RITZ_CHECK_RAW(L->V, (L->room + 1) * L->n * B); /* most is never used */
    RITZ_CHECK_NEW(L->W, L->n * B);
    RITZ_CHECK_NEW(L->MW, L->n * B);
    RITZ_CHECK_NEW(L->MV, L->n * B);
    RITZ_CHECK_NEW(L->T, order * order);
    RITZ_CHECK_NEW(L->Z, order * order);
    RITZ_CHECK_NEW(L->theta, order);
    RITZ_CHECK_NEW(L->rank, order);
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

/* X -= V L->C of blocks [first, first + count); L->C changes its sign. */
static void subtract_blocks(const block_lanczos *L, int64_t first,
                            int64_t count, double *X)
{
    for (int64_t i = 0; i < count * SQUARE; i++)
        L->C[i] = -L->C[i];
    add_blocks(L, first, count, L->C, X);
}

/* --- orthonormal blocks --------------------------------------------------- */

/* Orthonormalise a block, X := Q of X = Q R, by two Cholesky factors of X'MX.
   False, with X and MX unchanged, if a vector is no longer than `least` or
   depends on the others. */
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
        if (!ritz_square_factor(G, Q, 0.0)) /* G is nearly the identity */
            return false;
        ritz_square_multiply(Q, R);
    }
}

/* Make column j orthogonal to the columns of `others`, in two passes, and
   divide it by its length. It becomes zero, and false is returned, if what is
   left is no longer than `least`, or if x'M x is only rounding, as for a vector
   that moves no mass. The coefficients are added to column j of R. */
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

/* W := Q of W = Q R, column by column. settled[j] is false where column j
   depends on those before it; it is zero then, and so is row j of R. */
static void settle_columns(block_lanczos *L, double least, bool *settled,
                           double *R)
{
    memset(settled, 0, B * sizeof *settled);
    memset(R, 0, SQUARE * sizeof *R);
    for (int j = 0; j < B; j++)
        settled[j] = settle_column(L, j, settled, least, L->W, L->MW, R);
}

/* X := X - V V'M X, in two passes, and MX := M X. */
static void take_out_blocks(block_lanczos *L, double *X, double *MX)
{
    for (int pass = 0; pass < 2; pass++) {
        multiply_mass(L, X, MX);
        project_blocks(L, 0, L->blocks, MX);
        subtract_blocks(L, 0, L->blocks, X);
    }
    multiply_mass(L, X, MX);
}

/* W := A^-1 M times random vectors, and MW := M W. */
static void start_block(block_lanczos *L)
{
    for (int64_t i = 0; i < L->n * B; i++)
        L->MW[i] = ritz_general_noise(&L->noise);
    multiply_mass(L, L->MW, L->W);
    ritz_factor_solve_rows(L->S->A, L->W);
    multiply_mass(L, L->W, L->MW);
}

/*
 * Replace each column of W that is not `settled` by a random vector,
 * orthonormal to V and to the other columns, with which the iteration goes on.
 * Where V already spans the range of A^-1 M, no vector is left: the column
 * stays zero and not settled, and its row and column of T are zero.
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
 * W := Q of W = Q R, and MW := M Q. `size` is the norm of the components
 * along V that were subtracted from W. Columns of W that are only rounding
 * errors of that subtraction are replaced by random ones, and their rows of R
 * are zero.
 *
 * Dividing a short column by its length makes its rounding errors as much
 * longer, and these have components along V: so V is subtracted once more.
 *
 * @param[out] exhausted  no direction is left: all of Q is zero
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

/* The block of T at rows of V_i and columns of V_j, column-major. */
static double *place_projected(const block_lanczos *L, int64_t i, int64_t j)
{
    return L->T + i * B + j * B * (L->room * B);
}

/* T_ij := C and T_ji := C', C row by row. */
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

/* C := T_ij, row by row. */
static void take_projected(const block_lanczos *L, int64_t i, int64_t j,
                           double *C)
{
    for (int r = 0; r < B; r++)
        for (int c = 0; c < B; c++)
            C[r * B + c] = place_projected(L, i, j)[r + c * (L->room * B)];
}

/*
 * W := A^-1 M V_j minus its components along V, and MW := M W; sets T_jj.
 * First the components along the blocks that T couples with V_j are subtracted,
 * whose coefficients are known from T, and along V_j itself. Then all of V is
 * subtracted once more, which keeps W orthogonal to working accuracy.
 *
 * @param[out] size  norm of the coefficients that were subtracted
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

/* Rank the eigenvalues theta of T by magnitude, the largest first. Theta of an
   eigenvalue below sigma is negative. */
static void rank_magnitudes(block_lanczos *L)
{
    int64_t low = 0;
    int64_t high = L->blocks * B - 1;

    for (int64_t c = 0; low <= high; c++)
        L->rank[c] = -L->theta[low] > L->theta[high] ? low++ : high--;
}

/* Z := the projected matrix, m x m. */
static void copy_projected(block_lanczos *L, int64_t m)
{
    for (int64_t j = 0; j < m; j++)
        memcpy(L->Z + j * m, L->T + j * L->room * B, (size_t)m * sizeof *L->Z);
}

/* Eigenpairs of T. Divide and conquer, which is fastest, may fail to converge
   where many eigenvalues are nearly equal; QR iterations then do not. */
static ritz_status solve_projected(block_lanczos *L)
{
    const int64_t m = L->blocks * B;
    int before = 0;
    int info = 0;

    /* for a small T the threads of the BLAS mostly wait for each other */
    if (m <= ALONE)
        before = ritz_blas_threads(1);
    copy_projected(L, m);
    info = LAPACKE_dsyevd(LAPACK_COL_MAJOR, 'V', 'U', (int)m, L->Z, (int)m,
                          L->theta);
    if (info > 0) {
        copy_projected(L, m);
        info = LAPACKE_dsyev(LAPACK_COL_MAJOR, 'V', 'U', (int)m, L->Z, (int)m,
                             L->theta);
    }
    ritz_blas_threads(before);
    RITZ_REFUSE_IF(info == LAPACK_WORK_MEMORY_ERROR, RITZ_ERR_MEMORY,
                   "no memory for eigenvectors of order %" PRId64, m);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_CONVERGENCE,
                   "the eigenvectors of order %" PRId64 " cannot be found", m);
    rank_magnitudes(L);
    return RITZ_OK;
}

/* q := R z_j, z_j the last eight components of the vector of the c-th largest
   theta (c from 0): |q| is the norm of its residual. */
static void last_part(const block_lanczos *L, int64_t c, const double *R,
                      double *q)
{
    const int64_t m = L->blocks * B;
    const double *z = L->Z + L->rank[c] * m + (m - B);

    for (int i = 0; i < B; i++) {
        q[i] = 0.0;
        for (int k = 0; k < B; k++)
            q[i] += R[i * B + k] * z[k];
    }
}

/* How many theta, counted from the largest, have converged; at most `most`. */
static int64_t count_converged(const block_lanczos *L, int64_t most,
                               const double *R)
{
    const int64_t m = L->blocks * B;
    int64_t c = 0;

    for (c = 0; c < most && c < m; c++) {
        const double theta = fabs(L->theta[L->rank[c]]);
        double q[B];
        double size = 0.0;

        last_part(L, c, R, q);
        for (int i = 0; i < B; i++)
            size = hypot(size, q[i]);
        if (!(size <= RITZ_LANCZOS_SETTLED * theta) ||
            theta <= RITZ_NO_DIRECTION * fabs(L->theta[L->rank[0]]))
            break;
    }
    return c;
}

/* C := coefficients of the Ritz vectors of the c-th to (c + 7)-th largest
   theta, those before `end`, in the blocks of V and in the next block. R NULL:
   without the inverse iteration, so that those in the next block are zero. */
static void combine_ritz(const block_lanczos *L, int64_t c, int64_t end,
                         const double *R, double *C)
{
    const int64_t m = L->blocks * B;

    memset(C, 0, (size_t)((L->blocks + 1) * SQUARE) * sizeof *C);
    for (int k = 0; k < B && c + k < end; k++) {
        const int64_t at = L->rank[c + k];
        const double *z = L->Z + at * m;
        double q[B];

        for (int64_t i = 0; i < m; i++)
            C[i * B + k] = z[i];
        if (!R)
            continue;
        last_part(L, c + k, R, q);
        for (int i = 0; i < B; i++)
            C[(m + i) * B + k] = q[i] / L->theta[at];
    }
}

/* The first `kept` blocks of V become the Ritz vectors of the largest theta,
   those before `end`. R as for combine_ritz(). */
static ritz_status keep_ritz(block_lanczos *L, int64_t kept, int64_t end,
                             const double *R)
{
    const int64_t part = (L->blocks + 1) * SQUARE;
    RITZ_OWN_ARRAY double *C = NULL, *room = NULL;

    RITZ_CHECK_NEW(C, kept * part);
    RITZ_CHECK_NEW(room, ritz_blocks_room(&L->on, kept));
    for (int64_t g = 0; g < kept; g++)
        combine_ritz(L, g * B, end, R, C + g * part);
    ritz_blocks_combine(&L->on, L->blocks + (R ? 1 : 0), kept, part, C, room,
                        L->V);
    return RITZ_OK;
}

/* Free the blocks of V from `kept` on; a failure costs only memory. */
static void shorten_basis(block_lanczos *L, int64_t kept)
{
    const size_t size = (size_t)(kept * L->n * B) * sizeof *L->V;
    double *shorter = size > 0 ? realloc(L->V, size) : NULL;

    L->V = shorter ? shorter : L->V;
}

/* X := Ritz vectors of the `count` largest theta, rows in the order of M. They
   replace V, so that memory does not hold both. */
static ritz_status extract_vectors(block_lanczos *L, int64_t count,
                                   const double *R, ritz_dense *X)
{
    const int64_t *order = ritz_factor_order(L->S->A);
    const int64_t kept = (count + B - 1) / B;

    RITZ_CHECK(keep_ritz(L, kept, count, R));
    shorten_basis(L, kept);
    RITZ_CHECK(ritz_dense_new(L->n, count, X));
    for (int64_t c = 0; c < count; c += B)
        for (int64_t i = 0; i < L->n; i++)
            for (int64_t k = 0; k < B && c + k < count; k++)
                X->val[order[i] + (c + k) * L->n] =
                    block_at(L, c / B)[i * B + k];
    return RITZ_OK;
}

/* How many blocks of Ritz vectors a restart keeps: 5 k / 4 vectors and more. */
static int64_t blocks_kept(const block_lanczos *L)
{
    return (L->k + L->k / 4 + B - 1) / B + 1;
}

/*
 * Thick restart [WuSimon2000]: the blocks of V become the Ritz vectors of the
 * largest theta, followed by the block that came after V. In T these vectors
 * have theta on the diagonal, and that block is coupled with each of them by
 * R z_j.
 */
static ritz_status restart_space(block_lanczos *L, const double *R)
{
    const int64_t m = L->blocks * B;
    const int64_t ld = L->room * B;
    const int64_t kept = blocks_kept(L);

    RITZ_CHECK(keep_ritz(L, kept, m, NULL));
    memset(L->T, 0, (size_t)(ld * ld) * sizeof *L->T);
    for (int64_t c = 0; c < kept * B; c++) {
        double q[B];

        last_part(L, c, R, q);
        L->T[c + c * ld] = L->theta[L->rank[c]];
        for (int i = 0; i < B; i++) {
            L->T[(kept * B + i) + c * ld] = q[i];
            L->T[c + (kept * B + i) * ld] = q[i];
        }
    }
    memcpy(block_at(L, kept), block_at(L, L->blocks),
           (size_t)(L->n * B) * sizeof *L->V);
    L->blocks = kept + 1;
    L->coupled = 0;
    return RITZ_OK;
}

/* Whether to look for converged pairs, which costs an eigensolution of T: once
   V has *next blocks or is full; sets *next for the time after. */
static bool is_time_to_look(const block_lanczos *L, int64_t *next)
{
    if (L->blocks < *next && L->blocks < L->room)
        return false;
    *next = L->blocks + 1 + L->blocks / 32;
    return true;
}

/* Whether at least k pairs have converged, and S->below of them lie below
   sigma. */
static bool is_enough(const block_lanczos *L, int64_t found)
{
    int64_t below = 0;

    for (int64_t c = 0; c < found; c++)
        below += L->theta[L->rank[c]] < 0.0;
    return found >= L->k && below >= L->S->below;
}

/* Extend V until k pairs have converged. R is that of the block after V. */
static ritz_status iterate_blocks(block_lanczos *L, double *R, int64_t *found,
                                  ritz_lanczos_end *end)
{
    /* no check of convergence before there are 2.4 basis vectors for each pair,
       or 1.4 if eigenvalues lie on both sides of sigma */
    int64_t next = ((L->S->below > 0 ? 7 : 12) * L->k / 5 + B - 1) / B;
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
            *found = count_converged(
                L, L->S->below > 0 ? L->blocks * B : L->k + SPARES, R);
            *end = exhausted && !is_enough(L, *found) ? RITZ_LANCZOS_EXHAUSTED
                                                      : RITZ_LANCZOS_FOUND;
            if (exhausted || is_enough(L, *found))
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

/* The eigenvalue of the c-th largest theta; HUGE_VAL if theta is rounding. */
static double eigenvalue_at(const block_lanczos *L, int64_t c)
{
    const int64_t m = L->blocks * B;
    const double theta = c < m ? L->theta[L->rank[c]] : 0.0;

    return fabs(theta) > RITZ_NO_DIRECTION * fabs(L->theta[L->rank[0]])
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
    if (*end == RITZ_LANCZOS_SLOW)
        *next = eigenvalue_at(&L, k - 1);
    if (*end != RITZ_LANCZOS_FOUND)
        return RITZ_OK;
    *next = eigenvalue_at(&L, found);
    RITZ_CHECK_NEW(values, found);
    for (int64_t c = 0; c < found; c++)
        values[c] = eigenvalue_at(&L, c);
    RITZ_CHECK(extract_vectors(&L, found, R, X));
    RITZ_MOVE(*lambda, values);
    return RITZ_OK;
}
