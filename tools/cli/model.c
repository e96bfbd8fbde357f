#include "cli/model.h"

#include <ritz/eigen.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

static ritz_status read_component(const char *path, model *out)
{
    return ritz_container_read_component(path, &out->component);
}

static ritz_status read_basis(const char *path, model *out)
{
    return ritz_container_read_basis(path, &out->basis);
}

static ritz_status read_reduced(const char *path, model *out)
{
    return ritz_container_read_reduced(path, &out->reduced);
}

static ritz_status read_system(const char *path, model *out)
{
    return ritz_container_read_system(path, &out->system);
}

static ritz_status read_response(const char *path, model *out)
{
    return ritz_container_read_response(path, &out->response);
}

static ritz_status read_ranking(const char *path, model *out)
{
    return ritz_container_read_rankings(path, &out->rankings);
}

static ritz_status read_states(const char *path, model *out)
{
    return ritz_container_read_state_space(path, &out->states);
}

static ritz_status read_simulation(const char *path, model *out)
{
    return ritz_container_read_simulation(path, &out->simulation);
}

static const struct kind {
    const char *name; /* in files */
    const char *noun; /* in sentences */
    model_kind kind;
    ritz_status (*read)(const char *path, model *out);
} kinds[] = {
    {"component", "a component", MODEL_COMPONENT, read_component},
    {"basis", "a basis", MODEL_BASIS, read_basis},
    {"reduced", "a reduced component", MODEL_REDUCED, read_reduced},
    {"system", "a system", MODEL_SYSTEM, read_system},
    {"response", "a response", MODEL_RESPONSE, read_response},
    {"ranking", "a ranking", MODEL_RANKING, read_ranking},
    {"state-space", "a state space", MODEL_STATES, read_states},
    {"simulation", "a time response", MODEL_SIMULATION, read_simulation},
};

enum { NUM_KINDS = sizeof kinds / sizeof *kinds };

/* "a component or a system" */
static void list_kinds(int wanted, char *out, size_t room)
{
    size_t used = 0;

    out[0] = '\0';
    for (int k = 0; k < NUM_KINDS && used < room; k++)
        if (wanted & (int)kinds[k].kind)
            used += (size_t)snprintf(out + used, room - used, "%s%s",
                                     used > 0 ? " or " : "", kinds[k].noun);
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
    ritz_status status = RITZ_OK;
    ritz_summary summary = {0};
    int k = 0;

    RITZ_TRY(ritz_container_summary(path, &summary));
    k = find_kind(&summary);
    RITZ_FAIL_IF(k == NUM_KINDS, RITZ_ERR_FORMAT,
                 "'%s' holds '%s', which is no kind of container", path,
                 summary.kind);
    *kind = kinds[k].kind;
    *noun = kinds[k].noun;
done:
    ritz_summary_free(&summary);
    return status;
}

ritz_status model_read(cli_run *run, const char *path, int wanted, model *out)
{
    ritz_status status = RITZ_OK;
    ritz_summary summary = {0};
    char list[160];
    int k = 0;

    RITZ_TRY(cli_input(run, path));
    RITZ_TRY(ritz_container_summary(path, &summary));
    k = find_kind(&summary);
    list_kinds(wanted, list, sizeof list);
    RITZ_FAIL_IF(k == NUM_KINDS, RITZ_ERR_FORMAT, "'%s' holds '%s', not %s",
                 path, summary.kind, list);
    RITZ_FAIL_IF(!(wanted & (int)kinds[k].kind), RITZ_ERR_FORMAT,
                 "'%s' holds %s, not %s", path, kinds[k].noun, list);
    RITZ_TRY(kinds[k].read(path, out));
    out->kind = kinds[k].kind;
    if (out->kind == MODEL_COMPONENT &&
        out->component.asymmetry > MODEL_ROUNDING)
        cli_warn(run,
                 "'%s': unsymmetric by %.1e of its largest entry, "
                 "averaged away",
                 path, out->component.asymmetry);
done:
    ritz_summary_free(&summary);
    return status;
}

ritz_status model_scene(cli_run *run, const char *path, ritz_scene *out)
{
    ritz_status status = RITZ_OK;
    ritz_scene scene = {0};

    RITZ_TRY(cli_input(run, path));
    RITZ_TRY(ritz_scene_read(path, &scene));
    for (int64_t k = 0; k < scene.num_components; k++)
        RITZ_TRY_IN(path, cli_input(run, scene.component[k].model));
    *out = scene;
    scene = (ritz_scene){0};
done:
    ritz_scene_free(&scene);
    return status;
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

model_view model_look(const model *m)
{
    const ritz_reduced *r = &m->reduced;

    if (m->at)
        return (model_view){
            {&m->at->K, &m->at->M, &m->at->D, &m->at->K4, &m->at->io},
            m->system.damping};
    return (model_view){{&r->K, &r->M, &r->D, &r->K4, &r->io}, r->damping};
}

ritz_status model_damping(const model *m, const char *asked, ritz_damping *out)
{
    const char *own = m->kind == MODEL_COMPONENT ? m->component.damping
                                                 : model_look(m).damping;

    return ritz_context(ritz_damping_parse(asked ? asked : own, out),
                        asked ? "--damping" : "damping of the model");
}

ritz_status model_hertz(const ritz_dense *K, const ritz_dense *M,
                        int64_t *num_rigid, int64_t *count, double **out)
{
    ritz_status status = RITZ_OK;
    ritz_pairs pairs = {0};
    double *hertz = NULL;

    RITZ_TRY(ritz_eigen_dense(K, M, &pairs));
    hertz = calloc((size_t)pairs.Phi.ncol + 1, sizeof *hertz);
    RITZ_FAIL_IF(!hertz, RITZ_ERR_MEMORY, "no memory for frequencies");
    for (int64_t k = pairs.num_rigid; k < pairs.Phi.ncol; k++)
        hertz[k] = ritz_eigen_hertz(pairs.lambda[k]);
    *num_rigid = pairs.num_rigid;
    *count = pairs.Phi.ncol;
    *out = hertz;
done:
    ritz_pairs_free(&pairs);
    return status;
}

ritz_status model_hertz_at(const ritz_configuration *at, double **out)
{
    int64_t e = at->K.nrow;
    double *hertz = calloc((size_t)e + 1, sizeof *hertz);

    if (!hertz)
        return ritz_fail(RITZ_ERR_MEMORY, "no memory for frequencies");
    for (int64_t k = at->num_rigid; k < e; k++)
        hertz[k] = ritz_eigen_hertz(at->lambda[k]);
    *out = hertz;
    return RITZ_OK;
}

static const char *verdict(const ritz_measure *m, const char *known)
{
    if (isnan(m->limit))
        return known;
    return ritz_measure_holds(m) ? "pass" : "fail";
}

void model_set_measures(cli_run *run, const char *key,
                        const ritz_measures *measures, const char *known)
{
    sink_list(run, key);
    for (int64_t k = 0; k < measures->count; k++) {
        const ritz_measure *m = &measures->item[k];

        sink_set(run, "name,value,limit,verdict,where", "%s %g %g %s %s",
                 m->name, m->value, m->limit, verdict(m, known), m->where);
    }
    sink_end(run);
}

void model_say_measures(cli_run *run, const char *key,
                        const ritz_measures *measures, const char *known)
{
    int width = 28; /* more where a name is longer */

    for (int64_t k = 0; k < measures->count; k++)
        if (strlen(measures->item[k].name) > (size_t)width)
            width = (int)strlen(measures->item[k].name);
    cli_say(run, "%-*s %12s %12s  %-9s  %s", width, "measure", "value", "limit",
            "verdict", "where");
    sink_list(run, key);
    for (int64_t k = 0; k < measures->count; k++) {
        const ritz_measure *m = &measures->item[k];

        sink_say(run, "name,value,limit,verdict,where",
                 "%-*s %12.4e %12.4g  %-9s  %s", width, m->name, m->value,
                 m->limit, verdict(m, known), m->where);
    }
    sink_end(run);
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

ritz_io model_io_of_states(const ritz_state_space *states)
{
    return (ritz_io){.num_inputs = states->num_inputs,
                     .num_outputs = states->num_outputs,
                     .input = states->input,
                     .output = states->output,
                     .limit = states->limit};
}

json_t *model_measures_json(const ritz_measures *measures, const char *known)
{
    json_t *array = json_array();

    for (int64_t k = 0; k < measures->count; k++) {
        const ritz_measure *m = &measures->item[k];
        json_t *item = json_object();

        json_object_set_new(item, "name", cli_string(m->name));
        json_object_set_new(item, "value", cli_real(m->value));
        json_object_set_new(item, "limit", cli_real(m->limit));
        json_object_set_new(item, "verdict", json_string(verdict(m, known)));
        json_object_set_new(item, "where", cli_string(m->where));
        json_array_append_new(array, item);
    }
    return array;
}

json_t *model_cost_json(const ritz_cost *cost)
{
    json_t *object = json_object();

    json_object_set_new(object, "highest_hz", cli_real(cost->highest_hz));
    json_object_set_new(object, "step_explicit", cli_real(cost->step_explicit));
    json_object_set_new(object, "step_accurate", cli_real(cost->step_accurate));
    json_object_set_new(object, "step", cli_real(cost->step));
    json_object_set_new(object, "seconds_per_second",
                        cli_real(cost->seconds_per_second));
    json_object_set_new(object, "integrator", cli_string(cost->integrator));
    return object;
}

json_t *model_reals_json(int64_t count, const double *values)
{
    json_t *array = json_array();

    for (int64_t k = 0; k < count; k++)
        json_array_append_new(array, cli_real(values[k]));
    return array;
}

bool model_band(const ritz_columns *columns, double *low, double *high)
{
    bool any = false;

    for (int64_t k = 0; k < columns->count; k++) {
        double hertz = columns->hertz[k];

        if (columns->kind[k] != RITZ_COLUMN_NORMAL || isnan(hertz))
            continue;
        *low = any && *low < hertz ? *low : hertz;
        *high = any && *high > hertz ? *high : hertz;
        any = true;
    }
    return any;
}

void model_free(model *m)
{
    ritz_component_free(&m->component);
    ritz_basis_free(&m->basis);
    ritz_reduced_free(&m->reduced);
    ritz_system_free(&m->system);
    ritz_response_free(&m->response);
    ritz_rankings_free(&m->rankings);
    ritz_state_space_free(&m->states);
    ritz_simulation_free(&m->simulation);
    *m = (model){0};
}
