/*
 * Reads the modal output of MBDyn, a file .mod, which has a line for each time,
 * body and mode,
 *
 *     BODY.MODE  q  q'  q''
 *
 * with the label of the modal joint and the number of the mode [MBDyn2017]. The
 * file does not state the times.
 */
#include "formats/history_lines.h"

#include "base/alloc.h"
#include "base/text.h"

#include <ritz/recover.h>

#include <ctype.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum { FIELDS = 4 };

typedef struct mod_file {
    history_lines lines;
    double step;
    int64_t label; /* of the body; 0: that of the first line */
    int64_t times; /* read so far */
    int64_t *mode; /* order: numbers of the modes, as at the first time */
} mod_file;

static void end(void *own)
{
    mod_file *mod = own;

    history_lines_free(&mod->lines);
    free(mod->mode);
    free(mod);
}

/* Read BODY.MODE, as in "12.3". */
static bool read_label(const char *field, int64_t *label, int64_t *mode)
{
    const char *point = strchr(field, '.');
    char copy[RITZ_NAME_SIZE];

    if (!point || point == field || !isdigit((unsigned char)point[1]) ||
        (size_t)(point - field) >= sizeof copy)
        return false;
    memcpy(copy, field, (size_t)(point - field));
    copy[point - field] = '\0';
    return ritz_text_whole(copy, label) && ritz_text_whole(point + 1, mode) &&
           *label >= 0 && *mode >= 0;
}

/* The first line has a label and three numbers, with blanks between them. */
static bool recognise(const char *bytes, int64_t size)
{
    char line[256];
    char *rest = line;
    const char *newline = memchr(bytes, '\n', (size_t)size);
    size_t length = newline ? (size_t)(newline - bytes) : (size_t)size;
    int64_t label = 0, mode = 0;
    double value = 0.0;
    const char *field = NULL;

    if (length >= sizeof line)
        return false;
    memcpy(line, bytes, length);
    line[length] = '\0';
    if (strchr(line, ','))
        return false;
    field = history_lines_field(&rest, ' ');
    if (!field || !read_label(field, &label, &mode))
        return false;
    for (int k = 1; k < FIELDS; k++) {
        field = history_lines_field(&rest, ' ');
        if (!field || !ritz_text_real(field, &value))
            return false;
    }
    return !rest;
}

static ritz_status begin(FILE *file, const ritz_history_request *request,
                         ritz_history *history)
{
    mod_file *mod = NULL;

    if (!(request->step > 0.0) || request->q || request->v || request->a) {
        fclose(file);
        return ritz_fail(
            RITZ_ERR_ARGUMENT,
            request->step > 0.0
                ? "a file .mod has columns of its own: --q, --v "
                  "and --a are for tables"
                : "a file .mod has no times: give --step, from one "
                  "to the next");
    }
    mod = ritz_zalloc(1, sizeof *mod);
    if (!mod) {
        fclose(file);
        return RITZ_ERR_MEMORY;
    }
    *mod = (mod_file){
        .lines.file = file, .step = request->step, .label = request->label};
    history->own = mod;
    history->has_v = history->has_a = true;
    RITZ_CHECK_NEW(mod->mode, request->order);
    return RITZ_OK;
}

/* Read a line of mode `at`. *taken is false if it is of another body. */
static ritz_status take_line(mod_file *mod, int64_t at, ritz_history *history,
                             bool *taken)
{
    char *rest = mod->lines.text;
    const char *field = history_lines_field(&rest, ' ');
    int64_t label = 0, mode = 0;
    double value[FIELDS - 1] = {0.0};

    RITZ_REFUSE_IF(!field || !read_label(field, &label, &mode), RITZ_ERR_FORMAT,
                   "line %" PRId64 " does not begin with BODY.MODE",
                   mod->lines.number);
    for (int k = 0; k < FIELDS - 1; k++) {
        field = history_lines_field(&rest, ' ');
        RITZ_REFUSE_IF(!field, RITZ_ERR_FORMAT,
                       "line %" PRId64 " has less than three numbers",
                       mod->lines.number);
        RITZ_CHECK(history_lines_real(&mod->lines, field, &value[k]));
    }
    RITZ_REFUSE_IF(rest, RITZ_ERR_FORMAT,
                   "line %" PRId64 " has more than three numbers",
                   mod->lines.number);
    if (mod->label == 0)
        mod->label = label;
    *taken = label == mod->label;
    if (!*taken)
        return RITZ_OK;
    if (mod->times == 0)
        mod->mode[at] = mode;
    RITZ_REFUSE_IF(mode != mod->mode[at] ||
                       (mod->times == 0 && at > 0 && mode == mod->mode[0]),
                   RITZ_ERR_FORMAT,
                   "line %" PRId64 ": mode %" PRId64 " of body %" PRId64
                   " where another is due: it has not %" PRId64 " modes",
                   mod->lines.number, mode, label, history->order);
    for (int k = 0; k < FIELDS - 1; k++)
        history->x[k * history->order + at] = value[k];
    return RITZ_OK;
}

static ritz_status next(ritz_history *history, bool *more)
{
    mod_file *mod = history->own;
    int64_t at = 0;

    while (at < history->order) {
        bool taken = false;

        RITZ_CHECK(history_lines_next(&mod->lines, more));
        if (!*more)
            break;
        RITZ_CHECK(take_line(mod, at, history, &taken));
        at += taken;
    }
    RITZ_REFUSE_IF(at > 0 && at < history->order, RITZ_ERR_FORMAT,
                   "ends within time %" PRId64 ", after %" PRId64 " of %" PRId64
                   " modes",
                   mod->times + 1, at, history->order);
    RITZ_REFUSE_IF(at == 0 && mod->times == 0, RITZ_ERR_FORMAT,
                   "holds no mode of body %" PRId64, mod->label);
    *more = at > 0;
    history->seconds = (double)mod->times * mod->step;
    mod->times += *more;
    return RITZ_OK;
}

const ritz_history_format ritz_history_format_mbdyn = {
    .name = "mbdyn",
    .summary = "modal output of MBDyn, a file .mod",
    .reference = "MBDyn2017",
    .recognise = recognise,
    .begin = begin,
    .next = next,
    .end = end,
};
