/*
 * Series of displaced shapes with stresses, one frame for each time. The tests
 * check the numbers in each frame, and that a series that cannot be finished
 * leaves no file. meshio reads such series in tests/tools/recover.sh.
 */
#include "testing.h"

#include "damage.h"
#include "folder.h"

#include <ritz/export.h>

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* A line of grids 1, 2 and 3 with element 7 from 1 to 2 and element 9 from 2
   to 3. */
static void make_body(ritz_reduced *out)
{
    static const int64_t grid[] = {1, 2, 2, 3};
    ritz_quantity *q = NULL;

    *out = (ritz_reduced){.num_dofs = 3, .units = "kg m s"};
    assert_ok(ritz_dense_identity(2, &out->K));
    assert_ok(ritz_dense_identity(2, &out->M));
    assert_ok(ritz_dense_new(3, 2, &out->T));
    assert_ok(ritz_columns_new(2, &out->columns));
    assert_ok(ritz_io_new(2, 0, 0, &out->io));
    out->T.val[0] = 1.0;
    out->T.val[5] = 2.0;
    out->dof = ritz_zalloc(3, sizeof *out->dof);
    out->grids = (ritz_grids){.count = 3,
                              .num_frames = 1,
                              .id = ritz_zalloc(3, 8),
                              .position = ritz_zalloc(9, 8),
                              .frame = ritz_zalloc(3, 8),
                              .axes = ritz_zalloc(9, 8)};
    out->elements = (ritz_elements){.count = 2,
                                    .kind = ritz_zalloc(2, 8),
                                    .first = ritz_zalloc(3, 8),
                                    .grid = ritz_zalloc(4, 8),
                                    .id = ritz_zalloc(2, 8)};
    for (int64_t k = 0; k < 3; k++) {
        out->dof[k] = (ritz_dof){k + 1, 1};
        out->grids.id[k] = k + 1;
        out->grids.position[3 * k] = (double)k;
        out->grids.axes[4 * k] = 1.0;
        out->elements.first[k] = 2 * k;
    }
    out->elements.kind[0] = out->elements.kind[1] = RITZ_CELL_LINE;
    out->elements.id[0] = 9;
    out->elements.id[1] = 7;
    memcpy(out->elements.grid, grid, sizeof grid);
    q = out->quantity = ritz_zalloc(1, sizeof *q);
    out->num_quantities = 1;
    snprintf(q->name, sizeof q->name, "stress");
    snprintf(q->kind, sizeof q->kind, "stress");
    q->count = 4;
    q->place = ritz_zalloc(4, 8);
    q->part = ritz_zalloc(4, sizeof *q->part);
    assert_ok(ritz_dense_new(4, 2, &q->ST));
    for (int64_t k = 0; k < 4; k++) {
        q->place[k] = k == 3 ? 8 : 7 + 2 * (k / 2);
        snprintf(q->part[k], RITZ_NAME_SIZE, k % 2 ? "sy" : "sx");
    }
}

static void cells_have_the_rows_of_their_elements(void **)
{
    RITZ_OWN(ritz_reduced) body = {0};
    RITZ_OWN(ritz_moving) m = {0};
    const double q[2] = {0.5, -3.0}, y[4] = {1.0, -4.0, 2.0, 9.0};

    make_body(&body);
    assert_ok(ritz_moving_new(&body, &m));
    assert_int_equal(m.num_lost, 1); /* element 8 */
    assert_int_equal(m.frame.num_fields, 3);
    assert_string_equal(m.frame.field[0], "stress");
    assert_string_equal(m.frame.field[1], "stress sx");
    assert_string_equal(m.frame.field[2], "stress sy");
    ritz_moving_to(&m, q);
    assert_near(m.frame.u.val[0], 0.5, 0.0);
    assert_near(m.frame.u.val[6], -6.0, 0.0);
    assert_true(isnan(m.frame.of_cell[0]));
    ritz_moving_paint(&m, 0, y);
    /* cell 0 is element 9, cell 1 element 7 */
    assert_near(m.frame.of_cell[0], 2.0, 0.0);
    assert_near(m.frame.of_cell[1], -4.0, 0.0);
    assert_near(m.frame.of_cell[3], 1.0, 0.0);
    assert_true(isnan(m.frame.of_cell[4]));
    assert_near(m.frame.of_cell[5], -4.0, 0.0);
    ritz_moving_to(&m, q);
    assert_true(isnan(m.frame.of_cell[1]));
}

static ritz_status write_series(const ritz_series_format *format,
                                const ritz_reduced *body, const char *path,
                                int frames)
{
    RITZ_OWN(ritz_moving) m = {0};
    RITZ_OWN(ritz_series) series = {0};
    const double y[4] = {1.0, -4.0, 2.0, 9.0};

    RITZ_CHECK(ritz_moving_new(body, &m));
    RITZ_CHECK(ritz_series_begin(format, path, &m, NULL, &series));
    for (int k = 0; k < frames; k++) {
        const double q[2] = {0.25 * k, 1.0};

        ritz_moving_to(&m, q);
        ritz_moving_paint(&m, 0, y);
        RITZ_CHECK(ritz_series_frame(&series, 0.125 * k, &m.frame));
    }
    return frames > 2 ? RITZ_ERR_FILE : ritz_series_finish(&series, path);
}

static void expect(const char *path, const char *words)
{
    RITZ_OWN_ARRAY char *text = NULL;

    assert_ok(ritz_text_read(path, &text));
    if (!strstr(text, words))
        fail_msg("'%s' lacks '%s':\n%s", path, words, text);
}

/* A series that is freed before it is finished leaves no file. */
static void collections_list_their_frames(void **)
{
    RITZ_OWN(ritz_reduced) body = {0};
    char folder[512], frame[600];
    const char *const path = folder_path("m.pvd");

    make_body(&body);
    assert_ok(write_series(&ritz_series_format_pvd, &body, path, 2));
    expect(path, "timestep=\"0.125\" part=\"0\" file=\"m.frames/000001.vtu\"");
    expect(path, "reduced component by Ritz");
    snprintf(folder, sizeof folder, "%s", folder_path("m.frames"));
    snprintf(frame, sizeof frame, "%s/000001.vtu", folder);
    expect(frame, "Name=\"stress sy\" NumberOfComponents=\"1\" "
                  "format=\"ascii\">\nnan\n-4\n");
    expect(frame, "Name=\"displacement\" NumberOfComponents=\"3\" "
                  "format=\"ascii\">\n0.25 0 0\n0 0 0\n2 0 0\n");
    expect(frame, "Name=\"element\"");
    assert_int_equal(remove(frame), 0);
    snprintf(frame, sizeof frame, "%s/000000.vtu", folder);
    assert_int_equal(remove(frame), 0);
    assert_int_equal(rmdir(folder), 0);
    assert_int_equal(remove(path), 0);
    assert_int_equal(write_series(&ritz_series_format_pvd, &body, path, 3),
                     RITZ_ERR_FILE);
    assert_int_equal(access(path, F_OK), -1);
    assert_int_equal(access(folder, F_OK), -1);
}

static void an_xdmf_has_a_grid_for_each_time(void **)
{
    RITZ_OWN(ritz_reduced) body = {0};
    const char *const path = folder_path("m.xdmf");
    const char *const heavy = folder_path("m.xdmf.h5");

    make_body(&body);
    assert_ok(write_series(&ritz_series_format_xdmf, &body, path, 2));
    expect(path, "<Time Value=\"0.125\"/>");
    expect(path, "m.xdmf.h5:/field_3_000001<");
    expect(path, "CollectionType=\"Temporal\"");
    assert_int_equal(remove(path), 0);
    assert_int_equal(remove(heavy), 0);
    assert_int_equal(write_series(&ritz_series_format_xdmf, &body, path, 3),
                     RITZ_ERR_FILE);
    assert_int_equal(access(heavy, F_OK), -1);
    assert_fails(write_series(&ritz_series_format_xdmf, &body,
                              folder_path("a:b.xdmf"), 1),
                 RITZ_ERR_ARGUMENT, "holds ':'");
}

static void a_place_that_cannot_be_written_is_refused(void **)
{
    RITZ_OWN(ritz_reduced) body = {0};

    make_body(&body);
    assert_fails(write_series(&ritz_series_format_pvd, &body,
                              folder_path("none/m.pvd"), 1),
                 RITZ_ERR_FILE, "cannot make the folder");
    ritz_dense_free(&body.T);
    assert_fails(
        write_series(&ritz_series_format_pvd, &body, folder_path("m.pvd"), 1),
        RITZ_ERR_ARGUMENT, "--without-basis");
}

static void maxima_are_a_table(void **)
{
    RITZ_OWN(ritz_reduced) body = {0};
    RITZ_OWN(ritz_recoverer) rules = {0};
    RITZ_OWN(ritz_recovered) peaks = {0};
    const double y[4] = {1.0, -4.0, 2.0, 0.1};
    const char *const path = folder_path("m.tsv");

    make_body(&body);
    assert_ok(ritz_recoverer_new(&body, NULL, false, &rules));
    assert_ok(ritz_recovered_new(&rules, &peaks));
    assert_ok(ritz_recovered_note(0, 0.25, y, &peaks));
    assert_ok(ritz_recovered_write(path, &peaks, &body, NULL));
    expect(path, "# reduced component by Ritz");
    expect(path, "\nstress\t7\tsy\t-4\t0.25\n");
    expect(path, "\t0.10000000000000001\t0.25\n");
}

/* Charts of motion read a collection back: frames have the numbers written. */
static void frames_are_read_back(void **)
{
    RITZ_OWN(ritz_reduced) body = {0};
    RITZ_OWN(ritz_shapes) frame = {0};
    RITZ_OWN_ARRAY char *text = NULL;
    char name[RITZ_COLLECTION_NAME], path[600];
    const char *const list = folder_path("r.pvd");
    const char *at = NULL;
    double seconds = 0.0;
    bool more = false;

    make_body(&body);
    assert_ok(write_series(&ritz_series_format_pvd, &body, list, 2));
    assert_ok(ritz_text_read(list, &text));
    assert_true(ritz_collection_recognise(text));
    at = text;
    assert_ok(ritz_collection_next(&at, &seconds, name, &more));
    assert_ok(ritz_collection_next(&at, &seconds, name, &more));
    assert_true(more);
    assert_near(seconds, 0.125, 0.0);
    assert_string_equal(name, "r.frames/000001.vtu");
    snprintf(path, sizeof path, "%s", folder_path(name));
    assert_ok(ritz_frame_read(path, &frame));
    assert_int_equal(frame.num_points, 3);
    assert_near(frame.position[6], 2.0, 0.0);
    assert_near(frame.u.val[6], 2.0, 0.0);
    assert_int_equal(frame.cells.count, 2);
    assert_int_equal(frame.cells.grid[3], 2);
    assert_string_equal(frame.field[0], "stress");
    assert_near(frame.of_cell[1], -4.0, 0.0);
    assert_ok(ritz_collection_next(&at, &seconds, name, &more));
    assert_false(more);
    for (int k = 0; k < 2; k++) {
        snprintf(name, sizeof name, "r.frames/%06d.vtu", k);
        assert_int_equal(remove(folder_path(name)), 0);
    }
    assert_int_equal(rmdir(folder_path("r.frames")), 0);
}

/* The names of a quantity and of a part may be long and differ at their ends;
   each has its field, which is read back. */
static void long_names_of_fields_are_kept(void **)
{
#define LONG "a quantity whose name has sixty letters, the last ones too: "
    RITZ_OWN(ritz_reduced) body = {0};
    RITZ_OWN(ritz_moving) m = {0};
    RITZ_OWN(ritz_shapes) frame = {0};

    make_body(&body);
    for (int64_t k = 0; k < 4; k++)
        snprintf(body.quantity[0].part[k], RITZ_NAME_SIZE, LONG "%s",
                 k % 2 ? "sy" : "sx");
    snprintf(body.quantity[0].name, RITZ_NAME_SIZE, LONG "s");
    assert_ok(ritz_moving_new(&body, &m));
    assert_int_equal(m.frame.num_fields, 3);
    assert_string_equal(m.frame.field[1], LONG "s " LONG "sx");
    assert_string_equal(m.frame.field[2], LONG "s " LONG "sy");
    assert_ok(
        write_series(&ritz_series_format_pvd, &body, folder_path("l.pvd"), 1));
    assert_ok(ritz_frame_read(folder_path("l.frames/000000.vtu"), &frame));
    assert_string_equal(frame.field[0], LONG "s");
    assert_near(frame.of_cell[1], -4.0, 0.0);
    assert_int_equal(remove(folder_path("l.frames/000000.vtu")), 0);
    assert_int_equal(rmdir(folder_path("l.frames")), 0);
}

static bool is_there(const char *name)
{
    return access(folder_path(name), F_OK) == 0;
}

/* Files of the folder that are no frames stay. */
static void frames_of_a_longer_series_are_removed(void **)
{
    RITZ_OWN(ritz_reduced) body = {0};
    const char *const path = folder_path("s.pvd");

    make_body(&body);
    assert_ok(write_series(&ritz_series_format_pvd, &body, path, 2));
    (void)folder_write("s.frames/000007.vtu", "after a gap");
    (void)folder_write("s.frames/1000000.vtu", "the next after 999999");
    (void)folder_write("s.frames/000001.png", "a picture");
    assert_ok(write_series(&ritz_series_format_pvd, &body, path, 1));
    assert_true(is_there("s.frames/000000.vtu"));
    assert_true(!is_there("s.frames/000001.vtu"));
    assert_true(!is_there("s.frames/000007.vtu"));
    assert_true(!is_there("s.frames/1000000.vtu"));
    assert_int_equal(remove(folder_path("s.frames/000001.png")), 0);
    assert_int_equal(remove(folder_path("s.frames/000000.vtu")), 0);
    assert_int_equal(rmdir(folder_path("s.frames")), 0);
}

static const char one[] =
    "<VTKFile type=\"UnstructuredGrid\">\n<Piece NumberOfPoints=\"2\" "
    "NumberOfCells=\"1\">\n<DataArray type=\"Float64\" "
    "Name=\"displacement\">\n0 0 1\n0 0 2\n</DataArray>\n<CellData>\n"
    "<DataArray Name=\"stress\">\nnan\n</DataArray>\n</CellData>\n"
    "<DataArray Name=\"Points\">\n0 0 0 1 0 0\n</DataArray>\n"
    "<DataArray Name=\"connectivity\">\n0 1\n</DataArray>\n"
    "<DataArray Name=\"offsets\">\n2\n</DataArray>\n"
    "<DataArray Name=\"types\">\n3\n</DataArray>\n</Piece>\n";

/* Replace one piece of the text. */
static void refuse_with(const char *piece, const char *by, const char *words)
{
    const char *at = strstr(one, piece);
    RITZ_OWN(ritz_shapes) frame = {0};
    char text[1024];

    assert_non_null(at);
    snprintf(text, sizeof text, "%.*s%s%s", (int)(at - one), one, by,
             at + strlen(piece));
    assert_fails(ritz_frame_parse(text, &frame), RITZ_ERR_FORMAT, words);
}

static void other_frames_are_refused(void **)
{
    RITZ_OWN(ritz_shapes) frame = {0};
    const char *list = "<DataSet timestep=\"1\" file=\"../x.vtu\"/>";
    const char *timeless = "<DataSet file=\"x.vtu\"/>";
    char name[RITZ_COLLECTION_NAME];
    double seconds = 0.0;
    bool more = false;

    assert_ok(ritz_frame_parse(one, &frame));
    assert_true(isnan(frame.of_cell[0]));
    refuse_with("<Piece ", "<Part ", "is no unstructured grid");
    refuse_with("\"2\"", "\"99999\"", "'NumberOfPoints' is no number");
    refuse_with("\"2\"", "\"0\"", "holds no points");
    refuse_with("0 0 2", "0 0", "'displacement' has not 6 numbers");
    refuse_with("0 0 2", "0 0 2 3", "'displacement' has more than 6 numbers");
    refuse_with("0 0 2", "0 0 inf", "'displacement' has not 6 numbers");
    refuse_with("\"Points\"", "\"Point\"", "there is no array 'Points'");
    refuse_with("\n0 1\n", "\n0 2\n",
                "'connectivity' has not 2 numbers up to 1");
    refuse_with("\n2\n</D", "\n1\n</D", "has not the points of its type");
    refuse_with("\n3\n</D", "\n5\n</D", "has not the points of its type");
    assert_fails(ritz_collection_next(&list, &seconds, name, &more),
                 RITZ_ERR_FORMAT, "without a file beside the list");
    assert_fails(ritz_collection_next(&timeless, &seconds, name, &more),
                 RITZ_ERR_FORMAT, "without a time");
}

static ritz_status parse_bytes(const char *bytes, int64_t size)
{
    RITZ_OWN_ARRAY char *text = NULL;
    RITZ_OWN(ritz_shapes) frame = {0};

    RITZ_CHECK_NEW(text, size + 1);
    memcpy(text, bytes, (size_t)size);
    return ritz_frame_parse(text, &frame);
}

static ritz_status parse_once(void)
{
    RITZ_OWN(ritz_shapes) frame = {0};

    return ritz_frame_parse(one, &frame);
}

static void damaged_frames_are_refused(void **)
{
    damage_cut(parse_bytes, one, (int64_t)strlen(one));
    damage_corrupt(parse_bytes, one, (int64_t)strlen(one));
    assert_survives_every_allocation(parse_once());
}

/* Frames of a collection are published as they are written, so that a failure
   has to remove them and their folder. */
static void all_allocations_may_fail(void **)
{
    RITZ_OWN(ritz_reduced) body = {0};
    char frame[600];
    const char *const path = folder_path("a.pvd");

    make_body(&body);
    assert_survives_every_allocation(
        write_series(&ritz_series_format_pvd, &body, path, 1));
    snprintf(frame, sizeof frame, "%s", folder_path("a.frames/000000.vtu"));
    assert_int_equal(remove(frame), 0);
    assert_int_equal(rmdir(folder_path("a.frames")), 0);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(cells_have_the_rows_of_their_elements),
    cmocka_unit_test(collections_list_their_frames),
    cmocka_unit_test(an_xdmf_has_a_grid_for_each_time),
    cmocka_unit_test(a_place_that_cannot_be_written_is_refused),
    cmocka_unit_test(maxima_are_a_table),
    cmocka_unit_test(frames_are_read_back),
    cmocka_unit_test(long_names_of_fields_are_kept),
    cmocka_unit_test(frames_of_a_longer_series_are_removed),
    cmocka_unit_test(other_frames_are_refused),
    cmocka_unit_test(damaged_frames_are_refused),
    cmocka_unit_test(all_allocations_may_fail),
};

TEST_MODULE(series, tests, folder_make, folder_remove)
