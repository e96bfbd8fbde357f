/*
 * MUG1, the displacements of the grids of all ports and of those that rows of
 * recovery name, six rows each. The table TUG1 names them (nastran_tables.c).
 */
#include "formats/nastran_displacements.h"

#include "base/alloc.h"
#include "formats/nastran_items.h"
#include "model/equations.h"

#include <stdlib.h>
#include <string.h>

/* The dofs whose displacements follow from T q: the rows of T, and behind them
   the recovered dofs, which depend on these. */
typedef struct displacement_source {
    const ritz_reduced *reduced;
    ritz_dof *dof;
    ritz_roster roster;
    ritz_sparse from; /* G'; column k gives recovered dof k by rows of T */
} displacement_source;

static void displacement_source_free(displacement_source *source)
{
    free(source->dof);
    ritz_roster_free(&source->roster);
    ritz_sparse_free(&source->from);
}

static ritz_status take_source(const ritz_reduced *reduced,
                               displacement_source *out)
{
    const ritz_recovery *recovery = &reduced->recovery;

    out->reduced = reduced;
    RITZ_CHECK(ritz_recovery_extend(recovery, reduced->num_dofs, reduced->dof,
                                    NULL, &out->dof, NULL));
    RITZ_CHECK(ritz_roster_new(reduced->num_dofs + recovery->count, out->dof,
                               &out->roster));
    if (recovery->count > 0)
        RITZ_CHECK(ritz_sparse_transpose(&recovery->G, &out->from));
    return RITZ_OK;
}

/* Displacement of a dof for a unit of coordinate j; 0 if the component does not
 * have the dof. */
static double displacement_of(const displacement_source *source, ritz_dof dof,
                              int64_t j)
{
    const double *t = ritz_dense_col(&source->reduced->T, j);
    const ritz_sparse *from = &source->from;
    const int64_t row = ritz_roster_row(&source->roster, dof);
    const int64_t k = row - source->reduced->num_dofs;
    double u = 0.0;

    if (k < 0)
        return row < 0 ? 0.0 : t[row];
    for (int64_t p = from->colptr[k]; p < from->colptr[k + 1]; p++)
        u += from->val[p] * t[from->rowind[p]];
    return u;
}

/* A grid or point, and from which rows of quantities its displacements are. */
typedef struct displaced_point {
    ritz_nastran_entry entry;
    int64_t from; /* row of the recovered ones; -1: of the component */
} displaced_point;

typedef struct displaced_points {
    int64_t count;
    displaced_point *at;
} displaced_points;

static void displaced_points_free(displaced_points *list)
{
    free(list->at);
}

/* By number, those of the component first. */
static int compare_points(const void *left, const void *right)
{
    const displaced_point *a = left;
    const displaced_point *b = right;

    if (a->entry.id != b->entry.id)
        return a->entry.id < b->entry.id ? -1 : 1;
    return (a->from > b->from) - (a->from < b->from);
}

/* The grids and scalar points of all ports and quantities, each once,
 * ascending. */
static ritz_status list_points(const ritz_reduced *reduced,
                               const ritz_nastran_elements *recovered,
                               displaced_points *out)
{
    int64_t count = recovered->count;
    int64_t kept = 0;

    for (int64_t p = 0; p < reduced->num_ports; p++)
        count += reduced->port[p].count;
    RITZ_CHECK_NEW(out->at, count);
    for (int64_t p = 0; p < reduced->num_ports; p++)
        for (int64_t k = 0; k < reduced->port[p].count; k++) {
            const ritz_dof dof = reduced->port[p].dof[k];
            displaced_point *new = &out->at[out->count++];

            new->entry.type =
                dof.component > 0 ? RITZ_NASTRAN_GRID : RITZ_NASTRAN_SCALAR;
            new->entry.id = dof.grid;
            new->entry.count = RITZ_NASTRAN_DOFS;
            new->from = -1;
        }
    for (int64_t k = 0; k < recovered->count; k++)
        out->at[out->count++] =
            (displaced_point){recovered->entry[k], recovered->entry[k].first};
    if (out->count > 1)
        qsort(out->at, (size_t)out->count, sizeof *out->at, compare_points);
    for (int64_t k = 0; k < out->count; k++)
        if (k == 0 || out->at[k].entry.id != out->at[kept - 1].entry.id)
            out->at[kept++] = out->at[k];
    out->count = kept;
    return RITZ_OK;
}

/* Of a scalar point the first row is its displacement, the others are zero. */
static void fill_rows(const displacement_source *source,
                      const ritz_nastran_rows *rows,
                      const ritz_nastran_entry *of, ritz_dense *A)
{
    const bool grid = of->type == RITZ_NASTRAN_GRID;

    for (int64_t k = 0; k < rows->order; k++)
        for (int64_t i = 0; i < (grid ? of->count : 1); i++) {
            const ritz_dof dof = {of->id, grid ? i + 1 : 0};

            ritz_dense_col(A, k)[of->first + i] =
                displacement_of(source, dof, rows->at[k]);
        }
}

static void copy_rows(const ritz_dense *from, const displaced_point *point,
                      const ritz_nastran_entry *to, ritz_dense *A)
{
    for (int64_t k = 0; k < A->ncol; k++)
        memcpy(ritz_dense_col(A, k) + to->first,
               ritz_dense_col(from, k) + point->from,
               (size_t)to->count * sizeof *A->val);
}

/* Each grid and point gets its rows. */
static ritz_status fill_points(const displaced_points *list,
                               const ritz_reduced *reduced,
                               const ritz_nastran_rows *rows,
                               ritz_nastran_displacements *all)
{
    RITZ_OWN(displacement_source) source = {0};
    RITZ_OWN(ritz_dense) recovered = {0};
    int64_t count = 0;

    RITZ_CHECK(take_source(reduced, &source));
    RITZ_CHECK(ritz_nastran_elements_matrix(&all->recovered, rows, &recovered));
    RITZ_CHECK_NEW(all->entry, list->count);
    for (int64_t k = 0; k < list->count; k++) {
        all->entry[k] = list->at[k].entry;
        all->entry[k].first = count;
        count += all->entry[k].count;
    }
    all->count = list->count;
    RITZ_CHECK(ritz_dense_new(count, rows->order, &all->A));
    for (int64_t k = 0; k < list->count; k++)
        if (list->at[k].from < 0)
            fill_rows(&source, rows, &all->entry[k], &all->A);
        else
            copy_rows(&recovered, &list->at[k], &all->entry[k], &all->A);
    return RITZ_OK;
}

ritz_status ritz_nastran_displacements_new(const ritz_reduced *reduced,
                                           const ritz_nastran_rows *rows,
                                           ritz_nastran_displacements *out)
{
    RITZ_OWN(ritz_nastran_displacements) all = {0};
    RITZ_OWN(displaced_points) list = {0};

    RITZ_CHECK(
        ritz_nastran_elements_new(reduced, "displacement", &all.recovered));
    RITZ_CHECK(list_points(reduced, &all.recovered, &list));
    if (list.count > 0)
        RITZ_CHECK(fill_points(&list, reduced, rows, &all));
    RITZ_MOVE(*out, all);
    return RITZ_OK;
}

void ritz_nastran_displacements_free(ritz_nastran_displacements *all)
{
    free(all->entry);
    ritz_dense_free(&all->A);
    ritz_nastran_elements_free(&all->recovered);
    *all = (ritz_nastran_displacements){0};
}
