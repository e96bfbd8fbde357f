/* Switched models: --switched LIBRARY[,LIBRARY]. */
#include "print/simulation.h"

#include "base/alloc.h"
#include "base/text.h"
#include "base/tolerances.h"

#include <ritz/import.h>
#include <ritz/switched.h>

#include <inttypes.h>
#include <math.h>
#include <string.h>

enum { MOST_LIBRARIES = 16 };

bool simulation_switched_asked(const simulation_options *given)
{
    return given->switched != NULL;
}

void simulation_check_switched(const cli_program *program,
                               simulation_options *given)
{
    if (given->switched && given->integrator != &ritz_integrator_modal)
        cli_refuse(program,
                   "--switched propagates each set exactly, by its modes: "
                   "--method %s cannot be used with it",
                   given->method);
    given->indicator = given->indicator > 0.0 ? given->indicator : 0.99;
    given->hysteresis = fmax(given->hysteresis, 0.0);
    given->dwell = fmax(given->dwell, 0.0);
    given->inner = given->inner ? given->inner : "mass";
    given->jump = given->jump ? given->jump : "offset";
    given->share_of = given->share_of ? given->share_of : "model";
}

/* What follows "modes" in "modes" or "modes:K", the lowest modes of the model;
   NULL for a file. */
static const char *find_modes_word(const char *text)
{
    static const char word[] = "modes";
    const size_t length = sizeof word - 1;

    if (strncmp(text, word, length) != 0 ||
        (text[length] != '\0' && text[length] != ':'))
        return NULL;
    return text + length;
}

static ritz_status take_modes(const simulation_task *task, const char *count,
                              ritz_dense *out)
{
    const ritz_model *s = &task->subject;
    const int64_t n = ritz_model_order(*s);
    RITZ_OWN(ritz_pairs) pairs = {0};
    int64_t modes = n;

    RITZ_REFUSE_IF(*count && (!ritz_text_whole(count + 1, &modes) || modes < 1),
                   RITZ_ERR_ARGUMENT, "'modes%s' is not a number of modes",
                   count);
    if (s->kind == RITZ_MODEL_COMPONENT) {
        const ritz_span span = {.modes = modes < n ? modes : n - 1};
        RITZ_OWN(ritz_dense) K = {0}, M = {0};

        if (modes < n)
            RITZ_CHECK(ritz_eigen_sparse(&s->component->K, &s->component->M,
                                         &span, &pairs));
        else {
            RITZ_CHECK(ritz_sparse_dense(&s->component->K, &K));
            RITZ_CHECK(ritz_sparse_dense(&s->component->M, &M));
            RITZ_CHECK(ritz_eigen_dense(&K, &M, &pairs));
        }
    } else if (s->kind == RITZ_MODEL_DENSE) {
        RITZ_CHECK(ritz_eigen_dense(s->dense.K, s->dense.M, &pairs));
    }
    return ritz_dense_columns(
        &pairs.Phi, 0, modes < pairs.Phi.ncol ? modes : pairs.Phi.ncol, out);
}

/* The line of the run's input of that path, "SHA-256  PATH"; NULL if it has no
   sum, as a pipe. */
static const char *find_sum(const cli_run *run, const char *path)
{
    for (int64_t k = 0; k < run->num_inputs; k++)
        if (strlen(run->input[k]) > RITZ_DIGEST_SIZE &&
            strcmp(run->input[k] + RITZ_DIGEST_SIZE + 1, path) == 0)
            return run->input[k];
    return NULL;
}

/* Warn of a basis that was made from other files than the model. Its rows may
   be as many by chance; and the same matrices may be in another file. */
static ritz_status check_origin(cli_run *run, const char *path)
{
    const char *subject = find_sum(run, run->operand[0]);
    RITZ_OWN(ritz_summary) made = {0};

    if (!subject || !ritz_container_seems(run->operand[0]))
        return RITZ_OK;
    RITZ_CHECK(ritz_container_summary(path, &made));
    for (int64_t k = 0; k < made.num_inputs; k++)
        if (strncmp(made.input[k], subject, RITZ_DIGEST_SIZE - 1) == 0)
            return RITZ_OK;
    if (made.num_inputs > 0)
        cli_warn(
            run,
            "the basis '%s' was made from '%s', whose SHA-256 differs from "
            "that of '%s': does it belong to this model?",
            path, strstr(made.input[0], "  ") + 2, run->operand[0]);
    return RITZ_OK;
}

/* Read a basis of Ritz, or a matrix from any foreign file. */
static ritz_status read_library(cli_run *run, const char *path, ritz_dense *out)
{
    RITZ_OWN(ritz_matrix) T = {0};
    RITZ_OWN_ARRAY char *file = NULL;
    const ritz_wanted wanted = {.spec = path, .into = &T};

    if (ritz_container_seems(path)) {
        RITZ_OWN(model) m = {0};

        RITZ_CHECK(model_read(run, path, MODEL_BASIS, &m));
        RITZ_REFUSE_IF(m.basis.states, RITZ_ERR_ARGUMENT,
                       "'%s' is a basis of states, not of displacements", path);
        RITZ_CHECK(check_origin(run, path));
        RITZ_MOVE(*out, m.basis.T);
        return RITZ_OK;
    }
    RITZ_CHECK(ritz_foreign_path(path, &file));
    RITZ_CHECK(cli_input(run, file));
    RITZ_CHECK(ritz_foreign_collect(1, &wanted, NULL));
    RITZ_REFUSE_IF(T.imaginary, RITZ_ERR_ARGUMENT, "'%s' is complex", path);
    return ritz_sparse_dense(&T.A, out);
}

static ritz_status take_library(simulation_task *task, const char *word)
{
    const char *count = find_modes_word(word);
    ritz_dense *out = &task->library[task->num_libraries];

    RITZ_REFUSE_IF(task->num_libraries == MOST_LIBRARIES, RITZ_ERR_ARGUMENT,
                   "more than %d libraries", (int)MOST_LIBRARIES);
    RITZ_REFUSE_IF(!*word, RITZ_ERR_ARGUMENT, "a library without a name");
    RITZ_CHECK(count ? take_modes(task, count, out)
                     : read_library(task->run, word, out));
    RITZ_REFUSE_IF(task->stage.count > 0 && out->nrow != task->m.at->K.nrow,
                   RITZ_ERR_ARGUMENT,
                   "'%s' has %" PRId64 " rows, the joined system has %" PRId64
                   " coordinates: give 'modes', or a basis of the system that "
                   "ritz-assemble --at writes",
                   word, out->nrow, task->m.at->K.nrow);
    task->num_libraries++;
    return RITZ_OK;
}

ritz_status simulation_switched_prepare(simulation_task *task)
{
    const char *given = task->given->switched;
    RITZ_OWN_ARRAY char *text = NULL;
    char *rest = NULL;

    RITZ_CHECK_COPY(text, given, (int64_t)strlen(given) + 1);
    rest = text;
    RITZ_CHECK_NEW(task->library, MOST_LIBRARIES);
    while (rest) {
        char *comma = strchr(rest, ',');

        if (comma)
            *comma = '\0';
        RITZ_CHECK(take_library(task, rest));
        rest = comma ? comma + 1 : NULL;
    }
    return RITZ_OK;
}

/* Print the largest kinetic energy that a set left out at a switch. */
static void say_left_out(cli_run *run, const ritz_switched *asked,
                         const ritz_switched_report *r)
{
    const bool offset = asked->jump == RITZ_SWITCH_OFFSET;

    sink_field(
        run, "left out", "left_out,left_out_at",
        "a share of %.2g of the kinetic energy, by the set that begins at "
        "%.6g s",
        r->left_out, r->left_out_at);
    if (r->left_out > RITZ_SWITCH_LEFT_OUT)
        cli_warn(
            run,
            "the set that begins at %.6g s leaves out %.3g %% of the kinetic "
            "energy, which %s: an --indicator closer to 1 leaves out less",
            r->left_out_at, 100.0 * r->left_out,
            offset ? "is held constant from then on" : "is lost");
}

static void say_report(cli_run *run, const ritz_switched *asked,
                       const ritz_switched_report *r, const ritz_simulation *s)
{
    const double steps = s->seconds[s->count - 1] / s->step;

    sink_field(run, "library", "vectors,given",
               "%" PRId64 " vectors of %" PRId64 " given", r->num_vectors,
               r->num_given);
    sink_field(run, "switches", "switches,fallbacks",
               "%" PRId64 " changes of the set; %" PRId64
               " times all vectors were below the indicator",
               r->num_switches, r->num_fallbacks);
    sink_field(run, "vector-steps", "vector_steps,mean_vectors",
               "%.0f, %.4g vectors a step", r->vector_steps,
               r->vector_steps / steps);
    if (r->dwell > 0.0)
        sink_field(run, "stable", "dwell,needed",
                   "sets dwell %.4g s, and %.4g s are needed", asked->dwell,
                   r->dwell);
    else
        sink_field(run, "stable", "defect",
                   "the energy is a common Lyapunov function of all sets, "
                   "which the library meets to %.1e",
                   r->defect);
    say_left_out(run, asked, r);
    if (r->outside > 0.0)
        cli_warn(run,
                 "%.2g of the initial state is outside the library, and is "
                 "lost",
                 r->outside);
}

ritz_status simulation_switched(simulation_task *task,
                                const ritz_simulation_request *request,
                                ritz_simulation *out)
{
    const simulation_options *given = task->given;
    const bool euclidean = strcmp(given->inner, "euclidean") == 0;
    const bool project = strcmp(given->jump, "project") == 0;
    const ritz_switched asked = {
        .num_libraries = task->num_libraries,
        .library = task->library,
        .redundant = given->redundant,
        .interval = given->switch_interval,
        .indicator = given->indicator,
        .share_of_library = strcmp(given->share_of, "library") == 0,
        .hysteresis = given->hysteresis,
        .look_ahead = given->look_ahead,
        .inner = euclidean ? RITZ_SWITCH_EUCLIDEAN : RITZ_SWITCH_MASS,
        .jump = project ? RITZ_SWITCH_PROJECT : RITZ_SWITCH_OFFSET,
        .dwell = given->dwell,
    };
    ritz_switched_report report = {0};

    RITZ_REFUSE_IF(!(given->switch_interval > 0.0), RITZ_ERR_ARGUMENT,
                   "--switched needs --switch-interval");
    RITZ_CHECK(
        ritz_simulate_switched(task->subject, request, &asked, &report, out));
    if (out->num_state == 0)
        say_report(task->run, &asked, &report, out);
    return RITZ_OK;
}
