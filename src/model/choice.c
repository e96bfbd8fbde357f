/* The words of a choice: each one's text is parsed here and nowhere else. */
#include <ritz/choice.h>

#include "model/names.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* The next of some words with commas between them; NULL past the last. */
static const char *next_word(const char *text, char word[RITZ_SHORT_SIZE])
{
    size_t length = strcspn(text, ",");
    size_t kept = length < RITZ_SHORT_SIZE ? length : RITZ_SHORT_SIZE - 1;

    memcpy(word, text, kept);
    word[kept] = '\0';
    return text[length] ? text + length + 1 : NULL;
}

/* Which of some words a text is. */
static ritz_status take_word(const char *what, const char *text, int64_t count,
                             const char (*words)[16], int64_t *out)
{
    const ritz_names names = {what, count, words[0], sizeof *words};

    return ritz_words_find(&names, text, out);
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

static const char loads[][16] = {"attached", "inputs", "outputs", "dampers"};

static ritz_status take_loads(const char *text, ritz_choice *choice)
{
    char word[RITZ_SHORT_SIZE];
    int64_t at = 0;
    int sum = 0;

    for (const char *rest = text; rest;) {
        rest = next_word(rest, word);
        RITZ_CHECK(
            take_word("load", word, sizeof loads / sizeof *loads, loads, &at));
        sum |= 1 << at;
    }
    choice->loads = sum;
    return RITZ_OK;
}

static const char inners[][16] = {
    [RITZ_INNER_STIFFNESS] = "stiffness",
    [RITZ_INNER_MASS] = "mass",
};

static ritz_status take_inner(const char *text, ritz_choice *choice)
{
    int64_t at = choice->inner;
    ritz_status status = take_word("inner product", text, 2, inners, &at);

    choice->inner = (ritz_inner)at;
    return status;
}

static ritz_status take_interface_modes(const char *text, ritz_choice *choice)
{
    char cut[RITZ_SHORT_SIZE];
    int64_t count = 0;

    RITZ_REFUSE_IF(!ritz_text_whole(text, &count) || count < 1,
                   RITZ_ERR_ARGUMENT,
                   "'%s' is no number of interface modes, 1 or more",
                   ritz_text_short(text, cut));
    choice->interface_modes = count;
    return RITZ_OK;
}

static const char gramians[][16] = {
    [RITZ_GRAMIAN_INPUTS] = "inputs",
    [RITZ_GRAMIAN_OUTPUTS] = "outputs",
};

static ritz_status take_gramian(const char *text, ritz_choice *choice)
{
    int64_t at = choice->gramian;
    ritz_status status = take_word("Gramian", text, 2, gramians, &at);

    choice->gramian = (ritz_gramian)at;
    return status;
}

static const char operators[][16] = {"state", "inverse"};

static ritz_status take_operator(const char *text, ritz_choice *choice)
{
    int64_t at = choice->inverse;
    ritz_status status = take_word("operator", text, 2, operators, &at);

    choice->inverse = at == 1;
    return status;
}

static ritz_status take_damping(const char *text, ritz_choice *choice)
{
    return ritz_damping_parse(text, &choice->damping);
}

static const char engines[][16] = {
    [RITZ_ENGINE_AUTO] = "auto",
    [RITZ_ENGINE_DENSE] = "dense",
    [RITZ_ENGINE_MODAL] = "modal",
    [RITZ_ENGINE_LOW_RANK] = "low-rank",
};

static ritz_status take_engine(const char *text, ritz_choice *choice)
{
    int64_t at = choice->engine;
    ritz_status status = take_word(
        "engine", text, sizeof engines / sizeof *engines, engines, &at);

    choice->engine = (ritz_engine)at;
    return status;
}

static ritz_status take_among(const char *text, ritz_choice *choice)
{
    char cut[RITZ_SHORT_SIZE];
    double hertz = 0.0;

    RITZ_REFUSE_IF(!ritz_text_real(text, &hertz) || !(hertz > 0.0),
                   RITZ_ERR_ARGUMENT, "'%s' is no frequency above 0 Hz",
                   ritz_text_short(text, cut));
    choice->among_hz = hertz;
    return RITZ_OK;
}

static ritz_status take_band(const char *text, ritz_choice *choice)
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
    choice->band_hz[0] = hertz[0];
    choice->band_hz[1] = hertz[1];
    return RITZ_OK;
}

static const char remainders[][16] = {"dropped", "static"};

static ritz_status take_remainder(const char *text, ritz_choice *choice)
{
    int64_t at = choice->perturb;
    ritz_status status = take_word("remainder", text, 2, remainders, &at);

    choice->perturb = at == 1;
    return status;
}

static const char sides[][16] = {"one", "two"};

static ritz_status take_sides(const char *text, ritz_choice *choice)
{
    int64_t at = !choice->one_sided;
    ritz_status status = take_word("side", text, 2, sides, &at);

    choice->one_sided = at == 0;
    return status;
}

const ritz_choice_word ritz_choice_words[] = {
    {"shift_hz", "F[,F]", "expansion points of Krylov vectors [0]",
     RITZ_USES_SHIFTS, take_shifts},
    {"loads", "WORD[,WORD]",
     "forces that vectors answer: attached, inputs, outputs, dampers",
     RITZ_USES_LOADS, take_loads},
    {"inner", "WORD", "inner product of Krylov vectors: stiffness or mass",
     RITZ_USES_INNER, take_inner},
    {"interface_modes", "N",
     "replace attached dofs by N characteristic constraint modes",
     RITZ_USES_INTERFACE, take_interface_modes},
    {"gramian", "WORD", "whose Gramian Lanczos works in: inputs or outputs",
     RITZ_USES_GRAMIAN, take_gramian},
    {"operator", "WORD", "Lanczos on the matrix of states: state or inverse",
     RITZ_USES_OPERATOR, take_operator},
    {"damping", "TEXT", "'modal 0.01', instead of the component's own",
     RITZ_USES_DAMPING, take_damping},
    {"engine", "WORD", "how Gramians are found: auto, dense, modal, low-rank",
     RITZ_USES_ENGINE, take_engine},
    {"among_hz", "F", "modal Gramians: of the modes up to this frequency",
     RITZ_USES_AMONG, take_among},
    {"band_hz", "F,F", "where the response matters", RITZ_USES_BAND, take_band},
    {"remainder", "WORD", "what becomes of other states: dropped or static",
     RITZ_USES_REMAINDER, take_remainder},
    {"sides", "WORD", "project by one side, which keeps symmetry, or by two",
     RITZ_USES_SIDES, take_sides},
    {0},
};

ritz_status ritz_choice_take(const ritz_choice_word *word, const char *text,
                             ritz_choice *choice)
{
    RITZ_CHECK(word->take(text, choice));
    choice->given |= word->uses;
    return RITZ_OK;
}

/* Append to what stands in out. */
static void append(int64_t size, char *out, const char *text)
{
    size_t used = strlen(out);

    snprintf(out + used, (size_t)size - used, "%s%s", used > 0 ? " " : "",
             text);
}

/* The same of a key and its word. */
static void append_word(int64_t size, char *out, const char *key,
                        const char *word)
{
    append(size, out, key);
    append(size, out, word);
}

void ritz_choice_print(const ritz_choice *choice, int64_t size, char *out)
{
    char text[2 * RITZ_NAME_SIZE] = "";

    for (int64_t k = 0; k < choice->num_shifts; k++) {
        snprintf(text, sizeof text, k == 0 ? "shift-hz %.17g" : ",%.17g",
                 choice->shift_hz[k]);
        if (k == 0)
            append(size, out, text);
        else
            snprintf(out + strlen(out), (size_t)size - strlen(out), "%s", text);
    }
    for (size_t k = 0; k < sizeof loads / sizeof *loads; k++)
        if (choice->loads & (1 << k))
            append_word(size, out, "load", loads[k]);
    if (choice->given & RITZ_USES_INNER)
        append_word(size, out, "inner", inners[choice->inner]);
    if (choice->given & RITZ_USES_INTERFACE) {
        snprintf(text, sizeof text, "interface-modes %" PRId64,
                 choice->interface_modes);
        append(size, out, text);
    }
    if (choice->given & RITZ_USES_GRAMIAN)
        append_word(size, out, "gramian", gramians[choice->gramian]);
    if (choice->given & RITZ_USES_OPERATOR)
        append_word(size, out, "operator", operators[choice->inverse]);
    if (choice->given & RITZ_USES_ENGINE)
        append_word(size, out, "engine", engines[choice->engine]);
    if (choice->given & RITZ_USES_AMONG) {
        snprintf(text, sizeof text, "among-hz %.17g", choice->among_hz);
        append(size, out, text);
    }
    if (choice->given & RITZ_USES_BAND) {
        snprintf(text, sizeof text, "band-hz %.17g,%.17g", choice->band_hz[0],
                 choice->band_hz[1]);
        append(size, out, text);
    }
    if (choice->given & RITZ_USES_REMAINDER)
        append_word(size, out, "remainder", remainders[choice->perturb]);
    if (choice->given & RITZ_USES_SIDES)
        append_word(size, out, "sides", sides[!choice->one_sided]);
    if (choice->given & RITZ_USES_DAMPING) {
        char damping[RITZ_DAMPING_SIZE];

        ritz_damping_print(&choice->damping, damping);
        append(size, out, damping);
    }
}
