#include "base/names.h"

#include <stdio.h>
#include <string.h>

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
