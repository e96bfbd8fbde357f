/* What is in an object, for people and as JSON: ritz-info, ritz-import. */
#ifndef RITZ_TOOLS_PRINT_DESCRIBE_H
#define RITZ_TOOLS_PRINT_DESCRIBE_H

#include "cli/model.h"

#include <ritz/deck.h>
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
void describe_simulation(const cli_run *run, json_t *keys,
                         const ritz_simulation *simulation);
void describe_rankings(const cli_run *run, json_t *keys,
                       const ritz_rankings *all);
ritz_status describe_states(const cli_run *run, json_t *keys,
                            const ritz_state_space *states);
void describe_matrices(const cli_run *run, json_t *keys,
                       const ritz_matrices *matrices);
void describe_deck(const cli_run *run, json_t *keys, const ritz_deck *deck);

/** Text form of a damping, and of a fit what it came to. */
void describe_damping(const cli_run *run, json_t *keys, const char *text);
void describe_dampers(const cli_run *run, json_t *keys,
                      const ritz_dampers *dampers);

/** Dofs that constraints eliminated. */
void describe_recovery(const cli_run *run, json_t *keys,
                       const ritz_recovery *recovery);

/** Share of D that is antisymmetric, in the Frobenius norm; and of a dense D. */
void describe_skew(const cli_run *run, json_t *keys, double share);
double describe_skew_dense(const ritz_dense *D);

/** How a basis was made; kinds of its columns; a group of measures. */
void describe_origin(const cli_run *run, json_t *keys,
                     const ritz_origin *origin);
void describe_columns(const cli_run *run, json_t *keys,
                      const ritz_columns *columns);
void describe_measures(const cli_run *run, json_t *keys, const char *key,
                       const ritz_measures *measures);

/** Mass, centre and inertia; nothing if not known. */
void describe_inertia(const cli_run *run, json_t *keys,
                      const ritz_inertia *inertia);

#endif
