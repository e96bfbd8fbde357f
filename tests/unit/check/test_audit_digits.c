/* source-digits: numbers that were rounded, and numbers that are short. */
#include "masses.h"
#include "project.h"
#include "testing.h"

#include <ritz/check.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { MASSES = 14 };

/* A row on springs k, whose source declares a number of digits. */
static ritz_audit audit_of(int64_t n, const double *k, int64_t declared,
                           const char *format)
{
    double m[MASSES];
    char text[64];
    RITZ_OWN(ritz_component) row = {0};
    ritz_audit audit = {0};

    for (int64_t i = 0; i < n; i++)
        m[i] = 1.0;
    assert_ok(masses_component(n, m, k, NULL, &row));
    row.digits = (double)declared;
    for (int64_t p = 0; format && p < row.K.colptr[n]; p++) {
        /* a format of the test's own */
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
        snprintf(text, sizeof text, format, row.K.val[p]);
#pragma GCC diagnostic pop
        row.K.val[p] = strtod(text, NULL);
    }
    assert_ok(ritz_audit_component(&row, &audit));
    return audit;
}

static void assert_digits(int64_t n, const double *k, int64_t declared,
                          const char *format, ritz_verdict verdict,
                          double digits)
{
    RITZ_OWN(ritz_audit) audit = audit_of(n, k, declared, format);
    const ritz_check *check = find_check(&audit, "source-digits");

    for (int64_t i = 0; i < audit.count; i++)
        assert_true(audit.check[i].verdict != RITZ_FAIL);
    if (check->verdict != verdict || check->value != digits)
        fail_msg("%s: %g digits, %s", ritz_verdict_name(check->verdict),
                 check->value, check->says);
}

/* Held by 1 beside 200: half a unit of one digit, if these were rounded. */
static void whole_numbers_are_what_they_say(void **)
{
    const double k[] = {1, 200, 400, 200, 300};
    const double tens[] = {20, 1070, 1530, 380};

    assert_digits(5, k, 3, NULL, RITZ_PASS, 17.0);
    assert_digits(4, tens, 4, NULL, RITZ_PASS, 17.0);
}

static void short_decimals_are_what_they_say(void **)
{
    const double k[] = {0.5, 1.25, 2.75, 0.125};

    assert_digits(4, k, 4, NULL, RITZ_PASS, 17.0);
}

/* Sums of long and short whole numbers have all numbers of digits. */
static void sums_of_whole_numbers_are_exact(void **)
{
    const double k[] = {2e6,  1e7, 15, 1070, 1530, 1e8, 380,
                        2500, 3e6, 70, 9e5,  12,   1e5, 4e4};

    assert_digits(MASSES, k, 9, NULL, RITZ_PASS, 17.0);
}

/* 12 345 and its double may be five digits of something: no harm is seen. */
static void few_whole_numbers_of_five_digits_pass(void **)
{
    const double k[] = {12345, 12345, 12345};

    assert_digits(3, k, 5, NULL, RITZ_PASS, 5.0);
}

static void what_was_rounded_warns(void **)
{
    double k[MASSES];

    for (int i = 0; i < MASSES; i++) /* over two decades */
        k[i] = 1e4 * exp(2.0 + sin(1.0 + 7.0 * i) * 2.3);
    assert_digits(MASSES, k, 6, "%.5e", RITZ_WARN, 6.0);
    assert_digits(MASSES, k, 9, "%.3f", RITZ_WARN, 9.0);
    assert_digits(MASSES, k, 0, NULL, RITZ_PASS, 17.0);
}

/* A reader that knows of few digits, as of single precision, is believed
   where the values do not contradict it. */
static void digits_of_the_source_are_kept(void **)
{
    double k[MASSES];

    for (int i = 0; i < MASSES; i++)
        k[i] = (double)(float)(1e4 * exp(2.0 + sin(1.0 + 7.0 * i) * 2.3));
    assert_digits(MASSES, k, 7, NULL, RITZ_WARN, 7.0);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(whole_numbers_are_what_they_say),
    cmocka_unit_test(short_decimals_are_what_they_say),
    cmocka_unit_test(sums_of_whole_numbers_are_exact),
    cmocka_unit_test(few_whole_numbers_of_five_digits_pass),
    cmocka_unit_test(what_was_rounded_warns),
    cmocka_unit_test(digits_of_the_source_are_kept),
};

TEST_MODULE(audit_digits, tests, NULL, NULL)
