/*
 * Decimal to binary, correctly rounded.
 *
 * A number is m 10^e with a whole m < 10^19. One of usual size is rounded by
 * whole numbers: see round_usual(). For others, powers 10^0..10^22 are doubles,
 * so for m <= 2^53 and |e| <= 22 one operation rounds right [Clinger1990].
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

/* ---- numbers of usual size ----------------------------------------------- */

/*
 * 10^e = (T + t) 2^(E - 127) with 0 <= t < 1, E = floor(e log2(10)) and a whole
 * T of 128 bits, of which the highest is set. With m moved to the left until
 * its highest bit is set, w = m 2^z, the product w T 2^-64 has the two words
 * a_1 and a_0 and a fraction; it is too small by less than 1, and the fraction
 * is less than 1. So the double next to m 10^e follows from a_1 and a_0, unless
 * these are less than 2 below the middle between two doubles, or there
 * [Lemire2021].
 */
#ifdef __SIZEOF_INT128__
enum { LOWEST_POWER = -60, HIGHEST_POWER = 22 };

static const uint64_t power_words[][2] = {
    {0xcdb02555653131b6, 0x3792f412cb06794d},
    {0x808e17555f3ebf11, 0xe2bbd88bbee40bd0},
    {0xa0b19d2ab70e6ed6, 0x5b6aceaeae9d0ec4},
    {0xc8de047564d20a8b, 0xf245825a5a445275},
    {0xfb158592be068d2e, 0xeed6e2f0f0d56712},
    {0x9ced737bb6c4183d, 0x55464dd69685606b},
    {0xc428d05aa4751e4c, 0xaa97e14c3c26b886},
    {0xf53304714d9265df, 0xd53dd99f4b3066a8},
    {0x993fe2c6d07b7fab, 0xe546a8038efe4029},
    {0xbf8fdb78849a5f96, 0xde98520472bdd033},
    {0xef73d256a5c0f77c, 0x963e66858f6d4440},
    {0x95a8637627989aad, 0xdde7001379a44aa8},
    {0xbb127c53b17ec159, 0x5560c018580d5d52},
    {0xe9d71b689dde71af, 0xaab8f01e6e10b4a6},
    {0x9226712162ab070d, 0xcab3961304ca70e8},
    {0xb6b00d69bb55c8d1, 0x3d607b97c5fd0d22},
    {0xe45c10c42a2b3b05, 0x8cb89a7db77c506a},
    {0x8eb98a7a9a5b04e3, 0x77f3608e92adb242},
    {0xb267ed1940f1c61c, 0x55f038b237591ed3},
    {0xdf01e85f912e37a3, 0x6b6c46dec52f6688},
    {0x8b61313bbabce2c6, 0x2323ac4b3b3da015},
    {0xae397d8aa96c1b77, 0xabec975e0a0d081a},
    {0xd9c7dced53c72255, 0x96e7bd358c904a21},
    {0x881cea14545c7575, 0x7e50d64177da2e54},
    {0xaa242499697392d2, 0xdde50bd1d5d0b9e9},
    {0xd4ad2dbfc3d07787, 0x955e4ec64b44e864},
    {0x84ec3c97da624ab4, 0xbd5af13bef0b113e},
    {0xa6274bbdd0fadd61, 0xecb1ad8aeacdd58e},
    {0xcfb11ead453994ba, 0x67de18eda5814af2},
    {0x81ceb32c4b43fcf4, 0x80eacf948770ced7},
    {0xa2425ff75e14fc31, 0xa1258379a94d028d},
    {0xcad2f7f5359a3b3e, 0x096ee45813a04330},
    {0xfd87b5f28300ca0d, 0x8bca9d6e188853fc},
    {0x9e74d1b791e07e48, 0x775ea264cf55347d},
    {0xc612062576589dda, 0x95364afe032a819d},
    {0xf79687aed3eec551, 0x3a83ddbd83f52204},
    {0x9abe14cd44753b52, 0xc4926a9672793542},
    {0xc16d9a0095928a27, 0x75b7053c0f178293},
    {0xf1c90080baf72cb1, 0x5324c68b12dd6338},
    {0x971da05074da7bee, 0xd3f6fc16ebca5e03},
    {0xbce5086492111aea, 0x88f4bb1ca6bcf584},
    {0xec1e4a7db69561a5, 0x2b31e9e3d06c32e5},
    {0x9392ee8e921d5d07, 0x3aff322e62439fcf},
    {0xb877aa3236a4b449, 0x09befeb9fad487c2},
    {0xe69594bec44de15b, 0x4c2ebe687989a9b3},
    {0x901d7cf73ab0acd9, 0x0f9d37014bf60a10},
    {0xb424dc35095cd80f, 0x538484c19ef38c94},
    {0xe12e13424bb40e13, 0x2865a5f206b06fb9},
    {0x8cbccc096f5088cb, 0xf93f87b7442e45d3},
    {0xafebff0bcb24aafe, 0xf78f69a51539d748},
    {0xdbe6fecebdedd5be, 0xb573440e5a884d1b},
    {0x89705f4136b4a597, 0x31680a88f8953030},
    {0xabcc77118461cefc, 0xfdc20d2b36ba7c3d},
    {0xd6bf94d5e57a42bc, 0x3d32907604691b4c},
    {0x8637bd05af6c69b5, 0xa63f9a49c2c1b10f},
    {0xa7c5ac471b478423, 0x0fcf80dc33721d53},
    {0xd1b71758e219652b, 0xd3c36113404ea4a8},
    {0x83126e978d4fdf3b, 0x645a1cac083126e9},
    {0xa3d70a3d70a3d70a, 0x3d70a3d70a3d70a3},
    {0xcccccccccccccccc, 0xcccccccccccccccc},
    {0x8000000000000000, 0x0000000000000000},
    {0xa000000000000000, 0x0000000000000000},
    {0xc800000000000000, 0x0000000000000000},
    {0xfa00000000000000, 0x0000000000000000},
    {0x9c40000000000000, 0x0000000000000000},
    {0xc350000000000000, 0x0000000000000000},
    {0xf424000000000000, 0x0000000000000000},
    {0x9896800000000000, 0x0000000000000000},
    {0xbebc200000000000, 0x0000000000000000},
    {0xee6b280000000000, 0x0000000000000000},
    {0x9502f90000000000, 0x0000000000000000},
    {0xba43b74000000000, 0x0000000000000000},
    {0xe8d4a51000000000, 0x0000000000000000},
    {0x9184e72a00000000, 0x0000000000000000},
    {0xb5e620f480000000, 0x0000000000000000},
    {0xe35fa931a0000000, 0x0000000000000000},
    {0x8e1bc9bf04000000, 0x0000000000000000},
    {0xb1a2bc2ec5000000, 0x0000000000000000},
    {0xde0b6b3a76400000, 0x0000000000000000},
    {0x8ac7230489e80000, 0x0000000000000000},
    {0xad78ebc5ac620000, 0x0000000000000000},
    {0xd8d726b7177a8000, 0x0000000000000000},
    {0x878678326eac9000, 0x0000000000000000},
};

__extension__ typedef unsigned __int128 two_words;

/* floor(e log2(10)) for |e| < 350: 217706 2^-16 is log2(10) to 3e-6. */
static int64_t floor_log2(int64_t e)
{
    return e * 217706 / 65536 - (e < 0);
}

/* m 10^e for m > 0; false if it is not certain, or none of usual size. */
static bool round_usual(uint64_t m, int64_t e, double *out)
{
    enum { BIAS = 1023, FRACTION = 52 };
    const int zeros = __builtin_clzll(m);
    const uint64_t w = m << zeros;
    const uint64_t *T = NULL;
    two_words a = 0;
    uint64_t high = 0, low = 0, rest = 0, middle = 0, bits = 0;
    int dropped = 0; /* bits of a_1 beyond those of a double */
    int64_t exponent = 0;

    if (e < LOWEST_POWER || e > HIGHEST_POWER)
        return false;
    T = power_words[e - LOWEST_POWER];
    a = (two_words)w * T[0] + (uint64_t)((two_words)w * T[1] >> 64);
    high = (uint64_t)(a >> 64);
    low = (uint64_t)a;
    dropped = 10 + (int)(high >> 63);
    middle = UINT64_C(1) << (dropped - 1);
    rest = high & (2 * middle - 1);
    if ((rest == middle && low == 0) ||
        (rest == middle - 1 && low >= UINT64_MAX - 1))
        return false;
    /* the highest bit adds 1 to the exponent, and so does a carry */
    exponent = floor_log2(e) + dropped - zeros + 1 + FRACTION + BIAS - 1;
    bits = (high >> dropped) + (rest >= middle);
    bits += (uint64_t)exponent << FRACTION;
    memcpy(out, &bits, sizeof bits);
    return true;
}
#else
static bool round_usual(uint64_t, int64_t, double *)
{
    return false;
}
#endif

/* ---- other numbers ------------------------------------------------------- */

/* m 10^e if it can be rounded for certain. */
static bool round_fast(uint64_t m, int64_t e, double *out)
{
    pair x = {.hi = (double)m};
    double doubt = 0.0;

    if (round_usual(m, e, out))
        return true;
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

static const uint64_t ONES = UINT64_C(0x0101010101010101);

/*
 * The value of eight decimal digits, the first in the lowest byte, by three
 * multiplications: neighbouring bytes are combined to numbers of two digits,
 * these to numbers of four, and these to one of eight.
 *
 * @return false if one of the eight bytes is no digit, or on a big-endian
 *         processor; *out is unchanged
 */
static inline bool combine_eight(uint64_t v, uint64_t *out)
{
    v ^= '0' * ONES; /* digits become 0 to 9, other bytes become 10 or more */
    if (__BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__ ||
        ((v | ((v & (0x7f * ONES)) + 0x76 * ONES)) & (0x80 * ONES)) != 0)
        return false;
    v = (10 * v + (v >> 8)) & UINT64_C(0x00ff00ff00ff00ff);
    v = (100 * v + (v >> 16)) & UINT64_C(0x0000ffff0000ffff);
    *out = (10000 * v + (v >> 32)) & UINT64_C(0xffffffff);
    return true;
}

static inline bool take_eight(const char *at, uint64_t *out)
{
    uint64_t v = 0;

    memcpy(&v, at, sizeof v);
    return combine_eight(v, out);
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

/* "E+03" or "D-12". */
static bool take_exponent(const char *at, int64_t *out)
{
    const bool negative = at[1] == '-';
    int64_t e = 0;

    if ((at[0] != 'E' && at[0] != 'D') || (at[1] == '+') == negative ||
        !is_digit(at[2]) || !is_digit(at[3]))
        return false;
    e = 10 * (at[2] - '0') + (at[3] - '0');
    *out = negative ? -e : e;
    return true;
}

/* Signs are as good as random, so that none of them decides a branch. */
bool ritz_decimal_scan_field(const char *at, int64_t width, int64_t decimals,
                             double *out)
{
    static const double sign[] = {1.0, -1.0};
    const char *c = at + width - decimals - 7; /* the sign */
    const bool negative = *c == '-', blank = *c == ' ';
    uint64_t m = 0, eight = 0;
    int64_t e = 0;
    double value = 0.0;

    for (; at < c; at++)
        if (*at != ' ')
            return false;
    if (blank == negative || !is_digit(c[1]) || c[2] != '.')
        return false;
    m = (uint64_t)(c[1] - '0');
    for (c += 3; decimals - (c - at) >= 5; c += 8) {
        if (!take_eight(c, &eight))
            return false;
        m = TEN_TO_8 * m + eight;
    }
    for (; c - at < decimals + 3; c++) {
        if (!is_digit(*c))
            return false;
        m = 10 * m + (uint64_t)(*c - '0');
    }
    if (!take_exponent(c, &e) ||
        (m > 0 && !round_fast(m, e - decimals, &value)))
        return false;
    *out = sign[negative] * value;
    return true;
}

/* Blanks before the number are turned into zeros. So eight digits are combined
 * at once, without a loop over the length of the number. */
bool ritz_decimal_scan_eight(const char *at, int64_t *out)
{
    uint64_t v = 0, other = 0, value = 0;

    memcpy(&v, at, sizeof v);
    other = v ^ ' ' * ONES;
    if (other == 0)
        return false;
    v |= (('0' ^ ' ') * ONES) &
         ((UINT64_C(1) << (__builtin_ctzll(other) / 8 * 8)) - 1);
    if (!combine_eight(v, &value))
        return false;
    *out = (int64_t)value;
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
