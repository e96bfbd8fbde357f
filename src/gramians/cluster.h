/* Modes too close to be told apart. */
#ifndef RITZ_GRAMIANS_CLUSTER_H
#define RITZ_GRAMIANS_CLUSTER_H

#include <ritz/model.h>

/** One past the last mode of the cluster that begins at mode @p first. */
int64_t ritz_modal_cluster(const ritz_modal *modal, int64_t first);

/** Modes first .. last - 1 as a model of their own. */
ritz_status ritz_modal_part(const ritz_modal *modal, int64_t first,
                            int64_t last, ritz_modal *out);

#endif
