/*
 * Krylov vectors of a system at one configuration [McDaniel2000, eq. 3.2.15 to
 * 3.2.17]. In its modal coordinates M = I and K = diag(lambda), so that of the
 * flexible part
 *
 *     V_1 = Lambda^-1 R,    V_{j+1} = Lambda^-1 V_j,    R = B or [B, C']
 *
 * each block made K-orthonormal to all before it, twice, and dependent columns
 * left out. Galerkin's projection on j blocks keeps the first j of the moments
 * C Lambda^-i-1 B, and the first 2j if outputs start the block too, since then
 * C Lambda^-i and Lambda^-i B are both spanned.
 *
 * An output of velocity or acceleration adds its own rows to those that start.
 */
#include "base/alloc.h"
#include "compare/compare.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of a column's K-norm what is left of a dependent one. */
static const double dependent = 1e-10;

/* a'Kb of flexible coordinates. */
static double product(const ritz_configuration *c, const double *a,
                      const double *b)
{
    double sum = 0.0;

    for (int64_t k = c->num_rigid; k < c->K.ncol; k++)
        sum += a[k] * c->lambda[k] * b[k];
    return sum;
}

/* Make v K-orthonormal to the first m columns; false if it depends on them. */
static bool orthogonalise(const ritz_configuration *c, const ritz_dense *V,
                          int64_t m, double *v)
{
    double before = sqrt(product(c, v, v));
    double after = 0.0;

    for (int pass = 0; pass < 2; pass++)
        for (int64_t j = 0; j < m; j++) {
            const double *u = ritz_dense_col(V, j);
            double share = product(c, u, v);

            for (int64_t k = c->num_rigid; k < c->K.ncol; k++)
                v[k] -= share * u[k];
        }
    after = sqrt(product(c, v, v));
    if (!(after > dependent * before))
        return false;
    for (int64_t k = c->num_rigid; k < c->K.ncol; k++)
        v[k] /= after;
    return true;
}

/* v = Lambda^-1 r, r a column, or row i of a matrix with a stride. */
static void solve(const ritz_configuration *c, const double *r, int64_t stride,
                  double *v)
{
    for (int64_t k = c->num_rigid; k < c->K.ncol; k++)
        v[k] = r[k * stride] / c->lambda[k];
}

/* The block that starts: B, and rows of C, Cv and Ca. */
static ritz_status start(const ritz_configuration *c, bool both,
                         ritz_dense *out)
{
    const ritz_io *io = &c->io;
    const ritz_dense *const C[] = {&io->C, &io->Cv, &io->Ca};
    int64_t m = 0;

    RITZ_CHECK(ritz_dense_new(
        c->K.ncol, io->num_inputs + (both ? 3 * io->num_outputs : 0), out));
    for (int64_t j = 0; j < io->num_inputs; j++)
        solve(c, ritz_dense_col(&io->B, j), 1, ritz_dense_col(out, m++));
    for (int k = 0; k < 3 && both; k++)
        for (int64_t i = 0; i < io->num_outputs; i++)
            solve(c, C[k]->val + i, io->num_outputs, ritz_dense_col(out, m++));
    return RITZ_OK;
}

/*
 * Append one block to V, which has a column to spare, from its candidates W.
 *
 * @return whether all of W found room
 */
static bool append(const ritz_configuration *c, const ritz_dense *W,
                   int64_t vectors, ritz_dense *V, int64_t *count)
{
    for (int64_t j = 0; j < W->ncol; j++) {
        double *v = ritz_dense_col(V, *count);

        memcpy(v, ritz_dense_col(W, j), (size_t)W->nrow * sizeof *v);
        if (!orthogonalise(c, V, *count, v))
            continue;
        if (*count == vectors)
            return false;
        *count += 1;
    }
    return true;
}

ritz_status ritz_system_krylov(const ritz_configuration *configuration,
                               int64_t vectors, bool both, ritz_dense *out,
                               int64_t *moments)
{
    ritz_status status = RITZ_OK;
    const ritz_configuration *c = configuration;
    int64_t flexible = c->K.ncol - c->num_rigid;
    int64_t most = vectors < flexible ? vectors : flexible;
    int64_t count = 0, first = 0, blocks = 0;
    ritz_dense V = {0}, W = {0};

    RITZ_TRY(ritz_dense_new(c->K.ncol, most + 1, &V));
    RITZ_TRY(start(c, both, &W));
    while (append(c, &W, most, &V, &count)) {
        blocks++;
        if (count == first) /* every further moment is kept as well */
            break;
        ritz_dense_free(&W);
        RITZ_TRY(ritz_dense_columns(&V, first, count - first, &W));
        for (int64_t j = 0; j < W.ncol; j++)
            solve(c, ritz_dense_col(&W, j), 1, ritz_dense_col(&W, j));
        first = count;
    }
    *moments = both ? 2 * blocks : blocks;
    RITZ_TRY(ritz_dense_columns(&V, 0, count, out));
done:
    ritz_dense_free(&V);
    ritz_dense_free(&W);
    return status;
}
