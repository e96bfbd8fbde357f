#include "rows.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "ranks.h"

#include <inttypes.h>
#include <limits.h>
#include <math.h>

/* --- reading -------------------------------------------------------------- */

int64_t rows_first_dof(const rows_frame *f, int rank)
{
    int64_t first = f->num_dofs / ranks_count() * rank +
                    f->num_dofs % ranks_count() * rank / ranks_count();

    while (f->dof && first > 0 && first < f->num_dofs &&
           f->dof[first].component > 0 &&
           f->dof[first].grid == f->dof[first - 1].grid)
        first++;
    return first;
}

/*
 * The checksum of a data set is computed over its values in their order. Each
 * rank continues the sum that it receives from the one before, and the last
 * rank compares it with the file.
 */
static ritz_status verify_chain(const rows_frame *f, const char *name,
                                const ritz_slab *slab)
{
    const int rank = ranks_own();
    uint64_t sum[RITZ_SLAB_SETS];

    ritz_slab_begin(sum);
    if (rank > 0)
        MPI_Recv(sum, RITZ_SLAB_SETS, MPI_UINT64_T, rank - 1, 0,
                 PETSC_COMM_WORLD, MPI_STATUS_IGNORE);
    ritz_slab_sum(slab, sum);
    if (rank == ranks_count() - 1)
        return ritz_slab_verify(f->path, name, sum);
    MPI_Send(sum, RITZ_SLAB_SETS, MPI_UINT64_T, rank + 1, 0, PETSC_COMM_WORLD);
    return RITZ_OK;
}

ritz_status rows_read_matrix(const rows_frame *f, const char *name,
                             ritz_slab *out)
{
    const int rank = ranks_own();

    RANKS_CHECK(ritz_slab_read(f->path, name, f->num_dofs,
                               rows_first_dof(f, rank),
                               rows_first_dof(f, rank + 1), out));
    return ranks_agree(verify_chain(f, name, out));
}

/* --- partition ------------------------------------------------------------ */

/* A pseudo-random number, uniform in (-1, 1), that depends on row and column
   alone. */
static double make_noise(int64_t row, int64_t column)
{
    uint64_t state = (uint64_t)row + 1998 + ((uint64_t)column << 40);

    for (int k = 0; k < 3; k++) {
        state = state * 6364136223846793005U + 1442695040888963407U;
        state ^= state >> 29;
    }
    return (double)(int64_t)state / (double)INT64_MAX;
}

/* The number of attached dofs below a dof, and whether it is attached
   itself. */
static int64_t count_attached(const rows_frame *f, int64_t dof, bool *is_one)
{
    int64_t low = 0;
    int64_t high = f->num_attached;

    while (low < high) {
        const int64_t middle = low + (high - low) / 2;

        if (f->sorted[middle] < dof)
            low = middle + 1;
        else
            high = middle;
    }
    *is_one = low < f->num_attached && f->sorted[low] == dof;
    return low;
}

/* Rows of this rank in compressed form, with indices of PETSc's type. */
typedef struct compressed {
    int64_t rows;
    PetscInt *start, *column;
    double *value;
} compressed;

static void compressed_free(compressed *c)
{
    RITZ_FREE(c->start, c->column, c->value);
}

/* Check of K_bi = K_ib' for each attached dof b, x a random vector: x'K_ib from
   the interior rows less K_bi x from column b, and the sum of the magnitudes of
   both. */
typedef struct mirror {
    double *gap, *size;
} mirror;

static void mirror_free(mirror *m)
{
    RITZ_FREE(m->gap, m->size);
}

static void compare_entry(const mirror *m, int64_t at, double value,
                          int64_t row)
{
    m->gap[at] += value * make_noise(row, 0);
    m->size[at] += fabs(value);
}

/* Subtract K_bi x of one attached dof b, from the interior entries of its
   column. */
static void sum_attached(const rows_frame *f, const ritz_slab *slab, int64_t j,
                         int64_t at, const mirror *m)
{
    for (int64_t p = slab->A.colptr[j]; p < slab->A.colptr[j + 1]; p++) {
        bool attached = false;
        const int64_t dof = slab->A.rowind[p];
        const int64_t below = count_attached(f, dof, &attached);

        if (!attached)
            compare_entry(m, at, -slab->A.val[p], dof - below);
    }
}

/* Split the rows of a slab: entries of interior columns go to *c, those of
   attached columns with their sign changed to `load`, unless it is NULL. */
static void partition_rows(const rows_frame *f, const ritz_slab *slab,
                           compressed *c, double *load, const mirror *m)
{
    int64_t row = 0;
    int64_t at = 0;

    for (int64_t j = 0; j < slab->A.ncol; j++) {
        bool attached = false;
        const int64_t before = count_attached(f, slab->from + j, &attached);

        if (attached) {
            sum_attached(f, slab, j, f->position[before], m);
            continue;
        }
        for (int64_t p = slab->A.colptr[j]; p < slab->A.colptr[j + 1]; p++) {
            const int64_t dof = slab->A.rowind[p];
            const int64_t below = count_attached(f, dof, &attached);

            if (attached && load)
                load[row + f->position[below] * c->rows] = -slab->A.val[p];
            if (attached)
                compare_entry(m, f->position[below], slab->A.val[p],
                              slab->from + j - before);
            else
                c->column[at] = (PetscInt)(dof - below);
            if (!attached)
                c->value[at++] = slab->A.val[p];
        }
        c->start[++row] = (PetscInt)at;
    }
}

/* Sum over all ranks, and refuse a matrix with a difference beyond rounding. */
static ritz_status check_mirror(const rows_frame *f, const mirror *m,
                                const char *name)
{
    ranks_sum(m->gap, f->num_attached);
    ranks_sum(m->size, f->num_attached);
    for (int64_t b = 0; b < f->num_attached; b++)
        RITZ_REFUSE_IF(fabs(m->gap[b]) > RITZ_SYMMETRIC * m->size[b],
                       RITZ_ERR_FORMAT,
                       "%s is unsymmetric: its column of an attached dof is "
                       "not its row (ritz-import --symmetrise averages it "
                       "away)",
                       name);
    return RITZ_OK;
}

static ritz_status allocate_rows(const ritz_slab *slab, int64_t own,
                                 compressed *c)
{
    const int64_t entries = slab->A.colptr[slab->A.ncol];

    RITZ_REFUSE_IF(entries > INT32_MAX, RITZ_ERR_ARGUMENT,
                   "a rank would hold %" PRId64
                   " entries of a matrix, and can count to 2^31: take more "
                   "ranks",
                   entries);
    c->rows = own;
    RITZ_CHECK_NEW(c->start, own + 1);
    RITZ_CHECK_NEW(c->column, entries);
    RITZ_CHECK_NEW(c->value, entries);
    return RITZ_OK;
}

/* Make a distributed matrix of PETSc from the slab, which is freed. */
static ritz_status convert_slab(const rows_frame *f, const char *name,
                                ritz_slab *slab, double *load, const rows *r,
                                Mat *out)
{
    RITZ_OWN(compressed) c = {0};
    RITZ_OWN(mirror) m = {0};

    m.gap = ritz_zalloc(f->num_attached, sizeof *m.gap);
    m.size = ritz_zalloc(f->num_attached, sizeof *m.size);
    RANKS_CHECK(m.gap && m.size ? RITZ_OK : RITZ_ERR_MEMORY);
    RANKS_CHECK(allocate_rows(slab, r->own, &c));
    partition_rows(f, slab, &c, load, &m);
    ritz_slab_free(slab);
    RANKS_CHECK(check_mirror(f, &m, name));
    ranks_expect(MatCreate(PETSC_COMM_WORLD, out));
    ranks_expect(MatSetSizes(*out, (PetscInt)r->own, (PetscInt)r->own,
                             (PetscInt)r->interior, (PetscInt)r->interior));
    ranks_expect(MatSetType(*out, MATMPIAIJ));
    ranks_expect(
        MatMPIAIJSetPreallocationCSR(*out, c.start, c.column, c.value));
    ranks_expect(MatSetOption(*out, MAT_SYMMETRIC, PETSC_TRUE));
    ranks_expect(MatSetOption(*out, MAT_SYMMETRY_ETERNAL, PETSC_TRUE));
    return RITZ_OK;
}

/* --- symmetry ------------------------------------------------------------- */

void rows_fill(Vec x, int64_t column)
{
    PetscInt from = 0;
    PetscInt to = 0;
    double *values = NULL;

    ranks_expect(VecGetOwnershipRange(x, &from, &to));
    ranks_expect(VecGetArray(x, &values));
    for (PetscInt i = from; i < to; i++)
        values[i - from] = make_noise(i, column);
    ranks_expect(VecRestoreArray(x, &values));
}

/*
 * Refuse A if max |A x - A'x| of a random x is above rounding, relative to the
 * largest row sum of |A|. ritz-import stores matrices that are symmetric to the
 * last bit, so that any larger difference means a damaged file.
 */
static ritz_status check_symmetry(Mat A, const char *name)
{
    PetscReal largest = 0.0;
    PetscReal gap = 0.0;
    Vec x = NULL;
    Vec y = NULL;
    Vec z = NULL;

    ranks_expect(MatCreateVecs(A, &x, &y));
    ranks_expect(VecDuplicate(y, &z));
    rows_fill(x, 0);
    ranks_expect(MatMult(A, x, y));
    ranks_expect(MatMultTranspose(A, x, z));
    ranks_expect(VecAXPY(z, -1.0, y));
    ranks_expect(VecNorm(z, NORM_INFINITY, &gap));
    ranks_expect(MatNorm(A, NORM_INFINITY, &largest));
    ranks_expect(VecDestroy(&x));
    ranks_expect(VecDestroy(&y));
    ranks_expect(VecDestroy(&z));
    RITZ_REFUSE_IF(gap > RITZ_SYMMETRIC * largest, RITZ_ERR_FORMAT,
                   "%s is unsymmetric by %.1e of its largest row (ritz-import "
                   "--symmetrise averages it away)",
                   name, gap / largest);
    return RITZ_OK;
}

/* --- interior ------------------------------------------------------------- */

/* Number of interior dofs of this rank. */
static int64_t count_interior(const rows_frame *f)
{
    const int64_t from = rows_first_dof(f, ranks_own());
    const int64_t to = rows_first_dof(f, ranks_own() + 1);
    bool is_one = false;

    return to - from -
           (count_attached(f, to, &is_one) - count_attached(f, from, &is_one));
}

static ritz_status read_stiffness(const rows_frame *f, rows *r)
{
    RITZ_OWN(ritz_slab) slab = {0};
    double *load = NULL;

    RITZ_CHECK(rows_read_matrix(f, "K", &slab));
    if (f->num_attached > 0) {
        ranks_expect(MatCreateDense(PETSC_COMM_WORLD, (PetscInt)r->own,
                                    PETSC_DECIDE, (PetscInt)r->interior,
                                    (PetscInt)f->num_attached, NULL, &r->load));
        ranks_expect(MatDenseGetArray(r->load, &load));
    }
    RITZ_CHECK(convert_slab(f, "K", &slab, load, r, &r->K));
    if (load)
        ranks_expect(MatDenseRestoreArray(r->load, &load));
    return check_symmetry(r->K, "K");
}

static ritz_status read_mass(const rows_frame *f, rows *r)
{
    RITZ_OWN(ritz_slab) slab = {0};

    RITZ_CHECK(rows_read_matrix(f, "M", &slab));
    RITZ_CHECK(convert_slab(f, "M", &slab, NULL, r, &r->M));
    return check_symmetry(r->M, "M");
}

ritz_status rows_read(const rows_frame *frame, rows *out)
{
    RITZ_OWN(rows) r = {.own = count_interior(frame)};

    r.interior = ranks_total(r.own);
    /* eight vectors are exchanged at a time, as one of eight numbers a row */
    RITZ_REFUSE_IF(r.interior > INT32_MAX / 8, RITZ_ERR_ARGUMENT,
                   "%" PRId64 " rows are more than PETSc can count here",
                   r.interior);
    RITZ_CHECK(read_stiffness(frame, &r));
    RITZ_CHECK(read_mass(frame, &r));
    RITZ_MOVE(*out, r);
    return RITZ_OK;
}

void rows_free(rows *r)
{
    ranks_expect(MatDestroy(&r->K));
    ranks_expect(MatDestroy(&r->M));
    ranks_expect(MatDestroy(&r->load));
    *r = (rows){0};
}
