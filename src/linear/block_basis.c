#include "linear/block_basis.h"

#include "base/alloc.h"
#include "base/memory.h"
#include "base/tolerances.h"
#include "linear/factor.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { B = RITZ_BLOCK, SQUARE = RITZ_SQUARE };

static int64_t block_bytes(const ritz_block_basis *b)
{
    return b->n * B * (int64_t)sizeof *b->W;
}

ritz_status ritz_block_basis_new(int64_t room, ritz_block_basis *b)
{
    const int64_t step = b->width * b->n * B;
    const int64_t most = b->width * (room + b->width);

    RITZ_CHECK_NEW(b->W, step);
    RITZ_CHECK_NEW(b->MW, step);
    RITZ_CHECK_NEW(b->C, most * SQUARE);
    RITZ_CHECK(
        ritz_blocks_new(b->n, ritz_factor_threads(b->S->A), most, &b->on));
    return ritz_block_list_new(b->n, room + b->width, &b->V);
}

ritz_status ritz_block_basis_admit(ritz_block_basis *b,
                                   const ritz_basis_needs *needs)
{
    const int64_t size = block_bytes(b);
    const int64_t all = b->V.count * size + needs->meanwhile;
    const int64_t few = needs->kept + 1 + RITZ_BLOCK_WINDOW;
    const int64_t later = needs->kept * size + needs->afterwards;
    int64_t least = few * size + needs->meanwhile;
    int64_t held = 0;

    least = least > later ? least : later;
    ritz_memory_return();
    if (ritz_memory_fits(all))
        return RITZ_OK;
    RITZ_CHECK(
        ritz_memory_admit("the Lanczos basis", least < all ? least : all));
    held = (ritz_memory_left() - needs->meanwhile) / size - RITZ_BLOCK_WINDOW;
    held = held > 0 ? held : 0;
    return held < b->V.count ? ritz_block_list_limit(&b->V, held) : RITZ_OK;
}

void ritz_block_basis_free(ritz_block_basis *b)
{
    ritz_blocks_free(&b->on);
    ritz_block_list_free(&b->V);
    RITZ_FREE(b->W, b->MW, b->C);
}

ritz_status ritz_block_basis_move_step(ritz_block_basis *b, int64_t kept)
{
    for (int64_t q = 0; q < b->width; q++)
        RITZ_CHECK(ritz_block_list_move(&b->V, b->blocks + q, kept + q));
    b->blocks = kept + b->width;
    return RITZ_OK;
}

/* V_j := a block of W: a copy of it, or W itself if it has no other block. */
static ritz_status put_block(ritz_block_basis *b, int64_t j, double *W)
{
    if (b->width > 1)
        return ritz_block_list_put(&b->V, j, false, &W);
    return ritz_block_list_put(&b->V, j, true, &b->W);
}

static double *part_of(const ritz_block_basis *b, double *W, int64_t q)
{
    return W + q * b->n * B;
}

/* Y := M X */
static void multiply_mass(const ritz_block_basis *b, const double *X, double *Y)
{
    ritz_blocks_multiply(&b->on, b->M, X, Y);
}

void ritz_block_basis_multiply(const ritz_block_basis *b, double *X, double *Y)
{
    for (int64_t q = 0; q < b->width; q++)
        multiply_mass(b, part_of(b, X, q), part_of(b, Y, q));
}

ritz_status ritz_block_basis_project(const ritz_block_basis *b, int64_t first,
                                     int64_t count, int64_t width,
                                     const double *X)
{
    return ritz_block_list_project(&b->V, &b->on, first, count, width, X, b->C);
}

ritz_status ritz_block_basis_subtract(const ritz_block_basis *b, int64_t first,
                                      int64_t count, int64_t width, double *X)
{
    for (int64_t i = 0; i < width * count * SQUARE; i++)
        b->C[i] = -b->C[i];
    return ritz_block_list_add(&b->V, &b->on, first, count, width, b->C, X);
}

/* --- orthonormal blocks --------------------------------------------------- */

/* Orthonormalise a block, X := Q of X = Q R, by two Cholesky factors of X'MX.
   False, with X and MX unchanged, if a vector is no longer than `least` or
   depends on the others. */
static bool settle_block(ritz_block_basis *b, double least, double *X,
                         double *MX, double *R)
{
    double G[SQUARE], Q[SQUARE], U[SQUARE];

    ritz_blocks_inner(&b->on, X, MX, G);
    for (int j = 0; j < B; j++)
        if (!(G[j * B + j] > least * least))
            return false;
    if (!ritz_square_factor(G, R, RITZ_GRAM_DEPENDENT))
        return false;
    for (int pass = 0;; pass++) {
        ritz_square_invert(pass == 0 ? R : Q, U);
        ritz_blocks_transform(&b->on, U, X);
        ritz_blocks_transform(&b->on, U, MX);
        if (pass == 1)
            return true;
        ritz_blocks_inner(&b->on, X, MX, G);
        if (!ritz_square_factor(G, Q, 0.0)) /* G is nearly the identity */
            return false;
        ritz_square_multiply(Q, R);
    }
}

/* Make column j orthogonal to the columns of `others`, in two passes, and
   divide it by its length. It becomes zero, and false is returned, if what is
   left is no longer than `least`, or if x'M x is only rounding, as for a vector
   that moves no mass. The coefficients are added to column j of R. */
static bool settle_column(ritz_block_basis *b, int j, const bool *others,
                          double least, double *X, double *MX, double *R)
{
    double size = 0.0;
    bool settled = false;

    for (int pass = 0; pass < 2; pass++)
        for (int k = 0; k < B; k++) {
            const double r =
                others[k] ? ritz_columns_inner(b->n, X, k, MX, j) : 0.0;

            if (r == 0.0)
                continue;
            ritz_columns_add(b->n, -r, k, j, X);
            ritz_columns_add(b->n, -r, k, j, MX);
            R[k * B + j] += r;
        }
    size = sqrt(fmax(ritz_columns_inner(b->n, X, j, MX, j), 0.0));
    settled =
        size > least &&
        size * size > RITZ_NO_DIRECTION * ritz_row_matrix_terms(b->M, X, j);
    R[j * B + j] = settled ? size : 0.0;
    ritz_columns_scale(b->n, settled ? 1.0 / size : 0.0, j, X);
    ritz_columns_scale(b->n, settled ? 1.0 / size : 0.0, j, MX);
    return settled;
}

/* W := Q of W = Q R, column by column. settled[j] is false where column j
   depends on those before it; it is zero then, and so is row j of R. */
static void settle_columns(ritz_block_basis *b, double least, double *W,
                           double *MW, bool *settled, double *R)
{
    memset(settled, 0, B * sizeof *settled);
    memset(R, 0, SQUARE * sizeof *R);
    for (int j = 0; j < B; j++)
        settled[j] = settle_column(b, j, settled, least, W, MW, R);
}

/* X := X - V V'M X, in two passes, and MX := M X. */
static ritz_status take_out_blocks(ritz_block_basis *b, double *X, double *MX)
{
    for (int pass = 0; pass < 2; pass++) {
        multiply_mass(b, X, MX);
        RITZ_CHECK(ritz_block_basis_project(b, 0, b->blocks, 1, MX));
        RITZ_CHECK(ritz_block_basis_subtract(b, 0, b->blocks, 1, X));
    }
    multiply_mass(b, X, MX);
    return RITZ_OK;
}

/* W := A^-1 M times random vectors, and MW := M W. */
static void start_block(ritz_block_basis *b, double *W, double *MW)
{
    for (int64_t i = 0; i < b->n * B; i++)
        MW[i] = ritz_general_noise(&b->noise);
    multiply_mass(b, MW, W);
    ritz_factor_solve_rows(b->S->A, W);
    multiply_mass(b, W, MW);
}

/*
 * Replace each column of W that is not `settled` by a random vector,
 * orthonormal to V and to the other columns, with which the iteration goes on.
 * Where V already spans the range of A^-1 M, no vector is left: the column
 * stays zero and not settled, and its row and column of T are zero.
 */
static ritz_status refill_block(ritz_block_basis *b, double *W, double *MW,
                                bool *settled)
{
    RITZ_OWN_ARRAY double *X = NULL, *MX = NULL;
    double G[SQUARE];

    RITZ_CHECK_COPY(X, W, b->n * B);
    RITZ_CHECK_COPY(MX, MW, b->n * B);
    start_block(b, W, MW);
    ritz_blocks_inner(&b->on, W, MW, G);
    RITZ_CHECK(take_out_blocks(b, W, MW));
    for (int64_t i = 0; i < b->n * B; i++)
        if (settled[i % B]) {
            W[i] = X[i];
            MW[i] = MX[i];
        }
    for (int j = 0; j < B; j++) {
        const double length = sqrt(fmax(G[j * B + j], 0.0));
        double unused[SQUARE] = {0};

        if (!settled[j])
            settled[j] = settle_column(
                b, j, settled, RITZ_NO_DIRECTION * length, W, MW, unused);
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
 * W := Q of W = Q R, and MW := M Q, of one block. `size` is the norm of the
 * components along V that were subtracted from W. Columns of W that are only
 * rounding errors of that subtraction are replaced by random ones, and their
 * rows of R are zero.
 *
 * Dividing a short column by its length makes its rounding errors as much
 * longer, and these have components along V: so V is subtracted once more.
 *
 * @param[out] exhausted  no direction is left: all of Q is zero
 */
static ritz_status settle_one(ritz_block_basis *b, double size, double *W,
                              double *MW, double *R, bool *exhausted)
{
    const double least = RITZ_NO_DIRECTION * size;
    bool settled[B] = {false};
    double Q[SQUARE];

    *exhausted = false;
    if (settle_block(b, least, W, MW, R))
        return RITZ_OK;
    settle_columns(b, least, W, MW, settled, R);
    for (int pass = 0; pass < 2; pass++) {
        if (count_settled(settled) < B)
            RITZ_CHECK(refill_block(b, W, MW, settled));
        RITZ_CHECK(take_out_blocks(b, W, MW));
        settle_columns(b, RITZ_MOSTLY_LEFT, W, MW, settled, Q);
        ritz_square_multiply(Q, R);
    }
    *exhausted = count_settled(settled) == 0;
    return RITZ_OK;
}

double *ritz_block_basis_square(const ritz_block_basis *b, double *R, int64_t p,
                                int64_t q)
{
    return R + (p * b->width + q) * SQUARE;
}

/* Make block q of W orthogonal to the blocks of the same step before it, in two
   passes. */
static ritz_status take_out_step(ritz_block_basis *b, int64_t before, int64_t q,
                                 double *R)
{
    double *W = part_of(b, b->W, q);
    double *MW = part_of(b, b->MW, q);

    for (int pass = 0; pass < 2 && q > 0; pass++) {
        RITZ_CHECK(ritz_block_basis_project(b, before, q, 1, MW));
        for (int64_t i = 0; i < q * SQUARE; i++)
            ritz_block_basis_square(b, R, i / SQUARE, q)[i % SQUARE] += b->C[i];
        RITZ_CHECK(ritz_block_basis_subtract(b, before, q, 1, W));
        multiply_mass(b, W, MW);
    }
    return RITZ_OK;
}

/* Orthonormalise block q of W, and put it behind the blocks of V. */
static ritz_status add_block(ritz_block_basis *b, double size, int64_t before,
                             int64_t q, double *R, bool *none)
{
    RITZ_CHECK(take_out_step(b, before, q, R));
    RITZ_CHECK(settle_one(b, size, part_of(b, b->W, q), part_of(b, b->MW, q),
                          ritz_block_basis_square(b, R, q, q), none));
    return put_block(b, b->blocks++, part_of(b, b->W, q));
}

ritz_status ritz_block_basis_orthonormalise(ritz_block_basis *b, double size,
                                            double *R, bool *exhausted)
{
    const int64_t before = b->blocks;
    ritz_status status = RITZ_OK;

    memset(R, 0, (size_t)(b->width * b->width) * SQUARE * sizeof *R);
    for (int64_t q = 0; q < b->width && status == RITZ_OK; q++) {
        bool none = false;

        status = add_block(b, size, before, q, R, &none);
        if (q == 0)
            *exhausted = none;
    }
    b->blocks = before;
    return status;
}

ritz_status ritz_block_basis_begin(ritz_block_basis *b, bool *exhausted)
{
    double R[RITZ_STEP_SQUARES * SQUARE];
    double G[SQUARE];

    for (int64_t q = 0; q < b->width; q++)
        start_block(b, part_of(b, b->W, q), part_of(b, b->MW, q));
    ritz_blocks_inner(&b->on, b->W, b->MW, G);
    RITZ_CHECK(ritz_block_basis_orthonormalise(b, sqrt(ritz_square_size(G)), R,
                                               exhausted));
    b->blocks = b->width;
    return RITZ_OK;
}
