#include "testing.h"

#include <ritz/basis.h>

#include <string.h>

static const ritz_choice_word *word(const char *key)
{
    const ritz_choice_word *w = ritz_choice_words;

    while (w->key && strcmp(w->key, key) != 0)
        w++;
    assert_non_null(w->key);
    return w;
}

static ritz_status take(const char *key, const char *text, ritz_choice *choice)
{
    return ritz_choice_take(word(key), text, choice);
}

static void words_set_what_they_name(void **state)
{
    ritz_choice c = {0};

    (void)state;
    assert_ok(take("shift_hz", "0,2.5", &c));
    assert_int_equal(c.num_shifts, 2);
    assert_near(c.shift_hz[1], 2.5, 0.0);
    assert_ok(take("loads", "inputs,dampers", &c));
    assert_int_equal(c.loads, RITZ_LOADS_INPUTS | RITZ_LOADS_DAMPERS);
    assert_ok(take("inner", "mass", &c));
    assert_int_equal(c.inner, RITZ_INNER_MASS);
    assert_ok(take("interface_modes", "8", &c));
    assert_int_equal(c.interface_modes, 8);
    assert_ok(take("gramian", "outputs", &c));
    assert_int_equal(c.gramian, RITZ_GRAMIAN_OUTPUTS);
    assert_ok(take("operator", "inverse", &c));
    assert_true(c.inverse);
    assert_ok(take("damping", "modal 0.01", &c));
    assert_near(c.damping.zeta, 0.01, 0.0);
}

static void what_was_given_is_remembered_and_printed(void **state)
{
    ritz_choice c = {0};
    char text[200] = "modes 4";
    char none[8] = "";

    (void)state;
    ritz_choice_print(&c, sizeof none, none);
    assert_string_equal(none, "");
    assert_ok(take("shift_hz", "0,2.5", &c));
    assert_ok(take("inner", "mass", &c));
    assert_ok(take("interface_modes", "8", &c));
    assert_int_equal(c.given,
                     RITZ_USES_SHIFTS | RITZ_USES_INNER | RITZ_USES_INTERFACE);
    ritz_choice_print(&c, sizeof text, text);
    assert_string_equal(text,
                        "modes 4 shift-hz 0,2.5 inner mass interface-modes 8");
}

static void a_print_that_does_not_fit_is_cut(void **state)
{
    ritz_choice c = {0};
    char text[16] = "";

    (void)state;
    assert_ok(take("shift_hz", "1,2,3,4,5,6,7,8,9", &c));
    ritz_choice_print(&c, sizeof text, text);
    assert_string_equal(text, "shift-hz 1,2,3,");
}

/* A text that is too long is cut and nothing is written beyond its buffer. */
static void a_print_keeps_to_its_room(void **state)
{
    struct {
        char text[16], after[16];
    } room = {"", "a_b_c"};
    ritz_choice c = {0};

    (void)state;
    assert_ok(take("shift_hz", "1,2,3,4,5,6,7,8,9", &c));
    assert_ok(take("interface_modes", "8", &c));
    ritz_choice_print(&c, sizeof room.text, room.text);
    assert_string_equal(room.text, "shift-hz 1,2,3,");
    assert_string_equal(room.after, "a_b_c");
}

static void bad_values_are_refused(void **state)
{
    static const struct {
        const char *key, *text, *sentence;
    } cases[] = {
        {"shift_hz", "",
         "expansion point '' is not a frequency of 0 Hz or "
         "above"},
        {"shift_hz", "1,-2",
         "expansion point '-2' is not a frequency of 0 Hz "
         "or above"},
        {"shift_hz", "nan",
         "expansion point 'nan' is not a frequency of 0 Hz "
         "or above"},
        {"shift_hz", "1,1", "expansion point 1 Hz is given twice"},
        {"shift_hz", "0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16",
         "there can be 16 expansion points, not more"},
        {"loads", "inptus", "unknown load 'inptus', is 'inputs' meant?"},
        {"loads", "inputs,",
         "unknown load '', there is attached, inputs, "
         "outputs, dampers"},
        {"inner", "K", "unknown inner product 'K', there is stiffness, mass"},
        {"interface_modes", "0",
         "'0' is no number of interface modes, 1 or more"},
        {"gramian", "both", "unknown Gramian 'both', there is inputs, outputs"},
        {"operator", "A", "unknown operator 'A', there is state, inverse"},
        {"damping", "modal 2",
         "damping ratio 2 is overdamped, it must stay below 1"},
    };

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        ritz_choice c = {0};

        assert_fails(take(cases[k].key, cases[k].text, &c), RITZ_ERR_ARGUMENT,
                     cases[k].sentence);
        assert_int_equal(c.given, 0);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(words_set_what_they_name),
    cmocka_unit_test(what_was_given_is_remembered_and_printed),
    cmocka_unit_test(a_print_that_does_not_fit_is_cut),
    cmocka_unit_test(a_print_keeps_to_its_room),
    cmocka_unit_test(bad_values_are_refused),
};

TEST_MODULE(choice, tests, NULL, NULL)
