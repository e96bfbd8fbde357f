/*
 * Free bodies and ports: a tolerance is met by flexible motion even where rigid
 * motion makes the largest response, and a component with ports keeps columns
 * for them.
 */
#include "testing.h"

#include "frame.h"
#include "project.h"
#include "scenes.h"

#include "fit/fitter.h"

#include <ritz/matrix.h>

/* The free beam with input and output at its tip; with `ports` both ends are
   ports. */
static void open_free(bool ports, ritz_component *beam)
{
    int64_t tip = 0;

    assert_ok(frame_component(12, 0.5, &frame_mcdaniel, false, false, 0, beam));
    tip = beam->num_dofs - 2;
    assert_ok(frame_io(beam, 1, &tip, 1, &tip));
    if (!ports)
        return;
    assert_ok(add_port(beam, "root", 0));
    assert_ok(add_port(beam, "tip", 12));
}

static ritz_fit_request request_of(const char *tolerance)
{
    ritz_fit_request request = RITZ_FIT_NONE;

    request.tolerance.band_hz[1] = 1.0;
    request.tolerance.damping =
        (ritz_damping){.kind = RITZ_DAMPING_MODAL, .zeta = 0.01};
    request.num_random = 50;
    request.costs = false;
    assert_ok(ritz_tolerance_take(tolerance, &request.tolerance));
    return request;
}

static void find(const ritz_component *beam, const ritz_fit_request *request,
                 ritz_fitter **fitter, ritz_fit *fit)
{
    assert_ok(ritz_fitter_new(beam, request, fitter));
    assert_ok(ritz_fitter_search(*fitter, fit));
    if (fit->chosen < 0)
        fail_msg("%s", fit->why);
}

/* Rigid motion alone is within 1e-2 of the largest response. */
static void a_number_alone_is_not_met_by_rigid_motion(void **state)
{
    const ritz_fit_request request = request_of("1e-2");
    const ritz_fit_candidate *c = NULL;
    RITZ_OWN(ritz_component) beam = {0};
    RITZ_OWN(ritz_fitter) *fitter = NULL;
    RITZ_OWN(ritz_fit) fit = {0};

    (void)state;
    open_free(false, &beam);
    find(&beam, &request, &fitter, &fit);
    c = &fit.candidate[fit.chosen];
    assert_true(find_measure(&c->errors, "flexible-response-relative")->value <=
                1e-2);
    assert_true(find_measure(&c->errors, "frequency-relative")->value <= 1e-2);
    assert_true(find_measure(&c->errors, "missing-modes")->value == 0.0);
}

/* Number of columns that a fit must keep, not counting rigid ones. */
static int64_t count_interface(const ritz_columns *columns, int64_t count)
{
    int64_t found = 0;

    for (int64_t k = 0; k < count; k++)
        found += columns->kind[k] != RITZ_COLUMN_RIGID &&
                 ritz_fit_stays(columns->kind[k]);
    return found;
}

/* With 8 modes, a method has columns for all six attached dofs if and only if
   it declares that it keeps an interface. */
static void methods_that_keep_an_interface_have_columns_for_it(void **state)
{
    const int special = RITZ_USES_SPACE | RITZ_USES_GRAMIAN |
                        RITZ_USES_OPERATOR | RITZ_USES_NEIGHBOUR;
    RITZ_OWN(ritz_component) beam = {0};
    RITZ_OWN(ritz_dofs) attached = {0};
    int64_t keeping = 0;

    (void)state;
    open_free(true, &beam);
    assert_ok(ritz_component_attached(&beam, NULL, &attached));
    assert_int_equal(attached.count, 6);
    for (int k = 0; ritz_methods[k]; k++) {
        const ritz_method *method = ritz_methods[k];
        ritz_request request = RITZ_REQUEST_NONE;
        RITZ_OWN(ritz_basis) basis = {0};

        if (method->uses & special || !(method->uses & RITZ_USES_ATTACHED))
            continue;
        request.component = &beam;
        request.attached = attached;
        request.modes = method->uses & RITZ_USES_MODES ? 8 : -1;
        if (method->uses & RITZ_USES_DAMPING) {
            request.choice.given |= RITZ_USES_DAMPING;
            request.choice.damping =
                (ritz_damping){.kind = RITZ_DAMPING_RAYLEIGH, .b = 1e-3};
        }
        if (ritz_basis_make(method, &request, &basis) != RITZ_OK) {
            assert_false(method->keeps_interface);
            continue;
        }
        keeping += method->keeps_interface;
        if (method->keeps_interface !=
            (count_interface(&basis.columns, basis.T.ncol) >= attached.count))
            fail_msg("%s has %d columns of its interface", method->name,
                     (int)count_interface(&basis.columns, basis.T.ncol));
    }
    assert_true(keeping >= 8);
}

/* Forces at ports are no inputs, so that no error of a response accounts for
   them: columns for the ports are kept instead. */
static void a_component_with_ports_keeps_columns_of_them(void **state)
{
    const ritz_fit_request request = request_of("response=1e-1");
    RITZ_OWN(ritz_component) beam = {0};
    RITZ_OWN(ritz_fitter) *fitter = NULL;
    RITZ_OWN(ritz_fit) fit = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};

    (void)state;
    open_free(true, &beam);
    find(&beam, &request, &fitter, &fit);
    for (int64_t m = 0; m < fit.num_methods; m++)
        assert_true(fit.method[m]->keeps_interface);
    assert_ok(
        ritz_fitter_reduced(fitter, &fit.candidate[fit.chosen], &reduced));
    assert_true(count_interface(&reduced.columns, reduced.K.ncol) >= 6);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_number_alone_is_not_met_by_rigid_motion),
    cmocka_unit_test(methods_that_keep_an_interface_have_columns_for_it),
    cmocka_unit_test(a_component_with_ports_keeps_columns_of_them),
};

TEST_MODULE(fit_free, tests, NULL, NULL)
