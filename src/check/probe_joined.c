/*
 * Columns of kind force, p, are made to join bodies by interface forces lambda,
 * to which they answer statically: C_q q + C_p p = 0, p = -K_pp^-1 C_p' lambda,
 * with C the rows of the ports. Held to the ground so, a body is
 *
 *     K = [ K_qq   C_q'               ]     M = [ M_qq   0         ]
 *         [ C_q   -C_p K_pp^-1 C_p'   ],        [ 0      H M_pp H' ],
 *
 * H = C_p K_pp^-1, in [q; lambda], C reduced to the rows that C_p reaches: a
 * negative eigenvalue for each force that has mass [Rixen2004].
 */
#include "check/probe_parts.h"

#include "base/alloc.h"
#include "linear/general.h"

#include <math.h>
#include <stdlib.h>

static const double dependent = 1e-9;

typedef struct joint {
    int64_t count; /* of force columns */
    int64_t *force, *other;
    ritz_dense Cq, Cp;   /* rows of C that C_p reaches */
    ritz_dense Kpp, Mpp; /* of the force columns */
    ritz_dense flexible; /* K_pp^-1 C_p' */
    ritz_dense K, M;     /* of [q; lambda] */
} joint;

static void discard(joint *j)
{
    free(j->force);
    free(j->other);
    ritz_dense_free(&j->Cq);
    ritz_dense_free(&j->Cp);
    ritz_dense_free(&j->Kpp);
    ritz_dense_free(&j->Mpp);
    ritz_dense_free(&j->flexible);
    ritz_dense_free(&j->K);
    ritz_dense_free(&j->M);
}

static ritz_status find_columns(const ritz_reduced *reduced, joint *j)
{
    int64_t rest = 0;

    RITZ_CHECK_NEW(j->force, reduced->columns.count);
    RITZ_CHECK_NEW(j->other, reduced->columns.count);
    for (int64_t k = 0; k < reduced->columns.count; k++)
        if (reduced->columns.kind[k] == RITZ_COLUMN_FORCE)
            j->force[j->count++] = k;
        else
            j->other[rest++] = k;
    return RITZ_OK;
}

/* Columns, or a square part, of A. */
static ritz_status pick(const ritz_dense *A, int64_t count, const int64_t *at,
                        bool square, ritz_dense *out)
{
    int64_t rows = square ? count : A->nrow;

    RITZ_CHECK(ritz_dense_new(rows, count, out));
    for (int64_t j = 0; j < count; j++)
        for (int64_t i = 0; i < rows; i++)
            ritz_dense_col(out, j)[i] =
                ritz_dense_col(A, at[j])[square ? at[i] : i];
    return RITZ_OK;
}

/* C := U'C, U the directions of forces that force columns answer to. */
static ritz_status take_rows(const ritz_prober *it, joint *j)
{
    ritz_status status = RITZ_OK;
    ritz_dense Cq = {0}, Cp = {0}, U = {0}, kept = {0};
    double *sigma = NULL;
    int64_t rank = 0;
    int64_t most = it->L.nrow < j->count ? it->L.nrow : j->count;

    RITZ_TRY(pick(&it->L, j->count, j->force, false, &Cp));
    RITZ_TRY(pick(&it->L, it->L.ncol - j->count, j->other, false, &Cq));
    RITZ_TRY(ritz_general_svd(&Cp, &U, &sigma, NULL));
    while (rank < most && sigma[rank] > dependent * sigma[0])
        rank++;
    kept = ritz_dense_part(&U, 0, rank);
    RITZ_TRY(ritz_dense_mul_tn(&kept, &Cq, &j->Cq));
    RITZ_TRY(ritz_dense_mul_tn(&kept, &Cp, &j->Cp));
done:
    free(sigma);
    ritz_dense_free(&Cq);
    ritz_dense_free(&Cp);
    ritz_dense_free(&U);
    return status;
}

static ritz_status fill(const ritz_prober *it, joint *j)
{
    ritz_status status = RITZ_OK;
    int64_t q = it->L.ncol - j->count;
    int64_t s = j->Cp.nrow;
    ritz_dense soft = {0}, mass = {0};

    RITZ_TRY(ritz_general_transpose(&j->Cp, &j->flexible));
    RITZ_TRY_IN("force columns",
                ritz_general_solve(&j->Kpp, false, &j->flexible));
    RITZ_TRY(ritz_dense_mul(&j->Cp, &j->flexible, &soft));
    RITZ_TRY(ritz_dense_congruence(&j->Mpp, &j->flexible, &mass));
    RITZ_TRY(ritz_dense_new(q + s, q + s, &j->K));
    RITZ_TRY(ritz_dense_new(q + s, q + s, &j->M));
    for (int64_t b = 0; b < q; b++) {
        for (int64_t a = 0; a < q; a++) {
            ritz_dense_col(&j->K, b)[a] =
                ritz_dense_col(&it->model.K, j->other[b])[j->other[a]];
            ritz_dense_col(&j->M, b)[a] =
                ritz_dense_col(&it->model.M, j->other[b])[j->other[a]];
        }
        for (int64_t a = 0; a < s; a++)
            ritz_dense_col(&j->K, b)[q + a] = ritz_dense_col(&j->K, q + a)[b] =
                ritz_dense_col(&j->Cq, b)[a];
    }
    for (int64_t b = 0; b < s; b++)
        for (int64_t a = 0; a < s; a++) {
            ritz_dense_col(&j->K, q + b)[q + a] = -ritz_dense_col(&soft, b)[a];
            ritz_dense_col(&j->M, q + b)[q + a] = ritz_dense_col(&mass, b)[a];
        }
    ritz_dense_symmetrise(&j->K);
    ritz_dense_symmetrise(&j->M);
done:
    ritz_dense_free(&soft);
    ritz_dense_free(&mass);
    return status;
}

ritz_status ritz_probe_joined(ritz_prober *it)
{
    ritz_status status = RITZ_OK;
    const ritz_dense none = {0};
    joint j = {0};
    ritz_probe probe = {0};
    char text[2 * RITZ_NAME_SIZE];

    if (!it->usable)
        return RITZ_OK;
    RITZ_TRY(find_columns(it->reduced, &j));
    if (j.count == 0 || it->L.nrow == 0)
        goto done;
    RITZ_TRY(take_rows(it, &j));
    RITZ_TRY(pick(&it->model.K, j.count, j.force, true, &j.Kpp));
    RITZ_TRY(pick(&it->model.M, j.count, j.force, true, &j.Mpp));
    RITZ_TRY(fill(it, &j));
    RITZ_TRY(ritz_probe_second_order(&j.K, &j.M, &none, NULL, &probe));
    ritz_probe_print(&probe, text);
    ritz_prober_say(it, "interface-joined",
                    probe.radius > 0.0 ? probe.pole[0] / probe.radius : 0.0,
                    probe.tolerance,
                    probe.verdict == RITZ_UNSTABLE ? RITZ_FAIL : RITZ_PASS, "",
                    "joined by interface forces, as its columns are made "
                    "for: %s",
                    text);
done:
    discard(&j);
    return status;
}
