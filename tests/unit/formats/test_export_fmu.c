/*
 * FMUs of small models. The archive is opened by libarchive's reader, the
 * description is compared with the text of the standard's examples, and the
 * numbers are put to use by the program that an importer loads.
 */
#include "base/alloc.h"
#include "faults.h"
#include "fmu_driver.h"
#include "folder.h"
#include "formats/fmu.h"
#include "masses.h"
#include "scenes.h"
#include "testing.h"

#include <ritz/basis.h>
#include <ritz/export.h>
#include <ritz/matrix.h>
#include <ritz/simulate.h>

#include <archive.h>
#include <archive_entry.h>
#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

enum { MASSES = 3, FILES = 5, TEXT = 1 << 16 };

/* ---- models ------------------------------------------------------------- */

/* Three masses, two forces, and outputs of each order. */
static void make_masses(const double *c, bool is_free, ritz_reduced *out)
{
    const double m[MASSES] = {2.0, 1.0, 1.5};
    const double k[MASSES] = {is_free ? 0.0 : 300.0, 200.0, 100.0};
    RITZ_OWN(ritz_component) masses = {0};

    assert_ok(masses_component(MASSES, m, k, c, &masses));
    assert_ok(masses_io(&masses, 2, (const int64_t[]){0, 2}, 3,
                        (const int64_t[]){0, 1, 2}));
    ritz_dense_col(&masses.io.C, 1)[1] = 0.0;
    ritz_dense_col(&masses.io.Cv, 1)[1] = 1.0;
    ritz_dense_col(&masses.io.C, 2)[2] = 0.0;
    ritz_dense_col(&masses.io.Ca, 2)[2] = 1.0;
    strcpy(masses.units, "kg mm s");
    assert_ok(reduce_with(&masses, &ritz_method_full, -1, out));
}

static ritz_status write_it(const ritz_reduced *reduced, int64_t fmi,
                            const char *name, ritz_export_report *report)
{
    const ritz_export_object object = {.reduced = reduced};
    const ritz_export_request request = {
        .output = folder_path(name), .fmi = fmi, .runtime = fmu_runtime()};

    return ritz_exporter_fmu.write(&object, &request, report);
}

static void rename_port(char to[RITZ_NAME_SIZE], const char *name)
{
    snprintf(to, RITZ_NAME_SIZE, "%s", name);
}

/* ---- what is in the archive --------------------------------------------- */

typedef struct fmu_file {
    char path[128];
    char *bytes;
    int64_t size, mode;
} fmu_file;

typedef struct fmu_archive {
    int count;
    fmu_file file[FILES];
} fmu_archive;

static void fmu_archive_free(fmu_archive *a)
{
    for (int k = 0; k < a->count; k++)
        free(a->file[k].bytes);
    *a = (fmu_archive){0};
}

static void open_archive(const char *name, fmu_archive *out)
{
    struct archive *a = archive_read_new();
    struct archive_entry *e = NULL;

    assert_int_equal(archive_read_support_format_zip(a), ARCHIVE_OK);
    assert_int_equal(archive_read_open_filename(a, folder_path(name), TEXT),
                     ARCHIVE_OK);
    while (archive_read_next_header(a, &e) == ARCHIVE_OK) {
        fmu_file *f = &out->file[out->count++];

        assert_true(out->count <= FILES);
        snprintf(f->path, sizeof f->path, "%s", archive_entry_pathname(e));
        f->size = archive_entry_size(e);
        f->mode = archive_entry_perm(e);
        f->bytes = calloc((size_t)f->size + 1, 1);
        assert_non_null(f->bytes);
        assert_int_equal(archive_read_data(a, f->bytes, (size_t)f->size),
                         f->size);
    }
    archive_read_free(a);
}

static const fmu_file *file_of(const fmu_archive *a, const char *path)
{
    for (int k = 0; k < a->count; k++)
        if (strcmp(a->file[k].path, path) == 0)
            return &a->file[k];
    fail_msg("there is no '%s'", path);
    return NULL;
}

/* How often a text has some words. */
static int count_words(const char *text, const char *words)
{
    int count = 0;

    for (; (text = strstr(text, words)) != NULL; text++)
        count++;
    return count;
}

static void assert_says(const char *text, const char *words)
{
    if (!strstr(text, words))
        fail_msg("'%s' is not in %s", words, text);
}

/* Instance of the resources, with the token of the description. */
static void drive(const fmu_archive *a, int fmi, fmu_driver *d)
{
    const fmu_file *numbers = file_of(a, "resources/ritz.bin");
    const char *key = fmi == 2 ? " guid=\"" : " instantiationToken=\"";
    const char *at = strstr(file_of(a, "modelDescription.xml")->bytes, key);
    char token[65] = "";

    assert_non_null(at);
    memcpy(token, at + strlen(key), 64);
    fmu_sample_write((const unsigned char *)numbers->bytes,
                     (size_t)numbers->size);
    if (!fmu_open(fmi, folder_path("."), token, true, d))
        fail_msg("%s", d->said);
}

/* ---- motion ------------------------------------------------------------- */

enum { STEPS = 40 };

/* ritz-simulate of a sine and a step, both held. */
static void simulate(ritz_model model, ritz_simulation *out)
{
    const ritz_signal signal[2] = {
        {.kind = RITZ_SIGNAL_SINE, .amplitude = 2.0, .hertz = {0.4, 0.0}},
        {.kind = RITZ_SIGNAL_STEP, .amplitude = -1.0}};
    const ritz_simulation_request request = {.integrator =
                                                 &ritz_integrator_modal,
                                             .seconds = STEPS * 0.125,
                                             .step = 0.125,
                                             .hold = RITZ_HOLD_ZERO,
                                             .signal = signal};

    assert_ok(ritz_simulate(model, &request, out));
}

/* The program's outputs are those of ritz_simulate. */
static void assert_same_motion(const char *name, int fmi, ritz_model model)
{
    RITZ_OWN(ritz_simulation) s = {0};
    RITZ_OWN(fmu_archive) a = {0};
    fmu_driver d;
    double largest[3] = {0.0};

    simulate(model, &s);
    for (int64_t k = 0; k < s.count * 3; k++)
        largest[k % 3] = fmax(largest[k % 3], fabs(s.y[k]));
    open_archive(name, &a);
    drive(&a, fmi, &d);
    assert_int_equal(fmu_start(&d, 0.0), FMI_OK);
    for (int64_t k = 0; k < s.count; k++) {
        for (unsigned j = 0; j < 2; j++)
            assert_int_equal(fmu_put(&d, 1 + j, s.u[2 * k + j]), FMI_OK);
        for (unsigned i = 0; i < 3; i++) /* rounding of 40 steps */
            assert_near(fmu_value(&d, 3 + i), s.y[3 * k + i],
                        1e-13 * largest[i]);
        assert_int_equal(fmu_step_over(&d, s.seconds[k], 0.125), FMI_OK);
    }
    fmu_close(&d);
}

static void held_inputs_give_the_motion_of_ritz_simulate(void **state)
{
    const double coupled[MASSES] = {3.0, 0.0, 1.0};
    const char *blocks[3] = {"states: 6, of 3 uncoupled modes",
                             "states: 6, of 3 uncoupled modes",
                             "states: 6, of 0 uncoupled modes"};

    (void)state;
    for (int kind = 0; kind < 3; kind++)
        for (int fmi = 2; fmi <= 3; fmi++) {
            RITZ_OWN(ritz_reduced) reduced = {0};
            RITZ_OWN(ritz_export_report) report = {0};
            ritz_damping damping = {0};

            make_masses(kind == 2 ? coupled : NULL, kind == 1, &reduced);
            if (kind == 0)
                strcpy(reduced.damping, "modal 0.05");
            assert_ok(write_it(&reduced, fmi, "masses.fmu", &report));
            assert_says(report.line[1], blocks[kind]);
            if (kind == 0)
                assert_ok(ritz_damping_parse("modal 0.05", &damping));
            assert_same_motion("masses.fmu", fmi,
                               ritz_model_of_reduced(&reduced, &damping));
        }
}

static void a_state_space_moves_as_ritz_simulate_does(void **state)
{
    const double coupled[MASSES] = {3.0, 0.0, 1.0};

    (void)state;
    for (int kind = 0; kind < 2; kind++) {
        RITZ_OWN(ritz_reduced) reduced = {0};
        RITZ_OWN(ritz_state_space) states = {0};
        RITZ_OWN(ritz_export_report) report = {0};
        const ritz_export_object object = {.states = &states};
        const ritz_export_request request = {
            .output = folder_path("states.fmu"), .runtime = fmu_runtime()};

        make_masses(coupled, kind == 1, &reduced);
        assert_ok(ritz_states_of_reduced(&reduced, NULL, &states));
        assert_ok(ritz_exporter_fmu.write(&object, &request, &report));
        assert_same_motion("states.fmu", 3, ritz_model_of_states(&states));
    }
}

/* Responses near the smallest double, a part of which is no double. */
static void nominal_values_stay_above_zero(void **state)
{
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_state_space) states = {0};
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN(fmu_archive) a = {0};
    const ritz_export_object object = {.states = &states};
    const ritz_export_request request = {.output = folder_path("tiny.fmu"),
                                         .runtime = fmu_runtime()};
    fmu_driver d;

    (void)state;
    make_masses(NULL, false, &reduced);
    assert_ok(ritz_states_of_reduced(&reduced, NULL, &states));
    for (int64_t k = 0; k < states.B.nrow * states.B.ncol; k++)
        states.B.val[k] *= 1e-320;
    assert_ok(ritz_exporter_fmu.write(&object, &request, &report));
    open_archive("tiny.fmu", &a);
    assert_int_equal(count_words(a.file[0].bytes, "nominal=\"0\""), 0);
    drive(&a, 3, &d); /* which the program refuses otherwise */
    fmu_close(&d);
}

/* The largest double on the diagonal of A and a number below it: their sum, a
   pole, is infinite. The model has no frequency to be scaled by. */
static void a_pole_beyond_all_doubles_ends_no_search(void **state)
{
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_state_space) states = {0};
    RITZ_OWN(ritz_export_report) report = {0};
    const ritz_export_object object = {.states = &states};
    const ritz_export_request request = {.output = folder_path("huge.fmu"),
                                         .runtime = fmu_runtime()};

    (void)state;
    make_masses(NULL, false, &reduced);
    assert_ok(ritz_states_of_reduced(&reduced, NULL, &states));
    for (int64_t k = 0; k < states.A.nrow * states.A.ncol; k++)
        states.A.val[k] = DBL_MAX;
    assert_ok(ritz_exporter_fmu.write(&object, &request, &report));
}

/* ---- text --------------------------------------------------------------- */

static void the_archive_holds_what_the_standard_wants(void **state)
{
    static const char *const paths[2][FILES] = {
        {"modelDescription.xml", "documentation/index.html",
         "documentation/license.txt", "resources/ritz.bin",
         "binaries/linux64/ritz_fmu.so"},
        {"modelDescription.xml", "documentation/index.html",
         "documentation/licenses/license.txt", "resources/ritz.bin",
         "binaries/x86_64-linux/ritz_fmu.so"}};
    RITZ_OWN(ritz_reduced) reduced = {0};

    (void)state;
    make_masses(NULL, false, &reduced);
    for (int fmi = 2; fmi <= 3; fmi++) {
        RITZ_OWN(ritz_export_report) report = {0};
        RITZ_OWN(fmu_archive) a = {0};

        assert_ok(write_it(&reduced, fmi, "held.fmu", &report));
        open_archive("held.fmu", &a);
        assert_int_equal(a.count, FILES);
        for (int k = 0; k < FILES; k++) {
            assert_string_equal(a.file[k].path, paths[fmi - 2][k]);
            assert_int_equal(a.file[k].mode, k == 4 ? 0755 : 0644);
        }
        /* the program calls malloc, not what an importer of FMI 2 gives it */
        assert_int_equal(
            count_words(a.file[0].bytes,
                        "canNotUseMemoryManagementFunctions=\"true\""),
            fmi == 2 ? 2 : 0);
        assert_says(a.file[1].bytes, "errors: neither measured nor estimated");
        assert_says(a.file[1].bytes, "units: kg mm s");
        assert_says(a.file[2].bytes, "BSD Zero Clause License");
        assert_says(a.file[2].bytes, "Modelica Association Project");
        assert_memory_equal(a.file[4].bytes, "\177ELF", 4);
    }
}

static void the_same_model_gives_the_same_bytes(void **state)
{
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_export_report) report = {0};
    char digest[3][RITZ_DIGEST_SIZE];

    (void)state;
    make_masses(NULL, false, &reduced);
    for (int k = 0; k < 3; k++) {
        assert_int_equal(setenv("TZ", k == 0 ? "UTC" : "Asia/Tokyo", 1), 0);
        tzset();
        if (k == 2)
            reduced.K.val[0] *= 1.0 + DBL_EPSILON;
        assert_ok(write_it(&reduced, 3, "twice.fmu", &report));
        assert_ok(ritz_digest_file(folder_path("twice.fmu"), digest[k]));
    }
    assert_int_equal(unsetenv("TZ"), 0);
    tzset();
    assert_string_equal(digest[0], digest[1]);
    assert_string_not_equal(digest[0], digest[2]);
}

/* Two free bodies and their modes: no unknown depends on every known one. */
static void dependencies_are_the_entries_that_are_not_zero(void **state)
{
    const double k[2] = {4.0, 9.0};
    RITZ_OWN(ritz_component) masses = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};

    (void)state;
    assert_ok(masses_apart(2, k, NULL, &masses));
    assert_ok(
        masses_io(&masses, 1, (const int64_t[]){1}, 1, (const int64_t[]){0}));
    assert_ok(reduce_with(&masses, &ritz_method_full, -1, &reduced));
    for (int fmi = 2; fmi <= 3; fmi++) {
        RITZ_OWN(ritz_export_report) report = {0};
        RITZ_OWN(fmu_archive) a = {0};
        const char *text = NULL;

        assert_ok(write_it(&reduced, fmi, "apart.fmu", &report));
        open_archive("apart.fmu", &a);
        text = file_of(&a, "modelDescription.xml")->bytes;
        /* y1 of q[1]; der(q[1]) of v[1]; der(v[2]) of u1 and q[2] */
        assert_says(text, fmi == 2 ? "index=\"3\" dependencies=\"4\" "
                                     "dependenciesKind=\"constant\""
                                   : "<Output valueReference=\"2\" "
                                     "dependencies=\"3\"");
        assert_says(text, fmi == 2 ? "index=\"8\" dependencies=\"5\""
                                   : "<ContinuousStateDerivative "
                                     "valueReference=\"7\" dependencies=\"4\"");
        assert_says(text, fmi == 2
                              ? "index=\"11\" dependencies=\"2 6\" "
                                "dependenciesKind=\"constant constant\""
                              : "valueReference=\"10\" dependencies=\"1 5\"");
        /* each unknown is an initial one too */
        assert_int_equal(count_words(text, "dependenciesKind"), 2 * 5);
    }
}

/* x' = A x + B u, y = C x + D u with matrices of ones, but D_21 = 0. */
static ritz_status make_dense_fmu(int64_t n, ritz_fmu *out)
{
    RITZ_OWN(ritz_fmu)
    fmu = {.num_inputs = 2, .num_outputs = 2, .num_states = n, .num_blocks = 1};

    RITZ_CHECK_NEW(fmu.block, 1);
    RITZ_CHECK_NEW(fmu.nominal, n);
    RITZ_CHECK_NEW(fmu.state, n);
    RITZ_CHECK_NEW(fmu.input, 2);
    RITZ_CHECK_NEW(fmu.output, 2);
    RITZ_CHECK(ritz_dense_new(n, n, &fmu.block[0]));
    RITZ_CHECK(ritz_dense_new(n, 2, &fmu.B));
    RITZ_CHECK(ritz_dense_new(2, n, &fmu.C));
    RITZ_CHECK(ritz_dense_new(2, 2, &fmu.D));
    for (int64_t i = 0; i < n * n; i++)
        fmu.block[0].val[i] = 1.0;
    for (int64_t i = 0; i < 2 * n; i++)
        fmu.B.val[i] = fmu.C.val[i] = 1.0;
    for (int i = 0; i < 4; i++)
        fmu.D.val[i] = i == 1 ? 0.0 : 1.0;
    for (int k = 0; k < 2; k++)
        fmu.input[k].says = fmu.output[k].says = "";
    RITZ_MOVE(*out, fmu);
    return RITZ_OK;
}

/* Lists of 100 are there. Longer ones are not, but of y2, on which u1 does not
 * act directly: an importer would suspect an algebraic loop. */
static void long_lists_of_dependencies_are_left_out(void **state)
{
    static const struct {
        int64_t order;
        int listed;
    } cases[] = {{98, 2 * 100}, {101, 2 * 1}};

    (void)state;
    for (int k = 0; k < 4; k++) {
        const ritz_fmu_text text = {
            .fmi = k < 2 ? 2 : 3, .name = "", .description = "", .token = ""};
        RITZ_OWN(ritz_fmu) fmu = {0};
        RITZ_OWN_ARRAY char *page = NULL;
        int64_t length = 0;

        assert_ok(make_dense_fmu(cases[k % 2].order, &fmu));
        assert_ok(ritz_fmu_describe(&fmu, &text, &page, &length));
        assert_int_equal(count_words(page, "dependenciesKind"),
                         cases[k % 2].listed);
        assert_int_equal(count_words(page, " dependencies=\""),
                         cases[k % 2].listed);
    }
}

static void names_are_distinct_and_escaped(void **state)
{
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN(fmu_archive) a = {0};
    const char *text = NULL;

    (void)state;
    make_masses(NULL, false, &reduced);
    rename_port(reduced.io.input[0], "a<b&\"c\"");
    rename_port(reduced.io.input[1], "time");
    rename_port(reduced.io.output[0], "der(q[1])");
    rename_port(reduced.io.output[1], "a<b&\"c\"");
    rename_port(reduced.io.output[2], "t\tb\xff");
    assert_ok(write_it(&reduced, 3, "names.fmu", &report));
    open_archive("names.fmu", &a);
    text = file_of(&a, "modelDescription.xml")->bytes;
    assert_says(text, "name=\"a&lt;b&amp;&quot;c&quot;\"");
    assert_says(text, "name=\"time (input)\"");
    assert_says(text, "name=\"der(q[1]) (output)\"");
    assert_says(text, "name=\"a&lt;b&amp;&quot;c&quot; (output)\"");
    assert_says(text, "name=\"t?b?\"");
    assert_says(report.line[2], "4 names of inputs and outputs are changed");
}

/* kg mm s: a force is in kg.mm/s2, a thousandth of a newton. */
static void units_are_stated_where_they_are_known(void **state)
{
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN(fmu_archive) a = {0};
    const char *text = NULL;

    (void)state;
    make_masses(NULL, false, &reduced);
    for (int64_t j = 0; j < reduced.io.B.nrow; j++)
        ritz_dense_col(&reduced.io.B, 1)[j] *= 2.0; /* of no dof */
    assert_ok(write_it(&reduced, 3, "units.fmu", &report));
    open_archive("units.fmu", &a);
    text = file_of(&a, "modelDescription.xml")->bytes;
    assert_says(text, "<Unit name=\"kg.mm/s2\"><BaseUnit kg=\"1\" m=\"1\" "
                      "s=\"-2\" factor=\"0.001\"/>");
    assert_says(text, "<Unit name=\"mm/s2\"><BaseUnit m=\"1\" s=\"-2\" ");
    assert_says(text, "name=\"u1\" valueReference=\"1\" description=\"force\" "
                      "causality=\"input\" variability=\"continuous\" "
                      "unit=\"kg.mm/s2\"");
    assert_says(text, "name=\"u2\" valueReference=\"2\" description=\"force or "
                      "moment\" causality=\"input\" variability=\"continuous\""
                      " start");
    assert_says(text, "description=\"velocity\" causality=\"output\" "
                      "variability=\"continuous\" initial=\"calculated\" "
                      "unit=\"mm/s\"");
    assert_says(report.line[2], "units of 1 inputs and outputs are not known");
    assert_int_equal(count_words(text, "<Unit name"), 5);
}

static void moments_and_tonnes_have_units(void **state)
{
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN(fmu_archive) a = {0};
    const char *text = NULL;

    (void)state;
    make_masses(NULL, false, &reduced);
    for (int64_t i = 0; i < reduced.num_dofs; i++)
        reduced.dof[i].component = 6;
    strcpy(reduced.units, "tonne mm s");
    assert_ok(write_it(&reduced, 2, "turns.fmu", &report));
    open_archive("turns.fmu", &a);
    text = file_of(&a, "modelDescription.xml")->bytes;
    assert_says(text,
                "<Unit name=\"N.mm\"><BaseUnit kg=\"1\" m=\"2\" s=\"-2\"");
    assert_says(text, "description=\"moment\"");
    assert_says(text, "description=\"angular acceleration\"");
    assert_says(text, "<Unit name=\"rad/s2\"><BaseUnit s=\"-2\" rad=\"1\" "
                      "factor=\"1\"/>");
}

/* ---- refusals ----------------------------------------------------------- */

static void models_that_no_fmu_can_hold_are_refused(void **state)
{
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_export_report) report = {0};
    const ritz_export_object object = {.reduced = &reduced};
    ritz_export_request request = {.output = folder_path("none.fmu")};

    (void)state;
    make_masses(NULL, false, &reduced);
    assert_fails(ritz_exporter_fmu.write(&object, &request, &report),
                 RITZ_ERR_ARGUMENT, "no folder with the program");
    request.runtime = folder_path("missing");
    assert_fails(ritz_exporter_fmu.write(&object, &request, &report),
                 RITZ_ERR_FILE, "which is installed with the tools");
    request.runtime = folder_path(".");
    (void)folder_write("ritz_fmu.so", "\177ELF of another machine");
    assert_fails(ritz_exporter_fmu.write(&object, &request, &report),
                 RITZ_ERR_FILE, "is no program of Linux on x86_64");
    assert_ok(ritz_dense_copy(&reduced.K, &reduced.K4));
    assert_fails(write_it(&reduced, 3, "none.fmu", &report), RITZ_ERR_ARGUMENT,
                 "structural damping is of harmonic motion alone");
    ritz_dense_free(&reduced.K4);
    reduced.io.B.val[0] = (double)INFINITY;
    assert_fails(write_it(&reduced, 3, "none.fmu", &report), RITZ_ERR_ARGUMENT,
                 "is not finite");
    ritz_io_free(&reduced.io);
    assert_ok(ritz_io_new(MASSES, 0, 0, &reduced.io));
    assert_fails(write_it(&reduced, 3, "none.fmu", &report), RITZ_ERR_ARGUMENT,
                 "it has neither inputs nor outputs");
    assert_int_equal(access(folder_path("none.fmu"), F_OK), -1);
    assert_fails(ritz_export_check(&ritz_exporter_dmig,
                                   &(ritz_export_request){.fmi = 2}),
                 RITZ_ERR_ARGUMENT, "dmig has no version of FMI");
}

static void a_model_may_have_inputs_or_outputs_alone(void **state)
{
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN(fmu_archive) a = {0};
    fmu_driver d;

    (void)state;
    make_masses(NULL, false, &reduced);
    ritz_io_free(&reduced.io);
    assert_ok(ritz_io_new(MASSES, 0, 1, &reduced.io));
    rename_port(reduced.io.output[0], "y");
    ritz_dense_col(&reduced.io.C, 0)[0] = 1.0;
    assert_ok(write_it(&reduced, 2, "quiet.fmu", &report));
    assert_string_equal(report.line[2], "warning: no input drives it");
    open_archive("quiet.fmu", &a);
    drive(&a, 2, &d);
    assert_int_equal(fmu_put(&d, 2, 1.0), FMI_OK);
    assert_int_equal(fmu_start(&d, 0.0), FMI_OK);
    assert_int_equal(fmu_step_over(&d, 0.0, 0.5), FMI_OK);
    assert_true(fmu_value(&d, 1) != 0.0);
    fmu_close(&d);
}

static ritz_status write_once(const ritz_reduced *reduced)
{
    RITZ_OWN(ritz_export_report) report = {0};

    return write_it(reduced, 3, "memory.fmu", &report);
}

static void exports_survive_every_failing_allocation(void **state)
{
    const double coupled[MASSES] = {3.0, 0.0, 1.0};
    RITZ_OWN(ritz_reduced) reduced = {0};

    (void)state;
    make_masses(coupled, false, &reduced);
    strcpy(reduced.damping, "modal 0.05");
    assert_survives_every_allocation(write_once(&reduced));
}

static ritz_status write_borrowed(const void *reduced)
{
    return write_once(reduced);
}

static void a_failed_write_leaves_no_file(void **state)
{
    RITZ_OWN(ritz_reduced) reduced = {0};

    (void)state;
    make_masses(NULL, false, &reduced);
    assert_true(faults_try_each(write_borrowed, &reduced,
                                folder_path("memory.fmu")) >= 1);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(held_inputs_give_the_motion_of_ritz_simulate),
    cmocka_unit_test(a_state_space_moves_as_ritz_simulate_does),
    cmocka_unit_test(nominal_values_stay_above_zero),
    cmocka_unit_test(a_pole_beyond_all_doubles_ends_no_search),
    cmocka_unit_test(the_archive_holds_what_the_standard_wants),
    cmocka_unit_test(the_same_model_gives_the_same_bytes),
    cmocka_unit_test(dependencies_are_the_entries_that_are_not_zero),
    cmocka_unit_test(long_lists_of_dependencies_are_left_out),
    cmocka_unit_test(names_are_distinct_and_escaped),
    cmocka_unit_test(units_are_stated_where_they_are_known),
    cmocka_unit_test(moments_and_tonnes_have_units),
    cmocka_unit_test(models_that_no_fmu_can_hold_are_refused),
    cmocka_unit_test(a_model_may_have_inputs_or_outputs_alone),
    cmocka_unit_test(exports_survive_every_failing_allocation),
    cmocka_unit_test(a_failed_write_leaves_no_file),
};

TEST_MODULE(export_fmu, tests, folder_make, folder_remove)
