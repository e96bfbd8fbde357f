/* Responses as columns of text: read as published, damaged, and closed around
   as the model that they were sampled from. */
#include "base/complex.h"
#include "damage.h"
#include "folder.h"
#include "testing.h"

#include <ritz/response.h>

#include <complex.h>
#include <float.h>
#include <stdio.h>
#include <string.h>

/* Two outputs, one input, one channel each way; a singular value behind. */
static const char two[] = "\n# hertz\tre(tip/push)\tim(tip/push)\t|root/push|\t"
                          "degrees\tsigma1\n"
                          "0 1 0 2 90 7\n# a comment\n"
                          "0.5;0.25,-0.5;2;180;7\r\n\n1.5 0 1e-3 0 -90 7";

static ritz_status read_text(const char *text, ritz_response *out)
{
    return ritz_response_read_table(folder_write("table", text), out);
}

static void columns_are_read_as_their_head_says(void **state)
{
    static const double due[3][2][2] = {{{1.0, 0.0}, {0.0, 2.0}},
                                        {{0.25, -0.5}, {-2.0, 0.0}},
                                        {{0.0, 1e-3}, {0.0, 0.0}}};
    RITZ_OWN(ritz_response) r = {0};

    (void)state;
    assert_ok(read_text(two, &r));
    assert_int_equal(r.count, 3);
    assert_int_equal(r.num_outputs, 2);
    assert_int_equal(r.num_inputs, 1);
    assert_string_equal(r.output[0], "tip");
    assert_string_equal(r.output[1], "root");
    assert_string_equal(r.input[0], "push");
    assert_near(r.hertz[1], 0.5, 0.0);
    for (int64_t k = 0; k < 3; k++)
        for (int64_t i = 0; i < 2; i++) {
            const double _Complex h = r.H[2 * k + i];

            assert_near(creal(h), due[k][i][0], 4.0 * DBL_EPSILON);
            assert_near(cimag(h), due[k][i][1], 4.0 * DBL_EPSILON);
        }
}

static void three_columns_are_one_channel(void **state)
{
    static const char *const heads[] = {"",
                                        "# hertz real imaginary\n",
                                        "# hertz re(y1/u1) im(y1/u1)\n",
                                        "hertz,real,imaginary\r\n",
                                        "\xef\xbb\xbf# hertz real imaginary\n",
                                        "\xef\xbb\xbf"};
    char text[128];

    (void)state;
    for (size_t k = 0; k < sizeof heads / sizeof *heads; k++) {
        RITZ_OWN(ritz_response) r = {0};

        snprintf(text, sizeof text, "%s1 3 4\n2 5 6\n", heads[k]);
        assert_ok(read_text(text, &r));
        assert_true(ritz_response_table_seems(folder_path("table")));
        assert_string_equal(r.output[0], "y1");
        assert_string_equal(r.input[0], "u1");
        assert_near(cimag(r.H[1]), 6.0, 0.0);
    }
}

static void what_is_no_table_is_refused(void **state)
{
    static const struct {
        const char *text, *words;
    } cases[] = {
        {"# seconds a b\n",
         "no table of a response: its head begins with 'seconds', not with "
         "hertz"},
        {"# Hz re(a/b) im(a/b)\n1 2 3\n", "begins with 'Hz', not with hertz"},
        {"rad/s real imaginary\n1 2 3\n", "begins with 'rad/s', not with"},
        {"#\tomega\ta\n", "begins with 'omega', not with hertz"},
        {"frequency,real,imaginary\n", "begins with 'frequency', not with"},
        {"scene: a\n", "begins with 'scene:', not with hertz"},
        {"#\n1 2 3\n", "begins with '', not with hertz"},
        {"1 2\n3 4\n", "line 1 has 2 columns that no head names"},
        {"\n1 2 3 4\n", "line 2 has 4 columns that no head names"},
        {"\xef\xbb\xbf \n", "no table of a response: it is empty"},
        {"# hertz\n1\n2\n", "the head names no channel"},
        {"# hertz |a/b|\n", "the head has '|a/b|' where"},
        {"# hertz re(a/b) im(a/c)\n", "the head has 're(a/b)' where"},
        {"# hertz |ab| degrees\n", "'|ab|' is not of the form OUT/IN"},
        {"# hertz |a/b/c| degrees\n", "'|a/b/c|' is not of the form OUT/IN"},
        {"# hertz |/b| degrees\n", "'' is no name of a signal"},
        {"# hertz |a/b| degrees |a/b| degrees\n",
         "2 channels are not one of each of 1 outputs and 1 inputs"},
        {"# hertz |a/b| degrees |c/d| degrees\n",
         "2 channels are not one of each of 2 outputs and 2 inputs"},
        {"# hertz |a/b| degrees |a/b| degrees |c/d| degrees |c/b| degrees\n",
         "a/b is there twice"},
        {"1 2 3\n1 2 3\n", "the frequency of line 2 does not ascend"},
        {"-1 2 3\n", "line 1: -1 Hz is no frequency"},
        {"1 2 3\n2 3\n", "line 2 has 2 numbers instead of 3"},
        {"1 2 3\n2 3 4 5\n", "line 2 is not a row of 3 numbers"},
        {"1 2 3\n2 nan 4\n", "line 2 is not a row of 3 numbers"},
        {"# hertz magnitude degrees\n1 -2 3\n",
         "line 2: a magnitude is negative"},
        {"1 2 3\n", "a response of 1 frequencies is none"},
        {"# hertz |a/b| degrees\n", "a response of 0 frequencies is none"},
        {"", "no table of a response: it is empty"},
    };

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        RITZ_OWN(ritz_response) r = {0};

        assert_fails(read_text(cases[k].text, &r), RITZ_ERR_FORMAT,
                     cases[k].words);
    }
}

static void containers_do_not_seem_tables(void **state)
{
    static const char start[] = "\x89HDF\r\n\x1a\n\0\0";
    const char *path = folder_path("container");
    FILE *file = fopen(path, "wb");

    (void)state;
    assert_non_null(file);
    assert_int_equal(fwrite(start, 1, sizeof start, file), sizeof start);
    assert_int_equal(fclose(file), 0);
    assert_false(ritz_response_table_seems(path));
    assert_false(ritz_response_table_seems(folder_write("cut", "\x89HDF")));
    assert_false(ritz_response_table_seems(folder_path("")));
    assert_false(ritz_response_table_seems(folder_path("there is none")));
    assert_true(ritz_response_table_seems(folder_write("other", "scene: a\n")));
}

static ritz_status read_bytes(const char *bytes, int64_t size)
{
    const char *path = folder_path("damaged");
    RITZ_OWN(ritz_response) r = {0};
    FILE *file = fopen(path, "wb");

    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, (size_t)size, file), size);
    assert_int_equal(fclose(file), 0);
    (void)ritz_response_table_seems(path);
    return ritz_response_read_table(path, &r);
}

static void damaged_tables_are_refused_or_read(void **state)
{
    (void)state;
    damage_cut(read_bytes, two, sizeof two - 1);
    damage_corrupt(read_bytes, two, sizeof two - 1);
}

static ritz_status read_and_drop(void)
{
    RITZ_OWN(ritz_response) r = {0};

    return ritz_response_read_table(folder_path("table"), &r);
}

static void reading_survives_every_allocation(void **state)
{
    (void)state;
    (void)folder_write("table", two);
    assert_survives_every_allocation(read_and_drop());
}

/* 1 / (1 + i f) at 0, 0.1 ... 1 Hz around a gain of 2. */
static void sample(ritz_response *out)
{
    char text[2048] = "";
    size_t length = 0;

    for (int k = 0; k <= 10; k++) {
        const double _Complex h = 1.0 / ritz_complex(1.0, 0.1 * k);

        length += (size_t)snprintf(text + length, sizeof text - length,
                                   "%.17g %.17g %.17g\n", 0.1 * k, creal(h),
                                   cimag(h));
    }
    assert_ok(read_text(text, out));
}

/* Plant and controller both measured: H = G / (1 + G G). */
static void a_loop_of_measured_responses_is_closed_at_their_points(void **state)
{
    int64_t measured = 0, driven = 0;
    const ritz_loop loop = {1, &measured, 1, &driven, false};
    RITZ_OWN(ritz_response) r = {0};
    RITZ_OWN(ritz_responder) *G = NULL, *F = NULL, *H = NULL;
    double _Complex h = 0.0;

    (void)state;
    sample(&r);
    assert_ok(ritz_measured_responder(&r, &G));
    assert_ok(ritz_measured_responder(&r, &F));
    assert_ok(ritz_loop_responder(&loop, G, F, 0, NULL, &H));
    for (int64_t k = 0; k < r.count; k++) {
        const double _Complex g = r.H[k], due = g / (1.0 + g * g);

        assert_ok(ritz_responder_at(H, r.hertz[k], &h));
        assert_near(cabs(h - due), 0.0, 1e-14);
    }
    assert_ok(ritz_responder_at(G, 0.55, &h)); /* a cubic: h^4 |G''''| / 24 */
    assert_near(cabs(h - 1.0 / ritz_complex(1.0, 0.55)), 0.0, 1e-4);
    h = 0.0;
    assert_fails(ritz_responder_at(G, 1.1, &h), RITZ_ERR_ARGUMENT,
                 "1.1 Hz is outside what was measured, 0 to 1 Hz");
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(columns_are_read_as_their_head_says),
    cmocka_unit_test(three_columns_are_one_channel),
    cmocka_unit_test(what_is_no_table_is_refused),
    cmocka_unit_test(containers_do_not_seem_tables),
    cmocka_unit_test(damaged_tables_are_refused_or_read),
    cmocka_unit_test(reading_survives_every_allocation),
    cmocka_unit_test(a_loop_of_measured_responses_is_closed_at_their_points),
};

TEST_MODULE(response_table, tests, folder_make, folder_remove)
