/*
 * The common part of the real and the complex factor by sequential MUMPS.
 *
 * MUMPS has a struct for each arithmetic; both have the fields below, so each
 * describes its own by a ritz_mumps of pointers and the rest is written once.
 */
#ifndef RITZ_LINEAR_MUMPS_H
#define RITZ_LINEAR_MUMPS_H

#include <ritz/matrix.h>

#include <mumps_c_types.h>
#include <stdbool.h>

typedef struct ritz_mumps {
    void *id;               /* the struct of MUMPS */
    void (*call)(void *id); /* runs its job */
    void (*set_rhs)(void *id, int n, int k, void *x);
    MUMPS_INT *job, *icntl; /* fields of the struct */
    const MUMPS_INT *infog;
    double *cntl;
    int width; /* doubles per number: 1 real, 2 complex */
} ritz_mumps;

/* A matrix, or its lower triangle, as MUMPS reads it: entry k at row[k],
   col[k], from 1. */
typedef struct ritz_mumps_pattern {
    int64_t n, nnz;
    MUMPS_INT *row, *col;
} ritz_mumps_pattern;

/* MUMPS's names for its jobs. */
enum {
    RITZ_MUMPS_START = -1,
    RITZ_MUMPS_END = -2,
    RITZ_MUMPS_ANALYSE = 1,
    RITZ_MUMPS_FACTOR = 2,
    RITZ_MUMPS_SOLVE = 3,
};

/**
 * Union of the lower triangles of @p count matrices, or of the @p whole of
 * them, column by column, rows in the order they are met. The caller frees
 * @p out.
 *
 * @return RITZ_ERR_ARGUMENT if sizes disagree, or exceed MUMPS's 32 bits
 */
ritz_status ritz_mumps_unite(int64_t count, const ritz_sparse *const *A,
                             bool whole, ritz_mumps_pattern *out);
void ritz_mumps_pattern_free(ritz_mumps_pattern *P);

/** Options of every factor: silent, null pivots found. After START. */
void ritz_mumps_configure(const ritz_mumps *mumps);

/** Run a job, with more room each time MUMPS asks for it. */
ritz_status ritz_mumps_run(const ritz_mumps *mumps, int job);

/** Overwrite @p x, n x k numbers, by the solution. */
ritz_status ritz_mumps_solve(const ritz_mumps *mumps, int64_t n, int64_t k,
                             void *x);

/**
 * Whether the factored matrix A, values @p val on @p P, is singular to working
 * accuracy: |H y| <= c eps |y| for some y, where H = S A S is A scaled so that
 * the largest entry of each row is near one.
 *
 * @return RITZ_ERR_SINGULAR if so
 */
ritz_status ritz_mumps_judge(const ritz_mumps *mumps,
                             const ritz_mumps_pattern *P, const double *val);

#endif
