/*
 * Universal files of modes. They are read here by the columns of the published
 * layout: records of fixed fields, data sets between records of -1.
 */
#include "testing.h"

#include "bodies.h"
#include "folder.h"

#include <ritz/basis.h>
#include <ritz/export.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { GRIDS = 4, TEXT_SIZE = 1 << 20, SETS = 64 };

/* A data set: its number and its records, without those of -1. */
typedef struct uff_set {
    int number;
    int count;
    const char *record[512];
} uff_set;

/* A file, cut into records. */
typedef struct uff_file {
    char *text;
    int count;
    uff_set *set;
} uff_file;

static void uff_file_free(uff_file *f)
{
    free(f->text);
    free(f->set);
    *f = (uff_file){0};
}

/* Each record has at most 80 letters; sets follow each other without gaps. */
static void split_sets(uff_file *f)
{
    uff_set *open = NULL;

    for (char *at = f->text, *next = NULL; *at; at = next) {
        char *end = strchr(at, '\n');

        assert_non_null(end);
        *end = '\0';
        next = end + 1;
        assert_true(end - at <= 80);
        if (strcmp(at, "    -1") == 0 && open) {
            open = NULL;
        } else if (!open) {
            assert_string_equal(at, "    -1");
            assert_true(f->count < SETS);
            open = &f->set[f->count++];
        } else if (open->number == 0) {
            assert_int_equal(strlen(at), 6);
            open->number = (int)strtol(at, NULL, 10);
        } else {
            assert_true(open->count < 512);
            open->record[open->count++] = at;
        }
    }
    assert_null(open);
}

static void read_uff(const char *path, uff_file *out)
{
    FILE *file = fopen(path, "r");
    size_t size = 0;

    assert_non_null(file);
    out->text = calloc(TEXT_SIZE, 1);
    out->set = calloc(SETS, sizeof *out->set);
    assert_true(out->text && out->set);
    size = fread(out->text, 1, TEXT_SIZE - 1, file);
    assert_int_equal(fclose(file), 0);
    assert_true(size > 0 && size < TEXT_SIZE - 1);
    split_sets(out);
}

/* The k-th set of a number; NULL: there are fewer. */
static const uff_set *find_set(const uff_file *f, int number, int k)
{
    for (int i = 0; i < f->count; i++)
        if (f->set[i].number == number && k-- == 0)
            return &f->set[i];
    return NULL;
}

/* Field k of a record, behind `skip` letters, each `width` letters wide. */
static double field(const char *record, int skip, int width, int k)
{
    char text[32] = "";
    char *end = NULL;
    double value = 0.0;

    assert_non_null(record);
    if (!record || (int)strlen(record) < skip + width * (k + 1))
        fail_msg("'%s' has no field %d", record ? record : "", k + 1);
    else
        memcpy(text, record + skip + width * k, (size_t)width);
    for (char *at = text; *at; at++)
        if (*at == 'D')
            *at = 'E';
    value = strtod(text, &end);
    assert_true(end == text + width);
    return value;
}

/* A chain of four grids, two bars and a triangle between them; D = M and stated
   damping. */
typedef struct fixture {
    ritz_component body;
    ritz_basis basis;
    ritz_reduced reduced;
} fixture;

static ritz_status add_elements(ritz_component *body)
{
    const int64_t kind[] = {RITZ_CELL_LINE, RITZ_CELL_LINE, RITZ_CELL_TRIANGLE};
    const int64_t first[] = {0, 2, 4, 7};
    const int64_t grid[] = {11, 12, 13, 12, 11, 12, 14};

    body->elements.count = 3;
    RITZ_CHECK_COPY(body->elements.kind, kind, 3);
    RITZ_CHECK_COPY(body->elements.first, first, 4);
    RITZ_CHECK_COPY(body->elements.grid, grid, 7);
    return RITZ_OK;
}

static ritz_status make_fixture(fixture *f)
{
    static const double at[GRIDS][3] = {
        {0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {-1.23456789, 1e-7, 20}};
    ritz_request request = RITZ_REQUEST_NONE;

    RITZ_CHECK(body_chain(GRIDS, at, 11, 4, &f->body));
    RITZ_CHECK(add_elements(&f->body));
    RITZ_CHECK(ritz_sparse_copy(&f->body.M, &f->body.D));
    snprintf(f->body.damping, sizeof f->body.damping, "modal 0.01");
    snprintf(f->body.units, sizeof f->body.units, "kg m s");
    request.component = &f->body;
    RITZ_CHECK(ritz_basis_make(&ritz_method_full, &request, &f->basis));
    return ritz_reduce(&f->body, &f->basis, &f->reduced);
}

static int set_up(void **state)
{
    static fixture f;

    f = (fixture){0};
    *state = &f;
    assert_ok(make_fixture(&f));
    return folder_make(state);
}

static int tear_down(void **state)
{
    fixture *f = *state;

    ritz_component_free(&f->body);
    ritz_basis_free(&f->basis);
    ritz_reduced_free(&f->reduced);
    return folder_remove(state);
}

static ritz_status write_modes(const ritz_shapes *shapes, const char *path,
                               const ritz_stamp *stamp,
                               ritz_export_report *report)
{
    const ritz_export_request request = {.output = path, .stamp = stamp};

    return ritz_exporter_uff.write(&(ritz_export_object){.shapes = shapes},
                                   &request, report);
}

static bool says(const ritz_export_report *report, const char *words)
{
    for (int64_t k = 0; k < report->count; k++)
        if (strstr(report->line[k], words))
            return true;
    return false;
}

/* |a - b| is half a unit of the sixth digit: 5e-6 of the power of ten. */
static void assert_six_digits(double found, double expected)
{
    assert_near(found, expected, 5.0001e-6 * fabs(expected));
}

static void nodes_and_modes_keep_six_digits(void **state)
{
    const fixture *f = *state;
    const char *path = folder_path("modes.uff");
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN(ritz_shapes) s = {0};
    RITZ_OWN(uff_file) file = {0};

    assert_ok(ritz_shapes_of_reduced(&f->reduced, "1,7-9", &s));
    assert_ok(write_modes(&s, path, NULL, &report));
    assert_true(says(&report, "4 modes at 4 nodes, translations and rotations, "
                              "modal mass 1; 4 edges"));
    assert_true(says(&report, "six digits of each number are kept"));
    read_uff(path, &file);
    assert_int_equal(find_set(&file, 15, 0)->count, GRIDS);
    for (int k = 0; k < GRIDS; k++) {
        const char *record = find_set(&file, 15, 0)->record[k];

        assert_true(field(record, 0, 10, 0) == 11.0 + k);
        for (int i = 0; i < 3; i++)
            assert_six_digits(field(record, 40, 13, i), s.position[3 * k + i]);
    }
    for (int j = 0; j < 4; j++) {
        const uff_set *set = find_set(&file, 55, j);

        assert_int_equal(set->count, 8 + 2 * GRIDS);
        assert_string_equal(set->record[0], s.name[j]);
        assert_string_equal(set->record[2], "NONE");
        assert_string_equal(set->record[5], "         1         2         3"
                                            "         8         2         6");
        assert_true(field(set->record[6], 0, 10, 0) == 2.0);
        assert_true(field(set->record[6], 0, 10, 1) == 4.0);
        assert_true(field(set->record[6], 0, 10, 3) == (j == 0 ? 1 : 6 + j));
        for (int k = 0; k < GRIDS; k++) {
            const char *record = set->record[9 + 2 * k];

            assert_true(field(set->record[8 + 2 * k], 0, 10, 0) == 11.0 + k);
            for (int i = 0; i < 3; i++) {
                assert_six_digits(field(record, 0, 13, i),
                                  ritz_dense_col(&s.u, j)[3 * k + i]);
                assert_six_digits(field(record, 39, 13, i),
                                  ritz_dense_col(&s.turn, j)[3 * k + i]);
            }
        }
    }
    assert_null(find_set(&file, 55, 4));
}

/* With D = M each phi'D phi is 1: zeta = 0.01 + 1 / (2 w). Eigenvectors of 24
   rows have phi'M phi = 1 to 24 eps times the condition of M, below 1e-11. */
static void ratios_are_of_matrix_and_statement(void **state)
{
    const fixture *f = *state;
    const char *path = folder_path("ratios.uff");
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN(ritz_shapes) s = {0}, full = {0};
    RITZ_OWN(uff_file) file = {0};
    const char *record = NULL;
    double w = 0.0;

    assert_ok(ritz_shapes_of_reduced(&f->reduced, "1,7", &s));
    assert_ok(ritz_shapes_of_component(&f->body, "1,7", &full));
    w = 2.0 * 3.14159265358979323846 * s.mode[1].hertz;
    assert_true(s.mode[0].hertz == 0.0 && s.mode[0].ratio == 0.0);
    assert_true(s.mode[1].number == 7);
    assert_near(s.mode[1].ratio, 0.01 + 0.5 / w, 1e-11);
    assert_near(full.mode[1].ratio, 0.01 + 0.5 / w, 1e-9);
    assert_string_equal(full.units, "kg m s");
    assert_ok(write_modes(&s, path, NULL, &report));
    assert_true(says(&report, "damping ratios are phi'D phi / (2 w)"));
    read_uff(path, &file);
    record = find_set(&file, 55, 1)->record[7];
    assert_six_digits(field(record, 0, 13, 0), s.mode[1].hertz);
    assert_true(field(record, 0, 13, 1) == 1.0);
    assert_six_digits(field(record, 0, 13, 2), s.mode[1].ratio);
    assert_true(field(record, 0, 13, 3) == 0.0);
}

/* 11-12, 11-14, 12-13 and 12-14: each edge once. */
static void trace_lines_draw_each_edge_once(void **state)
{
    static const double nodes[] = {11, 12, 0, 11, 14, 0, 12, 13, 0, 12, 14};
    const fixture *f = *state;
    const char *path = folder_path("lines.uff");
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN(ritz_shapes) s = {0};
    RITZ_OWN(uff_file) file = {0};
    const uff_set *set = NULL;

    assert_ok(ritz_shapes_of_reduced(&f->reduced, "7", &s));
    assert_ok(write_modes(&s, path, NULL, &report));
    read_uff(path, &file);
    set = find_set(&file, 82, 0);
    assert_non_null(set);
    assert_null(find_set(&file, 82, 1));
    assert_true(field(set->record[0], 0, 10, 1) == 11.0);
    assert_int_equal(set->count, 4);
    for (int k = 0; k < 11; k++)
        assert_true(field(set->record[2 + k / 8], 0, 10, k % 8) == nodes[k]);
}

/* A fan of quadratic triangles: 3 n edges of two halves each; the long line is
   cut where 125 nodes are reached. */
static void long_lines_are_cut_and_halves_drawn(void **state)
{
    enum { CELLS = 30, POINTS = 6 * CELLS };
    int64_t kind[CELLS], first[CELLS + 1] = {0}, grid[POINTS], id[POINTS];
    double position[3 * POINTS] = {0}, u[3 * POINTS] = {0};
    char name[1][RITZ_NAME_SIZE] = {"mode 1, 1 Hz"};
    ritz_shape_mode mode = {1, 1.0, 0.0};
    ritz_shapes s = {
        .num_points = POINTS,
        .id = id,
        .position = position,
        .cells = {.count = CELLS, .kind = kind, .first = first, .grid = grid},
        .meshed = true,
        .count = 1,
        .name = name,
        .u = {3 * POINTS, 1, u},
        .mode = &mode};
    const char *path = folder_path("fan.uff");
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN(uff_file) file = {0};
    int edges = 0;

    (void)state;
    for (int64_t k = 0; k < POINTS; k++) {
        id[k] = k + 1;
        grid[k] = k;
    }
    for (int64_t k = 0; k < CELLS; k++) {
        kind[k] = RITZ_CELL_TRIANGLE6;
        first[k + 1] = 6 * (k + 1);
    }
    assert_ok(write_modes(&s, path, NULL, &report));
    assert_true(says(&report, "without data set 164: units are not known"));
    assert_true(says(&report, "180 edges"));
    read_uff(path, &file);
    assert_null(find_set(&file, 164, 0));
    for (int k = 0; find_set(&file, 82, k); k++) {
        const uff_set *set = find_set(&file, 82, k);
        int count = (int)field(set->record[0], 0, 10, 1);
        double last = 0.0;

        assert_true(count <= 125);
        assert_true(field(set->record[0], 0, 10, 0) == k + 1.0);
        for (int i = 0; i < count; i++) {
            double node = field(set->record[2 + i / 8], 0, 10, i % 8);

            edges += last > 0.0 && node > 0.0;
            last = node;
        }
    }
    assert_int_equal(edges, 6 * CELLS);
}

static void units_and_inputs_are_named(void **state)
{
    const fixture *f = *state;
    const char *path = folder_path("units.uff");
    char text[] = "0123456789abcdef  rotor \xc3\xb6.h5";
    char *const input[] = {text};
    const ritz_stamp stamp = {.command = "x", .num_inputs = 1, .input = input};
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN(ritz_shapes) s = {0};
    RITZ_OWN(uff_file) file = {0};
    const uff_set *set = NULL;

    assert_ok(ritz_shapes_of_reduced(&f->reduced, "7", &s));
    snprintf(s.units, sizeof s.units, "tonne mm s");
    assert_ok(write_modes(&s, path, &stamp, &report));
    read_uff(path, &file);
    set = find_set(&file, 164, 0);
    assert_true(field(set->record[0], 0, 10, 0) == 10.0);
    assert_true(field(set->record[0], 30, 10, 0) == 2.0);
    assert_true(field(set->record[1], 0, 25, 0) == 1000.0);
    assert_true(field(set->record[1], 0, 25, 1) == 1.0);
    assert_true(field(set->record[2], 0, 25, 0) == 273.15);
    set = find_set(&file, 55, 0);
    assert_non_null(strstr(set->record[1], "by Ritz "));
    assert_string_equal(set->record[4], "input: 0123456789abcdef  rotor ??.h5");
}

static void what_the_format_cannot_say_is_refused(void **state)
{
    const fixture *f = *state;
    const char *path = folder_path("none.uff");
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN(ritz_shapes) s = {0}, columns = {0};

    assert_ok(ritz_shapes_of_basis(&f->basis, &f->body, "1", &columns));
    assert_fails(write_modes(&columns, path, NULL, &report), RITZ_ERR_ARGUMENT,
                 "columns of a basis are no modes");
    assert_ok(ritz_shapes_of_reduced(&f->reduced, "7", &s));
    s.mode[0].hertz = -1.0;
    assert_fails(write_modes(&s, path, NULL, &report), RITZ_ERR_ARGUMENT,
                 "does not oscillate: leave it out by --modes");
    s.mode[0].hertz = 1.0;
    s.mode[0].ratio = (double)INFINITY;
    assert_fails(write_modes(&s, path, NULL, &report), RITZ_ERR_ARGUMENT,
                 "at 1 Hz with a damping ratio of inf: the file has room");
    s.mode[0].ratio = 0.0;
    s.id[3] = 2147483648;
    assert_fails(write_modes(&s, path, NULL, &report), RITZ_ERR_ARGUMENT,
                 "grid 2147483648 has no label");
    s.id[3] = 14;
    s.turn.val[3] = 1e100;
    assert_fails(write_modes(&s, path, NULL, &report), RITZ_ERR_ARGUMENT,
                 "a rotation of grid 12 is 1e+100");
    s.turn.val[3] = 0.0;
    s.position[11] = 1e300;
    assert_fails(write_modes(&s, path, NULL, &report), RITZ_ERR_ARGUMENT,
                 "a coordinate of grid 14 is 1e+300");
    assert_int_equal(access(path, F_OK), -1);
    assert_int_equal(report.count, 0);
}

static ritz_status write_once(const fixture *f, const char *path)
{
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN(ritz_shapes) s = {0};

    RITZ_CHECK(ritz_shapes_of_reduced(&f->reduced, "7", &s));
    return write_modes(&s, path, NULL, &report);
}

static ritz_status shape_once(const fixture *f)
{
    RITZ_OWN(ritz_shapes) s = {0};

    return ritz_shapes_of_component(&f->body, "7", &s);
}

static void no_allocation_failure_leaks(void **state)
{
    const fixture *f = *state;

    assert_survives_every_allocation(write_once(f, folder_path("modes.uff")));
    assert_survives_every_allocation(shape_once(f));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(nodes_and_modes_keep_six_digits),
    cmocka_unit_test(ratios_are_of_matrix_and_statement),
    cmocka_unit_test(trace_lines_draw_each_edge_once),
    cmocka_unit_test(long_lines_are_cut_and_halves_drawn),
    cmocka_unit_test(units_and_inputs_are_named),
    cmocka_unit_test(what_the_format_cannot_say_is_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(uff, tests, set_up, tear_down)
