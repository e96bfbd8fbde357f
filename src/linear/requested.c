#include "linear/requested.h"

#include "base/tolerances.h"

#include <float.h>
#include <math.h>

static bool is_clustered(double a, double b)
{
    return fabs(b - a) <= RITZ_CLUSTER_GAP * fmax(fabs(a), fabs(b));
}

bool ritz_pairs_clustered(const ritz_pairs *P, int64_t k)
{
    return k > 0 && k < P->Phi.ncol &&
           is_clustered(P->lambda[k - 1], P->lambda[k]);
}

int64_t ritz_pairs_whole(const ritz_pairs *P, int64_t end)
{
    while (ritz_pairs_clustered(P, end))
        end++;
    return end;
}

int64_t ritz_pairs_wanted(const ritz_pairs *P, const ritz_span *span,
                          double limit)
{
    int64_t end = P->num_rigid + (span->modes < 0 ? 0 : span->modes);
    int64_t count = P->Phi.ncol;

    if (span->modes < 0)
        for (end = P->num_rigid; end < count && P->lambda[end] <= limit;)
            end++;
    return ritz_pairs_whole(P, end < count ? end : count);
}

int64_t ritz_pairs_gap(const ritz_pairs *P, int64_t end)
{
    const int64_t count = P->Phi.ncol;
    const double rounding =
        count > 0 ? RITZ_COUNT_ROUNDING * fabs(P->lambda[count - 1]) : 0.0;
    double widest = 0.0;
    int64_t at = end;

    for (int64_t k = end > 0 ? end : 1; k < count; k++) {
        double gap = (P->lambda[k] - P->lambda[k - 1]) /
                     fmax(fabs(P->lambda[k]), rounding);

        if (gap > widest) {
            widest = gap;
            at = k;
        }
    }
    return at;
}

double ritz_pairs_between(const ritz_pairs *P, int64_t k, double part)
{
    double above = k < P->Phi.ncol ? P->lambda[k] : HUGE_VAL;
    double below = k > 0 ? P->lambda[k - 1] : above - fabs(above) - DBL_MIN;

    if (k == P->Phi.ncol)
        above = below + fabs(below) + DBL_MIN;
    return below + part * (above - below);
}

bool ritz_pairs_unclear(const ritz_pairs *P, double limit)
{
    for (int64_t j = 0; j < P->Phi.ncol; j++)
        if (fabs(P->lambda[j] - limit) <= RITZ_COUNT_UNCLEAR * limit)
            return true;
    return false;
}

void ritz_pairs_truncate(ritz_pairs *P, int64_t end)
{
    P->Phi.ncol = end;
    P->num_rigid = P->num_rigid < end ? P->num_rigid : end;
}
