/*
 * Constraint elements of bulk data as equations u_m = sum of shares u_n, along
 * the displacement axes of the grids.
 *
 *     MPC     SID  G1 C1 A1  G2 C2 A2      u_1 = -(A2 u_2 + ...) / A1
 *                  G3 C3 A3  G4 C4 A4
 *
 * What an element says that is not understood is kept as a sentence: only
 * matrices that still hold the dependent dofs need it.
 *
 * [Nastran1986], section 2.4; [MSC2012].
 */
#include "base/alloc.h"
#include "base/search.h"
#include "base/tolerances.h"
#include "formats/bulk.h"
#include "linear/general.h"
#include "model/equations.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <strings.h>

/* A constraint element as it becomes equations. */
typedef struct ritz_bulk_tying {
    const ritz_bulk_cards *all;
    const ritz_deck *built;
    const ritz_card *card;
    const char *name; /* "RBE2 600" */
    ritz_equations *out;
} ritz_bulk_tying;

enum { ALL_SIX = 0x7e }; /* bits of directions 1 to 6 */

/* Fail with file, line and the name of the element before the sentence. */
[[gnu::format(printf, 2, 3)]] static ritz_status
tying_refuse(const ritz_bulk_tying *it, const char *format, ...)
{
    char sentence[300];
    va_list args;

    va_start(args, format);
    vsnprintf(sentence, sizeof sentence, format, args);
    va_end(args);
    return ritz_cards_refuse(&it->all->cards, it->card->entry->line, "%s %s",
                             it->name, sentence);
}

/* The grid that field @p k names, as index; it must have a position. */
static ritz_status tying_grid(const ritz_bulk_tying *it, int64_t k,
                              int64_t *out)
{
    const ritz_deck *built = it->built;
    int64_t id = 0;

    RITZ_CHECK(ritz_card_id(it->card, k, &id));
    *out = ritz_grids_find(&built->grids, id);
    if (*out < 0 && ritz_search(built->num_points, built->point, id) >= 0)
        return tying_refuse(it,
                            "names '%" PRId64 "', a scalar point: "
                            "it is nowhere and cannot turn",
                            id);
    if (*out < 0)
        return tying_refuse(
            it, "names grid '%" PRId64 "', which the deck does not define", id);
    return RITZ_OK;
}

/* Directions that field @p k lists, 0 of a blank or 0: none, unless one is
 * due. */
static ritz_status tying_mask(const ritz_bulk_tying *it, int64_t k, bool due,
                              uint8_t *out)
{
    RITZ_CHECK(ritz_card_directions(it->card, k, out));
    *out &= ALL_SIX;
    if (due && *out == 0)
        return ritz_card_refuse(it->card, k, "a list of directions 1 to 6");
    return RITZ_OK;
}

/* A number with a point is a thermal expansion coefficient, not a grid. */
static bool tying_is_real(const ritz_bulk_tying *it, int64_t k)
{
    return strchr(ritz_card_text(it->card, k), '.') != NULL;
}

/* Pairs of grid and directions from field @p k on, to the end, to UM or to a
 * thermal field; `k` is moved there. */
static ritz_status tying_pairs(const ritz_bulk_tying *it, bool due, int64_t *k,
                               ritz_ties *out)
{
    ritz_tie tie = {.weight = 1.0};

    while (*k < it->card->count) {
        const char *text = ritz_card_text(it->card, *k);

        if (!*text) {
            (*k)++;
            continue;
        }
        if (tying_is_real(it, *k) || strcasecmp(text, "UM") == 0)
            break;
        RITZ_CHECK(tying_grid(it, *k, &tie.grid));
        RITZ_CHECK(tying_mask(it, *k + 1, due, &tie.mask));
        RITZ_CHECK(ritz_ties_add(out, tie));
        *k += 2;
    }
    return RITZ_OK;
}

/* ---- MPC ---------------------------------------------------------------- */

typedef struct term {
    ritz_dof dof;
    double factor;
} term;

/* G C A at field k; of scalar points C is blank, 0 or 1. */
static ritz_status take_term(const ritz_bulk_tying *it, int64_t k, term *out)
{
    const ritz_deck *built = it->built;
    int64_t id = 0;
    int64_t c = 0;

    RITZ_CHECK(ritz_card_id(it->card, k, &id));
    RITZ_CHECK(ritz_card_whole(it->card, k + 1, 0, &c));
    RITZ_CHECK(ritz_card_real(it->card, k + 2, nan(""), &out->factor));
    if (isnan(out->factor))
        return ritz_card_refuse(it->card, k + 2, "a factor");
    if (ritz_search(built->num_points, built->point, id) >= 0) {
        if (c < 0 || c > 1)
            return ritz_card_refuse(it->card, k + 1,
                                    "a direction of a scalar point");
        c = 0;
    } else if (ritz_grids_find(&built->grids, id) < 0) {
        return tying_refuse(
            it, "names '%" PRId64 "', which the deck does not define", id);
    } else if (c < 1 || c > 6) {
        return ritz_card_refuse(it->card, k + 1, "a direction 1 to 6");
    }
    out->dof = (ritz_dof){id, c};
    return RITZ_OK;
}

/* Lines have their terms at fields 1 and 4, and nothing at the other two. */
static ritz_status check_layout(const ritz_bulk_tying *it)
{
    for (int64_t k = 7; k < it->card->count; k += k % 8 == 7 ? 1 : 7)
        if (*ritz_card_text(it->card, k))
            return ritz_card_refuse(it->card, k,
                                    "where MPC has a term: that field is "
                                    "blank");
    return RITZ_OK;
}

/* The elements that are understood. */
static ritz_status tie_mpc(const ritz_bulk_tying *it)
{
    term first = {0};
    term next = {0};

    RITZ_CHECK(check_layout(it));
    RITZ_CHECK(take_term(it, 1, &first));
    if (first.factor == 0.0)
        return tying_refuse(
            it, "begins with a factor of zero, and its first dof is the one "
                "that depends");
    RITZ_CHECK(ritz_equations_begin(it->out, first.dof));
    for (int64_t k = 4; k < it->card->count; k += k % 8 == 4 ? 5 : 3) {
        if (!*ritz_card_text(it->card, k) &&
            !*ritz_card_text(it->card, k + 1) &&
            !*ritz_card_text(it->card, k + 2))
            continue;
        RITZ_CHECK(take_term(it, k, &next));
        RITZ_CHECK(
            ritz_equations_add(it->out, next.dof, -next.factor / first.factor));
    }
    return RITZ_OK;
}

/* ---- rigid elements ----------------------------------------------------- */

/*
 * Dependent dofs follow six independent ones:
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
 */

static ritz_status tie_all(const ritz_bulk_tying *it, const ritz_ties *from,
                           const ritz_ties *to)
{
    ritz_status status = RITZ_OK;
    long long count = ritz_ties_dofs(from);

    if (count != 6)
        return tying_refuse(it, "has %lld independent dofs, six are due",
                            count);
    for (int64_t k = 0; k < from->count; k++)
        for (int64_t j = 0; j < to->count; j++)
            if (from->tie[k].grid == to->tie[j].grid &&
                (from->tie[k].mask & to->tie[j].mask))
                return tying_refuse(
                    it, "makes a dof of grid '%lld' depend on itself",
                    (long long)it->built->grids.id[from->tie[k].grid]);
    status = ritz_tie_rigid(&it->built->grids, from, to, it->out);
    if (status == RITZ_ERR_SINGULAR)
        return tying_refuse(it,
                            "is left free to move by its six independent dofs");
    return status;
}

static ritz_status tie_rbe2(const ritz_bulk_tying *it)
{
    RITZ_OWN(ritz_ties) from = {0}, to = {0};
    ritz_tie tie = {.mask = ALL_SIX, .weight = 1.0};

    RITZ_CHECK(tying_grid(it, 1, &tie.grid));
    RITZ_CHECK(ritz_ties_add(&from, tie));
    RITZ_CHECK(tying_mask(it, 2, true, &tie.mask));
    for (int64_t k = 3; k < it->card->count; k++) {
        if (!*ritz_card_text(it->card, k))
            continue;
        if (tying_is_real(it, k)) /* thermal expansion */
            break;
        RITZ_CHECK(tying_grid(it, k, &tie.grid));
        RITZ_CHECK(ritz_ties_add(&to, tie));
    }
    return tie_all(it, &from, &to);
}

/* RBAR or RTRPLT: grids, then CN of each, then CM of each from a field on. */
static ritz_status tie_corners(const ritz_bulk_tying *it)
{
    bool plate = it->card->entry->name[1] == 'T';
    int64_t corners = plate ? 3 : 2;
    int64_t at = plate ? 8 : 5;
    RITZ_OWN(ritz_ties) from = {0}, to = {0};
    ritz_tie free[3] = {0};
    ritz_tie held[3] = {0};
    bool given = false;

    for (int64_t k = 0; k < corners; k++) {
        RITZ_CHECK(tying_grid(it, 1 + k, &free[k].grid));
        held[k] = free[k];
        RITZ_CHECK(tying_mask(it, 1 + corners + k, false, &free[k].mask));
        RITZ_CHECK(tying_mask(it, at + k, false, &held[k].mask));
        given = given || held[k].mask != 0;
    }
    for (int64_t k = 0; k < corners; k++) {
        if (!given)
            held[k].mask = (uint8_t)(ALL_SIX & ~(unsigned)free[k].mask);
        if (free[k].mask)
            RITZ_CHECK(ritz_ties_add(&from, free[k]));
        if (held[k].mask)
            RITZ_CHECK(ritz_ties_add(&to, held[k]));
    }
    return tie_all(it, &from, &to);
}

static ritz_status tie_rbe1(const ritz_bulk_tying *it)
{
    RITZ_OWN(ritz_ties) from = {0}, to = {0};
    int64_t k = 1;

    RITZ_CHECK(tying_pairs(it, false, &k, &from));
    if (strcasecmp(ritz_card_text(it->card, k), "UM") != 0)
        return tying_refuse(it, "names no dependent dofs by UM");
    k++;
    RITZ_CHECK(tying_pairs(it, true, &k, &to));
    return tie_all(it, &from, &to);
}

/* ---- RBE3 --------------------------------------------------------------- */

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

typedef struct average_card {
    int64_t grid; /* the reference */
    uint8_t mask; /* of it */
    ritz_ties over, moved;
} average_card;

static void average_card_free(average_card *card)
{
    ritz_ties_free(&card->over);
    ritz_ties_free(&card->moved);
}

/* WT C G1 G2 ... from field k on; where the next group begins. */
static ritz_status take_group(const ritz_bulk_tying *it, int64_t *k,
                              average_card *out)
{
    ritz_tie tie = {0};

    RITZ_CHECK(ritz_card_real(it->card, *k, 0.0, &tie.weight));
    if (tie.weight < 0.0)
        return ritz_card_refuse(it->card, *k, "a weight from zero on");
    RITZ_CHECK(tying_mask(it, *k + 1, true, &tie.mask));
    for (*k += 2; *k < it->card->count; (*k)++) {
        const char *text = ritz_card_text(it->card, *k);

        if (!*text)
            continue;
        if (tying_is_real(it, *k) || strcasecmp(text, "UM") == 0 ||
            strcasecmp(text, "ALPHA") == 0)
            break;
        RITZ_CHECK(tying_grid(it, *k, &tie.grid));
        if (tie.weight > 0.0)
            RITZ_CHECK(ritz_ties_add(&out->over, tie));
    }
    return RITZ_OK;
}

static ritz_status take_average(const ritz_bulk_tying *it, average_card *out)
{
    int64_t k = 4;

    RITZ_CHECK(tying_grid(it, 2, &out->grid));
    RITZ_CHECK(tying_mask(it, 3, true, &out->mask));
    while (k < it->card->count) {
        const char *text = ritz_card_text(it->card, k);

        if (strcasecmp(text, "ALPHA") == 0)
            break;
        if (strcasecmp(text, "UM") == 0) {
            k++;
            return tying_pairs(it, true, &k, &out->moved);
        }
        if (*text)
            RITZ_CHECK(take_group(it, &k, out));
        else
            k++;
    }
    return RITZ_OK;
}

/* T A, one row for each direction of REFC. */
static ritz_status average_rows(const ritz_bulk_tying *it,
                                const average_card *card,
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
            return tying_refuse(
                it,
                "cannot tell '%s' from the dofs that it averages: do they "
                "lie on a line?",
                ritz_dof_name(ref[at], name));
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

/* ---- UM ----------------------------------------------------------------- */

/* All dofs of the element as columns of E = [I, -T A]. */
static ritz_status join_columns(const ritz_dense *TA, const ritz_dof *ref,
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
                return tying_refuse(
                    it, "names '%s' by UM, which it does not hold, or twice",
                    ritz_dof_name(wanted, name));
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

/* E := E_m^-1 E of the columns behind the first m. */
static ritz_status solve_moved(const ritz_bulk_tying *it, ritz_dense *E)
{
    int64_t m = E->nrow;
    const ritz_dense moved = ritz_dense_part(E, 0, m);
    ritz_dense rest = ritz_dense_part(E, m, E->ncol - m);
    RITZ_OWN(ritz_dense) copy = {0};
    double sigma[6] = {0};

    RITZ_CHECK(ritz_dense_copy(&moved, &copy));
    RITZ_CHECK(ritz_general_singular(&copy, sigma));
    if (!(sigma[m - 1] > RITZ_HALF_DIGITS * sigma[0]))
        return tying_refuse(it, "cannot be solved for the dofs that UM names");
    return ritz_general_solve(&moved, false, &rest);
}

static ritz_status put_moved(const ritz_bulk_tying *it,
                             const average_card *card, const ritz_dense *TA,
                             const ritz_dof *ref, const ritz_average *average)
{
    double length = average->length;
    int64_t m = TA->nrow;
    RITZ_OWN(ritz_dense) E = {0}, rest = {0};
    RITZ_OWN_ARRAY ritz_dof *dof = NULL;

    if (ritz_ties_dofs(&card->moved) != m)
        return tying_refuse(it,
                            "names %" PRId64 " dofs by UM, %" PRId64 " depend",
                            ritz_ties_dofs(&card->moved), m);
    RITZ_CHECK(join_columns(TA, ref, average, length, &dof, &E));
    RITZ_CHECK(move_front(it, card, dof, &E));
    RITZ_CHECK(solve_moved(it, &E));
    RITZ_CHECK(ritz_dense_columns(&E, m, E.ncol - m, &rest));
    for (int64_t j = 0; j < rest.ncol; j++)
        for (int64_t i = 0; i < m; i++)
            ritz_dense_col(&rest, j)[i] *= -ritz_tie_scale(dof[m + j], length) /
                                           ritz_tie_scale(dof[i], length);
    for (int64_t i = 0; i < m; i++)
        RITZ_CHECK(put_row(&rest, i, dof[i], dof + m, length, it->out));
    return RITZ_OK;
}

static ritz_status tie_rbe3(const ritz_bulk_tying *it)
{
    const ritz_grids *grids = &it->built->grids;
    RITZ_OWN(average_card) card = {0};
    RITZ_OWN(ritz_average) average = {0};
    RITZ_OWN(ritz_dense) TA = {0};
    ritz_dof ref[6] = {0};
    int64_t m = 0;

    RITZ_CHECK(take_average(it, &card));
    RITZ_CHECK(ritz_average_new(grids, &card.over,
                                grids->position + 3 * card.grid, &average));
    for (int c = 1; c <= 6; c++)
        m += (card.mask >> c) & 1;
    RITZ_CHECK(ritz_dense_new(m, average.A.ncol, &TA));
    RITZ_CHECK(average_rows(it, &card, &average, ref, &TA));
    if (card.moved.count > 0)
        return put_moved(it, &card, &TA, ref, &average);
    for (int64_t i = 0; i < m; i++)
        RITZ_CHECK(
            put_row(&TA, i, ref[i], average.dof, average.length, it->out));
    return RITZ_OK;
}

/* ---- all of them -------------------------------------------------------- */

/* Elements that are understood; the others are refused by name. */
static const struct kind {
    const char *name;
    ritz_status (*tie)(const ritz_bulk_tying *it);
} KINDS[] = {
    {"MPC", tie_mpc},   {"RBAR", tie_corners}, {"RBE1", tie_rbe1},
    {"RBE2", tie_rbe2}, {"RBE3", tie_rbe3},    {"RTRPLT", tie_corners},
};

static ritz_status tie_element(const ritz_bulk_tying *it)
{
    for (size_t k = 0; k < sizeof KINDS / sizeof *KINDS; k++)
        if (strcmp(KINDS[k].name, it->card->entry->name) == 0)
            return KINDS[k].tie(it);
    return tying_refuse(
        it, "is not understood: MPC, RBAR, RBE1, RBE2, RBE3 and RTRPLT are");
}

static ritz_status tie_card(const ritz_bulk_cards *all, int64_t k,
                            ritz_deck *built)
{
    RITZ_OWN(ritz_card) card = {0};
    const ritz_line *line = NULL;
    ritz_equation_source from = {.name = ""};
    const ritz_bulk_tying it = {.all = all,
                                .built = built,
                                .card = &card,
                                .name = from.name,
                                .out = &built->equations};

    RITZ_CHECK(ritz_card_take(&all->cards, all->constraint[k].entry, &card));
    line = &all->cards.line[card.entry->line];
    from.file = line->file;
    from.line = line->number;
    memcpy(from.name, built->constraint[k], sizeof from.name);
    RITZ_CHECK(ritz_equations_cite_next(&built->equations, from));
    return tie_element(&it);
}

ritz_status ritz_bulk_list_equations(const ritz_bulk_cards *all,
                                     ritz_deck *built)
{
    if (built->num_constraints == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_deck_paths(&all->cards.files, &built->equations.num_files,
                               &built->equations.file));
    for (int64_t k = 0; k < built->num_constraints; k++) {
        ritz_status status = tie_card(all, k, built);

        if (status == RITZ_ERR_FORMAT)
            return ritz_deck_keep_sentence(&built->equations.refused);
        RITZ_CHECK(status);
    }
    return RITZ_OK;
}
