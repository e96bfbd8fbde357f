/* Dofs without mass or stiffness, separate bodies, mass properties. */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "check/check.h"
#include "linear/general.h"

#include <ritz/matrix.h>
#include <ritz/model.h>

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/*
 * Dofs that have no mass, no stiffness, or no connection to the others. Dofs of
 * one grid belong together; two grids do if any entry of K or M couples them.
 */

static int64_t root_of(int64_t *parent, int64_t k)
{
    while (parent[k] != k) {
        parent[k] = parent[parent[k]];
        k = parent[k];
    }
    return k;
}

static void join_parts(int64_t *parent, int64_t a, int64_t b)
{
    a = root_of(parent, a);
    b = root_of(parent, b);
    if (a < b)
        parent[b] = a;
    else
        parent[a] = b;
}

static void join_entries(const ritz_sparse *A, int64_t *parent)
{
    for (int64_t j = 0; A->colptr && j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            if (A->val[p] != 0.0)
                join_parts(parent, A->rowind[p], j);
}

/* A row and the grid it belongs to, to bring rows of a grid together. */
typedef struct seat {
    int64_t grid, row;
} seat;

static int compare_seats(const void *left, const void *right)
{
    const seat *a = left;
    const seat *b = right;

    if (a->grid != b->grid)
        return a->grid < b->grid ? -1 : 1;
    return (a->row > b->row) - (a->row < b->row);
}

static ritz_status join_grids(const ritz_component *c, int64_t *parent)
{
    RITZ_OWN_ARRAY seat *list = NULL;

    RITZ_CHECK_NEW(list, c->num_dofs);
    for (int64_t k = 0; k < c->num_dofs; k++)
        list[k] = (seat){c->dof[k].grid, k};
    qsort(list, (size_t)c->num_dofs, sizeof *list, compare_seats);
    for (int64_t k = 1; k < c->num_dofs; k++)
        if (list[k].grid == list[k - 1].grid)
            join_parts(parent, list[k].row, list[k - 1].row);
    return RITZ_OK;
}

/* Number the parts in it->part; their count, and the largest of them. */
static ritz_status find_parts(ritz_checker *it, int64_t *count)
{
    const ritz_component *c = it->component;
    int64_t n = c->num_dofs;
    RITZ_OWN_ARRAY int64_t *parent = NULL, *size = NULL;

    RITZ_CHECK_NEW(parent, n);
    RITZ_CHECK_NEW(size, n);
    RITZ_CHECK_NEW(it->part, n);
    for (int64_t k = 0; k < n; k++)
        parent[k] = k;
    join_entries(&c->K, parent);
    join_entries(&c->M, parent);
    RITZ_CHECK(join_grids(c, parent));
    *count = 0;
    for (int64_t k = 0; k < n; k++) { /* a root is the least of its part */
        int64_t root = root_of(parent, k);

        it->part[k] = root == k ? (*count)++ : it->part[root];
        size[it->part[k]]++;
    }
    for (int64_t k = 0; k < *count; k++)
        if (size[k] > size[it->largest])
            it->largest = k;
    return RITZ_OK;
}

/* Grids outside the largest part, each once. */
static void name_others(const ritz_checker *it, char where[RITZ_WHERE_SIZE])
{
    const ritz_component *c = it->component;
    int64_t last = -1;

    where[0] = '\0';
    for (int64_t k = 0; k < c->num_dofs; k++) {
        char name[RITZ_DOF_NAME_SIZE];

        if (it->part[k] == it->largest || c->dof[k].grid == last)
            continue;
        last = c->dof[k].grid;
        snprintf(name, sizeof name, "%s %" PRId64,
                 c->dof[k].component == 0 ? "point" : "grid", last);
        ritz_checker_list(where, name);
    }
}

static ritz_status check_parts(ritz_checker *it)
{
    int64_t count = 0;
    char where[RITZ_WHERE_SIZE];

    RITZ_CHECK(find_parts(it, &count));
    name_others(it, where);
    if (count == 1)
        ritz_checker_say(it, "separate-bodies", 1.0, 1.0, RITZ_PASS, where,
                         "all dofs are connected");
    else
        ritz_checker_say(it, "separate-bodies", (double)count, 1.0, RITZ_WARN,
                         where,
                         "%" PRId64 " parts without connection: the grids "
                         "named lie outside the largest",
                         count);
    return RITZ_OK;
}

/* Rows of A that hold nothing but zeros. */
static void check_rows(ritz_checker *it, const ritz_sparse *A, const char *name,
                       const char *meaning, bool *flag)
{
    char some[RITZ_WHERE_SIZE];
    int64_t count = 0;

    for (int64_t j = 0; j < A->ncol; j++) {
        flag[j] = true;
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            if (A->val[p] != 0.0)
                flag[j] = false;
        count += flag[j];
    }
    snprintf(some, sizeof some, "%" PRId64 " of %" PRId64 " dofs %s", count,
             A->ncol, meaning);
    ritz_checker_flagged(it, name, flag, RITZ_WARN, "there are none", some);
}

ritz_status ritz_check_dofs(ritz_checker *it)
{
    const ritz_component *c = it->component;
    RITZ_OWN_ARRAY bool *flag = NULL;

    RITZ_CHECK_NEW(flag, c->num_dofs);
    check_rows(it, &c->M, "massless-dofs",
               "have no mass: they follow the others without inertia", flag);
    if (!it->rigid)
        check_rows(it, &c->K, "unconnected-dofs",
                   "have mass but no stiffness: they move freely", flag);
    return check_parts(it);
}

/*
 * Mass properties: with rigid motions R = [T, Theta] about the mass centre,
 *
 *     R'MR = | m I   0  |
 *            |  0   J_c |
 *
 * whatever the body is: three equal masses, no coupling between translation
 * and rotation, and principal moments with J_1 + J_2 >= J_3 > 0. Directions
 * without any dof, as in plane models, are passed over.
 */

static ritz_verdict verdict_of(double value)
{
    if (value <= RITZ_MASS_AGREES)
        return RITZ_PASS;
    return value <= RITZ_MASS_BEARABLE ? RITZ_WARN : RITZ_FAIL;
}

/* Whether any dof lies along a basic axis. */
static bool has_direction(const ritz_checker *it, int64_t j)
{
    return ritz_dense_col_max(&it->R, j) > 0.0;
}

/* The three masses agree; the largest of them. */
static double check_masses(ritz_checker *it, const ritz_dense *A)
{
    double least = DBL_MAX;
    double most = 0.0;
    double spread = 0.0;

    for (int64_t j = 0; j < 3; j++) {
        if (!has_direction(it, j))
            continue;
        least = fmin(least, ritz_dense_col(A, j)[j]);
        most = fmax(most, ritz_dense_col(A, j)[j]);
    }
    if (!(most > 0.0)) {
        ritz_checker_say(it, "mass-translations", nan(""), RITZ_MASS_AGREES,
                         RITZ_WARN, NULL, "no mass moves with a translation");
        return 0.0;
    }
    spread = (most - least) / most;
    ritz_checker_say(it, "mass-translations", spread, RITZ_MASS_AGREES,
                     verdict_of(spread), NULL,
                     spread <= RITZ_MASS_AGREES
                         ? "mass %.9g, the same along all axes"
                         : "mass %.9g along one axis, %.9g along another",
                     most, least);
    return most;
}

/*
 * Mass that couples translations with each other, relative to m, and with
 * rotations about the mass centre, relative to m times the size.
 */
static void check_coupling(ritz_checker *it, const ritz_dense *A, double mass,
                           const double *centre)
{
    double worst = 0.0;
    char text[RITZ_WHERE_SIZE];

    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < 3; i++) {
            double scale = mass * (j < 3 ? 1.0 : it->size);

            if (i == j || !has_direction(it, i) ||
                !has_direction(it, j < 3 ? j : j - 3))
                continue;
            worst = fmax(worst, fabs(ritz_dense_col(A, j)[i]) / scale);
        }
    if (it->placed)
        snprintf(text, sizeof text, "mass centre at %.6g %.6g %.6g", centre[0],
                 centre[1], centre[2]);
    else
        snprintf(text, sizeof text, "translations are %scoupled by mass",
                 worst <= RITZ_MASS_AGREES ? "not " : "");
    ritz_checker_say(it, "mass-coupling", worst, RITZ_MASS_AGREES,
                     verdict_of(worst), NULL, "%s", text);
}

static ritz_status check_moments(ritz_checker *it, const ritz_dense *A)
{
    RITZ_OWN(ritz_dense) tensor = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    const double *J = NULL; /* principal moments of inertia, ascending */
    double margin = 0.0;
    bool spatial = true;

    for (int64_t j = 0; j < 6; j++)
        spatial = spatial && has_direction(it, j);
    if (!spatial)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_block(A, 3, 3, 3, 3, &tensor));
    ritz_dense_symmetrise(&tensor);
    RITZ_CHECK(ritz_general_symmetric(&tensor, &pairs));
    J = pairs.lambda;
    margin = J[2] > 0.0 ? (J[0] + J[1] - J[2]) / J[2] : 0.0;
    ritz_checker_say(
        it, "inertia-tensor", margin, -RITZ_MASS_AGREES,
        margin >= -RITZ_MASS_AGREES && J[0] >= -RITZ_MASS_AGREES * J[2]
            ? RITZ_PASS
            : RITZ_FAIL,
        NULL, "principal moments %.6g %.6g %.6g%s", J[0], J[1], J[2],
        margin >= -RITZ_MASS_AGREES ? "" : ": no body has these moments");
    return RITZ_OK;
}

ritz_status ritz_check_mass(ritz_checker *it)
{
    ritz_inertia inertia = {0};
    RITZ_OWN(ritz_dense) R = {0}, A = {0}; /* R'MR, about the mass centre */
    double mass = 0.0;

    if (it->placed) {
        RITZ_CHECK(ritz_inertia_of(it->component, &inertia));
        RITZ_CHECK(ritz_rigid_geometry(it->component, inertia.centre, &R));
    }
    RITZ_CHECK(
        ritz_sparse_condense(&it->component->M, it->placed ? &R : &it->R, &A));
    mass = check_masses(it, &A);
    if (mass > 0.0) {
        check_coupling(it, &A, mass, inertia.centre);
        if (A.ncol == 6)
            RITZ_CHECK(check_moments(it, &A));
    }
    return RITZ_OK;
}
