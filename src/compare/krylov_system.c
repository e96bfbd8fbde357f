/*
 * Krylov vectors of a system at one configuration [McDaniel2000, eq. 3.2.15 to
 * 3.2.17]. In its modal coordinates M = I and K = diag(lambda), so that the
 * flexible part has the blocks
 *
 *     V_1 = Lambda^-1 R,    V_{j+1} = Lambda^-1 V_j,    R = B or [B, C']
 *
 * each block made K-orthonormal to all before it, twice, and dependent columns
 * left out. Galerkin's projection on j blocks keeps the first j of the moments
 * C Lambda^-i-1 B, and the first 2j if outputs start the block too, since then
 * C Lambda^-i and Lambda^-i B are both spanned.
 *
 * An output of velocity or acceleration adds its own rows to the first block.
 */
#include "base/tolerances.h"
#include "compare/compare.h"
#include "linear/orthonormal.h"

/* v = Lambda^-1 r, where r is a column, or a row of a matrix with a stride. */
static void divide_by_lambda(const ritz_configuration *c, const double *r,
                             int64_t stride, double *v)
{
    for (int64_t k = c->num_rigid; k < c->K.ncol; k++)
        v[k] = r[k * stride] / c->lambda[k];
}

ritz_status ritz_system_statics(const ritz_configuration *configuration,
                                bool both, ritz_dense *out)
{
    const ritz_configuration *c = configuration;
    const ritz_io *io = &c->io;
    const ritz_dense *const C[] = {&io->C, &io->Cv, &io->Ca};
    int64_t m = 0;

    RITZ_CHECK(ritz_dense_new(
        c->K.ncol, io->num_inputs + (both ? 3 * io->num_outputs : 0), out));
    for (int64_t j = 0; j < io->num_inputs; j++)
        divide_by_lambda(c, ritz_dense_col(&io->B, j), 1,
                         ritz_dense_col(out, m++));
    for (int k = 0; k < 3 && both; k++)
        for (int64_t i = 0; i < io->num_outputs; i++)
            divide_by_lambda(c, C[k]->val + i, io->num_outputs,
                             ritz_dense_col(out, m++));
    return RITZ_OK;
}

/* diag(Lambda), 0 for rigid modes: the inner product of the vectors. */
static ritz_status fill_weights(const ritz_configuration *c, ritz_sparse *out)
{
    int64_t n = c->K.ncol;

    RITZ_CHECK(ritz_sparse_new(n, n, n, out));
    for (int64_t k = 0; k < n; k++) {
        out->colptr[k + 1] = k + 1;
        out->rowind[k] = k;
        out->val[k] = k < c->num_rigid ? 0.0 : c->lambda[k];
    }
    return RITZ_OK;
}

/*
 * Append one block, up to `vectors` in all; says whether all new vectors fit.
 */
static ritz_status append_block(ritz_dense *W, int64_t vectors,
                                ritz_orthonormal *set, bool *fits)
{
    *fits = true;
    for (int64_t j = 0; j < W->ncol && *fits; j++) {
        ritz_dense column = ritz_dense_part(W, j, 1);

        RITZ_CHECK(
            ritz_orthonormal_append(set, &column, set->count < vectors, NULL));
        *fits = set->left == 0;
    }
    return RITZ_OK;
}

ritz_status ritz_system_krylov(const ritz_configuration *configuration,
                               int64_t vectors, bool both, ritz_dense *out,
                               int64_t *moments)
{
    const ritz_configuration *c = configuration;
    int64_t flexible = c->K.ncol - c->num_rigid;
    int64_t most = vectors < flexible ? vectors : flexible;
    int64_t first = 0, blocks = 0;
    RITZ_OWN(ritz_sparse) weights = {0};
    RITZ_OWN(ritz_orthonormal) set = {0};
    RITZ_OWN(ritz_dense) W = {0};
    bool fits = false;

    RITZ_CHECK(fill_weights(c, &weights));
    RITZ_CHECK(ritz_orthonormal_new(c->K.ncol, &weights, RITZ_DEPENDENT, &set));
    RITZ_CHECK(ritz_system_statics(c, both, &W));
    RITZ_CHECK(append_block(&W, most, &set, &fits));
    while (fits) {
        blocks++;
        if (set.count == first) /* all further moments are kept as well */
            break;
        ritz_dense_free(&W);
        RITZ_CHECK(ritz_dense_columns(&set.V, first, set.count - first, &W));
        for (int64_t j = 0; j < W.ncol; j++)
            divide_by_lambda(c, ritz_dense_col(&W, j), 1,
                             ritz_dense_col(&W, j));
        first = set.count;
        RITZ_CHECK(append_block(&W, most, &set, &fits));
    }
    *moments = both ? 2 * blocks : blocks;
    return ritz_dense_columns(&set.V, 0, set.count, out);
}
