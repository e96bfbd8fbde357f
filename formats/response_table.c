/*
 * A frequency response as columns of text, as instruments and ritz-export write
 * it: behind '#' and "hertz" a pair of columns for each channel,
 *
 *     # hertz  re(OUT/IN)  im(OUT/IN)  |OUT2/IN|  degrees ...
 *
 * or "real imaginary" or "magnitude degrees" of the only one, which is u1 to
 * y1. Three columns without a head are hertz, real and imaginary part. Columns
 * of singular values, behind the channels, are passed over.
 */
#include "base/alloc.h"
#include "base/complex.h"
#include "base/text.h"
#include "base/tolerances.h"

#include <ritz/base.h>
#include <ritz/response.h>

#include <complex.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char blank[] = " \t\r,;";

static const char mark[] = "\xef\xbb\xbf"; /* byte-order mark of UTF-8 */

enum { SEEN = 512, BARE = 3 };

/* What the head says of the columns behind hertz. */
typedef struct table_columns {
    int64_t pairs, passed;   /* channels; columns behind them */
    int64_t *output, *input; /* of each pair */
    bool *polar;
    int64_t num_outputs, num_inputs;
    char (*out)[RITZ_NAME_SIZE]; /* names in the order in which they come */
    char (*in)[RITZ_NAME_SIZE];
} table_columns;

static void table_columns_free(table_columns *c)
{
    RITZ_FREE(c->output, c->input, c->polar, c->out, c->in);
    *c = (table_columns){0};
}

/* Index of a name in a list, to which it is added if it is new. */
static ritz_status find_name(const char *name, size_t length, int64_t *count,
                             char (*list)[RITZ_NAME_SIZE], int64_t *out)
{
    char word[RITZ_NAME_SIZE] = "";

    RITZ_REFUSE_IF(length == 0 || length >= RITZ_NAME_SIZE, RITZ_ERR_FORMAT,
                   "'%.*s' is no name of a signal",
                   (int)(length < 80 ? length : 80), name);
    memcpy(word, name, length);
    *out = ritz_name_index(*count, list, word);
    if (*out >= 0)
        return RITZ_OK;
    *out = (*count)++;
    memcpy(list[*out], word, sizeof word);
    return RITZ_OK;
}

/* "OUT/IN" between a prefix and a last character. */
static ritz_status take_names(const char *word, size_t prefix, table_columns *c)
{
    const char *name = word + prefix;
    const size_t length = strlen(name) - 1;
    const char *slash = memchr(name, '/', length);
    const size_t first = slash ? (size_t)(slash - name) : 0;

    RITZ_REFUSE_IF(!slash || memchr(slash + 1, '/', length - first - 1),
                   RITZ_ERR_FORMAT, "'%.80s' is not of the form OUT/IN", word);
    RITZ_CHECK(
        find_name(name, first, &c->num_outputs, c->out, &c->output[c->pairs]));
    return find_name(slash + 1, length - first - 1, &c->num_inputs, c->in,
                     &c->input[c->pairs]);
}

/* A pair of the only channel. */
static ritz_status take_only(table_columns *c)
{
    RITZ_CHECK(
        find_name("y1", 2, &c->num_outputs, c->out, &c->output[c->pairs]));
    return find_name("u1", 2, &c->num_inputs, c->in, &c->input[c->pairs]);
}

static bool is_between(const char *word, const char *prefix, char last)
{
    const size_t length = strlen(word), start = strlen(prefix);

    return length > start + 1 && strncmp(word, prefix, start) == 0 &&
           word[length - 1] == last;
}

/* Two words of the head. */
static ritz_status take_pair(const char *first, const char *second,
                             table_columns *c)
{
    const bool degrees = second && strcmp(second, "degrees") == 0;
    const bool imaginary = second && is_between(second, "im(", ')') &&
                           is_between(first, "re(", ')') &&
                           strcmp(first + 3, second + 3) == 0;

    if (degrees && is_between(first, "|", '|')) {
        RITZ_CHECK(take_names(first, 1, c));
    } else if (imaginary) {
        RITZ_CHECK(take_names(first, 3, c));
    } else {
        RITZ_REFUSE_IF(!second ||
                           !((strcmp(first, "real") == 0 &&
                              strcmp(second, "imaginary") == 0) ||
                             (strcmp(first, "magnitude") == 0 && degrees)),
                       RITZ_ERR_FORMAT,
                       "the head has '%.80s' where re(OUT/IN) and im(OUT/IN), "
                       "or |OUT/IN| and degrees, are expected",
                       first);
        RITZ_CHECK(take_only(c));
    }
    c->polar[c->pairs++] = degrees;
    return RITZ_OK;
}

static ritz_status table_columns_new(size_t words, table_columns *c)
{
    const int64_t most = (int64_t)words / 2 + 1;

    RITZ_CHECK_NEW(c->output, most);
    RITZ_CHECK_NEW(c->input, most);
    RITZ_CHECK_NEW(c->polar, most);
    RITZ_CHECK_NEW(c->out, most);
    RITZ_CHECK_NEW(c->in, most);
    return RITZ_OK;
}

/* Each channel of each output and input, once. */
static ritz_status check_channels(const table_columns *c)
{
    RITZ_OWN_ARRAY bool *there = NULL;

    RITZ_REFUSE_IF(c->pairs == 0, RITZ_ERR_FORMAT, "the head names no channel");
    RITZ_REFUSE_IF(c->num_outputs > c->pairs / c->num_inputs ||
                       c->num_outputs * c->num_inputs != c->pairs,
                   RITZ_ERR_FORMAT,
                   "%" PRId64 " channels are not one of each of %" PRId64
                   " outputs and %" PRId64 " inputs",
                   c->pairs, c->num_outputs, c->num_inputs);
    RITZ_CHECK_NEW(there, c->pairs);
    for (int64_t k = 0; k < c->pairs; k++) {
        bool *at = &there[c->output[k] * c->num_inputs + c->input[k]];

        RITZ_REFUSE_IF(*at, RITZ_ERR_FORMAT, "%s/%s is there twice",
                       c->out[c->output[k]], c->in[c->input[k]]);
        *at = true;
    }
    return RITZ_OK;
}

/* The head, behind its '#'. */
static ritz_status read_head(char *line, table_columns *c)
{
    char *place = NULL;
    char *word = NULL;

    RITZ_CHECK(table_columns_new(strlen(line), c));
    word = strtok_r(line, blank, &place);
    RITZ_REFUSE_IF(!word || strcmp(word, "hertz") != 0, RITZ_ERR_FORMAT,
                   "no table of a response: its head begins with '%.40s', not "
                   "with hertz",
                   word ? word : "");
    while ((word = strtok_r(NULL, blank, &place)) != NULL) {
        if (strncmp(word, "sigma", 5) == 0 || c->passed > 0)
            c->passed++;
        else
            RITZ_CHECK(take_pair(word, strtok_r(NULL, blank, &place), c));
    }
    return check_channels(c);
}

/* Numbers of a row, as many as there are columns. */
static ritz_status read_row(char *line, int64_t number, int64_t count,
                            double *value, bool *any)
{
    char *place = NULL;
    int64_t found = 0;

    *any = false;
    for (char *word = strtok_r(line, blank, &place); word;
         word = strtok_r(NULL, blank, &place)) {
        if (found == 0 && word[0] == '#')
            return RITZ_OK;
        RITZ_REFUSE_IF(found == count || !ritz_text_real(word, &value[found]) ||
                           !isfinite(value[found]),
                       RITZ_ERR_FORMAT,
                       "line %" PRId64 " is not a row of %" PRId64 " numbers",
                       number, count);
        found++;
    }
    RITZ_REFUSE_IF(found > 0 && found < count, RITZ_ERR_FORMAT,
                   "line %" PRId64 " has %" PRId64
                   " numbers instead of %" PRId64,
                   number, found, count);
    *any = found > 0;
    return RITZ_OK;
}

/* Numbers of a row into the next point. */
static ritz_status add_point(const table_columns *c, const double *value,
                             int64_t number, ritz_response *r)
{
    double _Complex *H = r->H + r->count * c->pairs;

    RITZ_REFUSE_IF(value[0] < 0.0, RITZ_ERR_FORMAT,
                   "line %" PRId64 ": %g Hz is no frequency", number, value[0]);
    RITZ_REFUSE_IF(r->count > 0 && value[0] <= r->hertz[r->count - 1],
                   RITZ_ERR_FORMAT,
                   "the frequency of line %" PRId64 " does not ascend", number);
    r->hertz[r->count] = value[0];
    for (int64_t k = 0; k < c->pairs; k++) {
        const double a = value[1 + 2 * k], b = value[2 + 2 * k];
        const double angle = b * RITZ_PI / 180.0;

        RITZ_REFUSE_IF(c->polar[k] && a < 0.0, RITZ_ERR_FORMAT,
                       "line %" PRId64 ": a magnitude is negative", number);
        H[c->output[k] * c->num_inputs + c->input[k]] =
            c->polar[k] ? ritz_complex(a * cos(angle), a * sin(angle))
                        : ritz_complex(a, b);
    }
    r->count++;
    return RITZ_OK;
}

static ritz_status make_room(const table_columns *c, int64_t rows,
                             ritz_response *r)
{
    r->num_outputs = c->num_outputs;
    r->num_inputs = c->num_inputs;
    RITZ_CHECK_COPY(r->output, c->out, c->num_outputs);
    RITZ_CHECK_COPY(r->input, c->in, c->num_inputs);
    RITZ_REFUSE_IF(rows > INT64_MAX / 16 / c->pairs, RITZ_ERR_FORMAT,
                   "%" PRId64 " lines are too many", rows);
    RITZ_CHECK_NEW(r->hertz, rows);
    RITZ_CHECK_NEW(r->H, rows * c->pairs);
    (void)snprintf(r->method, sizeof r->method, "measured");
    return RITZ_OK;
}

/* The line after the one that ends at `end`; NULL: there is none. */
static char *cut_line(char *line)
{
    char *end = strchr(line, '\n');

    if (end)
        *end = '\0';
    return end ? end + 1 : NULL;
}

/* Words of the line, and whether the first is a number. */
static int64_t count_words(const char *line, bool *number)
{
    char first[SEEN] = "";
    double ignored = 0.0;
    const size_t length = strcspn(line, " \t\r,;\n");
    int64_t count = 0;

    if (length < sizeof first)
        memcpy(first, line, length);
    *number = ritz_text_real(first, &ignored);
    while (*line != '\0' && *line != '\n') {
        count++;
        line += strcspn(line, " \t\r,;\n");
        line += strspn(line, blank);
    }
    return count;
}

/* The head if the first line is one, else that of three columns. */
static ritz_status find_columns(char **text, int64_t *number, table_columns *c)
{
    char bare[] = "hertz real imaginary";
    char *line = *text;
    bool numbers = false;
    int64_t words = 0;

    if (strncmp(line, mark, sizeof mark - 1) == 0)
        line += sizeof mark - 1;
    for (; *line != '\0' && strchr(" \t\r\n", *line); line++)
        *number += *line == '\n';
    RITZ_REFUSE_IF(*line == '\0', RITZ_ERR_FORMAT,
                   "no table of a response: it is empty");
    words = count_words(line, &numbers);
    *text = line;
    if (numbers) {
        RITZ_REFUSE_IF(words != BARE, RITZ_ERR_FORMAT,
                       "line %" PRId64 " has %" PRId64
                       " columns that no head names: a head begins with hertz, "
                       "without one there are hertz, real and imaginary part",
                       *number + 1, words);
        return read_head(bare, c);
    }
    *text = cut_line(line);
    ++*number;
    return read_head(line + (*line == '#'), c);
}

static ritz_status parse_table(char *text, ritz_response *out)
{
    int64_t number = 0;
    const int64_t rows = ritz_text_lines(text);
    RITZ_OWN(table_columns) c = {0};
    RITZ_OWN(ritz_response) r = {0};
    RITZ_OWN_ARRAY double *value = NULL;

    RITZ_CHECK(find_columns(&text, &number, &c));
    RITZ_CHECK(make_room(&c, rows, &r));
    RITZ_CHECK_NEW(value, 1 + 2 * c.pairs + c.passed);
    while (text) {
        char *line = text;
        bool any = false;

        text = cut_line(line);
        RITZ_CHECK(
            read_row(line, ++number, 1 + 2 * c.pairs + c.passed, value, &any));
        if (any)
            RITZ_CHECK(add_point(&c, value, number, &r));
    }
    RITZ_REFUSE_IF(r.count < 2, RITZ_ERR_FORMAT,
                   "a response of %" PRId64 " frequencies is none", r.count);
    RITZ_MOVE(*out, r);
    return RITZ_OK;
}

ritz_status ritz_response_read_table(const char *path, ritz_response *out)
{
    RITZ_OWN_ARRAY char *text = NULL;

    RITZ_CHECK(ritz_text_read(path, &text));
    return ritz_context(parse_table(text, out), path);
}

bool ritz_response_table_seems(const char *path)
{
    char head[SEEN] = "";
    FILE *file = fopen(path, "rb");
    size_t size = 0;
    bool read = false;

    if (!file)
        return false;
    size = fread(head, 1, sizeof head, file);
    read = ferror(file) == 0;
    (void)fclose(file);
    return read && memchr(head, '\0', size) == NULL &&
           (unsigned char)head[0] != 0x89; /* the first of HDF5 */
}
