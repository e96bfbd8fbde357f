#include "base/team.h"
#include "testing.h"

#include <signal.h>
#include <stdatomic.h>
#include <sys/wait.h>
#include <unistd.h>

enum { MOST = 4, TASKS = 2000 };

typedef struct tally {
    int64_t done[MOST]; /* steps of each thread */
    int wrong;          /* steps of others that thread 0 found missing */
} tally;

/* Every thread counts its steps; behind each meeting all counts are equal. */
static void count_together(int thread, int threads, void *task)
{
    tally *t = task;
    const int64_t before = t->done[thread];

    for (int64_t step = 1; step <= 3; step++) {
        t->done[thread]++;
        ritz_team_meet(threads);
        for (int k = 0; k < threads; k++)
            if (t->done[k] != before + step && thread == 0)
                t->wrong++;
        ritz_team_meet(threads);
    }
}

static void all_threads_work_and_meet(void **state)
{
    (void)state;
    for (int limit = 1; limit <= MOST; limit++) {
        tally t = {{0}, 0};
        int threads = 0;

        ritz_set_threads(limit);
        threads = ritz_team_ready(MOST);
        assert_true(threads >= 1 && threads <= limit);
        for (int k = 0; k < TASKS; k++)
            ritz_team_run(threads, count_together, &t);
        for (int k = 0; k < threads; k++)
            assert_int_equal(t.done[k], 3 * TASKS);
        for (int k = threads; k < MOST; k++)
            assert_int_equal(t.done[k], 0);
        assert_int_equal(t.wrong, 0);
    }
    ritz_set_threads(1);
}

static void a_task_may_use_fewer_threads_than_were_started(void **state)
{
    tally t = {{0}, 0};

    (void)state;
    ritz_set_threads(3);
    assert_true(ritz_team_ready(2) <= 2);
    assert_int_equal(ritz_team_ready(0), 1);
    ritz_team_run(ritz_team_ready(3), count_together, &t);
    ritz_team_run(ritz_team_ready(2), count_together, &t);
    assert_int_equal(t.done[0], 6);
    assert_int_equal(t.wrong, 0);
    ritz_set_threads(-7);
    assert_int_equal(ritz_team_ready(MOST), 1);
    ritz_set_threads(1);
}

/* Null where no library that is linked uses OpenMP. */
[[gnu::weak]] int omp_get_max_threads(void);

static void ask_openmp(int thread, int threads, void *task)
{
    int *most = task;

    (void)threads;
    most[thread] = omp_get_max_threads();
}

/* A BLAS in a thread of the team would otherwise start as many as there are
   cores, each time for each of them. */
static void openmp_starts_no_threads_in_the_team(void **state)
{
    int most[2] = {0, 1};

    (void)state;
    if (!omp_get_max_threads)
        skip();
    ritz_set_threads(2);
    ritz_team_run(ritz_team_ready(2), ask_openmp, most);
    assert_int_equal(most[1], 1);
    ritz_set_threads(1);
}

/* The child of a fork has the caller's thread alone, and starts others. */
static void a_forked_process_starts_threads_of_its_own(void **state)
{
    tally t = {{0}, 0};
    int status = 0;
    int threads = 0;
    pid_t child = 0;

    (void)state;
    ritz_set_threads(2);
    threads = ritz_team_ready(2);
    ritz_team_run(threads, count_together, &t);
    child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        alarm(20);
        ritz_team_run(threads, count_together, &t);
        _exit(t.wrong == 0 && t.done[threads - 1] == 6 ? 0 : 1);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    ritz_team_run(threads, count_together, &t);
    assert_int_equal(t.done[0], 6);
    ritz_set_threads(1);
}

static void parts_cover_every_item_once(void **state)
{
    (void)state;
    for (int threads = 1; threads < 9; threads++)
        for (int64_t count = 0; count < 20; count++) {
            int64_t end = 0;

            for (int k = 0; k < threads; k++) {
                int64_t from = 0;
                int64_t to = 0;

                ritz_team_part(count, k, threads, &from, &to);
                assert_int_equal(from, end);
                assert_true(to >= from);
                end = to;
            }
            assert_int_equal(end, count);
        }
}

enum { ITEMS = 1000 };

/* How often each item was worked on, and by which thread if that is known. */
typedef struct items {
    _Atomic int done[ITEMS];
    int thread[ITEMS];
} items;

static void mark_range(int thread, int64_t from, int64_t to, void *task)
{
    items *all = task;

    for (int64_t k = from; k < to; k++) {
        all->done[k]++;
        all->thread[k] = thread;
    }
}

static void mark_item(int64_t k, void *task)
{
    items *all = task;

    all->done[k]++;
}

static void every_item_is_worked_on_once(void **state)
{
    (void)state;
    for (int limit = 1; limit <= MOST; limit++) {
        items all = {{0}, {0}};
        int threads = 0;

        ritz_set_threads(limit);
        threads = ritz_team_ready(MOST);
        ritz_team_over(threads, ITEMS, mark_range, &all);
        for (int64_t k = 0; k < ITEMS; k++) {
            int64_t from = 0;
            int64_t to = 0;

            ritz_team_part(ITEMS, all.thread[k], threads, &from, &to);
            assert_true(k >= from && k < to);
            assert_int_equal(all.done[k], 1);
        }
        ritz_team_each(threads, ITEMS, mark_item, &all);
        for (int64_t k = 0; k < ITEMS; k++)
            assert_int_equal(all.done[k], 2);
    }
    ritz_set_threads(1);
}

static void ask_for_more(int64_t k, void *task)
{
    int *ready = task;

    ready[k] = ritz_team_ready(MOST);
}

/* So that what a task calls may ask for threads too. */
static void within_a_task_one_thread_is_ready(void **state)
{
    int ready[MOST * MOST] = {0};

    (void)state;
    ritz_set_threads(MOST);
    ritz_team_each(ritz_team_ready(MOST), MOST * MOST, ask_for_more, ready);
    for (int k = 0; k < MOST * MOST; k++)
        assert_int_equal(ready[k], 1);
    assert_int_equal(ritz_team_ready(MOST), MOST);
    ritz_set_threads(1);
}

static void a_file_has_four_shares_for_each_thread(void **state)
{
    (void)state;
    assert_int_equal(ritz_team_shares(1), 4);
    assert_int_equal(ritz_team_shares(16), 64);
    assert_int_equal(ritz_team_shares(17), RITZ_TEAM_SHARES);
}

static void *read_signal_mask(void *argument)
{
    pthread_sigmask(SIG_SETMASK, NULL, argument);
    return NULL;
}

static void a_thread_outside_the_team_blocks_signals(void **state)
{
    sigset_t before, inside, after;
    pthread_t id;

    (void)state;
    pthread_sigmask(SIG_SETMASK, NULL, &before);
    assert_true(ritz_team_start(read_signal_mask, &inside, &id));
    assert_int_equal(pthread_join(id, NULL), 0);
    pthread_sigmask(SIG_SETMASK, NULL, &after);
    assert_int_equal(sigismember(&inside, SIGINT), 1);
    assert_int_equal(sigismember(&inside, SIGTERM), 1);
    assert_int_equal(sigismember(&after, SIGINT), sigismember(&before, SIGINT));
}

typedef struct failing_items {
    _Atomic int done;   /* of the five items before the first failure */
    _Atomic bool later; /* item 9 has begun */
} failing_items;

enum { PATIENCE = 1000000 }; /* looks; a single thread waits in vain */

/* Items 5 and 9 of 20 fail. Item 5 ends after item 9 where it can. */
static ritz_status fail_twice(int64_t k, void *task)
{
    failing_items *f = task;

    atomic_fetch_add(&f->done, k < 5);
    if (k == 9)
        atomic_store(&f->later, true);
    for (int i = 0; k == 5 && i < PATIENCE && !atomic_load(&f->later); i++)
        continue;
    return k == 5 || k == 9
               ? ritz_fail(RITZ_ERR_SINGULAR, "item %d fails", (int)k)
               : RITZ_OK;
}

static void the_first_failure_is_reported_by_its_number(void **state)
{
    (void)state;
    for (int limit = 1; limit <= MOST; limit++) {
        failing_items all = {0}, five = {0};

        ritz_set_threads(limit);
        assert_int_equal(
            ritz_team_try(ritz_team_ready(MOST), 20, fail_twice, &all),
            RITZ_ERR_SINGULAR);
        assert_string_equal(ritz_error_message(), "item 5 fails");
        assert_int_equal(all.done, 5); /* all before it were worked on */
        assert_ok(ritz_team_try(ritz_team_ready(MOST), 5, fail_twice, &five));
        assert_int_equal(five.done, 5);
    }
    ritz_set_threads(1);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(all_threads_work_and_meet),
    cmocka_unit_test(a_task_may_use_fewer_threads_than_were_started),
    cmocka_unit_test(openmp_starts_no_threads_in_the_team),
    cmocka_unit_test(a_forked_process_starts_threads_of_its_own),
    cmocka_unit_test(parts_cover_every_item_once),
    cmocka_unit_test(every_item_is_worked_on_once),
    cmocka_unit_test(within_a_task_one_thread_is_ready),
    cmocka_unit_test(the_first_failure_is_reported_by_its_number),
    cmocka_unit_test(a_file_has_four_shares_for_each_thread),
    cmocka_unit_test(a_thread_outside_the_team_blocks_signals),
};

TEST_MODULE(team, tests, NULL, NULL)
