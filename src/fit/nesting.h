/*
 * Columns of all flexible bodies of a model, and the models that some of them
 * make. Shared by nesting.c, order.c and nest.c.
 */
#ifndef RITZ_FIT_NESTING_H
#define RITZ_FIT_NESTING_H

#include "fit/fitter.h"

typedef struct ritz_nesting {
    ritz_fitter *f;
    ritz_bodies whole;    /* flexible bodies with all their columns */
    ritz_dense parts;     /* of a component: Phi'M T of all columns */
    int64_t *first;       /* num_bodies + 1: its first column of all */
    int64_t count, fixed; /* columns; those that must stay, first */
    int64_t *column;      /* count, what matters most first */
    double *alone;        /* of each column: the ratio without it */
    int64_t *own, *some;  /* to work in: columns of one body, and of all */
    int64_t every;        /* of listed places the first, and each every-th */
    int64_t step;         /* columns between two cuts that are measured */
    int64_t hardest;      /* the place where the last model was worst */
    int only;             /* RITZ_ONLY_LIMITED: only those errors of cuts are
                             measured that have a limit; 0: all errors */
    ritz_pairs modes;     /* of the model of the first columns of the order, as
                             many as are left; {0}: not known */
} ritz_nesting;

void ritz_nesting_free(ritz_nesting *n);

/* --- nesting.c ------------------------------------------------------------ */

/** Columns of body @p k among some, as the body numbers them.
 * @param[out] own  NULL: they are only counted */
int64_t ritz_nesting_own(const ritz_nesting *n, int64_t k, int64_t count,
                         const int64_t *column, int64_t *own);

/** The model of some columns. It has no invariants and no T: shapes of a
 * component are compared by `parts`. */
ritz_status ritz_nesting_join(const ritz_nesting *n, int64_t count,
                              const int64_t *column, ritz_fit_joined *out);

/**
 * Worst error over tolerance of the model of some columns, on the grid of the
 * listed places. It begins where the last model was worst: a ratio of @p most or
 * more is not measured at the other places.
 *
 * @param[out] modes  of a component; NULL: not wanted
 */
ritz_status ritz_nesting_ratio(ritz_nesting *n, int64_t count,
                               const int64_t *column, double most,
                               ritz_pairs *modes, double *out);

/** Threads that measure @p models models of this nesting at once: 1 of a scene,
 * and where responses of the full model take factors. */
int ritz_nesting_threads(const ritz_nesting *n, int64_t models);

/* --- order.c -------------------------------------------------------------- */

/** Put the columns of `whole`, the bodies of a candidate before columns are left
 * out, in order: by the order that was kept, or by a new one that is kept from
 * now on. Fills everything but `whole`. */
ritz_status ritz_nesting_order(ritz_fitter *f, const ritz_fit_candidate *of,
                               ritz_nesting *n);

#endif
