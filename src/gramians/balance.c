/*
 * Balancing by square roots. With the factors of both Gramians
 *
 *     Z_o'E Z_c = U S V',   T = Z_c V S^-1/2,   W = Z_o U S^-1/2,
 *
 *     W'E T = I,   T'... of W_c = T S T', W_o = W S W' in the kept states
 *
 * so that both Gramians of the states W'E x are S: what is controllable by
 * little input and what is observable by little output stand in the same order.
 * A value no larger than the rounding of the product has no direction of its
 * own: T and W leave it out whatever was asked for. [Moore1981], [Tombs1987]
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"
#include "linear/product_svd.h"

#include <ritz/basis.h>

#include <float.h>
#include <math.h>
#include <stdlib.h>

static const ritz_dense *descriptor_times(const ritz_gramians *gramians)
{
    return gramians->EZc.val ? &gramians->EZc : &gramians->Zc;
}

ritz_status ritz_gramians_hankel(const ritz_gramians *gramians, int64_t *count,
                                 double **sigma)
{
    RITZ_OWN(ritz_product_svd) svd = {0};

    RITZ_CHECK_IN("Hankel values",
                  ritz_product_svd_new(
                      &gramians->Zo, descriptor_times(gramians), false, &svd));
    *count = svd.count;
    RITZ_MOVE(*sigma, svd.s);
    return RITZ_OK;
}

double ritz_hankel_bound(int64_t count, const double *sigma, int64_t kept)
{
    double sum = 0.0;
    double last = 0.0;

    for (int64_t k = 0; k < count; k++) {
        if (k > 0 && last - sigma[k] <= RITZ_HANKEL_REPEATED * last)
            continue;
        last = sigma[k];
        if (k >= kept)
            sum += last;
    }
    return 2.0 * sum;
}

/* Values that rounding of the product leaves. */
static int64_t count_true(const ritz_gramians *gramians,
                          const ritz_product_svd *svd)
{
    int64_t k = gramians->Zc.ncol;
    int64_t l = gramians->Zo.ncol;
    double size = (double)(k > l ? k : l);
    int64_t count = 0;

    while (count < svd->rank && svd->s[count] > 0.0 &&
           svd->s[count] > size * DBL_EPSILON * svd->s[0])
        count++;
    return count;
}

/* The number of leading rows and columns of G that are close to I. */
static int64_t count_close(const ritz_dense *G)
{
    double sum = 0.0;

    for (int64_t j = 0; j < G->ncol; j++) {
        for (int64_t i = 0; i <= j; i++) {
            double upper = ritz_dense_col(G, j)[i] - (i == j ? 1.0 : 0.0);
            double lower = ritz_dense_col(G, i)[j];

            sum += upper * upper + (i < j ? lower * lower : 0.0);
        }
        if (!(sqrt(sum) <= RITZ_BALANCED_DEFECT))
            return j;
    }
    return G->ncol;
}

/* How many values are kept. */
static int64_t cut_values(int64_t count, const double *sigma, int64_t order,
                          double tolerance)
{
    int64_t kept = 0;

    while (kept < count && (order < 0 || kept < order) &&
           sigma[kept] >= tolerance * sigma[0])
        kept++;
    while (kept > 0 && kept < count &&
           sigma[kept - 1] - sigma[kept] <= RITZ_CLUSTER_GAP * sigma[kept - 1])
        kept--;
    return kept;
}

/* Z times columns of a side of the product, over the roots of s. */
static ritz_status project_side(const ritz_dense *Z, const ritz_dense *vectors,
                                const double *sigma, int64_t count,
                                ritz_dense *out)
{
    RITZ_OWN(ritz_dense) V = {0};

    RITZ_CHECK(ritz_dense_columns(vectors, 0, count, &V));
    for (int64_t j = 0; j < count; j++)
        for (int64_t i = 0; i < V.nrow; i++)
            ritz_dense_col(&V, j)[i] /= sqrt(sigma[j]);
    return ritz_dense_mul(Z, &V, out);
}

/* The leading columns of W times G^-1 of the leading rows and columns. */
static ritz_status correct_sides(const ritz_dense *W, const ritz_dense *G,
                                 int64_t count, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) leading = {0}, X = {0};
    ritz_dense part = ritz_dense_part(W, 0, count);

    RITZ_CHECK(ritz_dense_block(G, 0, count, 0, count, &leading));
    RITZ_CHECK(ritz_general_transpose(&part, &X));
    RITZ_CHECK_IN("balancing", ritz_general_solve(&leading, true, &X));
    return ritz_general_transpose(&X, out);
}

/*
 * T and W of as many values as there are, then cut. G = (E T)'W is I but for
 * rounding, some eps |Z_o| |E Z_c| / sigma, and W := W G^-1 takes that away.
 */
static ritz_status project_balanced(const ritz_gramians *gramians,
                                    const ritz_product_svd *svd, int64_t order,
                                    double tolerance, ritz_balanced *out)
{
    int64_t count = count_true(gramians, svd);
    RITZ_OWN(ritz_dense) T = {0}, ET = {0}, W = {0}, G = {0};

    RITZ_CHECK(project_side(&gramians->Zc, &svd->V, svd->s, count, &T));
    RITZ_CHECK(project_side(&gramians->Zo, &svd->U, svd->s, count, &W));
    RITZ_CHECK(
        project_side(descriptor_times(gramians), &svd->V, svd->s, count, &ET));
    RITZ_CHECK(ritz_dense_mul_tn(&ET, &W, &G));
    out->count = count_close(&G);
    out->kept = cut_values(out->count, svd->s, order, tolerance);
    out->bound = ritz_hankel_bound(out->count, svd->s, out->kept);
    RITZ_CHECK(ritz_dense_columns(&T, 0, out->kept, &out->T));
    return correct_sides(&W, &G, out->kept, &out->W);
}

ritz_status ritz_gramians_balance(const ritz_gramians *gramians, int64_t order,
                                  double tolerance, ritz_balanced *out)
{
    RITZ_OWN(ritz_product_svd) svd = {0};
    RITZ_OWN(ritz_balanced) balanced = {0};

    RITZ_REFUSE_IF(!(tolerance >= 0.0 && tolerance < 1.0), RITZ_ERR_ARGUMENT,
                   "a tolerance of Hankel values is %g, it must be at least 0 "
                   "and below 1",
                   tolerance);
    RITZ_CHECK_IN("balancing",
                  ritz_product_svd_new(&gramians->Zo,
                                       descriptor_times(gramians), true, &svd));
    RITZ_CHECK(project_balanced(gramians, &svd, order, tolerance, &balanced));
    RITZ_MOVE(balanced.sigma, svd.s);
    RITZ_MOVE(*out, balanced);
    return RITZ_OK;
}

void ritz_gramians_free(ritz_gramians *gramians)
{
    ritz_dense_free(&gramians->Zc);
    ritz_dense_free(&gramians->EZc);
    ritz_dense_free(&gramians->Zo);
    ritz_dense_free(&gramians->T);
    ritz_dense_free(&gramians->W);
    *gramians = (ritz_gramians){0};
}

void ritz_balanced_free(ritz_balanced *balanced)
{
    free(balanced->sigma);
    ritz_dense_free(&balanced->T);
    ritz_dense_free(&balanced->W);
    *balanced = (ritz_balanced){0};
}
