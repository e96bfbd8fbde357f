/* The matrices of a reduced component or a state space, by name. */
#include "base/alloc.h"
#include "formats/sink.h"

#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct entry {
    const char *name;
    size_t offset;  /* of the dense matrix in its object */
    bool symmetric; /* if its values are: a gyroscopic D is not */
} entry;

/* Matrices of one kind of object; the table ends in one without a name. */
typedef struct matrix_kind {
    const entry *entry;
    const char *noun;
    const char *all;   /* "K, M and D" */
    const char *usual; /* "K,M,D" */
} matrix_kind;

static const matrix_kind states = {
    .entry =
        (const entry[]){
            {"A", offsetof(ritz_state_space, A), false},
            {"B", offsetof(ritz_state_space, B), false},
            {"C", offsetof(ritz_state_space, C), false},
            {"D", offsetof(ritz_state_space, D), false},
            {"E", offsetof(ritz_state_space, E), false},
            {0},
        },
    .noun = "state space",
    .all = "A, B, C, D and E",
    .usual = "A,B,C,D,E",
};

static const matrix_kind reduced = {
    .entry =
        (const entry[]){
            {"K", offsetof(ritz_reduced, K), true},
            {"M", offsetof(ritz_reduced, M), true},
            {"D", offsetof(ritz_reduced, D), true},
            {"K4", offsetof(ritz_reduced, K4), true},
            {"T", offsetof(ritz_reduced, T), false},
            {"B", offsetof(ritz_reduced, io.B), false},
            {"C", offsetof(ritz_reduced, io.C), false},
            {"Cv", offsetof(ritz_reduced, io.Cv), false},
            {"Ca", offsetof(ritz_reduced, io.Ca), false},
            {0},
        },
    .noun = "reduced component",
    .all = "K, M, D, K4, T, B, C, Cv and Ca",
    .usual = "K,M,D,K4",
};

static const ritz_dense *dense_of(const void *object, const entry *e)
{
    return (const ritz_dense *)(const void *)((const char *)object + e->offset);
}

/* Every entry stored, zeros too. */
static ritz_status fill_matrix(const entry *e, const ritz_dense *A,
                               ritz_matrix *out)
{
    int64_t at = 0;

    RITZ_CHECK(ritz_sparse_new(A->nrow, A->ncol, A->nrow * A->ncol, &out->A));
    for (int64_t j = 0; j < A->ncol; j++) {
        for (int64_t i = 0; i < A->nrow; i++) {
            out->A.rowind[at] = i;
            out->A.val[at++] = ritz_dense_col(A, j)[i];
        }
        out->A.colptr[j + 1] = at;
    }
    snprintf(out->name, sizeof out->name, "%s", e->name);
    out->symmetric = e->symmetric && ritz_dense_asymmetry(A) == 0.0;
    out->digits = 17;
    return RITZ_OK;
}

static const entry *find_entry(const entry *among, const char *name,
                               size_t length)
{
    for (; among->name; among++)
        if (strlen(among->name) == length &&
            strncmp(among->name, name, length) == 0)
            return among;
    return NULL;
}

/* The matrices that `at` lists, with commas between; of usual ones those that
 * the object has. */
static ritz_status list_matrices(const matrix_kind *kind, const void *object,
                                 const char *at, bool asked, ritz_matrices *out)
{
    while (*at) {
        size_t length = strcspn(at, ",");
        const entry *e = find_entry(kind->entry, at, length);
        const ritz_dense *A = NULL;

        RITZ_REFUSE_IF(!e, RITZ_ERR_ARGUMENT,
                       "there is no matrix '%.*s', there are %s", (int)length,
                       at, kind->all);
        for (int64_t k = 0; k < out->count; k++)
            RITZ_REFUSE_IF(strcmp(out->matrix[k].name, e->name) == 0,
                           RITZ_ERR_ARGUMENT, "'%s' is named twice", e->name);
        A = dense_of(object, e);
        RITZ_REFUSE_IF(asked && !A->val, RITZ_ERR_ARGUMENT,
                       "this %s has no '%s'", kind->noun, e->name);
        if (asked || (A->val && A->nrow > 0 && A->ncol > 0)) {
            RITZ_CHECK(fill_matrix(e, A, &out->matrix[out->count]));
            out->count++;
        }
        at += length + (at[length] != '\0');
    }
    return RITZ_OK;
}

ritz_status ritz_export_matrices(const ritz_export_object *object,
                                 const ritz_export_request *request,
                                 const char *usual, ritz_export_report *report,
                                 ritz_matrices *out)
{
    const matrix_kind *kind = object->states ? &states : &reduced;
    const char *names = request->matrices;
    RITZ_OWN(ritz_matrices) list = {0};

    if (!names)
        names = usual ? usual : kind->usual;
    RITZ_CHECK_NEW(list.matrix, (int64_t)strlen(names) + 1);
    RITZ_CHECK(list_matrices(
        kind, object->states ? (const void *)object->states : object->reduced,
        names, request->matrices != NULL, &list));
    for (int64_t k = 0; k < list.count; k++)
        RITZ_CHECK(ritz_export_say(report, "%s  %lld x %lld",
                                   list.matrix[k].name,
                                   (long long)list.matrix[k].A.nrow,
                                   (long long)list.matrix[k].A.ncol));
    RITZ_MOVE(*out, list);
    return RITZ_OK;
}
