#define _XOPEN_SOURCE 700 /* NOLINT: declares realpath */

#include "base/text.h"

#include "base/alloc.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

ritz_status ritz_text_read(const char *path, char **out)
{
    RITZ_OWN_ARRAY char *text = NULL;
    int64_t size = 0;

    RITZ_CHECK(ritz_bytes_read(path, &size, &text));
    RITZ_REFUSE_IF(strlen(text) != (size_t)size, RITZ_ERR_FORMAT,
                   "'%s' is not a text file", path);
    RITZ_MOVE(*out, text);
    return RITZ_OK;
}

bool ritz_text_real(const char *text, double *out)
{
    char *end = NULL;
    double value = 0.0;

    if (text[strspn(text, "+-.0123456789eE")] != '\0')
        return false; /* strtod would take hexadecimal, inf and nan */
    value = strtod(text, &end);
    if (end == text || *end || !isfinite(value))
        return false;
    *out = value;
    return true;
}

bool ritz_text_whole(const char *text, int64_t *out)
{
    char *end = NULL;
    long long value = 0;

    if (text[strspn(text, "+-0123456789")] != '\0')
        return false;
    errno = 0;
    value = strtoll(text, &end, 10);
    if (end == text || *end || errno)
        return false;
    *out = value;
    return true;
}

bool ritz_text_part(const char *text, size_t length, char mark,
                    char copy[RITZ_NAME_SIZE], char **rest)
{
    *rest = NULL;
    if (length >= RITZ_NAME_SIZE)
        return false;
    memcpy(copy, text, length);
    copy[length] = '\0';
    *rest = strchr(copy, mark);
    if (*rest)
        *(*rest)++ = '\0';
    return true;
}

bool ritz_text_range(const char *text, size_t length, int64_t *from,
                     int64_t *to)
{
    char copy[RITZ_NAME_SIZE];
    char *dash = NULL;

    *to = 0;
    return ritz_text_part(text, length, '-', copy, &dash) &&
           ritz_text_whole(copy, from) && *from > 0 &&
           (!dash || (ritz_text_whole(dash, to) && *to >= *from));
}

ritz_status ritz_name_copy(const char *name, char out[RITZ_NAME_SIZE])
{
    size_t length = strlen(name);

    RITZ_REFUSE_IF(length == 0, RITZ_ERR_ARGUMENT, "a name is empty");
    RITZ_REFUSE_IF(length >= RITZ_NAME_SIZE, RITZ_ERR_ARGUMENT,
                   "'%.40s...' is longer than %d letters", name,
                   RITZ_NAME_SIZE - 1);
    for (const char *c = name; *c; c++)
        RITZ_REFUSE_IF((unsigned char)*c < ' ' || *c == '/' || *c == 127,
                       RITZ_ERR_ARGUMENT,
                       "'%s' holds '/' or a control character, a name cannot",
                       name);
    for (const char *c = name; *c; c += ritz_letter_length(c))
        RITZ_REFUSE_IF(ritz_letter_length(c) == 0, RITZ_ERR_ARGUMENT,
                       "'%s' is not UTF-8, a name must be", name);
    RITZ_REFUSE_IF(strcmp(name, ".") == 0 || strcmp(name, "..") == 0,
                   RITZ_ERR_ARGUMENT, "'%s' cannot be a name", name);
    memcpy(out, name, length + 1);
    return RITZ_OK;
}

int64_t ritz_text_lines(const char *text)
{
    int64_t count = 1;

    for (; *text; text++)
        count += *text == '\n';
    return count;
}

ritz_status ritz_path_folder(const char *path, char **out)
{
    const char *slash = strrchr(path, '/');
    size_t length = slash ? (size_t)(slash - path) : 1;
    char *folder = NULL;

    if (slash == path)
        length = 1; /* the root */
    RITZ_CHECK_NEW(folder, (int64_t)length + 1);
    memcpy(folder, slash ? path : ".", length);
    *out = folder;
    return RITZ_OK;
}

const char *ritz_path_name(const char *path)
{
    const char *slash = strrchr(path, '/');

    return slash ? slash + 1 : path;
}

bool ritz_path_within(const char *path, const char *folder)
{
    RITZ_OWN_ARRAY char *inner = realpath(path, NULL);
    RITZ_OWN_ARRAY char *outer = realpath(folder, NULL);
    size_t length = outer ? strlen(outer) : 0;

    if (!inner || !outer || strncmp(inner, outer, length) != 0)
        return false;
    return outer[length - 1] == '/' || inner[length] == '/';
}

/* Names. */

enum { FAR = 1000, LONGEST = 64 };

/* Edit distance of two short words, FAR if one is long. */
static int count_edits(const char *a, const char *b)
{
    int row[LONGEST + 1];
    int m = (int)strlen(a);
    int n = (int)strlen(b);

    if (m > LONGEST || n > LONGEST)
        return FAR;
    for (int j = 0; j <= n; j++)
        row[j] = j;
    for (int i = 1; i <= m; i++) {
        int diagonal = row[0];

        row[0] = i;
        for (int j = 1; j <= n; j++) {
            int best = diagonal + (a[i - 1] != b[j - 1]);

            diagonal = row[j];
            if (row[j] + 1 < best)
                best = row[j] + 1;
            if (row[j - 1] + 1 < best)
                best = row[j - 1] + 1;
            row[j] = best;
        }
    }
    return row[n];
}

/* The name so far that is nearest to a word, and its distance. */
typedef struct nearest {
    const char *word, *name;
    int edits;
} nearest;

static void try_name(nearest *near, const char *name)
{
    int edits = count_edits(near->word, name);

    if (edits < near->edits) {
        near->edits = edits;
        near->name = name;
    }
}

/* NULL if more than half of the letters differ. */
static const char *accept_nearest(const nearest *near)
{
    return near->edits <= (int)(strlen(near->word) + 1) / 2 ? near->name : NULL;
}

const char *ritz_text_nearest(const char *word, int64_t count,
                              const char *first, size_t stride)
{
    nearest near = {word, NULL, FAR};

    for (int64_t k = 0; k < count; k++)
        try_name(&near, first + (size_t)k * stride);
    return accept_nearest(&near);
}

static void record_unknown(const char *kind, const char *name, const char *near,
                           const char *otherwise)
{
    ritz_record("there is no %s '%.63s'%s%s%s", kind, name,
                near ? ", is '" : "", near ? near : "",
                near ? "' meant?" : otherwise);
}

/* Row k of a table of pointers to structs; the first member is the name. */
static const char *name_row(const void *table, int64_t k, const void **row)
{
    const char *name = NULL;

    memcpy(row, (const char *)table + (size_t)k * sizeof *row, sizeof *row);
    if (*row)
        memcpy(&name, *row, sizeof name);
    return name;
}

const void *ritz_row_find(const void *table, const char *kind, const char *name)
{
    nearest near = {name, NULL, FAR};
    const void *row = NULL;
    const char *known = name_row(table, 0, &row);

    for (int64_t k = 1; known; known = name_row(table, k++, &row)) {
        if (strcmp(known, name) == 0)
            return row;
        try_name(&near, known);
    }
    record_unknown(kind, name, accept_nearest(&near), "");
    return NULL;
}

static const char *name_at(const ritz_names *names, int64_t k)
{
    return names->first + (size_t)k * names->stride;
}

int64_t ritz_names_index(const ritz_names *names, const char *word)
{
    for (int64_t k = 0; k < names->count; k++)
        if (strcmp(name_at(names, k), word) == 0)
            return k;
    return -1;
}

static int compare_names(const void *a, const void *b)
{
    return strcmp(a, b);
}

ritz_status ritz_names_repeated(int64_t count,
                                const char (*name)[RITZ_NAME_SIZE],
                                char out[RITZ_NAME_SIZE])
{
    RITZ_OWN_ARRAY char(*sorted)[RITZ_NAME_SIZE] = NULL;

    out[0] = '\0';
    RITZ_CHECK_COPY(sorted, name, count);
    qsort(sorted, (size_t)count, sizeof *sorted, compare_names);
    for (int64_t k = 1; k < count && !*out; k++)
        if (strcmp(sorted[k - 1], sorted[k]) == 0)
            memcpy(out, sorted[k], sizeof *sorted);
    return RITZ_OK;
}

int64_t ritz_name_index(int64_t count, char (*name)[RITZ_NAME_SIZE],
                        const char *word)
{
    const ritz_names names = {"", count, (char *)name, sizeof *name};

    return ritz_names_index(&names, word);
}

int64_t ritz_names_seek(const ritz_names *names, const char *word)
{
    int64_t at = ritz_names_index(names, word);

    if (at < 0)
        record_unknown(
            names->what, word,
            ritz_text_nearest(word, names->count, names->first, names->stride),
            names->count > 0 ? "" : ", the model has none");
    return at;
}

/* "model, basis, modes", as many as there is room for. */
static const char *list_names(const ritz_names *names, char *out, size_t size)
{
    size_t used = 0;

    snprintf(out, size, "none");
    for (int64_t k = 0; k < names->count; k++) {
        const char *name = name_at(names, k);

        if (used + strlen(name) + sizeof ", ..." > size) {
            snprintf(out + used, size - used, ", ...");
            break;
        }
        used += (size_t)snprintf(out + used, size - used, "%s%s",
                                 k > 0 ? ", " : "", name);
    }
    return out;
}

ritz_status ritz_words_find(const ritz_names *names, const char *word,
                            int64_t *out)
{
    int64_t at = ritz_names_index(names, word);
    const char *near = NULL;
    char text[RITZ_SHORT_SIZE];
    char all[200];

    if (at < 0)
        near =
            ritz_text_nearest(word, names->count, names->first, names->stride);
    RITZ_REFUSE_IF(near, RITZ_ERR_ARGUMENT, "unknown %s '%s', is '%s' meant?",
                   names->what, ritz_text_short(word, text), near);
    RITZ_REFUSE_IF(at < 0, RITZ_ERR_ARGUMENT, "unknown %s '%s', there is %s",
                   names->what, ritz_text_short(word, text),
                   list_names(names, all, sizeof all));
    *out = at;
    return RITZ_OK;
}

const char *ritz_text_short(const char *text, char out[RITZ_SHORT_SIZE])
{
    enum { MOST = 40 };
    size_t length = strlen(text);
    size_t kept = length <= MOST ? length : MOST;

    /* never half a character of UTF-8, whose later bytes are 10xxxxxx */
    while (kept < length && kept > 0 && ((unsigned char)text[kept] >> 6) == 2)
        kept--;
    memcpy(out, text, kept);
    for (size_t k = 0; k < kept; k++)
        if ((unsigned char)out[k] < ' ' || out[k] == 127)
            out[k] = ' ';
    snprintf(out + kept, RITZ_SHORT_SIZE - kept, "%s",
             kept < length ? "..." : "");
    return out;
}
