/*
 * Constraints between the rows of matrices. With G from the equations of the
 * deck and of ports, u = G u_n,
 *
 *     K_nn = G' K G, and the same of M, D, K4 and K_G
 *
 * Matrices without rows for dependent dofs have been through that already: then
 * G only says how these dofs follow, as far as what they follow is there.
 */
#include "base/alloc.h"
#include "base/search.h"
#include "import/import.h"
#include "model/equations.h"

#include <stdlib.h>
#include <string.h>

/* ---- which rows there are ----------------------------------------------- */

ritz_status ritz_tying_append(int64_t count, const ritz_dof *dof,
                              ritz_tying *tying)
{
    ritz_row_names *names = &tying->names;

    RITZ_CHECK(ritz_array_extend(&names->dof, names->count, count,
                                 sizeof *names->dof));
    RITZ_CHECK(ritz_array_extend(&tying->mark, names->count, count,
                                 sizeof *tying->mark));
    if (count > 0)
        memcpy(names->dof + names->count, dof, (size_t)count * sizeof *dof);
    names->count += count;
    return RITZ_OK;
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

static bool is_ascending(const ritz_row_names *names)
{
    for (int64_t k = 1; k < names->count; k++)
        if (ritz_dof_compare(&names->dof[k - 1], &names->dof[k]) >= 0)
            return false;
    return true;
}

/* Sort names that were ascending before more were added; place parts anew. */
static ritz_status sort_names(ritz_row_names *names, ritz_parts *parts)
{
    RITZ_OWN_ARRAY ritz_dof *before = NULL;
    RITZ_OWN(ritz_roster) roster = {0};

    RITZ_CHECK_COPY(before, names->dof, names->count);
    names->count = ritz_dof_distinct(names->count, names->dof);
    RITZ_CHECK(ritz_roster_new(names->count, names->dof, &roster));
    for (int64_t k = 0; k < parts->count; k++)
        for (int64_t i = 0; i < parts->part[k].matrix.A.nrow; i++) {
            int64_t *place = &parts->part[k].place[i];

            *place = ritz_roster_row(&roster, before[*place]);
        }
    return RITZ_OK;
}

/* Add rows for dofs that only equations name, and mark all rows. */
static ritz_status find_rows(const ritz_deck *deck, const ritz_roster *roster,
                             ritz_parts *parts, const ritz_component *component,
                             ritz_tying *it)
{
    ritz_row_names *names = &it->names;
    bool sorted = is_ascending(names);
    RITZ_OWN_ARRAY ritz_dof *missing = NULL;
    int64_t count = 0;

    RITZ_CHECK(list_missing(deck, roster, &count, &missing));
    RITZ_CHECK(ritz_tying_append(count, missing, it));
    if (sorted)
        RITZ_CHECK(sort_names(names, parts));
    for (int64_t k = 0; k < parts->count; k++)
        if (parts->part[k].becomes == &component->K ||
            parts->part[k].becomes == &component->M)
            ritz_part_mark(&parts->part[k], RITZ_TIED_ALIVE, it->mark);
    for (int64_t k = 0; k < names->count; k++) {
        if (ritz_dof_among(names->dof[k], deck->num_fixed, deck->fixed))
            it->mark[k] |= RITZ_TIED_FIXED;
        if (!it->acts && ritz_roster_row(roster, names->dof[k]) < 0)
            it->mark[k] |= RITZ_TIED_OUTSIDE;
    }
    return RITZ_OK;
}

/* ---- whether constraints act -------------------------------------------- */

/* A constraint that is not understood is refused only if the matrices still
 * have its dofs. */
static ritz_status pass_refusal(ritz_deck *deck, const ritz_tying *it,
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
                ritz_dof_among(eq->dependent[e], deck->num_sets[s],
                               deck->set[s]),
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
    RITZ_OWN_ARRAY bool *fixed = NULL;

    RITZ_CHECK_NEW(fixed, tying->names.count);
    for (int64_t k = 0; k < tying->names.count; k++)
        fixed[k] = tying->mark[k] & RITZ_TIED_FIXED;
    ritz_elimination_free(&tying->by);
    return ritz_elimination_new(&tying->deck->equations, tying->names.count,
                                tying->names.dof, fixed, &tying->by);
}

ritz_status ritz_tying_new(ritz_deck *deck, ritz_parts *parts,
                           ritz_row_names *names,
                           const ritz_component *component,
                           ritz_import_report *report, ritz_tying *out)
{
    const ritz_equations *eq = &deck->equations;
    RITZ_OWN(ritz_tying) new = {.deck = deck, .names = *names};
    RITZ_OWN(ritz_roster) roster = {0};

    *names = (ritz_row_names){0};
    new.acts = deck->num_constraints > 0 && new.names.whole;
    RITZ_CHECK(ritz_roster_new(new.names.count, new.names.dof, &roster));
    for (int64_t e = 0; e < eq->count && !new.acts; e++)
        new.acts = ritz_roster_row(&roster, eq->dependent[e]) >= 0;
    RITZ_CHECK(pass_refusal(deck, &new, report));
    RITZ_CHECK_NEW(new.mark, new.names.count);
    RITZ_CHECK(find_rows(deck, &roster, parts, component, &new));
    if (new.acts)
        RITZ_CHECK(check_sets(deck));
    RITZ_CHECK(name_constraints(deck, report));
    RITZ_CHECK(ritz_tying_solve(&new));
    RITZ_MOVE(*out, new);
    return RITZ_OK;
}

void ritz_tying_free(ritz_tying *tying)
{
    ritz_row_names_free(&tying->names);
    free(tying->mark);
    ritz_elimination_free(&tying->by);
    *tying = (ritz_tying){0};
}

/* ---- constraints applied ------------------------------------------------ */

/* A := G'AG, not symmetrised, as the asymmetry of A is to be reported. */
static ritz_status project_matrix(const ritz_sparse *G, ritz_sparse *A)
{
    RITZ_OWN(ritz_sparse) AG = {0}, turned = {0}, C = {0};

    RITZ_CHECK(ritz_sparse_product(A, G, &AG));
    RITZ_CHECK(ritz_sparse_transpose(G, &turned));
    RITZ_CHECK(ritz_sparse_product(&turned, &AG, &C));
    ritz_sparse_free(A);
    RITZ_MOVE(*A, C);
    return RITZ_OK;
}

/* True if no row of the part is eliminated: G is the identity there. */
static bool is_kept(const ritz_tying *tying, const ritz_part *part)
{
    const ritz_dofs *gone = &tying->by.gone;

    for (int64_t i = 0; gone->count > 0 && i < part->matrix.A.nrow; i++)
        if (ritz_search(gone->count, gone->at, part->place[i]) >= 0)
            return false;
    return true;
}

/* A := G'AG of a part, with those columns of G that become rows. */
static ritz_status apply_part(const ritz_tying *tying, int64_t n,
                              const int64_t *column, ritz_part *part)
{
    const ritz_elimination *by = &tying->by;
    int64_t rows = part->matrix.A.nrow;
    RITZ_OWN(ritz_sparse) G = {0};

    if (is_kept(tying, part)) {
        for (int64_t i = 0; i < rows; i++)
            part->place[i] = ritz_search(
                n, column,
                ritz_search(by->kept.count, by->kept.at, part->place[i]));
        return RITZ_OK;
    }
    RITZ_CHECK(ritz_sparse_extract(&by->G, rows, part->place, n, column, &G));
    RITZ_CHECK(project_matrix(&G, &part->matrix.A));
    free(part->place);
    RITZ_CHECK_NEW(part->place, n);
    for (int64_t j = 0; j < n; j++)
        part->place[j] = j;
    return RITZ_OK;
}

/* Dependent dofs of which a matrix has a row. */
static ritz_status count_eliminated(const ritz_tying *tying,
                                    const ritz_parts *parts, int64_t *out)
{
    RITZ_OWN_ARRAY bool *row = NULL;

    RITZ_CHECK_NEW(row, tying->names.count);
    for (int64_t k = 0; k < parts->count; k++)
        for (int64_t i = 0; i < parts->part[k].matrix.A.nrow; i++)
            row[parts->part[k].place[i]] = true;
    for (int64_t k = 0; k < tying->by.gone.count; k++)
        *out += row[tying->by.gone.at[k]];
    return RITZ_OK;
}

ritz_status ritz_tying_apply(const ritz_tying *tying, ritz_parts *parts,
                             ritz_row_names *kept, ritz_import_report *report)
{
    const ritz_dofs *by = &tying->by.kept;
    RITZ_OWN(ritz_row_names) names = {0};
    RITZ_OWN_ARRAY int64_t *column = NULL; /* of G, of each row that stays */

    RITZ_CHECK_NEW(column, by->count);
    RITZ_CHECK_NEW(names.dof, by->count);
    for (int64_t j = 0; j < by->count; j++) {
        if (tying->mark[by->at[j]] & RITZ_TIED_OUTSIDE)
            continue;
        column[names.count] = j;
        names.dof[names.count++] = tying->names.dof[by->at[j]];
    }
    memcpy(names.map, tying->names.map, sizeof names.map);
    RITZ_CHECK(count_eliminated(tying, parts, &report->num_eliminated));
    for (int64_t k = 0; k < parts->count; k++)
        RITZ_CHECK(apply_part(tying, names.count, column, &parts->part[k]));
    RITZ_MOVE(*kept, names);
    return RITZ_OK;
}

/* ---- recovery ----------------------------------------------------------- */

void ritz_tying_unknown(const ritz_tying *tying, bool *unknown)
{
    const ritz_sparse *G = &tying->by.G;

    for (int64_t j = 0; j < G->ncol; j++)
        if ((tying->mark[tying->by.kept.at[j]] &
             (RITZ_TIED_OUTSIDE | RITZ_TIED_FIXED)) == RITZ_TIED_OUTSIDE)
            for (int64_t p = G->colptr[j]; p < G->colptr[j + 1]; p++)
                unknown[G->rowind[p]] = true;
}

ritz_status ritz_tying_recover(const ritz_tying *tying,
                               ritz_component *component,
                               ritz_import_report *report)
{
    const ritz_dofs *kept = &tying->by.kept, *gone = &tying->by.gone;
    RITZ_OWN(ritz_recovery) recovery = {0};
    RITZ_OWN(ritz_roster) roster = {0};
    RITZ_OWN_ARRAY int64_t *row = NULL, *column = NULL; /* of G */
    RITZ_OWN_ARRAY bool *unknown = NULL;

    if (gone->count == 0)
        return RITZ_OK;
    RITZ_CHECK_NEW(row, gone->count);
    RITZ_CHECK_NEW(column, component->num_dofs);
    RITZ_CHECK_NEW(unknown, tying->names.count);
    RITZ_CHECK_NEW(recovery.dof, gone->count);
    RITZ_CHECK(ritz_roster_new(component->num_dofs, component->dof, &roster));
    for (int64_t j = 0; j < kept->count; j++) {
        int64_t k = ritz_roster_row(&roster, tying->names.dof[kept->at[j]]);

        if (k >= 0)
            column[k] = j;
    }
    ritz_tying_unknown(tying, unknown);
    for (int64_t k = 0; k < gone->count; k++)
        if (!unknown[gone->at[k]]) {
            row[recovery.count] = gone->at[k];
            recovery.dof[recovery.count++] = tying->names.dof[gone->at[k]];
        }
    report->num_recovered = recovery.count;
    report->num_lost = gone->count - recovery.count;
    if (recovery.count == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_sparse_extract(&tying->by.G, recovery.count, row,
                                   component->num_dofs, column, &recovery.G));
    RITZ_MOVE(component->recovery, recovery);
    return RITZ_OK;
}
