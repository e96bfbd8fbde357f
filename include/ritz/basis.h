/*
 * A basis: the subspace in which a component is reduced, u = T q or, of states,
 * [u; u'] = T z.
 */
#ifndef RITZ_BASIS_H
#define RITZ_BASIS_H

#include <ritz/damping.h>
#include <ritz/dense.h>
#include <ritz/text.h>

#include <stdbool.h>

#pragma GCC visibility push(default)

/* A method that makes another kind adds it here, and its name in basis.c. */
typedef enum ritz_column_kind {
    RITZ_COLUMN_RIGID,      /* free rigid-body motion */
    RITZ_COLUMN_CONSTRAINT, /* answers unit motion of one attached dof */
    RITZ_COLUMN_NORMAL,     /* eigenvector, interface clamped or free */
    RITZ_COLUMN_RESIDUAL,   /* answers a unit force, less what is kept */
    RITZ_COLUMN_SYSTEM,     /* part of system modes, from the second stage */
    RITZ_COLUMN_KRYLOV, /* of a block Krylov sequence, any expansion point */
    RITZ_COLUMN_STATIC, /* static Ritz vector: answers a load */
    RITZ_COLUMN_ATTACHMENT, /* inertia-relief attachment mode */
    RITZ_COLUMN_INTERFACE,  /* characteristic constraint mode */
    RITZ_COLUMN_MASSLESS,   /* residual flexibility, its mass left out */
    RITZ_COLUMN_FORCE,      /* residual flexibility of a dual interface force */
    RITZ_COLUMN_STATE,      /* of a first-order basis */
    RITZ_COLUMN_PERTURBED,  /* a state that answers statically */
    RITZ_COLUMN_BALANCED,   /* balanced, of second order */
} ritz_column_kind;

/* What each of r columns is. */
typedef struct ritz_columns {
    int64_t count;
    ritz_column_kind *kind;
    int64_t *dof;     /* row of the full component it attaches; -1 where none */
    double *hertz;    /* NaN where none */
    double *residual; /* relative, of the eigenpair; NaN where none */
} ritz_columns;

/* How it was made. */
typedef struct ritz_origin {
    char method[RITZ_NAME_SIZE];
    char options[RITZ_NAME_SIZE];   /* as asked: "modes 12" */
    char reference[RITZ_NAME_SIZE]; /* key in docs/references.bib */
    char engine[RITZ_NAME_SIZE];    /* "dense LAPACK", "CHOLMOD + ARPACK" */
} ritz_origin;

/*
 * T, n x r, and of each of its columns what it is. Of states T has 2n rows, n
 * displacements and then n velocities, or the states of a state space; left
 * vectors W may stand beside: see ritz_reduce_states.
 */
typedef struct ritz_basis {
    ritz_dense T;
    ritz_dense W; /* as T; {0}: T itself */
    bool states;
    int64_t num_hankel; /* values of the model that was balanced; 0: none */
    double *hankel;     /* descending */
    double bound; /* of the H-infinity error, outputs over their limits, where
                     there are Hankel values; NaN: they bound nothing */
    char damping[RITZ_DAMPING_SIZE]; /* of states, or with a W: what they were
                                        made with, as ritz_damping_parse reads */
    double among_hz; /* they are made of modes up to here alone; 0: of all */
    ritz_columns columns;
    ritz_origin origin;
    char remark[4 * RITZ_NAME_SIZE]; /* what a user should know; not stored */
} ritz_basis;

/** @p r columns of kind normal, with neither dof nor hertz nor residual. */
ritz_status ritz_columns_new(int64_t r, ritz_columns *out);
ritz_status ritz_columns_copy(const ritz_columns *columns, ritz_columns *out);

/** Basis of @p r zero columns for @p n dofs. */
ritz_status ritz_basis_new(int64_t n, int64_t r, ritz_basis *out);

/** Name of a kind, as files hold it: "normal". */
const char *ritz_column_name(ritz_column_kind kind);

/** Kind of that name; false if there is none. */
bool ritz_column_find(const char *name, ritz_column_kind *out);

void ritz_columns_free(ritz_columns *columns);
void ritz_basis_free(ritz_basis *basis);

#pragma GCC visibility pop

#endif
