/*
 * A basis: the subspace in which a component is reduced, u = T q or, of states,
 * [u; u'] = T z.
 */
#ifndef RITZ_SUBSPACE_H
#define RITZ_SUBSPACE_H

#include <ritz/parts.h>

#include <stdbool.h>
#include <stdint.h>

#pragma GCC visibility push(default)

/* A method that makes another kind adds it here, and its name in basis.c. */
typedef enum ritz_column_kind {
    RITZ_COLUMN_RIGID,      /* free rigid-body motion */
    RITZ_COLUMN_CONSTRAINT, /* response to unit motion of an attached dof */
    RITZ_COLUMN_NORMAL,     /* eigenvector, interface clamped or free */
    RITZ_COLUMN_RESIDUAL,   /* response to a unit force, less kept modes */
    RITZ_COLUMN_SYSTEM,     /* part of system modes, from the second stage */
    RITZ_COLUMN_KRYLOV, /* of a block Krylov sequence, any expansion point */
    RITZ_COLUMN_STATIC, /* static Ritz vector: response to a load */
    RITZ_COLUMN_ATTACHMENT, /* inertia-relief attachment mode */
    RITZ_COLUMN_INTERFACE,  /* characteristic constraint mode */
    RITZ_COLUMN_MASSLESS,   /* residual flexibility, its mass left out */
    RITZ_COLUMN_FORCE,      /* residual flexibility of a dual interface force */
    RITZ_COLUMN_STATE,      /* of a first-order basis */
    RITZ_COLUMN_PERTURBED,  /* a state that responds statically */
    RITZ_COLUMN_BALANCED,   /* balanced, of second order */
} ritz_column_kind;

/* Kind and origin of each of r columns. */
typedef struct ritz_columns {
    int64_t count;
    ritz_column_kind *kind;
    int64_t *dof;     /* row of the full component it attaches; -1 where none */
    double *hertz;    /* NaN where none */
    double *residual; /* relative, of the eigenpair; NaN where none */
    /* bound of the relative error of the eigenvalue, of engines that find it
       approximately; NaN where none. NULL: none at all */
    double *error;
} ritz_columns;

/* How a basis, or a model in its subspace, was made. */
typedef struct ritz_origin {
    char method[RITZ_NAME_SIZE];
    char options[RITZ_NAME_SIZE];   /* as asked: "modes 12" */
    char reference[RITZ_NAME_SIZE]; /* key in docs/references.bib */
    char engine[RITZ_NAME_SIZE];    /* "dense LAPACK", "CHOLMOD + ARPACK" */
    const char
        *reason; /* why this engine was chosen, one phrase; NULL: there was
                           no choice, or the basis was read from a file */
} ritz_origin;

/*
 * T, n x r, and what each of its columns is. A basis of states has 2n rows, n
 * displacements and then n velocities, or one row for each state of a state
 * space. Left vectors W may be given too: see ritz_reduce_states.
 */
typedef struct ritz_basis {
    ritz_dense T;
    ritz_dense W; /* as T; {0}: T itself */
    bool states;
    int64_t num_hankel; /* 0: the basis does not balance a model */
    double *hankel;     /* Hankel singular values of that model, descending */
    double bound; /* of the H-infinity error, outputs over their limits, where
                     there are Hankel values; NaN: they bound nothing */
    char damping[RITZ_DAMPING_SIZE]; /* of states, or with a W: what they were
                                        made with, by ritz_damping_parse */
    double among_hz; /* highest frequency of the modes of which the states are
                        made; 0: of all modes */
    ritz_columns columns;
    ritz_origin origin;
    char units[RITZ_NAME_SIZE];      /* of the model, "kg m s" */
    char remark[4 * RITZ_NAME_SIZE]; /* what a user should know; not stored */
} ritz_basis;

/** @p r columns of kind normal, with neither dof nor hertz nor residual. */
ritz_status ritz_columns_new(int64_t r, ritz_columns *out);

/** Columns at[0], at[1], ... of @p columns; @p at NULL: the first @p count.
 * What @p out held is freed. */
ritz_status ritz_columns_pick(const ritz_columns *columns, int64_t count,
                              const int64_t *at, ritz_columns *out);

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
