#include "base/team.h"

#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>

enum {
    MOST = 64,   /* threads */
    SPINS = 400, /* pauses before sleep: some 20 microseconds */
};

/* A number that threads wait for: it only grows. */
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
    int started;           /* threads beside the callers' own */
    uint32_t before[MOST]; /* tasks before each of them was started */
    bool refused;          /* the system starts no more */
    signal_count tasks, ends, meetings;
    _Atomic int working; /* started threads that are not at the task's end */
    _Atomic int arrived; /* at the next meeting */
    int threads;         /* of this task */
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

/* Wait until the count is another than @p seen. */
static void await_change(signal_count *s, uint32_t seen)
{
    for (int k = 0; k < SPINS; k++) {
        if (atomic_load(&s->count) != seen)
            return;
        pause_thread();
    }
    pthread_mutex_lock(&s->lock);
    atomic_fetch_add(&s->sleepers, 1);
    while (atomic_load(&s->count) == seen)
        pthread_cond_wait(&s->changed, &s->lock);
    atomic_fetch_sub(&s->sleepers, 1);
    pthread_mutex_unlock(&s->lock);
}

/* A thread that goes to sleep counts itself before it looks at the count a last
   time, so that either it sees the change or it is seen here. */
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

/* What a thread that was started does: its part of every task, which may be
   none. */
static void *serve_tasks(void *argument)
{
    const int thread = (int)(intptr_t)argument;

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

/* A process that was forked has none of the threads. */
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
    (void)pthread_atfork(NULL, NULL, forget_threads); /* fails without memory */
}

/* One more thread, which leaves all signals to the others. */
static bool start_thread(int thread)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    sigset_t all, before;
    pthread_t id;
    bool started = false;

    pthread_once(&once, watch_forks);
    team.before[thread] = atomic_load(&team.tasks.count);
    sigfillset(&all);
    if (pthread_sigmask(SIG_SETMASK, &all, &before) != 0)
        return false;
    started = pthread_create(&id, NULL, serve_tasks,
                             (void *)(intptr_t)thread) == 0; // NOLINT
    if (started)
        pthread_detach(id);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return started;
}

void ritz_set_threads(int threads)
{
    threads = threads > 1 ? threads : 1;
    atomic_store(&team.limit, threads < MOST ? threads : MOST);
}

int ritz_team_ready(int most)
{
    const int limit = atomic_load(&team.limit);
    int ready = 0;

    most = most < limit ? most : limit;
    if (most <= 1)
        return 1;
    pthread_mutex_lock(&team.busy);
    while (team.started + 1 < most && !team.refused) {
        team.refused = !start_thread(team.started + 1);
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
    while (team.started + 1 < threads && start_thread(team.started + 1))
        team.started++; /* after a fork */
    ended = atomic_load(&team.ends.count);
    team.threads = threads;
    team.work = work;
    team.task = task;
    atomic_store(&team.working, team.started);
    announce_change(&team.tasks);
    work(0, threads, task);
    await_change(&team.ends, ended);
    pthread_mutex_unlock(&team.busy);
}
