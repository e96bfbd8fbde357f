/* The table of formats of matrices. */
#include <ritz/import.h>

const ritz_format *const ritz_formats[] = {
    &ritz_format_output4,        &ritz_format_matrix_market, &ritz_format_mat,
    &ritz_format_harwell_boeing, &ritz_format_coordinates,   &ritz_format_dmig,
    &ritz_format_matrix_input,   &ritz_format_user_element,  NULL,
};
