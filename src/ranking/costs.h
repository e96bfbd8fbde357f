/* What several rankings have in common. */
#ifndef RITZ_RANKING_COSTS_H
#define RITZ_RANKING_COSTS_H

#include <ritz/ranking.h>

/** Modal costs of each output: m x p, row k that of mode k. */
ritz_status ritz_modal_costs(const ritz_modal *modal, ritz_dense *out);

/** Name k of a list or, without one, "y1". */
void ritz_ranking_name_part(const char (*names)[RITZ_NAME_SIZE],
                            const char *letter, int64_t k,
                            char out[RITZ_NAME_SIZE]);

/* The value of a cluster of modes that is a model of its own. */
typedef ritz_status ritz_cluster_value(const ritz_rank_request *request,
                                       const ritz_modal *cluster, double *out);

/** Rank by cluster: the value of each mode is that of its cluster. */
ritz_status ritz_ranking_by_cluster(const ritz_rank_request *request,
                                    ritz_cluster_value *value,
                                    ritz_ranking *ranking);

/** Replace the values within each cluster by their mean. */
void ritz_ranking_share(const ritz_modal *modal, double *value);

/** Sort modes by magnitude of value; of equal ones the lower mode precedes. */
ritz_status ritz_ranking_sort(int64_t count, const double *value,
                              int64_t *order);

/** The first mode of each mode's cluster. */
void ritz_ranking_clusters(const ritz_modal *modal, int64_t *cluster);

#endif
