/*
 * Mass properties from the mass matrix: with rigid motions R = [T, Theta] of
 * unit translations and unit rotations about the basic origin,
 *
 *     R'MR = |  m I     -m c~ |     c the centre of mass, c~ x = c x x,
 *            |  m c~     J_o  |     J_c = J_o - m (c'c I - c c')
 */
#include "base/alloc.h"
#include "linear/general.h"
#include "model/equations.h"

#include <ritz/model.h>

#include <math.h>
#include <string.h>

static const double origin[3];

/* Mean over the translations of the model: a plane model has two. */
static double mean_mass(const ritz_dense *A)
{
    double sum = 0.0;
    int count = 0;

    for (int i = 0; i < 3; i++)
        if (ritz_dense_col(A, i)[i] > 0.0) {
            sum += ritz_dense_col(A, i)[i];
            count++;
        }
    return count > 0 ? sum / count : 0.0;
}

/*
 * Two translations, j and k, give c_i; where only one of them is in the
 * model, as in a plane one, that one alone is used.
 */
static double read_centre(const ritz_dense *A, double m, int i)
{
    int j = (i + 1) % 3;
    int k = (i + 2) % 3;
    bool has_j = ritz_dense_col(A, j)[j] > 0.0;
    bool has_k = ritz_dense_col(A, k)[k] > 0.0;
    double sum = (has_j ? ritz_dense_col(A, 3 + k)[j] : 0.0) -
                 (has_k ? ritz_dense_col(A, 3 + j)[k] : 0.0);

    return has_j || has_k ? sum / (m * (has_j + has_k)) : 0.0;
}

/* Whether the model has the translations that inertia (i, j) is read from. */
static bool has_translations(const ritz_dense *A, int i, int j)
{
    for (int k = 0; k < 3; k++)
        if (k != i && k != j && !(ritz_dense_col(A, k)[k] > 0.0))
            return false;
    return true;
}

/* Inertias that the model's translations do not determine stay zero. */
void ritz_inertia_read(const ritz_dense *A, ritz_inertia *inertia)
{
    double m = mean_mass(A);
    double *c = inertia->centre;
    double square = 0.0;

    inertia->mass = m;
    inertia->known = m > 0.0;
    if (!inertia->known)
        return;
    for (int i = 0; i < 3; i++) {
        c[i] = read_centre(A, m, i);
        square += c[i] * c[i];
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            if (has_translations(A, i, j))
                inertia->tensor[3 * i + j] =
                    ritz_dense_col(A, 3 + j)[3 + i] -
                    m * ((i == j ? square : 0.0) - c[i] * c[j]);
}

ritz_status ritz_inertia_momenta(const ritz_component *component,
                                 ritz_dense *out)
{
    RITZ_OWN(ritz_dense) R = {0};

    if (component->grids.count == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_rigid_geometry(component, origin, &R));
    return ritz_sparse_condense(&component->M, &R, out);
}

ritz_status ritz_inertia_of(const ritz_component *component, ritz_inertia *out)
{
    RITZ_OWN(ritz_dense) A = {0};

    *out = (ritz_inertia){0};
    RITZ_CHECK(ritz_inertia_momenta(component, &A));
    if (A.val)
        ritz_inertia_read(&A, out);
    return RITZ_OK;
}

/*
 * Inertia invariants from M, T and the places of grids.
 *
 * The 3 x 3 block of M that joins the translations of grids i and j, along the
 * basic axes, is m_ij I3 for solids and lumped masses; of others the mean of
 * its diagonal is taken,
 *
 *     m_ij = sum_pq M_ip,jq (a_ip . a_jq) / sum_pq (a_ip . a_jq)^2
 *
 * over the translations p of i and q of j that there are, along axes a: the
 * denominator counts the directions that both have, three of whole grids.
 */

static double dot_product(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Number of directions that nodes i and j share, at least 1. */
static double count_common(const ritz_nodes *nodes, int64_t i, int64_t j)
{
    const double *a = ritz_nodes_axes(nodes, i);
    const double *b = ritz_nodes_axes(nodes, j);
    double sum = 0.0;

    for (int64_t p = 0; p < 3; p++)
        for (int64_t q = 0; q < 3; q++)
            if (nodes->row[3 * i + p] >= 0 && nodes->row[3 * j + q] >= 0) {
                double cosine = dot_product(a + 3 * p, b + 3 * q);

                sum += cosine * cosine;
            }
    return fmax(sum, 1.0);
}

/* (a_ip . a_jq) / sum_pq (a_ip . a_jq)^2, at = 3 i + p and to = 3 j + q. The sum
   is 3 if both nodes are whole. Most are, and have the axes of their
   neighbours. */
static double share_of(const ritz_nodes *nodes, const bool *whole, int64_t at,
                       int64_t to)
{
    const int64_t i = at / 3, j = to / 3;
    const double *a = ritz_nodes_axes(nodes, i);
    const double *b = ritz_nodes_axes(nodes, j);

    if (whole[i] && whole[j])
        return a == b ? (at % 3 == to % 3 ? 1.0 / 3.0 : 0.0)
                      : dot_product(a + 3 * (at % 3), b + 3 * (to % 3)) / 3.0;
    return dot_product(a + 3 * (at % 3), b + 3 * (to % 3)) /
           count_common(nodes, i, j);
}

/* What the sums of nodal masses need to know of the dofs of nodes. */
typedef struct placed_dofs {
    const ritz_sparse *M;
    const ritz_nodes *nodes;
    bool *whole;    /* of each node: has three translations */
    int64_t *place; /* of each dof: 3 node + direction, or -1 */
    int64_t *mark;  /* of each node: its last entry in m + 1 */
} placed_dofs;

static void placed_dofs_free(placed_dofs *p)
{
    RITZ_FREE(p->whole, p->place, p->mark);
}

static ritz_status place_dofs(const ritz_component *component, placed_dofs *p)
{
    const ritz_nodes *nodes = p->nodes;

    RITZ_CHECK_NEW(p->whole, nodes->count);
    RITZ_CHECK_NEW(p->place, component->num_dofs);
    RITZ_CHECK_NEW(p->mark, nodes->count);
    for (int64_t i = 0; i < component->num_dofs; i++)
        p->place[i] = -1;
    for (int64_t i = 0; i < nodes->count; i++)
        p->whole[i] = true;
    for (int64_t k = 0; k < 3 * nodes->count; k++) {
        p->whole[k / 3] = p->whole[k / 3] && nodes->row[k] >= 0;
        if (nodes->row[k] >= 0)
            p->place[nodes->row[k]] = k;
    }
    return RITZ_OK;
}

/* Sum column j of m, from entry `first` on, in no order of rows. Returns the end
   of the column. m NULL: entries are only counted. */
static int64_t sum_column(placed_dofs *p, int64_t j, int64_t first,
                          ritz_sparse *m)
{
    const ritz_sparse *M = p->M;
    int64_t end = first;

    for (int64_t to = 3 * j; to < 3 * j + 3; to++) {
        const int64_t c = p->nodes->row[to];

        for (int64_t e = c < 0 ? 0 : M->colptr[c];
             e < (c < 0 ? 0 : M->colptr[c + 1]); e++) {
            const int64_t at = p->place[M->rowind[e]];
            const double share =
                at < 0 ? 0.0 : share_of(p->nodes, p->whole, at, to);

            if (share == 0.0)
                continue;
            if (p->mark[at / 3] <= first)
                p->mark[at / 3] = ++end;
            if (m) {
                m->rowind[p->mark[at / 3] - 1] = at / 3;
                m->val[p->mark[at / 3] - 1] += M->val[e] * share;
            }
        }
    }
    return end;
}

/* m, with a row for each node, from entries of M between translations. */
static ritz_status nodal_mass(const ritz_component *component,
                              const ritz_nodes *nodes, ritz_sparse *out)
{
    const int64_t n = nodes->count;
    RITZ_OWN(placed_dofs) p = {.M = &component->M, .nodes = nodes};
    RITZ_OWN(ritz_sparse) raw = {0}, turned = {0};
    int64_t count = 0;

    RITZ_CHECK(place_dofs(component, &p));
    for (int64_t j = 0; j < n; j++)
        count = sum_column(&p, j, count, NULL);
    memset(p.mark, 0, (size_t)n * sizeof *p.mark);
    RITZ_CHECK(ritz_sparse_new(n, n, count, &raw));
    for (int64_t j = 0; j < n; j++)
        raw.colptr[j + 1] = sum_column(&p, j, raw.colptr[j], &raw);
    /* two transpositions sort the rows of each column */
    RITZ_CHECK(ritz_sparse_transpose(&raw, &turned));
    return ritz_sparse_transpose(&turned, out);
}

/* R'MR and R'MT. */
static ritz_status find_momenta(const ritz_component *component,
                                const ritz_dense *T, ritz_invariants *out)
{
    RITZ_OWN(ritz_dense) R = {0}, MR = {0}, A = {0};

    RITZ_CHECK(ritz_rigid_geometry(component, origin, &R));
    RITZ_CHECK(ritz_sparse_mul(&component->M, &R, &MR));
    RITZ_CHECK(ritz_dense_mul_tn(&R, &MR, &A));
    ritz_dense_symmetrise(&A);
    memcpy(out->rigid, A.val, sizeof out->rigid);
    return ritz_dense_mul_tn(&MR, T, &out->momentum);
}

static ritz_status list_positions(const ritz_nodes *nodes, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(nodes->count, 3, out));
    for (int a = 0; a < 3; a++)
        for (int64_t i = 0; i < nodes->count; i++)
            ritz_dense_col(out, a)[i] =
                nodes->grids->position[3 * nodes->grid[i] + a];
    return RITZ_OK;
}

/* X_a' m T_b and T_a' m T_b of all a <= b for one b. */
static ritz_status find_products(const ritz_nodes *nodes, const ritz_sparse *m,
                                 const ritz_dense *T, int b,
                                 ritz_invariants *out)
{
    int64_t r = T->ncol;
    RITZ_OWN(ritz_dense)
    X = {0}, T_b = {0}, mT = {0}, T_a = {0}, P = {0}, mirror = {0};

    RITZ_CHECK(ritz_nodes_along(nodes, T, b, &T_b));
    RITZ_CHECK(ritz_sparse_mul(m, &T_b, &mT));
    RITZ_CHECK(list_positions(nodes, &X));
    RITZ_CHECK(ritz_dense_mul_tn(&X, &mT, &P));
    ritz_dense_put(&P, 0, b * r, &out->position);
    ritz_dense_free(&P);
    RITZ_CHECK(ritz_dense_mul_tn(&T_b, &mT, &P));
    ritz_dense_symmetrise(&P);
    ritz_dense_put(&P, b * r, b * r, &out->product);
    ritz_dense_free(&T_b);
    for (int a = 0; a < b; a++) {
        ritz_dense_free(&P);
        RITZ_CHECK(ritz_nodes_along(nodes, T, a, &T_a));
        RITZ_CHECK(ritz_dense_mul_tn(&T_a, &mT, &P));
        ritz_dense_put(&P, a * r, b * r, &out->product);
        RITZ_CHECK(ritz_general_transpose(&P, &mirror));
        ritz_dense_put(&mirror, b * r, a * r, &out->product);
        ritz_dense_free(&mirror);
        ritz_dense_free(&T_a);
    }
    return RITZ_OK;
}

ritz_status ritz_invariants_of(const ritz_component *component,
                               const ritz_dense *T, ritz_invariants *out)
{
    int64_t r = T->ncol;
    RITZ_OWN(ritz_nodes) nodes = {0};
    RITZ_OWN(ritz_sparse) m = {0};
    RITZ_OWN(ritz_invariants) found = {0};

    if (component->grids.count == 0 || r > RITZ_INVARIANT_COLUMNS)
        return RITZ_OK;
    RITZ_CHECK(ritz_nodes_of(component->num_dofs, component->dof,
                             &component->grids, &nodes));
    RITZ_CHECK(nodal_mass(component, &nodes, &m));
    RITZ_CHECK(find_momenta(component, T, &found));
    RITZ_CHECK(ritz_dense_new(3, 3 * r, &found.position));
    RITZ_CHECK(ritz_dense_new(3 * r, 3 * r, &found.product));
    for (int b = 0; b < 3; b++)
        RITZ_CHECK(find_products(&nodes, &m, T, b, &found));
    RITZ_MOVE(*out, found);
    return RITZ_OK;
}

ritz_status ritz_invariants_project(const ritz_invariants *invariants,
                                    const ritz_dense *V, ritz_invariants *out)
{
    RITZ_OWN(ritz_invariants) second = {0};
    RITZ_OWN(ritz_dense) V3 = {0};

    if (!invariants->momentum.val)
        return RITZ_OK;
    memcpy(second.rigid, invariants->rigid, sizeof second.rigid);
    /* I3 (x) V: T V transforms each of the three blocks of columns by V */
    RITZ_CHECK(ritz_dense_new(3 * V->nrow, 3 * V->ncol, &V3));
    for (int b = 0; b < 3; b++)
        ritz_dense_put(V, b * V->nrow, b * V->ncol, &V3);
    RITZ_CHECK(ritz_dense_mul(&invariants->momentum, V, &second.momentum));
    RITZ_CHECK(ritz_dense_mul(&invariants->position, &V3, &second.position));
    RITZ_CHECK(
        ritz_dense_congruence(&invariants->product, &V3, &second.product));
    RITZ_MOVE(*out, second);
    return RITZ_OK;
}

void ritz_invariants_free(ritz_invariants *invariants)
{
    ritz_dense_free(&invariants->momentum);
    ritz_dense_free(&invariants->position);
    ritz_dense_free(&invariants->product);
    *invariants = (ritz_invariants){0};
}
