/* What several rankings share: clusters, order. */
#ifndef RITZ_RANKING_CLUSTERS_H
#define RITZ_RANKING_CLUSTERS_H

#include <ritz/ranking.h>

/** Name k of a list or, without one, "y1". */
void ritz_ranking_name_part(const char (*names)[RITZ_NAME_SIZE],
                            const char *letter, int64_t k,
                            char out[RITZ_NAME_SIZE]);

/** For each mode, the first mode of its cluster; clusters by frequency only. */
void ritz_ranking_clusters(const ritz_modal *modal, int64_t *cluster);

/** One past the last mode of the cluster by frequency that begins at @p
 * first. */
int64_t ritz_cluster_end(int64_t count, const int64_t *cluster, int64_t first);

/** Replace the values within each cluster by their mean. */
void ritz_ranking_share(int64_t count, const int64_t *cluster, double *value);

/** Sort modes by magnitude of value; of equal ones the lower mode precedes. */
ritz_status ritz_ranking_sort(int64_t count, const double *value,
                              int64_t *order);

#endif
