/*
 * ritz_simulate. If a request includes the coordinates over time, they are added
 * to the outputs,
 *
 *     q = V u,   q' = V u',   q'' = V u'',
 *
 * where u are the coordinates of the model and V is mostly the identity, so that
 * every integrator computes them as it computes any output.
 */
#include "simulate/motion.h"

#include "base/alloc.h"

#include <stdlib.h>
#include <string.h>

/* Row i of V. */
static void copy_row(const ritz_dense *V, int64_t i, int64_t to, ritz_dense *C)
{
    for (int64_t j = 0; j < C->ncol; j++)
        ritz_dense_col(C, j)[to] =
            V ? ritz_dense_col(V, j)[i] : (double)(i == j);
}

ritz_status ritz_coordinates_add(const ritz_io *own, const ritz_dense *V,
                                 ritz_io *out)
{
    RITZ_OWN(ritz_io) io = {0};
    const int64_t p = own->num_outputs, n = V ? V->nrow : own->B.nrow;

    RITZ_CHECK(ritz_io_new(own->B.nrow, own->num_inputs, p + 3 * n, &io));
    for (int64_t j = 0; j < own->num_inputs; j++)
        memcpy(io.input[j], own->input[j], sizeof io.input[j]);
    for (int64_t j = 0; j < p; j++)
        memcpy(io.output[j], own->output[j], sizeof io.output[j]);
    ritz_dense_put(&own->B, 0, 0, &io.B);
    ritz_dense_put(&own->C, 0, 0, &io.C);
    ritz_dense_put(&own->Cv, 0, 0, &io.Cv);
    ritz_dense_put(&own->Ca, 0, 0, &io.Ca);
    for (int64_t i = 0; i < n; i++) {
        copy_row(V, i, p + i, &io.C);
        copy_row(V, i, p + n + i, &io.Cv);
        copy_row(V, i, p + 2 * n + i, &io.Ca);
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

ritz_status ritz_coordinates_take(int64_t own, ritz_simulation *s)
{
    const int64_t n = (s->num_outputs - own) / 3;
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

    if (!request->coordinates)
        return run(subject, request, context, out);
    RITZ_REFUSE_IF(subject.kind != RITZ_MODEL_DENSE, RITZ_ERR_ARGUMENT,
                   "coordinates are of reduced components and systems: "
                   "ritz-reduce a component first, by 'full' without loss");
    own = subject.dense.io;
    RITZ_CHECK(ritz_coordinates_add(own, NULL, &io));
    subject.dense.io = &io;
    RITZ_CHECK(run(subject, request, context, &s));
    RITZ_CHECK(ritz_coordinates_take(own->num_outputs, &s));
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
