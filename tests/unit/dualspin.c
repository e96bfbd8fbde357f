#include "dualspin.h"

#include "scenes.h"
#include "testing.h"

#include <ritz/import.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool dualspin_is_there(void)
{
    return getenv("RITZ_DATA");
}

void dualspin_or_skip(void)
{
    if (dualspin_is_there())
        return;
    print_message("skipped: no data, RITZ_DATA is not set\n");
    skip();
}

const char *dualspin_path(const char *name)
{
    static char path[4096];

    snprintf(path, sizeof path, "%s/dualspin/%s", getenv("RITZ_DATA"), name);
    return path;
}

ritz_status dualspin_component(int which, ritz_component *out)
{
    static const char *const names[] = {"rotor", "stator", "platform"};
    static const char *const ports[][2] = {
        {"bearing=1", NULL}, {"bearing=1", "scan=5"}, {"scan=1", NULL}};
    ritz_status status = RITZ_OK;
    ritz_import_request request = {.units = "kg m s"};
    ritz_import_report report = {0};
    char deck[64], K[4200], M[4200], bulk[4200];

    snprintf(deck, sizeof deck, "%s.op4", names[which]);
    snprintf(K, sizeof K, "%s:KGG", dualspin_path(deck));
    snprintf(M, sizeof M, "%s:MGG", dualspin_path(deck));
    snprintf(deck, sizeof deck, "%s.bdf", names[which]);
    snprintf(bulk, sizeof bulk, "%s", dualspin_path(deck));
    request.stiffness = which == 2 ? NULL : K;
    request.mass = M;
    request.bulk = bulk;
    request.port = ports[which];
    request.num_ports = ports[which][1] ? 2 : 1;
    status = ritz_import(&request, out, &report);
    ritz_import_report_free(&report);
    return status;
}

ritz_status dualspin_stage(ritz_scene *scene, ritz_stage *out)
{
    ritz_status status = RITZ_OK;
    ritz_reduced body[3] = {0};
    ritz_component component = {0};

    RITZ_TRY(ritz_scene_read(dualspin_path("scene.yaml"), scene));
    for (int k = 0; k < 3; k++) {
        const ritz_scene_component *item = &scene->component[k];
        const ritz_span span = {item->modes, item->up_to_hz};

        RITZ_TRY(dualspin_component(k, &component));
        RITZ_TRY(reduce_to(&component, ritz_method_find(item->basis), &span,
                           &body[k]));
        ritz_component_free(&component);
    }
    RITZ_TRY(ritz_stage_from(scene, body, out));
done:
    ritz_component_free(&component);
    for (int k = 0; k < 3; k++)
        ritz_reduced_free(&body[k]);
    return status;
}
