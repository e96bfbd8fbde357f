/*
 * Rigid elements of bulk data. Dependent dofs follow six independent ones:
 *
 *     RBE2    EID GN CM GM1 GM2 ...                    all six of GN
 *     RBAR    EID GA GB CNA CNB CMA CMB                six of two grids
 *     RTRPLT  EID GA GB GC CNA CNB CNC -  CMA CMB CMC  six of three
 *     RBE1    EID GN1 CN1 GN2 CN2 GN3 CN3              six of up to six
 *             -   GN4 CN4 ...
 *             UM  GM1 CM1 GM2 CM2 ...
 *
 * Where CMA, CMB and CMC are all blank, every dof of these grids that is not
 * independent depends. A thermal expansion coefficient behind them is passed
 * over.
 *
 * [Nastran1986], section 2.4; [MSC2012].
 */
#include "formats/bulk_parts.h"

enum { ALL_SIX = 0x7e };

static ritz_status tie_all(const ritz_bulk_tying *it, const ritz_ties *from,
                           const ritz_ties *to)
{
    ritz_status status = RITZ_OK;
    long long count = ritz_ties_dofs(from);

    if (count != 6)
        RITZ_TRY(ritz_bulk_tying_refuse(
            it, "has %lld independent dofs, six are due", count));
    for (int64_t k = 0; k < from->count; k++)
        for (int64_t j = 0; j < to->count; j++)
            if (from->tie[k].grid == to->tie[j].grid &&
                (from->tie[k].mask & to->tie[j].mask))
                RITZ_TRY(ritz_bulk_tying_refuse(
                    it, "makes a dof of grid '%lld' depend on itself",
                    (long long)it->built->grids.id[from->tie[k].grid]));
    status = ritz_tie_rigid(&it->built->grids, from, to, it->out);
    if (status == RITZ_ERR_SINGULAR)
        RITZ_TRY(ritz_bulk_tying_refuse(
            it, "is left free to move by its six independent dofs"));
done:
    return status;
}

ritz_status ritz_bulk_tie_rbe2(const ritz_bulk_tying *it)
{
    ritz_status status = RITZ_OK;
    ritz_ties from = {0}, to = {0};
    ritz_tie tie = {.mask = ALL_SIX, .weight = 1.0};

    RITZ_TRY(ritz_bulk_tying_grid(it, 1, &tie.grid));
    RITZ_TRY(ritz_ties_add(&from, tie));
    RITZ_TRY(ritz_bulk_tying_mask(it, 2, &tie.mask));
    if (tie.mask == 0)
        RITZ_TRY(ritz_card_refuse(it->card, 2, "a list of directions 1 to 6"));
    for (int64_t k = 3; k < it->card->count; k++) {
        if (!*ritz_card_text(it->card, k))
            continue;
        if (ritz_bulk_tying_is_real(it, k)) /* thermal expansion */
            break;
        RITZ_TRY(ritz_bulk_tying_grid(it, k, &tie.grid));
        RITZ_TRY(ritz_ties_add(&to, tie));
    }
    RITZ_TRY(tie_all(it, &from, &to));
done:
    ritz_ties_free(&from);
    ritz_ties_free(&to);
    return status;
}

/* A bar or a plate: grids, then CN of each, then CM of each at field `at`. */
static ritz_status tie_corners(const ritz_bulk_tying *it, int64_t corners,
                               int64_t at)
{
    ritz_status status = RITZ_OK;
    ritz_ties from = {0}, to = {0};
    ritz_tie free[3] = {0};
    ritz_tie held[3] = {0};
    bool given = false;

    for (int64_t k = 0; k < corners; k++) {
        RITZ_TRY(ritz_bulk_tying_grid(it, 1 + k, &free[k].grid));
        held[k] = free[k];
        RITZ_TRY(ritz_bulk_tying_mask(it, 1 + corners + k, &free[k].mask));
        RITZ_TRY(ritz_bulk_tying_mask(it, at + k, &held[k].mask));
        given = given || held[k].mask != 0;
    }
    for (int64_t k = 0; k < corners; k++) {
        if (!given)
            held[k].mask = (uint8_t)(ALL_SIX & ~(unsigned)free[k].mask);
        if (free[k].mask)
            RITZ_TRY(ritz_ties_add(&from, free[k]));
        if (held[k].mask)
            RITZ_TRY(ritz_ties_add(&to, held[k]));
    }
    RITZ_TRY(tie_all(it, &from, &to));
done:
    ritz_ties_free(&from);
    ritz_ties_free(&to);
    return status;
}

ritz_status ritz_bulk_tie_rbar(const ritz_bulk_tying *it)
{
    return tie_corners(it, 2, 5);
}

ritz_status ritz_bulk_tie_rtrplt(const ritz_bulk_tying *it)
{
    return tie_corners(it, 3, 8);
}

ritz_status ritz_bulk_tie_rbe1(const ritz_bulk_tying *it)
{
    ritz_status status = RITZ_OK;
    ritz_ties from = {0}, to = {0};
    ritz_tie tie = {.weight = 1.0};
    int64_t k = 1;

    while (k < it->card->count &&
           !ritz_bulk_is_word(ritz_card_text(it->card, k), "UM")) {
        if (!*ritz_card_text(it->card, k)) {
            k++;
            continue;
        }
        RITZ_TRY(ritz_bulk_tying_grid(it, k, &tie.grid));
        RITZ_TRY(ritz_bulk_tying_mask(it, k + 1, &tie.mask));
        RITZ_TRY(ritz_ties_add(&from, tie));
        k += 2;
    }
    if (k == it->card->count)
        RITZ_TRY(ritz_bulk_tying_refuse(it, "names no dependent dofs by UM"));
    RITZ_TRY(ritz_bulk_tying_pairs(it, k + 1, &to));
    RITZ_TRY(tie_all(it, &from, &to));
done:
    ritz_ties_free(&from);
    ritz_ties_free(&to);
    return status;
}
