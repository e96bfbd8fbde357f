/*
 * Run records: the lines of --record, as charts need them. A line of
 * ritz-verify has the errors of a file; what that file cost is in the lines of
 * ritz-basis and ritz-reduce that made it, and is found by the files' names.
 */
#ifndef RITZ_TOOLS_CLI_RECORDS_H
#define RITZ_TOOLS_CLI_RECORDS_H

#include <ritz/base.h>

#include <jansson.h>

#include <stdbool.h>
#include <stdint.h>

/* One line. Texts and values are borrowed from its JSON. */
typedef struct record {
    json_t *json;
    const char *tool, *method, *subject; /* "" where there is none */
    int64_t order;                       /* -1: none */
    json_t *errors, *tolerance;          /* NULL: none */
    double cpu;  /* s, to make basis and reduction; NaN: not known */
    double cost; /* s of processor time for one second simulated; NaN */
    bool feasible, chosen, runner_up;
    bool incomplete; /* modes of the band are missing: errors are of the rest */
} record;

typedef struct records {
    int64_t count, room;
    record *item;
} records;

/**
 * Read lines behind those that are there. Empty lines are passed over.
 *
 * @return RITZ_ERR_FORMAT naming the line that is no record
 */
ritz_status records_read(const char *path, records *all);

/** Whether a file can be one of records: its first letter is a '{'. */
bool records_is(const char *path);

/**
 * Give each line of ritz-verify the times of the lines that made the model it
 * measured: the processor time to make it, and the cost of simulating it.
 */
void records_join(records *all);

/* An error measure as it is drawn, less being better. */
typedef struct measure {
    char name[RITZ_NAME_SIZE];
    char title[RITZ_NAME_SIZE];
    double tolerance; /* NaN: none */
} measure;

/** A value of errors, estimates or the like; NaN if there is none. */
double record_value(const json_t *values, const char *name);

/** An error as it is drawn: of MAC, what it lacks of one. */
double record_error(const record *r, const char *name);

/** Title of a measure in charts; its name if charts do not draw it. */
const char *record_title(const char *name);

enum { RECORD_SET_MEASURES = 12 };

/* The records that a chart can show: of one subject, with a method, an order
   and errors, each repeated line once. They borrow from `all`. */
typedef struct record_set {
    records all;
    int64_t num_measures; /* with a tolerance first, then by importance */
    measure measure[RECORD_SET_MEASURES];
    int64_t num_methods; /* in order of their names */
    const char **method;
    int64_t *which; /* method of each record */
} record_set;

/**
 * @param[in]  subject  the only one to be taken; NULL: there must be one alone
 * @param[out] out      to be freed, even on failure
 */
ritz_status record_set_new(const records *all, const char *subject,
                           record_set *out);
void record_set_free(record_set *s);

/* Errors below are rounding of the solvers, and as good as none. */
#define RECORDS_ROUNDING 1e-9

/** Whether any error of that measure is more than rounding. */
bool records_matter(const records *all, const measure *m);

/** Whether every record with errors knows what simulating it costs. */
bool records_cost(const records *all);

void records_free(records *all);

#endif
