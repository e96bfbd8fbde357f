/* The report of ritz-fit, and the lines that it records. */
#ifndef RITZ_TOOLS_PRINT_FIT_H
#define RITZ_TOOLS_PRINT_FIT_H

#include "cli/model.h"

#include <ritz/fit.h>

/* A run of ritz-fit, for the observer that records candidates. */
typedef struct fit_run {
    cli_run *run;
    const char *subject;
    const ritz_verify_request *limits; /* NULL: not known yet */
    ritz_status recorded;              /* the first failure to append */
} fit_run;

/* What a candidate was found to be. */
typedef struct fit_mark {
    bool chosen, runner_up;
    const char *why; /* NULL: none */
} fit_mark;

/** Append a candidate to the file of --record. */
void fit_record(fit_run *fit, const ritz_fit_candidate *candidate,
                fit_mark mark);

/** The same as an observer; @p context is a fit_run. */
void fit_observe(const ritz_fit_candidate *candidate, void *context);

/** What was searched, and the answer; the same as JSON. */
void fit_say(cli_run *run, const ritz_fitter *fitter, const ritz_fit *fit);

enum { FIT_PATH = 4096 };

/* A file that an answer makes, and whether something was there before. */
typedef struct fit_file {
    char *path;
    bool there;
} fit_file;

typedef struct fit_files {
    int64_t count;
    fit_file *file;
} fit_files;

/** PREFIXname.h5 @return RITZ_ERR_ARGUMENT if that is too long */
ritz_status fit_body_path(const char *prefix, const char *name,
                          char out[FIT_PATH]);

/**
 * Every file that an answer makes: output, report and, of a scene, bodies.
 *
 * @return RITZ_ERR_FILE if one of them cannot be made: known before the search
 */
ritz_status fit_files_foresee(const cli_run *run, const char *prefix,
                              const char *report, const ritz_scene *scene,
                              fit_files *out);
ritz_status fit_files_add(fit_files *files, const char *path);

/** Remove those that were not there before. */
void fit_files_discard(const fit_files *files);

void fit_files_free(fit_files *files);

/**
 * Say what a scene's answer comes to if its bodies are cut, the same as JSON;
 * write its bodies as PREFIXname.h5 if @p prefix is there, and its system to
 * the output if there is one.
 */
ritz_status fit_write_scene(cli_run *run, const char *prefix,
                            const ritz_scene *scene, ritz_fitter *fitter,
                            const ritz_fit_candidate *chosen);

/** Measures by name, as records and JSON hold them. */
json_t *fit_values_json(const ritz_measures *measures);

/** Every method at equal error and at @p equal_order; the same as JSON. */
void fit_say_all(cli_run *run, const ritz_fit *fit, int64_t equal_order,
                 const int64_t *equal);

#endif
