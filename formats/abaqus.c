/* Lines, fields and numbers as Abaqus and CalculiX write them. */
#include "formats/abaqus.h"

#include <ctype.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>

ritz_status ritz_abaqus_in_line(ritz_status status, int64_t number)
{
    char line[32];

    snprintf(line, sizeof line, "line %" PRId64, number > 0 ? number : 1);
    return ritz_context(status, line);
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\0';
}

/* [at, end) without blanks at its ends. */
static ritz_comma_field strip(const char *at, const char *end)
{
    while (at < end && is_blank(*at))
        at++;
    while (end > at && is_blank(end[-1]))
        end--;
    return (ritz_comma_field){at, end};
}

bool ritz_abaqus_next(ritz_lines *text)
{
    while (ritz_lines_next(text)) {
        ritz_comma_field line = strip(text->line, text->line_end);

        text->line = line.at;
        text->line_end = line.end;
        if (line.at < line.end)
            return true;
    }
    return false;
}

bool ritz_abaqus_is_comment(const ritz_lines *text)
{
    return text->line_end - text->line > 1 && text->line[0] == '*' &&
           text->line[1] == '*';
}

bool ritz_abaqus_is_keyword(const ritz_lines *text)
{
    return text->line[0] == '*' && !ritz_abaqus_is_comment(text);
}

bool ritz_abaqus_next_stated(ritz_lines *text)
{
    while (ritz_abaqus_next(text))
        if (!ritz_abaqus_is_comment(text))
            return true;
    return false;
}

bool ritz_abaqus_next_data(ritz_lines *text)
{
    ritz_lines ahead = *text;

    if (!ritz_abaqus_next_stated(&ahead) || ritz_abaqus_is_keyword(&ahead))
        return false;
    *text = ahead;
    return true;
}

bool ritz_abaqus_field(const char **at, const char *end, ritz_comma_field *out)
{
    const char *stop = NULL;

    if (*at >= end)
        return false;
    stop = memchr(*at, ',', (size_t)(end - *at));
    *out = strip(*at, stop ? stop : end);
    *at = stop ? stop + 1 : end;
    return true;
}

static char upper(char c)
{
    return (char)toupper((unsigned char)c);
}

bool ritz_abaqus_spells(const ritz_comma_field *field, const char *word)
{
    for (const char *c = field->at; c < field->end; c++) {
        if (is_blank(*c))
            continue;
        while (*word == ' ')
            word++;
        if (upper(*c) != *word)
            return false;
        word++;
    }
    return *word == '\0';
}

ritz_comma_field ritz_abaqus_value(ritz_comma_field *field)
{
    const char *end = field->end;
    const char *sign = NULL;

    if (field->at < end)
        sign = memchr(field->at, '=', (size_t)(end - field->at));
    if (!sign)
        return (ritz_comma_field){end, end};
    *field = strip(field->at, sign);
    return strip(sign + 1, end);
}

int ritz_abaqus_quoted(const ritz_comma_field *field)
{
    return ritz_lines_quoted(field->at, field->end);
}

ritz_status ritz_abaqus_name(const ritz_comma_field *field,
                             char out[RITZ_NAME_SIZE])
{
    size_t length = (size_t)(field->end - field->at);
    bool fits = length > 0 && length < RITZ_NAME_SIZE;

    for (const char *c = field->at; c < field->end && fits; c++)
        fits = !iscntrl((unsigned char)*c) && *c != '/';
    RITZ_REFUSE_IF(!fits, RITZ_ERR_FORMAT, "'%.*s' is not the name of a matrix",
                   ritz_abaqus_quoted(field), field->at);
    memcpy(out, field->at, length);
    out[length] = '\0';
    return RITZ_OK;
}

ritz_status ritz_abaqus_whole(const ritz_comma_field *field, int64_t *out)
{
    const char *at = field->at;

    RITZ_REFUSE_IF(!ritz_decimal_scan_whole(&at, field->end, out) ||
                       at < field->end,
                   RITZ_ERR_FORMAT, "'%.*s' is not a whole number",
                   ritz_abaqus_quoted(field), field->at);
    return RITZ_OK;
}

ritz_status ritz_abaqus_real(const ritz_comma_field *field, int64_t *digits,
                             double *out)
{
    const char *at = field->at;
    ritz_decimal number = {0};

    RITZ_REFUSE_IF(!ritz_decimal_scan(&at, field->end, &number) ||
                       at < field->end,
                   RITZ_ERR_FORMAT, "'%.*s' is not a number",
                   ritz_abaqus_quoted(field), field->at);
    RITZ_REFUSE_IF(!isfinite(number.value), RITZ_ERR_FORMAT,
                   "'%.*s' is not finite", ritz_abaqus_quoted(field),
                   field->at);
    if (number.digits > *digits)
        *digits = number.digits;
    *out = number.value;
    return RITZ_OK;
}

ritz_status ritz_abaqus_check_node(int64_t node)
{
    RITZ_REFUSE_IF(node < 1, RITZ_ERR_FORMAT,
                   "node %" PRId64 " is internal to Abaqus: only nodes of the "
                   "model, from 1 on, name rows",
                   node);
    return RITZ_OK;
}

ritz_status ritz_abaqus_check_direction(int64_t direction)
{
    static const char *const kind[] = {
        [7] = "warping",
        [8] = "a pressure",
        [9] = "an electric potential",
        [10] = "a flow or a concentration",
        [11] = "a temperature",
    };
    const int64_t known = (int64_t)(sizeof kind / sizeof *kind);

    RITZ_REFUSE_IF(direction >= 1 && direction < known && kind[direction],
                   RITZ_ERR_FORMAT,
                   "degree of freedom %" PRId64 ", %s, is not read, but 1 to 6",
                   direction, kind[direction]);
    RITZ_REFUSE_IF(direction < 1 || direction >= known, RITZ_ERR_FORMAT,
                   "degree of freedom %" PRId64 " is none of 1 to 6",
                   direction);
    return RITZ_OK;
}
