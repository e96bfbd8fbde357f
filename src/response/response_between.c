/* What a response says between its points: see ritz_response_at. */
#include "response/mesh.h"

#include <math.h>

enum { CUBIC = 4 };
/* Of the last frequency: so far beside the range is in it. */
static const double rounding = 1e-12;

int ritz_cubic(int64_t count, const double *x, int64_t k, double at,
               int64_t *first, double weight[static 4])
{
    int points = count < CUBIC ? (int)count : CUBIC;
    int64_t from = k - 1;

    if (from > count - points)
        from = count - points;
    if (from < 0)
        from = 0;
    for (int i = 0; i < points; i++) {
        weight[i] = 1.0;
        for (int j = 0; j < points; j++)
            if (j != i)
                weight[i] *= (at - x[from + j]) / (x[from + i] - x[from + j]);
    }
    *first = from;
    return points;
}

void ritz_cubic_mix(int points, const double *weight, int64_t values,
                    const double _Complex *H, double _Complex *out)
{
    for (int64_t v = 0; v < values; v++) {
        out[v] = 0.0;
        for (int i = 0; i < points; i++)
            out[v] += weight[i] * H[i * values + v];
    }
}

/* The last point at or before `hertz`, but for that at the end. */
static int64_t interval(const ritz_response *r, double hertz)
{
    int64_t low = 0;
    int64_t high = r->count - 1;

    while (high - low > 1) {
        int64_t middle = low + (high - low) / 2;

        if (r->hertz[middle] <= hertz)
            low = middle;
        else
            high = middle;
    }
    return low;
}

ritz_status ritz_response_at(const ritz_response *response, double hertz,
                             double _Complex *out)
{
    const ritz_response *r = response;
    int64_t values = r->num_outputs * r->num_inputs;
    double weight[CUBIC];
    int64_t first = 0;
    int points = 0;
    double beside = 0.0;

    RITZ_REFUSE_IF(r->count < 1, RITZ_ERR_ARGUMENT,
                   "the response has no points");
    beside = rounding * r->hertz[r->count - 1];
    RITZ_REFUSE_IF(!(hertz >= r->hertz[0] - beside) ||
                       !(hertz <= r->hertz[r->count - 1] + beside),
                   RITZ_ERR_ARGUMENT,
                   "%g Hz is outside the response, which is from %g to %g Hz",
                   hertz, r->hertz[0], r->hertz[r->count - 1]);
    points = ritz_cubic(r->count, r->hertz, interval(r, hertz), hertz, &first,
                        weight);
    for (int i = 0; i < points; i++)
        RITZ_REFUSE_IF(!isfinite(weight[i]), RITZ_ERR_ARGUMENT,
                       "the response has %g Hz twice", hertz);
    ritz_cubic_mix(points, weight, values, r->H + first * values, out);
    return RITZ_OK;
}
