/* What tools share: containers of any kind, and how they are reported. */
#ifndef RITZ_TOOLS_CLI_MODEL_H
#define RITZ_TOOLS_CLI_MODEL_H

#include "cli/sink.h"

#include <ritz/container.h>
#include <ritz/scene.h>
#include <ritz/simulate.h>
#include <ritz/verify.h>

/* Up to here two triangles differ by rounding, which is no cause to warn. */
#define MODEL_ROUNDING 1e-13

typedef enum model_kind {
    MODEL_COMPONENT = 1,
    MODEL_BASIS = 2,
    MODEL_REDUCED = 4,
    MODEL_SYSTEM = 8,
    MODEL_RESPONSE = 16,
    MODEL_RANKING = 32,
    MODEL_STATES = 64,
    MODEL_SIMULATION = 128,
    MODEL_ANY = 255,
} model_kind;

/* A container that was read: the object that `kind` names, others empty. */
typedef struct model {
    model_kind kind;
    ritz_component component;
    ritz_basis basis;
    ritz_reduced reduced;
    ritz_system system;
    ritz_response response;
    ritz_rankings rankings;
    ritz_state_space states;
    ritz_simulation simulation;
    ritz_configuration *at; /* of a system, once model_at has chosen */
} model;

/* The small matrices of a reduced component or of a system as it stands. */
typedef struct model_view {
    ritz_second_order matrices;
    const char *damping; /* of the model; "" none */
} model_view;

/** The kind of a container, and how sentences call it: "a system". */
ritz_status model_peek(const char *path, model_kind *kind, const char **noun);

/**
 * Hash and read a container of one of some kinds.
 *
 * @param[in] wanted  sum of those wanted; another is refused by name
 */
ritz_status model_read(cli_run *run, const char *path, int wanted, model *out);

/** Hash and read a scene, and hash the models that it names. */
ritz_status model_scene(cli_run *run, const char *path, ritz_scene *out);

/** Choose the configuration of --at; @p at given for no system is refused. */
ritz_status model_at(model *model, const char *path, const char *at);

/** Of a reduced component or a system with its configuration chosen. */
model_view model_look(const model *model);

/** The damping of --damping, or else the model's own. */
ritz_status model_damping(const model *model, const char *asked,
                          ritz_damping *out);

/** Frequencies of a small dense model, Hz, rigid modes as 0. */
ritz_status model_hertz(const ritz_dense *K, const ritz_dense *M,
                        int64_t *num_rigid, int64_t *count, double **out);

/** Frequencies of a configuration, Hz, rigid modes as 0; caller frees. */
ritz_status model_hertz_at(const ritz_configuration *at, double **out);

/**
 * Table of measures, and a list of them with verdicts; or the list alone.
 *
 * @param[in] known  the word for those without a limit: "measured", "estimated"
 */
void model_say_measures(cli_run *run, const char *key,
                        const ritz_measures *measures, const char *known);
void model_set_measures(cli_run *run, const char *key,
                        const ritz_measures *measures, const char *known);

json_t *model_measures_json(const ritz_measures *measures, const char *known);
json_t *model_cost_json(const ritz_cost *cost);
json_t *model_reals_json(int64_t count, const double *values);

/** What a simulator pays, as the object `cost`. */
void model_set_cost(cli_run *run, const ritz_cost *cost);

/** Names of inputs and outputs, and limits, borrowed; no matrices. */
ritz_io model_io_of_states(const ritz_state_space *states);

/** "1.2 to 30.5 Hz" of the columns that have a frequency; false if none. */
bool model_band(const ritz_columns *columns, double *low, double *high);

void model_free(model *model);

#endif
