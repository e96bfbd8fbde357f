/*
 * Makes the matrices of an FMU. The states of a model of second order are its
 * modal coordinates and their rates, as in the modal integrator of
 * ritz-simulate; a state space keeps its states. States that the damping matrix
 * or A couples form a dense block. A mode that is coupled to no other is an
 * oscillator.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "formats/fmu.h"
#include "formats/sink.h"
#include "simulate/motion.h"

#include <complex.h>
#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

void ritz_fmu_free(ritz_fmu *fmu)
{
    RITZ_FREE_EACH(ritz_dense, fmu->num_blocks, fmu->block);
    ritz_dense_free(&fmu->B);
    ritz_dense_free(&fmu->C);
    ritz_dense_free(&fmu->D);
    RITZ_FREE(fmu->nominal, fmu->state, fmu->input, fmu->output);
    *fmu = (ritz_fmu){0};
}

int64_t ritz_fmu_block_size(const ritz_dense *block)
{
    return block->nrow == 1 && block->ncol == 2 ? 2 : block->nrow;
}

double ritz_fmu_entry(const ritz_fmu *fmu, int64_t block, int64_t row,
                      int64_t col)
{
    const ritz_dense *A = &fmu->block[block];

    if (A->nrow == A->ncol)
        return ritz_dense_col(A, col)[row];
    if (row == 0)
        return col == 1 ? 1.0 : 0.0;
    return -A->val[col];
}

/* ---- blocks ------------------------------------------------------------- */

/* Entry of A in x' = A x: that of a state space, or of modes with
   x = [q_1 ... q_n, v_1 ... v_n]. */
static double first_order_entry(const ritz_motion *m, int64_t i, int64_t j)
{
    const int64_t n = m->n;

    if (m->form == RITZ_FORM_STATES)
        return ritz_dense_col(&m->A, j)[i];
    if (i < n)
        return j == n + i ? 1.0 : 0.0;
    if (j < n)
        return j == i - n ? -m->lambda[j] : 0.0;
    return -ritz_dense_col(&m->D, j - n)[i - n];
}

/* List the rows of A in the order of blocks: those of the first group, and so
   on. */
static void list_rows(const ritz_motion *m, const ritz_groups *groups,
                      int64_t *row)
{
    const bool modes = m->form != RITZ_FORM_STATES;
    int64_t at = 0;

    for (int64_t g = 0; g < groups->count; g++) {
        const int64_t from = groups->first[g];
        const int64_t to = groups->first[g + 1];

        for (int64_t k = from; k < to; k++)
            row[at++] = groups->member[k];
        for (int64_t k = from; modes && k < to; k++)
            row[at++] = m->n + groups->member[k];
    }
}

static ritz_status fill_block(const ritz_motion *m, const int64_t *row,
                              int64_t count, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(count, count, out));
    for (int64_t j = 0; j < count; j++)
        for (int64_t i = 0; i < count; i++)
            ritz_dense_col(out, j)[i] = first_order_entry(m, row[i], row[j]);
    return RITZ_OK;
}

static bool drives(const ritz_dense *B, int64_t row)
{
    for (int64_t j = 0; j < B->ncol; j++)
        if (ritz_dense_col(B, j)[row] != 0.0)
            return true;
    return false;
}

/* Store a block as lambda and d if it is q' = v, v' = -lambda q - d v + b'u. */
static ritz_status note_oscillator(const ritz_dense *B, int64_t first,
                                   ritz_dense *block)
{
    const double *A = block->val;
    RITZ_OWN(ritz_dense) pair = {0};

    if (block->nrow != 2 || A[0] != 0.0 || A[2] != 1.0 || drives(B, first))
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_new(1, 2, &pair));
    pair.val[0] = -A[1];
    pair.val[1] = -A[3];
    ritz_dense_free(block);
    RITZ_MOVE(*block, pair);
    return RITZ_OK;
}

static void name_state(const ritz_motion *m, int64_t row,
                       char out[RITZ_NAME_SIZE])
{
    const char *letter = row < m->n ? "q" : "v";

    if (m->form == RITZ_FORM_STATES)
        letter = "x";
    snprintf(out, RITZ_NAME_SIZE, "%s[%" PRId64 "]", letter, row % m->n + 1);
}

static ritz_status fill_ports(const ritz_motion *m, const int64_t *row,
                              ritz_fmu *fmu)
{
    const bool states = m->form == RITZ_FORM_STATES;

    RITZ_CHECK(ritz_dense_new(fmu->num_states, fmu->num_inputs, &fmu->B));
    RITZ_CHECK(ritz_dense_new(fmu->num_outputs, fmu->num_states, &fmu->C));
    RITZ_CHECK(ritz_dense_copy(&m->feed, &fmu->D));
    RITZ_CHECK_NEW(fmu->state, fmu->num_states);
    for (int64_t i = 0; i < fmu->num_states; i++) {
        const bool rate = row[i] >= m->n;
        const int64_t from = row[i] % m->n;

        name_state(m, row[i], fmu->state[i]);
        for (int64_t j = 0; j < fmu->num_inputs; j++)
            if (states || rate)
                ritz_dense_col(&fmu->B, j)[i] = ritz_dense_col(&m->B, j)[from];
        memcpy(ritz_dense_col(&fmu->C, i),
               ritz_dense_col(rate ? &m->Cv : &m->C, from),
               (size_t)fmu->num_outputs * sizeof(double));
    }
    return RITZ_OK;
}

static ritz_status fill_blocks(const ritz_motion *m, ritz_fmu *fmu)
{
    const bool states = m->form == RITZ_FORM_STATES;
    const ritz_dense *couples = states ? &m->A : &m->D;
    RITZ_OWN(ritz_groups) groups = {0};
    RITZ_OWN_ARRAY int64_t *row = NULL;
    int64_t first = 0;

    fmu->num_states = states ? m->n : 2 * m->n;
    RITZ_CHECK(ritz_groups_new(
        couples, states ? 0.0 : RITZ_SUM_ROUNDING * ritz_dense_max(couples),
        &groups));
    RITZ_CHECK_NEW(row, fmu->num_states);
    list_rows(m, &groups, row);
    RITZ_CHECK(fill_ports(m, row, fmu));
    RITZ_CHECK_NEW(fmu->block, groups.count);
    fmu->num_blocks = groups.count;
    for (int64_t g = 0; g < groups.count; g++) {
        const int64_t count =
            (states ? 1 : 2) * (groups.first[g + 1] - groups.first[g]);

        RITZ_CHECK(fill_block(m, row + first, count, &fmu->block[g]));
        RITZ_CHECK(note_oscillator(&fmu->B, first, &fmu->block[g]));
        first += count;
    }
    return RITZ_OK;
}

/* ---- nominal values ----------------------------------------------------- */

/*
 * Solvers multiply their absolute tolerance by nominal values. That of a state
 * is a fixed part of its largest |(s I - A)^-1 b|, over all inputs and over
 * real s from the lowest frequency of the model to the highest: that is about
 * its largest response to a unit step at the time 1/s. A state that hardly
 * responds has RITZ_HALF_DIGITS of the largest nominal value, so that a solver
 * does not resolve its rounding errors.
 */

static double frequency_of(const ritz_motion *m, const double _Complex *pole,
                           int64_t k)
{
    return pole ? cabs(pole[k]) : sqrt(fabs(m->lambda[k]));
}

/* Lowest and highest circular frequency; both 1 if there is none. A pole that
   overflows has none. */
static ritz_status find_range(const ritz_export_object *object,
                              const ritz_motion *m, double range[2])
{
    RITZ_OWN_ARRAY double _Complex *pole = NULL;
    int64_t count = m->n;

    if (object->states)
        RITZ_CHECK(ritz_state_space_poles(object->states, &count, &pole));
    range[0] = (double)INFINITY;
    range[1] = 0.0;
    for (int64_t k = 0; k < count; k++) {
        const double w = frequency_of(m, pole, k);

        if (isfinite(w))
            range[1] = fmax(range[1], w);
    }
    for (int64_t k = 0; k < count; k++) {
        const double w = frequency_of(m, pole, k);

        if (isfinite(w) && w > RITZ_HALF_DIGITS * range[1])
            range[0] = fmin(range[0], w);
    }
    if (range[1] == 0.0)
        range[0] = range[1] = 1.0;
    return RITZ_OK;
}

/* Raise the nominal values of a block to |(s I - A)^-1 B| at one s. An s that
 * is an eigenvalue is skipped. */
static ritz_status note_response(const ritz_fmu *fmu, int64_t block,
                                 int64_t first, double s, double *nominal)
{
    const int64_t count = ritz_fmu_block_size(&fmu->block[block]);
    RITZ_OWN(ritz_dense) P = {0}, X = {0};

    RITZ_CHECK(ritz_dense_new(count, count, &P));
    RITZ_CHECK(ritz_dense_block(&fmu->B, first, count, 0, fmu->num_inputs, &X));
    for (int64_t j = 0; j < count; j++)
        for (int64_t i = 0; i < count; i++)
            ritz_dense_col(&P, j)[i] =
                (i == j ? s : 0.0) - ritz_fmu_entry(fmu, block, i, j);
    switch (ritz_general_solve_scaled(&P, false, &X)) {
    case RITZ_OK:
        break;
    case RITZ_ERR_SINGULAR:
        return RITZ_OK;
    default:
        return RITZ_ERR_MEMORY;
    }
    for (int64_t j = 0; j < X.ncol; j++)
        for (int64_t i = 0; i < count; i++)
            nominal[first + i] =
                fmax(nominal[first + i], fabs(ritz_dense_col(&X, j)[i]));
    return RITZ_OK;
}

/* Raise small nominal values to a part of the largest, and round all to powers
 * of two, which do not depend on rounding errors. None is 0, as FMI demands. */
static void settle_nominals(int64_t count, double *nominal)
{
    double largest = 0.0;

    for (int64_t i = 0; i < count; i++)
        if (isfinite(nominal[i]))
            largest = fmax(largest, nominal[i]);
    if (!(largest > 0.0))
        largest = 1.0;
    for (int64_t i = 0; i < count; i++) {
        const double value = isfinite(nominal[i]) ? nominal[i] : largest;
        int power = 0;

        (void)frexp(fmax(value, RITZ_HALF_DIGITS * largest), &power);
        nominal[i] = fmax(ldexp(RITZ_NOMINAL_SHARE, power - 1), DBL_MIN);
    }
}

static ritz_status find_nominals(const ritz_export_object *object,
                                 const ritz_motion *m, ritz_fmu *fmu)
{
    enum { STEP = 4 }; /* of s */
    double range[2] = {1.0, 1.0};
    double s = 1.0;

    RITZ_CHECK_NEW(fmu->nominal, fmu->num_states);
    RITZ_CHECK(find_range(object, m, range));
    s = range[0];
    do {
        for (int64_t b = 0, first = 0; b < fmu->num_blocks; b++) {
            RITZ_CHECK(note_response(fmu, b, first, s, fmu->nominal));
            first += ritz_fmu_block_size(&fmu->block[b]);
        }
        s *= STEP;
    } while (s <= STEP * range[1]);
    settle_nominals(fmu->num_states, fmu->nominal);
    return RITZ_OK;
}

/* ---- the model ---------------------------------------------------------- */

static ritz_status check_finite(const ritz_dense *A, const char *name)
{
    for (int64_t k = 0; k < A->nrow * A->ncol; k++)
        RITZ_REFUSE_IF(!isfinite(A->val[k]), RITZ_ERR_ARGUMENT,
                       "an entry of '%s' is not finite", name);
    return RITZ_OK;
}

static ritz_status check_numbers(const ritz_fmu *fmu)
{
    for (int64_t k = 0; k < fmu->num_blocks; k++)
        RITZ_CHECK(check_finite(&fmu->block[k], "A"));
    RITZ_CHECK(check_finite(&fmu->B, "B"));
    RITZ_CHECK(check_finite(&fmu->C, "C"));
    return check_finite(&fmu->D, "D");
}

ritz_status ritz_fmu_of(const ritz_export_object *object, ritz_fmu *out)
{
    const ritz_simulation_request request = RITZ_SIMULATION_NONE;
    const char *text = object->reduced ? object->reduced->damping : "";
    ritz_damping damping = {0};
    RITZ_OWN(ritz_motion) m = {0};
    RITZ_OWN(ritz_fmu) fmu = {0};
    const ritz_model model =
        object->states ? ritz_model_of_states(object->states)
                       : ritz_model_of_reduced(object->reduced, &damping);
    const ritz_io io = ritz_model_io(model); /* borrowed */

    if (*text)
        RITZ_CHECK(ritz_damping_parse(text, &damping));
    RITZ_REFUSE_IF(io.num_inputs + io.num_outputs == 0, RITZ_ERR_ARGUMENT,
                   "it has neither inputs nor outputs, by which an FMU is "
                   "joined: import with --input and --output");
    RITZ_CHECK(ritz_motion_new(model, &request, &m));
    fmu.num_inputs = io.num_inputs;
    fmu.num_outputs = io.num_outputs;
    RITZ_CHECK(fill_blocks(&m, &fmu));
    RITZ_CHECK(check_numbers(&fmu));
    RITZ_CHECK(find_nominals(object, &m, &fmu));
    RITZ_CHECK(ritz_fmu_name_ports(object, &io, &fmu));
    RITZ_MOVE(*out, fmu);
    return RITZ_OK;
}

/* ---- bytes -------------------------------------------------------------- */

typedef struct fmu_numbers {
    const ritz_fmu *fmu;
    const char *token;
} fmu_numbers;

static void put_words(FILE *file, const ritz_fmu *fmu)
{
    const int64_t count[4] = {fmu->num_inputs, fmu->num_outputs,
                              fmu->num_states, fmu->num_blocks};

    fwrite(count, sizeof *count, 4, file);
    for (int64_t k = 0; k < fmu->num_blocks; k++) {
        const ritz_dense *A = &fmu->block[k];
        const int64_t size = A->nrow == A->ncol ? A->nrow : 0;

        fwrite(&size, sizeof size, 1, file);
    }
}

static void put_dense(FILE *file, const ritz_dense *A)
{
    if (A->nrow > 0 && A->ncol > 0)
        fwrite(A->val, sizeof *A->val, (size_t)(A->nrow * A->ncol), file);
}

static ritz_status put_model(FILE *file, const void *what)
{
    static const char head[16] = "RITZFMU1"; /* room for the hash, set later */
    const fmu_numbers *all = what;
    const ritz_fmu *fmu = all->fmu;

    fwrite(head, 1, sizeof head, file);
    fwrite(all->token, 1, RITZ_DIGEST_SIZE - 1, file);
    put_words(file, fmu);
    for (int64_t k = 0; k < fmu->num_blocks; k++)
        put_dense(file, &fmu->block[k]);
    put_dense(file, &fmu->B);
    put_dense(file, &fmu->C);
    put_dense(file, &fmu->D);
    fwrite(fmu->nominal, sizeof *fmu->nominal, (size_t)fmu->num_states, file);
    return RITZ_OK;
}

ritz_status ritz_fmu_numbers(const ritz_fmu *fmu,
                             const char token[RITZ_DIGEST_SIZE],
                             unsigned char **bytes, int64_t *size)
{
    enum { AT_HASH = 8, AT_TOKEN = 16 };
    const fmu_numbers all = {fmu, token};
    uint64_t hash = 0xcbf29ce484222325U; /* [FowlerNollVo2019] */
    char *text = NULL;

    RITZ_CHECK(
        ritz_sink_hold(put_model, &all, "the numbers of an FMU", &text, size));
    for (int64_t k = AT_TOKEN; k < *size; k++)
        hash = (hash ^ (unsigned char)text[k]) * 0x100000001b3U;
    memcpy(text + AT_HASH, &hash, sizeof hash);
    *bytes = (unsigned char *)text;
    return RITZ_OK;
}
