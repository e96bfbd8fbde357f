/* Containers of recovered maxima, and refusals of quantities that do not fit
   their model. */
#include "testing.h"

#include "sample_quantities.h"
#include "samples.h"

#include <ritz/container.h>

#include <stdio.h>

static const char path[] = "test_container_recovered.h5";
static const ritz_stamp stamp = {.command = "ritz-verb"};

static int tear_down(void **)
{
    remove(path);
    return 0;
}

static void maxima_are_read_back(void **)
{
    RITZ_OWN(ritz_recovered) a = {0}, b = {0};

    assert_ok(sample_recovered(&a));
    assert_ok(ritz_container_write_recovered(path, &a, &stamp));
    assert_ok(ritz_container_read_recovered(path, &b));
    assert_int_equal(a.count, b.count);
    assert_near(a.end, b.end, 0.0);
    assert_string_equal(a.units, b.units);
    assert_int_equal(a.num_quantities, b.num_quantities);
    for (int64_t k = 0; k < a.num_quantities; k++) {
        const ritz_peaks *p = &a.quantity[k];
        const ritz_peaks *q = &b.quantity[k];

        assert_string_equal(p->name, q->name);
        assert_string_equal(p->by, q->by);
        assert_int_equal(p->count, q->count);
        assert_memory_equal(p->place, q->place, (size_t)p->count * 8);
        assert_memory_equal(p->value, q->value, (size_t)p->count * 8);
        assert_memory_equal(p->seconds, q->seconds, (size_t)p->count * 8);
    }
}

/* A script may write a container whose quantities do not fit its model. */
static void quantities_of_another_size_are_refused(void **)
{
    for (int k = 0; k < 3; k++) {
        RITZ_OWN(ritz_reduced) a = {0}, b = {0};

        assert_ok(sample_reduced(true, &a));
        if (k == 0)
            ritz_dense_free(&a.quantity[0].A);
        if (k == 1)
            a.quantity[0].F.ncol--; /* fewer inputs than the model has */
        if (k == 2)
            snprintf(a.quantity[1].kind, RITZ_NAME_SIZE, "strain");
        assert_ok(ritz_container_write_reduced(path, &a, &stamp));
        assert_fails(ritz_container_read_reduced(path, &b), RITZ_ERR_FORMAT,
                     k == 0   ? "lacks a part of its mode acceleration"
                     : k == 1 ? "of another size than the model"
                              : "which is none of stress");
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(maxima_are_read_back),
    cmocka_unit_test(quantities_of_another_size_are_refused),
};

TEST_MODULE(container_recovered, tests, NULL, tear_down)
