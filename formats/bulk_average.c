/*
 * RBE3: a grid that moves as the weighted average of others.
 *
 *     RBE3  EID  -  REFGRID REFC  WT1 C1 G11 G12 ... WT2 C2 G21 ...
 *           UM  GM1 CM1 GM2 CM2 ...
 *
 *     u_ref = T A u_i,    by least squares over dofs i, see ties.h
 *
 * UM moves dependence: with E = [I, -T A] over the dofs of REFC and of the
 * averaged grids, E_m u_m + E_n u_n = 0 and as many u_m as REFC has directions.
 *
 * [MSC2012]; the tests hold it to the GM that a commercial NASTRAN wrote.
 */
#include "formats/bulk_parts.h"

#include "base/alloc.h"

#include <lapacke.h>

#include <inttypes.h>
#include <math.h>

typedef struct average_card {
    int64_t grid; /* the reference */
    uint8_t mask; /* of it */
    ritz_ties over, moved;
} average_card;

/* WT C G1 G2 ... from field k on; where the next group begins. */
static ritz_status take_group(const ritz_bulk_tying *it, int64_t *k,
                              average_card *out)
{
    ritz_tie tie = {0};

    RITZ_CHECK(ritz_card_real(it->card, *k, 0.0, &tie.weight));
    if (tie.weight < 0.0)
        RITZ_CHECK(ritz_card_refuse(it->card, *k, "a weight from zero on"));
    RITZ_CHECK(ritz_bulk_tying_mask(it, *k + 1, &tie.mask));
    if (tie.mask == 0)
        RITZ_CHECK(
            ritz_card_refuse(it->card, *k + 1, "a list of directions 1 to 6"));
    for (*k += 2; *k < it->card->count; (*k)++) {
        const char *text = ritz_card_text(it->card, *k);

        if (!*text)
            continue;
        if (ritz_bulk_tying_is_real(it, *k) || ritz_bulk_is_word(text, "UM") ||
            ritz_bulk_is_word(text, "ALPHA"))
            break;
        RITZ_CHECK(ritz_bulk_tying_grid(it, *k, &tie.grid));
        if (tie.weight > 0.0)
            RITZ_CHECK(ritz_ties_add(&out->over, tie));
    }
    return RITZ_OK;
}

static ritz_status take_card(const ritz_bulk_tying *it, average_card *out)
{
    int64_t k = 4;

    RITZ_CHECK(ritz_bulk_tying_grid(it, 2, &out->grid));
    RITZ_CHECK(ritz_bulk_tying_mask(it, 3, &out->mask));
    if (out->mask == 0)
        RITZ_CHECK(
            ritz_card_refuse(it->card, 3, "a list of directions 1 to 6"));
    while (k < it->card->count) {
        const char *text = ritz_card_text(it->card, k);

        if (ritz_bulk_is_word(text, "ALPHA"))
            break;
        if (ritz_bulk_is_word(text, "UM")) {
            RITZ_CHECK(ritz_bulk_tying_pairs(it, k + 1, &out->moved));
            break;
        }
        if (*text)
            RITZ_CHECK(take_group(it, &k, out));
        else
            k++;
    }
    return RITZ_OK;
}

/* T A, one row for each direction of REFC. */
static ritz_status rows_of(const ritz_bulk_tying *it, const average_card *card,
                           const ritz_average *average, ritz_dof *ref,
                           ritz_dense *out)
{
    const ritz_grids *grids = &it->built->grids;
    int64_t at = 0;

    for (int64_t c = 1; c <= 6; c++) {
        const ritz_tie one = {card->grid, card->mask, 1.0};
        double row[6];
        char name[RITZ_DOF_NAME_SIZE];

        if (!ritz_tie_has(&one, c))
            continue;
        ref[at] = (ritz_dof){grids->id[card->grid], c};
        ritz_tie_row(grids, card->grid, c, grids->position + 3 * card->grid,
                     row);
        if (!ritz_average_tells(average, row))
            RITZ_CHECK(ritz_bulk_tying_refuse(
                it,
                "cannot tell '%s' from the dofs that it averages: do they "
                "lie on a line?",
                ritz_dof_name(ref[at], name)));
        for (int64_t j = 0; j < average->A.ncol; j++)
            for (int i = 0; i < 6; i++)
                ritz_dense_col(out, j)[at] +=
                    row[i] * ritz_dense_col(&average->A, j)[i];
        at++;
    }
    return RITZ_OK;
}

/* One equation, without the shares that are rounding. */
static ritz_status put_row(const ritz_dense *A, int64_t row, ritz_dof dependent,
                           const ritz_dof *dof, double length,
                           ritz_equations *out)
{
    double most = 0.0;

    for (int64_t j = 0; j < A->ncol; j++)
        most = fmax(most, fabs(ritz_dense_col(A, j)[row]) /
                              ritz_tie_scale(dof[j], length));
    RITZ_CHECK(ritz_equations_begin(out, dependent));
    for (int64_t j = 0; j < A->ncol; j++)
        if (fabs(ritz_dense_col(A, j)[row]) >
            RITZ_TIE_ROUNDING * most * ritz_tie_scale(dof[j], length))
            RITZ_CHECK(
                ritz_equations_add(out, dof[j], ritz_dense_col(A, j)[row]));
    return RITZ_OK;
}

/* ---- UM ---------------------------------------------------------------- */

/* All dofs of the element as columns of E = [I, -T A]. */
static ritz_status join(const ritz_dense *TA, const ritz_dof *ref,
                        const ritz_average *average, double length,
                        ritz_dof **dof, ritz_dense *E)
{
    int64_t m = TA->nrow;

    RITZ_CHECK_NEW(*dof, m + TA->ncol);
    RITZ_CHECK(ritz_dense_new(m, m + TA->ncol, E));
    for (int64_t j = 0; j < m + TA->ncol; j++) {
        double *col = ritz_dense_col(E, j);

        (*dof)[j] = j < m ? ref[j] : average->dof[j - m];
        for (int64_t i = 0; i < m; i++)
            col[i] =
                (j < m ? (double)(i == j) : -ritz_dense_col(TA, j - m)[i]) *
                ritz_tie_scale(ref[i], length) /
                ritz_tie_scale((*dof)[j], length);
    }
    return RITZ_OK;
}

/* Columns of E that UM names, in front, the others behind them. */
static ritz_status move_front(const ritz_bulk_tying *it,
                              const average_card *card, ritz_dof *dof,
                              ritz_dense *E)
{
    int64_t at = 0;
    char name[RITZ_DOF_NAME_SIZE];

    for (int64_t k = 0; k < card->moved.count; k++)
        for (int64_t c = 1; c <= 6; c++) {
            ritz_dof wanted = {it->built->grids.id[card->moved.tie[k].grid], c};
            int64_t j = at;

            if (!ritz_tie_has(&card->moved.tie[k], c))
                continue;
            while (j < E->ncol && ritz_dof_compare(&dof[j], &wanted) != 0)
                j++;
            if (j == E->ncol)
                RITZ_CHECK(ritz_bulk_tying_refuse(
                    it, "names '%s' by UM, which it does not hold, or twice",
                    ritz_dof_name(wanted, name)));
            dof[j] = dof[at];
            dof[at] = wanted;
            for (int64_t i = 0; i < E->nrow; i++) {
                double kept = ritz_dense_col(E, j)[i];

                ritz_dense_col(E, j)[i] = ritz_dense_col(E, at)[i];
                ritz_dense_col(E, at)[i] = kept;
            }
            at++;
        }
    return RITZ_OK;
}

/* E := -E_m^-1 E of the columns behind the first m. */
static ritz_status solve_moved(const ritz_bulk_tying *it, ritz_dense *E)
{
    lapack_int m = (lapack_int)E->nrow;
    lapack_int rest = (lapack_int)E->ncol - m;
    lapack_int pivot[6];
    double size = LAPACKE_dlange(LAPACK_COL_MAJOR, '1', m, m, E->val, m);
    double rcond = 0.0;

    if (LAPACKE_dgetrf(LAPACK_COL_MAJOR, m, m, E->val, m, pivot) == 0)
        (void)LAPACKE_dgecon(LAPACK_COL_MAJOR, '1', m, E->val, m, size, &rcond);
    if (!(rcond > 1.5e-8))
        RITZ_CHECK(ritz_bulk_tying_refuse(
            it, "cannot be solved for the dofs that UM names"));
    if (rest > 0)
        RITZ_REFUSE_IF(LAPACKE_dgetrs(LAPACK_COL_MAJOR, 'N', m, rest, E->val, m,
                                      pivot, ritz_dense_col(E, m), m) != 0,
                       RITZ_ERR_MEMORY, "no memory for the constraints");
    return RITZ_OK;
}

static ritz_status put_moved(const ritz_bulk_tying *it,
                             const average_card *card, const ritz_dense *TA,
                             const ritz_dof *ref, const ritz_average *average)
{
    ritz_status status = RITZ_OK;
    double length = average->length;
    int64_t m = TA->nrow;
    ritz_dense E = {0}, rest = {0};
    ritz_dof *dof = NULL;

    if (ritz_ties_dofs(&card->moved) != m)
        RITZ_TRY(ritz_bulk_tying_refuse(
            it, "names %" PRId64 " dofs by UM, %" PRId64 " depend",
            ritz_ties_dofs(&card->moved), m));
    RITZ_TRY(join(TA, ref, average, length, &dof, &E));
    RITZ_TRY(move_front(it, card, dof, &E));
    RITZ_TRY(solve_moved(it, &E));
    RITZ_TRY(ritz_dense_columns(&E, m, E.ncol - m, &rest));
    for (int64_t j = 0; j < rest.ncol; j++)
        for (int64_t i = 0; i < m; i++)
            ritz_dense_col(&rest, j)[i] *= -ritz_tie_scale(dof[m + j], length) /
                                           ritz_tie_scale(dof[i], length);
    for (int64_t i = 0; i < m; i++)
        RITZ_TRY(put_row(&rest, i, dof[i], dof + m, length, it->out));
done:
    free(dof);
    ritz_dense_free(&E);
    ritz_dense_free(&rest);
    return status;
}

ritz_status ritz_bulk_tie_rbe3(const ritz_bulk_tying *it)
{
    ritz_status status = RITZ_OK;
    const ritz_grids *grids = &it->built->grids;
    average_card card = {0};
    ritz_average average = {0};
    ritz_dense TA = {0};
    ritz_dof ref[6] = {0};
    int64_t m = 0;

    RITZ_TRY(take_card(it, &card));
    RITZ_TRY(ritz_average_new(grids, &card.over,
                              grids->position + 3 * card.grid, &average));
    for (int c = 1; c <= 6; c++)
        m += (card.mask >> c) & 1;
    RITZ_TRY(ritz_dense_new(m, average.A.ncol, &TA));
    RITZ_TRY(rows_of(it, &card, &average, ref, &TA));
    if (card.moved.count > 0)
        RITZ_TRY(put_moved(it, &card, &TA, ref, &average));
    for (int64_t i = 0; i < m && card.moved.count == 0; i++)
        RITZ_TRY(put_row(&TA, i, ref[i], average.dof, average.length, it->out));
done:
    ritz_ties_free(&card.over);
    ritz_ties_free(&card.moved);
    ritz_average_free(&average);
    ritz_dense_free(&TA);
    return status;
}
