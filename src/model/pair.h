/*
 * Pairs of modes of which a choice by value keeps only one: modes of equal
 * values, where rounding decides which is kept; and modes of close frequencies
 * and similar values, where half of a motion may be left out.
 */
#ifndef RITZ_MODEL_PAIR_H
#define RITZ_MODEL_PAIR_H

#include <ritz/base.h>

#include <stdbool.h>
#include <stdint.h>

enum { RITZ_PAIR_SIZE = 192 };

/** Whether the value of a mode left out equals that of a mode kept, to a
 * relative 1e-6. */
bool ritz_is_one_value(double kept, double left);

/** Whether a mode that is kept, [0], and one that is left out, [1], are a
 * pair. */
bool ritz_is_pair(const double hertz[static 2], const double value[static 2]);

/** Write "the modes at 1.2 and 1.3 Hz are a pair, ...: keeping 3 splits
 * them". */
void ritz_pair_print(const double hertz[static 2], const double value[static 2],
                     int64_t kept, char out[RITZ_PAIR_SIZE]);

#endif
