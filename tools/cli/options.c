#include "cli/options.h"

#include <string.h>

void words_add(choice_words *all, int except, cli_option *options)
{
    int count = 0;

    for (int k = 0; ritz_choice_words[k].key && k < WORDS_MOST; k++) {
        const ritz_choice_word *word = &ritz_choice_words[k];
        char *name = all->name[k];

        if (word->uses & except)
            continue;
        snprintf(name, WORDS_NAME, "%s", word->key);
        for (char *at = strchr(name, '_'); at; at = strchr(at, '_'))
            *at = '-';
        options[count++] = (cli_option)CLI_TEXT(name, &all->text[k],
                                                word->argument, word->help);
    }
}

void words_take(const cli_program *program, const choice_words *all,
                ritz_choice *choice)
{
    for (int k = 0; ritz_choice_words[k].key && k < WORDS_MOST; k++)
        if (all->text[k] && ritz_choice_take(&ritz_choice_words[k],
                                             all->text[k], choice) != RITZ_OK)
            cli_refuse(program, "%s", ritz_error_message());
}
