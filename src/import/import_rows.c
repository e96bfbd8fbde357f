/*
 * From matrices as read to matrices of the component: rows are placed by name,
 * what the deck fixes is left out (u = 0), and rows empty in both K and M are
 * left out too, as nothing moves there.
 */
#include "import/import.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* Rows of the component-to-be where a matrix has an entry that is not zero. */
void ritz_part_mark(const ritz_part *part, bool *taken)
{
    const ritz_sparse *A = &part->matrix.A;

    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            if (A->val[p] != 0.0) {
                taken[part->place[j]] = true;
                taken[part->place[A->rowind[p]]] = true;
            }
}

/*
 * A(place, place) of the rows that stay. Zeros are left out, so that a dense
 * and a sparse spelling of a matrix become the same.
 */
static ritz_status scatter(const ritz_part *part, const int64_t *stays,
                           int64_t n, ritz_sparse *out)
{
    ritz_status status = RITZ_OK;
    const ritz_sparse *A = &part->matrix.A;
    int64_t nnz = A->colptr[A->ncol];
    int64_t kept = 0;
    int64_t *row = NULL;
    int64_t *col = NULL;
    double *val = NULL;

    RITZ_NEW(row, nnz);
    RITZ_NEW(col, nnz);
    RITZ_NEW(val, nnz);
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            row[kept] = stays[part->place[A->rowind[p]]];
            col[kept] = stays[part->place[j]];
            val[kept] = A->val[p];
            kept += A->val[p] != 0.0 && row[kept] >= 0 && col[kept] >= 0;
        }
    RITZ_TRY(ritz_sparse_from_triplets(n, n, kept, row, col, val, out));
done:
    free(row);
    free(col);
    free(val);
    return status;
}

/* Which rows hold stiffness, mass, and anything else. */
typedef struct presence {
    bool *K, *M, *other, *fixed;
} presence;

static ritz_status find_presence(const ritz_parts *parts, const ritz_deck *deck,
                                 const ritz_names *names,
                                 const ritz_component *component, presence *at)
{
    RITZ_CHECK_NEW(at->K, names->count);
    RITZ_CHECK_NEW(at->M, names->count);
    RITZ_CHECK_NEW(at->other, names->count);
    RITZ_CHECK_NEW(at->fixed, names->count);
    for (int64_t k = 0; k < parts->count; k++) {
        const ritz_part *part = &parts->part[k];

        if (part->becomes == &component->K)
            ritz_part_mark(part, at->K);
        else if (part->becomes == &component->M)
            ritz_part_mark(part, at->M);
        else
            ritz_part_mark(part, at->other);
    }
    for (int64_t k = 0; deck->num_fixed > 0 && k < names->count; k++)
        at->fixed[k] =
            bsearch(&names->dof[k], deck->fixed, (size_t)deck->num_fixed,
                    sizeof *deck->fixed, ritz_dof_compare) != NULL;
    return RITZ_OK;
}

/* Sort the rows: stays[k] is the new row, -1 if it is left out. */
static ritz_status sort_rows(const presence *at, const ritz_names *names,
                             bool rigid, int64_t *stays,
                             ritz_import_report *report, ritz_component *to)
{
    char name[RITZ_DOF_NAME_SIZE];

    for (int64_t k = 0; k < names->count; k++) {
        bool empty = !at->K[k] && !at->M[k];

        stays[k] = -1;
        if (at->fixed[k] && !empty) {
            report->fixed[report->num_fixed++] = names->dof[k];
            continue;
        }
        RITZ_REFUSE_IF(empty && at->other[k], RITZ_ERR_FORMAT,
                       "'%s' has damping or geometric stiffness, but neither "
                       "stiffness nor mass",
                       ritz_dof_name(names->dof[k], name));
        if (empty) {
            report->removed[report->num_removed++] = names->dof[k];
            continue;
        }
        report->num_massless += !at->M[k];
        report->num_floating += !at->K[k] && !rigid;
        stays[k] = to->num_dofs;
        to->dof[to->num_dofs++] = names->dof[k];
    }
    RITZ_REFUSE_IF(to->num_dofs == 0, RITZ_ERR_FORMAT,
                   "no row that is free to move has stiffness or mass");
    return RITZ_OK;
}

/* Positions and frames of the grids that have rows in the matrices. */
static ritz_status keep_grids(const ritz_grids *all, const ritz_roster *roster,
                              ritz_grids *out)
{
    ritz_status status = RITZ_OK;
    ritz_grids grids = {.num_frames = all->num_frames};
    int64_t count = 0;

    RITZ_NEW(grids.id, all->count);
    RITZ_NEW(grids.position, 3 * all->count);
    RITZ_NEW(grids.frame, all->count);
    RITZ_NEW(grids.axes, 9 * all->num_frames);
    if (all->num_frames > 0)
        memcpy(grids.axes, all->axes,
               9 * (size_t)all->num_frames * sizeof *all->axes);
    for (int64_t k = 0; k < all->count; k++) {
        int64_t at = ritz_roster_from(roster, all->id[k]);

        if (at == roster->count || roster->place[at].dof.grid != all->id[k])
            continue;
        grids.id[count] = all->id[k];
        grids.frame[count] = all->frame[k];
        memcpy(grids.position + 3 * count, all->position + 3 * k,
               3 * sizeof *all->position);
        count++;
    }
    grids.count = count;
    *out = grids;
    grids = (ritz_grids){0};
done:
    ritz_grids_free(&grids);
    return status;
}

/* One grid and no deck: wherever it is, that is the origin. */
static ritz_status place_alone(const ritz_names *names, ritz_grids *out)
{
    ritz_status status = RITZ_OK;
    ritz_grids grids = {.count = 1, .num_frames = 1};

    for (int64_t k = 0; k < names->count; k++)
        if (names->dof[k].grid != names->dof[0].grid ||
            names->dof[k].component == 0)
            goto done;
    RITZ_NEW(grids.id, 1);
    RITZ_NEW(grids.position, 3);
    RITZ_NEW(grids.frame, 1);
    RITZ_NEW(grids.axes, 9);
    grids.id[0] = names->dof[0].grid;
    for (int64_t i = 0; i < 3; i++)
        grids.axes[4 * i] = 1.0;
    *out = grids;
    grids = (ritz_grids){0};
done:
    ritz_grids_free(&grids);
    return status;
}

ritz_status ritz_import_place(const ritz_deck *deck, const ritz_names *names,
                              ritz_component *component)
{
    ritz_status status = RITZ_OK;
    ritz_roster roster = {0};

    if (deck->grids.count == 0)
        return place_alone(names, &component->grids);
    RITZ_TRY(ritz_roster_new(names->count, names->dof, &roster));
    RITZ_TRY(keep_grids(&deck->grids, &roster, &component->grids));
done:
    ritz_roster_free(&roster);
    return status;
}

ritz_status ritz_parts_settle(ritz_parts *parts, const ritz_deck *deck,
                              const ritz_names *names,
                              ritz_component *component,
                              ritz_import_report *report)
{
    ritz_status status = RITZ_OK;
    presence at = {0};
    int64_t *stays = NULL;
    bool rigid = true;

    for (int64_t k = 0; k < parts->count; k++)
        rigid = rigid && parts->part[k].becomes != &component->K;
    RITZ_NEW(stays, names->count);
    RITZ_NEW(component->dof, names->count);
    RITZ_NEW(report->removed, names->count);
    RITZ_NEW(report->fixed, names->count);
    RITZ_TRY(find_presence(parts, deck, names, component, &at));
    RITZ_TRY(sort_rows(&at, names, rigid, stays, report, component));
    for (int64_t k = 0; k < parts->count; k++)
        RITZ_TRY(scatter(&parts->part[k], stays, component->num_dofs,
                         parts->part[k].becomes));
    memcpy(report->map, names->map, sizeof report->map);
done:
    free(stays);
    free(at.K);
    free(at.M);
    free(at.other);
    free(at.fixed);
    return status;
}

void ritz_parts_free(ritz_parts *parts)
{
    for (int64_t k = 0; k < parts->count; k++) {
        ritz_matrix_free(&parts->part[k].matrix);
        free(parts->part[k].place);
    }
    free(parts->part);
    *parts = (ritz_parts){0};
}
