/* The larger of two numbers, searching ascending ones, sorting, and enumerating
 * combinations. */
#ifndef RITZ_BASE_SEARCH_H
#define RITZ_BASE_SEARCH_H

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

/** First of @p count ascending numbers not below @p value; count if none. */
static inline int64_t ritz_lower_bound(int64_t count, const int64_t *sorted,
                                       int64_t value)
{
    int64_t low = 0;

    while (low < count) {
        int64_t middle = low + (count - low) / 2;

        if (sorted[middle] < value)
            low = middle + 1;
        else
            count = middle;
    }
    return low;
}

/** Place of @p value among ascending numbers; -1 if it is not there. */
static inline int64_t ritz_search(int64_t count, const int64_t *sorted,
                                  int64_t value)
{
    int64_t k = ritz_lower_bound(count, sorted, value);

    return k < count && sorted[k] == value ? k : -1;
}

/** Number of the @p count ascending values that are at most @p value. */
static inline int64_t ritz_upper_bound(int64_t count, const double *sorted,
                                       double value)
{
    int64_t low = 0;

    while (low < count) {
        int64_t middle = low + (count - low) / 2;

        if (sorted[middle] <= value)
            low = middle + 1;
        else
            count = middle;
    }
    return low;
}

/** The larger of @p a and @p b; @p a if either is not a number, unlike fmax(),
 * which is a call of the C library and too slow for long loops. */
static inline double ritz_larger(double a, double b)
{
    return b > a ? b : a;
}

/** For qsort: numbers in ascending order. */
static inline int ritz_ascending(const void *left, const void *right)
{
    double a = *(const double *)left;
    double b = *(const double *)right;

    return (a > b) - (a < b);
}

/** For qsort: indices, or structs that begin with an index, in ascending
 * order. */
static inline int ritz_ascending_index(const void *left, const void *right)
{
    int64_t a = *(const int64_t *)left;
    int64_t b = *(const int64_t *)right;

    return (a > b) - (a < b);
}

/**
 * The next combination of @p k of the numbers 0 .. n - 1, ascending, in place
 * of the one at @p at; the first is 0, 1, ..., k - 1. False after the last one.
 */
static inline bool ritz_next_choice(int64_t n, int64_t k, int64_t *at)
{
    int64_t i = k - 1;

    while (i >= 0 && at[i] == n - k + i)
        i--;
    if (i < 0)
        return false;
    at[i]++;
    for (int64_t j = i + 1; j < k; j++)
        at[j] = at[j - 1] + 1;
    return true;
}

/**
 * Sort numbers; of those that differ by @p within, relative, or less, the first
 * stays. How many are left.
 */
static inline int64_t ritz_sort_distinct(int64_t count, double *value,
                                         double within)
{
    int64_t kept = 0;

    qsort(value, (size_t)count, sizeof *value, ritz_ascending);
    for (int64_t k = 0; k < count; k++)
        if (kept == 0 || value[k] - value[kept - 1] > within * value[k])
            value[kept++] = value[k];
    return kept;
}

#endif
