/* Which mode is which: the table that --tracks of other tools writes. */
#include "print/rankings.h"

#include <ritz/text.h>

#include <stdlib.h>
#include <string.h>

enum { FIELDS = 3, FIELD = 256 };

/* "TRACK\tCONFIGURATION\tMODE\t..." of one line; false if it is none. */
static bool take_line(const char *line, char field[FIELDS][FIELD])
{
    for (int k = 0; k < FIELDS; k++) {
        size_t length = strcspn(line, "\t\n");

        if (length >= FIELD)
            return false;
        memcpy(field[k], line, length);
        field[k][length] = '\0';
        line += length;
        if (*line != '\t')
            return k == FIELDS - 1;
        line++;
    }
    return true;
}

/* Configuration of that name; systems without sweeps are "as joined". */
static int64_t find(const ritz_rankings *all, const char *at)
{
    for (int64_t k = 0; k < all->count; k++)
        if (strcmp(*all->item[k].at ? all->item[k].at : "as joined", at) == 0)
            return k;
    return -1;
}

static ritz_status put(const char *line, int64_t most, ritz_rankings *all)
{
    char field[FIELDS][FIELD];
    int64_t track = 0, mode = 0, at = -1;

    RITZ_REFUSE_IF(
        !take_line(line, field) || !ritz_text_whole(field[0], &track) ||
            !ritz_text_whole(field[2], &mode) || track < 1 || track > most ||
            mode < 1,
        RITZ_ERR_FORMAT, "'%.40s' is no line of a table of tracks", line);
    at = find(all, field[1]);
    if (at < 0)
        return RITZ_OK;
    RITZ_REFUSE_IF(mode > all->item[at].count, RITZ_ERR_FORMAT,
                   "mode %lld at '%s' is not there: the tracks are those of "
                   "another system",
                   (long long)mode, field[1]);
    all->track[at][mode - 1] = track - 1;
    return RITZ_OK;
}

static ritz_status check(const ritz_rankings *all)
{
    for (int64_t k = 0; k < all->count; k++)
        for (int64_t i = 0; i < all->item[k].count; i++)
            RITZ_REFUSE_IF(all->track[k][i] < 0, RITZ_ERR_FORMAT,
                           "mode %lld at '%s' has no track", (long long)i + 1,
                           all->item[k].at);
    return RITZ_OK;
}

static ritz_status make_room(ritz_rankings *all)
{
    all->track = calloc((size_t)all->count + 1, sizeof *all->track);
    RITZ_REFUSE_IF(!all->track, RITZ_ERR_MEMORY, "no memory for tracks");
    for (int64_t k = 0; k < all->count; k++) {
        size_t m = (size_t)all->item[k].count;

        all->track[k] = malloc((m + 1) * sizeof **all->track);
        RITZ_REFUSE_IF(!all->track[k], RITZ_ERR_MEMORY, "no memory for tracks");
        for (size_t i = 0; i < m; i++)
            all->track[k][i] = -1;
    }
    return RITZ_OK;
}

ritz_status rankings_read_tracks(cli_run *run, const char *path,
                                 ritz_rankings *all)
{
    ritz_status status = RITZ_OK;
    char *text = NULL;
    int64_t size = 0, rows = 0;

    RITZ_TRY(cli_input(run, path));
    RITZ_TRY(ritz_bytes_read(path, &size, &text));
    RITZ_TRY(make_room(all));
    RITZ_FAIL_IF(strncmp(text, "track\tconfiguration\tmode\t", 25) != 0,
                 RITZ_ERR_FORMAT, "it is no table of tracks");
    for (const char *c = text; *c; c++)
        rows += *c == '\n';
    for (const char *line = strchr(text, '\n'); line && line[1];
         line = strchr(line + 1, '\n'))
        RITZ_TRY(put(line + 1, rows, all));
    RITZ_TRY(check(all));
done:
    free(text);
    return ritz_context(status, path);
}
