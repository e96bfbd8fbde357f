#define LANES 8
#include "linear/twofold_body.h"

void ritz_twofold_8(const ritz_sparse *A, const double *X, double *Y,
                    double *low)
{
    add_twofold(A, X, Y, low);
}
