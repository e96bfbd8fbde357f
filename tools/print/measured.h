/* Measured responses as plants and controllers of ritz-frf. */
#ifndef RITZ_PRINT_MEASURED_H
#define RITZ_PRINT_MEASURED_H

#include "print/print.h"

/** Whether what was read is a response and no model. */
bool measured_is(const model *m);

/** Inputs and outputs of a model or of a measured response; borrowed. */
ritz_io measured_ends(const model *m);

/** Read a container of one of some kinds, or a response as a container or as a
 * table of text. */
ritz_status measured_read(cli_run *run, const char *path, int wanted,
                          model *out);

/** Refuse what is asked of a model and cannot be asked of a measurement. */
ritz_status measured_refuse(const response_options *given, const char *path);

/**
 * Points of a measured plant or controller: those of the table, the plant's if
 * both are, within the band that is known; even ones in it if a number of points
 * is given.
 *
 * @return RITZ_ERR_ARGUMENT outside what was measured
 */
ritz_status measured_place(const response_options *given, const model *plant,
                           const model *controller, ritz_grid *out);

#endif
