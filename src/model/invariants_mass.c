/* Mass of grids from the blocks of M: see the header. */
#include "model/invariants_mass.h"

#include "base/alloc.h"

#include <math.h>
#include <string.h>

/* ---- nodes -------------------------------------------------------------- */

/* List the grids that have a dof as nodes. `row` gets six rows of each node, -1
   where it lacks a dof. */
static ritz_status list_nodes(const ritz_component *component,
                              ritz_nodes *nodes, int64_t **row)
{
    const ritz_grids *grids = &component->grids;
    int64_t *at = NULL;

    nodes->grids = grids;
    RITZ_CHECK_NEW(*row, 6 * grids->count);
    at = *row;
    RITZ_CHECK_NEW(nodes->grid, grids->count);
    RITZ_CHECK_NEW(nodes->row, 3 * grids->count);
    for (int64_t k = 0; k < 6 * grids->count; k++)
        at[k] = -1;
    for (int64_t i = 0; i < component->num_dofs; i++) {
        const ritz_dof dof = component->dof[i];
        const int64_t k =
            dof.component < 1 ? -1 : ritz_grids_find(grids, dof.grid);

        if (k >= 0)
            at[6 * k + dof.component - 1] = i;
    }
    for (int64_t k = 0; k < grids->count; k++) {
        bool any = false;

        for (int p = 0; p < 6; p++)
            any = any || at[6 * k + p] >= 0;
        if (!any)
            continue;
        memmove(at + 6 * nodes->count, at + 6 * k, 6 * sizeof *at);
        memcpy(nodes->row + 3 * nodes->count, at + 6 * nodes->count,
               3 * sizeof *at);
        nodes->grid[nodes->count++] = k;
    }
    return RITZ_OK;
}

/* List the nodes with arms once more, with the rows of their rotations. */
static ritz_status list_turning(const int64_t *row, ritz_nodal_mass *mass)
{
    const ritz_nodes *nodes = &mass->nodes;
    ritz_nodes *turning = &mass->turning;
    RITZ_OWN_ARRAY int64_t *place = NULL;

    turning->grids = nodes->grids;
    RITZ_CHECK_NEW(place, nodes->count);
    for (int64_t k = 0; k < 2 * mass->count; k++)
        if (mass->arm[k / 2].turning[k % 2] >= 0)
            place[mass->arm[k / 2].at[k % 2]] = 1;
    RITZ_CHECK_NEW(turning->grid, nodes->count);
    RITZ_CHECK_NEW(turning->row, 3 * nodes->count);
    for (int64_t i = 0; i < nodes->count; i++) {
        if (!place[i])
            continue;
        memcpy(turning->row + 3 * turning->count, row + 6 * i + 3,
               3 * sizeof *row);
        turning->grid[turning->count] = nodes->grid[i];
        place[i] = turning->count++;
    }
    for (int64_t k = 0; k < 2 * mass->count; k++)
        if (mass->arm[k / 2].turning[k % 2] >= 0)
            mass->arm[k / 2].turning[k % 2] = place[mass->arm[k / 2].at[k % 2]];
    return RITZ_OK;
}

/* ---- blocks ------------------------------------------------------------- */

/* Blocks of M in the columns of one node. */
typedef struct columns {
    const ritz_sparse *M;
    const ritz_nodes *nodes;
    const int64_t *row; /* 6 of each node */
    int64_t *place;     /* of each dof: 6 node + direction, or -1 */
    int64_t *mark;      /* of each node: its last entry in m + 1 */
    int64_t widest;     /* most nodes in a column of m */
    double *block;      /* 36 widest, row by row, along axes of nodes */
} columns;

static void columns_free(columns *c)
{
    RITZ_FREE(c->place, c->mark, c->block);
}

static ritz_status place_dofs(int64_t num_dofs, columns *c)
{
    RITZ_CHECK_NEW(c->place, num_dofs);
    RITZ_CHECK_NEW(c->mark, c->nodes->count);
    for (int64_t i = 0; i < num_dofs; i++)
        c->place[i] = -1;
    for (int64_t k = 0; k < 6 * c->nodes->count; k++)
        if (c->row[k] >= 0)
            c->place[c->row[k]] = k;
    return RITZ_OK;
}

/* Find the nodes i whose blocks M_ij are not zero, in no order. They are the
   entries of column j of m, which begins at entry `first`. If `rowind` is
   given, they are stored there and their blocks in c->block. @return where the
   column ends */
static int64_t take_column(columns *c, int64_t j, int64_t first,
                           int64_t *rowind)
{
    int64_t end = first;

    for (int q = 0; q < 6; q++) {
        const int64_t col = c->row[6 * j + q];

        for (int64_t e = col < 0 ? 0 : c->M->colptr[col];
             e < (col < 0 ? 0 : c->M->colptr[col + 1]); e++) {
            const int64_t at = c->place[c->M->rowind[e]];

            if (at < 0 || c->M->val[e] == 0.0)
                continue;
            if (c->mark[at / 6] <= first) {
                c->mark[at / 6] = ++end;
                if (rowind)
                    rowind[end - 1] = at / 6;
            }
            if (rowind)
                c->block[36 * (c->mark[at / 6] - 1 - first) + 6 * (at % 6) +
                         q] += c->M->val[e];
        }
    }
    return end;
}

/* Whether a block has entries of rotations. */
static bool has_rotations(const double *block)
{
    for (int p = 0; p < 6; p++)
        for (int q = 0; q < 6; q++)
            if ((p > 2 || q > 2) && block[6 * p + q] != 0.0)
                return true;
    return false;
}

/* Transform a block from the axes of nodes i and j to basic axes. */
static void turn_to_basic(const double *axes_i, const double *axes_j,
                          const double *block, double out[6][6])
{
    memset(out, 0, 36 * sizeof out[0][0]);
    for (int p = 0; p < 6; p++)
        for (int q = 0; q < 6; q++)
            for (int a = 0; a < 3 && block[6 * p + q] != 0.0; a++)
                for (int b = 0; b < 3; b++)
                    out[p / 3 * 3 + a][q / 3 * 3 + b] +=
                        axes_i[3 * (p % 3) + a] * block[6 * p + q] *
                        axes_j[3 * (q % 3) + b];
}

/* m = sum_pq M_ip,jq (a_ip . a_jq) / sum_pq (a_ip . a_jq)^2 over the
   translations p of node i and q of node j, with axes a. */
static double mean_of(const columns *c, int64_t i, int64_t j,
                      const double *block)
{
    const double *a = ritz_nodes_axes(c->nodes, i);
    const double *b = ritz_nodes_axes(c->nodes, j);
    double sum = 0.0;

    for (int64_t p = 0; p < 3; p++)
        for (int64_t q = 0; q < 3; q++)
            if (a != b)
                sum += block[6 * p + q] *
                       (a[3 * p] * b[3 * q] + a[3 * p + 1] * b[3 * q + 1] +
                        a[3 * p + 2] * b[3 * q + 2]);
            else if (p == q)
                sum += block[7 * p];
    return sum / ritz_shared_directions(a, c->row + 6 * i, b, c->row + 6 * j);
}

/*
 * The weight of component d of f in the block of the translations p of one
 * node, with axes a, and the rotations q of the other, with axes b: sum_pq
 * ((a_p x b_q)_d)^2. It is 2 if both nodes have all these dofs.
 */
static double count_turns(const double *a, const int64_t *moves,
                          const double *b, const int64_t *turns, int d)
{
    const int u = (d + 1) % 3;
    const int v = (d + 2) % 3;
    double sum = 0.0;

    for (int p = 0; p < 3; p++)
        for (int q = 0; q < 3; q++)
            if (moves[p] >= 0 && turns[3 + q] >= 0) {
                const double across =
                    a[3 * p + u] * b[3 * q + v] - a[3 * p + v] * b[3 * q + u];

                sum += across * across;
            }
    return fmax(sum, 1.0);
}

static void read_arm(const columns *c, const double *block, ritz_mass_arm *arm)
{
    const int64_t i = arm->at[0];
    const int64_t j = arm->at[1];
    const double *a = ritz_nodes_axes(c->nodes, i);
    const double *b = ritz_nodes_axes(c->nodes, j);
    double B[6][6], trace = 0.0;

    turn_to_basic(a, b, block, B);
    for (int d = 0; d < 3; d++) {
        const int u = (d + 1) % 3;
        const int v = (d + 2) % 3;

        /* f~ has f_d at (v, u) */
        arm->f[0][d] = (B[3 + v][u] - B[3 + u][v]) /
                       count_turns(b, c->row + 6 * j, a, c->row + 6 * i, d);
        arm->f[1][d] = (B[u][3 + v] - B[v][3 + u]) /
                       count_turns(a, c->row + 6 * i, b, c->row + 6 * j, d);
        trace += B[3 + d][3 + d];
    }
    for (int d = 0; d < 3; d++)
        for (int e = 0; e < 3; e++)
            arm->G[d][e] = (d == e ? trace / 2.0 : 0.0) - B[3 + e][3 + d];
}

static bool is_zero(const double *x, int count)
{
    for (int k = 0; k < count; k++)
        if (x[k] != 0.0)
            return false;
    return true;
}

static ritz_status add_arm(const columns *c, int64_t i, int64_t j,
                           const double *block, ritz_nodal_mass *mass)
{
    ritz_mass_arm arm = {.at = {i, j}};
    bool square = false;

    read_arm(c, block, &arm);
    square = !is_zero(&arm.G[0][0], 9);
    for (int k = 0; k < 2; k++)
        arm.turning[k] = square || !is_zero(arm.f[k], 3) ? 0 : -1;
    if (arm.turning[0] < 0 && arm.turning[1] < 0)
        return RITZ_OK;
    RITZ_CHECK_ROOM(mass->arm, mass->count, mass->room);
    mass->arm[mass->count++] = arm;
    return RITZ_OK;
}

/* If nodes i and j are the ends of a beam, subtract its part from `own`, the
   block M_jj. */
static void fit_beam(const ritz_beams *beams, int64_t i, int64_t j,
                     const double *block, double *own)
{
    ritz_beam *beam = i == j ? NULL : ritz_beams_find(beams, i, j);
    const int column = beam && beam->node[1] == j;

    if (!beam)
        return;
    ritz_beam_fit(column, block, beam);
    if (beam->known[column])
        ritz_beam_take_out(beam, column, own);
}

/* Read m, arms and beams from the blocks of column j of m, which begins at
   entry `first`. */
static ritz_status read_column(const columns *c, int64_t j, int64_t first,
                               ritz_sparse *m, ritz_nodal_mass *mass)
{
    ritz_beam *held = ritz_beams_find(&mass->beams, -1, j);
    double own[36] = {0};

    for (int64_t e = first; e < m->colptr[j + 1]; e++) {
        const int64_t i = m->rowind[e];
        const double *block = c->block + 36 * (e - first);

        m->val[e] = mean_of(c, i, j, block);
        for (int k = 0; k < 36 && i == j; k++)
            own[k] += block[k];
        if (has_rotations(block)) {
            RITZ_CHECK(add_arm(c, i, j, block, mass));
            fit_beam(&mass->beams, i, j, block, own);
        }
    }
    if (held)
        ritz_beam_fit_held(own, held);
    return RITZ_OK;
}

static ritz_status read_blocks(columns *c, ritz_nodal_mass *mass)
{
    const int64_t n = c->nodes->count;
    RITZ_OWN(ritz_sparse) m = {0}, turned = {0};
    int64_t count = 0;

    for (int64_t j = 0; j < n; j++) {
        const int64_t end = take_column(c, j, count, NULL);

        c->widest = end - count > c->widest ? end - count : c->widest;
        count = end;
    }
    memset(c->mark, 0, (size_t)n * sizeof *c->mark);
    RITZ_CHECK_NEW(c->block, 36 * c->widest);
    RITZ_CHECK(ritz_sparse_new(n, n, count, &m));
    for (int64_t j = 0; j < n; j++) {
        const int64_t first = m.colptr[j];

        m.colptr[j + 1] = take_column(c, j, first, m.rowind);
        RITZ_CHECK(read_column(c, j, first, &m, mass));
        memset(c->block, 0,
               36 * (size_t)(m.colptr[j + 1] - first) * sizeof *c->block);
    }
    /* two transpositions sort the rows of each column */
    RITZ_CHECK(ritz_sparse_transpose(&m, &turned));
    return ritz_sparse_transpose(&turned, &mass->m);
}

ritz_status ritz_nodal_mass_of(const ritz_component *component,
                               ritz_nodal_mass *out)
{
    RITZ_OWN(ritz_nodal_mass) mass = {0};
    RITZ_OWN_ARRAY int64_t *row = NULL;
    RITZ_OWN(columns) c = {.M = &component->M, .nodes = &mass.nodes};

    RITZ_CHECK(list_nodes(component, &mass.nodes, &row));
    c.row = row;
    RITZ_CHECK(
        ritz_beams_list(&component->elements, &mass.nodes, row, &mass.beams));
    RITZ_CHECK(place_dofs(component->num_dofs, &c));
    RITZ_CHECK(read_blocks(&c, &mass));
    ritz_beams_keep(&mass.beams);
    RITZ_CHECK(list_turning(row, &mass));
    RITZ_MOVE(*out, mass);
    return RITZ_OK;
}

void ritz_nodal_mass_free(ritz_nodal_mass *mass)
{
    ritz_nodes_free(&mass->nodes);
    ritz_nodes_free(&mass->turning);
    ritz_sparse_free(&mass->m);
    free(mass->arm);
    ritz_beams_free(&mass->beams);
    *mass = (ritz_nodal_mass){0};
}
