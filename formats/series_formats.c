/* The table of formats of series. */
#include <ritz/export.h>

const ritz_series_format *const ritz_series_formats[] = {
    &ritz_series_format_pvd,
    &ritz_series_format_xdmf,
    NULL,
};
