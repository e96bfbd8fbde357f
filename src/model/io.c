#include "base/alloc.h"

#include <ritz/io.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

ritz_status ritz_io_new(int64_t n, int64_t num_inputs, int64_t num_outputs,
                        ritz_io *out)
{
    ritz_status status = RITZ_OK;
    ritz_io io = {.num_inputs = num_inputs, .num_outputs = num_outputs};

    RITZ_NEW(io.input, num_inputs);
    RITZ_NEW(io.output, num_outputs);
    RITZ_NEW(io.limit, num_outputs);
    for (int64_t k = 0; k < num_outputs; k++)
        io.limit[k] = nan("");
    RITZ_TRY(ritz_dense_new(n, num_inputs, &io.B));
    RITZ_TRY(ritz_dense_new(num_outputs, n, &io.C));
    RITZ_TRY(ritz_dense_new(num_outputs, n, &io.Cv));
    RITZ_TRY(ritz_dense_new(num_outputs, n, &io.Ca));
    *out = io;
    io = (ritz_io){0};
done:
    ritz_io_free(&io);
    return status;
}

/* Names and limits of `from`, starting at some input and output of `to`. */
static void label(const ritz_io *from, ritz_io *to, int64_t first_input,
                  int64_t first_output)
{
    for (int64_t k = 0; k < from->num_inputs; k++)
        memcpy(to->input[first_input + k], from->input[k], RITZ_NAME_SIZE);
    for (int64_t k = 0; k < from->num_outputs; k++) {
        memcpy(to->output[first_output + k], from->output[k], RITZ_NAME_SIZE);
        to->limit[first_output + k] = from->limit[k];
    }
}

ritz_status ritz_io_project(const ritz_io *io, const ritz_dense *T,
                            ritz_io *out)
{
    ritz_status status = RITZ_OK;
    ritz_io part = {0};

    RITZ_TRY(ritz_io_new(0, io->num_inputs, io->num_outputs, &part));
    label(io, &part, 0, 0);
    ritz_dense_free(&part.B);
    ritz_dense_free(&part.C);
    ritz_dense_free(&part.Cv);
    ritz_dense_free(&part.Ca);
    RITZ_TRY_IN("inputs", ritz_dense_mul_tn(T, &io->B, &part.B));
    RITZ_TRY_IN("outputs", ritz_dense_mul(&io->C, T, &part.C));
    RITZ_TRY_IN("outputs", ritz_dense_mul(&io->Cv, T, &part.Cv));
    RITZ_TRY_IN("outputs", ritz_dense_mul(&io->Ca, T, &part.Ca));
    *out = part;
    part = (ritz_io){0};
done:
    ritz_io_free(&part);
    return status;
}

/* Put `part` into `whole` with its corner at (row, col). */
static void place(const ritz_dense *part, int64_t row, int64_t col,
                  ritz_dense *whole)
{
    for (int64_t j = 0; j < part->ncol; j++)
        for (int64_t i = 0; i < part->nrow; i++)
            ritz_dense_col(whole, col + j)[row + i] =
                ritz_dense_col(part, j)[i];
}

ritz_status ritz_io_join(const ritz_io *a, const ritz_io *b, ritz_io *out)
{
    ritz_status status = RITZ_OK;
    ritz_io both = {0};
    const ritz_io *const parts[] = {a, b};
    int64_t n = 0;
    int64_t p = 0;
    int64_t m = 0;

    RITZ_TRY(ritz_io_new(a->B.nrow + b->B.nrow, a->num_inputs + b->num_inputs,
                         a->num_outputs + b->num_outputs, &both));
    for (int k = 0; k < 2; k++) {
        const ritz_io *part = parts[k];

        label(part, &both, m, p);
        place(&part->B, n, m, &both.B);
        place(&part->C, p, n, &both.C);
        place(&part->Cv, p, n, &both.Cv);
        place(&part->Ca, p, n, &both.Ca);
        n += part->B.nrow;
        m += part->num_inputs;
        p += part->num_outputs;
    }
    *out = both;
    both = (ritz_io){0};
done:
    ritz_io_free(&both);
    return status;
}

void ritz_io_free(ritz_io *io)
{
    free(io->input);
    free(io->output);
    free(io->limit);
    ritz_dense_free(&io->B);
    ritz_dense_free(&io->C);
    ritz_dense_free(&io->Cv);
    ritz_dense_free(&io->Ca);
    *io = (ritz_io){0};
}
