#include "base/alloc.h"
#include "base/complex.h"
#include "base/tolerances.h"

#include <ritz/model.h>

#include <complex.h>
#include <math.h>

ritz_status ritz_io_new(int64_t n, int64_t num_inputs, int64_t num_outputs,
                        ritz_io *out)
{
    RITZ_OWN(ritz_io)
    io = {.num_inputs = num_inputs, .num_outputs = num_outputs};

    RITZ_CHECK_NEW(io.input, num_inputs);
    RITZ_CHECK_NEW(io.output, num_outputs);
    RITZ_CHECK_NEW(io.limit, num_outputs);
    for (int64_t k = 0; k < num_outputs; k++)
        io.limit[k] = nan("");
    RITZ_CHECK(ritz_dense_new(n, num_inputs, &io.B));
    RITZ_CHECK(ritz_dense_new(num_outputs, n, &io.C));
    RITZ_CHECK(ritz_dense_new(num_outputs, n, &io.Cv));
    RITZ_CHECK(ritz_dense_new(num_outputs, n, &io.Ca));
    RITZ_MOVE(*out, io);
    return RITZ_OK;
}

ritz_status ritz_io_project(const ritz_io *io, const ritz_dense *T,
                            ritz_io *out)
{
    RITZ_OWN(ritz_io)
    part = {.num_inputs = io->num_inputs, .num_outputs = io->num_outputs};

    RITZ_CHECK_COPY(part.input, io->input, io->num_inputs);
    RITZ_CHECK_COPY(part.output, io->output, io->num_outputs);
    RITZ_CHECK_COPY(part.limit, io->limit, io->num_outputs);
    RITZ_CHECK_IN("inputs", ritz_dense_mul_tn(T, &io->B, &part.B));
    RITZ_CHECK_IN("outputs", ritz_dense_mul(&io->C, T, &part.C));
    RITZ_CHECK_IN("outputs", ritz_dense_mul(&io->Cv, T, &part.Cv));
    RITZ_CHECK_IN("outputs", ritz_dense_mul(&io->Ca, T, &part.Ca));
    RITZ_MOVE(*out, part);
    return RITZ_OK;
}

ritz_status ritz_io_copy(const ritz_io *io, ritz_io *out)
{
    RITZ_OWN(ritz_io)
    copy = {.num_inputs = io->num_inputs, .num_outputs = io->num_outputs};

    RITZ_CHECK_COPY(copy.input, io->input, io->num_inputs);
    RITZ_CHECK_COPY(copy.output, io->output, io->num_outputs);
    RITZ_CHECK_COPY(copy.limit, io->limit, io->num_outputs);
    RITZ_CHECK(ritz_dense_copy(&io->B, &copy.B));
    RITZ_CHECK(ritz_dense_copy(&io->C, &copy.C));
    RITZ_CHECK(ritz_dense_copy(&io->Cv, &copy.Cv));
    RITZ_CHECK(ritz_dense_copy(&io->Ca, &copy.Ca));
    RITZ_MOVE(*out, copy);
    return RITZ_OK;
}

void ritz_io_free(ritz_io *io)
{
    RITZ_FREE(io->input, io->output, io->limit);
    ritz_dense_free(&io->B);
    ritz_dense_free(&io->C);
    ritz_dense_free(&io->Cv);
    ritz_dense_free(&io->Ca);
    *io = (ritz_io){0};
}

void ritz_io_respond(const ritz_io *io, double hertz, const double _Complex *X,
                     double _Complex *H)
{
    double w = 2.0 * RITZ_PI * hertz;
    int64_t n = io->B.nrow;

    for (int64_t k = 0; k < n; k++) {
        const double *c = io->C.val + k * io->C.nrow;
        const double *cv = io->Cv.val + k * io->Cv.nrow;
        const double *ca = io->Ca.val + k * io->Ca.nrow;

        for (int64_t i = 0; i < io->num_outputs; i++) {
            const double re = c[i] - w * w * ca[i], im = w * cv[i];

            if (c[i] == 0.0 && cv[i] == 0.0 && ca[i] == 0.0)
                continue;
            for (int64_t j = 0; j < io->num_inputs; j++)
                H[i * io->num_inputs + j] +=
                    im == 0.0 ? re * X[k + j * n]
                              : ritz_complex(re, im) * X[k + j * n];
        }
    }
}
