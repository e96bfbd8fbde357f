/*
 * Attached dofs by name, and the choice among them, on the beam of
 * [McDaniel2000], chapter 3, with modes 1, 2, 3 and 5 kept: its section 3.3.1
 * has twelve dofs to choose an attachment mode from. The expected numbers were
 * computed with NumPy: dense eigenvectors, compatibility by SVD, H summed over
 * modes at 4000 frequencies.
 */
#include "testing.h"

#include "beams.h"
#include "compared.h"
#include "matrices.h"
#include "scenes.h"

#include "compare/compare.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char band[] = "band_hz: [0, 0.3]\ndamping: {modal: 0.01}\n"
                           "select: {modes: [1, 2, 3, 5]}\n";

static void prepare(compared *f, const char *choice)
{
    char keys[1024];

    snprintf(keys, sizeof keys, "%s%s", band, choice);
    compared_prepare(false, beams_io, keys, f);
}

static void reduce(compared *f, const char *choice)
{
    prepare(f, choice);
    assert_ok(ritz_compare(&f->stage, &f->c));
}

static const ritz_candidate *find_candidate(const compared *f, const char *name)
{
    for (int64_t k = 0; k < f->c.num_candidates; k++)
        if (strcmp(f->c.candidate[k].name, name) == 0)
            return &f->c.candidate[k];
    print_message("there is no candidate '%s'\n", name);
    return NULL;
}

static const ritz_candidate *find_chosen(const compared *f)
{
    const ritz_candidate *chosen = NULL;

    for (int64_t k = 0; k < f->c.num_candidates; k++)
        if (f->c.candidate[k].chosen) {
            assert_null(chosen);
            chosen = &f->c.candidate[k];
        }
    assert_non_null(chosen);
    return chosen;
}

/*
 * The twelve dofs of the paper. Without attachment modes the largest singular
 * value of H is off by 2.5e-3 and the smallest non-zero one by 2.3e-2. The
 * smallest one is worst at 0.3 Hz; for the last three dofs it is worst between
 * two frequencies of the grid, hence their wider bound.
 */
static void twelve_dofs_are_compared_by_both_singular_values(void **)
{
    static const struct {
        const char *name;
        double largest, smallest, bound;
    } dofs[] = {
        {"nothing", 2.528079e-3, 2.337257e-2, 1e-4},
        {"u1", 5.591575e-4, 2.876486e-3, 1e-4},
        {"u2", 2.173767e-4, 5.061342e-4, 1e-4},
        {"u3", 2.528079e-3, 2.337257e-2, 1e-4},
        {"y2", 3.072251e-4, 6.490383e-4, 1e-4},
        {"y4", 2.947329e-3, 2.531948e-2, 1e-4},
        {"y5", 4.533641e-3, 3.729531e-2, 1e-4},
        {"A/n1:1", 2.528079e-3, 2.337257e-2, 1e-4},
        {"A/middle:1", 2.528079e-3, 2.337257e-2, 1e-4},
        {"B/n4:1", 2.528079e-3, 2.337257e-2, 1e-4},
        {"y1", 3.928271e-3, 3.185230e-2, 2e-2},
        {"y3", 3.859843e-3, 3.125481e-2, 2e-2},
        {"y6", 2.997311e-3, 2.450802e-2, 2e-2},
    };
    const ritz_candidate *chosen = NULL;
    compared f;

    reduce(&f, "augment: {level: system, attached: auto}\n");
    assert_int_equal(f.c.search.pool, 12);
    assert_int_equal(f.c.search.below, 0);
    for (size_t k = 0; k < sizeof dofs / sizeof *dofs; k++) {
        const ritz_candidate *one = find_candidate(&f, dofs[k].name);

        assert_non_null(one);
        assert_int_equal(one->num_forces, k > 0);
        assert_near(one->deviation[0] / dofs[k].largest, 1.0,
                    fmax(1e-3, dofs[k].bound));
        assert_near(one->deviation[1] / dofs[k].smallest, 1.0, dofs[k].bound);
        assert_near(ritz_candidate_worst(one), one->deviation[1], 0.0);
    }
    chosen = find_chosen(&f);
    assert_string_equal(chosen->name, "u2");
    assert_int_equal(f.c.second.num_coordinates, 9);
    compared_release(&f);
}

/* The tolerance lies between the two deviations without attachment modes, so
   that an attachment mode is needed. */
static void the_smallest_singular_value_decides(void **)
{
    compared f;

    reduce(&f, "augment: {level: system, attached: auto, tolerance: 0.003}\n");
    assert_true(f.c.candidate[0].deviation[0] < 0.003);
    assert_true(find_chosen(&f) != &f.c.candidate[0]);
    assert_true(ritz_candidate_worst(find_chosen(&f)) <= 0.003);
    compared_release(&f);
}

/* No single dof meets the tolerance, and 28 of the 66 pairs do: two bending
   forces complete the bending motion. The set of all three inputs takes two
   coordinates more. */
static void pairs_are_tried_where_no_single_dof_is_near_enough(void **)
{
    const ritz_candidate *chosen = NULL;
    compared f;

    reduce(&f, "augment: {level: system, attached: auto, tolerance: 1e-6}\n");
    chosen = find_chosen(&f);
    assert_int_equal(f.c.search.below, 1);
    assert_int_equal(f.c.search.tried, 12 + 66);
    assert_int_equal(chosen->num_forces, 2);
    assert_true(ritz_candidate_worst(chosen) < 1e-9);
    assert_true(chosen->total <= find_candidate(&f, "inputs")->total - 2);
    assert_int_equal(f.c.second.num_coordinates, chosen->total);
    compared_release(&f);
}

/* `among` lists the candidates: two outputs, and a port with all its dofs. */
static void the_choice_can_be_limited(void **)
{
    compared f;

    reduce(&f, "augment: {level: system, attached: auto, tolerance: 0.02,\n"
               "          among: [y1, A/n1, y6]}\n");
    assert_int_equal(f.c.search.pool, 4); /* A/n1:6 is y1 */
    assert_non_null(find_candidate(&f, "y1"));
    assert_non_null(find_candidate(&f, "A/n1:1"));
    assert_non_null(find_candidate(&f, "A/n1:2"));
    assert_null(find_candidate(&f, "u2"));
    assert_string_equal(find_chosen(&f)->name, "A/n1:2");
    compared_release(&f);
}

/* All names of a dof attach the same mode. With the attachment mode of dof 5
   the gain of stage two is off by 1.9e-5 of that of stage one. */
static void a_dof_can_be_attached_by_any_of_its_names(void **)
{
    static const char *const names[] = {"u2", "A/middle:2", "A/2:2",
                                        "B/middle:2", "B/2:2"};
    double gain = 0.0;

    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        char choice[128];
        compared f;

        snprintf(choice, sizeof choice,
                 "augment: {level: system, attached: [%s]}\n", names[k]);
        reduce(&f, choice);
        if (k == 0)
            gain = f.c.row[0].gain_error;
        assert_near(gain, 1.9e-5, 5e-7);
        assert_near(f.c.row[0].gain_error / gain, 1.0, 1e-6);
        assert_int_equal(f.c.second.num_coordinates, 9);
        compared_release(&f);
    }
}

/* An output without an input can be attached: its force acts where it
   measures. */
static void an_output_can_be_attached(void **)
{
    static const char *const names[] = {"y5", "B/n4:2", "B/4:2"};
    double gain = 0.0;

    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        char choice[128];
        compared f;

        snprintf(choice, sizeof choice,
                 "augment: {level: system, attached: [%s]}\n", names[k]);
        reduce(&f, choice);
        if (k == 0)
            gain = f.c.row[0].gain_error;
        assert_near(gain, 8.6e-4, 5e-6);
        assert_near(f.c.row[0].gain_error / gain, 1.0, 1e-6);
        compared_release(&f);
    }
}

/* At component level all dofs of a port can be attached, and the usual sets are
   compared too. */
static void ports_of_components_can_be_attached(void **)
{
    const ritz_candidate *own = NULL;
    compared f;

    reduce(&f, "augment: {level: component, attached: [inputs, B/n4]}\n");
    own = find_chosen(&f);
    assert_string_equal(own->name, "inputs, B/n4:1, B/n4:2, B/n4:6");
    assert_int_equal(own->num_forces, 6);
    assert_int_equal(f.c.num_candidates, 6);
    assert_int_equal(f.c.search.pool, 0);
    assert_true(own->total > find_candidate(&f, "inputs")->total);
    assert_true(f.c.row[0].gain_error < 1e-11);
    compared_release(&f);
}

static void unknown_ports_and_grids_are_refused(void **)
{
    static const struct {
        const char *place, *words;
    } cases[] = {
        {"A/midle", "there is no port 'midle', is 'middle' meant?"},
        {"A/midle:2", "there is no port 'midle', is 'middle' meant?"},
        {"A/middle:3", "'middle' has no direction 3"},
        {"A/7:2", "there is no port and no grid '7'"},
        {"A/2:4", "'2' has no direction 4"},
        {"A/middle:9", "there is no port 'middle:9'"},
    };

    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char choice[128];
        compared f;

        snprintf(choice, sizeof choice,
                 "augment: {level: system, attached: [%s]}\n", cases[k].place);
        prepare(&f, choice);
        assert_fails(ritz_compare(&f.stage, &f.c), RITZ_ERR_ARGUMENT,
                     cases[k].words);
        compared_release(&f);
    }
}

/* A body without T has no grids but those of its ports. */
static void a_grid_of_a_body_without_a_basis_is_refused(void **)
{
    compared f;

    prepare(&f, "augment: {level: system, attached: [A/2:2]}\n");
    ritz_dense_free(&f.stage.body[0].T);
    assert_fails(ritz_compare(&f.stage, &f.c), RITZ_ERR_ARGUMENT,
                 "only its ports are known of this component");
    compared_release(&f);
}

static void no_allocation_failure_leaks(void **)
{
    compared f;

    prepare(&f, "augment: {level: system, attached: auto, tolerance: 1e-6,\n"
                "          among: [y1, A/n1:2]}\n");
    assert_survives_allocations(11, compared_anew(&f.stage));
    compared_release(&f);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(twelve_dofs_are_compared_by_both_singular_values),
    cmocka_unit_test(the_smallest_singular_value_decides),
    cmocka_unit_test(pairs_are_tried_where_no_single_dof_is_near_enough),
    cmocka_unit_test(the_choice_can_be_limited),
    cmocka_unit_test(a_dof_can_be_attached_by_any_of_its_names),
    cmocka_unit_test(an_output_can_be_attached),
    cmocka_unit_test(ports_of_components_can_be_attached),
    cmocka_unit_test(unknown_ports_and_grids_are_refused),
    cmocka_unit_test(a_grid_of_a_body_without_a_basis_is_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(attach, tests, NULL, NULL)
