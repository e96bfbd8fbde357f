/*
 * bench_pencils [COUNT [SEARCHES]] - run block Lanczos, and then spectrum
 * slices, without a count of modes on COUNT random pencils (10000) of 20 to 150
 * rows; whole searches by every engine on COUNT others of 60 to 200 rows; and
 * ritz_eigen_sparse() on SEARCHES (60) of 650 to 899 rows. Prints a table by
 * kind of pencil: modes missed, wrong counts, largest errors; a line for each
 * pencil with a fault, with its seed; and how many searches ended with each
 * engine.
 */
#include "judged.h"
#include "testing.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct sum_of_kind {
    int64_t pencils, refused, exhausted, slow, missed, caught, spurious;
    int64_t counts, wrong;
    double value, residual, orthogonal;
} sum_of_kind;

static void add_verdict(const pencil_verdict *v, sum_of_kind *s)
{
    s->pencils++;
    s->refused += v->refused;
    s->exhausted += v->exhausted;
    s->slow += v->slow;
    s->missed += v->missed;
    s->caught += v->caught;
    s->spurious += v->false_mode;
    s->counts += v->counts;
    s->wrong += v->wrong_counts;
    s->value = fmax(s->value, v->value);
    s->residual = fmax(s->residual, v->residual);
    s->orthogonal = fmax(s->orthogonal, v->orthogonal);
}

static void print_sum(const char *name, const sum_of_kind *s)
{
    printf("%-15s %7ld %7ld %9ld %5ld %6ld %6ld %8ld %7ld %5ld %8.1e %8.1e "
           "%8.1e\n",
           name, (long)s->pencils, (long)s->refused, (long)s->exhausted,
           (long)s->slow, (long)s->missed, (long)s->caught, (long)s->spurious,
           (long)s->counts, (long)s->wrong, s->value, s->residual,
           s->orthogonal);
}

/* The searches, each of every WAYS-th pencil of a kind. */
static const struct {
    const char *name;
    pencil_search how;
} ways[] = {
    {"lanczos", {.engine = RITZ_EIGEN_LANCZOS}},
    {"lanczos, Hz", {.engine = RITZ_EIGEN_LANCZOS, .by_frequency = true}},
    {"slices", {.engine = RITZ_EIGEN_SLICES}},
    {"slices, Hz", {.engine = RITZ_EIGEN_SLICES, .by_frequency = true}},
    {"amls", {.engine = RITZ_EIGEN_AMLS}},
    {"amls, Hz", {.engine = RITZ_EIGEN_AMLS, .by_frequency = true}},
    {"arpack", {.engine = RITZ_EIGEN_ARPACK}},
    {"arpack, Hz", {.engine = RITZ_EIGEN_ARPACK, .by_frequency = true}},
    {"1e-2", {.accuracy = 1e-2}},
    {"1e-2, Hz", {.accuracy = 1e-2, .by_frequency = true}},
    {"amls 1e-2, Hz",
     {.engine = RITZ_EIGEN_AMLS, .accuracy = 1e-2, .by_frequency = true}},
    {"1e-6", {.accuracy = 1e-6}},
};
enum { WAYS = sizeof ways / sizeof *ways };

/* Searches, and what became of them: by which engine the modes were found. */
typedef struct sum_of_way {
    int64_t searches, failed, missed;
    int64_t by_blocks, by_slices, by_substructures, by_arpack, by_lapack;
} sum_of_way;

static sum_of_way searched[WAYS];

static void add_engine(const pencil_verdict *v, sum_of_way *s)
{
    s->searches++;
    s->failed += v->slow || v->refused;
    s->missed += v->missed || v->false_mode;
    s->by_blocks += strstr(v->engine, "Lanczos") != NULL;
    s->by_slices += strstr(v->engine, "slices") != NULL;
    s->by_substructures += strstr(v->engine, "substructures") != NULL;
    s->by_arpack += strstr(v->engine, "ARPACK") != NULL;
    s->by_lapack += strstr(v->engine, "LAPACK") != NULL;
}

static void judge_way(uint64_t seed, pencil_verdict *out)
{
    const uint64_t way = seed / PENCIL_KINDS % WAYS;

    judge_search(seed, &ways[way].how, out);
    add_engine(out, &searched[way]);
}

/* ritz_eigen_sparse() on a pencil of 650 to 899 rows. */
static void judge_large(uint64_t seed, pencil_verdict *out)
{
    judge_search(seed, &(pencil_search){.n = 650 + (int64_t)(seed * 37 % 250)},
                 out);
}

static void print_ways(void)
{
    printf("%-15s %8s %6s %6s %7s %6s %13s %6s %6s\n", "search", "pencils",
           "failed", "missed", "lanczos", "slices", "substructures", "arpack",
           "lapack");
    for (int w = 0; w < WAYS; w++) {
        const sum_of_way *s = &searched[w];

        printf("%-15s %8ld %6ld %6ld %7ld %6ld %13ld %6ld %6ld\n", ways[w].name,
               (long)s->searches, (long)s->failed, (long)s->missed,
               (long)s->by_blocks, (long)s->by_slices,
               (long)s->by_substructures, (long)s->by_arpack,
               (long)s->by_lapack);
    }
    (void)fflush(stdout);
}

static bool is_faulty(const pencil_verdict *v)
{
    return v->missed || v->false_mode || v->wrong_counts || v->slow ||
           v->refused || v->orthogonal > 1e-11;
}

static void print_fault(int64_t seed, const pencil_verdict *v)
{
    printf("  seed %ld, %s, %ld rows, %ld of %ld%s%s%s%s%s, value %.1e, "
           "residual %.1e, orthogonal %.1e, wrong counts %ld, %s%s\n",
           (long)seed, pencil_names[v->kind], (long)v->n, (long)v->found,
           (long)v->asked, v->missed ? ", missed" : "",
           v->caught ? ", caught" : "", v->false_mode ? ", false" : "",
           v->slow ? ", slow" : "", v->refused ? ", refused" : "", v->value,
           v->residual, v->orthogonal, (long)v->wrong_counts, v->engine,
           v->sentence);
}

static void run(int64_t count, void (*judge)(uint64_t, pencil_verdict *))
{
    sum_of_kind sums[PENCIL_KINDS] = {0};

    for (int64_t seed = 0; seed < count; seed++) {
        pencil_verdict v;

        judge((uint64_t)seed, &v);
        add_verdict(&v, &sums[v.kind]);
        if (is_faulty(&v))
            print_fault(seed, &v);
    }
    printf("%-15s %7s %7s %9s %5s %6s %6s %8s %7s %5s %8s %8s %8s\n", "kind",
           "pencils", "refused", "exhausted", "slow", "missed", "caught",
           "spurious", "counts", "wrong", "value", "residual", "X'MX - I");
    for (int k = 0; k < PENCIL_KINDS; k++)
        print_sum(pencil_names[k], &sums[k]);
    (void)fflush(stdout);
}

int main(int argc, char **argv)
{
    const int64_t count = argc > 1 ? strtol(argv[1], NULL, 10) : 10000;

    run(count, judge_lanczos);
    run(count, judge_slices);
    run(count, judge_way);
    print_ways();
    run(argc > 2 ? strtol(argv[2], NULL, 10) : 60, judge_large);
    return 0;
}
