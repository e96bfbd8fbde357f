/* What is in an object, for people and as JSON: ritz-info, ritz-import. */
#ifndef RITZ_TOOLS_DESCRIBE_H
#define RITZ_TOOLS_DESCRIBE_H

#include "model.h"

#include <ritz/bulk.h>
#include <ritz/foreign.h>

/* Each says it in lines and sets keys of @p keys. */
void describe_component(const cli_run *run, json_t *keys,
                        const ritz_component *component);
void describe_basis(const cli_run *run, json_t *keys, const ritz_basis *basis);
ritz_status describe_reduced(const cli_run *run, json_t *keys,
                             const ritz_reduced *reduced);
ritz_status describe_system(const cli_run *run, json_t *keys,
                            const ritz_system *system);
void describe_response(const cli_run *run, json_t *keys,
                       const ritz_response *response);
void describe_ranking(const cli_run *run, json_t *keys,
                      const ritz_ranking *ranking);
void describe_matrices(const cli_run *run, json_t *keys,
                       const ritz_matrices *matrices);
void describe_bulk(const cli_run *run, json_t *keys, const ritz_bulk *bulk);

/** Best first: mode, frequency, damping, value, share. */
void describe_order(const cli_run *run, const ritz_ranking *ranking);

/** Mass, centre and inertia; nothing if not known. */
void describe_inertia(const cli_run *run, json_t *keys,
                      const ritz_inertia *inertia);

#endif
