#include "poles/peak.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/search.h"

#include <complex.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>

/*
 * Peaks lie near poles, so the search starts at points near poles. It refines
 * all brackets at the same time by golden sections.
 */

/* Largest number of peaks that are refined, and brackets for each of them. */
enum { MOST_PEAKS = 8, BRACKETS = 3 };

double ritz_peak_of_pole(double _Complex pole)
{
    double gap = cimag(pole) * cimag(pole) - creal(pole) * creal(pole);

    return gap > 0.0 ? sqrt(gap) : cabs(pole);
}

ritz_status ritz_largest_singular(int64_t p, int64_t m, double _Complex *H,
                                  double *out)
{
    RITZ_OWN_ARRAY double *sigma = NULL, *spare = NULL;
    const int64_t count = p < m ? p : m;

    RITZ_CHECK_NEW(sigma, count);
    RITZ_CHECK_NEW(spare, count);
    RITZ_REFUSE_IF(LAPACKE_zgesvd(LAPACK_COL_MAJOR, 'N', 'N', (int)p, (int)m, H,
                                  (int)p, sigma, NULL, 1, NULL, 1, spare) != 0,
                   RITZ_ERR_CONVERGENCE,
                   "singular values of a response were not found");
    *out = sigma[0];
    return RITZ_OK;
}

ritz_status ritz_peak_at(ritz_peak *peak, int64_t count, const double *w,
                         double *value)
{
    const int64_t size = peak->outputs * peak->inputs;
    RITZ_OWN_ARRAY double _Complex *H = NULL;

    for (int64_t k = 0; k < count; k++)
        value[k] = 0.0;
    if (size == 0 || count == 0)
        return RITZ_OK;
    RITZ_CHECK_NEW(H, count * size);
    RITZ_CHECK(peak->respond(peak->state, count, w, H));
    for (int64_t k = 0; k < count; k++) {
        RITZ_CHECK(ritz_largest_singular(peak->outputs, peak->inputs,
                                         H + k * size, &value[k]));
        if (value[k] > peak->value) {
            peak->value = value[k];
            peak->w = w[k];
        }
    }
    return RITZ_OK;
}

static ritz_status climb_at(void *state, int64_t count, const double *w,
                            double *value)
{
    return ritz_peak_at(state, count, w, value);
}

/* Index of the highest point not yet taken; -1 if there is none. */
static int64_t next_highest_point(int64_t count, const double *value)
{
    int64_t best = -1;

    for (int64_t k = 0; k < count; k++)
        if (value[k] >= 0.0 && (best < 0 || value[k] > value[best]))
            best = k;
    return best;
}

/*
 * Brackets from a point to its neighbour on either side, and one within 1 % of
 * the point, for a narrow peak next to it.
 */
static void place_brackets(int64_t count, const double *w, int64_t k,
                           ritz_bracket *bracket)
{
    double low = k > 0 ? w[k - 1] : w[k];
    double high = k + 1 < count ? w[k + 1] : 2.0 * w[k] + 1.0;

    bracket[0] = (ritz_bracket){.low = low, .high = w[k]};
    bracket[1] = (ritz_bracket){.low = w[k], .high = high};
    bracket[2] = (ritz_bracket){.low = fmax(low, w[k] * 0.99),
                                .high = fmin(high, w[k] * 1.01)};
}

ritz_status ritz_peak_find(ritz_peak *peak, int64_t count, const double *w)
{
    const ritz_curves curves = {climb_at, peak};
    const double far = HUGE_VAL;
    RITZ_OWN_ARRAY double *value = NULL;
    ritz_bracket bracket[BRACKETS * MOST_PEAKS];
    double at_infinity = 0.0;
    int64_t brackets = 0;

    RITZ_CHECK_NEW(value, count);
    RITZ_CHECK(ritz_peak_at(peak, count, w, value));
    RITZ_CHECK(ritz_peak_at(peak, 1, &far, &at_infinity));
    while (brackets < (int64_t)BRACKETS * MOST_PEAKS) {
        int64_t k = next_highest_point(count, value);

        if (k < 0 || value[k] < RITZ_PEAK_WORTH * peak->value)
            break;
        value[k] = -1.0;
        place_brackets(count, w, k, bracket + brackets);
        brackets += BRACKETS;
    }
    return ritz_curves_between(&curves, RITZ_PEAK_PLACED, brackets, bracket);
}
