#include "scenes.h"

#include "frame.h"
#include "testing.h"

#include <stdio.h>
#include <stdlib.h>

ritz_status scene_of_two_beams(bool clamped, ritz_scene *out)
{
    char text[512];

    snprintf(text, sizeof text,
             "scene: two beams\n"
             "components:\n"
             "  A: {model: %s, basis: full}\n"
             "  B: {model: b.h5, basis: full}\n"
             "joints:\n"
             "  - {name: middle, between: [A/middle, B/middle], type: fixed}\n",
             clamped ? "clamped.h5" : "a.h5");
    return ritz_scene_parse("two.yaml", text, out);
}

ritz_status add_port(ritz_component *component, const char *name, int64_t grid)
{
    ritz_status status = RITZ_OK;
    ritz_port *more = NULL;
    ritz_port *port = NULL;
    int64_t k = ritz_grids_find(&component->grids, grid);

    RITZ_NEW(more, component->num_ports + 1);
    if (component->num_ports > 0)
        memcpy(more, component->port,
               (size_t)component->num_ports * sizeof *more);
    free(component->port);
    component->port = more;
    port = &more[component->num_ports++];
    snprintf(port->name, sizeof port->name, "%s", name);
    RITZ_NEW(port->dofs.at, 6);
    for (int64_t i = 0; i < component->num_dofs; i++)
        if (component->dof[i].grid == grid)
            port->dofs.at[port->dofs.count++] = i;
    for (int i = 0; i < 3; i++) {
        port->origin[i] = component->grids.position[3 * k + i];
        port->axes[4 * i] = 1.0;
    }
done:
    return status;
}

ritz_status reduce_to(const ritz_component *component,
                      const ritz_method *method, const ritz_span *span,
                      ritz_reduced *out)
{
    ritz_status status = RITZ_OK;
    ritz_request request = RITZ_REQUEST_NONE;
    ritz_basis basis = {0};

    request.component = component;
    request.modes = span->modes;
    request.up_to_hz = span->up_to_hz;
    RITZ_TRY(ritz_component_attached(component, NULL, &request.attached));
    RITZ_TRY(ritz_basis_make(method, &request, &basis));
    RITZ_TRY(ritz_reduce(component, &basis, out));
done:
    ritz_dofs_free(&request.attached);
    ritz_basis_free(&basis);
    return status;
}

ritz_status reduce_with(const ritz_component *component,
                        const ritz_method *method, int64_t modes,
                        ritz_reduced *out)
{
    const ritz_span span = {.modes = modes};

    return reduce_to(component, method, &span, out);
}

ritz_status stage_of_two_beams(const ritz_scene *scene,
                               const ritz_method *method, int64_t modes,
                               ritz_stage *out)
{
    ritz_status status = RITZ_OK;
    bool clamped = strcmp(scene->component[0].model, "clamped.h5") == 0;
    ritz_component half[2] = {{0}};
    ritz_reduced body[2] = {0};

    for (int k = 0; k < 2; k++) {
        frame_section section = frame_mcdaniel;

        section.offset = (double)k;
        RITZ_TRY(frame_component(2, 0.5, &section, k == 0, k == 1 && clamped,
                                 2 * k, &half[k]));
        RITZ_TRY(add_port(&half[k], "middle", 2));
        RITZ_TRY(reduce_with(&half[k], method, modes, &body[k]));
    }
    RITZ_TRY(ritz_stage_from(scene, body, out));
done:
    for (int k = 0; k < 2; k++) {
        ritz_component_free(&half[k]);
        ritz_reduced_free(&body[k]);
    }
    return status;
}
