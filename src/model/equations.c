/* Constraint equations, as they are built, cited and freed. */
#include "model/equations.h"
#include "base/alloc.h"

#include <ritz/model.h>

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

/* room[] is of these arrays */
enum { DEPENDENT, FIRST, DOF, SHARE, SOURCE, FROM };

ritz_status ritz_equations_cite_next(ritz_equations *equations,
                                     ritz_equation_source from)
{
    RITZ_CHECK_ROOM(equations->from, equations->num_sources,
                    equations->room[FROM]);
    equations->from[equations->num_sources++] = from;
    return RITZ_OK;
}

ritz_status ritz_equations_begin(ritz_equations *equations, ritz_dof dependent)
{
    int64_t e = equations->count;
    int64_t starts = e == 0 ? 0 : e + 1;
    int64_t begin = 0;

    if (starts > 0)
        begin = equations->first[e];
    RITZ_CHECK_ROOM(equations->dependent, e, equations->room[DEPENDENT]);
    RITZ_CHECK_ROOM(equations->source, e, equations->room[SOURCE]);
    /* room for two more: first[0] comes with the first equation */
    RITZ_CHECK_ROOM(equations->first, starts, equations->room[FIRST]);
    RITZ_CHECK_ROOM(equations->first, e + 1, equations->room[FIRST]);
    equations->dependent[e] = dependent;
    equations->source[e] = equations->num_sources - 1;
    equations->first[e] = begin;
    equations->first[e + 1] = begin;
    equations->count++;
    return RITZ_OK;
}

ritz_status ritz_equations_add(ritz_equations *equations, ritz_dof dof,
                               double share)
{
    int64_t *end = &equations->first[equations->count];

    if (share == 0.0)
        return RITZ_OK;
    RITZ_CHECK_ROOM(equations->dof, *end, equations->room[DOF]);
    RITZ_CHECK_ROOM(equations->share, *end, equations->room[SHARE]);
    equations->dof[*end] = dof;
    equations->share[(*end)++] = share;
    return RITZ_OK;
}
