/*
 * A component in modal form, without geometry. Its dofs are modes of unit modal
 * mass, at scalar points 1, 2, ...:
 *
 *     q_k'' + 2 zeta_k omega_k q_k' + omega_k^2 q_k = b_k f,
 *     y = sum_k c_k q_k + cv_k q_k' + ca_k q_k''
 *
 * so that K = diag(omega^2), M = I and D = diag(2 zeta omega).
 */
#include "import/import.h"

#include "base/alloc.h"
#include "base/text.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The numbers of a file with one row or one column. */
typedef struct vector {
    int64_t count;
    double *at;
} vector;

static void vector_free(vector *v)
{
    free(v->at);
}

static ritz_status take_vector(const ritz_part *part, vector *out)
{
    const ritz_sparse *A = &part->matrix.A;

    RITZ_REFUSE_IF(part->matrix.imaginary, RITZ_ERR_FORMAT,
                   "%s: '%s' is complex, real numbers are due", part->what,
                   part->spec);
    RITZ_REFUSE_IF((A->nrow != 1 && A->ncol != 1) || A->nrow * A->ncol == 0,
                   RITZ_ERR_FORMAT,
                   "'%s' is %" PRId64 " x %" PRId64
                   ", one row or one column is due",
                   part->spec, A->nrow, A->ncol);
    out->count = A->nrow * A->ncol;
    RITZ_CHECK_NEW(out->at, out->count);
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            out->at[A->rowind[p] + j] += A->val[p];
    return RITZ_OK;
}

/* Make the matrix of a part diag(value). Its number of digits stays unknown,
 * because rounding spoils no differences in a diagonal stiffness. */
static ritz_status make_diagonal(const vector *value, ritz_part *part)
{
    int64_t n = value->count;
    RITZ_OWN_ARRAY int64_t *at = NULL;
    RITZ_OWN(ritz_sparse) A = {0};

    RITZ_CHECK_NEW(at, n);
    for (int64_t k = 0; k < n; k++)
        at[k] = k;
    RITZ_CHECK(ritz_sparse_from_triplets(n, n, n, at, at, value->at, &A));
    ritz_matrix_free(&part->matrix);
    RITZ_MOVE(part->matrix.A, A);
    part->matrix.symmetric = true;
    return RITZ_OK;
}

/* Convert frequencies to lambda = omega^2  [rad^2/s^2]. */
static ritz_status take_lambda(const ritz_part *part, vector *lambda)
{
    RITZ_CHECK(take_vector(part, lambda));
    for (int64_t k = 0; k < lambda->count; k++) {
        RITZ_REFUSE_IF(
            !(lambda->at[k] >= 0.0) || isinf(lambda->at[k]), RITZ_ERR_FORMAT,
            "frequencies: '%s': each is finite and not negative, '%g' is "
            "not",
            part->spec, lambda->at[k]);
        lambda->at[k] = ritz_eigen_lambda(lambda->at[k]);
    }
    return RITZ_OK;
}

/* Read zeta_k; a single number is the ratio of all modes. */
static ritz_status take_ratios(const char *text, const ritz_part *part,
                               int64_t count, vector *zeta)
{
    double all = 0.0;

    if (part) {
        RITZ_CHECK(take_vector(part, zeta));
        RITZ_REFUSE_IF(
            zeta->count != count && zeta->count != 1, RITZ_ERR_FORMAT,
            "ratios: '%s' has %" PRId64 " for %" PRId64 " frequencies", text,
            zeta->count, count);
        all = zeta->at[0];
    } else {
        RITZ_REFUSE_IF(!ritz_text_real(text, &all), RITZ_ERR_ARGUMENT,
                       "ratios: '%s' is no number", text);
    }
    if (zeta->count != count) {
        vector_free(zeta);
        *zeta = (vector){.count = count};
        RITZ_CHECK_NEW(zeta->at, count);
        for (int64_t k = 0; k < count; k++)
            zeta->at[k] = all;
    }
    for (int64_t k = 0; k < count; k++)
        RITZ_REFUSE_IF(!(zeta->at[k] >= 0.0 && zeta->at[k] < 1.0),
                       RITZ_ERR_FORMAT,
                       "ratios: '%s': each is 0 or more and below 1, '%g' "
                       "is not",
                       text, zeta->at[k]);
    return RITZ_OK;
}

/* Append a part. */
static ritz_part *next_part(const char *spec, const char *what,
                            ritz_sparse *becomes, ritz_parts *parts)
{
    ritz_part *part = &parts->part[parts->count++];

    *part = (ritz_part){.spec = spec, .what = what, .becomes = becomes};
    return part;
}

ritz_status ritz_modal_want(const ritz_import_request *request,
                            ritz_component *component, ritz_parts *parts)
{
    double number = 0.0;

    RITZ_REFUSE_IF(request->stiffness || request->mass || request->damping ||
                       request->structural_damping || request->num_loads > 0 ||
                       request->bulk || request->dofs || request->rows,
                   RITZ_ERR_ARGUMENT,
                   "frequencies make a whole component: neither its matrices "
                   "nor a deck, nor names of rows go with them");
    RITZ_CHECK_NEW(parts->part, 3);
    next_part(request->frequencies, "frequencies", &component->K, parts);
    if (request->ratios && !ritz_text_real(request->ratios, &number))
        next_part(request->ratios, "ratios", &component->D, parts);
    return RITZ_OK;
}

ritz_status ritz_modal_make(const ritz_import_request *request,
                            ritz_component *component, ritz_parts *parts)
{
    const ritz_part *ratios = parts->count > 1 ? &parts->part[1] : NULL;
    RITZ_OWN(vector) value = {0}, lambda = {0}, zeta = {0};

    RITZ_CHECK(take_lambda(&parts->part[0], &lambda));
    value.count = lambda.count;
    RITZ_CHECK_NEW(value.at, lambda.count);
    RITZ_CHECK(make_diagonal(&lambda, &parts->part[0]));
    if (request->ratios) {
        RITZ_CHECK(take_ratios(request->ratios, ratios, lambda.count, &zeta));
        if (parts->count == 1)
            next_part(request->ratios, "ratios", &component->D, parts);
        for (int64_t k = 0; k < lambda.count; k++)
            value.at[k] = 2.0 * zeta.at[k] * sqrt(lambda.at[k]);
        RITZ_CHECK(make_diagonal(&value, &parts->part[1]));
    }
    for (int64_t k = 0; k < lambda.count; k++)
        value.at[k] = 1.0;
    return make_diagonal(&value, next_part(request->frequencies, "modal mass",
                                           &component->M, parts));
}
