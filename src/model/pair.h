/*
 * Pairs that a choice of modes by their values cuts: two modes of one value,
 * or of one frequency and values of a size. Which of such is kept depends on
 * rounding, or says that half of a motion is left out.
 */
#ifndef RITZ_MODEL_PAIR_H
#define RITZ_MODEL_PAIR_H

#include <ritz/base.h>

#include <stdbool.h>
#include <stdint.h>

enum { RITZ_PAIR_SIZE = 192 };

/** Whether two values are one. */
bool ritz_is_one_value(double kept, double left);

/** Whether a mode that is kept and one that is left out are a pair. */
bool ritz_is_pair(const double hertz[static 2], const double value[static 2]);

/** "the modes at 1.2 and 1.3 Hz are a pair, ...: keeping 3 splits them" */
void ritz_pair_print(const double hertz[static 2], const double value[static 2],
                     int64_t kept, char out[RITZ_PAIR_SIZE]);

#endif
