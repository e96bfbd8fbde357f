#include "assembly/assembly.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>

/* Whether there is anything to add to K, or to D. */
static bool has_rates(const ritz_springs *springs, bool damping)
{
    for (int64_t k = 0; k < springs->S.nrow; k++)
        if (!damping || springs->of.item[k].freedom->damping > 0.0)
            return true;
    return false;
}

/* A += sum_k s[k] R(k,:)' R(k,:), s the stiffnesses or the dampings. */
static void add_rows(const ritz_dense *R, const ritz_relations *of,
                     bool damping, ritz_dense *A)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < A->nrow; i++) {
            double sum = 0.0;

            for (int64_t k = 0; k < R->nrow; k++) {
                const ritz_freedom *hold = of->item[k].freedom;

                sum += (damping ? hold->damping : hold->stiffness) *
                       (ritz_dense_col(R, i)[k] * ritz_dense_col(R, j)[k]);
            }
            ritz_dense_col(A, j)[i] += sum;
        }
}

ritz_status ritz_springs_add(const ritz_springs *springs, bool damping,
                             const ritz_dense *P, ritz_dense *A)
{
    RITZ_OWN(ritz_dense) R = {0};

    if (!has_rates(springs, damping))
        return RITZ_OK;
    if (!A->val)
        RITZ_CHECK(ritz_dense_new(P->ncol, P->ncol, A));
    RITZ_CHECK(ritz_dense_mul(&springs->S, P, &R));
    add_rows(&R, &springs->of, damping, A);
    return RITZ_OK;
}

ritz_status ritz_springs_add_sparse(const ritz_springs *springs, bool damping,
                                    int64_t n, const int64_t *at,
                                    ritz_sparse *A)
{
    const int64_t Q = springs->S.ncol;
    RITZ_OWN(ritz_dense) dense = {0};
    RITZ_OWN(ritz_sparse) part = {0}, own = {0}, sum = {0};
    RITZ_OWN_ARRAY int64_t *row = NULL, *col = NULL;

    if (!has_rates(springs, damping))
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_new(Q, Q, &dense));
    add_rows(&springs->S, &springs->of, damping, &dense);
    RITZ_CHECK(ritz_sparse_from_dense(&dense, &part));
    RITZ_CHECK_NEW(row, part.colptr[Q]);
    RITZ_CHECK_NEW(col, part.colptr[Q]);
    for (int64_t j = 0; j < Q; j++)
        for (int64_t e = part.colptr[j]; e < part.colptr[j + 1]; e++) {
            row[e] = at[part.rowind[e]];
            col[e] = at[j];
        }
    RITZ_CHECK(ritz_sparse_from_triplets(n, n, part.colptr[Q], row, col,
                                         part.val, &own));
    if (A->colptr)
        RITZ_CHECK(ritz_sparse_add(1.0, A, 1.0, &own, &sum));
    else
        RITZ_MOVE(sum, own);
    ritz_sparse_free(A);
    RITZ_MOVE(*A, sum);
    return RITZ_OK;
}

void ritz_springs_free(ritz_springs *springs)
{
    ritz_dense_free(&springs->S);
    ritz_relations_free(&springs->of);
    *springs = (ritz_springs){0};
}

/*
 * The rows of C q = 0, one for each direction that a joint locks, and the rows
 * of S, with S q the elongations of the joints' springs. In C coordinates are
 * scaled to unit mass and the rows of one joint and kind by the largest among
 * them, so that rounding stays small relative to a constraint.
 */

/* The ports that a joint holds. */
static ritz_status find_ends(const ritz_stage *stage, const ritz_joint *joint,
                             ritz_joint_end end[2])
{
    for (int k = 0; k < 2; k++) {
        const int64_t c = joint->between[k].component;

        end[k].component = stage->scene->component[c].name;
        end[k].port =
            ritz_reduced_port(&stage->body[c], joint->between[k].port);
        if (!end[k].port)
            return ritz_scene_context(stage->scene, RITZ_ERR_ARGUMENT,
                                      joint->line, joint->column, "joint",
                                      joint->name);
    }
    return RITZ_OK;
}

/* Write a relation as a row over all coordinates, each times its scale. */
static void fill_row(const ritz_stage *stage, const ritz_relation *r,
                     const double *scale, int64_t row, ritz_dense *C)
{
    for (int end = 0; end < 2; end++) {
        int64_t first = stage->first[r->joint->between[end].component];

        for (int64_t j = 0; j < r->port[end]->map.ncol; j++) {
            double value = ritz_relation_at(r, end, j);

            ritz_dense_col(C, first + j)[row] +=
                (end == 0 ? value : -value) * (scale ? scale[first + j] : 1.0);
        }
    }
}

static double row_norm(const ritz_dense *C, int64_t row)
{
    double sum = 0.0;

    for (int64_t j = 0; j < C->ncol; j++) {
        double x = ritz_dense_col(C, j)[row];

        sum += x * x;
    }
    return sqrt(sum);
}

/* Divide the rows of one joint and kind by the largest norm among them. */
static void scale_rows(const ritz_relations *list, ritz_dense *C)
{
    for (int64_t first = 0, end = 0; first < list->count; first = end) {
        const ritz_relation *r = list->item;
        double most[2] = {0.0, 0.0};

        while (end < list->count && r[end].joint == r[first].joint) {
            most[r[end].rotation] =
                fmax(most[r[end].rotation], row_norm(C, end));
            end++;
        }
        for (int64_t k = first; k < end; k++)
            for (int64_t j = 0; j < C->ncol; j++)
                if (most[r[k].rotation] > 0.0)
                    ritz_dense_col(C, j)[k] /= most[r[k].rotation];
    }
}

/* The relations of every joint at some settings, those of one state. */
static ritz_status list_relations(const ritz_stage *stage,
                                  const double *setting,
                                  ritz_freedom_state state, ritz_relations *out)
{
    const ritz_scene *scene = stage->scene;
    RITZ_OWN_ARRAY ritz_joint_pose *pose = NULL;

    RITZ_CHECK_NEW(pose, scene->num_joints);
    RITZ_CHECK(ritz_place_joints(stage, setting, pose));
    RITZ_CHECK(ritz_settle_axes(stage, pose, NULL));
    for (int64_t j = 0; j < scene->num_joints; j++) {
        const ritz_joint *joint = &scene->joint[j];
        int64_t kept = out->count;
        ritz_joint_end end[2];

        RITZ_CHECK(find_ends(stage, joint, end));
        RITZ_CHECK(ritz_joint_relate(joint, end, &pose[j], out));
        for (int64_t k = kept; k < out->count; k++)
            if (out->item[k].freedom->state == state)
                out->item[kept++] = out->item[k];
        out->count = kept;
    }
    return RITZ_OK;
}

/* Relations of one state of all joints, as rows of C; @p scale NULL: of 1. */
static ritz_status make_rows(const ritz_stage *stage, const double *setting,
                             ritz_freedom_state state, const double *scale,
                             ritz_relations *list, ritz_dense *C)
{
    RITZ_CHECK(list_relations(stage, setting, state, list));
    RITZ_CHECK(ritz_dense_new(list->count, stage->num_coordinates, C));
    for (int64_t k = 0; k < list->count; k++)
        fill_row(stage, &list->item[k], scale, k, C);
    return RITZ_OK;
}

ritz_status ritz_stage_constraints(const ritz_stage *stage,
                                   const double *setting, const double *scale,
                                   ritz_dense *out)
{
    RITZ_OWN(ritz_relations) list = {0};
    RITZ_OWN(ritz_dense) C = {0};

    RITZ_CHECK(make_rows(stage, setting, RITZ_LOCKED, scale, &list, &C));
    scale_rows(&list, &C);
    RITZ_MOVE(*out, C);
    return RITZ_OK;
}

ritz_status ritz_stage_springs(const ritz_stage *stage, const double *setting,
                               ritz_springs *out)
{
    RITZ_OWN(ritz_springs) springs = {0};

    RITZ_CHECK(
        make_rows(stage, setting, RITZ_CAGED, NULL, &springs.of, &springs.S));
    RITZ_MOVE(*out, springs);
    return RITZ_OK;
}

ritz_status ritz_stage_locks(const ritz_stage *stage, const double *setting,
                             ritz_springs *out)
{
    RITZ_OWN(ritz_springs) locked = {0};

    RITZ_CHECK(
        make_rows(stage, setting, RITZ_LOCKED, NULL, &locked.of, &locked.S));
    RITZ_MOVE(*out, locked);
    return RITZ_OK;
}

/*
 * The rank of the constraints has to be right: a row of rounding that is taken
 * for a constraint gives a wrong system [McDaniel2000, table 3.3]. The rank is
 * found from C' = Q_1 R and the singular values of the small R.
 *
 * N = Q_1 [U_2, 0; 0, I] with C' = Q_1 [R; 0], R = U S W', U_2 the left
 * singular vectors of the value 0. N is orthonormal and spans the null space of
 * C.
 */
ritz_status ritz_null_space(const ritz_dense *C, int64_t *rank, ritz_dense *out)
{
    int64_t n = C->ncol;
    int64_t c = C->nrow < n ? C->nrow : n;
    RITZ_OWN(ritz_dense) F = {0}, R = {0}, U = {0}, N = {0};
    RITZ_OWN_ARRAY double *tau = NULL, *sigma = NULL, *work = NULL;
    ritz_dense U_2 = {0}; /* borrowed */

    RITZ_CHECK_NEW(tau, c);
    RITZ_CHECK_NEW(sigma, c);
    RITZ_CHECK_NEW(work, c);
    RITZ_CHECK(ritz_general_transpose(C, &F));
    RITZ_CHECK(ritz_dense_new(c, C->nrow, &R));
    RITZ_CHECK(ritz_dense_new(c, c, &U));
    *rank = 0;
    if (c > 0) {
        RITZ_REFUSE_IF(LAPACKE_dgeqrf(LAPACK_COL_MAJOR, (int)n, (int)C->nrow,
                                      F.val, (int)n, tau) != 0,
                       RITZ_ERR_MEMORY, "no memory for the constraints");
        for (int64_t j = 0; j < C->nrow; j++)
            for (int64_t i = 0; i <= j && i < c; i++)
                ritz_dense_col(&R, j)[i] = ritz_dense_col(&F, j)[i];
        RITZ_REFUSE_IF(LAPACKE_dgesvd(LAPACK_COL_MAJOR, 'A', 'N', (int)c,
                                      (int)C->nrow, R.val, (int)c, sigma, U.val,
                                      (int)c, NULL, 1, work) != 0,
                       RITZ_ERR_CONVERGENCE,
                       "singular values of the constraints do not converge");
        while (*rank < c && sigma[*rank] > RITZ_RANK_LOSS * sigma[0])
            (*rank)++;
    }
    RITZ_CHECK(ritz_dense_new(n, n - *rank, &N));
    U_2 = ritz_dense_part(&U, *rank, c - *rank);
    ritz_dense_put(&U_2, 0, 0, &N);
    for (int64_t j = c; j < n; j++)
        ritz_dense_col(&N, j - *rank)[j] = 1.0;
    if (c > 0 && N.ncol > 0)
        RITZ_REFUSE_IF(LAPACKE_dormqr(LAPACK_COL_MAJOR, 'L', 'N', (int)n,
                                      (int)N.ncol, (int)c, F.val, (int)n, tau,
                                      N.val, (int)n) != 0,
                       RITZ_ERR_MEMORY, "no memory for the constraints");
    RITZ_MOVE(*out, N);
    return RITZ_OK;
}
