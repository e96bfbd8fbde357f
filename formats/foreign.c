/* Files of matrices: recognised by content, and what a user may ask of them. */
#include "base/alloc.h"
#include "base/path.h"

#include <ritz/foreign.h>

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* "output4, matrix-market or dmig" would age: the list comes from the table. */
static void list_formats(char *text, size_t size)
{
    size_t used = 0;

    for (int k = 0; ritz_formats[k] && used < size; k++)
        used += (size_t)snprintf(text + used, size - used, "%s%s",
                                 k > 0 ? ", " : "", ritz_formats[k]->name);
}

static ritz_status parse(const char *bytes, int64_t size, const char *folder,
                         ritz_matrices *out)
{
    const ritz_format *format = NULL;
    char known[128] = "";

    RITZ_REFUSE_IF(size == 0, RITZ_ERR_FORMAT, "is empty");
    for (int k = 0; ritz_formats[k] && !format; k++)
        if (ritz_formats[k]->recognise(bytes, size))
            format = ritz_formats[k];
    list_formats(known, sizeof known);
    RITZ_REFUSE_IF(!format, RITZ_ERR_FORMAT,
                   "holds no matrix in a format that is known: %s", known);
    RITZ_CHECK(format->read(bytes, size, folder, out));
    snprintf(out->format, sizeof out->format, "%s", format->name);
    return RITZ_OK;
}

enum { QUOTED = 192 }; /* room for a quoted path */

/* "'kgg.op4'", cut to what leaves room for the rest of a sentence. */
static void quote(const char *path, char out[QUOTED])
{
    size_t length = strlen(path);
    size_t most = QUOTED - 8;

    if (length <= most)
        snprintf(out, QUOTED, "'%s'", path);
    else
        snprintf(out, QUOTED, "'...%s'", path + length - most);
}

ritz_status ritz_foreign_parse(const char *bytes, int64_t size,
                               ritz_matrices *out)
{
    return parse(bytes, size, NULL, out);
}

ritz_status ritz_foreign_read(const char *path, ritz_matrices *out)
{
    ritz_status status = RITZ_OK;
    char what[QUOTED];
    char *bytes = NULL;
    char *folder = NULL;
    int64_t size = 0;

    RITZ_TRY(ritz_bytes_read(path, &size, &bytes));
    RITZ_TRY(ritz_path_folder(path, &folder));
    quote(path, what);
    RITZ_TRY_IN(what, parse(bytes, size, folder, out));
done:
    free(bytes);
    free(folder);
    return status;
}

static char fold(char c)
{
    return (char)(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
}

static int64_t padded_length(const char *text, int64_t length)
{
    while (length > 0 && text[length - 1] == ' ')
        length--;
    return length;
}

/* Names are one if they differ by case and trailing blanks only. */
static bool same_name(const char *a, const char *b, int64_t length)
{
    int64_t n = padded_length(a, (int64_t)strlen(a));

    length = padded_length(b, length);
    if (n != length)
        return false;
    for (int64_t k = 0; k < n; k++)
        if (fold(a[k]) != fold(b[k]))
            return false;
    return true;
}

/* A spec taken apart; `name` NULL where there is none. */
typedef struct spec {
    int64_t path; /* length of the file's name */
    const char *name;
    int64_t length; /* of the name */
    int64_t which;  /* K from 1, 0 where there is none */
} spec;

/* The last colon parts file and name, unless the whole is a file's name. */
static spec split_spec(const char *text)
{
    spec s = {.path = (int64_t)strlen(text)};
    const char *colon = strrchr(text, ':');
    const char *mark = NULL;
    struct stat there;

    if (!colon || colon == text || strchr(colon, '/') ||
        stat(text, &there) == 0)
        return s;
    s.path = colon - text;
    s.name = colon + 1;
    s.length = (int64_t)strlen(s.name);
    mark = strrchr(s.name, '#');
    if (mark && ritz_text_whole(mark + 1, &s.which) && s.which > 0)
        s.length = mark - s.name;
    else
        s.which = 0;
    return s;
}

ritz_status ritz_foreign_path(const char *spec_text, char **out)
{
    spec s = split_spec(spec_text);
    char *path = NULL;

    RITZ_CHECK_NEW(path, s.path + 1);
    memcpy(path, spec_text, (size_t)s.path);
    *out = path;
    return RITZ_OK;
}

/* As they stand, or failing that whatever their case. */
static bool is_named(const ritz_matrices *all, const spec *s, int64_t k)
{
    const char *name = all->matrix[k].name;

    if (!s->name)
        return !all->matrix[k].other[0];
    for (int64_t i = 0; i < all->count; i++)
        if (strlen(all->matrix[i].name) == (size_t)s->length &&
            strncmp(all->matrix[i].name, s->name, (size_t)s->length) == 0)
            return strlen(name) == (size_t)s->length &&
                   strncmp(name, s->name, (size_t)s->length) == 0;
    return same_name(name, s->name, s->length);
}

static int64_t count_name(const ritz_matrices *all, const char *name,
                          int64_t from)
{
    int64_t count = 0;

    for (int64_t k = from; k < all->count; k++)
        count += same_name(all->matrix[k].name, name, (int64_t)strlen(name));
    return count;
}

/* "KAA (3 times), MAA": each name once, in the file's order. */
static void list_names(const ritz_matrices *all, char *text, size_t size)
{
    size_t used = 0;

    text[0] = '\0';
    for (int64_t k = 0; k < all->count; k++) {
        const char *name = all->matrix[k].name;
        int64_t times = count_name(all, name, 0);
        int more = 0;

        if (count_name(all, name, k) < times)
            continue;
        if (used + RITZ_NAME_SIZE + 32 > size) {
            snprintf(text + used, size - used, ", ...");
            return;
        }
        more = snprintf(text + used, size - used, "%s%s", used > 0 ? ", " : "",
                        name[0] ? name : "one without a name");
        used += (size_t)more;
        if (times > 1)
            used += (size_t)snprintf(text + used, size - used,
                                     " (%" PRId64 " times)", times);
    }
}

/* The index of the matrix that the spec names. */
static ritz_status find(const ritz_matrices *all, const spec *s,
                        const char *file, int64_t *out)
{
    char holds[220];
    const char *first = all->matrix[0].name;
    const char *base = strrchr(file, '/');
    int64_t found = -1;
    int64_t times = 0;

    base = base ? base + 1 : file;
    for (int64_t k = 0; k < all->count; k++) {
        if (!is_named(all, s, k))
            continue;
        times++;
        if (times == 1 || times == s->which)
            found = k;
    }
    list_names(all, holds, sizeof holds);
    RITZ_REFUSE_IF(!s->name && times > 1, RITZ_ERR_ARGUMENT,
                   "'%.80s' holds %s: name one, as %.80s:%s%s", base, holds,
                   base, first, count_name(all, first, 0) > 1 ? "#1" : "");
    RITZ_REFUSE_IF(!s->name && times == 0, RITZ_ERR_FORMAT,
                   "'%.80s' holds no matrix, but %s", base, holds);
    RITZ_REFUSE_IF(times == 0, RITZ_ERR_ARGUMENT,
                   "'%.80s' holds no '%.*s', but %s", base,
                   (int)(s->length % 80), s->name, holds);
    RITZ_REFUSE_IF(s->which > times, RITZ_ERR_ARGUMENT,
                   "'%.80s' holds %.*s %" PRId64 " times, so that #%" PRId64
                   " is not among them",
                   base, (int)(s->length % 80), s->name, times, s->which);
    RITZ_REFUSE_IF(s->which == 0 && times > 1, RITZ_ERR_ARGUMENT,
                   "'%.80s' holds %s: say which, as %.80s:%.*s#1", base, holds,
                   base, (int)(s->length % 80), s->name);
    *out = found;
    return RITZ_OK;
}

ritz_status ritz_foreign_select(const char *spec_text, ritz_matrix *out)
{
    ritz_status status = RITZ_OK;
    spec s = split_spec(spec_text);
    ritz_matrices all = {0};
    char *path = NULL;
    int64_t which = 0;

    RITZ_TRY(ritz_foreign_path(spec_text, &path));
    RITZ_TRY(ritz_foreign_read(path, &all));
    RITZ_FAIL_IF(all.count == 0, RITZ_ERR_FORMAT, "'%.200s' holds no matrix",
                 path);
    RITZ_TRY(find(&all, &s, path, &which));
    RITZ_FAIL_IF(all.matrix[which].other[0], RITZ_ERR_FORMAT, "'%.200s' is %s",
                 spec_text, all.matrix[which].other);
    *out = all.matrix[which];
    all.matrix[which] = (ritz_matrix){0};
done:
    ritz_matrices_free(&all);
    free(path);
    return status;
}
