#include "poles/refine.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "poles/poles.h"

#include <math.h>
#include <stdlib.h>

enum { MOST_STEPS = 12, MOST_MATRICES = 4 };

ritz_status ritz_refiner_new(const ritz_component *component, bool structural,
                             ritz_refiner *out)
{
    const ritz_sparse *A[MOST_MATRICES] = {&component->K, &component->M};
    int64_t count = 2;
    ritz_refiner r = {.component = component};

    if (structural && component->K4.colptr)
        r.K4 = &component->K4;
    if (component->D.colptr)
        A[count++] = &component->D;
    if (r.K4)
        A[count++] = r.K4;
    RITZ_CHECK(ritz_zldl_new(count, A, &r.Z));
    *out = r;
    return RITZ_OK;
}

static double norm_of(const ritz_dense *x)
{
    double sum = 0.0;

    for (int64_t i = 0; i < x->nrow * x->ncol; i++)
        sum = hypot(sum, x->val[i]);
    return sum;
}

/* u += c A x. */
static ritz_status add_product(const ritz_sparse *A, double _Complex c,
                               const ritz_dense *x, double _Complex *u)
{
    RITZ_OWN(ritz_dense) Ax = {0};
    int64_t n = x->nrow;

    if (!A || !A->colptr)
        return RITZ_OK;
    RITZ_CHECK(ritz_sparse_mul(A, x, &Ax));
    for (int64_t i = 0; i < n; i++)
        u[i] += c * ritz_complex(Ax.val[i], Ax.val[n + i]);
    return RITZ_OK;
}

/* most += |c||A||x|, entry by entry. */
static void add_most(const ritz_sparse *A, double c, const ritz_dense *x,
                     double *most)
{
    int64_t n = x->nrow;

    for (int64_t j = 0; A && A->colptr && j < n; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            most[A->rowind[p]] +=
                c * fabs(A->val[p]) * hypot(x->val[j], x->val[n + j]);
}

static ritz_status factor_at(ritz_refiner *r, double _Complex s)
{
    double _Complex c[MOST_MATRICES] = {1.0, s * s};
    int64_t count = 2;

    if (r->component->D.colptr)
        c[count++] = s;
    if (r->K4)
        c[count] = ritz_complex(0.0, 1.0);
    return ritz_zldl_factor(r->Z, c);
}

/* One step; how far it moved s, 0 where s is the eigenvalue. */
static ritz_status take_step(ritz_refiner *r, ritz_dense *x, double _Complex *s,
                             double _Complex *u, double *move)
{
    ritz_status status = RITZ_OK;
    double size = norm_of(x);
    double _Complex xu = 0.0;
    int64_t n = x->nrow;
    bool last = false;

    for (int64_t i = 0; i < 2 * n; i++)
        x->val[i] /= size;
    for (int64_t i = 0; i < n; i++)
        u[i] = 0.0;
    RITZ_TRY(add_product(&r->component->M, 2.0 * *s, x, u));
    RITZ_TRY(add_product(&r->component->D, 1.0, x, u));
    status = factor_at(r, *s);
    *move = 0.0;
    last = status == RITZ_ERR_SINGULAR; /* s is the eigenvalue: x, beside it */
    if (last)
        status = factor_at(r, *s * (1.0 + RITZ_NUDGE));
    if (last && status == RITZ_ERR_SINGULAR)
        return RITZ_OK;
    RITZ_TRY(status);
    RITZ_TRY(ritz_zldl_solve(r->Z, 1, u));
    for (int64_t i = 0; i < n; i++)
        xu += ritz_complex(x->val[i], -x->val[n + i]) * u[i];
    for (int64_t i = 0; i < n; i++) {
        x->val[i] = creal(u[i]);
        x->val[n + i] = cimag(u[i]);
    }
    if (last)
        goto done;
    *move = cabs(1.0 / xu);
    *s -= 1.0 / xu;
done:
    return status;
}

ritz_status ritz_refine(ritz_refiner *refiner, ritz_dense *x,
                        double _Complex *s)
{
    ritz_status status = RITZ_OK;
    double _Complex *u = NULL;
    double before = HUGE_VAL;
    double move = HUGE_VAL;
    bool still = false;

    RITZ_NEW(u, x->nrow);
    for (int t = 0; t < MOST_STEPS && !still; t++) {
        RITZ_TRY(take_step(refiner, x, s, u, &move));
        still =
            move <= RITZ_REFINED * cabs(*s) ||
            (move <= RITZ_REFINED_NEARLY * cabs(*s) && move >= 0.5 * before);
        before = move;
    }
    RITZ_FAIL_IF(!still, RITZ_ERR_CONVERGENCE,
                 "the damped mode near %.6g Hz was not found",
                 ritz_eigen_hertz(cabs(*s) * cabs(*s)));
done:
    free(u);
    return status;
}

ritz_status ritz_refiner_residual(const ritz_refiner *refiner,
                                  const ritz_dense *x, double _Complex s,
                                  double *out)
{
    const struct {
        const ritz_sparse *A;
        double _Complex c;
    } terms[] = {
        {&refiner->component->K, 1.0},
        {&refiner->component->M, s * s},
        {&refiner->component->D, s},
        {refiner->K4, ritz_complex(0.0, 1.0)},
    };
    ritz_status status = RITZ_OK;
    double _Complex *u = NULL;
    double *most = NULL;
    double size = 0.0, gap = 0.0;

    RITZ_NEW(u, x->nrow);
    RITZ_NEW(most, x->nrow);
    for (int k = 0; k < MOST_MATRICES; k++) {
        RITZ_TRY(add_product(terms[k].A, terms[k].c, x, u));
        add_most(terms[k].A, cabs(terms[k].c), x, most);
    }
    for (int64_t i = 0; i < x->nrow; i++) {
        gap = hypot(gap, cabs(u[i]));
        size = hypot(size, most[i]);
    }
    *out = size > 0.0 ? gap / size : 0.0;
done:
    free(u);
    free(most);
    return status;
}

void ritz_refiner_free(ritz_refiner *refiner)
{
    ritz_zldl_free(&refiner->Z);
    *refiner = (ritz_refiner){0};
}
