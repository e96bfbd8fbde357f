/*
 * A container with one reduced component or state space: a system at a
 * configuration, the first columns of a nested component, or either in
 * first-order form, for every tool that takes one. [HDFGroup2016]
 */
#include <ritz/container.h>
#include <ritz/export.h>

static ritz_status write_container(const ritz_export_object *object,
                                   const ritz_export_request *request,
                                   ritz_export_report *report)
{
    static const ritz_stamp empty = {.command = ""};
    const ritz_stamp *stamp = request->stamp ? request->stamp : &empty;

    if (object->states) {
        RITZ_CHECK(ritz_container_write_state_space(request->output,
                                                    object->states, stamp));
        return ritz_export_say(
            report, "state space, %lld states; numbers keep every bit",
            (long long)ritz_state_space_order(object->states));
    }
    RITZ_CHECK(
        ritz_container_write_reduced(request->output, object->reduced, stamp));
    return ritz_export_say(report,
                           "reduced component, %lld columns; numbers keep "
                           "every bit",
                           (long long)object->reduced->K.nrow);
}

const ritz_exporter ritz_exporter_container = {
    .name = "container",
    .summary = "container of Ritz, which every tool reads",
    .reference = "HDFGroup2016",
    .kind = "reduced",
    .takes = RITZ_EXPORT_REDUCED | RITZ_EXPORT_STATES | RITZ_EXPORT_ROWS |
             RITZ_EXPORT_LOADS,
    .write = write_container,
};
