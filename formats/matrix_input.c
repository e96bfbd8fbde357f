/*
 * Matrices in the text that *MATRIX INPUT takes: Abaqus writes it by *MATRIX
 * OUTPUT, FORMAT=MATRIX INPUT, and CalculiX by *SUBSTRUCTURE MATRIX OUTPUT,
 * OUTPUT FILE=MATRIX.
 *
 *     *MATRIX INPUT, NAME=K, TYPE=SYMMETRIC, SCALE FACTOR=s
 *     101,1, 101,1, 9.89e+01             node, direction of the row and of the
 *     101,2, 101,1, 3.57e+01             column, value
 *
 * Programs write the lines without the keyword, which makes one matrix without
 * a name. Rows are the dofs that occur, ascending.
 *
 * A symmetric matrix is given by one triangle or by both. The order of nodes in
 * the solver decides what a triangle is, so that one is one if no entry has a
 * counterpart across the diagonal. If all have one, both triangles are given. A
 * mixture is refused: the entries without a counterpart may be zero there or
 * equal. TYPE=UNSYMMETRIC says that they are zero.
 *
 * [Abaqus2016], *MATRIX INPUT and *MATRIX OUTPUT; [Dhondt2022], *SUBSTRUCTURE
 * MATRIX OUTPUT and *MATRIX ASSEMBLE.
 */
#include "base/alloc.h"
#include "base/search.h"
#include "formats/abaqus.h"
#include "formats/matrix.h"

#include <ritz/import.h>

#include <ctype.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>

enum { FIELDS = 5 }; /* of a line of data */

/* What TYPE says. */
enum {
    RITZ_INPUT_UNTYPED, /* there is no keyword */
    RITZ_INPUT_SYMMETRIC,
    RITZ_INPUT_UNSYMMETRIC,
};

/* An entry: rows are keys first, then counted from 0. */
typedef struct ritz_input_term {
    int64_t row, col; /* once counted, of the lower triangle */
    double value;
    int64_t line;
    bool flipped; /* it stood in the upper triangle */
} ritz_input_term;

typedef struct ritz_matrix_input {
    ritz_lines text;
    int64_t wanted;  /* line of the keyword of the matrix that is read; 0: it
                        has none; -1: no matrix is read */
    bool found;      /* it was read, as the last one */
    int64_t refused; /* line that a refusal names; 0: the line taken last */
    char name[RITZ_NAME_SIZE]; /* what the last keyword says, and its line */
    int type;
    double scale;
    int64_t line;
    int64_t count, room;
    ritz_input_term *term;
    int64_t digits;
} ritz_matrix_input;

static void ritz_matrix_input_free(ritz_matrix_input *m)
{
    free(m->term);
}

/* ---- keywords and lines of data ------------------------------------------ */

static ritz_status take_type(const ritz_comma_field *value, int *out)
{
    bool symmetric = ritz_abaqus_spells(value, "SYMMETRIC");

    RITZ_REFUSE_IF(!symmetric && !ritz_abaqus_spells(value, "UNSYMMETRIC"),
                   RITZ_ERR_FORMAT,
                   "TYPE of *MATRIX INPUT is neither SYMMETRIC nor UNSYMMETRIC "
                   "but '%.*s'",
                   ritz_abaqus_quoted(value), value->at);
    *out = symmetric ? RITZ_INPUT_SYMMETRIC : RITZ_INPUT_UNSYMMETRIC;
    return RITZ_OK;
}

static ritz_status take_parameter(ritz_matrix_input *m, ritz_comma_field field)
{
    const ritz_comma_field value = ritz_abaqus_value(&field);
    int64_t digits = 0;

    if (ritz_abaqus_spells(&field, "NAME"))
        return ritz_abaqus_name(&value, m->name);
    if (ritz_abaqus_spells(&field, "TYPE"))
        return take_type(&value, &m->type);
    if (ritz_abaqus_spells(&field, "SCALE FACTOR")) {
        RITZ_CHECK(ritz_abaqus_real(&value, &digits, &m->scale));
        RITZ_REFUSE_IF(m->scale == 0.0, RITZ_ERR_FORMAT,
                       "SCALE FACTOR of *MATRIX INPUT is 0");
        return RITZ_OK;
    }
    RITZ_REFUSE_IF(ritz_abaqus_spells(&field, "INPUT"), RITZ_ERR_FORMAT,
                   "the entries are in another file, '%.*s': give that one",
                   ritz_abaqus_quoted(&value), value.at);
    return ritz_fail(RITZ_ERR_FORMAT, "'%.*s' of *MATRIX INPUT is not read",
                     ritz_abaqus_quoted(&field), field.at);
}

/* The keyword line that was taken last. */
static ritz_status read_keyword(ritz_matrix_input *m)
{
    const char *at = m->text.line + 1; /* behind the star */
    const char *end = m->text.line_end;
    ritz_comma_field field = {at, at};

    (void)ritz_abaqus_field(&at, end, &field); /* "*" alone has none */
    RITZ_REFUSE_IF(!ritz_abaqus_spells(&field, "MATRIX INPUT"), RITZ_ERR_FORMAT,
                   "'*%.*s' is not *MATRIX INPUT", ritz_abaqus_quoted(&field),
                   field.at);
    m->line = m->text.number;
    m->name[0] = '\0';
    m->type = RITZ_INPUT_SYMMETRIC;
    m->scale = 1.0;
    while (ritz_abaqus_field(&at, end, &field))
        RITZ_CHECK(take_parameter(m, field));
    RITZ_REFUSE_IF(!m->name[0], RITZ_ERR_FORMAT, "*MATRIX INPUT has no NAME");
    return RITZ_OK;
}

/* Numbers that ascend as dofs do, by node and then direction. A node has at
 * most 18 digits. */
static int64_t key_of_dof(int64_t node, int64_t direction)
{
    return 8 * node + direction;
}

static ritz_dof dof_of_key(int64_t key)
{
    return (ritz_dof){key / 8, key % 8};
}

static ritz_status take_dof(const ritz_comma_field field[2], int64_t *key)
{
    int64_t node = 0;
    int64_t direction = 0;

    RITZ_CHECK(ritz_abaqus_whole(&field[0], &node));
    RITZ_CHECK(ritz_abaqus_whole(&field[1], &direction));
    RITZ_CHECK(ritz_abaqus_check_node(node));
    RITZ_CHECK(ritz_abaqus_check_direction(direction));
    *key = key_of_dof(node, direction);
    return RITZ_OK;
}

/* Split a line into its five fields; false if it has more or fewer. */
static bool split_line(const ritz_lines *text, ritz_comma_field field[FIELDS])
{
    const char *at = text->line;
    int count = 0;

    while (count < FIELDS &&
           ritz_abaqus_field(&at, text->line_end, &field[count]))
        count++;
    return count == FIELDS && at == text->line_end;
}

static ritz_status read_term(ritz_matrix_input *m)
{
    ritz_comma_field field[FIELDS] = {0};
    ritz_input_term term = {.line = m->text.number};

    RITZ_REFUSE_IF(!split_line(&m->text, field), RITZ_ERR_FORMAT,
                   "'%.*s' is not 'node, direction, node, direction, value'",
                   ritz_lines_quoted(m->text.line, m->text.line_end),
                   m->text.line);
    RITZ_CHECK(take_dof(&field[0], &term.row));
    RITZ_CHECK(take_dof(&field[2], &term.col));
    RITZ_CHECK(ritz_abaqus_real(&field[4], &m->digits, &term.value));
    term.value *= m->scale;
    RITZ_REFUSE_IF(!isfinite(term.value), RITZ_ERR_FORMAT,
                   "the value times SCALE FACTOR is not finite");
    RITZ_CHECK_ROOM(m->term, m->count, m->room);
    m->term[m->count++] = term;
    return RITZ_OK;
}

/* The lines of one matrix, which are left unread unless it is wanted. */
static ritz_status read_terms(ritz_matrix_input *m, ritz_listing *listing)
{
    ritz_listed item = {.nrow = -1,
                        .ncol = -1,
                        .symmetric = m->type == RITZ_INPUT_SYMMETRIC,
                        .at = m->line};

    m->found = m->line == m->wanted;
    while (ritz_abaqus_next_data(&m->text))
        if (m->found)
            RITZ_CHECK(read_term(m));
    RITZ_REFUSE_IF(m->found && m->count == 0, RITZ_ERR_FORMAT,
                   "*MATRIX INPUT of '%s' is followed by no entry", m->name);
    memcpy(item.name, m->name, sizeof item.name);
    return listing ? ritz_listing_add(listing, &item) : RITZ_OK;
}

/* All matrices of the file for its list, or those up to the one wanted. */
static ritz_status read_file(ritz_matrix_input *m, ritz_listing *listing)
{
    ritz_lines ahead = m->text;

    m->scale = 1.0;
    if (ritz_abaqus_next_data(&ahead))
        RITZ_CHECK(read_terms(m, listing));
    while (!m->found && ritz_abaqus_next_stated(&m->text)) {
        RITZ_CHECK(read_keyword(m));
        RITZ_CHECK(read_terms(m, listing));
    }
    return RITZ_OK;
}

/* Put the line before the sentence of a failure. */
static ritz_status add_line(const ritz_matrix_input *m, ritz_status status)
{
    return ritz_abaqus_in_line(status,
                               m->refused > 0 ? m->refused : m->text.number);
}

/* ---- entries to columns -------------------------------------------------- */

/* Keys of the rows, ascending. */
static ritz_status collect_rows(const ritz_matrix_input *m, int64_t *count,
                                int64_t **out)
{
    int64_t *key = NULL;
    int64_t all = 0;
    int64_t kept = 0;

    RITZ_CHECK_NEW(key, 2 * m->count);
    for (int64_t k = 0; k < m->count; k++) {
        key[all++] = m->term[k].row;
        if (k == 0 || m->term[k].col != m->term[k - 1].col)
            key[all++] = m->term[k].col;
    }
    qsort(key, (size_t)all, sizeof *key, ritz_ascending_index);
    for (int64_t k = 0; k < all; k++)
        if (kept == 0 || key[k] != key[kept - 1])
            key[kept++] = key[k];
    *count = kept;
    *out = key;
    return RITZ_OK;
}

/* By column, row and line. */
static int compare_terms(const void *left, const void *right)
{
    const ritz_input_term *a = left;
    const ritz_input_term *b = right;
    int order = ritz_ascending_index(&a->col, &b->col);

    if (!order)
        order = ritz_ascending_index(&a->row, &b->row);
    return order ? order : ritz_ascending_index(&a->line, &b->line);
}

/* Count the rows of entries, turn all to the lower triangle, and sort. */
static void sort_terms(ritz_matrix_input *m, int64_t n, const int64_t *key)
{
    bool sorted = true;

    for (int64_t k = 0; k < m->count; k++) {
        ritz_input_term *t = &m->term[k];
        int64_t i = ritz_search(n, key, t->row);
        int64_t j = ritz_search(n, key, t->col);

        t->flipped = i < j;
        t->row = t->flipped ? j : i;
        t->col = t->flipped ? i : j;
        sorted = sorted && (k == 0 || compare_terms(t - 1, t) <= 0);
    }
    if (!sorted)
        qsort(m->term, (size_t)m->count, sizeof *m->term, compare_terms);
}

static ritz_status refuse_term(ritz_matrix_input *m, const int64_t *key,
                               const ritz_input_term *t, const char *what)
{
    char row[RITZ_DOF_NAME_SIZE];
    char col[RITZ_DOF_NAME_SIZE];

    ritz_dof_name(dof_of_key(key[t->flipped ? t->col : t->row]), row);
    ritz_dof_name(dof_of_key(key[t->flipped ? t->row : t->col]), col);
    m->refused = t->line;
    return ritz_fail(RITZ_ERR_FORMAT, "entry (%s, %s) %s", row, col, what);
}

/* Whether both triangles are given; that nothing is given twice, and that
 * triangles agree. */
static ritz_status check_triangles(ritz_matrix_input *m, const int64_t *key,
                                   bool *both)
{
    const ritz_input_term *single = NULL; /* has no counterpart */

    *both = m->type == RITZ_INPUT_UNSYMMETRIC;
    for (int64_t k = 0; k < m->count; k++) {
        const ritz_input_term *t = &m->term[k];
        const ritz_input_term *next = k + 1 < m->count ? t + 1 : NULL;

        if (!next || next->col != t->col || next->row != t->row) {
            if (!single && t->row != t->col && t->value != 0.0)
                single = t;
            continue;
        }
        if (next->flipped == t->flipped ||
            (k + 2 < m->count && t[2].col == t->col && t[2].row == t->row))
            return refuse_term(m, key,
                               next->flipped == t->flipped ? next : t + 2,
                               "is given twice");
        if (m->type == RITZ_INPUT_SYMMETRIC && next->value != t->value)
            return refuse_term(m, key, next,
                               "differs from its counterpart, though the "
                               "matrix is symmetric");
        *both = true;
        k++; /* the counterpart */
    }
    if (*both && single && m->type != RITZ_INPUT_UNSYMMETRIC)
        return refuse_term(m, key, single,
                           "has no counterpart across the diagonal, as others "
                           "have: say of an unsymmetric matrix '*MATRIX "
                           "INPUT, NAME=..., TYPE=UNSYMMETRIC' before it");
    return RITZ_OK;
}

/* The matrix of the sorted entries. */
static ritz_status compress_terms(const ritz_matrix_input *m, int64_t n,
                                  bool both, ritz_matrix *out)
{
    RITZ_OWN(ritz_triplets) list = {0};

    RITZ_CHECK(ritz_triplets_reserve(&list, m->count));
    for (int64_t k = 0; k < m->count; k++) {
        const ritz_input_term *t = &m->term[k];
        bool above = both && t->flipped;

        ritz_triplets_put_value(&list, above ? t->col : t->row,
                                above ? t->row : t->col, t->value, 0.0);
    }
    RITZ_CHECK(ritz_triplets_compress(&list, n, n, out));
    return both ? RITZ_OK : ritz_matrix_mirror(out, 1.0, 1.0);
}

static ritz_status make_matrix(ritz_matrix_input *m, ritz_matrix *out)
{
    RITZ_OWN(ritz_matrix) new = {0};
    RITZ_OWN_ARRAY int64_t *key = NULL;
    int64_t n = 0;
    bool both = false;

    RITZ_CHECK(collect_rows(m, &n, &key));
    sort_terms(m, n, key);
    RITZ_CHECK(check_triangles(m, key, &both));
    RITZ_CHECK(compress_terms(m, n, both, &new));
    RITZ_CHECK_NEW(new.row, n);
    for (int64_t i = 0; i < n; i++)
        new.row[i] = dof_of_key(key[i]);
    memcpy(new.name, m->name, sizeof new.name);
    new.symmetric = !both || m->type == RITZ_INPUT_SYMMETRIC;
    new.digits = m->digits < 1 ? 1 : m->digits > 17 ? 17 : m->digits;
    snprintf(new.spelling, sizeof new.spelling, "MATRIX INPUT, %s",
             both ? "both triangles" : "one triangle");
    RITZ_MOVE(*out, new);
    return RITZ_OK;
}

/* ---- the format ---------------------------------------------------------- */

static ritz_status list_file(const ritz_foreign *file, ritz_listing *out)
{
    RITZ_OWN(ritz_matrix_input)
    m = {.text = ritz_abaqus_lines(file->bytes, file->size), .wanted = -1};

    return add_line(&m, read_file(&m, out));
}

static ritz_status read_matrix(const ritz_foreign *file,
                               const ritz_listed *which, ritz_matrix *out)
{
    RITZ_OWN(ritz_matrix_input)
    m = {.text = ritz_abaqus_lines(file->bytes, file->size),
         .wanted = which->at};

    RITZ_CHECK(add_line(&m, read_file(&m, NULL)));
    RITZ_REFUSE_IF(!m.found, RITZ_ERR_FORMAT,
                   "the matrix '%s' is no longer there", which->name);
    return add_line(&m, make_matrix(&m, out));
}

/* A value with a point, an exponent or letters: five whole numbers could be an
 * element and its nodes. */
static bool is_value(const ritz_comma_field *field)
{
    ritz_decimal number = {0};
    const char *at = field->at;
    bool real = false;

    for (const char *c = at; c < field->end; c++)
        real = real || *c == '.' || isalpha((unsigned char)*c);
    return real && ritz_decimal_scan(&at, field->end, &number) &&
           at == field->end;
}

/* The first line that is no comment is the keyword, or an entry. */
static bool recognise_input(const char *bytes, int64_t size)
{
    ritz_lines text = ritz_abaqus_lines(bytes, size);
    ritz_comma_field field[FIELDS] = {0};
    const char *at = NULL;
    int64_t number = 0;

    if (!ritz_abaqus_next_stated(&text))
        return false;
    if (ritz_abaqus_is_keyword(&text)) {
        at = text.line + 1;
        return ritz_abaqus_field(&at, text.line_end, &field[0]) &&
               ritz_abaqus_spells(&field[0], "MATRIX INPUT");
    }
    if (!split_line(&text, field))
        return false;
    for (int k = 0; k < FIELDS - 1; k++) {
        at = field[k].at;
        if (!ritz_decimal_scan_whole(&at, field[k].end, &number) ||
            at < field[k].end)
            return false;
    }
    return is_value(&field[FIELDS - 1]);
}

const ritz_format ritz_format_matrix_input = {
    .name = "matrix-input",
    .summary = "Abaqus MATRIX INPUT, also written by CalculiX",
    .reference = "Abaqus2016",
    .recognise = recognise_input,
    .maps = true,
    .list = list_file,
    .read = read_matrix,
};
