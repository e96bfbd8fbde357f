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

#include <stdlib.h>
#include <string.h>

/* ---- which rows there are ----------------------------------------------- */

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

static bool is_ascending(const ritz_row_names *names)
{
    for (int64_t k = 1; k < names->count; k++)
        if (ritz_dof_compare(&names->dof[k - 1], &names->dof[k]) >= 0)
            return false;
    return true;
}

/* Names that ascend go on doing so: the rows of parts are placed anew. */
static ritz_status sort_names(ritz_row_names *names, ritz_parts *parts)
{
    RITZ_OWN_ARRAY ritz_dof *before = NULL;
    RITZ_OWN(ritz_roster) roster = {0};

    RITZ_CHECK_NEW(before, names->count);
    if (names->count > 0)
        memcpy(before, names->dof, (size_t)names->count * sizeof *before);
    names->count = ritz_dof_distinct(names->count, names->dof);
    RITZ_CHECK(ritz_roster_new(names->count, names->dof, &roster));
    for (int64_t k = 0; k < parts->count; k++)
        for (int64_t i = 0; i < parts->part[k].matrix.A.nrow; i++) {
            int64_t *place = &parts->part[k].place[i];

            *place = ritz_roster_row(&roster, before[*place]);
        }
    return RITZ_OK;
}

/* Rows for dofs that only equations name; what is fixed and what is alive. */
static ritz_status find_rows(const ritz_deck *deck, ritz_parts *parts,
                             const ritz_component *component, ritz_tying *it)
{
    ritz_row_names *names = &it->names;
    bool sorted = is_ascending(names);
    RITZ_OWN(ritz_roster) roster = {0};
    RITZ_OWN_ARRAY ritz_dof *missing = NULL;
    int64_t count = 0;

    RITZ_CHECK(ritz_roster_new(names->count, names->dof, &roster));
    RITZ_CHECK(list_missing(deck, &roster, &count, &missing));
    RITZ_CHECK(ritz_tying_append(count, missing, it));
    if (sorted)
        RITZ_CHECK(sort_names(names, parts));
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
    return RITZ_OK;
}

/* ---- whether constraints act -------------------------------------------- */

static ritz_status find_action(const ritz_deck *deck, ritz_tying *it)
{
    const ritz_equations *eq = &deck->equations;
    RITZ_OWN(ritz_roster) roster = {0};

    it->acts = deck->num_constraints > 0 && it->names.whole;
    RITZ_CHECK(ritz_roster_new(it->names.count, it->names.dof, &roster));
    for (int64_t e = 0; e < eq->count && !it->acts; e++)
        it->acts = ritz_roster_row(&roster, eq->dependent[e]) >= 0;
    return RITZ_OK;
}

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

ritz_status ritz_tying_new(ritz_deck *deck, ritz_parts *parts,
                           ritz_row_names *names,
                           const ritz_component *component,
                           ritz_import_report *report, ritz_tying *out)
{
    RITZ_OWN(ritz_tying) new = {.deck = deck, .names = *names};

    *names = (ritz_row_names){0};
    RITZ_CHECK(find_action(deck, &new));
    RITZ_CHECK(pass_refusal(deck, &new, report));
    RITZ_CHECK_NEW(new.fixed, new.names.count);
    RITZ_CHECK_NEW(new.alive, new.names.count);
    RITZ_CHECK_NEW(new.outside, new.names.count);
    RITZ_CHECK(find_rows(deck, parts, component, &new));
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
    free(tying->fixed);
    free(tying->alive);
    free(tying->outside);
    ritz_elimination_free(&tying->by);
    *tying = (ritz_tying){0};
}

/* ---- constraints applied ------------------------------------------------ */

/* Rows of G that a part has, with columns renumbered. */
static ritz_status rows_of(const ritz_sparse *G_turned, const ritz_part *part,
                           const int64_t *column, int64_t n, ritz_sparse *out)
{
    int64_t rows = part->matrix.A.nrow;
    int64_t count = 0;
    RITZ_OWN_ARRAY int64_t *row = NULL, *col = NULL;
    RITZ_OWN_ARRAY double *val = NULL;

    for (int64_t i = 0; i < rows; i++)
        count += G_turned->colptr[part->place[i] + 1] -
                 G_turned->colptr[part->place[i]];
    RITZ_CHECK_NEW(row, count);
    RITZ_CHECK_NEW(col, count);
    RITZ_CHECK_NEW(val, count);
    count = 0;
    for (int64_t i = 0; i < rows; i++) {
        int64_t from = part->place[i];

        for (int64_t p = G_turned->colptr[from]; p < G_turned->colptr[from + 1];
             p++) {
            row[count] = i;
            col[count] = column[G_turned->rowind[p]];
            val[count++] = G_turned->val[p];
        }
    }
    return ritz_sparse_from_triplets(rows, n, count, row, col, val, out);
}

/* A := G'AG, unsymmetric as it was: what is averaged away is to be reported. */
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

/* Columns of G that become rows; -1: dofs that the matrices have not. */
static ritz_status list_kept(const ritz_tying *tying, int64_t *column,
                             ritz_row_names *kept)
{
    const ritz_dofs *by = &tying->by.kept;

    RITZ_CHECK_NEW(kept->dof, by->count);
    for (int64_t j = 0; j < by->count; j++) {
        column[j] = -1;
        if (tying->outside[by->at[j]])
            continue;
        column[j] = kept->count;
        kept->dof[kept->count++] = tying->names.dof[by->at[j]];
    }
    memcpy(kept->map, tying->names.map, sizeof kept->map);
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

static ritz_status apply_part(const ritz_tying *tying,
                              const ritz_sparse *turned, const int64_t *column,
                              int64_t n, ritz_part *part)
{
    RITZ_OWN(ritz_sparse) G = {0};

    if (is_kept(tying, part)) {
        for (int64_t i = 0; i < part->matrix.A.nrow; i++) {
            int64_t *place = &part->place[i];

            *place = column[turned->rowind[turned->colptr[*place]]];
        }
        return RITZ_OK;
    }
    RITZ_CHECK(rows_of(turned, part, column, n, &G));
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
    RITZ_OWN(ritz_row_names) names = {0};
    RITZ_OWN(ritz_sparse) turned = {0};
    RITZ_OWN_ARRAY int64_t *column = NULL;

    RITZ_CHECK_NEW(column, tying->by.kept.count);
    RITZ_CHECK(list_kept(tying, column, &names));
    RITZ_CHECK(count_eliminated(tying, parts, &report->num_eliminated));
    RITZ_CHECK(ritz_sparse_transpose(&tying->by.G, &turned));
    for (int64_t k = 0; k < parts->count; k++)
        RITZ_CHECK(
            apply_part(tying, &turned, column, names.count, &parts->part[k]));
    RITZ_MOVE(*kept, names);
    return RITZ_OK;
}

/* ---- recovery ----------------------------------------------------------- */

/* Row of the component that a column of G is: -1 if that dof does not move,
 * -2 if nothing is known of it. */
static ritz_status list_rows(const ritz_tying *tying,
                             const ritz_component *component, int64_t *row)
{
    const ritz_dofs *kept = &tying->by.kept;
    RITZ_OWN(ritz_roster) roster = {0};

    RITZ_CHECK(ritz_roster_new(component->num_dofs, component->dof, &roster));
    for (int64_t j = 0; j < kept->count; j++) {
        int64_t k = kept->at[j];

        row[j] = ritz_roster_row(&roster, tying->names.dof[k]);
        if (tying->outside[k] && !tying->fixed[k])
            row[j] = -2;
    }
    return RITZ_OK;
}

static bool is_known(const ritz_sparse *turned, int64_t of, const int64_t *row)
{
    for (int64_t p = turned->colptr[of]; p < turned->colptr[of + 1]; p++)
        if (row[turned->rowind[p]] == -2)
            return false;
    return true;
}

/* Rows of G of the dofs that are gone, as far as they are known. */
static ritz_status gather_rows(const ritz_tying *tying,
                               const ritz_sparse *turned, const int64_t *row,
                               int64_t n, ritz_recovery *out)
{
    const ritz_dofs *gone = &tying->by.gone;
    int64_t most = tying->by.G.colptr[tying->by.G.ncol];
    RITZ_OWN_ARRAY int64_t *line = NULL, *col = NULL;
    RITZ_OWN_ARRAY double *val = NULL;
    int64_t count = 0;

    RITZ_CHECK_NEW(line, most);
    RITZ_CHECK_NEW(col, most);
    RITZ_CHECK_NEW(val, most);
    RITZ_CHECK_NEW(out->dof, gone->count);
    for (int64_t k = 0; k < gone->count; k++) {
        int64_t of = gone->at[k];

        if (!is_known(turned, of, row))
            continue;
        for (int64_t p = turned->colptr[of]; p < turned->colptr[of + 1]; p++) {
            if (row[turned->rowind[p]] < 0)
                continue;
            line[count] = out->count;
            col[count] = row[turned->rowind[p]];
            val[count++] = turned->val[p];
        }
        out->dof[out->count++] = tying->names.dof[of];
    }
    return ritz_sparse_from_triplets(out->count, n, count, line, col, val,
                                     &out->G);
}

ritz_status ritz_tying_recover(const ritz_tying *tying,
                               ritz_component *component,
                               ritz_import_report *report)
{
    RITZ_OWN(ritz_recovery) recovery = {0};
    RITZ_OWN(ritz_sparse) turned = {0};
    RITZ_OWN_ARRAY int64_t *row = NULL;

    if (tying->by.gone.count == 0)
        return RITZ_OK;
    RITZ_CHECK_NEW(row, tying->by.kept.count);
    RITZ_CHECK(list_rows(tying, component, row));
    RITZ_CHECK(ritz_sparse_transpose(&tying->by.G, &turned));
    RITZ_CHECK(
        gather_rows(tying, &turned, row, component->num_dofs, &recovery));
    report->num_recovered = recovery.count;
    report->num_lost = tying->by.gone.count - recovery.count;
    if (recovery.count == 0)
        return RITZ_OK;
    RITZ_MOVE(component->recovery, recovery);
    return RITZ_OK;
}
