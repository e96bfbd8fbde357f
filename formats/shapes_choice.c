/* Lists of modes, "1-6,9". */
#include "formats/shapes_parts.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* "5" or "7-9" of so many letters. */
static bool read_part(const char *text, size_t length, int64_t *from,
                      int64_t *to)
{
    char part[48] = "";
    char *dash = NULL;

    if (length == 0 || length >= sizeof part)
        return false;
    memcpy(part, text, length);
    dash = strchr(part, '-');
    if (dash)
        *dash++ = '\0';
    if (!ritz_text_whole(part, from) || *from < 1)
        return false;
    *to = *from;
    return !dash || (ritz_text_whole(dash, to) && *to >= *from);
}

/* Twice: to count, and to fill `at` unless it is NULL. */
static ritz_status walk(const char *list, const char *what, int64_t most,
                        shapes_choice *out)
{
    const char *end = list + strlen(list);

    out->count = 0;
    for (const char *at = list; at <= end;) {
        size_t length = strcspn(at, ",");
        int64_t from = 0, to = 0;

        RITZ_REFUSE_IF(!read_part(at, length, &from, &to), RITZ_ERR_ARGUMENT,
                       "'%.*s' is no part of a list of modes such as 1,5,10-20",
                       (int)(length % 64), at);
        RITZ_REFUSE_IF(to > most, RITZ_ERR_ARGUMENT,
                       "there is no %s %" PRId64 ", there are %" PRId64, what,
                       to, most);
        for (int64_t k = from; k <= to; k++, out->count++)
            if (out->at)
                out->at[out->count] = k - 1;
        at += length + 1;
    }
    return RITZ_OK;
}

ritz_status shapes_furthest(const char *list, int64_t *out)
{
    const char *end = list + strlen(list);

    *out = 0;
    for (const char *at = list; at <= end;) {
        size_t length = strcspn(at, ",");
        int64_t from = 0, to = 0;

        RITZ_REFUSE_IF(!read_part(at, length, &from, &to), RITZ_ERR_ARGUMENT,
                       "'%.*s' is no part of a list of modes such as 1,5,10-20",
                       (int)(length % 64), at);
        *out = to > *out ? to : *out;
        at += length + 1;
    }
    return RITZ_OK;
}

ritz_status shapes_choose(const char *list, const char *what, int64_t most,
                          shapes_choice *out)
{
    ritz_status status = RITZ_OK;
    shapes_choice made = {.count = most};

    if (list)
        RITZ_TRY(walk(list, what, most, &made));
    RITZ_NEW(made.at, made.count + 1);
    if (list)
        RITZ_TRY(walk(list, what, most, &made));
    for (int64_t k = 0; !list && k < most; k++)
        made.at[k] = k;
    *out = made;
    made.at = NULL;
done:
    free(made.at);
    return status;
}
