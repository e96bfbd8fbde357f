/*
 * A neighbour as the component feels it through a joint. Its own motion is
 * u_f = A q (neighbour.c); the relations of the joint (joints.c) are rows
 *
 *     F q - G u = 0 where locked,    a spring of k_s where caged,
 *
 * u being the dofs of the component's port. With L those rows of F that are
 * locked, q = S u + Z z, S = L^+ G, L Z = 0; z is what the joint leaves free:
 * it goes where the energy is least, and if it costs none where inertia takes
 * it,
 *
 *     Z'H Z z = -Z'(H S - sum k_s f g') u,     H = K + sum k_s f f'
 *     (ZN)'M (S u + Z z) = 0,                  Z'HZ N = 0
 *
 * so that q = Y u, M_n = Y'MY, K_n = Y'KY + sum k_s (Y'f - g)(Y'f - g)'.
 */
#include "assembly/neighbour.h"
#include "base/alloc.h"

#include <lapacke.h>

#include <math.h>
#include <stdlib.h>

/* Of a matrix scaled to unit diagonal: smaller singular values are none. */
static const double rank_tolerance = 1e-9;
/* Of the largest diagonal entry: below it is rounding. */
static const double rounding = 1e-13;

/* Rows of one state, those of springs each times the root of its stiffness. */
static ritz_status pick(const ritz_dense *A, const ritz_link *of,
                        ritz_freedom_state state, ritz_dense *out)
{
    int64_t count = 0;

    for (int64_t k = 0; k < of->count; k++)
        count += of->freedom[k].state == state;
    RITZ_CHECK(ritz_dense_new(count, A->ncol, out));
    count = 0;
    for (int64_t k = 0; k < of->count; k++) {
        const ritz_freedom *freedom = &of->freedom[k];
        double factor = state == RITZ_CAGED ? sqrt(freedom->stiffness) : 1.0;

        if (freedom->state != state)
            continue;
        for (int64_t j = 0; j < A->ncol; j++)
            ritz_dense_col(out, j)[count] = factor * ritz_dense_col(A, j)[k];
        count++;
    }
    return RITZ_OK;
}

/* S = L^+ G and Z: what the locked rows demand of q, and what they leave. */
static ritz_status hold(const ritz_link *of, ritz_dense *S, ritz_dense *Z)
{
    ritz_status status = RITZ_OK;
    ritz_dense L = {0}, G = {0}, U = {0}, Vt = {0}, UG = {0};
    double *sigma = NULL;
    int c = 0;
    int r = (int)of->F.ncol;
    int64_t rank = 0;

    RITZ_TRY(pick(&of->F, of, RITZ_LOCKED, &L));
    RITZ_TRY(pick(&of->G, of, RITZ_LOCKED, &G));
    c = (int)L.nrow;
    RITZ_TRY(ritz_dense_new(c, c, &U));
    RITZ_TRY(ritz_dense_new(r, r, &Vt));
    RITZ_NEW(sigma, c < r ? c : r);
    for (int64_t j = 0; j < r && c == 0; j++)
        ritz_dense_col(&Vt, j)[j] = 1.0;
    RITZ_FAIL_IF(c > 0 && LAPACKE_dgesdd(LAPACK_COL_MAJOR, 'A', c, r, L.val, c,
                                         sigma, U.val, c, Vt.val, r) != 0,
                 RITZ_ERR_CONVERGENCE, "the joint's relations have no rank");
    while (rank < c && rank < r && sigma[rank] > rank_tolerance * sigma[0])
        rank++;
    RITZ_TRY(ritz_dense_mul_tn(&U, &G, &UG));
    RITZ_TRY(ritz_dense_new(r, G.ncol, S));
    RITZ_TRY(ritz_dense_new(r, r - rank, Z));
    for (int64_t i = 0; i < r; i++) {
        for (int64_t j = 0; j < G.ncol; j++)
            for (int64_t k = 0; k < rank; k++)
                ritz_dense_col(S, j)[i] += ritz_dense_col(&Vt, i)[k] *
                                           ritz_dense_col(&UG, j)[k] / sigma[k];
        for (int64_t k = rank; k < r; k++)
            ritz_dense_col(Z, k - rank)[i] = ritz_dense_col(&Vt, i)[k];
    }
done:
    free(sigma);
    ritz_dense_free(&L);
    ritz_dense_free(&G);
    ritz_dense_free(&U);
    ritz_dense_free(&Vt);
    ritz_dense_free(&UG);
    return status;
}

/*
 * X = -A^+ B of a semidefinite A, and N whose columns A does not see; both by
 * the eigenvectors of A scaled to unit diagonal. N may be NULL.
 */
static ritz_status relax(ritz_dense *A, const ritz_dense *B, double largest,
                         ritz_dense *X, ritz_dense *N)
{
    ritz_status status = RITZ_OK;
    int64_t n = A->ncol;
    int64_t unseen = 0;
    double *d = NULL, *lambda = NULL;

    RITZ_NEW(d, n);
    RITZ_NEW(lambda, n);
    RITZ_TRY(ritz_dense_new(n, B->ncol, X));
    for (int64_t j = 0; j < n; j++) {
        double own = ritz_dense_col(A, j)[j];

        d[j] = own > rounding * largest ? 1.0 / sqrt(own) : 0.0;
    }
    for (int64_t j = 0; j < n; j++)
        for (int64_t i = 0; i < n; i++)
            ritz_dense_col(A, j)[i] *= d[i] * d[j];
    for (int64_t j = 0; j < n; j++)
        d[j] = d[j] > 0.0 ? d[j] : 1.0;
    RITZ_FAIL_IF(n > 0 && LAPACKE_dsyevd(LAPACK_COL_MAJOR, 'V', 'L', (int)n,
                                         A->val, (int)n, lambda) != 0,
                 RITZ_ERR_CONVERGENCE,
                 "what the joint leaves free has no eigenvalues");
    while (unseen < n && lambda[unseen] <= rank_tolerance)
        unseen++;
    for (int64_t k = unseen; k < n; k++)
        for (int64_t j = 0; j < B->ncol; j++) {
            const double *w = ritz_dense_col(A, k);
            double sum = 0.0;

            for (int64_t i = 0; i < n; i++)
                sum += w[i] * d[i] * ritz_dense_col(B, j)[i];
            for (int64_t i = 0; i < n; i++)
                ritz_dense_col(X, j)[i] -= d[i] * w[i] * sum / lambda[k];
        }
    if (N)
        RITZ_TRY(ritz_dense_columns(A, 0, unseen, N));
    for (int64_t j = 0; N && j < unseen; j++)
        for (int64_t i = 0; i < n; i++)
            ritz_dense_col(N, j)[i] *= d[i];
done:
    free(d);
    free(lambda);
    return status;
}

/* S += Z X with X = -(Z'HZ)^+ Z'R; N as above. */
static ritz_status move(const ritz_dense *H, const ritz_dense *R,
                        const ritz_dense *Z, ritz_dense *S, ritz_dense *N)
{
    ritz_status status = RITZ_OK;
    ritz_dense A = {0}, B = {0}, X = {0}, more = {0};

    RITZ_TRY(ritz_dense_congruence(H, Z, &A));
    RITZ_TRY(ritz_dense_mul_tn(Z, R, &B));
    RITZ_TRY(relax(&A, &B, ritz_dense_max(H), &X, N));
    RITZ_TRY(ritz_dense_mul(Z, &X, &more));
    for (int64_t k = 0; k < S->nrow * S->ncol; k++)
        S->val[k] += more.val[k];
done:
    ritz_dense_free(&A);
    ritz_dense_free(&B);
    ritz_dense_free(&X);
    ritz_dense_free(&more);
    return status;
}

/* K + f f' of the springs' rows, each times the root of its stiffness. */
static ritz_status add_springs(const ritz_dense *K, const ritz_dense *f,
                               ritz_dense *H)
{
    ritz_status status = RITZ_OK;
    ritz_dense part = {0};

    RITZ_TRY(ritz_dense_mul_tn(f, f, &part));
    RITZ_TRY(ritz_dense_copy(K, H));
    for (int64_t k = 0; k < H->nrow * H->ncol; k++)
        H->val[k] += part.val[k];
done:
    ritz_dense_free(&part);
    return status;
}

/* Y: how the far body follows the near port. */
static ritz_status follow(const ritz_reduced *far, const ritz_link *of,
                          ritz_dense *Y)
{
    ritz_status status = RITZ_OK;
    ritz_dense Z = {0}, N = {0}, ZN = {0}, f = {0}, g = {0};
    ritz_dense H = {0}, R = {0}, cross = {0}, MS = {0};

    RITZ_TRY(hold(of, Y, &Z));
    RITZ_TRY(pick(&of->F, of, RITZ_CAGED, &f));
    RITZ_TRY(pick(&of->G, of, RITZ_CAGED, &g));
    RITZ_TRY(add_springs(&far->K, &f, &H));
    RITZ_TRY(ritz_dense_mul(&H, Y, &R));
    RITZ_TRY(ritz_dense_mul_tn(&f, &g, &cross));
    for (int64_t k = 0; k < R.nrow * R.ncol; k++)
        R.val[k] -= cross.val[k];
    RITZ_TRY(move(&H, &R, &Z, Y, &N));
    RITZ_TRY(ritz_dense_mul(&Z, &N, &ZN));
    RITZ_TRY(ritz_dense_mul(&far->M, Y, &MS));
    RITZ_TRY(move(&far->M, &MS, &ZN, Y, NULL));
done:
    ritz_dense_free(&Z);
    ritz_dense_free(&N);
    ritz_dense_free(&ZN);
    ritz_dense_free(&f);
    ritz_dense_free(&g);
    ritz_dense_free(&H);
    ritz_dense_free(&R);
    ritz_dense_free(&cross);
    ritz_dense_free(&MS);
    return status;
}

/* K_n of the near port's dofs. */
static ritz_status stiffness(const ritz_reduced *far, const ritz_link *of,
                             const ritz_dense *Y, ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense f = {0}, g = {0}, K = {0}, gap = {0};

    RITZ_TRY(pick(&of->F, of, RITZ_CAGED, &f));
    RITZ_TRY(pick(&of->G, of, RITZ_CAGED, &g));
    RITZ_TRY(ritz_dense_congruence(&far->K, Y, &K));
    RITZ_TRY(ritz_dense_mul(&f, Y, &gap));
    for (int64_t k = 0; k < gap.nrow * gap.ncol; k++)
        gap.val[k] -= g.val[k];
    RITZ_TRY(add_springs(&K, &gap, out));
done:
    ritz_dense_free(&f);
    ritz_dense_free(&g);
    ritz_dense_free(&K);
    ritz_dense_free(&gap);
    return status;
}

ritz_status ritz_link_condense(const ritz_reduced *far, const ritz_link *link,
                               ritz_dense *K, ritz_dense *M)
{
    ritz_status status = RITZ_OK;
    ritz_dense Y = {0};

    RITZ_TRY(follow(far, link, &Y));
    RITZ_TRY(stiffness(far, link, &Y, K));
    RITZ_TRY(ritz_dense_congruence(&far->M, &Y, M));
done:
    ritz_dense_free(&Y);
    return status;
}

void ritz_link_free(ritz_link *link)
{
    ritz_dense_free(&link->F);
    ritz_dense_free(&link->G);
    free(link->freedom);
    *link = (ritz_link){0};
}
