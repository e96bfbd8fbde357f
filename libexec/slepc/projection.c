/*
 * T'KT is linear in K. Each rank projects the part of K that it has read, its
 * own columns, and the results of all ranks are added:
 *
 *     K = sum_p K_p,   T'KT = sum_p T'K_p T
 *
 * K_p has entries in few rows, those of the rank's dofs and their neighbours.
 * The rank needs no other rows of T, which it gets from rank 0. As K is
 * symmetric, the rank's columns are used as rows: sums of K T with twice the
 * digits are then complete in one rank. All dofs of a grid are in one rank, as
 * the inertia invariants of beams need whole blocks of M.
 */
#include "projection.h"

#include "base/alloc.h"
#include "container/slab.h"
#include "model/congruences.h"
#include "ranks.h"
#include "rows.h"

#include <inttypes.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A task, broadcast by rank 0; the path and the kinds of columns follow it. */
typedef struct projection_task {
    int64_t path_size; /* with its terminating 0; 0: there are no more tasks */
    int64_t num_dofs, num_columns;
} projection_task;

/* Matrices that are projected. */
enum { STIFFNESS, MASS, DAMPING, HYSTERESIS, MATRICES };

static const struct {
    const char *name;
    size_t at;      /* in a component */
    bool symmetric; /* must be; if it is not, it is refused */
    bool by_rows;   /* the columns that are read serve as rows */
} matrices[MATRICES] = {
    [STIFFNESS] = {"K", offsetof(ritz_component, K), true, true},
    [MASS] = {"M", offsetof(ritz_component, M), true, false},
    [DAMPING] = {"D", offsetof(ritz_component, D), false, false},
    [HYSTERESIS] = {"K4", offsetof(ritz_component, K4), true, false},
};

/* What each rank has during a task. */
typedef struct share {
    const projection_task *task;
    const ritz_component *component; /* all but its matrices */
    rows_frame frame;
    int64_t from, to; /* the rank's own dofs */
    ritz_slab slab[MATRICES];
    bool symmetric[MATRICES];
    int64_t num_loads;
    char (*load)[RITZ_NAME_SIZE]; /* of which there is geometric stiffness */
    ritz_slab *KG;                /* num_loads */
    ritz_dofs rows;      /* dofs of the part, ascending; at least one */
    int64_t *place;      /* of each dof among `rows` */
    ritz_component part; /* matrices with these rows; grids and elements are
                            borrowed */
    ritz_dense T;        /* their rows of T */
} share;

static void share_free(share *s)
{
    for (int k = 0; k < MATRICES; k++)
        ritz_slab_free(&s->slab[k]);
    RITZ_FREE_EACH(ritz_slab, s->num_loads, s->KG);
    free(s->load);
    ritz_dofs_free(&s->rows);
    ritz_dense_free(&s->T);
    RITZ_FREE(s->place);
    s->part.grids = (ritz_grids){0};
    s->part.elements = (ritz_elements){0};
    ritz_component_free(&s->part);
}

/* --- symmetry ------------------------------------------------------------- */

/* A hash of the place and the value of an entry. */
static uint64_t hash_entry(int64_t row, int64_t column, double value)
{
    uint64_t bits = 0;
    uint64_t state = (uint64_t)row * 0x9e3779b97f4a7c15U;

    memcpy(&bits, &value, sizeof bits);
    state = (state ^ (state >> 32)) + (uint64_t)column;
    state = (state * 0xbf58476d1ce4e5b9U) ^ bits;
    state = (state ^ (state >> 30)) * 0x94d049bb133111ebU;
    return (state ^ (state >> 27)) * 0x9e3779b97f4a7c15U;
}

/*
 * Whether A = A' to the last bit. Entries below the diagonal add a hash of
 * (row, column, value), those above subtract that of (column, row, value): the
 * sum over all ranks is 0 if both triangles agree, and by chance in 1 of 2^64
 * other cases.
 */
static bool is_symmetric(const ritz_slab *slab)
{
    const ritz_sparse *A = &slab->A;
    uint64_t sum = 0;

    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            const int64_t column = slab->from + j;
            const int64_t row = A->rowind[p];

            if (A->val[p] == 0.0)
                continue;
            if (row > column)
                sum += hash_entry(row, column, A->val[p]);
            if (row < column)
                sum -= hash_entry(column, row, A->val[p]);
        }
    MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_UINT64_T, MPI_SUM,
                  PETSC_COMM_WORLD);
    return sum == 0;
}

/* --- reading -------------------------------------------------------------- */

/* @param[in] must  refuse a matrix that is not symmetric */
static ritz_status read_slab(share *s, const char *name, bool must,
                             ritz_slab *slab, bool *symmetric)
{
    RITZ_CHECK(rows_read_matrix(&s->frame, name, slab));
    *symmetric = is_symmetric(slab);
    RITZ_REFUSE_IF(must && !*symmetric, RITZ_ERR_FORMAT,
                   "%s is not symmetric to the last bit: ritz-import would "
                   "average both triangles",
                   name);
    return RITZ_OK;
}

static ritz_status read_matrix(share *s, int k)
{
    const char *name = matrices[k].name;
    ritz_status status = RITZ_OK;
    bool has = false;

    if (ranks_own() == 0)
        status = ritz_slab_has(s->frame.path, name, &has);
    RANKS_CHECK(status);
    ranks_share(&has, sizeof has);
    if (!has && (k == DAMPING || k == HYSTERESIS))
        return RITZ_OK;
    return read_slab(s, name, matrices[k].symmetric, &s->slab[k],
                     &s->symmetric[k]);
}

/* Tell all ranks which loads have geometric stiffness. */
static ritz_status share_loads(share *s)
{
    ritz_status status = RITZ_OK;

    if (ranks_own() == 0)
        status = ritz_slab_loads(s->frame.path, &s->num_loads, &s->load);
    RANKS_CHECK(status);
    ranks_share(&s->num_loads, sizeof s->num_loads);
    if (ranks_own() > 0)
        s->load = ranks_take(s->num_loads, sizeof *s->load);
    ranks_share(s->load, s->num_loads * (int64_t)sizeof *s->load);
    RANKS_CHECK_NEW(s->KG, s->num_loads);
    return RITZ_OK;
}

static ritz_status read_loads(share *s)
{
    enum { SIZE = RITZ_NAME_SIZE + 8 };

    RITZ_CHECK(share_loads(s));
    for (int64_t k = 0; k < s->num_loads; k++) {
        char name[SIZE];
        bool symmetric = false;

        snprintf(name, sizeof name, "KG/%s", s->load[k]);
        RITZ_CHECK(read_slab(s, name, true, &s->KG[k], &symmetric));
    }
    return RITZ_OK;
}

/* --- the part ------------------------------------------------------------- */

static void mark_entries(const ritz_sparse *A, bool *mark)
{
    for (int64_t p = 0; A->colptr && p < A->colptr[A->ncol]; p++)
        mark[A->rowind[p]] = true;
}

/* Mark the rank's own dofs, and those in which its columns have entries. */
static void mark_touched(const share *s, bool *mark)
{
    mark[0] = true;
    for (int64_t j = s->from; j < s->to; j++)
        mark[j] = true;
    for (int k = 0; k < MATRICES; k++)
        mark_entries(&s->slab[k].A, mark);
    for (int64_t k = 0; k < s->num_loads; k++)
        mark_entries(&s->KG[k].A, mark);
}

/* If a dof of a grid is marked, mark all its dofs: the mass between two grids
   is computed from the directions that both have. */
static ritz_status mark_grids(const share *s, bool *mark)
{
    const ritz_grids *grids = &s->component->grids;
    const ritz_dof *dof = s->component->dof;
    RITZ_OWN_ARRAY bool *whole = NULL;

    RITZ_CHECK_NEW(whole, grids->count);
    for (int pass = 0; pass < 2; pass++)
        for (int64_t i = 0; i < s->task->num_dofs; i++) {
            const int64_t k = dof[i].component == 0
                                  ? -1
                                  : ritz_grids_find(grids, dof[i].grid);

            if (k >= 0 && pass == 0)
                whole[k] = whole[k] || mark[i];
            else if (k >= 0)
                mark[i] = whole[k];
        }
    return RITZ_OK;
}

/* Choose the dofs of the part: those that are marked. */
static ritz_status choose_rows(share *s)
{
    const int64_t n = s->task->num_dofs;
    RITZ_OWN_ARRAY bool *mark = NULL;

    RITZ_CHECK_NEW(mark, n);
    RITZ_CHECK_NEW(s->place, n);
    mark_touched(s, mark);
    RITZ_CHECK(mark_grids(s, mark));
    for (int64_t i = 0; i < n; i++) {
        s->place[i] = s->rows.count;
        s->rows.count += mark[i];
    }
    RITZ_REFUSE_IF(s->rows.count > INT_MAX, RITZ_ERR_ARGUMENT,
                   "a rank would project %" PRId64 " rows: take more ranks",
                   s->rows.count);
    RITZ_CHECK_NEW(s->rows.at, s->rows.count);
    for (int64_t i = 0; i < n; i++)
        if (mark[i])
            s->rows.at[s->place[i]] = i;
    return RITZ_OK;
}

/* The slab as a square matrix with the rows and columns of the part; the slab
   is freed. */
static ritz_status cut_slab(const share *s, ritz_slab *slab, bool by_rows,
                            ritz_sparse *out)
{
    const int64_t h = s->rows.count;
    RITZ_OWN(ritz_sparse) A = {0};

    RITZ_CHECK(ritz_sparse_new(h, h, slab->A.colptr[slab->A.ncol], &A));
    for (int64_t p = 0; p < slab->A.colptr[slab->A.ncol]; p++) {
        A.rowind[p] = s->place[slab->A.rowind[p]];
        A.val[p] = slab->A.val[p];
    }
    for (int64_t j = 0; j < slab->A.ncol; j++)
        A.colptr[s->place[slab->from + j] + 1] =
            slab->A.colptr[j + 1] - slab->A.colptr[j];
    for (int64_t j = 0; j < h; j++)
        A.colptr[j + 1] += A.colptr[j];
    ritz_slab_free(slab);
    if (by_rows)
        return ritz_sparse_transpose(&A, out);
    RITZ_MOVE(*out, A);
    return RITZ_OK;
}

static ritz_status cut_loads(share *s)
{
    RITZ_CHECK_NEW(s->part.load, s->num_loads);
    for (; s->part.num_loads < s->num_loads; s->part.num_loads++) {
        const int64_t k = s->part.num_loads;
        ritz_load *to = &s->part.load[k];

        RITZ_CHECK(ritz_name_copy(s->load[k], to->name));
        RITZ_CHECK(cut_slab(s, &s->KG[k], false, &to->KG));
    }
    return RITZ_OK;
}

static ritz_status make_part(share *s)
{
    RITZ_CHECK(choose_rows(s));
    s->part.num_dofs = s->rows.count;
    s->part.grids = s->component->grids;
    s->part.elements = s->component->elements;
    RITZ_CHECK_NEW(s->part.dof, s->rows.count);
    for (int64_t i = 0; i < s->rows.count; i++)
        s->part.dof[i] = s->component->dof[s->rows.at[i]];
    for (int k = 0; k < MATRICES; k++)
        if (s->slab[k].A.colptr)
            RITZ_CHECK(
                cut_slab(s, &s->slab[k], matrices[k].by_rows,
                         (ritz_sparse *)((char *)&s->part + matrices[k].at)));
    return cut_loads(s);
}

/* --- rows of T ------------------------------------------------------------ */

static void pick_rows(const double *x, int64_t count, const int64_t *row,
                      double *out)
{
    for (int64_t i = 0; i < count; i++)
        out[i] = x[row[i]];
}

/* In rank 0: send to another rank its rows of T, column by column. */
static ritz_status send_rows(const ritz_dense *T, int rank)
{
    RITZ_OWN_ARRAY int64_t *row = NULL;
    RITZ_OWN_ARRAY double *x = NULL;
    int64_t count = 0;

    MPI_Recv(&count, 1, MPI_INT64_T, rank, 0, PETSC_COMM_WORLD,
             MPI_STATUS_IGNORE);
    row = ranks_take(count, sizeof *row);
    x = ranks_take(count, sizeof *x);
    MPI_Recv(row, (int)count, MPI_INT64_T, rank, 0, PETSC_COMM_WORLD,
             MPI_STATUS_IGNORE);
    for (int64_t j = 0; j < T->ncol; j++) {
        pick_rows(ritz_dense_col(T, j), count, row, x);
        MPI_Send(x, (int)count, MPI_DOUBLE, rank, 0, PETSC_COMM_WORLD);
    }
    return RITZ_OK;
}

/* Give each rank its rows of T. @param[in] T  all rows; NULL but in rank 0 */
static ritz_status distribute_basis(share *s, const ritz_dense *T)
{
    const ritz_dofs *of = &s->rows;

    RANKS_CHECK(ritz_dense_new(of->count, s->task->num_columns, &s->T));
    if (!T) {
        MPI_Send(&of->count, 1, MPI_INT64_T, 0, 0, PETSC_COMM_WORLD);
        MPI_Send(of->at, (int)of->count, MPI_INT64_T, 0, 0, PETSC_COMM_WORLD);
    }
    for (int rank = 1; T && rank < ranks_count(); rank++)
        RITZ_CHECK(send_rows(T, rank));
    for (int64_t j = 0; j < s->T.ncol; j++) {
        double *x = ritz_dense_col(&s->T, j);

        if (T)
            pick_rows(ritz_dense_col(T, j), of->count, of->at, x);
        else
            MPI_Recv(x, (int)of->count, MPI_DOUBLE, 0, 0, PETSC_COMM_WORLD,
                     MPI_STATUS_IGNORE);
    }
    return RITZ_OK;
}

/* --- sums ----------------------------------------------------------------- */

static void add_matrix(ritz_dense *A)
{
    if (A->val)
        ranks_sum(A->val, A->nrow * A->ncol);
}

/* Whether K T must be summed with twice the digits, from T'T. */
static ritz_status choose_digits(const share *s, bool *twofold)
{
    const int64_t first = s->to > s->from ? s->place[s->from] : 0;
    RITZ_OWN(ritz_dense) own = {0}, G = {0};

    RANKS_CHECK(
        ritz_dense_block(&s->T, first, s->to - s->from, 0, s->T.ncol, &own));
    RANKS_CHECK(ritz_dense_mul_tn(&own, &own, &G));
    add_matrix(&G);
    return ranks_agree(ritz_congruences_twofold(&G, twofold));
}

/* K_jj / M_jj of the rank's own dofs, and then of all. */
static void find_fastest(const share *s, ritz_fastest *out)
{
    for (int64_t j = s->from; j < s->to; j++)
        ritz_fastest_add(ritz_sparse_diagonal(&s->part.K, s->place[j]),
                         ritz_sparse_diagonal(&s->part.M, s->place[j]), out);
    MPI_Allreduce(MPI_IN_PLACE, &out->ratio, 1, MPI_DOUBLE, MPI_MAX,
                  PETSC_COMM_WORLD);
    MPI_Allreduce(MPI_IN_PLACE, &out->massless, 1, MPI_C_BOOL, MPI_LOR,
                  PETSC_COMM_WORLD);
}

static void add_congruences(const share *s, ritz_congruences *sums)
{
    enum { MEMBERS = 10 };
    ritz_invariants *v = &sums->invariants;
    ritz_dense *const all[MEMBERS] = {
        &sums->K,       &sums->M,       &sums->D,     &sums->K4,
        &sums->rigid,   &v->momentum,   &v->position, &v->product,
        &sums->K_terms, &sums->K4_terms};
    ritz_dense *const symmetric[MATRICES] = {&sums->K, &sums->M, &sums->D,
                                             &sums->K4};

    for (int k = 0; k < MEMBERS; k++)
        add_matrix(all[k]);
    ranks_sum(v->rigid, sizeof v->rigid / sizeof *v->rigid);
    for (int k = 0; k < MATRICES; k++)
        if (symmetric[k]->val && s->symmetric[k])
            ritz_dense_symmetrise(symmetric[k]);
    for (int64_t k = 0; k < sums->num_loads; k++) {
        add_matrix(&sums->load[k].KG);
        ritz_dense_symmetrise(&sums->load[k].KG);
    }
}

/* Carry out a task. Collective. @param[in] T  NULL but in rank 0 */
static ritz_status work_together(const projection_task *t, const char *path,
                                 const ritz_component *component,
                                 const ritz_column_kind *kind,
                                 const ritz_dense *T, ritz_congruences *out)
{
    RITZ_OWN(share)
    s = {.task = t,
         .component = component,
         .frame = {
             .path = path, .num_dofs = t->num_dofs, .dof = component->dof}};
    RITZ_OWN(ritz_congruences) sums = {0};
    bool twofold = false;

    s.from = rows_first_dof(&s.frame, ranks_own());
    s.to = rows_first_dof(&s.frame, ranks_own() + 1);
    ritz_monitor_step("matrices", 0, 0);
    for (int k = 0; k < MATRICES; k++)
        RITZ_CHECK(read_matrix(&s, k));
    RITZ_CHECK(read_loads(&s));
    RANKS_CHECK(make_part(&s));
    RITZ_CHECK(distribute_basis(&s, T));
    RITZ_CHECK(choose_digits(&s, &twofold));
    ritz_monitor_step("projection", 0, 0);
    RANKS_CHECK(ritz_congruences_of(&s.part, kind, &s.T, twofold, &sums));
    find_fastest(&s, &sums.fastest);
    add_congruences(&s, &sums);
    RITZ_MOVE(*out, sums);
    return RITZ_OK;
}

/* --- rank 0 and the others ------------------------------------------------ */

/* In rank 0: whether the other ranks wait in projection_help() for a task. */
static bool others_wait = true;

bool projection_is_idle(void)
{
    return others_wait;
}

void projection_dismiss(void)
{
    projection_task none = {0};

    ranks_share(&none, sizeof none);
}

ritz_status projection_make(const char *path, const ritz_component *component,
                            const ritz_basis *basis, ritz_reduced *out)
{
    RITZ_OWN(ritz_congruences) sums = {0};
    RITZ_OWN_ARRAY char *name = NULL;
    ritz_status status = RITZ_OK;
    projection_task t = {.path_size = (int64_t)strlen(path) + 1,
                         .num_dofs = component->num_dofs,
                         .num_columns = basis->T.ncol};

    RITZ_CHECK_COPY(name, path, t.path_size);
    others_wait = false;
    ranks_share(&t, sizeof t);
    ranks_share(name, t.path_size);
    ranks_share(basis->columns.kind,
                t.num_columns * (int64_t)sizeof *basis->columns.kind);
    status = ranks_agree(RITZ_OK);
    if (status == RITZ_OK)
        status = work_together(&t, path, component, basis->columns.kind,
                               &basis->T, &sums);
    others_wait = true;
    RITZ_CHECK(status);
    return ritz_congruences_reduce(component, basis, &sums, out);
}

/* Take part in a task. */
static void help_once(const projection_task *t)
{
    RITZ_OWN_ARRAY char *path = ranks_take(t->path_size, sizeof *path);
    RITZ_OWN_ARRAY ritz_column_kind *kind =
        ranks_take(t->num_columns, sizeof *kind);
    RITZ_OWN(ritz_component) component = {0};
    RITZ_OWN(ritz_congruences) sums = {0};

    ranks_share(path, t->path_size);
    ranks_share(kind, t->num_columns * (int64_t)sizeof *kind);
    if (ranks_agree(ritz_slab_frame(path, &component)) == RITZ_OK)
        (void)work_together(t, path, &component, kind, NULL, &sums);
}

void projection_help(void)
{
    for (;;) {
        projection_task t = {0};

        ranks_share(&t, sizeof t);
        if (t.path_size == 0)
            return;
        help_once(&t);
    }
}
