#include "print/checksum.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

enum { TEXT = 3 * RITZ_DIGEST_SIZE + 64 };

static void add_part(char text[TEXT], const void *bytes, int64_t count,
                     size_t size)
{
    char sum[RITZ_DIGEST_SIZE];

    ritz_digest_bytes(bytes, (size_t)count * size, sum);
    sink_append(text, TEXT, " %s", sum);
}

void checksum_sparse(const ritz_sparse *A, char out[RITZ_DIGEST_SIZE])
{
    char text[TEXT];
    int64_t nnz = A->colptr[A->ncol];

    snprintf(text, sizeof text, "%" PRId64 " %" PRId64, A->nrow, A->ncol);
    add_part(text, A->colptr, A->ncol + 1, sizeof *A->colptr);
    add_part(text, A->rowind, nnz, sizeof *A->rowind);
    add_part(text, A->val, nnz, sizeof *A->val);
    ritz_digest_bytes(text, strlen(text), out);
}

void checksum_dense(const ritz_dense *A, char out[RITZ_DIGEST_SIZE])
{
    char text[TEXT];

    snprintf(text, sizeof text, "%" PRId64 " %" PRId64, A->nrow, A->ncol);
    add_part(text, A->val, A->nrow * A->ncol, sizeof *A->val);
    ritz_digest_bytes(text, strlen(text), out);
}

void checksum_set(cli_run *run, const char *name, const char *sum)
{
    sink_object(run, "checksums");
    json_object_set_new(sink_here(run), name, cli_string(sum));
    sink_end(run);
}
