/* The threads of the BLAS. */
#ifndef RITZ_LINEAR_BLAS_THREADS_H
#define RITZ_LINEAR_BLAS_THREADS_H

/**
 * Set the number of threads of OpenBLAS, for the whole process; with one thread
 * OpenMP starts no others in any library. Another BLAS is left as it is.
 *
 * @param[in] threads  0 changes nothing
 * @return the number before, to restore it; 0 if the BLAS is not OpenBLAS
 */
int ritz_blas_threads(int threads);

/**
 * Before a sparse factor: set one thread if it takes so few floating-point
 * operations that a second thread would make it slower.
 *
 * @return what to give to ritz_blas_threads() after the factor
 */
int ritz_blas_threads_for(double operations);

#endif
