/*
 * Cards of NASTRAN bulk data: scanned into lines, lines joined to cards, a card
 * taken apart when it is asked for.
 */
#include "formats/cards_parts.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>

ritz_status ritz_deck_refuse(const ritz_deck *deck, int64_t line,
                             const char *format, ...)
{
    const ritz_line *at = &deck->line[line];
    const char *path = deck->file[at->file].path;
    char sentence[400];
    va_list args;

    va_start(args, format);
    vsnprintf(sentence, sizeof sentence, format, args);
    va_end(args);
    if (path)
        return ritz_fail(RITZ_ERR_FORMAT, "'%s', line %" PRId64 ": %s", path,
                         at->number, sentence);
    return ritz_fail(RITZ_ERR_FORMAT, "line %" PRId64 ": %s", at->number,
                     sentence);
}

ritz_status ritz_deck_parse(const char *path, const char *text, int64_t size,
                            const char *folder, ritz_deck *out)
{
    ritz_status status = RITZ_OK;
    ritz_deck deck = {0};
    ritz_lines whole = {.at = text, .end = text + size};

    RITZ_TRY(ritz_deck_scan(path, folder, whole, &deck));
    RITZ_TRY(ritz_deck_join(&deck));
    *out = deck;
    deck = (ritz_deck){0};
done:
    ritz_deck_free(&deck);
    return status;
}

void ritz_deck_free(ritz_deck *deck)
{
    for (int64_t k = 0; k < deck->num_files; k++) {
        free(deck->file[k].path);
        free(deck->file[k].text);
    }
    free(deck->file);
    free(deck->line);
    free(deck->entry);
    free(deck->selected[0]);
    free(deck->selected[1]);
    *deck = (ritz_deck){0};
}
