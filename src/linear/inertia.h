/* The number of negative eigenvalues of a sparse symmetric matrix, and of
 * eigenvalues of a pencil below a value. */
#ifndef RITZ_LINEAR_INERTIA_H
#define RITZ_LINEAR_INERTIA_H

#include <ritz/matrix.h>

/**
 * The number of negative eigenvalues of A. By Sylvester's law of inertia it is
 * the number of negative pivots of A = L D L'. The factor is not kept, so that
 * A cannot be tested for being singular to working accuracy: an eigenvalue that
 * is zero within rounding may be counted as negative or as positive.
 *
 * @param[in]  A      n x n, symmetric, both triangles stored
 * @param[in]  order  as ritz_ordering_new() returns it; NULL: find one
 * @param[out] negative  number of negative eigenvalues
 * @return RITZ_ERR_SINGULAR if a pivot is zero within rounding;
 *         RITZ_ERR_ARGUMENT if an entry is not finite; RITZ_ERR_MEMORY, also
 *         if what MUMPS works with would exceed the limit of memory
 * @cost   one factor by MUMPS; memory holds only the part that it works with
 */
ritz_status ritz_inertia_negative(const ritz_sparse *A, const int64_t *order,
                                  int64_t *negative);

/** Counts the eigenvalues of K phi = lambda M phi below one value after another.
 * The union of the patterns of K and M and its order are kept between counts.
 * Memory holds only the part of a factor that MUMPS works with. */
typedef struct ritz_counter ritz_counter;

/**
 * @param[in] K,M    n x n, symmetric, M semidefinite; borrowed until the counter
 *                   is freed
 * @param[in] order  as for ritz_inertia_negative(); copied
 * @return RITZ_ERR_ARGUMENT if the sizes of K and M differ or an entry is not
 *         finite; RITZ_ERR_MEMORY
 */
ritz_status ritz_counter_new(const ritz_sparse *K, const ritz_sparse *M,
                             const int64_t *order, ritz_counter **out);

/** A function of the caller that frees memory which is not needed during a
 * count. */
typedef struct ritz_relief {
    /** @return a failure ends the count with the same status */
    ritz_status (*call)(void *of);
    void *of;
} ritz_relief;

/** Let a counter call @p relief before each count that would exceed the limit of
 * memory. With {0}, as in a new counter, such a count is refused. */
void ritz_counter_relieve(ritz_counter *C, ritz_relief relief);

/** Whether another thread makes a Cholesky factor of the same pattern while this
 * counter counts: then a count is refused, as RITZ_ERR_MEMORY, unless memory
 * holds both. */
void ritz_counter_share(ritz_counter *C, bool shared);

/**
 * The number of eigenvalues of K phi = lambda M phi below @p tau. The factor of
 * K - tau M is not kept, as in ritz_inertia_negative(): an eigenvalue that is at
 * tau within rounding may be counted or not. After a failure the counter can be
 * used again.
 *
 * @param[out] below  unchanged on failure
 * @return RITZ_ERR_SINGULAR if a pivot is zero within rounding: an eigenvalue
 *         is at tau; RITZ_ERR_ARGUMENT if tau is not finite; RITZ_ERR_MEMORY,
 *         also if what MUMPS works with would exceed the limit of memory; the
 *         status of a relief that failed
 * @cost   an LDL' factorisation by MUMPS
 */
ritz_status ritz_counter_below(ritz_counter *C, double tau, int64_t *below);

void ritz_counter_free(ritz_counter **C);

/**
 * ritz_eigen_count() with a given order of rows. MUMPS keeps the factor, and
 * three solves test whether tau is an eigenvalue to working accuracy.
 *
 * @param[in] order  as for ritz_inertia_negative()
 */
ritz_status ritz_inertia_below(const ritz_sparse *K, const ritz_sparse *M,
                               double tau, const int64_t *order, int64_t *out);

#endif
