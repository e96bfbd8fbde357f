#define LANES 4
#include "linear/twofold_body.h"

void ritz_twofold_4(const ritz_sparse *A, const double *X, double *Y,
                    double *low)
{
    add_twofold(A, X, Y, low);
}
