/*
 * Which line continues which: markers in the tenth field of one line and in the
 * first of another. The line above is looked at first, then the whole deck.
 */
#include "formats/cards_parts.h"

#include "base/alloc.h"

typedef struct marker {
    char text[RITZ_CARD_NAME + 1];
    int64_t line;
    bool taken;
} marker;

static void copy_marker(const char *text, int64_t length,
                        char out[RITZ_CARD_NAME + 1])
{
    int64_t k = 0;

    for (; k < length && k < RITZ_CARD_NAME; k++)
        out[k] = ritz_card_upper(text[k]);
    out[k] = '\0';
}

/* Marker that a continuation begins with: field 1 without its + or *. */
static void leading_marker(const ritz_view *line, char out[RITZ_CARD_NAME + 1])
{
    const char *text = NULL;
    int64_t length = 0;

    ritz_view_name(line, &text, &length);
    if (length > 0) {
        text++;
        length--;
    }
    ritz_card_trim(&text, &length);
    copy_marker(text, length, out);
}

/* Marker that a line ends with: what is in columns 73-80. */
static void trailing_marker(const ritz_view *line, char out[RITZ_CARD_NAME + 1])
{
    const char *text = NULL;
    int64_t length = 0;
    int64_t mark = 0;

    out[0] = '\0';
    if (line->free) {
        (void)ritz_view_items(line, &mark);
        if (mark == 0)
            return;
        (void)ritz_view_item(line, mark, &text, &length);
    } else {
        if (line->length <= RITZ_CARD_DATA)
            return;
        text = line->text + RITZ_CARD_DATA;
        length = line->length - RITZ_CARD_DATA;
    }
    /* the first of the eight columns does not count, whatever it holds */
    if (length > 0 && ritz_card_is_blank(*text))
        ritz_card_trim(&text, &length);
    else if (length > 0 && !line->free && *text != '+' && *text != '*') {
        text++;
        length--;
    }
    if (length > 0 && (*text == '+' || *text == '*')) {
        text++;
        length--;
    }
    ritz_card_trim(&text, &length);
    copy_marker(text, length, out);
}

static ritz_status add_entry(ritz_cards *cards, int64_t line,
                             const ritz_view *seen)
{
    ritz_entry *entry = NULL;
    const char *name = NULL;
    int64_t length = 0;

    ritz_view_name(seen, &name, &length);
    RITZ_CHECK_ROOM(cards->entry, cards->num_entries, cards->entries_room);
    entry = &cards->entry[cards->num_entries++];
    *entry = (ritz_entry){.line = line};
    for (int64_t k = 0; k < length && k < RITZ_CARD_NAME_SIZE - 1; k++) {
        if (name[k] == '*' || ritz_card_is_blank(name[k]))
            break;
        entry->name[k] = ritz_card_upper(name[k]);
    }
    return RITZ_OK;
}

/* Continuations that no line above them claims. */
typedef struct strays {
    int64_t count, room;
    marker *marker;
} strays;

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
            RITZ_CHECK(add_entry(cards, k, &seen));
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
            RITZ_CHECK(ritz_cards_refuse(cards, list->marker[k].line,
                                         "another continuation has the marker "
                                         "'+%s' too",
                                         list->marker[k].text));
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
            RITZ_CHECK(ritz_cards_refuse(
                cards, k, "another line is continued by '+%s' too",
                wanted.text));
        found->taken = true;
        cards->line[k].next = found->line;
    }
    return RITZ_OK;
}

/* Every line must be reached from a card: no stray is left, no circle. */
static ritz_status check_reach(const ritz_cards *cards)
{
    ritz_status status = RITZ_OK;
    bool *reached = NULL;

    RITZ_NEW(reached, cards->num_lines);
    for (int64_t k = 0; k < cards->num_entries; k++)
        for (int64_t at = cards->entry[k].line; at >= 0;
             at = cards->line[at].next)
            reached[at] = true;
    for (int64_t k = 0; k < cards->num_lines; k++)
        if (!reached[k])
            RITZ_TRY(ritz_cards_refuse(cards, k,
                                       "the continuation '%.*s' belongs to no "
                                       "card",
                                       cards->line[k].length < RITZ_CARD_NAME
                                           ? (int)cards->line[k].length
                                           : RITZ_CARD_NAME,
                                       cards->line[k].text));
done:
    free(reached);
    return status;
}

ritz_status ritz_cards_join(ritz_cards *cards)
{
    ritz_status status = RITZ_OK;
    strays list = {0};

    RITZ_TRY(join_neighbours(cards, &list));
    RITZ_TRY(join_strays(cards, &list));
    RITZ_TRY(check_reach(cards));
done:
    free(list.marker);
    return status;
}
