#include "response/krylov_small.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "poles/dense_poles.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The projected matrices, in coordinates of V. */
typedef struct matrices {
    ritz_dense K, M, D, K4;
    ritz_io io;
} matrices;

static void matrices_free(matrices *a)
{
    ritz_dense_free(&a->K);
    ritz_dense_free(&a->M);
    ritz_dense_free(&a->D);
    ritz_dense_free(&a->K4);
    ritz_io_free(&a->io);
}

/* diag(leading, block). */
static ritz_status beneath(int64_t m, const double *leading,
                           const ritz_dense *block, ritz_dense *out)
{
    int64_t r = m + block->nrow;

    RITZ_CHECK(ritz_dense_new(r, m + block->ncol, out));
    for (int64_t k = 0; k < m; k++)
        ritz_dense_col(out, k)[k] = leading ? leading[k] : 1.0;
    for (int64_t j = 0; j < block->ncol; j++)
        memcpy(ritz_dense_col(out, m + j) + m, ritz_dense_col(block, j),
               (size_t)block->nrow * sizeof *block->val);
    return RITZ_OK;
}

/* Modes keep their own numbers, so that resonances keep their digits. */
static ritz_status project(const ritz_direct *direct,
                           const ritz_krylov_space *space, matrices *out,
                           ritz_dense *K_x, ritz_dense *M_x)
{
    const ritz_component *c = space->component;
    int64_t m = direct->m;
    const ritz_dense X = ritz_dense_part(&space->V, m, space->V.ncol - m);

    RITZ_CHECK(ritz_sparse_condense(&c->K, &X, K_x));
    RITZ_CHECK(ritz_sparse_condense(&c->M, &X, M_x));
    RITZ_CHECK(beneath(m, direct->poles.lambda, K_x, &out->K));
    RITZ_CHECK(beneath(m, NULL, M_x, &out->M));
    RITZ_CHECK(ritz_sparse_project(&c->D, &space->V, &out->D));
    RITZ_CHECK(ritz_sparse_project(&c->K4, &space->V, &out->K4));
    return ritz_io_project(&c->io, &space->V, &out->io);
}

/* Pairs of the whole: modes as they are, and those of (K_x, M_x). */
static ritz_status pair(const ritz_direct *direct, const ritz_dense *K_x,
                        const ritz_dense *M_x, ritz_pairs *out)
{
    ritz_status status = RITZ_OK;
    ritz_pairs rest = {0};
    int64_t m = direct->m;

    if (K_x->ncol > 0)
        RITZ_TRY(ritz_eigen_dense(K_x, M_x, &rest));
    out->num_rigid = direct->poles.num_rigid;
    RITZ_NEW(out->lambda, m + K_x->ncol);
    memcpy(out->lambda, direct->poles.lambda, (size_t)m * sizeof *out->lambda);
    for (int64_t k = 0; k < rest.Phi.ncol; k++)
        out->lambda[m + k] = rest.lambda[k];
    RITZ_TRY(beneath(m, NULL, &rest.Phi, &out->Phi));
done:
    ritz_pairs_free(&rest);
    return status;
}

/* Ratios belong to modes: what was given to other coordinates goes. */
static void take_ratios(const ritz_direct *direct, ritz_poles *poles)
{
    for (int64_t k = direct->m; direct->ratios && k < poles->count; k++) {
        double w = sqrt(poles->lambda[k]);
        double given =
            2.0 * w *
            ritz_damping_of_mode(&direct->damping, k - poles->num_rigid, w);

        poles->rate[k] -= given;
        if (poles->D.val)
            ritz_dense_col(&poles->D, k)[k] -= given;
    }
}

static ritz_status transpose(const ritz_dense *A, ritz_dense *out)
{
    if (!A->val)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_new(A->ncol, A->nrow, out));
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < A->nrow; i++)
            ritz_dense_col(out, i)[j] = ritz_dense_col(A, j)[i];
    return RITZ_OK;
}

/* The transposed system, loaded by what the outputs see. */
static ritz_status turn_over(const ritz_poles *poles, ritz_poles *out)
{
    ritz_status status = RITZ_OK;
    const ritz_io *io = &poles->io;
    const ritz_dense *const rows[] = {&io->C, &io->Cv, &io->Ca};
    int64_t r = poles->count + poles->massless;
    int64_t p = io->num_outputs;
    ritz_poles dual = {.count = poles->count,
                       .num_rigid = poles->num_rigid,
                       .massless = poles->massless,
                       .coupled = poles->coupled,
                       .skew = poles->skew};

    RITZ_NEW(dual.lambda, r);
    RITZ_NEW(dual.rate, r);
    memcpy(dual.lambda, poles->lambda, (size_t)r * sizeof *dual.lambda);
    memcpy(dual.rate, poles->rate, (size_t)r * sizeof *dual.rate);
    RITZ_TRY(transpose(&poles->D, &dual.D));
    RITZ_TRY(transpose(&poles->K4, &dual.K4));
    RITZ_TRY(ritz_io_new(r, 3 * p, 0, &dual.io));
    for (int k = 0; k < 3; k++)
        for (int64_t j = 0; j < r; j++)
            for (int64_t i = 0; i < p; i++)
                ritz_dense_col(&dual.io.B, k * p + i)[j] =
                    ritz_dense_col(rows[k], j)[i];
    *out = dual;
    dual = (ritz_poles){0};
done:
    ritz_poles_free(&dual);
    return status;
}

ritz_status ritz_krylov_small_new(const ritz_direct *direct,
                                  const ritz_krylov_space *space,
                                  ritz_krylov_small *out)
{
    ritz_status status = RITZ_OK;
    const ritz_io *io = &space->component->io;
    ritz_krylov_small small = {.outputs = io->num_outputs,
                               .inputs = io->num_inputs,
                               .r = space->V.ncol};
    ritz_dense K_x = {0}, M_x = {0};
    ritz_pairs pairs = {0};
    matrices a = {0};
    const ritz_second_order model = {&a.K, &a.M, &a.D, &a.K4, &a.io};

    RITZ_TRY(project(direct, space, &a, &K_x, &M_x));
    RITZ_TRY(pair(direct, &K_x, &M_x, &pairs));
    RITZ_TRY(ritz_poles_of_pairs(&model, &direct->damping, true, &pairs,
                                 &small.poles));
    take_ratios(direct, &small.poles);
    RITZ_TRY(turn_over(&small.poles, &small.dual));
    small.T = pairs.Phi;
    pairs.Phi = (ritz_dense){0};
    RITZ_NEW(small.q, small.r * small.inputs);
    RITZ_NEW(small.p, small.r * small.outputs);
    RITZ_NEW(small.z, small.r * (3 * small.outputs + small.inputs));
    *out = small;
    small = (ritz_krylov_small){0};
done:
    matrices_free(&a);
    ritz_dense_free(&K_x);
    ritz_dense_free(&M_x);
    ritz_pairs_free(&pairs);
    ritz_krylov_small_free(&small);
    return status;
}

/* out = T z, columns of complex numbers. */
static void back(const ritz_dense *T, int64_t columns, const double _Complex *z,
                 double _Complex *out)
{
    int64_t r = T->nrow;

    for (int64_t j = 0; j < columns; j++) {
        for (int64_t i = 0; i < r; i++)
            out[i + j * r] = 0.0;
        for (int64_t k = 0; k < T->ncol; k++) {
            const double *t = ritz_dense_col(T, k);

            for (int64_t i = 0; i < r; i++)
                out[i + j * r] += t[i] * z[k + j * T->ncol];
        }
    }
}

ritz_status ritz_krylov_small_solve(ritz_krylov_small *small, double hertz)
{
    double w = 2.0 * RITZ_PI * hertz;
    int64_t rp = small->r * small->outputs;
    double _Complex *z = small->z;

    RITZ_CHECK(ritz_poles_solve(&small->poles, hertz, z));
    back(&small->T, small->inputs, z, small->q);
    RITZ_CHECK(ritz_poles_solve(&small->dual, hertz, z));
    for (int64_t k = 0; k < rp; k++)
        z[k] += ritz_complex(0.0, w) * z[rp + k] - w * w * z[2 * rp + k];
    back(&small->T, small->outputs, z, small->p);
    return RITZ_OK;
}

/* Factors of the kinds of W: of loads in c's residual, of terms in Z. */
static void factors(const ritz_direct *direct, const ritz_krylov_space *space,
                    double w, bool dual, double _Complex *f)
{
    bool rayleigh = ritz_damping_is_rayleigh(&direct->damping);
    double a = rayleigh ? direct->damping.a : 0.0;
    double b = rayleigh ? direct->damping.b : 0.0;
    const double _Complex iw = ritz_complex(0.0, w);

    f[RITZ_KRYLOV_B] = dual ? 0.0 : 1.0;
    f[RITZ_KRYLOV_C] = dual ? 1.0 : 0.0;
    f[RITZ_KRYLOV_CV] = dual ? iw : 0.0;
    f[RITZ_KRYLOV_CA] = dual ? -w * w : 0.0;
    f[RITZ_KRYLOV_K] = -(1.0 + b * iw);
    f[RITZ_KRYLOV_M] = w * w - a * iw;
    f[RITZ_KRYLOV_D] = dual && space->DT.colptr ? 0.0 : -iw;
    f[RITZ_KRYLOV_DT] = dual ? -iw : 0.0;
    f[RITZ_KRYLOV_K4] = ritz_complex(0.0, -1.0);
}

void ritz_krylov_residual(const ritz_direct *direct,
                          const ritz_krylov_space *space,
                          const ritz_krylov_small *small, double hertz,
                          bool dual, int64_t index, double _Complex *y)
{
    const double _Complex *x = (dual ? small->p : small->q) + index * small->r;
    double _Complex f[RITZ_KRYLOV_K4 + 1];

    factors(direct, space, 2.0 * RITZ_PI * hertz, dual, f);
    for (int64_t k = 0; k < space->W.ncol; k++) {
        ritz_krylov_column c = space->column[k];
        bool load = c.kind <= RITZ_KRYLOV_CA;

        if (load)
            y[k] = c.index == index ? f[c.kind] : 0.0;
        else
            y[k] = f[c.kind] * x[c.index];
    }
}

double ritz_krylov_space_norm(const ritz_krylov_space *space,
                              const double _Complex *y)
{
    double sum = 0.0;
    int64_t n = space->G.ncol;

    for (int64_t j = 0; j < n; j++) {
        const double *g = ritz_dense_col(&space->G, j);
        double _Complex part = 0.0;

        if (y[j] == 0.0)
            continue;
        for (int64_t i = 0; i < n; i++)
            part += g[i] * y[i];
        sum += creal(part) * creal(y[j]) + cimag(part) * cimag(y[j]);
    }
    return sqrt(fmax(sum, 0.0));
}

void ritz_krylov_small_free(ritz_krylov_small *small)
{
    ritz_poles_free(&small->poles);
    ritz_poles_free(&small->dual);
    ritz_dense_free(&small->T);
    free(small->q);
    free(small->p);
    free(small->z);
    *small = (ritz_krylov_small){0};
}
