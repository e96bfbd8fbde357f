/* The error certificate of a model, and the lines into which comments are
   broken. */
#include "formats/certificate.h"
#include "testing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The text as comment lines of at most `width` bytes that begin with
   `before`. */
static char *comments(const char *before, int width, const char *text)
{
    char *out = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&out, &size);

    assert_non_null(file);
    ritz_comment_put(file, before, width, text);
    assert_int_equal(fclose(file), 0);
    return out;
}

static void assert_comments(int width, const char *text, const char *expected)
{
    RITZ_OWN_ARRAY char *got = comments("# ", width, text);

    assert_string_equal(got, expected);
}

static void long_lines_are_cut_at_blanks_and_between_letters(void **state)
{
    (void)state;
    assert_comments(0, "one two three\nfour\n", "# one two three\n# four\n");
    assert_comments(8, "one two three\nfour", "# one two \n# three\n# four\n");
    assert_comments(4, "abcdefghi\n", "# abcd\n# efgh\n# i\n");
    /* letters of two and three bytes are not divided */
    assert_comments(4, "aaa\u00e9b\n", "# aaa\n# \u00e9b\n");
    assert_comments(4, "\u20ac\u20ac\n", "# \u20ac\n# \u20ac\n");
    assert_comments(4, "a\n\nb\n", "# a\n# \n# b\n");
    assert_comments(4, "", "");
}

/* A reduced component with every entry that a certificate can have. */
static void fill(ritz_reduced *r)
{
    assert_ok(ritz_dense_new(2, 2, &r->K));
    assert_ok(ritz_columns_new(2, &r->columns));
    r->columns.hertz[1] = 2.5;
    strcpy(r->origin.method, "craig-bampton");
    strcpy(r->origin.options, "modes 1");
    strcpy(r->origin.reference, "Craig1968");
    strcpy(r->units, "kg m s");
    strcpy(r->damping, "modal 0.002");
}

static const char known[] =
    "order: 2, modes of the basis from 2.5 to 2.5 Hz\n"
    "units: kg m s\n"
    "damping: modal 0.002\n"
    "error, measured: frequency-relative 0.00125, limit 0.01, at mode 7\n"
    "error, estimated: static-gain 0.5\n"
    "input: 0123  a?b.h5\n"
    "made by: ritz-verify --band-hz 0,10\n"
    "command: ritz-export a?b.h5\n";

static void a_certificate_has_errors_inputs_and_command(void **state)
{
    RITZ_OWN(ritz_reduced) r = {0};
    char text[] = "0123  a\nb.h5";
    char *const input[] = {text};
    const ritz_stamp stamp = {.command = "ritz-export a\x01"
                                         "b.h5",
                              .num_inputs = 1,
                              .source = "ritz-verify --band-hz 0,10",
                              .input = input};
    const ritz_export_object object = {.reduced = &r};
    RITZ_OWN_ARRAY char *got = NULL;
    const char *second = NULL;

    (void)state;
    fill(&r);
    assert_ok(ritz_measures_add(&r.errors, "frequency-relative", 1.25e-3, 1e-2,
                                "mode 7"));
    assert_ok(
        ritz_measures_add(&r.estimates, "static-gain", 0.5, (double)NAN, ""));
    assert_ok(ritz_certificate(&object, &stamp, &got));
    second = strchr(got, '\n');
    assert_non_null(second);
    assert_memory_equal(got, "reduced component by Ritz ", 26);
    assert_non_null(
        strstr(got, ": craig-bampton, modes 1, reference Craig1968\n"));
    assert_string_equal(second + 1, known);
}

static void a_certificate_says_what_is_not_known(void **state)
{
    const ritz_io none = {0};
    RITZ_OWN(ritz_state_space) s = {0};
    const ritz_export_object object = {.states = &s};
    RITZ_OWN_ARRAY char *got = NULL;

    (void)state;
    assert_ok(ritz_state_space_new(3, &none, &s));
    assert_ok(ritz_certificate(&object, NULL, &got));
    assert_memory_equal(got, "state space by Ritz ", 20);
    assert_non_null(strstr(got, "\norder: 3\nunits: not known\ndamping: "
                                "that of the matrices\n"
                                "errors: neither measured nor estimated\n"));
}

/* XML allows neither "--" nor markup in a comment. */
static void an_xml_comment_has_no_markup(void **state)
{
    char *out = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&out, &size);

    (void)state;
    assert_non_null(file);
    ritz_comment_put_xml(file, "a --to b <c> & ---\nd-");
    assert_int_equal(fclose(file), 0);
    assert_string_equal(out, "<!--\na - -to b &lt;c&gt; &amp; - - -\nd- -->\n");
    free(out);
}

/* The certificate of shapes of a full component has inputs and command only. */
static void other_objects_have_inputs_and_command(void **state)
{
    const ritz_stamp stamp = {.command = "ritz-export --to vtu rotor.h5"};
    const ritz_export_object object = {0};
    RITZ_OWN_ARRAY char *got = NULL;

    (void)state;
    assert_ok(ritz_certificate(&object, &stamp, &got));
    assert_memory_equal(got, "by Ritz ", 8);
    assert_string_equal(strchr(got, '\n'),
                        "\ncommand: ritz-export --to vtu rotor.h5\n");
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(long_lines_are_cut_at_blanks_and_between_letters),
    cmocka_unit_test(a_certificate_has_errors_inputs_and_command),
    cmocka_unit_test(a_certificate_says_what_is_not_known),
    cmocka_unit_test(an_xml_comment_has_no_markup),
    cmocka_unit_test(other_objects_have_inputs_and_command),
};

TEST_MODULE(certificate, tests, NULL, NULL)
