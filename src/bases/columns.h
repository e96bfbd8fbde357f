/* The columns of a basis, their labels, its remark, and the load vectors that
 * columns respond to. */
#ifndef RITZ_BASES_COLUMNS_H
#define RITZ_BASES_COLUMNS_H

#include "linear/eigen_sparse.h"

#include <ritz/basis.h>

/** The requested damping, or else the component's own. */
ritz_status ritz_request_damping(const ritz_request *request,
                                 ritz_damping *out);

/**
 * The lowest modes of a pencil, as many as the request says.
 *
 * @param[in] what  for sentences, "free-interface modes"
 * @param[in] K,M   @p name is what K is called in sentences
 * @param[in] use   as of ritz_eigen_lending(); NULL: the factor is not used
 * @return RITZ_ERR_SINGULAR if K has a negative eigenvalue, or as
 *         ritz_eigen_sparse
 */
ritz_status ritz_lowest_modes(const char *what, const char *name,
                              const ritz_sparse *K, const ritz_sparse *M,
                              const ritz_span *span, const ritz_factor_use *use,
                              ritz_pairs *out);

/** Label columns from @p at on: rigid modes, and others of a kind. */
void ritz_columns_label(const ritz_pairs *modes, ritz_column_kind kind,
                        int64_t at, ritz_columns *columns);

/** Label column @p at: a rigid motion. */
void ritz_columns_label_rigid(int64_t at, ritz_columns *columns);

/** Label columns from @p at on: displacements of dofs. */
void ritz_columns_label_dofs(int64_t count, const int64_t *dof, int64_t at,
                             ritz_columns *columns);

/** The engine that found modes, and why it was chosen. */
void ritz_origin_name_engine(const ritz_pairs *modes, ritz_origin *origin);

/** A basis of modes, rigid and normal, and @p more columns of zeros. */
ritz_status ritz_basis_of_modes(const ritz_pairs *modes, int64_t more,
                                ritz_basis *out);

/**
 * Append to the remark as far as there is room, after @p joint if there is a
 * remark already: "; " say.
 */
[[gnu::format(printf, 3, 4)]] void
ritz_remark_add(ritz_basis *basis, const char *joint, const char *format, ...);

/* Room for what ritz_loads_name writes. */
enum { RITZ_LOADS_NAME_SIZE = RITZ_NAME_SIZE + 16 };

/**
 * The number of columns that ritz_loads_collect would give; zero is no failure
 * here.
 *
 * @param[in] loads  sum of RITZ_LOADS_...
 * @cost   O(n p)
 */
int64_t ritz_loads_count(const ritz_request *request, int loads);

/**
 * Unit forces at the attached dofs, columns of B, rows of C, then of Cv and Ca,
 * influence vectors of dampers: the requested ones, in this order, without zero
 * columns.
 *
 * @param[in]  loads  sum of RITZ_LOADS_...
 * @param[out] F      n x p, p at least 1
 * @param[out] dof    p, the row of an attached dof, -1 of others; the caller's
 *                    to free
 * @return RITZ_ERR_ARGUMENT if there is none, or an attached dof is out of
 *         range or repeated
 */
ritz_status ritz_loads_collect(const ritz_request *request, int loads,
                               ritz_dense *F, int64_t **dof);

/** "grid 3 T1", "input 'torque'": what column @p j is; returns @p text. */
const char *ritz_loads_name(const ritz_request *request, int loads, int64_t j,
                            char text[RITZ_LOADS_NAME_SIZE]);

/**
 * The loads in addition to those at the attached dofs, for a method that always
 * includes the latter: the requested loads, or else @p usual.
 *
 * @param[out] loads  sum of RITZ_LOADS_..., without RITZ_LOADS_ATTACHED
 * @return RITZ_ERR_ARGUMENT if loads are requested and the component has none
 *         of them
 */
ritz_status ritz_loads_beside(const ritz_request *request, int usual,
                              int *loads);

/**
 * Choose the static vectors Psi that are linearly independent and larger than
 * rounding. Psi are responses to F without their part in other columns. Columns
 * are chosen by pivots of F'Psi, scaled to a unit diagonal: the pivot, which is
 * the squared relative size of the independent part of a column, must exceed
 * the tolerance. Of pivots that agree to six digits the first is taken, so that
 * the choice does not depend on a processor's rounding.
 *
 * @param[in]     least  p values; column j is left out unless f_j'psi_j exceeds
 *                       least[j]
 * @param[in,out] keep   p flags, set to true for the columns chosen
 * @param[out]    kept   number of columns chosen
 */
ritz_status ritz_statics_choose(const ritz_dense *F, const ritz_dense *Psi,
                                const double *least, double tolerance,
                                bool *keep, int64_t *kept);

/**
 * The same from R = F'Psi, where F and Psi are not in one process.
 *
 * @param[in,out] R  p x p, overwritten
 */
ritz_status ritz_statics_choose_from(ritz_dense *R, const double *least,
                                     double tolerance, bool *keep,
                                     int64_t *kept);

/**
 * Add a remark with the number of static vectors of a kind that were left out,
 * and the first of them.
 *
 * @param[in] first  index, among all loads, of the first load of this kind
 * @param[in] keep   @p count flags; false: left out
 */
void ritz_remark_left_out(const ritz_request *request, int loads, int64_t first,
                          int64_t count, const bool *keep,
                          ritz_column_kind kind, ritz_basis *basis);

/** Which modes a request asks for, by which engine, and counted or not. */
ritz_span ritz_request_span(const ritz_request *request);

/**
 * Refuse a request that attaches nothing, and say what to do: models without
 * ports, such as systems at a configuration, have nothing to attach.
 *
 * @param[in] so  the consequence, for the sentence: "nothing would be kept"
 */
ritz_status ritz_refuse_unattached(const ritz_request *request, const char *so);

/**
 * Add a remark if D is no combination of M and K at some dofs: what acts there
 * has no static vectors, as dampers that are stated have them.
 */
ritz_status ritz_remark_damping(const ritz_request *request, ritz_basis *basis);

/** Add a remark if the component has dampers and these are not among the
 * loads. */
void ritz_remark_dampers(const ritz_request *request, int loads,
                         ritz_basis *basis);

/**
 * Refuse a stiffness that is not positive definite while the attached dofs are
 * held, and name the dofs that move freely, or whose motion has negative energy.
 *
 * @param[in] i      rows of the component that K is of
 * @param[in] pairs  its rigid modes and the lowest others; NULL: not known
 * @param[in] weak   row of K that gave way, -1 if not known
 * @param[in] negative  number of its negative eigenvalues beyond rounding, 0 if
 *                      not known
 * @return RITZ_ERR_SINGULAR
 */
ritz_status ritz_refuse_mechanism(const ritz_component *component,
                                  const ritz_dofs *i, const ritz_pairs *pairs,
                                  int64_t weak, int64_t negative);

#endif
