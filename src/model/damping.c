/* Damping as stated: its text form, ratios of modes, and a fit of a M + b K. */
#include "base/tolerances.h"

#include <ritz/model.h>

#include <assert.h>
#include <inttypes.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/*
 * Ratios of modes; and a fit of a M + b K to ratios zeta_k at w_k: linear least
 * squares of
 *
 *     [1 / (2 w_k), w_k / 2] [a; b] = zeta_k
 *
 * As both columns and all zeta_k are positive, where one of a and b comes out
 * negative it is held to 0 and the other, fitted alone, is positive: the least
 * squares of a, b >= 0.
 */

/* Columns 1 / (2 w) and w / 2 of a point, and its ratio. */
static void fit_equation(const double point[2], double row[3])
{
    double w = 2.0 * RITZ_PI * point[0];

    row[0] = 0.5 / w;
    row[1] = 0.5 * w;
    row[2] = point[1];
}

/* The column alone: its factor, and the sum of squares that it leaves. */
static double fit_alone(const ritz_damping *damping, int column, double *left)
{
    double cc = 0.0, cz = 0.0;
    double row[3];

    for (int64_t k = 0; k < damping->count; k++) {
        fit_equation(damping->point[k], row);
        cc += row[column] * row[column];
        cz += row[column] * row[2];
    }
    *left = 0.0;
    for (int64_t k = 0; k < damping->count; k++) {
        double r = 0.0;

        fit_equation(damping->point[k], row);
        r = row[2] - cz / cc * row[column];
        *left += r * r;
    }
    return cz / cc;
}

/* Both columns: the second made orthogonal to the first. */
static void fit_both(const ritz_damping *damping, double *a, double *b)
{
    double cc = 0.0, cd = 0.0, ee = 0.0, ez = 0.0, cz = 0.0;
    double row[3];

    for (int64_t k = 0; k < damping->count; k++) {
        fit_equation(damping->point[k], row);
        cc += row[0] * row[0];
        cd += row[0] * row[1];
        cz += row[0] * row[2];
    }
    for (int64_t k = 0; k < damping->count; k++) {
        double e = 0.0;

        fit_equation(damping->point[k], row);
        e = row[1] - cd / cc * row[0];
        ee += e * e;
        ez += e * row[2];
    }
    *b = ez / ee;
    *a = (cz - cd * *b) / cc;
}

void ritz_damping_fit(ritz_damping *damping)
{
    double left[2];
    double only_a = fit_alone(damping, 0, &left[0]);
    double only_b = fit_alone(damping, 1, &left[1]);

    fit_both(damping, &damping->a, &damping->b);
    if (damping->a >= 0.0 && damping->b >= 0.0)
        return;
    damping->a = left[0] <= left[1] ? only_a : 0.0;
    damping->b = left[0] <= left[1] ? 0.0 : only_b;
}

double ritz_damping_misfit(const ritz_damping *damping, int64_t *at)
{
    double worst = 0.0;

    *at = 0;
    for (int64_t k = 0; damping->kind == RITZ_DAMPING_FIT && k < damping->count;
         k++) {
        double w = 2.0 * RITZ_PI * damping->point[k][0];
        double off =
            fabs(ritz_damping_of_mode(damping, -1, w) - damping->point[k][1]);

        if (off > worst) {
            worst = off;
            *at = k;
        }
    }
    return worst;
}

double ritz_damping_of_mode(const ritz_damping *damping, int64_t mode,
                            double omega)
{
    double hertz = omega / (2.0 * RITZ_PI);

    switch (damping->kind) {
    case RITZ_DAMPING_NONE:
        break;
    case RITZ_DAMPING_MODAL:
        return damping->zeta;
    case RITZ_DAMPING_BANDS:
        for (int64_t k = damping->count - 1; k >= 0; k--)
            if (hertz >= damping->band[k][0] && hertz <= damping->band[k][1])
                return damping->band[k][2];
        break;
    case RITZ_DAMPING_RAYLEIGH:
    case RITZ_DAMPING_FIT:
        /* phi'(a M + b K)phi = a + b omega^2 = 2 zeta omega */
        if (omega > 0.0)
            return 0.5 * (damping->a / omega + damping->b * omega);
        break;
    case RITZ_DAMPING_MODES:
        return damping
            ->ratio[mode >= 0 && mode < damping->count ? mode
                                                       : damping->count - 1];
    }
    return 0.0;
}

/* Damping in words. */

/* RITZ_DAMPING_SIZE has room for a word and as many numbers of 24 letters. */
enum { MOST_NUMBERS = RITZ_MOST_RATIOS, NUMBER_SIZE = 32 };
static_assert(3 * RITZ_MAX_BANDS <= MOST_NUMBERS, "bands are fewer numbers");
static_assert(2 * RITZ_MOST_POINTS <= MOST_NUMBERS, "points are fewer numbers");
static_assert(offsetof(ritz_damping, b) ==
                  offsetof(ritz_damping, a) + sizeof(double),
              "a and b are numbers one behind the other");
static_assert(16 + 25 * MOST_NUMBERS <= RITZ_DAMPING_SIZE, "the text fits");

static ritz_status check_ratio(double zeta)
{
    RITZ_REFUSE_IF(!(zeta > 0.0), RITZ_ERR_ARGUMENT,
                   "damping ratio %g is not above 0", zeta);
    RITZ_REFUSE_IF(!(zeta < 1.0), RITZ_ERR_ARGUMENT,
                   "damping ratio %g is overdamped, it must stay below 1",
                   zeta);
    return RITZ_OK;
}

static ritz_status check_modal(const ritz_damping *damping)
{
    return check_ratio(damping->zeta);
}

static ritz_status check_bands(const ritz_damping *damping)
{
    RITZ_REFUSE_IF(damping->count < 1 || damping->count > RITZ_MAX_BANDS,
                   RITZ_ERR_ARGUMENT,
                   "%" PRId64 " damping bands are given, 1 to %d can be",
                   damping->count, RITZ_MAX_BANDS);
    for (int64_t k = 0; k < damping->count; k++) {
        const double *band = damping->band[k];
        double below = k > 0 ? damping->band[k - 1][1] : 0.0;

        RITZ_REFUSE_IF(
            !(band[0] >= 0.0 && band[1] > band[0] && isfinite(band[1])),
            RITZ_ERR_ARGUMENT,
            "damping band %g to %g Hz does not ascend from 0 or above", band[0],
            band[1]);
        RITZ_REFUSE_IF(
            band[0] < below, RITZ_ERR_ARGUMENT,
            "damping band %g to %g Hz begins before %g Hz, where the "
            "one before it ends",
            band[0], band[1], below);
        RITZ_CHECK(check_ratio(band[2]));
    }
    return RITZ_OK;
}

static ritz_status check_rayleigh(const ritz_damping *damping)
{
    RITZ_REFUSE_IF(!(damping->a >= 0.0 && damping->b >= 0.0 &&
                     isfinite(damping->a) && isfinite(damping->b)),
                   RITZ_ERR_ARGUMENT,
                   "rayleigh damping %g %g is negative or not finite",
                   damping->a, damping->b);
    RITZ_REFUSE_IF(damping->a == 0.0 && damping->b == 0.0, RITZ_ERR_ARGUMENT,
                   "rayleigh damping 0 0 is none");
    return RITZ_OK;
}

static ritz_status check_modes(const ritz_damping *damping)
{
    RITZ_REFUSE_IF(damping->count < 1 || damping->count > RITZ_MOST_RATIOS,
                   RITZ_ERR_ARGUMENT,
                   "%" PRId64 " ratios of modes are given, 1 to %d can be",
                   damping->count, RITZ_MOST_RATIOS);
    for (int64_t k = 0; k < damping->count; k++)
        RITZ_CHECK(check_ratio(damping->ratio[k]));
    return RITZ_OK;
}

static ritz_status check_fit(const ritz_damping *damping)
{
    bool differ = false;

    RITZ_REFUSE_IF(damping->count < 2 || damping->count > RITZ_MOST_POINTS,
                   RITZ_ERR_ARGUMENT,
                   "%" PRId64 " points of a fit are given, 2 to %d can be",
                   damping->count, RITZ_MOST_POINTS);
    for (int64_t k = 0; k < damping->count; k++) {
        const double *point = damping->point[k];

        RITZ_REFUSE_IF(
            !(point[0] > 0.0) || !isfinite(point[0]), RITZ_ERR_ARGUMENT,
            "a damping fit at %g Hz: its frequencies are above 0", point[0]);
        RITZ_CHECK(check_ratio(point[1]));
        differ = differ || point[0] != damping->point[0][0];
    }
    RITZ_REFUSE_IF(
        !differ, RITZ_ERR_ARGUMENT,
        "a damping fit needs two different frequencies, all are %g Hz",
        damping->point[0][0]);
    return RITZ_OK;
}

/* A word and the numbers behind it, which are the fields from an offset on. */
static const struct form {
    char name[16];
    int64_t least, most; /* numbers behind the word */
    int64_t group;       /* numbers that `count` counts as one; 0: no count */
    size_t offset;
    ritz_status (*check)(const ritz_damping *damping); /* NULL: nothing */
    const char *example;
} forms[] = {
    [RITZ_DAMPING_NONE] = {"", 0, 0, 0, 0, NULL, ""},
    [RITZ_DAMPING_MODAL] = {"modal", 1, 1, 0, offsetof(ritz_damping, zeta),
                            check_modal, "modal 0.002"},
    [RITZ_DAMPING_BANDS] = {"bands", 3, 3 * (int64_t)RITZ_MAX_BANDS, 3,
                            offsetof(ritz_damping, band), check_bands,
                            "bands 0 5 0.002 5 20 0.005"},
    [RITZ_DAMPING_RAYLEIGH] = {"rayleigh", 2, 2, 0, offsetof(ritz_damping, a),
                               check_rayleigh, "rayleigh 0.1 2e-5"},
    [RITZ_DAMPING_MODES] = {"modes", 1, RITZ_MOST_RATIOS, 1,
                            offsetof(ritz_damping, ratio), check_modes,
                            "modes 0.01 0.02 0.015"},
    [RITZ_DAMPING_FIT] = {"fit", 4, 2 * (int64_t)RITZ_MOST_POINTS, 2,
                          offsetof(ritz_damping, point), check_fit,
                          "fit 1 0.01 10 0.02"},
};

enum { NUM_FORMS = sizeof forms / sizeof *forms };

/* Shortest of %.1g, %.2g, ... that reads back as the same number: 20, 2e-05. */
static size_t print_number(double value, char out[NUMBER_SIZE])
{
    size_t shortest = NUMBER_SIZE;

    for (int digits = 1; digits <= 17; digits++) {
        char text[NUMBER_SIZE];
        size_t length =
            (size_t)snprintf(text, sizeof text, "%.*g", digits, value);

        if (length < shortest && strtod(text, NULL) == value) {
            memcpy(out, text, length + 1);
            shortest = length;
        }
    }
    return shortest;
}

void ritz_damping_print(const ritz_damping *damping,
                        char text[RITZ_DAMPING_SIZE])
{
    const struct form *form = &forms[damping->kind];
    int64_t count = form->group > 0 ? form->group * damping->count : form->most;
    double number[MOST_NUMBERS];
    size_t used = strlen(form->name);

    memcpy(text, form->name, used + 1);
    memcpy(number, (const char *)damping + form->offset,
           (size_t)count * sizeof *number);
    for (int64_t k = 0; k < count; k++) {
        text[used++] = ' ';
        used += print_number(number[k], text + used);
    }
}

ritz_status ritz_damping_check(const ritz_damping *damping)
{
    const struct form *form = &forms[damping->kind];

    return form->check ? form->check(damping) : RITZ_OK;
}

bool ritz_damping_is_rayleigh(const ritz_damping *damping)
{
    return damping->kind == RITZ_DAMPING_RAYLEIGH ||
           damping->kind == RITZ_DAMPING_FIT;
}

bool ritz_damping_has_ratios(const ritz_damping *damping)
{
    return damping && damping->kind != RITZ_DAMPING_NONE &&
           !ritz_damping_is_rayleigh(damping);
}

/* Cut a text at its spaces; how many words there are, at most `most`. */
static int64_t split_words(char *text, int64_t most, char *word[])
{
    int64_t count = 0;
    char *rest = NULL;

    for (char *at = strtok_r(text, " ", &rest); at && count < most;
         at = strtok_r(NULL, " ", &rest))
        word[count++] = at;
    return count;
}

static ritz_status read_numbers(const struct form *form, int64_t count,
                                char *word[], double number[MOST_NUMBERS])
{
    RITZ_REFUSE_IF(count < form->least || count > form->most ||
                       (form->group > 0 && count % form->group != 0),
                   RITZ_ERR_ARGUMENT,
                   "damping '%s' with %" PRId64 " numbers is not such as '%s'",
                   form->name, count, form->example);
    for (int64_t k = 0; k < count; k++)
        RITZ_REFUSE_IF(!ritz_text_real(word[k], &number[k]), RITZ_ERR_ARGUMENT,
                       "'%.40s' in a damping is not a finite number", word[k]);
    return RITZ_OK;
}

ritz_status ritz_damping_parse(const char *text, ritz_damping *out)
{
    ritz_damping damping = {0};
    char copy[RITZ_DAMPING_SIZE];
    char *word[MOST_NUMBERS + 2] = {0};
    double number[MOST_NUMBERS] = {0};
    int64_t count = 0;
    int kind = 0;

    RITZ_REFUSE_IF(strlen(text) >= sizeof copy, RITZ_ERR_ARGUMENT,
                   "the damping '%.40s...' is too long", text);
    memcpy(copy, text, strlen(text) + 1);
    count = split_words(copy, MOST_NUMBERS + 2, word);
    while (count > 0 && kind < NUM_FORMS &&
           strcmp(word[0], forms[kind].name) != 0)
        kind++;
    RITZ_REFUSE_IF(kind == NUM_FORMS, RITZ_ERR_ARGUMENT,
                   "unknown damping '%.40s', there is modal, modes, bands, "
                   "rayleigh, fit",
                   word[0]);
    if (count > 0) {
        damping.kind = (ritz_damping_kind)kind;
        RITZ_CHECK(read_numbers(&forms[kind], --count, word + 1, number));
        memcpy((char *)&damping + forms[kind].offset, number,
               (size_t)count * sizeof *number);
        if (forms[kind].group > 0)
            damping.count = count / forms[kind].group;
    }
    RITZ_CHECK(ritz_damping_check(&damping));
    if (damping.kind == RITZ_DAMPING_FIT)
        ritz_damping_fit(&damping);
    *out = damping;
    return RITZ_OK;
}
