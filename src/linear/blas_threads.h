/* The threads of the BLAS. */
#ifndef RITZ_LINEAR_BLAS_THREADS_H
#define RITZ_LINEAR_BLAS_THREADS_H

/**
 * Let the BLAS use this number of threads, where it is OpenBLAS; another BLAS
 * keeps its own.
 *
 * @return how many they were, 0 if that is not known
 */
int ritz_blas_threads(int threads);

#endif
