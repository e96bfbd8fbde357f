/*
 * responses COMPONENT DAMPING FROM_HZ TO_HZ CHECKS ENGINE... - seconds of
 * processor for 1000 points by each engine, and its largest error beside the
 * direct one at CHECKS random frequencies, of each channel's largest |H|. What
 * the direct engine takes for 1000 points is scaled from those. A table, no
 * verdict; OMP_NUM_THREADS=1 for one thread.
 */
#include "../unit/try.h"

#include <ritz/container.h>
#include <ritz/response.h>

#include <complex.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { POINTS = 1000 };

/* What engines are compared at. */
typedef struct checks {
    int64_t count, values;
    double *hertz;
    double _Complex *H; /* count x values, of the direct engine */
    double _Complex *row;
    double *peak;   /* values */
    double seconds; /* of the direct engine for POINTS */
} checks;

static double seconds(void)
{
    struct timespec now;

    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void see_peaks(checks *c, const double _Complex *H)
{
    for (int64_t v = 0; v < c->values; v++)
        c->peak[v] = fmax(c->peak[v], cabs(H[v]));
}

/* The direct engine at random frequencies. */
static ritz_status prepare(const ritz_response_request *request, checks *c)
{
    ritz_status status = RITZ_OK;
    ritz_responder *direct = NULL;
    double began = seconds(), ready = 0.0, each = 0.0;
    int64_t seed = 1992;

    RITZ_TRY(ritz_responder_new(ritz_response_engine_find("direct"), request,
                                &direct));
    ready = seconds() - began;
    for (int64_t k = 0; k < c->count; k++) {
        seed = seed * 48271 % 2147483647;
        c->hertz[k] = request->from_hz + (request->to_hz - request->from_hz) *
                                             (double)seed / 2147483647.0;
        RITZ_TRY(ritz_responder_at(direct, c->hertz[k], c->H + k * c->values));
        see_peaks(c, c->H + k * c->values);
    }
    each = (seconds() - began - ready) / (double)c->count;
    c->seconds = ready + POINTS * each;
    printf("%-10s %10.3f %10.2e %10.2f %10s %8s  of %" PRId64
           " points, %.3g s each\n",
           "direct", ready, each, c->seconds, "-", "1", c->count, each);
    fflush(stdout);
done:
    ritz_responder_free(&direct);
    return status;
}

static double error_of(const checks *c, const double _Complex *row, int64_t k)
{
    double error = 0.0;

    for (int64_t v = 0; v < c->values; v++)
        error =
            fmax(error, cabs(row[v] - c->H[k * c->values + v]) / c->peak[v]);
    return error;
}

static ritz_status measure(const char *name,
                           const ritz_response_request *request, checks *c)
{
    ritz_status status = RITZ_OK;
    const ritz_response_engine *engine = ritz_response_engine_find(name);
    ritz_responder *r = NULL;
    double began = seconds(), ready = 0.0, all = 0.0, error = 0.0;

    if (!engine)
        return RITZ_ERR_ARGUMENT;
    RITZ_TRY(ritz_responder_new(engine, request, &r));
    ready = seconds() - began;
    for (int64_t k = 0; k < POINTS; k++) {
        double part = (double)k / (POINTS - 1);

        RITZ_TRY(ritz_responder_at(
            r, request->from_hz + part * (request->to_hz - request->from_hz),
            c->row));
        see_peaks(c, c->row);
    }
    all = seconds() - began;
    for (int64_t k = 0; k < c->count; k++) {
        RITZ_TRY(ritz_responder_at(r, c->hertz[k], c->row));
        error = fmax(error, error_of(c, c->row, k));
    }
    printf("%-10s %10.3f %10.2e %10.2f %10.1e %8.0f  %s\n", name, ready,
           (all - ready) / POINTS, all, error, c->seconds / all,
           ritz_responder_remark(r));
    fflush(stdout);
done:
    ritz_responder_free(&r);
    return status;
}

static ritz_status bench(int argc, char **argv)
{
    ritz_status status = RITZ_OK;
    ritz_component component = {0};
    ritz_damping damping = {0};
    ritz_response_request request = {
        .model = ritz_model_of_component(&component, &damping),
        .from_hz = strtod(argv[3], NULL),
        .to_hz = strtod(argv[4], NULL),
        .tolerance = 1e-7};
    checks c = {.count = strtol(argv[5], NULL, 10)};

    RITZ_TRY(ritz_container_read_component(argv[1], &component));
    RITZ_TRY(ritz_damping_parse(argv[2], &damping));
    c.values = component.io.num_inputs * component.io.num_outputs;
    c.hertz = calloc((size_t)c.count, sizeof *c.hertz);
    c.H = calloc((size_t)(c.count * c.values), sizeof *c.H);
    c.row = calloc((size_t)c.values, sizeof *c.row);
    c.peak = calloc((size_t)c.values, sizeof *c.peak);
    if (!c.hertz || !c.H || !c.row || !c.peak) {
        status = RITZ_ERR_MEMORY;
        goto done;
    }
    printf("%" PRId64 " dofs, %" PRId64 " inputs, %" PRId64
           " outputs, %s, %s to %s Hz\n%-10s %10s %10s %10s %10s %8s\n",
           component.num_dofs, component.io.num_inputs,
           component.io.num_outputs, argv[2], argv[3], argv[4], "engine",
           "ready", "a point", "all", "error", "ratio");
    RITZ_TRY(prepare(&request, &c));
    for (int k = 6; k < argc; k++)
        RITZ_TRY(measure(argv[k], &request, &c));
done:
    free(c.hertz);
    free(c.H);
    free(c.row);
    free(c.peak);
    ritz_component_free(&component);
    return status;
}

int main(int argc, char **argv)
{
    if (argc < 7) {
        fprintf(stderr, "usage: responses COMPONENT DAMPING FROM_HZ TO_HZ "
                        "CHECKS ENGINE...\n");
        return 2;
    }
    if (bench(argc, argv) != RITZ_OK) {
        fprintf(stderr, "responses: %s\n", ritz_error_message());
        return 1;
    }
    return 0;
}
