/* The columns of a basis and their labels, and its remark. */
#ifndef RITZ_BASES_COLUMNS_H
#define RITZ_BASES_COLUMNS_H

#include <ritz/basis.h>

/**
 * The lowest modes of a pencil, as many as the request says.
 *
 * @param[in] what  for sentences, "free-interface modes"
 * @param[in] K,M   @p name is what K is called in sentences
 * @return RITZ_ERR_SINGULAR if K has a negative eigenvalue, or as
 *         ritz_eigen_sparse
 */
ritz_status ritz_lowest_modes(const char *what, const char *name,
                              const ritz_sparse *K, const ritz_sparse *M,
                              const ritz_span *span, ritz_pairs *out);

/** Label columns from @p at on: rigid modes, and others of a kind. */
void ritz_columns_label(const ritz_pairs *modes, ritz_column_kind kind,
                        int64_t at, ritz_columns *columns);

/** Label column @p at: a rigid motion. */
void ritz_columns_label_rigid(int64_t at, ritz_columns *columns);

/** Label columns from @p at on: displacements of dofs. */
void ritz_columns_label_dofs(int64_t count, const int64_t *dof, int64_t at,
                             ritz_columns *columns);

/** A basis of modes, rigid and normal, and @p more columns of zeros. */
ritz_status ritz_basis_of_modes(const ritz_pairs *modes, int64_t more,
                                ritz_basis *out);

/**
 * Append to the remark as far as there is room, after @p joint if there is a
 * remark already: "; " say.
 */
[[gnu::format(printf, 3, 4)]] void
ritz_remark_add(ritz_basis *basis, const char *joint, const char *format, ...);

#endif
