#include "assembly/eliminate.h"

#include <math.h>
#include <string.h>

static const double pivot_tolerance = 1e-9; /* of rows of largest norm 1 */

/* Row and column of the largest entry left; later columns win ties. */
static double find_pivot(const ritz_dense *C, int64_t from,
                         const int64_t *pivot_of, int64_t *row, int64_t *col)
{
    double best = 0.0;

    for (int64_t j = C->ncol - 1; j >= 0; j--)
        for (int64_t i = from; i < C->nrow && pivot_of[j] < 0; i++)
            if (fabs(ritz_dense_col(C, j)[i]) > best) {
                best = fabs(ritz_dense_col(C, j)[i]);
                *row = i;
                *col = j;
            }
    return best;
}

static void swap_rows(ritz_dense *C, int64_t a, int64_t b)
{
    for (int64_t j = 0; j < C->ncol; j++) {
        double *column = ritz_dense_col(C, j);
        double kept = column[a];

        column[a] = column[b];
        column[b] = kept;
    }
}

void ritz_eliminate(ritz_dense *C, int64_t *pivot_of)
{
    int64_t row = 0;
    int64_t col = 0;

    for (int64_t j = 0; j < C->ncol; j++)
        pivot_of[j] = -1;
    for (int64_t k = 0; k < C->nrow; k++) {
        if (find_pivot(C, k, pivot_of, &row, &col) <= pivot_tolerance)
            return;
        swap_rows(C, k, row);
        pivot_of[col] = k;
        for (int64_t j = 0; j < C->ncol; j++) {
            double *column = ritz_dense_col(C, j);

            if (j == col)
                continue;
            column[k] /= ritz_dense_col(C, col)[k];
            for (int64_t i = 0; i < C->nrow; i++)
                if (i != k)
                    column[i] -= ritz_dense_col(C, col)[i] * column[k];
        }
        memset(ritz_dense_col(C, col), 0, (size_t)C->nrow * sizeof *C->val);
        ritz_dense_col(C, col)[k] = 1.0;
    }
}
