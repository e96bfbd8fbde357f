#include "base/text.h"

#include "base/alloc.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* Move `used` bytes into a block of `size`, the rest of it zero. */
static ritz_status grow_text(char **text, int64_t used, int64_t size)
{
    char *bigger = NULL;

    RITZ_CHECK_NEW(bigger, size);
    if (used > 0)
        memcpy(bigger, *text, (size_t)used);
    free(*text);
    *text = bigger;
    return RITZ_OK;
}

/* Size that the system states of a regular file; 0 of a pipe, or if unknown. */
static int64_t stated_size(FILE *file)
{
    struct stat about;

    if (fstat(fileno(file), &about) != 0 || !S_ISREG(about.st_mode))
        return 0;
    return about.st_size < INT64_MAX / 4 ? about.st_size : INT64_MAX / 4;
}

/*
 * The size that is stated is a first guess, good for reading at once; a byte
 * more than that is requested, and doubled blocks follow if it comes.
 */
ritz_status ritz_bytes_read(const char *path, int64_t *size, char **out)
{
    enum { SMALLEST = 4096 };
    ritz_status status = RITZ_OK;
    char *bytes = NULL;
    int64_t used = 0;
    int64_t room = 0;
    FILE *file = fopen(path, "rb");

    RITZ_FAIL_IF(!file, RITZ_ERR_FILE, "cannot open '%s': %s", path,
                 strerror(errno));
    while (used == room) { /* full: there may be more */
        room = room > 0 ? 2 * room : stated_size(file) + 1;
        room = room < SMALLEST ? SMALLEST : room;
        RITZ_TRY(grow_text(&bytes, used, room + 1));
        used += (int64_t)fread(bytes + used, 1, (size_t)(room - used), file);
    }
    RITZ_FAIL_IF(ferror(file), RITZ_ERR_FILE, "cannot read '%s': %s", path,
                 strerror(errno));
    *size = used;
    RITZ_MOVE(*out, bytes);
done:
    if (file)
        fclose(file);
    free(bytes);
    return status;
}

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

int ritz_letter_length(const char *text)
{
    const unsigned char *c = (const unsigned char *)text;
    int more = c[0] >= 0xF0 ? 3 : c[0] >= 0xE0 ? 2 : 1;

    if (c[0] < 0x80)
        return c[0] >= ' ' && c[0] != 0x7F;
    if (c[0] < 0xC2 || c[0] > 0xF4 || (c[0] == 0xC2 && c[1] < 0xA0))
        return 0; /* no first byte, or a control character above 0x7F */
    for (int k = 1; k <= more; k++)
        if (c[k] >> 6 != 2)
            return 0;
    return 1 + more;
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
