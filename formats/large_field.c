/*
 * Numbers in the 16 columns of a large field of NASTRAN's bulk data, which hold
 * sign, digits, point and exponent. The exponent has no letter, and the point
 * stands where most digits fit:
 *
 *     .123456789012345   123.456789012345   1234567890123.+8   1.2345678901-123
 *
 * [Nastran1986], bulk data. Numbers of double precision must have the letter D
 * in NASTRAN-95, as 1.234567890123D5.
 */
#include "formats/large_field.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    FIELD = RITZ_LARGE_FIELD_SIZE - 1,
    MOST_FIGURES = FIELD - 1, /* the point takes one column */
};

/* |x| = 0.d1 d2 ... dn 10^E. */
typedef struct large_figures {
    char digit[MOST_FIGURES + 1]; /* without zeros behind */
    int n;
    int E;
    bool negative;
} large_figures;

/* x, which is not 0, rounded to n digits. */
static large_figures round_to(double x, int n)
{
    large_figures f = {.n = n, .negative = x < 0.0};
    char text[40];

    snprintf(text, sizeof text, "%.*e", n - 1, fabs(x));
    f.digit[0] = text[0];
    if (n > 1)
        memcpy(f.digit + 1, text + 2, (size_t)n - 1);
    f.E = 1 + (int)strtol(strchr(text, 'e') + 1, NULL, 10);
    while (f.n > 1 && f.digit[f.n - 1] == '0')
        f.n--;
    return f;
}

/* The text of a field, to which characters are appended. */
typedef struct large_field {
    int length;
    char *text;
    bool lettered; /* the number always has an exponent, with the letter D */
} large_field;

/* Count characters of `text`, or zeros if it is NULL. */
static void append(large_field *field, int count, const char *text)
{
    for (int k = 0; k < count && field->length < FIELD; k++) {
        char c = '0';

        if (text)
            c = text[k];
        field->text[field->length++] = c;
    }
    field->text[field->length] = '\0';
}

/* Without exponent; false if it is too wide. */
static bool print_fixed(const large_figures *f, int width, large_field *field)
{
    const int before = f->E > 0 ? f->E : 0;
    const int zeros = f->E < 0 ? -f->E : 0;
    const int whole = before < f->n ? before : f->n; /* digits before it */

    if ((before > f->n ? before : zeros + f->n) + 1 > width)
        return false;
    append(field, f->negative, "-");
    append(field, whole, f->digit);
    append(field, before - whole, NULL);
    append(field, 1, ".");
    append(field, zeros, NULL);
    append(field, f->n - whole, f->digit + whole);
    return true;
}

/* Print an exponent, "+5" or "-12", or with its letter "D5" or "D-12".
   @return its number of columns */
static int print_exponent(const large_field *field, int e, char text[static 16])
{
    return snprintf(text, 16, field->lettered ? "D%d" : "%+d", e);
}

/* Append the number with an exponent. The point goes behind the first digit
   unless the exponent is shorter otherwise. False if it does not fit. */
static bool print_scaled(const large_figures *f, int width, large_field *field)
{
    int whole = f->E > 0 ? f->n : 0;
    char exponent[16];
    int columns = print_exponent(field, f->E - whole, exponent);

    if (print_exponent(field, f->E - 1, exponent) <= columns)
        whole = 1;
    columns = print_exponent(field, f->E - whole, exponent);
    if (f->n + 1 + columns > width)
        return false;
    append(field, f->negative, "-");
    append(field, whole, f->digit);
    append(field, 1, ".");
    append(field, f->n - whole, f->digit + whole);
    append(field, columns, exponent);
    return true;
}

static void print_number(double x, bool lettered,
                         char out[static RITZ_LARGE_FIELD_SIZE])
{
    const int width = x < 0.0 ? FIELD - 1 : FIELD;
    large_field field = {.text = out, .lettered = lettered};

    snprintf(out, RITZ_LARGE_FIELD_SIZE, lettered ? "0.D0" : "0.");
    for (int n = MOST_FIGURES; x != 0.0 && n > 0; n--) {
        const large_figures f = round_to(x, n);

        if ((!lettered && print_fixed(&f, width, &field)) ||
            print_scaled(&f, width, &field))
            return;
    }
}

void ritz_large_field_print(double x, char out[static RITZ_LARGE_FIELD_SIZE])
{
    print_number(x, false, out);
}

void ritz_large_field_print_double(double x,
                                   char out[static RITZ_LARGE_FIELD_SIZE])
{
    print_number(x, true, out);
}
