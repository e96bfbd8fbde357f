/* Rankings compared, over configurations, and weights that go round. */
#include "testing.h"

#include <ritz/container.h>
#include <ritz/ranking.h>

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* A ranking by these values, each mode by itself. */
static ritz_status make(int64_t count, const double *value, ritz_ranking *out)
{
    ritz_status status = RITZ_OK;
    ritz_ranking r = {.by = "hankel", .count = count, .total = nan("")};

    RITZ_NEW(r.hertz, count);
    RITZ_NEW(r.zeta, count);
    RITZ_NEW(r.value, count);
    RITZ_NEW(r.order, count);
    RITZ_NEW(r.cluster, count);
    RITZ_NEW(r.system_value, 1);
    for (int64_t k = 0; k < count; k++) {
        r.hertz[k] = 1.0 + (double)k;
        r.value[k] = value[k];
        r.cluster[k] = k;
        r.order[k] = k;
    }
    for (int64_t i = 1; i < count; i++) /* few: by insertion */
        for (int64_t j = i;
             j > 0 && fabs(value[r.order[j]]) > fabs(value[r.order[j - 1]]);
             j--) {
            int64_t other = r.order[j];

            r.order[j] = r.order[j - 1];
            r.order[j - 1] = other;
        }
    *out = r;
    r = (ritz_ranking){0};
done:
    ritz_ranking_free(&r);
    return status;
}

static void a_ranking_agrees_with_itself_and_not_with_its_reverse(void **state)
{
    const double up[] = {1, 2, 3, 4, 5, 6, 7};
    const double down[] = {7, -6, 5, 4, 3, -2, 1};
    RITZ_OWN(ritz_ranking) a = {0}, b = {0};
    ritz_agreement g = {0};

    (void)state;
    assert_ok(make(7, up, &a));
    assert_ok(make(7, down, &b));
    assert_ok(ritz_rankings_agree(&a, NULL, &a, NULL, 3, &g));
    assert_near(g.spearman, 1.0, 1e-15);
    assert_near(g.kendall, 1.0, 1e-15);
    assert_int_equal(g.common, 7);
    assert_int_equal(g.num_left + g.num_entered, 0);
    assert_int_equal(g.num_overlaps, 3); /* 1, 2, 5 of seven */
    assert_int_equal(g.overlap[2].k, 5);
    assert_near(g.overlap[2].share, 1.0, 0.0);
    ritz_agreement_free(&g);
    assert_ok(ritz_rankings_agree(&a, NULL, &b, NULL, 3, &g));
    assert_near(g.spearman, -1.0, 1e-15);
    assert_near(g.kendall, -1.0, 1e-15);
    assert_near(g.overlap[0].share, 0.0, 0.0);
    assert_near(g.overlap[2].share, 0.6, 1e-15); /* 3, 4, 5 of five */
    assert_near(g.top_share, 0.0, 0.0);
    assert_int_equal(g.num_left, 3);
    assert_int_equal(g.left[0], 6);
    assert_int_equal(g.entered[0], 0);
    ritz_agreement_free(&g);
}

/*
 * By hand: places 1 2.5 2.5 4 of a and 2 1 3 4 of b. Spearman 3 / sqrt(4.5 5);
 * Kendall (4 - 1) / sqrt(5 6), the tied pair counting in one only. What is
 * 1e-12 of the largest and less is nothing, and so is equal.
 */
static void ties_share_their_place(void **state)
{
    const double one[] = {9, 5, 5, 1};
    const double two[] = {5, 9, 3, 1};
    const double noise[] = {1e-20, 1.0, 1e-15, -1e-17};
    const double zeros[] = {0.0, 1.0, 0.0, 0.0};
    ritz_ranking a = {0}, b = {0};
    ritz_agreement g = {0};

    (void)state;
    assert_ok(make(4, one, &a));
    assert_ok(make(4, two, &b));
    assert_ok(ritz_rankings_agree(&a, NULL, &b, NULL, 1, &g));
    assert_near(g.spearman, 3.0 / sqrt(4.5 * 5.0), 1e-15);
    assert_near(g.kendall, 3.0 / sqrt(30.0), 1e-15);
    ritz_agreement_free(&g);
    ritz_ranking_free(&a);
    ritz_ranking_free(&b);
    assert_ok(make(4, noise, &a));
    assert_ok(make(4, zeros, &b));
    assert_ok(ritz_rankings_agree(&a, NULL, &b, NULL, 1, &g));
    assert_near(g.spearman, 1.0, 1e-15);
    ritz_agreement_free(&g);
    ritz_ranking_free(&a);
    ritz_ranking_free(&b);
}

/*
 * [ZhuSkelton1992] Table 3: modal costs of 20 modes in the first round of
 * weights and the third. The first eight are the same, and modes 3 and 7 change
 * places among them. Spearman's and Kendall's from the table by SciPy 1.10.
 */
static void the_published_modal_costs_agree_as_the_paper_says(void **state)
{
    static const int64_t mode[2][20] = {
        {2,  1,  14, 13, 4,  8,  3,  7,  6,  11,
         12, 10, 16, 20, 27, 28, 15, 19, 24, 23},
        {2,  1,  14, 13, 4,  8,  7,  3,  6,  16,
         11, 10, 20, 12, 28, 27, 19, 15, 23, 24}};
    static const double cost[2][20] = {
        {6.6723e+1, 2.5040e+1, 4.2676e+0, 2.2173e+0, 4.7986e-1,
         2.0138e-1, 1.9129e-1, 1.7050e-1, 1.4221e-1, 8.7302e-2,
         7.9527e-2, 7.8317e-2, 5.2735e-2, 4.8844e-2, 3.3937e-2,
         3.2116e-2, 2.6763e-2, 2.5116e-2, 2.3742e-2, 2.3351e-2},
        {6.7071e+1, 2.3619e+1, 4.8554e+0, 2.6104e+0, 4.7182e-1,
         1.9765e-1, 1.8981e-1, 1.7689e-1, 9.9888e-2, 7.9285e-2,
         7.8692e-2, 7.5395e-2, 7.3416e-2, 7.3290e-2, 5.8980e-2,
         4.9655e-2, 3.8368e-2, 3.8337e-2, 3.4985e-2, 3.4597e-2}};
    ritz_ranking r[2] = {0};
    ritz_agreement g = {0};

    (void)state;
    for (int k = 0; k < 2; k++)
        assert_ok(make(20, cost[k], &r[k]));
    assert_ok(ritz_rankings_agree(&r[0], mode[0], &r[1], mode[1], 8, &g));
    assert_int_equal(g.common, 20);
    assert_near(g.top_share, 1.0, 0.0);
    assert_near(g.spearman, 0.97894736842105268, 1e-14);
    assert_near(g.kendall, 0.90526315789473677, 1e-14);
    ritz_agreement_free(&g);
    /* by seven, mode 3 leaves and mode 7 enters */
    assert_ok(ritz_rankings_agree(&r[0], mode[0], &r[1], mode[1], 7, &g));
    assert_int_equal(g.num_left, 1);
    assert_int_equal(g.left[0], 3);
    assert_int_equal(g.entered[0], 7);
    ritz_agreement_free(&g);
    ritz_ranking_free(&r[0]);
    ritz_ranking_free(&r[1]);
}

static void clusters_are_cut_by_no_depth(void **state)
{
    const double one[] = {5, 5, 1, 0.5};
    const double two[] = {3, 3, 6, 0.5};
    RITZ_OWN(ritz_ranking) a = {0}, b = {0};
    RITZ_OWN(ritz_agreement) g = {0};

    (void)state;
    assert_ok(make(4, one, &a));
    assert_ok(make(4, two, &b));
    a.cluster[1] = b.cluster[1] = 0;
    assert_ok(ritz_rankings_agree(&a, NULL, &b, NULL, 2, &g));
    /* the first two of a are the cluster; of b, the third and all of it */
    assert_near(g.top_share, 2.0 / 3.0, 1e-15);
    assert_int_equal(g.num_left, 0);
    assert_int_equal(g.num_entered, 1);
    assert_int_equal(g.entered[0], 2);
}

static void what_has_nothing_in_common_is_refused(void **state)
{
    const double value[] = {2, 1};
    const int64_t here[] = {0, 1}, there[] = {2, 3}, half[] = {1, 4};
    RITZ_OWN(ritz_ranking) a = {0};
    RITZ_OWN(ritz_agreement) g = {0};

    (void)state;
    assert_ok(make(2, value, &a));
    assert_fails(ritz_rankings_agree(&a, here, &a, there, 1, &g),
                 RITZ_ERR_ARGUMENT, "no mode in common");
    assert_fails(ritz_rankings_agree(&a, here, &a, here, 0, &g),
                 RITZ_ERR_ARGUMENT, "at least the first mode");
    assert_ok(ritz_rankings_agree(&a, here, &a, half, 1, &g));
    assert_int_equal(g.common, 1);
    assert_int_equal(g.alone[0], 1);
    assert_int_equal(g.alone[1], 1);
    assert_true(isnan(g.spearman)); /* one place has no order */
}

/* --- over configurations
   ---------------------------------------------------- */

static void the_largest_value_says_where_it_stands(void **state)
{
    const double one[] = {5, -1, 2}, two[] = {1, 7, 2.5};
    ritz_ranking item[2] = {0};
    int64_t track_a[] = {0, 1, 2}, track_b[] = {1, 0, 4};
    int64_t *track[] = {track_a, track_b};
    ritz_rankings all = {.count = 2, .item = item};
    ritz_ranking largest = {0};
    int64_t *where = NULL, *number = NULL;

    (void)state;
    assert_ok(make(3, one, &item[0]));
    assert_ok(make(3, two, &item[1]));
    assert_ok(ritz_rankings_largest(&all, &largest, &where, &number));
    assert_int_equal(largest.count, 3);
    assert_near(largest.value[1], 7.0, 0.0);
    assert_int_equal(where[0], 0);
    assert_int_equal(where[1], 1);
    assert_int_equal(largest.order[0], 1);
    ritz_ranking_free(&largest);
    free(where);
    free(number);
    /* followed: 0 is 5 and 7, 1 is -1 and 1, 2 is 2, 3 is nowhere, 4 is 2.5 */
    all.track = track;
    assert_ok(ritz_rankings_largest(&all, &largest, &where, &number));
    assert_int_equal(largest.count, 4);
    assert_near(largest.value[0], 7.0, 0.0);
    assert_near(largest.value[1], -1.0, 0.0);
    assert_int_equal(where[0], 1);
    assert_int_equal(where[1], 0);
    assert_int_equal(number[3], 4);
    ritz_ranking_free(&largest);
    free(where);
    free(number);
    all.track = NULL;
    item[1].count = 2;
    assert_fails(ritz_rankings_largest(&all, &largest, &where, &number),
                 RITZ_ERR_ARGUMENT, "only tracks say which is which");
    item[1].count = 3;
    strcpy(item[1].by, "h2");
    assert_fails(ritz_rankings_largest(&all, &largest, &where, &number),
                 RITZ_ERR_ARGUMENT, "by 'hankel' and by 'h2'");
    ritz_ranking_free(&item[0]);
    ritz_ranking_free(&item[1]);
}

static void several_rankings_come_back_from_a_file(void **state)
{
    const double one[] = {5, -1, 2}, two[] = {1, 7};
    const ritz_stamp stamp = {.command = "test"};
    char path[] = "/tmp/ritz-rankings-XXXXXX";
    int64_t track_a[] = {0, 1, 2}, track_b[] = {1, 3};
    int64_t *track[] = {track_a, track_b};
    ritz_ranking item[2] = {0};
    const ritz_rankings all = {.count = 2, .item = item, .track = track};
    RITZ_OWN(ritz_rankings) back = {0};
    int file = mkstemp(path);

    (void)state;
    assert_true(file >= 0);
    assert_ok(make(3, one, &item[0]));
    assert_ok(make(2, two, &item[1]));
    strcpy(item[1].at, "clock=60");
    assert_ok(ritz_container_write_rankings(path, &all, &stamp));
    assert_ok(ritz_container_read_rankings(path, &back));
    assert_int_equal(back.count, 2);
    assert_int_equal(back.item[0].count, 3);
    assert_string_equal(back.item[1].at, "clock=60");
    assert_near(back.item[1].value[1], 7.0, 0.0);
    assert_int_equal(back.track[1][1], 3);
    ritz_ranking_free(&item[0]);
    ritz_ranking_free(&item[1]);
    unlink(path);
    close(file);
}

/* --- weights
   ---------------------------------------------------------------- */

/* Modes far apart, each seen by one output alone. */
static const double omega[] = {1.0, 3.0, 10.0};
static const double zeta[] = {0.01, 0.01, 0.01};

static ritz_rank_request request_of(double *b, double *c, double *none,
                                    int64_t outputs)
{
    static double w[3], z[3];

    memcpy(w, omega, sizeof w);
    memcpy(z, zeta, sizeof z);
    return (ritz_rank_request){.modal = {3,
                                         w,
                                         z,
                                         {3, 1, b},
                                         {outputs, 3, c},
                                         {outputs, 3, none},
                                         0,
                                         {0},
                                         {0}}};
}

/*
 * Two outputs, each with a mode of one cost, and one to keep: whichever is
 * kept, the other output is missed and gains weight, so the next round keeps
 * the other, for ever.
 */
static void weights_that_oscillate_are_found_out(void **state)
{
    /* costs b^2 c^2 / (4 zeta w^3): 25, 25 and far less, of outputs 1, 2, 2 */
    double b[] = {1.0, 1.0, 0.01};
    double c[] = {1.0, 0.0, 0.0, 5.19615242270663188, 0.0, 1.0};
    double none[6] = {0.0};
    const ritz_rank_request request = request_of(b, c, none, 2);
    RITZ_OWN(ritz_reweighing) found = {0};

    (void)state;
    assert_ok(ritz_reweigh(&request, 1, &found));
    assert_int_equal(found.period, 2);
    assert_int_equal(found.num_kept, 1);
    assert_int_equal(found.num_other, 1);
    assert_int_equal(found.kept[0] + found.other[0], 1);
    assert_near(found.cost[0], 25.0, 1e-9);
    assert_near(found.weight[0] + found.weight[1], 2.0, 1e-12);
}

/* Either output has a mode of its own, and misses some of the third. */
static void weights_settle_on_what_is_missed(void **state)
{
    double b[] = {1.0, 1.0, 1.0};
    double c[] = {1.0, 0.0, 0.0, 5.0, 1.0, 1.5};
    double none[6] = {0.0};
    const ritz_rank_request request = request_of(b, c, none, 2);
    RITZ_OWN(ritz_reweighing) found = {0};
    double sum = 0.0, missed = 0.0;

    (void)state;
    assert_ok(ritz_reweigh(&request, 2, &found));
    assert_int_equal(found.period, 1);
    assert_int_equal(found.num_kept, 2);
    assert_int_equal(found.num_other, 0);
    for (int i = 0; i < 2; i++) {
        sum += found.weight[i];
        missed += found.missed[i];
        assert_true(found.missed[i] <= found.cost[i]);
    }
    assert_near(sum, 2.0, 1e-12);
    /* at rest q_i = p d_i / sum d; what is left of a = 1/2 to the power of the
     * rounds is below 1e-9 */
    for (int i = 0; i < 2; i++)
        assert_near(found.weight[i], 2.0 * found.missed[i] / missed, 1e-8);
}

static void weights_for_nothing_are_refused(void **state)
{
    double b[] = {1.0, 1.0, 10.0};
    double c[] = {0.01, 1.0, 1.0, 0.0, 3.0, 0.0};
    double none[6] = {0.0};
    ritz_rank_request request = request_of(b, c, none, 2);
    ritz_reweighing found = {0};

    (void)state;
    assert_fails(ritz_reweigh(&request, 3, &found), RITZ_ERR_ARGUMENT,
                 "leave one out, of 3");
    assert_fails(ritz_reweigh(&request, 0, &found), RITZ_ERR_ARGUMENT,
                 "at least one mode");
    request.modal.C.nrow = 0;
    assert_fails(ritz_reweigh(&request, 1, &found), RITZ_ERR_ARGUMENT,
                 "no inputs and outputs to weigh modes by");
}

/* --- every allocation
   ------------------------------------------------------- */

static ritz_status all_once(void)
{
    const double one[] = {5, -1, 2}, two[] = {1, 7, 2.5};
    double b[] = {1.0, 1.0, 10.0};
    double c[] = {0.01, 1.0, 1.0, 0.0, 3.0, 0.0};
    double none[6] = {0.0};
    const ritz_rank_request request = request_of(b, c, none, 2);
    ritz_status status = RITZ_OK;
    ritz_ranking item[2] = {0}, largest = {0};
    const ritz_rankings all = {.count = 2, .item = item};
    int64_t *where = NULL, *number = NULL;
    RITZ_OWN(ritz_agreement) g = {0};
    RITZ_OWN(ritz_reweighing) found = {0};

    RITZ_TRY(make(3, one, &item[0]));
    RITZ_TRY(make(3, two, &item[1]));
    RITZ_TRY(ritz_rankings_agree(&item[0], NULL, &item[1], NULL, 2, &g));
    RITZ_TRY(ritz_rankings_largest(&all, &largest, &where, &number));
    RITZ_TRY(ritz_reweigh(&request, 2, &found));
done:
    ritz_ranking_free(&item[0]);
    ritz_ranking_free(&item[1]);
    ritz_ranking_free(&largest);
    free(where);
    free(number);
    return status;
}

static void comparisons_survive_every_allocation(void **state)
{
    (void)state;
    assert_survives_every_allocation(all_once());
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_ranking_agrees_with_itself_and_not_with_its_reverse),
    cmocka_unit_test(ties_share_their_place),
    cmocka_unit_test(the_published_modal_costs_agree_as_the_paper_says),
    cmocka_unit_test(clusters_are_cut_by_no_depth),
    cmocka_unit_test(what_has_nothing_in_common_is_refused),
    cmocka_unit_test(the_largest_value_says_where_it_stands),
    cmocka_unit_test(several_rankings_come_back_from_a_file),
    cmocka_unit_test(weights_that_oscillate_are_found_out),
    cmocka_unit_test(weights_settle_on_what_is_missed),
    cmocka_unit_test(weights_for_nothing_are_refused),
    cmocka_unit_test(comparisons_survive_every_allocation),
};

TEST_MODULE(agreement, tests, NULL, NULL)
