/*
 * limits: measure how fast this machine is with OMP_NUM_THREADS threads, and
 * print one JSON object: floating-point operations a second in products of
 * dense matrices, and bytes read from memory a second, each the best of several
 * tries; and bytes of memory that are used for the first time a second. The
 * system clears those, and a virtual machine may have to get them back from its
 * host, which this process can do only once.
 */
#define _DEFAULT_SOURCE
#include <cblas.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>

enum { ORDER = 2048, TRIES = 7, PAGE = 4096 };

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

static double measure_first_use(void)
{
    char *x = mmap(NULL, bytes, PROT_READ | PROT_WRITE,
                   MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    double began = omp_get_wtime(), seconds = 0.0;

    if (x == MAP_FAILED) {
        fprintf(stderr, "limits: no memory\n");
        exit(1);
    }
    madvise(x, bytes, MADV_HUGEPAGE);
#pragma omp parallel for
    for (size_t i = 0; i < bytes; i += PAGE)
        x[i] = 1;
    seconds = omp_get_wtime() - began;
    munmap(x, bytes);
    return (double)bytes / seconds;
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
    const double first = measure_first_use(), flops = measure_product();

    printf("{\"threads\": %d, \"flops\": %.4g, \"read\": %.4g, "
           "\"first_use\": %.4g}\n",
           omp_get_max_threads(), flops, measure_reading(), first);
    return 0;
}
