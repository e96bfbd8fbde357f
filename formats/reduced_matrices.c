#include "formats/reduced_matrices.h"

#include "base/alloc.h"

#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct entry {
    const char *name;
    size_t offset; /* of the dense matrix in ritz_reduced */
    bool symmetric;
} entry;

static const entry entries[] = {
    {"K", offsetof(ritz_reduced, K), true},
    {"M", offsetof(ritz_reduced, M), true},
    {"D", offsetof(ritz_reduced, D), true},
    {"T", offsetof(ritz_reduced, T), false},
    {"B", offsetof(ritz_reduced, io.B), false},
    {"C", offsetof(ritz_reduced, io.C), false},
    {"Cv", offsetof(ritz_reduced, io.Cv), false},
    {"Ca", offsetof(ritz_reduced, io.Ca), false},
};

enum { COUNT = sizeof entries / sizeof *entries };

static const ritz_dense *dense_of(const ritz_reduced *reduced, const entry *e)
{
    return (const ritz_dense *)(const void *)((const char *)reduced +
                                              e->offset);
}

/* Every entry stored, zeros too. */
static ritz_status fill(const entry *e, const ritz_dense *A, ritz_matrix *out)
{
    ritz_status status = RITZ_OK;
    int64_t at = 0;

    RITZ_TRY(ritz_sparse_new(A->nrow, A->ncol, A->nrow * A->ncol, &out->A));
    for (int64_t j = 0; j < A->ncol; j++) {
        for (int64_t i = 0; i < A->nrow; i++) {
            out->A.rowind[at] = i;
            out->A.val[at++] = ritz_dense_col(A, j)[i];
        }
        out->A.colptr[j + 1] = at;
    }
    snprintf(out->name, sizeof out->name, "%s", e->name);
    out->symmetric = e->symmetric;
    out->digits = 17;
done:
    return status;
}

static const entry *find(const char *name, size_t length)
{
    for (int k = 0; k < COUNT; k++)
        if (strlen(entries[k].name) == length &&
            strncmp(entries[k].name, name, length) == 0)
            return &entries[k];
    return NULL;
}

ritz_status ritz_reduced_matrices(const ritz_reduced *reduced,
                                  const char *names, ritz_matrices *out)
{
    ritz_status status = RITZ_OK;
    ritz_matrices list = {0};
    const char *at = names ? names : reduced->D.val ? "K,M,D" : "K,M";

    RITZ_NEW(list.matrix, (int64_t)strlen(at) + 1);
    while (*at) {
        size_t length = strcspn(at, ",");
        const entry *e = find(at, length);

        RITZ_FAIL_IF(!e, RITZ_ERR_ARGUMENT,
                     "there is no matrix '%.*s', there are K, M, D, T, B, C, "
                     "Cv and Ca",
                     (int)length, at);
        for (int64_t k = 0; k < list.count; k++)
            RITZ_FAIL_IF(strcmp(list.matrix[k].name, e->name) == 0,
                         RITZ_ERR_ARGUMENT, "'%s' is named twice", e->name);
        RITZ_FAIL_IF(!dense_of(reduced, e)->val, RITZ_ERR_ARGUMENT,
                     "this reduced component has no '%s'", e->name);
        RITZ_TRY(fill(e, dense_of(reduced, e), &list.matrix[list.count]));
        list.count++;
        at += length + (at[length] != '\0');
    }
    *out = list;
    list = (ritz_matrices){0};
done:
    ritz_matrices_free(&list);
    return status;
}
