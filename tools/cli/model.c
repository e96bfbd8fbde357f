#include "cli/model.h"

#include "base/alloc.h"
#include "base/aside.h"
#include "cli/walk.h"
#include "model/squares.h"

#include <ritz/matrix.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { LARGE = 1 << 20 }; /* bytes of a file from which threads gain time */

/* Functions of a kind, to be called by its row. */
#define DEFINE_KIND(KIND, type, member, name, noun)                            \
    static ritz_status read_##type(const char *path, model *m)                 \
    {                                                                          \
        return ritz_container_read_##type(path, &m->member);                   \
    }                                                                          \
                                                                               \
    static ritz_status write_##type(const char *path, const model *m,          \
                                    const ritz_stamp *stamp)                   \
    {                                                                          \
        return ritz_container_write_##type(path, &m->member, stamp);           \
    }

MODEL_EACH_KIND(DEFINE_KIND)

static const struct kind {
    const char *name; /* in files */
    const char *noun; /* in sentences */
    model_kind kind;
    size_t offset; /* of the object in a model */
    ritz_status (*read)(const char *path, model *m);
    ritz_status (*write)(const char *path, const model *m,
                         const ritz_stamp *stamp);
} kinds[] = {
#define KIND_ROW(KIND, type, member, name, noun)                               \
    {name,        noun,        MODEL_##KIND, offsetof(model, member),          \
     read_##type, write_##type},
    MODEL_EACH_KIND(KIND_ROW)
#undef KIND_ROW
};

enum { NUM_KINDS = sizeof kinds / sizeof *kinds };

static const struct kind *kind_of(const model *m)
{
    int k = 0;

    while (kinds[k].kind != m->kind)
        k++;
    return &kinds[k];
}

ritz_status model_write(cli_run *run, const model *m)
{
    return kind_of(m)->write(run->output, m, cli_stamp(run));
}

const void *model_object(const model *m)
{
    return (const char *)m + kind_of(m)->offset;
}

ritz_model model_reference(const model *m)
{
    if (m->kind == MODEL_COMPONENT)
        return ritz_model_of_component(&m->component, &m->damping);
    if (m->kind == MODEL_STATES)
        return ritz_model_of_states(&m->states);
    return m->at ? ritz_model_of_configuration(m->at, &m->damping)
                 : ritz_model_of_reduced(&m->reduced, &m->damping);
}

bool model_has_states(const model *m)
{
    if (m->kind == MODEL_COMPONENT)
        return m->component.num_dofs <= MODEL_MOST_DOFS &&
               !m->component.K4.colptr;
    return m->kind == MODEL_STATES || !model_reference(m).dense.K4->val;
}

void model_nouns(int wanted, char *out, size_t room)
{
    out[0] = '\0';
    for (int k = 0; k < NUM_KINDS; k++)
        if (wanted & (int)kinds[k].kind)
            sink_append(out, room, "%s%s", *out ? " or " : "", kinds[k].noun);
}

/* NUM_KINDS: one that is not known. */
static int find_kind(const ritz_summary *summary)
{
    int k = 0;

    while (k < NUM_KINDS && strcmp(kinds[k].name, summary->kind) != 0)
        k++;
    return k;
}

ritz_status model_peek(const char *path, model_kind *kind, const char **noun)
{
    RITZ_OWN(ritz_summary) summary = {0};
    int k = 0;

    RITZ_CHECK(ritz_container_summary(path, &summary));
    k = find_kind(&summary);
    RITZ_REFUSE_IF(k == NUM_KINDS, RITZ_ERR_FORMAT,
                   "'%s' holds '%s', which is no kind of container", path,
                   summary.kind);
    *kind = kinds[k].kind;
    *noun = kinds[k].noun;
    return RITZ_OK;
}

/* Read from the file that is kept open. */
static ritz_status read_kept(const char *path, int wanted, model *out)
{
    RITZ_OWN(ritz_summary) summary = {0};
    char list[160];
    int k = 0;

    RITZ_CHECK(ritz_container_summary(path, &summary));
    k = find_kind(&summary);
    model_nouns(wanted, list, sizeof list);
    RITZ_REFUSE_IF(k == NUM_KINDS, RITZ_ERR_FORMAT, "'%s' holds '%s', not %s",
                   path, summary.kind, list);
    RITZ_REFUSE_IF(!(wanted & (int)kinds[k].kind), RITZ_ERR_FORMAT,
                   "'%s' holds %s, not %s", path, kinds[k].noun, list);
    out->kind = kinds[k].kind;
    return kinds[k].read(path, out);
}

/* The checksum of an input, by another thread while the input is read. */
typedef struct summing {
    const char *path;
    char digest[RITZ_DIGEST_SIZE];
    ritz_status status;
} summing;

static void sum_file(void *task)
{
    summing *s = task;

    s->status = ritz_digest_file(s->path, s->digest);
}

/* Whether a second thread gains time with this file. */
static bool is_large(const char *path)
{
    struct stat there = {0};

    return stat(path, &there) == 0 && S_ISREG(there.st_mode) &&
           there.st_size >= LARGE;
}

static ritz_status read_checked(const char *path, int wanted, model *out)
{
    ritz_status status = RITZ_OK;

    RITZ_CHECK(ritz_container_keep(path));
    status = read_kept(path, wanted, out);
    ritz_container_release();
    return status;
}

/* Read a large file and its checksum at the same time. */
static ritz_status read_and_sum(cli_run *run, const char *path, int wanted,
                                model *out)
{
    summing s = {.path = path};
    ritz_aside aside;
    ritz_status status = RITZ_OK;

    RITZ_CHECK(cli_input_unread(run, path));
    ritz_aside_begin(sum_file, &s, true, &aside);
    status = read_checked(path, wanted, out);
    ritz_aside_end(&aside);
    RITZ_CHECK(status);
    if (s.status != RITZ_OK) /* again, for its sentence */
        RITZ_CHECK(ritz_digest_file(path, s.digest));
    cli_input_sum(run, path, s.digest);
    return RITZ_OK;
}

ritz_status model_read(cli_run *run, const char *path, int wanted, model *out)
{
    ritz_status status = RITZ_OK;

    if (is_large(path)) {
        status = read_and_sum(run, path, wanted, out);
    } else {
        RITZ_CHECK(cli_input(run, path));
        status = read_checked(path, wanted, out);
    }
    RITZ_CHECK(status);
    if (out->kind == MODEL_COMPONENT &&
        out->component.asymmetry > MODEL_ROUNDING)
        cli_warn(run,
                 "'%s': unsymmetric by %.1e of its largest entry, "
                 "averaged away",
                 path, out->component.asymmetry);
    return RITZ_OK;
}

void model_warn_loads(cli_run *run, const char *path, int64_t count)
{
    if (count > 0)
        cli_warn(run,
                 "'%s': geometric stiffness of %ld load%s is left out: a state "
                 "space has no stiffness matrix",
                 path, count, count > 1 ? "s" : "");
}

ritz_status model_scene(cli_run *run, const char *path, ritz_scene *out)
{
    RITZ_OWN(ritz_scene) scene = {0};

    RITZ_CHECK(cli_input(run, path));
    RITZ_CHECK(ritz_scene_read(path, &scene));
    for (int64_t k = 0; k < scene.num_components; k++)
        walk_ahead(scene.component[k].model);
    for (int64_t k = 0; k < scene.num_components; k++)
        RITZ_CHECK_IN(path, cli_input(run, scene.component[k].model));
    RITZ_MOVE(*out, scene);
    return RITZ_OK;
}

/* Bytes that a system holds for one configuration. */
static double count_bytes(const ritz_configuration *at)
{
    const ritz_dense parts[] = {at->K,     at->M,     at->D,
                                at->K4,    at->io.B,  at->io.C,
                                at->io.Cv, at->io.Ca, at->momentum};
    double numbers = (double)at->K.nrow;

    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++)
        numbers += (double)parts[k].nrow * (double)parts[k].ncol;
    for (int64_t k = 0; k < at->num_blocks; k++)
        numbers += (double)at->P[k].nrow * (double)at->P[k].ncol;
    return numbers * (double)sizeof(double);
}

ritz_status model_foresee(cli_run *run, const ritz_stage *stage)
{
    enum { MANY = 1000 };
    const ritz_scene *scene = stage->scene;
    RITZ_OWN(ritz_configuration) first = {0};
    const double began = cli_clock();
    const double count = (double)scene->num_configurations;
    char text[CLI_DURATION];

    if (scene->num_configurations <= MANY)
        return RITZ_OK;
    RITZ_CHECK(ritz_stage_assemble(stage, scene->setting, &first));
    cli_warn(run,
             "the scene has %ld configurations: to assemble them takes about "
             "%s and %.2g GB; list those wanted under 'configurations'",
             scene->num_configurations,
             cli_duration(count * (cli_clock() - began), text),
             count * count_bytes(&first) * 1e-9);
    return RITZ_OK;
}

ritz_status model_at(model *m, const char *path, const char *at)
{
    const ritz_configuration *found = NULL;

    RITZ_REFUSE_IF(at && m->kind != MODEL_SYSTEM, RITZ_ERR_ARGUMENT,
                   "'%s' is no system, --at has nothing to choose from", path);
    if (m->kind != MODEL_SYSTEM)
        return RITZ_OK;
    RITZ_CHECK_IN(path, ritz_system_find(&m->system, at, &found));
    m->at = m->system.configuration + (found - m->system.configuration);
    return RITZ_OK;
}

ritz_status model_as_reduced(model *m, const char *path,
                             const model_options *given)
{
    RITZ_CHECK(model_prefix(m, path, given->order));
    RITZ_CHECK(model_at(m, path, given->at));
    if (!m->at)
        return RITZ_OK;
    RITZ_CHECK_IN(
        path, ritz_reduced_of_configuration(&m->system, m->at, &m->reduced));
    m->kind = MODEL_REDUCED;
    m->at = NULL;
    return RITZ_OK;
}

ritz_status model_as_component(model *m, const char *path,
                               const model_options *given)
{
    RITZ_CHECK(model_as_reduced(m, path, given));
    if (m->kind != MODEL_REDUCED)
        return RITZ_OK;
    RITZ_CHECK_IN(path, ritz_component_of_reduced(&m->reduced, &m->component));
    m->kind = MODEL_COMPONENT;
    return RITZ_OK;
}

ritz_status model_prefix(model *m, const char *path, int64_t order)
{
    ritz_reduced prefix = {0};

    if (order == 0)
        return RITZ_OK;
    RITZ_REFUSE_IF(m->kind != MODEL_REDUCED, RITZ_ERR_ARGUMENT,
                   "'%s' is no reduced component, --order has no columns to "
                   "choose from",
                   path);
    RITZ_CHECK_IN(path, ritz_reduced_prefix(&m->reduced, order, &prefix));
    ritz_reduced_free(&m->reduced);
    m->reduced = prefix;
    return RITZ_OK;
}

ritz_status model_settle(model *m, const char *path, const model_options *given)
{
    RITZ_CHECK(model_prefix(m, path, given->order));
    RITZ_CHECK(model_at(m, path, given->at));
    RITZ_REFUSE_IF(m->kind == MODEL_STATES && given->damping, RITZ_ERR_ARGUMENT,
                   "a state space is damped as it was made: --damping is for "
                   "ritz-basis");
    RITZ_CHECK_IN(path, model_install(m, &given->damper));
    return model_damping(m, given->damping, &m->damping);
}

ritz_dampers *model_dampers(model *m)
{
    if (m->kind == MODEL_COMPONENT)
        return &m->component.dampers;
    return m->at ? &m->at->dampers : &m->reduced.dampers;
}

ritz_status model_tune(model *m, const cli_list *texts)
{
    for (int k = 0; texts && k < texts->count; k++)
        RITZ_CHECK_IN("--damper",
                      ritz_dampers_tune(model_dampers(m), texts->text[k]));
    return RITZ_OK;
}

ritz_status model_install(model *m, const cli_list *texts)
{
    RITZ_CHECK(model_tune(m, texts));
    if (m->kind == MODEL_COMPONENT)
        return ritz_component_install(&m->component);
    return m->at ? ritz_configuration_install(m->at)
                 : ritz_reduced_install(&m->reduced);
}

ritz_status model_damping(const model *m, const char *given, ritz_damping *out)
{
    const char *own = m->kind == MODEL_COMPONENT ? m->component.damping
                      : m->kind == MODEL_SYSTEM  ? m->system.damping
                                                 : m->reduced.damping;

    return ritz_context(ritz_damping_parse(given ? given : own, out),
                        given ? "--damping" : "damping of the model");
}

ritz_status model_hertz(const ritz_dense *K, const ritz_dense *M,
                        int64_t *num_rigid, int64_t *count, double **out)
{
    RITZ_OWN(ritz_pairs) pairs = {0};

    RITZ_CHECK(ritz_eigen_dense(K, M, &pairs));
    RITZ_CHECK_NEW(*out, pairs.Phi.ncol + 1);
    for (int64_t k = pairs.num_rigid; k < pairs.Phi.ncol; k++)
        (*out)[k] = ritz_eigen_hertz(pairs.lambda[k]);
    *num_rigid = pairs.num_rigid;
    *count = pairs.Phi.ncol;
    return RITZ_OK;
}

ritz_status model_hertz_at(const ritz_configuration *at, double **out)
{
    RITZ_CHECK_NEW(*out, at->K.nrow + 1);
    for (int64_t k = at->num_rigid; k < at->K.nrow; k++)
        (*out)[k] = ritz_eigen_hertz(at->lambda[k]);
    return RITZ_OK;
}

int64_t model_negative_squares(const ritz_configuration *at, double *first_hz)
{
    int64_t count = 0;

    for (int64_t k = at ? at->K.nrow - 1 : -1; k >= 0; k--) {
        if (!ritz_configuration_is_square(at, k))
            continue;
        count++;
        if (first_hz)
            *first_hz = fabs(ritz_eigen_hertz(at->lambda[k]));
    }
    return count;
}

ritz_status model_refuse_forces(const model *m, const char *path)
{
    double first_hz = 0.0;
    int64_t count = model_negative_squares(m->at, &first_hz);

    RITZ_REFUSE_IF(count > 0, RITZ_ERR_ARGUMENT,
                   "'%s' has %ld negative squares from %.4g Hz on, of the "
                   "forces that join bodies of dual-craig-bampton: an unstable "
                   "model has no steady response; macneal-rubin has the same "
                   "columns",
                   path, (long)count, first_hz);
    return RITZ_OK;
}

static const char *name_verdict(const ritz_measure *m, const char *known)
{
    if (isnan(m->limit))
        return known;
    return ritz_measure_holds(m) ? "pass" : "fail";
}

void model_say_measures(cli_run *run, sink_text text, const char *key,
                        const ritz_measures *measures, const char *known)
{
    int width = 28; /* more where a name is longer */

    for (int64_t k = 0; k < measures->count; k++)
        if (strlen(measures->item[k].name) > (size_t)width)
            width = (int)strlen(measures->item[k].name);
    if (text != SINK_NONE && measures->count > 0)
        cli_say(run, "%-*s %12s %12s  %-9s  %s", width, "measure", "value",
                "limit", "verdict", "where");
    SINK_EACH(run, key, k, measures->count) {
        const ritz_measure *m = &measures->item[k];

        sink_tell(run, text, NULL, "name,value,limit,verdict,where,,cause",
                  "%-*s %12.4e %12.4g  %-9s  %s%s%s", width, m->name, m->value,
                  m->limit, name_verdict(m, known), m->where,
                  m->where[0] && m->cause[0] ? ": " : "", m->cause);
    }
}

void model_record_measure(cli_run *run, const ritz_measure *measure)
{
    cli_record_error(run, measure->name, measure->value);
    cli_record_cause(run, measure->name, measure->cause);
}

void model_record(cli_run *run, const ritz_measures *measures)
{
    for (int64_t k = 0; k < measures->count; k++)
        model_record_measure(run, &measures->item[k]);
}

void model_set_cost(cli_run *run, const ritz_cost *cost)
{
    sink_object(run, "cost");
    sink_set(run,
             "highest_hz,step_explicit,step_accurate,step,seconds_per_second,"
             "integrator",
             "%g %g %g %g %g %s", cost->highest_hz, cost->step_explicit,
             cost->step_accurate, cost->step, cost->seconds_per_second,
             cost->integrator);
    sink_end(run);
}

/* Name of a body's file: PREFIXname.h5. */
static ritz_status name_body(const char *prefix, const char *name,
                             char out[MODEL_PATH])
{
    int length = snprintf(out, MODEL_PATH, "%s%s.h5", prefix, name);

    RITZ_REFUSE_IF(length < 0 || length >= MODEL_PATH, RITZ_ERR_ARGUMENT,
                   "--components '%.40s...' is too long", prefix);
    return RITZ_OK;
}

ritz_status model_foresee_bodies(const char *prefix, const ritz_scene *scene)
{
    char path[MODEL_PATH];

    for (int64_t k = 0; prefix && k < scene->num_components; k++) {
        RITZ_CHECK(name_body(prefix, scene->component[k].name, path));
        RITZ_CHECK(cli_can_write(path));
    }
    return RITZ_OK;
}

ritz_status model_write_bodies(cli_run *run, const char *prefix,
                               const ritz_scene *scene,
                               const ritz_reduced *body)
{
    char path[MODEL_PATH];

    SINK_EACH(run, "component_files", k, prefix ? scene->num_components : 0) {
        RITZ_CHECK(name_body(prefix, scene->component[k].name, path));
        RITZ_CHECK(
            ritz_container_write_reduced(path, &body[k], cli_stamp(run)));
        sink_add(run, "%s", path);
    }
    return RITZ_OK;
}

void model_free(model *m)
{
#define FREE_KIND(KIND, type, member, name, noun)                              \
    ritz_##type##_free(&m->member);
    MODEL_EACH_KIND(FREE_KIND)
    *m = (model){0};
}

void words_add(choice_words *all, int except, cli_option *options)
{
    int count = 0;

    for (int k = 0; ritz_choice_words[k].key && k < WORDS_MOST; k++) {
        const ritz_choice_word *word = &ritz_choice_words[k];
        char *name = all->name[k];

        if (word->uses & except)
            continue;
        snprintf(name, WORDS_NAME, "%s", word->key);
        for (char *at = strchr(name, '_'); at; at = strchr(at, '_'))
            *at = '-';
        options[count++] = (cli_option)CLI_TEXT(name, &all->text[k],
                                                word->argument, word->help);
    }
}

void words_take(const cli_program *program, const choice_words *all,
                ritz_choice *choice)
{
    for (int k = 0; ritz_choice_words[k].key && k < WORDS_MOST; k++)
        if (all->text[k] && ritz_choice_take(&ritz_choice_words[k],
                                             all->text[k], choice) != RITZ_OK)
            cli_refuse(program, "%s", ritz_error_message());
}
