/*
 * The krylov engine while its space grows: errors at some points, and what is
 * added where they are largest. See response_krylov.c for the equations.
 */
#ifndef RITZ_RESPONSE_KRYLOV_H
#define RITZ_RESPONSE_KRYLOV_H

#include "response/krylov_small.h"

typedef struct ritz_krylov {
    ritz_direct full;
    ritz_krylov_space space;
    ritz_krylov_small small;
    double lambda_h;  /* every mode beneath is in the space */
    double tolerance; /* of the largest |H| of a channel */
    double amplify;   /* of errors, where full answers showed larger ones */
    int64_t outputs, inputs, values;
    int64_t count, num_even; /* of points; the first measure H too */
    double *hertz;
    double *size;  /* inputs, then outputs: of residuals at one point */
    double *load;  /* the same of the loads */
    double *error; /* count x values */
    double *trial; /* values: errors at one point more */
    double *noise; /* values: rounding of the full answers met last */
    double *peak, *allowed; /* values */
    double _Complex *y, *H;
    double worst;                /* largest error / allowed */
    double unmet;                /* that, or what full answers showed */
    int64_t at;                  /* the point where it is */
    int64_t points, corrections; /* that were made */
} ritz_krylov;

/** Points and arrays for a range. */
ritz_status ritz_krylov_place(ritz_krylov *k, double from_hz, double to_hz);

/** Whether D or K4 couples modes with the rest. */
bool ritz_krylov_couples(const ritz_krylov *k);

/** What each channel may err by at a frequency, into @p error. */
ritz_status ritz_krylov_judge(ritz_krylov *k, double hertz, double *error);

/** Residual @p index, inputs before outputs, of what was solved last: k->y. */
void ritz_krylov_take(ritz_krylov *k, double hertz, int64_t index);

/** All points anew. */
ritz_status ritz_krylov_measure(ritz_krylov *k);

/** A^-1 of all loads, the first vectors. */
ritz_status ritz_krylov_begin(ritz_krylov *k);

/** A^-1 of the residuals at the worst point. */
ritz_status ritz_krylov_correct(ritz_krylov *k, int64_t *added);

/**
 * Full answers at one frequency, and into the space unless what the projection
 * errs there is within what is allowed of the largest |H|, this one included,
 * and within what rounding makes of the full answers themselves.
 *
 * @param[out] was  that error over what is allowed
 */
ritz_status ritz_krylov_expand(ritz_krylov *k, double hertz, int64_t *added,
                               double *was);

#endif
