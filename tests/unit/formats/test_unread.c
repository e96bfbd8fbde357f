#include "testing.h"

#include "foreign.h"

#include <ritz/import.h>

#include <stdio.h>
#include <stdlib.h>

#define SAMPLE(text) (text), sizeof(text) - 1

static const struct sample {
    const char *name; /* beginning of the row's name */
    const char *text;
    size_t size;
} samples[] = {
    {"a Matrix Market file whose first line",
     SAMPLE("%MatrixMarket matrix coordinate real general\n1 1 1\n1 1 2.0\n")},
    {"a Matrix Market file whose first line",
     SAMPLE("MatrixMarket matrix array real general\n1 1\n2.0\n")},
    {"a list of dofs of CalculiX", SAMPLE("1.1\n1.2\n1.3\n12.1\n")},
    {"a binary file of ANSYS",
     SAMPLE("\x64\0\0\0\0\0\0\x80\x04\0\0\0\0\0\0\0")},
    {"a binary file of ANSYS", SAMPLE("\0\0\0\x64\x80\0\0\0\0\0\0\x0c")},
    {"a list of ANSYS", SAMPLE("Node Number\tX\n1\t0,1\n")},
};

enum { NUM_SAMPLES = sizeof samples / sizeof *samples };

static bool is_of_row(const struct sample *s, const ritz_unread *row)
{
    return row && strncmp(row->name, s->name, strlen(s->name)) == 0;
}

static void each_row_is_recognised(void **state)
{
    (void)state;
    for (int k = 0; k < NUM_SAMPLES; k++) {
        const ritz_unread *row =
            ritz_unread_find(samples[k].text, (int64_t)samples[k].size);

        if (!is_of_row(&samples[k], row))
            fail_msg("sample %d: %s, not %s", k, row ? row->name : "none",
                     samples[k].name);
    }
    for (const ritz_unread *row = ritz_unread_formats; row->name; row++) {
        bool any = false;

        for (int k = 0; k < NUM_SAMPLES; k++)
            any = any || is_of_row(&samples[k], row);
        if (!any)
            fail_msg("no sample is %s", row->name);
    }
}

static void a_refusal_says_what_it_is_and_what_to_do(void **state)
{
    ritz_matrices all = {0};
    ritz_deck deck = {0};
    (void)state;

    for (int k = 0; k < NUM_SAMPLES; k++) {
        const char *text = samples[k].text;
        int64_t size = (int64_t)samples[k].size;

        assert_fails(foreign_parse(text, size, &all), RITZ_ERR_FORMAT,
                     samples[k].name);
        assert_non_null(strstr(ritz_error_message(), "docs/import.md"));
        assert_fails(ritz_deck_parse("a.inp", text, size, NULL, &deck),
                     RITZ_ERR_FORMAT, samples[k].name);
        assert_non_null(strstr(ritz_error_message(), "a.inp: looks like"));
    }
}

static void formats_that_are_read_are_not_taken_for_others(void **state)
{
    static const char *const texts[] = {
        "",
        "\n\n",
        "$ a deck\nGRID,1,,0.,0.,0.\n",
        "NASTRAN BANDIT=-1\nID A,B\nSOL 1\nCEND\nBEGIN BULK\nENDDATA\n",
        "*CONT   0.0\n",
        "** a\n\n*Heading\n** b\n*Node\n",
        "SET 1 = 1\n1 1 1\n",
        "%%MatrixMarket matrix coordinate real general\n1 1 1\n1 1 2.0\n",
        "1 1\n1 2\n", /* names of dofs */
        "345 345 7002\n1 1 1.6e8\n",
        "1 1  3.5e+10\n1 2 -7.8e+09\r\n2 1 -7.8e+09\n\n2 2 3.5e+10\n",
        "1 1  8.13E+08\n1 2  2.15E+02\n2 2  1.20E+09\n",
        "1.5\n2.25\n",
        "0.1 2\n",
        "hello\n",
        "RSA 1 1\n1 1 1 1\n",
    };
    (void)state;

    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
        const ritz_unread *row =
            ritz_unread_find(texts[k], (int64_t)strlen(texts[k]));

        if (row)
            fail_msg("'%s' is taken for %s", texts[k], row->name);
    }
}

/* Each copy fills a heap block of its size, so that sanitisers detect reads
   beyond it. */
static void a_file_that_is_cut_is_not_read_beyond_its_end(void **state)
{
    (void)state;
    for (int k = 0; k < NUM_SAMPLES; k++)
        for (size_t size = 0; size <= samples[k].size; size++) {
            char *copy = malloc(size > 0 ? size : 1);

            assert_non_null(copy);
            memcpy(copy, samples[k].text, size);
            (void)ritz_unread_find(copy, (int64_t)size);
            free(copy);
        }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(each_row_is_recognised),
    cmocka_unit_test(a_refusal_says_what_it_is_and_what_to_do),
    cmocka_unit_test(formats_that_are_read_are_not_taken_for_others),
    cmocka_unit_test(a_file_that_is_cut_is_not_read_beyond_its_end),
};

TEST_MODULE(unread, tests, NULL, NULL)
