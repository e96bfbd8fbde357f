/*
 * Operations of a search for k modes of n dofs, with a factor of l entries that
 * takes f operations, in multiples of those of a large matrix product: solves
 * read the factor from memory, and the eigenvectors of a small matrix wait for
 * memory, too.
 *
 *     block Lanczos   m vectors, 2.5 k + 240, or 2.3 k + 100 with an accuracy:
 *                     SOLVE 4 l m + BASIS 2 n m (m + k) + SMALL 9 m^3
 *     slices          s = (k - 100) / 200 factors more, v = 3.3 k vectors, each
 *                     orthogonal to 300 others on average:
 *                     1.1 (FACTOR f s + SINGLE 4 l v
 *                     + BASIS (4 n 300 v + 2 n k^2) + SMALL 9 600^3 (s + 1))
 *     substructures   three factors with dense fronts, a reduced matrix of
 *                     order r = 6 g + 200, three inverse iterations with g = 1.5 k vectors:
 *                     FRONTS (FACTOR 3 f + SMALL 4/3 r^3
 *                     + 3 (SOLVE 4 l g + 6 n g^2))
 *
 * The factors in capitals are measured, see docs/methods/eigen.md.
 */
#include "linear/engine_choice.h"

#include "linear/factor.h"

#include <math.h>

/* Time of an operation, in multiples of that of a large matrix product. */
static const struct {
    double solve;  /* sixteen right-hand sides */
    double single; /* eight */
    double basis;  /* sixteen vectors and a basis: fewer vectors than m on
                      plates */
    double small;  /* eigenvectors of a small matrix */
    double factor;
    double fronts; /* small dense matrices, and estimates */
} time_of = {.solve = 4.0,
             .single = 5.5,
             .basis = 0.5,
             .small = 2.5,
             .factor = 1.5,
             .fronts = 5.0};

enum {
    LEAF = 200, /* rows of a substructure */
    SIDE = 100, /* of slices */
    MARGIN = 10 /* percent by which slices must be faster, because predictions
                   err by as much */
};

static double slices_of(double k)
{
    return k > 2 * SIDE ? ceil((k - SIDE) / (2 * SIDE)) : 0.0;
}

static double cost_of_lanczos(const ritz_search_size *s)
{
    const double n = (double)s->n, k = (double)s->k;
    const double m = s->accuracy > 0.0 ? 2.3 * k + 100.0 : 2.5 * k + 240.0;

    return time_of.solve * 4.0 * s->entries * m +
           time_of.basis * 2.0 * n * m * (m + k) +
           time_of.small * 9.0 * m * m * m;
}

/* Up to 200 modes slices are block Lanczos. They find pairs to rounding, and
   state no bounds of errors. */
static double cost_of_slices(const ritz_search_size *s)
{
    const double n = (double)s->n, k = (double)s->k;
    const double v = 3.3 * k;

    if (k <= 2.0 * SIDE || s->accuracy > 0.0)
        return HUGE_VAL;
    return (1.0 + MARGIN / 100.0) *
           (time_of.factor * s->operations * slices_of(k) +
            time_of.single * 4.0 * s->entries * v +
            time_of.basis * (4.0 * n * 3.0 * SIDE * v + 2.0 * n * k * k) +
            time_of.small * 9.0 * pow(6.0 * SIDE, 3.0) * (slices_of(k) + 1.0));
}

static double cost_of_amls(const ritz_search_size *s)
{
    const double n = (double)s->n, k = 1.5 * (double)s->k;
    const double r = 6.0 * k + LEAF;

    if (!(s->accuracy > 0.0))
        return HUGE_VAL;
    return time_of.fronts *
           (time_of.factor * 3.0 * s->operations +
            time_of.small * 4.0 / 3.0 * r * r * r +
            3.0 * (time_of.solve * 4.0 * s->entries * k + 6.0 * n * k * k));
}

double ritz_engine_cost(ritz_eigen_engine engine, const ritz_search_size *size)
{
    switch (engine) {
    case RITZ_EIGEN_LANCZOS:
        return cost_of_lanczos(size);
    case RITZ_EIGEN_SLICES:
        return cost_of_slices(size);
    case RITZ_EIGEN_AMLS:
        return cost_of_amls(size);
    case RITZ_EIGEN_AUTO:
    case RITZ_EIGEN_ARPACK:
        break;
    }
    return HUGE_VAL;
}

ritz_eigen_engine ritz_engine_choose(const ritz_search_size *size)
{
    static const ritz_eigen_engine others[] = {RITZ_EIGEN_SLICES,
                                               RITZ_EIGEN_AMLS};
    ritz_eigen_engine best = RITZ_EIGEN_LANCZOS;

    for (size_t e = 0; e < sizeof others / sizeof *others; e++)
        if (ritz_engine_cost(others[e], size) < ritz_engine_cost(best, size))
            best = others[e];
    return best;
}

ritz_eigen_engine ritz_engine_of(const ritz_span *span, const ritz_factor *A,
                                 int64_t n, int64_t k)
{
    ritz_search_size size = {.n = n, .k = k, .accuracy = span->accuracy};

    if (span->engine != RITZ_EIGEN_AUTO)
        return span->engine;
    ritz_factor_size(A, &size.entries, &size.operations);
    return ritz_engine_choose(&size);
}
