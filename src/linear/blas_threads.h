/* How many threads the BLAS library uses. */
#ifndef RITZ_LINEAR_BLAS_THREADS_H
#define RITZ_LINEAR_BLAS_THREADS_H

/**
 * Set the number of threads of OpenBLAS, for the whole process. Another BLAS is
 * left as it is.
 *
 * @param[in] threads  0 changes nothing
 * @return the number before, to restore it; 0 if the BLAS is not OpenBLAS
 */
int ritz_blas_threads(int threads);

#endif
