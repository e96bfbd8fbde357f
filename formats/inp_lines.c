/*
 * Lines of an input file: comments, keywords with their parameters, fields.
 *
 *     ** a comment
 *     *KEYWORD, KEY=VALUE, KEY,
 *     KEY=VALUE
 *     field, field, field
 *
 * A keyword that ends with a comma is continued. Case does not count, nor do
 * blanks in keywords and keys. [Abaqus2016]
 */
#include "base/alloc.h"
#include "formats/inp.h"

#include <ctype.h>
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <strings.h>

/* ---- lines --------------------------------------------------------------- */

static ritz_piece strip(const ritz_lines *text)
{
    return ritz_piece_trim(
        (ritz_piece){text->line, text->line_end - text->line});
}

bool ritz_inp_line(ritz_inp *all, ritz_piece *out)
{
    while (all->held || ritz_deck_next_line(&all->reading)) {
        all->held = false;
        *out = strip(&ritz_deck_top(&all->reading)->text);
        if (out->length > 0 &&
            !(out->length > 1 && out->text[0] == '*' && out->text[1] == '*'))
            return true;
    }
    return false;
}

static ritz_inp_place place_of_line(ritz_inp *all)
{
    const ritz_deck_text *top = ritz_deck_top(&all->reading);

    return (ritz_inp_place){top->file, top->text.number};
}

/* Letters up to the next comma that is not in quotes. */
static int64_t field_length(const char *at, const char *end)
{
    const char *from = at;
    bool quoted = false;

    for (; at < end && (quoted || *at != ','); at++)
        quoted = quoted != (*at == '"');
    return at - from;
}

ritz_status ritz_inp_split(ritz_inp *all, ritz_piece line)
{
    ritz_inp_fields *fields = &all->fields;
    const char *at = line.text;
    const char *end = line.text + line.length;

    fields->count = 0;
    fields->continues = line.length > 0 && end[-1] == ',';
    fields->place = place_of_line(all);
    while (at < end) {
        int64_t length = field_length(at, end);

        RITZ_CHECK_ROOM(fields->field, fields->count, fields->room);
        fields->field[fields->count++] =
            ritz_piece_trim((ritz_piece){at, length});
        at += length + 1;
    }
    return RITZ_OK;
}

/* ---- keywords ------------------------------------------------------------ */

bool ritz_inp_is(ritz_piece piece, const char *word)
{
    const char *end = piece.text + piece.length;

    for (const char *at = piece.text; at < end; at++) {
        if (ritz_card_is_blank(*at))
            continue;
        while (*word == ' ')
            word++;
        if (!*word || ritz_card_upper(*at) != *word++)
            return false;
    }
    return !*word;
}

bool ritz_inp_same(ritz_piece a, ritz_piece b)
{
    return a.length == b.length &&
           (a.length == 0 ||
            strncasecmp(a.text, b.text, (size_t)a.length) == 0);
}

ritz_piece ritz_inp_unquote(ritz_piece piece)
{
    if (piece.length > 1 && piece.text[0] == '"' &&
        piece.text[piece.length - 1] == '"') {
        piece.text++;
        piece.length -= 2;
    }
    return piece;
}

static ritz_status add_parameter(const ritz_inp *all, ritz_piece field,
                                 bool continued, ritz_inp_keyword *keyword)
{
    const char *equals = NULL;
    ritz_piece value = {field.text + field.length, 0};

    if (field.length == 0)
        return RITZ_OK;
    if (keyword->count == RITZ_INP_PARAMETERS)
        return ritz_inp_refuse(
            all, keyword->place, "'*%.*s' has more than %d parameters",
            RITZ_INP_QUOTED(keyword->name), RITZ_INP_PARAMETERS);
    equals = memchr(field.text, '=', (size_t)field.length);
    if (equals) {
        value =
            (ritz_piece){equals + 1, field.text + field.length - (equals + 1)};
        field.length = equals - field.text;
    }
    field = ritz_piece_trim(field);
    if (continued && keyword->odd.length == 0 &&
        !isalpha((unsigned char)*field.text))
        keyword->odd = field;
    keyword->key[keyword->count] = field;
    keyword->value[keyword->count++] = ritz_inp_unquote(ritz_piece_trim(value));
    return RITZ_OK;
}

ritz_status ritz_inp_take_keyword(ritz_inp *all, ritz_piece line)
{
    ritz_inp_keyword *keyword = &all->keyword;
    const ritz_inp_fields *fields = &all->fields;
    int64_t from = 1;

    line.text++; /* the asterisk */
    line.length--;
    RITZ_CHECK(ritz_inp_split(all, line));
    keyword->count = 0;
    keyword->odd = (ritz_piece){"", 0};
    keyword->place = fields->place;
    keyword->name = ritz_inp_field(all, 0);
    for (;;) {
        for (int64_t k = from; k < fields->count; k++)
            RITZ_CHECK(
                add_parameter(all, fields->field[k], from == 0, keyword));
        if (!fields->continues || !ritz_inp_line(all, &line))
            return RITZ_OK;
        if (*line.text == '*' ||
            place_of_line(all).file != keyword->place.file) {
            all->held = true;
            return RITZ_OK;
        }
        RITZ_CHECK(ritz_inp_split(all, line));
        from = 0;
    }
}

const ritz_piece *ritz_inp_parameter(const ritz_inp_keyword *keyword,
                                     const char *key)
{
    for (int64_t k = 0; k < keyword->count; k++)
        if (ritz_inp_is(keyword->key[k], key))
            return &keyword->value[k];
    return NULL;
}

ritz_status ritz_inp_follow(ritz_inp *all)
{
    const ritz_piece *input = ritz_inp_parameter(&all->keyword, "INPUT");
    char name[RITZ_DECK_LONGEST] = "";
    char where[RITZ_DECK_PLACE_SIZE];

    if (!input)
        return RITZ_OK;
    if (input->length == 0 || input->length >= RITZ_DECK_LONGEST)
        return ritz_inp_refuse(all, all->keyword.place,
                               "INPUT of '*%.*s' names no file, or one with a "
                               "name that is too long",
                               RITZ_INP_QUOTED(all->keyword.name));
    if (all->held || !ritz_deck_top(&all->reading))
        return ritz_inp_refuse(all, all->keyword.place,
                               "'*%.*s' ends with a comma, and no line "
                               "continues it",
                               RITZ_INP_QUOTED(all->keyword.name));
    if (!ritz_deck_top(&all->reading)->folder) {
        all->unfollowed = true;
        return RITZ_OK;
    }
    memcpy(name, input->text, (size_t)input->length);
    ritz_deck_place(&all->reading, where);
    RITZ_CHECK_IN(where, ritz_deck_include(&all->reading, name));
    return RITZ_OK;
}

/* ---- fields -------------------------------------------------------------- */

ritz_piece ritz_inp_field(const ritz_inp *all, int64_t k)
{
    return k < all->fields.count ? all->fields.field[k] : (ritz_piece){"", 0};
}

static ritz_status refuse_field(const ritz_inp *all, int64_t k,
                                const char *wanted)
{
    ritz_piece field = ritz_inp_field(all, k);

    if (field.length == 0)
        return ritz_inp_refuse(all, all->fields.place,
                               "field %" PRId64 " of '*%.*s' is blank where %s "
                               "must be",
                               k + 1, RITZ_INP_QUOTED(all->keyword.name),
                               wanted);
    return ritz_inp_refuse(
        all, all->fields.place, "'%.*s' in '*%.*s' is not %s",
        RITZ_INP_QUOTED(field), RITZ_INP_QUOTED(all->keyword.name), wanted);
}

bool ritz_inp_whole(ritz_piece piece, int64_t *out)
{
    const char *at = piece.text;
    const char *end = piece.text + piece.length;

    return ritz_decimal_scan_whole(&at, end, out) && at == end;
}

ritz_status ritz_inp_id(const ritz_inp *all, int64_t k, int64_t *out)
{
    static const int64_t MOST_ID = 999999999999999;

    if (!ritz_inp_whole(ritz_inp_field(all, k), out) || *out < 1 ||
        *out > MOST_ID) /* so that one may count beyond it */
        return refuse_field(all, k, "a number from 1 on, of at most 15 digits");
    return RITZ_OK;
}

ritz_status ritz_inp_direction(const ritz_inp *all, int64_t k, int64_t *out)
{
    if (!ritz_inp_whole(ritz_inp_field(all, k), out) || *out < 1 || *out > 6)
        return refuse_field(all, k, "a direction, 1 to 6");
    return RITZ_OK;
}

ritz_status ritz_inp_real(const ritz_inp *all, int64_t k, double *out)
{
    ritz_piece field = ritz_inp_field(all, k);
    const char *at = field.text;
    const char *end = field.text + field.length;
    ritz_decimal number = {0};

    if (field.length > 0 && (!ritz_decimal_scan(&at, end, &number) ||
                             at != end || !isfinite(number.value)))
        return refuse_field(all, k, "a number");
    *out = number.value;
    return RITZ_OK;
}

ritz_status ritz_inp_name(const ritz_inp *all, int64_t k, ritz_inp_named *out)
{
    ritz_piece field = ritz_inp_field(all, k);
    char first = '\0';

    *out = (ritz_inp_named){.inner = all->open.number > 0,
                            .place = all->fields.place};
    if (field.length == 0)
        return refuse_field(all, k, "a node or a set");
    first = *field.text;
    if (first == '-' || first == '+' || (first >= '0' && first <= '9'))
        return ritz_inp_id(all, k, &out->id);
    out->name = ritz_inp_unquote(field);
    return RITZ_OK;
}

ritz_status ritz_inp_refuse(const ritz_inp *all, ritz_inp_place place,
                            const char *format, ...)
{
    ritz_status status = RITZ_OK;
    va_list args;

    va_start(args, format);
    status =
        ritz_deck_refuse(&all->files, place.file, place.line, format, args);
    va_end(args);
    return status;
}
