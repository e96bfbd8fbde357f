/*
 * What each tool does once its command line is read: the main fills the
 * options, NULL, 0 or NaN where one was not given, and one function reads,
 * computes, writes and reports. What several tools report follows at the end.
 */
#ifndef RITZ_TOOLS_PRINT_PRINT_H
#define RITZ_TOOLS_PRINT_PRINT_H

#include "base/alloc.h"
#include "cli/model.h"

#include <ritz/assembly.h>
#include <ritz/basis.h>
#include <ritz/export.h>
#include <ritz/fit.h>
#include <ritz/import.h>
#include <ritz/ranking.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- ritz-basis, ritz-reduce ---------------------------------------------- */

typedef struct basis_options {
    const ritz_method *method;
    /* reads the component; NULL: basis_run does so itself */
    ritz_status (*read)(cli_run *run, const char *path, model *out);
    const char *ports;    /* "PORT[,PORT]"; NULL: all */
    cli_list neighbours;  /* "PORT=FILE:PORT" */
    ritz_request request; /* the component is taken from the operand */
    model_options model;  /* configuration or columns of the operand */
} basis_options;

ritz_status basis_run(cli_run *run, basis_options *given);

/**
 * Run ritz-basis: parse its command line and make the basis.
 *
 * @param[in] make  basis_run, or a function that calls it with other options
 * @return the exit status
 */
int basis_main(int argc, char **argv,
               ritz_status (*make)(cli_run *run, basis_options *given));

typedef struct reduce_options {
    bool without_basis;
    model_options model;   /* configuration or columns, and damping */
    const char *estimates; /* "all", "frequency" or "none"; NULL: all */
    const char
        *recovery; /* "displacement" or "acceleration"; NULL: the first */
    const char *recovery_ports; /* of mode acceleration; NULL: all */
    /* "auto" or "slepc"; only shown by --help: libexec_is_asked() reads it
       before options are parsed */
    const char *engine;
    ritz_estimate_request estimate;
    /* functions that read the component and project it on the basis; NULL:
       those of one process */
    ritz_status (*read)(cli_run *run, const char *path, model *out);
    ritz_status (*project)(const ritz_component *component,
                           const ritz_basis *basis, ritz_reduced *out);
} reduce_options;

ritz_status reduce_run(cli_run *run, reduce_options *given);

/**
 * Run ritz-reduce: parse its command line and reduce the component.
 *
 * @param[in] make  reduce_run, or a function that calls it with other options
 * @return the exit status
 */
int reduce_main(int argc, char **argv,
                ritz_status (*make)(cli_run *run, reduce_options *given));

/* --- ritz-check ----------------------------------------------------------- */

/**
 * Audit a component, or check the stability of a small model.
 *
 * @return RITZ_ERR_FORMAT naming the first check that fails
 */
ritz_status checks_run(cli_run *run, const model_options *given,
                       const cli_list *loads);

/** A table, the number of each verdict, and a list. */
void checks_say(cli_run *run, const char *key, const ritz_audit *audit);

/** The first check that fails; NULL if none does. */
const ritz_check *checks_first(const ritz_audit *audit);

/* --- ritz-compare --------------------------------------------------------- */

enum { COMPARISON_MOST_TOLERANCES = 64 };

typedef struct comparison_options {
    const char *prefix, *report, *tracks, *extraneous, *tolerance_table;
    int64_t num_tolerances;
    double tolerance[COMPARISON_MOST_TOLERANCES];
} comparison_options;

/** Reduce in two stages, write, and report orders, errors and frequencies. */
ritz_status comparison_run(cli_run *run, const comparison_options *given);

/** Worst errors by several composite tolerances. */
typedef struct tolerance_rows {
    int64_t count;
    ritz_tolerance_row *at;
} tolerance_rows;

/** "31+19+6", the orders of bodies; with --json as a list. */
void tolerances_orders(cli_run *run, int64_t count, const int64_t *order,
                       char out[80]);
void tolerances_say(cli_run *run, const ritz_stage *first,
                    const tolerance_rows *rows);
/** Write the same as a table. */
ritz_status tolerances_write(const char *path, const ritz_stage *first,
                             const tolerance_rows *rows);
void tolerance_rows_free(tolerance_rows *rows);

/* --- ritz-export ---------------------------------------------------------- */

typedef struct export_options {
    const ritz_exporter *exporter;
    ritz_export_request request;
    model_options model;
    cli_list component; /* the basis' component, or "BODY=FILE" of a system */
    bool force;
    bool states; /* write a reduced component as a state space */
} export_options;

/**
 * Write the operand in the format that is asked for, and say what is known of
 * its errors and its stability.
 *
 * @return RITZ_ERR_ARGUMENT if nothing is known of its errors, or it is not
 *         stable, without `force`
 */
ritz_status export_run(cli_run *run, const export_options *given);

/* --- ritz-fit ------------------------------------------------------------- */

enum { FIT_MOST_METHODS = 64 };

typedef struct fit_options {
    ritz_fit_request request;
    const char *tolerance, *methods, *damping, *prefix, *report;
    const ritz_method *method[FIT_MOST_METHODS]; /* of `methods` */
    int64_t seed;
    cli_list damper;
    bool all;
    int64_t order; /* at which --all compares; 0: that of the result */
} fit_options;

/** Search, report, record every candidate, and write the smallest model. */
ritz_status fit_search(cli_run *run, fit_options *given);

/* --- ritz-frf ------------------------------------------------------------- */

typedef struct loop_options {
    const char *controller, *feedback, *states;
    cli_list connect;
    bool force;
} loop_options;

/** Join a controller to a plant, as options say, and print what is joined. */
ritz_status loop_join(cli_run *run, const loop_options *given,
                      const ritz_io *plant, const ritz_io *controller,
                      ritz_loop *out);

/** Print whether a loop is stable, and the pole that decides it. */
void loop_say_stability(cli_run *run, const ritz_probe *probe);

typedef struct response_options {
    double from_hz, to_hz, up_to_hz;
    double tolerance; /* between points; 0: a grid is enough */
    int64_t points;
    const char *method;    /* "auto", or a name of the table */
    const char *points_of; /* another response */
    bool log, no_refine, singular, over_limits, zeros;
    cli_list input_size;
    model_options model;
    loop_options loops;
} response_options;

/** Print the table of methods. */
void responses_list(void);

/** Compute the response, and report what other options ask for. */
ritz_status responses_run(cli_run *run, const response_options *given);

/* --- ritz-import ---------------------------------------------------------- */

/* Lists of the command line are taken into the request. */
typedef struct import_options {
    cli_list load, preload, port, rigid, averaged, input, output, damper;
    const char *superelement; /* file from which matrices are requested */
    cli_list recovery, recovery_rows;
    ritz_import_request request;
    ritz_import_space_request space;
} import_options;

/** Matrices and geometry become a component, or matrices a state space. */
ritz_status import_run(cli_run *run, import_options *given);

/* --- ritz-poles ----------------------------------------------------------- */

typedef struct poles_options {
    int64_t modes, mode;      /* number, 0: all; mode that a scan follows */
    double up_to_hz, near_hz; /* near_hz NaN: not given */
    cli_list scan;            /* "NAME[,NAME]=FROM:TO:STEP[*FROM:TO:STEP]" */
    cli_list tune;            /* "NAME[,NAME]=FROM:TO[*FROM:TO]" */
    int64_t places, among;
    const char *low_pass; /* "HZ[:ORDER]" */
    model_options model;
    bool norm, tsv;
} poles_options;

/** Print the poles of a model, or the results for its dampers. */
ritz_status poles_report(cli_run *run, const poles_options *given);

/** Follow one pole through ranges of c and k, to the largest damping ratio. */
ritz_status dampers_scan(cli_run *run, model *m, const poles_options *given);

/** Print the H2 norm. */
ritz_status dampers_norm(cli_run *run, model *m, const poles_options *given);

/** Find the c and k of the smallest H2 norm, and with --place the best
 * placement. */
ritz_status dampers_tune(cli_run *run, model *m, const poles_options *given);

/* --- ritz-rank ------------------------------------------------------------ */

/* Rankings of one kind at all configurations, and each mode's largest value. */
typedef struct ranked {
    ritz_rankings all;
    ritz_ranking largest;   /* of several configurations; else empty */
    int64_t *where, *track; /* of the modes of the largest */
} ranked;

/** One ranking that stands for all: the largest, or the only one. */
const ritz_ranking *ranked_whole(const ranked *group);
int64_t *ranked_track(const ranked *group);

/** Numbers of the modes of the k-th ranking; NULL: their index. */
int64_t *ranked_numbers(const ritz_rankings *all, int64_t k);

void ranked_free(ranked *group);

/**
 * Best first: mode, frequency, damping, cluster, value, share, parts, exact
 * values and what a Hankel value differs by; at most @p most lines. Of a
 * ranking without modes its exact values, each with the bound of cutting there.
 *
 * @param[in] track  numbers of modes; NULL: their index
 */
void rankings_say(const cli_run *run, const ritz_ranking *ranking,
                  const int64_t *track, int64_t most);

/** The largest over configurations, where it stands, and places at each. */
void rankings_say_largest(const cli_run *run, const ranked *group);

/** by, at, damping, order, values and all else, in the object that is open, or
 * as an item of the list that is. */
void rankings_set(cli_run *run, const ritz_ranking *ranking,
                  const int64_t *track);

/** Say and report that modes couple, of all of a group the worst. */
void rankings_warn(cli_run *run, const ranked *group);

/** Damping of a ranking: "modal 0.002", "of the matrices" or "none". */
const char *rankings_damping(const ritz_ranking *ranking);

void rankings_say_weights(cli_run *run, const ritz_rank_request *request,
                          const ritz_reweighing *found, int64_t keep);

/* Several rankings of one set of modes, with names of what they differ by. */
typedef struct contest {
    int64_t count;
    const ritz_ranking **ranking;
    int64_t **track;
    char (*name)[2 * RITZ_NAME_SIZE];
    bool chain; /* each is compared with the one before, not with the first */
} contest;

/* A group for each ranking and each damping, or for each file. */
typedef struct rank_result {
    int64_t count;
    ranked *group;
    char (*file)[RITZ_NAME_SIZE]; /* of groups that were read; else NULL */
} rank_result;

void rank_result_free(rank_result *result);

/**
 * Rankings to be compared: of several groups the whole of each, of a single one
 * its configurations in a row; with @p all every ranking there is.
 */
ritz_status contest_new(const rank_result *result, bool all, contest *out);
void contest_free(contest *all);

/** Compare them: places, correlations, overlaps, what comes and goes. */
ritz_status rankings_compare(cli_run *run, const contest *all, int64_t top);

/** All rankings as one table with tabs. */
ritz_status rankings_write_table(const char *path, const contest *all);

enum { RANK_MOST = 16 };

/* Options of ritz-rank; NULL: not given. */
typedef struct rank_options {
    int64_t num_rankers;
    const ritz_ranker *ranker[RANK_MOST];
    cli_list damping;
    const char *by, *engine, *among; /* words */
    const char *at, *input_weights, *output_weights, *tracks, *table, *chart;
    double band_hz[2]; /* [0, 0]: the model's */
    int64_t keep, top; /* keep 0: weights stay */
    int64_t order;     /* columns of a nested component; 0: all */
    bool compare;
    ritz_status (*draw)(const char *path, const char *title, const contest *all,
                        int64_t most); /* for `chart` */
    ritz_choice choice;                /* of a component's Gramians */
} rank_options;

/** Rank what the operand holds, or read rankings of --compare, and report. */
ritz_status rank_run(cli_run *run, rank_options *given);

/* --- ritz-recover --------------------------------------------------------- */

typedef struct recover_options {
    const char *component, *system, *body;
    const char *modes, *to; /* words of the command line; modes NULL: either */
    const char *maxima, *table;
    const char *transform;
    const char *frame,
        *reference;            /* of --transform floating; NULL: the usual */
    const char *q, *v, *a, *f; /* columns of a table */
    double step;               /* of a file .mod; 0: not given */
    int64_t every, label;
    model_options model;
} recover_options;

/** Recover all times of a history, write them and their maxima. */
ritz_status recover_run(cli_run *run, const recover_options *given);

/* --- ritz-simulate -------------------------------------------------------- */

typedef struct simulation_options {
    const char *method, *hold; /* words of the command line */
    const ritz_integrator *integrator;
    const char *initial;     /* "mode:K*A" or a file; NULL: at rest */
    const char *checkpoint;  /* NULL: none */
    const char *constraints; /* "METHOD:NAME=VALUE,..."; NULL: eliminated */
    int64_t start_digits;    /* of initial values of bodies; 0: all */
    double seconds, step, accuracy, rho, up_to_hz;
    double band_hz[2]; /* 0, 0: not given */
    int64_t every;
    cli_list input; /* "NAME=SIGNAL" */
    bool hold_zero, cost, coordinates, any_step;
    const char *switched;                /* "LIBRARY,LIBRARY"; NULL: none */
    const char *inner, *jump, *share_of; /* words */
    double switch_interval, indicator, hysteresis, dwell;
    bool redundant, look_ahead;
    loop_options loops;   /* of --controller */
    const char *way;      /* how it is propagated, "split" or "exact" */
    double sample, delay; /* of a sampled controller, s; 0: not sampled */
    bool discrete;
    cli_list sweeps;   /* as given: one at most */
    const char *sweep; /* "JOINT=PATH"; NULL: no joint moves */
    const char *sweep_basis, *sweep_against; /* rows of simulation_swept.c */
    int64_t sweep_modes;                     /* 0: not given */
    char sweep_at[2 * RITZ_NAME_SIZE];       /* model.at at its start */
    model_options model;
} simulation_options;

/** Compute the response, if there is an output, and costs, if asked for. */
ritz_status simulation_run(cli_run *run, simulation_options *given);

/** Remove the checkpoint of a run whose output is in place, and
 * OUTPUT.interrupted if the same command wrote it. */
void simulation_remove_leftovers(const cli_run *run,
                                 const simulation_options *given);

/* --- ritz-verify ---------------------------------------------------------- */

typedef struct verify_options {
    ritz_verify_request verify;
    model_options model; /* the reduced one; dampers are of both */
} verify_options;

/**
 * Measure all errors and write the reduced model with them.
 *
 * @return RITZ_ERR_CONVERGENCE naming the first limit that is not met
 */
ritz_status verify_run(cli_run *run, verify_options *given);

/* --- ritz-info, and the tools that write what it describes ---------------- */

/* describe_component(run, &component), ...: each says it in lines, whose values
   go to the object that is open. */
#define DESCRIBE_ONE(KIND, type, member, name, noun)                           \
    ritz_status describe_##member(cli_run *run, const ritz_##type *object);
MODEL_EACH_KIND(DESCRIBE_ONE)
#undef DESCRIBE_ONE

/** Remarks on the bases of a scene's components, such as dampers without static
 * vectors: a line each, "notes" in JSON. */
void describe_remarks(cli_run *run, const ritz_scene *scene,
                      const ritz_reduced *body);

/** Write an object of any kind as the output, and describe it. */
ritz_status describe_output(cli_run *run, const model *m);

/**
 * A container, a matrix file or a deck, and how it was made.
 *
 * @param[in] members    list what a container holds, too
 * @param[in] directory  names and sizes of matrices alone: no values are read
 */
ritz_status describe_file(cli_run *run, const char *path, bool members,
                          bool directory);

/** The list `error_bounds` of modes that were found approximately; without any
 * there is no list. */
void sink_error_bounds(cli_run *run, const ritz_columns *columns);

/** Text form of a damping, and of a fit its coefficients and residual. */
void describe_damping(cli_run *run, const char *text);
void describe_dampers(cli_run *run, const ritz_dampers *dampers);

/**
 * SHA-256 of a matrix, whatever file it lies in, as a line and among the
 * checksums: of the text that joins the sums of its parts,
 *
 *     sparse  "NROW NCOL COLPTR ROWIND VAL"    dense  "NROW NCOL VAL"
 *
 * NROW and NCOL in decimal, the others SHA-256 in hexadecimal of the array's
 * little-endian bytes (i64, i64, f64).
 *
 * @param[out] out  "" with --quiet and without --json: nothing is computed then
 */
ritz_status checksum_sparse(cli_run *run, const char *name,
                            const ritz_sparse *A, char out[RITZ_DIGEST_SIZE]);

/**
 * Follow the modes of a system, say what happened to them up to the end of the
 * scene's band, set keys of the report, and write all of it to @p path, if
 * there is one, as a table with tabs. A single configuration has nothing to
 * say.
 */
ritz_status tracks_report(cli_run *run, const ritz_stage *stage,
                          const ritz_system *system, const char *path);

/**
 * What a scene that spins leaves out, and the rates that limit it; nothing of
 * another scene.
 *
 * @param[in] at  a system of the stage
 */
ritz_status spin_say(cli_run *run, const ritz_stage *stage,
                     const ritz_configuration *at);

/**
 * Warn of bodies whose inertia invariants are approximate.
 *
 * @param[in] turns  bodies that use them; NULL: all
 * @param[in] terms  what they are used for: "spin"
 */
ritz_status spin_warn_of_loss(cli_run *run, const ritz_stage *stage,
                              const bool *turns, const char *terms);

/** "deg" for a joint that turns, else the length among units such as "kg m
 * s". */
void settings_unit(const ritz_sweep *sweep, const char *units,
                   char out[RITZ_NAME_SIZE]);

/**
 * The joints of a scene that can be set, with their units.
 *
 * @param[in] setting  what they are set to; NULL: several configurations
 */
void settings_say(cli_run *run, const ritz_scene *scene, const char *units,
                  const double *setting);

/**
 * Warn of axes in loops that the scene gives with too few digits.
 *
 * @param[in] setting  @p count configurations, row by row
 */
ritz_status axes_say(cli_run *run, const ritz_stage *stage, int64_t count,
                     const double *setting);

/** The same of a scene whose bodies are not reduced. */
ritz_status axes_say_full(cli_run *run, const ritz_scene *scene,
                          const double *setting);

#endif
