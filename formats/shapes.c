/* Shapes of modes and of columns, at points. */
#include "base/alloc.h"
#include "base/search.h"
#include "base/text.h"
#include "base/tolerances.h"
#include "model/modal.h"
#include "model/squares.h"

#include <ritz/export.h>
#include <ritz/matrix.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A body that moves, with recovered dofs behind its own. */
typedef struct body {
    int64_t num_dofs;
    const ritz_dof *dof;
    const ritz_recovery *recovery;
    const ritz_grids *grids;
    const ritz_elements *elements;
} body;

/* ---- lists of modes, "1-6,9" -------------------------------------------- */

/* Modes or columns from 0, as listed. */
typedef struct mode_choice {
    int64_t count, room;
    int64_t *at;
} mode_choice;

static void mode_choice_free(mode_choice *which)
{
    free(which->at);
}

/* Append the numbers of a list, which are at most @p most; `which` NULL: only
 * the largest is wanted. */
static ritz_status walk_list(const char *list, const char *what, int64_t most,
                             mode_choice *which, int64_t *largest)
{
    const char *end = list + strlen(list);

    for (const char *at = list; at <= end;) {
        size_t length = strcspn(at, ",");
        int64_t from = 0, to = 0;

        RITZ_REFUSE_IF(!ritz_text_range(at, length, &from, &to),
                       RITZ_ERR_ARGUMENT,
                       "'%.*s' is no part of a list of modes such as 1,5,10-20",
                       (int)(length % 64), at);
        to = to > 0 ? to : from;
        RITZ_REFUSE_IF(to > most, RITZ_ERR_ARGUMENT,
                       "there is no %s %" PRId64 ", there are %" PRId64, what,
                       to, most);
        *largest = to > *largest ? to : *largest;
        for (int64_t k = from; which && k <= to; k++) {
            RITZ_CHECK_ROOM(which->at, which->count, which->room);
            which->at[which->count++] = k - 1;
        }
        at += length + 1;
    }
    return RITZ_OK;
}

/* "1,7-9" of @p most that there are; NULL: all. */
static ritz_status choose_modes(const char *list, const char *what,
                                int64_t most, mode_choice *out)
{
    int64_t largest = 0;

    if (list)
        return walk_list(list, what, most, out, &largest);
    RITZ_CHECK_NEW(out->at, most);
    for (; out->count < most; out->count++)
        out->at[out->count] = out->count;
    return RITZ_OK;
}

/* ---- points, how they move, and cells between them ---------------------- */

/* Grids with a dof, in ascending order; index[k]: point of grid k, or -1. */
static ritz_status list_points(const body *m, int64_t *index, bool *turns,
                               ritz_shapes *out)
{
    const ritz_grids *grids = m->grids;

    for (int64_t k = 0; k < grids->count; k++)
        index[k] = -1;
    for (int64_t i = 0; i < m->num_dofs; i++) {
        int64_t k = m->dof[i].component > 0
                        ? ritz_grids_find(grids, m->dof[i].grid)
                        : -1;

        *turns = *turns || m->dof[i].component > 3;
        if (k >= 0)
            index[k] = 0;
        else if (i == 0 || m->dof[i].grid != m->dof[i - 1].grid)
            out->num_placeless++;
    }
    for (int64_t k = 0; k < grids->count; k++)
        if (index[k] == 0)
            index[k] = out->num_points++;
    RITZ_REFUSE_IF(out->num_points == 0, RITZ_ERR_ARGUMENT,
                   "no grid has a position: import with --bulk");
    RITZ_CHECK_NEW(out->id, out->num_points);
    RITZ_CHECK_NEW(out->position, 3 * out->num_points);
    for (int64_t k = 0; k < grids->count; k++) {
        if (index[k] < 0)
            continue;
        out->id[index[k]] = grids->id[k];
        memcpy(out->position + 3 * index[k], grids->position + 3 * k,
               3 * sizeof *out->position);
    }
    return RITZ_OK;
}

/* Displacement axis i of a grid brings axes[3 i + j] along basic axis j. */
static void place_motion(const body *m, const ritz_dense *T,
                         const int64_t *index, ritz_shapes *out)
{
    const ritz_grids *grids = m->grids;

    for (int64_t i = 0; i < m->num_dofs; i++) {
        int64_t c = m->dof[i].component;
        int64_t k = c > 0 ? ritz_grids_find(grids, m->dof[i].grid) : -1;
        const double *axis = NULL;
        ritz_dense *to = c > 3 ? &out->turn : &out->u;

        if (k < 0)
            continue;
        axis = grids->axes + 9 * grids->frame[k] + 3 * ((c - 1) % 3);
        for (int64_t j = 0; j < T->ncol; j++)
            for (int b = 0; b < 3; b++)
                ritz_dense_col(to, j)[3 * index[k] + b] +=
                    axis[b] * ritz_dense_col(T, j)[i];
    }
}

/* Elements by points; a cell for each point if there are none. */
static ritz_status list_cells(const body *m, ritz_shapes *out)
{
    RITZ_OWN(ritz_elements) cells = {0};

    RITZ_CHECK(ritz_elements_copy(m->elements, &cells));
    (void)ritz_elements_keep(&cells, out->num_points, out->id);
    for (int64_t i = 0; cells.count > 0 && i < cells.first[cells.count]; i++)
        cells.grid[i] = ritz_search(out->num_points, out->id, cells.grid[i]);
    out->meshed = cells.count > 0;
    if (!out->meshed) {
        cells.count = out->num_points;
        RITZ_CHECK_NEW(cells.kind, cells.count);
        RITZ_CHECK_NEW(cells.first, cells.count + 1);
        RITZ_CHECK_NEW(cells.grid, cells.count);
        for (int64_t k = 0; k < cells.count; k++) {
            cells.kind[k] = RITZ_CELL_POINT;
            cells.grid[k] = k;
            cells.first[k + 1] = k + 1;
        }
    }
    RITZ_MOVE(out->cells, cells);
    return RITZ_OK;
}

/* All of the shapes but their names; recovered dofs move with the others. */
static ritz_status place_shapes(const body *own, const ritz_dense *T,
                                ritz_shapes *out)
{
    RITZ_OWN_ARRAY int64_t *index = NULL;
    RITZ_OWN_ARRAY ritz_dof *dof = NULL;
    RITZ_OWN(ritz_dense) shape = {0};
    body all = *own;
    bool turns = false;

    RITZ_CHECK(ritz_recovery_extend(own->recovery, own->num_dofs, own->dof, T,
                                    &dof, &shape));
    all.num_dofs += own->recovery->count;
    all.dof = dof;
    RITZ_CHECK_NEW(index, all.grids->count);
    RITZ_CHECK(list_points(&all, index, &turns, out));
    RITZ_CHECK(ritz_dense_new(3 * out->num_points, shape.ncol, &out->u));
    if (turns)
        RITZ_CHECK(ritz_dense_new(3 * out->num_points, shape.ncol, &out->turn));
    place_motion(&all, &shape, index, out);
    return list_cells(&all, out);
}

/* ---- which shapes ------------------------------------------------------- */

/* Chosen columns, and room for what they are called. */
static ritz_status pick_shapes(const ritz_dense *from, const mode_choice *which,
                               ritz_dense *T, ritz_shapes *out)
{
    RITZ_CHECK(ritz_dense_new(from->nrow, which->count, T));
    RITZ_CHECK_NEW(out->name, which->count + 1);
    out->count = which->count;
    for (int64_t j = 0; j < which->count; j++)
        memcpy(ritz_dense_col(T, j), ritz_dense_col(from, which->at[j]),
               (size_t)T->nrow * sizeof *T->val);
    return RITZ_OK;
}

/* Shapes with titles "mode 7, 12.3 Hz"; a spurious one is "negative square 41,
   -27.9 Hz". */
static ritz_status pick_modes(const ritz_pairs *pairs, bool squares,
                              const mode_choice *which, ritz_dense *Phi,
                              ritz_shapes *out)
{
    RITZ_CHECK(pick_shapes(&pairs->Phi, which, Phi, out));
    for (int64_t j = 0; j < which->count; j++) {
        int64_t k = which->at[j];
        double hertz =
            k < pairs->num_rigid ? 0.0 : ritz_eigen_hertz(pairs->lambda[k]);

        snprintf(out->name[j], RITZ_NAME_SIZE, "%s %" PRId64 ", %.4g Hz",
                 squares && hertz < 0.0 ? "negative square" : "mode", k + 1,
                 hertz);
    }
    return RITZ_OK;
}

/*
 * Number, frequency and damping ratio of the chosen modes, with Lambda = w^2,
 *
 *     zeta_k = (phi_k'D phi_k + c_k) / (2 w_k),
 *
 * c_k being what stated damping adds.
 *
 * @param[in] Delta  Phi'D Phi of the chosen modes; {0}: there is no D
 * @param[in] text   stated damping
 */
static ritz_status rate_modes(const ritz_pairs *pairs, const mode_choice *which,
                              const ritz_dense *Delta, const char *text,
                              ritz_shapes *out)
{
    ritz_damping damping = {0};

    RITZ_CHECK_IN("damping", ritz_damping_parse(text, &damping));
    RITZ_CHECK_NEW(out->mode, which->count);
    out->coupled = Delta->val != NULL;
    for (int64_t j = 0; j < which->count; j++) {
        ritz_shape_mode *mode = &out->mode[j];
        int64_t k = which->at[j];
        double lambda = k < pairs->num_rigid ? 0.0 : pairs->lambda[k];

        mode->number = k + 1;
        mode->hertz = ritz_eigen_hertz(lambda);
        if (lambda <= 0.0)
            continue;
        mode->ratio = ritz_modal_rate(&damping, k - pairs->num_rigid, lambda);
        if (Delta->val)
            mode->ratio += ritz_dense_col(Delta, j)[j];
        mode->ratio /= 2.0 * sqrt(lambda);
    }
    return RITZ_OK;
}

static body body_of_component(const ritz_component *component)
{
    return (body){component->num_dofs, component->dof, &component->recovery,
                  &component->grids, &component->elements};
}

static body body_of_reduced(const ritz_reduced *reduced)
{
    return (body){reduced->num_dofs, reduced->dof, &reduced->recovery,
                  &reduced->grids, &reduced->elements};
}

ritz_status ritz_shapes_of_reduced(const ritz_reduced *reduced,
                                   const char *list, ritz_shapes *out)
{
    const body whole = body_of_reduced(reduced);
    RITZ_OWN(ritz_shapes) shapes = {0};
    RITZ_OWN(ritz_structure) model = {0};
    RITZ_OWN(ritz_dense) Delta = {0}, Phi = {0}, T = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    RITZ_OWN(mode_choice) which = {0};

    RITZ_REFUSE_IF(!reduced->T.val || !reduced->dof, RITZ_ERR_ARGUMENT,
                   "it was reduced --without-basis, which holds the shapes");
    RITZ_CHECK(ritz_structure_of_reduced(reduced, &model));
    RITZ_CHECK(ritz_eigen_dense(&model.K, &model.M, &pairs));
    RITZ_CHECK(choose_modes(list, "mode", pairs.Phi.ncol, &which));
    RITZ_CHECK(pick_modes(&pairs, false, &which, &Phi, &shapes));
    if (model.D.val)
        RITZ_CHECK(ritz_dense_project(&model.D, &Phi, &Delta));
    RITZ_CHECK(rate_modes(&pairs, &which, &Delta, reduced->damping, &shapes));
    shapes.structural = reduced->K4.val != NULL;
    memcpy(shapes.units, reduced->units, sizeof shapes.units);
    RITZ_CHECK(ritz_dense_mul(&reduced->T, &Phi, &T));
    RITZ_CHECK(place_shapes(&whole, &T, &shapes));
    RITZ_MOVE(*out, shapes);
    return RITZ_OK;
}

/*
 * The shapes of a system. With the coordinates q_c = P_c x of body c, its grids
 * move by T_c P_c phi along the body's own axes, and are at R_c X + t_c.
 */

RITZ_ARRAY_OF(ritz_shapes);

static ritz_status check_shapes(const ritz_system *system,
                                const ritz_reduced *const *bodies)
{
    for (int64_t c = 0; c < system->num_components; c++)
        RITZ_REFUSE_IF(!bodies[c]->T.val || !bodies[c]->dof, RITZ_ERR_ARGUMENT,
                       "'%s' was reduced --without-basis, which holds its "
                       "shapes",
                       system->component[c].name);
    return RITZ_OK;
}

/* Offset of the grid numbers of each body, if any numbers occur twice. */
static ritz_status renumber_grids(const ritz_shapes_array *part, int64_t *add)
{
    int64_t highest = -1, power = 1;
    bool overlap = false;

    for (int64_t c = 0; c < part->count; c++) {
        const ritz_shapes *s = &part->at[c];

        overlap = overlap || s->id[0] <= highest;
        if (s->id[s->num_points - 1] > highest)
            highest = s->id[s->num_points - 1];
    }
    if (!overlap)
        return RITZ_OK;
    while (highest >= power && power < INT64_MAX / 10)
        power *= 10;
    RITZ_REFUSE_IF(highest >= power ||
                       part->count - 1 > (INT64_MAX - highest) / power,
                   RITZ_ERR_ARGUMENT,
                   "numbers of grids up to %" PRId64 " leave no others for "
                   "those of %" PRId64 " bodies",
                   highest, part->count);
    for (int64_t c = 0; c < part->count; c++)
        add[c] = c * power;
    return RITZ_OK;
}

/* y = R x, with R in columns 0 to 8 of row c. */
static void turn_vector(const ritz_dense *places, int64_t c, const double *x,
                        double *y)
{
    for (int64_t i = 0; i < 3; i++) {
        y[i] = 0.0;
        for (int64_t j = 0; j < 3; j++)
            y[i] += ritz_dense_col(places, 3 * i + j)[c] * x[j];
    }
}

/* Append the points of body c and their motions as points `first`, ... */
static void put_points(const ritz_shapes *part, const ritz_dense *places,
                       int64_t c, int64_t add, int64_t first, ritz_shapes *all)
{
    for (int64_t k = 0; k < part->num_points; k++) {
        double *x = all->position + 3 * (first + k);

        all->id[first + k] = part->id[k] + add;
        turn_vector(places, c, part->position + 3 * k, x);
        for (int64_t i = 0; i < 3; i++)
            x[i] += ritz_dense_col(places, 9 + i)[c];
        for (int64_t j = 0; j < all->count; j++) {
            turn_vector(places, c, ritz_dense_col(&part->u, j) + 3 * k,
                        ritz_dense_col(&all->u, j) + 3 * (first + k));
            if (part->turn.val)
                turn_vector(places, c, ritz_dense_col(&part->turn, j) + 3 * k,
                            ritz_dense_col(&all->turn, j) + 3 * (first + k));
        }
    }
}

/* Append cells, whose grids are points `first`, ... */
static void put_cells(const ritz_elements *part, int64_t first,
                      ritz_elements *all)
{
    int64_t used = all->first[all->count];

    for (int64_t k = 0; k < part->count; k++) {
        all->kind[all->count] = part->kind[k];
        for (int64_t i = part->first[k]; i < part->first[k + 1]; i++)
            all->grid[used++] = part->grid[i] + first;
        all->first[++all->count] = used;
    }
}

/* Allocate all points and cells; names and count are set already. */
static ritz_status make_room(const ritz_shapes_array *part, ritz_shapes *all)
{
    int64_t cells = 0, corners = 0;
    bool turns = false;

    for (int64_t c = 0; c < part->count; c++) {
        const ritz_shapes *s = &part->at[c];

        all->num_points += s->num_points;
        all->num_placeless += s->num_placeless;
        all->meshed = all->meshed || s->meshed;
        cells += s->cells.count;
        corners += s->cells.first[s->cells.count];
        turns = turns || s->turn.val;
    }
    RITZ_CHECK_NEW(all->id, all->num_points);
    RITZ_CHECK_NEW(all->position, 3 * all->num_points);
    RITZ_CHECK_NEW(all->cells.kind, cells);
    RITZ_CHECK_NEW(all->cells.first, cells + 1);
    RITZ_CHECK_NEW(all->cells.grid, corners);
    RITZ_CHECK(ritz_dense_new(3 * all->num_points, all->count, &all->u));
    if (turns)
        RITZ_CHECK(ritz_dense_new(3 * all->num_points, all->count, &all->turn));
    return RITZ_OK;
}

static ritz_status join_parts(ritz_shapes_array *part, const ritz_dense *places,
                              ritz_shapes *all)
{
    RITZ_OWN_ARRAY int64_t *add = NULL;
    int64_t first = 0;

    RITZ_CHECK(make_room(part, all));
    RITZ_CHECK_NEW(add, part->count);
    RITZ_CHECK(renumber_grids(part, add));
    for (int64_t c = 0; c < part->count; c++) {
        put_points(&part->at[c], places, c, add[c], first, all);
        put_cells(&part->at[c].cells, first, &all->cells);
        first += part->at[c].num_points;
    }
    return RITZ_OK;
}

ritz_status ritz_shapes_of_system(const ritz_system *system,
                                  const ritz_configuration *at,
                                  const ritz_reduced *const *bodies,
                                  const char *list, ritz_shapes *out)
{
    const bool squares = ritz_measures_find(&at->errors, RITZ_NEGATIVE_SQUARES);
    RITZ_OWN(ritz_shapes) all = {0};
    RITZ_OWN(ritz_shapes_array) part = {.count = system->num_components};
    RITZ_OWN(ritz_dense) Delta = {0}, Phi = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    RITZ_OWN(mode_choice) which = {0};

    RITZ_REFUSE_IF(!at->places.val, RITZ_ERR_ARGUMENT,
                   "it does not say where its bodies are: assemble it anew");
    RITZ_CHECK(ritz_system_check_bodies(system, at, bodies));
    RITZ_CHECK(check_shapes(system, bodies));
    RITZ_CHECK(ritz_eigen_dense(&at->K, &at->M, &pairs));
    if (squares)
        RITZ_CHECK(ritz_pairs_by_size(&pairs));
    RITZ_CHECK(choose_modes(list, "mode", pairs.Phi.ncol, &which));
    RITZ_CHECK(pick_modes(&pairs, squares, &which, &Phi, &all));
    if (at->D.val)
        RITZ_CHECK(ritz_dense_project(&at->D, &Phi, &Delta));
    RITZ_CHECK(rate_modes(&pairs, &which, &Delta, system->damping, &all));
    all.structural = at->K4.val != NULL;
    memcpy(all.units, system->units, sizeof all.units);
    RITZ_CHECK_NEW(part.at, part.count);
    for (int64_t c = 0; c < part.count; c++) {
        const ritz_reduced *b = bodies[c];
        const body whole = body_of_reduced(b);
        RITZ_OWN(ritz_dense) q = {0}, U = {0};

        RITZ_CHECK(ritz_dense_mul(&at->P[c], &Phi, &q));
        RITZ_CHECK(ritz_dense_mul(&b->T, &q, &U));
        RITZ_CHECK_IN(system->component[c].name,
                      place_shapes(&whole, &U, &part.at[c]));
    }
    RITZ_CHECK(join_parts(&part, &at->places, &all));
    RITZ_MOVE(*out, all);
    return RITZ_OK;
}

ritz_status ritz_shapes_of_component(const ritz_component *component,
                                     const char *list, ritz_shapes *out)
{
    enum { USUAL = 10 };
    const body whole = body_of_component(component);
    RITZ_OWN(ritz_shapes) shapes = {0};
    RITZ_OWN(ritz_sparse) K = {0}, D = {0};
    RITZ_OWN(ritz_dense) Delta = {0}, Phi = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    RITZ_OWN(mode_choice) which = {0};
    ritz_span span = {.modes = list ? 0 : USUAL};
    int64_t most = 0;

    if (list)
        RITZ_CHECK(walk_list(list, "mode", INT64_MAX, NULL, &span.modes));
    if (span.modes > component->num_dofs)
        span.modes = component->num_dofs;
    RITZ_CHECK(ritz_structure_sparse(component, NULL, &K, &D));
    RITZ_CHECK(ritz_eigen_sparse(&K, &component->M, &span, &pairs));
    most = pairs.Phi.ncol;
    if (!list && most > pairs.num_rigid + span.modes)
        most = pairs.num_rigid + span.modes;
    RITZ_CHECK(choose_modes(list, "mode", most, &which));
    RITZ_CHECK(pick_modes(&pairs, false, &which, &Phi, &shapes));
    if (D.colptr)
        RITZ_CHECK(ritz_sparse_project(&D, &Phi, &Delta));
    RITZ_CHECK(rate_modes(&pairs, &which, &Delta, component->damping, &shapes));
    shapes.structural = component->K4.colptr != NULL;
    memcpy(shapes.units, component->units, sizeof shapes.units);
    RITZ_CHECK(place_shapes(&whole, &Phi, &shapes));
    RITZ_MOVE(*out, shapes);
    return RITZ_OK;
}

/* "column 3 constraint", "column 9 normal, 12.3 Hz" */
static ritz_status pick_columns(const ritz_basis *basis,
                                const mode_choice *which, ritz_dense *T,
                                ritz_shapes *out)
{
    RITZ_CHECK(pick_shapes(&basis->T, which, T, out));
    for (int64_t j = 0; j < which->count; j++) {
        int64_t k = which->at[j];
        const char *kind = ritz_column_name(basis->columns.kind[k]);
        double hertz = basis->columns.hertz[k];

        if (isfinite(hertz))
            snprintf(out->name[j], RITZ_NAME_SIZE,
                     "column %" PRId64 " %s, %.4g Hz", k + 1, kind, hertz);
        else
            snprintf(out->name[j], RITZ_NAME_SIZE, "column %" PRId64 " %s",
                     k + 1, kind);
    }
    return RITZ_OK;
}

ritz_status ritz_shapes_of_basis(const ritz_basis *basis,
                                 const ritz_component *component,
                                 const char *list, ritz_shapes *out)
{
    const body whole = body_of_component(component);
    RITZ_OWN(ritz_shapes) shapes = {0};
    RITZ_OWN(ritz_dense) T = {0};
    RITZ_OWN(mode_choice) which = {0};

    RITZ_REFUSE_IF(basis->states, RITZ_ERR_ARGUMENT,
                   "a basis of states has no shapes");
    RITZ_REFUSE_IF(basis->T.nrow != component->num_dofs, RITZ_ERR_ARGUMENT,
                   "the basis is for %" PRId64
                   " dofs, the component has %" PRId64,
                   basis->T.nrow, component->num_dofs);
    RITZ_CHECK(choose_modes(list, "column", basis->T.ncol, &which));
    RITZ_CHECK(pick_columns(basis, &which, &T, &shapes));
    RITZ_CHECK(place_shapes(&whole, &T, &shapes));
    RITZ_MOVE(*out, shapes);
    return RITZ_OK;
}

ritz_status ritz_shapes_of_motion(const ritz_reduced *reduced, ritz_shapes *out)
{
    const body whole = body_of_reduced(reduced);
    RITZ_OWN(ritz_shapes) shapes = {0};
    RITZ_OWN(ritz_dense) T = {0};
    RITZ_OWN(mode_choice) which = {0};

    RITZ_REFUSE_IF(!reduced->T.val || !reduced->dof, RITZ_ERR_ARGUMENT,
                   "it was reduced --without-basis, which holds the shapes");
    RITZ_CHECK(choose_modes(NULL, "column", reduced->T.ncol, &which));
    RITZ_CHECK(pick_shapes(&reduced->T, &which, &T, &shapes));
    memcpy(shapes.units, reduced->units, sizeof shapes.units);
    RITZ_CHECK(place_shapes(&whole, &T, &shapes));
    RITZ_MOVE(*out, shapes);
    return RITZ_OK;
}

void ritz_shapes_free(ritz_shapes *shapes)
{
    RITZ_FREE(shapes->id, shapes->position, shapes->name, shapes->mode,
              shapes->field, shapes->of_cell);
    ritz_elements_free(&shapes->cells);
    ritz_dense_free(&shapes->u);
    ritz_dense_free(&shapes->turn);
    *shapes = (ritz_shapes){0};
}
