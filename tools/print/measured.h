/* Measured responses as plants and controllers of ritz-frf. */
#ifndef RITZ_PRINT_MEASURED_H
#define RITZ_PRINT_MEASURED_H

#include "print/print.h"

/** Whether a measured response was read, and not a model. */
bool measured_is(const model *m);

/** Inputs and outputs of a model or of a measured response; borrowed. */
ritz_io measured_ends(const model *m);

/** Read a container whose kind is among @p wanted, or a response from a
 * container or a text table. */
ritz_status measured_read(cli_run *run, const char *path, int wanted,
                          model *out);

/** Refuse options of models, which a measured response does not have. */
ritz_status measured_refuse(const response_options *given, const char *path);

/**
 * Frequencies of a loop with a measured plant or controller, within the band
 * that was measured: those of its table, or of the plant's table if both are
 * measured; evenly spaced ones if a number of points is given.
 *
 * @return RITZ_ERR_ARGUMENT if frequencies outside that band are requested
 */
ritz_status measured_place(const response_options *given, const model *plant,
                           const model *controller, ritz_grid *out);

#endif
