#include "print/simulation.h"

#include <ritz/eigen.h>

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

ritz_simulated simulation_subject(const model *m, const ritz_second_order *view,
                                  const ritz_damping *damping)
{
    if (m->kind == MODEL_STATES)
        return (ritz_simulated){.states = &m->states};
    if (m->kind == MODEL_COMPONENT)
        return (ritz_simulated){.component = &m->component, .damping = damping};
    return (ritz_simulated){.model = view, .damping = damping};
}

static const char (*input_names(const ritz_simulated *s,
                                int64_t *count))[RITZ_NAME_SIZE]
{
    const ritz_io *io = s->model       ? s->model->io
                        : s->component ? &s->component->io
                                       : NULL;

    *count = io ? io->num_inputs : s->states->num_inputs;
    return (const char(*)[RITZ_NAME_SIZE])(io ? io->input : s->states->input);
}

static int64_t coordinates(const ritz_simulated *s)
{
    if (s->model)
        return s->model->K->nrow;
    return s->component ? s->component->num_dofs : s->states->A.nrow;
}

static ritz_status take_input(cli_run *run, const ritz_simulated *subject,
                              const char *text, simulation_drive *drive)
{
    const char *equals = strchr(text, '=');
    size_t length = equals ? (size_t)(equals - text) : 0;
    const char(*name)[RITZ_NAME_SIZE] = input_names(subject, &drive->count);
    char word[RITZ_NAME_SIZE] = "";
    int64_t j = 0;

    RITZ_REFUSE_IF(!equals || length == 0 || length >= sizeof word,
                   RITZ_ERR_ARGUMENT, "'%s' is not NAME=SIGNAL", text);
    memcpy(word, text, length);
    while (j < drive->count && strcmp(name[j], word) != 0)
        j++;
    if (j == drive->count) {
        const char *nearest =
            drive->count > 0
                ? ritz_text_nearest(word, drive->count, name[0], sizeof *name)
                : NULL;

        if (!nearest && drive->count > 0)
            return ritz_fail(RITZ_ERR_ARGUMENT, "no input '%s', but '%s'%s",
                             word, name[0], drive->count > 1 ? ", ..." : "");
        return ritz_fail(RITZ_ERR_ARGUMENT, "no input '%s'%s%s%s", word,
                         nearest ? ", is '" : "", nearest ? nearest : "",
                         nearest ? "' meant?" : "");
    }
    RITZ_REFUSE_IF(drive->signal[j].kind != RITZ_SIGNAL_ZERO, RITZ_ERR_ARGUMENT,
                   "input '%s' is given twice", word);
    RITZ_CHECK(ritz_signal_parse(equals + 1, &drive->signal[j]));
    if (ritz_signal_is_file(equals + 1))
        RITZ_CHECK(cli_input(run, equals + 1));
    return RITZ_OK;
}

ritz_status simulation_inputs(cli_run *run, const ritz_simulated *subject,
                              const cli_list *texts, simulation_drive *drive)
{
    (void)input_names(subject, &drive->count);
    drive->signal = calloc((size_t)drive->count + 1, sizeof *drive->signal);
    RITZ_REFUSE_IF(!drive->signal, RITZ_ERR_MEMORY, "no memory for inputs");
    for (int k = 0; k < texts->count; k++)
        RITZ_CHECK_IN("--input",
                      take_input(run, subject, texts->text[k], drive));
    return RITZ_OK;
}

/* "K" or "K*A" */
static ritz_status parse_mode(const char *text, int64_t *mode, double *amount)
{
    char word[RITZ_NAME_SIZE];
    char *star = NULL;

    *amount = 1.0;
    RITZ_REFUSE_IF(strlen(text) >= sizeof word, RITZ_ERR_ARGUMENT,
                   "'%s' is no mode", text);
    (void)snprintf(word, sizeof word, "%s", text);
    star = strchr(word, '*');
    if (star)
        *star = '\0';
    RITZ_REFUSE_IF(!ritz_text_whole(word, mode) || *mode < 1 ||
                       (star && !ritz_text_real(star + 1, amount)),
                   RITZ_ERR_ARGUMENT,
                   "'mode:%s' is not a mode and an amplitude, as mode:7*0.1",
                   text);
    return RITZ_OK;
}

static ritz_status take_mode(const ritz_simulated *s, const char *text,
                             simulation_drive *drive)
{
    ritz_status status = RITZ_OK;
    ritz_pairs pairs = {0};
    int64_t mode = 0;
    double amount = 1.0;

    RITZ_FAIL_IF(s->states, RITZ_ERR_ARGUMENT,
                 "a state space has no modes: give a file");
    RITZ_TRY(parse_mode(text, &mode, &amount));
    if (s->component) {
        const ritz_span span = {.modes = mode};

        RITZ_TRY(ritz_eigen_sparse(&s->component->K, &s->component->M, &span,
                                   &pairs));
    } else {
        RITZ_TRY(ritz_eigen_dense(s->model->K, s->model->M, &pairs));
    }
    RITZ_FAIL_IF(mode > pairs.Phi.ncol, RITZ_ERR_ARGUMENT,
                 "there are %" PRId64 " modes, not %" PRId64, pairs.Phi.ncol,
                 mode);
    for (int64_t k = 0; k < pairs.Phi.nrow; k++)
        drive->x0[k] = amount * ritz_dense_col(&pairs.Phi, mode - 1)[k];
done:
    ritz_pairs_free(&pairs);
    return status;
}

/* A value, and its rate if there is one, a row. */
static ritz_status take_values(const char *path, int64_t n,
                               simulation_drive *drive)
{
    static const char blank[] = " \t\r,;\n";
    ritz_status status = RITZ_OK;
    char *text = NULL;
    char *line = NULL;
    int64_t row = 0;

    RITZ_TRY(ritz_text_read(path, &text));
    for (line = text; line;) {
        char *end = strchr(line, '\n');
        char *place = NULL;
        char *word = NULL;

        if (end)
            *end = '\0';
        word = strtok_r(line, blank, &place);
        line = end ? end + 1 : NULL;
        if (!word || word[0] == '#')
            continue;
        RITZ_FAIL_IF(
            row == n || !ritz_text_real(word, &drive->x0[row]), RITZ_ERR_FORMAT,
            "row %" PRId64 " is not a value of %" PRId64 " in all", row + 1, n);
        word = strtok_r(NULL, blank, &place);
        RITZ_FAIL_IF(word && !ritz_text_real(word, &drive->v0[row]),
                     RITZ_ERR_FORMAT, "row %" PRId64 ": '%s' is no rate",
                     row + 1, word);
        row++;
    }
    RITZ_FAIL_IF(row != n, RITZ_ERR_FORMAT,
                 "%" PRId64 " rows for %" PRId64 " coordinates", row, n);
done:
    free(text);
    return ritz_context(status, path);
}

ritz_status simulation_initial(cli_run *run, const ritz_simulated *subject,
                               const char *text, simulation_drive *drive)
{
    static const char mode[] = "mode:";
    int64_t n = coordinates(subject);

    if (!text)
        return RITZ_OK;
    drive->x0 = calloc((size_t)n + 1, sizeof *drive->x0);
    drive->v0 = calloc((size_t)n + 1, sizeof *drive->v0);
    RITZ_REFUSE_IF(!drive->x0 || !drive->v0, RITZ_ERR_MEMORY,
                   "no memory for initial values");
    if (strncmp(text, mode, sizeof mode - 1) == 0)
        return take_mode(subject, text + sizeof mode - 1, drive);
    RITZ_CHECK(cli_input(run, text));
    return take_values(text, n, drive);
}

void simulation_free(simulation_drive *drive)
{
    for (int64_t j = 0; drive->signal && j < drive->count; j++)
        ritz_signal_free(&drive->signal[j]);
    free(drive->signal);
    free(drive->x0);
    free(drive->v0);
    *drive = (simulation_drive){0};
}
