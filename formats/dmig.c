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
 * INCLUDE is followed where the file's folder is known; where it is not, a
 * matrix whose columns would have to come from elsewhere is refused.
 *
 * [Nastran1986], entry DMIG.
 */
#include "formats/dmig_parts.h"

#include "base/alloc.h"

#include <ctype.h>
#include <stdio.h>

static int compare_whole(int64_t a, int64_t b)
{
    return (a > b) - (a < b);
}

/* By matrix, then column, then row, then line. */
static int compare_terms(const void *a, const void *b)
{
    const ritz_dmig_term *left = a;
    const ritz_dmig_term *right = b;
    int order = compare_whole(left->matrix, right->matrix);

    if (!order)
        order = ritz_dof_compare(&left->col, &right->col);
    if (!order)
        order = ritz_dof_compare(&left->row, &right->row);
    return order ? order : compare_whole(left->line, right->line);
}

static int compare_ranks(const void *a, const void *b)
{
    const ritz_dmig_header *left = a;
    const ritz_dmig_header *right = b;

    return compare_whole(left->rank, right->rank);
}

static void swap_to_lower(ritz_dmig_term *one)
{
    ritz_dof row = one->row;

    if (ritz_dof_compare(&one->row, &one->col) < 0) {
        one->row = one->col;
        one->col = row;
    }
}

/* Terms of symmetric matrices all to the lower triangle; by matrix, sorted. */
static void sort_terms(ritz_dmig_cards *all)
{
    int64_t first = 0;

    for (int64_t k = 0; k < all->num_terms; k++)
        if (all->header[all->term[k].matrix].form == RITZ_DMIG_SYMMETRIC)
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
static ritz_status check_terms(const ritz_dmig_cards *all)
{
    char row[RITZ_DOF_NAME_SIZE];
    char col[RITZ_DOF_NAME_SIZE];

    for (int64_t k = 1; k < all->num_terms; k++) {
        const ritz_dmig_term *one = &all->term[k];
        const ritz_dmig_header *owner = &all->header[one->matrix];
        const char *both = "";

        if (one[-1].matrix != one->matrix ||
            ritz_dof_compare(&one[-1].col, &one->col) != 0 ||
            ritz_dof_compare(&one[-1].row, &one->row) != 0)
            continue;
        if (owner->form == RITZ_DMIG_SYMMETRIC)
            both = "; a symmetric one gives one triangle only";
        RITZ_CHECK(ritz_cards_refuse(&all->cards, one->line,
                                     "DMIG '%s' gives (%s, %s) twice%s",
                                     owner->name, ritz_dof_name(one->row, row),
                                     ritz_dof_name(one->col, col), both));
    }
    for (int64_t k = 0; k < all->num_headers; k++)
        if (all->header[k].count == 0 && all->cards.num_skipped > 0)
            RITZ_CHECK(
                ritz_cards_refuse(&all->cards, all->header[k].line,
                                  "DMIG '%s' has no columns here, and "
                                  "INCLUDE is not followed without a folder",
                                  all->header[k].name));
    return RITZ_OK;
}

static ritz_status read_dmig(const char *bytes, int64_t size,
                             const char *folder, ritz_matrices *out)
{
    ritz_status status = RITZ_OK;
    ritz_dmig_cards all = {0};
    ritz_matrices new = {0};

    RITZ_TRY(ritz_cards_parse(NULL, bytes, size, folder, &all.cards));
    RITZ_TRY(ritz_dmig_take(&all));
    RITZ_FAIL_IF(all.num_headers == 0, RITZ_ERR_FORMAT,
                 "there is no DMIG card in the bulk data");
    sort_terms(&all);
    RITZ_TRY(check_terms(&all));
    qsort(all.header, (size_t)all.num_headers, sizeof *all.header,
          compare_ranks);
    RITZ_NEW(new.matrix, all.num_headers);
    for (; new.count < all.num_headers; new.count++)
        RITZ_TRY(ritz_dmig_matrix(&all.header[new.count],
                                  all.term + all.header[new.count].first,
                                  &new.matrix[new.count]));
    snprintf(new.format, sizeof new.format, "%s", ritz_format_dmig.name);
    *out = new;
    new = (ritz_matrices){0};
done:
    ritz_cards_free(&all.cards);
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
