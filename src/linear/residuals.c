#include "linear/residuals.h"

#include "base/alloc.h"
#include "base/team.h"
#include "linear/tiles.h"

#include <math.h>
#include <string.h>

enum {
    WIDTH = RITZ_TILE,  /* vectors that are assessed at a time */
    CHUNK = 32,         /* rows of K X and M X that are held at a time */
    WORTHWHILE = 50000, /* matrix entries from which one more thread is used */
};

static int threads_for(int64_t entries)
{
    return ritz_team_ready(1 + entries / WORTHWHILE);
}

/* Columns [first, first + count) of X, at most 8, copied to x row by row, n x 8;
   zeros fill the rest. */
typedef struct eight {
    const ritz_dense *X;
    int64_t first, count;
    double *x;
} eight;

static void lay_out_rows(int thread, int64_t from, int64_t to, void *task)
{
    const eight *e = task;

    (void)thread;
    for (int64_t i = from; i < to; i++)
        for (int64_t c = 0; c < WIDTH; c++)
            e->x[i * WIDTH + c] =
                c < e->count ? e->X->val[i + (e->first + c) * e->X->nrow] : 0.0;
}

static eight next_eight(const ritz_dense *X, int64_t first, double *x,
                        int threads)
{
    const int64_t left = X->ncol - first;
    eight e = {.X = X, .first = first, .count = left < WIDTH ? left : WIDTH};

    e.x = x;
    ritz_team_over(threads, X->nrow, lay_out_rows, &e);
    return e;
}

/* Of eight pairs, summed over the rows of one thread, with u = `unit`:
     gap     |K x - lambda M x|^2 / u^2
     size    | |K||x| + |lambda||M||x| |^2 / u^2
     energy  |x|'|K||x| */
typedef struct sums {
    double gap[WIDTH], size[WIDTH], energy[WIDTH];
} sums;

typedef struct assessment {
    const ritz_sparse *K, *M;
    eight of;
    double lambda[WIDTH];
    double unit; /* of forces, so that their squares do not overflow */
    sums *sums;  /* of each thread */
} assessment;

static void assess_row(const assessment *a, const double *x, const double *K[2],
                       const double *M[2], sums *s)
{
    const double per = 1.0 / a->unit;

    for (int c = 0; c < WIDTH; c++) {
        const double lambda = a->lambda[c];
        const double gap = (K[0][c] - lambda * M[0][c]) * per;
        const double size = (K[1][c] + fabs(lambda) * M[1][c]) * per;

        s->energy[c] += fabs(x[c]) * K[1][c];
        s->gap[c] += gap * gap;
        s->size[c] += size * size;
    }
}

static void assess_rows(int thread, int64_t from, int64_t to, void *task)
{
    const assessment *a = task;
    const ritz_sparse *K = a->K, *M = a->M;
    const ritz_tiles *tiles = ritz_tiles_here();
    sums s = {0};

    for (int64_t r = from; r < to; r += CHUNK) {
        const int64_t end = r + CHUNK < to ? r + CHUNK : to;
        double Kx[2][CHUNK * WIDTH], Mx[2][CHUNK * WIDTH];

        tiles->of[0].terms(r, end, K, a->of.x, Kx[0], Kx[1]);
        tiles->of[0].terms(r, end, M, a->of.x, Mx[0], Mx[1]);
        for (int64_t i = 0; i < (end - r) * WIDTH; i += WIDTH)
            assess_row(a, a->of.x + r * WIDTH + i,
                       (const double *[]){Kx[0] + i, Kx[1] + i},
                       (const double *[]){Mx[0] + i, Mx[1] + i}, &s);
    }
    a->sums[thread] = s;
}

/* Of eight pairs: norms |K x - lambda M x| and | |K||x| + |lambda||M||x| |, and
   energies. */
static void assess_eight(assessment *a, int threads, double *gaps,
                         double *sizes, double *energies)
{
    ritz_team_over(threads, a->K->nrow, assess_rows, a);
    for (int64_t c = 0; c < a->of.count; c++) {
        double gap = 0.0;
        double size = 0.0;
        double energy = 0.0;

        for (int t = 0; t < threads; t++) {
            gap += a->sums[t].gap[c];
            size += a->sums[t].size[c];
            energy += a->sums[t].energy[c];
        }
        energies[c] = energy;
        gaps[c] = sqrt(gap);
        sizes[c] = sqrt(size);
    }
}

void ritz_pairs_relate(ritz_pairs *P, const double *size, const double *energy,
                       double *worst)
{
    double most = 0.0;
    double scale = 0.0;

    for (int64_t j = 0; j < P->Phi.ncol; j++) {
        most = fmax(most, size[j]);
        scale = fmax(scale, energy[j]);
    }
    P->num_rigid = ritz_eigen_rigid(P->Phi.ncol, P->lambda, scale);
    *worst = 0.0;
    for (int64_t j = 0; j < P->Phi.ncol; j++) {
        const double by = j < P->num_rigid ? most : size[j];

        P->residual[j] = by == 0.0 ? 0.0 : P->residual[j] / by;
        if (!isnan(*worst) && !(P->residual[j] <= *worst))
            *worst = P->residual[j];
    }
}

/* The power of two above the largest |K(i,j)|, or the largest |M(i,j)| if K = 0.
   Vectors of unit mass have entries of moderate size, so that forces divided by
   it can be squared. A power of two divides without rounding. */
static double unit_of(const ritz_sparse *K, const ritz_sparse *M)
{
    const double k = ritz_sparse_max(K);
    int exponent = 0;

    frexp(k > 0.0 ? k : ritz_sparse_max(M), &exponent);
    return ldexp(1.0, exponent);
}

ritz_status ritz_pairs_assess(const ritz_sparse *K, const ritz_sparse *M,
                              ritz_pairs *P, double *energy, double *worst)
{
    const int threads = threads_for(K->colptr[K->ncol] + M->colptr[M->ncol]);
    RITZ_OWN_ARRAY double *x = NULL;
    RITZ_OWN_ARRAY sums *of = NULL;
    assessment a = {.K = K, .M = M, .unit = unit_of(K, M)};
    RITZ_OWN_ARRAY double *own = NULL, *size = NULL;

    RITZ_CHECK_NEW(x, K->nrow * WIDTH);
    RITZ_CHECK_NEW(size, P->Phi.ncol);
    RITZ_CHECK_NEW(of, threads);
    if (!energy) {
        RITZ_CHECK_NEW(own, P->Phi.ncol);
        energy = own;
    }
    a.sums = of;
    for (int64_t first = 0; first < P->Phi.ncol; first += WIDTH) {
        a.of = next_eight(&P->Phi, first, x, threads);
        memset(a.lambda, 0, sizeof a.lambda);
        memcpy(a.lambda, P->lambda + first,
               (size_t)a.of.count * sizeof *a.lambda);
        assess_eight(&a, threads, P->residual + first, size + first,
                     energy + first);
    }
    ritz_pairs_relate(P, size, energy, worst);
    return RITZ_OK;
}

/* Residuals of eight pairs, and their |x|'|K||x| and |x|'|M||x|, summed over the
   rows of one thread. */
typedef struct subtraction {
    const ritz_sparse *K, *M;
    eight of;
    const double *lambda;
    ritz_dense *R;
    double (*energy)[2][WIDTH]; /* of each thread */
} subtraction;

/* A X of rows from .. to - 1, row by row, to y; |X|'|A||X| of these rows is added
   to @p sum. */
static void multiply_rows(const ritz_sparse *A, int64_t from, int64_t to,
                          const double *x, double *y, double *sum)
{
    double size[CHUNK * WIDTH];

    ritz_tiles_here()->of[0].terms(from, to, A, x, y, size);
    for (int64_t i = 0; i < to - from; i++)
        for (int c = 0; c < WIDTH; c++)
            sum[c] += fabs(x[(from + i) * WIDTH + c]) * size[i * WIDTH + c];
}

static void subtract_rows(int thread, int64_t from, int64_t to, void *task)
{
    const subtraction *t = task;
    double energy[2][WIDTH] = {0};

    for (int64_t r = from; r < to; r += CHUNK) {
        const int64_t end = r + CHUNK < to ? r + CHUNK : to;
        double Kx[CHUNK * WIDTH], Mx[CHUNK * WIDTH];

        multiply_rows(t->K, r, end, t->of.x, Kx, energy[0]);
        multiply_rows(t->M, r, end, t->of.x, Mx, energy[1]);
        for (int64_t c = 0; c < t->of.count; c++)
            for (int64_t i = 0; i < end - r; i++)
                ritz_dense_col(t->R, t->of.first + c)[r + i] =
                    Kx[i * WIDTH + c] -
                    t->lambda[t->of.first + c] * Mx[i * WIDTH + c];
    }
    memcpy(t->energy[thread], energy, sizeof energy);
}

ritz_status ritz_pairs_subtract(const ritz_sparse *K, const ritz_sparse *M,
                                const ritz_dense *X, const double *lambda,
                                ritz_dense *R, double *stiffness_terms,
                                double *mass_terms)
{
    const int threads = threads_for(K->colptr[K->ncol] + M->colptr[M->ncol]);
    double *const terms[] = {stiffness_terms, mass_terms};
    RITZ_OWN_ARRAY double *x = NULL;
    RITZ_OWN_ARRAY double(*energy)[2][WIDTH] = NULL;

    RITZ_CHECK_NEW(x, K->nrow * WIDTH);
    RITZ_CHECK_NEW(energy, threads);
    RITZ_CHECK(ritz_dense_new(X->nrow, X->ncol, R));
    for (int64_t first = 0; first < X->ncol; first += WIDTH) {
        subtraction t = {K,      M, next_eight(X, first, x, threads),
                         lambda, R, energy};

        ritz_team_over(threads, K->nrow, subtract_rows, &t);
        for (int a = 0; a < 2; a++)
            for (int64_t c = 0; c < t.of.count; c++) {
                terms[a][first + c] = 0.0;
                for (int k = 0; k < threads; k++)
                    terms[a][first + c] += energy[k][a][c];
            }
    }
    return RITZ_OK;
}
