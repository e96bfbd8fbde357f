/*
 * SHA-256 of a matrix, whatever file it lies in: of the text that joins the
 * sums of its parts,
 *
 *     sparse  "NROW NCOL COLPTR ROWIND VAL"    dense  "NROW NCOL VAL"
 *
 * NROW and NCOL in decimal, the others SHA-256 in hexadecimal of the array's
 * little-endian bytes (i64, i64, f64).
 */
#ifndef RITZ_TOOLS_PRINT_CHECKSUM_H
#define RITZ_TOOLS_PRINT_CHECKSUM_H

#include "cli/sink.h"

void checksum_sparse(const ritz_sparse *A, char out[RITZ_DIGEST_SIZE]);
void checksum_dense(const ritz_dense *A, char out[RITZ_DIGEST_SIZE]);

/** The sum of that name among the checksums; it may have commas, by which
 * sink.h would cut it. */
void checksum_set(cli_run *run, const char *name, const char *sum);

#endif
