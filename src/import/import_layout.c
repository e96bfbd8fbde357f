/* The dofs of a matrix of inputs, outputs or quantities, and the rows of the
   component that they are. */
#include "import/import.h"

#include "base/alloc.h"

#include <inttypes.h>

ritz_status ritz_layout_find(const ritz_io_files *files,
                             const ritz_matrix *matrix, const char *spec,
                             bool input, ritz_layout *out)
{
    bool named = matrix->row && !files->in_order;
    int64_t n = named ? matrix->A.nrow : files->num_dofs;
    bool across = !input && !named && matrix->A.ncol == n;

    RITZ_REFUSE_IF(matrix->imaginary, RITZ_ERR_FORMAT,
                   "'%s' is complex, a real matrix is due", spec);
    RITZ_REFUSE_IF(!across && matrix->A.nrow != n, RITZ_ERR_FORMAT,
                   "'%s' is %" PRId64 " x %" PRId64 ": %" PRId64
                   " %s are due, one for each dof of the mass",
                   spec, matrix->A.nrow, matrix->A.ncol, n,
                   input ? "rows" : "columns");
    *out = (ritz_layout){.num_dofs = n,
                         .dof = named ? matrix->row : files->dof,
                         .across = across,
                         .count = across ? matrix->A.nrow : matrix->A.ncol};
    RITZ_REFUSE_IF(out->count == 0, RITZ_ERR_FORMAT, "'%s' is empty", spec);
    return RITZ_OK;
}

ritz_status ritz_layout_rows(const ritz_layout *layout, const ritz_deck *deck,
                             const ritz_extended *extended, int64_t **out)
{
    int64_t *row = NULL;

    RITZ_CHECK_NEW(row, layout->num_dofs);
    for (int64_t i = 0; i < layout->num_dofs; i++) {
        ritz_dof dof = layout->dof[i];

        row[i] = ritz_roster_row(&extended->roster, dof);
        if (row[i] < 0)
            row[i] = ritz_dof_among(dof, deck->num_fixed, deck->fixed)
                         ? RITZ_ROW_FIXED
                         : RITZ_ROW_NONE;
    }
    *out = row;
    return RITZ_OK;
}

ritz_status ritz_layout_refuse(const char *spec,
                               const ritz_import_report *report,
                               const ritz_extended *extended, ritz_dof dof)
{
    char name[RITZ_DOF_NAME_SIZE];

    for (int64_t k = 0; k < report->num_removed; k++)
        RITZ_REFUSE_IF(ritz_dof_compare(&report->removed[k], &dof) == 0,
                       RITZ_ERR_FORMAT,
                       "'%s' has an entry for '%s', which has neither "
                       "stiffness nor mass",
                       spec, ritz_dof_name(dof, name));
    return ritz_context(ritz_roster_miss(&extended->roster, dof), spec);
}
