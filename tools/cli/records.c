#include "cli/records.h"

#include "base/alloc.h"

#include <ritz/verify.h>

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* Beyond these a file is no collection of runs, and charts would be black. */
enum { MOST_BYTES = 64 << 20, MOST_RECORDS = 20000 };

bool records_is(const char *path)
{
    FILE *file = fopen(path, "r");
    int letter = ' ';

    while (file && (letter == ' ' || letter == '\n' || letter == '\t' ||
                    letter == '\r'))
        letter = fgetc(file);
    if (file)
        fclose(file);
    return letter == '{';
}

double record_value(const json_t *values, const char *name)
{
    const json_t *value = json_object_get(values, name);

    return json_is_number(value) ? json_number_value(value) : nan("");
}

static const char *text_of(const json_t *line, const char *key)
{
    const char *text = json_string_value(json_object_get(line, key));

    return text ? text : "";
}

/* null is as good as absent: JSON has no NaN. */
static ritz_status check_values(const json_t *line, const char *key)
{
    json_t *values = json_object_get(line, key);
    json_t *value = NULL;
    const char *name = NULL;

    if (!values || json_is_null(values))
        return RITZ_OK;
    RITZ_REFUSE_IF(!json_is_object(values), RITZ_ERR_FORMAT,
                   "'%s' is no object of names and numbers", key);
    json_object_foreach(values, name, value) RITZ_REFUSE_IF(
        !json_is_number(value) && !json_is_null(value) &&
            strcmp(key, "cost") != 0,
        RITZ_ERR_FORMAT, "'%.60s' of '%s' is no number", name, key);
    return RITZ_OK;
}

static ritz_status check_line(const json_t *line)
{
    static const char *const objects[] = {"errors", "estimates", "tolerance",
                                          "seconds", "cost"};
    static const char *const texts[] = {"tool", "method", "subject", "command"};
    const json_t *order = json_object_get(line, "order");

    for (size_t k = 0; k < sizeof objects / sizeof *objects; k++)
        RITZ_CHECK(check_values(line, objects[k]));
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
        const json_t *text = json_object_get(line, texts[k]);

        RITZ_REFUSE_IF(text && !json_is_string(text) && !json_is_null(text),
                       RITZ_ERR_FORMAT, "'%s' is no text", texts[k]);
    }
    RITZ_REFUSE_IF(
        order && !json_is_null(order) &&
            (!json_is_integer(order) || json_integer_value(order) < 0),
        RITZ_ERR_FORMAT, "'order' is no whole number");
    return RITZ_OK;
}

/* Whether errors keep the tolerance, where a line does not say so itself. */
static bool keeps(const record *r)
{
    const char *name = NULL;
    json_t *limit = NULL;
    const json_t *said = json_object_get(r->json, "feasible");

    if (json_is_boolean(said))
        return json_is_true(said);
    if (r->incomplete)
        return false;
    if (!r->tolerance)
        return !json_is_false(json_object_get(r->json, "ok"));
    json_object_foreach(r->tolerance, name, limit)
    {
        double error = record_value(r->errors, name);

        if (!ritz_measure_meets(name, error, json_number_value(limit)))
            return false;
    }
    return true;
}

static json_t *object_of(const json_t *line, const char *key)
{
    json_t *object = json_object_get(line, key);

    return json_object_size(object) > 0 ? object : NULL;
}

static ritz_status take(json_t *line, const char *path, int64_t number,
                        records *all)
{
    const json_t *order = json_object_get(line, "order");
    record r = {.file = path, .line = number, .json = line};
    record *more = NULL;

    RITZ_CHECK(check_line(line));
    RITZ_REFUSE_IF(all->count == MOST_RECORDS, RITZ_ERR_FORMAT,
                   "these are more than %d records", (int)MOST_RECORDS);
    r.tool = text_of(line, "tool");
    r.method = text_of(line, "method");
    r.subject = text_of(line, "subject");
    r.order = json_is_integer(order) ? json_integer_value(order) : -1;
    r.errors = object_of(line, "errors");
    r.tolerance = object_of(line, "tolerance");
    r.cpu = record_value(json_object_get(line, "seconds"), "cpu");
    r.cost = record_value(json_object_get(line, "cost"), "seconds_per_second");
    r.incomplete = record_value(r.errors, "missing-modes") > 0.0;
    r.feasible = keeps(&r);
    r.chosen = json_is_true(json_object_get(line, "chosen"));
    r.runner_up = json_is_true(json_object_get(line, "runner_up"));
    if (all->count % 256 == 0) {
        more = realloc(all->item, (size_t)(all->count + 256) * sizeof *more);
        RITZ_REFUSE_IF(!more, RITZ_ERR_MEMORY, "no memory for records");
        all->item = more;
    }
    all->item[all->count++] = r;
    json_incref(line);
    return RITZ_OK;
}

static ritz_status take_line(const char *text, size_t length, const char *path,
                             int64_t number, records *all)
{
    ritz_status status = RITZ_OK;
    char context[256];
    json_error_t error = {0};
    json_t *line = json_loadb(text, length, JSON_REJECT_DUPLICATES, &error);

    snprintf(context, sizeof context, "'%.180s', line %lld", path,
             (long long)number);
    if (!line)
        status =
            ritz_fail(RITZ_ERR_FORMAT, "%s: no JSON: %s", context, error.text);
    else if (!json_is_object(line))
        status = ritz_fail(RITZ_ERR_FORMAT,
                           "%s: no record, which is a JSON "
                           "object",
                           context);
    else
        status = ritz_context(take(line, path, number, all), context);
    json_decref(line);
    return status;
}

ritz_status records_read(const char *path, records *all)
{
    struct stat file = {0};
    RITZ_OWN_ARRAY char *text = NULL;
    int64_t number = 0;

    RITZ_REFUSE_IF(stat(path, &file) != 0, RITZ_ERR_FILE,
                   "cannot open '%s': %s", path, strerror(errno));
    RITZ_REFUSE_IF(file.st_size > MOST_BYTES, RITZ_ERR_FORMAT,
                   "'%s' is too large for records: %lld bytes, the most is %d",
                   path, (long long)file.st_size, (int)MOST_BYTES);
    RITZ_CHECK(ritz_text_read(path, &text));
    for (const char *line = text; *line;) {
        size_t length = strcspn(line, "\n");

        number++;
        if (strspn(line, " \t\r") < length)
            RITZ_CHECK(take_line(line, length, path, number, all));
        line += length + (line[length] == '\n');
    }
    return RITZ_OK;
}

void records_free(records *all)
{
    for (int64_t k = 0; k < all->count; k++)
        json_decref(all->item[k].json);
    free(all->item);
    *all = (records){0};
}
