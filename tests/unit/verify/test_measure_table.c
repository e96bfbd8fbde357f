/* The table of measures, its page, and the measures that a limit asks for. */
#include "testing.h"

#include "masses.h"
#include "project.h"

#include <ritz/verify.h>

#include <stdio.h>
#include <stdlib.h>

static const ritz_verify_request plain = RITZ_VERIFY_NONE;

/* The part of a page from one heading to another. */
static char *part_of(const char *page, const char *from, const char *to)
{
    const char *first = strstr(page, from);
    const char *last = first ? strstr(first, to) : NULL;

    if (!first || !last) {
        fail_msg("the page has no '%s' before '%s'", from, to);
        return NULL;
    }
    return strndup(first, (size_t)(last - first));
}

/* "| `name` | definition | `word` |" for each row, and no other. */
static void assert_listed(const char *part, bool states)
{
    int64_t rows = 0;

    for (const char *at = part; (at = strstr(at, "\n| `")); at++)
        rows++;
    for (int k = 0; k < RITZ_MEASURES; k++) {
        const ritz_measure_kind *kind = &ritz_measure_table[k];
        char begin[2 * RITZ_NAME_SIZE], end[2 * RITZ_NAME_SIZE] = "| |\n";
        const char *line = NULL;

        if (states ? !kind->of_states : !kind->of_modes)
            continue;
        if (kind->word)
            (void)snprintf(end, sizeof end, "| `%s` |\n", kind->word);
        (void)snprintf(begin, sizeof begin, "\n| `%s` |", kind->name);
        line = strstr(part, begin);
        if (!line) {
            fail_msg("the page has no row of %s", kind->name);
            return;
        }
        line = strchr(line + 1, '\n') + 1 - strlen(end);
        if (strncmp(line, end, strlen(end)) != 0)
            fail_msg("the row of %s does not end with %s", kind->name, end);
        rows--;
    }
    assert_int_equal(rows, 0);
}

static void the_page_lists_every_row_of_the_table_and_no_other(void **)
{
    char path[1024];
    char *page = NULL, *modes = NULL, *states = NULL;

    (void)snprintf(path, sizeof path, "%s/../docs/methods/verify.md",
                   getenv("RITZ_DATA"));
    assert_ok(ritz_text_read(path, &page));
    modes = part_of(page, "## Errors of ritz-verify", "## State spaces");
    states = part_of(page, "## State spaces", "## Band");
    assert_listed(modes, false);
    assert_listed(states, true);
    free(page);
    free(modes);
    free(states);
}

static void every_row_is_whole(void **)
{
    for (int k = 0; k < RITZ_MEASURES; k++) {
        const ritz_measure_kind *kind = &ritz_measure_table[k];

        assert_true(kind->of_modes || kind->of_states);
        assert_non_null(kind->unit);
        assert_int_equal(!kind->word, !kind->help);
        assert_int_equal(!kind->label, kind->importance == 0);
        assert_ptr_equal(ritz_measure_kind_find(kind->name), kind);
        assert_true(!kind->other || ritz_measure_kind_find(kind->other));
    }
}

static void ratios_are_of_what_is_wrong(void **)
{
    assert_near(ritz_measure_ratio("mac", 0.9, 0.95), 2.0, 1e-12);
    assert_near(ritz_measure_ratio("gain", 0.9, 0.45), 2.0, 0.0);
    assert_near(ritz_measure_ratio("missing-modes", 0.0, 0.0), 0.0, 0.0);
    assert_near(ritz_measure_ratio("missing-modes", 2.0, 0.0), 3.0, 0.0);
    assert_near(ritz_measure_error("mac", 0.75), 0.25, 0.0);
    assert_true(!ritz_measure_meets("mac", 0.1, 0.2));
    assert_true(!ritz_measure_meets("response-db", 0.2, 0.1));
    assert_true(isnan(ritz_measure_limit(plain.limit, "mac")));
}

/* The measure called @p name of a reduction by T, as a component and as a
   system: both have it, and it is the same. */
static double measured(const ritz_component *full, int64_t columns,
                       const double *T, ritz_verify_request request,
                       ritz_measure_id id)
{
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    ritz_configuration at = {0};
    RITZ_OWN(ritz_measures) found = {0}, system = {0};
    const char *name = ritz_measure_table[id].name;
    double value = 0.0;

    assert_ok(ritz_basis_new(full->num_dofs, columns, &basis));
    memcpy(basis.T.val, T, (size_t)(full->num_dofs * columns) * sizeof *T);
    assert_ok(ritz_reduce(full, &basis, &reduced));
    assert_ok(verify_reduced(full, &reduced, &request, &found));
    assert_null(ritz_measures_find(&found, name));
    ritz_measures_free(&found);
    request.limit[id] = 1.0;
    assert_ok(verify_reduced(full, &reduced, &request, &found));
    at = (ritz_configuration){
        .K = reduced.K, .M = reduced.M, .D = reduced.D, .io = reduced.io};
    assert_ok(verify_system(full, &at, &request, &system));
    value = find_measure(&found, name)->value;
    assert_near(find_measure(&found, name)->limit, 1.0, 0.0);
    assert_near(find_measure(&system, name)->value, value, 1e-13);
    return value;
}

/* Four masses in a row, seen and driven at two, and two vectors that are no
   modes. SciPy's numbers below are of scipy.linalg.solve_continuous_lyapunov
   and of numpy.linalg.svd at 4001 frequencies. */
static ritz_component row_of_four(void)
{
    static const double m[] = {1.0, 2.0, 1.5, 1.0};
    static const double k[] = {100.0, 50.0, 80.0, 60.0};
    static const double c[] = {0.4, 0.1, 0.2, 0.3};
    static const int64_t pushed[] = {0, 3}, seen[] = {1, 3};
    ritz_component row = {0};

    assert_ok(masses_component(4, m, k, c, &row));
    assert_ok(masses_io(&row, 2, pushed, 2, seen));
    return row;
}

static const double two_vectors[] = {1.0, 0.7, 0.3, 0.0, 0.0, 0.3, 0.7, 1.0};

/* |c b / (s^2 + 2 z w s + w^2)|_2^2 = (c b)^2 / (4 z w^3); of two masses apart
   one is left out. */
static void the_h2_error_of_a_mode_left_out_is_its_norm(void **)
{
    static const double k[] = {9.0, 16.0}, c[] = {0.3, 0.2};
    static const double T[] = {1.0, 0.0};
    static const int64_t both[] = {0, 1};
    ritz_verify_request request = plain;
    RITZ_OWN(ritz_component) masses = {0};
    double square[2];

    for (int i = 0; i < 2; i++) /* 4 z w^3 = 2 c k */
        square[i] = 1.0 / (2.0 * c[i] * k[i]);
    request.band_hz[1] = 0.5;
    assert_ok(masses_apart(2, k, c, &masses));
    assert_ok(masses_io(&masses, 2, both, 2, both));
    assert_near(measured(&masses, 1, T, request, RITZ_MEASURE_H2),
                sqrt(square[1] / (square[0] + square[1])), 1e-13);
}

static void the_h2_error_is_that_of_scipy(void **)
{
    ritz_verify_request request = plain;
    ritz_component row = row_of_four();

    request.band_hz[1] = 0.45;
    assert_near(measured(&row, 2, two_vectors, request, RITZ_MEASURE_H2),
                1.315847267990201, 1e-11);
    ritz_component_free(&row);
}

static void h2_errors_of_unequal_rigid_motion_are_refused(void **)
{
    static const double m[] = {1.0, 2.0, 1.5}, k[] = {0.0, 50.0, 80.0};
    static const double c[] = {0.0, 0.1, 0.2};
    static const double T[] = {1.0, 0.0, 0.0};
    static const int64_t first = 0;
    ritz_verify_request request = plain;
    RITZ_OWN(ritz_component) row = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    ritz_measures found = {0};

    request.band_hz[1] = 0.5;
    request.limit[RITZ_MEASURE_H2] = 1.0;
    assert_ok(masses_component(3, m, k, c, &row));
    assert_ok(masses_io(&row, 1, &first, 1, &first));
    assert_ok(ritz_basis_new(3, 1, &basis));
    memcpy(basis.T.val, T, sizeof T);
    assert_ok(ritz_reduce(&row, &basis, &reduced));
    assert_fails(verify_reduced(&row, &reduced, &request, &found),
                 RITZ_ERR_ARGUMENT, "the norm of their difference is infinite");
}

/* H = diag(h_1, h_2): below all resonances sigma_2 is the response of the
   stiffer mass. It rises with frequency; the error, of a model that is too
   stiff and too heavy, is largest at rest. */
static void the_smallest_singular_value_is_of_the_stiffer_mass(void **)
{
    static const double k[] = {4.0, 100.0, 9.0}, c[] = {0.1, 0.2, 0.3};
    static const double T[] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.5};
    static const int64_t both[] = {0, 1};
    const double w = 2.0 * 3.14159265358979323846 * 0.3;
    ritz_verify_request request = plain;
    RITZ_OWN(ritz_component) masses = {0};
    double largest = 0.0;

    request.band_hz[1] = 0.3;
    assert_ok(masses_apart(3, k, c, &masses));
    assert_ok(masses_io(&masses, 2, both, 2, both));
    largest = 1.0 / hypot(k[1] - w * w, w * c[1]);
    assert_near(measured(&masses, 2, T, request, RITZ_MEASURE_SINGULAR),
                (1.0 / k[1] - 1.0 / (k[1] + 0.25 * k[2])) / largest, 1e-12);
}

static void the_smallest_singular_value_is_that_of_scipy(void **)
{
    ritz_verify_request request = plain;
    ritz_component row = row_of_four();

    request.band_hz[1] = 0.45;
    assert_near(measured(&row, 2, two_vectors, request, RITZ_MEASURE_SINGULAR),
                0.14121453568614842, 1e-10);
    ritz_component_free(&row);
}

/* One column reaches both outputs from one input alone: the other singular
   value is zero everywhere and does not count. */
static void singular_values_that_are_zero_do_not_count(void **)
{
    static const int64_t seen[] = {1, 3};
    static const double T[] = {1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0,
                               0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0};
    static const int64_t twice[] = {0, 0};
    ritz_verify_request request = plain;
    ritz_component row = row_of_four();

    request.band_hz[1] = 0.45;
    assert_ok(masses_io(&row, 2, twice, 2, seen));
    assert_true(measured(&row, 4, T, request, RITZ_MEASURE_SINGULAR) < 1e-12);
    ritz_component_free(&row);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_page_lists_every_row_of_the_table_and_no_other),
    cmocka_unit_test(every_row_is_whole),
    cmocka_unit_test(ratios_are_of_what_is_wrong),
    cmocka_unit_test(the_h2_error_of_a_mode_left_out_is_its_norm),
    cmocka_unit_test(the_h2_error_is_that_of_scipy),
    cmocka_unit_test(h2_errors_of_unequal_rigid_motion_are_refused),
    cmocka_unit_test(the_smallest_singular_value_is_of_the_stiffer_mass),
    cmocka_unit_test(the_smallest_singular_value_is_that_of_scipy),
    cmocka_unit_test(singular_values_that_are_zero_do_not_count),
};

TEST_MODULE(measure_table, tests, NULL, NULL)
