/* EXTRN: which rows the matrices of an external superelement have. */
#include "testing.h"

#include "damage.h"
#include "formats/cards.h"
#include "solvers.h"

#include <ritz/import.h>

#include <stdio.h>
#include <stdlib.h>

static ritz_status parse(const char *text, ritz_deck *out)
{
    return ritz_deck_parse("t.pch", text, (int64_t)strlen(text), ".", out);
}

/* Compare the rows of a deck with a list such as "5.1 5.2 9.0". */
static void assert_rows(const char *text, const char *expected)
{
    RITZ_OWN(ritz_deck) deck = {0};
    char rows[400] = "";
    size_t used = 0;

    assert_ok(parse(text, &deck));
    assert_null(deck.external_twice);
    for (int64_t k = 0; k < deck.num_external; k++)
        used += (size_t)snprintf(rows + used, sizeof rows - used, "%s%d.%d",
                                 k > 0 ? " " : "", (int)deck.external[k].grid,
                                 (int)deck.external[k].component);
    assert_string_equal(rows, expected);
}

static void rows_are_in_the_order_of_the_pairs(void **state)
{
    (void)state;
    assert_rows("BEGIN SUPER      102\n"
                "EXTRN          9     123       3      16\n"
                "            1001       0    1003            1002       1\n"
                "GRID           3\nGRID           9\n"
                "SPOINT      1001    THRU    1003\n",
                "9.1 9.2 9.3 3.1 3.6 1001.0 1003.0 1002.0");
}

static void a_range_names_the_grids_that_exist(void **state)
{
    (void)state;
    assert_rows("GRID,2\nGRID,4\nGRID,7\nSPOINT,5\n"
                "EXTRN,2,THRU,6,1,7,3\n",
                "2.1 4.1 5.0 7.3");
    assert_rows("EXTRN,8,1,,,2,THRU,4,3\n", "8.1 2.3 3.3 4.3");
}

static void a_row_named_twice_is_kept_as_a_sentence(void **state)
{
    RITZ_OWN(ritz_deck) deck = {0};

    (void)state;
    assert_ok(parse("EXTRN,1,12\nEXTRN,2,1\nEXTRN,1,2\n", &deck));
    assert_int_equal(deck.num_external, 4);
    assert_non_null(deck.external_twice);
    assert_string_equal(deck.external_twice,
                        "EXTRN names 'grid 1 T2' twice: a deck with one "
                        "superelement alone, or --dofs, must name the rows");
}

static void what_names_no_rows_is_refused(void **state)
{
    static const struct {
        const char *text, *says;
    } bad[] = {
        {"EXTRN,1,7\n", "'t.pch', line 1: '7' in EXTRN is not a list of "},
        {"EXTRN,-1,1\n", "'-1' in EXTRN is not a positive whole number"},
        {"EXTRN,5,THRU,4,1\n", "'4' in EXTRN is not at or above where THRU"},
        {"EXTRN,5,THRU\n", "a field of EXTRN is blank where a positive whole"},
        {"EXTRN,1,THRU,99999999,1\n",
         "EXTRN stands for more than 1000000 rows"},
    };

    (void)state;
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        RITZ_OWN(ritz_deck) deck = {0};

        assert_fails(parse(bad[k].text, &deck), RITZ_ERR_FORMAT, bad[k].says);
    }
}

static const char DECK[] = "BEGIN SUPER      102\n"
                           "EXTRN          3  123456      11  123456\n"
                           "            1001       0    1002       0\n"
                           "EXTRN,20,THRU,22,2\n"
                           "GRID,3\nGRID,11\nGRID,21\nGRID,22\n"
                           "SPOINT      1001    THRU    1002\n";

static ritz_status read_bytes(const char *bytes, int64_t size)
{
    RITZ_OWN(ritz_deck) deck = {0};
    char text[4096];

    assert_true(size < (int64_t)sizeof text);
    memcpy(text, bytes, (size_t)size);
    text[size] = '\0';
    return ritz_deck_parse("t.pch", text, size, NULL, &deck);
}

static void a_deck_cut_or_corrupted_anywhere_ends_well(void **state)
{
    (void)state;
    assert_rows(DECK, "3.1 3.2 3.3 3.4 3.5 3.6 11.1 11.2 11.3 11.4 11.5 11.6 "
                      "1001.0 1002.0 21.2 22.2");
    damage_cut(read_bytes, DECK, sizeof DECK - 1);
    damage_corrupt(read_bytes, DECK, sizeof DECK - 1);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    assert_survives_every_allocation(read_bytes(DECK, sizeof DECK - 1));
    assert_survives_every_allocation(read_bytes("EXTRN,1,1\nEXTRN,1,1\n", 20));
}

static void a_real_punch_file_names_its_rows(void **state)
{
    static const int64_t grid[] = {3, 11, 19, 27};
    char path[512];
    RITZ_OWN(ritz_deck) deck = {0};

    (void)state;
    if (!solvers_find(CSUPER "inboard.pch", path))
        skip();
    assert_ok(ritz_deck_read(path, &deck));
    assert_int_equal(deck.num_external, 32);
    for (int64_t k = 0; k < 24; k++) {
        assert_int_equal(deck.external[k].grid, grid[k / 6]);
        assert_int_equal(deck.external[k].component, k % 6 + 1);
    }
    for (int64_t k = 24; k < 32; k++) {
        assert_int_equal(deck.external[k].grid, 2995001 + k - 24);
        assert_int_equal(deck.external[k].component, 0);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(rows_are_in_the_order_of_the_pairs),
    cmocka_unit_test(a_range_names_the_grids_that_exist),
    cmocka_unit_test(a_row_named_twice_is_kept_as_a_sentence),
    cmocka_unit_test(what_names_no_rows_is_refused),
    cmocka_unit_test(a_deck_cut_or_corrupted_anywhere_ends_well),
    cmocka_unit_test(every_allocation_may_fail),
    cmocka_unit_test(a_real_punch_file_names_its_rows),
};

TEST_MODULE(bulk_external, tests, NULL, NULL)
