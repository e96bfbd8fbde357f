#include "print/checksum.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

enum { TEXT = 3 * RITZ_DIGEST_SIZE + 64 };

static void part(char text[TEXT], const void *bytes, int64_t count, size_t size)
{
    size_t used = strlen(text);
    char sum[RITZ_DIGEST_SIZE];

    ritz_digest_bytes(bytes, (size_t)count * size, sum);
    snprintf(text + used, TEXT - used, " %s", sum);
}

void checksum_sparse(const ritz_sparse *A, char out[RITZ_DIGEST_SIZE])
{
    char text[TEXT];
    int64_t nnz = A->colptr[A->ncol];

    snprintf(text, sizeof text, "%" PRId64 " %" PRId64, A->nrow, A->ncol);
    part(text, A->colptr, A->ncol + 1, sizeof *A->colptr);
    part(text, A->rowind, nnz, sizeof *A->rowind);
    part(text, A->val, nnz, sizeof *A->val);
    ritz_digest_bytes(text, strlen(text), out);
}

void checksum_dense(const ritz_dense *A, char out[RITZ_DIGEST_SIZE])
{
    char text[TEXT];

    snprintf(text, sizeof text, "%" PRId64 " %" PRId64, A->nrow, A->ncol);
    part(text, A->val, A->nrow * A->ncol, sizeof *A->val);
    ritz_digest_bytes(text, strlen(text), out);
}
