#include "fixed.h"

#include "base/alloc.h"
#include "base/search.h"
#include "base/tolerances.h"
#include "bases/columns.h"
#include "blocks.h"
#include "modes.h"
#include "ranks.h"
#include "rows.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A task, broadcast by rank 0; the path and the attached dofs follow it. */
typedef struct task {
    int64_t path_size; /* with its terminating 0; 0: there are no more tasks */
    int64_t num_dofs, num_attached;
    int64_t num_loads; /* with static vectors */
    double tolerance;  /* for dependent static vectors */
    bool held;
    ritz_span span;
} task;

/* The basis being made, in rank 0 only. */
typedef struct target {
    const ritz_request *request;
    ritz_dofs interior;
    int loads;    /* sum of RITZ_LOADS_... */
    ritz_dense F; /* loads, one a column; rows of all dofs */
    ritz_basis basis;
} target;

static void target_free(target *t)
{
    ritz_dofs_free(&t->interior);
    ritz_dense_free(&t->F);
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
    /* Interior rows of loads, and their static responses; NULL: no loads */
    Mat F, X;
    double *least; /* energy below which a response is rounding, for each */
    bool *keep;    /* whether response j is a column of the basis */
    int64_t kept;
    target *target; /* NULL but in rank 0 */
} rank_work;

static void rank_work_free(rank_work *w)
{
    ranks_expect(MatDestroy(&w->Psi));
    ranks_expect(MatDestroy(&w->F));
    ranks_expect(MatDestroy(&w->X));
    RITZ_FREE(w->least, w->keep);
    modes_free(&w->modes);
    rank_pencil_free(&w->pencil);
    rows_free(&w->rows);
}

/* --- results in rank 0 ---------------------------------------------------- */

typedef struct columns_at {
    const target *target;
    int64_t first;
    const bool *keep; /* flags of the columns that are put; NULL: all are */
    int64_t left_out; /* number of columns that were not put so far */
} columns_at;

static void put_column(void *state, int64_t column, const double *x)
{
    columns_at *c = state;
    const ritz_dofs *i = &c->target->interior;
    const ritz_dense *T = &c->target->basis.T;

    if (c->keep && !c->keep[column]) {
        c->left_out++;
        return;
    }
    for (int64_t k = 0; k < i->count; k++)
        T->val[i->at[k] + (c->first + column - c->left_out) * T->nrow] = x[k];
}

/* Put the vectors of the modes into the columns of the basis from `first`
   on. */
static ritz_status place_modes(const rank_work *w, int64_t first)
{
    columns_at at = {w->target, first, NULL, 0};
    const ritz_pairs *P = &w->modes.pairs;

    if (!w->modes.X) {
        for (int64_t j = 0; ranks_own() == 0 && j < P->Phi.ncol; j++)
            put_column(&at, j, ritz_dense_col(&P->Phi, j));
        return RITZ_OK;
    }
    return block_gather(w->modes.X, P->Phi.ncol, put_column, &at);
}

/* Allocate the basis of constraint modes, modes and static vectors, label its
   columns, and set the rows of the attached dofs. */
static ritz_status label_columns(const rank_work *w, const ritz_dofs *b)
{
    const ritz_pairs *P = &w->modes.pairs;
    const target *t = w->target;
    ritz_basis *basis = &w->target->basis;
    const int64_t statics = b->count + P->Phi.ncol; /* first column */

    RITZ_CHECK(ritz_basis_new(w->task->num_dofs, statics + w->kept, basis));
    for (int64_t j = statics; j < statics + w->kept; j++)
        basis->columns.kind[j] = RITZ_COLUMN_STATIC;
    if (w->task->held) {
        ritz_remark_left_out(t->request, t->loads, 0, w->task->num_loads,
                             w->keep, RITZ_COLUMN_STATIC, basis);
        ritz_remark_dampers(t->request, t->loads, basis);
    }
    ritz_columns_label_dofs(b->count, b->at, 0, &basis->columns);
    ritz_columns_label(P, RITZ_COLUMN_NORMAL, b->count, &basis->columns);
    for (int64_t j = 0; j < b->count; j++)
        ritz_dense_col(&basis->T, j)[b->at[j]] = 1.0;
    memcpy(basis->origin.engine, P->engine, sizeof basis->origin.engine);
    return RITZ_OK;
}

static ritz_status collect_columns(const rank_work *w, const ritz_dofs *b)
{
    columns_at at = {w->target, 0, NULL, 0};
    ritz_status status = RITZ_OK;

    ritz_monitor_step("columns of the basis", 0, 0);
    if (w->target)
        status = label_columns(w, b);
    RANKS_CHECK(status);
    if (w->Psi)
        RITZ_CHECK(
            block_gather(w->Psi, w->task->num_attached, put_column, &at));
    RITZ_CHECK(place_modes(w, w->task->num_attached));
    if (w->X) {
        at = (columns_at){w->target,
                          w->task->num_attached + w->modes.pairs.Phi.ncol,
                          w->keep, 0};
        RITZ_CHECK(block_gather(w->X, w->task->num_loads, put_column, &at));
    }
    if (w->target) {
        ritz_dense Phi =
            ritz_dense_part(&w->target->basis.T, w->task->num_attached,
                            w->modes.pairs.Phi.ncol);

        ritz_dense_orient(&Phi);
    }
    return RITZ_OK;
}

/* --- static vectors ------------------------------------------------------- */

/* The static vectors of src/bases/fixed_interface.c: X = K_ii^-1 F_i without
   its part in the modes. */

static void give_load(const void *state, int64_t column, double *x)
{
    const target *t = state;

    for (int64_t k = 0; k < t->interior.count; k++)
        x[k] = ritz_dense_col(&t->F, column)[t->interior.at[k]];
}

static void give_mode(const void *state, int64_t column, double *x)
{
    const ritz_dense *Phi = state;

    memcpy(x, ritz_dense_col(Phi, column), (size_t)Phi->nrow * sizeof *x);
}

/* X := K_ii^-1 F_i, with the factor of K_ii. A column whose energy without the
   modes will be below `least` consists of rounding. */
static ritz_status respond_interior(rank_work *w)
{
    const double part = fmax(w->task->tolerance, RITZ_FORCE_RELIEVED);
    RITZ_OWN(ritz_dense) R = {0};

    if (w->task->num_loads == 0)
        return RITZ_OK;
    RITZ_CHECK(block_scatter(w->rows.K, w->task->num_loads, give_load,
                             w->target, &w->F));
    ranks_expect(MatDuplicate(w->F, MAT_DO_NOT_COPY_VALUES, &w->X));
    RITZ_CHECK(rank_pencil_solve(&w->pencil, w->F, w->X));
    RITZ_CHECK(block_product(w->F, w->X, &R));
    for (int64_t j = 0; j < R.ncol; j++)
        w->least[j] = part * ritz_dense_col(&R, j)[j];
    return RITZ_OK;
}

/* Remove the part of X in the modes. If rank 0 found the modes alone, each rank
   first gets its rows of them. */
static ritz_status remove_modes(rank_work *w)
{
    const ritz_pairs *P = &w->modes.pairs;
    Mat Phi = w->modes.X;
    ritz_status status = RITZ_OK;

    if (P->Phi.ncol == 0)
        return RITZ_OK;
    if (!Phi)
        RITZ_CHECK(
            block_scatter(w->rows.K, P->Phi.ncol, give_mode, &P->Phi, &Phi));
    status = block_remove(&w->pencil, Phi, P->Phi.ncol, w->X);
    if (!w->modes.X)
        ranks_expect(MatDestroy(&Phi));
    return status;
}

/* Remove the modes from X, and flag in `keep` the columns that do not depend on
   others. */
static ritz_status choose_statics(rank_work *w)
{
    RITZ_OWN(ritz_dense) R = {0};
    ritz_status status = RITZ_OK;

    if (!w->X)
        return RITZ_OK;
    RITZ_CHECK(remove_modes(w));
    RITZ_CHECK(block_product(w->F, w->X, &R));
    if (ranks_own() == 0)
        status = ritz_statics_choose_from(&R, w->least, w->task->tolerance,
                                          w->keep, &w->kept);
    return ranks_agree(status);
}

/* --- mechanisms ----------------------------------------------------------- */

static void keep_column(void *state, int64_t column, const double *x)
{
    ritz_dense *Phi = state;

    memcpy(ritz_dense_col(Phi, column), x, (size_t)Phi->nrow * sizeof *x);
}

/* Fail with a sentence that names the dofs that move freely. */
static ritz_status refuse_free(const rank_work *w, modes *found, int64_t weak,
                               int64_t negative)
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
        status = ritz_refuse_mechanism(w->target->request->component,
                                       &w->target->interior, P, weak, negative);
    return ranks_agree(status);
}

/* The number of negative eigenvalues, beyond what ten digits of K_ii leave of
   zeros; 0 if they cannot be counted. */
static ritz_status count_negative(rank_work *w, int64_t *out)
{
    const ritz_status status = rank_pencil_count(
        &w->pencil, -RITZ_RIGID_DIGITS * w->pencil.typical, out);

    if (status != RITZ_ERR_SINGULAR)
        return status;
    *out = 0;
    return RITZ_OK;
}

/* K_ii is not positive definite: find its lowest mode, to name the dofs that
   move freely or have negative energy, or those without stiffness and mass. */
static ritz_status explain_singular(rank_work *w)
{
    const ritz_span lowest = {.modes = 1};
    const int64_t weak = rank_factor_null_row(w->pencil.F);
    RITZ_OWN(modes) found = {0};
    ritz_status status = modes_shift(&w->pencil, false, 0.0);
    int64_t negative = 0;

    if (status == RITZ_OK)
        status = modes_find(&w->pencil, &lowest, 0.0, 0, &found);
    if (status == RITZ_ERR_MEMORY)
        return status;
    RITZ_CHECK(count_negative(w, &negative));
    if (status == RITZ_OK)
        return refuse_free(w, &found, weak, negative);
    if (w->target)
        (void)ritz_refuse_mechanism(w->target->request->component,
                                    &w->target->interior, NULL, weak, negative);
    return ranks_agree(RITZ_ERR_SINGULAR);
}

/* --- the work of all ranks ------------------------------------------------ */

static ritz_status find_constraint_modes(rank_work *w)
{
    if (!w->rows.load)
        return RITZ_OK;
    ritz_monitor_step("constraint modes", 0, 0);
    ranks_expect(MatDuplicate(w->rows.load, MAT_DO_NOT_COPY_VALUES, &w->Psi));
    RITZ_CHECK(rank_pencil_solve(&w->pencil, w->rows.load, w->Psi));
    ranks_expect(MatDestroy(&w->rows.load));
    return RITZ_OK;
}

static ritz_status find_modes(rank_work *w, const char *what, double limit,
                              int64_t goal)
{
    const ritz_pairs *P = &w->modes.pairs;

    RITZ_CHECK_IN(
        what, modes_find(&w->pencil, &w->task->span, limit, goal, &w->modes));
    if (w->task->held && P->num_rigid > 0)
        return ritz_context(refuse_free(w, &w->modes, -1, 0), what);
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

    RITZ_CHECK_IN(what, rank_pencil_new(w->rows.K, w->rows.M, &w->pencil));
    RITZ_CHECK_IN(what,
                  modes_foresee(&w->pencil, &w->task->span, &limit, &goal));
    status = modes_shift(&w->pencil, w->task->held, limit);
    if (status == RITZ_ERR_SINGULAR && w->task->held)
        status = explain_singular(w);
    RITZ_CHECK_IN(w->task->held ? "interior stiffness" : what, status);
    RITZ_CHECK_IN("constraint modes", find_constraint_modes(w));
    RITZ_CHECK_IN("static vectors", respond_interior(w));
    if (w->task->span.modes != 0 || !w->task->held)
        RITZ_CHECK(find_modes(w, what, limit, goal));
    return ritz_context(choose_statics(w), "static vectors");
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

    RANKS_CHECK(status);
    RANKS_CHECK_NEW(position, b->count);
    RANKS_CHECK_NEW(w.least, t->num_loads);
    RANKS_CHECK_NEW(w.keep, t->num_loads);
    qsort(sorted.at, (size_t)sorted.count, sizeof *sorted.at,
          ritz_ascending_index);
    for (int64_t j = 0; j < b->count; j++)
        position[ritz_search(b->count, sorted.at, b->at[j])] = j;
    w.frame =
        (rows_frame){path, t->num_dofs, b->count, sorted.at, position, NULL};
    ritz_monitor_step("matrices", 0, 0);
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

/* In rank 0: the dofs and loads of a basis. */
static ritz_status prepare_target(const ritz_request *request,
                                  const ritz_dofs *b, target *to)
{
    RITZ_OWN_ARRAY int64_t *dof = NULL;

    RITZ_CHECK(
        ritz_dofs_complement(b, request->component->num_dofs, &to->interior));
    if (ritz_loads_count(request, to->loads) > 0)
        RITZ_CHECK(ritz_loads_collect(request, to->loads, &to->F, &dof));
    return RITZ_OK;
}

ritz_status fixed_make(const char *path, const ritz_request *request, bool held,
                       int loads, ritz_basis *out)
{
    const ritz_dofs nothing = {0};
    const ritz_dofs *b = held ? &request->attached : &nothing;
    RITZ_OWN(target) to = {.request = request, .loads = loads};
    RITZ_OWN_ARRAY char *name = NULL;
    ritz_status status = RITZ_OK;
    task t = {.path_size = (int64_t)strlen(path) + 1,
              .num_dofs = request->component->num_dofs,
              .num_attached = b->count,
              .tolerance = request->tolerance,
              .held = held,
              .span = ritz_request_span(request)};

    RITZ_CHECK(prepare_target(request, b, &to));
    t.num_loads = to.F.ncol;
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
