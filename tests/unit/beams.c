#include "beams.h"

#include "frame.h"
#include "scenes.h"

#include "base/alloc.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char beams_io[] = "inputs:\n"
                        "  - {name: u1, at: A/n1, component: 2}\n"
                        "  - {name: u2, at: A/middle, component: 2}\n"
                        "  - {name: u3, at: B/n3, component: 1}\n"
                        "outputs:\n"
                        "  - {name: y1, at: A/n1, component: 6}\n"
                        "  - {name: y2, at: A/middle, component: 6}\n"
                        "  - {name: y3, at: B/n3, component: 2}\n"
                        "  - {name: y4, at: B/n3, component: 6}\n"
                        "  - {name: y5, at: B/n4, component: 2}\n"
                        "  - {name: y6, at: B/n4, component: 6}\n";

const char beams_krylov_io[] =
    "inputs: [{name: u, at: A/middle, component: [1, 2, 6]}]\n"
    "outputs: [{name: y, at: A/middle, component: 2}]\n";

static const char head[] =
    "scene: beams\n"
    "components:\n"
    "  A: {model: a.h5, basis: full}\n"
    "  B: {model: b.h5, basis: full}\n"
    "joints:\n"
    "  - {name: middle, between: [A/middle, B/middle], type: fixed}\n";

ritz_status beams_stage(bool clamped, const char *tail, ritz_scene *scene,
                        ritz_stage *stage)
{
    ritz_status status = RITZ_OK;
    size_t size = sizeof head + strlen(tail);
    ritz_component half[2] = {{0}};
    ritz_reduced body[2] = {0};
    char *text = NULL;

    RITZ_NEW(text, (int64_t)size);
    snprintf(text, size, "%s%s", head, tail);
    RITZ_TRY(ritz_scene_parse("beams.yaml", text, scene));
    for (int k = 0; k < 2; k++) {
        frame_section section = frame_mcdaniel;

        section.offset = (double)k;
        RITZ_TRY(frame_component(2, 0.5, &section, k == 0, k == 1 && clamped,
                                 2 * k, &half[k]));
        RITZ_TRY(add_port(&half[k], "middle", 2));
        RITZ_TRY(add_port(&half[k], k == 0 ? "n1" : "n3", k == 0 ? 1 : 3));
        if (k == 1 && !clamped)
            RITZ_TRY(add_port(&half[k], "n4", 4));
        RITZ_TRY(reduce_with(&half[k], &ritz_method_full, -1, &body[k]));
    }
    RITZ_TRY(ritz_stage_from(scene, body, stage));
done:
    for (int k = 0; k < 2; k++) {
        ritz_component_free(&half[k]);
        ritz_reduced_free(&body[k]);
    }
    free(text);
    return status;
}
