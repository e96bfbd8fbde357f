/*
 * INCLUDE: the file goes on top of those that are being gone through. Its name
 * is relative to the folder of the file that names it.
 */
#include "formats/cards_parts.h"

#include "base/alloc.h"
#include "base/path.h"

#include <ritz/text.h>

#include <inttypes.h>
#include <stdio.h>

enum { MOST_FILES = 10000 };

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
        int64_t length = end - at;

        if (quote)
            stop = memchr(at, quote, (size_t)length);
        else
            ritz_card_uncomment(at, &length);
        if (stop)
            length = stop - at;
        ritz_card_trim(&at, &length);
        RITZ_REFUSE_IF(used + (size_t)length >= size, RITZ_ERR_FORMAT,
                       "the name that INCLUDE gives is too long");
        memcpy(name + used, at, (size_t)length);
        used += (size_t)length;
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

/* folder/name, or name alone if it begins at the root. */
static ritz_status join_path(const char *folder, const char *name, char **out)
{
    size_t length = strlen(folder) + strlen(name) + 2;
    char *path = NULL;

    RITZ_CHECK_NEW(path, (int64_t)length);
    if (*name == '/' || !*folder || strcmp(folder, ".") == 0)
        snprintf(path, length, "%s", name);
    else
        snprintf(path, length, "%s/%s", folder, name);
    *out = path;
    return RITZ_OK;
}

static const char *path_of(const ritz_scanner *scan, int level)
{
    return scan->cards->file[scan->open[level].file].path;
}

/* Go on with a file before the one that includes it; takes `bytes`. */
static ritz_status open_file(ritz_scanner *scan, const char *path, char *bytes)
{
    ritz_status status = RITZ_OK;
    ritz_source new = {.text = {.at = bytes, .end = bytes + strlen(bytes)},
                       .file = scan->cards->num_files};

    status = ritz_cards_add_file(scan->cards, path, bytes);
    if (status != RITZ_OK)
        free(bytes);
    RITZ_TRY(status);
    RITZ_TRY(ritz_cards_skip_control(path, &new.text, scan->cards));
    RITZ_TRY(ritz_path_folder(path, &new.folder));
    scan->open[scan->depth++] = new;
done:
    return status;
}

static ritz_status include(ritz_scanner *scan, const char *path)
{
    char *bytes = NULL;

    for (int k = 0; k < scan->depth; k++)
        RITZ_REFUSE_IF(path_of(scan, k) && strcmp(path_of(scan, k), path) == 0,
                       RITZ_ERR_FORMAT, "'%s' includes itself", path);
    RITZ_REFUSE_IF(scan->depth > RITZ_CARDS_DEEPEST, RITZ_ERR_FORMAT,
                   "INCLUDE is more than %d files deep", RITZ_CARDS_DEEPEST);
    RITZ_REFUSE_IF(scan->cards->num_files >= MOST_FILES, RITZ_ERR_FORMAT,
                   "INCLUDE reads more than %d files", MOST_FILES);
    RITZ_CHECK(ritz_text_read(path, &bytes));
    return open_file(scan, path, bytes);
}

ritz_status ritz_scanner_include(ritz_scanner *scan, const char *rest)
{
    enum { LONGEST = 4096 };
    ritz_status status = RITZ_OK;
    ritz_source *top = &scan->open[scan->depth - 1];
    const char *including = path_of(scan, scan->depth - 1);
    int64_t number = top->text.number;
    char name[LONGEST] = "";
    char where[LONGEST + 40] = "";
    char *path = NULL;

    if (including)
        snprintf(where, sizeof where, "'%s', line %" PRId64, including, number);
    else
        snprintf(where, sizeof where, "line %" PRId64, number);
    RITZ_TRY_IN(where, include_name(&top->text, rest, name, sizeof name));
    if (!top->folder) {
        scan->cards->num_skipped++;
        goto done;
    }
    RITZ_TRY(join_path(top->folder, name, &path));
    RITZ_TRY_IN(where, include(scan, path));
done:
    free(path);
    return status;
}
