/*
 * Shapes for viewers and the elements that carry them. What files of them hold
 * is read back by meshio in tests/tools/shapes.sh.
 */
#include "testing.h"

#include "bodies.h"
#include "folder.h"

#include <ritz/basis.h>
#include <ritz/export.h>
#include <ritz/import.h>

/* A free chain of three bodies, reduced to all of its modes. */
typedef struct fixture {
    ritz_component body;
    ritz_basis basis;
    ritz_reduced reduced;
} fixture;

static int set_up(void **state)
{
    static const double at[3][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}};
    static fixture f;
    ritz_request request = RITZ_REQUEST_NONE;

    f = (fixture){0};
    assert_ok(body_chain(3, at, 1, 4, &f.body));
    request.component = &f.body;
    assert_ok(ritz_basis_make(&ritz_method_full, &request, &f.basis));
    assert_ok(ritz_reduce(&f.body, &f.basis, &f.reduced));
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;

    ritz_component_free(&f->body);
    ritz_basis_free(&f->basis);
    ritz_reduced_free(&f->reduced);
    return 0;
}

static void a_list_chooses_modes_and_names_them(void **state)
{
    fixture *f = *state;
    ritz_shapes shapes = {0};

    assert_ok(ritz_shapes_of_reduced(&f->reduced, "1,7-8", &shapes));
    assert_int_equal(shapes.count, 3);
    assert_int_equal(shapes.num_points, 3);
    assert_string_equal(shapes.name[0], "mode 1, 0 Hz");
    assert_non_null(strstr(shapes.name[1], "mode 7, "));
    assert_false(shapes.meshed);
    assert_int_equal(shapes.cells.kind[2], RITZ_CELL_POINT);
    ritz_shapes_free(&shapes);
    assert_fails(ritz_shapes_of_reduced(&f->reduced, "19", &shapes),
                 RITZ_ERR_ARGUMENT, "there is no mode 19, there are 18");
    assert_fails(ritz_shapes_of_reduced(&f->reduced, "1,,2", &shapes),
                 RITZ_ERR_ARGUMENT, "'' is no part of a list of modes");
    assert_fails(ritz_shapes_of_reduced(&f->reduced, "3-2", &shapes),
                 RITZ_ERR_ARGUMENT, "'3-2' is no part of a list of modes");
}

/* The basis of all dofs is the identity, and the body has basic axes. */
static void columns_of_a_basis_are_where_their_dofs_are(void **state)
{
    fixture *f = *state;
    ritz_shapes shapes = {0};
    ritz_component other = {0};

    assert_ok(ritz_shapes_of_basis(&f->basis, &f->body, NULL, &shapes));
    assert_int_equal(shapes.count, 18);
    for (int64_t j = 0; j < 18; j++) {
        ritz_dof dof = f->body.dof[j];
        const ritz_dense *of = dof.component > 3 ? &shapes.turn : &shapes.u;
        int64_t row = 3 * (dof.grid - 1) + (dof.component - 1) % 3;

        assert_true(ritz_dense_col(of, j)[row] == 1.0);
    }
    ritz_shapes_free(&shapes);
    assert_fails(ritz_shapes_of_basis(&f->basis, &other, NULL, &shapes),
                 RITZ_ERR_ARGUMENT, "the basis is for 18 dofs");
}

static void what_has_no_place_is_refused(void **state)
{
    fixture *f = *state;
    ritz_reduced bare = f->reduced;
    ritz_shapes shapes = {0};

    bare.T = (ritz_dense){0};
    assert_fails(ritz_shapes_of_reduced(&bare, NULL, &shapes),
                 RITZ_ERR_ARGUMENT, "--without-basis");
    bare = f->reduced;
    bare.grids = (ritz_grids){0};
    assert_fails(ritz_shapes_of_reduced(&bare, NULL, &shapes),
                 RITZ_ERR_ARGUMENT, "no grid has a position");
}

static void elements_with_strange_grids_are_counted(void **state)
{
    static const char deck[] = "BEGIN BULK\n"
                               "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\n"
                               "CBAR,1,1,1,2,0.,0.,1.\n"
                               "CELAS2,2,1.,1,1\n"
                               "CBAR,3,1,1,two\n"
                               "CTRIA3,4,1,1,2\n"
                               "CHEXA,5,1,1,2,1,2,1,2\n,1,2,9\n"
                               "ENDDATA\n";
    RITZ_OWN(ritz_deck) bulk = {0};

    (void)state;
    assert_ok(
        ritz_deck_parse("a.bdf", deck, (int64_t)strlen(deck), ".", &bulk));
    assert_int_equal(bulk.elements.count, 2);
    assert_int_equal(bulk.elements.id[0], 1);
    assert_int_equal(bulk.elements.id[1], 5);
    /* one grid of a bar is a spring to the ground, of a triangle nothing */
    assert_int_equal(bulk.num_strange, 1);
    assert_int_equal(bulk.elements.kind[1], RITZ_CELL_HEXA);
    assert_int_equal(bulk.elements.first[2], 10);
    assert_int_equal(ritz_elements_keep(&bulk.elements, 1, (int64_t[]){1}), 2);
    assert_int_equal(bulk.elements.count, 0);
}

static void cells_that_do_not_fit_are_refused(void **state)
{
    int64_t kind[] = {RITZ_CELL_LINE}, first[] = {0, 2}, grid[] = {1, 3};
    const int64_t id[] = {1, 2, 3};
    ritz_elements cells = {1, kind, first, grid, NULL};

    (void)state;
    assert_ok(ritz_elements_check(&cells, 3, id));
    grid[1] = 4;
    assert_fails(ritz_elements_check(&cells, 3, id), RITZ_ERR_FORMAT,
                 "element 1 has a grid without a position");
    kind[0] = RITZ_CELL_TRIANGLE;
    assert_fails(ritz_elements_check(&cells, 3, id), RITZ_ERR_FORMAT,
                 "element 1 has 2 grids, its kind has 3");
    kind[0] = 7;
    assert_fails(ritz_elements_check(&cells, 3, id), RITZ_ERR_FORMAT,
                 "element 1 is of kind 7");
    first[0] = 1;
    assert_fails(ritz_elements_check(&cells, 3, id), RITZ_ERR_FORMAT,
                 "do not begin");
}

static ritz_status write_once(const fixture *f, const ritz_exporter *exporter,
                              const char *path)
{
    const ritz_export_request request = {.output = path};
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN(ritz_shapes) shapes = {0};

    RITZ_CHECK(ritz_shapes_of_reduced(&f->reduced, "7", &shapes));
    return exporter->write(&(ritz_export_object){.shapes = &shapes}, &request,
                           &report);
}

static void an_output_that_cannot_be_is_named(void **state)
{
    assert_fails(write_once(*state, &ritz_exporter_xdmf, "no/shapes.xdmf"),
                 RITZ_ERR_FILE, "h5: cannot create 'no/shapes");
}

static void no_allocation_failure_leaks(void **state)
{
    static const char deck[] = "BEGIN BULK\nGRID,1,,0.,0.,0.\n"
                               "GRID,2,,1.,0.,0.\nCBAR,1,1,1,2\nENDDATA\n";
    fixture *f = *state;
    void *none = NULL;
    ritz_deck bulk = {0};
    ritz_shapes shapes = {0};

    assert_survives_every_allocation(
        ritz_deck_parse("a.bdf", deck, (int64_t)strlen(deck), ".", &bulk));
    ritz_deck_free(&bulk);
    assert_survives_every_allocation(
        ritz_shapes_of_basis(&f->basis, &f->body, "1", &shapes));
    ritz_shapes_free(&shapes);
    assert_int_equal(folder_make(&none), 0);
    assert_survives_every_allocation(
        write_once(f, &ritz_exporter_vtu, folder_path("shapes.vtu")));
    assert_survives_every_allocation(
        write_once(f, &ritz_exporter_xdmf, folder_path("shapes.xdmf")));
    assert_int_equal(folder_remove(&none), 0);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_list_chooses_modes_and_names_them),
    cmocka_unit_test(columns_of_a_basis_are_where_their_dofs_are),
    cmocka_unit_test(what_has_no_place_is_refused),
    cmocka_unit_test(elements_with_strange_grids_are_counted),
    cmocka_unit_test(cells_that_do_not_fit_are_refused),
    cmocka_unit_test(an_output_that_cannot_be_is_named),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(shapes, tests, set_up, tear_down)
