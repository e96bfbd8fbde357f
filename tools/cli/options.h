/* Rows of option tables that several tools share. */
#ifndef RITZ_TOOLS_CLI_OPTIONS_H
#define RITZ_TOOLS_CLI_OPTIONS_H

#include "cli/model.h"

#include <ritz/model.h>

#define AT_OPTION(place)                                                       \
    CLI_TEXT("at", place, "JOINT=SETTING[,JOINT=SETTING]",                     \
             "which configuration of a system, degrees and lengths")

#define ORDER_OPTION(place)                                                    \
    CLI_INT("order", place, "N", 1, 1e6,                                       \
            "the first N columns of a nested reduced component [all]")

#define DAMPING_OPTION(place)                                                  \
    CLI_TEXT("damping", place, "TEXT",                                         \
             "\"modal ZETA\", \"modes ZETA ...\", \"bands F F ZETA ...\" "     \
             "(Hz), \"rayleigh A B\" or \"fit F ZETA ...\" [the model's]")

#define DAMPERS_OPTION(list)                                                   \
    CLI_LIST("damper", list, "NAME=C[*K]",                                     \
             "give a damper other values than the model states")

/* All that is asked of a model before anything is made of it. */
#define MODEL_OPTIONS(given)                                                   \
    AT_OPTION(&(given)->at), ORDER_OPTION(&(given)->order),                    \
        DAMPING_OPTION(&(given)->damping), DAMPERS_OPTION(&(given)->damper)

/* The words of a choice (choice.h) as options. */
enum { WORDS_MOST = 32, WORDS_NAME = 32 };

typedef struct choice_words {
    const char *text[WORDS_MOST];
    char name[WORDS_MOST][WORDS_NAME];
} choice_words;

/**
 * An option for every word: shift_hz becomes --shift-hz.
 *
 * @param[in]  except   RITZ_USES_... of words that the tool has options of its
 *                      own for
 * @param[out] options  room for WORDS_MOST
 */
void words_add(choice_words *all, int except, cli_option *options);

/** Take the words that were given into a choice, or end the program. */
void words_take(const cli_program *program, const choice_words *all,
                ritz_choice *choice);

#endif
