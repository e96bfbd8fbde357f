/* Tolerances as words: which measure, how far off it may be. */
#include "fit/fit_parts.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* A measure, its word, and where its limit stands. */
typedef struct word {
    char word[RITZ_NAME_SIZE];
    const char *measure;
    size_t offset;
    double most;   /* no tolerance is above */
    bool responds; /* needs inputs and outputs */
} word;

#define LIMIT(name) offsetof(ritz_verify_request, limit_##name)

static const word words[] = {
    {"frequency", "frequency-relative", LIMIT(frequency), 1.0, false},
    {"mac", "mac", LIMIT(mac), 1.0, false},
    {"damping", "damping-relative", LIMIT(damping), 1.0, false},
    {"response", "response-relative", LIMIT(response), 1.0, true},
    {"flexible", "flexible-response-relative", LIMIT(flexible), 1.0, true},
    {"gain", "static-gain-relative", LIMIT(gain), 1.0, true},
    {"missing", "missing-modes", LIMIT(missing), 1e9, false},
};

enum { WORDS = sizeof words / sizeof *words };

static double *place_of(ritz_verify_request *limits, const word *w)
{
    return (double *)(void *)((char *)limits + w->offset);
}

static double value_of(const ritz_verify_request *limits, const word *w)
{
    return *(const double *)(const void *)((const char *)limits + w->offset);
}

/* The word of one item: "response" where there is none. */
static const word *find(const char *name)
{
    const char *near = NULL;

    for (int k = 0; k < WORDS; k++)
        if (strcmp(words[k].word, name) == 0)
            return &words[k];
    near = ritz_text_nearest(name, WORDS, words[0].word, sizeof *words);
    ritz_record("there is no measure '%s', %s%s%s", name,
                near ? "is '"
                     : "but frequency, mac, damping, response, flexible, gain, "
                       "missing",
                near ? near : "", near ? "' meant?" : "");
    return NULL;
}

static ritz_status take_item(const char *item, ritz_verify_request *limits)
{
    const char *equals = strchr(item, '=');
    char name[RITZ_NAME_SIZE] = "response";
    const word *w = NULL;
    double value = 0.0;

    if (equals)
        (void)snprintf(name, sizeof name, "%.*s", (int)(equals - item), item);
    w = find(name);
    if (!w)
        return RITZ_ERR_ARGUMENT;
    RITZ_REFUSE_IF(!isnan(value_of(limits, w)), RITZ_ERR_ARGUMENT,
                   "'%s' is given twice", name);
    RITZ_REFUSE_IF(!ritz_text_real(equals ? equals + 1 : item, &value) ||
                       value < 0.0 || value > w->most ||
                       (value == 0.0 && w->most == 1.0),
                   RITZ_ERR_ARGUMENT, "'%s' is no tolerance of '%s'",
                   equals ? equals + 1 : item, name);
    *place_of(limits, w) = value;
    return RITZ_OK;
}

ritz_status ritz_tolerance_take(const char *text, ritz_verify_request *limits)
{
    char item[2 * RITZ_NAME_SIZE];

    for (const char *at = text; at;) {
        size_t length = strcspn(at, ",");

        RITZ_REFUSE_IF(length == 0 || length >= sizeof item, RITZ_ERR_ARGUMENT,
                       "'%s' is no list of tolerances", text);
        memcpy(item, at, length);
        item[length] = '\0';
        RITZ_CHECK(take_item(item, limits));
        at = at[length] ? at + length + 1 : NULL;
    }
    return RITZ_OK;
}

void ritz_tolerance_print(const ritz_verify_request *limits, int64_t size,
                          char *out)
{
    size_t used = 0;

    out[0] = '\0';
    for (int k = 0; k < WORDS && used < (size_t)size; k++) {
        double limit = value_of(limits, &words[k]);

        if (!isnan(limit))
            used += (size_t)snprintf(out + used, (size_t)size - used, "%s%s=%g",
                                     used > 0 ? "," : "", words[k].word, limit);
    }
}

const char *ritz_tolerance_word(const char *measure)
{
    for (int k = 0; k < WORDS; k++)
        if (strcmp(words[k].measure, measure) == 0)
            return words[k].word;
    return measure;
}

double ritz_fit_limit(const ritz_verify_request *limits, const char *measure)
{
    for (int k = 0; k < WORDS; k++)
        if (strcmp(words[k].measure, measure) == 0)
            return value_of(limits, &words[k]);
    return nan("");
}

ritz_status ritz_fit_check(const ritz_verify_request *limits,
                           const ritz_component *full)
{
    bool any = false;

    for (int k = 0; k < WORDS; k++) {
        if (isnan(value_of(limits, &words[k])))
            continue;
        any = any || strcmp(words[k].word, "missing") != 0 ||
              value_of(limits, &words[k]) == 0.0;
        RITZ_REFUSE_IF(
            words[k].responds &&
                (full->io.num_inputs == 0 || full->io.num_outputs == 0),
            RITZ_ERR_ARGUMENT,
            "a tolerance of '%s' needs inputs and outputs, and there "
            "are %" PRId64 " and %" PRId64,
            words[k].word, full->io.num_inputs, full->io.num_outputs);
    }
    RITZ_REFUSE_IF(!any, RITZ_ERR_ARGUMENT,
                   "no tolerance is given: which measure, how far off");
    RITZ_REFUSE_IF(!isnan(limits->limit_damping) &&
                       limits->damping.kind == RITZ_DAMPING_NONE &&
                       !full->damping[0] && !full->D.colptr && !full->K4.colptr,
                   RITZ_ERR_ARGUMENT,
                   "a tolerance of 'damping' needs a model that is damped");
    return RITZ_OK;
}

void ritz_fit_settle(const ritz_reference *reference,
                     ritz_verify_request *limits)
{
    int64_t rigid = 0;

    if (!isnan(limits->limit_damping)) /* of a mode that is missing there is */
        limits->limit_missing = fmax(limits->limit_missing, 0.0); /* none */
    (void)ritz_reference_modes(reference, &rigid);
    if (rigid > 0 || isnan(limits->limit_flexible))
        return;
    limits->limit_response =
        fmin(limits->limit_response, limits->limit_flexible);
    limits->limit_flexible = nan("");
}

/* How many times its tolerance an error is. */
static double ratio(const ritz_measure *m, double limit)
{
    double error = m->value;

    if (strcmp(m->name, "mac") == 0) {
        error = fmax(1.0 - m->value, 0.0);
        limit = 1.0 - limit;
    }
    if (error <= limit)
        return limit > 0.0 ? error / limit : 0.0;
    return limit > 0.0 ? error / limit : 1.0 + error;
}

void ritz_fit_judge(const ritz_verify_request *limits,
                    ritz_fit_candidate *candidate)
{
    candidate->excess = 0.0;
    candidate->binding = -1;
    for (int64_t k = 0; k < candidate->errors.count; k++) {
        ritz_measure *m = &candidate->errors.item[k];
        double limit = ritz_fit_limit(limits, m->name);
        double one = isnan(m->limit) ? limit : m->limit;

        if (isnan(one))
            continue;
        m->limit = one;
        one = ratio(m, one);
        if (candidate->binding < 0 || one > candidate->excess) {
            candidate->excess = one;
            candidate->binding = k;
        }
    }
    candidate->feasible = candidate->excess <= 1.0;
}
