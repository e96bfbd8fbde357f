/* Text that is gone through line by line, and its decimal numbers, read fast
 * and rounded as strtod rounds. */
#ifndef RITZ_FORMATS_DECIMAL_H
#define RITZ_FORMATS_DECIMAL_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

/* Begin with `at` and `end`; a copy goes on from where it was made. */
typedef struct ritz_lines {
    const char *at, *end;
    const char *line, *line_end; /* taken last, without its '\n' */
    int64_t number;              /* of that line, from 1 */
} ritz_lines;

/** Take the next line. @return false at the end of the text */
static inline bool ritz_lines_next(ritz_lines *text)
{
    const char *stop = NULL;

    if (text->at >= text->end)
        return false;
    stop = memchr(text->at, '\n', (size_t)(text->end - text->at));
    text->line = text->at;
    text->line_end = stop ? stop : text->end;
    text->at = stop ? stop + 1 : text->end;
    text->number++;
    return true;
}

/** Letters of a text that a message quotes: all, but at most 79. */
static inline int ritz_lines_quoted(const char *text, const char *end)
{
    return end - text < 80 ? (int)(end - text) : 79;
}

typedef struct ritz_decimal {
    double value;   /* not finite if the text says so or is too large */
    int64_t digits; /* as written, from the first that is not zero */
} ritz_decimal;

/**
 * One number at @p at, which is moved behind it: C's spellings and Fortran's,
 * "1.5E+3", "1.5D+3", "1.5+3", ".5", "nan", "inf". Blanks are not skipped.
 *
 * @return false if there is none; @p at is then where it was
 */
bool ritz_decimal_scan(const char **at, const char *end, ritz_decimal *out);

/**
 * The number in a field of @p width letters as Fortran's 1P,Ew.d fills it:
 * blanks, a sign or another blank, a digit, the point, @p decimals digits, E or
 * D, and an exponent of a sign and two digits. ritz_decimal_scan() finds the
 * same number there, in three times the time.
 *
 * @param[in] decimals  1 to 18, and at most @p width - 7
 * @return false if the field is spelled otherwise, or rounding needs strtod;
 *         *out is unchanged
 */
bool ritz_decimal_scan_field(const char *at, int64_t width, int64_t decimals,
                             double *out);

/** The whole number without a sign at the end of eight letters, behind blanks.
 * @return false if they are spelled otherwise; *out is unchanged */
bool ritz_decimal_scan_eight(const char *at, int64_t *out);

/** Scan a whole number of at most 18 digits, as above. */
bool ritz_decimal_scan_whole(const char **at, const char *end, int64_t *out);

/** Move over blanks and tabs; NUL is a blank too, as old files pad so. */
const char *ritz_decimal_skip(const char *at, const char *end);

/** True if @p at is neither the end nor a blank: a word goes on. */
bool ritz_decimal_is_inside(const char *at, const char *end);

/** @p count whole numbers apart by blanks; @p at is moved behind them and the
 * blanks that follow. */
bool ritz_decimal_scan_wholes(const char **at, const char *end, int64_t count,
                              int64_t *out);

#endif
