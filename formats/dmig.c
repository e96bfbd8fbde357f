/*
 * Matrices in DMIG cards, of bulk data or of a punch file.
 *
 *     DMIG  NAME  0   IFO  TIN  TOUT  POLAR  -  NCOL         the header
 *     DMIG  NAME  GJ  CJ   -    G1  C1  A1  B1               one column
 *           G2  C2  A2  B2      G3  C3  A3  B3  ...
 *
 * IFO 1 is square, 6 symmetric with one triangle given, 2 and 9 rectangular;
 * TIN 1 and 2 are real, 3 and 4 complex, A + iB or, if POLAR is 1, A at B
 * degrees. Square ones have a row for every dof that occurs as row or column,
 * ascending. Rectangular ones have the rows and columns that occur; with IFO 9
 * and NCOL they have the columns 1 to NCOL, and GJ is the number of a column.
 *
 * INCLUDE is followed where the file's folder is known; where it is not, a
 * matrix whose columns would have to come from elsewhere is refused.
 *
 * [Nastran1986], and [MSC2022] for NCOL, entry DMIG.
 */
#include "base/alloc.h"
#include "base/search.h"
#include "base/team.h"
#include "base/tolerances.h"
#include "formats/cards.h"
#include "formats/matrix.h"

#include <ritz/import.h>

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <strings.h>

enum {
    RITZ_DMIG_SQUARE = 1,
    RITZ_DMIG_WIDE = 2,
    RITZ_DMIG_SYMMETRIC = 6,
    RITZ_DMIG_COLUMNS = 9,
    MOST_COLUMNS = 1000000, /* largest NCOL */
};

/* A header card. */
typedef struct ritz_dmig_header {
    int64_t line; /* in the deck: no two headers have the same */
    char name[RITZ_NAME_SIZE];
    int64_t form;
    bool complex, polar;
    int64_t columns; /* NCOL of form 9; 0: those that occur */
    int64_t digits;
    int64_t count; /* of its terms */
} ritz_dmig_header;

/* A(row, col) = re + i im, as a column card gives it. */
typedef struct ritz_dmig_term {
    ritz_dof row, col;
    double re, im;
    int64_t line;
} ritz_dmig_term;

typedef struct ritz_dmig_cards {
    ritz_cards cards;
    int64_t num_headers, headers_room;
    int64_t num_terms, terms_room;
    int64_t wanted;           /* line of the header whose terms are taken */
    ritz_dmig_header *header; /* sorted by name once all are taken */
    ritz_dmig_term *term;
} ritz_dmig_cards;

static void ritz_dmig_cards_free(ritz_dmig_cards *all)
{
    ritz_cards_free(&all->cards);
    RITZ_FREE(all->header, all->term);
}

static int compare_names(const void *a, const void *b)
{
    const ritz_dmig_header *left = a;
    const ritz_dmig_header *right = b;

    return strcmp(left->name, right->name);
}

static ritz_status sort_headers(ritz_dmig_cards *all)
{
    if (all->num_headers > 1)
        qsort(all->header, (size_t)all->num_headers, sizeof *all->header,
              compare_names);
    for (int64_t k = 1; k < all->num_headers; k++)
        if (compare_names(&all->header[k - 1], &all->header[k]) == 0)
            return ritz_cards_refuse(&all->cards, all->header[k].line,
                                     "DMIG '%s' has a second header",
                                     all->header[k].name);
    return RITZ_OK;
}

static ritz_status take_name(const ritz_card *card, char out[RITZ_NAME_SIZE])
{
    const char *name = ritz_card_text(card, 0);
    size_t k = 0;

    if (!isalpha((unsigned char)*name))
        return ritz_card_refuse(card, 0, "the name of a matrix");
    for (; name[k]; k++) {
        if (iscntrl((unsigned char)name[k]) || name[k] == '/')
            return ritz_card_refuse(card, 0, "the name of a matrix");
        out[k] = ritz_card_upper(name[k]);
    }
    out[k] = '\0';
    return RITZ_OK;
}

/* The header has 0 where columns have a grid; a blank is a header's too. */
static bool is_header(const ritz_card *card)
{
    const char *grid = ritz_card_text(card, 1);

    return strcmp(grid, "0") == 0 || !*grid;
}

static ritz_status add_header(ritz_dmig_cards *all, const ritz_card *card)
{
    ritz_dmig_header header = {.line = card->entry->line};
    int64_t type = 0;
    int64_t polar = 0;

    RITZ_CHECK(take_name(card, header.name));
    RITZ_CHECK(ritz_card_whole(card, 2, 0, &header.form));
    RITZ_CHECK(ritz_card_whole(card, 3, 0, &type));
    RITZ_CHECK(ritz_card_whole(card, 5, 0, &polar));
    if (header.form != RITZ_DMIG_SQUARE && header.form != RITZ_DMIG_WIDE &&
        header.form != RITZ_DMIG_SYMMETRIC && header.form != RITZ_DMIG_COLUMNS)
        return ritz_card_refuse(card, 2, "a form: 1, 2, 6 or 9");
    if (type < 1 || type > 4)
        return ritz_card_refuse(card, 3, "a type: 1, 2, 3 or 4");
    if (polar != 0 && polar != 1)
        return ritz_card_refuse(card, 5, "0 or 1 for POLAR");
    header.complex = type > 2;
    header.polar = polar == 1;
    if (header.form == RITZ_DMIG_COLUMNS) /* other forms ignore the field */
        RITZ_CHECK(ritz_card_whole(card, 7, 0, &header.columns));
    if (header.columns < 0 || header.columns > MOST_COLUMNS)
        return ritz_card_refuse(card, 7, "a number of columns");
    RITZ_CHECK_ROOM(all->header, all->num_headers, all->headers_room);
    all->header[all->num_headers++] = header;
    return RITZ_OK;
}

static ritz_status take_dof(const ritz_card *card, int64_t k, ritz_dof *out)
{
    RITZ_CHECK(ritz_card_id(card, k, &out->grid));
    RITZ_CHECK(ritz_card_whole(card, k + 1, 0, &out->component));
    if (out->component < 0 || out->component > 6)
        return ritz_card_refuse(card, k + 1, "a direction, 0 to 6");
    return RITZ_OK;
}

static bool is_empty_group(const ritz_card *card, int64_t k)
{
    for (int64_t j = k; j < k + 4; j++)
        if (*ritz_card_text(card, j))
            return false;
    return true;
}

/* G C A B at field k. */
static ritz_status add_term(ritz_dmig_cards *all, ritz_dmig_header *owner,
                            const ritz_card *card, int64_t k, ritz_dof col)
{
    static const double RADIANS = RITZ_PI / 180.0;
    ritz_dmig_term new = {.col = col};
    double a = 0.0;
    double b = 0.0;
    int64_t digits = 0;

    RITZ_CHECK(take_dof(card, k, &new.row));
    RITZ_CHECK(ritz_card_real(card, k + 2, 0.0, &a));
    RITZ_CHECK(ritz_card_real(card, k + 3, 0.0, &b));
    if (!owner->complex && b != 0.0)
        return ritz_card_refuse(card, k + 3,
                                "blank, as it is in a real matrix");
    new.line = card->field[k].line;
    new.re = owner->polar ? a *cos(b * RADIANS) : a;
    new.im = owner->polar ? a *sin(b * RADIANS) : b;
    for (int64_t j = k + 2; j < k + 4; j++) {
        digits = ritz_card_digits(ritz_card_text(card, j));
        if (digits > owner->digits)
            owner->digits = digits;
    }
    RITZ_CHECK_ROOM(all->term, all->num_terms, all->terms_room);
    all->term[all->num_terms++] = new;
    owner->count++;
    return RITZ_OK;
}

static ritz_status add_column(ritz_dmig_cards *all, const ritz_card *card)
{
    ritz_dmig_header named = {0};
    ritz_dmig_header *owner = NULL;
    ritz_dof col = {0};

    RITZ_CHECK(take_name(card, named.name));
    if (all->num_headers > 0)
        owner = bsearch(&named, all->header, (size_t)all->num_headers,
                        sizeof named, compare_names);
    if (!owner)
        return ritz_cards_refuse(&all->cards, card->entry->line,
                                 "DMIG '%s' has no header", named.name);
    RITZ_CHECK(take_dof(card, 1, &col));
    if (owner->columns > 0) {
        if (col.grid > owner->columns)
            return ritz_card_refuse(card, 1, "among the columns 1 to NCOL");
        col.component = 0;
    }
    for (int64_t k = 4; k < card->count && owner->line == all->wanted; k += 4)
        if (!is_empty_group(card, k))
            RITZ_CHECK(add_term(all, owner, card, k, col));
    return RITZ_OK;
}

/* Take the headers, or the columns, of the entries [from, to) of the deck. */
static ritz_status take_range(ritz_dmig_cards *all, bool headers, int64_t from,
                              int64_t to)
{
    RITZ_OWN(ritz_card) card = {0};

    for (int64_t k = from; k < to; k++) {
        if (strcmp(all->cards.entry[k].name, "DMIG") != 0)
            continue;
        RITZ_CHECK(ritz_card_take(&all->cards, k, &card));
        if (is_header(&card) != headers)
            continue;
        RITZ_CHECK(headers ? add_header(all, &card) : add_column(all, &card));
    }
    return RITZ_OK;
}

/* ---- cards by several threads -------------------------------------------- */

/*
 * The entries of the deck are cut into shares, contiguous ranges; each share is
 * taken by one thread, and the results are joined in the order of the deck. If
 * a card is refused, one thread takes all entries once more, so that the error
 * names the first wrong card of the file.
 */
enum { SHARE_ENTRIES = 4000 }; /* one thread for each so many entries */

typedef struct ritz_dmig_shares {
    const ritz_dmig_cards *all;
    bool headers;
    int64_t count;
    ritz_dmig_cards share[RITZ_TEAM_SHARES]; /* `cards` are borrowed of all */
    ritz_status status[RITZ_TEAM_SHARES];
    int64_t offset[RITZ_TEAM_SHARES]; /* first term of the share in all */
} ritz_dmig_shares;

static void ritz_dmig_shares_free(ritz_dmig_shares *shares)
{
    for (int64_t k = 0; k < shares->count; k++)
        RITZ_FREE(shares->share[k].header, shares->share[k].term);
}

static ritz_status read_share(const ritz_dmig_shares *shares, int64_t k,
                              ritz_dmig_cards *share)
{
    const ritz_dmig_cards *all = shares->all;
    int64_t from = 0;
    int64_t to = 0;

    share->cards = all->cards;
    share->wanted = all->wanted;
    if (!shares->headers) {
        RITZ_CHECK_COPY(share->header, all->header, all->num_headers);
        share->num_headers = share->headers_room = all->num_headers;
    }
    ritz_team_part(all->cards.num_entries, k, shares->count, &from, &to);
    return take_range(share, shares->headers, from, to);
}

static void take_share(int64_t k, void *task)
{
    ritz_dmig_shares *shares = task;

    shares->status[k] = read_share(shares, k, &shares->share[k]);
}

/* Copy the terms of share k to their place among all. */
static void join_terms(int64_t k, void *task)
{
    const ritz_dmig_shares *shares = task;
    const ritz_dmig_cards *share = &shares->share[k];

    if (share->num_terms > 0)
        memcpy(shares->all->term + shares->offset[k], share->term,
               (size_t)share->num_terms * sizeof *share->term);
}

/* Add the terms and digits that a share counted for each header. */
static void join_counts(const ritz_dmig_cards *share, ritz_dmig_cards *all)
{
    for (int64_t k = 0; k < all->num_headers; k++) {
        all->header[k].count += share->header[k].count;
        if (share->header[k].digits > all->header[k].digits)
            all->header[k].digits = share->header[k].digits;
    }
}

/* Append the headers of a share. */
static ritz_status join_headers(const ritz_dmig_cards *share,
                                ritz_dmig_cards *all)
{
    for (int64_t k = 0; k < share->num_headers; k++) {
        RITZ_CHECK_ROOM(all->header, all->num_headers, all->headers_room);
        all->header[all->num_headers++] = share->header[k];
    }
    return RITZ_OK;
}

/* Take the headers, or the columns, of the whole deck. Headers are taken first,
 * because they may stand behind their columns. */
static ritz_status take_cards(ritz_dmig_cards *all, bool headers)
{
    const int64_t entries = all->cards.num_entries;
    const int threads = ritz_team_ready(entries / SHARE_ENTRIES);
    RITZ_OWN(ritz_dmig_shares) shares = {.all = all, .headers = headers};
    int64_t total = 0;

    if (threads < 2)
        return take_range(all, headers, 0, entries);
    shares.count = ritz_team_shares(threads);
    ritz_team_each(threads, shares.count, take_share, &shares);
    for (int64_t k = 0; k < shares.count; k++) {
        if (shares.status[k] != RITZ_OK)
            return take_range(all, headers, 0, entries);
        shares.offset[k] = total;
        total += shares.share[k].num_terms;
    }
    if (headers) {
        for (int64_t k = 0; k < shares.count; k++)
            RITZ_CHECK(join_headers(&shares.share[k], all));
        return RITZ_OK;
    }
    RITZ_CHECK_NEW(all->term, total);
    all->num_terms = all->terms_room = total;
    ritz_team_each(threads, shares.count, join_terms, &shares);
    for (int64_t k = 0; k < shares.count; k++)
        join_counts(&shares.share[k], all);
    return RITZ_OK;
}

/* The dofs that occur as rows, as columns or as either, ascending. */
static ritz_status collect_dofs(const ritz_dmig_term *terms, int64_t count,
                                bool rows, bool cols, int64_t *found,
                                ritz_dof **out)
{
    ritz_dof *dof = NULL;
    int64_t n = 0;

    RITZ_CHECK_NEW(dof, 2 * count);
    for (int64_t k = 0; k < count; k++) {
        if (rows)
            dof[n++] = terms[k].row;
        if (cols)
            dof[n++] = terms[k].col;
    }
    *found = ritz_dof_distinct(n, dof);
    *out = dof;
    return RITZ_OK;
}

/* The columns of a rectangular matrix, ascending. */
static ritz_status list_columns(const ritz_dmig_header *owner,
                                const ritz_dmig_term *terms, int64_t *count,
                                ritz_dof **out)
{
    if (owner->columns == 0)
        return collect_dofs(terms, owner->count, false, true, count, out);
    RITZ_CHECK_NEW(*out, owner->columns);
    *count = owner->columns;
    for (int64_t j = 0; j < owner->columns; j++)
        (*out)[j] = (ritz_dof){j + 1, 0};
    return RITZ_OK;
}

/* The matrix of a header and its sorted terms. */
static ritz_status make_matrix(const ritz_dmig_header *owner,
                               const ritz_dmig_term *terms, ritz_matrix *out)
{
    bool square =
        owner->form == RITZ_DMIG_SQUARE || owner->form == RITZ_DMIG_SYMMETRIC;
    RITZ_OWN(ritz_matrix)
    new = {.symmetric = owner->form == RITZ_DMIG_SYMMETRIC,
           .digits = owner->digits};
    RITZ_OWN(ritz_triplets) list = {.is_complex = owner->complex};
    int64_t nrow = 0;
    int64_t ncol = 0;

    memcpy(new.name, owner->name, sizeof new.name);
    snprintf(new.spelling, sizeof new.spelling, "DMIG, form %d%s%s",
             (int)owner->form, owner->complex ? ", complex" : "",
             owner->polar ? ", polar" : "");
    RITZ_CHECK(
        collect_dofs(terms, owner->count, true, square, &nrow, &new.row));
    ncol = nrow;
    if (!square)
        RITZ_CHECK(list_columns(owner, terms, &ncol, &new.col));
    RITZ_CHECK(ritz_triplets_reserve(&list, owner->count));
    for (int64_t k = 0; k < owner->count; k++) {
        const ritz_dmig_term *one = &terms[k];
        const ritz_dof *cols = square ? new.row : new.col;
        const ritz_dof *row = bsearch(&one->row, new.row, (size_t)nrow,
                                      sizeof *row, ritz_dof_compare);
        const ritz_dof *col = bsearch(&one->col, cols, (size_t)ncol,
                                      sizeof *col, ritz_dof_compare);

        ritz_triplets_put(&list, row - new.row, col - cols, one->re, one->im);
    }
    RITZ_CHECK(ritz_triplets_compress(&list, nrow, ncol, &new));
    if (new.symmetric) /* one triangle is given */
        RITZ_CHECK(ritz_matrix_mirror(&new, 1.0, 1.0));
    RITZ_MOVE(*out, new);
    return RITZ_OK;
}

/* By column, then row, then line. */
static int compare_terms(const void *a, const void *b)
{
    const ritz_dmig_term *left = a;
    const ritz_dmig_term *right = b;
    int order = ritz_dof_compare(&left->col, &right->col);

    if (!order)
        order = ritz_dof_compare(&left->row, &right->row);
    return order ? order : ritz_ascending_index(&left->line, &right->line);
}

/* Terms of a symmetric matrix all to the lower triangle; sorted. */
static void sort_terms(const ritz_dmig_header *owner, ritz_dmig_cards *all)
{
    for (int64_t k = 0; k < all->num_terms; k++) {
        ritz_dmig_term *one = &all->term[k];
        ritz_dof row = one->row;

        if (owner->form != RITZ_DMIG_SYMMETRIC ||
            ritz_dof_compare(&one->row, &one->col) >= 0)
            continue;
        one->row = one->col;
        one->col = row;
    }
    if (all->num_terms > 1)
        qsort(all->term, (size_t)all->num_terms, sizeof *all->term,
              compare_terms);
}

/* No place is given twice, and a symmetric one gives one triangle. */
static ritz_status check_terms(const ritz_dmig_header *owner,
                               const ritz_dmig_cards *all)
{
    char row[RITZ_DOF_NAME_SIZE];
    char col[RITZ_DOF_NAME_SIZE];

    for (int64_t k = 1; k < all->num_terms; k++) {
        const ritz_dmig_term *one = &all->term[k];
        const char *both = "";

        if (ritz_dof_compare(&one[-1].col, &one->col) != 0 ||
            ritz_dof_compare(&one[-1].row, &one->row) != 0)
            continue;
        if (owner->form == RITZ_DMIG_SYMMETRIC)
            both = "; a symmetric one gives one triangle only";
        return ritz_cards_refuse(&all->cards, one->line,
                                 "DMIG '%s' gives (%s, %s) twice%s",
                                 owner->name, ritz_dof_name(one->row, row),
                                 ritz_dof_name(one->col, col), both);
    }
    if (owner->count == 0 && all->cards.num_skipped > 0)
        return ritz_cards_refuse(&all->cards, owner->line,
                                 "DMIG '%s' has no columns here, and "
                                 "INCLUDE is not followed without a folder",
                                 owner->name);
    return RITZ_OK;
}

/* The deck: its headers, and the terms of the matrix that is wanted. */
static ritz_status take_deck(const ritz_foreign *file, ritz_dmig_cards *all)
{
    RITZ_CHECK(ritz_cards_parse(NULL, file->bytes, file->size, file->folder,
                                &all->cards));
    RITZ_CHECK(take_cards(all, true));
    RITZ_CHECK(sort_headers(all));
    return take_cards(all, false);
}

/* Sizes follow from the columns: headers do not state them. */
static ritz_status list_file(const ritz_foreign *file, ritz_listing *out)
{
    RITZ_OWN(ritz_dmig_cards) all = {.wanted = -1};

    RITZ_CHECK(take_deck(file, &all));
    RITZ_REFUSE_IF(all.num_headers == 0, RITZ_ERR_FORMAT,
                   "there is no DMIG card in the bulk data");
    qsort(all.header, (size_t)all.num_headers, sizeof *all.header,
          ritz_ascending_index); /* into the order of the file */
    for (int64_t k = 0; k < all.num_headers; k++) {
        const ritz_dmig_header *header = &all.header[k];
        ritz_listed item = {.nrow = -1,
                            .ncol = -1,
                            .symmetric = header->form == RITZ_DMIG_SYMMETRIC,
                            .is_complex = header->complex,
                            .at = header->line};

        memcpy(item.name, header->name, sizeof item.name);
        RITZ_CHECK(ritz_listing_add(out, &item));
    }
    return RITZ_OK;
}

/* The header that was listed; NULL: a mapped file has lost it since. */
static const ritz_dmig_header *find_header(const ritz_dmig_cards *all,
                                           const ritz_listed *which)
{
    for (int64_t k = 0; k < all->num_headers; k++)
        if (all->header[k].line == which->at &&
            strcmp(all->header[k].name, which->name) == 0)
            return &all->header[k];
    return NULL;
}

static ritz_status read_matrix(const ritz_foreign *file,
                               const ritz_listed *which, ritz_matrix *out)
{
    RITZ_OWN(ritz_dmig_cards) all = {.wanted = which->at};
    const ritz_dmig_header *header = NULL;

    RITZ_CHECK(take_deck(file, &all));
    header = find_header(&all, which);
    RITZ_REFUSE_IF(!header, RITZ_ERR_FORMAT, "DMIG '%s' has lost its header",
                   which->name);
    sort_terms(header, &all);
    RITZ_CHECK(check_terms(header, &all));
    return make_matrix(header, all.term, out);
}

/* A line must begin with the word DMIG, in any case. */
static bool recognise_dmig(const char *bytes, int64_t size)
{
    ritz_lines text = {.at = bytes, .end = bytes + size};

    while (ritz_lines_next(&text))
        if (text.line_end - text.line > 4 && text.line[4] &&
            strncasecmp(text.line, "DMIG", 4) == 0 &&
            strchr(" *,\t", text.line[4]))
            return true;
    return false;
}

const ritz_format ritz_format_dmig = {
    .name = "dmig",
    .summary = "NASTRAN DMIG cards, in bulk data or a punch file",
    .reference = "Nastran1986",
    .recognise = recognise_dmig,
    .maps = true,
    .list = list_file,
    .read = read_matrix,
};
