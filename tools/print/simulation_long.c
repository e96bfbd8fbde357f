/*
 * Long runs. A run ends early at a signal, or to write a checkpoint. The result
 * is a time response with a state, from which the same command continues the
 * run.
 */
#include "print/simulation.h"

#include "base/draft.h"
#include "base/text.h"

#include <string.h>
#include <unistd.h>

/* Decides when a run ends early. */
typedef struct run_watch {
    bool keeps;   /* it writes checkpoints */
    double began; /* by cli_clock: when the run was started or continued */
    double next;  /* when it is to end; 0: no step was taken yet */
} run_watch;

/* Seconds of work between two checkpoints. */
static const double between = 30.0;
/* Smallest ratio of the time of steps to the time of writing a checkpoint and
   starting again. */
static const double share = 20.0;

/* Whether to end the run here. The time until the first call is that of
   starting the run. */
static bool is_due(void *context)
{
    run_watch *w = context;
    double now = 0.0;

    if (cli_interrupted())
        return true;
    if (!w->keeps)
        return false;
    now = cli_clock();
    if (w->next == 0.0)
        w->next = now + fmax(between, share * (now - w->began));
    return now >= w->next;
}

/* Refuse a checkpoint of another command or of other files. */
static ritz_status check_command(const cli_run *run, const char *path)
{
    RITZ_OWN(ritz_summary) summary = {0};
    bool same = true;

    RITZ_CHECK(ritz_container_summary(path, &summary));
    RITZ_REFUSE_IF(strcmp(summary.kind, "simulation") != 0 ||
                       !*summary.interrupted,
                   RITZ_ERR_ARGUMENT, "'%s' is no checkpoint", path);
    RITZ_REFUSE_IF(strcmp(summary.command, run->command) != 0,
                   RITZ_ERR_ARGUMENT, "'%s' is a checkpoint of '%s'", path,
                   summary.command);
    same = summary.num_inputs == run->num_inputs;
    for (int64_t k = 0; same && k < run->num_inputs; k++)
        same = strcmp(summary.input[k], run->input[k]) == 0;
    RITZ_REFUSE_IF(!same, RITZ_ERR_ARGUMENT,
                   "'%s' is a checkpoint of files that have changed since",
                   path);
    return RITZ_OK;
}

static ritz_status read_checkpoint(const cli_run *run, const char *path,
                                   ritz_simulation *out)
{
    ritz_status status = RITZ_OK;

    for (int k = 0; k < run->num_operands; k++)
        RITZ_REFUSE_IF(ritz_draft_same(path, run->operand[k]),
                       RITZ_ERR_ARGUMENT, "'%s' is the model", path);
    RITZ_REFUSE_IF(ritz_draft_same(path, run->output), RITZ_ERR_ARGUMENT,
                   "'%s' is the output too", path);
    if (access(path, F_OK) != 0)
        return cli_can_write(path);
    RITZ_CHECK(ritz_container_keep(path));
    status = check_command(run, path);
    if (status == RITZ_OK)
        status = ritz_container_read_simulation(path, out);
    ritz_container_release();
    ritz_draft_unprotect(path); /* the next checkpoint replaces it */
    return status;
}

/* "the run, after 3.2 of 10 s" */
static void describe_end(const ritz_simulation_request *request,
                         const ritz_simulation *s, char out[RITZ_NAME_SIZE])
{
    snprintf(out, RITZ_NAME_SIZE, "the run, after %.6g of %.6g s",
             s->state[0] * request->step, request->seconds);
}

static ritz_status write_checkpoint(simulation_task *task,
                                    const ritz_simulation_request *request,
                                    const ritz_simulation *s)
{
    char what[RITZ_NAME_SIZE];
    ritz_stamp stamp = *cli_stamp(task->run);

    describe_end(request, s, what);
    stamp.interrupted = what;
    stamp.now = true;
    return ritz_container_write_simulation(task->given->checkpoint, s, &stamp);
}

/* After the sentence of a failure, say more of a file. */
static ritz_status add_sentence(ritz_status status, const char *more,
                                const char *path)
{
    char why[RITZ_MESSAGE_SIZE];

    snprintf(why, sizeof why, "%s", ritz_error_message());
    return ritz_fail(status, "%s; %s '%s'", why, more, path);
}

ritz_status simulation_name_checkpoint(const simulation_task *task,
                                       ritz_status status)
{
    const char *path = task->given->checkpoint;

    if (status == RITZ_OK || !path || access(path, F_OK) != 0)
        return status;
    return add_sentence(status, "the same command continues the run from",
                        path);
}

/* The run is in OUTPUT.interrupted. `fault` is why it is not in the file of
   --checkpoint, "" if it is. */
static ritz_status tell_end(const simulation_task *task, const char *fault,
                            const char *what)
{
    const char *checkpoint = task->given->checkpoint;
    const char *kept = task->run->output;

    RITZ_REFUSE_IF(!checkpoint, RITZ_ERR_CONVERGENCE,
                   "interrupted: %s, is in '%s'", what, kept);
    RITZ_REFUSE_IF(
        *fault, RITZ_ERR_CONVERGENCE,
        "interrupted: %s, is in '%s'; its checkpoint was not written: "
        "%s; the same command continues it if you copy '%s' to '%s'",
        what, kept, fault, kept, checkpoint);
    return ritz_fail(RITZ_ERR_CONVERGENCE,
                     "interrupted: %s, is in '%s'; the same command continues "
                     "it from '%s'",
                     what, kept, checkpoint);
}

/* After a signal, write the run until then as OUTPUT.interrupted, whether or
   not a checkpoint could be written. */
static ritz_status keep_rest(simulation_task *task, const char *fault,
                             const ritz_simulation_request *request,
                             const ritz_simulation *s)
{
    cli_run *run = task->run;
    char what[RITZ_NAME_SIZE];
    ritz_status status = RITZ_OK;

    describe_end(request, s, what);
    RITZ_CHECK(cli_divert(run, what));
    status = ritz_container_write_simulation(run->output, s, cli_stamp(run));
    if (status == RITZ_OK)
        return tell_end(task, fault, what);
    if (*fault)
        status = add_sentence(status, "nor can the checkpoint be written to",
                              task->given->checkpoint);
    return simulation_name_checkpoint(task, status);
}

/* Write a checkpoint. If that fails the run goes on, and why is in `fault`. */
static void try_checkpoint(simulation_task *task,
                           const ritz_simulation_request *request,
                           const ritz_simulation *s,
                           char fault[RITZ_MESSAGE_SIZE])
{
    const bool first = !*fault;

    *fault = '\0';
    if (write_checkpoint(task, request, s) == RITZ_OK)
        return;
    snprintf(fault, RITZ_MESSAGE_SIZE, "%s", ritz_error_message());
    if (first && !cli_interrupted())
        cli_warn(task->run,
                 "a checkpoint was not written; the run goes on, and tries "
                 "again after half a minute: %s",
                 fault);
}

ritz_status simulation_long_run(simulation_task *task,
                                ritz_simulation_request *request,
                                simulation_function *simulate,
                                ritz_simulation *out)
{
    const char *checkpoint = task->given->checkpoint;
    char fault[RITZ_MESSAGE_SIZE] = "";
    RITZ_OWN(ritz_simulation) part = {0};

    if (checkpoint)
        RITZ_CHECK_IN("--checkpoint",
                      read_checkpoint(task->run, checkpoint, &part));
    cli_interruptible();
    while (true) {
        run_watch watch = {.keeps = checkpoint, .began = cli_clock()};
        RITZ_OWN(ritz_simulation) s = {0};

        request->stop = is_due;
        request->context = &watch;
        request->from = part.num_state > 0 ? &part : NULL;
        RITZ_CHECK(simulate(task, request, &s));
        simulation_name_spin(task, &s);
        ritz_simulation_free(&part);
        RITZ_MOVE(part, s);
        if (part.num_state == 0)
            break;
        if (checkpoint)
            try_checkpoint(task, request, &part, fault);
        if (cli_interrupted())
            return keep_rest(task, fault, request, &part);
    }
    (void)cli_uninterruptible();
    RITZ_MOVE(*out, part);
    return RITZ_OK;
}

/* Whether a file is what an interrupted run of this command has left. */
static bool is_leftover(const cli_run *run, const char *path)
{
    RITZ_OWN(ritz_summary) summary = {0};

    return access(path, F_OK) == 0 &&
           ritz_container_summary(path, &summary) == RITZ_OK &&
           strcmp(summary.kind, "simulation") == 0 && *summary.interrupted &&
           strcmp(summary.command, run->command) == 0;
}

void simulation_remove_leftovers(const cli_run *run,
                                 const simulation_options *given)
{
    char path[CLI_MAX_COMMAND];

    if (given->checkpoint)
        unlink(given->checkpoint);
    if (run->output &&
        snprintf(path, sizeof path, "%s.interrupted", run->output) <
            (int)sizeof path &&
        is_leftover(run, path))
        unlink(path);
}
