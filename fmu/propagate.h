/* SPDX-License-Identifier: 0BSD */
/*
 * A step of the model over a time h in which the inputs are constant,
 *
 *     x_1 = exp(A h) x_0 + int_0^h exp(A s) ds B u.
 *
 * It is exact but for rounding, and is computed block by block.
 */
#ifndef RITZ_FMU_PROPAGATE_H
#define RITZ_FMU_PROPAGATE_H

#include "model.h"

/* exp(A h) and its integral for one step size. */
typedef struct fmu_step {
    double h;
    double *numbers; /* for each block a fmu_oscillator, or the matrices of
                        fmu_exponential; NULL: not computed */
    uint64_t used;   /* value of `count` below when it was used last */
} fmu_step;

/* Importers subtract two times to get a step size, so that equal steps differ
   in their last digits. The matrices of a few step sizes are kept. */
enum { FMU_STEPS = 4 };

typedef struct fmu_steps {
    fmu_step step[FMU_STEPS];
    uint64_t count; /* number of steps so far */
} fmu_steps;

/**
 * @param[in]  h   positive
 * @param[out] x1  must not be @p x0
 * @return false: there is no memory, or the result is not finite
 */
bool fmu_propagate(const fmu_model *model, fmu_steps *steps, double h,
                   const double *u, const double *x0, double *x1,
                   char why[FMU_MESSAGE_SIZE]);
void fmu_steps_free(fmu_steps *steps);

/*
 * A step of one oscillator under a constant force f, with S the response of q
 * to a unit velocity:
 *
 *     q_1 = hold q_0 + S v_0 + P f,   v_1 = -lambda S q_0 + rate v_0 + S f
 */
typedef struct fmu_oscillator {
    double hold, S, rate, P;
} fmu_oscillator;

fmu_oscillator fmu_oscillator_over(double lambda, double d, double h);

/**
 * E = exp(A h) and G = int_0^h exp(A s) ds B of a dense block.
 *
 * @param[in]  A  k x k
 * @param[in]  B  k x p, columns @p stride apart
 * @param[out] E  k x k, then k x p of G
 * @return false: there is no memory
 */
bool fmu_exponential(size_t k, size_t p, const double *A, const double *B,
                     size_t stride, double h, double *E);

#endif
