/* What a tool says, as text and as JSON of one call. */
#include "testing.h"

#include "cli/sink.h"

#include <math.h>
#include <stdlib.h>

/* A run that keeps what it says, and shows nothing. */
static void open_run(cli_run *run)
{
    *run = (cli_run){.quiet = true, .report = json_object()};
    assert_int_equal(cli_table_new(&run->said), RITZ_OK);
}

static void close_run(cli_run *run)
{
    cli_table_free(&run->said);
    json_decref(run->report);
}

static void assert_report(const cli_run *run, const char *expected)
{
    char *text = json_dumps(run->report, JSON_COMPACT);

    assert_string_equal(text, expected);
    free(text);
}

static void a_line_gives_text_and_keys(void **state)
{
    cli_run run;
    int64_t count = 7;

    (void)state;
    open_run(&run);
    sink_say(&run, "name,,count,size,open", "%-4s|%3.1f%%|%*ld|%+.1e|%d", "ab",
             12.34, 5, count, 0.5, true);
    sink_field(&run, "title", "note", "%.3s", "shortened");
    sink_set(&run, "hidden", "%g", 2.0);
    assert_string_equal(run.said.text, "ab  |12.3%|    7|+5.0e-01|1\n"
                                       "  title          sho\n");
    assert_report(&run, "{\"name\":\"ab\",\"count\":7,\"size\":0.5,"
                        "\"open\":true,\"note\":\"shortened\",\"hidden\":2.0}");
    close_run(&run);
}

static void what_is_no_number_is_null_and_a_dash(void **state)
{
    cli_run run;

    (void)state;
    open_run(&run);
    sink_say(&run, "a,b,c", "%6.2f|%-6.1e|%s", (double)NAN, (double)NAN, "");
    sink_set(&run, "d", "%g", (double)INFINITY);
    assert_string_equal(run.said.text, "     -|-     |\n");
    assert_report(&run, "{\"a\":null,\"b\":null,\"c\":\"\",\"d\":null}");
    close_run(&run);
}

static void values_said_in_a_list_are_items(void **state)
{
    static const double reals[] = {1.0, 2.5};
    static const int64_t modes[] = {0, 3};
    cli_run run;

    (void)state;
    open_run(&run);
    sink_list(&run, "rows");
    cli_say(&run, "head");
    sink_say(&run, "k", "%ld", (int64_t)1);
    sink_object(&run, NULL);
    sink_set(&run, "k", "%ld", (int64_t)2);
    sink_wholes(&run, "modes", 2, modes, 1);
    sink_end(&run);
    sink_end(&run);
    sink_reals(&run, "reals", 2, reals);
    sink_list(&run, "plain");
    sink_add(&run, "%s %d", "x", false);
    sink_end(&run);
    assert_string_equal(run.said.text, "head\n1\n");
    assert_report(&run, "{\"rows\":[{\"k\":1},{\"k\":2,\"modes\":[1,4]}],"
                        "\"reals\":[1.0,2.5],\"plain\":[\"x\",false]}");
    close_run(&run);
}

static void an_object_that_is_there_is_opened_again(void **state)
{
    cli_run run;

    (void)state;
    open_run(&run);
    for (int64_t k = 0; k < 2; k++) {
        sink_object(&run, "sums");
        sink_set(&run, k == 0 ? "a" : "b", "%ld", k);
        sink_end(&run);
    }
    sink_lift(&run, json_object_get(run.report, "sums"));
    assert_report(&run, "{\"sums\":{\"a\":0,\"b\":1},\"a\":0,\"b\":1}");
    close_run(&run);
}

static void a_text_ends_where_its_room_does(void **state)
{
    char text[6] = "";

    (void)state;
    for (int k = 0; k < 4; k++)
        sink_append(text, sizeof text, "%d,", k);
    assert_string_equal(text, "0,1,2");
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_line_gives_text_and_keys),
    cmocka_unit_test(what_is_no_number_is_null_and_a_dash),
    cmocka_unit_test(values_said_in_a_list_are_items),
    cmocka_unit_test(an_object_that_is_there_is_opened_again),
    cmocka_unit_test(a_text_ends_where_its_room_does),
};

TEST_MODULE(sink, tests, NULL, NULL)
