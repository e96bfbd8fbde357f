/* Numbers in large fields of bulk data: for all that writes cards. */
#ifndef RITZ_FORMATS_LARGE_FIELD_H
#define RITZ_FORMATS_LARGE_FIELD_H

enum { RITZ_LARGE_FIELD_SIZE = 16 + 1 }; /* columns, and the NUL */

/**
 * A finite number with as many digits as fit: 15 from 0.1 to 1e15, 13 of most
 * others, one fewer behind a minus; zeros at the end are left out.
 */
void ritz_large_field_print(double x, char out[static RITZ_LARGE_FIELD_SIZE]);

#endif
