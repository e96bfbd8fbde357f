/*
 * Processor seconds of the buckling factors of plates, their errors, and those
 * of T'KG T beside T'K T for so many columns T.
 *
 *     bench_buckling COLUMNS POINTS...
 *
 * POINTS inside a side: 316 make 100 thousand dofs.
 */
#include "check/buckling.h"
#include "../unit/fixtures/plate.h"
#include "../unit/try.h"

#include <ritz/reduced.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static double now(void)
{
    struct timespec now;

    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static ritz_status time_projection(const ritz_sparse *A, const ritz_dense *T,
                                   double *out)
{
    RITZ_OWN(ritz_dense) first = {0}, second = {0};
    double began = 0.0;

    RITZ_CHECK(ritz_sparse_project(A, T, &first)); /* memory is there then */
    began = now();
    RITZ_CHECK(ritz_sparse_project(A, T, &second));
    *out = now() - began;
    return RITZ_OK;
}

/* The larger of the relative errors; NaN if a factor is missing. */
static double error_of(const ritz_buckling *found, const ritz_buckling *exact)
{
    const double one = fabs(found->factor / exact->factor - 1.0);
    const double two = fabs(found->reversed / exact->reversed - 1.0);

    if (isnan(found->reversed) != isnan(exact->reversed))
        return (double)NAN;
    return fmax(one, two);
}

static ritz_status measure(int64_t m, double n_y, int64_t columns)
{
    RITZ_OWN(ritz_sparse) K = {0}, KG = {0};
    RITZ_OWN(ritz_dense) T = {0};
    ritz_buckling found = {0}, exact = {0};
    double began = 0.0, seconds = 0.0, of_K = 0.0, of_KG = 0.0;

    RITZ_CHECK(plate_matrices(m, 1.0, n_y, &K, &KG));
    plate_factors(m, 1.0, n_y, &exact);
    began = now();
    RITZ_CHECK(ritz_buckling_iterated(&K, &KG, &found));
    seconds = now() - began;
    RITZ_CHECK(ritz_dense_new(m * m, columns, &T));
    for (int64_t k = 0; k < m * m * columns; k++)
        T.val[k] = sin(1e-3 * (double)k);
    RITZ_CHECK(time_projection(&K, &T, &of_K));
    RITZ_CHECK(time_projection(&KG, &T, &of_KG));
    printf("%8" PRId64 " %6g %12.3f %10.1e %10.3f %10.3f\n", m * m, n_y,
           seconds, error_of(&found, &exact), of_K, of_KG);
    return RITZ_OK;
}

int main(int argc, char **argv)
{
    static const double n_y[] = {0.0, -0.1, -0.9};

    if (argc < 3) {
        fprintf(stderr, "usage: buckling COLUMNS POINTS...\n");
        return 2;
    }
    printf("%8s %6s %12s %10s %10s %10s\n", "dofs", "n_y", "factors, s",
           "error", "T'K T, s", "T'KG T, s");
    for (int k = 2; k < argc; k++)
        for (size_t i = 0; i < sizeof n_y / sizeof *n_y; i++)
            if (measure(strtol(argv[k], NULL, 10), n_y[i],
                        strtol(argv[1], NULL, 10)) != RITZ_OK) {
                fprintf(stderr, "buckling: %s\n", ritz_error_message());
                return 1;
            }
    return 0;
}
