/* Decks through ritz_deck_parse(), which recognises their format. */
#include "testing.h"

#include <ritz/import.h>

#include <stdio.h>
#include <unistd.h>

static void each_format_of_decks_says_what_it_is(void **state)
{
    (void)state;
    for (int k = 0; ritz_decks[k]; k++) {
        assert_true(*ritz_decks[k]->name && *ritz_decks[k]->title);
        assert_true(*ritz_decks[k]->reference);
        assert_non_null(ritz_decks[k]->recognise);
        assert_non_null(ritz_decks[k]->parse);
    }
    assert_ptr_equal(ritz_deck_recognise("GRID,1\n", 7), &ritz_deck_nastran);
    assert_ptr_equal(ritz_deck_recognise("*NODE\n", 6), &ritz_deck_inp);
    assert_null(ritz_deck_recognise("GRID\0", 5));
}

/* An inp deck begins with any keyword; editors put a byte order mark first. */
static void decks_are_recognised_by_their_first_line(void **state)
{
    static const struct {
        const char *text;
        const ritz_deck_format *format;
    } cases[] = {
        {"*PHYSICAL CONSTANTS, ABSOLUTE ZERO=0\n", &ritz_deck_inp},
        {"** GRID\n\n *Contact\n", &ritz_deck_inp},
        {"\xef\xbb\xbf*HEADING\n", &ritz_deck_inp},
        {"\xef\xbb\xbfGRID,1\n", &ritz_deck_nastran},
        {"*KEYWORD\n*NODE\n", &ritz_deck_nastran}, /* LS-DYNA */
        {"*KEYWORD, MEMORY=100m\n", &ritz_deck_nastran},
        {"* 7\n", &ritz_deck_nastran},
        {"*\n", &ritz_deck_nastran},
    };
    RITZ_OWN(ritz_deck) deck = {0};

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        assert_ptr_equal(
            ritz_deck_recognise(cases[k].text, (int64_t)strlen(cases[k].text)),
            cases[k].format);
    assert_ok(ritz_deck_parse("a.bdf", "\xef\xbb\xbfGRID,1\n", 10, ".", &deck));
    assert_int_equal(deck.grids.count, 1);
    ritz_deck_free(&deck);
    assert_ok(
        ritz_deck_parse("a.inp", "\xef\xbb\xbf*NODE\n4\n", 11, ".", &deck));
    assert_int_equal(deck.grids.id[0], 4);
}

static void a_deck_names_its_format_and_all_its_dofs(void **state)
{
    static const char TEXT[] = "GRID,7\nGRID,2\nSPOINT,5\n";
    const ritz_dof last = {7, 6};
    RITZ_OWN(ritz_deck) deck = {0};
    (void)state;

    assert_ok(
        ritz_deck_parse("a.bdf", TEXT, (int64_t)strlen(TEXT), ".", &deck));
    assert_ptr_equal(deck.format, &ritz_deck_nastran);
    assert_int_equal(deck.num_dofs, 13);
    for (int64_t k = 1; k < deck.num_dofs; k++)
        assert_true(ritz_dof_compare(&deck.dof[k - 1], &deck.dof[k]) < 0);
    assert_int_equal(deck.dof[6].grid, 5);
    assert_int_equal(deck.dof[6].component, 0);
    assert_int_equal(ritz_dof_compare(&deck.dof[12], &last), 0);
}

static void bytes_that_are_no_deck_are_refused(void **state)
{
    ritz_deck deck = {0};
    FILE *file = fopen("none.bdf", "wb");
    (void)state;

    assert_non_null(file);
    assert_int_equal(fwrite("GRID\0", 1, 5, file), 5);
    assert_int_equal(fclose(file), 0);
    assert_fails(ritz_deck_read("none.bdf", &deck), RITZ_ERR_FORMAT,
                 "'none.bdf' is not a text file");
    assert_int_equal(unlink("none.bdf"), 0);
    assert_fails(ritz_deck_read("none.bdf", &deck), RITZ_ERR_FILE, "none.bdf");
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(each_format_of_decks_says_what_it_is),
    cmocka_unit_test(decks_are_recognised_by_their_first_line),
    cmocka_unit_test(a_deck_names_its_format_and_all_its_dofs),
    cmocka_unit_test(bytes_that_are_no_deck_are_refused),
};

TEST_MODULE(decks, tests, NULL, NULL)
