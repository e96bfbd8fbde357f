#include "factor.h"

#include "base/alloc.h"
#include "base/memory.h"
#include "linear/ordering.h"
#include "ranks.h"

#include <dmumps_c.h>
#include <inttypes.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* MUMPS's numbers for its jobs. */
enum { START = -1, END = -2, ANALYSE = 1, FACTOR = 2, SOLVE = 3 };

/* Indices from zero of its arrays of controls and results: ICNTL(k) of the
   manual is icntl[k - 1]. */
enum {
    ERROR_UNIT = 0,
    DIAGNOSTIC_UNIT = 1,
    GLOBAL_UNIT = 2,
    PRINT_LEVEL = 3,
    ORDERING = 6,
    ROOT_SEQUENTIAL = 12,
    ROOM_PERCENT = 13,
    ENTRIES = 17,
    RIGHT_SIDES = 19,
    SOLUTION = 20,
    ON_DISK = 21,
    NULL_PIVOTS = 23,
    ANALYSIS = 27,
    OUTCOME = 0,          /* of INFOG */
    NEGATIVE_PIVOTS = 11, /* of INFOG */
    NUM_NULL_PIVOTS = 27, /* of INFOG */
    OWN_PIVOTS = 22,      /* of INFO */
    ROOM = 14,            /* of INFO */
    DISK_ROOM = 16,       /* of INFO, if factors are on disk */
};

/* Values of these controls. */
enum { GIVEN_ORDER = 1, METIS = 5, BY_RANKS = 3, RIGHT_BY_RANKS = 10 };

enum { MOST_ROOM = 2000 /* percent */, ACROSS = 32 /* columns of a solve */ };

/* How rows of a solution travel from the ranks that eliminated them to those
   that own them. */
typedef struct route {
    int *out, *out_at; /* number and first of the rows that go to each rank */
    int *in, *in_at;   /* and of those that come from it */
    int64_t *from;     /* of each that goes: its row in the rank's solution */
    int64_t *to;       /* of each that comes: its row in X */
    int64_t going, coming;
} route;

static void route_free(route *r)
{
    RITZ_FREE(r->out, r->out_at, r->in, r->in_at, r->from, r->to);
    *r = (route){0};
}

struct rank_factor {
    Mat K, M; /* borrowed */
    DMUMPS_STRUC_C id;
    bool started;
    int64_t own; /* rows of this rank, which begin at `first` */
    int64_t first;
    /* upper triangle of the rank's rows, and the rank's rows, from 1; MUMPS
       borrows all four */
    MUMPS_INT *row, *column, *rows;
    double *value;
    MUMPS_INT *place;  /* in rank 0: pivot of each row, from 1 */
    MUMPS_INT *pivots; /* rows of the solution in this rank, from 1 */
    route route;       /* of the present factor, from its first solve on */
    int64_t null_row;  /* in rank 0: of a pivot that is zero; -1: none */
};

static void call_mumps(rank_factor *F, int job)
{
    F->id.job = job;
    dmumps_c(&F->id);
}

void rank_factor_free(rank_factor **factor)
{
    rank_factor *F = *factor;

    if (!F)
        return;
    if (F->started)
        call_mumps(F, END);
    route_free(&F->route);
    RITZ_FREE(F->row, F->column, F->rows, F->value, F->place, F->pivots);
    free(F);
    *factor = NULL;
}

/* The outcome of a job as a status, from INFOG(1), which is the same in every
   rank. */
static ritz_status report_failure(const rank_factor *F)
{
    enum { SINGULAR = -10 };
    static const int memory[] = {-5, -7, -8, -9, -13, -17, -19, -20};
    const int outcome = F->id.infog[OUTCOME];

    for (size_t k = 0; k < sizeof memory / sizeof *memory; k++)
        RITZ_REFUSE_IF(outcome == memory[k], RITZ_ERR_MEMORY,
                       "one of %d ranks has no memory for its part of the "
                       "factor: take more ranks, on more machines",
                       ranks_count());
    RITZ_REFUSE_IF(outcome == SINGULAR, RITZ_ERR_SINGULAR,
                   "the matrix is singular");
    RITZ_REFUSE_IF(outcome < 0, RITZ_ERR_CONVERGENCE,
                   "the matrix cannot be factored, MUMPS says %d", outcome);
    return RITZ_OK;
}

/* --- pattern -------------------------------------------------------------- */

/* Row i of K - sigma M, in the union of both patterns: columns in ascending
   order, and values. Returns their number. */
static int64_t join_row(const rank_factor *F, int64_t i, double sigma,
                        MUMPS_INT *column, double *value)
{
    const PetscInt *k = NULL, *m = NULL;
    const double *K = NULL, *M = NULL;
    PetscInt k_end = 0, m_end = 0, a = 0, b = 0;
    int64_t count = 0;

    ranks_expect(MatGetRow(F->K, (PetscInt)i, &k_end, &k, &K));
    ranks_expect(MatGetRow(F->M, (PetscInt)i, &m_end, &m, &M));
    while (a < k_end || b < m_end) {
        const bool by_k = b == m_end || (a < k_end && k[a] <= m[b]);
        const PetscInt j = by_k ? k[a] : m[b];

        value[count] = 0.0;
        column[count] = j;
        if (a < k_end && k[a] == j)
            value[count] += K[a++];
        if (b < m_end && m[b] == j)
            value[count] -= sigma * M[b++];
        count++;
    }
    ranks_expect(MatRestoreRow(F->K, (PetscInt)i, &k_end, &k, &K));
    ranks_expect(MatRestoreRow(F->M, (PetscInt)i, &m_end, &m, &M));
    return count;
}

/* The pattern of this rank's rows, and working memory for one row. */
typedef struct pattern {
    int64_t entries, upper; /* of them on and above the diagonal */
    int64_t *length;        /* of each row */
    MUMPS_INT *column;      /* of each entry, from 0 */
    double *value;          /* of one row */
} pattern;

static void pattern_free(pattern *p)
{
    RITZ_FREE(p->length, p->column, p->value);
    *p = (pattern){0};
}

/* Entries of this rank's rows of a matrix. */
static int64_t count_entries(Mat A)
{
    MatInfo info;

    ranks_expect(MatGetInfo(A, MAT_LOCAL, &info));
    return (int64_t)info.nz_used;
}

static ritz_status allocate_pattern(const rank_factor *F, pattern *p)
{
    const int64_t room = count_entries(F->K) + count_entries(F->M);
    PetscInt columns = 0;

    ranks_expect(MatGetSize(F->K, NULL, &columns));
    RITZ_CHECK_NEW(p->length, F->own);
    RITZ_CHECK_NEW(p->column, room);
    RITZ_CHECK_NEW(p->value, columns);
    return RITZ_OK;
}

static ritz_status find_pattern(const rank_factor *F, pattern *p)
{
    RITZ_CHECK(allocate_pattern(F, p));
    for (int64_t i = 0; i < F->own; i++) {
        const MUMPS_INT *column = p->column + p->entries;

        p->length[i] =
            join_row(F, F->first + i, 0.0, p->column + p->entries, p->value);
        p->entries += p->length[i];
        for (int64_t k = 0; k < p->length[i]; k++)
            p->upper += column[k] >= F->first + i;
    }
    return RITZ_OK;
}

/* Put the upper triangle of the rank's rows of K - sigma M into the arrays for
   MUMPS. @param  column,value  working memory for one row */
static void fill_entries(rank_factor *F, double sigma, MUMPS_INT *column,
                         double *value)
{
    int64_t at = 0;

    for (int64_t i = F->first; i < F->first + F->own; i++) {
        const int64_t count = join_row(F, i, sigma, column, value);

        for (int64_t k = 0; k < count; k++) {
            if (column[k] < i)
                continue;
            F->row[at] = (MUMPS_INT)(i + 1);
            F->column[at] = column[k] + 1;
            F->value[at++] = value[k];
        }
    }
}

/* --- order ---------------------------------------------------------------- */

/* Columns are sent and received in pieces of at most this many. */
enum { PIECE = 1 << 28 };

static void send_pattern(const rank_factor *F, const pattern *p)
{
    MPI_Send(p->length, (int)F->own, MPI_INT64_T, 0, 0, PETSC_COMM_WORLD);
    for (int64_t at = 0; at < p->entries; at += PIECE)
        MPI_Send(p->column + at,
                 (int)(p->entries - at < PIECE ? p->entries - at : PIECE),
                 MPI_INT, 0, 0, PETSC_COMM_WORLD);
}

/* Add rows to a pattern whose `filled` rows before are complete. */
static void append_rows(int64_t rows, const int64_t *length,
                        const MUMPS_INT *column, int64_t *filled,
                        ritz_sparse *out)
{
    int64_t at = out->colptr[*filled];
    int64_t from = 0;

    for (int64_t i = 0; i < rows; i++) {
        for (int64_t k = 0; k < length[i]; k++)
            out->rowind[at++] = column[from++];
        out->colptr[++*filled] = at;
    }
}

/* In rank 0: the rows of another rank. */
static void receive_pattern(int rank, int64_t rows, int64_t *filled,
                            ritz_sparse *out)
{
    RITZ_OWN_ARRAY int64_t *length = ranks_take(rows, sizeof *length);
    RITZ_OWN_ARRAY MUMPS_INT *column = NULL;
    int64_t entries = 0;

    MPI_Recv(length, (int)rows, MPI_INT64_T, rank, 0, PETSC_COMM_WORLD,
             MPI_STATUS_IGNORE);
    for (int64_t i = 0; i < rows; i++)
        entries += length[i];
    column = ranks_take(entries, sizeof *column);
    for (int64_t at = 0; at < entries; at += PIECE)
        MPI_Recv(column + at,
                 (int)(entries - at < PIECE ? entries - at : PIECE), MPI_INT,
                 rank, 0, PETSC_COMM_WORLD, MPI_STATUS_IGNORE);
    append_rows(rows, length, column, filled, out);
}

/* Gather the pattern of all rows in rank 0. It has no values. */
static ritz_status gather_pattern(const rank_factor *F, const pattern *p,
                                  ritz_sparse *out)
{
    const int64_t entries = ranks_total(p->entries);
    const bool all = ranks_own() == 0;
    const PetscInt *first = NULL;
    int64_t filled = 0;
    PetscInt n = 0;

    ranks_expect(MatGetSize(F->K, &n, NULL));
    ranks_expect(MatGetOwnershipRanges(F->K, &first));
    out->nrow = out->ncol = n;
    out->colptr = ritz_zalloc(all ? n + 1 : 0, sizeof *out->colptr);
    out->rowind = ritz_zalloc(all ? entries : 0, sizeof *out->rowind);
    RANKS_CHECK(out->colptr && out->rowind ? RITZ_OK : RITZ_ERR_MEMORY);
    if (!all) {
        send_pattern(F, p);
        return RITZ_OK;
    }
    append_rows(F->own, p->length, p->column, &filled, out);
    for (int r = 1; r < ranks_count(); r++)
        receive_pattern(r, first[r + 1] - first[r], &filled, out);
    return RITZ_OK;
}

/* In rank 0: order the rows. */
static ritz_status place_rows(rank_factor *F, const ritz_sparse *A)
{
    RITZ_OWN_ARRAY int64_t *order = NULL;

    RITZ_CHECK(ritz_ordering_new(A, &order));
    RITZ_CHECK_NEW(F->place, A->nrow);
    for (int64_t k = 0; k < A->nrow; k++)
        F->place[order[k]] = (MUMPS_INT)(k + 1);
    F->id.perm_in = F->place;
    return RITZ_OK;
}

/* Order the rows in rank 0, unless MUMPS is to do it: a small matrix, or as an
   option says. */
static ritz_status order_rows(rank_factor *F, const pattern *p)
{
    RITZ_OWN(ritz_sparse) A = {0};
    ritz_status status = RITZ_OK;

    ritz_monitor_step("order of rows", 0, 0);
    if (F->id.icntl[ORDERING] != GIVEN_ORDER)
        return RITZ_OK;
    RITZ_CHECK(gather_pattern(F, p, &A));
    if (ranks_own() == 0)
        status = place_rows(F, &A);
    return ranks_agree(status);
}

/* --- analysis ------------------------------------------------------------- */

/* Set a control from the environment variable PETSC_OPTIONS, with the names
   that PETSc has for them: -mat_mumps_icntl_28 2. Returns whether it is there. */
static bool read_whole(const char *kind, int number, MUMPS_INT *out)
{
    char name[40];
    PetscBool given = PETSC_FALSE;
    PetscInt value = 0;

    snprintf(name, sizeof name, "-mat_mumps_%s_%d", kind, number);
    ranks_expect(PetscOptionsGetInt(NULL, NULL, name, &value, &given));
    if (given)
        *out = value;
    return given;
}

static void read_real(const char *kind, int number, double *out)
{
    char name[40];

    snprintf(name, sizeof name, "-mat_mumps_%s_%d", kind, number);
    ranks_expect(PetscOptionsGetReal(NULL, NULL, name, out, NULL));
}

/* Rows are ordered as given; null pivots are counted; ScaLAPACK does not factor
   the last front, as it does not count negative pivots. */
static void set_controls(rank_factor *F)
{
    enum { CONTROLS = 60, REAL_CONTROLS = 15 };
    MUMPS_INT *icntl = F->id.icntl;

    icntl[ERROR_UNIT] = icntl[DIAGNOSTIC_UNIT] = icntl[GLOBAL_UNIT] = 0;
    icntl[PRINT_LEVEL] = 0;
    icntl[ENTRIES] = BY_RANKS;
    icntl[RIGHT_SIDES] = RIGHT_BY_RANKS;
    icntl[SOLUTION] = 1; /* by ranks */
    icntl[ORDERING] = F->id.n < RITZ_ORDER_FROM ? METIS : GIVEN_ORDER;
    icntl[ROOT_SEQUENTIAL] = 1;
    icntl[ROOM_PERCENT] = 30;
    icntl[NULL_PIVOTS] = 1;
    for (int k = 1; k <= CONTROLS; k++)
        if (read_whole("icntl", k, &icntl[k - 1]) && k - 1 == ANALYSIS)
            icntl[ORDERING] = METIS;
    for (int k = 1; k <= REAL_CONTROLS; k++)
        read_real("cntl", k, &F->id.cntl[k - 1]);
}

static ritz_status allocate_entries(rank_factor *F, const pattern *p)
{
    RITZ_CHECK_NEW(F->row, p->upper);
    RITZ_CHECK_NEW(F->column, p->upper);
    RITZ_CHECK_NEW(F->value, p->upper);
    RITZ_CHECK_NEW(F->rows, F->own);
    for (int64_t i = 0; i < F->own; i++)
        F->rows[i] = (MUMPS_INT)(F->first + i + 1);
    return RITZ_OK;
}

static void start_mumps(rank_factor *F)
{
    PetscInt n = 0;

    F->id.sym = 2; /* symmetric, not known to be definite */
    F->id.par = 1; /* rank 0 takes part */
    F->id.comm_fortran = (MUMPS_INT)MPI_Comm_c2f(PETSC_COMM_WORLD);
    call_mumps(F, START);
    F->started = true;
    ranks_expect(MatGetSize(F->K, &n, NULL));
    F->id.n = n;
    set_controls(F);
}

/*
 * Refuse a factor that would not fit on one of the machines, by the limit of
 * rank 0. MUMPS estimates the memory of each rank, in millions of bytes.
 */
static ritz_status admit_factor(const rank_factor *F)
{
    const bool on_disk = F->id.icntl[ON_DISK] != 0;
    int64_t needed[2] = {
        F->id.info[on_disk ? DISK_ROOM : ROOM] * INT64_C(1000000), 1};
    MPI_Comm machine = MPI_COMM_NULL;
    char what[64];

    MPI_Comm_split_type(PETSC_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0,
                        MPI_INFO_NULL, &machine);
    MPI_Allreduce(MPI_IN_PLACE, needed, 2, MPI_INT64_T, MPI_SUM, machine);
    MPI_Comm_free(&machine);
    MPI_Allreduce(MPI_IN_PLACE, needed, 2, MPI_INT64_T, MPI_MAX,
                  PETSC_COMM_WORLD);
    snprintf(what, sizeof what,
             "the factor in %" PRId64 " rank(s) of one machine", needed[1]);
    return ranks_agree(ranks_own() == 0 ? ritz_memory_admit(what, needed[0])
                                        : RITZ_OK);
}

static ritz_status analyse_pattern(rank_factor *F)
{
    RITZ_OWN(pattern) p = {0};

    start_mumps(F);
    RITZ_CHECK(report_failure(F));
    RANKS_CHECK(find_pattern(F, &p));
    RANKS_CHECK(allocate_entries(F, &p));
    RITZ_CHECK(order_rows(F, &p));
    fill_entries(F, 0.0, p.column, p.value);
    F->id.nnz_loc = p.upper;
    pattern_free(&p);
    F->id.irn_loc = F->row;
    F->id.jcn_loc = F->column;
    F->id.a_loc = F->value;
    ritz_monitor_step("analysis", 0, 0);
    call_mumps(F, ANALYSE);
    RITZ_CHECK(report_failure(F));
    return admit_factor(F);
}

ritz_status rank_factor_new(Mat K, Mat M, rank_factor **out)
{
    RITZ_OWN(rank_factor) *F = NULL;
    PetscInt from = 0;
    PetscInt to = 0;

    RANKS_CHECK_NEW(F, 1);
    F->null_row = -1;
    F->K = K;
    F->M = M;
    ranks_expect(MatGetOwnershipRange(K, &from, &to));
    F->first = from;
    F->own = to - from;
    RITZ_CHECK(analyse_pattern(F));
    RITZ_MOVE(*out, F);
    return RITZ_OK;
}

/* --- factors -------------------------------------------------------------- */

/* Whether the factorisation failed as its workspace was too small. */
static bool needs_room(const rank_factor *F)
{
    return F->id.infog[OUTCOME] == -8 || F->id.infog[OUTCOME] == -9;
}

/* Compute the entries of K - sigma M. */
static ritz_status shift_entries(rank_factor *F, double sigma)
{
    RITZ_OWN_ARRAY MUMPS_INT *column = NULL;
    RITZ_OWN_ARRAY double *value = NULL;

    RITZ_CHECK_NEW(column, F->id.n);
    RITZ_CHECK_NEW(value, F->id.n);
    fill_entries(F, sigma, column, value);
    return RITZ_OK;
}

/* If delayed pivots need more workspace than the analysis predicted, repeat with
   twice as much in addition. */
ritz_status rank_factor_make(rank_factor *F, double sigma, const char *step,
                             int64_t *negative)
{
    free(F->pivots);
    F->pivots = NULL;
    route_free(&F->route);
    RANKS_CHECK(shift_entries(F, sigma));
    ritz_monitor_step(step, 0, 0);
    call_mumps(F, FACTOR);
    while (needs_room(F) && F->id.icntl[ROOM_PERCENT] < MOST_ROOM) {
        F->id.icntl[ROOM_PERCENT] *= 2;
        call_mumps(F, FACTOR);
    }
    RITZ_CHECK(report_failure(F));
    *negative = F->id.infog[NEGATIVE_PIVOTS];
    F->null_row = -1;
    if (F->id.infog[NUM_NULL_PIVOTS] > 0 && ranks_own() == 0)
        F->null_row = F->id.pivnul_list[0] - 1;
    RITZ_REFUSE_IF(F->id.infog[NUM_NULL_PIVOTS] > 0, RITZ_ERR_SINGULAR,
                   "the matrix is singular, %d pivots are zero",
                   F->id.infog[NUM_NULL_PIVOTS]);
    return RITZ_OK;
}

int64_t rank_factor_null_row(const rank_factor *F)
{
    return F->null_row;
}

/* --- solves --------------------------------------------------------------- */

/* The rank that owns a row. */
static int find_owner(const PetscInt *first, int64_t row)
{
    int low = 0;
    int high = ranks_count() - 1;

    while (low < high) {
        const int middle = low + (high - low + 1) / 2;

        if (first[middle] <= row)
            low = middle;
        else
            high = middle - 1;
    }
    return low;
}

static ritz_status allocate_route(int64_t going, route *r)
{
    r->going = going;
    RITZ_CHECK_NEW(r->out, ranks_count());
    RITZ_CHECK_NEW(r->out_at, ranks_count());
    RITZ_CHECK_NEW(r->in, ranks_count());
    RITZ_CHECK_NEW(r->in_at, ranks_count());
    RITZ_CHECK_NEW(r->from, going);
    return RITZ_OK;
}

/* at[r] := the sum of the counts before r. Returns the sum of all. */
static int64_t sum_before(const int *counts, int *at)
{
    int64_t sum = 0;

    for (int r = 0; r < ranks_count(); r++) {
        at[r] = (int)sum;
        sum += counts[r];
    }
    return sum;
}

/* Sort the rows of the rank's solution by the ranks that own them; row[k] is the
   row of the k-th within its owner. */
static void sort_pivots(const rank_factor *F, const PetscInt *first, route *r,
                        int64_t *row)
{
    for (int64_t k = 0; k < r->going; k++)
        r->out[find_owner(first, F->pivots[k] - 1)]++;
    (void)sum_before(r->out, r->out_at);
    for (int64_t k = 0; k < r->going; k++) {
        const int owner = find_owner(first, F->pivots[k] - 1);
        const int at = r->out_at[owner]++;

        r->from[at] = k;
        row[at] = F->pivots[k] - 1 - first[owner];
    }
    (void)sum_before(r->out, r->out_at);
}

/* Find the route of solutions of the present factor, from the rows that its
   first solve has put into F->pivots. */
static ritz_status plan_route(rank_factor *F)
{
    RITZ_OWN(route) r = {0};
    RITZ_OWN_ARRAY int64_t *row = NULL;
    const PetscInt *first = NULL;

    ranks_expect(MatGetOwnershipRanges(F->K, &first));
    RANKS_CHECK(allocate_route(F->id.lsol_loc, &r));
    RANKS_CHECK_NEW(row, r.going);
    sort_pivots(F, first, &r, row);
    MPI_Alltoall(r.out, 1, MPI_INT, r.in, 1, MPI_INT, PETSC_COMM_WORLD);
    r.coming = sum_before(r.in, r.in_at);
    RANKS_CHECK_NEW(r.to, r.coming);
    MPI_Alltoallv(row, r.out, r.out_at, MPI_INT64_T, r.to, r.in, r.in_at,
                  MPI_INT64_T, PETSC_COMM_WORLD);
    RITZ_MOVE(F->route, r);
    return RITZ_OK;
}

/* Working memory of a solve: rows of the solution in this rank, those that go,
   and those that come. */
typedef struct parcels {
    double *solution, *out, *in;
} parcels;

static void parcels_free(parcels *p)
{
    RITZ_FREE(p->solution, p->out, p->in);
}

/* Send the rows of a solution of @p count columns to their owners. */
static void deliver_rows(const rank_factor *F, int64_t count, const parcels *p,
                         double *X)
{
    const route *r = &F->route;
    MPI_Datatype row = MPI_DATATYPE_NULL;

    for (int64_t k = 0; k < r->going; k++)
        for (int64_t c = 0; c < count; c++)
            p->out[k * count + c] = p->solution[r->from[k] + c * r->going];
    MPI_Type_contiguous((int)count, MPI_DOUBLE, &row);
    MPI_Type_commit(&row);
    MPI_Alltoallv(p->out, r->out, r->out_at, row, p->in, r->in, r->in_at, row,
                  PETSC_COMM_WORLD);
    MPI_Type_free(&row);
    for (int64_t k = 0; k < r->coming; k++)
        for (int64_t c = 0; c < count; c++)
            X[r->to[k] + c * F->own] = p->in[k * count + c];
}

/* Solve for at most ACROSS columns. */
static ritz_status solve_some(rank_factor *F, int64_t count, const double *B,
                              const parcels *p, double *X)
{
    DMUMPS_STRUC_C *id = &F->id;

    id->nrhs = (MUMPS_INT)count;
    id->nloc_rhs = (MUMPS_INT)F->own;
    id->lrhs_loc = (MUMPS_INT)(F->own > 0 ? F->own : 1);
    id->irhs_loc = F->rows;
    memcpy(&id->rhs_loc, &B, sizeof B); /* MUMPS does not write to it */
    id->sol_loc = p->solution;
    id->isol_loc = F->pivots;
    call_mumps(F, SOLVE);
    RITZ_CHECK(report_failure(F));
    if (!F->route.out)
        RITZ_CHECK(plan_route(F));
    deliver_rows(F, count, p, X);
    return RITZ_OK;
}

static ritz_status allocate_parcels(rank_factor *F, int64_t columns, parcels *p)
{
    const int64_t across = columns < ACROSS ? columns : ACROSS;

    F->id.lsol_loc = F->id.info[OWN_PIVOTS];
    if (!F->pivots)
        RITZ_CHECK_NEW(F->pivots, F->id.lsol_loc);
    RITZ_CHECK_NEW(p->solution, F->id.lsol_loc * across);
    RITZ_CHECK_NEW(p->out, F->id.lsol_loc * across);
    RITZ_CHECK_NEW(p->in, F->own * across);
    return RITZ_OK;
}

ritz_status rank_factor_solve(rank_factor *F, int64_t columns, const double *B,
                              double *X)
{
    RITZ_OWN(parcels) p = {0};

    RANKS_CHECK(allocate_parcels(F, columns, &p));
    for (int64_t j = 0; j < columns; j += ACROSS)
        RITZ_CHECK(solve_some(F, columns - j < ACROSS ? columns - j : ACROSS,
                              B + j * F->own, &p, X + j * F->own));
    return RITZ_OK;
}
