/*
 * Recovery of stresses, forces and displacements on the full mesh from a
 * history of the coordinates of a reduced component.
 */
#ifndef RITZ_RECOVER_H
#define RITZ_RECOVER_H

#include <ritz/model.h>
#include <ritz/simulate.h>

#include <stdbool.h>
#include <stdio.h>

#pragma GCC visibility push(default)

/* The state of a reduced component at one time. Arrays are borrowed, and NULL
   if they are not known. */
typedef struct ritz_instant {
    double seconds;
    const double *q, *v, *a; /* r each: q, q', q'' */
    const double *f;         /* inputs */
} ritz_instant;

/* How a quantity is recovered: y = C q + Cv q' + Ca q'' + F f. */
typedef struct ritz_recovery_rule {
    ritz_dense C, Cv, Ca, F; /* {0}: zero */
    bool acceleration;       /* it is mode acceleration */
} ritz_recovery_rule;

typedef struct ritz_recoverer {
    const ritz_reduced *reduced; /* borrowed */
    int64_t count;               /* quantities */
    ritz_recovery_rule *rule;
} ritz_recoverer;

/**
 * Prepare the recovery of all quantities of a reduced component. Mode
 * acceleration includes the forces of stated damping, and those of dampers with
 * their present c and k.
 *
 * @param[in] damping       in addition to that of matrices; NULL: none
 * @param[in] acceleration true: by mode acceleration if a quantity has it, else
 *                          by mode displacement; false: by mode displacement
 * @return RITZ_ERR_ARGUMENT if @p acceleration is true and no quantity has it
 * @cost   O(r^3 + rows r^2)
 */
ritz_status ritz_recoverer_new(const ritz_reduced *reduced,
                               const ritz_damping *damping, bool acceleration,
                               ritz_recoverer *out);

/** Check that an instant has all that the rules need.
 * @return RITZ_ERR_ARGUMENT, with the name of what is missing */
ritz_status ritz_recoverer_check(const ritz_recoverer *recoverer,
                                 const ritz_instant *now);

/** Recover the rows of quantity @p k from an instant that
 * ritz_recoverer_check() accepts. @param[out] y a value for each row */
void ritz_recoverer_rows(const ritz_recoverer *recoverer, int64_t k,
                         const ritz_instant *now, double *y);

void ritz_recoverer_free(ritz_recoverer *recoverer);

/* The value of the largest magnitude over time of each row of a quantity. */
typedef struct ritz_peaks {
    char name[RITZ_NAME_SIZE]; /* as in ritz_quantity, like the next four */
    char kind[RITZ_NAME_SIZE];
    int64_t count;
    int64_t *place;
    char (*part)[RITZ_NAME_SIZE];
    char by[RITZ_NAME_SIZE]; /* method: "mode displacement" or "mode
                                acceleration" */
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

/** Begin with peaks of no times. */
ritz_status ritz_recovered_new(const ritz_recoverer *recoverer,
                               ritz_recovered *out);

/** Raise the peaks of quantity @p k to its rows @p y at a time.
 * @return RITZ_ERR_CONVERGENCE if a row is not finite */
ritz_status ritz_recovered_note(int64_t k, double seconds, const double *y,
                                ritz_recovered *recovered);

/** Count a time, once all quantities were noted. */
void ritz_recovered_step(double seconds, ritz_recovered *recovered);

/** "element 12 sx", as ritz_quantity_name(). */
const char *ritz_peaks_name(const ritz_peaks *peaks, int64_t row,
                            char text[RITZ_QUANTITY_NAME_SIZE]);

void ritz_peaks_free(ritz_peaks *peaks);
void ritz_recovered_free(ritz_recovered *recovered);

/*
 * Histories: the coordinates of a reduced component over time, read one time
 * after the other from containers of Ritz or from files of simulators.
 */

/* How to read a history. Everything is borrowed. */
typedef struct ritz_history_request {
    int64_t order;       /* number of coordinates x in the file */
    const ritz_dense *V; /* r x order, q = V x; NULL: the file has q itself */
    int64_t num_inputs;
    const char (*input)[RITZ_NAME_SIZE]; /* their names */
    /* columns of a table with q, q', q'' and inputs: "2-9,14", names or
       "PREFIX*"; NULL: the usual ones of the format */
    const char *q, *v, *a, *f;
    bool unforced; /* no input acts: f = 0 */
    bool floating; /* coordinates of a frame may come before those of `order` */
    double step;   /* of formats without times, s; 0: not known */
    int64_t label; /* of the body, in a file with several; 0: the first one */
    const char *body; /* name of the body, if a simulation has coordinates of
                         several; NULL: it has those of a single model */
} ritz_history_request;

typedef struct ritz_history {
    const struct ritz_history_format *format; /* NULL: `simulation` is read */
    const ritz_simulation *simulation;        /* borrowed */
    int64_t at;                               /* times that were read */
    void *own;                                /* data of the format */
    int64_t first;                            /* of the body's coordinates */
    int64_t order, num_inputs;                /* of the file */
    const ritz_dense *V;
    bool has_v, has_a, has_f, unforced;
    double seconds;
    double *x; /* 3 order: x, x', x'' of the file */
    double *q; /* 3 r: q, q', q'' of the component; NULL: they are x */
    double *f; /* num_inputs */
} ritz_history;

typedef struct ritz_history_format {
    const char *name;      /* "mbdyn" */
    const char *summary;   /* one line */
    const char *reference; /* key in docs/references.bib */
    /** True if a file that begins with these bytes looks like the format. */
    bool (*recognise)(const char *bytes, int64_t size);
    /** Read up to the first time, and set has_v, has_a and has_f. Takes
     * ownership of @p file, after a failure too. */
    ritz_status (*begin)(FILE *file, const ritz_history_request *request,
                         ritz_history *history);
    /** Read the next time into seconds, x and f.
     * @param[out] more  false at the end
     * @return RITZ_ERR_FORMAT, with the line's number in the sentence */
    ritz_status (*next)(ritz_history *history, bool *more);
    void (*end)(void *own);
} ritz_history_format;

/** All formats of histories, the last entry is NULL. */
extern const ritz_history_format *const ritz_history_formats[];
extern const ritz_history_format ritz_history_format_mbdyn;
extern const ritz_history_format ritz_history_format_table;

/** Open a text file, whose format is recognised by its content.
 * @return RITZ_ERR_FILE, RITZ_ERR_FORMAT, RITZ_ERR_ARGUMENT */
ritz_status ritz_history_open(const char *path,
                              const ritz_history_request *request,
                              ritz_history *out);

/** Read the coordinates that a simulation has stored; if it has those of
 * several bodies, those of request->body. The simulation is borrowed.
 * @return RITZ_ERR_ARGUMENT if it has none, or not request->order, or no such
 *         body */
ritz_status ritz_history_of_simulation(const ritz_simulation *simulation,
                                       const ritz_history_request *request,
                                       ritz_history *out);

/** Read the next time. Times do not descend.
 * @param[out] now   borrowed from the history until the next call; unchanged at
 *                   the end
 * @param[out] more  false at the end */
ritz_status ritz_history_next(ritz_history *history, ritz_instant *now,
                              bool *more);

void ritz_history_free(ritz_history *history);

#pragma GCC visibility pop

#endif
