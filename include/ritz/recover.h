/*
 * Recovery: stresses, forces and displacements of the full mesh from the
 * coordinates of a reduced component over time.
 */
#ifndef RITZ_RECOVER_H
#define RITZ_RECOVER_H

#include <ritz/model.h>
#include <ritz/simulate.h>

#include <stdbool.h>
#include <stdio.h>

#pragma GCC visibility push(default)

/* Coordinates at a time; NULL where they are not known. Borrowed. */
typedef struct ritz_instant {
    double seconds;
    const double *q, *v, *a; /* r each: q, q', q'' */
    const double *f;         /* inputs */
} ritz_instant;

/* The rows of a quantity at a time: y = C q + Cv q' + Ca q'' + F f. */
typedef struct ritz_recovery_rule {
    ritz_dense C, Cv, Ca, F; /* {0}: nothing of that kind */
    bool acceleration;       /* by mode acceleration */
} ritz_recovery_rule;

typedef struct ritz_recoverer {
    const ritz_reduced *reduced; /* borrowed */
    int64_t count;               /* of its quantities */
    ritz_recovery_rule *rule;
} ritz_recoverer;

/**
 * Prepare the recovery of all quantities of a reduced component. Stated damping
 * and dampers, with c and k as they are now, act in mode acceleration.
 *
 * @param[in] damping       in addition to that of matrices; NULL: none
 * @param[in] acceleration  by mode acceleration where a quantity has it, else
 *                          by mode displacement
 * @return RITZ_ERR_ARGUMENT if no quantity has it and it is asked for
 * @cost   O(r^3 + rows r^2)
 */
ritz_status ritz_recoverer_new(const ritz_reduced *reduced,
                               const ritz_damping *damping, bool acceleration,
                               ritz_recoverer *out);

/** @return RITZ_ERR_ARGUMENT naming what a rule needs and the instant lacks */
ritz_status ritz_recoverer_check(const ritz_recoverer *recoverer,
                                 const ritz_instant *now);

/** Rows of quantity @p k, of which the instant has all that its rule needs.
 * @param[out] y  as many as it has rows */
void ritz_recoverer_rows(const ritz_recoverer *recoverer, int64_t k,
                         const ritz_instant *now, double *y);

void ritz_recoverer_free(ritz_recoverer *recoverer);

/* The value of the largest size of each row of a quantity, and its time. */
typedef struct ritz_peaks {
    char name[RITZ_NAME_SIZE]; /* as in ritz_quantity, like the next four */
    char kind[RITZ_NAME_SIZE];
    int64_t count;
    int64_t *place;
    char (*part)[RITZ_NAME_SIZE];
    char by[RITZ_NAME_SIZE]; /* "mode displacement", "mode acceleration" */
    double *value;           /* count, with its sign */
    double *seconds;         /* count: when it was first reached */
} ritz_peaks;

typedef struct ritz_recovered {
    int64_t count; /* times that were recovered */
    double begin, end;
    int64_t num_quantities;
    ritz_peaks *quantity;
    char units[RITZ_NAME_SIZE];
} ritz_recovered;

/** Peaks of nothing so far. */
ritz_status ritz_recovered_new(const ritz_recoverer *recoverer,
                               ritz_recovered *out);

/** Note the rows of quantity @p k. @return RITZ_ERR_CONVERGENCE if one is not
 * finite */
ritz_status ritz_recovered_note(int64_t k, double seconds, const double *y,
                                ritz_recovered *recovered);

/** Count a time. */
void ritz_recovered_step(double seconds, ritz_recovered *recovered);

/** "element 12 sx", as ritz_quantity_name(). */
const char *ritz_peaks_name(const ritz_peaks *peaks, int64_t row,
                            char text[RITZ_QUANTITY_NAME_SIZE]);

void ritz_peaks_free(ritz_peaks *peaks);
void ritz_recovered_free(ritz_recovered *recovered);

/*
 * Histories: coordinates of a reduced component over time, one time after the
 * other, from our own containers or from what simulators write.
 */

/* What is wanted of a history. Everything is borrowed. */
typedef struct ritz_history_request {
    int64_t order;       /* coordinates in the file: r, or columns of `V` */
    const ritz_dense *V; /* r x order, q = V x of those in the file; NULL: q */
    int64_t num_inputs;
    const char (*input)[RITZ_NAME_SIZE]; /* their names */
    /* columns, "2-9,14", names or "PREFIX*"; NULL: those of the format */
    const char *q, *v, *a, *f;
    bool unforced; /* no input acts: f = 0 */
    double step;   /* of formats without times, s; 0: not known */
    int64_t label; /* of the body where a file has several; 0: the only one */
} ritz_history_request;

typedef struct ritz_history {
    const struct ritz_history_format *format; /* NULL: a simulation */
    const ritz_simulation *simulation;        /* borrowed */
    int64_t at;                               /* times read */
    void *own;                                /* of the format */
    int64_t order, num_inputs;                /* in the file */
    const ritz_dense *V;
    bool has_v, has_a, has_f, unforced;
    double seconds;
    double *x; /* 3 x order: coordinates of the file, rates, accelerations */
    double *q; /* 3 x r, the same of the component; NULL: x */
    double *f; /* num_inputs */
} ritz_history;

typedef struct ritz_history_format {
    const char *name;      /* "mbdyn" */
    const char *summary;   /* one line */
    const char *reference; /* key in docs/references.bib */
    /** True if a file that begins with these bytes looks like the format. */
    bool (*recognise)(const char *bytes, int64_t size);
    /** Read what precedes the first time; sets has_v, has_a and has_f. */
    ritz_status (*begin)(FILE *file, const ritz_history_request *request,
                         ritz_history *history);
    /** Read a time into seconds, x and f. @param[out] more  false at the end
     * @return RITZ_ERR_FORMAT with the line */
    ritz_status (*next)(ritz_history *history, bool *more);
    void (*end)(void *own);
} ritz_history_format;

/** All formats of histories, ended by NULL. */
extern const ritz_history_format *const ritz_history_formats[];
extern const ritz_history_format ritz_history_format_mbdyn;
extern const ritz_history_format ritz_history_format_table;

/** Open a text; its format is recognised by content.
 * @return RITZ_ERR_FILE, RITZ_ERR_FORMAT, RITZ_ERR_ARGUMENT */
ritz_status ritz_history_open(const char *path,
                              const ritz_history_request *request,
                              ritz_history *out);

/** The coordinates that a simulation has stored, borrowed.
 * @return RITZ_ERR_ARGUMENT if it has none, or not as many */
ritz_status ritz_history_of_simulation(const ritz_simulation *simulation,
                                       const ritz_history_request *request,
                                       ritz_history *out);

/** The next time; times ascend.
 * @param[out] now   borrowed from the history until the next call
 * @param[out] more  false, and no instant, at the end */
ritz_status ritz_history_next(ritz_history *history, ritz_instant *now,
                              bool *more);

void ritz_history_free(ritz_history *history);

#pragma GCC visibility pop

#endif
