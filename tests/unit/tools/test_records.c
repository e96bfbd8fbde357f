/* Run records, as charts read them. */
#include "testing.h"

#include "folder.h"

#include "cli/records.h"

#include <math.h>

static ritz_status read_text(const char *text, records *out)
{
    return records_read(folder_write("runs.jsonl", text), out);
}

/* One line as ritz-fit writes it. */
#define LINE(method, order, error, more)                                       \
    "{\"tool\":\"ritz-fit\",\"method\":\"" method "\",\"order\":" #order       \
    ",\"errors\":{\"response-relative\":" #error                               \
    ",\"mac\":0.99},\"seconds\":{\"cpu\":0.5}" more "}\n"

static void records_hold_what_lines_say(void **state)
{
    records all = {0};
    record_set some = {0};
    const measure *m = some.measure;

    (void)state;
    assert_int_equal(
        read_text(LINE("b", 8, 1e-2, "") "\n" LINE(
                      "a", 12, 1e-4,
                      ",\"tolerance\":{\"mac\":0.9},\"chosen\":true,"
                      "\"cost\":{\"seconds_per_second\":2e-3,"
                      "\"integrator\":\"modal\"}"),
                  &all),
        RITZ_OK);
    assert_int_equal(all.count, 2);
    assert_true(all.item[1].cost == 2e-3 && all.item[1].cpu == 0.5);
    assert_true(isnan(all.item[0].cost) && all.item[1].chosen);
    assert_int_equal(record_set_new(&all, NULL, &some), RITZ_OK);
    assert_int_equal(some.num_measures, 2);
    assert_string_equal(m[0].name, "mac"); /* it has a tolerance */
    assert_true(fabs(m[0].tolerance - 0.1) < 1e-15);
    assert_true(fabs(record_error(&all.item[0], "mac") - 0.01) < 1e-15);
    assert_true(isnan(record_error(&all.item[0], "h2-relative")));
    record_set_free(&some);
    records_free(&all);
}

static void methods_are_sorted(void **state)
{
    records all = {0};
    record_set some = {0};

    (void)state;
    assert_int_equal(read_text(LINE("b", 8, 1, "") LINE("a", 8, 1, "")
                                   LINE("b", 9, 1, ""),
                               &all),
                     RITZ_OK);
    assert_int_equal(record_set_new(&all, NULL, &some), RITZ_OK);
    assert_int_equal(some.num_methods, 2);
    assert_string_equal(some.method[0], "a");
    assert_int_equal(some.which[0], 1);
    assert_int_equal(some.which[1], 0);
    assert_int_equal(some.which[2], 1);
    record_set_free(&some);
    records_free(&all);
}

static void a_line_that_is_repeated_counts_once(void **state)
{
    records all = {0};
    record_set some = {0};

    (void)state;
    assert_int_equal(read_text(LINE("a", 8, 1e-3, "") LINE("a", 9, 1e-3, "")
                                   LINE("a", 8, 1e-3, ",\"chosen\":true"),
                               &all),
                     RITZ_OK);
    assert_int_equal(record_set_new(&all, NULL, &some), RITZ_OK);
    assert_int_equal(some.all.count, 2);
    assert_true(some.all.item[0].chosen && some.all.item[0].order == 8);
    record_set_free(&some);
    records_free(&all);
}

static void limits_that_are_not_met_are_not(void **state)
{
    static const struct {
        const char *line;
        bool feasible;
    } cases[] = {
        {LINE("a", 8, 1e-2, ""), true},
        {LINE("a", 8, 1e-2, ",\"ok\":false"), false},
        {LINE("a", 8, 1e-2, ",\"tolerance\":{\"response-relative\":1e-2}"),
         true},
        {LINE("a", 8, 1e-2, ",\"tolerance\":{\"response-relative\":1e-3}"),
         false},
        {LINE("a", 8, 1e-2, ",\"tolerance\":{\"mac\":0.999}"), false},
        {LINE("a", 8, 1e-2, ",\"tolerance\":{\"h2-relative\":1}"), false},
        {LINE("a", 8, null, ",\"tolerance\":{\"response-relative\":1}"), false},
        {LINE("a", 8, 9, ",\"feasible\":true"), true},
    };

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        records all = {0};

        assert_int_equal(read_text(cases[k].line, &all), RITZ_OK);
        assert_int_equal(all.item[0].feasible, cases[k].feasible);
        records_free(&all);
    }
}

static void verified_files_cost_what_made_them(void **state)
{
    static const char text[] =
        "{\"tool\":\"ritz-import\",\"command\":\"ritz-import -o a.h5\","
        "\"seconds\":{\"cpu\":100}}\n"
        "{\"tool\":\"ritz-basis\",\"command\":\"ritz-basis m a.h5 -o b.h5\","
        "\"inputs\":[\"0  a.h5\"],\"seconds\":{\"cpu\":1}}\n"
        "{\"tool\":\"ritz-reduce\",\"command\":\"ritz-reduce a.h5 b.h5 "
        "--output='r s.h5'\",\"inputs\":[\"0  a.h5\",\"0  b.h5\"],"
        "\"seconds\":{\"cpu\":2}}\n"
        "{\"tool\":\"ritz-verify\",\"method\":\"m\",\"order\":3,\"errors\":"
        "{\"mac\":1},\"inputs\":[\"0  a.h5\",\"0  r s.h5\"],"
        "\"command\":\"ritz-verify\",\"seconds\":{\"cpu\":50}}\n"
        "{\"tool\":\"ritz-simulate\",\"inputs\":[\"0  r s.h5\"],"
        "\"cost\":{\"seconds_per_second\":0.25}}\n";
    records all = {0};

    (void)state;
    assert_int_equal(read_text(text, &all), RITZ_OK);
    records_join(&all);
    assert_true(all.item[3].cpu == 3.0);
    assert_true(all.item[3].cost == 0.25);
    records_free(&all);
}

static void lines_that_are_no_records_are_named(void **state)
{
    static const struct {
        const char *text, *words;
    } cases[] = {
        {LINE("a", 8, 1, "") "{\"x\":", "runs.jsonl', line 2: no JSON"},
        {"[1, 2]\n", "line 1: no record, which is a JSON object"},
        {"{\"order\":1.5}", "line 1: 'order' is no whole number"},
        {"{\"order\":-3}", "line 1: 'order' is no whole number"},
        {"{\"method\":7}", "line 1: 'method' is no text"},
        {"{\"errors\":[1]}", "'errors' is no object of names and numbers"},
        {"{\"errors\":{\"mac\":\"1\"}}", "'mac' of 'errors' is no number"},
        {"{\"order\":1,\"order\":2}", "line 1: no JSON"},
        {"{\"errors\":{\"mac\":NaN}}", "line 1: no JSON"},
    };

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        records all = {0};

        assert_fails(read_text(cases[k].text, &all), RITZ_ERR_FORMAT,
                     cases[k].words);
        records_free(&all);
    }
}

static void records_that_do_not_compare_are_refused(void **state)
{
    records all = {0};
    record_set some = {0};

    (void)state;
    assert_int_equal(read_text(LINE("a", 8, 1, ",\"subject\":\"rotor\"")
                                   LINE("a", 8, 1, ",\"subject\":\"stator\""),
                               &all),
                     RITZ_OK);
    assert_fails(record_set_new(&all, NULL, &some), RITZ_ERR_ARGUMENT,
                 "records of 'rotor' and of 'stator' do not compare");
    record_set_free(&some);
    assert_fails(record_set_new(&all, "x", &some), RITZ_ERR_ARGUMENT,
                 "no record of 'x'");
    record_set_free(&some);
    assert_int_equal(record_set_new(&all, "stator", &some), RITZ_OK);
    assert_int_equal(some.all.count, 1);
    record_set_free(&some);
    records_free(&all);
    assert_int_equal(read_text("{\"method\":\"a\",\"order\":3}", &all),
                     RITZ_OK);
    assert_fails(record_set_new(&all, NULL, &some), RITZ_ERR_ARGUMENT,
                 "no record has a method, an order and errors");
    record_set_free(&some);
    records_free(&all);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(records_hold_what_lines_say),
    cmocka_unit_test(methods_are_sorted),
    cmocka_unit_test(a_line_that_is_repeated_counts_once),
    cmocka_unit_test(limits_that_are_not_met_are_not),
    cmocka_unit_test(verified_files_cost_what_made_them),
    cmocka_unit_test(lines_that_are_no_records_are_named),
    cmocka_unit_test(records_that_do_not_compare_are_refused),
};

TEST_MODULE(records, tests, folder_make, folder_remove)
