/* Scales, words, records and pictures of charts, apart from gnuplot. */
#include "testing.h"

#include "folder.h"

#include "tools/axis.h"
#include "tools/html.h"
#include "tools/records.h"
#include "tools/svg.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- scales --------------------------------------------------------------- */

static void decades_hold_all_values(void **state)
{
    const double values[] = {3e-4, 0.02, nan(""), HUGE_VAL};
    int64_t lifted = -1;
    axis a = axis_log(4, values, 1e-9, &lifted);

    (void)state;
    assert_int_equal(lifted, 0);
    assert_true(fabs(a.low - 1e-4) < 1e-12 && fabs(a.high - 0.1) < 1e-12);
}

static void zero_and_less_stand_at_the_foot(void **state)
{
    const double values[] = {3e-4, 0.0, -2.0, 1e-12, 0.02};
    int64_t lifted = 0;
    axis a = axis_log(5, values, 1e-9, &lifted);

    (void)state;
    assert_int_equal(lifted, 3);
    assert_true(fabs(a.low - 1e-5) < 1e-12); /* a decade of their own */
    assert_true(axis_clamp(&a, 0.0) == a.low);
    assert_true(axis_clamp(&a, -2.0) == a.low);
    assert_true(axis_clamp(&a, 0.02) == 0.02);
    assert_true(isnan(axis_clamp(&a, nan(""))));
}

static void nothing_above_the_floor_still_has_an_axis(void **state)
{
    const double values[] = {0.0, nan("")};
    int64_t lifted = 0;
    axis a = axis_log(2, values, 1e-9, &lifted);

    (void)state;
    assert_int_equal(lifted, 1);
    assert_true(a.low > 0.0 && a.high > a.low);
}

static void a_tight_axis_ends_at_one_two_or_five(void **state)
{
    const double values[] = {0.0031, 0.7};
    const double one[] = {1.0};
    axis a = axis_tight(2, values);

    (void)state;
    assert_true(fabs(a.low - 0.002) < 1e-15 && fabs(a.high - 1.0) < 1e-12);
    a = axis_tight(1, one);
    assert_true(a.low < 1.0 && a.high > 1.0);
}

static void a_linear_axis_holds_one_value_too(void **state)
{
    const double values[] = {5.0, nan("")};
    axis a = axis_linear(2, values, false);

    (void)state;
    assert_true(a.low < 5.0 && a.high > 5.0);
    a = axis_linear(2, values, true);
    assert_true(a.low == 0.0 && a.high > 5.0);
}

static void a_decade_is_as_long_as_the_next(void **state)
{
    axis a = {.log = true, .low = 1e-3, .high = 1e-1, .from = 100, .to = 300};

    (void)state;
    assert_true(fabs(axis_place(&a, 1e-3) - 100.0) < 1e-9);
    assert_true(fabs(axis_place(&a, 1e-2) - 200.0) < 1e-9);
    assert_true(fabs(axis_place(&a, 1e-1) - 300.0) < 1e-9);
}

/* --- words ---------------------------------------------------------------- */

static bool overlap(const axis_word *a, const axis_word *b)
{
    return a->left < b->left + b->wide && b->left < a->left + a->wide &&
           a->base < b->base + b->high && b->base < a->base + a->high;
}

static void words_do_not_cover_each_other(void **state)
{
    enum { COUNT = 40 };
    const double box[] = {0.0, 0.0, 400.0, 300.0};
    axis_word word[COUNT];
    int64_t written = 0;

    (void)state;
    for (int k = 0; k < COUNT; k++)
        word[k] =
            (axis_word){.x = 200.0, .y = 150.0, .wide = 30.0, .high = 12.0};
    axis_words(COUNT, word, box);
    for (int k = 0; k < COUNT; k++) {
        written += word[k].written;
        for (int i = 0; word[k].written && i < k; i++)
            assert_false(word[i].written && overlap(&word[i], &word[k]));
    }
    assert_true(written >= 4 && written < COUNT);
}

static void a_word_that_must_be_is_written_anywhere(void **state)
{
    const double box[] = {0.0, 0.0, 100.0, 100.0};
    axis_word word[2] = {
        {.fixed = true, .wide = 100.0, .high = 100.0},
        {.x = 50.0, .y = 50.0, .wide = 40.0, .high = 12.0, .must = true},
    };

    (void)state;
    axis_words(2, word, box);
    assert_true(word[1].written);
    assert_true(word[1].left >= 0.0 && word[1].left + 40.0 <= 100.0);
    word[1].must = false;
    axis_words(2, word, box);
    assert_false(word[1].written);
}

/* --- text ----------------------------------------------------------------- */

static void assert_text(const char *text, const char *markup)
{
    char *got = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&got, &size);

    assert_non_null(file);
    html_text(file, text);
    fclose(file);
    assert_string_equal(got, markup);
    free(got);
}

static void hostile_text_is_text(void **state)
{
    (void)state;
    assert_text("<b a=\"x\" b='y'>&amp;",
                "&lt;b a=&quot;x&quot; b=&#39;y&#39;&gt;&amp;amp;");
    assert_text("a\tb\nc\x01", "a b c ");
    assert_text("\xc3\xa9\xff\xe2\x82", "\xc3\xa9???");
    assert_text("", "");
}

static const char drawn[] =
    "<?xml version=\"1.0\"?>\n<svg viewBox=\"0 0 9 9\">\n"
    "<title>Gnuplot</title>\n<desc>Produced</desc>\n"
    "<defs><circle id='gpDot' r='0.5'/></defs>\n"
    "<g id=\"gnuplot_plot_1\" ><title>gnuplot_plot_1</title>\n"
    "<g fill=\"none\" color=\"black\">\n</g>\n"
    "<g onmousemove=\"gnuplot_svg.showHypertext(evt,'1')\" "
    "onmouseout=\"gnuplot_svg.hideHypertext()\"><title> </title>\n"
    "<use xlink:href='#gpDot' color='rgb(  0, 114, 178)'/></g>\n"
    "<text fill=\"#5a6270\">a = 'b' &gt; #gpDot</text></g></svg>\n";

static void a_picture_is_named_and_its_points_are(void **state)
{
    char one[] = "no", two[] = "x < \"y\"";
    char *const tips[] = {one, two};
    char *svg = NULL;

    (void)state;
    assert_int_equal(svg_dress(drawn, "A & B", "what <it> is", 2, tips, &svg),
                     RITZ_OK);
    assert_non_null(strstr(svg, "<title>A &amp; B</title>\n"
                                "<desc>what &lt;it&gt; is</desc>"));
    assert_non_null(strstr(svg, "<g class=\"mark\"><title>x &lt; &quot;y&quot;"
                                "</title>\n<use"));
    assert_null(strstr(svg, "onmouse"));
    assert_null(strstr(svg, "gnuplot_plot_1</title>"));
    assert_null(strstr(svg, "color=\"black\">\n</g>"));
    free(svg);
}

static void a_tip_that_is_not_there_is_empty(void **state)
{
    char *svg = NULL;

    (void)state;
    assert_int_equal(svg_dress(drawn, "", "", 0, NULL, &svg), RITZ_OK);
    assert_non_null(strstr(svg, "<g class=\"mark\"><title></title>"));
    free(svg);
}

static void a_page_gives_its_own_names_and_colours(void **state)
{
    char *svg = NULL, *got = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&got, &size);

    (void)state;
    assert_non_null(file);
    assert_int_equal(svg_dress(drawn, "A", "B", 0, NULL, &svg), RITZ_OK);
    svg_embed(file, svg, "p7-");
    fclose(file);
    assert_null(strstr(got, "<?xml"));
    assert_non_null(strstr(got, "role=\"img\" aria-labelledby=\"p7-t p7-d\""));
    assert_non_null(strstr(got, "<title id=\"p7-t\">A</title>"));
    assert_non_null(strstr(got, "id='p7-gpDot'"));
    assert_non_null(strstr(got, "xlink:href='#p7-gpDot'"));
    assert_non_null(strstr(got, "color='var(--c1)'"));
    assert_non_null(strstr(got, "fill=\"var(--muted)\""));
    assert_non_null(strstr(got, ">a = 'b' &gt; #gpDot</text>"));
    free(got);
    free(svg);
}

/* --- records -------------------------------------------------------------- */

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
    records all = {0}, some = {0};
    measure *m = NULL;
    int64_t count = 0;

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
    assert_int_equal(all.item[1].line, 3);
    assert_true(all.item[1].cost == 2e-3 && all.item[1].cpu == 0.5);
    assert_true(isnan(all.item[0].cost) && all.item[1].chosen);
    assert_int_equal(records_select(&all, NULL, &some), RITZ_OK);
    assert_int_equal(records_measures(&some, &count, &m), RITZ_OK);
    assert_int_equal(count, 2);
    assert_string_equal(m[0].name, "mac"); /* it has a tolerance */
    assert_true(fabs(m[0].tolerance - 0.1) < 1e-15);
    assert_true(fabs(record_error(&all.item[0], "mac") - 0.01) < 1e-15);
    assert_true(isnan(record_error(&all.item[0], "h2-relative")));
    free(m);
    free(some.item);
    records_free(&all);
}

static void methods_are_sorted(void **state)
{
    records all = {0};
    const char **method = NULL;
    int64_t *which = NULL;
    int64_t count = 0;

    (void)state;
    assert_int_equal(read_text(LINE("b", 8, 1, "") LINE("a", 8, 1, "")
                                   LINE("b", 9, 1, ""),
                               &all),
                     RITZ_OK);
    assert_int_equal(records_methods(&all, &count, &method, &which), RITZ_OK);
    assert_int_equal(count, 2);
    assert_string_equal(method[0], "a");
    assert_int_equal(which[0], 1);
    assert_int_equal(which[1], 0);
    assert_int_equal(which[2], 1);
    free(method);
    free(which);
    records_free(&all);
}

static void a_line_that_is_repeated_counts_once(void **state)
{
    records all = {0}, some = {0};

    (void)state;
    assert_int_equal(read_text(LINE("a", 8, 1e-3, "") LINE("a", 9, 1e-3, "")
                                   LINE("a", 8, 1e-3, ",\"chosen\":true"),
                               &all),
                     RITZ_OK);
    assert_int_equal(records_select(&all, NULL, &some), RITZ_OK);
    assert_int_equal(some.count, 2);
    assert_true(some.item[0].chosen && some.item[0].order == 8);
    free(some.item);
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
    records all = {0}, some = {0};

    (void)state;
    assert_int_equal(read_text(LINE("a", 8, 1, ",\"subject\":\"rotor\"")
                                   LINE("a", 8, 1, ",\"subject\":\"stator\""),
                               &all),
                     RITZ_OK);
    assert_fails(records_select(&all, NULL, &some), RITZ_ERR_ARGUMENT,
                 "records of 'rotor' and of 'stator' do not compare");
    assert_fails(records_select(&all, "x", &some), RITZ_ERR_ARGUMENT,
                 "no record of 'x'");
    assert_int_equal(records_select(&all, "stator", &some), RITZ_OK);
    assert_int_equal(some.count, 1);
    free(some.item);
    records_free(&all);
    assert_int_equal(read_text("{\"method\":\"a\",\"order\":3}", &all),
                     RITZ_OK);
    assert_fails(records_select(&all, NULL, &some), RITZ_ERR_ARGUMENT,
                 "no record has a method, an order and errors");
    records_free(&all);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(decades_hold_all_values),
        cmocka_unit_test(zero_and_less_stand_at_the_foot),
        cmocka_unit_test(nothing_above_the_floor_still_has_an_axis),
        cmocka_unit_test(a_tight_axis_ends_at_one_two_or_five),
        cmocka_unit_test(a_linear_axis_holds_one_value_too),
        cmocka_unit_test(a_decade_is_as_long_as_the_next),
        cmocka_unit_test(words_do_not_cover_each_other),
        cmocka_unit_test(a_word_that_must_be_is_written_anywhere),
        cmocka_unit_test(hostile_text_is_text),
        cmocka_unit_test(a_picture_is_named_and_its_points_are),
        cmocka_unit_test(a_tip_that_is_not_there_is_empty),
        cmocka_unit_test(a_page_gives_its_own_names_and_colours),
        cmocka_unit_test(records_hold_what_lines_say),
        cmocka_unit_test(methods_are_sorted),
        cmocka_unit_test(a_line_that_is_repeated_counts_once),
        cmocka_unit_test(limits_that_are_not_met_are_not),
        cmocka_unit_test(verified_files_cost_what_made_them),
        cmocka_unit_test(lines_that_are_no_records_are_named),
        cmocka_unit_test(records_that_do_not_compare_are_refused),
    };

    return cmocka_run_group_tests(tests, folder_make, folder_remove);
}
