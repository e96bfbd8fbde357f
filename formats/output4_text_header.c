/* Lines of OUTPUT4 text: integers, and the header of a matrix. */
#include "formats/output4_text.h"

#include "formats/decimal.h"

#include <stdio.h>
#include <string.h>

bool ritz_output4_take_line(ritz_output4_text *t)
{
    ritz_lines *lines = &t->lines;

    if (!ritz_lines_next(lines))
        return false;
    if (lines->line_end > lines->line && lines->line_end[-1] == '\r')
        lines->line_end--;
    return true;
}

bool ritz_output4_take_filled_line(ritz_output4_text *t)
{
    while (ritz_output4_take_line(t))
        if (ritz_decimal_skip(t->lines.line, t->lines.line_end) !=
            t->lines.line_end)
            return true;
    return false;
}

/* `count` integers in fields of some width, the line blank behind them. */
static bool read_fields(const char *at, const char *end, const int64_t *width,
                        int64_t count, int64_t *out)
{
    for (int64_t k = 0; k < count; k++) {
        const char *stop = end - at > width[k] ? at + width[k] : end;

        at = ritz_decimal_skip(at, stop);
        if (!ritz_decimal_scan_whole(&at, stop, &out[k]) ||
            ritz_decimal_skip(at, stop) != stop)
            return false;
        at = stop;
    }
    return true;
}

bool ritz_output4_take_integers(const ritz_output4_text *t, int64_t count,
                                int64_t *out)
{
    static const int64_t widths[2][3] = {{8, 8, 8}, {16, 16, 16}};

    if (ritz_decimal_scan_row(t->lines.line, t->lines.line_end, count, out))
        return true;
    for (int k = 0; k < 2; k++)
        if (t->lines.line_end - t->lines.line == widths[k][0] * count &&
            read_fields(t->lines.line, t->lines.line_end, widths[k], count,
                        out))
            return true;
    return false;
}

/* A whole number of at most 3 digits that must be followed by something. */
static bool small_number(const char **at, const char *end, int64_t *out)
{
    const char *start = *at;

    return *at < end && **at >= '0' && **at <= '9' &&
           ritz_decimal_scan_whole(at, end, out) && *at - start <= 3;
}

/* "1P,3E23.16" or "5E16.9" at `at`, up to a blank, '|' or the end. */
static bool read_format(const char *at, const char *end, ritz_output4_text *t)
{
    const char *start = at;
    bool scaled = end - at > 3 && at[0] == '1' && (at[1] | 32) == 'p';
    int64_t decimals = 0;

    if (scaled)
        at += at[2] == ',' ? 3 : 2;
    if (!small_number(&at, end, &t->per_line) || at == end ||
        ((*at | 32) != 'e' && (*at | 32) != 'd'))
        return false;
    at++;
    if (!small_number(&at, end, &t->width) || at == end || *at++ != '.' ||
        !small_number(&at, end, &decimals))
        return false;
    if (at < end && *at != ' ' && *at != '|' && *at != '\0')
        return false;
    if (t->per_line < 1 || t->width < 3 || decimals >= t->width)
        return false;
    t->digits = decimals + scaled;
    snprintf(t->format, sizeof t->format, "%.*s", (int)(at - start), start);
    return true;
}

/* Name and format behind the four integers of a header. */
static bool read_label(const char *at, const char *end, ritz_output4_text *t,
                       char name[RITZ_NAME_SIZE])
{
    const char *name_end = end - at > 8 ? at + 8 : end;
    bool found = false;

    for (const char *c = name_end; c < end && !found; c++)
        found = read_format(c, end, t);
    if (!found && ritz_decimal_skip(name_end, end) != end)
        return false;
    for (const char *c = at; c < name_end && !found; c++) {
        found = read_format(c, end, t); /* a short name without padding */
        if (found)
            name_end = c;
    }
    if (!found) {
        static const char usual[] = "5E16.9";

        /* without 1P the point is in front of all digits, but not here */
        found = read_format(usual, usual + strlen(usual), t);
        t->digits++;
    }
    if (t->digits > 17)
        t->digits = 17;
    if (t->digits < 1)
        t->digits = 1;
    ritz_output4_name(at, name_end - at, name);
    return found;
}

bool ritz_output4_take_header(ritz_output4_text *t, ritz_output4_header *out)
{
    static const int64_t widths[2][4] = {{8, 8, 8, 8}, {16, 16, 8, 8}};
    static const int64_t total[2] = {32, 48};
    int64_t n[4] = {0};

    for (int k = 0; k < 2; k++) {
        ritz_output4_header h = {0};

        if (t->lines.line_end - t->lines.line < total[k] ||
            !read_fields(t->lines.line, t->lines.line + total[k], widths[k], 4,
                         n) ||
            !read_label(t->lines.line + total[k], t->lines.line_end, t, h.name))
            continue;
        h.ncol = n[0];
        h.nrow = n[1] < 0 ? -n[1] : n[1];
        h.bigmat = n[1] < 0 || n[1] >= 65536;
        h.form = n[2];
        h.type = n[3];
        *out = h;
        return h.ncol >= 0 && h.type >= 1 && h.type <= 4;
    }
    return false;
}
