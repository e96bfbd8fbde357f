/* Inputs as functions of time: words, and tables from files. */
#include <ritz/simulate.h>

#include "base/alloc.h"
#include "base/search.h"
#include "base/text.h"
#include "base/tolerances.h"

#include <ritz/base.h>

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WORD_SIZE = 32, TEXT_SIZE = 128 };

static const struct word {
    char name[WORD_SIZE];
    ritz_signal_kind kind;
    int numbers; /* behind a colon */
} words[] = {
    {"step", RITZ_SIGNAL_STEP, 0},
    {"impulse", RITZ_SIGNAL_IMPULSE, 0},
    {"sine", RITZ_SIGNAL_SINE, 1},
    {"chirp", RITZ_SIGNAL_CHIRP, 2},
};

enum { NUM_WORDS = sizeof words / sizeof *words };

static const struct word *find_word(const char *text)
{
    size_t length = strcspn(text, ":*");

    for (int k = 0; k < NUM_WORDS; k++)
        if (strlen(words[k].name) == length &&
            strncmp(words[k].name, text, length) == 0)
            return &words[k];
    return NULL;
}

bool ritz_signal_is_file(const char *text)
{
    return find_word(text) == NULL;
}

/* "F0,F1" */
static bool read_numbers(char *text, int count, double *out)
{
    for (int k = 0; k < count; k++) {
        char *comma = strchr(text, ',');

        if ((comma != NULL) != (k + 1 < count))
            return false;
        if (comma)
            *comma = '\0';
        if (!ritz_text_real(text, &out[k]) || out[k] < 0.0)
            return false;
        text = comma ? comma + 1 : text;
    }
    return true;
}

static ritz_status parse_word(const struct word *word, const char *text,
                              ritz_signal *out)
{
    ritz_signal signal = {.kind = word->kind, .amplitude = 1.0};
    char copy[TEXT_SIZE];
    char *star = NULL;
    char *colon = NULL;

    RITZ_REFUSE_IF(strlen(text) >= sizeof copy, RITZ_ERR_ARGUMENT,
                   "'%s' is no signal", text);
    (void)snprintf(copy, sizeof copy, "%s", text);
    star = strchr(copy, '*');
    if (star)
        *star = '\0';
    RITZ_REFUSE_IF(star && !ritz_text_real(star + 1, &signal.amplitude),
                   RITZ_ERR_ARGUMENT, "'%s' has no amplitude behind '*'", text);
    colon = strchr(copy, ':');
    RITZ_REFUSE_IF(
        (colon != NULL) != (word->numbers > 0) ||
            (colon && !read_numbers(colon + 1, word->numbers, signal.hertz)),
        RITZ_ERR_ARGUMENT, "'%s': %s is followed by %s", text, word->name,
        word->numbers == 0   ? "nothing but '*' and an amplitude"
        : word->numbers == 1 ? "':' and a frequency in Hz"
                             : "':' and two frequencies in Hz");
    *out = signal;
    return RITZ_OK;
}

/* One line into time and value; false at a comment or an empty line. */
static ritz_status parse_line(char *line, int64_t number, bool *any,
                              double value[2])
{
    static const char blank[] = " \t\r,;";
    char *place = NULL;
    int found = 0;

    *any = false;
    for (char *word = strtok_r(line, blank, &place); word;
         word = strtok_r(NULL, blank, &place)) {
        if (found == 0 && word[0] == '#')
            return RITZ_OK;
        RITZ_REFUSE_IF(found == 2 || !ritz_text_real(word, &value[found]),
                       RITZ_ERR_FORMAT,
                       "line %" PRId64 " is not a time and a value", number);
        found++;
    }
    RITZ_REFUSE_IF(found == 1, RITZ_ERR_FORMAT,
                   "line %" PRId64 " has a time and no value", number);
    *any = found == 2;
    return RITZ_OK;
}

ritz_status ritz_signal_read(const char *path, ritz_signal *out)
{
    RITZ_OWN(ritz_signal)
    signal = {.kind = RITZ_SIGNAL_TABLE, .amplitude = 1.0};
    RITZ_OWN_ARRAY char *text = NULL;
    char *line = NULL;
    int64_t number = 0;

    RITZ_CHECK(ritz_text_read(path, &text));
    RITZ_CHECK_NEW(signal.time, ritz_text_lines(text));
    RITZ_CHECK_NEW(signal.value, ritz_text_lines(text));
    for (line = text; line;) {
        char *end = strchr(line, '\n');
        double pair[2] = {0.0, 0.0};
        bool any = false;

        if (end)
            *end = '\0';
        RITZ_CHECK(parse_line(line, ++number, &any, pair));
        RITZ_REFUSE_IF(
            any && signal.count > 0 && pair[0] < signal.time[signal.count - 1],
            RITZ_ERR_FORMAT, "the time of line %" PRId64 " descends", number);
        signal.time[signal.count] = pair[0];
        signal.value[signal.count] = pair[1];
        signal.count += any;
        line = end ? end + 1 : NULL;
    }
    RITZ_REFUSE_IF(signal.count == 0, RITZ_ERR_FORMAT,
                   "there is no line of a time and a value");
    RITZ_MOVE(*out, signal);
    return RITZ_OK;
}

ritz_status ritz_signal_parse(const char *text, ritz_signal *out)
{
    const struct word *word = find_word(text);
    ritz_status status = word ? parse_word(word, text, out)
                              : ritz_context(ritz_signal_read(text, out), text);

    if (status != RITZ_ERR_FILE)
        return status;
    return ritz_fail(RITZ_ERR_FILE,
                     "'%s' is neither step, impulse, sine:F nor chirp:F,F, nor "
                     "a file that can be read",
                     text);
}

/* At a time that occurs twice the table jumps, to the later value. */
static double look_up(const ritz_signal *signal, double t)
{
    const double *x = signal->time;
    int64_t next = ritz_upper_bound(signal->count, x, t);
    double share = 0.0;

    if (next == 0)
        return 0.0;
    if (next == signal->count)
        return t <= x[next - 1] * (1.0 + 4.0 * DBL_EPSILON)
                   ? signal->value[next - 1]
                   : 0.0;
    share = (t - x[next - 1]) / (x[next] - x[next - 1]);
    return (1.0 - share) * signal->value[next - 1] +
           share * signal->value[next];
}

double ritz_signal_at(const ritz_signal *signal, double t, double seconds)
{
    const double *f = signal->hertz;

    switch (signal->kind) {
    case RITZ_SIGNAL_ZERO:
    case RITZ_SIGNAL_IMPULSE:
        break;
    case RITZ_SIGNAL_STEP:
        return signal->amplitude;
    case RITZ_SIGNAL_SINE:
        return signal->amplitude * sin(2.0 * RITZ_PI * f[0] * t);
    case RITZ_SIGNAL_CHIRP:
        return signal->amplitude *
               sin(2.0 * RITZ_PI *
                   (f[0] * t + 0.5 * (f[1] - f[0]) * t * t / seconds));
    case RITZ_SIGNAL_TABLE:
        return signal->amplitude * look_up(signal, t);
    }
    return 0.0;
}

void ritz_signal_free(ritz_signal *signal)
{
    RITZ_FREE(signal->time, signal->value);
    *signal = (ritz_signal){0};
}
