#include "linear/blas_threads.h"

/* Null where the BLAS is not OpenBLAS. */
[[gnu::weak]] void openblas_set_num_threads(int threads);
[[gnu::weak]] int openblas_get_num_threads(void);

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
