/* SPDX-License-Identifier: 0BSD */
#include "propagate.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* How many numbers a block has in fmu_step. */
static size_t count_numbers(const fmu_model *m, const fmu_block *b)
{
    return b->oscillates ? sizeof(fmu_oscillator) / sizeof(double)
                         : b->count * (b->count + m->num_inputs);
}

static bool fill_step(const fmu_model *m, double h, double *at)
{
    for (size_t k = 0; k < m->num_blocks; k++) {
        const fmu_block *b = &m->block[k];

        if (b->oscillates) {
            const fmu_oscillator o = fmu_oscillator_over(b->A[0], b->A[1], h);

            memcpy(at, &o, sizeof o);
        } else if (!fmu_exponential(b->count, m->num_inputs, b->A,
                                    m->B + b->first, m->num_states, h, at)) {
            return false;
        }
        at += count_numbers(m, b);
    }
    return true;
}

/* The step that is kept for this size; if there is none, the step that was used
   least recently, to be replaced. */
static fmu_step *choose_step(fmu_steps *steps, double h)
{
    fmu_step *oldest = steps->step;

    for (int k = 0; k < FMU_STEPS; k++) {
        fmu_step *s = &steps->step[k];

        if (s->numbers && s->h == h)
            return s;
        if (s->used < oldest->used)
            oldest = s;
    }
    return oldest;
}

static const double *find_step(const fmu_model *m, fmu_steps *steps, double h)
{
    fmu_step *s = choose_step(steps, h);
    size_t count = 0;

    if (!s->numbers || s->h != h) {
        for (size_t k = 0; k < m->num_blocks; k++)
            count += count_numbers(m, &m->block[k]);
        free(s->numbers);
        s->numbers = malloc((count + 1) * sizeof *s->numbers);
        if (s->numbers && !fill_step(m, h, s->numbers)) {
            free(s->numbers);
            s->numbers = NULL;
        }
        s->h = h;
    }
    s->used = ++steps->count;
    return s->numbers;
}

static void advance_oscillator(const fmu_model *m, const fmu_block *b,
                               const double *numbers, const double *u,
                               const double *x0, double *x1)
{
    fmu_oscillator o;
    const double q = x0[b->first];
    const double v = x0[b->first + 1];
    double f = 0.0;

    memcpy(&o, numbers, sizeof o);
    for (size_t j = 0; j < m->num_inputs; j++)
        f += m->B[j * m->num_states + b->first + 1] * u[j];
    x1[b->first] = o.hold * q + o.S * v + o.P * f;
    x1[b->first + 1] = -b->A[0] * o.S * q + o.rate * v + o.S * f;
}

static void advance_dense(const fmu_model *m, const fmu_block *b,
                          const double *E, const double *u, const double *x0,
                          double *x1)
{
    const size_t k = b->count;

    for (size_t i = 0; i < k; i++)
        x1[b->first + i] = 0.0;
    for (size_t j = 0; j < k + m->num_inputs; j++) {
        const double by = j < k ? x0[b->first + j] : u[j - k];

        for (size_t i = 0; i < k; i++)
            x1[b->first + i] += E[j * k + i] * by;
    }
}

bool fmu_propagate(const fmu_model *model, fmu_steps *steps, double h,
                   const double *u, const double *x0, double *x1,
                   char why[FMU_MESSAGE_SIZE])
{
    const double *at = find_step(model, steps, h);

    if (!at) {
        snprintf(why, FMU_MESSAGE_SIZE, "there is no memory for a step");
        return false;
    }
    for (size_t k = 0; k < model->num_blocks; k++) {
        const fmu_block *b = &model->block[k];

        if (b->oscillates)
            advance_oscillator(model, b, at, u, x0, x1);
        else
            advance_dense(model, b, at, u, x0, x1);
        at += count_numbers(model, b);
    }
    for (size_t i = 0; i < model->num_states; i++)
        if (!isfinite(x1[i])) {
            snprintf(why, FMU_MESSAGE_SIZE,
                     "the motion is not finite after a step of %g", h);
            return false;
        }
    return true;
}

void fmu_steps_free(fmu_steps *steps)
{
    for (int k = 0; k < FMU_STEPS; k++)
        free(steps->step[k].numbers);
    *steps = (fmu_steps){0};
}
