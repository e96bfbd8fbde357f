#include "fixtures/judged.h"
#include "testing.h"

enum { PENCILS = 225, SEARCHES = 2 };

static void check_verdict(uint64_t seed, const pencil_verdict *v)
{
    const bool wide = v->kind == PENCIL_SPREAD || v->kind == PENCIL_MIXED;

    if (v->refused || (v->slow && !wide) || v->false_mode || v->wrong_counts ||
        (v->missed && !v->caught) || v->orthogonal > 1e-11)
        fail_msg("seed %ju, %s, %jd rows, %jd of %jd modes: "
                 "%s%s%s%s %jd wrong counts, orthogonal to %.1e",
                 (uintmax_t)seed, pencil_names[v->kind], (intmax_t)v->n,
                 (intmax_t)v->found, (intmax_t)v->asked,
                 v->refused ? "refused," : "", v->slow ? "slow," : "",
                 v->false_mode ? "false," : "", v->missed ? "missed," : "",
                 (intmax_t)v->wrong_counts, v->orthogonal);
}

/* bench_pencils runs ten thousand of them. A mode may be missed if a count of
   modes shows it. */
static void no_mode_is_missed_without_the_count_showing_it(void **state)
{
    int64_t found = 0;
    int64_t counts = 0;

    (void)state;
    for (uint64_t seed = 0; seed < PENCILS; seed++) {
        pencil_verdict v;

        judge_lanczos(seed, &v);
        check_verdict(seed, &v);
        found += v.found;
        counts += v.counts;
    }
    assert_true(found > 10 * PENCILS);
    assert_true(counts > PENCILS);
}

/*
 * Slices here have so few eigenvalues that some clusters are larger than a
 * slice. For these kinds of pencils slices may give up (a search then goes on
 * with one shift), but what they return must be right.
 */
static void slices_lose_no_modes_of_random_pencils(void **state)
{
    int64_t found = 0;

    (void)state;
    for (uint64_t seed = 0; seed < PENCILS; seed++) {
        pencil_verdict v;

        judge_slices(seed, &v);
        v.slow = v.slow && v.kind != PENCIL_EQUAL && v.kind != PENCIL_NEAR;
        check_verdict(seed, &v);
        found += v.found;
    }
    assert_true(found > 10 * PENCILS);
}

/* A search for more modes than exist is exhausted; nothing else may fail. */
static void substructures_lose_no_modes_of_random_pencils(void **state)
{
    int64_t found = 0;

    (void)state;
    for (uint64_t seed = 0; seed < PENCILS; seed++) {
        pencil_verdict v;

        judge_amls(seed, &v);
        check_verdict(seed, &v);
        found += v.found;
    }
    assert_true(found > 10 * PENCILS);
}

/* With these seeds a block has nearly dependent vectors, or the last vectors
   move no mass beyond rounding errors. Earlier code returned vectors that were
   not orthogonal for some of them. */
static void nearly_dependent_blocks_stay_orthogonal(void **state)
{
    const uint64_t seeds[] = {550, 667, 755, 1250, 2195, 2909, 5581, 7957};

    (void)state;
    for (size_t k = 0; k < sizeof seeds / sizeof *seeds; k++) {
        pencil_verdict v;

        judge_lanczos(seeds[k], &v);
        check_verdict(seeds[k], &v);
    }
}

static void searches_find_every_mode(void **state)
{
    const uint64_t seeds[SEARCHES] = {PENCIL_EQUAL, PENCIL_FREE};

    (void)state;
    for (int k = 0; k < SEARCHES; k++) {
        pencil_verdict v;

        judge_search(seeds[k], 640, &v);
        check_verdict(seeds[k], &v);
        assert_false(v.missed || v.slow);
        assert_true(v.found >= v.asked);
        assert_near(v.residual, 0.0, 1e-11); /* RITZ_EIGEN_RESIDUAL */
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(no_mode_is_missed_without_the_count_showing_it),
    cmocka_unit_test(slices_lose_no_modes_of_random_pencils),
    cmocka_unit_test(substructures_lose_no_modes_of_random_pencils),
    cmocka_unit_test(nearly_dependent_blocks_stay_orthogonal),
    cmocka_unit_test(searches_find_every_mode),
};

TEST_MODULE(random_pencils, tests, NULL, NULL)
