/*
 * The files of a deck. A file that INCLUDE names is gone through in place; its
 * name is relative to the folder of the file that names it.
 */
#include "formats/deck_files.h"
#include "base/alloc.h"
#include "base/text.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { MOST_FILES = 10000 };

ritz_lines ritz_deck_lines(const char *text, int64_t size)
{
    static const char mark[] = "\xef\xbb\xbf";
    const int64_t skipped =
        size >= 3 && memcmp(text, mark, sizeof mark - 1) == 0 ? 3 : 0;

    return (ritz_lines){.at = text + skipped, .end = text + size};
}

/* Append a file; its text belongs to the deck then, unless the call fails. */
static ritz_status add_file(ritz_deck_files *files, const char *path,
                            ritz_deck_file file)
{
    file.path = NULL;
    RITZ_CHECK_ROOM(files->file, files->count, files->room);
    if (path)
        RITZ_CHECK_COPY(file.path, path, (int64_t)strlen(path) + 1);
    files->file[files->count++] = file;
    return RITZ_OK;
}

static void identify_file(const struct stat *there, ritz_deck_file *file)
{
    file->known = true;
    file->device = (uint64_t)there->st_dev;
    file->inode = (uint64_t)there->st_ino;
}

static bool same_file(const ritz_deck_file *a, const ritz_deck_file *b)
{
    return a->known && b->known && a->device == b->device &&
           a->inode == b->inode;
}

ritz_status ritz_deck_begin(ritz_deck_reading *reading, const char *path,
                            const char *text, int64_t size, const char *folder)
{
    ritz_deck_file file = {0};
    struct stat there;
    char *copy = NULL;

    if (path && folder && stat(path, &there) == 0)
        identify_file(&there, &file);
    RITZ_CHECK(add_file(reading->files, path, file));
    if (folder)
        RITZ_CHECK_COPY(copy, folder, (int64_t)strlen(folder) + 1);
    reading->home = folder;
    reading->open[reading->depth++] =
        (ritz_deck_text){.text = ritz_deck_lines(text, size),
                         .file = reading->files->count - 1,
                         .folder = copy};
    return RITZ_OK;
}

ritz_deck_text *ritz_deck_top(ritz_deck_reading *reading)
{
    return reading->depth > 0 ? &reading->open[reading->depth - 1] : NULL;
}

bool ritz_deck_next_line(ritz_deck_reading *reading)
{
    while (reading->depth > 0) {
        if (ritz_lines_next(&ritz_deck_top(reading)->text))
            return true;
        free(reading->open[--reading->depth].folder);
    }
    return false;
}

/* ---- INCLUDE ------------------------------------------------------------ */

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

/* Whether a file may be included: it is not open, and was included few times.
 * *earlier: an earlier inclusion, whose text can be used; NULL: none. */
static ritz_status check_repeats(const ritz_deck_reading *reading,
                                 const char *path, const ritz_deck_file *file,
                                 const ritz_deck_file **earlier)
{
    const ritz_deck_files *files = reading->files;
    int64_t times = 0;

    *earlier = NULL;
    for (int k = 0; k < reading->depth; k++)
        RITZ_REFUSE_IF(same_file(&files->file[reading->open[k].file], file),
                       RITZ_ERR_FORMAT, "'%s' includes itself", path);
    for (int64_t k = 0; k < files->count; k++) {
        if (!same_file(&files->file[k], file))
            continue;
        times++;
        if (files->file[k].text)
            *earlier = &files->file[k];
    }
    RITZ_REFUSE_IF(times >= RITZ_DECK_REPEATED, RITZ_ERR_FORMAT,
                   "'%s' is included more than %d times", path,
                   RITZ_DECK_REPEATED);
    return RITZ_OK;
}

/*
 * Decks may come from strangers: the name must be that of a regular file,
 * because a device may have no end and a pipe no writer.
 */
static ritz_status include_path(ritz_deck_reading *reading, const char *path)
{
    ritz_deck_text new = {.file = reading->files->count};
    ritz_deck_file file = {.outside = !ritz_path_within(path, reading->home)};
    const ritz_deck_file *earlier = NULL;
    const char *text = NULL;
    RITZ_OWN_ARRAY char *bytes = NULL;
    struct stat there;

    RITZ_REFUSE_IF(stat(path, &there) != 0, RITZ_ERR_FILE,
                   "cannot open '%s': %s", path, strerror(errno));
    RITZ_REFUSE_IF(!S_ISREG(there.st_mode), RITZ_ERR_FILE,
                   "'%s' is not a regular file", path);
    identify_file(&there, &file);
    RITZ_CHECK(check_repeats(reading, path, &file, &earlier));
    RITZ_REFUSE_IF(reading->depth > RITZ_DECK_DEEPEST, RITZ_ERR_FORMAT,
                   "INCLUDE is more than %d files deep", RITZ_DECK_DEEPEST);
    RITZ_REFUSE_IF(reading->files->count >= MOST_FILES, RITZ_ERR_FORMAT,
                   "INCLUDE reads more than %d files", MOST_FILES);
    if (!earlier)
        RITZ_CHECK(ritz_text_read(path, &bytes));
    text = earlier ? earlier->text : bytes;
    new.text = ritz_deck_lines(text, (int64_t)strlen(text));
    file.text = bytes;
    RITZ_CHECK(add_file(reading->files, path, file));
    bytes = NULL;
    RITZ_CHECK(ritz_path_folder(path, &new.folder));
    reading->open[reading->depth++] = new;
    return RITZ_OK;
}

ritz_status ritz_deck_include(ritz_deck_reading *reading, const char *name)
{
    RITZ_OWN_ARRAY char *path = NULL;

    RITZ_CHECK(join_path(ritz_deck_top(reading)->folder, name, &path));
    return include_path(reading, path);
}

/* ---- sentences ---------------------------------------------------------- */

const char *ritz_deck_place(ritz_deck_reading *reading,
                            char text[static RITZ_DECK_PLACE_SIZE])
{
    const ritz_deck_text *top = ritz_deck_top(reading);
    const char *path = reading->files->file[top->file].path;

    if (path)
        snprintf(text, RITZ_DECK_PLACE_SIZE, "'%s', line %" PRId64, path,
                 top->text.number);
    else
        snprintf(text, RITZ_DECK_PLACE_SIZE, "line %" PRId64, top->text.number);
    return text;
}

/* Remove from a sentence everything between the first quote and the last one,
 * since a quotation may contain quotes; remove all after the first one if the
 * sentence was cut off. */
static void hide_quotes(char *sentence, size_t size)
{
    char *first = strchr(sentence, '\'');
    const char *last = strrchr(sentence, '\'');
    char end[400] = "";

    if (!first)
        return;
    if (last > first)
        snprintf(end, sizeof end, "...%s", last);
    snprintf(first + 1, size - (size_t)(first + 1 - sentence), "%s", end);
}

ritz_status ritz_deck_refuse(const ritz_deck_files *files, int64_t file,
                             int64_t line, const char *format, va_list args)
{
    const ritz_deck_file *at = &files->file[file];
    char sentence[400];

    vsnprintf(sentence, sizeof sentence, format, args);
    if (at->outside)
        hide_quotes(sentence, sizeof sentence);
    if (at->path)
        return ritz_fail(RITZ_ERR_FORMAT, "'%s', line %" PRId64 ": %s",
                         at->path, line, sentence);
    return ritz_fail(RITZ_ERR_FORMAT, "line %" PRId64 ": %s", line, sentence);
}

ritz_status ritz_deck_paths(const ritz_deck_files *files, int64_t *count,
                            char ***out)
{
    RITZ_CHECK_NEW(*out, files->count);
    for (; *count < files->count; ++*count) {
        const char *path = files->file[*count].path;

        if (path)
            RITZ_CHECK_COPY((*out)[*count], path, (int64_t)strlen(path) + 1);
    }
    return RITZ_OK;
}

ritz_status ritz_deck_keep_sentence(char **out)
{
    const char *said = ritz_error_message();

    RITZ_CHECK_COPY(*out, said, (int64_t)strlen(said) + 1);
    return RITZ_OK;
}

void ritz_deck_reading_free(ritz_deck_reading *reading)
{
    while (reading->depth > 0)
        free(reading->open[--reading->depth].folder);
}

void ritz_deck_files_free(ritz_deck_files *files)
{
    for (int64_t k = 0; k < files->count; k++)
        RITZ_FREE(files->file[k].path, files->file[k].text);
    free(files->file);
    *files = (ritz_deck_files){0};
}

static bool has_direction(uint8_t mask, int64_t c)
{
    return (((unsigned)mask >> (unsigned)c) & 1U) != 0;
}

ritz_status ritz_deck_list_dofs(const ritz_grids *grids, const uint8_t *mask,
                                int64_t *count, ritz_dof **out)
{
    enum { DIRECTIONS = 6 };
    int64_t room = 0;

    for (int64_t k = 0; k < grids->count; k++)
        for (int64_t c = 1; c <= DIRECTIONS; c++)
            room += has_direction(mask[k], c);
    RITZ_CHECK_NEW(*out, room);
    *count = 0;
    for (int64_t k = 0; k < grids->count; k++)
        for (int64_t c = 1; c <= DIRECTIONS; c++)
            if (has_direction(mask[k], c))
                (*out)[(*count)++] = (ritz_dof){grids->id[k], c};
    return RITZ_OK;
}
