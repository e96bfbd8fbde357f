#include "folder.h"

#include "testing.h"

#include <ritz/container.h>

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static char folder[] = "ritz-test-XXXXXX";

int folder_make(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

int folder_remove(void **state)
{
    DIR *all = opendir(folder);
    const struct dirent *entry = NULL;

    (void)state;
    if (!all)
        return -1;
    while ((entry = readdir(all)))
        if (entry->d_name[0] != '.')
            (void)unlink(folder_path(entry->d_name));
    closedir(all);
    return rmdir(folder);
}

const char *folder_path(const char *name)
{
    static char path[16][512];
    static int turn = 0;

    turn = (turn + 1) % 16;
    snprintf(path[turn], sizeof path[turn], "%s/%s", folder, name);
    return path[turn];
}

const char *folder_write(const char *name, const char *text)
{
    const char *path = folder_path(name);
    FILE *file = fopen(path, "w");

    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
    return path;
}

void folder_store(const char *name, const ritz_component *component)
{
    const ritz_stamp stamp = {.command = "test"};

    assert_ok(
        ritz_container_write_component(folder_path(name), component, &stamp));
}

void folder_parse(const char *text, ritz_scene *out)
{
    assert_ok(ritz_scene_parse("test.yaml", text, out));
    for (int64_t k = 0; k < out->num_components; k++) {
        char *model = strdup(folder_path(out->component[k].model));

        assert_non_null(model);
        free(out->component[k].model);
        out->component[k].model = model;
    }
}
