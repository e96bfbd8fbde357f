/* The table of formats of histories. The first that recognises a file reads it.
 */
#include <ritz/recover.h>

const ritz_history_format *const ritz_history_formats[] = {
    &ritz_history_format_mbdyn,
    &ritz_history_format_table,
    NULL,
};
