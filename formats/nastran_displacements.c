/*
 * MUG1, the displacements of the grids of all ports, six rows each, and the
 * table TUG1, which says whose they are:
 *
 *     DTI  TUG1  0  rows  columns  32767  0  7  0
 *          PHIP     7           REAL  1  ENDREC
 *     DTI  TUG1  1  1  0.  2  0.  ...  ENDREC                 for each column
 *     DTI  TUG1  2
 *          TYPE  ID  COMP  ROW  TYPE  ID  COMP  ROW
 *          1     3   6     1    2     1001  1  7  ...  ENDREC
 *
 * with type 1 of grids and 2 of scalar points, and the number of rows for COMP.
 * The table is that of files that two programs of NASTRAN wrote, and of
 * pyYeti's writer [Widrick2024].
 */
#include "formats/nastran_displacements.h"

#include "base/alloc.h"
#include "formats/small_field.h"
#include "model/equations.h"

#include <stdlib.h>

enum { GRID_DOFS = 6 };

/* The dofs that T and the recovery know, by name. */
typedef struct displacement_source {
    const ritz_reduced *reduced;
    ritz_dof *dof;
    ritz_roster roster;
    ritz_sparse from; /* G', whose column k is recovered dof k */
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

/* The grids and scalar points of all ports, each once, ascending. */
static ritz_status list_points(const ritz_reduced *reduced,
                               ritz_nastran_displacements *all)
{
    RITZ_OWN_ARRAY ritz_dof *dof = NULL;
    int64_t count = 0;
    int64_t row = 0;

    for (int64_t p = 0; p < reduced->num_ports; p++)
        count += reduced->port[p].count;
    RITZ_CHECK_NEW(dof, count);
    count = 0;
    for (int64_t p = 0; p < reduced->num_ports; p++)
        for (int64_t k = 0; k < reduced->port[p].count; k++) {
            dof[count] = reduced->port[p].dof[k];
            dof[count].component = dof[count].component > 0;
            count++;
        }
    count = ritz_dof_distinct(count, dof);
    RITZ_CHECK_NEW(all->point, count);
    for (int64_t k = 0; k < count; k++) {
        const int64_t rows = dof[k].component > 0 ? GRID_DOFS : 1;

        all->point[all->count++] = (ritz_nastran_point){dof[k].grid, row, rows};
        row += rows;
    }
    return RITZ_OK;
}

static void fill_rows(const displacement_source *source,
                      const ritz_nastran_rows *rows,
                      const ritz_nastran_point *of, ritz_dense *A)
{
    for (int64_t k = 0; k < rows->order; k++)
        for (int64_t i = 0; i < of->count; i++) {
            const ritz_dof dof = {of->id, of->count > 1 ? i + 1 : 0};

            ritz_dense_col(A, k)[of->first + i] =
                displacement_of(source, dof, rows->at[k]);
        }
}

ritz_status ritz_nastran_displacements_new(const ritz_reduced *reduced,
                                           const ritz_nastran_rows *rows,
                                           ritz_nastran_displacements *out)
{
    RITZ_OWN(ritz_nastran_displacements) all = {0};
    RITZ_OWN(displacement_source) source = {0};
    const ritz_nastran_point *last = NULL;

    RITZ_CHECK(list_points(reduced, &all));
    if (all.count > 0) {
        last = &all.point[all.count - 1];
        RITZ_CHECK(take_source(reduced, &source));
        RITZ_CHECK(
            ritz_dense_new(last->first + last->count, rows->order, &all.A));
        for (int64_t k = 0; k < all.count; k++)
            fill_rows(&source, rows, &all.point[k], &all.A);
    }
    RITZ_MOVE(*out, all);
    return RITZ_OK;
}

void ritz_nastran_displacements_free(ritz_nastran_displacements *all)
{
    free(all->point);
    ritz_dense_free(&all->A);
    *all = (ritz_nastran_displacements){0};
}

/* ---- the table ----------------------------------------------------------- */

static ritz_small_card begin_record(FILE *file, int64_t record)
{
    ritz_small_card card = ritz_small_begin(file, "DTI");

    ritz_small_text(&card, "TUG1");
    ritz_small_id(&card, record);
    return card;
}

static void put_head(FILE *file, const ritz_dense *A)
{
    static const char *const words[] = {
        "32767", "0", "7", "0", "PHIP", "", "7", "", "", "REAL", "1", "ENDREC"};
    ritz_small_card card = begin_record(file, 0);

    ritz_small_id(&card, A->nrow);
    ritz_small_id(&card, A->ncol);
    for (size_t k = 0; k < sizeof words / sizeof *words; k++)
        ritz_small_text(&card, words[k]);
    ritz_small_end(&card);
}

static void put_columns(FILE *file, const ritz_dense *A)
{
    ritz_small_card card = begin_record(file, 1);

    for (int64_t k = 1; k <= A->ncol; k++) {
        ritz_small_id(&card, k);
        ritz_small_text(&card, "0.0");
    }
    ritz_small_text(&card, "ENDREC");
    ritz_small_end(&card);
}

void ritz_nastran_displacements_put(FILE *file,
                                    const ritz_nastran_displacements *all)
{
    static const char *const titles[] = {"TYPE", "ID", "COMP", "ROW"};
    ritz_small_card card = {0};

    put_head(file, &all->A);
    put_columns(file, &all->A);
    card = begin_record(file, 2);
    ritz_small_skip(&card);
    for (int k = 0; k < 8; k++)
        ritz_small_text(&card, titles[k % 4]);
    for (int64_t k = 0; k < all->count; k++) {
        const ritz_nastran_point *p = &all->point[k];

        ritz_small_id(&card, p->count > 1 ? 1 : 2);
        ritz_small_id(&card, p->id);
        ritz_small_id(&card, p->count);
        ritz_small_id(&card, p->first + 1);
    }
    ritz_small_text(&card, "ENDREC");
    ritz_small_end(&card);
}
