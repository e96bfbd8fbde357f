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
 *                     MARGIN (FACTOR f s + SINGLE 4 l v
 *                     + BASIS (4 n 300 v + 2 n k^2) + SMALL 9 600^3 (s + 1))
 *     substructures   three factors with dense fronts, a reduced matrix of order
 *                     r = 6 g + 200, three inverse iterations with g = 1.5 k vectors:
 *                     FRONTS (FACTOR 3 f + SMALL 4/3 r^3
 *                     + 3 (SOLVE 4 l g + 6 n g^2))
 *
 * The factors in capitals are measured, see docs/methods/eigen.md.
 */
#include "linear/engine_choice.h"

#include <float.h>
#include <math.h>

/* Time of an operation, in multiples of that of a large matrix product. */
static const double SOLVE = 4.0;  /* sixteen right-hand sides */
static const double SINGLE = 5.5; /* eight */
static const double BASIS = 0.5;  /* sixteen vectors and a basis: fewer vectors
                                     than m on plates */
static const double SMALL = 2.5;  /* eigenvectors of a small matrix */
static const double FACTOR = 1.5;
static const double FRONTS = 5.0; /* small dense matrices, and estimates */
static const double MARGIN = 1.1; /* by which slices must be faster, because
                                     predictions err by as much */

enum {
    LEAF = 200, /* rows of a substructure */
    SIDE = 100, /* of slices */
    SLICE_BASIS =
        1000, /* vectors that a slice has in addition to those found */
};

static double slices_of(double k)
{
    return k > 2 * SIDE ? ceil((k - SIDE) / (2 * SIDE)) : 0.0;
}

static ritz_engine_cost cost_of_lanczos(const ritz_search_size *s)
{
    const double n = (double)s->n, k = (double)s->k;
    const double m = s->accuracy > 0.0 ? 2.3 * k + 100.0 : 2.5 * k + 240.0;

    return (ritz_engine_cost){
        .operations = SOLVE * 4.0 * s->entries * m +
                      BASIS * 2.0 * n * m * (m + k) + SMALL * 9.0 * m * m * m,
        .bytes = 8.0 * (n * (4.0 * k + 96.0) + 48.0 * k * k)};
}

static ritz_engine_cost cost_of_slices(const ritz_search_size *s)
{
    const double n = (double)s->n, k = (double)s->k;
    const double v = 3.3 * k;

    return (ritz_engine_cost){
        .operations =
            MARGIN *
            (FACTOR * s->operations * slices_of(k) +
             SINGLE * 4.0 * s->entries * v +
             BASIS * (4.0 * n * 3.0 * SIDE * v + 2.0 * n * k * k) +
             SMALL * 9.0 * pow(6.0 * SIDE, 3.0) * (slices_of(k) + 1.0)),
        .bytes = 8.0 * n * (k + SLICE_BASIS)};
}

/* With an accuracy slices come last: they find pairs to rounding, and state no
   bounds of errors. */
static ritz_engine_cost cost_of_exact(const ritz_search_size *s)
{
    ritz_engine_cost cost = cost_of_slices(s);

    if (s->accuracy > 0.0)
        cost.operations = DBL_MAX;
    return cost;
}

static ritz_engine_cost cost_of_amls(const ritz_search_size *s)
{
    const double n = (double)s->n, k = 1.5 * (double)s->k;
    const double r = 6.0 * k + LEAF;

    return (ritz_engine_cost){
        .operations =
            FRONTS *
            (FACTOR * 3.0 * s->operations + SMALL * 4.0 / 3.0 * r * r * r +
             3.0 * (SOLVE * 4.0 * s->entries * k + 6.0 * n * k * k)),
        .bytes = 8.0 * (3.0 * n * k + r * (r + 3.0 * k))};
}

ritz_engine_cost ritz_engine_cost_of(ritz_eigen_engine engine,
                                     const ritz_search_size *size)
{
    const ritz_engine_cost none = {HUGE_VAL, HUGE_VAL};

    switch (engine) {
    case RITZ_EIGEN_LANCZOS:
        return cost_of_lanczos(size);
    case RITZ_EIGEN_SLICES: /* up to so many modes they are block Lanczos */
        return size->k > 2 * SIDE ? cost_of_exact(size) : none;
    case RITZ_EIGEN_AMLS:
        return size->accuracy > 0.0 ? cost_of_amls(size) : none;
    case RITZ_EIGEN_AUTO:
    case RITZ_EIGEN_ARPACK:
        break;
    }
    return none;
}

ritz_eigen_engine ritz_engine_choose(const ritz_search_size *size,
                                     bool (*fits)(int64_t bytes),
                                     const char **reason)
{
    static const ritz_eigen_engine engines[] = {
        RITZ_EIGEN_LANCZOS, RITZ_EIGEN_SLICES, RITZ_EIGEN_AMLS};
    enum { ENGINES = sizeof engines / sizeof *engines };
    ritz_engine_cost cost[ENGINES] = {0};
    int fastest = 0;
    int smallest = 0;
    int best = -1;

    for (int e = 0; e < ENGINES; e++) {
        cost[e] = ritz_engine_cost_of(engines[e], size);
        if (cost[e].operations < cost[fastest].operations)
            fastest = e;
        if (cost[e].bytes < cost[smallest].bytes)
            smallest = e;
        if (cost[e].bytes < (double)INT64_MAX &&
            (best < 0 || cost[e].operations < cost[best].operations) &&
            fits((int64_t)cost[e].bytes))
            best = e;
    }
    *reason = best == fastest ? "the fastest by prediction"
              : best >= 0     ? "the fastest that fits into memory"
                              : "it needs the least memory";
    return engines[best >= 0 ? best : smallest];
}
