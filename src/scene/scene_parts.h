/* Parts of a scene, each read by its own file; scene.c puts them together. */
#ifndef RITZ_SCENE_SCENE_PARTS_H
#define RITZ_SCENE_SCENE_PARTS_H

#include "scene/yaml.h"

#include <ritz/scene.h>

enum {
    RITZ_MOST_PARTS = 10000,           /* components, joints, inputs, outputs */
    RITZ_MOST_SWEEPS = 1000,           /* as looked up for every setting */
    RITZ_MOST_SETTINGS = 1000000,      /* configurations times sweeps */
    RITZ_MOST_CONFIGURATIONS = 100000, /* given or combined */
    RITZ_MOST_REFERENCES = 1000,       /* each sought among all of those */
};

/*
 * Each reads the value of one key of the scene, NULL where it is absent; what
 * it names must have been read: components, joints, configurations, the rest.
 */
typedef ritz_status ritz_scene_part(const ritz_yaml *yaml,
                                    const yaml_node_t *node, ritz_scene *scene);
ritz_scene_part ritz_scene_components;
ritz_scene_part ritz_scene_joints;
ritz_scene_part ritz_scene_configurations;
ritz_scene_part ritz_scene_inputs;
ritz_scene_part ritz_scene_outputs;
ritz_scene_part ritz_scene_composite;

/** Number of items of a list of parts, refused if it is too long. */
ritz_status ritz_scene_count(const ritz_yaml *yaml, const yaml_node_t *node,
                             int64_t *count);

/** "rotor/bearing", its component one of the scene. */
ritz_status ritz_scene_place_read(const ritz_yaml *yaml,
                                  const yaml_node_t *node,
                                  const ritz_scene *scene,
                                  ritz_scene_place *out);

/** First of @p count rows of @p n numbers that repeats one before it, or -1. */
ritz_status ritz_rows_repeated(int64_t count, int64_t n, const double *val,
                               int64_t *out);

#endif
