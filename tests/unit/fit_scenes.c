#include "fit_scenes.h"

#include "testing.h"

#include "dualspin.h"
#include "folder.h"
#include "frame.h"
#include "scenes.h"

#include <ritz/container.h>

ritz_fit_request fit_scenes_quick(const char *tolerance)
{
    ritz_fit_request request = RITZ_FIT_NONE;

    request.num_random = 50;
    request.num_between = 2;
    request.costs = false;
    assert_ok(ritz_tolerance_take(tolerance, &request.tolerance));
    return request;
}

ritz_fit_request fit_scenes_by(const ritz_method *const *methods, int64_t count,
                               const char *tolerance)
{
    ritz_fit_request request = fit_scenes_quick(tolerance);

    request.methods = methods;
    request.num_methods = count;
    return request;
}

/* A clamped beam of `left` elements, one of `right` fixed to its end. */
void fit_scenes_store_beams(int64_t left, int64_t right)
{
    const int64_t elements[] = {left, right};
    static const char *const file[] = {"left.h5", "right.h5"};

    for (int k = 0; k < 2; k++) {
        frame_section section = frame_mcdaniel;
        ritz_component beam = {0};

        section.offset = k == 0 ? 0.0 : 0.5 * (double)left;
        section.inertia *= k == 0 ? 1.0 : 0.5;
        assert_ok(frame_component(elements[k], 0.5, &section, k == 0, false,
                                  k == 0 ? 0 : 100, &beam));
        assert_ok(add_port(&beam, "joint", k == 0 ? left : 100));
        if (k == 1)
            assert_ok(add_port(&beam, "tip", 100 + right));
        folder_store(file[k], &beam);
        ritz_component_free(&beam);
    }
}

void fit_scenes_damp_left(void)
{
    ritz_component beam = {0};

    assert_ok(ritz_container_read_component(folder_path("left.h5"), &beam));
    assert_ok(ritz_dampers_new(beam.num_dofs, 1, &beam.dampers));
    memcpy(beam.dampers.name[0], "pot", 4);
    beam.dampers.c[0] = 0.5;
    beam.dampers.B.val[beam.num_dofs - 2] = 1.0;
    folder_store("left.h5", &beam);
    ritz_component_free(&beam);
}

const char fit_scenes_beams[] =
    "scene: two beams\n"
    "components:\n"
    "  left: {model: left.h5, basis: craig-bampton, modes: 4}\n"
    "  right: {model: right.h5, basis: craig-bampton, modes: 4}\n"
    "joints:\n"
    "  - {name: j, between: [left/joint, right/joint], type: fixed}\n"
    "inputs: [{name: f, at: right/tip, component: 2}]\n"
    "outputs: [{name: y, at: right/tip, component: 2}]\n"
    "band_hz: [0, 0.2]\n"
    "damping: {modal: 0.01}\n";

const char fit_scenes_driven[] =
    "scene: driven at the joint\n"
    "components:\n"
    "  left: {model: left.h5, basis: craig-bampton, modes: 4}\n"
    "  right: {model: right.h5, basis: craig-bampton, modes: 4}\n"
    "joints:\n"
    "  - {name: j, between: [left/joint, right/joint], type: fixed}\n"
    "inputs: [{name: f, at: left/joint, component: 2}]\n"
    "outputs: [{name: y, at: right/tip, component: 2},"
    " {name: z, at: right/tip, component: 6}]\n"
    "band_hz: [0, 0.3]\n"
    "damping: {modal: 0.005}\n";

void fit_scenes_store_spacecraft(void)
{
    static const char *const file[] = {"rotor.h5", "stator.h5", "platform.h5"};

    for (int k = 0; k < 3; k++) {
        ritz_component part = {0};

        assert_ok(dualspin_component(k, &part));
        folder_store(file[k], &part);
        ritz_component_free(&part);
    }
}

const char fit_scenes_spacecraft[] =
    "scene: spacecraft\n"
    "components:\n"
    "  rotor: {model: rotor.h5, basis: macneal-rubin, modes: 6}\n"
    "  stator: {model: stator.h5, basis: macneal-rubin, modes: 6}\n"
    "  platform: {model: platform.h5, basis: rigid}\n"
    "joints:\n"
    "  - {name: clock, between: [rotor/bearing, stator/bearing],"
    " type: hinge, axis: [0, 0, 1], angles_deg: [0, 90]}\n"
    "  - {name: cone, between: [stator/scan, platform/scan],"
    " type: hinge, axis: [0, 1, 0], angles_deg: [0]}\n"
    "inputs: [{name: torque, at: rotor/bearing, component: 6,"
    " against: stator/bearing}]\n"
    "outputs: [{name: gyro, at: platform/scan, component: 6}]\n"
    "band_hz: [0, 5]\n"
    "damping: {modal: 0.002}\n";
