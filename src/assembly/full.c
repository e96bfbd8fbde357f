#include "assembly/assembly.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <ritz/matrix.h>

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/*
 * Full models of a scene, restricted to the dofs of their ports for the
 * assembly.
 */

/* The bodies, and the dofs at which joints, inputs and outputs may act. */
typedef struct ritz_held {
    const ritz_scene *scene;
    int64_t count;
    ritz_component *body;
    ritz_dofs *held;  /* dofs of all ports of each body */
    int64_t *first;   /* of each body's dofs among all N */
    int64_t num_dofs; /* N */
    ritz_stage stage; /* whose coordinates are the held dofs */
    int64_t *row;     /* of each such coordinate among all N */
} ritz_held;

/* Index of dof `dof` of a body among the held ones, those of its ports. */
static int64_t find_held(const ritz_dofs *held, int64_t dof)
{
    int64_t k = 0;

    while (held->at[k] != dof)
        k++;
    return k;
}

/* A port's rows as combinations of the held dofs alone. */
static ritz_status restrict_port(const ritz_component *component,
                                 const ritz_port *port, const ritz_dofs *held,
                                 ritz_port_map *map)
{
    RITZ_OWN(ritz_dense) wide = {0};

    RITZ_CHECK(ritz_port_map_of(component, port, NULL, map));
    RITZ_CHECK(ritz_dense_new(map->count, held->count, &wide));
    for (int64_t j = 0; j < map->count; j++) {
        const ritz_dense one = ritz_dense_part(&map->map, j, 1);

        ritz_dense_put(&one, 0, find_held(held, port->dofs.at[j]), &wide);
    }
    ritz_dense_replace(&map->map, &wide);
    return RITZ_OK;
}

/* A body restricted to its held dofs. */
static ritz_status restrict_body(const ritz_component *component,
                                 const ritz_dofs *held, ritz_reduced *body)
{
    body->num_dofs = component->num_dofs;
    RITZ_CHECK(ritz_dense_new(held->count, held->count, &body->K));
    RITZ_CHECK(ritz_dense_new(held->count, held->count, &body->M));
    RITZ_CHECK_NEW(body->port, component->num_ports);
    for (int64_t k = 0; k < component->num_ports; k++) {
        body->num_ports++;
        RITZ_CHECK(restrict_port(component, &component->port[k], held,
                                 &body->port[k]));
    }
    return RITZ_OK;
}

static ritz_status load_body(const ritz_source *source, const char *model,
                             ritz_component *out)
{
    char kind[RITZ_NAME_SIZE];

    RITZ_CHECK(source->kind(source->state, model, kind));
    RITZ_REFUSE_IF(strcmp(kind, "reduced") == 0, RITZ_ERR_ARGUMENT,
                   "'%s' is reduced already, its full model is wanted", model);
    return source->component(source->state, model, out);
}

static ritz_status load_bodies(ritz_held *p)
{
    const ritz_scene *scene = p->scene;

    RITZ_CHECK_NEW(p->body, scene->num_components);
    RITZ_CHECK_NEW(p->held, scene->num_components);
    RITZ_CHECK_NEW(p->first, scene->num_components);
    for (int64_t k = 0; k < scene->num_components; k++) {
        p->count++;
        p->first[k] = p->num_dofs;
        RITZ_CHECK_IN(
            scene->component[k].name,
            load_body(scene->source, scene->component[k].model, &p->body[k]));
        p->num_dofs += p->body[k].num_dofs;
        RITZ_CHECK(ritz_component_attached(&p->body[k], NULL, &p->held[k]));
    }
    return RITZ_OK;
}

/* Build the stage of held dofs, and list their indices among all dofs. */
static ritz_status build_stage(ritz_held *p)
{
    RITZ_OWN(ritz_bodies) body = {0};

    RITZ_CHECK(ritz_bodies_new(p->count, &body));
    for (int64_t k = 0; k < p->count; k++)
        RITZ_CHECK_IN(p->scene->component[k].name,
                      restrict_body(&p->body[k], &p->held[k], &body.item[k]));
    RITZ_CHECK(ritz_stage_from(p->scene, body.item, &p->stage));
    RITZ_CHECK_NEW(p->row, p->stage.num_coordinates);
    for (int64_t k = 0; k < p->count; k++)
        for (int64_t j = 0; j < p->held[k].count; j++)
            p->row[p->stage.first[k] + j] = p->first[k] + p->held[k].at[j];
    return RITZ_OK;
}

static void ritz_held_free(ritz_held *p)
{
    RITZ_FREE_EACH(ritz_component, p->count, p->body);
    RITZ_FREE_EACH(ritz_dofs, p->count, p->held);
    RITZ_FREE(p->first, p->row);
    ritz_stage_free(&p->stage);
}

/* Row and column of the largest entry left; later columns win ties. */
static double find_pivot(const ritz_dense *C, int64_t from,
                         const int64_t *pivot_of, int64_t *row, int64_t *col)
{
    double best = 0.0;

    for (int64_t j = C->ncol - 1; j >= 0; j--)
        for (int64_t i = from; i < C->nrow && pivot_of[j] < 0; i++)
            if (fabs(ritz_dense_col(C, j)[i]) > best) {
                best = fabs(ritz_dense_col(C, j)[i]);
                *row = i;
                *col = j;
            }
    return best;
}

static void swap_rows(ritz_dense *C, int64_t a, int64_t b)
{
    for (int64_t j = 0; j < C->ncol; j++) {
        double *column = ritz_dense_col(C, j);
        double kept = column[a];

        column[a] = column[b];
        column[b] = kept;
    }
}

/*
 * Gauss-Jordan elimination with complete pivoting: C becomes rows with one
 * slave (an eliminated dof) each, u_s + sum_m C_sm u_m = 0. Dependent rows have
 * no slave; among equal pivots later columns become slaves.
 *
 * @param[in]  C         rows of largest norm 1, relative to which entries
 *                       are rounding
 * @param[out] pivot_of  C->ncol: the row in which a column is the slave, -1 for
 *                       masters
 */
static void eliminate_slaves(ritz_dense *C, int64_t *pivot_of)
{
    int64_t row = 0;
    int64_t col = 0;

    for (int64_t j = 0; j < C->ncol; j++)
        pivot_of[j] = -1;
    for (int64_t k = 0; k < C->nrow; k++) {
        if (find_pivot(C, k, pivot_of, &row, &col) <= RITZ_RANK_LOSS)
            return;
        swap_rows(C, k, row);
        pivot_of[col] = k;
        for (int64_t j = 0; j < C->ncol; j++) {
            double *column = ritz_dense_col(C, j);

            if (j == col)
                continue;
            column[k] /= ritz_dense_col(C, col)[k];
            for (int64_t i = 0; i < C->nrow; i++)
                if (i != k)
                    column[i] -= ritz_dense_col(C, col)[i] * column[k];
        }
        memset(ritz_dense_col(C, col), 0, (size_t)C->nrow * sizeof *C->val);
        ritz_dense_col(C, col)[k] = 1.0;
    }
}

/*
 * The full-order system as one component. Bodies are joined at few dofs: with
 * the constraints C u = 0 over the dofs of all ports, Gauss-Jordan elimination
 * with complete pivoting picks as many of them as slaves as C has rank,
 *
 *     u_s = -C_m u_m,    u = T u_m,    K = T' diag(K_1, K_2, ...) T
 *
 * and T is the identity but for the rows of the slaves, so K stays sparse.
 */

/* T from the reduced constraints, and the list of the masters. */
static ritz_status make_basis(const ritz_held *p, const ritz_dense *C,
                              const int64_t *pivot_of, ritz_master *master,
                              ritz_sparse *T)
{
    int64_t most = p->num_dofs + C->nrow * C->ncol;
    RITZ_OWN_ARRAY int64_t *column = NULL, *row = NULL, *col = NULL;
    RITZ_OWN_ARRAY double *val = NULL;
    int64_t count = 0, masters = 0;

    RITZ_CHECK_NEW(column, p->num_dofs); /* of each dof in T, -1 for slaves */
    RITZ_CHECK_NEW(row, most);
    RITZ_CHECK_NEW(col, most);
    RITZ_CHECK_NEW(val, most);
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
    return ritz_sparse_from_triplets(p->num_dofs, masters, count, row, col, val,
                                     T);
}

/* A matrix of a body, by its offset in the component. */
static const ritz_sparse *body_matrix(const ritz_component *body, size_t offset)
{
    return (const ritz_sparse *)(const void *)((const char *)body + offset);
}

/*
 * A matrix of each body, by its offset in the component, on a block diagonal:
 * rows from @p first, columns those of the body; {0} if no body has it.
 */
static ritz_status stack_matrices(const ritz_held *p, size_t offset,
                                  int64_t rows, const int64_t *first,
                                  ritz_sparse *out)
{
    RITZ_OWN(ritz_sparse) A = {0};
    int64_t nnz = 0;
    bool any = false;

    for (int64_t k = 0; k < p->count; k++) {
        const ritz_sparse *part = body_matrix(&p->body[k], offset);

        any = any || part->colptr;
        nnz += part->colptr ? part->colptr[part->ncol] : 0;
    }
    if (!any)
        return RITZ_OK;
    RITZ_CHECK(ritz_sparse_new(rows, p->num_dofs, nnz, &A));
    for (int64_t k = 0; k < p->count; k++) {
        const ritz_sparse *part = body_matrix(&p->body[k], offset);

        for (int64_t j = 0; j < p->body[k].num_dofs; j++) {
            int64_t *end = &A.colptr[p->first[k] + j + 1];

            *end = end[-1];
            if (!part->colptr)
                continue;
            for (int64_t e = part->colptr[j]; e < part->colptr[j + 1]; e++) {
                A.rowind[*end] = first[k] + part->rowind[e];
                A.val[(*end)++] = part->val[e];
            }
        }
    }
    RITZ_MOVE(*out, A);
    return RITZ_OK;
}

/* A matrix of body k, in the rows and columns of its dofs in the system. */
static ritz_status place_block(const ritz_held *p, int64_t k,
                               const ritz_sparse *A, ritz_sparse *out)
{
    const int64_t entries = A->colptr[A->ncol];

    RITZ_CHECK(ritz_sparse_new(p->num_dofs, p->num_dofs, entries, out));
    for (int64_t j = 0; j < A->ncol; j++)
        out->colptr[p->first[k] + j + 1] = A->colptr[j + 1];
    for (int64_t j = p->first[k] + A->ncol; j < p->num_dofs; j++)
        out->colptr[j + 1] = entries;
    for (int64_t e = 0; e < entries; e++) {
        out->rowind[e] = p->first[k] + A->rowind[e];
        out->val[e] = A->val[e];
    }
    return RITZ_OK;
}

/* Geometric stiffness of each load of each body, "body:load". */
static ritz_status project_loads(const ritz_held *p, const ritz_sparse *T,
                                 ritz_component *system)
{
    int64_t count = 0;

    for (int64_t k = 0; k < p->count; k++)
        count += p->body[k].num_loads;
    RITZ_CHECK_NEW(system->load, count);
    for (int64_t k = 0; k < p->count; k++)
        for (int64_t j = 0; j < p->body[k].num_loads; j++) {
            const ritz_load *load = &p->body[k].load[j];
            ritz_load *made = &system->load[system->num_loads++];
            RITZ_OWN(ritz_sparse) all = {0};

            RITZ_CHECK(ritz_body_load_name(p->scene->component[k].name,
                                           load->name, made->name));
            RITZ_CHECK(place_block(p, k, &load->KG, &all));
            RITZ_CHECK(ritz_sparse_congruence(&all, T, &made->KG));
        }
    return RITZ_OK;
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
    RITZ_OWN(ritz_springs) springs = {0};
    RITZ_OWN(ritz_sparse) all = {0};

    RITZ_CHECK(ritz_stage_springs(&p->stage, setting, &springs));
    for (int k = 0; k < MATRICES; k++) {
        ritz_sparse *into =
            (ritz_sparse *)(void *)((char *)system + offsets[k]);

        RITZ_CHECK(stack_matrices(p, offsets[k], p->num_dofs, p->first, &all));
        if (k == K || k == D)
            RITZ_CHECK(ritz_springs_add_sparse(&springs, k == D, p->num_dofs,
                                               p->row, &all));
        if (all.colptr)
            RITZ_CHECK(ritz_sparse_congruence(&all, T, into));
        ritz_sparse_free(&all);
    }
    return project_loads(p, T, system);
}

/*
 * Expand B from held coordinates to all dofs, then project on the masters: B =
 * T' B.
 */
static ritz_status project_io(const ritz_held *p, const ritz_sparse *turned,
                              ritz_io *out)
{
    const int64_t Q = p->stage.num_coordinates;
    RITZ_OWN(ritz_dense) S = {0};

    /* S = E T, E picking the held coordinates out of all dofs */
    RITZ_CHECK(ritz_dense_new(Q, turned->nrow, &S));
    for (int64_t j = 0; j < Q; j++) {
        int64_t c = p->row[j];

        for (int64_t e = turned->colptr[c]; e < turned->colptr[c + 1]; e++)
            ritz_dense_col(&S, turned->rowind[e])[j] = turned->val[e];
    }
    return ritz_io_project(&p->stage.io, &S, out);
}

/*
 * Influence vectors of all bodies' dampers, expanded to all dofs and projected
 * on the masters.
 */
static ritz_status project_dampers(const ritz_held *p,
                                   const ritz_sparse *turned, ritz_dampers *out)
{
    RITZ_OWN(ritz_dampers) all = {0};
    RITZ_OWN(ritz_dense) B = {0};

    for (int64_t k = 0; k < p->count; k++)
        RITZ_CHECK(ritz_dampers_append(&p->body[k].dampers,
                                       p->scene->component[k].name, p->num_dofs,
                                       p->first[k], &all));
    if (all.count == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_sparse_mul(turned, &all.B, &B));
    ritz_dense_replace(&all.B, &B);
    RITZ_MOVE(*out, all);
    return RITZ_OK;
}

/* Recovery of dofs that constraints eliminated in the bodies: diag(G_k) T. */
static ritz_status project_recovery(const ritz_held *p, const int64_t *add,
                                    const ritz_sparse *T, ritz_recovery *out)
{
    RITZ_OWN(ritz_sparse) G = {0};
    RITZ_OWN_ARRAY int64_t *first = NULL;
    int64_t rows = 0;

    RITZ_CHECK_NEW(first, p->count);
    for (int64_t k = 0; k < p->count; k++) {
        first[k] = rows;
        rows += p->body[k].recovery.count;
    }
    if (rows == 0)
        return RITZ_OK;
    RITZ_CHECK_NEW(out->dof, rows);
    for (int64_t k = 0; k < p->count; k++) {
        const ritz_recovery *r = &p->body[k].recovery;

        for (int64_t i = 0; i < r->count; i++)
            out->dof[out->count++] =
                (ritz_dof){r->dof[i].grid + add[k], r->dof[i].component};
    }
    RITZ_CHECK(stack_matrices(p, offsetof(ritz_component, recovery.G), rows,
                              first, &G));
    return ritz_sparse_product(&G, T, &out->G);
}

/*
 * Names of the masters, and the grids of all bodies at their positions for
 * these settings.
 */
static ritz_status name_dofs(const ritz_held *p, const double *setting,
                             const ritz_master *master, const ritz_sparse *T,
                             ritz_component *system)
{
    RITZ_OWN_ARRAY int64_t *add = NULL;

    RITZ_CHECK_NEW(add, p->count);
    RITZ_CHECK(ritz_place_grids(&p->stage, setting, p->count, p->body, add,
                                &system->grids));
    RITZ_CHECK_NEW(system->dof, system->num_dofs);
    for (int64_t j = 0; j < system->num_dofs; j++) {
        system->dof[j] = p->body[master[j].body].dof[master[j].dof];
        system->dof[j].grid += add[master[j].body];
    }
    return project_recovery(p, add, T, &system->recovery);
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

ritz_status ritz_assemble_full(const ritz_scene *scene, const double *setting,
                               ritz_component *out, ritz_master **where)
{
    RITZ_OWN(ritz_component) system = {0};
    RITZ_OWN(ritz_held) p = {.scene = scene};
    RITZ_OWN(ritz_dense) C = {0};
    RITZ_OWN(ritz_sparse) T = {0}, turned = {0};
    RITZ_OWN_ARRAY ritz_master *master = NULL;
    RITZ_OWN_ARRAY int64_t *pivot_of = NULL;

    RITZ_CHECK(ritz_spin_refuse(scene));
    RITZ_CHECK(load_bodies(&p));
    RITZ_CHECK(build_stage(&p));
    RITZ_CHECK(check_units(scene, &p));
    RITZ_CHECK(ritz_stage_constraints(&p.stage, setting, NULL, &C));
    RITZ_CHECK_NEW(pivot_of, C.ncol);
    RITZ_CHECK_NEW(master, p.num_dofs);
    eliminate_slaves(&C, pivot_of);
    RITZ_CHECK(make_basis(&p, &C, pivot_of, master, &T));
    system.num_dofs = T.ncol;
    RITZ_CHECK(project_matrices(&p, setting, &T, &system));
    RITZ_CHECK(ritz_sparse_transpose(&T, &turned));
    RITZ_CHECK(project_io(&p, &turned, &system.io));
    RITZ_CHECK(project_dampers(&p, &turned, &system.dampers));
    RITZ_CHECK(name_dofs(&p, setting, master, &T, &system));
    ritz_damping_print(&scene->damping, system.damping);
    memcpy(system.units, p.body[0].units, sizeof system.units);
    RITZ_CHECK(ritz_component_settle(&system, false));
    RITZ_MOVE(*out, system);
    if (where)
        RITZ_MOVE(*where, master);
    return RITZ_OK;
}

ritz_status ritz_scene_near_axes(const ritz_scene *scene, const double *setting,
                                 ritz_near_axes *out)
{
    RITZ_OWN(ritz_held) p = {.scene = scene};
    bool loops = false;

    RITZ_CHECK(ritz_scene_loops(scene, &loops));
    if (!loops)
        return RITZ_OK;
    RITZ_CHECK(load_bodies(&p));
    RITZ_CHECK(build_stage(&p));
    return ritz_stage_near_axes(&p.stage, setting, out);
}

/*
 * The basis T of an assembled system. Bodies move as u_c = T_c q_c with q_c =
 * P_c x. C P = 0 holds in their ports' maps, which are rows of T_c, so that
 * (u_1, u_2, ...) satisfies the full-order constraints too and follows from its
 * masters.
 */
ritz_status ritz_stage_basis(const ritz_stage *stage,
                             const ritz_configuration *at, int64_t n,
                             const ritz_master *master, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) T = {0};
    RITZ_OWN_ARRAY int64_t *row = NULL;

    RITZ_CHECK_NEW(row, n);
    RITZ_CHECK(ritz_dense_new(n, at->K.ncol, &T));
    for (int64_t first = 0, last = 0; first < n; first = last) {
        const int64_t k = master[first].body;
        const ritz_reduced *body = &stage->body[k];
        RITZ_OWN(ritz_dense) part = {0}, TP = {0};
        int64_t most = 0;

        for (last = first; last < n && master[last].body == k; last++) {
            row[last] = master[last].dof;
            most = row[last] > most ? row[last] : most;
        }
        RITZ_REFUSE_IF(!body->T.val || body->T.nrow <= most, RITZ_ERR_ARGUMENT,
                       "'%s' has no basis T for its %" PRId64 " dofs",
                       stage->scene->component[k].name, most + 1);
        RITZ_CHECK(ritz_dense_rows(&body->T, last - first, row + first, &part));
        RITZ_CHECK(ritz_dense_mul(&part, &at->P[k], &TP));
        ritz_dense_put(&TP, first, 0, &T);
    }
    RITZ_MOVE(*out, T);
    return RITZ_OK;
}
