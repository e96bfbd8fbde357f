/*
 * The setting of a joint over time. With s = t / seconds in [0, 1]
 *
 *     linear   a = from + (to - from) s
 *     smooth   a = from + (to - from) (10 s^3 - 15 s^4 + 6 s^5)
 *
 * A table is interpolated by the cubic spline whose rate is 0 at both ends.
 */
#include "base/alloc.h"
#include "base/text.h"

#include <ritz/swept.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A number of FROM:TO:TIME. */
static ritz_status read_number(const char *text, const char *word, double *out)
{
    RITZ_REFUSE_IF(!ritz_text_real(word, out), RITZ_ERR_ARGUMENT,
                   "'%s' in '%s' is not a finite number", word, text);
    return RITZ_OK;
}

/* Read FROM:TO:TIME, where TIME may end in "s", and ":smooth" may follow. */
static ritz_status read_words(const char *text, ritz_path *out)
{
    char copy[RITZ_NAME_SIZE] = "";
    char *place = copy, *word[5] = {0}, *end = NULL;
    int count = 0;

    RITZ_REFUSE_IF(strlen(text) >= sizeof copy, RITZ_ERR_ARGUMENT,
                   "'%s' is too long", text);
    memcpy(copy, text, strlen(text) + 1);
    while (place && count < 5) {
        word[count++] = place;
        place = strchr(place, ':');
        if (place)
            *place++ = '\0';
    }
    RITZ_REFUSE_IF(count < 3 || count > 4, RITZ_ERR_ARGUMENT,
                   "'%s' is not FROM:TO:TIME, as 0:60:30s or 0:60:30s:smooth",
                   text);
    RITZ_REFUSE_IF(word[3] && strcmp(word[3], "smooth") != 0, RITZ_ERR_ARGUMENT,
                   "'%s' in '%s' is not 'smooth'", word[3], text);
    out->kind = word[3] ? RITZ_PATH_SMOOTH : RITZ_PATH_LINEAR;
    end = word[2] + strlen(word[2]);
    if (end - word[2] > 1 && end[-1] == 's')
        end[-1] = '\0';
    RITZ_CHECK(read_number(text, word[0], &out->from));
    RITZ_CHECK(read_number(text, word[1], &out->to));
    RITZ_CHECK(read_number(text, word[2], &out->seconds));
    RITZ_REFUSE_IF(!(out->seconds > 0.0), RITZ_ERR_ARGUMENT,
                   "the time of '%s' is %g s, and must be above 0", text,
                   out->seconds);
    return RITZ_OK;
}

/*
 * Second derivatives m of the spline: with h_k = t_k+1 - t_k and d_k = (a_k+1 -
 * a_k) / h_k,
 *
 *     h_k-1 m_k-1 + 2 (h_k-1 + h_k) m_k + h_k m_k+1 = 6 (d_k - d_k-1)
 *
 * and at the ends, where the rate is 0, 2 h_0 m_0 + h_0 m_1 = 6 d_0 and h m_n-1
 * + 2 h m_n = -6 d. The matrix is diagonally dominant and needs no pivots.
 */
static ritz_status bend_table(ritz_path *path)
{
    const int64_t n = path->count;
    const double *t = path->time, *a = path->value;
    RITZ_OWN_ARRAY double *upper = NULL;

    RITZ_CHECK_NEW(upper, n);
    RITZ_CHECK_NEW(path->bend, n);
    for (int64_t k = 0; k < n; k++) {
        double left = k > 0 ? t[k] - t[k - 1] : 0.0;
        double right = k + 1 < n ? t[k + 1] - t[k] : 0.0;
        double own = 2.0 * (left + right);
        double load = 0.0;

        if (right > 0.0)
            load += 6.0 * (a[k + 1] - a[k]) / right;
        if (left > 0.0) {
            load -= 6.0 * (a[k] - a[k - 1]) / left;
            own -= left * upper[k - 1];
            load -= left * path->bend[k - 1];
        }
        upper[k] = right / own;
        path->bend[k] = load / own;
    }
    for (int64_t k = n - 2; k >= 0; k--)
        path->bend[k] -= upper[k] * path->bend[k + 1];
    return RITZ_OK;
}

static ritz_status read_table(const char *file, ritz_path *out)
{
    ritz_signal table = {0};

    RITZ_CHECK_IN(file, ritz_signal_read(file, &table));
    out->kind = RITZ_PATH_TABLE;
    out->count = table.count;
    out->time = table.time;
    out->value = table.value;
    RITZ_REFUSE_IF(out->count < 2, RITZ_ERR_ARGUMENT,
                   "'%s' has fewer than two times", file);
    for (int64_t k = 1; k < out->count; k++)
        RITZ_REFUSE_IF(!(out->time[k] > out->time[k - 1]), RITZ_ERR_ARGUMENT,
                       "'%s' has %g s twice: a joint does not jump", file,
                       out->time[k]);
    RITZ_REFUSE_IF(out->time[0] != 0.0, RITZ_ERR_ARGUMENT,
                   "'%s' begins at %g s, and the run at 0", file, out->time[0]);
    out->from = out->value[0];
    out->to = out->value[out->count - 1];
    out->seconds = out->time[out->count - 1];
    return bend_table(out);
}

ritz_status ritz_path_parse(const char *text, ritz_path *out)
{
    RITZ_OWN(ritz_path) path = {0};
    ritz_status status =
        strchr(text, ':') ? read_words(text, &path) : read_table(text, &path);
    double range[2];

    if (status == RITZ_ERR_FILE)
        return ritz_fail(RITZ_ERR_FILE,
                         "'%s' is neither FROM:TO:TIME, as 0:60:30s, nor a "
                         "file of times and settings that can be read",
                         text);
    RITZ_CHECK(status);
    ritz_path_range(&path, range);
    RITZ_REFUSE_IF(!(range[1] > range[0]), RITZ_ERR_ARGUMENT,
                   "'%s' does not move: it is at %g all the time", text,
                   range[0]);
    RITZ_MOVE(*out, path);
    return RITZ_OK;
}

/* The spline between times k and k + 1. */
static void table_at(const ritz_path *path, int64_t k, double t, double *out)
{
    double h = path->time[k + 1] - path->time[k];
    double s = t - path->time[k];
    double m = path->bend[k], jerk = (path->bend[k + 1] - m) / h;
    double rate = (path->value[k + 1] - path->value[k]) / h -
                  h * (2.0 * m + path->bend[k + 1]) / 6.0;

    out[0] = path->value[k] + s * (rate + s * (0.5 * m + s * jerk / 6.0));
    out[1] = rate + s * (m + 0.5 * s * jerk);
    out[2] = m + s * jerk;
}

void ritz_path_at(const ritz_path *path, double t, double out[static 3])
{
    const double range = path->to - path->from, T = path->seconds;
    const double s = t / T;
    int64_t k = 0;

    out[1] = out[2] = 0.0;
    if (path->kind == RITZ_PATH_LINEAR) {
        out[0] = path->from + range * s;
        out[1] = range / T;
    } else if (s >= 1.0) {
        out[0] = path->to;
    } else if (path->kind == RITZ_PATH_SMOOTH) {
        out[0] = path->from + range * s * s * s * (10.0 + s * (6.0 * s - 15.0));
        out[1] = range * 30.0 * s * s * (1.0 - s) * (1.0 - s) / T;
        out[2] = range * 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) / (T * T);
    } else {
        while (k + 2 < path->count && t >= path->time[k + 1])
            k++;
        table_at(path, k, t, out);
    }
}

/* Extremes of the spline: values at its times, and where its rate is 0. */
static void range_table(const ritz_path *path, double *range)
{
    for (int64_t k = 0; k + 1 < path->count; k++) {
        double h = path->time[k + 1] - path->time[k], at[3];
        double jerk = (path->bend[k + 1] - path->bend[k]) / h;
        double roots[2] = {0.0, 0.0};
        double root = 0.0;

        table_at(path, k, path->time[k], at);
        root = sqrt(fmax(at[2] * at[2] - 2.0 * jerk * at[1], 0.0));
        /* roots of rate + m s + jerk s^2 / 2, in the form without
           cancellation */
        root = -(at[2] + copysign(root, at[2]));
        roots[0] = root != 0.0 ? 2.0 * at[1] / root : 0.0;
        roots[1] = jerk != 0.0 ? root / jerk : 0.0;
        for (int j = 0; j < 2; j++) {
            double s = fmin(fmax(roots[j], 0.0), h);

            table_at(path, k, path->time[k] + s, at);
            range[0] = fmin(range[0], at[0]);
            range[1] = fmax(range[1], at[0]);
        }
    }
}

void ritz_path_range(const ritz_path *path, double out[static 2])
{
    out[0] = fmin(path->from, path->to);
    out[1] = fmax(path->from, path->to);
    if (path->kind == RITZ_PATH_TABLE)
        range_table(path, out);
}

void ritz_path_free(ritz_path *path)
{
    RITZ_FREE(path->time, path->value, path->bend);
    *path = (ritz_path){0};
}
