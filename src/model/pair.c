#include "model/pair.h"

#include "base/tolerances.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

bool ritz_is_one_value(double kept, double left)
{
    return left >= (1.0 - RITZ_CLUSTER_GAP) * kept;
}

bool ritz_is_pair(const double hertz[static 2], const double value[static 2])
{
    return ritz_is_one_value(value[0], value[1]) ||
           (fabs(hertz[1] - hertz[0]) <= RITZ_CLOSE * hertz[0] &&
            value[1] >= RITZ_HANKEL_PAIR * value[0]);
}

void ritz_pair_print(const double hertz[static 2], const double value[static 2],
                     int64_t kept, char out[RITZ_PAIR_SIZE])
{
    snprintf(out, RITZ_PAIR_SIZE,
             "the modes at %.6g and %.6g Hz are a pair, of values %.4g and "
             "%.4g: keeping %" PRId64 " splits them",
             hertz[0], hertz[1], value[0], value[1], kept);
}
