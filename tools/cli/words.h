/* The words of a choice (choice.h) as options of a tool. */
#ifndef RITZ_TOOLS_CLI_WORDS_H
#define RITZ_TOOLS_CLI_WORDS_H

#include "cli/cli.h"

#include <ritz/choice.h>

enum { WORDS_MOST = 32, WORDS_NAME = 32 };

typedef struct words {
    const char *text[WORDS_MOST];
    char name[WORDS_MOST][WORDS_NAME];
} words;

/**
 * An option for every word: shift_hz becomes --shift-hz.
 *
 * @param[in]  except   RITZ_USES_... of words that the tool has options of its
 *                      own for
 * @param[out] options  room for WORDS_MOST
 */
void words_add(words *all, int except, cli_option *options);

/** What was given, or the end of the program. */
void words_take(const cli_program *program, const words *all,
                ritz_choice *choice);

#endif
