/*
 * Every error measure between a full and a reduced model, one row each. Options,
 * help, verification, fit, records and charts read this table; a new measure is
 * one name in RITZ_EACH_MEASURE, one row of src/verify/measures.c, its function
 * there, and one line in docs/methods/verify.md.
 */
#ifndef RITZ_MEASURES_H
#define RITZ_MEASURES_H

#include <ritz/reduced.h>

#include <math.h>

#pragma GCC visibility push(default)

/* In the order in which a verified file lists them. */
#define RITZ_EACH_MEASURE(X)                                                   \
    X(FREQUENCY)                                                               \
    X(MAC)                                                                     \
    X(DAMPING)                                                                 \
    X(RIGID_HERTZ)                                                             \
    X(MISSING_RIGID)                                                           \
    X(MISSING)                                                                 \
    X(EXTRA)                                                                   \
    X(INFINITY)                                                                \
    X(INFINITY_RELATIVE)                                                       \
    X(INFINITY_BOUND)                                                          \
    X(H2)                                                                      \
    X(RESPONSE)                                                                \
    X(FLEXIBLE)                                                                \
    X(LEVEL)                                                                   \
    X(GAIN)                                                                    \
    X(SINGULAR)                                                                \
    X(GROWTH)

typedef enum ritz_measure_id {
#define RITZ_MEASURE_ID(name) RITZ_MEASURE_##name,
    RITZ_EACH_MEASURE(RITZ_MEASURE_ID)
#undef RITZ_MEASURE_ID
        RITZ_MEASURES
} ritz_measure_id;

/* What must be there before a measure can be held to a limit. */
enum {
    RITZ_NEEDS_CHANNELS = 1, /* inputs and outputs */
    RITZ_NEEDS_DAMPING = 2,  /* damping that somebody has stated */
    RITZ_NEEDS_BAND = 4,     /* a band, of state spaces too */
    RITZ_NEEDS_LIMIT = 8,    /* costly for second-order models: measured only
                                where a limit is given */
};

struct ritz_sides;      /* two second-order models that are compared */
struct ritz_state_pair; /* two state spaces that are compared */

typedef struct ritz_measure_kind {
    const char *name;  /* in files, records and JSON */
    const char *word;  /* of --tolerance and --limit-; NULL: takes no limit */
    const char *help;  /* of --limit-; NULL if there is no word */
    const char *label; /* on charts; NULL: not drawn unless asked for */
    int importance;    /* charts draw 1 first; 0 if there is no label */
    const char *unit;  /* "": relative, "modes", "Hz" or "dB" */
    bool large_is_good;
    int needs;         /* sum of RITZ_NEEDS_... */
    const char *bound; /* estimate of ritz-reduce that bounds it; NULL */
    const char *other; /* measure that is held to this limit where this one
                              does not exist; NULL: none */
    /* The value, its place and, where it is not the one of the request, the
       limit; the value stays NaN where there is nothing to compare. NULL: does
       not exist for such models. */
    ritz_status (*of_modes)(const struct ritz_sides *sides, ritz_measure *out);
    ritz_status (*of_states)(const struct ritz_state_pair *pair,
                             ritz_measure *out);
} ritz_measure_kind;

/** By ritz_measure_id. */
extern const ritz_measure_kind ritz_measure_table[RITZ_MEASURES];

/** The row called @p name; NULL if there is none. */
const ritz_measure_kind *ritz_measure_kind_find(const char *name);

/** The limit of the measure called @p name; NaN if it has none. */
double ritz_measure_limit(const double limit[RITZ_MEASURES], const char *name);

/** How wrong a value is, 0 being best: 1 - MAC, all others as they are. */
double ritz_measure_error(const char *name, double value);

/**
 * Error over tolerance, 1 or less where the limit is met. Of a limit that
 * allows nothing: 0 where there is no error, else 1 + error.
 */
double ritz_measure_ratio(const char *name, double value, double limit);

/** Whether a value meets a limit. */
bool ritz_measure_meets(const char *name, double value, double limit);

/** Whether a measure meets its limit; a NaN limit is always met. */
bool ritz_measure_holds(const ritz_measure *measure);

/** Whether value @p a is worse than value @p b. */
bool ritz_measure_is_worse(const char *name, double a, double b);

#pragma GCC visibility pop

#endif
