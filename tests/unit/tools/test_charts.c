/* Scales, words and pictures of charts, apart from gnuplot. */
#include "testing.h"

#include "chart/axis.h"
#include "chart/chart_place.h"
#include "chart/html.h"
#include "chart/svg.h"

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

static bool overlap(const chart_box *a, const chart_box *b)
{
    return a->left < b->right && b->left < a->right && a->bottom < b->top &&
           b->bottom < a->top;
}

static bool holds(const chart_box *frame, const chart_box *a)
{
    return a->left >= frame->left && a->right <= frame->right &&
           a->bottom >= frame->bottom && a->top <= frame->top;
}

/* One mark alone: its word is beside it. Words for the same one follow while
   there is room. */
static void words_do_not_cover_each_other(void **state)
{
    enum { COUNT = 40 };
    chart_spot spot = {200.0, 150.0, 4.0};
    const chart_box mark = {196.0, 146.0, 204.0, 154.0};
    chart_box word[COUNT];
    chart_places places = {.frame = {0.0, 0.0, 400.0, 300.0},
                           .num_spots = 1,
                           .spot = &spot,
                           .word = word};

    (void)state;
    for (int k = 0; k < COUNT; k++) {
        chart_word w = {
            .x = 200.0, .y = 150.0, .half = 4.0, .wide = 30.0, .high = 12.0};

        if (!chart_place_beside(&places, &w))
            break;
        assert_true(holds(&places.frame, &w.at));
        assert_false(overlap(&mark, &w.at));
        for (int64_t i = 0; i < places.num_words; i++)
            assert_false(overlap(&word[i], &w.at));
        assert_true(w.at.right - w.at.left == 30.0);
        word[places.num_words++] = w.at;
    }
    assert_true(places.num_words >= 2 && places.num_words < COUNT);
}

/* A cloud of marks without a gap: an order is left out, and two words that
   must be are across marks, but in the frame and not across each other. */
static void a_word_that_must_be_is_written_anywhere(void **state)
{
    enum { SIDE = 20 };
    chart_spot spot[SIDE * SIDE];
    chart_box word[2];
    chart_places places = {.frame = {0.0, 0.0, 400.0, 400.0},
                           .num_spots = SIDE * SIDE,
                           .spot = spot,
                           .word = word};

    (void)state;
    for (int k = 0; k < SIDE * SIDE; k++) {
        const int row = k / SIDE;

        spot[k] =
            (chart_spot){10.0 + 20.0 * (k % SIDE), 10.0 + 20.0 * row, 9.0};
    }
    for (int k = 0; k < 2; k++) {
        chart_word w = {
            .x = 190.0, .y = 190.0, .half = 9.0, .wide = 90.0, .high = 12.0};

        assert_false(chart_place_beside(&places, &w));
        chart_place_around(&places, &w);
        assert_true(holds(&places.frame, &w.at));
        assert_false(k == 1 && overlap(&word[0], &w.at));
        word[places.num_words++] = w.at;
    }
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

/* As gnuplot begins text, a line, and text that is the colour of paper. */
static void words_have_a_rim_of_paper(void **state)
{
    static const char text[] =
        "<g stroke=\"none\" fill=\"rgb(27,31,36)\" font-family=\"sans\">"
        "<text>a</text></g>\n<path stroke=\"none\" fill=\"rgb(1,2,3)\"/>\n"
        "<g stroke=\"none\" fill=\"rgb(255,255,255)\" font-family=\"sans\">"
        "<text>b</text></g>\n";
    char *svg = NULL;

    (void)state;
    assert_int_equal(svg_dress(text, "A", "B", 0, NULL, &svg), RITZ_OK);
    assert_non_null(strstr(svg, "paint-order=\"stroke\" fill=\"rgb(27,31,36)"));
    assert_non_null(strstr(svg, "<g stroke=\"#ffffff\" stroke-width=\"3\""));
    assert_non_null(strstr(svg, "<path stroke=\"none\" fill=\"rgb(1,2,3)\""));
    assert_non_null(strstr(svg, "<g stroke=\"none\" fill=\"rgb(255,255,255)"));
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

static const struct CMUnitTest tests[] = {
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
    cmocka_unit_test(words_have_a_rim_of_paper),
    cmocka_unit_test(a_tip_that_is_not_there_is_empty),
    cmocka_unit_test(a_page_gives_its_own_names_and_colours),
};

TEST_MODULE(charts, tests, NULL, NULL)
