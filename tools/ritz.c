/* ritz - list the tools, and start one: `ritz basis ...` is `ritz-basis ...` */
#include "cli/cli.h"

#include <ritz/base.h>

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { VERB_SIZE = 16, EXIT_USAGE = 2 };

static const struct verb {
    char name[VERB_SIZE];
    const char *summary;
} verbs[] = {
    {"import", "matrices and geometry -> component; A, B, C -> state space"},
    {"info", "what is in a container, a matrix file or a bulk data deck"},
    {"check", "audit a component before it is reduced"},
    {"basis",
     "component -> basis, by one of the methods of 'ritz basis --list'"},
    {"reduce", "component + basis -> reduced component, with error estimates"},
    {"assemble", "scene -> system at one or all configurations"},
    {"rank", "which modes matter from inputs to outputs"},
    {"compare", "scene -> two-stage reduction over all configurations"},
    {"frf", "frequency response of any model, zeros, closed loops"},
    {"simulate", "time response of any model, and what a second of it costs"},
    {"recover", "reduced coordinates over time -> stresses, motion, maxima"},
    {"poles", "damped poles of any model, dampers retuned or scanned"},
    {"fit", "component or scene + tolerance -> the smallest model that holds"},
    {"verify", "full against reduced: every error, pass or fail"},
    {"chart", "pictures of records, rankings, responses; one page of them all"},
    {"export", "reduced component, state space, response -> file of others"},
    {"claims", "published numbers held against what the tools answer"},
};

enum { NUM_VERBS = sizeof verbs / sizeof *verbs };

static int list_verbs(void)
{
    printf("Usage: ritz VERB [OPTION]... INPUT... -o OUTPUT\n\n"
           "Reduce finite-element models for flexible-multibody simulation, "
           "with their errors.\n\n");
    for (int k = 0; k < NUM_VERBS; k++)
        printf("  %-10s %s\n", verbs[k].name, verbs[k].summary);
    printf("\n'ritz VERB --help' says more. 'ritz VERB' is 'ritz-VERB'.\n");
    if (fclose(stdout) == 0)
        return EXIT_SUCCESS;
    cli_complain("ritz: cannot write to standard output: %s\n",
                 strerror(errno));
    return EXIT_FAILURE;
}

static int refuse_verb(const char *word)
{
    const char *nearest =
        ritz_text_nearest(word, NUM_VERBS, verbs[0].name, sizeof *verbs);

    cli_complain("ritz: no tool '%s'%s%s%s\nTry 'ritz --help'.\n", word,
                 nearest ? ", is '" : "", nearest ? nearest : "",
                 nearest ? "' meant?" : "");
    return EXIT_USAGE;
}

/* The tool beside this program, or else where the shell would find it. */
static int start_tool(const char *verb, char **argv)
{
    char self[4096] = "";
    char tool[sizeof self + VERB_SIZE + sizeof "ritz-"];
    ssize_t length = readlink("/proc/self/exe", self, sizeof self - 1);
    char *slash = length > 0 ? strrchr(self, '/') : NULL;

    argv[0] = tool;
    if (slash) {
        slash[1] = '\0';
        snprintf(tool, sizeof tool, "%sritz-%s", self, verb);
        execv(tool, argv);
    }
    snprintf(tool, sizeof tool, "ritz-%s", verb);
    execvp(tool, argv);
    cli_complain("ritz: cannot start '%s': %s\n", tool, strerror(errno));
    return EXIT_FAILURE;
}

int main(int argc, char **argv)
{
    static char help[] = "--help";
    char *helping[] = {NULL, help, NULL};
    bool asks = argc > 2 && strcmp(argv[1], "help") == 0;
    const char *word = asks ? argv[2] : argc > 1 ? argv[1] : help;

    for (int k = 0; k < NUM_VERBS; k++)
        if (strcmp(word, verbs[k].name) == 0)
            return start_tool(word, asks ? helping : argv + 1);
    if (strcmp(word, help) == 0 || strcmp(word, "-h") == 0 ||
        strcmp(word, "help") == 0)
        return list_verbs();
    if (strcmp(word, "--version") != 0)
        return refuse_verb(word);
    return printf("ritz (Ritz) %s\n", ritz_version()) < 0 || fclose(stdout);
}
