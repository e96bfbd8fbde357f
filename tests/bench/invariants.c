/*
 * Processor seconds of inertia invariants beside those of T'M T, for so many
 * columns T: the part of ritz-reduce that moving frames cost.
 *
 *     bench_invariants COLUMNS COMPONENT...
 */
#include "../unit/try.h"

#include <ritz/container.h>
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

/* Columns that cost what those of any basis do. */
static ritz_status fill_columns(int64_t n, int64_t count, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(n, count, out));
    for (int64_t k = 0; k < n * count; k++)
        out->val[k] = sin(1e-3 * (double)k);
    return RITZ_OK;
}

static ritz_status reduce_mass(const ritz_sparse *M, const ritz_dense *T)
{
    RITZ_OWN(ritz_dense) MT = {0}, M_r = {0};

    RITZ_CHECK(ritz_sparse_mul(M, T, &MT));
    return ritz_dense_mul_tn(T, &MT, &M_r);
}

static ritz_status measure(const char *path, int64_t count)
{
    RITZ_OWN(ritz_component) component = {0};
    RITZ_OWN(ritz_invariants) invariants = {0};
    RITZ_OWN(ritz_dense) T = {0};
    double began = 0.0, mass = 0.0;

    RITZ_CHECK(ritz_container_read_component(path, &component));
    RITZ_CHECK(fill_columns(component.num_dofs, count, &T));
    RITZ_CHECK(reduce_mass(&component.M, &T)); /* memory is there then */
    began = now();
    RITZ_CHECK(reduce_mass(&component.M, &T));
    mass = now() - began;
    began = now();
    RITZ_CHECK(ritz_invariants_of(&component, &T, &invariants));
    printf("%10" PRId64 " %8" PRId64 " %12.3f %12.3f\n", component.num_dofs,
           count, mass, now() - began);
    return RITZ_OK;
}

int main(int argc, char **argv)
{
    if (argc < 3) {
        fprintf(stderr, "usage: invariants COLUMNS COMPONENT...\n");
        return 2;
    }
    printf("%10s %8s %12s %12s\n", "dofs", "columns", "T'M T, s",
           "invariants, s");
    for (int k = 2; k < argc; k++)
        if (measure(argv[k], strtol(argv[1], NULL, 10)) != RITZ_OK) {
            fprintf(stderr, "invariants: %s\n", ritz_error_message());
            return 1;
        }
    return 0;
}
