#include "testing.h"

#include "spring_chain.h"

#include <ritz/check.h>
#include <ritz/import.h>

#include <stdio.h>
#include <stdlib.h>

/* The check 'rayleigh' of an audit, copied; false if there is none. */
static bool find(const ritz_component *component, ritz_check *out)
{
    RITZ_OWN(ritz_audit) audit = {0};
    bool found = false;

    assert_ok(ritz_audit_component(component, &audit));
    for (int64_t k = 0; k < audit.count; k++)
        if (strcmp(audit.check[k].name, "rayleigh") == 0) {
            *out = audit.check[k];
            found = true;
        }
    return found;
}

static void without_damping_there_is_nothing_to_fit(void **)
{
    RITZ_OWN(ritz_component) chain = {0};
    ritz_check check = {0};

    assert_ok(chain_component(20, &chain));
    assert_false(find(&chain, &check));
}

/* a M + b K, some roundings of each entry. */
static void proportional_damping_is_recognised(void **)
{
    RITZ_OWN(ritz_component) chain = {0};
    ritz_check check = {0};

    assert_ok(chain_component(20, &chain));
    assert_ok(ritz_sparse_add(0.3, &chain.M, 0.002, &chain.K, &chain.D));
    assert_true(find(&chain, &check));
    assert_near(check.value, 0.0, 1e-14);
    assert_string_equal(check.where, "a = 0.3, b = 0.002");
    assert_int_equal(check.verdict, RITZ_PASS);
    assert_non_null(strstr(check.says, "damping is proportional"));
}

/* One damper alone has few places in common with M and K. */
static void damping_that_couples_is_no_fault(void **)
{
    static const int64_t at[] = {2};
    static const double one[] = {1.0};
    RITZ_OWN(ritz_component) chain = {0};
    ritz_check check = {0};

    assert_ok(chain_component(20, &chain));
    assert_ok(ritz_sparse_from_triplets(20, 20, 1, at, at, one, &chain.D));
    assert_true(find(&chain, &check));
    assert_true(check.value > 0.9 && check.value <= 1.0);
    assert_int_equal(check.verdict, RITZ_PASS);
    assert_non_null(strstr(check.says, "not proportional, it couples modes"));
}

static void a_gyroscopic_part_is_named(void **)
{
    static const int64_t row[] = {2, 3}, col[] = {3, 2};
    static const double skew[] = {1.0, -1.0};
    RITZ_OWN(ritz_component) chain = {0};
    ritz_check check = {0};

    assert_ok(chain_component(20, &chain));
    assert_ok(ritz_sparse_from_triplets(20, 20, 2, row, col, skew, &chain.D));
    assert_true(find(&chain, &check));
    assert_near(check.value, 1.0, 1e-15);
    assert_non_null(strstr(check.says, "100 % of it is gyroscopic"));
}

/* LF10: D = 100 M + 0.01 K exactly. */
static void a_published_model_is_proportional_to_rounding(void **)
{
    const char *folder = getenv("RITZ_EXTERNAL_DATA");
    char path[3][512];
    const char *const file[] = {"K", "M", "D"};
    ritz_import_request request = {.dofs = "test_audit_damping.dofs"};
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) model = {0};
    ritz_check check = {0};
    FILE *dofs = NULL;

    for (int k = 0; k < 3; k++)
        snprintf(path[k], sizeof path[k], "%s/second_order/LF10/%s.mtx",
                 folder ? folder : "../shared/data", file[k]);
    dofs = fopen(path[0], "r");
    if (!dofs) {
        print_message("skipped: no external data\n");
        skip();
    }
    fclose(dofs);
    dofs = fopen(request.dofs, "w");
    assert_non_null(dofs);
    for (int k = 1; k <= 18; k++)
        fprintf(dofs, "%d 0\n", k);
    fclose(dofs);
    request.stiffness = path[0];
    request.mass = path[1];
    request.damping = path[2];
    assert_ok(ritz_import(&request, &model, &report));
    assert_true(find(&model, &check));
    assert_near(check.value, 0.0, 1e-15); /* 17 digits; measured: 4.9e-16 */
    assert_string_equal(check.where, "a = 100, b = 0.01");
    remove(request.dofs);
}

static ritz_status audit(const ritz_component *component)
{
    RITZ_OWN(ritz_audit) found = {0};
    ritz_status status = ritz_audit_component(component, &found);

    return status;
}

static void no_allocation_is_forgotten(void **)
{
    RITZ_OWN(ritz_component) chain = {0};

    assert_ok(chain_component(20, &chain));
    assert_ok(ritz_sparse_add(0.3, &chain.M, 0.002, &chain.K, &chain.D));
    assert_survives_every_allocation(audit(&chain));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(without_damping_there_is_nothing_to_fit),
    cmocka_unit_test(proportional_damping_is_recognised),
    cmocka_unit_test(damping_that_couples_is_no_fault),
    cmocka_unit_test(a_gyroscopic_part_is_named),
    cmocka_unit_test(a_published_model_is_proportional_to_rounding),
    cmocka_unit_test(no_allocation_is_forgotten),
};

TEST_MODULE(audit_damping, tests, NULL, NULL)
