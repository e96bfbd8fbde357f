#include "bases/krylov_block.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* Of eps max |v|'|W||v|; see docs/methods/krylov.md for what was measured. */
static const double products = 16.0;

void ritz_krylov_say(ritz_basis *basis, const char *format, ...)
{
    size_t used = strlen(basis->remark);
    va_list args;

    va_start(args, format);
    (void)vsnprintf(basis->remark + used, sizeof basis->remark - used, format,
                    args);
    va_end(args);
}

void ritz_krylov_say_blocks(const ritz_krylov *S, int64_t asked,
                            ritz_basis *basis)
{
    int64_t found = S->set.count - S->seeds;

    if (found < asked)
        ritz_krylov_say(basis,
                        "%" PRId64 " vectors and not %" PRId64
                        ", nothing new is left; ",
                        found, asked);
    for (int64_t k = 0; k < S->num_points; k++)
        ritz_krylov_say(basis, "%s%" PRId64 " whole block(s) about %g Hz",
                        k > 0 ? ", " : "", S->point[k].whole,
                        S->point[k].hertz);
}

/* Largest |v|'|W||v| of the columns. */
static double largest_sum(const ritz_dense *V, const ritz_dense *size)
{
    double most = 0.0;

    for (int64_t j = 0; j < V->ncol; j++) {
        double sum = 0.0;

        for (int64_t i = 0; i < V->nrow; i++)
            sum += fabs(ritz_dense_col(V, j)[i]) * ritz_dense_col(size, j)[i];
        most = fmax(most, sum);
    }
    return most;
}

static ritz_status measure(const ritz_krylov *S, double *worst, double *bound)
{
    ritz_status status = RITZ_OK;
    bool by_mass = S->inner == RITZ_INNER_MASS;
    const ritz_sparse *W = by_mass ? S->body->M : S->body->K;
    const ritz_dense V = ritz_dense_part(&S->set.V, 0, S->set.count);
    ritz_dense WV = {0}, size = {0}, G = {0};

    RITZ_TRY(ritz_sparse_mul(W, &V, &WV));
    RITZ_TRY(ritz_dense_mul_tn(&V, &WV, &G));
    RITZ_TRY(ritz_dense_new(V.nrow, V.ncol, &size));
    ritz_krylov_size(W, &V, 1.0, &size);
    for (int64_t j = 0; j < G.ncol; j++)
        ritz_dense_col(&G, j)[j] -= 1.0;
    *worst = ritz_dense_max(&G);
    *bound = products * DBL_EPSILON * largest_sum(&V, &size);
done:
    ritz_dense_free(&WV);
    ritz_dense_free(&size);
    ritz_dense_free(&G);
    return status;
}

ritz_status ritz_krylov_say_orthonormal(const ritz_krylov *S, ritz_basis *basis)
{
    const char *W = S->inner == RITZ_INNER_MASS ? "M" : "K";
    double worst = 0.0;
    double bound = 0.0;

    RITZ_CHECK(measure(S, &worst, &bound));
    ritz_krylov_say(basis, "; |V'%sV - I| is %.1e, %s %.1e", W, worst,
                    worst <= bound ? "within" : "beyond", bound);
    return RITZ_OK;
}

ritz_status ritz_krylov_join(const ritz_krylov *S, ritz_basis *out)
{
    const ritz_dense *Phi = &S->body->Phi;
    int64_t r = Phi->ncol;
    size_t size = (size_t)Phi->nrow * sizeof *Phi->val;

    RITZ_REFUSE_IF(r + S->set.count == 0, RITZ_ERR_ARGUMENT,
                   "the basis would have no vectors");
    RITZ_CHECK(ritz_basis_new(S->body->K->nrow, r + S->set.count, out));
    for (int64_t j = 0; j < r; j++) {
        memcpy(ritz_dense_col(&out->T, j), ritz_dense_col(Phi, j), size);
        out->columns.kind[j] = RITZ_COLUMN_RIGID;
        out->columns.hertz[j] = 0.0;
        out->columns.residual[j] = S->body->residual[j];
    }
    for (int64_t j = 0; j < S->set.count; j++) {
        memcpy(ritz_dense_col(&out->T, r + j), ritz_dense_col(&S->set.V, j),
               (size_t)out->T.nrow * sizeof *out->T.val);
        out->columns.kind[r + j] = RITZ_COLUMN_KRYLOV;
    }
    snprintf(out->origin.engine, sizeof out->origin.engine, "CHOLMOD%s",
             S->point[S->num_points - 1].A ? " + MUMPS" : "");
    return RITZ_OK;
}
