/* Quantities that follow from the motion of a model: y = S u. */
#include "base/alloc.h"
#include "base/text.h"

#include <ritz/model.h>

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const ritz_quantity_kinds[] = {
    "stress", "force", "displacement", "acceleration", "other", NULL};

bool ritz_quantity_of_grids(const char *kind)
{
    return strcmp(kind, "displacement") == 0 ||
           strcmp(kind, "acceleration") == 0;
}

const char *ritz_quantity_name(const ritz_quantity *quantity, int64_t row,
                               char text[RITZ_QUANTITY_NAME_SIZE])
{
    const char *part = quantity->part[row];
    int64_t place = quantity->place[row];

    if (place > 0)
        snprintf(text, RITZ_QUANTITY_NAME_SIZE, "%s %" PRId64 "%s%s",
                 ritz_quantity_of_grids(quantity->kind) ? "grid" : "element",
                 place, *part ? " " : "", part);
    else
        snprintf(text, RITZ_QUANTITY_NAME_SIZE, "row %" PRId64 "%s%s", row + 1,
                 *part ? " " : "", part);
    return text;
}

/* Checks for quantities of components and of reduced components alike. */
static ritz_status check_names(int64_t count, const ritz_quantity *quantity,
                               int64_t k)
{
    const ritz_quantity *q = &quantity[k];
    char name[RITZ_NAME_SIZE];
    int known = 0;

    RITZ_REFUSE_IF(ritz_name_copy(q->name, name) != RITZ_OK, RITZ_ERR_FORMAT,
                   "'%.40s' cannot be the name of a quantity", q->name);
    for (int64_t j = 0; j < k && k < count; j++)
        RITZ_REFUSE_IF(strcmp(quantity[j].name, name) == 0, RITZ_ERR_FORMAT,
                       "there are two quantities '%s'", name);
    while (ritz_quantity_kinds[known] &&
           strcmp(ritz_quantity_kinds[known], q->kind) != 0)
        known++;
    RITZ_REFUSE_IF(!ritz_quantity_kinds[known], RITZ_ERR_FORMAT,
                   "'%s' is of kind '%.40s', which is none of stress, force, "
                   "displacement, acceleration and other",
                   name, q->kind);
    RITZ_REFUSE_IF(q->count < 1 || !q->place || !q->part, RITZ_ERR_FORMAT,
                   "'%s' has no rows", name);
    return RITZ_OK;
}

ritz_status ritz_quantities_check(int64_t count, const ritz_quantity *quantity,
                                  int64_t n)
{
    for (int64_t k = 0; k < count; k++) {
        const ritz_quantity *q = &quantity[k];

        RITZ_CHECK(check_names(count, quantity, k));
        RITZ_REFUSE_IF(!q->S.colptr || q->S.nrow != q->count || q->S.ncol != n,
                       RITZ_ERR_FORMAT,
                       "'%s' is %" PRId64 " x %" PRId64 " where %" PRId64
                       " x %" PRId64 " is due",
                       q->name, q->S.nrow, q->S.ncol, q->count, n);
        RITZ_CHECK_IN(q->name, ritz_sparse_check(&q->S, q->S.colptr[n]));
    }
    return RITZ_OK;
}

/* Whether a matrix is absent, or has this size. */
static bool fits(const ritz_dense *A, int64_t rows, int64_t columns)
{
    return !A->val || (A->nrow == rows && A->ncol == columns);
}

ritz_status ritz_quantities_check_reduced(int64_t count,
                                          const ritz_quantity *quantity,
                                          int64_t r, int64_t inputs,
                                          int64_t dampers)
{
    for (int64_t k = 0; k < count; k++) {
        const ritz_quantity *q = &quantity[k];
        const bool corrected = q->Q.val != NULL;

        RITZ_CHECK(check_names(count, quantity, k));
        RITZ_REFUSE_IF(
            !q->ST.val || !fits(&q->ST, q->count, r) ||
                !fits(&q->Q, q->count, r) || !fits(&q->A, q->count, r) ||
                !fits(&q->V, q->count, r) || !fits(&q->F, q->count, inputs) ||
                !fits(&q->H, q->count, dampers),
            RITZ_ERR_FORMAT, "'%s' is of another size than the model", q->name);
        RITZ_REFUSE_IF((q->A.val != NULL) != corrected ||
                           (!corrected && (q->V.val || q->F.val || q->H.val)) ||
                           (corrected && inputs > 0 && !q->F.val) ||
                           (corrected && dampers > 0 && !q->H.val),
                       RITZ_ERR_FORMAT,
                       "'%s' lacks a part of its mode acceleration", q->name);
    }
    return RITZ_OK;
}

/* A T; {0} if there is no A. */
static ritz_status project(const ritz_dense *A, const ritz_dense *T,
                           ritz_dense *out)
{
    return A->val ? ritz_dense_mul(A, T, out) : RITZ_OK;
}

static ritz_status copy_known(const ritz_dense *A, ritz_dense *out)
{
    return A->val ? ritz_dense_copy(A, out) : RITZ_OK;
}

static ritz_status project_one(const ritz_quantity *from, const ritz_dense *T,
                               ritz_quantity *to)
{
    memcpy(to->name, from->name, sizeof to->name);
    memcpy(to->kind, from->kind, sizeof to->kind);
    to->count = from->count;
    RITZ_CHECK_COPY(to->place, from->place, from->count);
    RITZ_CHECK_COPY(to->part, from->part, from->count);
    if (from->S.colptr)
        RITZ_CHECK_IN(from->name, ritz_sparse_mul(&from->S, T, &to->ST));
    else
        RITZ_CHECK_IN(from->name, ritz_dense_mul(&from->ST, T, &to->ST));
    RITZ_CHECK(project(&from->Q, T, &to->Q));
    RITZ_CHECK(project(&from->V, T, &to->V));
    RITZ_CHECK(project(&from->A, T, &to->A));
    RITZ_CHECK(copy_known(&from->F, &to->F));
    return copy_known(&from->H, &to->H);
}

/* Several quantities, freed together until they are handed over. */
RITZ_ARRAY_OF(ritz_quantity);

ritz_status ritz_quantities_project(int64_t count,
                                    const ritz_quantity *quantity,
                                    const ritz_dense *T, ritz_quantity **out)
{
    RITZ_OWN(ritz_quantity_array) made = {.count = count};

    if (count == 0)
        return RITZ_OK;
    RITZ_CHECK_NEW(made.at, count);
    for (int64_t k = 0; k < count; k++)
        RITZ_CHECK_IN("recovery", project_one(&quantity[k], T, &made.at[k]));
    *out = made.at;
    made.at = NULL;
    return RITZ_OK;
}

void ritz_quantity_free(ritz_quantity *quantity)
{
    enum { MATRICES = 6 };
    ritz_dense *const all[MATRICES] = {&quantity->ST, &quantity->Q,
                                       &quantity->A,  &quantity->V,
                                       &quantity->F,  &quantity->H};

    RITZ_FREE(quantity->place, quantity->part);
    ritz_sparse_free(&quantity->S);
    for (int k = 0; k < MATRICES; k++)
        ritz_dense_free(all[k]);
    *quantity = (ritz_quantity){0};
}
