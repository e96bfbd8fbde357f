/* The tokenizer of NASTRAN cards: one card, however it is spelled. */
#include "testing.h"

#include "formats/cards.h"

#include <stdio.h>

static ritz_status parse(const char *text, ritz_cards *out)
{
    return ritz_cards_parse("t.dat", text, (int64_t)strlen(text), NULL, out);
}

/* Fields of the k-th card with '|' behind each, for comparison at a glance. */
static void fields_of(const char *text, int64_t k, char *out, size_t size)
{
    RITZ_OWN(ritz_cards) cards = {0};
    RITZ_OWN(ritz_card) card = {0};
    size_t used = 0;

    assert_ok(parse(text, &cards));
    assert_true(k < cards.num_entries);
    assert_ok(ritz_card_take(&cards, k, &card));
    used = (size_t)snprintf(out, size, "%s:", card.entry->name);
    for (int64_t j = 0; j < card.count; j++)
        used += (size_t)snprintf(out + used, size - used, "%s|",
                                 ritz_card_text(&card, j));
}

static void assert_fields(const char *text, const char *expected)
{
    char found[600];

    fields_of(text, 0, found, sizeof found);
    assert_string_equal(found, expected);
}

static void small_large_and_free_fields_say_the_same(void **state)
{
    static const char EXPECTED[] = "GRID:101||1.|2.|3.|10|123456|";

    (void)state;
    assert_fields("GRID    101             1.      2.      3.      10      "
                  "123456\n",
                  EXPECTED);
    assert_fields("GRID*   101                             1.              "
                  "2.\n*       3.              10              123456\n",
                  EXPECTED);
    assert_fields("GRID,101,,1.,2.,3.,10,123456\n", EXPECTED);
    assert_fields("grid , 101 ,  , 1., 2.,3.,10,123456 $ note\r\n", EXPECTED);
    assert_fields("GRID*,101,,1.,2.\n*,3.,10,123456", EXPECTED);
    assert_fields("GRID\t101\t\t1.\t2.\t3.\t10\t123456", EXPECTED);
    assert_fields("GRID,101,,1.,2.,3.,10,123456", EXPECTED);
}

static void continuations_are_found_by_marker_or_by_place(void **state)
{
    static const char EXPECTED[] = "RBE2:1|2|3|4|5|6|7|8|9|10|";
    static const char HEAD[] =
        "RBE2    1       2       3       4       5       6       7       8    ";
    char text[400];
    static const char *const TAILS[] = {
        "   +C1\n+C1     9       10\n",
        "   \n        9       10\n",
        "   +\n+       9       10\n",
        "   \n$ comment\n\n+       9       10\n",
        "   +C1\n+C1,9,10\n",
        "   \n,9,10\n",
        "   \n+,9,10\n",
        "   C1\n+1      9       10\n", /* column 73 does not count */
        ("   00000012\n"
         "        9       10                                "
         "                      00000013\n"),
        "   \n*       9               10\n",
        /* both out of order */
        ("   +c1\nGRID    5                                       "
         "                        +X\n"
         "+C1     9       10\n+X      1.\n"),
        "   +C1\nGRID    5\n+C1     9       10\n",
    };

    (void)state;
    for (size_t k = 0; k < sizeof TAILS / sizeof *TAILS; k++) {
        snprintf(text, sizeof text, "%s%s", HEAD, TAILS[k]);
        assert_fields(text, EXPECTED);
    }
    assert_fields("RBE2,1,2,3,4,5,6,7,8,+A\n+A,9,10\n", EXPECTED);
    assert_fields("RBE2,1,2,3,4,5,6,7,8\n,9,10\n", EXPECTED);
}

static void a_small_line_after_one_large_line_leaves_a_gap(void **state)
{
    (void)state;
    assert_fields("DMIG*   K                              1               1\n"
                  "+       2       1       5.\n",
                  "DMIG:K|1|1||||||2|1|5.|");
}

static void a_marker_may_end_a_free_line_early(void **state)
{
    (void)state;
    assert_fields("GRID,1,,2.,+\n+,7\n", "GRID:1||2.||||||7|");
    assert_fields("GRID,1,,2.,+3\n", "GRID:1||2.|+3|");
}

static void control_sections_are_left_out(void **state)
{
    char found[200];
    static const char *const DECKS[] = {
        "SOL 103\nCEND\nSPC = 5\nBEGIN BULK\nGRID,1\nENDDATA\nGRID,2\n",
        "begin  bulk\nGRID,1\n",
        "$TITLE   = x\n$LABEL\nBEGIN SUPER=102\nGRID,1\n",
        "INCLUDE 'no/such/file'\nCEND\nBEGIN BULK $ here\nGRID,1\nenddata",
        "GRID,1",
    };

    (void)state;
    for (size_t k = 0; k < sizeof DECKS / sizeof *DECKS; k++) {
        ritz_cards cards = {0};

        assert_ok(parse(DECKS[k], &cards));
        assert_int_equal(cards.num_entries, 1);
        ritz_cards_free(&cards);
        fields_of(DECKS[k], 0, found, sizeof found);
        assert_string_equal(found, "GRID:1|");
    }
}

static void the_case_control_says_which_sets_act(void **state)
{
    RITZ_OWN(ritz_cards) cards = {0};

    (void)state;
    assert_ok(parse("SPC = 9\nCEND\n  spc=5\nMPC = 7 $ x\nMPCFORCES = 3\n"
                    "SUBCASE 1\nSPC(X) = 6\nBEGIN BULK\n",
                    &cards));
    assert_int_equal(cards.num_selected[RITZ_SELECT_SPC], 3);
    assert_int_equal(cards.selected[RITZ_SELECT_SPC][1], 5);
    assert_int_equal(cards.selected[RITZ_SELECT_SPC][2], 6);
    assert_int_equal(cards.num_selected[RITZ_SELECT_MPC], 1);
    assert_int_equal(cards.selected[RITZ_SELECT_MPC][0], 7);
}

static void numbers_are_read_in_nastran_spelling(void **state)
{
    static const struct {
        const char *text;
        double value;
        int64_t digits;
    } GOOD[] = {
        {"1.5D+3", 1500.0, 2},
        {"1.5+3", 1500.0, 2},
        {".5", 0.5, 1},
        {"-1.-3", -0.001, 1},
        {"7", 7.0, 1},
        {"+2.5e-1", 0.25, 2},
        {"1.d0", 1.0, 1},
        {"6.894+7", 68940000.0, 4},
        {"-1.556000000D+02", -155.6, 10},
        {"0.000", 0.0, 0},
        {"0.0012300", 0.00123, 5},
        {"-0.", 0.0, 0},
    };
    static const char *const BAD[] = {"",    "x",    "1.5.2", "1.5+",     "--1",
                                      "1 2", "nan",  "1e999", "1.5E+3+2", "inf",
                                      "+",   "0x10", "1,5"};
    double value = 0.0;

    (void)state;
    for (size_t k = 0; k < sizeof GOOD / sizeof *GOOD; k++) {
        assert_true(ritz_card_number(GOOD[k].text, &value));
        assert_near(value, GOOD[k].value, 0.0); /* rounded as the compiler */
        assert_int_equal(ritz_card_digits(GOOD[k].text), GOOD[k].digits);
    }
    for (size_t k = 0; k < sizeof BAD / sizeof *BAD; k++)
        assert_false(ritz_card_number(BAD[k], &value));
}

static ritz_status parse_all(const char *text)
{
    RITZ_OWN(ritz_cards) cards = {0};
    RITZ_OWN(ritz_card) card = {0};

    RITZ_CHECK(parse(text, &cards));
    for (int64_t k = 0; k < cards.num_entries; k++)
        RITZ_CHECK(ritz_card_take(&cards, k, &card));
    return RITZ_OK;
}

static void what_is_no_card_is_refused_with_its_line(void **state)
{
    static const struct {
        const char *text, *words;
    } CASES[] = {
        {"\n+C1     2\n", "'t.dat', line 2: the continuation '+C1     ' "
                          "belongs to no card"},
        {"GRID    1\n+C1     2\n", "line 2: the continuation"},
        {"GRID    1\n+A                                                     "
         "                 +A\n",
         "belongs to no card"}, /* a circle of one */
        {"GRID,1\n+A,1\n+B,2\n+A,3\n", "another continuation has the marker"},
        {"A,1,2,3,4,5,6,7,8,+C\nB,1,2,3,4,5,6,7,8,+C\nD,1\n+C,3\n",
         "line 2: another line is continued by '+C' too"},
        {"GRID,1,2,3,4,5,6,7,8,9\n", "a line of GRID has more than 8 fields"},
        {"GRID 1  2\n", "'GRID 1' is not the name of a card alone"},
        {"GRID,1234567890123456789012345678901234567890\n",
         "is too long for a field"},
        {"CEND\nGRID,1\n", "holds CEND but no BEGIN BULK"},
    };

    (void)state;
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++)
        assert_fails(parse_all(CASES[k].text), RITZ_ERR_FORMAT, CASES[k].words);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    assert_survives_every_allocation(
        parse_all("CEND\nSPC=1\nBEGIN BULK\nA,1,2,3,4,5,6,7,8,+C\nB,1\n"
                  "+C,3\n"));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(small_large_and_free_fields_say_the_same),
    cmocka_unit_test(continuations_are_found_by_marker_or_by_place),
    cmocka_unit_test(a_small_line_after_one_large_line_leaves_a_gap),
    cmocka_unit_test(a_marker_may_end_a_free_line_early),
    cmocka_unit_test(control_sections_are_left_out),
    cmocka_unit_test(the_case_control_says_which_sets_act),
    cmocka_unit_test(numbers_are_read_in_nastran_spelling),
    cmocka_unit_test(what_is_no_card_is_refused_with_its_line),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(cards, tests, NULL, NULL)
