/* State effectors for Basilisk, from reduced components made by hand. */
#include "testing.h"

#include "folder.h"

#include <ritz/export.h>

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MODES = 4, ORDER = 6 + MODES };

/*
 * A body of mass 20 and inertia 30 about grid 7, of which a mass of 3 swings
 * along z at x = 2 with 1 Hz, a part turns about x with the inertia 2 at 2 Hz, a
 * part twists as it moves, at 3 Hz, and a part moves alone, at 4 Hz.
 */
static ritz_status make_body(ritz_reduced *out)
{
    const double part[MODES][6] = {
        {0, 0, sqrt(3.0), 0, -2.0 * sqrt(3.0), 0},
        {0, 0, 0, sqrt(2.0), 0, 0},
        {0.5, 0, 0, 0.5, 0.1, 0},
        {0},
    };

    RITZ_CHECK(ritz_dense_new(ORDER, ORDER, &out->K));
    RITZ_CHECK(ritz_dense_new(ORDER, ORDER, &out->M));
    RITZ_CHECK(ritz_columns_new(ORDER, &out->columns));
    for (int64_t i = 0; i < 6; i++) {
        ritz_dense_col(&out->M, i)[i] = i < 3 ? 20.0 : 30.0;
        out->columns.kind[i] = RITZ_COLUMN_CONSTRAINT;
    }
    for (int64_t k = 0; k < MODES; k++) {
        ritz_dense_col(&out->K, 6 + k)[6 + k] =
            ritz_eigen_lambda((double)k + 1.0);
        ritz_dense_col(&out->M, 6 + k)[6 + k] = 1.0;
        for (int64_t i = 0; i < 6; i++)
            ritz_dense_col(&out->M, 6 + k)[i] =
                ritz_dense_col(&out->M, i)[6 + k] = part[k][i];
    }
    snprintf(out->units, sizeof out->units, "kg m s");
    snprintf(out->damping, sizeof out->damping, "modal 0.01");
    return RITZ_OK;
}

/* Attach the six motions of the grid as the first coordinates. */
static ritz_status add_port(ritz_reduced *out)
{
    ritz_port_map *port = calloc(1, sizeof *port);

    assert_non_null(port);
    out->port = port;
    out->num_ports = 1;
    strcpy(port->name, "hub");
    port->count = 6;
    port->dof = calloc(6, sizeof *port->dof);
    port->position = calloc(18, sizeof *port->position);
    assert_true(port->dof && port->position);
    RITZ_CHECK(ritz_dense_new(6, ORDER, &port->map));
    for (int64_t i = 0; i < 6; i++) {
        port->dof[i] = (ritz_dof){7, i + 1};
        ritz_dense_col(&port->map, i)[i] = 1.0;
    }
    return ritz_io_new(ORDER, 0, 0, &out->io);
}

static int set_up(void **state)
{
    static ritz_reduced body;

    *state = &body;
    assert_ok(make_body(&body));
    assert_ok(add_port(&body));
    return folder_make(state);
}

static int tear_down(void **state)
{
    ritz_reduced_free(*state);
    return folder_remove(state);
}

static ritz_status write_module(const ritz_reduced *body, const char *path,
                                ritz_export_report *report)
{
    const ritz_export_request request = {.output = path};

    return ritz_exporter_basilisk.write(&(ritz_export_object){.reduced = body},
                                        &request, report);
}

/* Read the numbers that follow a word of the text, from `from` on. */
static const char *read_numbers(const char *from, const char *word, int count,
                                double *out)
{
    const char *at = strstr(from, word);

    assert_non_null(at);
    at += strlen(word);
    for (int k = 0; k < count; k++) {
        char *end = NULL;

        at += strspn(at, " :[],\n\"");
        out[k] = strtod(at, &end);
        assert_true(end != at);
        at = end;
    }
    return at;
}

static void assert_numbers(const char *from, const char *word, int count,
                           const double *expected)
{
    double found[9];

    read_numbers(from, word, count, found);
    for (int k = 0; k < count; k++)
        assert_near(found[k], expected[k],
                    64.0 * DBL_EPSILON * fmax(1.0, fabs(expected[k])));
}

static void modes_become_springs_and_spinning_bodies(void **state)
{
    const double place[3] = {2, 0, 0}, up[3] = {0, 0, 1}, ahead[3] = {1, 0, 0};
    const double three = 3.0, two = 2.0;
    const double w1 = 2.0 * M_PI, w2 = 4.0 * M_PI;
    const double k1 = 3.0 * w1 * w1;
    const double k2 = 2.0 * w2 * w2;
    const char *path = folder_path("body.py");
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN_ARRAY char *text = NULL;
    const char *springs = NULL, *spinners = NULL;

    assert_ok(write_module(*state, path, &report));
    assert_ok(ritz_text_read(path, &text));
    springs = strstr(text, "SPRINGS = [");
    spinners = strstr(text, "SPINNERS = [");
    assert_true(springs && spinners);
    assert_numbers(springs, "\"mass\"", 1, &three);
    assert_numbers(springs, "\"place\"", 3, place);
    assert_numbers(springs, "\"axis\"", 3, up);
    assert_numbers(springs, "\"k\"", 1, &k1);
    assert_numbers(spinners, "\"inertia\"", 1, &two);
    assert_numbers(spinners, "\"axis\"", 3, ahead);
    assert_numbers(spinners, "\"k\"", 1, &k2);
    assert_non_null(strstr(text, "# errors: neither measured nor estimated"));
    assert_non_null(strstr(report.line[3],
                           "warning: mode 3, 3 Hz, is left "
                           "out: it pushes the hub along an axis "
                           "and turns it about the same one"));
    assert_non_null(strstr(report.line[4], "mode 4, 4 Hz, is left out: it does "
                                           "not act on the hub"));
}

/* The hub has the mass of the body without the 3 on the spring at x = 2, and
   its inertia about the grid without the 2 of the spinning body about x and the
   12 of the mass on the spring about y and z. */
static void the_hub_keeps_the_rest(void **state)
{
    const double mass = 17.0, centre[3] = {-6.0 / 17.0, 0, 0};
    const double shift = 36.0 / 17.0;
    const double inertia[9] = {28, 0, 0, 0, 18 - shift, 0, 0, 0, 18 - shift};
    const char *path = folder_path("hub.py");
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN_ARRAY char *text = NULL;

    assert_ok(write_module(*state, path, &report));
    assert_ok(ritz_text_read(path, &text));
    assert_numbers(strstr(text, "HUB = "), "\"mass\"", 1, &mass);
    assert_numbers(strstr(text, "HUB = "), "\"centre\"", 3, centre);
    assert_numbers(strstr(text, "HUB = "), "\"inertia\"", 9, inertia);
}

static void assert_refused(const ritz_reduced *body, const char *words)
{
    const char *path = folder_path("none.py");
    RITZ_OWN(ritz_export_report) report = {0};

    assert_fails(write_module(body, path, &report), RITZ_ERR_ARGUMENT, words);
    assert_int_equal(access(path, F_OK), -1);
}

/* Participations of the third mode along and about x, and about y. */
static void couple_third(ritz_reduced *body, double p, double h, double h_y)
{
    ritz_dense_col(&body->M, 8)[4] = ritz_dense_col(&body->M, 4)[8] = h_y;
    ritz_dense_col(&body->M, 8)[0] = ritz_dense_col(&body->M, 0)[8] = p;
    ritz_dense_col(&body->M, 8)[3] = ritz_dense_col(&body->M, 3)[8] = h;
}

static void a_hub_without_mass_or_inertia_is_refused(void **state)
{
    ritz_reduced *body = *state;
    double *M = body->M.val;

    /* a mass of 3 along z and one along x, of 4 in each direction */
    couple_third(body, sqrt(3.0), 0.0, 0.1);
    M[0] = M[ORDER + 1] = M[2 * ORDER + 2] = 4.0;
    M[4 * ORDER + 4] = 60.0;
    assert_refused(body, "the effectors have more mass than the component, and "
                         "leave the hub -2");
    M[0] = M[ORDER + 1] = M[2 * ORDER + 2] = 20.0;
    M[4 * ORDER + 4] = 30.0;
    couple_third(body, 0.5, 0.5, 0.1);
    /* the mass at x = 2 takes 12 about z, where it does not move */
    M[5 * ORDER + 5] = 12.0;
    assert_refused(body, "the effectors leave the hub a moment of inertia of "
                         "-2.11765");
    M[5 * ORDER + 5] = 30.0;
}

/* What a mode along the line to the grid has as rotation is rounding, whose
   direction means nothing. */
static void a_mode_along_its_line_is_a_spring(void **state)
{
    const double mass = 0.25, ahead[3] = {1, 0, 0};
    const char *path = folder_path("line.py");
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN_ARRAY char *text = NULL;
    const char *second = NULL;

    couple_third(*state, 0.5, 1e-16, 0.0);
    assert_ok(write_module(*state, path, &report));
    couple_third(*state, 0.5, 0.5, 0.1);
    assert_ok(ritz_text_read(path, &text));
    second = strstr(text, "{\"hertz\": 3");
    assert_non_null(second);
    assert_numbers(second, "\"mass\"", 1, &mass);
    assert_numbers(second, "\"axis\"", 3, ahead);
}

/* An unstable mode, which --force exports, grows in Basilisk too. */
static void a_negative_stiffness_keeps_its_sign(void **state)
{
    ritz_reduced *body = *state;
    const double k1 = -3.0 * 4.0 * M_PI * M_PI;
    const double k2 = -2.0 * 16.0 * M_PI * M_PI;
    const char *path = folder_path("unstable.py");
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN_ARRAY char *text = NULL;

    for (int64_t k = 6; k < 8; k++)
        ritz_dense_col(&body->K, k)[k] *= -1.0;
    assert_ok(write_module(body, path, &report));
    for (int64_t k = 6; k < 8; k++)
        ritz_dense_col(&body->K, k)[k] *= -1.0;
    assert_ok(ritz_text_read(path, &text));
    assert_numbers(strstr(text, "SPRINGS = ["), "\"k\"", 1, &k1);
    assert_numbers(strstr(text, "SPINNERS = ["), "\"k\"", 1, &k2);
}

static void modes_of_which_none_fits_are_refused(void **state)
{
    ritz_reduced *body = *state;
    ritz_dense M = {0};

    assert_ok(ritz_dense_copy(&body->M, &M));
    for (int64_t k = 6; k < 8; k++) /* the spring and the spinning body */
        for (int64_t i = 0; i < 6; i++)
            ritz_dense_col(&body->M, k)[i] = ritz_dense_col(&body->M, i)[k] =
                0.0;
    assert_refused(body, "of 4 modes none is a mass on a spring or a spinning "
                         "body, and without effectors the hub is rigid");
    ritz_dense_free(&body->M);
    body->M = M;
}

static void other_bodies_are_refused(void **state)
{
    ritz_reduced *body = *state;

    body->units[0] = '\0';
    assert_refused(body, "and the units are not known");
    snprintf(body->units, sizeof body->units, "kg m s");
    body->K.val[0] = 1e3;
    assert_refused(body, "the body is held at the ground, at 1.13 Hz");
    body->K.val[0] = 0.0;
}

static ritz_status write_once(const ritz_reduced *body, const char *path)
{
    RITZ_OWN(ritz_export_report) report = {0};

    return write_module(body, path, &report);
}

static void no_allocation_failure_leaks(void **state)
{
    assert_survives_every_allocation(
        write_once(*state, folder_path("body.py")));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(modes_become_springs_and_spinning_bodies),
    cmocka_unit_test(the_hub_keeps_the_rest),
    cmocka_unit_test(a_hub_without_mass_or_inertia_is_refused),
    cmocka_unit_test(a_mode_along_its_line_is_a_spring),
    cmocka_unit_test(a_negative_stiffness_keeps_its_sign),
    cmocka_unit_test(modes_of_which_none_fits_are_refused),
    cmocka_unit_test(other_bodies_are_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(basilisk, tests, set_up, tear_down)
