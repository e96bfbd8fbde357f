/*
 * States that answer statically, x2' = 0, are eliminated [LiuAnderson1989]:
 *
 *     0 = A21 x1 + A22 x2 + B2 u
 *
 *     A := A11 - A12 A22^-1 A21,   B := B1 - A12 A22^-1 B2,
 *     C := C1 - C2 A22^-1 A21,     D := D - C2 A22^-1 B2
 *
 * so that the answer at 0 Hz is what it was. Of balanced states the bound of a
 * truncation holds for them too. All four are one Schur complement of
 * G = [A B; C D].
 */
#include "base/alloc.h"
#include "linear/general.h"
#include "model/state_reduce.h"

#include <math.h>
#include <stdlib.h>

static void copy(const ritz_dense *from, int64_t row, int64_t col,
                 ritz_dense *G)
{
    for (int64_t j = 0; j < from->ncol; j++)
        for (int64_t i = 0; i < from->nrow; i++)
            ritz_dense_col(G, col + j)[row + i] = ritz_dense_col(from, j)[i];
}

/* A becomes rows row.. and columns col.. of G. */
static void paste(const ritz_dense *G, int64_t row, int64_t col, ritz_dense *A)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < A->nrow; i++)
            ritz_dense_col(A, j)[i] = ritz_dense_col(G, col + j)[row + i];
}

static ritz_status join(const ritz_state_space *model, ritz_dense *out)
{
    int64_t n = model->A.nrow;

    RITZ_CHECK(
        ritz_dense_new(n + model->num_outputs, n + model->num_inputs, out));
    copy(&model->A, 0, 0, out);
    copy(&model->B, 0, n, out);
    copy(&model->C, n, 0, out);
    copy(&model->D, n, n, out);
    return RITZ_OK;
}

/* Numbers below @p count of those that stay: states, and all that follow. */
static ritz_status choose(const ritz_columns *columns, int64_t count,
                          bool perturbed, int64_t *kept, int64_t **out)
{
    int64_t *at = NULL;
    int64_t next = 0;

    RITZ_CHECK_NEW(at, count);
    for (int64_t k = 0; k < count; k++) {
        bool is =
            k < columns->count && columns->kind[k] == RITZ_COLUMN_PERTURBED;

        if (is == perturbed)
            at[next++] = k;
    }
    *kept = next;
    *out = at;
    return RITZ_OK;
}

/* Rows and columns of G. */
static ritz_status pick(const ritz_dense *G, int64_t nrow, const int64_t *rows,
                        int64_t ncol, const int64_t *cols, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(nrow, ncol, out));
    for (int64_t j = 0; j < ncol; j++)
        for (int64_t i = 0; i < nrow; i++)
            ritz_dense_col(out, j)[i] = ritz_dense_col(G, cols[j])[rows[i]];
    return RITZ_OK;
}

/* G11 - G12 G22^-1 G21, with the states of kind perturbed second. */
static ritz_status eliminate(const ritz_state_space *model,
                             const ritz_columns *columns, ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense G = {0}, G12 = {0}, G21 = {0}, G22 = {0}, change = {0};
    int64_t *rows = NULL, *cols = NULL, *rest = NULL;
    int64_t nrow = 0, ncol = 0, count = 0;

    RITZ_TRY(join(model, &G));
    RITZ_TRY(choose(columns, G.nrow, false, &nrow, &rows));
    RITZ_TRY(choose(columns, G.ncol, false, &ncol, &cols));
    RITZ_TRY(choose(columns, columns->count, true, &count, &rest));
    RITZ_TRY(pick(&G, nrow, rows, ncol, cols, out));
    RITZ_TRY(pick(&G, nrow, rows, count, rest, &G12));
    RITZ_TRY(pick(&G, count, rest, ncol, cols, &G21));
    RITZ_TRY(pick(&G, count, rest, count, rest, &G22));
    status = ritz_general_solve(&G22, false, &G21);
    RITZ_FAIL_IF(status == RITZ_ERR_SINGULAR, RITZ_ERR_SINGULAR,
                 "the remainder has no static answer: a motion that nothing "
                 "holds is among its states");
    RITZ_TRY(status);
    RITZ_TRY(ritz_dense_mul(&G12, &G21, &change));
    for (int64_t k = 0; k < change.nrow * change.ncol; k++)
        out->val[k] -= change.val[k];
done:
    ritz_dense_free(&G);
    ritz_dense_free(&G12);
    ritz_dense_free(&G21);
    ritz_dense_free(&G22);
    ritz_dense_free(&change);
    free(rows);
    free(cols);
    free(rest);
    return status;
}

/* Of states that stay what the columns say. */
static ritz_status keep_columns(const ritz_columns *columns, int64_t kept,
                                ritz_columns *out)
{
    ritz_columns stay = {0};
    int64_t next = 0;

    RITZ_CHECK(ritz_columns_new(kept, &stay));
    for (int64_t k = 0; k < columns->count; k++) {
        if (columns->kind[k] == RITZ_COLUMN_PERTURBED)
            continue;
        stay.kind[next] = columns->kind[k];
        stay.dof[next] = columns->dof[k];
        stay.hertz[next] = columns->hertz[k];
        stay.residual[next++] = columns->residual[k];
    }
    ritz_columns_free(out);
    *out = stay;
    return RITZ_OK;
}

static ritz_status perturb(const ritz_columns *columns, ritz_state_space *model)
{
    ritz_status status = RITZ_OK;
    ritz_dense G = {0};
    int64_t r = 0;

    RITZ_TRY(eliminate(model, columns, &G));
    r = G.nrow - model->num_outputs;
    ritz_dense_free(&model->A);
    ritz_dense_free(&model->B);
    ritz_dense_free(&model->C);
    RITZ_TRY(ritz_dense_new(r, r, &model->A));
    RITZ_TRY(ritz_dense_new(r, model->num_inputs, &model->B));
    RITZ_TRY(ritz_dense_new(model->num_outputs, r, &model->C));
    paste(&G, 0, 0, &model->A);
    paste(&G, 0, r, &model->B);
    paste(&G, r, 0, &model->C);
    paste(&G, r, r, &model->D);
    RITZ_TRY(keep_columns(columns, r, &model->columns));
done:
    ritz_dense_free(&G);
    return status;
}

static ritz_status note_bound(const ritz_basis *basis, ritz_state_space *model)
{
    bool limited = false;

    if (basis->num_hankel == 0 || isnan(basis->bound))
        return RITZ_OK;
    for (int64_t k = 0; k < model->num_outputs; k++)
        limited = limited || !isnan(model->limit[k]);
    return ritz_measures_add(&model->estimates, "h-infinity-bound",
                             basis->bound, nan(""),
                             limited ? "outputs over their limits" : NULL);
}

ritz_status ritz_states_settle(const ritz_basis *basis, const ritz_dense *E,
                               ritz_state_space *model)
{
    bool whole = true;

    RITZ_CHECK_IN("left against right vectors",
                  ritz_general_solve(E, false, &model->A));
    RITZ_CHECK(ritz_general_solve(E, false, &model->B));
    for (int64_t k = 0; k < basis->columns.count; k++)
        whole = whole && basis->columns.kind[k] != RITZ_COLUMN_PERTURBED;
    if (whole) {
        ritz_columns_free(&model->columns);
        RITZ_CHECK(ritz_columns_copy(&basis->columns, &model->columns));
    } else {
        RITZ_CHECK(perturb(&basis->columns, model));
    }
    RITZ_CHECK(note_bound(basis, model));
    model->origin = basis->origin;
    return RITZ_OK;
}
