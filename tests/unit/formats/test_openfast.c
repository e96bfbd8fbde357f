/*
 * Superelements for OpenFAST. They are read here by the rules of the published
 * specifications, of release 5 and of those before it.
 */
#include "testing.h"

#include "bodies.h"
#include "folder.h"

#include <ritz/basis.h>
#include <ritz/export.h>

#include <stdio.h>
#include <stdlib.h>
#include <strings.h>
#include <unistd.h>

enum { GRIDS = 4, MODES = 5, ORDER = 6 + MODES, LINES = 200 };

/* What a reader takes from a file. */
typedef struct flex_file {
    char *text;
    int count;
    char *line[LINES];
    int n;
    double M[ORDER * ORDER], K[ORDER * ORDER], D[ORDER * ORDER]; /* by rows */
    double WK[ORDER * ORDER], W[ORDER];
    double step, end; /* of loads */
    double load[2][ORDER + 2];
} flex_file;

static void flex_file_free(flex_file *f)
{
    free(f->text);
    f->text = NULL;
}

static void split_lines(const char *path, flex_file *f)
{
    enum { SIZE = 1 << 18 };
    FILE *file = fopen(path, "r");
    size_t size = 0;

    assert_non_null(file);
    f->text = calloc(SIZE, 1);
    assert_non_null(f->text);
    size = fread(f->text, 1, SIZE - 1, file);
    assert_int_equal(fclose(file), 0);
    assert_true(size > 0 && size < SIZE - 1 && f->text[size - 1] == '\n');
    for (char *at = f->text; *at; at = strchr(at, '\0') + 1) {
        assert_true(f->count < LINES);
        f->line[f->count++] = at;
        *strchr(at, '\n') = '\0';
    }
}

/* Line k; "" behind the last one. */
static const char *line_of(const flex_file *f, int k)
{
    assert_true(k < f->count);
    return k < f->count && f->line[k] ? f->line[k] : "";
}

static bool begins(const char *line, const char *key)
{
    return strncasecmp(line, key, strlen(key)) == 0;
}

/* As many numbers as there are, all that a line holds. */
static void read_row(const char *line, int count, double *out)
{
    char *end = NULL;

    for (int k = 0; k < count; k++, line = end) {
        out[k] = strtod(line, &end);
        assert_true(end != line);
    }
    assert_true(*line == '\0');
}

static void read_rows(const flex_file *f, int *at, int rows, double *out)
{
    for (int i = 0; i < rows; i++)
        read_row(line_of(f, ++*at), f->n, out + (size_t)i * ORDER);
}

/* By keywords in any case; lines of release 4 with a dimension behind a keyword
   are skipped. A keyword that is not known must be a comment. */
static void read_flex(const char *path, bool old, flex_file *f)
{
    const struct {
        const char *key;
        double *values;
        bool only_new;
        int rows;
    } blocks[] = {
        {"!mass", f->M, false, ORDER},
        {"!stiffness", f->K, false, ORDER},
        {"!damping", f->D, false, ORDER},
        {"!weight constant", f->W, true, 1},
        {"!weight stiffness", f->WK, true, ORDER},
    };
    int found = 0;

    split_lines(path, f);
    assert_true(line_of(f, 0)[0] == '!');
    assert_non_null(strstr(line_of(f, 1), "Flex 5 Format"));
    for (int at = 0; at < f->count; at++) {
        const char *line = line_of(f, at);

        assert_true(line[0] == '!');
        if (begins(line, "!dimension:"))
            f->n = (int)strtol(line + 11, NULL, 10);
        else if (begins(line, "!time increment in simulation:"))
            f->step = strtod(line + 30, NULL);
        else if (begins(line, "!total simulation time in file:"))
            f->end = strtod(line + 31, NULL);
        for (size_t k = 0; k < sizeof blocks / sizeof *blocks; k++)
            if (begins(line, blocks[k].key)) {
                assert_int_equal(f->n, ORDER);
                assert_true(!(old && blocks[k].only_new));
                at += old;
                read_rows(f, &at, blocks[k].rows, blocks[k].values);
                found++;
                break;
            }
        if (begins(line, "!loading")) {
            assert_true(old && f->step == 1.0 && f->end == 1.0);
            at++;
            for (int t = 0; t < 2; t++)
                read_row(line_of(f, ++at), ORDER + 2, f->load[t]);
        }
    }
    assert_int_equal(found, old ? 3 : 5);
}

static bool holds_line(const flex_file *f, const char *words)
{
    for (int k = 0; k < f->count; k++)
        if (strstr(line_of(f, k), words))
            return true;
    return false;
}

/* A chain of four grids, the last held by its port, and five modes. */
typedef struct fixture {
    ritz_component body;
    ritz_reduced reduced;
} fixture;

static ritz_status attach_port(const ritz_component *body, const char *port,
                               const ritz_method *method, ritz_reduced *out)
{
    ritz_request request = RITZ_REQUEST_NONE;
    RITZ_OWN(ritz_basis) basis = {0};
    ritz_status status = RITZ_OK;

    request.component = body;
    request.modes = MODES;
    RITZ_CHECK(ritz_component_attached(body, port, &request.attached));
    status = ritz_basis_make(method, &request, &basis);
    ritz_dofs_free(&request.attached);
    RITZ_CHECK(status);
    return ritz_reduce(body, &basis, out);
}

static ritz_status make_body(ritz_component *out)
{
    static const double at[GRIDS][3] = {
        {0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {2, 1, 1}};

    RITZ_CHECK(body_chain(GRIDS, at, 21, 9, out));
    RITZ_CHECK(ritz_sparse_copy(&out->K, &out->D));
    snprintf(out->units, sizeof out->units, "kg m s");
    return RITZ_OK;
}

static int set_up(void **state)
{
    static fixture f;

    f = (fixture){0};
    *state = &f;
    assert_ok(make_body(&f.body));
    assert_ok(
        attach_port(&f.body, "g4", &ritz_method_craig_bampton, &f.reduced));
    return folder_make(state);
}

static int tear_down(void **state)
{
    fixture *f = *state;

    ritz_component_free(&f->body);
    ritz_reduced_free(&f->reduced);
    return folder_remove(state);
}

static ritz_status write_model(const ritz_exporter *exporter,
                               const ritz_reduced *reduced, const char *path,
                               const ritz_stamp *stamp,
                               ritz_export_report *report)
{
    const ritz_export_request request = {.output = path, .stamp = stamp};

    return exporter->write(&(ritz_export_object){.reduced = reduced}, &request,
                           report);
}

/* Bit for bit, but for the sign of zero. */
static void assert_matrix(const double *found, const ritz_dense *A)
{
    for (int i = 0; i < ORDER; i++)
        for (int j = 0; j < ORDER; j++)
            assert_true(found[i * ORDER + j] == ritz_dense_col(A, j)[i]);
}

static void assert_zeros(const double *found, int count)
{
    for (int k = 0; k < count; k++)
        assert_true(found[k] == 0.0);
}

/* Constraint modes come first in Craig-Bampton, and axes are basic. */
static void release_5_reads_every_bit(void **state)
{
    const fixture *f = *state;
    const char *path = folder_path("five.dat");
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN(flex_file) file = {0};

    assert_int_equal(f->reduced.K.ncol, ORDER);
    assert_ok(
        write_model(&ritz_exporter_openfast, &f->reduced, path, NULL, &report));
    read_flex(path, false, &file);
    assert_matrix(file.K, &f->reduced.K);
    assert_matrix(file.M, &f->reduced.M);
    assert_matrix(file.D, &f->reduced.D);
    assert_zeros(file.W, ORDER);
    assert_zeros(file.WK, ORDER * ORDER);
    assert_non_null(strstr(report.line[0], "six directions of grid 24 and 5 "
                                           "modes"));
}

static void releases_before_read_loads_too(void **state)
{
    const fixture *f = *state;
    const char *path = folder_path("four.dat");
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN(flex_file) file = {0};

    assert_ok(write_model(&ritz_exporter_openfast_4, &f->reduced, path, NULL,
                          &report));
    read_flex(path, true, &file);
    assert_matrix(file.K, &f->reduced.K);
    assert_matrix(file.M, &f->reduced.M);
    assert_matrix(file.D, &f->reduced.D);
    assert_true(file.load[0][0] == 0.0 && file.load[1][0] == 1.0);
    for (int t = 0; t < 2; t++)
        assert_zeros(file.load[t] + 1, ORDER + 1);
}

/* Axes of grid 24 turned about x, y = 0.8 y' - 0.6 z': along basic axes the
   interface has the same K as if they had not been. Static condensation has
   the error eps cond(K_ii), and the condition is below 1e4. */
static void own_axes_become_basic_ones(void **state)
{
    static const double axes[18] = {1, 0, 0, 0, 1,   0,   0, 0,    1,
                                    1, 0, 0, 0, 0.8, 0.6, 0, -0.6, 0.8};
    const fixture *f = *state;
    const char *path = folder_path("own.dat");
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN(flex_file) file = {0};
    RITZ_OWN(ritz_component) body = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_sparse) turn = {0}, K = {0}, M = {0};
    int64_t row[40], col[40], count = 0;
    double val[40];
    double most = ritz_dense_max(&f->reduced.K);

    assert_ok(make_body(&body));
    ritz_sparse_free(&body.D);
    free(body.grids.axes);
    body.grids.axes = malloc(sizeof axes);
    assert_non_null(body.grids.axes);
    memcpy(body.grids.axes, axes, sizeof axes);
    body.grids.num_frames = 2;
    body.grids.frame[3] = 1;
    /* u_basic = Q u, with block (axes)' for grid 24 */
    for (int64_t j = 0; j < 24; j++)
        for (int64_t i = 0; i < 24; i++) {
            bool own = j >= 18 && i / 3 == j / 3;
            double q = own ? axes[9 + 3 * (j % 3) + i % 3] : i == j ? 1.0 : 0.0;

            if (q == 0.0)
                continue;
            row[count] = i;
            col[count] = j;
            val[count++] = q;
        }
    assert_ok(ritz_sparse_from_triplets(24, 24, count, row, col, val, &turn));
    assert_ok(ritz_sparse_congruence(&body.K, &turn, &K));
    assert_ok(ritz_sparse_congruence(&body.M, &turn, &M));
    ritz_sparse_free(&body.K);
    ritz_sparse_free(&body.M);
    RITZ_MOVE(body.K, K);
    RITZ_MOVE(body.M, M);
    assert_ok(attach_port(&body, "g4", &ritz_method_craig_bampton, &reduced));
    assert_ok(
        write_model(&ritz_exporter_openfast, &reduced, path, NULL, &report));
    read_flex(path, false, &file);
    assert_true(holds_line(&file, "damping: none"));
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++) {
            assert_near(file.K[i * ORDER + j],
                        ritz_dense_col(&f->reduced.K, j)[i], 1e-11 * most);
            assert_near(file.M[i * ORDER + j],
                        ritz_dense_col(&f->reduced.M, j)[i], 1e-11 * most);
        }
}

/* Measures, damping and inputs are in comments; a rule of damping is in D. */
static void the_certificate_is_in_comments(void **state)
{
    const fixture *f = *state;
    const char *path = folder_path("sealed.dat");
    char text[] = "0123456789abcdef  a\nb.h5";
    char *const input[] = {text};
    const ritz_stamp stamp = {.command = "ritz-export --to openfast a.h5",
                              .num_inputs = 1,
                              .input = input};
    ritz_measure item = {.name = "frequency-relative",
                         .value = 1.5e-6,
                         .limit = 1e-3,
                         .where = "mode 7, 3.41 Hz"};
    ritz_reduced known = f->reduced; /* borrowed */
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN(flex_file) file = {0};

    known.errors = (ritz_measures){1, &item};
    snprintf(known.damping, sizeof known.damping, "rayleigh 2 0");
    assert_ok(
        write_model(&ritz_exporter_openfast, &known, path, &stamp, &report));
    read_flex(path, false, &file);
    assert_true(holds_line(&file, "! reduced component by Ritz"));
    assert_true(holds_line(&file, "! error, measured: frequency-relative "
                                  "1.5e-06, limit 0.001, at mode 7, 3.41 Hz"));
    assert_true(holds_line(&file, "! input: 0123456789abcdef  a?b.h5"));
    assert_true(holds_line(&file, "! command: ritz-export --to openfast a.h5"));
    assert_true(holds_line(&file, "! damping: rayleigh 2 0"));
    for (int k = 0; k < ORDER; k++) /* D + 2 M, two roundings */
        assert_near(file.D[k * (ORDER + 1)],
                    ritz_dense_col(&f->reduced.D, k)[k] +
                        2.0 * ritz_dense_col(&f->reduced.M, k)[k],
                    1e-15 * file.D[k * (ORDER + 1)]);
}

static void assert_refused(const ritz_reduced *reduced, const char *words)
{
    const char *path = folder_path("none.dat");
    RITZ_OWN(ritz_export_report) report = {0};

    assert_fails(
        write_model(&ritz_exporter_openfast, reduced, path, NULL, &report),
        RITZ_ERR_ARGUMENT, words);
    assert_int_equal(access(path, F_OK), -1);
    assert_int_equal(report.count, 0);
}

static void other_interfaces_and_units_are_refused(void **state)
{
    const fixture *f = *state;
    ritz_reduced other = f->reduced; /* borrowed */
    RITZ_OWN(ritz_reduced) two = {0}, free_free = {0};

    snprintf(other.units, sizeof other.units, "tonne mm s");
    assert_refused(&other, "the units are 'tonne mm s'");
    other.units[0] = '\0';
    assert_refused(&other, "the units are not known: import with --units");
    assert_ok(attach_port(&f->body, "g1,g4", &ritz_method_craig_bampton, &two));
    assert_refused(&two, "its ports have 2 grids: tie what is joined to one "
                         "grid by an RBE2");
    assert_ok(
        attach_port(&f->body, "g4", &ritz_method_macneal_rubin, &free_free));
    assert_refused(&free_free, "cannot hold the six motions of 4 grids");
}

static ritz_status write_once(const fixture *f, const char *path)
{
    RITZ_OWN(ritz_export_report) report = {0};

    return write_model(&ritz_exporter_openfast_4, &f->reduced, path, NULL,
                       &report);
}

static void no_allocation_failure_leaks(void **state)
{
    assert_survives_every_allocation(
        write_once(*state, folder_path("four.dat")));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(release_5_reads_every_bit),
    cmocka_unit_test(releases_before_read_loads_too),
    cmocka_unit_test(own_axes_become_basic_ones),
    cmocka_unit_test(the_certificate_is_in_comments),
    cmocka_unit_test(other_interfaces_and_units_are_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(openfast, tests, set_up, tear_down)
