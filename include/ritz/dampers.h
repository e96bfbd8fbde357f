/*
 * Discrete dampers (and springs) kept apart from D and K, so that they can be
 * retuned after reduction: damper j adds c_j b_j b_j' to D and k_j b_j b_j' to
 * K, b_j being its influence vector, +1 and -1 at the dofs it lies between.
 *
 * D and K of a component and of its reduction hold nothing of them, and bases
 * are made without them; who answers for the model (a response, poles, errors,
 * assembly, export) installs them first. What D and K hold already is kept
 * beside c and k, so that installing twice adds nothing, and installing after a
 * change of c or k adds the difference.
 */
#ifndef RITZ_DAMPERS_H
#define RITZ_DAMPERS_H

#include <ritz/dense.h>
#include <ritz/sparse.h>
#include <ritz/text.h>

#pragma GCC visibility push(default)

typedef struct ritz_dampers {
    int64_t count;
    char (*name)[RITZ_NAME_SIZE]; /* distinct; "body/name" in a system */
    double *c, *k;                /* either sign of k, c >= 0 */
    double *held_c, *held_k;      /* what D and K hold of them already */
    ritz_dense B;                 /* n x count */
} ritz_dampers;

/** @p count dampers without name, c and k, for @p n coordinates. */
ritz_status ritz_dampers_new(int64_t n, int64_t count, ritz_dampers *out);

/** What the subspace x = T q sees of them: T'B; names, c and k kept. */
ritz_status ritz_dampers_project(const ritz_dampers *dampers,
                                 const ritz_dense *T, ritz_dampers *out);

ritz_status ritz_dampers_copy(const ritz_dampers *dampers, ritz_dampers *out);

/**
 * Append @p more, whose coordinates are rows first, first + 1, ... of the @p n
 * that all have; with @p owner each is called "owner/name".
 *
 * @return RITZ_ERR_ARGUMENT if a name becomes too long
 */
ritz_status ritz_dampers_append(const ritz_dampers *more, const char *owner,
                                int64_t n, int64_t first,
                                ritz_dampers *dampers);

/**
 * Whether dampers make sense for a model of @p n coordinates: names there and
 * distinct, values finite, c not negative.
 *
 * @return RITZ_ERR_FORMAT with what is wrong
 */
ritz_status ritz_dampers_check(const ritz_dampers *dampers, int64_t n);

/** Index of a name; -1 and a sentence naming the nearest if there is none. */
int64_t ritz_dampers_find(const ritz_dampers *dampers, const char *name);

/**
 * Take "NAME=C" or "NAME=C*K" as new values; without K it stays.
 *
 * @return RITZ_ERR_ARGUMENT if the name is unknown, or no numbers follow
 */
ritz_status ritz_dampers_tune(ritz_dampers *dampers, const char *text);

/**
 * Install: D += sum (c - held_c) b b' and K likewise. An absent D, {0}, is made
 * if there is anything to add.
 *
 * @return RITZ_ERR_ARGUMENT if the sizes disagree
 */
ritz_status ritz_dampers_install(ritz_dampers *dampers, ritz_dense *K,
                                 ritz_dense *D);

/** The same of sparse matrices; b has few entries. */
ritz_status ritz_dampers_install_sparse(ritz_dampers *dampers, ritz_sparse *K,
                                        ritz_sparse *D);

void ritz_dampers_free(ritz_dampers *dampers);

#pragma GCC visibility pop

#endif
