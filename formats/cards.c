/*
 * Cards of NASTRAN bulk data.
 *
 *     small field   name    8 fields of  8 columns   marker in 73-80
 *     large field   name*   4 fields of 16 columns   marker in 73-80
 *     free field    name,   8 fields (4 if name*)    ,marker
 *
 * A line whose first field is blank, or begins with + or *, continues a card.
 * A comma in the first ten columns makes a line free. A tab goes to the next of
 * columns 9, 17, ... What lies beyond column 80 of a fixed line is not read.
 * Two large lines count as one small: a small line that follows a single large
 * one leaves its four missing fields blank.
 */
#include "formats/cards.h"

#include "base/alloc.h"
#include "formats/decimal.h"

#include <ritz/text.h>

#include <ctype.h>
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>

enum {
    NAME = 8,      /* columns of the first field */
    DATA_END = 72, /* columns up to the tenth field */
    COLUMNS = 80,
};

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

/* Without blanks at both ends. */
static void trim(const char **text, int64_t *length)
{
    while (*length > 0 && is_blank((*text)[*length - 1]))
        (*length)--;
    while (*length > 0 && is_blank(**text)) {
        (*text)++;
        (*length)--;
    }
}

static char upper(char c)
{
    return (char)toupper((unsigned char)c);
}

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

void *ritz_array_grown(void *array, int64_t count, int64_t *room, size_t size)
{
    char *more = NULL;

    if (count < *room)
        return array;
    more = ritz_zalloc(2 * *room + 16, size);
    if (!more)
        return NULL;
    if (count > 0)
        memcpy(more, array, (size_t)count * size);
    free(array);
    *room = 2 * *room + 16;
    return more;
}

/* ---- lines ------------------------------------------------------------- */

/* A fixed line with its tabs expanded, or a free line as it is. */
typedef struct view {
    bool free;
    bool large;     /* '*' ends the name, or begins a continuation */
    bool continues; /* it belongs to a card above */
    int64_t length;
    const char *text; /* buffer, or the line itself */
    char buffer[COLUMNS + 1];
} view;

static void expand_tabs(const ritz_line *line, view *out)
{
    int64_t column = 0;

    for (int32_t k = 0; k < line->length && column < COLUMNS; k++) {
        if (line->text[k] != '\t') {
            out->buffer[column++] = line->text[k];
            continue;
        }
        do
            out->buffer[column++] = ' ';
        while (column % 8 != 0);
    }
    out->buffer[column] = '\0';
    out->text = out->buffer;
    out->length = column;
}

/* First field of a line, without blanks around it. */
static void name_field(const view *line, const char **text, int64_t *length)
{
    const char *comma = NULL;

    *text = line->text;
    *length = line->length < NAME ? line->length : NAME;
    if (line->free) {
        comma = memchr(line->text, ',', (size_t)line->length);
        *length = comma ? comma - line->text : line->length;
    }
    trim(text, length);
}

static void look(const ritz_line *line, view *out)
{
    enum { FREE_BY = 10 };
    int64_t head = line->length < FREE_BY ? line->length : FREE_BY;
    const char *name = NULL;
    int64_t length = 0;

    out->free = memchr(line->text, ',', (size_t)head) != NULL;
    if (out->free) {
        out->text = line->text;
        out->length = line->length;
    } else {
        expand_tabs(line, out);
    }
    name_field(out, &name, &length);
    out->continues = length == 0 || *name == '+' || *name == '*';
    if (out->continues)
        out->large = length > 0 && *name == '*';
    else
        out->large = memchr(name, '*', (size_t)length) != NULL;
}

/* Item k of a free line, items parted by commas; false if there is none. */
static bool free_item(const view *line, int64_t k, const char **text,
                      int64_t *length)
{
    const char *at = line->text;
    const char *end = line->text + line->length;

    for (; k > 0; k--) {
        at = memchr(at, ',', (size_t)(end - at));
        if (!at)
            return false;
        at++;
    }
    *text = at;
    at = memchr(at, ',', (size_t)(end - at));
    *length = (at ? at : end) - *text;
    trim(text, length);
    return true;
}

/* ---- scanning ---------------------------------------------------------- */

/* Text that is gone through line by line. */
typedef struct reader {
    const char *at, *end;
    const char *line; /* last line taken, without its end */
    int64_t length;
    int64_t number; /* of that line */
} reader;

static bool next_line(reader *text)
{
    const char *stop = NULL;

    if (text->at == text->end)
        return false;
    stop = memchr(text->at, '\n', (size_t)(text->end - text->at));
    text->line = text->at;
    text->length = (stop ? stop : text->end) - text->at;
    text->at = stop ? stop + 1 : text->end;
    text->number++;
    return true;
}

/* Whether a line begins with this word, in capitals; *rest: what follows. */
static bool first_word(const char *line, int64_t length, const char *word,
                       const char **rest)
{
    int64_t k = 0;

    trim(&line, &length);
    for (; word[k]; k++)
        if (k == length || upper(line[k]) != word[k])
            return false;
    if (k < length && isalnum((unsigned char)line[k]))
        return false;
    *rest = line + k;
    return true;
}

static void cut_comment(const char *line, int64_t *length)
{
    const char *dollar = memchr(line, '$', (size_t)*length);

    if (dollar)
        *length = dollar - line;
}

/* SPC = 5 in the case control: remember which set is meant. */
static ritz_status take_selection(const reader *text, const char *word,
                                  int64_t which, ritz_deck *deck)
{
    ritz_status status = RITZ_OK;
    const char *end = text->line + text->length;
    const char *at = NULL;
    int64_t set = 0;

    if (!first_word(text->line, text->length, word, &at))
        goto done;
    at = memchr(at, '=', (size_t)(end - at));
    if (!at)
        goto done;
    for (at++; at < end && is_blank(*at); at++)
        ;
    for (; at < end && isdigit((unsigned char)*at) && set < INT64_MAX / 100;
         at++)
        set = 10 * set + (*at - '0');
    if (set == 0)
        goto done;
    RITZ_ROOM(deck->selected[which], deck->num_selected[which],
              deck->selected_room[which]);
    deck->selected[which][deck->num_selected[which]++] = set;
done:
    return status;
}

/*
 * Go to where bulk data begin: behind BEGIN BULK, behind any other BEGIN if
 * CEND came before it, at the start where there is neither.
 */
static ritz_status skip_control(const char *path, reader *text, ritz_deck *deck)
{
    ritz_status status = RITZ_OK;
    reader trial = *text;
    const char *rest = NULL;
    bool cases = false;
    bool begun = false;

    while (!begun && next_line(&trial)) {
        const char *end = trial.line + trial.length;

        cases = cases || first_word(trial.line, trial.length, "CEND", &rest);
        begun = first_word(trial.line, trial.length, "BEGIN", &rest) &&
                (cases || first_word(rest, end - rest, "BULK", &rest));
    }
    RITZ_FAIL_IF(cases && !begun, RITZ_ERR_FORMAT,
                 "'%s' holds CEND but no BEGIN BULK", path ? path : "the deck");
    while (begun && text->number < trial.number) {
        (void)next_line(text);
        if (cases) {
            RITZ_TRY(take_selection(text, "SPC", RITZ_SELECT_SPC, deck));
            RITZ_TRY(take_selection(text, "MPC", RITZ_SELECT_MPC, deck));
        }
    }
done:
    return status;
}

static ritz_status copy_text(const char *text, char **out)
{
    ritz_status status = RITZ_OK;
    char *copy = NULL;

    RITZ_NEW(copy, (int64_t)strlen(text) + 1);
    memcpy(copy, text, strlen(text) + 1);
    *out = copy;
done:
    return status;
}

static ritz_status add_file(ritz_deck *deck, const char *path, char *text)
{
    ritz_status status = RITZ_OK;
    char *copy = NULL;

    RITZ_ROOM(deck->file, deck->num_files, deck->files_room);
    if (path)
        RITZ_TRY(copy_text(path, &copy));
    deck->file[deck->num_files].path = copy;
    deck->file[deck->num_files++].text = text;
done:
    return status;
}

static ritz_status add_line(ritz_deck *deck, int64_t file, const reader *text,
                            int64_t length)
{
    ritz_status status = RITZ_OK;
    ritz_line *line = NULL;

    RITZ_FAIL_IF(length > INT32_MAX, RITZ_ERR_FORMAT,
                 "line %" PRId64 " is too long", text->number);
    RITZ_ROOM(deck->line, deck->num_lines, deck->lines_room);
    line = &deck->line[deck->num_lines++];
    *line = (ritz_line){.text = text->line,
                        .length = (int32_t)length,
                        .file = (int32_t)file,
                        .number = text->number,
                        .next = -1};
done:
    return status;
}

enum { DEEPEST = 16, MOST_FILES = 10000 };

/* A file that is being gone through. */
typedef struct source {
    reader text;
    int64_t file;
    char *folder; /* to which its INCLUDEs are relative; NULL: not followed */
} source;

/* The file on top, below it those whose INCLUDE led there. */
typedef struct scanner {
    ritz_deck *deck;
    bool ended; /* by ENDDATA */
    int depth;
    source open[DEEPEST + 1];
} scanner;

/* The name in 'quotes', perhaps over several lines, or the rest of the line. */
static ritz_status include_name(reader *text, const char *at, char *name,
                                size_t size)
{
    ritz_status status = RITZ_OK;
    const char *end = text->line + text->length;
    size_t used = 0;
    char quote = '\0';

    while (at < end && (is_blank(*at) || *at == '='))
        at++;
    if (at < end && (*at == '\'' || *at == '"'))
        quote = *at++;
    for (;;) {
        const char *stop = NULL;
        int64_t length = end - at;

        if (quote)
            stop = memchr(at, quote, (size_t)length);
        else
            cut_comment(at, &length);
        if (stop)
            length = stop - at;
        trim(&at, &length);
        RITZ_FAIL_IF(used + (size_t)length >= size, RITZ_ERR_FORMAT,
                     "the name that INCLUDE gives is too long");
        memcpy(name + used, at, (size_t)length);
        used += (size_t)length;
        if (stop || !quote)
            break;
        RITZ_FAIL_IF(!next_line(text), RITZ_ERR_FORMAT,
                     "the quote of INCLUDE is not closed");
        at = text->line;
        end = text->line + text->length;
    }
    name[used] = '\0';
    RITZ_FAIL_IF(used == 0, RITZ_ERR_FORMAT, "INCLUDE names no file");
done:
    return status;
}

/* folder/name, or name alone if it begins at the root. */
static ritz_status join_path(const char *folder, const char *name, char **out)
{
    ritz_status status = RITZ_OK;
    size_t length = strlen(folder) + strlen(name) + 2;
    char *path = NULL;

    RITZ_NEW(path, (int64_t)length);
    if (*name == '/' || !*folder || strcmp(folder, ".") == 0)
        snprintf(path, length, "%s", name);
    else
        snprintf(path, length, "%s/%s", folder, name);
    *out = path;
done:
    return status;
}

/* The folder of a path: "." if it names none. */
static ritz_status folder_of(const char *path, char **out)
{
    ritz_status status = RITZ_OK;
    const char *slash = strrchr(path, '/');
    size_t length = slash ? (size_t)(slash - path) : 1;
    char *folder = NULL;

    if (slash == path)
        length = 1; /* the root */
    RITZ_NEW(folder, (int64_t)length + 1);
    memcpy(folder, slash ? path : ".", length);
    *out = folder;
done:
    return status;
}

static const char *path_of(const scanner *scan, int level)
{
    return scan->deck->file[scan->open[level].file].path;
}

/* Go on with a file before the one that includes it; takes `bytes`. */
static ritz_status open_file(scanner *scan, const char *path, char *bytes)
{
    ritz_status status = RITZ_OK;
    source new = {.text = {.at = bytes, .end = bytes + strlen(bytes)},
                  .file = scan->deck->num_files};

    status = add_file(scan->deck, path, bytes);
    if (status != RITZ_OK)
        free(bytes);
    RITZ_TRY(status);
    RITZ_TRY(skip_control(path, &new.text, scan->deck));
    RITZ_TRY(folder_of(path, &new.folder));
    scan->open[scan->depth++] = new;
done:
    return status;
}

static ritz_status include(scanner *scan, const char *path)
{
    ritz_status status = RITZ_OK;
    char *bytes = NULL;

    for (int k = 0; k < scan->depth; k++)
        RITZ_FAIL_IF(path_of(scan, k) && strcmp(path_of(scan, k), path) == 0,
                     RITZ_ERR_FORMAT, "'%s' includes itself", path);
    RITZ_FAIL_IF(scan->depth > DEEPEST, RITZ_ERR_FORMAT,
                 "INCLUDE is more than %d files deep", DEEPEST);
    RITZ_FAIL_IF(scan->deck->num_files >= MOST_FILES, RITZ_ERR_FORMAT,
                 "INCLUDE reads more than %d files", MOST_FILES);
    RITZ_TRY(ritz_text_read(path, &bytes));
    RITZ_TRY(open_file(scan, path, bytes));
done:
    return status;
}

/* Follow an INCLUDE; `rest` is what stands behind the word. */
static ritz_status take_include(scanner *scan, const char *rest)
{
    enum { LONGEST = 4096 };
    ritz_status status = RITZ_OK;
    source *top = &scan->open[scan->depth - 1];
    const char *including = path_of(scan, scan->depth - 1);
    int64_t number = top->text.number;
    char name[LONGEST];
    char where[LONGEST + 40] = "";
    char *path = NULL;

    if (including)
        snprintf(where, sizeof where, "'%s', line %" PRId64, including, number);
    else
        snprintf(where, sizeof where, "line %" PRId64, number);
    RITZ_TRY_IN(where, include_name(&top->text, rest, name, sizeof name));
    if (!top->folder) {
        scan->deck->num_skipped++;
        goto done;
    }
    RITZ_TRY(join_path(top->folder, name, &path));
    RITZ_TRY_IN(where, include(scan, path));
done:
    free(path);
    return status;
}

static ritz_status take_line(scanner *scan)
{
    ritz_status status = RITZ_OK;
    const source *top = &scan->open[scan->depth - 1];
    const char *line = top->text.line;
    const char *rest = NULL;
    int64_t length = top->text.length;

    cut_comment(line, &length);
    while (length > 0 && is_blank(line[length - 1]))
        length--;
    if (length == 0 || first_word(line, length, "BEGIN", &rest))
        goto done;
    if (first_word(line, length, "ENDDATA", &rest))
        scan->ended = true;
    else if (first_word(line, length, "INCLUDE", &rest))
        RITZ_TRY(take_include(scan, rest));
    else
        RITZ_TRY(add_line(scan->deck, top->file, &top->text, length));
done:
    return status;
}

/* Keep the lines of a file, and of what it includes, up to ENDDATA. */
static ritz_status scan_all(const char *path, const char *folder, reader text,
                            ritz_deck *deck)
{
    ritz_status status = RITZ_OK;
    scanner scan = {.deck = deck};
    char *copy = NULL;

    RITZ_TRY(add_file(deck, path, NULL));
    RITZ_TRY(skip_control(path, &text, deck));
    if (folder)
        RITZ_TRY(copy_text(folder, &copy));
    scan.open[scan.depth++] = (source){.text = text, .folder = copy};
    while (scan.depth > 0 && !scan.ended) {
        if (next_line(&scan.open[scan.depth - 1].text))
            RITZ_TRY(take_line(&scan));
        else
            free(scan.open[--scan.depth].folder);
    }
done:
    while (scan.depth > 0)
        free(scan.open[--scan.depth].folder);
    return status;
}

/* ---- continuations ----------------------------------------------------- */

typedef struct marker {
    char text[NAME + 1];
    int64_t line;
    bool taken;
} marker;

static void copy_marker(const char *text, int64_t length, char out[NAME + 1])
{
    int64_t k = 0;

    for (; k < length && k < NAME; k++)
        out[k] = upper(text[k]);
    out[k] = '\0';
}

/* Marker that a continuation begins with: field 1 without its + or *. */
static void leading_marker(const view *line, char out[NAME + 1])
{
    const char *text = NULL;
    int64_t length = 0;

    name_field(line, &text, &length);
    if (length > 0) {
        text++;
        length--;
    }
    trim(&text, &length);
    copy_marker(text, length, out);
}

/* Whether a free item is a marker, +C1 or *, rather than a number. */
static bool is_marker(const char *text, int64_t length)
{
    if (length == 0 || (*text != '+' && *text != '*'))
        return false;
    return length == 1 || *text == '*' || isalpha((unsigned char)text[1]);
}

/*
 * Items of a free line that are data: up to the ninth, or to a marker that
 * ends the line before; *mark: the item of the marker, 0 if there is none.
 */
static int64_t free_items(const view *line, int64_t *mark)
{
    int64_t width = line->large ? 4 : 8;
    const char *text = NULL;
    int64_t length = 0;
    int64_t count = 0;

    while (count <= width && free_item(line, count + 1, &text, &length))
        count++;
    *mark = 0;
    if (count > 0)
        (void)free_item(line, count, &text, &length);
    if (count > width || (count > 0 && is_marker(text, length)))
        *mark = count--;
    return count;
}

/* Marker that a line ends with: what is in columns 73-80. */
static void trailing_marker(const view *line, char out[NAME + 1])
{
    const char *text = NULL;
    int64_t length = 0;
    int64_t mark = 0;

    out[0] = '\0';
    if (line->free) {
        (void)free_items(line, &mark);
        if (mark == 0)
            return;
        (void)free_item(line, mark, &text, &length);
    } else {
        if (line->length <= DATA_END)
            return;
        text = line->text + DATA_END;
        length = line->length - DATA_END;
    }
    /* the first of the eight columns does not count, whatever it holds */
    if (length > 0 && is_blank(*text))
        trim(&text, &length);
    else if (length > 0 && !line->free && *text != '+' && *text != '*') {
        text++;
        length--;
    }
    if (length > 0 && (*text == '+' || *text == '*')) {
        text++;
        length--;
    }
    trim(&text, &length);
    copy_marker(text, length, out);
}

static ritz_status add_entry(ritz_deck *deck, int64_t line, const view *seen)
{
    ritz_status status = RITZ_OK;
    ritz_entry *entry = NULL;
    const char *name = NULL;
    int64_t length = 0;

    name_field(seen, &name, &length);
    RITZ_ROOM(deck->entry, deck->num_entries, deck->entries_room);
    entry = &deck->entry[deck->num_entries++];
    *entry = (ritz_entry){.line = line};
    for (int64_t k = 0; k < length && k < RITZ_CARD_NAME_SIZE - 1; k++) {
        if (name[k] == '*' || is_blank(name[k]))
            break;
        entry->name[k] = upper(name[k]);
    }
done:
    return status;
}

/* Continuations that no line above them claims. */
typedef struct strays {
    int64_t count, room;
    marker *marker;
} strays;

static ritz_status add_stray(strays *list, int64_t line,
                             const char text[NAME + 1])
{
    ritz_status status = RITZ_OK;

    RITZ_ROOM(list->marker, list->count, list->room);
    list->marker[list->count] = (marker){.line = line};
    memcpy(list->marker[list->count++].text, text, NAME + 1);
done:
    return status;
}

/* Give each continuation to the line above it where the markers allow. */
static ritz_status join_neighbours(ritz_deck *deck, strays *list)
{
    ritz_status status = RITZ_OK;
    char lead[NAME + 1];
    char trail[NAME + 1] = "";
    view seen;

    for (int64_t k = 0; k < deck->num_lines; k++) {
        look(&deck->line[k], &seen);
        if (!seen.continues) {
            RITZ_TRY(add_entry(deck, k, &seen));
            trailing_marker(&seen, trail);
            continue;
        }
        leading_marker(&seen, lead);
        if (k > 0 && (!lead[0] || strcmp(lead, trail) == 0))
            deck->line[k - 1].next = k;
        else
            RITZ_TRY(add_stray(list, k, lead));
        trailing_marker(&seen, trail);
    }
done:
    return status;
}

static int compare_markers(const void *a, const void *b)
{
    const marker *left = a;
    const marker *right = b;

    return strcmp(left->text, right->text);
}

/* Let the lines whose tenth field has a stray's marker claim it. */
static ritz_status join_strays(ritz_deck *deck, strays *list)
{
    ritz_status status = RITZ_OK;
    marker wanted = {0};
    view seen;

    if (list->count == 0)
        goto done;
    qsort(list->marker, (size_t)list->count, sizeof *list->marker,
          compare_markers);
    for (int64_t k = 1; k < list->count; k++)
        if (compare_markers(&list->marker[k - 1], &list->marker[k]) == 0)
            RITZ_TRY(ritz_deck_refuse(deck, list->marker[k].line,
                                      "another continuation has the marker "
                                      "'+%s' too",
                                      list->marker[k].text));
    for (int64_t k = 0; k < deck->num_lines; k++) {
        marker *found = NULL;

        look(&deck->line[k], &seen);
        trailing_marker(&seen, wanted.text);
        if (!wanted.text[0] || deck->line[k].next >= 0)
            continue;
        found = bsearch(&wanted, list->marker, (size_t)list->count,
                        sizeof wanted, compare_markers);
        if (!found)
            continue;
        if (found->taken)
            RITZ_TRY(ritz_deck_refuse(deck, k,
                                      "another line is continued by '+%s' too",
                                      wanted.text));
        found->taken = true;
        deck->line[k].next = found->line;
    }
done:
    return status;
}

/* Every line must be reached from a card: no stray is left, no circle. */
static ritz_status check_reach(const ritz_deck *deck)
{
    ritz_status status = RITZ_OK;
    bool *reached = NULL;

    RITZ_NEW(reached, deck->num_lines);
    for (int64_t k = 0; k < deck->num_entries; k++)
        for (int64_t at = deck->entry[k].line; at >= 0;
             at = deck->line[at].next)
            reached[at] = true;
    for (int64_t k = 0; k < deck->num_lines; k++)
        if (!reached[k])
            RITZ_TRY(ritz_deck_refuse(
                deck, k,
                "the continuation '%.*s' belongs to no "
                "card",
                deck->line[k].length < NAME ? (int)deck->line[k].length : NAME,
                deck->line[k].text));
done:
    free(reached);
    return status;
}

ritz_status ritz_deck_parse(const char *path, const char *text, int64_t size,
                            const char *folder, ritz_deck *out)
{
    ritz_status status = RITZ_OK;
    ritz_deck deck = {0};
    strays list = {0};
    reader whole = {.at = text, .end = text + size};

    RITZ_TRY(scan_all(path, folder, whole, &deck));
    RITZ_TRY(join_neighbours(&deck, &list));
    RITZ_TRY(join_strays(&deck, &list));
    RITZ_TRY(check_reach(&deck));
    *out = deck;
    deck = (ritz_deck){0};
done:
    free(list.marker);
    ritz_deck_free(&deck);
    return status;
}

/* ---- fields ------------------------------------------------------------ */

static ritz_status add_field(ritz_card *card, int64_t line, const char *text,
                             int64_t length)
{
    ritz_status status = RITZ_OK;
    ritz_field *field = NULL;

    trim(&text, &length);
    if (length >= RITZ_CARD_FIELD_SIZE)
        RITZ_TRY(ritz_deck_refuse(card->deck, line,
                                  "'%.16s...' in %s is too long for a field",
                                  text, card->entry->name));
    RITZ_ROOM(card->field, card->count, card->room);
    field = &card->field[card->count++];
    memcpy(field->text, text, (size_t)length);
    field->text[length] = '\0';
    field->line = line;
done:
    return status;
}

/* Whether anything but blanks stands in a free line after item k. */
static bool more_items(const view *line, int64_t k)
{
    const char *text = NULL;
    int64_t length = 0;

    if (!free_item(line, k + 1, &text, &length))
        return false;
    for (const char *c = text; c < line->text + line->length; c++)
        if (*c != ',' && !is_blank(*c))
            return true;
    return false;
}

static ritz_status add_free(ritz_card *card, int64_t line, const view *seen)
{
    ritz_status status = RITZ_OK;
    int64_t width = seen->large ? 4 : 8;
    const char *text = "";
    int64_t length = 0;
    int64_t mark = 0;
    int64_t count = free_items(seen, &mark);
    const char *tenth = "";
    int64_t tenth_length = 0;

    if (mark > width)
        (void)free_item(seen, mark, &tenth, &tenth_length);
    if ((tenth_length > 0 && !is_marker(tenth, tenth_length) &&
         *tenth != '+') ||
        more_items(seen, width + 1))
        RITZ_TRY(ritz_deck_refuse(card->deck, line,
                                  "a line of %s has more than %d fields",
                                  card->entry->name, (int)width));
    for (int64_t k = 0; k < width; k++) {
        length = 0;
        if (k < count)
            (void)free_item(seen, k + 1, &text, &length);
        RITZ_TRY(add_field(card, line, text, length));
    }
done:
    return status;
}

static ritz_status add_fixed(ritz_card *card, int64_t line, const view *seen)
{
    ritz_status status = RITZ_OK;
    int64_t width = seen->large ? 16 : 8;

    for (int64_t column = NAME; column < DATA_END; column += width) {
        int64_t length = seen->length - column;

        if (length > width)
            length = width;
        if (length < 0)
            length = 0;
        RITZ_TRY(
            add_field(card, line, length ? seen->text + column : "", length));
    }
done:
    return status;
}

/* The name must fill its field alone, or the columns are not what they seem. */
static ritz_status check_name(const ritz_card *card, const view *seen)
{
    ritz_status status = RITZ_OK;
    const char *name = NULL;
    int64_t length = 0;

    name_field(seen, &name, &length);
    for (int64_t k = 0; k < length; k++)
        if (is_blank(name[k]) && name[length - 1] != '*')
            RITZ_TRY(ritz_deck_refuse(card->deck, card->entry->line,
                                      "'%.*s' is not the name of a card alone",
                                      (int)(length < 20 ? length : 20), name));
done:
    return status;
}

ritz_status ritz_deck_card(const ritz_deck *deck, int64_t k, ritz_card *card)
{
    ritz_status status = RITZ_OK;
    view seen;

    card->deck = deck;
    card->entry = &deck->entry[k];
    card->count = 0;
    for (int64_t at = card->entry->line; at >= 0; at = deck->line[at].next) {
        look(&deck->line[at], &seen);
        if (at == card->entry->line)
            RITZ_TRY(check_name(card, &seen));
        while (!seen.large && card->count % 8 != 0)
            RITZ_TRY(add_field(card, at, "", 0));
        if (seen.free)
            RITZ_TRY(add_free(card, at, &seen));
        else
            RITZ_TRY(add_fixed(card, at, &seen));
    }
    while (card->count > 0 && !card->field[card->count - 1].text[0])
        card->count--;
done:
    return status;
}

const char *ritz_card_text(const ritz_card *card, int64_t k)
{
    return k < card->count ? card->field[k].text : "";
}

ritz_status ritz_card_refuse(const ritz_card *card, int64_t k,
                             const char *wanted)
{
    const char *text = ritz_card_text(card, k);
    int64_t line = k < card->count ? card->field[k].line : card->entry->line;

    if (!*text)
        return ritz_deck_refuse(card->deck, line,
                                "a field of %s is blank where %s must be",
                                card->entry->name, wanted);
    return ritz_deck_refuse(card->deck, line, "'%s' in %s is not %s", text,
                            card->entry->name, wanted);
}

ritz_status ritz_card_whole(const ritz_card *card, int64_t k, int64_t blank,
                            int64_t *out)
{
    const char *text = ritz_card_text(card, k);

    if (*text && !ritz_text_whole(text, out))
        return ritz_card_refuse(card, k, "a whole number");
    if (!*text)
        *out = blank;
    return RITZ_OK;
}

ritz_status ritz_card_id(const ritz_card *card, int64_t k, int64_t *out)
{
    static const int64_t MOST_ID = 999999999999999;
    const char *text = ritz_card_text(card, k);

    if (!ritz_text_whole(text, out) || *out <= 0)
        return ritz_card_refuse(card, k, "a positive whole number");
    if (*out > MOST_ID) /* so that one may count beyond it */
        return ritz_card_refuse(card, k, "an id of at most 15 digits");
    return RITZ_OK;
}

ritz_status ritz_card_real(const ritz_card *card, int64_t k, double blank,
                           double *out)
{
    const char *text = ritz_card_text(card, k);

    if (*text && !ritz_card_number(text, out))
        return ritz_card_refuse(card, k, "a number");
    if (!*text)
        *out = blank;
    return RITZ_OK;
}

/* All of a text as a number, and the digits it is written with. */
static bool scan_number(const char *text, ritz_decimal *out)
{
    const char *end = text + strlen(text);

    return ritz_decimal_scan(&text, end, out) && text == end &&
           isfinite(out->value);
}

bool ritz_card_number(const char *text, double *out)
{
    ritz_decimal number = {0};

    if (!scan_number(text, &number))
        return false;
    *out = number.value;
    return true;
}

int64_t ritz_card_digits(const char *text)
{
    ritz_decimal number = {0};

    return scan_number(text, &number) ? number.digits : 0;
}

void ritz_card_free(ritz_card *card)
{
    free(card->field);
    *card = (ritz_card){0};
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
