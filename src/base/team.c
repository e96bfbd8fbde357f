#include "base/team.h"

#include "base/crowd.h"
#include "base/text.h"

#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <time.h>

/* Null where no library that is linked uses OpenMP. */
[[gnu::weak]] void omp_set_num_threads(int threads);

enum {
    MOST = 64,       /* threads */
    SPINS = 64,      /* pauses between two looks at the clock */
    AWAKE = 200,     /* microseconds before sleep: to wake a thread takes as
                        long on a virtual machine */
    CROWDED = 20000, /* microseconds for which no thread spins once cores were
                         found crowded */
    SHARES_EACH = 4, /* of a file for each thread: some take longer */
};

/* A counter that threads wait on; it only grows. */
typedef struct signal_count {
    _Atomic uint32_t count;
    _Atomic uint32_t sleepers;
    pthread_mutex_t lock;
    pthread_cond_t changed;
} signal_count;

#define SIGNAL_COUNT                                                           \
    {                                                                          \
        .lock = PTHREAD_MUTEX_INITIALIZER, .changed = PTHREAD_COND_INITIALIZER \
    }

static struct {
    pthread_mutex_t busy; /* held by the caller whose task runs */
    _Atomic int limit;
    int started;           /* threads, without the callers' own */
    uint32_t before[MOST]; /* count of tasks when each was started */
    bool refused;          /* the system starts no more */
    signal_count tasks, ends, meetings;
    _Atomic int working;     /* started threads that have not ended the task */
    _Atomic int arrived;     /* threads that wait in ritz_team_meet() */
    _Atomic int64_t crowded; /* microseconds, until when no thread spins */
    int threads;             /* that work on the task */
    ritz_team_work *work;
    void *task;
} team = {
    .busy = PTHREAD_MUTEX_INITIALIZER,
    .limit = 1,
    .tasks = SIGNAL_COUNT,
    .ends = SIGNAL_COUNT,
    .meetings = SIGNAL_COUNT,
};

static void pause_thread(void)
{
#if defined __x86_64__
    __builtin_ia32_pause();
#endif
}

static int64_t read_microseconds(void)
{
    struct timespec now = {0};

    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000 + now.tv_nsec / 1000;
}

/*
 * Whether the count differs from @p seen within AWAKE.
 *
 * A thread of the team that does not come within that time may have no core,
 * because other programs have it. A thread that spins then uses up the time that
 * the system allows this program, and is stopped itself when it has work; one
 * that sleeps is given a core at once when it is woken. With a program on one of
 * two cores, 50 modes of a solid of 55,000 dofs took three times as long while
 * threads spun.
 */
static bool spin_for_change(const signal_count *s, uint32_t seen)
{
    const int64_t start = read_microseconds();

    if (start < atomic_load(&team.crowded))
        return atomic_load(&s->count) != seen;
    do {
        for (int k = 0; k < SPINS; k++) {
            if (atomic_load(&s->count) != seen)
                return true;
            pause_thread();
        }
    } while (read_microseconds() - start < AWAKE);
    /* a thread that waits for a task waits for no other thread's core */
    if (s != &team.tasks && ritz_cores_crowded(0))
        atomic_store(&team.crowded, start + CROWDED);
    return false;
}

/* Wait until the count differs from @p seen. */
static void await_change(signal_count *s, uint32_t seen)
{
    if (spin_for_change(s, seen))
        return;
    pthread_mutex_lock(&s->lock);
    atomic_fetch_add(&s->sleepers, 1);
    while (atomic_load(&s->count) == seen)
        pthread_cond_wait(&s->changed, &s->lock);
    atomic_fetch_sub(&s->sleepers, 1);
    pthread_mutex_unlock(&s->lock);
}

/* A thread adds itself to the sleepers before it reads the count for the last
   time: so either it sees the new count, or it is among the sleepers here. */
static void announce_change(signal_count *s)
{
    atomic_fetch_add(&s->count, 1);
    if (atomic_load(&s->sleepers) == 0)
        return;
    pthread_mutex_lock(&s->lock);
    pthread_cond_broadcast(&s->changed);
    pthread_mutex_unlock(&s->lock);
}

void ritz_team_meet(int threads)
{
    const uint32_t seen = atomic_load(&team.meetings.count);

    if (threads == 1)
        return;
    if (atomic_fetch_add(&team.arrived, 1) + 1 < threads) {
        await_change(&team.meetings, seen);
        return;
    }
    atomic_store(&team.arrived, 0);
    announce_change(&team.meetings);
}

/* Whether the thread works on a task of the team. */
static _Thread_local bool works;

/* OpenMP keeps this number for each thread by itself: a BLAS that the caller has
   set to one thread would start several in the threads of the team, and its sums
   would depend on which thread works on an item. */
void ritz_team_member(void)
{
    if (omp_set_num_threads)
        omp_set_num_threads(1);
}

/* Run by each started thread: it does its part of every task. A task of fewer
   threads has no part for it. */
static void *serve_tasks(void *argument)
{
    const int thread = (int)(intptr_t)argument;

    works = true;
    ritz_team_member();
    for (uint32_t seen = team.before[thread];; seen++) {
        await_change(&team.tasks, seen);
        if (thread < team.threads)
            team.work(thread, team.threads, team.task);
        if (atomic_fetch_sub(&team.working, 1) == 1)
            announce_change(&team.ends);
    }
    return NULL;
}

static void forget_sleepers(signal_count *s)
{
    atomic_store(&s->sleepers, 0);
    pthread_mutex_init(&s->lock, NULL);
    pthread_cond_init(&s->changed, NULL);
}

/* In the child of a fork only the thread that called fork() exists. */
static void forget_threads(void)
{
    forget_sleepers(&team.tasks);
    forget_sleepers(&team.ends);
    forget_sleepers(&team.meetings);
    pthread_mutex_init(&team.busy, NULL);
    atomic_store(&team.arrived, 0);
    team.started = 0;
    team.refused = false;
}

static void watch_forks(void)
{
    /* if there is no memory for this, a child must not use the team */
    (void)pthread_atfork(NULL, NULL, forget_threads);
}

bool ritz_team_start(void *(*run)(void *argument), void *argument,
                     pthread_t *out)
{
    sigset_t all, before;
    bool started = false;

    sigfillset(&all);
    sigdelset(&all, SIGBUS); /* of the thread that reads a map: see mapped.h */
    if (pthread_sigmask(SIG_SETMASK, &all, &before) != 0)
        return false;
    started = pthread_create(out, NULL, run, argument) == 0;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return started;
}

/* Start thread @p thread of the team. */
static bool enlarge_team(int thread)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    void *number = (void *)(intptr_t)thread; // NOLINT
    pthread_t id;

    pthread_once(&once, watch_forks);
    team.before[thread] = atomic_load(&team.tasks.count);
    if (!ritz_team_start(serve_tasks, number, &id))
        return false;
    pthread_detach(id);
    return true;
}

void ritz_set_threads(int threads)
{
    threads = threads > 1 ? threads : 1;
    atomic_store(&team.limit, threads < MOST ? threads : MOST);
}

int ritz_team_ready(int64_t gain)
{
    const int limit = atomic_load(&team.limit);
    const int most = gain < limit ? (int)gain : limit;
    int ready = 0;

    if (gain <= 1 || most <= 1 || works)
        return 1;
    pthread_mutex_lock(&team.busy);
    while (team.started + 1 < most && !team.refused) {
        team.refused = !enlarge_team(team.started + 1);
        team.started += !team.refused;
    }
    ready = team.started + 1 < most ? team.started + 1 : most;
    pthread_mutex_unlock(&team.busy);
    return ready;
}

void ritz_team_run(int threads, ritz_team_work *work, void *task)
{
    uint32_t ended = 0;

    if (threads <= 1) {
        work(0, 1, task);
        return;
    }
    pthread_mutex_lock(&team.busy);
    while (team.started + 1 < threads && enlarge_team(team.started + 1))
        team.started++; /* a fork has lost those that were ready */
    ended = atomic_load(&team.ends.count);
    team.threads = threads;
    team.work = work;
    team.task = task;
    atomic_store(&team.working, team.started);
    announce_change(&team.tasks);
    works = true;
    work(0, threads, task);
    works = false;
    await_change(&team.ends, ended);
    pthread_mutex_unlock(&team.busy);
}

/* Items that are divided among threads beforehand. */
typedef struct divided_items {
    int64_t count;
    ritz_team_range *work;
    void *task;
} divided_items;

static void work_on_range(int thread, int threads, void *task)
{
    const divided_items *r = task;
    int64_t from = 0;
    int64_t to = 0;

    ritz_team_part(r->count, thread, threads, &from, &to);
    r->work(thread, from, to, r->task);
}

void ritz_team_over(int threads, int64_t count, ritz_team_range *work,
                    void *task)
{
    ritz_team_run(threads, work_on_range, &(divided_items){count, work, task});
}

/* Items of which each thread takes the next one when it is free. */
typedef struct item_queue {
    int64_t count;
    _Atomic int64_t next;
    ritz_team_item *work;
    void *task;
} item_queue;

static void work_on_items(int thread, int threads, void *task)
{
    item_queue *q = task;
    int64_t k = 0;

    (void)thread;
    (void)threads;
    while ((k = atomic_fetch_add(&q->next, 1)) < q->count)
        q->work(k, q->task);
}

void ritz_team_each(int threads, int64_t count, ritz_team_item *work,
                    void *task)
{
    ritz_team_run(threads, work_on_items,
                  &(item_queue){.count = count, .work = work, .task = task});
}

/* Items that can fail, and the first one that did. */
typedef struct fallible_items {
    ritz_team_step *work;
    void *task;
    pthread_mutex_t lock;  /* of the fields below */
    _Atomic int64_t first; /* its number; INT64_MAX: none has failed */
    ritz_status status;
    char why[RITZ_MESSAGE_SIZE];
} fallible_items;

/* Items are taken in ascending order, so that none before the first failure is
   left out. */
static void try_item(int64_t k, void *task)
{
    fallible_items *items = task;
    ritz_status status = RITZ_OK;

    if (k > atomic_load(&items->first))
        return;
    status = items->work(k, items->task);
    if (status == RITZ_OK)
        return;
    pthread_mutex_lock(&items->lock);
    if (k < atomic_load(&items->first)) {
        atomic_store(&items->first, k);
        items->status = status;
        (void)snprintf(items->why, sizeof items->why, "%s",
                       ritz_error_message());
    }
    pthread_mutex_unlock(&items->lock);
}

ritz_status ritz_team_try(int threads, int64_t count, ritz_team_step *work,
                          void *task)
{
    fallible_items items = {.work = work,
                            .task = task,
                            .lock = PTHREAD_MUTEX_INITIALIZER,
                            .first = INT64_MAX};

    ritz_team_each(threads, count, try_item, &items);
    /* a sentence belongs to the thread that recorded it */
    if (items.status != RITZ_OK)
        ritz_record("%s", items.why);
    return items.status;
}

int64_t ritz_team_shares(int threads)
{
    const int64_t shares = (int64_t)threads * SHARES_EACH;

    return shares < RITZ_TEAM_SHARES ? shares : RITZ_TEAM_SHARES;
}
