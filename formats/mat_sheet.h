/*
 * Writes a MAT file of level 5, by libmatio. The head contains no time, so that
 * the same run writes the same bytes. libmatio does not report a full disk;
 * therefore the file is read back and compared before it gets its name.
 */
#ifndef RITZ_FORMATS_MAT_SHEET_H
#define RITZ_FORMATS_MAT_SHEET_H

#include "formats/sink.h"

#include <matio.h>

/* The file, and the variables written to it. */
typedef struct ritz_mat_sheet {
    ritz_draft draft;
    mat_t *file;
    int64_t count, room;
    matvar_t **variable;
} ritz_mat_sheet;

ritz_status ritz_mat_sheet_open(const char *path, ritz_mat_sheet *out);

/** Put a real matrix. @param[in] values  column-major */
ritz_status ritz_mat_put_real(ritz_mat_sheet *s, const char *name, int64_t nrow,
                              int64_t ncol, const double *values);

/** Put all matrices of a list. @param[in] list  every entry is stored,
 * column-major */
ritz_status ritz_mat_put_matrices(ritz_mat_sheet *s, const ritz_matrices *list);

/** Put names as a column of cells; no variable if @p count is 0. */
ritz_status ritz_mat_put_names(ritz_mat_sheet *s, const char *name,
                               int64_t count,
                               const char (*names)[RITZ_NAME_SIZE]);

/** Put a text of UTF-8 as a row of letters; no variable if it is empty. */
ritz_status ritz_mat_put_text(ritz_mat_sheet *s, const char *name,
                              const char *text);

/**
 * Close the file, compare its contents with the variables, and give it its
 * name.
 *
 * @param[in] list  matrices to compare by Ritz's own reader too; NULL: none
 * @return RITZ_ERR_FILE if the contents differ
 */
ritz_status ritz_mat_sheet_publish(ritz_mat_sheet *s,
                                   const ritz_matrices *list);

void ritz_mat_sheet_free(ritz_mat_sheet *sheet);

#endif
