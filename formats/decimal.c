/*
 * Decimal to binary, correctly rounded.
 *
 * A number is m 10^e with a whole m < 10^19. Powers 10^0..10^22 are doubles, so
 * for m <= 2^53 and |e| <= 22 one operation rounds right [Clinger1990].
 * Otherwise m = hi + lo, two doubles, is multiplied or divided by such powers
 * with errors carried along [Dekker1971]; each step adds at most 2^-102 of the
 * value, twelve steps less than 2^-98. If hi + lo rounds to one double wherever
 * in that band the truth is, that double is right; if not, strtod decides.
 */
#include "formats/decimal.h"

#include "base/tolerances.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { STEP = 22, MOST_EXPONENT = 250, MOST_DIGITS = 19, LONGEST = 128 };

static const double power[STEP + 1] = {
    1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
    1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

/* A number as it is being read. */
typedef struct reading {
    uint64_t mantissa;
    int64_t digits;
    int64_t exponent;
    bool negative;
} reading;

typedef struct pair {
    double hi, lo;
} pair;

/* a b = hi + lo exactly. */
static pair multiply_exactly(double a, double b)
{
    double split_a = 134217729.0 * a; /* 2^27 + 1 */
    double split_b = 134217729.0 * b;
    double a_hi = split_a - (split_a - a);
    double b_hi = split_b - (split_b - b);
    double a_lo = a - a_hi;
    double b_lo = b - b_hi;
    double hi = a * b;

    return (pair){hi, ((a_hi * b_hi - hi) + a_hi * b_lo + a_lo * b_hi) +
                          a_lo * b_lo};
}

/* hi + lo with |lo| <= ulp(hi) / 2, for |hi| > |lo|. */
static pair renormalise_pair(double hi, double lo)
{
    double sum = hi + lo;

    return (pair){sum, lo - (sum - hi)};
}

static pair multiply_pair(pair a, double b)
{
    pair p = multiply_exactly(a.hi, b);

    return renormalise_pair(p.hi, p.lo + a.lo * b);
}

static pair divide_pair(pair a, double b)
{
    double quotient = a.hi / b;
    pair p = multiply_exactly(quotient, b);

    return renormalise_pair(quotient, (((a.hi - p.hi) - p.lo) + a.lo) / b);
}

/* m 10^e if it can be rounded for certain. */
static bool round_fast(uint64_t m, int64_t e, double *out)
{
    pair x = {.hi = (double)m};
    double doubt = 0.0;

    if (FLT_EVAL_METHOD != 0 || e > MOST_EXPONENT || e < -MOST_EXPONENT)
        return false;
    if (m <= (UINT64_C(1) << 53) && e >= -STEP && e <= STEP) {
        *out = e < 0 ? x.hi / power[-e] : x.hi * power[e];
        return true;
    }
    x.lo = (double)(int64_t)(m - (uint64_t)x.hi);
    for (; e > 0; e -= e < STEP ? e : STEP)
        x = multiply_pair(x, power[e < STEP ? e : STEP]);
    for (; e < 0; e += -e < STEP ? -e : STEP)
        x = divide_pair(x, power[-e < STEP ? -e : STEP]);
    doubt = x.hi * RITZ_DOUBLE_DOUBLE;
    *out = x.hi + (x.lo + doubt);
    return *out == x.hi + (x.lo - doubt);
}

/* The text from `at` to `end` in C's spelling, through strtod. */
static bool round_slowly(const char *at, const char *end, double *out)
{
    char copy[LONGEST];
    char *stop = NULL;
    size_t used = 0;
    bool marked = false;

    for (const char *c = at; c < end; c++) {
        bool mark = *c == 'e' || *c == 'E' || *c == 'd' || *c == 'D';

        if (used + 3 > sizeof copy)
            return false;
        if (c > at && (*c == '+' || *c == '-') && !marked)
            copy[used++] = 'e';
        marked = marked || mark || (c > at && (*c == '+' || *c == '-'));
        copy[used++] = (char)(mark ? 'e' : *c);
    }
    copy[used] = '\0';
    *out = strtod(copy, &stop);
    return *stop == '\0';
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

enum { TEN_TO_8 = 100000000 };

/*
 * The value of eight decimal digits by three multiplications: neighbouring
 * bytes are combined to numbers of two digits, these to numbers of four, and
 * these to one of eight.
 *
 * @return false if one of the eight bytes is no digit, or on a big-endian
 *         processor; *out is unchanged
 */
static bool take_eight(const char *at, uint64_t *out)
{
    const uint64_t ones = UINT64_C(0x0101010101010101);
    uint64_t v = 0;

    memcpy(&v, at, sizeof v);
    v ^= '0' * ones; /* digits become 0 to 9, other bytes become 10 or more */
    if (__BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__ ||
        ((v | ((v & (0x7f * ones)) + 0x76 * ones)) & (0x80 * ones)) != 0)
        return false;
    v = (10 * v + (v >> 8)) & UINT64_C(0x00ff00ff00ff00ff);
    v = (100 * v + (v >> 16)) & UINT64_C(0x0000ffff0000ffff);
    *out = (10000 * v + (v >> 32)) & UINT64_C(0xffffffff);
    return true;
}

/* Digits from `at`; more than fit the mantissa are only counted. */
static const char *scan_digits(const char *at, const char *end, reading *r)
{
    uint64_t eight = 0;

    while (r->mantissa == 0 && at < end && *at == '0')
        at++;
    for (; end - at >= 8 && r->digits + 8 <= MOST_DIGITS &&
           take_eight(at, &eight);
         at += 8) {
        r->mantissa = TEN_TO_8 * r->mantissa + eight;
        r->digits += 8;
    }
    for (; at < end && is_digit(*at); at++) {
        if (r->digits < MOST_DIGITS)
            r->mantissa = 10 * r->mantissa + (uint64_t)(*at - '0');
        r->digits++;
    }
    return at;
}

/* "E+3", "D+3" or "+3" behind a significand; NULL if it is cut short. */
static const char *scan_exponent(const char *at, const char *end, reading *r)
{
    bool negative = false;
    int64_t e = 0;

    if (at == end)
        return at;
    if (*at == 'e' || *at == 'E' || *at == 'd' || *at == 'D')
        at++;
    else if (*at != '+' && *at != '-')
        return at;
    if (at < end && (*at == '+' || *at == '-'))
        negative = *at++ == '-';
    if (at == end || !is_digit(*at))
        return NULL;
    for (; at < end && is_digit(*at); at++)
        if (e < 100000)
            e = 10 * e + (*at - '0');
    r->exponent += negative ? -e : e;
    return at;
}

/* "nan" and "inf", which are read as such. */
static bool scan_word(const char **at, const char *c, const char *end,
                      ritz_decimal *out)
{
    static const char *const words[] = {"infinity", "inf", "nan"};

    for (size_t k = 0; k < sizeof words / sizeof *words; k++) {
        size_t length = strlen(words[k]);

        if ((size_t)(end - c) < length || strncasecmp(c, words[k], length) != 0)
            continue;
        *out = (ritz_decimal){.value = k < 2 ? HUGE_VAL : (double)NAN};
        *at = c + length;
        return true;
    }
    return false;
}

bool ritz_decimal_scan(const char **at, const char *end, ritz_decimal *out)
{
    reading r = {0};
    const char *c = *at;
    const char *whole = NULL;
    const char *point = NULL;
    double value = 0.0;

    if (c < end && (*c == '-' || *c == '+'))
        r.negative = *c++ == '-';
    if (c < end && (*c | 32) >= 'a')
        return scan_word(at, c, end, out);
    whole = c;
    c = scan_digits(c, end, &r);
    if (c < end && *c == '.') {
        point = ++c;
        c = scan_digits(c, end, &r);
        r.exponent -= c - point;
    }
    if (c - whole - (point ? 1 : 0) == 0)
        return false;
    c = scan_exponent(c, end, &r);
    if (!c)
        return false;
    if (r.mantissa > 0 &&
        (r.digits > MOST_DIGITS || !round_fast(r.mantissa, r.exponent, &value)))
        if (!round_slowly(whole, c, &value))
            return false;
    *out = (ritz_decimal){r.negative ? -value : value, r.digits};
    *at = c;
    return true;
}

bool ritz_decimal_scan_whole(const char **at, const char *end, int64_t *out)
{
    const char *c = *at;
    const char *first = NULL;
    int64_t value = 0;
    bool negative = false;

    if (c < end && (*c == '-' || *c == '+'))
        negative = *c++ == '-';
    first = c;
    for (; c < end && is_digit(*c) && c - first < 18; c++)
        value = 10 * value + (*c - '0');
    if (c == first || (c < end && is_digit(*c)))
        return false;
    *out = negative ? -value : value;
    *at = c;
    return true;
}

const char *ritz_decimal_skip(const char *at, const char *end)
{
    while (at < end && (*at == ' ' || *at == '\t' || *at == '\0'))
        at++;
    return at;
}

bool ritz_decimal_is_inside(const char *at, const char *end)
{
    return at < end && at == ritz_decimal_skip(at, end);
}

bool ritz_decimal_scan_wholes(const char **at, const char *end, int64_t count,
                              int64_t *out)
{
    for (int64_t k = 0; k < count; k++) {
        *at = ritz_decimal_skip(*at, end);
        if (!ritz_decimal_scan_whole(at, end, &out[k]) ||
            ritz_decimal_is_inside(*at, end))
            return false;
    }
    *at = ritz_decimal_skip(*at, end);
    return true;
}
