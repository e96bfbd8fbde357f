/* Runs in which the constraints between bodies of a scene are enforced. */
#include "print/simulation.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <inttypes.h>
#include <string.h>

/* Number of redundant rows whose names are printed. */
enum { MOST_NAMES = 6 };

/* Round values to some digits, as if they came from a file. */
static void round_values(int64_t digits, int64_t n, double *x)
{
    char text[64];

    for (int64_t k = 0; k < n; k++) {
        (void)snprintf(text, sizeof text, "%.*e", (int)digits - 1, x[k]);
        (void)ritz_text_real(text, &x[k]);
    }
}

/* q = P y for values y of the system; NULL for NULL. */
static ritz_status find_start(const simulation_options *given,
                              const ritz_unjoined *bodies, const double *y,
                              double **out)
{
    RITZ_OWN(ritz_dense) q = {0};
    RITZ_OWN_ARRAY double *copy = NULL;
    ritz_dense from = {bodies->P.ncol, 1, NULL}; /* borrowed */

    if (!y)
        return RITZ_OK;
    RITZ_CHECK_COPY(copy, y, from.nrow);
    from.val = copy;
    RITZ_CHECK(ritz_dense_mul(&bodies->P, &from, &q));
    if (given->start_digits > 0)
        round_values(given->start_digits, q.nrow, q.val);
    RITZ_MOVE(*out, q.val);
    return RITZ_OK;
}

static void say_redundant(cli_run *run, const ritz_unjoined *bodies,
                          const ritz_constrained_facts *facts)
{
    SINK_EACH(run, "redundant", k, facts->num_redundant)
        sink_add(run, "%s", bodies->row[facts->redundant[k]]);
    for (int64_t k = 0; k < facts->num_redundant && k < MOST_NAMES; k++)
        sink_field(run, k == 0 ? "redundant" : "", "", "%s",
                   bodies->row[facts->redundant[k]]);
    if (facts->num_redundant > MOST_NAMES)
        sink_field(run, "", "", "and %ld more",
                   facts->num_redundant - MOST_NAMES);
}

static void say_facts(cli_run *run, const ritz_unjoined *bodies,
                      const ritz_constrained_request *how,
                      const ritz_constrained_facts *facts)
{
    const ritz_stabilisation *method = how->method;

    sink_object(run, "constraints");
    sink_field(run, "constraints", "method,rows,rank",
               "%s, %ld rows of rank %ld", method->name, facts->num_rows,
               facts->rank);
    say_redundant(run, bodies, facts);
    for (int k = 0; k < RITZ_MOST_GAINS && method->gain[k].name; k++)
        sink_field(run, method->gain[k].name, method->gain[k].name, "%.6g%s%s",
                   facts->gain[k], *method->gain[k].unit ? " " : "",
                   method->gain[k].unit);
    sink_field(run, "highest", "highest_hz,joined_hz",
               "%.6g Hz, of the joined bodies %.6g Hz", facts->highest_hz,
               facts->joined_hz);
    sink_field(run, "a step", "step_cost,step_limit",
               "%.3g s of processor time; explicit ones are stable below %.4g "
               "s",
               facts->step_cost, facts->step_limit);
    sink_end(run);
}

static void say_start(cli_run *run, const ritz_constrained_facts *facts)
{
    const double most = fmax(facts->moved, facts->moved_rate);

    if (most > 0.0)
        sink_field(run, "start", "moved,moved_rate",
                   "moved into the constraints: displacements by %.2g of their "
                   "size, velocities by %.2g",
                   facts->moved, facts->moved_rate);
    if (most > RITZ_START_MOVED)
        cli_warn(run,
                 "the start violates the constraints: %s were moved by %.2g %% "
                 "of their size, to the nearest that satisfy them",
                 facts->moved >= facts->moved_rate ? "displacements"
                                                   : "velocities",
                 100.0 * most);
}

static void warn_of_ringing(cli_run *run, double step,
                            const ritz_constrained_facts *facts)
{
    if (facts->unresolved)
        cli_warn(run,
                 "a step of %g s resolves springs up to %.4g Hz: stiffer ones "
                 "ring, and forces with them; --method generalised-alpha --rho "
                 "0 ends that in some steps, index-2 has no springs",
                 step, 1.0 / (RITZ_PI * step));
    if (facts->force_rounding > RITZ_FORCE_ROUNDING)
        cli_warn(run,
                 "springs are so stiff that, after a load jumps, up to %.1e of "
                 "the forces in the joints are rounding; positions are "
                 "accurate",
                 facts->force_rounding);
}

static ritz_status check_scene(const simulation_task *task)
{
    RITZ_REFUSE_IF(task->stage.count == 0, RITZ_ERR_ARGUMENT,
                   "'%s' is no scene: --constraints joins bodies that are not "
                   "joined yet",
                   task->run->operand[0]);
    return RITZ_OK;
}

/* Refuse an integrator that would not be used, and --rho if it has none. */
static ritz_status check_integrator(const simulation_task *task,
                                    const ritz_constrained_request *how)
{
    const ritz_integrator *asked = task->given->integrator;
    const bool given = cli_given(task->run, "method");
    const bool alpha = asked == &ritz_integrator_generalised_alpha;

    RITZ_REFUSE_IF(given && !how->method->integrator && !alpha,
                   RITZ_ERR_ARGUMENT,
                   "%s is generalised-alpha: --method %s is not for it",
                   how->method->name, asked->name);
    RITZ_REFUSE_IF(given && asked == &ritz_integrator_modal, RITZ_ERR_ARGUMENT,
                   "--method modal is not for bodies that forces join: take "
                   "trapezoidal");
    RITZ_REFUSE_IF(cli_given(task->run, "rho") && how->method->integrator &&
                       !alpha,
                   RITZ_ERR_ARGUMENT,
                   "--rho is for --method generalised-alpha and index-2, not "
                   "for %s",
                   given ? asked->name : how->method->integrator->name);
    return RITZ_OK;
}

bool simulation_is_constrained(const simulation_options *given)
{
    return given->constraints;
}

ritz_status simulation_constrained(simulation_task *task,
                                   const ritz_simulation_request *request,
                                   ritz_simulation *out)
{
    const simulation_options *given = task->given;
    ritz_simulation_request asked = *request;
    ritz_constrained_request how = {0};
    RITZ_OWN(ritz_unjoined) bodies = {0};
    RITZ_OWN(ritz_constrained_facts) facts = {0};
    RITZ_OWN(ritz_simulation) s = {0};
    RITZ_OWN_ARRAY double *x0 = NULL, *v0 = NULL;

    RITZ_CHECK_IN("--constraints",
                  ritz_constrained_parse(given->constraints, &how));
    how.any_step = given->any_step;
    RITZ_CHECK(check_scene(task));
    RITZ_CHECK(check_integrator(task, &how));
    RITZ_CHECK(ritz_stage_unjoined(&task->stage, task->setting, task->m.at,
                                   &task->m.damping, &bodies));
    RITZ_CHECK(find_start(given, &bodies, task->x0, &x0));
    RITZ_CHECK(find_start(given, &bodies, task->v0, &v0));
    asked.x0 = x0;
    asked.v0 = v0;
    RITZ_CHECK(ritz_simulate_constrained(&bodies, &how, &asked, &facts, &s));
    RITZ_CHECK(simulation_name_bodies(task, NULL, &s));
    ritz_damping_print(&task->m.damping, s.damping);
    if (s.num_state == 0) {
        say_facts(task->run, &bodies, &how, &facts);
        say_start(task->run, &facts);
        warn_of_ringing(task->run, asked.step, &facts);
    }
    RITZ_MOVE(*out, s);
    return RITZ_OK;
}
