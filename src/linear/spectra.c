#include "linear/spectra.h"

#include "base/alloc.h"

#include <stdlib.h>
#include <string.h>

/* Pencils that LAPACK always solves, of at most 600 dofs, are stored, so that a full store takes
   a few dozen megabytes. */
enum { MOST_PENCILS = 8 };

typedef struct stored_spectrum {
    ritz_sparse K, M;
    ritz_pairs pairs;
} stored_spectrum;

struct ritz_spectra {
    int64_t count;
    stored_spectrum item[MOST_PENCILS]; /* the oldest first */
};

static _Thread_local ritz_spectra *lent;

static void stored_spectrum_free(stored_spectrum *s)
{
    ritz_sparse_free(&s->K);
    ritz_sparse_free(&s->M);
    ritz_pairs_free(&s->pairs);
}

ritz_status ritz_spectra_new(ritz_spectra **out)
{
    RITZ_CHECK_NEW(*out, 1);
    return RITZ_OK;
}

void ritz_spectra_free(ritz_spectra **spectra)
{
    if (!*spectra)
        return;
    for (int64_t k = 0; k < (*spectra)->count; k++)
        stored_spectrum_free(&(*spectra)->item[k]);
    free(*spectra);
    *spectra = NULL;
}

int64_t ritz_spectra_count(const ritz_spectra *spectra)
{
    return spectra->count;
}

ritz_spectra_lent ritz_spectra_lend(ritz_spectra *spectra)
{
    const ritz_spectra_lent scope = {lent};

    lent = spectra;
    return scope;
}

void ritz_spectra_lent_free(ritz_spectra_lent *scope)
{
    lent = scope->before;
}

bool ritz_spectra_are_lent(void)
{
    return lent;
}

/* Whether two matrices have the same entries, bit by bit, in the same order. */
static bool are_equal(const ritz_sparse *A, const ritz_sparse *B)
{
    const size_t columns = (size_t)(A->ncol + 1) * sizeof *A->colptr;
    const int64_t entries = A->colptr[A->ncol];

    return A->nrow == B->nrow && A->ncol == B->ncol &&
           memcmp(A->colptr, B->colptr, columns) == 0 &&
           memcmp(A->rowind, B->rowind, (size_t)entries * sizeof *A->rowind) ==
               0 &&
           memcmp(A->val, B->val, (size_t)entries * sizeof *A->val) == 0;
}

const ritz_pairs *ritz_spectra_find(const ritz_sparse *K, const ritz_sparse *M)
{
    for (int64_t k = 0; lent && k < lent->count; k++)
        if (are_equal(&lent->item[k].K, K) && are_equal(&lent->item[k].M, M))
            return &lent->item[k].pairs;
    return NULL;
}

ritz_status ritz_spectra_keep(const ritz_sparse *K, const ritz_sparse *M,
                              const ritz_pairs *pairs)
{
    RITZ_OWN(stored_spectrum) found = {0};

    if (!lent)
        return RITZ_OK;
    RITZ_CHECK(ritz_sparse_copy(K, &found.K));
    RITZ_CHECK(ritz_sparse_copy(M, &found.M));
    RITZ_CHECK(ritz_pairs_copy(pairs, pairs->Phi.ncol, &found.pairs));
    if (lent->count == MOST_PENCILS) {
        stored_spectrum_free(&lent->item[0]);
        lent->count--;
        memmove(lent->item, lent->item + 1,
                (size_t)lent->count * sizeof *lent->item);
    }
    RITZ_MOVE(lent->item[lent->count], found);
    lent->count++;
    return RITZ_OK;
}
