#define LANES 2
#include "linear/twofold_body.h"

void ritz_twofold_2(const ritz_sparse *A, const double *X, double *Y,
                    double *low)
{
    add_twofold(A, X, Y, low);
}
