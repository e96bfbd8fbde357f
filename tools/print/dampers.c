/* Reports of dampers: scans of a pole, the H2 norm, tuning and placement. */
#include "print/print.h"

#include "base/tolerances.h"

#include <ritz/tuning.h>

#include <complex.h>
#include <inttypes.h>

/* --- Ranges of the command line ------------------------------------------- */

/* "NAME[,NAME]=C[*K]" with C and K as "FROM:TO:STEP" or "FROM:TO"; one of the
   two may be empty. */
typedef struct damper_ranges {
    int64_t count;
    int64_t *damper;
    bool has[2];        /* c, k */
    double value[2][3]; /* from, to, step */
} damper_ranges;

static void damper_ranges_free(damper_ranges *ranges)
{
    free(ranges->damper);
    *ranges = (damper_ranges){0};
}

RITZ_ARRAY_OF(damper_ranges);

/* Convert the names before '=' to indices. */
static ritz_status take_names(char *names, const ritz_dampers *dampers,
                              damper_ranges *out)
{
    char *rest = NULL;

    for (char *at = strtok_r(names, ",", &rest); at;
         at = strtok_r(NULL, ",", &rest)) {
        out->damper[out->count] = ritz_dampers_find(dampers, at);
        if (out->damper[out->count++] < 0)
            return RITZ_ERR_ARGUMENT;
    }
    return RITZ_OK;
}

/* "FROM:TO:STEP" as three numbers, "FROM:TO" as two; "" is no range. */
static bool take_range(char *text, int numbers, bool *has, double *value)
{
    char *rest = NULL;
    char *at = strtok_r(text, ":", &rest);
    int count = 0;

    *has = at != NULL;
    for (; at; at = strtok_r(NULL, ":", &rest))
        if (count == numbers || !ritz_text_real(at, &value[count++]))
            return false;
    return !*has || count == numbers;
}

/* Parse the ranges after '='. */
static bool take_ranges(char *text, int numbers, damper_ranges *out)
{
    char *star = strchr(text, '*');

    if (star)
        *star++ = '\0';
    return take_range(text, numbers, &out->has[0], out->value[0]) &&
           (!star || take_range(star, numbers, &out->has[1], out->value[1])) &&
           (out->has[0] || out->has[1]);
}

/* Parse all but the names of dampers, which are left in @p names. */
static ritz_status parse_values(const char *text, int numbers, char **names,
                                damper_ranges *out)
{
    RITZ_OWN_ARRAY char *copy = NULL;
    int64_t size = (int64_t)strlen(text) + 1;
    char *equals = NULL;

    RITZ_CHECK_COPY(copy, text, size);
    RITZ_CHECK_NEW(out->damper, size);
    equals = strrchr(copy, '=');
    if (equals)
        *equals = '\0';
    RITZ_REFUSE_IF(
        !equals || equals == copy || !take_ranges(equals + 1, numbers, out),
        RITZ_ERR_ARGUMENT, "'%s' is not of the form NAME[,NAME]=%s", text,
        numbers == 3 ? "FROM:TO:STEP[*FROM:TO:STEP]" : "FROM:TO[*FROM:TO]");
    RITZ_MOVE(*names, copy);
    return RITZ_OK;
}

static ritz_status parse_ranges(const char *text, const ritz_dampers *dampers,
                                int numbers, damper_ranges *out)
{
    RITZ_OWN_ARRAY char *names = NULL;

    RITZ_CHECK(parse_values(text, numbers, &names, out));
    return take_names(names, dampers, out);
}

/* "low, middle" */
static void join_names(const ritz_dampers *dampers, int64_t count,
                       const int64_t *damper, size_t size, char *out)
{
    out[0] = '\0';
    for (int64_t j = 0; j < count; j++)
        sink_append(out, size, "%s%s", j > 0 ? ", " : "",
                    dampers->name[damper[j]]);
}

/* --- Scans ---------------------------------------------------------------- */

enum { LABEL_SIZE = 256 };

/* The axes of a scan, and their columns of the table. */
typedef struct scan_axes {
    int64_t count;
    ritz_scan_axis *axis;
    char (*label)[LABEL_SIZE]; /* "c" of one axis; "c(low)" of several */
} scan_axes;

static void scan_axes_free(scan_axes *axes)
{
    RITZ_FREE(axes->axis, axes->label);
}

static ritz_status scan_axes_new(const damper_ranges_array *ranges,
                                 const ritz_dampers *dampers, scan_axes *out)
{
    RITZ_CHECK_NEW(out->axis, 2 * ranges->count);
    RITZ_CHECK_NEW(out->label, 2 * ranges->count);
    for (int64_t g = 0; g < ranges->count; g++)
        for (int k = 0; k < 2; k++) {
            const damper_ranges *r = &ranges->at[g];

            if (!r->has[k])
                continue;
            out->axis[out->count++] = (ritz_scan_axis){
                r->count,       r->damper,      k,
                r->value[k][0], r->value[k][1], r->value[k][2]};
        }
    for (int64_t a = 0; a < out->count; a++) {
        char names[LABEL_SIZE - 4];

        join_names(dampers, out->axis[a].count, out->axis[a].damper,
                   sizeof names, names);
        (void)snprintf(out->label[a], LABEL_SIZE, "%s",
                       out->axis[a].of_k ? "k" : "c");
        if (out->count > 1)
            sink_append(out->label[a], LABEL_SIZE, "(%s)", names);
    }
    return RITZ_OK;
}

static double hertz_of(double _Complex s)
{
    return cabs(s) / (2.0 * RITZ_PI);
}

/* One point: "c", or "values" in the order of the axes, and the pole. */
static void set_point(cli_run *run, const ritz_scan *scan,
                      const scan_axes *axes, int64_t k)
{
    const double *value = scan->value + k * scan->num_axes;
    double _Complex s = scan->s[k];

    if (scan->num_axes == 1)
        sink_set(run, axes->label[0], "%g", value[0]);
    else
        sink_reals(run, "values", scan->num_axes, value);
    sink_set(run, "hertz,zeta,real,imaginary", "%g %g %g %g", hertz_of(s),
             ritz_spectrum_ratio(s), creal(s), cimag(s));
}

/* Warn if the best point lies at an end of an axis. */
static void warn_ends(cli_run *run, const ritz_scan *scan,
                      const scan_axes *axes)
{
    int64_t stride = 1;

    for (int64_t a = scan->num_axes - 1; a >= 0; a--) {
        int64_t at = scan->best / stride % scan->size[a];

        if (at == 0 || at == scan->size[a] - 1)
            cli_warn(run, "the best %s, %g, is at an end of the range",
                     axes->label[a],
                     scan->value[scan->best * scan->num_axes + a]);
        stride *= scan->size[a];
    }
}

static void say_heading(cli_run *run, const scan_axes *axes, bool tsv)
{
    for (int64_t a = 0; a < axes->count; a++)
        sink_part(run, tsv ? "%s\t" : "%13s ", axes->label[a]);
    cli_say(run, tsv ? "%s\t%s" : "%13s %12s", tsv ? "hertz" : "|s|/2pi Hz",
            tsv ? "zeta" : "zeta %");
}

/* Print the table of a scan and its best point. */
static void say_scan(cli_run *run, const ritz_scan *scan, const scan_axes *axes,
                     bool tsv)
{
    SINK_EACH(run, "axes", a, scan->num_axes)
        sink_add(run, "%s", axes->label[a]);
    say_heading(run, axes, tsv);
    SINK_ITEMS(run, "scan", k, scan->count) {
        double hertz = hertz_of(scan->s[k]);
        double zeta = ritz_spectrum_ratio(scan->s[k]);

        set_point(run, scan, axes, k);
        for (int64_t a = 0; a < scan->num_axes; a++) {
            int width = (int)strlen(axes->label[a]);
            double value = scan->value[k * scan->num_axes + a];

            if (tsv)
                sink_part(run, "%.12g\t", value);
            else
                sink_part(run, "%*g ", width > 13 ? width : 13, value);
        }
        if (tsv)
            cli_say(run, "%.12g\t%.12g", hertz, zeta);
        else
            cli_say(run, "%13.7g %12.6g%s", hertz, 100.0 * zeta,
                    k == scan->best ? "  best" : "");
    }
    json_object_set(run->report, "best",
                    json_array_get(json_object_get(run->report, "scan"),
                                   (size_t)scan->best));
    warn_ends(run, scan, axes);
}

ritz_status dampers_scan(cli_run *run, model *m, const poles_options *given)
{
    const ritz_dampers *dampers = model_dampers(m);
    RITZ_OWN(damper_ranges_array) ranges = {.count = given->scan.count};
    RITZ_OWN(scan_axes) axes = {0};
    RITZ_OWN(ritz_scan) found = {0};
    ritz_scan_request request = {.mode = given->mode - 1};

    RITZ_CHECK_NEW(ranges.at, ranges.count);
    for (int64_t g = 0; g < ranges.count; g++)
        RITZ_CHECK_IN("--scan", parse_ranges(given->scan.text[g], dampers, 3,
                                             &ranges.at[g]));
    RITZ_CHECK(scan_axes_new(&ranges, dampers, &axes));
    request.count = axes.count;
    request.axis = axes.axis;
    RITZ_CHECK(ritz_scan_of(model_reference(m), &request, &found));
    say_scan(run, &found, &axes, given->tsv);
    return RITZ_OK;
}

/* --- The H2 norm ---------------------------------------------------------- */

/* Parse "HZ[:ORDER]", and print a line about the disturbance at the inputs. */
static ritz_status take_noise(cli_run *run, const poles_options *given,
                              ritz_disturbance *out)
{
    enum { PAPER_ORDER = 6 }; /* [ChuMilman1992, section 5] */
    char hertz[RITZ_NAME_SIZE] = "";
    const char *colon = given->low_pass ? strchr(given->low_pass, ':') : NULL;
    size_t length = colon             ? (size_t)(colon - given->low_pass)
                    : given->low_pass ? strlen(given->low_pass)
                                      : 0;

    *out = (ritz_disturbance){.order = PAPER_ORDER};
    if (given->low_pass && length < sizeof hertz)
        memcpy(hertz, given->low_pass, length);
    RITZ_REFUSE_IF(given->low_pass &&
                       (!ritz_text_real(hertz, &out->low_pass_hz) ||
                        !(out->low_pass_hz > 0.0) ||
                        (colon && !ritz_text_whole(colon + 1, &out->order))),
                   RITZ_ERR_ARGUMENT,
                   "--low-pass: '%.80s' is not of the form HZ[:ORDER]",
                   given->low_pass);
    if (given->low_pass)
        sink_say(run, given->tsv ? NULL : "low_pass,order",
                 "noise at the inputs up to %g Hz, low-pass of order %ld",
                 out->low_pass_hz, out->order);
    else if (!given->tsv)
        cli_say(run, "white noise at the inputs");
    return RITZ_OK;
}

ritz_status dampers_norm(cli_run *run, model *m, const poles_options *given)
{
    ritz_disturbance noise = {0};
    ritz_h2 h2 = {0};

    RITZ_CHECK(take_noise(run, given, &noise));
    RITZ_CHECK(ritz_h2_of(model_reference(m), &noise, &h2));
    if (given->tsv)
        sink_say(run, "h2", "%.12g", h2.value);
    else
        sink_say(run, "h2,engine", "H2 norm %.10g (%s)", h2.value, h2.engine);
    sink_set(run, "change", "%g", h2.change);
    if (h2.change > 0.0 && !given->tsv)
        cli_say(run, "twice as many modes changed it by %.1e of itself",
                h2.change);
    cli_record(run, "poles", 0);
    return RITZ_OK;
}

/* --- Tuning --------------------------------------------------------------- */

/* Groups of dampers, each with its ranges. */
typedef struct tuned_groups {
    damper_ranges_array ranges;
    ritz_tuned *tuned;
} tuned_groups;

static void tuned_groups_free(tuned_groups *groups)
{
    damper_ranges_array_free(&groups->ranges);
    free(groups->tuned);
}

static bool is_each(const char *text, const ritz_dampers *dampers)
{
    if (strncmp(text, "each=", 5) != 0)
        return false;
    for (int64_t j = 0; j < dampers->count; j++)
        if (strcmp(dampers->name[j], "each") == 0)
            return false;
    return true;
}

/* One group from an option, or one group for each damper. */
static ritz_status take_groups(const char *text, const ritz_dampers *dampers,
                               damper_ranges_array *out)
{
    if (!is_each(text, dampers))
        return parse_ranges(text, dampers, 2, &out->at[out->count++]);
    for (int64_t j = 0; j < dampers->count; j++) {
        damper_ranges *one = &out->at[out->count++];
        RITZ_OWN_ARRAY char *names = NULL;

        RITZ_CHECK(parse_values(text, 2, &names, one));
        one->damper[one->count++] = j;
    }
    return RITZ_OK;
}

static ritz_status tuned_groups_new(const cli_list *texts,
                                    const ritz_dampers *dampers,
                                    tuned_groups *out)
{
    int64_t most = texts->count * (dampers->count + 1);

    RITZ_CHECK_NEW(out->ranges.at, most);
    RITZ_CHECK_NEW(out->tuned, most);
    for (int g = 0; g < texts->count; g++)
        RITZ_CHECK_IN("--tune",
                      take_groups(texts->text[g], dampers, &out->ranges));
    for (int64_t g = 0; g < out->ranges.count; g++) {
        const damper_ranges *r = &out->ranges.at[g];
        double none = nan("");
        ritz_tuned *tuned = &out->tuned[g];

        *tuned = (ritz_tuned){r->count, r->damper, {none, none}, {none, none}};
        if (r->has[0])
            memcpy(tuned->c, r->value[0], sizeof tuned->c);
        if (r->has[1])
            memcpy(tuned->k, r->value[1], sizeof tuned->k);
    }
    return RITZ_OK;
}

static void warn_range(cli_run *run, const char *what, const char *name,
                       double value, const double range[2])
{
    if (range[1] > range[0] && (value <= range[0] || value >= range[1]))
        cli_warn(run, "the best %s of '%s', %g, is at an end of its range",
                 what, name, value);
}

/* Values of damper j in group g: the tuned ones, or its own where not tuned. */
static void values_of(const ritz_tuning *tuning, int64_t g,
                      const ritz_dampers *dampers, int64_t j, double value[2])
{
    value[0] = isnan(tuning->c[g]) ? dampers->c[j] : tuning->c[g];
    value[1] = isnan(tuning->k[g]) ? dampers->k[j] : tuning->k[g];
}

/* Print c and k as a table, and as options of ritz-poles. */
static void say_values(cli_run *run, const tuned_groups *groups,
                       const int64_t *taken, const ritz_dampers *dampers,
                       const ritz_tuning *tuning, bool tsv)
{
    if (tsv)
        cli_say(run, "damper\tc\tk");
    else
        cli_say(run, "%-24s %14s %14s", "damper", "c", "k");
    sink_list(run, "tuned");
    for (int64_t g = 0; g < tuning->count; g++) {
        const ritz_tuned *tuned = &groups->tuned[taken ? taken[g] : g];

        for (int64_t i = 0; i < tuned->count; i++) {
            int64_t j = tuned->damper[i];
            double v[2];

            values_of(tuning, g, dampers, j, v);
            sink_object(run, NULL);
            sink_set(run, "damper,c,k", "%s %g %g", dampers->name[j], v[0],
                     v[1]);
            sink_end(run);
            cli_say(run, tsv ? "%s\t%.12g\t%.12g" : "%-24s %14.7g %14.7g",
                    dampers->name[j], v[0], v[1]);
            if (i > 0)
                continue;
            warn_range(run, "c", dampers->name[j], v[0], tuned->c);
            warn_range(run, "k", dampers->name[j], v[1], tuned->k);
        }
    }
    sink_end(run);
}

static void say_options(cli_run *run, const tuned_groups *groups,
                        const int64_t *taken, const ritz_dampers *dampers,
                        const ritz_tuning *tuning)
{
    sink_part(run, "for other tools:");
    for (int64_t g = 0; g < tuning->count; g++) {
        const ritz_tuned *tuned = &groups->tuned[taken ? taken[g] : g];

        for (int64_t i = 0; i < tuned->count; i++) {
            double v[2];

            values_of(tuning, g, dampers, tuned->damper[i], v);
            sink_part(run, " --damper %s=%.7g*%.7g",
                      dampers->name[tuned->damper[i]], v[0], v[1]);
        }
    }
    cli_say(run, "%s", "");
}

static void warn_tuning(cli_run *run, const ritz_tuning *tuning)
{
    double off = fabs(tuning->norm - tuning->tuned) / tuning->norm;

    if (off > RITZ_TUNED_FULL)
        cli_warn(run,
                 "the norm of the full model differs by %.1e from that of the "
                 "model that was tuned: give more --modes",
                 off);
    if (tuning->slope > RITZ_TUNED_SLOPE)
        cli_warn(run,
                 "the search ended where the norm still falls by %.1e of "
                 "itself over a range: narrow the ranges",
                 tuning->slope);
}

static void say_tuning(cli_run *run, const ritz_tuning *tuning, bool tsv)
{
    sink_set(run, "before,h2,change,searched,modes", "%g %g %g %g %ld",
             tuning->before, tuning->norm, tuning->change, tuning->tuned,
             tuning->modes);
    sink_set(run, "evaluations,starts,agreed,slope", "%ld %ld %ld %g",
             tuning->evaluations, tuning->starts, tuning->agreed,
             tuning->slope);
    if (!tsv) {
        cli_say(run, "H2 norm %.10g, before %.10g", tuning->norm,
                tuning->before);
        if (tuning->modes > 0)
            cli_say(run,
                    "of the full model; tuned with %ld modes and static "
                    "responses, where it is %.10g",
                    tuning->modes, tuning->tuned);
        cli_say(run, "%ld of %ld searches end there, %ld evaluations",
                tuning->agreed, tuning->starts, tuning->evaluations);
    }
    warn_tuning(run, tuning);
}

/* Print the norm of each candidate alone, then the best combinations. */
static void say_places(cli_run *run, const ritz_placing *placing,
                       const tuned_groups *groups, const ritz_dampers *dampers)
{
    char names[LABEL_SIZE];

    sink_say(run, "none", "H2 norm without any %.10g", placing->none);
    cli_say(run, "%-24s %16s %14s %14s", "alone", "H2 norm", "c", "k");
    SINK_ITEMS(run, "alone", g, placing->count) {
        const ritz_tuned *tuned = &groups->tuned[g];

        join_names(dampers, tuned->count, tuned->damper, sizeof names, names);
        sink_say(run, "groups,h2,c,k", "%-24s %16.9g %14.7g %14.7g", names,
                 placing->alone[g], placing->c[g], placing->k[g]);
    }
    sink_say(run, "combinations,among",
             "%ld combinations of the best %ld; the next best:",
             placing->num_choices, placing->num_among);
    SINK_ITEMS(run, "next", j, placing->num_next) {
        names[0] = '\0';
        for (int64_t i = 0; i < placing->places; i++) {
            const ritz_tuned *tuned =
                &groups->tuned[placing->next[j * placing->places + i]];
            char some[LABEL_SIZE];

            join_names(dampers, tuned->count, tuned->damper, sizeof some, some);
            sink_append(names, sizeof names, "%s%s", i > 0 ? ", " : "", some);
        }
        sink_say(run, "h2,groups", "%16.9g  %s", placing->next_norm[j], names);
    }
}

ritz_status dampers_tune(cli_run *run, model *m, const poles_options *given)
{
    const ritz_dampers *dampers = model_dampers(m);
    RITZ_OWN(tuned_groups) groups = {0};
    RITZ_OWN(ritz_tuning) tuning = {0};
    RITZ_OWN(ritz_placing) placing = {0};
    ritz_placing_request request = {.places = given->places,
                                    .among = given->among};
    const ritz_tuning *found = given->places > 0 ? &placing.tuning : &tuning;

    RITZ_CHECK(tuned_groups_new(&given->tune, dampers, &groups));
    RITZ_CHECK(take_noise(run, given, &request.tuning.noise));
    request.tuning.model = model_reference(m);
    request.tuning.count = groups.ranges.count;
    request.tuning.tuned = groups.tuned;
    request.tuning.modes = given->modes;
    if (given->places > 0)
        RITZ_CHECK(ritz_placing_of(&request, &placing));
    else
        RITZ_CHECK(ritz_tuning_of(&request.tuning, &tuning));
    if (given->places > 0 && !given->tsv)
        say_places(run, &placing, &groups, dampers);
    say_tuning(run, found, given->tsv);
    say_values(run, &groups, placing.taken, dampers, found, given->tsv);
    if (!given->tsv)
        say_options(run, &groups, placing.taken, dampers, found);
    cli_record(run, "poles", 0);
    return RITZ_OK;
}
