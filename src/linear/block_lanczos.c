#include "linear/block_lanczos.h"

#include "base/alloc.h"
#include "base/memory.h"
#include "base/tolerances.h"
#include "linear/band.h"
#include "linear/blas_threads.h"
#include "linear/block_basis.h"
#include "linear/factor.h"
#include "linear/folded.h"
#include "linear/lanczos_room.h"

#include <inttypes.h>
#include <lapacke.h>
#include <limits.h>
#include <math.h>
#include <string.h>

enum {
    B = RITZ_BLOCK,
    SQUARE = RITZ_SQUARE,
    WIDEST = RITZ_STEP_WIDEST,
    RESTARTS = 40,
    ALONE = 600, /* order of T up to which LAPACK is fastest on one thread */
};

typedef struct block_lanczos {
    ritz_block_basis b; /* its rows are in the factor's order */
    int64_t k;
    double settled;    /* residual of a pair that has converged */
    int64_t room;      /* of blocks in b */
    double *both;      /* n x 16, for solves of two blocks */
    double *T;         /* V'M A^-1 M V, of order 8 room, column-major */
    double *Z, *theta; /* eigenvectors and eigenvalues of T, ascending */
    int64_t *rank;     /* of theta, by magnitude, the largest first */
    int64_t coupled;   /* T has blocks of the last step from here on */
    bool restarted;    /* T is no band matrix any more */
    double kth;        /* a lower bound of the k-th largest theta; 0: unknown */
} block_lanczos;

static void block_lanczos_free(block_lanczos *L)
{
    ritz_block_basis_free(&L->b);
    RITZ_FREE(L->both, L->T, L->Z, L->theta, L->rank);
}

static ritz_status allocate_lanczos(block_lanczos *L)
{
    const int64_t n = L->b.n;
    const int64_t width = L->b.width;
    const int64_t order = L->room * B;

    RITZ_REFUSE_IF(order > INT_MAX / 8, RITZ_ERR_ARGUMENT,
                   "%" PRId64 " modes of %" PRId64
                   " dofs are more than can be found",
                   L->k, n);
    if (width > 1)
        RITZ_CHECK_NEW(L->both, width * n * B);
    RITZ_CHECK_NEW(L->T, order * order);
    RITZ_CHECK_NEW(L->Z, order * order);
    RITZ_CHECK_NEW(L->theta, order);
    RITZ_CHECK_NEW(L->rank, order);
    return ritz_block_basis_new(L->room, &L->b);
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

/* X := A^-1 X for all blocks of a step. */
static void solve_step(block_lanczos *L, double *X)
{
    if (L->b.width == WIDEST)
        ritz_factor_solve_two(L->b.S->A, X, L->both);
    else
        ritz_factor_solve_rows(L->b.S->A, X);
}

/* L->b.C := the blocks of T in the columns of the last step and in the rows of
   the earlier blocks that it is coupled with. Their norm is returned. */
static double take_coupling(const block_lanczos *L, int64_t j)
{
    const int64_t count = j - L->coupled;
    double size = 0.0;

    for (int64_t k = 0; k < L->b.width * count; k++) {
        double *C = L->b.C + k * SQUARE;

        take_projected(L, L->coupled + k % count, j + k / count, C);
        size = hypot(size, ritz_square_size(C));
    }
    return size;
}

/* T_jj := (A + A') / 2 for the blocks of the last step, the first of which is
   block j of V. A has its 8 x 8 blocks column by column. */
static void put_diagonal(block_lanczos *L, int64_t j, const double *A)
{
    for (int64_t q = 0; q < L->b.width; q++)
        for (int64_t p = 0; p <= q; p++) {
            const double *upper = A + (q * L->b.width + p) * SQUARE;
            const double *lower = A + (p * L->b.width + q) * SQUARE;
            double mean[SQUARE];

            for (int i = 0; i < SQUARE; i++)
                mean[i] = 0.5 * (upper[i] + lower[i % B * B + i / B]);
            put_projected(L, j + p, j + q, mean);
        }
}

/*
 * W := A^-1 M V_j minus its components along V, and MW := M W; sets T_jj. V_j
 * are the blocks of the last step. First the components along the blocks that T
 * couples with V_j are subtracted, whose coefficients are known from T, and
 * along V_j itself. Then all of V is subtracted once more, which keeps W
 * orthogonal to working accuracy.
 *
 * @param[out] size  norm of the coefficients that were subtracted
 */
static ritz_status expand_space(block_lanczos *L, double *size)
{
    const int64_t w = L->b.width;
    const int64_t j = L->b.blocks - w;
    /* M V_j, until it is overwritten by M W */
    double *const MV[] = {L->b.MW, L->b.MW + (w - 1) * L->b.n * B};
    double A[RITZ_STEP_SQUARES * SQUARE];

    memcpy(L->b.W, L->b.MW, (size_t)(w * L->b.n * B) * sizeof *L->b.W);
    solve_step(L, L->b.W);
    *size = take_coupling(L, j);
    RITZ_CHECK(ritz_block_basis_subtract(&L->b, L->coupled, j - L->coupled, w,
                                         L->b.W));
    ritz_blocks_project(&L->b.on, w, MV, w, L->b.W, L->b.C);
    memcpy(A, L->b.C, (size_t)(w * w) * SQUARE * sizeof *A);
    RITZ_CHECK(ritz_block_basis_subtract(&L->b, j, w, w, L->b.W));
    ritz_block_basis_multiply(&L->b, L->b.W, L->b.MW);
    RITZ_CHECK(ritz_block_basis_project(&L->b, 0, L->b.blocks, w, L->b.MW));
    for (int64_t i = 0; i < w * w * SQUARE; i++) {
        const int64_t q = i / (w * SQUARE);

        A[i] += L->b.C[(q * L->b.blocks + j) * SQUARE + i % (w * SQUARE)];
        *size = hypot(*size, A[i]);
    }
    RITZ_CHECK(ritz_block_basis_subtract(&L->b, 0, L->b.blocks, w, L->b.W));
    ritz_block_basis_multiply(&L->b, L->b.W, L->b.MW);
    put_diagonal(L, j, A);
    return RITZ_OK;
}

/* Rank the eigenvalues theta of T by magnitude, the largest first. Theta of an
   eigenvalue below sigma is negative. */
static void rank_magnitudes(block_lanczos *L)
{
    int64_t low = 0;
    int64_t high = L->b.blocks * B - 1;

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
    const int64_t m = L->b.blocks * B;
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

/* q := R z_j, z_j the components of an eigenvector of T for the last step, eight
   for each block. The norm of q, which is that of the residual, is returned. */
static double couple_next(const block_lanczos *L, const double *z,
                          const double *R, double *q)
{
    const int64_t last = L->b.width * B;
    double size = 0.0;

    for (int64_t i = 0; i < last; i++) {
        q[i] = 0.0;
        for (int64_t k = 0; k < last; k++)
            q[i] +=
                R[(i / B * L->b.width + k / B) * SQUARE + i % B * B + k % B] *
                z[k];
        size = hypot(size, q[i]);
    }
    return size;
}

/* q := R z_j of the c-th largest theta, c from 0. */
static double last_part(const block_lanczos *L, int64_t c, const double *R,
                        double *q)
{
    const int64_t m = L->b.blocks * B;

    return couple_next(L, L->Z + (L->rank[c] + 1) * m - L->b.width * B, R, q);
}

/* How many theta, counted from the largest, have converged; at most `most`. */
static int64_t count_converged(const block_lanczos *L, int64_t most,
                               const double *R)
{
    const int64_t m = L->b.blocks * B;
    int64_t c = 0;

    for (c = 0; c < most && c < m; c++) {
        const double theta = fabs(L->theta[L->rank[c]]);
        double q[WIDEST * B];

        if (!(last_part(L, c, R, q) <= L->settled * theta) ||
            theta <= RITZ_NO_DIRECTION * fabs(L->theta[L->rank[0]]))
            break;
    }
    return c;
}

/* U := coefficients, in V and the next step, of the Ritz vectors of the `count`
   largest theta after one inverse iteration. R NULL: before it, with coefficients
   in V only. */
static ritz_status select_ritz(const block_lanczos *L, int64_t count,
                               const double *R, ritz_dense *U)
{
    const int64_t m = L->b.blocks * B;
    const int64_t last = R ? L->b.width * B : 0;

    RITZ_CHECK(ritz_dense_new(m + last, count, U));
    for (int64_t c = 0; c < count; c++) {
        double *u = ritz_dense_col(U, c);
        double q[WIDEST * B];

        memcpy(u, L->Z + L->rank[c] * m, (size_t)m * sizeof *u);
        if (R)
            last_part(L, c, R, q);
        for (int64_t i = 0; i < last; i++)
            u[m + i] = q[i] / L->theta[L->rank[c]];
    }
    return RITZ_OK;
}

/* V := V U; the last block is filled up with zeros. */
static ritz_status combine_basis(block_lanczos *L, const ritz_dense *U)
{
    const int64_t kept = (U->ncol + B - 1) / B;
    const int64_t part = U->nrow * B;
    RITZ_OWN_ARRAY double *C = NULL, *room = NULL;

    RITZ_CHECK_NEW(C, kept * part);
    RITZ_CHECK_NEW(room, ritz_blocks_room(&L->b.on, kept));
    for (int64_t c = 0; c < U->ncol; c++)
        for (int64_t i = 0; i < U->nrow; i++)
            C[c / B * part + i * B + c % B] = U->val[i + c * U->nrow];
    return ritz_block_list_combine(&L->b.V, &L->b.on, U->nrow / B, kept, part,
                                   C, room);
}

/*
 * Rayleigh-Ritz for A in the span of X = A^-1 M V Z / Theta, which is V U, and
 * the moments of V Z, see enclosure.h. With Q = R Z_j, by the recurrence,
 *
 *     A^-1 M V Z = V Z Theta + V_j+1 Q,    F1 = Theta,  F2 = Theta^2 + Q'Q
 *     X'A X = Theta^-1,    X'M X = U'U = Theta^-1 F2 Theta^-1
 *
 * U is multiplied by the eigenvectors; `values` are eigenvalues of K, the shift
 * added.
 */
static ritz_status improve_ritz(const block_lanczos *L, ritz_dense *U,
                                double *values, ritz_moments *moments)
{
    const int64_t k = U->ncol;
    RITZ_OWN(ritz_dense) A_r = {0}, M_r = {0};
    RITZ_OWN(ritz_pairs) small = {0};

    ritz_moments_free(moments);
    RITZ_CHECK(ritz_dense_new(k, k, &A_r));
    RITZ_CHECK(ritz_dense_new(k, k, &moments->first));
    RITZ_CHECK(ritz_dense_mul_tn(U, U, &M_r));
    RITZ_CHECK(ritz_dense_copy(&M_r, &moments->second));
    for (int64_t j = 0; j < k; j++) {
        const double theta = L->theta[L->rank[j]];

        ritz_dense_col(&A_r, j)[j] = 1.0 / theta;
        ritz_dense_col(&moments->first, j)[j] = theta;
        for (int64_t i = 0; i < k; i++)
            ritz_dense_col(&moments->second, j)[i] *=
                L->theta[L->rank[i]] * theta;
    }
    RITZ_CHECK(ritz_eigen_dense(&A_r, &M_r, &small));
    RITZ_REFUSE_IF(small.Phi.ncol < k, RITZ_ERR_CONVERGENCE,
                   "%" PRId64 " eigenvectors depend on each other",
                   k - small.Phi.ncol);
    RITZ_CHECK(ritz_eigen_quotients(&A_r, &small.Phi, values));
    for (int64_t j = 0; j < k; j++)
        values[j] += L->b.S->sigma;
    return ritz_dense_times(&small.Phi, U);
}

/* X := V U, rows in the order of M. Each block of them replaces one of V, so that
   memory does not hold both. */
static ritz_status extract_vectors(block_lanczos *L, const ritz_dense *U,
                                   ritz_dense *X)
{
    const int64_t *order = ritz_factor_order(L->b.S->A);
    const int64_t count = U->ncol;
    const int64_t last = (count + B - 1) / B;

    RITZ_CHECK(combine_basis(L, U));
    ritz_block_list_shorten(&L->b.V, last);
    ritz_memory_return(); /* X does not fit between the blocks that are left */
    X->val = ritz_alloc_admitted(L->b.n * count, sizeof *X->val);
    if (!X->val)
        return RITZ_ERR_MEMORY;
    X->nrow = L->b.n;
    X->ncol = count;
    for (int64_t j = last; j-- > 0;) {
        const int64_t width = count - j * B < B ? count - j * B : B;
        const double *V = NULL;

        RITZ_CHECK(ritz_block_list_look(&L->b.V, j, &V));
        for (int64_t i = 0; i < L->b.n; i++)
            for (int64_t k = 0; k < width; k++)
                X->val[order[i] + (j * B + k) * L->b.n] = V[i * B + k];
        ritz_block_list_shorten(&L->b.V, j);
        if (L->b.V.held < L->b.V.count)
            ritz_memory_return();
    }
    return RITZ_OK;
}

/* How many blocks of Ritz vectors a restart keeps: 5 k / 4 vectors or more, a
   multiple of the blocks of a step. */
static int64_t blocks_kept(const block_lanczos *L)
{
    const int64_t kept = (L->k + L->k / 4 + B - 1) / B + 1;

    return (kept + L->b.width - 1) / L->b.width * L->b.width;
}

/*
 * Thick restart [WuSimon2000]: the blocks of V become the Ritz vectors of the
 * largest theta, followed by the blocks of the next step. In T these vectors
 * have theta on the diagonal, and those blocks are coupled with each of them by
 * R z_j.
 */
static ritz_status restart_space(block_lanczos *L, const double *R)
{
    const int64_t ld = L->room * B;
    const int64_t kept = blocks_kept(L);
    RITZ_OWN(ritz_dense) U = {0};

    RITZ_CHECK(select_ritz(L, kept * B, NULL, &U));
    RITZ_CHECK(combine_basis(L, &U));
    memset(L->T, 0, (size_t)(ld * ld) * sizeof *L->T);
    for (int64_t c = 0; c < kept * B; c++) {
        double q[WIDEST * B];

        last_part(L, c, R, q);
        L->T[c + c * ld] = L->theta[L->rank[c]];
        for (int64_t i = 0; i < L->b.width * B; i++) {
            L->T[(kept * B + i) + c * ld] = q[i];
            L->T[c + (kept * B + i) * ld] = q[i];
        }
    }
    L->coupled = 0;
    L->restarted = true;
    return ritz_block_basis_move_step(&L->b, kept);
}

/* Whether to look for converged pairs, which costs an eigensolution of T: once
   V has `next` blocks or is full. */
static bool is_time_to_look(const block_lanczos *L, int64_t next)
{
    return L->b.blocks >= next || L->b.blocks == L->room;
}

/* Whether a single eigenpair of T is found in much less time than all of them, and
   is enough to know. */
static bool is_band(const block_lanczos *L)
{
    return !L->restarted && L->b.S->below == 0 && L->b.blocks < L->room &&
           L->b.blocks * B > ALONE;
}

/* The number of blocks at the next look. A block of B vectors hardly makes more
   than B pairs converge, so that fewer blocks than are skipped would not be
   enough; in a large V another block costs less than a look. */
static int64_t next_look(const block_lanczos *L, int64_t found)
{
    const int64_t missing = L->k > found ? (L->k - found) / B : 0;
    const int64_t more = L->b.blocks / 32;

    return L->b.blocks + 1 + (missing > more ? missing - 1 : more);
}

/* The lower triangle of T, which is a band matrix until the first restart: R is
   upper triangular. */
static void copy_band(const block_lanczos *L, ritz_band *T)
{
    const int64_t w = T->width;

    for (int64_t j = 0; j < T->n; j++)
        memcpy(T->val + j * (w + 1), L->T + j * (L->room * B + 1),
               (size_t)(T->n - j <= w ? T->n - j : w + 1) * sizeof *T->val);
}

/* The least theta that has a direction. */
static double least_theta(const ritz_band *T)
{
    double largest = 0.0;

    for (int64_t j = 0; j < T->n; j++)
        largest = fmax(largest, T->val[j * (T->width + 1)]);
    return RITZ_NO_DIRECTION * largest;
}

/*
 * Whether the k-th pair has converged, by itself: eigenvectors of all pairs cost
 * as much as several steps. The others have converged before, as a rule.
 */
static ritz_status test_kth(block_lanczos *L, const double *R, bool *converged)
{
    const int64_t last = L->b.width * B;
    RITZ_OWN_ARRAY double *val = NULL, *z = NULL;
    ritz_band T = {.n = L->b.blocks * B, .width = last};
    double q[WIDEST * B];
    bool exists = false;

    *converged = false;
    RITZ_CHECK_NEW(z, T.n);
    RITZ_CHECK_NEW(val, T.n * (last + 1));
    T.val = val;
    copy_band(L, &T);
    L->kth = fmax(L->kth, least_theta(&T));
    RITZ_CHECK(ritz_band_kth(&T, L->k, &L->kth, &exists));
    if (!exists)
        return RITZ_OK;
    RITZ_CHECK(ritz_band_vector(&T, L->kth, z));
    *converged = couple_next(L, z + T.n - last, R, q) <= L->settled * L->kth;
    return RITZ_OK;
}

/* Whether at least k pairs have converged, and S->below of them lie below
   sigma. */
static bool is_enough(const block_lanczos *L, int64_t found)
{
    int64_t below = 0;

    for (int64_t c = 0; c < found; c++)
        below += L->theta[L->rank[c]] < 0.0;
    return found >= L->k && below >= L->b.S->below;
}

/* Put R and R', which couple the last step with the next one, into T, and count
   the next step among the blocks of V. */
static void couple_steps(block_lanczos *L, double *R)
{
    for (int64_t p = 0; p < L->b.width; p++)
        for (int64_t q = 0; q < L->b.width; q++)
            put_projected(L, L->b.blocks + p, L->b.blocks - L->b.width + q,
                          ritz_block_basis_square(&L->b, R, p, q));
    L->coupled = L->b.blocks - L->b.width;
    L->b.blocks += L->b.width;
}

/* Extend V until k pairs have converged. R is that of the step after V. */
static ritz_status iterate_blocks(block_lanczos *L, double *R, int64_t *found,
                                  ritz_lanczos_end *end)
{
    /* no check of convergence before there are 2.4 basis vectors for each pair,
       2.2 if an accuracy is given, or 1.4 if eigenvalues lie on both sides of
       sigma */
    int64_t next = ((L->b.S->below > 0                   ? 7
                     : L->settled > RITZ_LANCZOS_SETTLED ? 11
                                                         : 12) *
                        L->k / 5 +
                    B - 1) /
                   B;
    int64_t steps = 0;
    int restarts = 0;
    bool exhausted = false;
    bool look = false;
    double size = 0.0;

    for (;;) {
        ritz_monitor_step("eigenvectors", ++steps, 0);
        RITZ_CHECK(expand_space(L, &size));
        RITZ_CHECK(ritz_block_basis_orthonormalise(&L->b, size, R, &exhausted));
        look = exhausted || is_time_to_look(L, next);
        if (look && !exhausted && is_band(L))
            RITZ_CHECK(test_kth(L, R, &look));
        if (look) {
            RITZ_CHECK(solve_projected(L));
            *found =
                count_converged(L,
                                L->b.S->below > 0 ? L->b.blocks * B
                                                  : L->k + RITZ_LANCZOS_SPARES,
                                R);
            next = next_look(L, *found);
            *end = exhausted && !is_enough(L, *found) ? RITZ_LANCZOS_EXHAUSTED
                                                      : RITZ_LANCZOS_FOUND;
            if (exhausted || is_enough(L, *found))
                return RITZ_OK;
        }
        *end = RITZ_LANCZOS_SLOW;
        if (L->b.blocks == L->room &&
            (restarts++ == RESTARTS ||
             blocks_kept(L) + 2 * L->b.width > L->room))
            return RITZ_OK;
        if (L->b.blocks == L->room) {
            RITZ_CHECK(restart_space(L, R));
            next = L->b.blocks;
            continue;
        }
        couple_steps(L, R);
    }
}

/* The eigenvalue of the c-th largest theta; HUGE_VAL if theta is rounding. */
static double eigenvalue_at(const block_lanczos *L, int64_t c)
{
    const int64_t m = L->b.blocks * B;
    const double theta = c < m ? L->theta[L->rank[c]] : 0.0;

    return fabs(theta) > RITZ_NO_DIRECTION * fabs(L->theta[L->rank[0]])
               ? L->b.S->sigma + 1.0 / theta
               : HUGE_VAL;
}

/* What there is of K and M during the iteration. */
typedef struct lanczos_pencil {
    ritz_row_matrix rows; /* of M, in the order of the factor */
    ritz_folded K, M;     /* {0}: not folded */
    bool freed;           /* M can be made of the rows again */
} lanczos_pencil;

static void lanczos_pencil_free(lanczos_pencil *P)
{
    ritz_row_matrix_free(&P->rows);
    ritz_folded_free(&P->K);
    ritz_folded_free(&P->M);
}

/* Free what is not needed of the matrices that may be folded: K is folded, and so
   is an M with stored zeros, which its rows do not have. */
static ritz_status fold_pencil(const ritz_lanczos_plan *plan, lanczos_pencil *P)
{
    ritz_sparse *M = plan->fold[1];

    if (plan->fold[0])
        RITZ_CHECK(ritz_folded_new(plan->fold[0], &P->K));
    if (!M)
        return RITZ_OK;
    P->freed = M->colptr[M->ncol] == P->rows.start[P->rows.n];
    if (!P->freed)
        return ritz_folded_new(M, &P->M);
    ritz_sparse_free(M);
    return RITZ_OK;
}

static ritz_status open_pencil(const ritz_shifted *S,
                               const ritz_lanczos_plan *plan, lanczos_pencil *P)
{
    if (P->freed)
        RITZ_CHECK(ritz_row_matrix_restore(&P->rows, ritz_factor_order(S->A),
                                           plan->fold[1]));
    ritz_row_matrix_free(&P->rows);
    ritz_memory_return();
    RITZ_CHECK(ritz_folded_open(&P->K, plan->fold[0]));
    return ritz_folded_open(&P->M, plan->fold[1]);
}

/* Decide how many blocks of V memory holds. On either side of a shift more pairs
   may be found than requested; K and M grow again afterwards. */
static ritz_status admit_blocks(block_lanczos *L, const lanczos_pencil *P)
{
    const ritz_basis_needs needs = {
        .kept = ritz_lanczos_found(L->b.S->below > 0 ? 2 * L->k : L->k),
        .meanwhile = ritz_lanczos_meanwhile(L->b.n, L->k, L->room),
        .afterwards = ritz_folded_growth(&P->K) + ritz_folded_growth(&P->M) +
                      (P->freed ? 16 * P->rows.start[P->rows.n] : 0),
    };

    return ritz_block_basis_admit(&L->b, &needs);
}

/* ritz_block_lanczos() with the matrices that may be folded. */
static ritz_status find_pairs(const ritz_shifted *S, ritz_lanczos_plan *plan,
                              lanczos_pencil *P, ritz_dense *X, double **lambda,
                              ritz_lanczos_end *end)
{
    RITZ_OWN(block_lanczos)
    L = {
        .b = {.S = S,
              .n = P->rows.n,
              .width = ritz_lanczos_width(plan),
              .noise = 1998,
              .M = &P->rows},
        .k = plan->k,
        .room = ritz_lanczos_blocks(plan, P->rows.n),
        .settled = plan->settled > 0.0 ? plan->settled : RITZ_LANCZOS_SETTLED,
    };
    RITZ_OWN(ritz_dense) U = {0};
    RITZ_OWN_ARRAY double *values = NULL;
    double R[RITZ_STEP_SQUARES * SQUARE];
    int64_t found = 0;
    bool exhausted = false;

    RITZ_CHECK(fold_pencil(plan, P));
    RITZ_CHECK(allocate_lanczos(&L));
    RITZ_CHECK(admit_blocks(&L, P));
    RITZ_CHECK(ritz_block_basis_begin(&L.b, &exhausted));
    *end = RITZ_LANCZOS_EXHAUSTED;
    if (exhausted)
        return RITZ_OK;
    RITZ_CHECK(iterate_blocks(&L, R, &found, end));
    if (*end == RITZ_LANCZOS_SLOW)
        plan->next = eigenvalue_at(&L, L.k - 1);
    if (*end != RITZ_LANCZOS_FOUND)
        return RITZ_OK;
    plan->next = eigenvalue_at(&L, found);
    RITZ_CHECK_NEW(values, found);
    for (int64_t c = 0; c < found; c++)
        values[c] = eigenvalue_at(&L, c);
    RITZ_CHECK(select_ritz(&L, found, R, &U));
    if (plan->settled > 0.0)
        RITZ_CHECK(improve_ritz(&L, &U, values, &plan->moments));
    RITZ_CHECK(extract_vectors(&L, &U, X));
    RITZ_MOVE(*lambda, values);
    return RITZ_OK;
}

ritz_status ritz_block_lanczos(const ritz_shifted *S, ritz_lanczos_plan *plan,
                               ritz_dense *X, double **lambda,
                               ritz_lanczos_end *end)
{
    RITZ_OWN(lanczos_pencil) P = {0};
    ritz_status status = RITZ_OK;

    RITZ_CHECK(ritz_row_matrix_new(S->M, ritz_factor_order(S->A), &P.rows));
    status = find_pairs(S, plan, &P, X, lambda, end);
    if (status != RITZ_ERR_MEMORY) {
        const ritz_status opened = open_pencil(S, plan, &P);

        status = status == RITZ_OK ? opened : status;
    }
    return status;
}
