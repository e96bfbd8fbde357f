/*
 * Linear equations between dofs, as constraint elements state them, and their
 * elimination: with the dependent dofs u_m and all others u_n
 *
 *     u_m = R_mm u_m + R_mn u_n,    u = G u_n,   G_m = (I - R_mm)^-1 R_mn
 */
#ifndef RITZ_EQUATIONS_H
#define RITZ_EQUATIONS_H

#include <ritz/dofs.h>
#include <ritz/sparse.h>
#include <ritz/text.h>

#include <stdbool.h>

#pragma GCC visibility push(default)

/* What states equations: a card of a deck, or a port. */
typedef struct ritz_equation_source {
    char name[RITZ_NAME_SIZE]; /* "RBE2 600" */
    int64_t file;              /* index in `file`, -1: none */
    int64_t line;
} ritz_equation_source;

/* Equation e: u(dependent[e]) = sum share[k] u(dof[k]), k from first[e] to
 * first[e + 1] - 1. A dof may occur more than once, its shares add up. */
typedef struct ritz_equations {
    int64_t count;
    ritz_dof *dependent; /* count */
    int64_t *first;      /* count + 1; NULL if count is 0 */
    ritz_dof *dof;
    double *share;
    int64_t *source; /* count, index of what states it */
    int64_t num_sources;
    ritz_equation_source *from;
    int64_t num_files;
    char **file;   /* paths that sources are in */
    char *refused; /* why there are no more of them; NULL: these are all */
    int64_t room[6];
} ritz_equations;

/** Room for what ritz_equations_cite writes. */
enum { RITZ_CITATION_SIZE = 200 };

/** "RBE2 600 ('deck.bdf', line 12)"; returns @p text. */
const char *ritz_equations_cite(const ritz_equations *equations, int64_t source,
                                char text[static RITZ_CITATION_SIZE]);

/** The equation that eliminates @p dof, -1 if none does. @cost O(count) */
int64_t ritz_equations_find(const ritz_equations *equations, ritz_dof dof);

void ritz_equations_free(ritz_equations *equations);

/* All dofs in terms of those that stay. */
typedef struct ritz_elimination {
    ritz_dofs kept; /* n of all, ascending */
    ritz_dofs gone; /* the others, ascending */
    ritz_sparse G;  /* all x n; row kept.at[j] is that of the identity */
} ritz_elimination;

/**
 * Solve the equations for their dependent dofs. Dependents may depend on each
 * other, in chains or in circles.
 *
 * @param[in] dof    count distinct names; every dof of the equations is there
 * @param[in] fixed  count, u = 0 there: none of these may be dependent; NULL
 * @return RITZ_ERR_FORMAT if a dof is dependent twice, dependent and fixed, or
 *         not there; RITZ_ERR_SINGULAR if a circle leaves its dofs undetermined
 * @cost   O(count + entries of G), and the cube of the longest circle
 */
ritz_status ritz_elimination_new(const ritz_equations *equations, int64_t count,
                                 const ritz_dof *dof, const bool *fixed,
                                 ritz_elimination *out);

void ritz_elimination_free(ritz_elimination *elimination);

/*
 * Dofs that are not among the coordinates of a model, but follow from them:
 * u(dof[k]) = G(k,:) u.
 */
typedef struct ritz_recovery {
    int64_t count;
    ritz_dof *dof;
    ritz_sparse G; /* count x n; {0} if count is 0 */
} ritz_recovery;

/** Whether these can be recovered from @p n dofs. @return RITZ_ERR_FORMAT */
ritz_status ritz_recovery_check(const ritz_recovery *recovery, int64_t n,
                                const ritz_dof *dof);

ritz_status ritz_recovery_copy(const ritz_recovery *recovery,
                               ritz_recovery *out);

/**
 * The dofs of a model and behind them those recovered, and how all of them
 * move: [T; G T].
 *
 * @param[in]  T      n x r; NULL if @p shape is
 * @param[out] names  n + count
 * @param[out] shape  (n + count) x r; NULL: not wanted
 */
ritz_status ritz_recovery_extend(const ritz_recovery *recovery, int64_t n,
                                 const ritz_dof *dof, const ritz_dense *T,
                                 ritz_dof **names, ritz_dense *shape);

void ritz_recovery_free(ritz_recovery *recovery);

#pragma GCC visibility pop

#endif
