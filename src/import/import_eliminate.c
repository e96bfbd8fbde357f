/* Constraints applied to the matrices, and the dofs that are gone by them. */
#include "import/import.h"

#include "base/alloc.h"
#include "base/search.h"

#include <stdlib.h>
#include <string.h>

/* Rows of G that a part has, with columns renumbered. */
static ritz_status rows_of(const ritz_sparse *G_turned, const ritz_part *part,
                           const int64_t *column, int64_t n, ritz_sparse *out)
{
    ritz_status status = RITZ_OK;
    int64_t rows = part->matrix.A.nrow;
    int64_t count = 0;
    int64_t *row = NULL, *col = NULL;
    double *val = NULL;

    for (int64_t i = 0; i < rows; i++)
        count += G_turned->colptr[part->place[i] + 1] -
                 G_turned->colptr[part->place[i]];
    RITZ_NEW(row, count);
    RITZ_NEW(col, count);
    RITZ_NEW(val, count);
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
    RITZ_TRY(ritz_sparse_from_triplets(rows, n, count, row, col, val, out));
done:
    free(row);
    free(col);
    free(val);
    return status;
}

/* A := G'AG, unsymmetric as it was: what is averaged away is to be reported. */
static ritz_status project(const ritz_sparse *G, ritz_sparse *A)
{
    ritz_status status = RITZ_OK;
    ritz_sparse AG = {0}, turned = {0}, C = {0};

    RITZ_TRY(ritz_sparse_product(A, G, &AG));
    RITZ_TRY(ritz_sparse_transpose(G, &turned));
    RITZ_TRY(ritz_sparse_product(&turned, &AG, &C));
    ritz_sparse_free(A);
    *A = C;
    C = (ritz_sparse){0};
done:
    ritz_sparse_free(&AG);
    ritz_sparse_free(&turned);
    ritz_sparse_free(&C);
    return status;
}

/* Columns of G that become rows; -1: dofs that the matrices have not. */
static ritz_status list_kept(const ritz_tying *tying, int64_t *column,
                             ritz_names *kept)
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

/* Whether every row of G that a part has is one of the identity. */
static bool is_kept(const ritz_tying *tying, const ritz_part *part)
{
    const ritz_dofs *gone = &tying->by.gone;

    for (int64_t i = 0; gone->count > 0 && i < part->matrix.A.nrow; i++)
        if (ritz_search(gone->count, gone->at, part->place[i]) >= 0)
            return false;
    return true;
}

static ritz_status apply(const ritz_tying *tying, const ritz_sparse *turned,
                         const int64_t *column, int64_t n, ritz_part *part)
{
    ritz_status status = RITZ_OK;
    ritz_sparse G = {0};

    if (is_kept(tying, part)) {
        for (int64_t i = 0; i < part->matrix.A.nrow; i++) {
            int64_t *place = &part->place[i];

            *place = column[turned->rowind[turned->colptr[*place]]];
        }
        goto done;
    }
    RITZ_TRY(rows_of(turned, part, column, n, &G));
    RITZ_TRY(project(&G, &part->matrix.A));
    free(part->place);
    RITZ_NEW(part->place, n);
    for (int64_t j = 0; j < n; j++)
        part->place[j] = j;
done:
    ritz_sparse_free(&G);
    return status;
}

/* Dependent dofs of which a matrix has a row. */
static ritz_status count_eliminated(const ritz_tying *tying,
                                    const ritz_parts *parts, int64_t *out)
{
    ritz_status status = RITZ_OK;
    bool *row = NULL;

    RITZ_NEW(row, tying->names.count);
    for (int64_t k = 0; k < parts->count; k++)
        for (int64_t i = 0; i < parts->part[k].matrix.A.nrow; i++)
            row[parts->part[k].place[i]] = true;
    for (int64_t k = 0; k < tying->by.gone.count; k++)
        *out += row[tying->by.gone.at[k]];
done:
    free(row);
    return status;
}

ritz_status ritz_tying_apply(const ritz_tying *tying, ritz_parts *parts,
                             ritz_names *kept, ritz_import_report *report)
{
    ritz_status status = RITZ_OK;
    ritz_names names = {0};
    ritz_sparse turned = {0};
    int64_t *column = NULL;

    RITZ_NEW(column, tying->by.kept.count);
    RITZ_TRY(list_kept(tying, column, &names));
    RITZ_TRY(count_eliminated(tying, parts, &report->num_eliminated));
    RITZ_TRY(ritz_sparse_transpose(&tying->by.G, &turned));
    for (int64_t k = 0; k < parts->count; k++)
        RITZ_TRY(apply(tying, &turned, column, names.count, &parts->part[k]));
    *kept = names;
    names = (ritz_names){0};
done:
    free(column);
    ritz_names_free(&names);
    ritz_sparse_free(&turned);
    return status;
}

/* ---- recovery ---------------------------------------------------------- */

/* Row of the component that a column of G is: -1 if that dof does not move,
 * -2 if nothing is known of it. */
static ritz_status list_rows(const ritz_tying *tying,
                             const ritz_component *component, int64_t *row)
{
    ritz_status status = RITZ_OK;
    const ritz_dofs *kept = &tying->by.kept;
    ritz_roster roster = {0};

    RITZ_TRY(ritz_roster_new(component->num_dofs, component->dof, &roster));
    for (int64_t j = 0; j < kept->count; j++) {
        int64_t k = kept->at[j];

        row[j] = ritz_roster_row(&roster, tying->names.dof[k]);
        if (tying->outside[k] && !tying->fixed[k])
            row[j] = -2;
    }
done:
    ritz_roster_free(&roster);
    return status;
}

static bool is_known(const ritz_sparse *turned, int64_t of, const int64_t *row)
{
    for (int64_t p = turned->colptr[of]; p < turned->colptr[of + 1]; p++)
        if (row[turned->rowind[p]] == -2)
            return false;
    return true;
}

/* Rows of G of the dofs that are gone, as far as they are known. */
static ritz_status gather(const ritz_tying *tying, const ritz_sparse *turned,
                          const int64_t *row, int64_t n, ritz_recovery *out)
{
    ritz_status status = RITZ_OK;
    const ritz_dofs *gone = &tying->by.gone;
    int64_t most = tying->by.G.colptr[tying->by.G.ncol];
    int64_t *line = NULL, *col = NULL;
    double *val = NULL;
    int64_t count = 0;

    RITZ_NEW(line, most);
    RITZ_NEW(col, most);
    RITZ_NEW(val, most);
    RITZ_NEW(out->dof, gone->count);
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
    RITZ_TRY(ritz_sparse_from_triplets(out->count, n, count, line, col, val,
                                       &out->G));
done:
    free(line);
    free(col);
    free(val);
    return status;
}

ritz_status ritz_tying_recover(const ritz_tying *tying,
                               ritz_component *component,
                               ritz_import_report *report)
{
    ritz_status status = RITZ_OK;
    ritz_recovery recovery = {0};
    ritz_sparse turned = {0};
    int64_t *row = NULL;

    if (tying->by.gone.count == 0)
        goto done;
    RITZ_NEW(row, tying->by.kept.count);
    RITZ_TRY(list_rows(tying, component, row));
    RITZ_TRY(ritz_sparse_transpose(&tying->by.G, &turned));
    RITZ_TRY(gather(tying, &turned, row, component->num_dofs, &recovery));
    report->num_recovered = recovery.count;
    report->num_lost = tying->by.gone.count - recovery.count;
    if (recovery.count == 0)
        goto done;
    component->recovery = recovery;
    recovery = (ritz_recovery){0};
done:
    free(row);
    ritz_sparse_free(&turned);
    ritz_recovery_free(&recovery);
    return status;
}
