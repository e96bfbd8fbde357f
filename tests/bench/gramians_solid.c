/*
 * gramians_solid COMPONENT DAMPING [TOLERANCE [AMONG_HZ]] - print time, memory
 * and the leading Hankel values of one component by engine low-rank, by engine
 * projection if D is a M + b K, and with AMONG_HZ by engine modal from the
 * modes up to that frequency. Nothing is judged.
 */
#include "../unit/try.h"
#include "gramians/projection.h"

#include <ritz/base.h>
#include <ritz/basis.h>
#include <ritz/container.h>

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <time.h>

enum { SHOWN = 12 };

static double seconds(clockid_t of)
{
    struct timespec now;

    clock_gettime(of, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static double peak_megabytes(void)
{
    struct rusage usage;

    getrusage(RUSAGE_SELF, &usage);
    return (double)usage.ru_maxrss / 1e3;
}

static double began;

static void show(const char *what, int64_t done, int64_t total)
{
    (void)total;
    if (done % 10 == 0)
        fprintf(stderr, "%7.1f s (%.1f of processors)  %s %" PRId64 "\n",
                seconds(CLOCK_MONOTONIC) - began,
                seconds(CLOCK_PROCESS_CPUTIME_ID), what, done);
}

/* One engine: its factors, time and values. */
static ritz_status measure(const ritz_gramians_request *request,
                           const char *name, int64_t *count, double **sigma)
{
    ritz_status status = RITZ_OK;
    ritz_gramians gramians = {0};
    double start = seconds(CLOCK_MONOTONIC);
    double worked = seconds(CLOCK_PROCESS_CPUTIME_ID);

    RITZ_TRY(ritz_gramians_of_component(request, &gramians));
    RITZ_TRY(ritz_gramians_hankel(&gramians, count, sigma));
    printf("%-10s %8.1f s (%.1f of processors) %8.0f MB  %s\n"
           "           rank %" PRId64 " and %" PRId64
           ", residuals %.1e and %.1e, error %.1e, %" PRId64 " values\n",
           name, seconds(CLOCK_MONOTONIC) - start,
           seconds(CLOCK_PROCESS_CPUTIME_ID) - worked, peak_megabytes(),
           gramians.engine, gramians.Zc.ncol, gramians.Zo.ncol,
           gramians.residual[0], gramians.residual[1], gramians.error, *count);
    fflush(stdout);
done:
    ritz_gramians_free(&gramians);
    return status;
}

static ritz_status bench(int argc, char **argv)
{
    ritz_status status = RITZ_OK;
    ritz_component component = {0};
    ritz_gramians_request request = {.component = &component,
                                     .engine = RITZ_ENGINE_LOW_RANK};
    int64_t count[3] = {0};
    double *sigma[3] = {0};
    bool fits = false;

    RITZ_TRY(ritz_container_read_component(argv[1], &component));
    RITZ_TRY(ritz_damping_parse(argv[2], &request.damping));
    request.tolerance = argc > 3 ? strtod(argv[3], NULL) : 0.0;
    printf("%" PRId64 " dofs, %s\n", component.num_dofs, argv[2]);
    RITZ_TRY(ritz_projection_fits(&request, &fits));
    request.engine = RITZ_ENGINE_PROJECTION;
    if (fits)
        RITZ_TRY(measure(&request, "projection", &count[2], &sigma[2]));
    request.engine = RITZ_ENGINE_LOW_RANK;
    RITZ_TRY(measure(&request, "low-rank", &count[0], &sigma[0]));
    request.tolerance = 0.0;
    request.engine = RITZ_ENGINE_MODAL;
    request.among_hz = argc > 4 ? strtod(argv[4], NULL) : 0.0;
    if (argc > 4)
        RITZ_TRY(measure(&request, "modal", &count[1], &sigma[1]));
    for (int64_t k = 0; k < SHOWN && k < count[0]; k++)
        printf("%4" PRId64 "  %.9e  %.9e  %.9e\n", k + 1, sigma[0][k],
               k < count[2] ? sigma[2][k] : 0.0,
               k < count[1] ? sigma[1][k] : 0.0);
    for (int64_t k = SHOWN; k < count[0]; k++)
        if (getenv("GRAMIANS_ALL"))
            printf("%4" PRId64 "  %.9e\n", k + 1, sigma[0][k]);
done:
    free(sigma[0]);
    free(sigma[1]);
    free(sigma[2]);
    ritz_component_free(&component);
    return status;
}

int main(int argc, char **argv)
{
    if (argc < 3) {
        fprintf(stderr, "usage: gramians_solid COMPONENT DAMPING [TOLERANCE "
                        "[AMONG_HZ]]\n");
        return 2;
    }
    began = seconds(CLOCK_MONOTONIC);
    ritz_monitor_observe(show);
    if (bench(argc, argv) != RITZ_OK) {
        fprintf(stderr, "gramians_solid: %s\n", ritz_error_message());
        return 1;
    }
    return 0;
}
