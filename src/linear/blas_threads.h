/* The number of threads that the BLAS, and OpenMP loops, use. */
#ifndef RITZ_LINEAR_BLAS_THREADS_H
#define RITZ_LINEAR_BLAS_THREADS_H

/**
 * Set the number of threads of OpenBLAS, for the whole process; an OpenBLAS
 * built with OpenMP uses it where the calling thread calls it, and one thread in
 * threads that base/team.h starts. Does nothing if the BLAS is not OpenBLAS.
 *
 * @param[in] threads  0 changes nothing
 * @return the number before, to restore it by a second call; 0 if the BLAS is
 *         not OpenBLAS
 */
int ritz_blas_threads(int threads);

/* While it exists the BLAS uses one thread. This saves time with matrices of a
   few hundred rows: further threads would gain little, and wait for more work
   in a loop that takes processor time. */
typedef struct ritz_blas_single {
    int before; /* number of threads */
} ritz_blas_single;

/** One thread from now on, until ritz_blas_single_free(): RITZ_OWN it. */
ritz_blas_single ritz_blas_single_new(void);
void ritz_blas_single_free(ritz_blas_single *single);

/**
 * Called by a thread of a team before it calls the BLAS, while a
 * ritz_blas_single exists: OpenMP keeps the number of threads for each thread,
 * so that an OpenBLAS which uses OpenMP must be told by every one.
 */
void ritz_blas_single_here(int thread);

/* Settings before ritz_blas_alone(). */
typedef struct ritz_blas_setting {
    int threads; /* number of threads of OpenBLAS; 0: was not changed */
    int levels;  /* omp_get_max_active_levels(); -1: was not changed */
} ritz_blas_setting;

/**
 * Before a sparse factorisation that is too small to gain from several threads:
 * let OpenBLAS use one, and let OpenMP loops that the calling thread enters
 * start no others. A larger factorisation changes nothing.
 *
 * @param[in] operations  floating-point operations of the factorisation
 * @return for ritz_blas_restore(), which must follow in the same thread
 */
ritz_blas_setting ritz_blas_alone(double operations);

/** Back to what was set before ritz_blas_alone(). */
void ritz_blas_restore(ritz_blas_setting before);

#endif
