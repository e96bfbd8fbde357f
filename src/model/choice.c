/*
 * The words of a choice, by kind: one table says what each is, and one function
 * for each kind reads and prints it.
 */
#include <ritz/basis.h>

#include "base/text.h"
#include "base/tolerances.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* Copy the first of some words with commas between them; the rest, or NULL. */
static const char *next_word(const char *text, char word[RITZ_SHORT_SIZE])
{
    size_t length = strcspn(text, ",");
    size_t kept = length < RITZ_SHORT_SIZE ? length : RITZ_SHORT_SIZE - 1;

    memcpy(word, text, kept);
    word[kept] = '\0';
    return text[length] ? text + length + 1 : NULL;
}

static ritz_status take_shifts(const char *text, ritz_choice *choice)
{
    char word[RITZ_SHORT_SIZE];
    int64_t count = 0;

    for (const char *at = text; at;) {
        double hertz = 0.0;

        at = next_word(at, word);
        RITZ_REFUSE_IF(
            !ritz_text_real(word, &hertz) || hertz < 0.0, RITZ_ERR_ARGUMENT,
            "expansion point '%s' is not a frequency of 0 Hz or above", word);
        RITZ_REFUSE_IF(count == RITZ_MOST_SHIFTS, RITZ_ERR_ARGUMENT,
                       "there can be %d expansion points, not more",
                       RITZ_MOST_SHIFTS);
        for (int64_t k = 0; k < count; k++)
            RITZ_REFUSE_IF(choice->shift_hz[k] == hertz, RITZ_ERR_ARGUMENT,
                           "expansion point %g Hz is given twice", hertz);
        choice->shift_hz[count++] = hertz;
    }
    choice->num_shifts = count;
    return RITZ_OK;
}

static ritz_status take_band(const char *text, double *band)
{
    char word[2][RITZ_SHORT_SIZE] = {"", ""};
    char cut[RITZ_SHORT_SIZE];
    const char *rest = next_word(text, word[0]);
    double hertz[2] = {0.0, 0.0};

    if (rest)
        rest = next_word(rest, word[1]);
    RITZ_REFUSE_IF(rest || !ritz_text_real(word[0], &hertz[0]) ||
                       !ritz_text_real(word[1], &hertz[1]) ||
                       !(hertz[0] >= 0.0 && hertz[1] > hertz[0]),
                   RITZ_ERR_ARGUMENT,
                   "'%s' is no band: two ascending frequencies, 0 Hz or above",
                   ritz_text_short(text, cut));
    memcpy(band, hertz, sizeof hertz);
    return RITZ_OK;
}

static const char loads[][16] = {"attached", "inputs", "outputs", "dampers"};
static const char inners[][16] = {
    [RITZ_INNER_STIFFNESS] = "stiffness",
    [RITZ_INNER_MASS] = "mass",
};
static const char gramians[][16] = {
    [RITZ_GRAMIAN_INPUTS] = "inputs",
    [RITZ_GRAMIAN_OUTPUTS] = "outputs",
};
static const char operators[][16] = {"state", "inverse"};
static const char engines[][16] = {
    [RITZ_ENGINE_AUTO] = "auto",
    [RITZ_ENGINE_DENSE] = "dense",
    [RITZ_ENGINE_MODAL] = "modal",
    [RITZ_ENGINE_LOW_RANK] = "low-rank",
    [RITZ_ENGINE_PROJECTION] = "projection",
    [RITZ_ENGINE_LANCZOS] = "lanczos",
    [RITZ_ENGINE_ARPACK] = "arpack",
    [RITZ_ENGINE_SLICES] = "slices",
    [RITZ_ENGINE_AMLS] = "amls",
    [RITZ_ENGINE_SLEPC] = "slepc",
};
static const char remainders[][16] = {"dropped", "static"};
static const char sides[][16] = {"two", "one"};
static const char counts[][16] = {"yes", "no"};

#define FIELD(field) offsetof(ritz_choice, field)
#define WORDS(words) words, sizeof(words) / sizeof *(words)

const ritz_choice_word ritz_choice_words[] = {
    {"shift_hz", "F[,F]", "expansion points of Krylov vectors [0]",
     RITZ_USES_SHIFTS, RITZ_CHOICE_SHIFTS, FIELD(shift_hz), NULL, NULL, 0},
    {"loads", "WORD[,WORD]",
     "forces whose responses are vectors: attached, inputs, outputs, dampers",
     RITZ_USES_LOADS, RITZ_CHOICE_SET, FIELD(loads), "load", WORDS(loads)},
    {"inner", "WORD", "inner product of Krylov vectors: stiffness or mass",
     RITZ_USES_INNER, RITZ_CHOICE_ENUM, FIELD(inner), "inner product",
     WORDS(inners)},
    {"interface_modes", "N",
     "replace attached dofs by N characteristic constraint modes",
     RITZ_USES_INTERFACE, RITZ_CHOICE_COUNT, FIELD(interface_modes),
     "interface modes", NULL, 0},
    {"gramian", "WORD", "whose Gramian Lanczos works in: inputs or outputs",
     RITZ_USES_GRAMIAN, RITZ_CHOICE_ENUM, FIELD(gramian), "Gramian",
     WORDS(gramians)},
    {"operator", "WORD", "Lanczos on the matrix of states: state or inverse",
     RITZ_USES_OPERATOR, RITZ_CHOICE_FLAG, FIELD(inverse), "operator",
     WORDS(operators)},
    {"damping", "TEXT", "'modal 0.01', instead of the component's own",
     RITZ_USES_DAMPING, RITZ_CHOICE_DAMPING, FIELD(damping), NULL, NULL, 0},
    {"engine", "WORD",
     "how Gramians are computed: auto, dense, modal, low-rank, "
     "projection; how modes are: auto, lanczos, arpack, slices, amls, slepc",
     RITZ_USES_ENGINE, RITZ_CHOICE_ENUM, FIELD(engine), "engine",
     WORDS(engines)},
    {"among_hz", "F", "modal Gramians: of the modes up to this frequency",
     RITZ_USES_AMONG, RITZ_CHOICE_HERTZ, FIELD(among_hz), NULL, NULL, 0},
    {"band_hz", "F,F", "where the response matters", RITZ_USES_BAND,
     RITZ_CHOICE_BAND, FIELD(band_hz), NULL, NULL, 0},
    {"remainder", "WORD", "what becomes of other states: dropped or static",
     RITZ_USES_REMAINDER, RITZ_CHOICE_FLAG, FIELD(perturb), "remainder",
     WORDS(remainders)},
    {"count", "WORD", "prove by a count that no mode is missing: yes or no",
     RITZ_USES_COUNT, RITZ_CHOICE_FLAG, FIELD(uncounted), "count",
     WORDS(counts)},
    {"accuracy", "X",
     "eigenvalues of modes within this relative error, 1e-8 to 1e-2 "
     "[to rounding; amls 1e-4]",
     RITZ_USES_ACCURACY, RITZ_CHOICE_ACCURACY, FIELD(accuracy), NULL, NULL, 0},
    {"sides", "WORD", "project by one side, which keeps symmetry, or by two",
     RITZ_USES_SIDES, RITZ_CHOICE_FLAG, FIELD(one_sided), "side", WORDS(sides)},
    {0},
};

static ritz_status find_word(const ritz_choice_word *of, const char *text,
                             int64_t *out)
{
    const ritz_names names = {of->what, of->num_values, of->value[0],
                              sizeof *of->value};

    return ritz_words_find(&names, text, out);
}

/* Bits of the words that are listed, the first word 1. */
static ritz_status take_set(const ritz_choice_word *of, const char *text,
                            int *out)
{
    char word[RITZ_SHORT_SIZE];
    int64_t at = 0;
    int sum = 0;

    for (const char *rest = text; rest;) {
        rest = next_word(rest, word);
        RITZ_CHECK(find_word(of, word, &at));
        sum |= 1 << at;
    }
    *out = sum;
    return RITZ_OK;
}

/* Index of a word, as an enumeration of int or as a flag. */
static ritz_status take_word(const ritz_choice_word *of, const char *text,
                             void *field)
{
    int64_t at = 0;

    RITZ_CHECK(find_word(of, text, &at));
    if (of->kind == RITZ_CHOICE_FLAG)
        *(bool *)field = at == 1;
    else
        *(int *)field = (int)at;
    return RITZ_OK;
}

static ritz_status take_value(const ritz_choice_word *word, const char *text,
                              ritz_choice *choice)
{
    void *field = (char *)choice + word->offset;
    char cut[RITZ_SHORT_SIZE];
    int64_t count = 0;
    double hertz = 0.0;
    double accuracy = 0.0;

    switch (word->kind) {
    case RITZ_CHOICE_SHIFTS:
        return take_shifts(text, choice);
    case RITZ_CHOICE_SET:
        return take_set(word, text, field);
    case RITZ_CHOICE_ENUM:
    case RITZ_CHOICE_FLAG:
        return take_word(word, text, field);
    case RITZ_CHOICE_COUNT:
        RITZ_REFUSE_IF(!ritz_text_whole(text, &count) || count < 1,
                       RITZ_ERR_ARGUMENT, "'%s' is no number of %s, 1 or more",
                       ritz_text_short(text, cut), word->what);
        *(int64_t *)field = count;
        return RITZ_OK;
    case RITZ_CHOICE_HERTZ:
        RITZ_REFUSE_IF(!ritz_text_real(text, &hertz) || !(hertz > 0.0),
                       RITZ_ERR_ARGUMENT, "'%s' is no frequency above 0 Hz",
                       ritz_text_short(text, cut));
        *(double *)field = hertz;
        return RITZ_OK;
    case RITZ_CHOICE_ACCURACY:
        RITZ_REFUSE_IF(!ritz_text_real(text, &accuracy) ||
                           !(accuracy >= RITZ_ACCURACY_LEAST &&
                             accuracy <= RITZ_ACCURACY_MOST),
                       RITZ_ERR_ARGUMENT,
                       "'%s' is no accuracy of modes from 1e-8 to 1e-2",
                       ritz_text_short(text, cut));
        *(double *)field = accuracy;
        return RITZ_OK;
    case RITZ_CHOICE_BAND:
        return take_band(text, field);
    case RITZ_CHOICE_DAMPING:
        return ritz_damping_parse(text, field);
    }
    return RITZ_OK;
}

ritz_status ritz_choice_take(const ritz_choice_word *word, const char *text,
                             ritz_choice *choice)
{
    RITZ_CHECK(take_value(word, text, choice));
    choice->given |= word->uses;
    return RITZ_OK;
}

/* Append "key value" to what stands in out, with '-' for '_' in the key. */
static void append_word(int64_t size, char *out, const char *key,
                        const char *value)
{
    const size_t room = (size_t)size;
    size_t used = strlen(out);
    size_t from = used + (used > 0); /* beyond the end if the text is full */

    snprintf(out + used, room - used, "%s%s %s", used > 0 ? " " : "", key,
             value);
    for (size_t k = from; k < room && out[k] && out[k] != ' '; k++)
        if (out[k] == '_')
            out[k] = '-';
}

static void print_reals(int64_t count, const double *x, size_t size, char *out)
{
    size_t used = 0;

    for (int64_t k = 0; k < count && used < size; k++)
        used += (size_t)snprintf(out + used, size - used, "%s%.17g",
                                 k > 0 ? "," : "", x[k]);
}

/* Every load that is in the set; the index that an enumeration or flag is. */
static void print_names(const ritz_choice_word *word, const void *field,
                        int64_t size, char *out)
{
    int value = word->kind == RITZ_CHOICE_FLAG ? (int)*(const bool *)field
                                               : *(const int *)field;
    bool set = word->kind == RITZ_CHOICE_SET;

    for (int k = 0; k < word->num_values; k++)
        if (set ? value >> k & 1 : value == k)
            append_word(size, out, set ? word->what : word->key,
                        word->value[k]);
}

static void print_value(const ritz_choice_word *word, const ritz_choice *choice,
                        int64_t size, char *out)
{
    const void *field = (const char *)choice + word->offset;
    char text[RITZ_MOST_SHIFTS * 32] = "";

    switch (word->kind) {
    case RITZ_CHOICE_SHIFTS:
        print_reals(choice->num_shifts, field, sizeof text, text);
        break;
    case RITZ_CHOICE_COUNT:
        snprintf(text, sizeof text, "%" PRId64, *(const int64_t *)field);
        break;
    case RITZ_CHOICE_HERTZ:
    case RITZ_CHOICE_ACCURACY:
        print_reals(1, field, sizeof text, text);
        break;
    case RITZ_CHOICE_BAND:
        print_reals(2, field, sizeof text, text);
        break;
    default:
        print_names(word, field, size, out);
        return;
    }
    append_word(size, out, word->key, text);
}

/* Shifts and loads may also be set without their word; damping comes last. */
void ritz_choice_print(const ritz_choice *choice, int64_t size, char *out)
{
    char damping[RITZ_DAMPING_SIZE];

    for (const ritz_choice_word *word = ritz_choice_words; word->key; word++) {
        bool given = choice->given & word->uses;

        if (word->kind == RITZ_CHOICE_SHIFTS)
            given = choice->num_shifts > 0;
        if (word->kind == RITZ_CHOICE_SET)
            given = true;
        if (given && word->kind != RITZ_CHOICE_DAMPING)
            print_value(word, choice, size, out);
    }
    if (choice->given & RITZ_USES_DAMPING) {
        size_t used = strlen(out);

        ritz_damping_print(&choice->damping, damping);
        snprintf(out + used, (size_t)size - used, "%s%s", used > 0 ? " " : "",
                 damping);
    }
}
