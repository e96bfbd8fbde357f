/* The sparse pencil A - s E: products and factorisation. */
#include "linear/pencil.h"

#include "base/alloc.h"

#include <math.h>

static ritz_status make_identity(int64_t n, ritz_sparse *out)
{
    RITZ_CHECK(ritz_sparse_new(n, n, n, out));
    for (int64_t k = 0; k < n; k++) {
        out->colptr[k + 1] = k + 1;
        out->rowind[k] = k;
        out->val[k] = 1.0;
    }
    return RITZ_OK;
}

ritz_status ritz_pencil_new(const ritz_sparse *A, const ritz_sparse *E,
                            ritz_pencil *out)
{
    RITZ_OWN(ritz_pencil) p = {.n = A->nrow, .plain = !E->colptr};
    const ritz_sparse *const both[] = {&p.A, &p.E};

    RITZ_CHECK(ritz_sparse_copy(A, &p.A));
    RITZ_CHECK(p.plain ? make_identity(p.n, &p.E) : ritz_sparse_copy(E, &p.E));
    if (ritz_sparse_asymmetry(&p.A) > 0.0 ||
        ritz_sparse_asymmetry(&p.E) > 0.0) {
        RITZ_CHECK(ritz_sparse_transpose(&p.A, &p.At));
        RITZ_CHECK(ritz_sparse_transpose(&p.E, &p.Et));
    }
    RITZ_CHECK(ritz_zldl_new(2, both, &p.F));
    RITZ_MOVE(*out, p);
    return RITZ_OK;
}

bool ritz_pencil_is_symmetric(const ritz_pencil *pencil)
{
    return !pencil->At.colptr;
}

const ritz_sparse *ritz_pencil_system(const ritz_pencil *pencil,
                                      bool transposed)
{
    return transposed && pencil->At.colptr ? &pencil->At : &pencil->A;
}

const ritz_sparse *ritz_pencil_descriptor(const ritz_pencil *pencil,
                                          bool transposed)
{
    return transposed && pencil->Et.colptr ? &pencil->Et : &pencil->E;
}

ritz_status ritz_pencil_factor(ritz_pencil *pencil, double _Complex s)
{
    const double _Complex c[] = {1.0, -s};

    if (pencil->factored && pencil->s == s)
        return RITZ_OK;
    pencil->factored = false;
    RITZ_CHECK(ritz_zldl_factor(pencil->F, c));
    pencil->s = s;
    pencil->factored = true;
    return RITZ_OK;
}

ritz_status ritz_pencil_solve(ritz_pencil *pencil, bool transposed, int64_t k,
                              double _Complex *X)
{
    return ritz_zldl_solve(pencil->F, transposed, k, X);
}

void ritz_pencil_times(const ritz_sparse *A, int64_t k,
                       const double _Complex *X, double _Complex *Y)
{
    for (int64_t c = 0; c < k; c++) {
        const double _Complex *x = X + c * A->ncol;
        double _Complex *y = Y + c * A->nrow;

        for (int64_t i = 0; i < A->nrow; i++)
            y[i] = 0.0;
        for (int64_t j = 0; j < A->ncol; j++)
            for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
                y[A->rowind[p]] += A->val[p] * x[j];
    }
}

void ritz_pencil_free(ritz_pencil *pencil)
{
    ritz_zldl_free(&pencil->F);
    ritz_sparse_free(&pencil->A);
    ritz_sparse_free(&pencil->E);
    ritz_sparse_free(&pencil->At);
    ritz_sparse_free(&pencil->Et);
    *pencil = (ritz_pencil){0};
}

double ritz_pencil_magnitude(const ritz_pencil *pencil, double w,
                             const double *x, const double *y)
{
    const ritz_sparse *const M[] = {&pencil->A, &pencil->E};
    const double c[] = {1.0, w};
    double sum = 0.0;

    for (int m = 0; m < 2; m++)
        for (int64_t j = 0; j < pencil->n; j++)
            for (int64_t p = M[m]->colptr[j]; p < M[m]->colptr[j + 1]; p++)
                sum += c[m] * fabs(M[m]->val[p]) * y[M[m]->rowind[p]] * x[j];
    return sum;
}
