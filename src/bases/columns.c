#include "bases/columns.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

ritz_status ritz_lowest_modes(const char *what, const char *name,
                              const ritz_sparse *K, const ritz_sparse *M,
                              const ritz_span *span, ritz_pairs *out)
{
    RITZ_CHECK_IN(what, ritz_eigen_sparse(K, M, span, out));
    RITZ_REFUSE_IF(out->Phi.ncol > 0 && out->num_rigid == 0 &&
                       out->lambda[0] <= 0.0,
                   RITZ_ERR_SINGULAR,
                   "%s is not positive semidefinite: an eigenvalue is %.3g",
                   name, out->lambda[0]);
    return RITZ_OK;
}

void ritz_columns_label_rigid(int64_t at, ritz_columns *columns)
{
    columns->kind[at] = RITZ_COLUMN_RIGID;
    columns->hertz[at] = 0.0;
}

void ritz_columns_label(const ritz_pairs *modes, ritz_column_kind kind,
                        int64_t at, ritz_columns *columns)
{
    for (int64_t j = 0; j < modes->Phi.ncol; j++) {
        columns->kind[at + j] = kind;
        columns->hertz[at + j] = ritz_eigen_hertz(modes->lambda[j]);
        columns->residual[at + j] = modes->residual[j];
        if (j < modes->num_rigid)
            ritz_columns_label_rigid(at + j, columns);
    }
}

void ritz_columns_label_dofs(int64_t count, const int64_t *dof, int64_t at,
                             ritz_columns *columns)
{
    for (int64_t j = 0; j < count; j++) {
        columns->kind[at + j] = RITZ_COLUMN_CONSTRAINT;
        columns->dof[at + j] = dof[j];
    }
}

ritz_status ritz_basis_of_modes(const ritz_pairs *modes, int64_t more,
                                ritz_basis *out)
{
    RITZ_CHECK(ritz_basis_new(modes->Phi.nrow, modes->Phi.ncol + more, out));
    ritz_dense_put(&modes->Phi, 0, 0, &out->T);
    ritz_columns_label(modes, RITZ_COLUMN_NORMAL, 0, &out->columns);
    memcpy(out->origin.engine, modes->engine, sizeof out->origin.engine);
    return RITZ_OK;
}

void ritz_remark_add(ritz_basis *basis, const char *joint, const char *format,
                     ...)
{
    size_t used = strlen(basis->remark);
    size_t left = sizeof basis->remark - used;
    char text[sizeof basis->remark];
    va_list args;

    va_start(args, format);
    (void)vsnprintf(text, sizeof text, format, args);
    va_end(args);
    (void)snprintf(basis->remark + used, left, "%s%s", used > 0 ? joint : "",
                   text);
}
