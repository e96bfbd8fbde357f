/* Numbers in large fields of bulk data: for all that writes cards. */
#ifndef RITZ_FORMATS_LARGE_FIELD_H
#define RITZ_FORMATS_LARGE_FIELD_H

enum { RITZ_LARGE_FIELD_SIZE = 16 + 1 }; /* columns, and the NUL */

/**
 * Print a finite number with as many digits as fit: 15 from 0.1 to 1e15, else
 * 13 with an exponent of one digit (1e-5, 1e17), 12 with one of two (1e-20,
 * 1e30), 11 with one of three; one fewer behind a minus. Zeros at the end are
 * left out.
 */
void ritz_large_field_print(double x, char out[static RITZ_LARGE_FIELD_SIZE]);

/**
 * The same for NASTRAN-95, which reads a number of double precision only if it
 * has an exponent with the letter D: 1.234567890123D5 has 13 digits.
 */
void ritz_large_field_print_double(double x,
                                   char out[static RITZ_LARGE_FIELD_SIZE]);

#endif
