/*
 * The full-order system as one component. Bodies meet at few dofs: with the
 * constraints C u = 0 over the dofs of all ports, Gauss-Jordan elimination with
 * complete pivoting picks as many of them as slaves as C has rank,
 *
 *     u_s = -C_m u_m,    u = T u_m,    K = T' diag(K_1, K_2, ...) T
 *
 * and T is the identity but for the rows of the slaves, so K stays sparse.
 */
#include "assembly/eliminate.h"
#include "assembly/held.h"
#include "assembly/placement.h"
#include "assembly/springs.h"
#include "base/alloc.h"

#include <ritz/synthesis.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* T from the reduced constraints, and what the masters are. */
static ritz_status make_basis(const ritz_held *p, const ritz_dense *C,
                              const int64_t *pivot_of, ritz_master *master,
                              ritz_sparse *T)
{
    ritz_status status = RITZ_OK;
    int64_t most = p->num_dofs + C->nrow * C->ncol;
    int64_t *column = NULL, *row = NULL, *col = NULL;
    double *val = NULL;
    int64_t count = 0, masters = 0;

    RITZ_NEW(column, p->num_dofs); /* of each dof in T, -1 for slaves */
    RITZ_NEW(row, most);
    RITZ_NEW(col, most);
    RITZ_NEW(val, most);
    for (int64_t j = 0; j < C->ncol; j++)
        if (pivot_of[j] >= 0)
            column[p->row[j]] = -1;
    for (int64_t i = 0, k = 0; i < p->num_dofs; i++) {
        while (i >= p->first[k] + p->body[k].num_dofs)
            k++;
        if (column[i] < 0)
            continue;
        column[i] = masters;
        master[masters] = (ritz_master){k, i - p->first[k]};
        row[count] = i;
        col[count] = masters++;
        val[count++] = 1.0;
    }
    for (int64_t s = 0; s < C->ncol; s++)
        for (int64_t m = 0; m < C->ncol && pivot_of[s] >= 0; m++) {
            double g = ritz_dense_col(C, m)[pivot_of[s]];

            if (pivot_of[m] >= 0 || g == 0.0)
                continue;
            row[count] = p->row[s];
            col[count] = column[p->row[m]];
            val[count++] = -g;
        }
    RITZ_TRY(ritz_sparse_from_triplets(p->num_dofs, masters, count, row, col,
                                       val, T));
done:
    free(column);
    free(row);
    free(col);
    free(val);
    return status;
}

/* One matrix of every body, by where it lies in a component. */
static const ritz_sparse *matrix_of(const ritz_component *body, size_t offset)
{
    return (const ritz_sparse *)(const void *)((const char *)body + offset);
}

/* diag(A_1, A_2, ...), bodies without one giving nothing; {0} if none has. */
static ritz_status stack(const ritz_held *p, size_t offset, ritz_sparse *out)
{
    ritz_status status = RITZ_OK;
    ritz_sparse A = {0};
    int64_t nnz = 0, at = 0;
    bool any = false;

    for (int64_t k = 0; k < p->count; k++) {
        const ritz_sparse *part = matrix_of(&p->body[k], offset);

        any = any || part->colptr;
        nnz += part->colptr ? part->colptr[part->ncol] : 0;
    }
    if (!any)
        return RITZ_OK;
    RITZ_TRY(ritz_sparse_new(p->num_dofs, p->num_dofs, nnz, &A));
    for (int64_t k = 0; k < p->count; k++) {
        const ritz_sparse *part = matrix_of(&p->body[k], offset);

        for (int64_t j = 0; j < p->body[k].num_dofs; j++) {
            for (int64_t e = part->colptr ? part->colptr[j] : 0;
                 part->colptr && e < part->colptr[j + 1]; e++) {
                A.rowind[at] = p->first[k] + part->rowind[e];
                A.val[at++] = part->val[e];
            }
            A.colptr[p->first[k] + j + 1] = at;
        }
    }
    *out = A;
    A = (ritz_sparse){0};
done:
    ritz_sparse_free(&A);
    return status;
}

static ritz_status project_matrices(const ritz_held *p, const double *setting,
                                    const ritz_sparse *T,
                                    ritz_component *system)
{
    enum { K, M, D, K4, MATRICES };
    static const size_t offsets[MATRICES] = {
        [K] = offsetof(ritz_component, K),
        [M] = offsetof(ritz_component, M),
        [D] = offsetof(ritz_component, D),
        [K4] = offsetof(ritz_component, K4),
    };
    ritz_status status = RITZ_OK;
    ritz_springs springs = {0};
    ritz_sparse all = {0};

    RITZ_TRY(ritz_stage_springs(&p->stage, setting, &springs));
    for (int k = 0; k < MATRICES; k++) {
        ritz_sparse *into =
            (ritz_sparse *)(void *)((char *)system + offsets[k]);

        RITZ_TRY(stack(p, offsets[k], &all));
        if (k == K || k == D)
            RITZ_TRY(ritz_springs_add_sparse(&springs, k == D, p->num_dofs,
                                             p->row, &all));
        if (all.colptr)
            RITZ_TRY(ritz_sparse_congruence(&all, T, into));
        ritz_sparse_free(&all);
    }
done:
    ritz_springs_free(&springs);
    ritz_sparse_free(&all);
    return status;
}

/* Scatter held coordinates to all dofs, then to masters: B = T' B. */
static ritz_status project_io(const ritz_held *p, const ritz_sparse *T,
                              ritz_io *out)
{
    ritz_status status = RITZ_OK;
    const int64_t Q = p->stage.num_coordinates;
    ritz_sparse turned = {0};
    ritz_dense S = {0};

    /* S = E T, E picking the held coordinates out of all dofs */
    RITZ_TRY(ritz_sparse_transpose(T, &turned));
    RITZ_TRY(ritz_dense_new(Q, T->ncol, &S));
    for (int64_t j = 0; j < Q; j++) {
        int64_t c = p->row[j];

        for (int64_t e = turned.colptr[c]; e < turned.colptr[c + 1]; e++)
            ritz_dense_col(&S, turned.rowind[e])[j] = turned.val[e];
    }
    RITZ_TRY(ritz_io_project(&p->stage.io, &S, out));
done:
    ritz_sparse_free(&turned);
    ritz_dense_free(&S);
    return status;
}

/* Influence vectors of all bodies' dampers, scattered and brought to masters. */
static ritz_status project_dampers(const ritz_held *p, const ritz_sparse *T,
                                   ritz_dampers *out)
{
    ritz_status status = RITZ_OK;
    ritz_dampers all = {0};
    ritz_sparse turned = {0};
    ritz_dense B = {0};

    for (int64_t k = 0; k < p->count; k++)
        RITZ_TRY(ritz_dampers_append(&p->body[k].dampers,
                                     p->scene->component[k].name, p->num_dofs,
                                     p->first[k], &all));
    if (all.count == 0)
        return RITZ_OK;
    RITZ_TRY(ritz_sparse_transpose(T, &turned));
    RITZ_TRY(ritz_sparse_mul(&turned, &all.B, &B));
    ritz_dense_free(&all.B);
    all.B = B;
    B = (ritz_dense){0};
    *out = all;
    all = (ritz_dampers){0};
done:
    ritz_dampers_free(&all);
    ritz_sparse_free(&turned);
    ritz_dense_free(&B);
    return status;
}

/* Names of the masters; grids of all bodies where the angles put them. */
static ritz_status name_dofs(const ritz_held *p, const double *setting,
                             const ritz_master *master, const ritz_sparse *T,
                             ritz_component *system)
{
    ritz_status status = RITZ_OK;
    int64_t *add = NULL;

    RITZ_NEW(add, p->count);
    RITZ_TRY(ritz_place_grids(&p->stage, setting, p->count, p->body, add,
                              &system->grids));
    RITZ_NEW(system->dof, system->num_dofs);
    for (int64_t j = 0; j < system->num_dofs; j++) {
        system->dof[j] = p->body[master[j].body].dof[master[j].dof];
        system->dof[j].grid += add[master[j].body];
    }
    RITZ_TRY(ritz_held_recovery(p, add, T, &system->recovery));
done:
    free(add);
    return status;
}

static ritz_status check_units(const ritz_scene *scene, const ritz_held *p)
{
    for (int64_t k = 1; k < p->count; k++)
        RITZ_REFUSE_IF(
            strcmp(p->body[k].units, p->body[0].units) != 0, RITZ_ERR_ARGUMENT,
            "'%s' is in units '%s' and '%s' in '%s'", scene->component[0].name,
            p->body[0].units, scene->component[k].name, p->body[k].units);
    return RITZ_OK;
}

ritz_status ritz_assemble_masters(const ritz_scene *scene,
                                  const double *setting, ritz_component *out,
                                  ritz_master **where)
{
    ritz_status status = RITZ_OK;
    ritz_component system = {0};
    ritz_master *master = NULL;
    ritz_held p = {0};
    ritz_dense C = {0};
    ritz_sparse T = {0};
    double *scale = NULL;
    int64_t *pivot_of = NULL;

    RITZ_TRY(ritz_held_load(scene, &p));
    RITZ_TRY(check_units(scene, &p));
    RITZ_NEW(scale, p.stage.num_coordinates);
    for (int64_t j = 0; j < p.stage.num_coordinates; j++)
        scale[j] = 1.0;
    RITZ_TRY(ritz_stage_constraints(&p.stage, setting, scale, &C));
    RITZ_NEW(pivot_of, C.ncol);
    RITZ_NEW(master, p.num_dofs);
    ritz_eliminate(&C, pivot_of);
    RITZ_TRY(make_basis(&p, &C, pivot_of, master, &T));
    system.num_dofs = T.ncol;
    RITZ_TRY(project_matrices(&p, setting, &T, &system));
    RITZ_TRY(project_io(&p, &T, &system.io));
    RITZ_TRY(project_dampers(&p, &T, &system.dampers));
    RITZ_TRY(name_dofs(&p, setting, master, &T, &system));
    ritz_damping_print(&scene->damping, system.damping);
    memcpy(system.units, p.body[0].units, sizeof system.units);
    RITZ_TRY(ritz_component_settle(&system, false));
    *out = system;
    *where = master;
    system = (ritz_component){0};
    master = NULL;
done:
    free(scale);
    free(pivot_of);
    free(master);
    ritz_dense_free(&C);
    ritz_sparse_free(&T);
    ritz_held_free(&p);
    ritz_component_free(&system);
    return status;
}

ritz_status ritz_assemble_full(const ritz_scene *scene, const double *setting,
                               ritz_component *out)
{
    ritz_master *master = NULL;
    ritz_status status = ritz_assemble_masters(scene, setting, out, &master);

    free(master);
    return status;
}
