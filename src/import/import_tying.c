/*
 * Constraints between the rows of matrices. With G from the equations of the
 * deck and of ports, u = G u_n,
 *
 *     K_nn = G' K G, and the same of M, D, K4 and K_G
 *
 * Matrices without rows for dependent dofs have been through that already: then
 * G only says how these dofs follow, as far as what they follow is there.
 */
#include "import/import.h"

#include "base/alloc.h"

#include <stdlib.h>
#include <string.h>

/* ---- which rows there are ---------------------------------------------- */

ritz_status ritz_tying_append(int64_t count, const ritz_dof *dof,
                              ritz_tying *tying)
{
    ritz_status status = RITZ_OK;
    int64_t before = tying->names.count;
    ritz_dof *names = NULL;
    bool *flag[3] = {NULL, NULL, NULL};
    bool **old[3] = {&tying->fixed, &tying->alive, &tying->outside};

    RITZ_NEW(names, before + count);
    for (int i = 0; i < 3; i++) {
        RITZ_NEW(flag[i], before + count);
        if (before > 0)
            memcpy(flag[i], *old[i], (size_t)before * sizeof **flag);
    }
    if (before > 0)
        memcpy(names, tying->names.dof, (size_t)before * sizeof *names);
    if (count > 0)
        memcpy(names + before, dof, (size_t)count * sizeof *names);
    for (int i = 0; i < 3; i++) {
        free(*old[i]);
        *old[i] = flag[i];
        flag[i] = NULL;
    }
    free(tying->names.dof);
    tying->names.dof = names;
    tying->names.count = before + count;
    names = NULL;
done:
    for (int i = 0; i < 3; i++)
        free(flag[i]);
    free(names);
    return status;
}

/* Dofs of the equations that are no rows, each once. */
static ritz_status list_missing(const ritz_deck *deck,
                                const ritz_roster *roster, int64_t *count,
                                ritz_dof **out)
{
    const ritz_equations *eq = &deck->equations;
    int64_t terms = eq->count > 0 ? eq->first[eq->count] : 0;
    ritz_dof *list = NULL;
    int64_t found = 0;

    RITZ_CHECK_NEW(list, eq->count + terms);
    for (int64_t e = 0; e < eq->count; e++)
        if (ritz_roster_row(roster, eq->dependent[e]) < 0)
            list[found++] = eq->dependent[e];
    for (int64_t k = 0; k < terms; k++)
        if (ritz_roster_row(roster, eq->dof[k]) < 0)
            list[found++] = eq->dof[k];
    *count = ritz_dof_distinct(found, list);
    *out = list;
    return RITZ_OK;
}

static bool is_ascending(const ritz_names *names)
{
    for (int64_t k = 1; k < names->count; k++)
        if (ritz_dof_compare(&names->dof[k - 1], &names->dof[k]) >= 0)
            return false;
    return true;
}

/* Names that ascend go on doing so: the rows of parts are placed anew. */
static ritz_status sort_names(ritz_names *names, ritz_parts *parts)
{
    ritz_status status = RITZ_OK;
    ritz_dof *before = NULL;
    ritz_roster roster = {0};

    RITZ_NEW(before, names->count);
    if (names->count > 0)
        memcpy(before, names->dof, (size_t)names->count * sizeof *before);
    names->count = ritz_dof_distinct(names->count, names->dof);
    RITZ_TRY(ritz_roster_new(names->count, names->dof, &roster));
    for (int64_t k = 0; k < parts->count; k++)
        for (int64_t i = 0; i < parts->part[k].matrix.A.nrow; i++) {
            int64_t *place = &parts->part[k].place[i];

            *place = ritz_roster_row(&roster, before[*place]);
        }
done:
    free(before);
    ritz_roster_free(&roster);
    return status;
}

/* Rows for dofs that only equations name; what is fixed and what is alive. */
static ritz_status find_rows(const ritz_deck *deck, ritz_parts *parts,
                             const ritz_component *component, ritz_tying *it)
{
    ritz_status status = RITZ_OK;
    ritz_names *names = &it->names;
    bool sorted = is_ascending(names);
    ritz_roster roster = {0};
    ritz_dof *missing = NULL;
    int64_t count = 0;

    RITZ_TRY(ritz_roster_new(names->count, names->dof, &roster));
    RITZ_TRY(list_missing(deck, &roster, &count, &missing));
    RITZ_TRY(ritz_tying_append(count, missing, it));
    if (sorted)
        RITZ_TRY(sort_names(names, parts));
    for (int64_t k = 0; k < parts->count; k++)
        if (parts->part[k].becomes == &component->K ||
            parts->part[k].becomes == &component->M)
            ritz_part_mark(&parts->part[k], it->alive);
    for (int64_t k = 0; k < names->count; k++) {
        bool row = ritz_roster_row(&roster, names->dof[k]) >= 0;

        it->fixed[k] =
            deck->num_fixed > 0 &&
            bsearch(&names->dof[k], deck->fixed, (size_t)deck->num_fixed,
                    sizeof *deck->fixed, ritz_dof_compare) != NULL;
        it->outside[k] = !row && !it->acts;
    }
done:
    ritz_roster_free(&roster);
    free(missing);
    return status;
}

/* ---- whether constraints act ------------------------------------------- */

static ritz_status find_action(const ritz_deck *deck, ritz_tying *it)
{
    ritz_status status = RITZ_OK;
    const ritz_equations *eq = &deck->equations;
    ritz_roster roster = {0};

    it->acts = deck->num_constraints > 0 && it->names.whole;
    RITZ_TRY(ritz_roster_new(it->names.count, it->names.dof, &roster));
    for (int64_t e = 0; e < eq->count && !it->acts; e++)
        it->acts = ritz_roster_row(&roster, eq->dependent[e]) >= 0;
done:
    ritz_roster_free(&roster);
    return status;
}

/* What is not understood matters where the dofs are still there. */
static ritz_status heed_refusal(ritz_deck *deck, const ritz_tying *it,
                                ritz_import_report *report)
{
    ritz_equations *eq = &deck->equations;

    if (!eq->refused)
        return RITZ_OK;
    RITZ_REFUSE_IF(it->acts, RITZ_ERR_FORMAT,
                   "%s; the matrices still hold its dofs, and matrices of the "
                   "a-set would not",
                   eq->refused);
    report->unknown = eq->refused;
    eq->refused = NULL;
    ritz_equations_free(eq);
    return RITZ_OK;
}

/* A dof is in the a-set or depends, not both. */
static ritz_status check_sets(const ritz_deck *deck)
{
    const ritz_equations *eq = &deck->equations;
    char name[RITZ_DOF_NAME_SIZE];
    char cited[RITZ_CITATION_SIZE];

    for (int64_t e = 0; e < eq->count; e++)
        for (int s = 0; s < RITZ_NUM_SETS; s++)
            RITZ_REFUSE_IF(
                deck->num_sets[s] > 0 &&
                    bsearch(&eq->dependent[e], deck->set[s],
                            (size_t)deck->num_sets[s], sizeof *deck->set[s],
                            ritz_dof_compare),
                RITZ_ERR_FORMAT,
                "'%s' depends on %s and is in the a-set: it cannot be both",
                ritz_dof_name(eq->dependent[e], name),
                ritz_equations_cite(eq, eq->source[e], cited));
    return RITZ_OK;
}

static ritz_status name_constraints(const ritz_deck *deck,
                                    ritz_import_report *report)
{
    if (report->unknown)
        return RITZ_OK;
    RITZ_CHECK_NEW(report->constraint, deck->num_constraints);
    for (int64_t k = 0; k < deck->num_constraints; k++) {
        int64_t at = report->num_constraints;

        /* cards of one MPC set have one name, and mostly follow each other */
        if (at > 0 &&
            strcmp(deck->constraint[k], report->constraint[at - 1]) == 0)
            continue;
        memcpy(report->constraint[at], deck->constraint[k],
               sizeof *report->constraint);
        report->num_constraints++;
    }
    return RITZ_OK;
}

ritz_status ritz_tying_solve(ritz_tying *tying)
{
    ritz_elimination_free(&tying->by);
    return ritz_elimination_new(&tying->deck->equations, tying->names.count,
                                tying->names.dof, tying->fixed, &tying->by);
}

ritz_status ritz_tying_new(const ritz_import_request *request, ritz_deck *deck,
                           ritz_parts *parts, ritz_names *names,
                           const ritz_component *component,
                           ritz_import_report *report, ritz_tying *out)
{
    ritz_status status = RITZ_OK;
    ritz_tying new = {.deck = deck, .names = *names};

    *names = (ritz_names){0};
    RITZ_TRY(find_action(deck, &new));
    RITZ_TRY(heed_refusal(deck, &new, report));
    RITZ_NEW(new.fixed, new.names.count);
    RITZ_NEW(new.alive, new.names.count);
    RITZ_NEW(new.outside, new.names.count);
    RITZ_TRY(find_rows(deck, parts, component, &new));
    if (new.acts)
        RITZ_TRY(check_sets(deck));
    RITZ_TRY(name_constraints(deck, report));
    RITZ_TRY(ritz_tying_solve(&new));
    RITZ_TRY(ritz_tying_ports(request, deck, &new, report));
    *out = new;
    new = (ritz_tying){0};
done:
    ritz_tying_free(&new);
    return status;
}

void ritz_tying_free(ritz_tying *tying)
{
    ritz_names_free(&tying->names);
    free(tying->fixed);
    free(tying->alive);
    free(tying->outside);
    ritz_elimination_free(&tying->by);
    *tying = (ritz_tying){0};
}
