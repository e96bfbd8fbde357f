#include "ranking/coupling.h"

#include <math.h>

/* A mode this much weaker than the largest is rounding: its coupling is too. */
static const double negligible = 1e-20;

/* Which of a Gramian's entries are largest against their diagonals. */
static void couple(const ritz_dense *W, ritz_ranking *ranking)
{
    const int64_t *cluster = ranking->cluster;
    double largest[2] = {0.0, 0.0};

    for (int64_t a = 0; a < W->nrow; a++)
        largest[a % 2] = fmax(largest[a % 2], ritz_dense_col(W, a)[a]);
    for (int64_t b = 0; b < W->nrow; b++)
        for (int64_t a = 0; a < b; a++) {
            double wa = ritz_dense_col(W, a)[a];
            double wb = ritz_dense_col(W, b)[b];
            double off = fabs(ritz_dense_col(W, b)[a]) / sqrt(wa * wb);

            if (cluster[a / 2] == cluster[b / 2] ||
                !(wa > negligible * largest[a % 2]) ||
                !(wb > negligible * largest[b % 2]) ||
                !(off > ranking->coupling))
                continue;
            ranking->coupling = off;
            ranking->coupled[0] = a / 2;
            ranking->coupled[1] = b / 2;
        }
}

ritz_status ritz_ranking_coupling(const ritz_modal *modal,
                                  ritz_ranking *ranking)
{
    ritz_status status = RITZ_OK;
    ritz_dense Wc = {0};
    ritz_dense Wo = {0};

    RITZ_TRY(ritz_modal_gramians(modal, &Wc, &Wo));
    ranking->coupling = 0.0;
    couple(&Wc, ranking);
    couple(&Wo, ranking);
done:
    ritz_dense_free(&Wc);
    ritz_dense_free(&Wo);
    return status;
}
