/*
 * Matrix Market files are written with 17 digits, so that reading them gives
 * the same bits. A matrix is written as symmetric, its lower triangle only, if
 * it is marked so and both triangles agree in every bit; otherwise both are
 * written, because a reader could not restore the difference. A matrix all of
 * whose entries are stored is written as an array.
 */
#include "base/alloc.h"
#include "base/search.h"
#include "formats/certificate.h"
#include "formats/matrix.h"
#include "formats/sink.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

typedef struct market_job {
    const ritz_matrix *matrix;
    const char *comment;
} market_job;

/* Index of A(i,j) in A->val; -1 if it is not stored. */
static int64_t find_entry(const ritz_sparse *A, int64_t i, int64_t j)
{
    int64_t p = A->colptr[j];
    int64_t k = ritz_search(A->colptr[j + 1] - p, A->rowind + p, i);

    return k < 0 ? -1 : p + k;
}

/* Whether for each stored A(i,j) an equal A(j,i) is stored. */
static bool is_mirrored(const ritz_matrix *m)
{
    for (int64_t j = 0; j < m->A.ncol; j++)
        for (int64_t p = m->A.colptr[j]; p < m->A.colptr[j + 1]; p++) {
            int64_t q = find_entry(&m->A, j, m->A.rowind[p]);

            if (q < 0 || m->A.val[p] != m->A.val[q] ||
                (m->imaginary && m->imaginary[p] != m->imaginary[q]))
                return false;
        }
    return true;
}

static ritz_status write_market(FILE *file, const void *what)
{
    const market_job *all = what;
    const ritz_matrix *m = all->matrix;
    const ritz_sparse *A = &m->A;
    int64_t nnz = A->colptr[A->ncol];
    bool symmetric =
        m->symmetric && A->nrow == A->ncol && nnz > 0 && is_mirrored(m);
    bool array = A->ncol > 0 && nnz % A->ncol == 0 && nnz / A->ncol == A->nrow;
    int64_t count = 0;

    RITZ_CHECK(ritz_sink_check(m));
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            count += !symmetric || A->rowind[p] >= j;
    fprintf(file, "%%%%MatrixMarket matrix %s %s %s\n",
            array ? "array" : "coordinate", m->imaginary ? "complex" : "real",
            symmetric ? "symmetric" : "general");
    ritz_comment_put(file, "% ", 0, all->comment ? all->comment : "");
    fprintf(file, "%" PRId64 " %" PRId64, A->nrow, A->ncol);
    if (!array)
        fprintf(file, " %" PRId64, count);
    fputc('\n', file);
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            if (symmetric && A->rowind[p] < j)
                continue;
            if (!array)
                fprintf(file, "%" PRId64 " %" PRId64 " ", A->rowind[p] + 1,
                        j + 1);
            fprintf(file, "%.16e", A->val[p]);
            if (m->imaginary)
                fprintf(file, " %.16e", m->imaginary[p]);
            fputc('\n', file);
        }
    return RITZ_OK;
}

ritz_status ritz_matrix_market_write(const char *path,
                                     const ritz_matrix *matrix,
                                     const char *comment)
{
    market_job all = {matrix, comment};

    return ritz_sink_write(path, write_market, &all);
}

/*
 * Export of a reduced component or a state space: each matrix is written to its
 * own file. The '%' in the output's name stands for the name of the matrix:
 * "small-%.mtx" gives small-A.mtx, small-B.mtx, ...
 */

/* The name of the output, with its '%' replaced by the name of the matrix. */
static ritz_status name_file(const char *output, const char *name, char **out)
{
    int64_t room = (int64_t)(strlen(output) + strlen(name)) + 1;
    const char *mark = strchr(output, '%');
    char *path = NULL;

    RITZ_CHECK_NEW(path, room);
    if (mark)
        snprintf(path, (size_t)room, "%.*s%s%s", (int)(mark - output), output,
                 name, mark + 1);
    else
        snprintf(path, (size_t)room, "%s", output);
    *out = path;
    return RITZ_OK;
}

/* Make the comment: "matrix K", then the certificate. */
static ritz_status join_comment(const char *name, const char *certificate,
                                char **out)
{
    const int64_t room = (int64_t)(strlen(name) + strlen(certificate)) + 10;

    RITZ_CHECK_NEW(*out, room);
    snprintf(*out, (size_t)room, "matrix %s\n%s", name, certificate);
    return RITZ_OK;
}

/* If the output's name has a '%', each matrix is written to a file of its own,
   with the name of the matrix in place of the '%'. Otherwise one matrix is
   written: the one that --matrix names, else K, or A of a state space. */
static ritz_status write_matrices(const ritz_export_object *object,
                                  const ritz_export_request *request,
                                  ritz_export_report *report)
{
    bool pattern = strchr(request->output, '%') != NULL;
    const char *one = object->states ? "A" : "K";
    RITZ_OWN_ARRAY char *certificate = NULL;
    RITZ_OWN(ritz_matrices) list = {0};

    RITZ_CHECK(ritz_export_damped(object, request, pattern ? NULL : one, report,
                                  &list));
    RITZ_REFUSE_IF(list.count != 1 && !pattern, RITZ_ERR_ARGUMENT,
                   "a Matrix Market file holds one matrix: name it with "
                   "--matrix, or write '%%' for it in the output's name");
    RITZ_CHECK(ritz_export_say_rest(object, request, &list, report));
    RITZ_CHECK(ritz_export_say(report, "17 digits, which keep every bit; the "
                                       "file has no place for names and "
                                       "inertia"));
    RITZ_CHECK(ritz_certificate(object, request->stamp, &certificate));
    for (int64_t k = 0; k < list.count; k++) {
        const char *name = list.matrix[k].name;
        RITZ_OWN_ARRAY char *path = NULL, *comment = NULL;

        RITZ_CHECK(join_comment(name, certificate, &comment));
        RITZ_CHECK(name_file(request->output, name, &path));
        RITZ_CHECK(ritz_matrix_market_write(path, &list.matrix[k], comment));
    }
    return RITZ_OK;
}

const ritz_exporter ritz_exporter_matrix_market = {
    .name = "matrix-market",
    .summary = "Matrix Market text: one matrix, or -o NAME-%.mtx for all",
    .reference = "BoisvertPozoRemington1996",
    .kind = "reduced",
    .takes = RITZ_EXPORT_REDUCED | RITZ_EXPORT_STATES | RITZ_EXPORT_MATRICES |
             RITZ_EXPORT_LOADS,
    .write = write_matrices,
};
