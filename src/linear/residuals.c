#include "linear/residuals.h"

#include "base/alloc.h"
#include "base/team.h"

#include <math.h>
#include <string.h>

enum {
    WIDTH = 8,          /* pairs that are assessed at a time */
    WORTHWHILE = 50000, /* one thread for each so many entries of K and M */
};

/* Norms of eight pairs, summed over the rows of one thread: |K x - lambda M x|,
   | |K||x| + |lambda||M||x| | and |x|'|K||x|. */
typedef struct sums {
    double gap[WIDTH], size[WIDTH], energy[WIDTH];
} sums;

typedef struct assessment {
    const ritz_sparse *K, *M;
    const ritz_pairs *P;
    int64_t first, count; /* pairs [first, first + count) */
    double *x;            /* their vectors, n x 8 row by row */
    sums *of;             /* of each thread */
} assessment;

static void lay_out_rows(int thread, int64_t from, int64_t to, void *task)
{
    const assessment *a = task;

    (void)thread;
    for (int64_t i = from; i < to; i++)
        for (int64_t c = 0; c < a->count; c++)
            a->x[i * WIDTH + c] =
                a->P->Phi.val[i + (a->first + c) * a->K->nrow];
}

/* y := row j of A x, and size := row j of |A||x|, for a symmetric A. */
static void multiply_row(const ritz_sparse *A, int64_t j, const double *x,
                         double *y, double *size)
{
    memset(y, 0, WIDTH * sizeof *y);
    memset(size, 0, WIDTH * sizeof *size);
    for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
        const double *from = x + A->rowind[p] * WIDTH;
        const double a = A->val[p];

        for (int c = 0; c < WIDTH; c++) {
            const double part = a * from[c];

            y[c] += part;
            size[c] += fabs(part);
        }
    }
}

static void assess_rows(int thread, int64_t from, int64_t to, void *task)
{
    const assessment *a = task;
    sums *s = &a->of[thread];

    *s = (sums){0};
    for (int64_t j = from; j < to; j++) {
        double Kx[WIDTH], Mx[WIDTH], k[WIDTH], m[WIDTH];

        multiply_row(a->K, j, a->x, Kx, k);
        multiply_row(a->M, j, a->x, Mx, m);
        for (int c = 0; c < a->count; c++) {
            const double lambda = a->P->lambda[a->first + c];

            s->energy[c] += fabs(a->x[j * WIDTH + c]) * k[c];
            s->gap[c] = hypot(s->gap[c], Kx[c] - lambda * Mx[c]);
            s->size[c] = hypot(s->size[c], k[c] + fabs(lambda) * m[c]);
        }
    }
}

/* Residuals of the pairs [first, first + count). *scale is raised to the
   largest of their |x|'|K||x|. */
static void assess_eight(assessment *a, int threads, double *scale)
{
    ritz_team_over(threads, a->K->nrow, lay_out_rows, a);
    ritz_team_over(threads, a->K->nrow, assess_rows, a);
    for (int64_t c = 0; c < a->count; c++) {
        double gap = 0.0;
        double size = 0.0;
        double energy = 0.0;

        for (int t = 0; t < threads; t++) {
            gap = hypot(gap, a->of[t].gap[c]);
            size = hypot(size, a->of[t].size[c]);
            energy += a->of[t].energy[c];
        }
        *scale = fmax(*scale, energy);
        a->P->residual[a->first + c] = size > 0.0 ? gap / size : 0.0;
    }
}

ritz_status ritz_pairs_assess(const ritz_sparse *K, const ritz_sparse *M,
                              ritz_pairs *P, double *worst)
{
    const int64_t entries = K->colptr[K->ncol] + M->colptr[M->ncol];
    const int threads = ritz_team_ready(1 + entries / WORTHWHILE);
    RITZ_OWN_ARRAY double *x = NULL;
    RITZ_OWN_ARRAY sums *of = NULL;
    double scale = 0.0;

    RITZ_CHECK_NEW(x, K->nrow * WIDTH);
    RITZ_CHECK_NEW(of, threads);
    *worst = 0.0;
    for (int64_t first = 0; first < P->Phi.ncol; first += WIDTH) {
        const int64_t left = P->Phi.ncol - first;

        assess_eight(
            &(assessment){K, M, P, first, left < WIDTH ? left : WIDTH, x, of},
            threads, &scale);
    }
    for (int64_t j = 0; j < P->Phi.ncol; j++)
        *worst = P->residual[j] <= *worst ? *worst : P->residual[j];
    P->num_rigid = ritz_eigen_rigid(P->Phi.ncol, P->lambda, scale);
    return RITZ_OK;
}
