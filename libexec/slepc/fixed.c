#include "fixed.h"

#include "base/alloc.h"
#include "base/search.h"
#include "bases/columns.h"
#include "blocks.h"
#include "modes.h"
#include "ranks.h"
#include "rows.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A task, broadcast by rank 0; the path and the attached dofs follow it. */
typedef struct task {
    int64_t path_size; /* with its terminating 0; 0: there are no more tasks */
    int64_t num_dofs, num_attached;
    bool held;
    ritz_span span;
} task;

/* The basis being made, in rank 0 only. */
typedef struct target {
    const ritz_component *component;
    ritz_dofs interior;
    ritz_basis basis;
} target;

static void target_free(target *t)
{
    ritz_dofs_free(&t->interior);
    ritz_basis_free(&t->basis);
}

/* What each rank has during a task. */
typedef struct rank_work {
    const task *task;
    rows_frame frame;
    rows rows;
    rank_pencil pencil;
    Mat Psi; /* constraint modes, interior rows; NULL: nothing is attached */
    modes modes;
    target *target; /* NULL but in rank 0 */
} rank_work;

static void rank_work_free(rank_work *w)
{
    ranks_expect(MatDestroy(&w->Psi));
    modes_free(&w->modes);
    rank_pencil_free(&w->pencil);
    rows_free(&w->rows);
}

/* --- results in rank 0 ---------------------------------------------------- */

typedef struct columns_at {
    const target *target;
    int64_t first;
} columns_at;

static void put_column(void *state, int64_t column, const double *x)
{
    const columns_at *c = state;
    const ritz_dofs *i = &c->target->interior;
    const ritz_dense *T = &c->target->basis.T;

    for (int64_t k = 0; k < i->count; k++)
        T->val[i->at[k] + (c->first + column) * T->nrow] = x[k];
}

/* Put the vectors of the modes into the columns of the basis from `first`
   on. */
static ritz_status place_modes(const rank_work *w, int64_t first)
{
    columns_at at = {w->target, first};
    const ritz_pairs *P = &w->modes.pairs;

    if (!w->modes.X) {
        for (int64_t j = 0; ranks_own() == 0 && j < P->Phi.ncol; j++)
            put_column(&at, j, ritz_dense_col(&P->Phi, j));
        return RITZ_OK;
    }
    return block_gather(w->modes.X, P->Phi.ncol, put_column, &at);
}

/* Allocate the basis of constraint modes and modes, label its columns, and set
   the rows of the attached dofs. */
static ritz_status label_columns(const rank_work *w, const ritz_dofs *b)
{
    const ritz_pairs *P = &w->modes.pairs;
    ritz_basis *basis = &w->target->basis;

    RITZ_CHECK(
        ritz_basis_new(w->task->num_dofs, b->count + P->Phi.ncol, basis));
    ritz_columns_label_dofs(b->count, b->at, 0, &basis->columns);
    ritz_columns_label(P, RITZ_COLUMN_NORMAL, b->count, &basis->columns);
    for (int64_t j = 0; j < b->count; j++)
        ritz_dense_col(&basis->T, j)[b->at[j]] = 1.0;
    memcpy(basis->origin.engine, P->engine, sizeof basis->origin.engine);
    return RITZ_OK;
}

static ritz_status collect_columns(const rank_work *w, const ritz_dofs *b)
{
    columns_at at = {w->target, 0};
    ritz_status status = RITZ_OK;

    if (w->target)
        status = label_columns(w, b);
    RANKS_CHECK(status);
    if (w->Psi)
        RITZ_CHECK(
            block_gather(w->Psi, w->task->num_attached, put_column, &at));
    RITZ_CHECK(place_modes(w, w->task->num_attached));
    if (w->target) {
        ritz_dense Phi =
            ritz_dense_part(&w->target->basis.T, w->task->num_attached,
                            w->modes.pairs.Phi.ncol);

        ritz_dense_orient(&Phi);
    }
    return RITZ_OK;
}

/* --- mechanisms ----------------------------------------------------------- */

static void keep_column(void *state, int64_t column, const double *x)
{
    ritz_dense *Phi = state;

    memcpy(ritz_dense_col(Phi, column), x, (size_t)Phi->nrow * sizeof *x);
}

/* Fail with a sentence that names the dofs that move freely. */
static ritz_status refuse_free(const rank_work *w, modes *found)
{
    ritz_pairs *P = &found->pairs;
    ritz_status status = RITZ_OK;
    RITZ_OWN(ritz_dense) Phi = {0};

    if (found->X) {
        if (w->target)
            status = ritz_dense_new(w->rows.interior, P->Phi.ncol, &Phi);
        RANKS_CHECK(status);
        RITZ_CHECK(block_gather(found->X, P->Phi.ncol, keep_column, &Phi));
        RITZ_MOVE(P->Phi, Phi);
    }
    status = RITZ_ERR_SINGULAR;
    if (w->target)
        status = ritz_refuse_mechanism(w->target->component,
                                       &w->target->interior, P, -1);
    return ranks_agree(status);
}

/* K_ii is not positive definite: find the motions that cost no energy, to name
   their dofs in the message. */
static ritz_status explain_singular(rank_work *w)
{
    const ritz_span rigid_only = {.modes = 0};
    RITZ_OWN(modes) found = {0};
    ritz_status status = modes_shift(&w->pencil, false, 0.0);

    if (status == RITZ_OK)
        status = modes_find(&w->pencil, &rigid_only, 0.0, 0, &found);
    if (status == RITZ_OK)
        return refuse_free(w, &found);
    if (status == RITZ_ERR_MEMORY)
        return status;
    if (w->target)
        (void)ritz_refuse_mechanism(w->target->component, &w->target->interior,
                                    NULL, -1);
    return ranks_agree(RITZ_ERR_SINGULAR);
}

/* --- the work of all ranks ------------------------------------------------ */

static ritz_status find_constraint_modes(rank_work *w)
{
    if (!w->rows.load)
        return RITZ_OK;
    ranks_expect(MatDuplicate(w->rows.load, MAT_DO_NOT_COPY_VALUES, &w->Psi));
    rank_pencil_solve(&w->pencil, w->rows.load, w->Psi);
    ranks_expect(MatDestroy(&w->rows.load));
    return RITZ_OK;
}

static ritz_status find_modes(rank_work *w, double limit, int64_t goal)
{
    const ritz_pairs *P = &w->modes.pairs;

    RITZ_CHECK(modes_find(&w->pencil, &w->task->span, limit, goal, &w->modes));
    if (w->task->held && P->num_rigid > 0)
        return refuse_free(w, &w->modes);
    RITZ_REFUSE_IF(P->Phi.ncol > 0 && P->num_rigid == 0 && P->lambda[0] <= 0.0,
                   RITZ_ERR_SINGULAR,
                   "K is not positive semidefinite: an eigenvalue is %.3g",
                   P->lambda[0]);
    return RITZ_OK;
}

static ritz_status solve_interior(rank_work *w)
{
    const char *what =
        w->task->held ? "fixed-interface modes" : "free-interface modes";
    ritz_status status = RITZ_OK;
    double limit = 0.0;
    int64_t goal = 0;

    RITZ_CHECK(rank_pencil_new(w->rows.K, w->rows.M, &w->pencil));
    RITZ_CHECK_IN(what,
                  modes_foresee(&w->pencil, &w->task->span, &limit, &goal));
    status = modes_shift(&w->pencil, w->task->held, limit);
    if (status == RITZ_ERR_SINGULAR && w->task->held)
        status = explain_singular(w);
    RITZ_CHECK_IN(w->task->held ? "interior stiffness" : what, status);
    RITZ_CHECK(find_constraint_modes(w));
    if (w->task->span.modes != 0 || !w->task->held)
        RITZ_CHECK_IN(what, find_modes(w, limit, goal));
    return RITZ_OK;
}

/* Carry out a task. Collective: every rank gives the same task, path and
   dofs. */
static ritz_status work_together(const task *t, const char *path,
                                 const ritz_dofs *b, target *to)
{
    RITZ_OWN(rank_work) w = {.task = t, .target = to};
    RITZ_OWN(ritz_dofs) sorted = {0};
    RITZ_OWN_ARRAY int64_t *position = NULL;
    ritz_status status = ritz_dofs_copy(b, &sorted);

    position = ritz_zalloc(b->count, sizeof *position);
    RANKS_CHECK(status == RITZ_OK && !position ? RITZ_ERR_MEMORY : status);
    qsort(sorted.at, (size_t)sorted.count, sizeof *sorted.at,
          ritz_ascending_index);
    for (int64_t j = 0; j < b->count; j++)
        position[ritz_search(b->count, sorted.at, b->at[j])] = j;
    w.frame = (rows_frame){path, t->num_dofs, b->count, sorted.at, position};
    RITZ_CHECK(rows_read(&w.frame, &w.rows));
    if (w.rows.interior > 0)
        RITZ_CHECK(solve_interior(&w));
    return collect_columns(&w, b);
}

/* --- rank 0 and the others ------------------------------------------------ */

/* In rank 0: whether the other ranks wait in fixed_help() for a task. */
static bool others_wait = true;

bool fixed_is_idle(void)
{
    return others_wait;
}

void fixed_dismiss(void)
{
    task none = {0};

    ranks_share(&none, sizeof none);
}

ritz_status fixed_make(const char *path, const ritz_request *request, bool held,
                       ritz_basis *out)
{
    const ritz_dofs nothing = {0};
    const ritz_dofs *b = held ? &request->attached : &nothing;
    RITZ_OWN(target) to = {.component = request->component};
    RITZ_OWN_ARRAY char *name = NULL;
    ritz_status status = RITZ_OK;
    task t = {.path_size = (int64_t)strlen(path) + 1,
              .num_dofs = request->component->num_dofs,
              .num_attached = b->count,
              .held = held,
              .span = ritz_request_span(request)};

    RITZ_CHECK(ritz_dofs_complement(b, t.num_dofs, &to.interior));
    RITZ_CHECK_COPY(name, path, t.path_size);
    others_wait = false;
    ranks_share(&t, sizeof t);
    ranks_share(name, t.path_size);
    ranks_share(b->at, b->count * (int64_t)sizeof *b->at);
    status = work_together(&t, path, b, &to);
    others_wait = true;
    RITZ_CHECK(status);
    RITZ_MOVE(*out, to.basis);
    return RITZ_OK;
}

void fixed_help(void)
{
    for (;;) {
        RITZ_OWN_ARRAY char *path = NULL;
        RITZ_OWN(ritz_dofs) b = {0};
        task t = {0};

        ranks_share(&t, sizeof t);
        if (t.path_size == 0)
            return;
        path = ranks_take(t.path_size, sizeof *path);
        b.count = t.num_attached;
        b.at = ranks_take(b.count, sizeof *b.at);
        ranks_share(path, t.path_size);
        ranks_share(b.at, b.count * (int64_t)sizeof *b.at);
        (void)work_together(&t, path, &b, NULL);
    }
}
