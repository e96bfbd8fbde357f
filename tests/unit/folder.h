/* A folder of a test's own, with what it reads and writes. */
#ifndef RITZ_TESTS_FOLDER_H
#define RITZ_TESTS_FOLDER_H

#include <ritz/component.h>
#include <ritz/scene.h>

/** For cmocka_run_group_tests: a new folder in the current one; its end. */
int folder_make(void **state);
int folder_remove(void **state);

/** Path of @p name in the folder, good for sixteen calls. */
const char *folder_path(const char *name);

/** Write a file of text to the folder, and say its path. */
const char *folder_write(const char *name, const char *text);

/** Write a container to the folder; the test fails if it cannot be. */
void folder_store(const char *name, const ritz_component *component);

/** Read a scene from text whose models lie in the folder. */
void folder_parse(const char *text, ritz_scene *out);

#endif
