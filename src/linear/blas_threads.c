#include "linear/blas_threads.h"

#include "base/tolerances.h"

/* Null where the BLAS is not OpenBLAS. */
[[gnu::weak]] void openblas_set_num_threads(int threads);
[[gnu::weak]] int openblas_get_num_threads(void);
/* Null where no library uses OpenMP. */
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
    /* so that CHOLMOD's own loops start no threads either. The BLAS comes
       first: told to use several, it waits for threads that OpenMP does not
       start */
    if (omp_set_max_active_levels)
        omp_set_max_active_levels(threads == 1 ? 0 : 1);
    return before;
}

int ritz_blas_threads_for(double operations)
{
    return operations < RITZ_FACTOR_ALONE ? ritz_blas_threads(1) : 0;
}
