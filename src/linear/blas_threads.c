#include "linear/blas_threads.h"

#include "base/tolerances.h"

/* Null where the BLAS is not OpenBLAS. */
[[gnu::weak]] void openblas_set_num_threads(int threads);
[[gnu::weak]] int openblas_get_num_threads(void);
/* Null where no library that is linked uses OpenMP. */
[[gnu::weak]] void omp_set_max_active_levels(int levels);

int ritz_blas_threads(int threads)
{
    int before = 0;

    if (!openblas_get_num_threads || !openblas_set_num_threads)
        return 0;
    before = openblas_get_num_threads();
    if (threads <= 0)
        return before;
    if (threads != before)
        openblas_set_num_threads(threads);
    /* CHOLMOD's own OpenMP loops shall start no threads either. OpenBLAS is set
       first: while it still counts on several threads, it would wait for some
       that OpenMP no longer starts. */
    if (omp_set_max_active_levels)
        omp_set_max_active_levels(threads == 1 ? 0 : 1);
    return before;
}

int ritz_blas_threads_for(double operations)
{
    return operations < RITZ_FACTOR_ALONE ? ritz_blas_threads(1) : 0;
}
