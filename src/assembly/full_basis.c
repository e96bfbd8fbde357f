/*
 * The basis T of an assembled system. Bodies move as u_c = T_c q_c with q_c =
 * P_c x. C P = 0 holds in their ports' maps, which are rows of T_c, so that
 * (u_1, u_2, ...) satisfies the full-order constraints too and follows from its
 * masters.
 */
#include "base/alloc.h"

#include <ritz/assembly.h>

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/*
 * Append the rows of body k, whose coordinates are rows first .. first + count
 * - 1 of P.
 */
static ritz_status add_body(const ritz_reduced *body, const ritz_dense *P,
                            int64_t first, int64_t count, const int64_t *row,
                            ritz_dense *T)
{
    RITZ_OWN(ritz_dense) part = {0}, TP = {0};

    RITZ_CHECK(ritz_dense_rows(&body->T, count, row, &part));
    RITZ_CHECK(ritz_dense_mul(&part, P, &TP));
    for (int64_t j = 0; j < T->ncol; j++)
        memcpy(ritz_dense_col(T, j) + first, ritz_dense_col(&TP, j),
               (size_t)count * sizeof *T->val);
    return RITZ_OK;
}

ritz_status ritz_stage_basis(const ritz_stage *stage,
                             const ritz_configuration *at, int64_t n,
                             const ritz_master *master, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) T = {0};
    RITZ_OWN_ARRAY int64_t *row = NULL;

    RITZ_CHECK_NEW(row, n);
    RITZ_CHECK(ritz_dense_new(n, at->K.ncol, &T));
    for (int64_t first = 0, last = 0; first < n; first = last) {
        const int64_t k = master[first].body;
        const ritz_reduced *body = &stage->body[k];
        int64_t most = 0;

        for (last = first; last < n && master[last].body == k; last++) {
            row[last] = master[last].dof;
            most = row[last] > most ? row[last] : most;
        }
        RITZ_REFUSE_IF(!body->T.val || body->T.nrow <= most, RITZ_ERR_ARGUMENT,
                       "'%s' has no basis T for its %" PRId64 " dofs",
                       stage->scene->component[k].name, most + 1);
        RITZ_CHECK(
            add_body(body, &at->P[k], first, last - first, row + first, &T));
    }
    RITZ_MOVE(*out, T);
    return RITZ_OK;
}
