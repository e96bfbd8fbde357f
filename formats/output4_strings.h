/*
 * NASTRAN OUTPUT4: matrices by columns, as text and as binary records.
 *
 * A sparse column is a sequence of strings, each consecutive rows behind one or
 * two integers. There are three readings of these, w words to a value:
 *
 *     words    IS = 65536 (w + 1) + row
 *     values   IS = 65536 v + row            NASTRAN-95, v counts values
 *     bigmat   w + 1, row
 *
 * Headers do not always tell which (a bigmat of few rows may be unmarked), so
 * that one is taken by which the strings of a column add up to its word count.
 */
#ifndef RITZ_FORMATS_OUTPUT4_STRINGS_H
#define RITZ_FORMATS_OUTPUT4_STRINGS_H

#include "formats/output4.h"

#include <inttypes.h>

/* The header that NCOL NROW FORM TYPE and a padded name state. @return false
 * if no matrix has such numbers */
static inline bool ritz_output4_set_header(const int64_t n[static 4],
                                           const char *name, int64_t length,
                                           ritz_output4_header *out)
{
    int64_t used = 0;

    if (n[0] < 0 || n[1] == INT64_MIN || n[3] < 1 || n[3] > 4)
        return false;
    *out = (ritz_output4_header){
        .ncol = n[0],
        .nrow = n[1] < 0 ? -n[1] : n[1],
        .bigmat = n[1] < 0 || n[1] >= 65536,
        .form = n[2],
        .type = n[3],
        .numbers = n[3] > 2 ? 2 : 1,
        .symmetric =
            n[2] == RITZ_OUTPUT4_SYMMETRIC && (n[1] == n[0] || n[1] == -n[0]),
    };
    for (int64_t k = 0; k < length && used < RITZ_NAME_SIZE - 1; k++)
        if (name[k] > ' ' && name[k] < 127)
            out->name[used++] = name[k];
    return true;
}

static inline int64_t
ritz_output4_count_integers(const ritz_output4_build *build)
{
    return build->rule == RITZ_OUTPUT4_BIGMAT ? 2 : 1;
}

/*
 * What a string's header says.
 *
 * @return false if that is not possible within @p left words
 */
static inline bool ritz_output4_decode_string(const ritz_output4_build *build,
                                              const int64_t *integers,
                                              int64_t left,
                                              ritz_output4_string *out)
{
    bool pair = build->rule == RITZ_OUTPUT4_BIGMAT;
    int64_t count = pair ? integers[0] : integers[0] / 65536;
    int64_t row = pair ? integers[1] : integers[0] % 65536;
    /* all of these are 1 or 2: divisions by them, one for each string, would
       take a tenth of the time of reading */
    const int64_t half = build->wide - 1, numbers = build->header.numbers;
    const int64_t value = numbers * build->wide; /* words of one */
    int64_t words = count - 1;

    if (count < 1 || count > left)
        return false;
    if (build->rule == RITZ_OUTPUT4_VALUES)
        words = count * value;
    *out = (ritz_output4_string){
        .row = row - 1,
        .reals = words >> half,
        .words = words + ritz_output4_count_integers(build),
    };
    return words >= 1 && (words & (value - 1)) == 0 && out->words <= left &&
           row >= 1 &&
           row - 1 + (out->reals >> (numbers - 1)) <= build->header.nrow;
}

/* Make room for @p count values from @p row, from 0. */
static inline ritz_status ritz_output4_begin_rows(ritz_output4_build *build,
                                                  int64_t row, int64_t count)
{
    RITZ_REFUSE_IF(row < build->below, RITZ_ERR_FORMAT,
                   "rows of %s do not ascend", build->where);
    RITZ_REFUSE_IF(count > build->header.nrow ||
                       row > build->header.nrow - count,
                   RITZ_ERR_FORMAT,
                   "%s has %" PRId64 " values from row %" PRId64
                   ", but the matrix %" PRId64 " rows",
                   build->where, count, row + 1, build->header.nrow);
    build->below = row + count;
    return ritz_triplets_reserve(&build->entries, count);
}

/* Append a value that there is room for; it must be finite. */
static inline ritz_status ritz_output4_put_value(ritz_output4_build *build,
                                                 int64_t row, double re,
                                                 double im)
{
    RITZ_REFUSE_IF(!isfinite(re) || !isfinite(im), RITZ_ERR_FORMAT,
                   "row %" PRId64 " of %s is not finite", row + 1,
                   build->where);
    ritz_triplets_put_value(&build->entries, row, build->column, re, im);
    return RITZ_OK;
}

#endif
