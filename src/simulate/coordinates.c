/*
 * ritz_simulate. If a request wants the coordinates of a dense model over time,
 * they are added to its outputs,
 *
 *     q = I q,   q' = I q',   q'' = I q'',
 *
 * so that every integrator computes them as it computes any output.
 */
#include "simulate/motion.h"

#include "base/alloc.h"

#include <stdlib.h>
#include <string.h>

/* The model's own outputs, and then n coordinates, velocities and
   accelerations. */
static ritz_status extend_outputs(const ritz_io *own, int64_t n, ritz_io *out)
{
    RITZ_OWN(ritz_io) io = {0};
    const int64_t p = own->num_outputs;

    RITZ_CHECK(ritz_io_new(n, own->num_inputs, p + 3 * n, &io));
    for (int64_t j = 0; j < own->num_inputs; j++)
        memcpy(io.input[j], own->input[j], sizeof io.input[j]);
    for (int64_t j = 0; j < p; j++)
        memcpy(io.output[j], own->output[j], sizeof io.output[j]);
    ritz_dense_put(&own->B, 0, 0, &io.B);
    ritz_dense_put(&own->C, 0, 0, &io.C);
    ritz_dense_put(&own->Cv, 0, 0, &io.Cv);
    ritz_dense_put(&own->Ca, 0, 0, &io.Ca);
    for (int64_t j = 0; j < n; j++) {
        ritz_dense_col(&io.C, j)[p + j] = 1.0;
        ritz_dense_col(&io.Cv, j)[p + n + j] = 1.0;
        ritz_dense_col(&io.Ca, j)[p + 2 * n + j] = 1.0;
    }
    RITZ_MOVE(*out, io);
    return RITZ_OK;
}

/* Copy `count` outputs of every time, from number `first` on. */
static ritz_status cut_columns(const ritz_simulation *s, int64_t first,
                               int64_t count, double **out)
{
    RITZ_CHECK_NEW(*out, s->count * count);
    for (int64_t k = 0; k < s->count && count > 0; k++)
        memcpy(*out + k * count, s->y + k * s->num_outputs + first,
               (size_t)count * sizeof **out);
    return RITZ_OK;
}

/* Move the coordinates out of the outputs, of which the first `own` stay. */
static ritz_status part_outputs(int64_t own, int64_t n, ritz_simulation *s)
{
    RITZ_OWN_ARRAY double *y = NULL;

    RITZ_CHECK(cut_columns(s, 0, own, &y));
    RITZ_CHECK(cut_columns(s, own, n, &s->q));
    RITZ_CHECK(cut_columns(s, own + n, n, &s->v));
    RITZ_CHECK(cut_columns(s, own + 2 * n, n, &s->a));
    s->num_coordinates = n;
    s->num_outputs = own;
    free(s->y);
    RITZ_MOVE(s->y, y);
    return RITZ_OK;
}

ritz_status ritz_simulate_coordinates(ritz_model subject,
                                      const ritz_simulation_request *request,
                                      ritz_run_function *run,
                                      const void *context, ritz_simulation *out)
{
    RITZ_OWN(ritz_io) io = {0};
    RITZ_OWN(ritz_simulation) s = {0};
    const ritz_io *own = NULL;
    int64_t n = 0;

    if (!request->coordinates)
        return run(subject, request, context, out);
    RITZ_REFUSE_IF(subject.kind != RITZ_MODEL_DENSE, RITZ_ERR_ARGUMENT,
                   "coordinates are of reduced components and systems");
    own = subject.dense.io;
    n = ritz_model_order(subject);
    RITZ_CHECK(extend_outputs(own, n, &io));
    subject.dense.io = &io;
    RITZ_CHECK(run(subject, request, context, &s));
    RITZ_CHECK(part_outputs(own->num_outputs, n, &s));
    RITZ_MOVE(*out, s);
    return RITZ_OK;
}

/* A run of one linear model. */
static ritz_status run_model(ritz_model subject,
                             const ritz_simulation_request *request,
                             const void *context, ritz_simulation *out)
{
    (void)context;
    return ritz_simulate_noting(subject, request, true, NULL, out);
}

ritz_status ritz_simulate(ritz_model subject,
                          const ritz_simulation_request *request,
                          ritz_simulation *out)
{
    return ritz_simulate_coordinates(subject, request, run_model, NULL, out);
}
