/*
 * limits: measure how fast this machine is with OMP_NUM_THREADS threads, and
 * print one JSON object: floating-point operations a second in products of
 * dense matrices, and bytes read from memory a second. Each is the best of
 * several tries.
 */
#include <cblas.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>

enum { ORDER = 2048, TRIES = 7 };

static const size_t bytes = (size_t)512 << 20; /* far beyond any cache */

static double *fill(size_t count)
{
    double *x = malloc(count * sizeof *x);

    if (!x) {
        fprintf(stderr, "limits: no memory\n");
        exit(1);
    }
#pragma omp parallel for
    for (size_t i = 0; i < count; i++)
        x[i] = 1.0 + (double)(i % 7);
    return x;
}

static double measure_product(void)
{
    const size_t entries = (size_t)ORDER * ORDER;
    double *A = fill(entries), *B = fill(entries), *C = fill(entries);
    double best = 0.0;

    for (int k = 0; k < TRIES; k++) {
        double began = omp_get_wtime(), rate = 0.0;

        cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, ORDER, ORDER,
                    ORDER, 1.0, A, ORDER, B, ORDER, 0.0, C, ORDER);
        rate = 2.0 * ORDER * ORDER * ORDER / (omp_get_wtime() - began);
        best = rate > best ? rate : best;
    }
    free(A);
    free(B);
    free(C);
    return best;
}

static double measure_reading(void)
{
    const size_t count = bytes / sizeof(double);
    double *x = fill(count), best = 0.0, total = 0.0;

    for (int k = 0; k < TRIES; k++) {
        double began = omp_get_wtime(), rate = 0.0, sum = 0.0;

#pragma omp parallel for simd reduction(+ : sum)
        for (size_t i = 0; i < count; i++)
            sum += x[i];
        rate = (double)bytes / (omp_get_wtime() - began);
        best = rate > best ? rate : best;
        total += sum;
    }
    free(x);
    if (total < 1.0) /* never, but so no compiler leaves the sums out */
        exit(1);
    return best;
}

int main(void)
{
    printf("{\"threads\": %d, \"flops\": %.4g, \"read\": %.4g}\n",
           omp_get_max_threads(), measure_product(), measure_reading());
    return 0;
}
