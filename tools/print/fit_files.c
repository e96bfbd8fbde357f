/* Places of an answer: seen to before the search, cleared if it fails. */
#include "print/fit.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

ritz_status fit_files_add(fit_files *files, const char *path)
{
    fit_file *more = NULL;
    struct stat there;

    RITZ_CHECK(cli_can_write(path));
    more = realloc(files->file, (size_t)(files->count + 1) * sizeof *more);
    RITZ_REFUSE_IF(!more, RITZ_ERR_MEMORY, "no memory for '%s'", path);
    files->file = more;
    more[files->count] = (fit_file){strdup(path), lstat(path, &there) == 0};
    RITZ_REFUSE_IF(!more[files->count].path, RITZ_ERR_MEMORY,
                   "no memory for '%s'", path);
    files->count++;
    return RITZ_OK;
}

ritz_status fit_files_foresee(const cli_run *run, const char *prefix,
                              const char *report, const ritz_scene *scene,
                              fit_files *out)
{
    if (run->output)
        RITZ_CHECK(fit_files_add(out, run->output));
    if (report)
        RITZ_CHECK(fit_files_add(out, report));
    for (int64_t k = 0; prefix && scene && k < scene->num_components; k++) {
        char path[FIT_PATH];

        RITZ_CHECK(fit_body_path(prefix, scene->component[k].name, path));
        RITZ_CHECK(fit_files_add(out, path));
    }
    return RITZ_OK;
}

void fit_files_discard(const fit_files *files)
{
    for (int64_t k = 0; k < files->count; k++)
        if (!files->file[k].there)
            (void)remove(files->file[k].path);
}

void fit_files_free(fit_files *files)
{
    for (int64_t k = 0; k < files->count; k++)
        free(files->file[k].path);
    free(files->file);
    *files = (fit_files){0};
}
