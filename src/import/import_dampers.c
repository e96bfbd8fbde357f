/*
 * Dampers "NAME=GRID:COMP[,GRID:COMP]*C[*K]", along basic axes as inputs are:
 * b is the row vector of the first place, less that of the second.
 */
#include "import/import.h"

#include "base/alloc.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char form[] = "NAME=GRID:COMP[,GRID:COMP]*C[*K]";

/* "C" or "C*K". */
static ritz_status take_numbers(const char *text, double *c, double *k)
{
    char copy[RITZ_NAME_SIZE] = "";
    char *star = NULL;
    bool good = strlen(text) < sizeof copy;

    if (good) {
        memcpy(copy, text, strlen(text) + 1);
        star = strchr(copy, '*');
        if (star)
            *star++ = '\0';
        good = ritz_text_real(copy, c) && (!star || ritz_text_real(star, k));
    }
    RITZ_REFUSE_IF(!good, RITZ_ERR_ARGUMENT,
                   "'%.40s' is neither C nor C*K, two finite numbers", text);
    RITZ_REFUSE_IF(*c < 0.0, RITZ_ERR_ARGUMENT,
                   "a damper's c is not negative, '%g' is", *c);
    return RITZ_OK;
}

static ritz_status make_damper(const char *text, const ritz_extended *extended,
                               int64_t j, ritz_dampers *dampers)
{
    const char *rest = NULL;
    const char *star = NULL;
    const char *comma = NULL;
    double *b = ritz_dense_col(&dampers->B, j);
    double largest = 0.0;

    RITZ_CHECK(ritz_import_split(text, form, dampers->name[j], &rest));
    star = strchr(rest, '*');
    RITZ_REFUSE_IF(!star, RITZ_ERR_ARGUMENT, "'%s' is not of the form %s", text,
                   form);
    RITZ_CHECK(take_numbers(star + 1, &dampers->c[j], &dampers->k[j]));
    comma = memchr(rest, ',', (size_t)(star - rest));
    RITZ_CHECK(ritz_import_aim(rest, (size_t)((comma ? comma : star) - rest),
                               extended, 1.0, b));
    if (comma)
        RITZ_CHECK(ritz_import_aim(comma + 1, (size_t)(star - comma - 1),
                                   extended, -1.0, b));
    for (int64_t i = 0; i < dampers->B.nrow; i++)
        largest = fmax(largest, fabs(b[i]));
    RITZ_REFUSE_IF(largest == 0.0, RITZ_ERR_ARGUMENT,
                   "nothing moves between '%.*s'", (int)(star - rest), rest);
    return RITZ_OK;
}

ritz_status ritz_import_dampers(const ritz_import_request *request,
                                const ritz_extended *extended,
                                ritz_component *component)
{
    ritz_dampers *dampers = &component->dampers;

    if (request->num_dampers == 0)
        return RITZ_OK;
    RITZ_CHECK(
        ritz_dampers_new(component->num_dofs, request->num_dampers, dampers));
    for (int64_t j = 0; j < request->num_dampers; j++)
        RITZ_CHECK_IN(request->damper[j],
                      make_damper(request->damper[j], extended, j, dampers));
    return ritz_dampers_check(dampers, component->num_dofs);
}
