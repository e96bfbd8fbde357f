/*
 * Lines of a coded database of ANSYS [Ansys2024]: commands whose fields commas
 * separate, and lines of blocks whose fields have fixed columns. A line with a
 * format of Fortran says which.
 */
#include "formats/cdb_lines.h"

#include <math.h>
#include <string.h>
#include <strings.h>

enum { MOST_DIGITS = 60 }; /* width of a field */

/* ---- commands ------------------------------------------------------------ */

bool ritz_cdb_take_line(ritz_cdb *all, ritz_piece *out, int64_t *number)
{
    const ritz_deck_text *top = NULL;

    if (!ritz_deck_next_line(&all->reading))
        return false;
    top = ritz_deck_top(&all->reading);
    *out = (ritz_piece){top->text.line, top->text.line_end - top->text.line};
    if (out->length > 0 && out->text[out->length - 1] == '\r')
        out->length--;
    *number = top->text.number;
    return true;
}

bool ritz_cdb_is_word(ritz_piece piece, const char *word)
{
    return piece.length == (int64_t)strlen(word) &&
           strncasecmp(piece.text, word, (size_t)piece.length) == 0;
}

bool ritz_cdb_read_whole(ritz_piece piece, int64_t *out)
{
    const char *at = piece.text;
    const char *end = piece.text + piece.length;
    const bool minus = at < end && *at == '-';

    at += minus;
    if (!ritz_decimal_scan_whole(&at, end, out) || at != end)
        return false;
    *out = minus ? -*out : *out;
    return true;
}

bool ritz_cdb_read_real(ritz_piece piece, double *out)
{
    ritz_decimal value = {0};
    const char *at = piece.text;

    if (piece.length > 0 &&
        !ritz_decimal_scan(&at, piece.text + piece.length, &value))
        return false;
    *out = value.value;
    return at == piece.text + piece.length && isfinite(value.value);
}

void ritz_cdb_split_command(ritz_piece text, int64_t line,
                            ritz_cdb_command *out)
{
    const char *stop = memchr(text.text, '!', (size_t)text.length);
    const char *end = stop ? stop : text.text + text.length;
    const char *at = text.text;

    *out = (ritz_cdb_command){.line = line};
    while (out->count < RITZ_CDB_MOST_FIELDS) {
        const char *comma = memchr(at, ',', (size_t)(end - at));
        const char *to = comma ? comma : end;

        out->field[out->count++] = ritz_piece_trim((ritz_piece){at, to - at});
        if (!comma)
            break;
        at = comma + 1;
    }
}

ritz_piece ritz_cdb_field(const ritz_cdb_command *command, int64_t k)
{
    return k < command->count ? command->field[k] : (ritz_piece){"", 0};
}

ritz_status ritz_cdb_take_whole(const ritz_cdb *all,
                                const ritz_cdb_command *command, int64_t k,
                                int64_t *out)
{
    const ritz_piece field = ritz_cdb_field(command, k);

    if (!ritz_cdb_read_whole(field, out))
        return ritz_cdb_refuse(
            all, command->line, "'%.*s' of '%.*s' is not a whole number",
            RITZ_CDB_QUOTED(field), RITZ_CDB_QUOTED(command->field[0]));
    return RITZ_OK;
}

ritz_status ritz_cdb_take_real(const ritz_cdb *all,
                               const ritz_cdb_command *command, int64_t k,
                               double *out)
{
    const ritz_piece field = ritz_cdb_field(command, k);

    if (!ritz_cdb_read_real(field, out))
        return ritz_cdb_refuse(
            all, command->line, "'%.*s' of '%.*s' is not a number",
            RITZ_CDB_QUOTED(field), RITZ_CDB_QUOTED(command->field[0]));
    return RITZ_OK;
}

/* ---- blocks -------------------------------------------------------------- */

/* Read a group such as "3i9" or "6e21.13e3", and move `at` to its end. */
static bool scan_group(const char **at, const char *end, const char *letters,
                       int64_t *count, int64_t *width)
{
    static const char marks[] = ".E"; /* of decimals, of digits of exponents */
    int64_t unused = 0;

    *count = 1;
    if (!ritz_decimal_scan_whole(at, end, count))
        *count = 1;
    if (*at == end || !strchr(letters, ritz_card_upper(**at)))
        return false;
    ++*at;
    if (!ritz_decimal_scan_whole(at, end, width) || *count < 1 || *width < 1 ||
        *count > RITZ_CDB_MOST_FIELDS || *width > MOST_DIGITS)
        return false;
    for (const char *mark = marks; *mark; mark++)
        if (*at < end && ritz_card_upper(**at) == *mark) {
            ++*at;
            (void)ritz_decimal_scan_whole(at, end, &unused);
        }
    return true;
}

static bool scan_form(ritz_piece line, ritz_cdb_form *out)
{
    const char *at = line.text;
    const char *end = line.text + line.length;

    if (line.length == 0 || *at++ != '(' ||
        !scan_group(&at, end, "I", &out->wholes, &out->whole_width))
        return false;
    if (at < end && *at == ',') {
        at++;
        if (!scan_group(&at, end, "EFDG", &out->reals, &out->real_width))
            return false;
    }
    return end - at == 1 && *at == ')';
}

ritz_status ritz_cdb_take_form(ritz_cdb *all, const ritz_cdb_command *command,
                               bool reals, ritz_cdb_form *out)
{
    ritz_piece line = {"", 0};
    int64_t number = command->line;

    *out = (ritz_cdb_form){0};
    if (!ritz_cdb_take_line(all, &line, &number) ||
        !scan_form(ritz_piece_trim(line), out) || reals != (out->reals > 0))
        return ritz_cdb_refuse(all, number,
                               "'%.*s' is not followed by a format such as "
                               "'%s'",
                               RITZ_CDB_QUOTED(command->field[0]),
                               reals ? "(3i9,6e21.13e3)" : "(19i9)");
    return RITZ_OK;
}

ritz_piece ritz_cdb_cut_field(ritz_piece line, int64_t from, int64_t width)
{
    const int64_t at = from < line.length ? from : line.length;
    const int64_t rest = line.length - at;

    return ritz_piece_trim(
        (ritz_piece){line.text + at, rest < width ? rest : width});
}

bool ritz_cdb_ends_block(ritz_piece line)
{
    const ritz_piece text = ritz_piece_trim(line);
    ritz_cdb_command command = {0};

    if (text.length == 0)
        return false;
    ritz_cdb_split_command(text, 0, &command);
    return ritz_cdb_is_word(command.field[0], "-1") ||
           ritz_cdb_is_word(command.field[0], "N") ||
           ritz_cdb_is_word(command.field[0], "EN");
}

ritz_status ritz_cdb_take_wholes(const ritz_cdb *all, const ritz_cdb_form *form,
                                 ritz_piece line, int64_t number, int64_t *out,
                                 int64_t *count)
{
    *count = 0;
    for (int64_t k = 0; k < form->wholes; k++) {
        const ritz_piece field =
            ritz_cdb_cut_field(line, k * form->whole_width, form->whole_width);

        out[k] = 0;
        if (field.length == 0)
            continue;
        if (!ritz_cdb_read_whole(field, &out[k]))
            return ritz_cdb_refuse(all, number, "'%.*s' is not a whole number",
                                   RITZ_CDB_QUOTED(field));
        *count = k + 1;
    }
    return RITZ_OK;
}
