/*
 * Cards of NASTRAN bulk data: scanned into lines, lines joined to cards, a card
 * taken apart when it is asked for.
 */
#include "formats/cards_parts.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>

ritz_status ritz_cards_refuse(const ritz_cards *cards, int64_t line,
                              const char *format, ...)
{
    const ritz_line *at = &cards->line[line];
    const char *path = cards->file[at->file].path;
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

ritz_status ritz_cards_parse(const char *path, const char *text, int64_t size,
                             const char *folder, ritz_cards *out)
{
    ritz_status status = RITZ_OK;
    ritz_cards cards = {0};
    ritz_lines whole = {.at = text, .end = text + size};

    RITZ_TRY(ritz_cards_scan(path, folder, whole, &cards));
    RITZ_TRY(ritz_cards_join(&cards));
    *out = cards;
    cards = (ritz_cards){0};
done:
    ritz_cards_free(&cards);
    return status;
}

void ritz_cards_free(ritz_cards *cards)
{
    for (int64_t k = 0; k < cards->num_files; k++) {
        free(cards->file[k].path);
        free(cards->file[k].text);
    }
    free(cards->file);
    free(cards->line);
    free(cards->entry);
    free(cards->selected[0]);
    free(cards->selected[1]);
    *cards = (ritz_cards){0};
}
