/*
 * What stage two is made from: modes by a list, by a band, by rank; and P&A,
 * held to the beam of two components [McDaniel2000, table 3.3].
 */
#include "testing.h"

#include "beams.h"
#include "compared.h"
#include "project.h"

#include "compare/compare.h"

#include <ritz/assembly.h>
#include <ritz/verify.h>

#include <float.h>
#include <stdio.h>
#include <stdlib.h>

/* Half a unit of the last digit printed. */
static const double four_digits = 5e-5;

/* Table 3.3, with the six dofs that a constraint of rank 2 leaves. */
static void modes_1_2_3_5_give_table_3_3(void **)
{
    static const double A[] = {0.0625, 0.3946, 1.3347, 3.8738};
    static const double B[] = {0.0, 0.0147, 0.3992, 1.5928};
    static const double S[] = {0.0156, 0.0979, 0.2760, 0.5446, 1.0631, 2.0961};
    const ritz_configuration *second = NULL;
    compared f;

    compared_reduce(false, "", "select: {modes: [1, 2, 3, 5]}\n", &f);
    second = &f.c.second_system.configuration[0];
    assert_hertz(&f.c.second.body[0].K, &f.c.second.body[0].M, 4, A,
                 four_digits);
    assert_hertz(&f.c.second.body[1].K, &f.c.second.body[1].M, 4, B,
                 four_digits);
    assert_int_equal(second->rank, 2);
    assert_hertz(&second->K, &second->M, 6, S, four_digits);
    assert_int_equal(f.c.num_rows, 1);
    assert_int_equal(f.c.row[0].num_kept, 4);
    assert_int_equal(f.c.row[0].kept[3], 4);
    assert_true(f.c.row[0].frequency_error <= f.c.row[0].allowed);
    compared_release(&f);
}

static void modes_1_2_3_4_bring_an_axial_constraint(void **)
{
    static const double S[] = {0.0156, 0.0979, 0.2760, 0.4872, 0.6626};
    const ritz_configuration *second = NULL;
    compared f;

    compared_reduce(false, "", "select: {modes: [4, 3, 1, 2]}\n", &f);
    second = &f.c.second_system.configuration[0];
    assert_int_equal(second->rank, 3);
    assert_hertz(&second->K, &second->M, 5, S, four_digits);
    compared_release(&f);
}

/* Each of the 4095 sets of modes but for some: the kept ones are exact. */
static void every_kept_mode_is_a_mode_of_the_second_system(void **)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    int64_t modes[12];

    assert_ok(beams_stage(false, "", &scene, &stage));
    scene.select = RITZ_SELECT_LISTED;
    free(scene.select_mode);
    scene.select_mode = modes;
    for (unsigned set = 1; set < 1u << 12; set += 37) {
        ritz_comparison c = {0};

        scene.num_select_modes = 0;
        for (int k = 0; k < 12; k++)
            if (set & (1u << k))
                modes[scene.num_select_modes++] = k;
        assert_ok(ritz_compare(&stage, &c));
        assert_int_equal(c.row[0].num_kept, scene.num_select_modes);
        assert_true(c.row[0].frequency_error <= c.row[0].allowed);
        assert_near(c.row[0].mac, 1.0, 1e-9); /* measured: 1e-14 */
        ritz_comparison_free(&c);
    }
    scene.select_mode = NULL;
}

static void a_band_keeps_what_lies_in_it(void **)
{
    compared f;

    compared_reduce(false, "", "band_hz: [0.05, 0.5]\nselect: {by: band}\n",
                    &f);
    assert_int_equal(f.c.row[0].num_kept, 3); /* 0.098, 0.276, 0.487 */
    assert_int_equal(f.c.row[0].kept[0], 1);
    assert_int_equal(f.c.row[0].kept[2], 3);
    compared_release(&f);
    /* nothing to rank by: from 0 up to the end of the band */
    compared_reduce(false, "", "band_hz: [0.05, 0.5]\n", &f);
    assert_int_equal(f.c.row[0].num_kept, 4);
    assert_int_equal(f.c.row[0].kept[0], 0);
    compared_release(&f);
}

/* Modes 4, 7, 10 and 11 are axial, and neither driven nor seen. */
static void a_ranking_leaves_out_what_no_input_drives(void **)
{
    compared f;

    compared_reduce(false, beams_io,
                    "damping: {modal: 0.01}\n"
                    "select: {by: gregory, tolerance: 1.0e-6}\n",
                    &f);
    assert_int_equal(f.c.row[0].num_kept, 8);
    for (int k = 0; k < 8; k++) {
        int64_t mode = f.c.row[0].kept[k] + 1;

        assert_true(mode != 4 && mode != 7 && mode != 10 && mode != 11);
    }
    compared_release(&f);
}

/*
 * Two beams that are not joined: every mode is there twice, and each pair is
 * one cluster. Whatever its selection, none of them is split.
 */
static void a_cluster_is_never_split_by_a_list(void **)
{
    static const int64_t list[] = {2};
    RITZ_OWN(ritz_scene) scene = {0};
    ritz_stage stage = {0};
    ritz_comparison c = {0};
    ritz_reduced body[2] = {0};
    int64_t mode[1] = {list[0]};

    assert_ok(beams_stage(false, "", &scene, &stage));
    for (int k = 0; k < 2; k++) { /* component A twice, and no joint */
        ritz_dense one = {0};
        int64_t r = stage.body[0].K.ncol;

        assert_ok(ritz_dense_new(r, r, &one));
        for (int64_t j = 0; j < r; j++)
            ritz_dense_col(&one, j)[j] = 1.0;
        assert_ok(ritz_reduced_project(&stage.body[0], &one, &body[k]));
        ritz_dense_free(&one);
    }
    ritz_stage_free(&stage);
    scene.num_joints = 0;
    assert_ok(ritz_stage_from(&scene, body, &stage));
    scene.select = RITZ_SELECT_LISTED;
    scene.num_select_modes = 1;
    scene.select_mode = mode;
    assert_ok(ritz_compare(&stage, &c));
    assert_int_equal(c.row[0].num_flexible, 12);
    assert_int_equal(c.row[0].num_completed, 1);
    assert_int_equal(c.row[0].num_kept, 2);
    assert_int_equal(c.row[0].kept[0], 2);
    assert_int_equal(c.row[0].kept[1], 3);
    assert_int_equal(c.V[0].ncol, 1); /* each body has its own of the two */
    assert_int_equal(c.V[1].ncol, 1);
    ritz_comparison_free(&c);
    ritz_stage_free(&stage);
    scene.select_mode = NULL;
    scene.num_joints = 1;
}

/*
 * P&A has six modes where four were kept: two stand for none of them. Removed,
 * the system has the four, and the bodies are what they were.
 */
static void extraneous_modes_are_found_and_removed(void **)
{
    static const char *const fates[] = {"", "extraneous: remove\n",
                                        "extraneous: out-of-band\n"};
    static const int64_t orders[] = {6, 4, 5};

    for (int k = 0; k < 3; k++) {
        char choice[256];
        const ritz_compare_row *row = NULL;
        const ritz_configuration *second = NULL;
        compared f;

        snprintf(choice, sizeof choice,
                 "band_hz: [0, 2]\nselect: {modes: [1, 2, 3, 5]}\n%s",
                 fates[k]);
        compared_reduce(false, "", choice, &f);
        row = &f.c.row[0];
        second = &f.c.second_system.configuration[0];
        assert_int_equal(row->num_strays, 2);
        assert_near(row->stray[0].hertz, 1.0631, four_digits);
        assert_near(row->stray[1].hertz, 2.0961, four_digits);
        assert_int_equal(row->stray[0].mode, 4);
        assert_true(row->stray[0].removed == (k == 1));
        assert_true(row->stray[1].removed == (k > 0));
        assert_int_equal(row->order, orders[k]);
        assert_int_equal(second->K.ncol, orders[k]);
        assert_int_equal(second->P[0].ncol, orders[k]);
        assert_int_equal(second->P[0].nrow, 4);
        assert_int_equal(f.c.second.body[0].K.ncol, 4);
        for (int64_t j = 0; j < orders[k]; j++)
            assert_near(ritz_dense_col(&second->K, j)[j], second->lambda[j],
                        DBL_EPSILON);
        compared_release(&f);
    }
}

/* Modes 3 and 5 alone: what is removed lies below and between them. */
static void modes_that_are_left_keep_their_frequencies(void **)
{
    const ritz_configuration *one = NULL, *two = NULL;
    compared f;

    compared_reduce(
        false, beams_io,
        "select: {modes: [3, 5]}\naugment: system\nextraneous: remove\n", &f);
    one = &f.c.first_system.configuration[0];
    two = &f.c.second_system.configuration[0];
    assert_true(f.c.row[0].stray[0].hertz < 0.27);
    assert_int_equal(two->K.ncol, 2);
    assert_int_equal(two->io.B.nrow, 2);
    assert_int_equal(two->io.C.ncol, 2);
    for (int j = 0; j < 2; j++) {
        int k = j == 0 ? 2 : 4;

        assert_near(two->lambda[j] / one->lambda[k], 1.0, 1e-10);
        assert_near(ritz_dense_col(&two->K, j)[j], two->lambda[j], DBL_EPSILON);
        assert_near(fabs(ritz_dense_col(&two->io.B, 0)[j]),
                    fabs(ritz_dense_col(&one->io.B, 0)[k]), 1e-9);
    }
    compared_release(&f);
}

static void choices_that_make_no_sense_are_refused(void **)
{
    static const struct {
        const char *choice, *words;
    } cases[] = {
        {"select: {modes: []}\n",
         "beams.yaml:7:17: 1 to 10000 modes can be listed, not 0"},
        {"select: {modes: [0]}\n", "0 is no flexible mode, the first is 1"},
        {"select: {modes: [2, 1, 2]}\n", "mode 2 is listed before"},
        {"select: {modes: [1], by: hankel}\n",
         "modes are chosen by a list or by something, not both"},
        {"select: {modes: [1], tolerance: 0.1}\n",
         "a tolerance goes with a ranking alone"},
        {"select: {by: band}\n",
         "modes are chosen by a band and there is no 'band_hz'"},
        {"select: {by: bnd}\n", "there is no ranking 'bnd'"},
        {"select: {by: krylov}\n",
         "by krylov wants to know how many 'vectors'"},
        {"select: {by: krylov, vectors: 3}\n",
         "Krylov vectors begin with what inputs do, and there are none"},
        {"select: {by: hankel, vectors: 3}\n",
         "'vectors' goes with 'by: krylov' alone"},
        {"select: {start: both}\n", "'start' goes with 'by: krylov' alone"},
        {"inputs: [{name: u, at: A/n1, component: 1}]\n"
         "select: {by: krylov, vectors: 0}\n",
         "1 to 10000 Krylov vectors can be made, not 0"},
        {"inputs: [{name: u, at: A/n1, component: 1}]\n"
         "select: {by: krylov, vectors: 2}\nextraneous: remove\n",
         "Krylov vectors keep moments, not modes, so no mode is extraneous"},
        {"extraneous: drop\n", "unknown fate of extraneous modes 'drop'"},
        {"extraneous: out-of-band\n", "there is no 'band_hz'"},
    };

    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        ritz_scene scene = {0};
        ritz_stage stage = {0};

        assert_fails(beams_stage(false, cases[k].choice, &scene, &stage),
                     RITZ_ERR_FORMAT, cases[k].words);
    }
}

static void a_mode_that_is_not_there_is_refused(void **)
{
    compared f;

    compared_prepare(false, "", "select: {modes: [1, 13]}\n", &f);
    assert_fails(ritz_compare(&f.stage, &f.c), RITZ_ERR_ARGUMENT,
                 "selection: mode 13 is listed, and there are 12 flexible "
                 "modes");
    compared_release(&f);
}

static void no_allocation_failure_leaks(void **)
{
    compared f;

    compared_prepare(false, "",
                     "band_hz: [0, 2]\nselect: {modes: [1, 2, 3, 5]}\n"
                     "extraneous: remove\n",
                     &f);
    assert_survives_every_allocation(compared_anew(&f.stage));
    compared_release(&f);
}

/*
 * A damper between node 1 of body A and the ground couples bending modes, which
 * then form one cluster. A cluster is kept as a whole or not at all.
 */
static void modes_that_damping_joins_are_kept_together(void **)
{
    const ritz_configuration *one = NULL;
    double value[16] = {0.0}, largest = 0.0;
    int64_t whole = 0, joined = 0;
    compared f;

    compared_prepare(
        false, beams_io,
        "damping: {modal: 0.001}\nselect: {by: hankel, tolerance: 0.5}\n", &f);
    assert_ok(ritz_dense_new(6, 6, &f.stage.body[0].D));
    ritz_dense_col(&f.stage.body[0].D, 1)[1] = 0.05;
    assert_ok(ritz_compare(&f.stage, &f.c));
    one = &f.c.first_system.configuration[0];
    assert_in_range(one->K.ncol - one->num_rigid, 8, 16);
    assert_ok(ritz_compare_values(&f.scene, one, value, &joined));
    for (int k = 0; k < 16; k++)
        largest = fmax(largest, value[k]);
    for (int k = 0; k < 16; k++)
        whole += value[k] == largest;
    assert_true(joined >= 4);
    assert_int_equal(whole, joined + 1);
    assert_int_equal(f.c.row[0].num_joined, joined);
    assert_true(f.c.row[0].num_kept >= whole);
    assert_true(f.c.row[0].num_kept < one->K.ncol - one->num_rigid);
    assert_true(f.c.row[0].frequency_error <= f.c.row[0].allowed);
    compared_release(&f);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(modes_1_2_3_5_give_table_3_3),
    cmocka_unit_test(modes_1_2_3_4_bring_an_axial_constraint),
    cmocka_unit_test(every_kept_mode_is_a_mode_of_the_second_system),
    cmocka_unit_test(a_band_keeps_what_lies_in_it),
    cmocka_unit_test(a_ranking_leaves_out_what_no_input_drives),
    cmocka_unit_test(a_cluster_is_never_split_by_a_list),
    cmocka_unit_test(extraneous_modes_are_found_and_removed),
    cmocka_unit_test(modes_that_are_left_keep_their_frequencies),
    cmocka_unit_test(choices_that_make_no_sense_are_refused),
    cmocka_unit_test(a_mode_that_is_not_there_is_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
    cmocka_unit_test(modes_that_damping_joins_are_kept_together),
};

TEST_MODULE(select, tests, NULL, NULL)
