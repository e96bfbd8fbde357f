/* Decimal numbers in text: rounded as strtod rounds, by each way to read
   them. */
#include "testing.h"

#include "damage.h"
#include "formats/decimal.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Against strtod, on the spellings that reach each path. */
static void decimals_are_rounded_as_strtod_rounds(void **state)
{
    uint64_t seed = 1;
    (void)state;

    for (int k = 0; k < 200000; k++) {
        ritz_decimal number = {0};
        char text[64];
        const char *from = text;

        (void)damage_random(&seed);
        snprintf(text, sizeof text, "%llu.%0*lluE%d",
                 (unsigned long long)(seed >> 60), 1 + k % 17,
                 (unsigned long long)((seed >> 13) % 10000000000000000U),
                 (int)(seed % 640) - 330 + 20 * (k % 2));
        assert_true(ritz_decimal_scan(&from, text + strlen(text), &number));
        assert_true(*from == '\0');
        if (number.value != strtod(text, NULL))
            fail_msg("%s is not %.17g", text, number.value);
    }
}

static void ties_and_odd_spellings_are_read(void **state)
{
    static const struct {
        const char *text;
        double value;
    } cases[] = {
        {"9007199254740993", 9007199254740992.0},
        {"9007199254740995", 9007199254740996.0},
        {"9007199254740993.00000000000000000000001", 9007199254740994.0},
        {".5", 0.5},
        {"-1.", -1.0},
        {"1.5+3", 1500.0},
        {"1.5-3", 0.0015},
        {"1.5d+3", 1500.0},
        {"+2.5D-1", 0.25},
        {"0.0E+000", 0.0},
        {"4.9406564584124654E-324", 0x1p-1074},
        {"1.7976931348623157E308", 0x1.fffffffffffffp1023},
        {"123456789012345678901234567890", 123456789012345678901234567890.0},
    };
    static const char *const bad[] = {"", ".", "-", "E5", "1E", "1E+", "x"};
    (void)state;

    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        ritz_decimal number = {0};
        const char *from = cases[k].text;

        assert_true(ritz_decimal_scan(&from, from + strlen(from), &number));
        assert_true(*from == '\0');
        assert_true(number.value == cases[k].value);
    }
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        ritz_decimal number = {0};
        const char *from = bad[k];

        assert_false(ritz_decimal_scan(&from, from + strlen(from), &number));
    }
}

/* One of 0 to n - 1. */
static uint64_t pick(uint64_t *seed, uint64_t n)
{
    return (damage_random(seed) >> 33) % n;
}

/* A number in a field of @p width letters, and perhaps one letter that does not
   belong there. */
static void print_field(uint64_t *seed, int width, int decimals, int k,
                        char *text)
{
    static const char strange[] = " +-.EeDd0123456789x\n\t";
    const double value = (double)(int64_t)damage_random(seed) * 0x1p-60;
    const int power = (int)pick(seed, 210) - 105;

    snprintf(text, 64, "%*.*E", width, decimals,
             k % 50 == 0 ? 0.0 : value * pow(10.0, power));
    if (k % 3 == 0)
        text[pick(seed, (uint64_t)width)] =
            strange[pick(seed, sizeof strange - 1)];
}

/* The number that the whole field holds. @return false if there is none */
static bool scan_whole_field(const char *text, int width, double *out)
{
    ritz_decimal number = {0};
    const char *at = ritz_decimal_skip(text, text + width);
    const bool found = ritz_decimal_scan(&at, text + width, &number) &&
                       ritz_decimal_skip(at, text + width) == text + width;

    *out = number.value;
    return found;
}

static void fields_hold_what_is_scanned_in_them(void **state)
{
    uint64_t seed = 7;
    int64_t missed = 0;
    (void)state;

    for (int k = 0; k < 300000; k++) {
        const int decimals = 1 + k % 18, width = decimals + 7 + k / 18 % 3;
        char text[64];
        double slow = 0.0, fast = 0.0;
        bool found = false;

        print_field(&seed, width, decimals, k, text);
        if (strlen(text) != (size_t)width) /* an exponent of three digits */
            continue;
        found = ritz_decimal_scan_field(text, width, decimals, &fast);
        missed += !found && k % 3 > 0 && text[width - 4] == 'E';
        assert_true(scan_whole_field(text, width, &slow) || !found);
        if (found && (slow != fast || signbit(slow) != signbit(fast)))
            fail_msg("'%s' is not %.17g", text, fast);
    }
    assert_true(missed < 100); /* 1.28E+25 is as good as between two doubles */
}

static void eight_letters_hold_what_is_scanned_in_them(void **state)
{
    static const char letters[] = "    0123456789-x";
    uint64_t seed = 11;
    int64_t usual = 0;
    (void)state;

    for (int k = 0; k < 100000; k++) {
        char text[32];
        const char *at = text;
        int64_t slow = 0, fast = 0;

        snprintf(text, sizeof text, "%8d",
                 (int)(pick(&seed, 100000000) >> pick(&seed, 27)));
        if (k % 3 == 0)
            text[pick(&seed, 8)] = letters[pick(&seed, sizeof letters - 1)];
        if (!ritz_decimal_scan_eight(text, &fast))
            continue;
        usual++;
        assert_true(ritz_decimal_scan_wholes(&at, text + 8, 1, &slow));
        assert_true(at == text + 8);
        assert_int_equal(slow, fast);
    }
    assert_true(usual > 50000);
    assert_false(ritz_decimal_scan_eight("        ", &usual));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(decimals_are_rounded_as_strtod_rounds),
    cmocka_unit_test(ties_and_odd_spellings_are_read),
    cmocka_unit_test(fields_hold_what_is_scanned_in_them),
    cmocka_unit_test(eight_letters_hold_what_is_scanned_in_them),
};

TEST_MODULE(decimal, tests, NULL, NULL)
