/* Order: searching ascending whole numbers, and sorting. */
#ifndef RITZ_BASE_SEARCH_H
#define RITZ_BASE_SEARCH_H

#include <stdint.h>

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

/** For qsort: numbers in ascending order. */
static inline int ritz_ascending(const void *left, const void *right)
{
    double a = *(const double *)left;
    double b = *(const double *)right;

    return (a > b) - (a < b);
}

#endif
