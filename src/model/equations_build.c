#include "model/equations_build.h"

#include "base/array.h"

/* room[] is of these arrays */
enum { DEPENDENT, FIRST, DOF, SHARE, SOURCE, FROM };

ritz_status ritz_equations_cite_next(ritz_equations *equations,
                                     ritz_equation_source from)
{
    ritz_status status = RITZ_OK;

    RITZ_ROOM(equations->from, equations->num_sources, equations->room[FROM]);
    equations->from[equations->num_sources++] = from;
done:
    return status;
}

ritz_status ritz_equations_begin(ritz_equations *equations, ritz_dof dependent)
{
    ritz_status status = RITZ_OK;
    int64_t e = equations->count;
    int64_t starts = e == 0 ? 0 : e + 1;
    int64_t begin = 0;

    if (starts > 0)
        begin = equations->first[e];
    RITZ_ROOM(equations->dependent, e, equations->room[DEPENDENT]);
    RITZ_ROOM(equations->source, e, equations->room[SOURCE]);
    /* room for two more: first[0] comes with the first equation */
    RITZ_ROOM(equations->first, starts, equations->room[FIRST]);
    RITZ_ROOM(equations->first, e + 1, equations->room[FIRST]);
    equations->dependent[e] = dependent;
    equations->source[e] = equations->num_sources - 1;
    equations->first[e] = begin;
    equations->first[e + 1] = begin;
    equations->count++;
done:
    return status;
}

ritz_status ritz_equations_add(ritz_equations *equations, ritz_dof dof,
                               double share)
{
    ritz_status status = RITZ_OK;
    int64_t *end = &equations->first[equations->count];

    if (share == 0.0)
        goto done;
    RITZ_ROOM(equations->dof, *end, equations->room[DOF]);
    RITZ_ROOM(equations->share, *end, equations->room[SHARE]);
    equations->dof[*end] = dof;
    equations->share[(*end)++] = share;
done:
    return status;
}
