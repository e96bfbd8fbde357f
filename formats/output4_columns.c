/*
 * The columns of an OUTPUT4 matrix, read by one thread or by several.
 *
 * For several threads the columns are cut into shares, contiguous runs of
 * columns; one thread reads a share. A share begins where find_column() of the
 * spelling (text or binary) sees the header of a column, which in text may be a
 * mistake. So the shares are used only if one thread would have read the same:
 * each share ends where the next one begins, columns ascend, and no share had
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
    if (build->column < 0)
        build->first_column = column - 1;
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

    for (int64_t k = 0; k < r->widths * RITZ_OUTPUT4_RULES; k++) {
        ritz_status status =
            try_strings(r, &start, build, (rule + k) % RITZ_OUTPUT4_RULES,
                        k < RITZ_OUTPUT4_RULES ? wide : 3 - wide, words);

        if (status != RITZ_ERR_FORMAT)
            return status;
    }
    return try_strings(r, &start, build, rule, wide, words);
}

bool ritz_output4_skip_columns(ritz_output4_reader *r,
                               const ritz_output4_header *header, int64_t *size)
{
    const ritz_output4_build build = {.header = *header};
    int64_t column = 0;
    int64_t n[3] = {0};

    *size = 0;
    while (column <= header->ncol) {
        if (r->as->take_column(r, &build, n) != RITZ_OK || n[0] <= column ||
            n[0] > header->ncol + 1)
            return false;
        column = n[0];
        *size += r->data_end - r->data;
        if (column <= header->ncol && r->as->skip_column &&
            !r->as->skip_column(r, n))
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
        (void)ritz_output4_skip_columns(&ahead, h, &most);
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

enum { SHARE_BYTES = 1 << 20 }; /* one thread for each so many bytes */

typedef struct ritz_output4_share {
    ritz_output4_reader r;
    ritz_output4_build build;
    const char *stop; /* where the next share begins; NULL for the last */
    ritz_status status;
    int64_t offset; /* its first entry in the matrix */
} ritz_output4_share;

typedef struct ritz_output4_shares {
    int64_t count;
    ritz_output4_share share[RITZ_TEAM_SHARES];
    ritz_output4_header header;
    const char *end; /* the byte behind the matrix */
} ritz_output4_shares;

static void ritz_output4_shares_free(ritz_output4_shares *all)
{
    for (int64_t k = 0; k < all->count; k++)
        ritz_output4_build_free(&all->share[k].build);
}

/* Cut the bytes from the reader to `end` into at most `most` shares. */
static void cut_shares(const ritz_output4_reader *r, const char *end,
                       int64_t most, ritz_output4_shares *all)
{
    const char *begin = r->text.at;
    const char *at = begin;

    for (int64_t k = 0; k < most && at && at < end; k++) {
        ritz_output4_share *share = &all->share[all->count++];
        const char *from = begin + (end - begin) / most * (k + 1);

        share->r = *r;
        share->r.text.at = at;
        at = r->as->find_column(&share->r, from > at ? from : at);
        if (k + 1 < most && at && at < end)
            share->stop = at;
    }
}

/*
 * How many entries a share gets room for: as many as its bytes can hold. The
 * first share gets room for all entries of the matrix, because those of the
 * other shares are copied behind its own. Room that is not used takes no
 * memory.
 */
static int64_t share_room(const ritz_output4_shares *all,
                          const ritz_output4_share *share)
{
    const ritz_output4_reader *r = &share->r;
    const char *stop =
        share->stop && share != all->share ? share->stop : all->end;
    int64_t each = r->width > 0 ? r->width : r->real;
    int64_t most = (stop - r->text.at) / (each * all->header.numbers);
    int64_t nrow = all->header.nrow;

    return nrow > 0 && most / nrow < all->header.ncol ? most
                                                      : nrow * all->header.ncol;
}

static ritz_status begin_share(const ritz_output4_shares *all,
                               ritz_output4_share *share)
{
    const ritz_output4_reader *r = &share->r;
    ritz_output4_build *build = &share->build;

    RITZ_CHECK(begin_matrix(&all->header, r->text.end - r->begin, build));
    build->wide = r->wide;
    return ritz_triplets_reserve(&build->entries, share_room(all, share));
}

static void read_share(int64_t k, void *task)
{
    ritz_output4_shares *all = task;
    ritz_output4_share *share = &all->share[k];

    share->status = begin_share(all, share);
    if (share->status == RITZ_OK)
        share->status = read_until(&share->r, &share->build, share->stop);
}

/* Whether one thread would have read the same as the shares: see the head. */
static bool do_shares_join(const ritz_output4_shares *all)
{
    const ritz_output4_build *first = &all->share[0].build;
    const int64_t rule = begin_rule(&all->header);
    int64_t column = -1;

    for (int64_t k = 0; k < all->count; k++) {
        const ritz_output4_share *share = &all->share[k];
        const ritz_output4_build *build = &share->build;
        bool last = k + 1 == all->count;

        if (share->status != RITZ_OK || build->ended != last ||
            (!last && share->r.text.at != share->stop))
            return false;
        if (!last && (build->rule != rule || build->wide != share->r.wide))
            return false;
        if (build->column >= 0 && build->first_column <= column)
            return false;
        column = build->column >= 0 ? build->column : column;
    }
    return first->entries.counts != NULL;
}

/* Copy the entries of share k behind those of the shares before it. */
static void join_share(int64_t k, void *task)
{
    ritz_output4_shares *all = task;
    ritz_output4_build *build = &all->share[k].build;
    ritz_triplets *to = &all->share[0].build.entries;
    const ritz_triplets *from = &build->entries;
    const int64_t at = all->share[k].offset;

    if (k == 0) /* the others are copied behind it */
        return;
    memcpy(to->row + at, from->row, (size_t)from->count * sizeof *from->row);
    memcpy(to->re + at, from->re, (size_t)from->count * sizeof *from->re);
    if (to->im)
        memcpy(to->im + at, from->im, (size_t)from->count * sizeof *from->im);
    if (build->column >= 0)
        memcpy(to->counts + build->first_column + 1,
               from->counts + build->first_column + 1,
               (size_t)(build->column - build->first_column + 1) *
                   sizeof *to->counts);
    ritz_output4_build_free(build);
}

/* Read the columns by several threads. @return false if one thread must read
 * them: the matrix is small, its end is not known, or the shares do not fit */
static bool read_in_shares(const ritz_output4_reader *r,
                           const ritz_output4_header *header, const char *end,
                           ritz_output4_build *out)
{
    const int threads =
        ritz_team_ready(end ? (end - r->text.at) / SHARE_BYTES : 1);
    RITZ_OWN(ritz_output4_shares) all = {.header = *header, .end = end};
    int64_t total = 0;

    if (threads < 2)
        return false;
    cut_shares(r, end, ritz_team_shares(threads), &all);
    ritz_team_each(threads, all.count, read_share, &all);
    if (!do_shares_join(&all))
        return false;
    for (int64_t k = 0; k < all.count; k++) {
        all.share[k].offset = total;
        total += all.share[k].build.entries.count;
        all.share[0].build.sparse |= all.share[k].build.sparse;
    }
    if (ritz_triplets_reserve(&all.share[0].build.entries,
                              total - all.share[0].build.entries.count) !=
        RITZ_OK)
        return false;
    ritz_team_each(threads, all.count, join_share, &all);
    all.share[0].build.entries.count = total;
    RITZ_MOVE(*out, all.share[0].build);
    return true;
}

ritz_status ritz_output4_read_columns(ritz_output4_reader *r,
                                      const ritz_output4_header *header,
                                      const char *end, ritz_output4_build *out)
{
    if (read_in_shares(r, header, end, out))
        return RITZ_OK;
    RITZ_CHECK(begin_matrix(header, r->text.end - r->begin, out));
    out->wide = r->wide;
    RITZ_CHECK(ritz_triplets_reserve(&out->entries, most_entries(r, header)));
    return read_until(r, out, NULL);
}

void ritz_output4_build_free(ritz_output4_build *build)
{
    ritz_triplets_free(&build->entries);
}
