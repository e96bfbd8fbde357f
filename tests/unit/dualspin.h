/* The dual-spin spacecraft of data/dualspin, in memory. */
#ifndef RITZ_TESTS_DUALSPIN_H
#define RITZ_TESTS_DUALSPIN_H

#include <ritz/synthesis.h>

#include <stdbool.h>

/** Whether its data is at hand: RITZ_DATA. */
bool dualspin_is_there(void);

/** Skip the test, and say so, if it is not. */
void dualspin_or_skip(void);

/** data/dualspin/NAME, in a buffer that the next call overwrites. */
const char *dualspin_path(const char *name);

/** Component 0 rotor, 1 stator or 2 platform, as its Makefile imports it. */
ritz_status dualspin_component(int which, ritz_component *out);

/** Its scene, and the three components reduced as the scene says. */
ritz_status dualspin_stage(ritz_scene *scene, ritz_stage *out);

#endif
