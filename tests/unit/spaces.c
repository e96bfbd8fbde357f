#include "spaces.h"

#include "testing.h"

#include "linear/general.h"

#include <ritz/foreign.h>

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { PATH_SIZE = 1024 };

static void put(const double *rows, ritz_dense *A)
{
    for (int64_t i = 0; i < A->nrow; i++)
        for (int64_t j = 0; j < A->ncol; j++)
            ritz_dense_col(A, j)[i] = rows[i * A->ncol + j];
}

static void name_all(ritz_io *io)
{
    for (int64_t j = 0; j < io->num_inputs; j++)
        snprintf(io->input[j], RITZ_NAME_SIZE, "u%d", (int)j + 1);
    for (int64_t i = 0; i < io->num_outputs; i++)
        snprintf(io->output[i], RITZ_NAME_SIZE, "y%d", (int)i + 1);
}

static ritz_status empty(int64_t states, int64_t inputs, int64_t outputs,
                         ritz_state_space *out)
{
    ritz_status status = RITZ_OK;
    ritz_io io = {0};

    RITZ_TRY(ritz_io_new(states, inputs, outputs, &io));
    name_all(&io);
    RITZ_TRY(ritz_state_space_new(states, &io, out));
done:
    ritz_io_free(&io);
    return status;
}

ritz_status spaces_make(const spaces_rows *rows, ritz_state_space *out)
{
    ritz_status status = RITZ_OK;

    RITZ_TRY(empty(rows->states, rows->inputs, rows->outputs, out));
    put(rows->A, &out->A);
    put(rows->B, &out->B);
    put(rows->C, &out->C);
    if (rows->D)
        put(rows->D, &out->D);
    if (rows->E) {
        RITZ_TRY(ritz_dense_new(rows->states, rows->states, &out->E));
        put(rows->E, &out->E);
    }
done:
    return status;
}

ritz_status spaces_project(const ritz_state_space *model, const ritz_dense *W,
                           const ritz_dense *T, ritz_state_space *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense ET = {0}, AT = {0}, WET = {0};

    RITZ_TRY(empty(T->ncol, model->num_inputs, model->num_outputs, out));
    ritz_dense_free(&out->A);
    ritz_dense_free(&out->B);
    ritz_dense_free(&out->C);
    RITZ_TRY(ritz_dense_mul(&model->A, T, &AT));
    RITZ_TRY(ritz_dense_mul_tn(W, &AT, &out->A));
    RITZ_TRY(ritz_dense_mul_tn(W, &model->B, &out->B));
    RITZ_TRY(ritz_dense_mul(&model->C, T, &out->C));
    if (model->E.val)
        RITZ_TRY(ritz_dense_mul(&model->E, T, &ET));
    RITZ_TRY(ritz_dense_mul_tn(W, model->E.val ? &ET : T, &WET));
    RITZ_TRY(ritz_general_solve(&WET, false, &out->A));
    RITZ_TRY(ritz_general_solve(&WET, false, &out->B));
    for (int64_t k = 0; k < out->D.nrow * out->D.ncol; k++)
        out->D.val[k] = model->D.val[k];
done:
    ritz_dense_free(&ET);
    ritz_dense_free(&AT);
    ritz_dense_free(&WET);
    return status;
}

static void path_of(const char *name, const char *file, char path[PATH_SIZE])
{
    const char *folder = getenv("RITZ_EXTERNAL_DATA");

    snprintf(path, PATH_SIZE, "%s/state_space/%s/%s", folder ? folder : "",
             name, file);
}

static void read_dense(const char *name, const char *file, ritz_dense *out)
{
    char path[PATH_SIZE];
    ritz_matrix matrix = {0};

    path_of(name, file, path);
    assert_ok(ritz_foreign_select(path, &matrix));
    assert_ok(ritz_dense_new(matrix.A.nrow, matrix.A.ncol, out));
    for (int64_t j = 0; j < matrix.A.ncol; j++)
        for (int64_t k = matrix.A.colptr[j]; k < matrix.A.colptr[j + 1]; k++)
            ritz_dense_col(out, j)[matrix.A.rowind[k]] = matrix.A.val[k];
    ritz_matrix_free(&matrix);
}

bool spaces_read(const char *name, ritz_state_space *out)
{
    char path[PATH_SIZE];
    ritz_dense A = {0}, B = {0}, C = {0};

    path_of(name, "A.mtx", path);
    if (access(path, R_OK) != 0) {
        printf("skipped: no external data '%s'\n", path);
        return false;
    }
    read_dense(name, "A.mtx", &A);
    read_dense(name, "B.mtx", &B);
    read_dense(name, "C.mtx", &C);
    assert_ok(empty(A.nrow, B.ncol, C.nrow, out));
    ritz_dense_free(&out->A);
    ritz_dense_free(&out->B);
    ritz_dense_free(&out->C);
    out->A = A;
    out->B = B;
    out->C = C;
    path_of(name, "E.mtx", path);
    if (access(path, R_OK) == 0)
        read_dense(name, "E.mtx", &out->E);
    return true;
}

int64_t spaces_numbers(const char *name, const char *file, double **out)
{
    char path[PATH_SIZE], line[64];
    FILE *text = NULL;
    int64_t count = 0;

    path_of(name, file, path);
    text = fopen(path, "r");
    assert_non_null(text);
    while (fgets(line, sizeof line, text))
        count++;
    rewind(text);
    *out = calloc((size_t)count + 1, sizeof **out);
    assert_non_null(*out);
    for (int64_t k = 0; k < count && fgets(line, sizeof line, text); k++)
        (*out)[k] = strtod(line, NULL);
    fclose(text);
    return count;
}
