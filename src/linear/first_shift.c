/*
 * The lowest eigenvalues of a body that is l elements long, relative to the
 * highest, which K_jj / M_jj estimates, are proportional to
 *
 *     l^-4  of bending,   l^-2  of stretching and of solids.
 *
 * The shift is RITZ_FIRST_BENDING l^-4 of the median of K_jj / M_jj, a little
 * less than the first bending eigenvalue. l is the number of levels of a
 * breadth-first search through the graph of K.
 *
 * A long body need not bend. Its k-th of n eigenvalues is at most about
 * (k / n)^(2/3) of the highest, that of a compact solid, and the shift is not
 * smaller than a part RITZ_FIRST_LEAST of this.
 *
 * A larger shift keeps more digits of the factor, and costs blocks of Lanczos or
 * another factor: bodies for which these cost nothing have the largest one.
 */
#include "linear/first_shift.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <math.h>

/* Rows by their level; row[0] is where the search begins. */
typedef struct levels {
    int64_t *row;
    bool *reached;
    int64_t count; /* rows reached */
} levels;

static void levels_free(levels *l)
{
    RITZ_FREE(l->row, l->reached);
}

/* Append the rows that are coupled with rows from .. to - 1 of the list and are
   not in it yet. */
static void append_level(const ritz_sparse *K, int64_t from, int64_t to,
                         levels *l)
{
    for (int64_t k = from; k < to; k++) {
        const int64_t j = l->row[k];

        for (int64_t p = K->colptr[j]; p < K->colptr[j + 1]; p++) {
            const int64_t i = K->rowind[p];

            if (l->reached[i])
                continue;
            l->reached[i] = true;
            l->row[l->count++] = i;
        }
    }
}

/* The number of levels from row `start` on, and the last row reached. */
static int64_t count_levels(const ritz_sparse *K, int64_t start, levels *l,
                            int64_t *last)
{
    int64_t found = 0;
    int64_t from = 0;

    for (int64_t i = 0; i < K->nrow; i++)
        l->reached[i] = false;
    l->row[0] = start;
    l->reached[start] = true;
    l->count = 1;
    while (from < l->count) {
        const int64_t to = l->count;

        append_level(K, from, to, l);
        from = to;
        found++;
    }
    *last = l->row[l->count - 1];
    return found;
}

/* l, from a row at one end. */
static ritz_status find_length(const ritz_sparse *K, int64_t *out)
{
    RITZ_OWN(levels) l = {0};
    int64_t end = 0;

    RITZ_CHECK_NEW(l.row, K->nrow);
    RITZ_CHECK_NEW(l.reached, K->nrow);
    count_levels(K, 0, &l, &end);
    *out = count_levels(K, end, &l, &end);
    return RITZ_OK;
}

ritz_status ritz_first_shift(const ritz_sparse *K, double typical,
                             int64_t modes, double *out)
{
    const double part = fmin(1.0, (double)modes / fmax(1.0, (double)K->nrow));
    double bending = 1.0;
    int64_t length = 1;

    RITZ_CHECK(find_length(K, &length));
    bending = RITZ_FIRST_BENDING * pow((double)length, -4.0);
    *out =
        typical * fmin(RITZ_FIRST_SHIFT,
                       fmax(bending, RITZ_FIRST_LEAST * pow(part, 2.0 / 3.0)));
    return RITZ_OK;
}

ritz_status ritz_first_factor(double typical, double sigma,
                              ritz_status (*factor)(void *of, double sigma),
                              void *of)
{
    ritz_status status = factor(of, sigma);

    while (status == RITZ_ERR_SINGULAR && -sigma < 1e3 * typical) {
        sigma = fmin(100.0 * sigma, -RITZ_FIRST_SHIFT * typical);
        status = factor(of, sigma);
    }
    if (status == RITZ_ERR_SINGULAR)
        ritz_record("stiffness and mass together are not positive definite, "
                    "is there a mechanism without mass?");
    return status;
}
