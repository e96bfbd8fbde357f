/*
 * A MAT file of level 5 that is written, by libmatio. The head contains no
 * time, so that the same run writes the same bytes. libmatio does not report a
 * full disk: the file is read back and compared before it gets its name.
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

/** @param[in] values  by columns */
ritz_status ritz_mat_put_real(ritz_mat_sheet *s, const char *name, int64_t nrow,
                              int64_t ncol, const double *values);

/** Matrices as they are listed, with every entry stored by columns. */
ritz_status ritz_mat_put_matrices(ritz_mat_sheet *s, const ritz_matrices *list);

/** Names as a column of cells; none if there is none. */
ritz_status ritz_mat_put_names(ritz_mat_sheet *s, const char *name,
                               int64_t count,
                               const char (*names)[RITZ_NAME_SIZE]);

/** UTF-8 as a row of letters; no variable if it is empty. */
ritz_status ritz_mat_put_text(ritz_mat_sheet *s, const char *name,
                              const char *text);

/**
 * Close the file, compare it with what was put, and give it its name.
 *
 * @param[in] list  matrices that are compared once more, by Ritz's own reader;
 *                  NULL: none
 * @return RITZ_ERR_FILE if it is not there to its end
 */
ritz_status ritz_mat_sheet_publish(ritz_mat_sheet *s,
                                   const ritz_matrices *list);

void ritz_mat_sheet_free(ritz_mat_sheet *sheet);

#endif
