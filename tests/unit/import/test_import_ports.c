/* Ports at grids that import creates: rigid and averaged ones. */
#include "testing.h"

#include "folder.h"
#include "frame.h"
#include "matrices.h"
#include "matrix_files.h"

#include <ritz/import.h>
#include <ritz/matrix.h>
#include <ritz/model.h>

#include <stdio.h>
#include <stdlib.h>

enum { CORNERS = 8, SOLID = 3 * CORNERS };

/* A cube of side 2 about (1, 1, 1): grids 1 to 4 below, 5 to 8 above; grid 6
 * has axes of its own. */
static const char CUBE[] = "CORD2R,4,,0.,0.,0.,0.3,0.1,1.0\n,1.0,0.4,0.\n"
                           "GRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\n"
                           "GRID,3,,2.,2.,0.\nGRID,4,,0.,2.,0.\n"
                           "GRID,5,,0.,0.,2.\nGRID,6,,2.,0.,2.,4\n"
                           "GRID,7,,2.,2.,2.\nGRID,8,,0.,2.,2.\n";

static const double corner[CORNERS][3] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0},
                                          {0, 2, 0}, {0, 0, 2}, {2, 0, 2},
                                          {2, 2, 2}, {0, 2, 2}};

/* Displacement axes of grid 6 as the deck defines them. */
static void find_axes(double A[9])
{
    RITZ_OWN(ritz_deck) bulk = {0};
    int64_t k = 0;

    assert_ok(ritz_deck_parse(NULL, CUBE, (int64_t)strlen(CUBE), NULL, &bulk));
    k = ritz_grids_find(&bulk.grids, 6);
    memcpy(A, bulk.grids.axes + 9 * bulk.grids.frame[k], 9 * sizeof *A);
}

/* Springs between all pairs of corners, a stiffness for each pair; masses 1 to
   8. */
static void fill_cube(ritz_dense *K, ritz_dense *M)
{
    double A[9];
    double turn[CORNERS][9] = {0};

    find_axes(A);
    for (int g = 0; g < CORNERS; g++)
        for (int i = 0; i < 9; i++)
            turn[g][i] = g == 5 ? A[i] : (double)(i % 4 == 0);
    assert_ok(ritz_dense_new(SOLID, SOLID, K));
    assert_ok(ritz_dense_new(SOLID, SOLID, M));
    for (int a = 0; a < CORNERS; a++)
        for (int b = 0; b < a; b++) {
            double e[SOLID] = {0};
            double d[3];
            double length = 0.0;

            for (int i = 0; i < 3; i++) {
                d[i] = corner[a][i] - corner[b][i];
                length += d[i] * d[i];
            }
            for (int i = 0; i < 3; i++)
                for (int j = 0; j < 3; j++) {
                    e[3 * a + i] += turn[a][3 * i + j] * d[j] / sqrt(length);
                    e[3 * b + i] -= turn[b][3 * i + j] * d[j] / sqrt(length);
                }
            for (int j = 0; j < SOLID; j++)
                for (int i = 0; i < SOLID; i++)
                    ritz_dense_col(K, j)[i] +=
                        (100.0 + 10.0 * a + b) * e[i] * e[j];
        }
    for (int g = 0; g < CORNERS; g++)
        for (int k = 3 * g; k < 3 * g + 3; k++)
            ritz_dense_col(M, k)[k] = 1.0 + g;
}

/* Import the cube; a file names its rows, which are translations only. */
static ritz_status import_cube(const char *deck_rest, const char *rigid,
                               const char *averaged, ritz_component *out,
                               ritz_import_report *report)
{
    char text[2000];
    int used = 0;
    ritz_dense K = {0}, M = {0};
    ritz_import_request request = {.num_rigid_ports = rigid != NULL,
                                   .rigid_port = &rigid,
                                   .num_averaged_ports = averaged != NULL,
                                   .averaged_port = &averaged};

    fill_cube(&K, &M);
    request.stiffness = put_matrix("k.mtx", &K);
    request.mass = put_matrix("m.mtx", &M);
    ritz_dense_free(&K);
    ritz_dense_free(&M);
    for (int k = 0; k < SOLID; k++)
        used += snprintf(text + used, sizeof text - (size_t)used, "%d %d\n",
                         k / 3 + 1, k % 3 + 1);
    request.dofs = folder_write("dofs", text);
    snprintf(text, sizeof text, "%s%s", CUBE, deck_rest);
    request.bulk = folder_write("deck.bdf", text);
    return ritz_import(&request, out, report);
}

static void assert_same_spectrum(const ritz_component *a,
                                 const ritz_component *b, double bound)
{
    ritz_dense K = {0}, M = {0};
    RITZ_OWN(ritz_pairs) one = {0}, two = {0};

    assert_ok(ritz_sparse_dense(&a->K, &K));
    assert_ok(ritz_sparse_dense(&a->M, &M));
    assert_ok(ritz_eigen_dense(&K, &M, &one));
    ritz_dense_free(&K);
    ritz_dense_free(&M);
    assert_ok(ritz_sparse_dense(&b->K, &K));
    assert_ok(ritz_sparse_dense(&b->M, &M));
    assert_ok(ritz_eigen_dense(&K, &M, &two));
    assert_int_equal(one.num_rigid, 6);
    assert_int_equal(two.num_rigid, 6);
    assert_int_equal(one.Phi.ncol, two.Phi.ncol);
    for (int64_t k = 6; k < one.Phi.ncol; k++)
        assert_near(one.lambda[k], two.lambda[k],
                    bound * one.lambda[one.Phi.ncol - 1]);
    ritz_dense_free(&K);
    ritz_dense_free(&M);
    ritz_pairs_free(&two);
}

/* Largest sum of magnitudes in a row of G, at least 1. */
static double row_sum(const ritz_sparse *G)
{
    double sum[SOLID] = {0};
    double largest = 1.0;

    for (int64_t p = 0; G->colptr && p < G->colptr[G->ncol]; p++)
        sum[G->rowind[p]] += fabs(G->val[p]);
    for (int64_t i = 0; i < G->nrow; i++)
        largest = fmax(largest, sum[i]);
    return largest;
}

/*
 * K R = 0 for the rigid motions R, and recovered dofs move as geometry says.
 *
 * Six dofs of an averaged port follow from A_p u_p = q - A_r u_r. QR of the 6 x
 * 6 matrix A_p has a backward error |dA_p| <= 6^2 eps |A_p| [Higham2002, sec.
 * 19.3], which changes u_p by A_p^-1 dA_p u_p. A is an average, of order 1, and
 * A_p^-1 is a part of G = A_p^-1 [I, -A_r]: the error is at most 36 eps |G|
 * |R|, with |G| the largest row sum. Pivoting decides which dofs depend on the
 * others, and rounding decides between equal pivots: |G| is 28 on one processor
 * and 58 on another.
 */
static void assert_rigid_motion(const ritz_component *c)
{
    const double origin[3] = {0.3, -0.2, 0.1};
    ritz_dense R = {0}, KR = {0}, all = {0}, geometry = {0};
    ritz_dof *names = NULL;
    ritz_component whole = *c;

    assert_ok(ritz_rigid_geometry(c, origin, &R));
    assert_ok(ritz_sparse_mul(&c->K, &R, &KR));
    assert_near(ritz_dense_max(&KR), 0.0,
                ritz_sparse_max(&c->K) * 64.0 * 0x1p-52);
    assert_ok(ritz_recovery_extend(&c->recovery, c->num_dofs, c->dof, &R,
                                   &names, &all));
    whole.dof = names;
    whole.num_dofs = all.nrow;
    assert_ok(ritz_rigid_geometry(&whole, origin, &geometry));
    for (int64_t k = 0; k < 6 * all.nrow; k++)
        assert_near(all.val[k], geometry.val[k],
                    36.0 * 0x1p-52 * row_sum(&c->recovery.G) *
                        ritz_dense_max(&geometry));
    ritz_dense_free(&R);
    ritz_dense_free(&KR);
    ritz_dense_free(&all);
    ritz_dense_free(&geometry);
    free(names);
}

static void a_rigid_port_is_an_rbe2_from_the_centre(void **)
{
    ritz_import_report report = {0};
    RITZ_OWN(ritz_component) port = {0}, element = {0};

    assert_ok(import_cube("", "top=5-8", NULL, &port, &report));
    assert_int_equal(report.num_grids, 1);
    assert_int_equal(report.grid[0].id, 9);
    assert_int_equal(report.grid[0].num_tied, 12);
    assert_int_equal(report.num_eliminated, 12);
    assert_int_equal(port.num_dofs, 18);
    assert_int_equal(port.num_ports, 1);
    assert_string_equal(port.port[0].name, "top");
    assert_int_equal(port.port[0].dofs.count, 6);
    assert_near(port.port[0].origin[2], 2.0, 0.0);
    assert_near(port.port[0].origin[0], 1.0, 0.0);
    assert_int_equal(port.dof[port.port[0].dofs.at[5]].grid, 9);
    assert_rigid_motion(&port);
    ritz_import_report_free(&report);
    assert_ok(import_cube("GRID,9,,1.,1.,2.\nRBE2,1,9,123,5,6,7,8\n", NULL,
                          NULL, &element, &report));
    assert_int_equal(element.num_dofs, 18);
    assert_near_sparse(&port.K, &element.K, 0.0);
    assert_near_sparse(&port.M, &element.M, 0.0);
    ritz_component_free(&element);
    ritz_import_report_free(&report);
}

/*
 * Six coordinates are new and six dofs depend on them: G in u = G q is square,
 * so that (G'KG, G'MG) has the spectrum of (K, M). Rounding grows by the
 * condition of G, about 10, and by that of the mass, 8.
 */
static void an_averaged_port_stiffens_nothing(void **)
{
    ritz_import_report report = {0};
    RITZ_OWN(ritz_component) port = {0}, plain = {0};

    assert_ok(import_cube("", NULL, "top=5-8:123", &port, &report));
    assert_int_equal(report.num_eliminated, 6);
    assert_int_equal(port.num_dofs, SOLID);
    assert_int_equal(port.recovery.count, 6);
    assert_rigid_motion(&port);
    ritz_import_report_free(&report);
    assert_ok(import_cube("", NULL, NULL, &plain, &report));
    assert_same_spectrum(&port, &plain, 1e-13);
    ritz_component_free(&plain);
    ritz_import_report_free(&report);
}

/* Coordinates q of the port are averages over the corners: the mean
 * displacement, and about z the mean rotation. A force on the port is thereby
 * spread over the corners. */
static void loads_on_an_averaged_port_are_spread(void **)
{
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};
    RITZ_OWN(ritz_dense) T = {0}, all = {0};
    ritz_dof *names = NULL;

    assert_ok(import_cube("", NULL, "foot=1-4", &c, &report));
    /* displacements of all corners for unit values of each coordinate */
    assert_ok(ritz_dense_new(c.num_dofs, c.num_dofs, &T));
    for (int64_t k = 0; k < c.num_dofs; k++)
        ritz_dense_col(&T, k)[k] = 1.0;
    assert_ok(
        ritz_recovery_extend(&c.recovery, c.num_dofs, c.dof, &T, &names, &all));
    for (int64_t j = 0; j < c.num_dofs; j++) {
        double mean[3] = {0.0, 0.0, 0.0};
        double swirl = 0.0;
        const double *u = ritz_dense_col(&all, j);

        for (int64_t i = 0; i < all.nrow; i++) {
            int64_t g = names[i].grid;

            if (g > 4)
                continue;
            mean[names[i].component - 1] += u[i] / 4.0;
            /* mean rotation: sum of d x u over sum of d^2; d^2 = 2 at each
               corner */
            if (names[i].component == 1)
                swirl -= (corner[g - 1][1] - 1.0) * u[i] / 8.0;
            if (names[i].component == 2)
                swirl += (corner[g - 1][0] - 1.0) * u[i] / 8.0;
        }
        for (int64_t i = 0; i < 3; i++)
            assert_near(mean[i],
                        (double)(j == row_of_dof(&c, (ritz_dof){9, i + 1})),
                        1e-14);
        assert_near(swirl, (double)(j == row_of_dof(&c, (ritz_dof){9, 6})),
                    1e-14);
    }
    free(names);
    ritz_dense_free(&all);
}

static void ports_that_leave_motion_open_are_refused(void **)
{
    static const struct {
        const char *rest, *grids, *words;
    } cases[] = {
        {"", "p=1", "p=1: its dofs leave 3 of six motions open"},
        {"", "p=1,7",
         "its dofs leave 1 of six motions open (do its grids lie on a line?)"},
        {"", "p=1-4:3", "its dofs leave 3 of six motions open"},
        {"", "p=1-8:4", "there is no 'grid 1 R1' among the dofs"},
        {"", "p=20", "there is no grid or point '20', the nearest is 8"},
        {"", "p=1,1", "'1' is listed twice"},
        {"", "p", "'p' is not of the form NAME=GRIDS[:COMPS]"},
    };
    ritz_import_report report = {0};
    ritz_component c = {0};

    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        assert_fails(
            import_cube(cases[k].rest, cases[k].grids, NULL, &c, &report),
            RITZ_ERR_ARGUMENT, cases[k].words);
        assert_fails(
            import_cube(cases[k].rest, NULL, cases[k].grids, &c, &report),
            RITZ_ERR_ARGUMENT, cases[k].words);
    }
    assert_fails(import_cube("SPC1,1,2,5\n", "p=5-8", NULL, &c, &report),
                 RITZ_ERR_FORMAT,
                 "'grid 5 T2' depends on rigid port p and is fixed by the "
                 "deck");
    assert_fails(import_cube("GRID,9,,1.,1.,2.\nRBE2,1,9,123,5,6,7,8\n",
                             "p=7,8,3,4", NULL, &c, &report),
                 RITZ_ERR_FORMAT, "and on rigid port p");
    assert_fails(import_cube("", "p=1-4", "p=5-8", &c, &report),
                 RITZ_ERR_ARGUMENT, "there are two ports 'p'");
    /* three of the four corners are fixed */
    assert_fails(import_cube("SPC1,1,123,1,2,3\n", NULL, "p=1-4", &c, &report),
                 RITZ_ERR_ARGUMENT, "its dofs leave 3 of six motions open");
}

static void positions_come_from_a_deck(void **)
{
    const double m[6] = {1, 1, 1, 1, 1, 1};
    const char *port = "p=1";
    const ritz_import_request request = {.mass = put_diagonal("m.mtx", 6, m),
                                         .num_rigid_ports = 1,
                                         .rigid_port = &port};
    ritz_import_report report = {0};
    ritz_component c = {0};

    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_ARGUMENT,
                 "positions of its grids are known from a deck alone: --bulk");
}

/* One grid with six dofs is a rigid body: a port at this grid renames its
   dofs. */
static void one_grid_of_six_dofs_is_enough(void **)
{
    const double m[6] = {2, 2, 2, 3, 4, 5};
    const char *port = "p=7";
    ritz_import_request request = {
        .mass = put_diagonal("m.mtx", 6, m),
        .bulk = folder_write("deck.bdf", "GRID,7,,1.,0.,0.\n"),
        .num_rigid_ports = 1,
        .rigid_port = &port};
    ritz_import_report report = {0};
    ritz_component c = {0};

    for (int k = 0; k < 2; k++) {
        assert_ok(ritz_import(&request, &c, &report));
        assert_int_equal(c.num_dofs, 6);
        assert_int_equal(c.dof[0].grid, 8);
        for (int64_t i = 0; i < 6; i++)
            assert_near(entry(&c.M, i, i), m[i], 8.0 * 0x1p-52);
        assert_near(entry(&c.M, 0, 4), 0.0, 8.0 * 0x1p-52);
        ritz_component_free(&c);
        ritz_import_report_free(&report);
        request.num_rigid_ports = 0;
        request.num_averaged_ports = 1;
        request.averaged_port = &port;
    }
}

/* An average over grids of an RBE2 is the motion of the RBE2's leading grid,
 * which then depends on the port. An average that includes the other grids
 * keeps the spectrum too. */
static void averages_follow_the_rigid_elements_of_the_deck(void **)
{
    static const char REST[] = "GRID,9,,1.,1.,2.\nRBE2,1,9,123,5,6,7,8\n";
    ritz_import_report report = {0};
    ritz_component tied = {0}, plain = {0};

    assert_ok(import_cube(REST, NULL, "top=5-8", &tied, &report));
    assert_int_equal(tied.num_dofs, 18);
    assert_int_equal(tied.dof[17].grid, 10);
    assert_rigid_motion(&tied);
    ritz_import_report_free(&report);
    assert_ok(import_cube(REST, NULL, NULL, &plain, &report));
    assert_same_spectrum(&tied, &plain, 1e-13);
    ritz_component_free(&tied);
    ritz_import_report_free(&report);
    assert_ok(import_cube(REST, NULL, "mixed=1-8", &tied, &report));
    assert_rigid_motion(&tied);
    assert_same_spectrum(&tied, &plain, 1e-13);
    ritz_component_free(&tied);
    ritz_component_free(&plain);
    ritz_import_report_free(&report);
}

/* Two averaged ports have 12 coordinates, which replace dofs of corners; the
 * dofs of a port at corners 1 and 4 are not replaced. */
static void averaged_ports_may_share_grids(void **)
{
    static const char *const ports[] = {"a=1-6", "b=3-8", "c=1-8"};
    static const char *const corner_port = "corners=1,4";
    ritz_import_report report = {0};
    ritz_component c = {0}, plain = {0};
    ritz_import_request request = {.num_averaged_ports = 3,
                                   .averaged_port = ports};

    assert_ok(import_cube("", NULL, NULL, &plain, &report));
    ritz_import_report_free(&report);
    request.stiffness = folder_path("k.mtx");
    request.mass = folder_path("m.mtx");
    request.dofs = folder_path("dofs");
    request.bulk = folder_path("deck.bdf");
    /* two of the six means over all corners follow from those of the other two
     * ports; the singular values of the 18 x 24 matrix of the three ports show
     * this too */
    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_ARGUMENT,
                 "c=1-8: six of its dofs are to depend on it, and without "
                 "those that other ports hold 2 motions are left open: name "
                 "more of them");
    request.num_averaged_ports = 2;
    assert_ok(ritz_import(&request, &c, &report));
    assert_int_equal(c.num_dofs, SOLID);
    assert_int_equal(c.recovery.count, 12);
    assert_int_equal(report.grid[1].id, 10);
    assert_rigid_motion(&c);
    assert_same_spectrum(&c, &plain, 1e-12);
    ritz_component_free(&c);
    ritz_import_report_free(&report);
    request.num_averaged_ports = 1;
    request.num_ports = 1;
    request.port = &corner_port;
    assert_ok(ritz_import(&request, &c, &report));
    assert_int_equal(c.port[0].dofs.count, 6);
    assert_same_spectrum(&c, &plain, 1e-12);
    ritz_component_free(&c);
    ritz_component_free(&plain);
    ritz_import_report_free(&report);
}

/* ---- memory ------------------------------------------------------------ */

static const ritz_import_request *everything;

static ritz_status import_everything(void)
{
    ritz_import_report report = {0};
    ritz_component c = {0};
    ritz_status status = ritz_import(everything, &c, &report);

    ritz_component_free(&c);
    ritz_import_report_free(&report);
    return status;
}

static void importing_survives_every_allocation(void **)
{
    static const char *const rigid = "low=1-3";
    static const char *const averaged = "top=5-8";
    static const char *const output = "tip=7:3";
    const ritz_import_request request = {.stiffness = folder_path("k.mtx"),
                                         .mass = folder_path("m.mtx"),
                                         .dofs = folder_path("dofs"),
                                         .bulk = folder_path("deck.bdf"),
                                         .num_rigid_ports = 1,
                                         .rigid_port = &rigid,
                                         .num_averaged_ports = 1,
                                         .averaged_port = &averaged,
                                         .num_outputs = 1,
                                         .output = &output};
    ritz_import_report report = {0};
    ritz_component c = {0};

    assert_ok(import_cube("MPC,1,5,1,1.0,5,2,-0.5\n,,6,1,0.5\n", NULL, NULL, &c,
                          &report));
    ritz_component_free(&c);
    ritz_import_report_free(&report);
    everything = &request;
    assert_survives_every_allocation(import_everything());
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_rigid_port_is_an_rbe2_from_the_centre),
    cmocka_unit_test(an_averaged_port_stiffens_nothing),
    cmocka_unit_test(loads_on_an_averaged_port_are_spread),
    cmocka_unit_test(ports_that_leave_motion_open_are_refused),
    cmocka_unit_test(positions_come_from_a_deck),
    cmocka_unit_test(one_grid_of_six_dofs_is_enough),
    cmocka_unit_test(averages_follow_the_rigid_elements_of_the_deck),
    cmocka_unit_test(averaged_ports_may_share_grids),
    cmocka_unit_test(importing_survives_every_allocation),
};

TEST_MODULE(import_ports, tests, folder_make, folder_remove)
