/* Scales, words and pictures of charts, apart from gnuplot. */
#include "testing.h"

#include "chart/chart.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- scales --------------------------------------------------------------- */

static void decades_hold_all_values(void **state)
{
    const double values[] = {3e-4, 0.02, nan(""), HUGE_VAL};
    int64_t lifted = -1;
    chart_range a = chart_decades(4, values, 1e-9, &lifted);

    (void)state;
    assert_int_equal(lifted, 0);
    assert_true(fabs(a.low - 1e-4) < 1e-12 && fabs(a.high - 0.1) < 1e-12);
}

static void zero_and_less_stand_at_the_foot(void **state)
{
    const double values[] = {3e-4, 0.0, -2.0, 1e-12, 0.02};
    int64_t lifted = 0;
    chart_range a = chart_decades(5, values, 1e-9, &lifted);

    (void)state;
    assert_int_equal(lifted, 3);
    assert_true(fabs(a.low - 1e-5) < 1e-12); /* a decade of their own */
}

static void nothing_above_the_floor_still_has_an_axis(void **state)
{
    const double values[] = {0.0, nan("")};
    int64_t lifted = 0;
    chart_range a = chart_decades(2, values, 1e-9, &lifted);

    (void)state;
    assert_int_equal(lifted, 1);
    assert_true(a.low > 0.0 && a.high > a.low);
}

/* --- points --------------------------------------------------------------- */

/* Of two in one square the lower stays, and what must; others of another
   series, square or picture are not asked. */
static void points_that_hide_each_other_are_thinned(void **state)
{
    picture_point p[] = {
        {.x = 1.0, .y = 3.0, .keep = true},
        {.x = 2.0, .y = 1.0},
        {.x = 3.0, .y = 2.0},
        {.x = 1.0, .y = 2.0, .group = 1},
        {.x = 9.0, .y = 1.0},
        {.x = 1.0, .y = 1.0, .group = -1},
        {.x = 2.5, .y = 0.5, .group = 2},
    };

    (void)state;
    assert_int_equal(picture_thin(7, p, 4.0), RITZ_OK);
    /* what must, stays alone */
    assert_true(p[0].keep && !p[1].keep && !p[2].keep);
    assert_true(p[3].keep && p[4].keep && p[6].keep && !p[5].keep);
    p[0].keep = false;
    assert_int_equal(picture_thin(7, p, 4.0), RITZ_OK);
    assert_true(!p[0].keep && p[1].keep && !p[2].keep);
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
    assert_text("]]>&#x0;", "]]&gt;&amp;#x0;");
    assert_text("", "");
}

/* XML forbids these characters, and a page or picture with one could not be
   read. */
static void letters_that_xml_has_not_are_marked(void **state)
{
    (void)state;
    assert_text("\xed\xa0\x80", "???"); /* half of a surrogate pair */
    assert_text("\xef\xbf\xbe", "???"); /* U+FFFE */
    assert_text("\xe0\x80\xaf", "???"); /* '/' in an overlong encoding */
    assert_text("\xf0\x80\x80\xaf", "????");
    assert_text("\xf4\x90\x80\x80", "????"); /* above U+10FFFF */
    assert_text("\xef\xbf\xbd\xed\x9f\xbf", "\xef\xbf\xbd\xed\x9f\xbf");
    assert_text("\xf4\x8f\xbf\xbf", "\xf4\x8f\xbf\xbf");
}

static void only_arguments_are_escaped(void **state)
{
    char *got = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&got, &size);

    (void)state;
    assert_non_null(file);
    html_print(file, "<b>%s</b> %lld %.3g %g%%", "<&>", -7LL, 0.12345, 0.5);
    fclose(file);
    assert_string_equal(got, "<b>&lt;&amp;&gt;</b> -7 0.123 0.5%");
    free(got);
}

/* --- pictures ------------------------------------------------------------- */

static void a_tip_is_one_field_of_markup(void **state)
{
    picture p = {0};

    (void)state;
    assert_int_equal(picture_new("x.svg", true, &p), RITZ_OK);
    picture_tip(&p, "a\n%s", "\\n \"it's\" <b>\t&");
    fflush(p.data.file);
    assert_string_equal(p.data.text,
                        "a\\n&#92;n &quot;it&#39;s&quot; &lt;b&gt; &amp;");
    picture_free(&p);
}

/* gnuplot takes two quotes in a row for the end of a string. */
static void a_quote_is_a_piece_of_its_own(void **state)
{
    picture p = {0};

    (void)state;
    assert_int_equal(picture_new("x.svg", true, &p), RITZ_OK);
    picture_give_text(&p, "x", "'a''b`\\n\"");
    fflush(p.given.file);
    assert_string_equal(p.given.text,
                        "x = '' . \"\\047\" . 'a' . \"\\047\" . '' . "
                        "\"\\047\" . 'b`\\n\"'\n");
    picture_free(&p);
}

static const char drawn[] =
    "<?xml version=\"1.0\"?>\n<svg viewBox=\"0 0 9 9\">\n"
    "<title>Gnuplot</title>\n<desc>Produced</desc>\n"
    "<defs><circle id='gpDot' r='0.5'/></defs>\n"
    "<g id=\"gnuplot_plot_1\" ><title>gnuplot_plot_1</title>\n"
    "<g onmousemove=\"gnuplot_svg.showHypertext(evt,'x &amp;lt; "
    "&amp;quot;y&amp;quot;\\n&amp;#92;n')\" "
    "onmouseout=\"gnuplot_svg.hideHypertext()\"><title> </title>\n"
    "<use xlink:href='#gpPt10' color='rgb(  0, 114, 178)'/></g>\n"
    "<path stroke='black' fill='rgb(1,2,3)'/>"
    "<text fill=\"#5a6270\">a = 'b' &gt; #gpDot rgb(0,114,178)</text>"
    "<text>a]]>&#x0;&amp;</text></g></svg>\n";

static char *copy_drawn(const char *title, const char *summary,
                        const char *prefix)
{
    char *got = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&got, &size);

    assert_non_null(file);
    svg_copy(file, drawn, title, summary, prefix);
    fclose(file);
    return got;
}

static void a_picture_is_named_and_its_points_are(void **state)
{
    char *svg = copy_drawn("A & B", "what <it> is", NULL);

    (void)state;
    assert_non_null(strstr(svg, "<title>A &amp; B</title>\n"
                                "<desc>what &lt;it&gt; is</desc>"));
    assert_non_null(strstr(svg, "<g class=\"mark\"><title>x &lt; &quot;y&quot;"
                                "\n&#92;n</title>\n<use"));
    assert_null(strstr(svg, "onmouse"));
    assert_null(strstr(svg, "gnuplot_plot_1</title>"));
    assert_non_null(strstr(svg, "color='rgb(  0, 114, 178)'"));
    assert_non_null(
        strstr(svg, "<text>a]]&gt;&amp;#x0;&amp;</text></g></svg>"));
    assert_memory_equal(svg, drawn,
                        strlen("<?xml version=\"1.0\"?>\n<svg "
                               "viewBox=\"0 0 9 9\">\n"));
    free(svg);
}

static void a_page_gives_its_own_names_and_colours(void **state)
{
    char *got = copy_drawn("A", "B", "p7-");

    (void)state;
    assert_null(strstr(got, "<?xml"));
    assert_non_null(strstr(got, "role=\"img\" aria-labelledby=\"p7-t p7-d\""));
    assert_non_null(strstr(got, "<title id=\"p7-t\">A</title>"));
    assert_non_null(strstr(got, "id='p7-gpDot'"));
    assert_non_null(strstr(got, "xlink:href='#p7-gpPt10'"));
    assert_non_null(strstr(got, "color='var(--c1)'"));
    assert_non_null(strstr(got, "stroke='var(--ink)' fill='rgb(1,2,3)'"));
    assert_non_null(strstr(got, "fill=\"var(--muted)\""));
    assert_non_null(strstr(got, ">a = 'b' &gt; #gpDot rgb(0,114,178)</text>"));
    assert_non_null(strstr(got, "<text>a]]&gt;&amp;#x0;&amp;</text>"));
    assert_non_null(strstr(got, "p7-d\" viewBox=\"0 0 9 9\">\n"));
    free(got);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(decades_hold_all_values),
    cmocka_unit_test(zero_and_less_stand_at_the_foot),
    cmocka_unit_test(nothing_above_the_floor_still_has_an_axis),
    cmocka_unit_test(points_that_hide_each_other_are_thinned),
    cmocka_unit_test(hostile_text_is_text),
    cmocka_unit_test(letters_that_xml_has_not_are_marked),
    cmocka_unit_test(only_arguments_are_escaped),
    cmocka_unit_test(a_tip_is_one_field_of_markup),
    cmocka_unit_test(a_quote_is_a_piece_of_its_own),
    cmocka_unit_test(a_picture_is_named_and_its_points_are),
    cmocka_unit_test(a_page_gives_its_own_names_and_colours),
};

TEST_MODULE(charts, tests, NULL, NULL)
