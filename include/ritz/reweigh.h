/*
 * Output weights that suit a choice of modes. Modal costs depend on weights;
 * the weights that should decide are those of outputs that the choice serves
 * badly. So it goes round [ZhuSkelton1992]:
 *
 *     keep the k modes of largest cost sum_i q_i V_ki,
 *     d_i = |Y_i - Y_i(kept alone)|, what output i misses, in squared limits,
 *     q_i := (1 - a) p d_i / sum d + a q_i,    a = 1/2, q_i = 1 at first
 *
 * until weights and choice repeat: from round to round, or after several, which
 * is an oscillation and has no answer.
 */
#ifndef RITZ_REWEIGH_H
#define RITZ_REWEIGH_H

#include <ritz/ranking.h>

#pragma GCC visibility push(default)

typedef struct ritz_reweighing {
    int64_t num_outputs;
    double *weight; /* q, beside those of the request; of the best round */
    double *cost;   /* Y, variance of each output for white inputs */
    double *missed; /* d of the best round: its largest is the least */
    int64_t num_kept;
    int64_t *kept;     /* modes of the best round, ascending */
    int64_t rounds;    /* that were made */
    int64_t period;    /* 1: settled; more: oscillates; 0: does neither */
    int64_t num_other; /* oscillates: modes that another round of the period
                            would keep */
    int64_t *other;
} ritz_reweighing;

/**
 * @param[in] keep  k, less than there are modes; clusters stay whole
 * @return RITZ_ERR_ARGUMENT if there is nothing to choose from
 */
ritz_status ritz_reweigh(const ritz_rank_request *request, int64_t keep,
                         ritz_reweighing *out);

void ritz_reweighing_free(ritz_reweighing *reweighing);

#pragma GCC visibility pop

#endif
