/*
 * Constraint elements of bulk data as equations u_m = sum of shares u_n, along
 * the displacement axes of the grids.
 *
 *     MPC     SID  G1 C1 A1  G2 C2 A2      u_1 = -(A2 u_2 + ...) / A1
 *                  G3 C3 A3  G4 C4 A4
 *
 * Rigid elements are in bulk_rigid.c, averages in bulk_average.c. What one of
 * them says that is not understood is kept as a sentence: only matrices that
 * still hold the dependent dofs need it.
 *
 * [Nastran1986], section 2.4.
 */
#include "formats/bulk_parts.h"

#include "base/alloc.h"
#include "base/search.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>

ritz_status ritz_bulk_keep_sentence(char **out)
{
    const char *said = ritz_error_message();
    size_t size = strlen(said) + 1;

    RITZ_CHECK_NEW(*out, (int64_t)size);
    memcpy(*out, said, size);
    return RITZ_OK;
}

ritz_status ritz_bulk_tying_refuse(const ritz_bulk_tying *it,
                                   const char *format, ...)
{
    char sentence[300];
    va_list args;

    va_start(args, format);
    vsnprintf(sentence, sizeof sentence, format, args);
    va_end(args);
    return ritz_cards_refuse(&it->all->cards, it->card->entry->line, "%s %s",
                             it->name, sentence);
}

ritz_status ritz_bulk_tying_grid(const ritz_bulk_tying *it, int64_t k,
                                 int64_t *out)
{
    const ritz_deck *built = it->built;
    int64_t id = 0;

    RITZ_CHECK(ritz_card_id(it->card, k, &id));
    *out = ritz_grids_find(&built->grids, id);
    if (*out < 0 && ritz_search(built->num_points, built->point, id) >= 0)
        RITZ_CHECK(ritz_bulk_tying_refuse(it,
                                          "names '%" PRId64
                                          "', a scalar point: "
                                          "it is nowhere and cannot turn",
                                          id));
    if (*out < 0)
        RITZ_CHECK(ritz_bulk_tying_refuse(
            it, "names grid '%" PRId64 "', which the deck does not define",
            id));
    return RITZ_OK;
}

ritz_status ritz_bulk_tying_mask(const ritz_bulk_tying *it, int64_t k,
                                 uint8_t *out)
{
    int64_t digits = 0;

    RITZ_CHECK(ritz_card_whole(it->card, k, 0, &digits));
    if (!ritz_bulk_mask(digits, out))
        RITZ_CHECK(
            ritz_card_refuse(it->card, k, "a list of directions 1 to 6"));
    *out &= 0x7e; /* bit 0: there are none */
    return RITZ_OK;
}

bool ritz_bulk_tying_is_real(const ritz_bulk_tying *it, int64_t k)
{
    return strchr(ritz_card_text(it->card, k), '.') != NULL;
}

ritz_status ritz_bulk_tying_pairs(const ritz_bulk_tying *it, int64_t k,
                                  ritz_ties *out)
{
    ritz_tie tie = {.weight = 1.0};

    while (k < it->card->count) {
        if (!*ritz_card_text(it->card, k)) {
            k++;
            continue;
        }
        if (ritz_bulk_tying_is_real(it, k)) /* thermal expansion */
            break;
        RITZ_CHECK(ritz_bulk_tying_grid(it, k, &tie.grid));
        RITZ_CHECK(ritz_bulk_tying_mask(it, k + 1, &tie.mask));
        if (tie.mask == 0)
            RITZ_CHECK(ritz_card_refuse(it->card, k + 1,
                                        "a list of directions 1 to 6"));
        RITZ_CHECK(ritz_ties_add(out, tie));
        k += 2;
    }
    return RITZ_OK;
}

/* ---- MPC --------------------------------------------------------------- */

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
        RITZ_CHECK(ritz_card_refuse(it->card, k + 2, "a factor"));
    if (ritz_search(built->num_points, built->point, id) >= 0) {
        if (c < 0 || c > 1)
            RITZ_CHECK(ritz_card_refuse(it->card, k + 1,
                                        "a direction of a scalar point"));
        c = 0;
    } else if (ritz_grids_find(&built->grids, id) < 0) {
        RITZ_CHECK(ritz_bulk_tying_refuse(
            it, "names '%" PRId64 "', which the deck does not define", id));
    } else if (c < 1 || c > 6) {
        RITZ_CHECK(ritz_card_refuse(it->card, k + 1, "a direction 1 to 6"));
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

ritz_status ritz_bulk_tie_mpc(const ritz_bulk_tying *it)
{
    term first = {0};
    term next = {0};

    RITZ_CHECK(check_layout(it));
    RITZ_CHECK(take_term(it, 1, &first));
    if (first.factor == 0.0)
        RITZ_CHECK(ritz_bulk_tying_refuse(
            it, "begins with a factor of zero, and its first dof is the one "
                "that depends"));
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

/* ---- all of them ------------------------------------------------------- */

/* Elements that are understood; the others are refused by name. */
static const struct kind {
    const char *name;
    ritz_status (*tie)(const ritz_bulk_tying *it);
} KINDS[] = {
    {"MPC", ritz_bulk_tie_mpc},   {"RBAR", ritz_bulk_tie_rbar},
    {"RBE1", ritz_bulk_tie_rbe1}, {"RBE2", ritz_bulk_tie_rbe2},
    {"RBE3", ritz_bulk_tie_rbe3}, {"RTRPLT", ritz_bulk_tie_rtrplt},
};

static ritz_status tie(const ritz_bulk_tying *it)
{
    for (size_t k = 0; k < sizeof KINDS / sizeof *KINDS; k++)
        if (strcmp(KINDS[k].name, it->card->entry->name) == 0)
            return KINDS[k].tie(it);
    return ritz_bulk_tying_refuse(
        it, "is not understood: MPC, RBAR, RBE1, RBE2, RBE3 and RTRPLT are");
}

static ritz_status copy_paths(const ritz_cards *cards, ritz_equations *out)
{
    RITZ_CHECK_NEW(out->file, cards->num_files);
    for (; out->num_files < cards->num_files; out->num_files++) {
        const char *path = cards->file[out->num_files].path;
        size_t size = path ? strlen(path) + 1 : 0;

        if (!path)
            continue;
        RITZ_CHECK_NEW(out->file[out->num_files], (int64_t)size);
        memcpy(out->file[out->num_files], path, size);
    }
    return RITZ_OK;
}

static ritz_status tie_card(const ritz_bulk_cards *all,
                            const ritz_bulk_constraint *one, ritz_card *card,
                            ritz_deck *built)
{
    ritz_equation_source from = {.name = ""};
    const ritz_line *line = NULL;
    const ritz_bulk_tying it = {.all = all,
                                .built = built,
                                .card = card,
                                .name = from.name,
                                .out = &built->equations};

    RITZ_CHECK(ritz_card_take(&all->cards, one->entry, card));
    line = &all->cards.line[card->entry->line];
    from.file = line->file;
    from.line = line->number;
    snprintf(from.name, sizeof from.name, "%s %" PRId64, one->name, one->id);
    RITZ_CHECK(ritz_equations_cite_next(&built->equations, from));
    return tie(&it);
}

ritz_status ritz_bulk_list_equations(const ritz_bulk_cards *all,
                                     ritz_deck *built)
{
    ritz_status status = RITZ_OK;
    ritz_card card = {0};

    if (all->num_constraints == 0)
        goto done;
    RITZ_TRY(copy_paths(&all->cards, &built->equations));
    for (int64_t k = 0; k < all->num_constraints; k++) {
        const ritz_bulk_constraint *one = &all->constraint[k];

        if (one->is_set &&
            !ritz_bulk_selects(&all->cards, RITZ_SELECT_MPC, one->id))
            continue;
        status = tie_card(all, one, &card, built);
        if (status == RITZ_ERR_FORMAT) {
            RITZ_TRY(ritz_bulk_keep_sentence(&built->equations.refused));
            break;
        }
        RITZ_TRY(status);
    }
done:
    ritz_card_free(&card);
    return status;
}
