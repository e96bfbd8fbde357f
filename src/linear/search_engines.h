/*
 * The state of a search for the lowest modes of a sparse pencil, the factor of
 * K - sigma M that it has, and the engines that find pairs with this factor.
 * For eigen_sparse.c alone.
 */
#ifndef RITZ_LINEAR_SEARCH_ENGINES_H
#define RITZ_LINEAR_SEARCH_ENGINES_H

#include "linear/eigen_sparse.h"
#include "linear/enclosure.h"
#include "linear/general.h"

enum {
    RITZ_SEARCH_BEHIND =
        2, /* modes requested above those wanted: a gap to count
                               in */
};

typedef struct ritz_search_engine ritz_search_engine;

typedef struct ritz_mode_search {
    const ritz_span *span;
    double limit;   /* of lambda by frequency, a little above */
    int limits;     /* how many of RITZ_COUNT_ABOVE were tried */
    int64_t target; /* modes below limit */
    ritz_shifted S;
    ritz_sparse *own[2]; /* K and M, if they may be folded; NULL: not */
    int64_t *order;      /* fill-reducing order of the factor, for the count */
    double typical;      /* median of K_jj / M_jj, 1 if there is none */
    int64_t *heavy;      /* columns of M that are not zero */
    int64_t num_heavy;
    double broken; /* -sigma at which the factor broke down */
    int64_t ask;
    int64_t misses;     /* how often the count found more */
    bool all;           /* found holds every finite mode */
    const char *reason; /* why this engine was chosen; NULL: it was named */
    const ritz_search_engine *engine, *chosen; /* now, and for that reason */
    const ritz_trial *size;
    const ritz_factor_use *use; /* of the factor before the count, or NULL */
    ritz_pairs found;
    ritz_moments moments; /* of what found.Phi was before its last iteration;
                             empty unless the engine is approximate */
    double counted_at;    /* modes were counted below this, or are to be */
    double error;         /* bound of relative errors of eigenvalues */
    double accuracy;      /* its limit */
    double settled;       /* residual at which pairs of block Lanczos have
                             converged for that accuracy */
} ritz_mode_search;

/* A method to find the s->ask lowest pairs with the factor s->S.A. */
struct ritz_search_engine {
    const char *name;
    bool approximate; /* eigenvalues to s->accuracy only */
    bool bounded;     /* it sets s->moments; if it is approximate and does not,
                         inverse iterations set them */
    /** *lambda stays NULL if the method gives vectors alone. If *end is SLOW,
     * *reach is set as by ritz_lanczos_lowest(). */
    ritz_status (*find)(ritz_mode_search *s, ritz_dense *X, double **lambda,
                        double *reach, ritz_lanczos_end *end);
    /** Bytes that it needs beside the factor at least; NULL: not known. */
    int64_t (*needs)(const ritz_shifted *S, int64_t ask, bool folded);
};

void ritz_mode_search_free(ritz_mode_search *s);

/** Shift and factor; the shift moves further away while the factor breaks
 * down. @return RITZ_ERR_SINGULAR if it does at every shift */
ritz_status ritz_search_shift(ritz_mode_search *s, double sigma);

/** Block Lanczos with one shift to rounding: `find` of most engines. */
ritz_status ritz_find_by_blocks(ritz_mode_search *s, ritz_dense *X,
                                double **lambda, double *reach,
                                ritz_lanczos_end *end);

/* The engine that takes over where another one fails. */
extern const ritz_search_engine ritz_search_reliable;

/** The engine of a span, block Lanczos for auto: with an accuracy it ends
 * earlier. A test may set another engine for auto, but not where an accuracy is
 * requested. */
const ritz_search_engine *ritz_search_engine_of(const ritz_span *span);

/** Choose the engine of a span with auto, unless a test has set it, once s->ask
 * modes are to be found with the factor s->S.A: see engine_choice.h. */
void ritz_search_choose(ritz_mode_search *s);

/** Choose how to search again after an approximate engine whose errors are too
 * large, or that missed a mode. */
void ritz_search_better(ritz_mode_search *s);

#endif
