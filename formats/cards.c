/*
 * Cards of NASTRAN bulk data. A deck is scanned into lines, without executive
 * and case control, comments, blank lines and what follows ENDDATA, with the
 * files that INCLUDE names. Then lines are joined to cards: a line continues
 * another by the markers in the tenth field of the one and the first field of
 * the other; the line above is looked at first, then the whole deck.
 */
#include "formats/cards.h"
#include "base/alloc.h"
#include "base/search.h"

#include <ritz/base.h>

#include <inttypes.h>

/* What is known while the lines of a deck are put together to cards. */
typedef struct ritz_scanner {
    ritz_cards *cards;
    bool ended; /* ENDDATA was read */
    ritz_deck_reading reading;
} ritz_scanner;

static void ritz_scanner_free(ritz_scanner *scan)
{
    ritz_deck_reading_free(&scan->reading);
}

/* ---- control sections --------------------------------------------------- */

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
    at = ritz_decimal_skip(at + 1, end);
    if (!ritz_decimal_scan_whole(&at, end, &set) || set <= 0)
        return RITZ_OK;
    RITZ_CHECK_ROOM(cards->selected[which], cards->num_selected[which],
                    cards->selected_room[which]);
    cards->selected[which][cards->num_selected[which]++] = set;
    return RITZ_OK;
}

/*
 * Go to where bulk data begin: behind BEGIN BULK, behind any other BEGIN if
 * CEND came before it, at the start where there is neither; keep the sets that
 * the case control selects.
 */
static ritz_status skip_control(const char *path, ritz_lines *text,
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
    /* by bytes: a mapped file may have lost lines since they were counted */
    while (begun && text->at < trial.at) {
        (void)ritz_lines_next(text);
        if (cases) {
            RITZ_CHECK(take_selection(text, "SPC", RITZ_SELECT_SPC, cards));
            RITZ_CHECK(take_selection(text, "MPC", RITZ_SELECT_MPC, cards));
        }
    }
    return RITZ_OK;
}

/* ---- INCLUDE ------------------------------------------------------------ */

/* The name in 'quotes', perhaps over several lines, or the rest of the line. */
static ritz_status include_name(ritz_lines *text, const char *at, char *name,
                                size_t size)
{
    const char *end = text->line_end;
    size_t used = 0;
    char quote = '\0';

    while (at < end && (ritz_card_is_blank(*at) || *at == '='))
        at++;
    if (at < end && (*at == '\'' || *at == '"'))
        quote = *at++;
    for (;;) {
        const char *stop = NULL;
        ritz_piece part = {at, end - at};

        if (quote)
            stop = memchr(at, quote, (size_t)part.length);
        else
            ritz_card_uncomment(at, &part.length);
        if (stop)
            part.length = stop - at;
        part = ritz_piece_trim(part);
        RITZ_REFUSE_IF(used + (size_t)part.length >= size, RITZ_ERR_FORMAT,
                       "the name that INCLUDE gives is too long");
        memcpy(name + used, part.text, (size_t)part.length);
        used += (size_t)part.length;
        if (stop || !quote)
            break;
        RITZ_REFUSE_IF(!ritz_lines_next(text), RITZ_ERR_FORMAT,
                       "the quote of INCLUDE is not closed");
        at = text->line;
        end = text->line_end;
    }
    name[used] = '\0';
    RITZ_REFUSE_IF(used == 0, RITZ_ERR_FORMAT, "INCLUDE names no file");
    return RITZ_OK;
}

static ritz_status include_file(ritz_scanner *scan, const char *name)
{
    const ritz_deck_files *files = &scan->cards->files;
    ritz_deck_text *top = ritz_deck_top(&scan->reading);

    if (!top->folder) {
        scan->cards->num_skipped++;
        return RITZ_OK;
    }
    RITZ_CHECK(ritz_deck_include(&scan->reading, name));
    top = ritz_deck_top(&scan->reading);
    return skip_control(files->file[top->file].path, &top->text, scan->cards);
}

/* Follow an INCLUDE; @p rest is what stands behind the word. */
static ritz_status follow_include(ritz_scanner *scan, const char *rest)
{
    char name[RITZ_DECK_LONGEST] = "";
    char where[RITZ_DECK_PLACE_SIZE];
    ritz_deck_text *top = ritz_deck_top(&scan->reading);

    ritz_deck_place(&scan->reading, where);
    RITZ_CHECK_IN(where, include_name(&top->text, rest, name, sizeof name));
    RITZ_CHECK_IN(where, include_file(scan, name));
    return RITZ_OK;
}

/* ---- lines of a file and of those that it includes ---------------------- */

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
    const ritz_deck_text *top = ritz_deck_top(&scan->reading);
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
        RITZ_CHECK(follow_include(scan, rest));
    else
        RITZ_CHECK(add_line(scan->cards, top->file, &top->text, length));
    return RITZ_OK;
}

/* Keep the lines of a file, and of what it includes, up to ENDDATA. */
static ritz_status scan_text(const char *path, const char *folder,
                             const char *text, int64_t size, ritz_cards *cards)
{
    RITZ_OWN(ritz_scanner)
    scan = {.cards = cards, .reading = {.files = &cards->files}};

    RITZ_CHECK(ritz_deck_begin(&scan.reading, path, text, size, folder));
    RITZ_CHECK(skip_control(path, &ritz_deck_top(&scan.reading)->text, cards));
    while (!scan.ended && ritz_deck_next_line(&scan.reading))
        RITZ_CHECK(take_line(&scan));
    return RITZ_OK;
}

/* ---- from lines to cards ------------------------------------------------ */

typedef struct marker {
    char text[RITZ_CARD_NAME + 1];
    int64_t line;
    bool taken;
} marker;

static void copy_marker(ritz_piece piece, int64_t skipped,
                        char out[RITZ_CARD_NAME + 1])
{
    int64_t k = 0;

    if (skipped > 0) /* an absent marker has no text */
        piece.text += skipped;
    piece.length -= skipped;
    piece = ritz_piece_trim(piece);
    for (; k < piece.length && k < RITZ_CARD_NAME; k++)
        out[k] = ritz_card_upper(piece.text[k]);
    out[k] = '\0';
}

static bool has_plus(ritz_piece piece)
{
    return piece.length > 0 && (*piece.text == '+' || *piece.text == '*');
}

/* Marker that a continuation begins with: field 1 without its + or *. */
static void leading_marker(const ritz_view *line, char out[RITZ_CARD_NAME + 1])
{
    copy_marker(line->name, line->name.length > 0, out);
}

/* Marker that a line ends with: what is in columns 73-80, of which the first
 * does not count, whatever it holds. */
static void trailing_marker(const ritz_view *line, char out[RITZ_CARD_NAME + 1])
{
    ritz_piece last = line->marker;

    if (last.length > 0 && ritz_card_is_blank(*last.text)) {
        last = ritz_piece_trim(last);
    } else if (last.length > 0 && !line->free && !has_plus(last)) {
        last.text++;
        last.length--;
    }
    copy_marker(last, has_plus(last), out);
}

static ritz_status add_entry(ritz_cards *cards, int64_t line, ritz_piece name)
{
    ritz_entry *entry = NULL;

    RITZ_CHECK_ROOM(cards->entry, cards->num_entries, cards->entries_room);
    entry = &cards->entry[cards->num_entries++];
    *entry = (ritz_entry){.line = line};
    for (int64_t k = 0; k < name.length && k < RITZ_CARD_NAME_SIZE - 1; k++) {
        if (name.text[k] == '*' || ritz_card_is_blank(name.text[k]))
            break;
        entry->name[k] = ritz_card_upper(name.text[k]);
    }
    return RITZ_OK;
}

/* Continuations that no line above them claims. */
typedef struct strays {
    int64_t count, room;
    marker *marker;
} strays;

static void strays_free(strays *list)
{
    free(list->marker);
}

static ritz_status add_stray(strays *list, int64_t line,
                             const char text[RITZ_CARD_NAME + 1])
{
    RITZ_CHECK_ROOM(list->marker, list->count, list->room);
    list->marker[list->count] = (marker){.line = line};
    memcpy(list->marker[list->count++].text, text, RITZ_CARD_NAME + 1);
    return RITZ_OK;
}

/* Give each continuation to the line above it where the markers allow. */
static ritz_status join_neighbours(ritz_cards *cards, strays *list)
{
    char lead[RITZ_CARD_NAME + 1];
    char trail[RITZ_CARD_NAME + 1] = "";
    ritz_view seen;

    for (int64_t k = 0; k < cards->num_lines; k++) {
        ritz_view_look(&cards->line[k], &seen);
        if (!seen.continues) {
            RITZ_CHECK(add_entry(cards, k, seen.name));
            trailing_marker(&seen, trail);
            continue;
        }
        leading_marker(&seen, lead);
        if (k > 0 && (!lead[0] || strcmp(lead, trail) == 0))
            cards->line[k - 1].next = k;
        else
            RITZ_CHECK(add_stray(list, k, lead));
        trailing_marker(&seen, trail);
    }
    return RITZ_OK;
}

static int compare_markers(const void *a, const void *b)
{
    const marker *left = a;
    const marker *right = b;

    return strcmp(left->text, right->text);
}

/* Let the lines whose tenth field has a stray's marker claim it. */
static ritz_status join_strays(ritz_cards *cards, strays *list)
{
    marker wanted = {0};
    ritz_view seen;

    if (list->count == 0)
        return RITZ_OK;
    qsort(list->marker, (size_t)list->count, sizeof *list->marker,
          compare_markers);
    for (int64_t k = 1; k < list->count; k++)
        if (compare_markers(&list->marker[k - 1], &list->marker[k]) == 0)
            return ritz_cards_refuse(cards, list->marker[k].line,
                                     "another continuation has the marker "
                                     "'+%s' too",
                                     list->marker[k].text);
    for (int64_t k = 0; k < cards->num_lines; k++) {
        marker *found = NULL;

        ritz_view_look(&cards->line[k], &seen);
        trailing_marker(&seen, wanted.text);
        if (!wanted.text[0] || cards->line[k].next >= 0)
            continue;
        found = bsearch(&wanted, list->marker, (size_t)list->count,
                        sizeof wanted, compare_markers);
        if (!found)
            continue;
        if (found->taken)
            return ritz_cards_refuse(cards, k,
                                     "another line is continued by '+%s' too",
                                     wanted.text);
        found->taken = true;
        cards->line[k].next = found->line;
    }
    return RITZ_OK;
}

/* Every line must be reached from a card: no stray is left, no circle. */
static ritz_status check_reach(const ritz_cards *cards)
{
    RITZ_OWN_ARRAY bool *reached = NULL;

    RITZ_CHECK_NEW(reached, cards->num_lines);
    for (int64_t k = 0; k < cards->num_entries; k++)
        for (int64_t at = cards->entry[k].line; at >= 0;
             at = cards->line[at].next)
            reached[at] = true;
    for (int64_t k = 0; k < cards->num_lines; k++)
        if (!reached[k])
            return ritz_cards_refuse(cards, k,
                                     "the continuation '%.*s' belongs to no "
                                     "card",
                                     cards->line[k].length < RITZ_CARD_NAME
                                         ? (int)cards->line[k].length
                                         : RITZ_CARD_NAME,
                                     cards->line[k].text);
    return RITZ_OK;
}

/* ---- decks -------------------------------------------------------------- */

ritz_status ritz_cards_parse(const char *path, const char *text, int64_t size,
                             const char *folder, ritz_cards *out)
{
    RITZ_OWN(ritz_cards) cards = {0};
    RITZ_OWN(strays) list = {0};

    RITZ_CHECK(scan_text(path, folder, text, size, &cards));
    RITZ_CHECK(join_neighbours(&cards, &list));
    RITZ_CHECK(join_strays(&cards, &list));
    RITZ_CHECK(check_reach(&cards));
    RITZ_MOVE(*out, cards);
    return RITZ_OK;
}

void ritz_cards_free(ritz_cards *cards)
{
    ritz_deck_files_free(&cards->files);
    RITZ_FREE(cards->line, cards->entry, cards->selected[0],
              cards->selected[1]);
    *cards = (ritz_cards){0};
}

bool ritz_cards_select(const ritz_cards *cards, int64_t which, int64_t set)
{
    return cards->num_selected[which] == 0 ||
           bsearch(&set, cards->selected[which],
                   (size_t)cards->num_selected[which], sizeof set,
                   ritz_ascending_index);
}
