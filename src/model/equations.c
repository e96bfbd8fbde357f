#include <ritz/equations.h>

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

const char *ritz_equations_cite(const ritz_equations *equations, int64_t source,
                                char text[static RITZ_CITATION_SIZE])
{
    const ritz_equation_source *from = &equations->from[source];
    const char *path = from->file < 0 ? NULL : equations->file[from->file];

    if (path)
        snprintf(text, RITZ_CITATION_SIZE, "%s ('%.100s', line %" PRId64 ")",
                 from->name, path, from->line);
    else if (from->line > 0)
        snprintf(text, RITZ_CITATION_SIZE, "%s (line %" PRId64 ")", from->name,
                 from->line);
    else
        snprintf(text, RITZ_CITATION_SIZE, "%s", from->name);
    return text;
}

int64_t ritz_equations_find(const ritz_equations *equations, ritz_dof dof)
{
    for (int64_t e = 0; e < equations->count; e++)
        if (ritz_dof_compare(&equations->dependent[e], &dof) == 0)
            return e;
    return -1;
}

void ritz_equations_free(ritz_equations *equations)
{
    free(equations->dependent);
    free(equations->first);
    free(equations->dof);
    free(equations->share);
    free(equations->source);
    free(equations->from);
    for (int64_t k = 0; k < equations->num_files; k++)
        free(equations->file[k]);
    free(equations->file);
    free(equations->refused);
    *equations = (ritz_equations){0};
}
