/* Places of an answer: seen to before the search, cleared if it fails. */
#include "print/fit.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

ritz_status fit_files_add(fit_files *files, const char *path)
{
    ritz_status status = RITZ_OK;
    fit_file *more = NULL;
    struct stat there;

    RITZ_TRY(cli_can_write(path));
    more = realloc(files->file, (size_t)(files->count + 1) * sizeof *more);
    RITZ_FAIL_IF(!more, RITZ_ERR_MEMORY, "no memory for '%s'", path);
    files->file = more;
    more[files->count] = (fit_file){strdup(path), lstat(path, &there) == 0};
    RITZ_FAIL_IF(!more[files->count].path, RITZ_ERR_MEMORY,
                 "no memory for '%s'", path);
    files->count++;
done:
    return status;
}

ritz_status fit_files_foresee(const cli_run *run, const char *prefix,
                              const char *report, const ritz_scene *scene,
                              fit_files *out)
{
    ritz_status status = RITZ_OK;

    if (run->output)
        RITZ_TRY(fit_files_add(out, run->output));
    if (report)
        RITZ_TRY(fit_files_add(out, report));
    for (int64_t k = 0; prefix && scene && k < scene->num_components; k++) {
        char path[FIT_PATH];

        RITZ_TRY(fit_body_path(prefix, scene->component[k].name, path));
        RITZ_TRY(fit_files_add(out, path));
    }
done:
    return status;
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
