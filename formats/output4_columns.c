/*
 * The columns of an OUTPUT4 matrix, read by one thread or by several.
 *
 * When the directory of a file is made, the values of each column are counted by
 * its headers, and marks are set at some columns. For several threads the
 * columns from one mark to the next are a share, which one thread reads. It
 * writes the entries to their places in the whole matrix, since the number of
 * values before the share is known. Zeros are counted but not kept; the gaps
 * that they leave are closed at the end.
 *
 * Shares are used only if one thread would have read the same: each share ends
 * where the next one begins, at the column that the mark says, and no share had
 * to change how headers of strings are read. Otherwise, for example in a
 * damaged file, one thread reads all columns once more and reports the first
 * error.
 */
#include "base/alloc.h"
#include "base/team.h"
#include "formats/output4.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- columns ------------------------------------------------------------ */

/*
 * A file may declare one column for each of its bytes, and so many more. A
 * matrix of ten million columns, nearly all zero, is legal and takes 150 bytes;
 * without a limit, a few damaged bytes could request all memory.
 */
enum { NULL_COLUMNS = 32000000 };

/* "column 1 of 'KAA'", without the cost of a format in each column. */
static void name_column(ritz_output4_build *build)
{
    const size_t length = strlen(build->header.name);
    char digits[20];
    size_t first = sizeof digits;
    int64_t left = build->column + 1;
    char *at = build->where;

    do {
        digits[--first] = (char)('0' + left % 10);
        left /= 10;
    } while (left > 0);
    memcpy(at, "column ", 7);
    memcpy(at + 7, digits + first, sizeof digits - first);
    at += 7 + sizeof digits - first;
    memcpy(at, " of '", 5);
    memcpy(at + 5, build->header.name, length);
    memcpy(at + 5 + length, "'", 2);
}

/* How headers of strings are read at first. */
static int64_t begin_rule(const ritz_output4_header *header)
{
    return header->bigmat ? RITZ_OUTPUT4_BIGMAT : RITZ_OUTPUT4_WORDS;
}

/* Begin a matrix that stands in a file of `size` bytes. */
static ritz_status begin_matrix(const ritz_output4_header *header, int64_t size,
                                ritz_output4_build *out)
{
    int64_t most = NULL_COLUMNS + size;

    RITZ_REFUSE_IF(header->ncol > most, RITZ_ERR_FORMAT,
                   "'%s' is said to have %" PRId64
                   " columns, far more than its file can fill",
                   header->name, header->ncol);
    *out = (ritz_output4_build){
        .header = *header,
        .columns = most - header->ncol,
        .column = -1,
        .rule = begin_rule(header),
        .entries.is_complex = header->numbers == 2,
    };
    name_column(out);
    RITZ_CHECK_NEW(out->entries.counts, header->ncol + 1);
    return RITZ_OK;
}

/* Begin a column, numbered from 1. Columns that were skipped are zero. */
static ritz_status begin_column(ritz_output4_build *build, int64_t column)
{
    RITZ_REFUSE_IF(column < 1 || column > build->header.ncol, RITZ_ERR_FORMAT,
                   "'%s' has %" PRId64 " columns, but one is numbered %" PRId64,
                   build->header.name, build->header.ncol, column);
    RITZ_REFUSE_IF(column <= build->column + 1, RITZ_ERR_FORMAT,
                   "column %" PRId64 " of '%s' follows column %" PRId64, column,
                   build->header.name, build->column + 1);
    build->column = column - 1;
    name_column(build);
    build->first = build->entries.count;
    build->below = 0;
    return RITZ_OK;
}

/* Remove the entries of this column that were read so far. */
static void rewind_column(ritz_output4_build *build)
{
    build->entries.count = build->first;
    build->entries.counts[build->column + 1] = 0;
    build->below = 0;
}

/* ---- one matrix --------------------------------------------------------- */

/* Read the strings of a column, which take `words` words, with build->rule and
   build->wide. */
static ritz_status read_strings(ritz_output4_reader *r,
                                ritz_output4_build *build, int64_t words)
{
    for (int64_t left = words; left > 0;) {
        ritz_output4_string string = {0};

        RITZ_CHECK(r->as->take_string(r, build, words, left, &string));
        RITZ_CHECK(r->as->read_numbers(r, build, string.row, string.reals));
        left -= string.words;
    }
    return RITZ_OK;
}

static ritz_status try_strings(ritz_output4_reader *r,
                               const ritz_output4_reader *start,
                               ritz_output4_build *build, int64_t rule,
                               int64_t wide, int64_t words)
{
    *r = *start;
    rewind_column(build);
    build->rule = rule;
    build->wide = wide;
    return read_strings(r, build, words);
}

/* Read the strings of a column. Files do not say how headers of strings are to
 * be read: the way that fitted last is tried first, then all others. If none
 * fits, the error is that of the first. */
static ritz_status read_sparse(ritz_output4_reader *r,
                               ritz_output4_build *build, int64_t words)
{
    const ritz_output4_reader start = *r;
    int64_t rule = build->rule;
    int64_t wide = build->wide;

    if (r->as->read_usual && r->as->read_usual(r, build, words))
        return RITZ_OK;
    for (int64_t k = 0; k < r->widths * RITZ_OUTPUT4_RULES; k++) {
        ritz_status status =
            try_strings(r, &start, build, (rule + k) % RITZ_OUTPUT4_RULES,
                        k < RITZ_OUTPUT4_RULES ? wide : 3 - wide, words);

        if (status != RITZ_ERR_FORMAT)
            return status;
    }
    return try_strings(r, &start, build, rule, wide, words);
}

/* Move behind a column. With marks, its values are counted too; if they cannot
 * be, the marks are removed. */
static bool pass_column(ritz_output4_reader *r, const ritz_output4_build *build,
                        const int64_t n[3], ritz_marks *marks)
{
    const ritz_output4_reader before = *r;
    int64_t values = 0;

    if (marks && marks->count > 0) {
        values = r->as->count_column(r, build, n);
        if (values >= 0) {
            marks->values += values;
            return true;
        }
        marks->count = 0;
        *r = before;
    }
    return !r->as->skip_column || r->as->skip_column(r, n);
}

bool ritz_output4_skip_columns(ritz_output4_reader *r,
                               const ritz_output4_header *header, int64_t *size,
                               ritz_marks *marks)
{
    const ritz_output4_build build = {
        .header = *header, .rule = begin_rule(header), .wide = r->wide};
    int64_t column = 0;
    int64_t n[3] = {0};

    *size = 0;
    while (column <= header->ncol) {
        const ritz_mark mark = {r->text.at - r->begin, r->text.number, column,
                                marks ? marks->values : 0};

        if (r->as->take_column(r, &build, n) != RITZ_OK || n[0] <= column ||
            n[0] > header->ncol + 1)
            return false;
        if (marks && (marks->count > 0 || column == 0))
            ritz_marks_add(marks, &mark);
        column = n[0];
        *size += r->data_end - r->data;
        if (column <= header->ncol && !pass_column(r, &build, n, marks))
            return false;
    }
    return !r->as->skip_last || r->as->skip_last(r, &build, n[2]) == RITZ_OK;
}

/* The largest number of entries that a matrix can have: by the lengths of its
 * records, or of the rest of the file in text. With room for so many, arrays
 * need not grow. */
static int64_t most_entries(const ritz_output4_reader *r,
                            const ritz_output4_header *h)
{
    ritz_output4_reader ahead = *r;
    int64_t most = (r->text.end - r->text.at) / (r->width > 0 ? r->width : 1);

    if (r->width == 0) {
        (void)ritz_output4_skip_columns(&ahead, h, &most, NULL);
        most /= r->real;
    }
    most /= h->numbers;
    return h->nrow > 0 && most / h->nrow < h->ncol ? most : h->nrow * h->ncol;
}

/* ---- columns one after the other ---------------------------------------- */

/* Read columns until the reader is at `stop` or behind it, or until the matrix
 * ends. @param[in] stop  where the next share begins; NULL: there is none */
static ritz_status read_until(ritz_output4_reader *r, ritz_output4_build *build,
                              const char *stop)
{
    int64_t n[3] = {0};

    while (!stop || r->text.at < stop) {
        RITZ_CHECK(r->as->take_column(r, build, n));
        if (n[0] == build->header.ncol + 1) {
            build->ended = true;
            return r->as->skip_last ? r->as->skip_last(r, build, n[2])
                                    : RITZ_OK;
        }
        RITZ_CHECK(begin_column(build, n[0]));
        build->sparse = build->sparse || n[1] == 0;
        if (n[1] == 0)
            RITZ_CHECK(read_sparse(r, build, n[2]));
        else
            RITZ_CHECK(r->as->read_dense(r, build, n));
    }
    return RITZ_OK;
}

/* ---- columns by several threads ----------------------------------------- */

typedef struct ritz_output4_share {
    ritz_output4_reader r;
    ritz_output4_build build; /* its entries are borrowed from the whole */
    ritz_status status;
} ritz_output4_share;

typedef struct ritz_output4_shares {
    const ritz_marks *marks;
    ritz_output4_build whole;
    ritz_output4_share share[RITZ_TEAM_SHARES];
} ritz_output4_shares;

static void ritz_output4_shares_free(ritz_output4_shares *all)
{
    ritz_output4_build_free(&all->whole);
}

/* The entries from `first` on, as a list that is empty and cannot grow. */
static ritz_triplets borrow_entries(const ritz_triplets *from, int64_t first,
                                    int64_t room)
{
    return (ritz_triplets){.room = room,
                           .row = from->row + first,
                           .counts = from->counts,
                           .re = from->re + first,
                           .im = from->im ? from->im + first : NULL,
                           .is_complex = from->is_complex,
                           .borrowed = true};
}

/* Values before share @p k; of all shares if there is none. */
static int64_t values_before(const ritz_marks *marks, int64_t k)
{
    return k < marks->count ? marks->mark[k].values : marks->values;
}

static void begin_share(const ritz_output4_reader *r, int64_t k,
                        ritz_output4_shares *all)
{
    const ritz_mark *mark = &all->marks->mark[k];
    ritz_output4_share *share = &all->share[k];
    const int64_t first = values_before(all->marks, k);

    share->r = *r;
    share->r.text.at = r->begin + mark->at;
    share->r.text.number = mark->line;
    share->build = all->whole;
    share->build.column = mark->column - 1;
    share->build.entries = borrow_entries(
        &all->whole.entries, first, values_before(all->marks, k + 1) - first);
}

static void read_share(int64_t k, void *task)
{
    ritz_output4_shares *all = task;
    const ritz_marks *marks = all->marks;
    ritz_output4_share *share = &all->share[k];
    const char *stop =
        k + 1 < marks->count ? share->r.begin + marks->mark[k + 1].at : NULL;

    share->status = read_until(&share->r, &share->build, stop);
}

/* Whether one thread would have read the same as the shares: see the head. */
static bool do_shares_join(const ritz_output4_shares *all)
{
    const ritz_marks *marks = all->marks;

    for (int64_t k = 0; k < marks->count; k++) {
        const ritz_output4_share *share = &all->share[k];
        const ritz_output4_build *build = &share->build;
        const ritz_mark *next = &marks->mark[k + 1];

        if (share->status != RITZ_OK || build->rule != all->whole.rule ||
            build->wide != all->whole.wide)
            return false;
        if (k + 1 == marks->count)
            return build->ended;
        if (build->ended || share->r.text.at != share->r.begin + next->at ||
            build->column != next->column - 1)
            return false;
    }
    return false;
}

/* Move the entries of the shares together, where zeros have left gaps. */
static void close_gaps(const ritz_output4_shares *all, ritz_triplets *whole)
{
    for (int64_t k = 0; k < all->marks->count; k++) {
        const ritz_triplets *from = &all->share[k].build.entries;
        const size_t count = (size_t)from->count;

        if (from->row != whole->row + whole->count && count > 0) {
            memmove(whole->row + whole->count, from->row,
                    count * sizeof *from->row);
            memmove(whole->re + whole->count, from->re,
                    count * sizeof *from->re);
            if (whole->im)
                memmove(whole->im + whole->count, from->im,
                        count * sizeof *from->im);
        }
        whole->count += from->count;
    }
}

/* Read the columns by several threads. @param[out] found  false if one thread
 * must read them: threads are not allowed, or the shares do not fit */
static ritz_status read_in_shares(const ritz_output4_reader *r,
                                  const ritz_output4_header *header,
                                  const ritz_marks *marks, bool *found,
                                  ritz_output4_build *out)
{
    const int threads = ritz_team_ready(marks ? marks->count : 1);
    RITZ_OWN(ritz_output4_shares) all = {.marks = marks};

    *found = false;
    if (!marks || threads < 2)
        return RITZ_OK;
    RITZ_CHECK(begin_matrix(header, r->text.end - r->begin, &all.whole));
    all.whole.wide = r->wide;
    RITZ_CHECK(ritz_triplets_room(&all.whole.entries, marks->values));
    for (int64_t k = 0; k < marks->count; k++)
        begin_share(r, k, &all);
    ritz_team_each(threads, marks->count, read_share, &all);
    if (!do_shares_join(&all))
        return RITZ_OK;
    close_gaps(&all, &all.whole.entries);
    for (int64_t k = 0; k < marks->count; k++)
        all.whole.sparse |= all.share[k].build.sparse;
    *found = true;
    RITZ_MOVE(*out, all.whole);
    return RITZ_OK;
}

ritz_status ritz_output4_read_columns(ritz_output4_reader *r,
                                      const ritz_output4_header *header,
                                      const ritz_marks *marks,
                                      ritz_output4_build *out)
{
    bool found = false;

    RITZ_CHECK(read_in_shares(r, header, marks, &found, out));
    if (found)
        return RITZ_OK;
    RITZ_CHECK(begin_matrix(header, r->text.end - r->begin, out));
    out->wide = r->wide;
    RITZ_CHECK(ritz_triplets_room(
        &out->entries, marks ? marks->values : most_entries(r, header)));
    return read_until(r, out, NULL);
}

void ritz_output4_build_free(ritz_output4_build *build)
{
    ritz_triplets_free(&build->entries);
}
