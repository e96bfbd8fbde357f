/* SPDX-License-Identifier: 0BSD */
#include "model.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ && sizeof(double) == 8,
               "numbers are taken from the file as they are");

enum {
    AT_HASH = 8,
    AT_TOKEN = 16,
    AT_COUNTS = 80,
    AT_BLOCKS = 112,
    WORD = 8,
    COUNTS = 4,
    OSCILLATOR = 2 /* number of its states, and of its coefficients */
};

/* Largest count that is accepted: products of two counts, and sums of such
   products, then fit a size_t. */
static const uint64_t most = 1U << 20;

static bool refuse(char why[FMU_MESSAGE_SIZE], const char *format, ...)
    __attribute__((format(printf, 2, 3)));

static bool refuse(char why[FMU_MESSAGE_SIZE], const char *format, ...)
{
    va_list args;

    va_start(args, format);
    vsnprintf(why, FMU_MESSAGE_SIZE, format, args);
    va_end(args);
    return false;
}

static uint64_t hash_bytes(const unsigned char *at, size_t size)
{
    uint64_t hash = 0xcbf29ce484222325U; /* [FowlerNollVo2019] */

    for (size_t k = 0; k < size; k++)
        hash = (hash ^ at[k]) * 0x100000001b3U;
    return hash;
}

static uint64_t word_at(const unsigned char *at)
{
    uint64_t word = 0;

    memcpy(&word, at, sizeof word);
    return word;
}

/* The whole file; NULL if it cannot be read. A byte is read first because a
 * folder can be opened and has a length of 2^63 - 1, but no byte. */
static unsigned char *read_bytes(FILE *file, size_t *size)
{
    unsigned char *bytes = NULL;
    long end = 0;

    (void)getc(file);
    if (ferror(file) || fseek(file, 0, SEEK_END) != 0)
        return NULL;
    end = ftell(file);
    if (end < 0 || fseek(file, 0, SEEK_SET) != 0)
        return NULL;
    *size = (size_t)end;
    bytes = malloc(*size + 1);
    if (bytes && fread(bytes, 1, *size, file) != *size) {
        free(bytes);
        return NULL;
    }
    return bytes;
}

/* Read the counts of the head; refuse counts for which the file is too short. */
static bool read_counts(const unsigned char *bytes, size_t size, fmu_model *m,
                        char why[FMU_MESSAGE_SIZE])
{
    size_t *const count[COUNTS] = {&m->num_inputs, &m->num_outputs,
                                   &m->num_states, &m->num_blocks};

    if (size < AT_BLOCKS || memcmp(bytes, "RITZFMU1", AT_HASH) != 0)
        return refuse(why, "it is no model that Ritz wrote");
    if (word_at(bytes + AT_HASH) !=
        hash_bytes(bytes + AT_TOKEN, size - AT_TOKEN))
        return refuse(why, "it is damaged: its checksum is another");
    for (int k = 0; k < COUNTS; k++) {
        const uint64_t word = word_at(bytes + AT_COUNTS + WORD * (size_t)k);

        if (word > most)
            return refuse(why, "it states a size of %llu",
                          (unsigned long long)word);
        *count[k] = (size_t)word;
    }
    if (m->num_blocks > (size - AT_BLOCKS) / WORD)
        return refuse(why, "it ends within its list of blocks");
    memcpy(m->token, bytes + AT_TOKEN, FMU_TOKEN_SIZE - 1);
    return true;
}

static bool list_blocks(const unsigned char *bytes, fmu_model *m,
                        size_t *num_numbers, char why[FMU_MESSAGE_SIZE])
{
    size_t states = 0;
    size_t numbers = 0;

    m->block = calloc(m->num_blocks + 1, sizeof *m->block);
    m->block_of = calloc(m->num_states + 1, sizeof *m->block_of);
    if (!m->block || !m->block_of)
        return refuse(why, "there is no memory for its blocks");
    for (size_t k = 0; k < m->num_blocks; k++) {
        const uint64_t word = word_at(bytes + AT_BLOCKS + WORD * k);
        fmu_block *b = &m->block[k];

        b->oscillates = word == 0;
        b->count = b->oscillates ? OSCILLATOR : (size_t)word;
        b->first = states;
        if (word > m->num_states || b->count > m->num_states - states)
            return refuse(why, "block %zu ends behind the last state", k + 1);
        for (size_t i = 0; i < b->count; i++)
            m->block_of[states++] = k;
        numbers += b->oscillates ? OSCILLATOR : b->count * b->count;
    }
    if (states != m->num_states)
        return refuse(why, "its blocks hold %zu of %zu states", states,
                      m->num_states);
    *num_numbers = numbers + (m->num_inputs + m->num_outputs + 1) * states +
                   m->num_outputs * m->num_inputs;
    return true;
}

static const double *take(const double **at, size_t count)
{
    const double *part = *at;

    *at += count;
    return part;
}

/* Let each matrix point to its numbers. */
static void place_matrices(fmu_model *m)
{
    const double *at = m->numbers;

    for (size_t k = 0; k < m->num_blocks; k++) {
        fmu_block *b = &m->block[k];

        b->A = take(&at, b->oscillates ? OSCILLATOR : b->count * b->count);
    }
    m->B = take(&at, m->num_states * m->num_inputs);
    m->C = take(&at, m->num_outputs * m->num_states);
    m->D = take(&at, m->num_outputs * m->num_inputs);
    m->nominal = take(&at, m->num_states);
}

static bool check_numbers(const fmu_model *m, size_t count,
                          char why[FMU_MESSAGE_SIZE])
{
    for (size_t k = 0; k < count; k++)
        if (!isfinite(m->numbers[k]))
            return refuse(why, "number %zu is not finite", k + 1);
    for (size_t k = 0; k < m->num_states; k++)
        if (!(m->nominal[k] > 0.0))
            return refuse(why, "nominal value %zu is not positive", k + 1);
    for (size_t k = 0; k < m->num_blocks; k++)
        for (size_t j = 0; m->block[k].oscillates && j < m->num_inputs; j++)
            if (m->B[j * m->num_states + m->block[k].first] != 0.0)
                return refuse(why, "an input drives a displacement at once");
    return true;
}

static bool fill_model(const unsigned char *bytes, size_t size, fmu_model *m,
                       char why[FMU_MESSAGE_SIZE])
{
    size_t count = 0;
    size_t head = 0;

    if (!read_counts(bytes, size, m, why) ||
        !list_blocks(bytes, m, &count, why))
        return false;
    head = AT_BLOCKS + WORD * m->num_blocks;
    if (size - head != WORD * count)
        return refuse(why, "it has %zu bytes of numbers instead of %zu",
                      size - head, WORD * count);
    m->numbers = malloc(WORD * count + 1);
    if (!m->numbers)
        return refuse(why, "there is no memory for its numbers");
    memcpy(m->numbers, bytes + head, WORD * count);
    place_matrices(m);
    return check_numbers(m, count, why);
}

bool fmu_model_parse(const unsigned char *bytes, size_t size, fmu_model *out,
                     char why[FMU_MESSAGE_SIZE])
{
    fmu_model m = {0};

    if (!fill_model(bytes, size, &m, why)) {
        fmu_model_free(&m);
        return false;
    }
    *out = m;
    return true;
}

bool fmu_model_read(const char *path, fmu_model *out,
                    char why[FMU_MESSAGE_SIZE])
{
    FILE *file = fopen(path, "rb");
    unsigned char *bytes = NULL;
    size_t size = 0;
    bool whole = false;

    if (!file)
        return refuse(why, "it cannot be opened: %s", strerror(errno));
    bytes = read_bytes(file, &size);
    (void)fclose(file);
    if (!bytes)
        return refuse(why, "it cannot be read");
    whole = fmu_model_parse(bytes, size, out, why);
    free(bytes);
    return whole;
}

void fmu_model_free(fmu_model *model)
{
    free(model->block);
    free(model->block_of);
    free(model->numbers);
    *model = (fmu_model){0};
}

static void derive_block(const fmu_block *b, const double *x, double *dx)
{
    const double *in = x + b->first;
    double *out = dx + b->first;

    if (b->oscillates) {
        out[0] = in[1];
        out[1] = -b->A[0] * in[0] - b->A[1] * in[1];
        return;
    }
    for (size_t i = 0; i < b->count; i++)
        out[i] = 0.0;
    for (size_t j = 0; j < b->count; j++)
        for (size_t i = 0; i < b->count; i++)
            out[i] += b->A[j * b->count + i] * in[j];
}

void fmu_model_derive(const fmu_model *model, const double *x, const double *u,
                      double *dx)
{
    const size_t n = model->num_states;

    for (size_t k = 0; k < model->num_blocks; k++)
        derive_block(&model->block[k], x, dx);
    for (size_t j = 0; j < model->num_inputs; j++)
        for (size_t i = 0; i < n; i++)
            dx[i] += model->B[j * n + i] * u[j];
}

double fmu_model_output(const fmu_model *model, size_t i, const double *x,
                        const double *u)
{
    double y = 0.0;

    for (size_t j = 0; j < model->num_states; j++)
        y += model->C[j * model->num_outputs + i] * x[j];
    for (size_t j = 0; j < model->num_inputs; j++)
        y += model->D[j * model->num_outputs + i] * u[j];
    return y;
}

double fmu_model_A(const fmu_model *model, size_t i, size_t j)
{
    const fmu_block *b = &model->block[model->block_of[i]];
    size_t row = i - b->first;
    size_t col = j - b->first;

    if (model->block_of[j] != model->block_of[i])
        return 0.0;
    if (!b->oscillates)
        return b->A[col * b->count + row];
    if (row == 0)
        return col == 1 ? 1.0 : 0.0;
    return -b->A[col];
}
