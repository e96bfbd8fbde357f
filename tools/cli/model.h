/* Containers of any kind: reading, questions that tools ask of any, reports. */
#ifndef RITZ_TOOLS_CLI_MODEL_H
#define RITZ_TOOLS_CLI_MODEL_H

#include "cli/sink.h"

#include <ritz/assembly.h>
#include <ritz/check.h>
#include <ritz/container.h>
#include <ritz/poles.h>
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
    MODEL_RECOVERED = 256,
    MODEL_ANY = 511,
} model_kind;

/* Those that have poles and responses. */
enum {
    MODEL_DYNAMIC =
        MODEL_COMPONENT | MODEL_REDUCED | MODEL_SYSTEM | MODEL_STATES
};

/* X(KIND, type, member of a model, name in files, noun of sentences) */
#define MODEL_EACH_KIND(X)                                                     \
    X(COMPONENT, component, component, "component", "a component")             \
    X(BASIS, basis, basis, "basis", "a basis")                                 \
    X(REDUCED, reduced, reduced, "reduced", "a reduced component")             \
    X(SYSTEM, system, system, "system", "a system")                            \
    X(RESPONSE, response, response, "response", "a response")                  \
    X(RANKING, rankings, rankings, "ranking", "a ranking")                     \
    X(STATES, state_space, states, "state-space", "a state space")             \
    X(SIMULATION, simulation, simulation, "simulation", "a time response")     \
    X(RECOVERED, recovered, recovered, "recovered", "recovered maxima")

/* The content of a container: the object that `kind` names. All others are
   empty, except those from which it was made. */
typedef struct model {
    model_kind kind;
#define MODEL_MEMBER(KIND, type, member, name, noun) ritz_##type member;
    MODEL_EACH_KIND(MODEL_MEMBER)
#undef MODEL_MEMBER
    ritz_configuration *at; /* of a system, once model_at has chosen */
    ritz_damping damping;   /* added to that of matrices; by model_settle */
} model;

/* Options that choose or change a model before it is used. */
typedef struct model_options {
    const char *at;      /* configuration of a system; NULL: the only one */
    const char *damping; /* NULL: the model's own */
    cli_list damper;     /* "NAME=C[*K]", other values of dampers */
    int64_t order;       /* columns of a nested component; 0: all */
} model_options;

/* Rows of option tables that several tools share. */
#define AT_OPTION(place)                                                       \
    CLI_TEXT("at", place, "JOINT=SETTING[,JOINT=SETTING]",                     \
             "configuration of a system, in degrees and lengths")

#define ORDER_OPTION(place)                                                    \
    CLI_INT("order", place, "N", 1, 1e6,                                       \
            "the first N columns of a nested reduced component [all]")

#define DAMPING_OPTION(place)                                                  \
    CLI_TEXT("damping", place, "TEXT",                                         \
             "\"modal ZETA\", \"modes ZETA ...\", \"bands F F ZETA ...\" "     \
             "(Hz), \"rayleigh A B\" or \"fit F ZETA ...\" [the model's]")

#define DAMPERS_OPTION(list)                                                   \
    CLI_LIST("damper", list, "NAME=C[*K]",                                     \
             "give a damper other values than the model states")

/* All that is asked of a model before anything is made of it. */
#define MODEL_OPTIONS(given)                                                   \
    AT_OPTION(&(given)->at), ORDER_OPTION(&(given)->order),                    \
        DAMPING_OPTION(&(given)->damping), DAMPERS_OPTION(&(given)->damper)

/* The words of a choice as options. */
enum { WORDS_MOST = 32, WORDS_NAME = 32 };

typedef struct choice_words {
    const char *text[WORDS_MOST];
    char name[WORDS_MOST][WORDS_NAME];
} choice_words;

/**
 * An option for every word: shift_hz becomes --shift-hz.
 *
 * @param[in]  except   RITZ_USES_... of words that the tool has options of its
 *                      own for
 * @param[out] options  room for WORDS_MOST
 */
void words_add(choice_words *all, int except, cli_option *options);

/** Take the words that were given into a choice, or end the program. */
void words_take(const cli_program *program, const choice_words *all,
                ritz_choice *choice);

/** The kind of a container, and how sentences call it: "a system". */
ritz_status model_peek(const char *path, model_kind *kind, const char **noun);

/** Those of some kinds in a sentence: "a component or a system". */
void model_nouns(int wanted, char *out, size_t room);

/**
 * Hash and read a container of one of some kinds.
 *
 * @param[in] wanted  sum of those wanted; another is refused by name
 */
ritz_status model_read(cli_run *run, const char *path, int wanted, model *out);

/** Hash and read a scene, and hash the models that it names. */
ritz_status model_scene(cli_run *run, const char *path, ritz_scene *out);

/** Warn that a state space, which has no stiffness matrix, leaves out the
 * geometric stiffness of @p count loads of a model. */
void model_warn_loads(cli_run *run, const char *path, int64_t count);

/** Warn of a scene with more than 1000 configurations, which a few lines of
 * text can define: estimate from the first one their time and memory. */
ritz_status model_foresee(cli_run *run, const ritz_stage *stage);

/** Choose the configuration of --at; @p at given for no system is refused. */
ritz_status model_at(model *model, const char *path, const char *at);

/**
 * Convert to a reduced component, if possible: a nested reduced component is
 * cut to its first columns, a system is taken at its configuration.
 */
ritz_status model_as_reduced(model *model, const char *path,
                             const model_options *given);

/**
 * Convert to a component, if possible: a reduced component or a system as
 * above, whose coordinates become dofs. `reduced` stays as well.
 */
ritz_status model_as_component(model *model, const char *path,
                               const model_options *given);

/**
 * Cut a reduced component to its first @p order columns, before anything is
 * made of it; 0: keep all.
 *
 * @return RITZ_ERR_ARGUMENT if it is no reduced component, or has no such
 *         prefix
 */
ritz_status model_prefix(model *model, const char *path, int64_t order);

/**
 * All that is asked of a model that was read: its first columns, its
 * configuration, its dampers with their values, installed, and its damping.
 *
 * @return RITZ_ERR_ARGUMENT if a state space is to be damped otherwise
 */
ritz_status model_settle(model *model, const char *path,
                         const model_options *given);

/*
 * Questions that tools ask of a component, reduced component, system with its
 * configuration chosen, or state space, whichever it is.
 */

/** The object that was read, whatever its kind. */
const void *model_object(const model *model);

/** As the library takes it, with that damping; borrowed. */
ritz_model model_reference(const model *model);

/* A component with more dofs is not made a first-order model just for its poles
   or zeros. */
enum { MODEL_MOST_DOFS = 400 };

/** Whether it is or can be made a state space: it has no structural damping,
 * and not too many dofs. */
bool model_has_states(const model *model);

/** Write it as the output. */
ritz_status model_write(cli_run *run, const model *model);

/** Dampers of a model, and the values that --damper gives them. */
ritz_dampers *model_dampers(model *model);
ritz_status model_tune(model *model, const cli_list *texts);

/** Tune them, and install them in the model's D and K; NULL: as they are. */
ritz_status model_install(model *model, const cli_list *texts);

/** The damping of --damping, or else the model's own. */
ritz_status model_damping(const model *model, const char *given,
                          ritz_damping *out);

/** Frequencies of a small dense model, Hz, rigid modes as 0. */
ritz_status model_hertz(const ritz_dense *K, const ritz_dense *M,
                        int64_t *num_rigid, int64_t *count, double **out);

/**
 * Number of modes with negative eigenvalue at a configuration of a system whose
 * bodies are joined by interface forces. They are spurious, since no body has
 * any. 0 for other models.
 *
 * @param[out] first_hz  |f| of the one nearest to 0; NULL: not wanted
 */
int64_t model_negative_squares(const ritz_configuration *at, double *first_hz);

/** Refuse a model with such modes: it has no steady response. */
ritz_status model_refuse_forces(const model *m, const char *path);

/** Frequencies of a configuration, Hz, rigid modes as 0; caller frees. */
ritz_status model_hertz_at(const ritz_configuration *at, double **out);

/**
 * A list of measures with verdicts, and a table of them if there are any.
 *
 * @param[in] text   SINK_NONE: the list alone
 * @param[in] known  the word for those without a limit: "measured", "estimated"
 */
void model_say_measures(cli_run *run, sink_text text, const char *key,
                        const ritz_measures *measures, const char *known);

/** Add a measure, or all of them, and causes of bounds to the line of
 * --record. */
void model_record_measure(cli_run *run, const ritz_measure *measure);
void model_record(cli_run *run, const ritz_measures *measures);

/** Steps and time of a simulator, as the object `cost`. */
void model_set_cost(cli_run *run, const ritz_cost *cost);

enum { MODEL_PATH = 4096 };

/** Check, before long work, that model_write_bodies can create its files. */
ritz_status model_foresee_bodies(const char *prefix, const ritz_scene *scene);

/** Write the reduced components of a scene as PREFIXname.h5; NULL: write
 * none. */
ritz_status model_write_bodies(cli_run *run, const char *prefix,
                               const ritz_scene *scene,
                               const ritz_reduced *body);

void model_free(model *model);

#endif
