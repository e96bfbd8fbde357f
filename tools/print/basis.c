#include "print/print.h"

#include "base/aside.h"
#include "base/tolerances.h"
#include "linear/ordering.h"

/* "PORT=FILE:PORT": the last ':' ends the file's name. */
static ritz_status split_neighbour(const char *text, ritz_joint *out,
                                   char path[MODEL_PATH])
{
    const char *equals = strchr(text, '=');
    const char *colon = strrchr(text, ':');
    size_t length = equals ? (size_t)(equals - text) : 0;
    size_t size = equals && colon > equals ? (size_t)(colon - equals) : 0;

    RITZ_REFUSE_IF(length == 0 || size <= 1 || colon[1] == '\0',
                   RITZ_ERR_ARGUMENT, "'%s' is not PORT=FILE:PORT", text);
    RITZ_REFUSE_IF(length >= RITZ_NAME_SIZE || size > MODEL_PATH ||
                       strlen(colon + 1) >= RITZ_NAME_SIZE,
                   RITZ_ERR_ARGUMENT, "'%.60s...' has too long a name", text);
    snprintf(out->between[0].port, RITZ_NAME_SIZE, "%.*s", (int)length, text);
    snprintf(out->between[1].port, RITZ_NAME_SIZE, "%s", colon + 1);
    snprintf(path, size, "%s", equals + 1);
    return RITZ_OK;
}

static ritz_status add_neighbour(cli_run *run, const char *text,
                                 const ritz_component *component,
                                 const ritz_dofs *attached, ritz_neighbour *sum)
{
    char path[MODEL_PATH];
    RITZ_OWN(model) far = {0};
    ritz_joint joint = {.type = RITZ_JOINT_FIXED, .name = "neighbour"};

    RITZ_CHECK(split_neighbour(text, &joint, path));
    RITZ_CHECK(model_read(run, path, MODEL_COMPONENT, &far));
    return ritz_joint_neighbour(
        &joint, NULL,
        (ritz_joined[]){{run->operand[1], component}, {path, &far.component}},
        0, attached, sum);
}

static ritz_status read_neighbours(cli_run *run, const cli_list *list,
                                   const ritz_component *component,
                                   const ritz_dofs *attached,
                                   ritz_neighbour *out)
{
    RITZ_OWN(ritz_neighbour) sum = {0};

    RITZ_CHECK(ritz_neighbour_new(attached->count, &sum));
    for (int k = 0; k < list->count; k++)
        RITZ_CHECK_IN("--neighbour", add_neighbour(run, list->text[k],
                                                   component, attached, &sum));
    RITZ_MOVE(*out, sum);
    return RITZ_OK;
}

/* Frequencies and residuals stand side by side: one of each for each mode. */
static void say_basis(cli_run *run, const ritz_basis *basis)
{
    const ritz_columns *c = &basis->columns;
    double worst = (double)NAN;

    SINK_EACH(run, "residuals", k, c->count) {
        if (isnan(c->hertz[k]))
            continue;
        sink_add(run, "%g", c->residual[k]);
        worst = fmax(worst, c->residual[k]);
    }
    sink_error_bounds(run, c);
    if (!isnan(worst)) {
        cli_say(run, "  %-14s %.1e relative, of the worst mode", "residual",
                worst);
        cli_record_error(run, "residual", worst);
    }
    if (basis->remark[0])
        sink_field(run, "note", "note", "%s", basis->remark);
    sink_set(run, "vectors", "%ld", c->count);
    cli_record(run, basis->origin.method, c->count);
}

/* Refuse a state space for this method, and name the methods that take one. */
static ritz_status refuse_space(const char *path, const ritz_method *method)
{
    char names[256] = "";

    for (const ritz_method *const *m = ritz_methods; *m; m++)
        if ((*m)->uses & RITZ_USES_SPACE)
            sink_append(names, sizeof names, "%s%s", *names ? ", " : "",
                        (*m)->name);
    return ritz_fail(RITZ_ERR_ARGUMENT,
                     "'%s' holds a state space, not a component, which alone "
                     "%s takes; methods that take a state space: %s",
                     path, method->name, names);
}

/* Read the model to be reduced, of a kind that the method takes. */
static ritz_status read_full(cli_run *run, const char *path,
                             const basis_options *given, model *out)
{
    const ritz_method *method = given->method;
    bool space = method->uses & RITZ_USES_SPACE;
    model_kind kind = MODEL_ANY;
    const char *noun = NULL;

    if (given->read)
        return given->read(run, path, out);
    if (!space && ritz_container_seems(path)) {
        RITZ_CHECK(model_peek(path, &kind, &noun));
        if (kind == MODEL_STATES)
            return refuse_space(path, method);
    }
    RITZ_CHECK(model_read(run, path,
                          MODEL_COMPONENT | MODEL_REDUCED | MODEL_SYSTEM |
                              (space ? MODEL_STATES : 0),
                          out));
    return model_as_component(out, path, &given->model);
}

/* Refuse ports of a reduced component: several coordinates move such a port,
   and none of them can be attached in its place. */
static ritz_status check_ports(const char *path, const model *full,
                               const basis_options *given)
{
    const bool attaches = given->method->uses & RITZ_USES_ATTACHED;
    const bool refused = given->ports ? *given->ports != '\0' : attaches;

    RITZ_REFUSE_IF(full->reduced.num_ports > 0 && refused, RITZ_ERR_ARGUMENT,
                   "'%s' is a reduced component, whose ports are no dofs that "
                   "%s could attach: --attach '' leaves them free",
                   path, given->method->name);
    return RITZ_OK;
}

/* Relative gap of value k to the one above it; 1 at either end. */
static double gap_above(int64_t count, const double *value, int64_t k)
{
    return k > 0 && k < count ? 1.0 - value[k] / value[k - 1] : 1.0;
}

/*
 * A lightly damped mode has two states of nearly equal value. A cut between the
 * two, whose gap is narrower than those on both sides, keeps half of the mode,
 * which is a real pole. Equal values are never cut: fewer states than asked for
 * are kept then.
 */
static void warn_of_split(cli_run *run, const ritz_basis *basis, int64_t kept,
                          double tolerance)
{
    const int64_t n = basis->num_hankel;
    const double *s = basis->hankel;
    const double gap = kept > 0 ? gap_above(n, s, kept) : 1.0;
    int64_t first = kept - 1, end = kept + 1;

    if (!basis->states || !(gap > RITZ_CLUSTER_GAP) || gap > RITZ_HANKEL_PAIR ||
        s[kept - 1] < tolerance * s[0])
        return;
    while (first > 0 && gap_above(n, s, first) <= RITZ_CLUSTER_GAP)
        first--;
    while (end < n && gap_above(n, s, end) <= RITZ_CLUSTER_GAP)
        end++;
    if (gap < gap_above(n, s, first) && gap < gap_above(n, s, end))
        cli_warn(run,
                 "values %ld and %ld are nearly equal, %.4g and %.4g, as those "
                 "of the two states of a mode are: --modes %ld splits them",
                 kept, kept + 1, s[kept - 1], s[kept], kept);
}

/* Configuration at which a system was read as this model; NULL: no system. */
static const char *name_configuration(const model *full)
{
    const ritz_origin *origin = &full->reduced.origin;

    return strcmp(origin->method, "system") == 0 ? origin->options : NULL;
}

/* A basis stores the configuration at which it was made, as "modes 12, at
   clock=60", unless its options leave no room. */
static const char configuration_mark[] = ", at ";

static void sign_configuration(const model *full, ritz_origin *origin)
{
    const char *at = name_configuration(full);
    const size_t used = strlen(origin->options);
    const size_t room = sizeof origin->options - used;
    const char *mark = configuration_mark + (used > 0 ? 0 : strlen(", "));

    if (at && strlen(mark) + strlen(at) < room)
        snprintf(origin->options + used, room, "%s%s", mark, at);
}

/* The configuration at which a basis was made; NULL: not stored. */
static const char *find_configuration(const char *options)
{
    const char *mark = strstr(options, configuration_mark);
    const char *alone = configuration_mark + strlen(", ");

    if (mark)
        return mark + strlen(configuration_mark);
    return strncmp(options, alone, strlen(alone)) == 0 ? options + strlen(alone)
                                                       : NULL;
}

/* A basis made at one configuration of a system has the size of all others, but
   is for this one only. */
static ritz_status check_configuration(const cli_run *run, const model *full,
                                       const ritz_basis *basis)
{
    const char *at = name_configuration(full);
    const char *made = find_configuration(basis->origin.options);

    RITZ_REFUSE_IF(at && made && strcmp(at, made) != 0, RITZ_ERR_ARGUMENT,
                   "'%s' was made at %s, not at %s", run->operand[1], made, at);
    return RITZ_OK;
}

/* Repeat the beginning of the basis' remark as a warning if it says that a pair
   of modes is cut. */
static void warn_of_pair(cli_run *run, const ritz_basis *basis)
{
    static const char cut[] = " splits them";
    const char *end = strstr(basis->remark, cut);

    if (end)
        cli_warn(run, "%.*s%s", (int)(end - basis->remark), basis->remark, cut);
}

/* The largest file of numbers beside the output, if there was one. */
static void describe_disk(cli_run *run)
{
    if (ritz_disk_used() > 0)
        sink_field(run, "disk", "disk_bytes",
                   "%ld bytes in '%s' held what memory did not",
                   ritz_disk_used(), ritz_disk_folder());
}

ritz_status basis_run(cli_run *run, basis_options *given)
{
    const char *path = run->operand[1];
    const ritz_method *method = given->method;
    ritz_request *request = &given->request;
    RITZ_OWN(model) m = {0};
    RITZ_OWN(ritz_dofs) attached = {0};
    RITZ_OWN(ritz_neighbour) neighbour = {0};
    RITZ_OWN(model) made = {.kind = MODEL_BASIS};

    cli_record(run, method->name, -1);
    RITZ_CHECK(read_full(run, path, given, &m));
    RITZ_CHECK(check_ports(path, &m, given));
    if (m.kind == MODEL_STATES)
        request->space = &m.states;
    else
        request->component = request->owned = &m.component;
    if (request->component && method->uses & RITZ_USES_ATTACHED)
        RITZ_CHECK_IN(path, ritz_component_attached(&m.component, given->ports,
                                                    &attached));
    request->attached = attached;
    if (given->neighbours.count > 0) {
        RITZ_CHECK(read_neighbours(run, &given->neighbours, &m.component,
                                   &attached, &neighbour));
        request->neighbour = &neighbour;
    }
    RITZ_CHECK_IN(path, ritz_basis_make(method, request, &made.basis));
    memcpy(made.basis.units,
           request->space ? m.states.units : m.component.units,
           sizeof made.basis.units);
    sign_configuration(&m, &made.basis.origin);
    cli_record_engine(run, made.basis.origin.engine, made.basis.origin.reason);
    RITZ_CHECK(describe_output(run, &made));
    describe_disk(run);
    say_basis(run, &made.basis);
    warn_of_split(run, &made.basis, request->modes, request->tolerance);
    warn_of_pair(run, &made.basis);
    return RITZ_OK;
}

/* Without T nobody can recover the full mesh, but the file is small. */
static void drop_basis(ritz_reduced *reduced)
{
    ritz_dense_free(&reduced->T);
    ritz_grids_free(&reduced->grids);
    ritz_elements_free(&reduced->elements);
    ritz_recovery_free(&reduced->recovery);
    free(reduced->dof);
    reduced->dof = NULL;
}

/* Whether project_component() stores T of the basis as it is. */
static bool keeps_vectors(const model *full, const reduce_options *given)
{
    return !given->project && full->reduced.num_ports == 0 &&
           !full->reduced.T.val;
}

/* Reduce a component by a basis. A model that was reduced before is projected
   again, so that its ports and shapes follow. */
static ritz_status project_component(const model *full, const ritz_basis *basis,
                                     const reduce_options *given,
                                     ritz_reduced *out)
{
    if (given->project)
        return given->project(&full->component, basis, out);
    if (keeps_vectors(full, given))
        return ritz_reduce(&full->component, basis, out);
    RITZ_CHECK(ritz_reduced_project(&full->reduced, &basis->T, out));
    ritz_columns_free(&out->columns);
    RITZ_CHECK(ritz_columns_pick(&basis->columns, basis->columns.count, NULL,
                                 &out->columns));
    for (int64_t j = 0; j < out->columns.count; j++)
        out->columns.dof[j] = -1;
    out->origin = basis->origin;
    return RITZ_OK;
}

static bool asked_for(const reduce_options *given, const char *estimates)
{
    return given->estimates && strcmp(given->estimates, estimates) == 0;
}

/* An order of the rows of a model's factors. It is found by another thread while
   the basis is read and projected on, and is the one that ritz_estimate() would
   find. */
typedef struct early_order {
    const ritz_component *full; /* borrowed */
    ritz_orders *orders;        /* NULL: none is found early */
    ritz_aside aside;
} early_order;

/* A failure is that of the estimate, which looks for an order again. */
static void find_order(void *task)
{
    const early_order *e = task;
    [[maybe_unused]] RITZ_OWN(ritz_orders_lent) lent =
        ritz_orders_lend(e->orders);
    RITZ_OWN(ritz_sparse) sum = {0};
    RITZ_OWN_ARRAY int64_t *order = NULL;

    if (ritz_sparse_add(1.0, &e->full->K, 1.0, &e->full->M, &sum) == RITZ_OK)
        (void)ritz_ordering_new(&sum, &order);
}

static ritz_status begin_order(const model *full, const reduce_options *given,
                               early_order *out)
{
    const ritz_component *component = &full->component;

    if (full->kind == MODEL_STATES || asked_for(given, "none") ||
        component->num_dofs < RITZ_ORDER_FROM || given->project)
        return RITZ_OK;
    out->full = component;
    RITZ_CHECK(ritz_orders_new(&out->orders));
    ritz_aside_begin(find_order, out, true, &out->aside);
    return RITZ_OK;
}

static void early_order_free(early_order *e)
{
    ritz_aside_end(&e->aside);
    ritz_orders_free(&e->orders);
}

/* Estimates of a model with the T that it stores, where that is the one of the
   basis, whose own copy is freed. */
static ritz_status estimate_model(const model *full, ritz_basis *basis,
                                  const reduce_options *given,
                                  early_order *early, ritz_reduced *reduced)
{
    [[maybe_unused]] RITZ_OWN(ritz_orders_lent) lent =
        ritz_orders_lend(early->orders);
    ritz_basis made = *basis;

    if (keeps_vectors(full, given)) {
        ritz_dense_free(&basis->T);
        made.T = reduced->T;
    }
    ritz_aside_end(&early->aside);
    return ritz_estimate(&full->component, &made, &given->estimate, reduced);
}

/* Compute mode acceleration if it is requested; refuse a model that was reduced
   before, since its full matrices are gone. */
static ritz_status correct_rows(cli_run *run, const model *full,
                                const ritz_basis *basis,
                                const reduce_options *given,
                                ritz_reduced *reduced)
{
    ritz_mode_accelerations made = {0};

    if (!given->recovery || strcmp(given->recovery, "acceleration") != 0)
        return RITZ_OK;
    RITZ_REFUSE_IF(given->project, RITZ_ERR_ARGUMENT,
                   "--recovery acceleration factors K, which --engine slepc "
                   "does not do");
    RITZ_REFUSE_IF(full->reduced.K.val, RITZ_ERR_ARGUMENT,
                   "'%s' was reduced before: it keeps the mode acceleration "
                   "that it has, and gets no other",
                   run->operand[0]);
    RITZ_CHECK_IN(run->operand[0], ritz_mode_acceleration(
                                       &full->component, &basis->T,
                                       given->recovery_ports, reduced, &made));
    sink_set(run, "mode_accelerations,free_motions,rigid_rows", "%ld %ld %g",
             made.count, made.motions, made.rigid);
    if (*made.reason)
        cli_warn(run, "%ld of %ld quantities have no mode acceleration: %s",
                 reduced->num_quantities - made.count, reduced->num_quantities,
                 made.reason);
    return RITZ_OK;
}

static ritz_status reduce_to_matrices(cli_run *run, const model *full,
                                      ritz_basis *basis,
                                      const reduce_options *given,
                                      early_order *early)
{
    const char *what = run->operand[1];
    RITZ_OWN(model) made = {.kind = MODEL_REDUCED};
    ritz_reduced *reduced = &made.reduced;
    const ritz_columns *c = &reduced->columns;

    RITZ_CHECK_IN(what, project_component(full, basis, given, reduced));
    RITZ_CHECK(correct_rows(run, full, basis, given, reduced));
    if (!asked_for(given, "none"))
        RITZ_CHECK_IN(what, estimate_model(full, basis, given, early, reduced));
    if (given->without_basis)
        drop_basis(reduced);
    RITZ_CHECK(describe_output(run, &made));
    describe_disk(run);
    sink_set(run, "vectors", "%ld", c->count);
    SINK_EACH(run, "residuals", k, c->count)
        if (!isnan(c->residual[k]))
            sink_add(run, "%g", c->residual[k]);
    cli_record(run, reduced->origin.method, reduced->K.nrow);
    model_record(run, &reduced->estimates);
    return RITZ_OK;
}

/* A model of either kind, in a basis that makes states of it. */
static ritz_status project_model(const model *full, const ritz_basis *basis,
                                 ritz_state_space *out)
{
    ritz_damping damping = {0};

    if (full->kind == MODEL_STATES)
        return ritz_reduce_space(&full->states, basis, out);
    RITZ_CHECK(ritz_damping_parse(basis->damping, &damping));
    return (basis->states ? ritz_reduce_states : ritz_reduce_companion)(
        &full->component, &damping, basis, out);
}

/* A reduced state space has its stability and, of some methods, an error bound
   among its estimates. */
static ritz_status reduce_to_states(cli_run *run, const model *full,
                                    const ritz_basis *basis)
{
    const char *what = run->operand[1];
    RITZ_OWN(model) made = {.kind = MODEL_STATES};
    ritz_state_space *states = &made.states;
    ritz_probe probe = {0};
    char text[2 * RITZ_NAME_SIZE];

    model_warn_loads(run, run->operand[0], full->component.num_loads);
    RITZ_CHECK_IN(what, project_model(full, basis, states));
    RITZ_CHECK_IN(what, ritz_probe_states(states, &probe));
    RITZ_CHECK(ritz_probe_record(&probe, &states->estimates));
    RITZ_CHECK(describe_output(run, &made));
    sink_set(run, "vectors", "%ld", states->columns.count);
    cli_record(run, states->origin.method, ritz_state_space_order(states));
    model_record(run, &states->estimates);
    ritz_probe_print(&probe, text);
    if (probe.verdict == RITZ_UNSTABLE)
        cli_warn(run, "'%s' is unstable: %s", run->output, text);
    return RITZ_OK;
}

/* Refuse a basis that was made for another number of dofs or states. */
static ritz_status check_rows(const cli_run *run, const model *full,
                              const ritz_basis *basis)
{
    bool space = full->kind == MODEL_STATES;
    int64_t due = ritz_model_order(model_reference(full));
    int64_t rows = basis->T.nrow / (basis->states && !space ? 2 : 1);

    RITZ_REFUSE_IF(space && !basis->states, RITZ_ERR_ARGUMENT,
                   "'%s' is a basis of displacements, '%s' is a state space",
                   run->operand[1], run->operand[0]);
    RITZ_REFUSE_IF(rows != due, RITZ_ERR_ARGUMENT,
                   "'%s' is a basis for %ld %s, '%s' has %ld", run->operand[1],
                   rows, space ? "states" : "dofs", run->operand[0], due);
    return RITZ_OK;
}

ritz_status reduce_run(cli_run *run, reduce_options *given)
{
    const char *what = run->operand[1];
    RITZ_OWN(model) full = {0};
    RITZ_OWN(model) basis = {0};
    RITZ_OWN(early_order) early = {0}; /* after full, which it borrows */

    if (given->read) {
        RITZ_CHECK(given->read(run, run->operand[0], &full));
    } else {
        RITZ_CHECK(model_read(run, run->operand[0], MODEL_DYNAMIC, &full));
        RITZ_CHECK(model_as_component(&full, run->operand[0], &given->model));
    }
    RITZ_CHECK(begin_order(&full, given, &early));
    RITZ_CHECK(model_read(run, what, MODEL_BASIS, &basis));
    RITZ_CHECK(check_rows(run, &full, &basis.basis));
    RITZ_CHECK(check_configuration(run, &full, &basis.basis));
    RITZ_CHECK(
        model_damping(&full, given->model.damping, &given->estimate.damping));
    RITZ_REFUSE_IF(
        given->without_basis && full.kind == MODEL_STATES, RITZ_ERR_ARGUMENT,
        "a reduced state space keeps no basis, --without-basis is for "
        "components");
    if (given->recovery_ports &&
        (!given->recovery || strcmp(given->recovery, "acceleration") != 0))
        cli_refuse(run->program,
                   "--recovery-ports are of --recovery acceleration");
    given->estimate.frequencies = asked_for(given, "frequency");
    if (full.kind == MODEL_STATES || basis.basis.states || basis.basis.W.val) {
        RITZ_REFUSE_IF(given->estimates || given->recovery, RITZ_ERR_ARGUMENT,
                       "'%s' reduces to a state space, --estimates and "
                       "--recovery are for components",
                       what);
        return reduce_to_states(run, &full, &basis.basis);
    }
    return reduce_to_matrices(run, &full, &basis.basis, given, &early);
}
