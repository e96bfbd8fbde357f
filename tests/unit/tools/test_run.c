#include "testing.h"

#include "cli/cli.h"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

/* The work of a tool after its command line is parsed. */
typedef void run_body(cli_run *run);

static void finish_in_order(cli_run *run)
{
    exit(cli_finish(run, RITZ_OK));
}

static void finish_with_failure(cli_run *run)
{
    exit(cli_finish(run, ritz_fail(RITZ_ERR_FORMAT, "it is no file")));
}

/* The Fortran library ends the process like this when it has no memory. */
static void end_within_a_library(cli_run *)
{
    exit(EXIT_SUCCESS);
}

static void refuse_later(cli_run *run)
{
    cli_refuse(run->program, "no such thing");
}

/* Exit status of a tool that runs in its own process. */
static int run_tool(run_body *body)
{
    static const cli_option none[] = {{0}};
    static const cli_program program = {
        .name = "ritz-test", .output_optional = true, .output = "nothing"};
    static char name[] = "ritz-test";
    char *argv[] = {name, NULL};
    int outcome = 0;
    pid_t child = fork();

    if (child == 0) {
        int nothing = open("/dev/null", O_WRONLY);
        cli_run run;

        dup2(nothing, STDOUT_FILENO);
        dup2(nothing, STDERR_FILENO);
        cli_parse(&program, none, 1, argv, &run);
        body(&run);
        _exit(99);
    }
    assert_int_equal(waitpid(child, &outcome, 0), child);
    assert_true(WIFEXITED(outcome));
    return WEXITSTATUS(outcome);
}

static void a_tool_that_a_library_ends_has_failed(void **)
{
    assert_int_equal(run_tool(end_within_a_library), 1);
}

static void a_tool_that_ends_by_itself_has_its_status(void **)
{
    assert_int_equal(run_tool(finish_in_order), 0);
    assert_int_equal(run_tool(finish_with_failure), 1);
    assert_int_equal(run_tool(refuse_later), 2);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_tool_that_a_library_ends_has_failed),
    cmocka_unit_test(a_tool_that_ends_by_itself_has_its_status),
};

TEST_MODULE(run, tests, NULL, NULL)
