/* The outputs of a harmonic motion. */
#ifndef RITZ_MODEL_IO_H
#define RITZ_MODEL_IO_H

#include <ritz/model.h>

/**
 * H += (C + i w Cv - w^2 Ca) X, w = 2 pi hertz.
 *
 * @param[in]     X  n x num_inputs, column-major
 * @param[in,out] H  num_outputs x num_inputs, row by row
 */
void ritz_io_respond(const ritz_io *io, double hertz, const double _Complex *X,
                     double _Complex *H);

#endif
