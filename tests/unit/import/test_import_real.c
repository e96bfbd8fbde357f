/* Importing decks and matrices that solvers wrote. */
#include "testing.h"

#include "folder.h"

#include <ritz/import.h>
#include <ritz/matrix.h>

#include <stdio.h>
#include <stdlib.h>

/* Path of a file in the folder that the variable names; NULL, with a message, if
   the variable is not set. */
static const char *external(const char *variable, const char *name)
{
    static char path[4][512];
    static int turn = 0;
    const char *where = getenv(variable);

    if (!where) {
        print_message("skipped: no %s\n", variable);
        return NULL;
    }
    turn = (turn + 1) % 4;
    snprintf(path[turn], sizeof path[turn], "%s/%s", where, name);
    return path[turn];
}

/* Files of a component, and the dofs and first frequency that it must have. */
typedef struct real {
    const char *variable, *stiffness, *mass, *bulk;
    int64_t dofs, removed;
    double hertz; /* first flexible frequency; 0: the body is rigid */
    double bound; /* half a unit of the last digit of hertz */
} real;

#define SOLVERS "nastran/public_solvers/"
#define CSUPER  "nastran/nas2cam_csuper/"
/* Frequencies of the spacecraft are from data/dualspin/SOURCE.md; those of
   inboard, mystran and csuper were computed with this program. */
static const real cases[] = {
    {"RITZ_DATA", "dualspin/rotor.op4:KGG", "dualspin/rotor.op4:MGG",
     "dualspin/rotor.bdf", 243, 3, 0.19878, 5e-6},
    {"RITZ_DATA", "dualspin/stator.op4:KGG", "dualspin/stator.op4:MGG",
     "dualspin/stator.bdf", 57, 3, 6.76982, 5e-6},
    {"RITZ_DATA", NULL, "dualspin/platform.op4:MGG", "dualspin/platform.bdf", 6,
     0, 0.0, 0.0},
    {"RITZ_EXTERNAL_DATA", SOLVERS "nastran95_inboard.op4:KGG",
     SOLVERS "nastran95_inboard.op4:MGG", SOLVERS "nastran95_inboard.deck", 156,
     0, 47.9210, 5e-5},
    {"RITZ_EXTERNAL_DATA", SOLVERS "mystran_outboard.op4:KGG",
     SOLVERS "mystran_outboard.op4:MGG", SOLVERS "mystran_outboard.dat", 156, 0,
     1.72508, 5e-6},
    {"RITZ_EXTERNAL_DATA", CSUPER "inboard.op4:KXX", CSUPER "inboard.op4:MXX",
     CSUPER "inboard.dat", 32, 0, 47.9267, 5e-5},
    /* oracles.md section 7 */
    {"RITZ_EXTERNAL_DATA", "nastran/pynastran/dmig.pch:KAAX",
     "nastran/pynastran/dmig.pch:MAAX", NULL, 15, 0, 1.033490, 5e-7},
};

/* The first flexible frequency; 0 if there is none. */
static double first_hertz(const ritz_component *c)
{
    const ritz_span span = {.modes = 1};
    ritz_pairs pairs = {0};
    double hertz = 0.0;

    if (c->K.colptr[c->num_dofs] == 0)
        return 0.0;
    assert_ok(ritz_eigen_sparse(&c->K, &c->M, &span, &pairs));
    hertz = ritz_eigen_hertz(pairs.lambda[pairs.num_rigid]);
    ritz_pairs_free(&pairs);
    return hertz;
}

static void check_real(const real *it)
{
    ritz_import_request request = {0};
    ritz_import_report report = {0};
    ritz_component c = {0};

    request.mass = external(it->variable, it->mass);
    if (!request.mass)
        return;
    if (it->stiffness)
        request.stiffness = external(it->variable, it->stiffness);
    if (it->bulk)
        request.bulk = external(it->variable, it->bulk);
    assert_ok(ritz_import(&request, &c, &report));
    assert_int_equal(c.num_dofs, it->dofs);
    assert_int_equal(report.num_removed, it->removed);
    assert_near(first_hertz(&c), it->hertz, it->bound);
    ritz_component_free(&c);
    ritz_import_report_free(&report);
}

static void real_files_become_components(void **)
{
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        check_real(&cases[k]);
}

/* Write a file of dof names from the node numbers of a map with three dofs for
   each node. */
static void convert_map(const char *path)
{
    char line[128];
    char text[8192] = "";
    size_t used = 0;
    bool sized = false;
    FILE *file = fopen(path, "r");

    assert_non_null(file);
    while (fgets(line, sizeof line, file)) {
        long node = strtol(line, NULL, 10);

        if (line[0] == '%')
            continue;
        for (int k = 1; sized && node > 0 && k <= 3; k++)
            used += (size_t)snprintf(text + used, sizeof text - used,
                                     "%ld %d\n", node, k);
        sized = true;
    }
    fclose(file);
    folder_write("dofs", text);
}

static void a_dof_map_names_the_rows_of_the_rotor(void **)
{
    const char *map =
        external("RITZ_EXTERNAL_DATA", "ansys/rotorAnsysMatrixDofMappingVector"
                                       ".txt");
    const char *const ports[] = {"axis=1-7:123"};
    /* oracles.md section 7 */
    const double hertz[] = {104.637011, 104.637011, 187.824087, 212.329701};
    const ritz_span span = {.modes = 4};
    ritz_import_request request = {.num_ports = 1, .port = ports};
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};

    if (!map)
        skip();
    convert_map(map);
    request.dofs = folder_path("dofs");
    request.stiffness = external("RITZ_EXTERNAL_DATA",
                                 "ansys/rotorAnsysStiffnessMatrixSparse.txt");
    request.mass =
        external("RITZ_EXTERNAL_DATA", "ansys/rotorAnsysMassMatrixSparse.txt");
    assert_ok(ritz_import(&request, &c, &report));
    assert_int_equal(c.num_dofs, 345);
    assert_int_equal(c.port[0].dofs.count, 21);
    assert_ok(ritz_eigen_sparse(&c.K, &c.M, &span, &pairs));
    assert_int_equal(pairs.num_rigid, 6);
    for (int k = 0; k < 4; k++)
        assert_near(ritz_eigen_hertz(pairs.lambda[6 + k]), hertz[k], 5e-7);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(real_files_become_components),
    cmocka_unit_test(a_dof_map_names_the_rows_of_the_rotor),
};

TEST_MODULE(import_real, tests, folder_make, folder_remove)
