/* The number of threads that the BLAS, and OpenMP loops, use. */
#ifndef RITZ_LINEAR_BLAS_THREADS_H
#define RITZ_LINEAR_BLAS_THREADS_H

/**
 * Set the number of threads of OpenBLAS, for the whole process. With 1, OpenMP
 * loops of any library that the calling thread enters start no threads either;
 * with more they may again. Does nothing if the BLAS is not OpenBLAS.
 *
 * @param[in] threads  0 changes nothing
 * @return the number of OpenBLAS before, to restore it by a second call; 0 if
 *         the BLAS is not OpenBLAS
 */
int ritz_blas_threads(int threads);

/**
 * Call ritz_blas_threads(1) before a sparse factorisation that is too small to
 * gain from several threads; leave the number as it is before a larger one.
 *
 * @param[in] operations  floating-point operations of the factorisation
 * @return the argument of ritz_blas_threads() that restores the number
 *         afterwards
 */
int ritz_blas_threads_for(double operations);

#endif
