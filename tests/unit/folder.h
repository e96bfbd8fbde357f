/* A folder of a test's own, with containers that scenes name. */
#ifndef RITZ_TESTS_FOLDER_H
#define RITZ_TESTS_FOLDER_H

#include <ritz/component.h>
#include <ritz/scene.h>

/** For cmocka_run_group_tests: a new folder in the current one; its end. */
int folder_make(void **state);
int folder_remove(void **state);

/** Path of @p name in the folder, good for four calls. */
const char *folder_path(const char *name);

/** Write a container to the folder; the test fails if it cannot be. */
void folder_store(const char *name, const ritz_component *component);

/** Read a scene from text whose models lie in the folder. */
void folder_parse(const char *text, ritz_scene *out);

#endif
