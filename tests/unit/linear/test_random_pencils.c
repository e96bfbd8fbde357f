#include "fixtures/judged.h"
#include "testing.h"

#include <string.h>

/* Rounding is that of the other builds; sanitizers are to see every line. */
#ifdef RITZ_SANITIZE
enum { PENCILS = 90, SEARCHES = 72 };
#else
enum { PENCILS = 225, SEARCHES = 216 };
#endif

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

/* What every search must hold to; exact ones have small residuals. */
static void check_search(uint64_t seed, const pencil_search *how)
{
    pencil_verdict v;

    judge_search(seed, how, &v);
    check_verdict(seed, &v);
    assert_false(v.missed || v.slow);
    if (!strstr(v.engine, "within"))
        assert_near(v.residual, 0.0, 1e-11); /* RITZ_EIGEN_RESIDUAL */
}

static void searches_find_every_mode(void **state)
{
    (void)state;
    check_search(PENCIL_EQUAL, &(pencil_search){.n = 640});
    check_search(PENCIL_FREE, &(pencil_search){.n = 640});
}

/* Every engine has pencils of every kind; bench_pencils runs ten thousand. */
static void searches_by_every_engine_find_every_mode(void **state)
{
    static const pencil_search way[] = {
        {.engine = RITZ_EIGEN_LANCZOS},
        {.engine = RITZ_EIGEN_SLICES, .by_frequency = true},
        {.engine = RITZ_EIGEN_AMLS},
        {.engine = RITZ_EIGEN_ARPACK, .by_frequency = true},
        {.engine = RITZ_EIGEN_AMLS, .by_frequency = true},
        {.engine = RITZ_EIGEN_LANCZOS, .accuracy = 1e-2, .by_frequency = true},
        {.engine = RITZ_EIGEN_SLICES},
        {.engine = RITZ_EIGEN_LANCZOS, .by_frequency = true},
    };
    enum { WAYS = sizeof way / sizeof *way };

    (void)state;
    for (uint64_t seed = 0; seed < SEARCHES; seed++)
        check_search(seed, &way[seed / PENCIL_KINDS % WAYS]);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(no_mode_is_missed_without_the_count_showing_it),
    cmocka_unit_test(slices_lose_no_modes_of_random_pencils),
    cmocka_unit_test(substructures_lose_no_modes_of_random_pencils),
    cmocka_unit_test(nearly_dependent_blocks_stay_orthogonal),
    cmocka_unit_test(searches_find_every_mode),
    cmocka_unit_test(searches_by_every_engine_find_every_mode),
};

TEST_MODULE(random_pencils, tests, NULL, NULL)
