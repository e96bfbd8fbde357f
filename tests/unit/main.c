/*
 * The main of every test program: modules by name, one after the other.
 * Without names all; --list prints what there is.
 */
#include "testing.h"

#include <stdio.h>
#include <stdlib.h>

static testing_module *first;
static testing_module **end = &first;

void testing_register(testing_module *module)
{
    *end = module;
    end = &module->next;
}

static const testing_module *find_module(const char *name)
{
    const testing_module *module = first;

    while (module && strcmp(module->name, name) != 0)
        module = module->next;
    return module;
}

static int run_module(const testing_module *module)
{
    return _cmocka_run_group_tests(module->name, module->tests, module->count,
                                   module->setup, module->teardown);
}

int main(int argc, char **argv)
{
    int failed = 0;

    if (argc == 2 && strcmp(argv[1], "--list") == 0) {
        for (const testing_module *m = first; m; m = m->next)
            puts(m->name);
        return EXIT_SUCCESS;
    }
    for (int i = 1; i < argc; i++) {
        const testing_module *module = find_module(argv[i]);

        if (!module) {
            fprintf(stderr, "%s: no module '%s': see --list\n", argv[0],
                    argv[i]);
            return EXIT_FAILURE;
        }
        failed += run_module(module) != 0;
    }
    for (const testing_module *m = first; argc == 1 && m; m = m->next)
        failed += run_module(m) != 0;
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
