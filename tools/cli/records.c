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

/* Check that values are numbers, or null for an absent one, as JSON has no NaN. A
   cost may have texts, too. */
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
static bool meets_tolerance(const record *r)
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

static ritz_status add_record(json_t *line, records *all)
{
    const json_t *order = json_object_get(line, "order");
    record r = {.json = line};

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
    r.feasible = meets_tolerance(&r);
    r.chosen = json_is_true(json_object_get(line, "chosen"));
    r.runner_up = json_is_true(json_object_get(line, "runner_up"));
    RITZ_CHECK_ROOM(all->item, all->count, all->room);
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
        status = ritz_fail(RITZ_ERR_FORMAT, "no JSON: %s", error.text);
    else if (!json_is_object(line))
        status =
            ritz_fail(RITZ_ERR_FORMAT, "no record, which is a JSON object");
    else
        status = add_record(line, all);
    json_decref(line);
    return ritz_context(status, context);
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

/* --- what a measured file cost ------------------------------------------- */

enum { NAME = 512 };

/* The word behind -o or --output; quoted, if the shell needs that. */
static void output_of(const record *r, char out[NAME])
{
    static const char *const options[] = {" -o ", " --output ", " --output="};
    const char *word = NULL;
    size_t length = 0;

    out[0] = '\0';
    for (size_t k = 0; k < sizeof options / sizeof *options && !word; k++) {
        word = strstr(text_of(r->json, "command"), options[k]);
        word = word ? word + strlen(options[k]) : NULL;
    }
    if (!word)
        return;
    if (*word == '\'')
        length = strcspn(++word, "'");
    else
        length = strcspn(word, " ");
    if (length < NAME)
        snprintf(out, NAME, "%.*s", (int)length, word);
}

/* The name in "SHA256  NAME". */
static const char *input_of(const record *r, size_t k)
{
    const char *text = json_string_value(
        json_array_get(json_object_get(r->json, "inputs"), k));
    const char *gap = text ? strstr(text, "  ") : NULL;

    return gap ? gap + 2 : "";
}

static size_t count_inputs(const record *r)
{
    return json_array_size(json_object_get(r->json, "inputs"));
}

/* The last line of ritz-basis or ritz-reduce before @p r that made its k-th
   input; NULL: none did. */
static const record *find_maker(const records *all, const record *r, size_t k)
{
    char made[NAME];

    for (const record *s = r - 1; s >= all->item && *input_of(r, k); s--) {
        if (strcmp(s->tool, "ritz-basis") != 0 &&
            strcmp(s->tool, "ritz-reduce") != 0)
            continue;
        output_of(s, made);
        if (strcmp(made, input_of(r, k)) == 0)
            return s;
    }
    return NULL;
}

/* Processor time of the reduction of what a line reads, and of its basis. */
static double time_to_make(const records *all, const record *r)
{
    double sum = 0.0;

    for (size_t k = 0; k < count_inputs(r); k++) {
        const record *reduce = find_maker(all, r, k);

        sum += reduce ? reduce->cpu : 0.0;
        for (size_t i = 0; reduce && i < count_inputs(reduce); i++) {
            const record *basis = find_maker(all, reduce, i);

            sum += basis ? basis->cpu : 0.0;
        }
    }
    return sum;
}

/* Simulator cost of a file that a line reads, measured by another line. */
static double cost_of_inputs(const records *all, const record *r)
{
    for (int64_t k = all->count - 1; k >= 0; k--) {
        const record *s = &all->item[k];

        if (isnan(s->cost) || s->errors)
            continue;
        for (size_t i = 0; i < count_inputs(r); i++)
            if (*input_of(r, i) && strcmp(input_of(s, 0), input_of(r, i)) == 0)
                return s->cost;
    }
    return nan("");
}

void records_join(records *all)
{
    for (int64_t k = 0; k < all->count; k++) {
        record *r = &all->item[k];
        double time = 0.0;

        if (!r->errors || strcmp(r->tool, "ritz-verify") != 0)
            continue;
        time = time_to_make(all, r);
        r->cpu = time > 0.0 ? time : nan(""); /* its own is verification's */
        if (isnan(r->cost))
            r->cost = cost_of_inputs(all, r);
    }
}

/* --- what a chart shows --------------------------------------------------- */

/* The measure at `rank` in the order of drawing; NULL: there are no more. */
static const ritz_measure_kind *by_importance(int rank)
{
    for (int k = 0; k < RITZ_MEASURES; k++)
        if (ritz_measure_table[k].importance == rank + 1)
            return &ritz_measure_table[k];
    return NULL;
}

double record_error(const record *r, const char *name)
{
    return ritz_measure_error(name, record_value(r->errors, name));
}

/* A later line that says the same and more takes the place of an earlier. */
static void add_once(const record *r, records *some)
{
    for (int64_t k = 0; k < some->count; k++) {
        record *before = &some->item[k];

        if (before->order != r->order ||
            strcmp(before->method, r->method) != 0 ||
            !json_equal(before->errors, r->errors))
            continue;
        bool chosen = before->chosen, runner_up = before->runner_up;

        *before = *r;
        before->chosen = before->chosen || chosen;
        before->runner_up = before->runner_up || runner_up;
        return;
    }
    some->item[some->count++] = *r;
}

/* Those of one subject that can be drawn, each once. */
static ritz_status select_records(const records *all, const char *subject,
                                  records *out)
{
    const record *first = NULL;

    RITZ_CHECK_NEW(out->item, all->count + 1);
    for (int64_t k = 0; k < all->count; k++) {
        const record *r = &all->item[k];

        if (!r->errors || r->order < 0 || !*r->method ||
            (subject && strcmp(r->subject, subject) != 0))
            continue;
        first = first ? first : r;
        RITZ_REFUSE_IF(!subject && strcmp(r->subject, first->subject) != 0,
                       RITZ_ERR_ARGUMENT,
                       "records of '%.60s' and of '%.60s' do not compare: "
                       "choose by --subject",
                       first->subject, r->subject);
        add_once(r, out);
    }
    RITZ_REFUSE_IF(out->count == 0 && subject && *subject, RITZ_ERR_ARGUMENT,
                   "no record of '%.60s' has a method, an order and errors",
                   subject);
    RITZ_REFUSE_IF(out->count == 0, RITZ_ERR_ARGUMENT,
                   "no record has a method, an order and errors: those of "
                   "ritz-verify and ritz-fit do");
    return RITZ_OK;
}

static bool is_measured(const records *all, const char *name)
{
    for (int64_t k = 0; k < all->count; k++)
        if (isfinite(record_value(all->item[k].errors, name)))
            return true;
    return false;
}

const char *record_title(const char *name)
{
    const ritz_measure_kind *kind = ritz_measure_kind_find(name);

    return kind && kind->label ? kind->label : name;
}

/* The tolerance that records state of a measure; of MAC, what it may lack. */
static double tolerance_of(const records *all, const char *name)
{
    for (int64_t k = 0; k < all->count; k++) {
        double limit = record_value(all->item[k].tolerance, name);

        if (isfinite(limit))
            return ritz_measure_error(name, limit);
    }
    return nan("");
}

static void add_measure(const char *name, record_set *s)
{
    measure *m = &s->measure[s->num_measures];

    for (int64_t k = 0; k < s->num_measures; k++)
        if (strcmp(s->measure[k].name, name) == 0)
            return;
    if (s->num_measures == RECORD_SET_MEASURES || !is_measured(&s->all, name) ||
        strlen(name) >= RITZ_NAME_SIZE)
        return;
    snprintf(m->name, RITZ_NAME_SIZE, "%s", name);
    snprintf(m->title, RITZ_NAME_SIZE, "%s", record_title(name));
    m->tolerance = tolerance_of(&s->all, name);
    s->num_measures++;
}

/* Those known, in their order; then others, relative ones or all. */
static void add_measures(json_t *values, bool others, record_set *s)
{
    const char *name = NULL;
    json_t *value = NULL;

    for (int k = 0; by_importance(k); k++)
        if (json_object_get(values, by_importance(k)->name))
            add_measure(by_importance(k)->name, s);
    json_object_foreach(values, name, value)
    {
        const char *end = strrchr(name, '-');

        if (others || (end && strcmp(end, "-relative") == 0))
            add_measure(name, s);
    }
}

/* Measures with a tolerance first, then relative errors by importance. */
static ritz_status list_measures(record_set *s)
{
    for (int64_t k = 0; k < s->all.count; k++)
        add_measures(s->all.item[k].tolerance, true, s);
    for (int k = 0; by_importance(k); k++)
        add_measure(by_importance(k)->name, s);
    for (int64_t k = 0; k < s->all.count; k++)
        add_measures(s->all.item[k].errors, false, s);
    RITZ_REFUSE_IF(s->num_measures == 0, RITZ_ERR_ARGUMENT,
                   "no record has a relative error that could be drawn");
    return RITZ_OK;
}

bool records_matter(const records *all, const measure *m)
{
    for (int64_t k = 0; k < all->count; k++)
        if (record_error(&all->item[k], m->name) > RECORDS_ROUNDING)
            return true;
    return false;
}

bool records_cost(const records *all)
{
    bool any = false;

    for (int64_t k = 0; k < all->count; k++) {
        if (!all->item[k].errors)
            continue;
        if (!isfinite(all->item[k].cost))
            return false;
        any = true;
    }
    return any;
}

static int by_name(const void *a, const void *b)
{
    const char *const *x = a, *const *y = b;

    return strcmp(*x, *y);
}

/* Methods in order of their names, and of each record which it is. */
static ritz_status list_methods(record_set *s)
{
    const records *all = &s->all;
    int64_t n = 0;

    RITZ_CHECK_NEW(s->method, all->count + 1);
    RITZ_CHECK_NEW(s->which, all->count + 1);
    for (int64_t k = 0; k < all->count; k++)
        s->method[k] = all->item[k].method;
    qsort(s->method, (size_t)all->count, sizeof *s->method, by_name);
    for (int64_t k = 0; k < all->count; k++)
        if (n == 0 || strcmp(s->method[n - 1], s->method[k]) != 0)
            s->method[n++] = s->method[k];
    for (int64_t k = 0; k < all->count; k++)
        while (strcmp(s->method[s->which[k]], all->item[k].method) != 0)
            s->which[k]++;
    s->num_methods = n;
    return RITZ_OK;
}

ritz_status record_set_new(const records *all, const char *subject,
                           record_set *out)
{
    *out = (record_set){0};
    RITZ_CHECK(select_records(all, subject, &out->all));
    RITZ_CHECK(list_methods(out));
    return list_measures(out);
}

void record_set_free(record_set *s)
{
    RITZ_FREE(s->all.item, s->method, s->which);
    *s = (record_set){0};
}
