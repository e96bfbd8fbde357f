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
 * ascending; rectangular ones have the rows and the columns that occur.
 *
 * INCLUDE is not followed, as the matrix' text alone is given here: a matrix
 * whose columns would have to come from elsewhere is refused.
 *
 * [Nastran1986], entry DMIG.
 */
#include "formats/cards.h"

#include "base/alloc.h"

#include <ritz/foreign.h>

#include <ctype.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>

enum { FORM_SQUARE = 1, FORM_WIDE = 2, FORM_SYMMETRIC = 6, FORM_COLUMNS = 9 };

/* What a header says. */
typedef struct header {
    char name[RITZ_NAME_SIZE];
    int64_t line; /* in the deck */
    int64_t form;
    bool complex, polar;
    int64_t digits;
    int64_t first, count; /* its terms, once sorted */
    int64_t rank;         /* place in the file */
} header;

/* A(row, col) = re + i im, as a column card gives it. */
typedef struct term {
    ritz_dof row, col;
    double re, im;
    int64_t line;
    int64_t matrix; /* index of the header */
} term;

typedef struct cards {
    ritz_deck deck;
    int64_t num_headers, headers_room;
    int64_t num_terms, terms_room;
    header *header; /* sorted by name once complete */
    term *term;
} cards;

static int compare_whole(int64_t a, int64_t b)
{
    return (a > b) - (a < b);
}

static int compare_dofs(const void *a, const void *b)
{
    const ritz_dof *left = a;
    const ritz_dof *right = b;
    int order = (left->grid > right->grid) - (left->grid < right->grid);

    return order ? order
                 : (left->component > right->component) -
                       (left->component < right->component);
}

/* By matrix, then column, then row, then line. */
static int compare_terms(const void *a, const void *b)
{
    const term *left = a;
    const term *right = b;
    int order = compare_whole(left->matrix, right->matrix);

    if (!order)
        order = compare_dofs(&left->col, &right->col);
    if (!order)
        order = compare_dofs(&left->row, &right->row);
    return order ? order : compare_whole(left->line, right->line);
}

static int compare_names(const void *a, const void *b)
{
    const header *left = a;
    const header *right = b;

    return strcmp(left->name, right->name);
}

static int compare_ranks(const void *a, const void *b)
{
    const header *left = a;
    const header *right = b;

    return compare_whole(left->rank, right->rank);
}

/* ---- reading ----------------------------------------------------------- */

static ritz_status take_name(const ritz_card *card, char out[RITZ_NAME_SIZE])
{
    const char *name = ritz_card_text(card, 0);
    size_t k = 0;

    if (!isalpha((unsigned char)*name))
        return ritz_card_refuse(card, 0, "the name of a matrix");
    for (; name[k]; k++) {
        if (iscntrl((unsigned char)name[k]) || name[k] == '/')
            return ritz_card_refuse(card, 0, "the name of a matrix");
        out[k] = (char)toupper((unsigned char)name[k]);
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

static ritz_status add_header(cards *all, const ritz_card *card)
{
    ritz_status status = RITZ_OK;
    header new = {.line = card->entry->line, .rank = all->num_headers};
    int64_t type = 0;
    int64_t polar = 0;

    RITZ_TRY(take_name(card, new.name));
    RITZ_TRY(ritz_card_whole(card, 2, 0, &new.form));
    RITZ_TRY(ritz_card_whole(card, 3, 0, &type));
    RITZ_TRY(ritz_card_whole(card, 5, 0, &polar));
    if (new.form != FORM_SQUARE &&new.form != FORM_WIDE &&new.form !=
        FORM_SYMMETRIC &&new.form != FORM_COLUMNS)
        RITZ_TRY(ritz_card_refuse(card, 2, "a form: 1, 2, 6 or 9"));
    if (type < 1 || type > 4)
        RITZ_TRY(ritz_card_refuse(card, 3, "a type: 1, 2, 3 or 4"));
    if (polar != 0 && polar != 1)
        RITZ_TRY(ritz_card_refuse(card, 5, "0 or 1 for POLAR"));
    new.complex = type > 2;
    new.polar = polar == 1;
    RITZ_ROOM(all->header, all->num_headers, all->headers_room);
    all->header[all->num_headers++] = new;
done:
    return status;
}

static ritz_status sort_headers(cards *all)
{
    ritz_status status = RITZ_OK;

    if (all->num_headers > 1)
        qsort(all->header, (size_t)all->num_headers, sizeof *all->header,
              compare_names);
    for (int64_t k = 1; k < all->num_headers; k++)
        if (compare_names(&all->header[k - 1], &all->header[k]) == 0)
            RITZ_TRY(ritz_deck_refuse(&all->deck, all->header[k].line,
                                      "DMIG '%s' has a second header",
                                      all->header[k].name));
done:
    return status;
}

static ritz_status take_dof(const ritz_card *card, int64_t k, ritz_dof *out)
{
    ritz_status status = RITZ_OK;

    RITZ_TRY(ritz_card_id(card, k, &out->grid));
    RITZ_TRY(ritz_card_whole(card, k + 1, 0, &out->component));
    if (out->component < 0 || out->component > 6)
        RITZ_TRY(ritz_card_refuse(card, k + 1, "a direction, 0 to 6"));
done:
    return status;
}

static bool is_empty_group(const ritz_card *card, int64_t k)
{
    for (int64_t j = k; j < k + 4; j++)
        if (*ritz_card_text(card, j))
            return false;
    return true;
}

/* G C A B at field k. */
static ritz_status add_term(cards *all, header *owner, const ritz_card *card,
                            int64_t k, ritz_dof col)
{
    static const double RADIANS = 3.14159265358979323846 / 180.0;
    ritz_status status = RITZ_OK;
    term new = {.col = col, .matrix = owner - all->header};
    double a = 0.0;
    double b = 0.0;
    int64_t digits = 0;

    RITZ_TRY(take_dof(card, k, &new.row));
    RITZ_TRY(ritz_card_real(card, k + 2, 0.0, &a));
    RITZ_TRY(ritz_card_real(card, k + 3, 0.0, &b));
    if (!owner->complex && b != 0.0)
        RITZ_TRY(
            ritz_card_refuse(card, k + 3, "blank, as it is in a real matrix"));
    new.line = card->field[k].line;
    new.re = owner->polar ? a *cos(b * RADIANS) : a;
    new.im = owner->polar ? a *sin(b * RADIANS) : b;
    for (int64_t j = k + 2; j < k + 4; j++) {
        digits = ritz_card_digits(ritz_card_text(card, j));
        if (digits > owner->digits)
            owner->digits = digits;
    }
    RITZ_ROOM(all->term, all->num_terms, all->terms_room);
    all->term[all->num_terms++] = new;
    owner->count++;
done:
    return status;
}

static ritz_status add_column(cards *all, const ritz_card *card)
{
    ritz_status status = RITZ_OK;
    header wanted = {0};
    header *owner = NULL;
    ritz_dof col = {0};

    RITZ_TRY(take_name(card, wanted.name));
    if (all->num_headers > 0)
        owner = bsearch(&wanted, all->header, (size_t)all->num_headers,
                        sizeof wanted, compare_names);
    if (!owner) {
        status = ritz_deck_refuse(&all->deck, card->entry->line,
                                  "DMIG '%s' has no header", wanted.name);
        goto done;
    }
    RITZ_TRY(take_dof(card, 1, &col));
    for (int64_t k = 4; k < card->count; k += 4)
        if (!is_empty_group(card, k))
            RITZ_TRY(add_term(all, owner, card, k, col));
done:
    return status;
}

/* Go through the DMIG cards: headers first, as they may follow columns. */
static ritz_status walk(cards *all, bool headers)
{
    ritz_status status = RITZ_OK;
    ritz_card card = {0};

    for (int64_t k = 0; k < all->deck.num_entries; k++) {
        if (strcmp(all->deck.entry[k].name, "DMIG") != 0)
            continue;
        RITZ_TRY(ritz_deck_card(&all->deck, k, &card));
        if (is_header(&card) != headers)
            continue;
        if (headers)
            RITZ_TRY(add_header(all, &card));
        else
            RITZ_TRY(add_column(all, &card));
    }
done:
    ritz_card_free(&card);
    return status;
}

/* ---- what the terms must be -------------------------------------------- */

static void swap_to_lower(term *one)
{
    ritz_dof row = one->row;

    if (compare_dofs(&one->row, &one->col) < 0) {
        one->row = one->col;
        one->col = row;
    }
}

/* Terms of symmetric matrices all to the lower triangle; by matrix, sorted. */
static void sort_terms(cards *all)
{
    int64_t first = 0;

    for (int64_t k = 0; k < all->num_terms; k++)
        if (all->header[all->term[k].matrix].form == FORM_SYMMETRIC)
            swap_to_lower(&all->term[k]);
    if (all->num_terms > 1)
        qsort(all->term, (size_t)all->num_terms, sizeof *all->term,
              compare_terms);
    for (int64_t k = 0; k < all->num_headers; k++) {
        all->header[k].first = first;
        first += all->header[k].count;
    }
}

/* No place is given twice, and symmetric ones give one triangle of each. */
static ritz_status check_terms(const cards *all)
{
    ritz_status status = RITZ_OK;
    char row[RITZ_DOF_NAME_SIZE];
    char col[RITZ_DOF_NAME_SIZE];

    for (int64_t k = 1; k < all->num_terms; k++) {
        const term *one = &all->term[k];
        const header *owner = &all->header[one->matrix];
        const char *both = "";

        if (one[-1].matrix != one->matrix ||
            compare_dofs(&one[-1].col, &one->col) != 0 ||
            compare_dofs(&one[-1].row, &one->row) != 0)
            continue;
        if (owner->form == FORM_SYMMETRIC)
            both = "; a symmetric one gives one triangle only";
        RITZ_TRY(ritz_deck_refuse(&all->deck, one->line,
                                  "DMIG '%s' gives (%s, %s) twice%s",
                                  owner->name, ritz_dof_name(one->row, row),
                                  ritz_dof_name(one->col, col), both));
    }
    for (int64_t k = 0; k < all->num_headers; k++)
        if (all->header[k].count == 0 && all->deck.num_skipped > 0)
            RITZ_TRY(ritz_deck_refuse(&all->deck, all->header[k].line,
                                      "DMIG '%s' has no columns here, and "
                                      "INCLUDE is not followed for matrices",
                                      all->header[k].name));
done:
    return status;
}

/* ---- matrices ---------------------------------------------------------- */

/* The distinct dofs of a list, ascending. */
static int64_t distinct(int64_t count, ritz_dof *dof)
{
    int64_t kept = 0;

    if (count > 1)
        qsort(dof, (size_t)count, sizeof *dof, compare_dofs);
    for (int64_t k = 0; k < count; k++)
        if (kept == 0 || compare_dofs(&dof[kept - 1], &dof[k]) != 0)
            dof[kept++] = dof[k];
    return kept;
}

static ritz_status collect(const term *terms, int64_t count, bool rows,
                           bool cols, int64_t *found, ritz_dof **out)
{
    ritz_status status = RITZ_OK;
    ritz_dof *dof = NULL;
    int64_t n = 0;

    RITZ_NEW(dof, 2 * count);
    for (int64_t k = 0; k < count; k++) {
        if (rows)
            dof[n++] = terms[k].row;
        if (cols)
            dof[n++] = terms[k].col;
    }
    *found = distinct(n, dof);
    *out = dof;
done:
    return status;
}

static int64_t position(ritz_dof wanted, int64_t count, const ritz_dof *dof)
{
    const ritz_dof *found =
        bsearch(&wanted, dof, (size_t)count, sizeof wanted, compare_dofs);

    return found - dof;
}

/* Triplets of a matrix, both triangles where one is given. */
typedef struct triplets {
    int64_t count;
    int64_t *row, *col;
    double *re, *im;
} triplets;

static void put(triplets *list, int64_t row, int64_t col, const term *one)
{
    list->row[list->count] = row;
    list->col[list->count] = col;
    list->re[list->count] = one->re;
    list->im[list->count++] = one->im;
}

static ritz_status make_triplets(const header *owner, const term *terms,
                                 int64_t nrow, const ritz_dof *row,
                                 int64_t ncol, const ritz_dof *col,
                                 triplets *out)
{
    ritz_status status = RITZ_OK;

    RITZ_NEW(out->row, 2 * owner->count);
    RITZ_NEW(out->col, 2 * owner->count);
    RITZ_NEW(out->re, 2 * owner->count);
    RITZ_NEW(out->im, 2 * owner->count);
    for (int64_t k = 0; k < owner->count; k++) {
        int64_t i = position(terms[k].row, nrow, row);
        int64_t j = position(terms[k].col, ncol, col);

        put(out, i, j, &terms[k]);
        if (owner->form == FORM_SYMMETRIC && i != j)
            put(out, j, i, &terms[k]);
    }
done:
    return status;
}

static ritz_status make_values(const triplets *list, int64_t nrow, int64_t ncol,
                               bool complex, ritz_matrix *out)
{
    ritz_status status = RITZ_OK;
    ritz_sparse second = {0};

    RITZ_TRY(ritz_sparse_from_triplets(nrow, ncol, list->count, list->row,
                                       list->col, list->re, &out->A));
    if (!complex)
        goto done;
    RITZ_TRY(ritz_sparse_from_triplets(nrow, ncol, list->count, list->row,
                                       list->col, list->im, &second));
    out->imaginary = second.val; /* no place occurs twice: one pattern */
    second.val = NULL;
done:
    ritz_sparse_free(&second);
    return status;
}

static ritz_status make_matrix(const header *owner, const term *terms,
                               ritz_matrix *out)
{
    ritz_status status = RITZ_OK;
    bool square = owner->form == FORM_SQUARE || owner->form == FORM_SYMMETRIC;
    ritz_matrix new = {.symmetric = owner->form == FORM_SYMMETRIC,
                       .digits = owner->digits};
    triplets list = {0};
    int64_t nrow = 0;
    int64_t ncol = 0;

    memcpy(new.name, owner->name, sizeof new.name);
    snprintf(new.spelling, sizeof new.spelling, "DMIG, form %d%s%s",
             (int)owner->form, owner->complex ? ", complex" : "",
             owner->polar ? ", polar" : "");
    RITZ_TRY(collect(terms, owner->count, true, square, &nrow, &new.row));
    ncol = nrow;
    if (!square)
        RITZ_TRY(collect(terms, owner->count, false, true, &ncol, &new.col));
    RITZ_TRY(make_triplets(owner, terms, nrow, new.row, ncol,
                           square ? new.row : new.col, &list));
    RITZ_TRY(make_values(&list, nrow, ncol, owner->complex, &new));
    *out = new;
    new = (ritz_matrix){0};
done:
    free(list.row);
    free(list.col);
    free(list.re);
    free(list.im);
    ritz_matrix_free(&new);
    return status;
}

/* ---- the format -------------------------------------------------------- */

static ritz_status read_dmig(const char *bytes, int64_t size,
                             ritz_matrices *out)
{
    ritz_status status = RITZ_OK;
    cards all = {0};
    ritz_matrices new = {0};

    RITZ_TRY(ritz_deck_parse(NULL, bytes, size, NULL, &all.deck));
    RITZ_TRY(walk(&all, true));
    RITZ_TRY(sort_headers(&all));
    RITZ_TRY(walk(&all, false));
    RITZ_FAIL_IF(all.num_headers == 0, RITZ_ERR_FORMAT,
                 "there is no DMIG card in the bulk data");
    sort_terms(&all);
    RITZ_TRY(check_terms(&all));
    qsort(all.header, (size_t)all.num_headers, sizeof *all.header,
          compare_ranks);
    RITZ_NEW(new.matrix, all.num_headers);
    for (; new.count < all.num_headers; new.count++)
        RITZ_TRY(make_matrix(&all.header[new.count],
                             all.term + all.header[new.count].first,
                             &new.matrix[new.count]));
    snprintf(new.format, sizeof new.format, "%s", ritz_format_dmig.name);
    *out = new;
    new = (ritz_matrices){0};
done:
    ritz_deck_free(&all.deck);
    free(all.header);
    free(all.term);
    ritz_matrices_free(&new);
    return status;
}

/* Whether a line begins with DMIG, in any case, as a word. */
static bool is_dmig(const char *line, int64_t length)
{
    static const char WORD[] = "DMIG";
    int64_t k = 0;

    for (; WORD[k]; k++)
        if (k == length || toupper((unsigned char)line[k]) != WORD[k])
            return false;
    return k < length && strchr(" *,\t", line[k]) && line[k];
}

static bool recognise_dmig(const char *bytes, int64_t size)
{
    const char *at = bytes;
    const char *end = bytes + size;

    while (at < end) {
        if (is_dmig(at, end - at))
            return true;
        at = memchr(at, '\n', (size_t)(end - at));
        if (!at)
            return false;
        at++;
    }
    return false;
}

const ritz_format ritz_format_dmig = {
    .name = "dmig",
    .summary = "NASTRAN DMIG cards, in bulk data or a punch file",
    .reference = "Nastran1986",
    .recognise = recognise_dmig,
    .read = read_dmig,
};
