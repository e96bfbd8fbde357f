/*
 * bench_pencils [COUNT [SEARCHES]] - run block Lanczos, and then spectrum
 * slices, on COUNT random pencils (10000) of 20 to 150 rows, and
 * ritz_eigen_sparse() on SEARCHES others (60) of 650 to 899 rows. Prints a
 * table by kind of pencil: modes missed, wrong counts, largest errors; and a
 * line for each pencil with a fault, with its seed.
 */
#include "judged.h"
#include "testing.h"

#include <stdio.h>
#include <stdlib.h>

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

/* ritz_eigen_sparse() on a pencil of 650 to 899 rows. */
static void judge_large(uint64_t seed, pencil_verdict *out)
{
    judge_search(seed, 650 + (int64_t)(seed * 37 % 250), out);
}

static void run(int64_t count, void (*judge)(uint64_t, pencil_verdict *))
{
    sum_of_kind sums[PENCIL_KINDS] = {0};

    for (int64_t seed = 0; seed < count; seed++) {
        pencil_verdict v;

        judge((uint64_t)seed, &v);
        add_verdict(&v, &sums[v.kind]);
        if (v.missed || v.false_mode || v.wrong_counts || v.slow ||
            v.orthogonal > 1e-11)
            printf("  seed %ld, %s, %ld rows, %ld of %ld%s%s%s%s, value %.1e, "
                   "residual %.1e, orthogonal %.1e, wrong counts %ld\n",
                   (long)seed, pencil_names[v.kind], (long)v.n, (long)v.found,
                   (long)v.asked, v.missed ? ", missed" : "",
                   v.caught ? ", caught" : "", v.false_mode ? ", false" : "",
                   v.slow ? ", slow" : "", v.value, v.residual, v.orthogonal,
                   (long)v.wrong_counts);
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
    run(argc > 2 ? strtol(argv[2], NULL, 10) : 60, judge_large);
    return 0;
}
