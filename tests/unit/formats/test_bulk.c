/* Bulk data: positions and axes by hand, sets, includes, refusals. */
#include "testing.h"

#include "damage.h"
#include "folder.h"
#include "formats/cards.h"
#include "solvers.h"

#include <ritz/import.h>

#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static ritz_status parse(const char *text, ritz_deck *out)
{
    return ritz_deck_parse("t.dat", text, (int64_t)strlen(text), ".", out);
}

static void assert_vector(const double *actual, double x, double y, double z,
                          double bound)
{
    assert_near(actual[0], x, bound);
    assert_near(actual[1], y, bound);
    assert_near(actual[2], z, bound);
}

/* Axis i of the k-th grid. */
static const double *axis(const ritz_deck *bulk, int64_t k, int i)
{
    return bulk->grids.axes + 9 * bulk->grids.frame[k] + 3 * (int64_t)i;
}

static void a_chain_of_frames_gives_positions_by_hand(void **state)
{
    static const char TEXT[] =
        /* spherical, at (10, 20, 30), z along x, x along y; so y is z */
        "CORD2S,2,0,10.,20.,30.,11.,20.,30.\n,10.,21.,30.\n"
        /* cylindrical in 2: origin at r 5, theta 90, phi 30 */
        "CORD2C,3,2,5.,90.,30.,5.,0.,0.\n,5.,90.,120.\n"
        "GRID,7,3,2.,60.,4.\n"
        "GRID,1,2,2.,90.,0.\n"
        "GRID,5,2,2.,60.,90.\n";
    RITZ_OWN(ritz_deck) bulk = {0};
    double s = sqrt(3.0);
    double o[3]; /* of frame 3, in the rectangular axes of 2 */
    double e_z[3];
    double e_x[3];
    double e_y[3];
    double p[3];

    (void)state;
    assert_ok(parse(TEXT, &bulk));
    assert_int_equal(bulk.grids.count, 3);
    assert_int_equal(bulk.grids.id[0], 1);
    assert_int_equal(bulk.grids.id[2], 7);
    /* Rounding: up to ten operations on numbers up to 30. */
    assert_vector(&bulk.grids.position[0], 10.0, 22.0, 30.0, 3e-14);
    assert_vector(&bulk.grids.position[3], 11.0, 20.0, 30.0 + s, 3e-14);
    /* A = 5 (cos 30, sin 30, 0), B = 5 e_z, C = 5 (-sin 30, cos 30, 0) */
    o[0] = 5.0 * s / 2.0;
    o[1] = 2.5;
    o[2] = 0.0;
    for (int k = 0; k < 3; k++)
        e_z[k] = ((k == 2 ? 5.0 : 0.0) - o[k]) / sqrt(50.0);
    e_x[0] = -2.5 - o[0]; /* C - A, then without its part along e_z */
    e_x[1] = 2.5 * s - o[1];
    e_x[2] = 0.0;
    {
        double along = e_x[0] * e_z[0] + e_x[1] * e_z[1] + e_x[2] * e_z[2];
        double norm = 0.0;

        for (int k = 0; k < 3; k++)
            e_x[k] -= along * e_z[k];
        norm = sqrt(e_x[0] * e_x[0] + e_x[1] * e_x[1] + e_x[2] * e_x[2]);
        for (int k = 0; k < 3; k++)
            e_x[k] /= norm;
    }
    e_y[0] = e_z[1] * e_x[2] - e_z[2] * e_x[1];
    e_y[1] = e_z[2] * e_x[0] - e_z[0] * e_x[2];
    e_y[2] = e_z[0] * e_x[1] - e_z[1] * e_x[0];
    for (int k = 0; k < 3; k++) /* r 2, theta 60, z 4 */
        p[k] = o[k] + 1.0 * e_x[k] + s * e_y[k] + 4.0 * e_z[k];
    assert_vector(&bulk.grids.position[6], 10.0 + p[2], 20.0 + p[0],
                  30.0 + p[1], 3e-14);
}

static void frames_by_grids_are_resolved_in_any_order(void **state)
{
    static const char TEXT[] =
        "GRID,9,5,1.,2.,3.\n"
        "CORD1R,5,2,3,4,6,2,3,4\n" /* two on a card */
        "CORD2R,7,0,1.,0.,0.,1.,0.,1.\n,1.,1.,0.\n"
        "GRID,2,7\nGRID,3,7,1.\nGRID,4,,1.,1.,1.\nGRID,10,6,1.\n";
    RITZ_OWN(ritz_deck) bulk = {0};

    (void)state;
    assert_ok(parse(TEXT, &bulk));
    /* 7: origin (1,0,0), x along y, y along -x; 5: the same origin, z along
     * grid 3 - grid 2 = y, x along (1,1,1) - (1,0,0) less its y = z, y = x */
    assert_vector(&bulk.grids.position[9], 3.0, 3.0, 1.0, 1e-14);
    assert_vector(&bulk.grids.position[12], 1.0, 0.0, 1.0, 1e-14);
}

static void curved_displacement_axes_follow_the_grid(void **state)
{
    static const char TEXT[] =
        "CORD2C,1,0,0.,0.,5.,0.,0.,6.\n,1.,0.,5.\n"
        "CORD2S,2,0,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n"
        "CORD2R,3,0,0.,0.,0.,1.,0.,0.\n,0.,1.,0.\n"
        "CORD2R,4,0,9.,9.,9.,9.,9.,10.\n,10.,9.,9.\n"
        "GRID,1,1,2.,30.,0.,1\n" /* radial at 30 degrees */
        "GRID,2,1,0.,77.,1.,1\n" /* on the axis */
        "GRID,3,2,2.,60.,90.,2\n"
        "GRID,4,2,2.,0.,0.,2\n" /* on the polar axis */
        "GRID,5,,,,,3\nGRID,6,,1.,,,3\n"
        "GRID,7,,1.,,,4\nGRID,8,,1.,,,0\n"; /* 4 has the basic axes */
    RITZ_OWN(ritz_deck) bulk = {0};
    double c = sqrt(3.0) / 2.0;

    (void)state;
    assert_ok(parse(TEXT, &bulk));
    /* entries of rotations: a few roundings of numbers up to 1 */
    assert_vector(axis(&bulk, 0, 0), c, 0.5, 0.0, 1e-15);
    assert_vector(axis(&bulk, 0, 1), -0.5, c, 0.0, 1e-15);
    assert_vector(axis(&bulk, 0, 2), 0.0, 0.0, 1.0, 1e-15);
    assert_int_equal(bulk.grids.frame[1], 0); /* the frame's own x, y, z */
    assert_vector(axis(&bulk, 2, 0), 0.0, c, 0.5, 1e-15);
    assert_vector(axis(&bulk, 2, 1), 0.0, 0.5, -c, 1e-15);
    assert_vector(axis(&bulk, 2, 2), -1.0, 0.0, 0.0, 1e-15);
    assert_int_equal(bulk.grids.frame[3], 0);
    assert_int_equal(bulk.grids.frame[4], bulk.grids.frame[5]);
    assert_vector(axis(&bulk, 4, 0), 0.0, 1.0, 0.0, 0.0);
    assert_vector(axis(&bulk, 4, 1), 0.0, 0.0, 1.0, 0.0);
    assert_vector(axis(&bulk, 4, 2), 1.0, 0.0, 0.0, 0.0);
    assert_int_equal(bulk.grids.frame[6], 0);
    assert_int_equal(bulk.grids.frame[7], 0);
    assert_int_equal(bulk.grids.num_frames, 4);
}

/* Dofs as "5.1 5.2 9.0". */
static void assert_dofs(int64_t count, const ritz_dof *dof,
                        const char *expected)
{
    char text[400] = "";
    size_t used = 0;

    for (int64_t k = 0; k < count; k++)
        used += (size_t)snprintf(text + used, sizeof text - used, "%s%d.%d",
                                 k > 0 ? " " : "", (int)dof[k].grid,
                                 (int)dof[k].component);
    assert_string_equal(text, expected);
}

static void sets_list_each_dof_once(void **state)
{
    static const char TEXT[] =
        "GRDSET,,,,,,,6\n"
        "GRID,1\nGRID,2,,,,,,0\nGRID,4,,,,,,13\nGRID,1\n"
        "SPOINT,11,THRU,13\nSPOINT,12,20\n"
        "ASET1,12,1,thru,3\nASET1,2,2,4\nASET1,,11,THRU,99\n"
        "ASET,4,3,20,0\nASET1,5,1,THRU,2\nASET1,5,2,THRU,4\n"
        "BSET1,4,ALL\nBNDFIX,1,5\n"
        "QSET1,0,ALL\nQSET,12,1\n"
        "SPC1,5,2,2\nSPC,5,4,6,0.1,11,0\n";
    RITZ_OWN(ritz_deck) bulk = {0};

    (void)state;
    assert_ok(parse(TEXT, &bulk));
    assert_int_equal(bulk.grids.count, 3);
    assert_int_equal(bulk.num_points, 4);
    assert_int_equal(bulk.point[3], 20);
    assert_dofs(bulk.num_sets[RITZ_SET_A], bulk.set[RITZ_SET_A],
                "1.1 1.2 1.5 2.1 2.2 2.5 4.2 4.3 4.5 11.0 12.0 13.0 20.0");
    assert_dofs(bulk.num_sets[RITZ_SET_B], bulk.set[RITZ_SET_B],
                "1.4 1.5 2.4 4.4");
    assert_dofs(bulk.num_sets[RITZ_SET_Q], bulk.set[RITZ_SET_Q],
                "11.0 12.0 13.0 20.0");
    assert_dofs(bulk.num_fixed, bulk.fixed, "1.6 2.2 4.1 4.3 4.6 11.0");
}

static void sets_without_grids_stand_for_all_they_name(void **state)
{
    RITZ_OWN(ritz_deck) bulk = {0};

    (void)state;
    assert_ok(parse("ASET1,3,5,THRU,7\n", &bulk));
    assert_dofs(bulk.num_sets[RITZ_SET_A], bulk.set[RITZ_SET_A], "5.3 6.3 7.3");
}

static void the_case_control_chooses_what_acts(void **state)
{
    static const char TEXT[] = "CEND\nSPC = 9\nMPC = 8\nBEGIN BULK\n"
                               "SPCADD,9,1,2\nMPCADD,8,4\n"
                               "SPC1,1,1,5\nSPC1,2,2,5\nSPC1,3,3,5\n"
                               "MPC,4,5,1,1.\nMPC,6,5,2,1.\n"
                               "RBE2,77,1,1,2\nCONM2,1,1,,2.\n";
    ritz_deck bulk = {0};

    (void)state;
    assert_ok(parse(TEXT, &bulk));
    assert_dofs(bulk.num_fixed, bulk.fixed, "5.1 5.2");
    assert_int_equal(bulk.num_constraints, 2);
    assert_string_equal(bulk.constraint[0], "MPC 4");
    assert_string_equal(bulk.constraint[1], "RBE2 77");
    ritz_deck_free(&bulk);
    assert_ok(parse(strstr(TEXT, "SPCADD"), &bulk));
    assert_dofs(bulk.num_fixed, bulk.fixed, "5.1 5.2 5.3");
    assert_int_equal(bulk.num_constraints, 3);
    ritz_deck_free(&bulk);
}

static void what_a_deck_cannot_mean_is_refused(void **state)
{
    static const struct {
        const char *text, *words;
    } CASES[] = {
        {"GRID,x\n", "'t.dat', line 1: 'x' in GRID is not a positive"},
        {"\nGRID,1,,1.2.3\n", "line 2: '1.2.3' in GRID is not a number"},
        {"GRID\n", "a field of GRID is blank where a positive"},
        {"GRID,1,,1.\nGRID,1,,2.\n", "line 2: GRID 1 is defined otherwise"},
        {"GRID,1,4\n", "GRID 1 uses coordinate system 4, which there is not"},
        {"GRID,1,,,,,4\n", "GRID 1 uses coordinate system 4"},
        {"GRID,1,,,,,-1\n", "in which a structure moves"},
        {"GRID,1,,,,,,117\n", "'117' in GRID is not a list of directions"},
        {"GRID,1,,1e308,,\nCORD2R,1,0,1e308,,,1e308,,1.\n,-1e308,,\n",
         "lie on a line"},
        {"CORD2R,1,0,,,,,,1.\n,,,5.\n", "the three points of coordinate "
                                        "system 1 lie on a line"},
        {"CORD2R,1,2,,,,,,1.\n,1.\nCORD2C,2,1,,,,,,1.\n,1.\n",
         "coordinate system 2 rests on itself by way of 1"},
        {"CORD1R,1,1,2,3\nGRID,1,1\nGRID,2\nGRID,3\n", "rests on itself"},
        {"CORD1R,1,1,2,3\nGRID,1\nGRID,2,,1.\n", "line 1: coordinate system 1 "
                                                 "is defined by grid 3"},
        {"CORD2R,1,5,,,,,,1.\n,1.\n", "coordinate system 1 rests on 5"},
        {"CORD2R,1,0,,,,,,1.\n,1.\nCORD2C,1,0,,,,,,1.\n,1.\n",
         "line 3: coordinate system 1 is defined otherwise"},
        {"GRID,1\nSPOINT,1\n", "line 2: 1 is a GRID and an SPOINT"},
        {"SPOINT,1,THRU,100000000\n", "THRU stands for more than 10000000"},
        {"SPOINT,9223372036854775807\n", "is not an id of at most 15"},
        {"SPOINT,9,THRU,1\n", "'1' in SPOINT is not at or above"},
        {"ASET1,1,1,THRU\n", "a field of ASET1 is blank"},
        {"GRID,1\nASET1,,1\n", "no directions of GRID 1 are given"},
        {"SPOINT,1\nASET1,123,1\n", "scalar point 1 has no directions"},
        {"GRDSET,,,,,,3\nGRDSET,,,,,,4\n", "another GRDSET"},
        {"INCLUDE 'no_such_file.blk'\n", "'t.dat', line 1: cannot open"},
        {"INCLUDE\n", "INCLUDE names no file"},
        {"INCLUDE 'abc\n", "line 1: the quote of INCLUDE is not closed"},
    };
    ritz_deck bulk = {0};

    (void)state;
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        bool missing = strstr(CASES[k].text, "no_such_file") != NULL;

        assert_fails(parse(CASES[k].text, &bulk),
                     missing ? RITZ_ERR_FILE : RITZ_ERR_FORMAT, CASES[k].words);
        assert_null(bulk.grids.id);
    }
}

/* ---- files ------------------------------------------------------------- */

static void includes_are_relative_to_the_file_that_names_them(void **state)
{
    const char *inner = folder_path("in");
    ritz_deck bulk = {0};

    (void)state;
    assert_int_equal(mkdir(inner, 0700), 0);
    folder_write("top.dat", "CEND\nBEGIN BULK\ninclude 'part one.blk' $ x\n"
                            "INCLUDE 'in/\n   b.blk'\nGRID,1\nENDDATA\n");
    folder_write("part one.blk", "GRID,2\n");
    folder_write("in/b.blk", "GRID,3\nINCLUDE c.blk $ beside this\n");
    folder_write("in/c.blk", "GRID,4\n");
    folder_write("loop.dat", "INCLUDE 'loop.dat'\n");
    folder_write("bad.dat", "\nINCLUDE 'part one.blk'\nGRID,2,,5.\n");
    assert_ok(ritz_deck_read(folder_path("top.dat"), &bulk));
    assert_int_equal(bulk.grids.count, 4);
    ritz_deck_free(&bulk);
    assert_fails(ritz_deck_read(folder_path("loop.dat"), &bulk),
                 RITZ_ERR_FORMAT, "includes itself");
    assert_fails(ritz_deck_read(folder_path("bad.dat"), &bulk), RITZ_ERR_FORMAT,
                 "bad.dat', line 3: GRID 2 is defined otherwise");
    assert_int_equal(remove(folder_path("in/b.blk")), 0);
    assert_int_equal(remove(folder_path("in/c.blk")), 0);
    assert_int_equal(rmdir(inner), 0);
}

static void includes_are_followed_sixteen_deep(void **state)
{
    enum { FILES = 18 }; /* d0 includes d1, and so on */
    ritz_deck bulk = {0};

    (void)state;
    for (int k = 0; k < FILES; k++) {
        char name[16];
        char text[64];

        snprintf(name, sizeof name, "d%d", k);
        snprintf(text, sizeof text,
                 k + 1 < FILES ? "GRID,%d\nINCLUDE 'd%d'\n" : "GRID,%d\n",
                 k + 1, k + 1);
        folder_write(name, text);
    }
    assert_ok(ritz_deck_read(folder_path("d1"), &bulk)); /* d2 to d17 in it */
    assert_int_equal(bulk.grids.count, 17);
    ritz_deck_free(&bulk);
    assert_fails(ritz_deck_read(folder_path("d0"), &bulk), RITZ_ERR_FORMAT,
                 "d16', line 2: INCLUDE is more than 16 files deep");
}

/* Devices, folders and pipes may never end or have no writer, and are not
   read. */
static void includes_are_regular_files(void **state)
{
    static const char *const names[] = {"/dev/null", ".", "p.blk"};
    ritz_deck bulk = {0};

    (void)state;
    assert_int_equal(mkfifo(folder_path("p.blk"), 0600), 0);
    for (int k = 0; k < 3; k++) {
        char text[64];

        snprintf(text, sizeof text, "GRID,1\nINCLUDE '%s'\n", names[k]);
        folder_write("top.dat", text);
        assert_fails(ritz_deck_read(folder_path("top.dat"), &bulk),
                     RITZ_ERR_FILE, "is not a regular file");
        assert_non_null(strstr(ritz_error_message(), "top.dat', line 2: "));
    }
    assert_int_equal(remove(folder_path("p.blk")), 0);
}

/* The limit holds under different names of the file, so that a deck cannot grow
   without bound. */
static void a_file_is_included_sixteen_times(void **state)
{
    char text[512] = "";
    size_t used = 0;
    ritz_deck bulk = {0};

    (void)state;
    folder_write("one.blk", "GRID,2\n");
    for (int k = 0; k < RITZ_DECK_REPEATED; k++)
        used += (size_t)snprintf(text + used, sizeof text - used,
                                 "INCLUDE '%sone.blk'\n", k % 2 ? "./" : "");
    folder_write("top.dat", text);
    assert_ok(ritz_deck_read(folder_path("top.dat"), &bulk));
    assert_int_equal(bulk.grids.count, 1);
    ritz_deck_free(&bulk);
    snprintf(text + used, sizeof text - used, "INCLUDE 'one.blk'\n");
    folder_write("top.dat", text);
    assert_fails(ritz_deck_read(folder_path("top.dat"), &bulk), RITZ_ERR_FORMAT,
                 "one.blk' is included more than 16 times");
    folder_write("loop.dat", "INCLUDE './loop.dat'\n");
    assert_fails(ritz_deck_read(folder_path("loop.dat"), &bulk),
                 RITZ_ERR_FORMAT, "loop.dat', line 1: ");
    assert_non_null(strstr(ritz_error_message(), "/./loop.dat' includes"));
}

/* A refusal does not show the author of a deck what files elsewhere contain. */
static void files_outside_the_decks_folder_are_not_quoted(void **state)
{
    static const struct {
        const char *text, *words;
    } CASES[] = {
        {"GRID,pass'word',1\n", "key', line 1: '...' in GRID is not"},
        {"+secret of mine\n", "key', line 1: the continuation '...' belongs"},
        {"GRID,12345678901234567890123456789012345678\n",
         "key', line 1: '...' in GRID is too long"},
    };
    const char *inner = folder_path("in");
    ritz_deck bulk = {0};

    (void)state;
    assert_int_equal(mkdir(inner, 0700), 0);
    folder_write("in/top.dat", "INCLUDE '../key'\n");
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        folder_write("key", CASES[k].text);
        assert_fails(ritz_deck_read(folder_path("in/top.dat"), &bulk),
                     RITZ_ERR_FORMAT, CASES[k].words);
    }
    folder_write("top.dat", "INCLUDE key\n"); /* in the deck's own folder */
    assert_fails(ritz_deck_read(folder_path("top.dat"), &bulk), RITZ_ERR_FORMAT,
                 "'1234567890123456...' in GRID");
    assert_int_equal(remove(folder_path("in/top.dat")), 0);
    assert_int_equal(rmdir(inner), 0);
}

static void real_decks_are_read(void **state)
{
    static const struct {
        const char *name;
        int64_t grids, points, a, b, q, constraints;
    } DECKS[] = {
        {"nas2cam_csuper/inboard.dat", 26, 8, 0, 24, 8, 0},
        {"nas2cam_csuper/inboard.pch", 4, 8, 32, 0, 0, 0},
        {"nas2cam_csuper/inboard.asm", 4, 8, 0, 0, 0, 0},
        {"nas2cam_csuper/inboard.blk", 26, 0, 0, 0, 0, 0},
        {"nas2cam_csuper/outboard.dat", 27, 22, 0, 0, 0, 3},
        {"nas2cam_csuper/exse101.bulk", 8, 0, 0, 0, 0, 0},
        {"public_solvers/nastran95_inboard.deck", 26, 0, 0, 0, 0, 0},
        {"public_solvers/mystran_outboard_cb.dat", 26, 0, 0, 0, 0, 0},
    };
    char path[512];
    ritz_deck bulk = {0};

    (void)state;
    if (!solvers_find("", path))
        skip();
    for (size_t k = 0; k < sizeof DECKS / sizeof *DECKS; k++) {
        assert_true(solvers_find(DECKS[k].name, path));
        assert_ok(ritz_deck_read(path, &bulk));
        assert_int_equal(bulk.grids.count, DECKS[k].grids);
        assert_int_equal(bulk.num_points, DECKS[k].points);
        assert_int_equal(bulk.num_sets[RITZ_SET_A], DECKS[k].a);
        assert_int_equal(bulk.num_sets[RITZ_SET_B], DECKS[k].b);
        assert_int_equal(bulk.num_sets[RITZ_SET_Q], DECKS[k].q);
        assert_int_equal(bulk.num_constraints, DECKS[k].constraints);
        if (bulk.grids.id[0] == 3) {
            int64_t eleven = ritz_grids_find(&bulk.grids, 11);

            assert_vector(bulk.grids.position, 600.0, 0.0, 300.0, 0.0);
            assert_int_equal(bulk.grids.frame[0], 0);
            /* CORD2R 10: z along x, x along y */
            assert_vector(axis(&bulk, eleven, 0), 0.0, 1.0, 0.0, 0.0);
            assert_vector(axis(&bulk, eleven, 2), 1.0, 0.0, 0.0, 0.0);
        }
        if (DECKS[k].constraints)
            assert_string_equal(bulk.constraint[2], "MPC 602");
        ritz_deck_free(&bulk);
    }
}

/* ---- hostile ----------------------------------------------------------- */

static const char DECK[] = "CEND\nSPC=1\nBEGIN BULK\nGRDSET,,,,,,,6\n"
                           "CORD2C  1       0       0.      0.      0.      "
                           "0.      0.      1.      +A\n"
                           "+A      1.      0.      0.\n"
                           "CORD1S,2,1,2,3\n"
                           "GRID*   1                               1.\n*\n"
                           "GRID    2               0.      0.      1.-1    "
                           "1\nGRID,3,1,1.,60.,,1,45\nGRID,4,2,1.,2.,3.\n"
                           "SPOINT,9,THRU,12\nASET1,123,1,THRU,4\n"
                           "QSET1,0,ALL\nSPC,1,3,1,0.,4,2\nSPCADD,1,2\n"
                           "SPC1,2,3,ALL\nRBE2,7,1,123456,2\nENDDATA\n";

/* A deck is text: NUL ends it. */
static ritz_status read_bytes(const char *bytes, int64_t size)
{
    RITZ_OWN(ritz_deck) bulk = {0};
    char text[sizeof DECK + 1] = "";
    ritz_status status = RITZ_OK;

    memcpy(text, bytes, (size_t)size);
    status = parse(text, &bulk);
    assert_true(status == RITZ_OK || !bulk.grids.id);
    return status;
}

static void a_deck_cut_or_corrupted_anywhere_ends_well(void **state)
{
    (void)state;
    assert_ok(read_bytes(DECK, sizeof DECK - 1));
    damage_cut(read_bytes, DECK, sizeof DECK);
    damage_corrupt(read_bytes, DECK, sizeof DECK - 1);
}

static void a_long_chain_of_frames_needs_no_stack(void **state)
{
    enum { LINKS = 20000, LONGEST = 80 };
    char *text = malloc((size_t)LINKS * LONGEST);
    size_t used = 0;
    ritz_deck bulk = {0};

    (void)state;
    assert_non_null(text);
    for (int k = 1; k <= LINKS; k++) /* each rests on the one behind it */
        used += (size_t)snprintf(text + used, LONGEST,
                                 "CORD2R,%d,%d,1.,0.,0.,1.,0.,1.\n,2.,0.,0.\n",
                                 k, k < LINKS ? k + 1 : 0);
    snprintf(text + used, LONGEST, "GRID,1,1\n");
    assert_ok(parse(text, &bulk));
    assert_vector(bulk.grids.position, LINKS, 0.0, 0.0, 0.0); /* integers */
    ritz_deck_free(&bulk);
    free(text);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    assert_survives_every_allocation(read_bytes(DECK, sizeof DECK - 1));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_chain_of_frames_gives_positions_by_hand),
    cmocka_unit_test(frames_by_grids_are_resolved_in_any_order),
    cmocka_unit_test(curved_displacement_axes_follow_the_grid),
    cmocka_unit_test(sets_list_each_dof_once),
    cmocka_unit_test(sets_without_grids_stand_for_all_they_name),
    cmocka_unit_test(the_case_control_chooses_what_acts),
    cmocka_unit_test(what_a_deck_cannot_mean_is_refused),
    cmocka_unit_test(includes_are_relative_to_the_file_that_names_them),
    cmocka_unit_test(includes_are_followed_sixteen_deep),
    cmocka_unit_test(includes_are_regular_files),
    cmocka_unit_test(a_file_is_included_sixteen_times),
    cmocka_unit_test(files_outside_the_decks_folder_are_not_quoted),
    cmocka_unit_test(real_decks_are_read),
    cmocka_unit_test(a_deck_cut_or_corrupted_anywhere_ends_well),
    cmocka_unit_test(a_long_chain_of_frames_needs_no_stack),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(bulk, tests, folder_make, folder_remove)
