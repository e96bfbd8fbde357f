/*
 * Two rods joined end to end by a scene whose models come from memory: a
 * source answers where files would. Each rod keeps eight fixed-interface
 * modes; the system's frequencies stand beside those of one long rod.
 */
#include "rod.h"

#include <math.h>
#include <stdio.h>

enum { ELEMENTS = 100 };

static const char text[] =
    "scene: two rods\n"
    "components:\n"
    "  a: {model: rod, basis: craig-bampton, modes: 8}\n"
    "  b: {model: rod, basis: craig-bampton, modes: 8}\n"
    "joints:\n"
    "  - {name: middle, between: [a/right, b/left], type: fixed}\n";

static ritz_status name_kind(void *state, const char *name,
                             char kind[static RITZ_NAME_SIZE])
{
    (void)state;
    (void)name;
    snprintf(kind, RITZ_NAME_SIZE, "component");
    return RITZ_OK;
}

static ritz_status make_rod(void *state, const char *name, ritz_component *out)
{
    (void)name;
    return rod_component(*(const int64_t *)state, out);
}

int main(void)
{
    int64_t elements = ELEMENTS;
    const ritz_source memory = {
        .state = &elements, .kind = name_kind, .component = make_rod};
    ritz_scene scene = {0};
    ritz_stage stage = {0};
    ritz_system system = {0};
    ritz_status status = ritz_scene_parse("two rods", text, &scene);

    scene.source = &memory;
    if (status == RITZ_OK)
        status = ritz_stage_new(&scene, &stage);
    if (status == RITZ_OK)
        status = ritz_assemble(&stage, NULL, &system);
    if (status == RITZ_OK) {
        const ritz_configuration *c = &system.configuration[0];

        puts("mode  system Hz  one rod Hz");
        for (int64_t k = c->num_rigid; k < 6; k++)
            printf("%4d  %9.7f  %10.7f\n", (int)k,
                   sqrt(c->lambda[k]) / (2.0 * 3.14159265358979),
                   (double)k / (4.0 * ELEMENTS));
    } else {
        fprintf(stderr, "assembly: %s\n", ritz_error_message());
    }
    ritz_system_free(&system);
    ritz_stage_free(&stage);
    ritz_scene_free(&scene);
    return status == RITZ_OK ? 0 : 1;
}
