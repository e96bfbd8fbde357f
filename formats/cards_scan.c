/*
 * From the text of a deck to the lines of its bulk data: without executive and
 * case control, comments, blank lines and what follows ENDDATA.
 */
#include "formats/cards_parts.h"

#include "base/alloc.h"

#include <inttypes.h>

/* SPC = 5 in the case control: remember which set is meant. */
static ritz_status take_selection(const ritz_lines *text, const char *word,
                                  int64_t which, ritz_cards *cards)
{
    const char *end = text->line_end;
    const char *at = NULL;
    int64_t set = 0;

    if (!ritz_card_begins(text->line, end - text->line, word, &at))
        return RITZ_OK;
    at = memchr(at, '=', (size_t)(end - at));
    if (!at)
        return RITZ_OK;
    for (at++; at < end && ritz_card_is_blank(*at); at++)
        ;
    for (; at < end && isdigit((unsigned char)*at) && set < INT64_MAX / 100;
         at++)
        set = 10 * set + (*at - '0');
    if (set == 0)
        return RITZ_OK;
    RITZ_CHECK_ROOM(cards->selected[which], cards->num_selected[which],
                    cards->selected_room[which]);
    cards->selected[which][cards->num_selected[which]++] = set;
    return RITZ_OK;
}

ritz_status ritz_cards_skip_control(const char *path, ritz_lines *text,
                                    ritz_cards *cards)
{
    ritz_lines trial = *text;
    const char *rest = NULL;
    bool cases = false;
    bool begun = false;

    while (!begun && ritz_lines_next(&trial)) {
        const char *end = trial.line_end;
        int64_t length = end - trial.line;

        cases = cases || ritz_card_begins(trial.line, length, "CEND", &rest);
        begun = ritz_card_begins(trial.line, length, "BEGIN", &rest) &&
                (cases || ritz_card_begins(rest, end - rest, "BULK", &rest));
    }
    RITZ_REFUSE_IF(cases && !begun, RITZ_ERR_FORMAT,
                   "'%s' holds CEND but no BEGIN BULK",
                   path ? path : "the deck");
    while (begun && text->number < trial.number) {
        (void)ritz_lines_next(text);
        if (cases) {
            RITZ_CHECK(take_selection(text, "SPC", RITZ_SELECT_SPC, cards));
            RITZ_CHECK(take_selection(text, "MPC", RITZ_SELECT_MPC, cards));
        }
    }
    return RITZ_OK;
}

static ritz_status copy_text(const char *text, char **out)
{
    char *copy = NULL;

    RITZ_CHECK_NEW(copy, (int64_t)strlen(text) + 1);
    memcpy(copy, text, strlen(text) + 1);
    *out = copy;
    return RITZ_OK;
}

ritz_status ritz_cards_add_file(ritz_cards *cards, const char *path, char *text)
{
    char *copy = NULL;

    RITZ_CHECK_ROOM(cards->file, cards->num_files, cards->files_room);
    if (path)
        RITZ_CHECK(copy_text(path, &copy));
    cards->file[cards->num_files].path = copy;
    cards->file[cards->num_files++].text = text;
    return RITZ_OK;
}

static ritz_status add_line(ritz_cards *cards, int64_t file,
                            const ritz_lines *text, int64_t length)
{
    ritz_line *line = NULL;

    RITZ_REFUSE_IF(length > INT32_MAX, RITZ_ERR_FORMAT,
                   "line %" PRId64 " is too long", text->number);
    RITZ_CHECK_ROOM(cards->line, cards->num_lines, cards->lines_room);
    line = &cards->line[cards->num_lines++];
    *line = (ritz_line){.text = text->line,
                        .length = (int32_t)length,
                        .file = (int32_t)file,
                        .number = text->number,
                        .next = -1};
    return RITZ_OK;
}

static ritz_status take_line(ritz_scanner *scan)
{
    const ritz_source *top = &scan->open[scan->depth - 1];
    const char *line = top->text.line;
    const char *rest = NULL;
    int64_t length = top->text.line_end - line;

    ritz_card_uncomment(line, &length);
    while (length > 0 && ritz_card_is_blank(line[length - 1]))
        length--;
    if (length == 0 || ritz_card_begins(line, length, "BEGIN", &rest))
        return RITZ_OK;
    if (ritz_card_begins(line, length, "ENDDATA", &rest))
        scan->ended = true;
    else if (ritz_card_begins(line, length, "INCLUDE", &rest))
        RITZ_CHECK(ritz_scanner_include(scan, rest));
    else
        RITZ_CHECK(add_line(scan->cards, top->file, &top->text, length));
    return RITZ_OK;
}

ritz_status ritz_cards_scan(const char *path, const char *folder,
                            ritz_lines text, ritz_cards *cards)
{
    ritz_status status = RITZ_OK;
    ritz_scanner scan = {.cards = cards};
    char *copy = NULL;

    RITZ_TRY(ritz_cards_add_file(cards, path, NULL));
    RITZ_TRY(ritz_cards_skip_control(path, &text, cards));
    if (folder)
        RITZ_TRY(copy_text(folder, &copy));
    scan.open[scan.depth++] = (ritz_source){.text = text, .folder = copy};
    while (scan.depth > 0 && !scan.ended) {
        if (ritz_lines_next(&scan.open[scan.depth - 1].text))
            RITZ_TRY(take_line(&scan));
        else
            free(scan.open[--scan.depth].folder);
    }
done:
    while (scan.depth > 0)
        free(scan.open[--scan.depth].folder);
    return status;
}
