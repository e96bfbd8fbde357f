/* Files of this folder that are part of the program, as CMake embeds them. */
#ifndef RITZ_TOOLS_CHART_TEXT_H
#define RITZ_TOOLS_CHART_TEXT_H

typedef struct chart_text {
    const char *name;        /* "pareto.gp" */
    const char *const *line; /* ended by NULL */
} chart_text;

/** Lines of the file of that name, which there is. */
const char *const *chart_text_find(const char *name);

#endif
