/*
 * All eigenpairs of small pencils, so that LAPACK solves each pencil once. A full
 * model, its parts with a fixed interface and its estimates need the same modes
 * up to different frequencies, at different times.
 */
#ifndef RITZ_LINEAR_SPECTRA_H
#define RITZ_LINEAR_SPECTRA_H

#include <ritz/matrix.h>

#include <stdbool.h>

/* A store of eigenpairs, each with the pencil that they belong to. */
typedef struct ritz_spectra ritz_spectra;

ritz_status ritz_spectra_new(ritz_spectra **out);
void ritz_spectra_free(ritz_spectra **spectra);

/** How many pencils are stored. */
int64_t ritz_spectra_count(const ritz_spectra *spectra);

/* While a value of this type exists, ritz_eigen_sparse() of this thread takes the
   pairs of a small pencil from a store if they are there, and stores those that
   it finds. */
typedef struct ritz_spectra_lent {
    ritz_spectra *before;
} ritz_spectra_lent;

/** Lend a store to this thread, until ritz_spectra_lent_free(), which RITZ_OWN
 * calls. @param[in] spectra  NULL: no pairs are stored until then */
ritz_spectra_lent ritz_spectra_lend(ritz_spectra *spectra);
void ritz_spectra_lent_free(ritz_spectra_lent *scope);

/** Whether a store is lent to this thread. */
bool ritz_spectra_are_lent(void);

/** All pairs of exactly this pencil; NULL: they are not stored, or no store is
 * lent. They are valid until the next call of ritz_spectra_keep(). */
const ritz_pairs *ritz_spectra_find(const ritz_sparse *K, const ritz_sparse *M);

/**
 * Store copies of a pencil and of all its pairs. If the store is full, those that
 * were stored first are dropped.
 *
 * @return RITZ_ERR_MEMORY; without a store nothing is done
 */
ritz_status ritz_spectra_keep(const ritz_sparse *K, const ritz_sparse *M,
                              const ritz_pairs *pairs);

#endif
