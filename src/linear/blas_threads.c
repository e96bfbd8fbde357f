#include "linear/blas_threads.h"

#include "base/tolerances.h"

/* Null where the BLAS is not OpenBLAS. */
[[gnu::weak]] void openblas_set_num_threads(int threads);
[[gnu::weak]] int openblas_get_num_threads(void);
/* Null where no library that is linked uses OpenMP. */
[[gnu::weak]] void omp_set_max_active_levels(int levels);
[[gnu::weak]] int omp_get_max_active_levels(void);
[[gnu::weak]] void omp_set_num_threads(int threads);

int ritz_blas_threads(int threads)
{
    int before = 0;

    if (!openblas_get_num_threads || !openblas_set_num_threads)
        return 0;
    before = openblas_get_num_threads();
    if (threads > 0 && threads != before)
        openblas_set_num_threads(threads);
    return before;
}

ritz_blas_single ritz_blas_single_new(void)
{
    return (ritz_blas_single){ritz_blas_threads(1)};
}

void ritz_blas_single_free(ritz_blas_single *single)
{
    ritz_blas_threads(single->before);
    single->before = 0;
}

void ritz_blas_single_here(int thread)
{
    if (thread > 0 && omp_set_num_threads)
        omp_set_num_threads(1);
}

/* OpenBLAS is set first: if it expects several threads and OpenMP starts none,
   it waits for ever. */
ritz_blas_setting ritz_blas_alone(double operations)
{
    ritz_blas_setting before = {0, -1};

    if (!(operations < RITZ_FACTOR_ALONE))
        return before;
    before.threads = ritz_blas_threads(1);
    if (before.threads > 0 && omp_get_max_active_levels &&
        omp_set_max_active_levels) {
        before.levels = omp_get_max_active_levels();
        omp_set_max_active_levels(0);
    }
    return before;
}

void ritz_blas_restore(ritz_blas_setting before)
{
    if (before.levels >= 0)
        omp_set_max_active_levels(before.levels);
    ritz_blas_threads(before.threads);
}
