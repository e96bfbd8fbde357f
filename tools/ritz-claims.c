/* ritz-claims - hold published numbers against what the tools answer. */
#include "claims/claims.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The folder of this program, where the other tools are. */
static ritz_status find_tools(claims_state *state)
{
    ssize_t length = readlink("/proc/self/exe", state->bin, PATH_MAX - 1);
    char *slash = NULL;

    state->bin[length > 0 ? length : 0] = '\0';
    slash = strrchr(state->bin, '/');
    RITZ_REFUSE_IF(!slash, RITZ_ERR_FILE, "the folder of the tools is unknown");
    *slash = '\0';
    return RITZ_OK;
}

/* An empty folder in which commands run; a data folder that moves with them. */
static ritz_status prepare_run(claims_state *state, const char *data)
{
    RITZ_CHECK(claims_level());
    RITZ_CHECK(find_tools(state));
    if (data && !realpath(data, state->data))
        snprintf(state->data, sizeof state->data, "%s", data);
    return claims_folder_new(state);
}

static ritz_status run_files(claims_state *state, const char *data)
{
    cli_run *run = state->run;

    RITZ_CHECK(prepare_run(state, data ? data : getenv("RITZ_EXTERNAL_DATA")));
    for (int k = 0; k < run->num_operands; k++) {
        RITZ_CHECK(cli_input(run, run->operand[k]));
        RITZ_CHECK(claims_file(state, run->operand[k]));
    }
    cli_say(run, "1..%" PRId64, state->holds + state->fails + state->skipped);
    RITZ_REFUSE_IF(state->fails > 0, RITZ_ERR_CONVERGENCE,
                   "%" PRId64 " of %" PRId64 " claims do not hold",
                   state->fails, state->holds + state->fails);
    return RITZ_OK;
}

static ritz_status run_claims(cli_run *run, const char *data)
{
    claims_state state = {.run = run, .list = json_array()};
    ritz_status status = run_files(&state, data);

    claims_folder_free(&state);
    json_decref(state.answer);
    json_object_set_new(run->report, "claims", state.list);
    sink_set(run, "holds,fails,skipped", "%ld %ld %ld", state.holds,
             state.fails, state.skipped);
    return status;
}

int main(int argc, char **argv)
{
    const char *data = NULL;
    const cli_option options[] = {
        CLI_TEXT("data", &data, "FOLDER",
                 "folder of others' files, $DATA in claims "
                 "[RITZ_EXTERNAL_DATA]"),
        {0},
    };
    const cli_program program = {
        .name = "ritz-claims",
        .operands = {{"FILE", "claims, each a number with its source", true}},
        .summary = "Run commands and hold their answers against published "
                   "numbers, each with its tolerance\nand its source. A line "
                   "for each; status 1 if one does not hold.",
        .example = "ritz-claims tests/claims/*.claims",
        .output = "nothing: what is claimed is said, not written",
        .output_optional = true,
    };
    cli_run run;

    cli_parse(&program, options, argc, argv, &run);
    return cli_finish(&run, run_claims(&run, data));
}
