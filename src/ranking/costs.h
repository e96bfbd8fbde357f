/* What rankings share with each other. */
#ifndef RITZ_RANKING_COSTS_H
#define RITZ_RANKING_COSTS_H

#include <ritz/ranking.h>

/** Modal costs of each output: m x p, row k that of mode k. */
ritz_status ritz_modal_costs(const ritz_modal *modal, ritz_dense *out);

/** Name k of a list or, without one, "y1". */
void ritz_ranking_name_part(const char (*names)[RITZ_NAME_SIZE],
                            const char *letter, int64_t k,
                            char out[RITZ_NAME_SIZE]);

/* What a cluster of modes, a model of its own, is worth. */
typedef ritz_status ritz_cluster_value(const ritz_rank_request *request,
                                       const ritz_modal *cluster, double *out);

/** The value of each mode is that of its cluster. */
ritz_status ritz_ranking_by_cluster(const ritz_rank_request *request,
                                    ritz_cluster_value *value,
                                    ritz_ranking *ranking);

/** Mean of the values within each cluster, for all of its modes. */
void ritz_ranking_share(const ritz_modal *modal, double *value);

/** Modes by magnitude of value, of equal ones the lower. */
ritz_status ritz_ranking_sort(int64_t count, const double *value,
                              int64_t *order);

/** The first mode of each mode's cluster. */
void ritz_ranking_clusters(const ritz_modal *modal, int64_t *cluster);

#endif
