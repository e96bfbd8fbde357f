/* Answers of tools, held against what was claimed. */
#include "claims/claims.h"

#include "base/text.h"
#include "base/tolerances.h"

#include <ritz/base.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The item of a list that "3" or "static-gain", its "name" or "at", names. */
static const json_t *find_item(const json_t *list, const char *name)
{
    static const char *const keys[] = {"name", "at"};
    int64_t index = 0;

    if (ritz_text_whole(name, &index))
        return index < 0 ? NULL : json_array_get(list, (size_t)index);
    for (size_t i = 0; i < json_array_size(list); i++)
        for (size_t k = 0; k < sizeof keys / sizeof *keys; k++) {
            const json_t *item = json_array_get(list, i);
            const char *text =
                json_string_value(json_object_get(item, keys[k]));

            if (text && strcmp(text, name) == 0)
                return item;
        }
    return NULL;
}

/*
 * The value at a path such as "configurations[1].frequencies_hz[6]" or
 * "measures[static-gain].value"; NULL: there is none.
 */
static const json_t *find_value(const json_t *answer, const char *path)
{
    const json_t *at = answer;

    while (at && *path) {
        const bool item = *path == '[';
        const char *name = path + item;
        const size_t length = strcspn(name, item ? "]" : ".[");
        char key[64] = "";

        if (length >= sizeof key)
            return NULL;
        memcpy(key, name, length);
        at = item ? find_item(at, key) : json_object_get(at, key);
        path = name + length;
        path += item && *path;
        path += *path == '.';
    }
    return at;
}

/* As what a frequency in Hz was published: "as lambda". */
static const char *const forms[] = {"hertz", "omega", "lambda", "beta"};

enum { NUM_FORMS = sizeof forms / sizeof *forms };

/* omega = 2 pi f, lambda = omega^2; beta of a beam of E I = rho A = L = 1. */
static double convert_hertz(double hertz, size_t form)
{
    const double omega = 2.0 * RITZ_PI * hertz;
    const double values[NUM_FORMS] = {hertz, omega, omega * omega, sqrt(omega)};

    return values[form];
}

/* How a value may differ. */
typedef enum bound_kind { RELATIVE, ABSOLUTE, BELOW, ABOVE } bound_kind;

typedef struct bound {
    bound_kind kind;
    double size;
} bound;

static bool is_within(double value, double expected, const bound *b)
{
    switch (b->kind) {
    case RELATIVE:
        return fabs(value - expected) <= b->size * fabs(expected);
    case ABSOLUTE:
        return fabs(value - expected) <= b->size;
    case BELOW:
        return value < b->size;
    case ABOVE:
        return value > b->size;
    }
    return false;
}

/* Count a verdict and tell it: one line of TAP, one object of JSON. */
static void tell_claim(claims_state *state, bool holds, const char *what,
                       const char *found)
{
    int64_t number = state->holds + state->fails + state->skipped + 1;
    const char *file = ritz_path_name(state->file);
    bool skipped = state->skipping;

    cli_say(state->run, "%sok %ld - %s:%d %s: %s; %s%s%s",
            skipped || holds ? "" : "not ", number, file, state->number, what,
            skipped ? "not looked at" : found, state->source,
            skipped ? " # skip there is no " : "",
            skipped ? state->absent : "");
    if (!holds && !skipped)
        cli_say(state->run, "# after: %s", state->command);
    state->skipped += skipped;
    state->holds += holds && !skipped;
    state->fails += !holds && !skipped;
    json_array_append_new(
        state->list, json_pack("{s:s, s:i, s:s, s:s, s:s, s:b, s:b}", "file",
                               file, "line", state->number, "what", what,
                               "found", found, "source", state->source, "holds",
                               holds && !skipped, "skipped", skipped));
}

/* "expect failure WORDS": status 1 with that sentence. */
static ritz_status expect_failure(claims_state *state, const claims_line *line)
{
    const char *sentence =
        json_string_value(find_value(state->answer, "error"));

    RITZ_REFUSE_IF(
        line->count != 3, RITZ_ERR_FORMAT,
        "'expect failure' takes the words of its sentence, in quotes");
    tell_claim(
        state,
        state->exit_code == 1 && sentence && strstr(sentence, line->word[2]),
        "failure", sentence ? sentence : "it did not fail with a sentence");
    return RITZ_OK;
}

/* "expect PATH is TEXT": of texts, whole numbers and truths. */
static void expect_text(claims_state *state, const claims_line *line)
{
    const json_t *at = find_value(state->answer, line->word[1]);
    char text[256] = "nothing there";

    if (json_is_string(at))
        snprintf(text, sizeof text, "%s", json_string_value(at));
    else if (json_is_integer(at))
        snprintf(text, sizeof text, "%" JSON_INTEGER_FORMAT,
                 json_integer_value(at));
    else if (json_is_boolean(at))
        snprintf(text, sizeof text, "%s", json_is_true(at) ? "true" : "false");
    tell_claim(state, strcmp(text, line->word[3]) == 0, line->word[1], text);
}

/* "frequencies_hz[6]" and 2 more: "frequencies_hz[8]"; a path that does not end
   in an index is itself. */
static void name_item(const char *path, int64_t more, size_t size, char *out)
{
    const char *bracket = strrchr(path, '[');
    char digits[24] = "";
    int64_t index = 0;

    snprintf(out, size, "%s", path);
    if (bracket && strcspn(bracket, "]") + 1 == strlen(bracket))
        snprintf(digits, sizeof digits, "%.*s", (int)strlen(bracket) - 2,
                 bracket + 1);
    if (ritz_text_whole(digits, &index) && index >= 0 &&
        index < INT64_MAX - more)
        snprintf(out, size, "%.*s[%ld]", (int)(bracket - path), path,
                 index + more);
}

/* One number, `more` items beyond the path. */
static ritz_status expect_number(claims_state *state, const claims_line *line,
                                 int64_t more, const char *text, size_t form,
                                 const bound *allowed)
{
    const json_t *at = NULL;
    double expected = 0.0, value = 0.0;
    char what[512], found[160];

    RITZ_REFUSE_IF(text && !ritz_text_real(text, &expected), RITZ_ERR_FORMAT,
                   "'%.40s' is not a number", text);
    name_item(line->word[1], more, sizeof what, what);
    at = find_value(state->answer, what);
    value = convert_hertz(json_number_value(at), form);
    if (!json_is_number(at))
        snprintf(found, sizeof found, "nothing there, %s expected",
                 text ? text : "a number");
    else if (text)
        snprintf(found, sizeof found, "%.12g for %s, off %.1e of %.1e%s", value,
                 text, value - expected, allowed->size,
                 allowed->kind == RELATIVE ? " relative" : "");
    else
        snprintf(found, sizeof found, "%.3e, to be %s %.1e", value,
                 allowed->kind == BELOW ? "below" : "above", allowed->size);
    tell_claim(state, json_is_number(at) && is_within(value, expected, allowed),
               what, found);
    return RITZ_OK;
}

/* "... rel 1e-6": how the line ends, behind `count` words of values. */
static ritz_status read_bound(const claims_line *line, int count, bound *out)
{
    static const char *const words[] = {[RELATIVE] = "rel",
                                        [ABSOLUTE] = "abs",
                                        [BELOW] = "below",
                                        [ABOVE] = "above"};
    size_t kind = 0;

    RITZ_REFUSE_IF(
        count < 0, RITZ_ERR_FORMAT,
        "an expectation is PATH [as FORM] VALUE... rel|abs TOLERANCE, "
        "PATH below|above LIMIT, PATH is WORD or failure WORDS");
    while (kind < sizeof words / sizeof *words &&
           strcmp(line->word[line->count - 2], words[kind]) != 0)
        kind++;
    RITZ_REFUSE_IF(kind == sizeof words / sizeof *words, RITZ_ERR_FORMAT,
                   "'%.40s' is none of rel, abs, below, above",
                   line->word[line->count - 2]);
    out->kind = (bound_kind)kind;
    RITZ_REFUSE_IF(!ritz_text_real(line->word[line->count - 1], &out->size),
                   RITZ_ERR_FORMAT, "'%.40s' is not a number",
                   line->word[line->count - 1]);
    RITZ_REFUSE_IF((kind >= BELOW) != (count == 0), RITZ_ERR_FORMAT, "%s",
                   kind >= BELOW ? "a limit stands alone"
                                 : "no value is given");
    return RITZ_OK;
}

ritz_status claims_expect(claims_state *state, const claims_line *line)
{
    const bool named = line->count > 3 && strcmp(line->word[2], "as") == 0;
    const int first = named ? 4 : 2;
    const int count = line->count - 2 - first;
    size_t form = 0;
    bound allowed = {0};

    RITZ_REFUSE_IF(!state->source[0], RITZ_ERR_FORMAT,
                   "a claim needs a 'source' before it");
    RITZ_REFUSE_IF(line->count < 3, RITZ_ERR_FORMAT, "nothing is expected");
    if (state->skipping) {
        tell_claim(state, false, "expect", "");
        return RITZ_OK;
    }
    if (strcmp(line->word[1], "failure") == 0)
        return expect_failure(state, line);
    if (line->count == 4 && strcmp(line->word[2], "is") == 0) {
        expect_text(state, line);
        return RITZ_OK;
    }
    while (named && form < NUM_FORMS && strcmp(forms[form], line->word[3]) != 0)
        form++;
    RITZ_REFUSE_IF(form == NUM_FORMS, RITZ_ERR_FORMAT,
                   "'%.40s' is none of hertz, omega, lambda, beta",
                   line->word[3]);
    RITZ_CHECK(read_bound(line, count, &allowed));
    if (count == 0)
        RITZ_CHECK(expect_number(state, line, 0, NULL, form, &allowed));
    for (int k = 0; k < count; k++)
        RITZ_CHECK(expect_number(state, line, k, line->word[first + k], form,
                                 &allowed));
    return RITZ_OK;
}
