#include "print/print.h"

#include "cli/libexec.h"

RITZ_ARRAY_OF(ritz_dense);
RITZ_ARRAY_OF(model);

enum { SUM_SIZE = 2 * RITZ_WHERE_SIZE + RITZ_NAME_SIZE + 8 };

/* A matrix as its text has it: a reader of the file integrates the rounded
   matrices, so these are checked. */
static ritz_status copy_rounded(const ritz_export_request *request,
                                const ritz_dense *A, ritz_dense *out)
{
    char text[40];
    bool exact = !request->text || request->digits == 0 || request->digits > 16;

    if (!A->val)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_copy(A, out));
    for (int64_t k = 0; !exact && k < A->nrow * A->ncol; k++) {
        snprintf(text, sizeof text, "%.*e", (int)request->digits - 1,
                 A->val[k]);
        out->val[k] = strtod(text, NULL);
    }
    return RITZ_OK;
}

/* Stability checks of what will be written, a reduced component or states. */
static ritz_status audit_rounded(const model *m,
                                 const ritz_export_request *request,
                                 ritz_audit *out)
{
    enum { PARTS = 6 };
    model rounded = *m; /* borrowed but for these */
    ritz_dense *const part[PARTS] = {&rounded.reduced.K, &rounded.reduced.M,
                                     &rounded.reduced.D, &rounded.reduced.K4,
                                     &rounded.states.A,  &rounded.states.E};
    RITZ_OWN(ritz_dense_array) copy = {.count = PARTS};

    RITZ_CHECK_NEW(copy.at, copy.count);
    for (int64_t k = 0; k < copy.count; k++) {
        RITZ_CHECK(copy_rounded(request, part[k], &copy.at[k]));
        *part[k] = copy.at[k];
    }
    return m->kind == MODEL_STATES ? ritz_audit_states(&rounded.states, out)
                                   : ritz_audit_reduced(&rounded.reduced, out);
}

/* The verdict, and its reason: the pole nearest to instability, or the first
   check that fails. */
static void sum_up(const ritz_audit *audit, const char **verdict,
                   char text[SUM_SIZE])
{
    const ritz_check *first = checks_first(audit);

    *verdict = first ? "unstable" : "stable";
    text[0] = '\0';
    if (first)
        snprintf(text, SUM_SIZE, "%s (%s%s%s)", first->says, first->name,
                 *first->where ? ", " : "", first->where);
    for (int64_t k = 0; !first && k < audit->count; k++)
        if (strcmp(audit->check[k].name, "poles") == 0) {
            snprintf(text, SUM_SIZE, "%s", audit->check[k].where);
            /* on the axis to rounding */
            if (fabs(audit->check[k].value) <= audit->check[k].limit)
                *verdict = "marginal";
        }
}

/* Refuse to export a model that is unstable, alone or in an assembly, and one
   of a method that does not preserve stability, unless --force is given. */
static ritz_status check_stability(cli_run *run, const model *m,
                                   const export_options *given)
{
    static const char unproven[] = "lanczos-two-sided";
    const char *method = m->kind == MODEL_STATES ? m->states.origin.method
                                                 : m->reduced.origin.method;
    RITZ_OWN(ritz_audit) audit = {0};
    bool fails = false, force = given->force;
    const char *verdict = NULL;
    char text[SUM_SIZE];

    RITZ_CHECK_IN(run->operand[0], audit_rounded(m, &given->request, &audit));
    fails = checks_first(&audit) != NULL;
    sum_up(&audit, &verdict, text);
    sink_set(run, "stability", "%s", verdict);
    checks_say(run, "probe", &audit);
    RITZ_REFUSE_IF(fails && !force, RITZ_ERR_ARGUMENT,
                   "'%s' is unstable: %s; export it all the same with --force",
                   run->operand[0], text);
    RITZ_REFUSE_IF(strcmp(method, unproven) == 0 && !force, RITZ_ERR_ARGUMENT,
                   "'%s' was made by %s, which promises no stability (now %s: "
                   "%s); export it all the same with --force",
                   run->operand[0], method, verdict, text);
    if (fails)
        cli_warn(run, "'%s' is unstable: %s", run->operand[0], text);
    else
        cli_say(run, "%s: %s", verdict, text);
    for (int64_t k = 0; k < audit.count; k++)
        if (audit.check[k].verdict == RITZ_WARN)
            cli_warn(run, "%s (%s, %s)", audit.check[k].says,
                     audit.check[k].name, audit.check[k].where);
    return RITZ_OK;
}

/* Errors that do not compare a body with its full model, recognised by the
   prefix of their names, and the warning about them. */
typedef struct reference {
    const char *prefix, *word, *by, *warning;
} reference;

static const reference references[] = {
    {"stage1-", "stage-1", "ritz-compare",
     "these are errors of stage two against stage one alone"},
    {"system-", "system", "ritz-fit",
     "these are errors of the scene's system, not of this body"},
    {"", "full", "ritz-verify or ritz-fit", NULL},
};

/* The first row whose prefix all names of measures have. */
static const reference *find_reference(const ritz_measures *errors)
{
    const reference *row = references;

    for (int64_t k = 0; k < errors->count;)
        if (strncmp(errors->item[k].name, row->prefix, strlen(row->prefix)) ==
            0) {
            k++;
        } else {
            row++;
            k = 0;
        }
    return row;
}

/* How errors become known: of a system at a configuration against the full one
   of its scene. */
static ritz_status refuse_unknown(const char *path, const ritz_origin *origin)
{
    const bool system = strcmp(origin->method, "system") == 0;
    char at[RITZ_NAME_SIZE + 8] = "";

    if (system && strchr(origin->options, '='))
        snprintf(at, sizeof at, " --at %s", origin->options);
    if (system)
        return ritz_fail(
            RITZ_ERR_ARGUMENT,
            "'%s' carries no measured errors: make its full model with "
            "ritz-assemble --full%s SCENE -o full.h5, measure with ritz-verify "
            "full.h5 %s%s -o verified.h5 and export verified.h5, or export it "
            "all the same with --force",
            path, at, path, at);
    return ritz_fail(
        RITZ_ERR_ARGUMENT,
        "'%s' carries neither estimated nor measured errors: run ritz-verify "
        "FULL %s -o verified.h5 and export verified.h5, or export it all the "
        "same with --force",
        path, path);
}

/* Say which errors are known; refuse a model of unknown errors unless it is
   forced. */
static ritz_status say_errors(cli_run *run, const ritz_origin *origin,
                              const ritz_measures *errors,
                              const ritz_measures *estimates, bool force)
{
    const char *rests = errors->count > 0      ? "measured"
                        : estimates->count > 0 ? "estimated"
                                               : "unknown";
    const ritz_measures *known = errors->count > 0 ? errors : estimates;
    const reference *of = find_reference(known);

    sink_set(run, "errors_rest_on", "%s", rests);
    if (known->count == 0)
        model_say_measures(run, SINK_NONE, "errors", known, rests);
    if (known->count == 0 && !force)
        return refuse_unknown(run->operand[0], origin);
    if (known->count == 0) {
        cli_warn(run, "nothing is known of the errors of '%s'",
                 run->operand[0]);
        return RITZ_OK;
    }
    sink_set(run, "errors_against", "%s", of->word);
    cli_say(run, "errors %s by %s:", rests,
            errors->count > 0 ? of->by : "ritz-reduce, not verified");
    model_say_measures(run, SINK_LINE, "errors", known, rests);
    for (int64_t k = 0; k < known->count; k++) {
        model_record_measure(run, &known->item[k]);
        if (!ritz_measure_holds(&known->item[k]))
            cli_warn(run, "'%s' does not meet its limit", known->item[k].name);
    }
    if (of->warning)
        cli_warn(run,
                 "%s: ritz-verify measures '%s' against its full component",
                 of->warning, run->operand[0]);
    return RITZ_OK;
}

/* Refuse columns that are forces at an interface: other programs join bodies by
   displacements. macneal-rubin makes the same columns as displacements. */
static ritz_status check_forces(cli_run *run, const ritz_columns *columns,
                                bool force)
{
    static const char sentence[] =
        "'%s' has columns for a joint by forces, which no other code makes of "
        "them: export the same made by macneal-rubin";
    bool any = false;

    for (int64_t k = 0; k < columns->count; k++)
        any = any || columns->kind[k] == RITZ_COLUMN_FORCE;
    RITZ_REFUSE_IF(any && !force, RITZ_ERR_ARGUMENT, sentence, run->operand[0]);
    if (any)
        cli_warn(run, sentence, run->operand[0]);
    return RITZ_OK;
}

/* What is known of a reduced component, and whether it may be exported. */
static ritz_status check_reduced(cli_run *run, const model *m,
                                 const export_options *given)
{
    const ritz_reduced *reduced = &m->reduced;
    bool force = given->force;

    for (int64_t j = 0; j < reduced->dampers.count; j++)
        cli_say(run, "damper '%s' installed: c = %g, k = %g",
                reduced->dampers.name[j], reduced->dampers.c[j],
                reduced->dampers.k[j]);
    RITZ_CHECK(say_errors(run, &reduced->origin, &reduced->errors,
                          &reduced->estimates, force));
    RITZ_CHECK(check_forces(run, &reduced->columns, force));
    return check_stability(run, m, given);
}

/* An imported state space is no reduction and has no errors; some reductions
   have no estimate but that of stability. */
static ritz_status say_state_errors(cli_run *run,
                                    const ritz_state_space *states, bool force)
{
    bool bounded = false;

    if (!*states->origin.method && states->errors.count == 0)
        return RITZ_OK;
    for (int64_t k = 0; k < states->estimates.count; k++)
        bounded = bounded || strcmp(states->estimates.item[k].name,
                                    "growth-relative") != 0;
    if (states->errors.count > 0 || bounded)
        return say_errors(run, &states->origin, &states->errors,
                          &states->estimates, force);
    cli_warn(run, "nothing is known of the errors of '%s' but its stability",
             run->operand[0]);
    return RITZ_OK;
}

static ritz_status find_basis_shapes(cli_run *run, const ritz_basis *basis,
                                     const export_options *given,
                                     ritz_shapes *out)
{
    RITZ_OWN(model) of = {0};

    RITZ_REFUSE_IF(given->component.count != 1, RITZ_ERR_ARGUMENT,
                   "'%s' is a basis, which knows no places: name its component "
                   "with --component",
                   run->operand[0]);
    RITZ_CHECK(model_read(run, given->component.text[0], MODEL_COMPONENT, &of));
    return ritz_shapes_of_basis(basis, &of.component, given->request.modes,
                                out);
}

/* The file of body `name` among texts "BODY=FILE"; NULL: not given. */
static const char *find_body(const export_options *given, const char *name)
{
    const size_t length = strlen(name);

    for (int k = 0; k < given->component.count; k++) {
        const char *text = given->component.text[k];

        if (strncmp(text, name, length) == 0 && text[length] == '=')
            return text + length + 1;
    }
    return NULL;
}

/* The reduced components that --component names, of all bodies of a system. */
typedef struct export_bodies {
    model_array of;
    const ritz_reduced **reduced; /* borrowed from these */
} export_bodies;

static void export_bodies_free(export_bodies *bodies)
{
    model_array_free(&bodies->of);
    free(bodies->reduced);
}

static ritz_status read_bodies(cli_run *run, const ritz_system *system,
                               const export_options *given, export_bodies *out)
{
    const int64_t count = system->num_components;

    out->of.count = count;
    RITZ_CHECK_NEW(out->of.at, count);
    // NOLINTNEXTLINE(bugprone-sizeof-expression): an array of pointers
    RITZ_CHECK_NEW(out->reduced, count);
    for (int64_t c = 0; c < count; c++) {
        const char *name = system->component[c].name;
        const char *path = find_body(given, name);

        RITZ_REFUSE_IF(!path, RITZ_ERR_ARGUMENT,
                       "a system holds no grids, its shapes and ports are "
                       "those of its bodies: name the reduced component of "
                       "'%s' with --component %s=FILE",
                       name, name);
        RITZ_CHECK(model_read(run, path, MODEL_REDUCED, &out->of.at[c]));
        out->reduced[c] = &out->of.at[c].reduced;
    }
    RITZ_REFUSE_IF(given->component.count != count, RITZ_ERR_ARGUMENT,
                   "%d bodies are named by --component, there are %ld",
                   given->component.count, (long)count);
    return RITZ_OK;
}

/* Modes of a system on the grids of its bodies. */
static ritz_status find_system_shapes(cli_run *run, const model *m,
                                      const export_options *given,
                                      ritz_shapes *out)
{
    RITZ_OWN(export_bodies) bodies = {0};

    RITZ_CHECK(read_bodies(run, &m->system, given, &bodies));
    return ritz_shapes_of_system(&m->system, m->at, bodies.reduced,
                                 given->request.modes, out);
}

/* A system at a configuration, with the ports of its bodies. */
static ritz_status place_ports(cli_run *run, model *m,
                               const export_options *given)
{
    const char *path = run->operand[0];
    const ritz_configuration *at = NULL;
    RITZ_OWN(export_bodies) bodies = {0};

    RITZ_CHECK(model_at(m, path, given->model.at));
    at = m->at;
    RITZ_CHECK(read_bodies(run, &m->system, given, &bodies));
    RITZ_CHECK(model_as_reduced(m, path, &given->model));
    return ritz_context(
        ritz_reduced_place_ports(&m->system, at, bodies.reduced, &m->reduced),
        path);
}

/* Shapes to export: modes of a reduced component, of a component or of a
   system, or columns of a basis. */
static ritz_status find_shapes(cli_run *run, const model *m,
                               const export_options *given, ritz_shapes *out)
{
    const char *modes = given->request.modes;

    if (m->kind == MODEL_SYSTEM)
        return find_system_shapes(run, m, given, out);
    RITZ_REFUSE_IF(given->component.count > 0 && m->kind != MODEL_BASIS,
                   RITZ_ERR_ARGUMENT,
                   "--component is for a basis or a system, '%s' knows its "
                   "places",
                   run->operand[0]);
    if (m->kind == MODEL_BASIS)
        return find_basis_shapes(run, &m->basis, given, out);
    return m->kind == MODEL_COMPONENT
               ? ritz_shapes_of_component(&m->component, modes, out)
               : ritz_shapes_of_reduced(&m->reduced, modes, out);
}

/* Kinds of model that an exporter takes, summed. */
static int kinds_of(const ritz_exporter *exporter)
{
    static const struct {
        int takes, kinds;
    } rows[] = {
        {RITZ_EXPORT_REDUCED, MODEL_REDUCED | MODEL_SYSTEM},
        {RITZ_EXPORT_STATES, MODEL_STATES},
        {RITZ_EXPORT_RESPONSE, MODEL_RESPONSE},
        {RITZ_EXPORT_SIMULATION, MODEL_SIMULATION},
        {RITZ_EXPORT_SHAPES,
         MODEL_REDUCED | MODEL_SYSTEM | MODEL_COMPONENT | MODEL_BASIS},
    };
    int kinds = 0;

    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        kinds |= exporter->takes & rows[k].takes ? rows[k].kinds : 0;
    return kinds;
}

/* The folder in which the program of FMUs is installed. */
static ritz_status find_runtime(char folder[PATH_MAX])
{
    RITZ_CHECK(libexec_find("ritz_fmu.so", folder));
    *strrchr(folder, '/') = '\0';
    return RITZ_OK;
}

/* Check the model, say what is known of it, and have the exporter write it. */
static ritz_status export_model(cli_run *run, model *m,
                                const export_options *given,
                                ritz_export_report *done)
{
    const ritz_exporter *exporter = given->exporter;
    ritz_export_object object = {0};
    ritz_export_request request = given->request;
    char runtime[PATH_MAX] = "";
    RITZ_OWN(ritz_shapes) shapes = {0};
    RITZ_OWN(ritz_summary) summary = {0};
    ritz_stamp stamp = {0};

    if (m->kind == MODEL_RESPONSE) {
        object.response = &m->response;
    } else if (m->kind == MODEL_SIMULATION) {
        object.simulation = &m->simulation;
    } else if (m->kind == MODEL_STATES) {
        cli_record(run, exporter->name, ritz_state_space_order(&m->states));
        RITZ_CHECK(check_stability(run, m, given));
        RITZ_CHECK(say_state_errors(run, &m->states, given->force));
        object.states = &m->states;
    } else if (exporter->takes & RITZ_EXPORT_SHAPES) {
        RITZ_CHECK_IN(run->operand[0], model_install(m, &given->model.damper));
        sink_list(run, "shapes");
        RITZ_CHECK_IN(run->operand[0], find_shapes(run, m, given, &shapes));
        sink_end(run);
        sink_names(run, NULL, "shapes", shapes.count, shapes.name);
        cli_record(run, exporter->name, shapes.count);
        object.shapes = &shapes;
        object.reduced = m->kind == MODEL_REDUCED ? &m->reduced : NULL;
    } else {
        cli_record(run, exporter->name, m->reduced.K.nrow);
        RITZ_CHECK_IN(run->operand[0], model_install(m, &given->model.damper));
        RITZ_CHECK(check_reduced(run, m, given));
        object.reduced = &m->reduced;
    }
    stamp = *cli_stamp(run);
    RITZ_CHECK(ritz_container_summary(run->operand[0], &summary));
    stamp.source = summary.command;
    request.stamp = &stamp;
    if (exporter->takes & RITZ_EXPORT_FMI) {
        RITZ_CHECK(find_runtime(runtime));
        request.runtime = runtime;
    }
    return ritz_export_write(exporter, &object, &request, done);
}

/* Add the damping that is asked for and, with --states, make a state space. */
static ritz_status settle_damping(cli_run *run, model *m,
                                  const export_options *given)
{
    const char *path = run->operand[0];
    const char *text = given->model.damping;

    RITZ_REFUSE_IF((text || given->states) && m->kind != MODEL_REDUCED,
                   RITZ_ERR_ARGUMENT,
                   "'%s' is neither a reduced component nor a system: %s is "
                   "not for it",
                   path, given->states ? "--states" : "--damping");
    if (m->kind != MODEL_REDUCED)
        return RITZ_OK;
    RITZ_CHECK(model_damping(m, text, &m->damping));
    if (text)
        ritz_damping_print(&m->damping, m->reduced.damping);
    if (!given->states)
        return RITZ_OK;
    model_warn_loads(run, path, m->reduced.num_loads);
    RITZ_CHECK_IN(path, model_install(m, &given->model.damper));
    RITZ_CHECK_IN(path,
                  ritz_states_of_reduced(&m->reduced, &m->damping, &m->states));
    m->kind = MODEL_STATES;
    return RITZ_OK;
}

/* Refuse a system for formats that take neither states, nor shapes, nor the
   ports of its bodies. */
static ritz_status check_kind(const model *m, const char *path,
                              const ritz_exporter *exporter)
{
    RITZ_REFUSE_IF(
        m->kind == MODEL_SYSTEM &&
            !(exporter->takes &
              (RITZ_EXPORT_STATES | RITZ_EXPORT_SHAPES | RITZ_EXPORT_PORTS)),
        RITZ_ERR_ARGUMENT,
        "'%s' is a system, and %s wants a body with its grids: export the "
        "bodies, which ritz-compare, ritz-assemble and ritz-fit write by "
        "--components",
        path, exporter->name);
    return RITZ_OK;
}

/* What the exporter did; a line that begins so is a warning. */
static void say_report(cli_run *run, const ritz_export_report *done)
{
    static const char warning[] = "warning: ";

    SINK_EACH(run, "said", k, done->count) {
        const char *line = done->line[k];

        if (strncmp(line, warning, strlen(warning)) == 0)
            cli_warn(run, "%s", line + strlen(warning));
        else
            cli_say(run, "  %s", line);
        sink_add(run, "%s", line);
    }
}

ritz_status export_run(cli_run *run, const export_options *given)
{
    const char *path = run->operand[0];
    RITZ_OWN(model) m = {0};
    RITZ_OWN(ritz_export_report) done = {0};

    sink_set(run, "format", "%s", given->exporter->name);
    sink_list(run, "said");
    sink_end(run);
    cli_record(run, given->exporter->name, -1);
    RITZ_CHECK(model_read(run, path, kinds_of(given->exporter), &m));
    RITZ_CHECK(check_kind(&m, path, given->exporter));
    if (given->exporter->takes & RITZ_EXPORT_SHAPES && m.kind == MODEL_SYSTEM)
        RITZ_CHECK(model_at(&m, path, given->model.at));
    else if (given->exporter->takes & RITZ_EXPORT_PORTS &&
             m.kind == MODEL_SYSTEM)
        RITZ_CHECK(place_ports(run, &m, given));
    else
        RITZ_CHECK(model_as_reduced(&m, path, &given->model));
    RITZ_CHECK(settle_damping(run, &m, given));
    RITZ_CHECK(export_model(run, &m, given, &done));
    cli_say(run, "%s: %s", run->output, given->exporter->summary);
    say_report(run, &done);
    return RITZ_OK;
}
