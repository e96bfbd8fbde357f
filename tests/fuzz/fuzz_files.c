/*
 * Files that an input contains, after the text that names them:
 *
 *     >K
 *     %%MatrixMarket matrix coordinate real symmetric
 *     ...
 *     >D
 *     1 1
 *     ...
 */
#include "fuzz.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MOST_FILES = 6, NAME_SIZE = 16, PATH_SIZE = 512 };

void fuzz_store(const char *name, const char *bytes, int64_t size)
{
    FILE *file = fopen(name, "wb");
    bool good = file && fwrite(bytes, 1, (size_t)size, file) == (size_t)size;

    if (file && fclose(file) == 0 && good)
        return;
    fprintf(stderr, "cannot write '%s'\n", name);
    exit(1);
}

/* ">NAME", then the file's content; returns what follows the content. */
static const char *store_file(const char *line, int *count)
{
    char name[NAME_SIZE + 1] = "";
    size_t length = strspn(line + 1, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmno"
                                     "pqrstuvwxyz0123456789");
    const char *text = strchr(line, '\n');
    const char *end = text ? strstr(text, "\n>") : NULL;

    if (!text)
        return NULL;
    memcpy(name, line + 1, length < NAME_SIZE ? length : NAME_SIZE);
    text++;
    end = end ? end + 1 : text + strlen(text);
    if (end < text)
        end = text;
    if (*name && *count < MOST_FILES) {
        ++*count;
        fuzz_store(name, text, end - text);
    }
    return *end ? end : NULL;
}

void fuzz_store_files(const char *text)
{
    int count = 0;

    while (text && *text == '>')
        text = store_file(text, &count);
}

void fuzz_remove_files(const char *text)
{
    char name[NAME_SIZE + 1];

    for (const char *at = strchr(text, '>'); at; at = strchr(at + 1, '>')) {
        size_t length = strcspn(at + 1, "\n");

        if (length > NAME_SIZE)
            length = NAME_SIZE;
        memcpy(name, at + 1, length);
        name[length] = '\0';
        if (*name && !strchr(name, '/') && *name != '.')
            remove(name);
    }
}

void fuzz_empty(const char *folder)
{
    char path[PATH_SIZE];
    DIR *listing = opendir(folder);
    const struct dirent *entry = NULL;

    while (listing && (entry = readdir(listing))) {
        (void)snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        unlink(path);
    }
    if (listing)
        closedir(listing);
}
