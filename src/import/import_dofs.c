/*
 * The dofs that a file names, one a line: "GRID COMP", or "NODE.COMP" as
 * CalculiX writes them [Dhondt2022]. The latter is split at its point: of a
 * number, a large node would leave no digit for the direction.
 */
#include "base/alloc.h"
#include "base/text.h"
#include "import/import.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Blanks, then a whole number without a sign, then a blank or the end. @return
 * what follows the digits; NULL if that is not so */
static const char *scan_number(const char *at, int64_t *out)
{
    enum { MOST = 15 };
    const char *first = NULL;
    int64_t value = 0;

    while (*at == ' ' || *at == '\t')
        at++;
    for (first = at; *at >= '0' && *at <= '9' && at - first < MOST; at++)
        value = 10 * value + (*at - '0');
    *out = value;
    return at > first && (!*at || strchr(" \t\r", *at)) ? at : NULL;
}

/* A line of two such numbers and nothing else, as nearly all lines are. @return
 * false if it is another one */
static bool scan_plain_line(const char *line, ritz_dof *out)
{
    const char *at = scan_number(line, &out->grid);

    at = at ? scan_number(at, &out->component) : NULL;
    return at && !at[strspn(at, " \t\r")] && out->grid > 0 &&
           out->component <= 6;
}

/* Whether the first dof that the text names is spelled "NODE.COMP". */
static bool is_dotted(const char *text)
{
    size_t digits = 0;

    for (text += strspn(text, " \t\r\n"); *text == '#';
         text += strspn(text, " \t\r\n"))
        text += strcspn(text, "\n");
    digits = strspn(text, "0123456789");
    return digits > 0 && text[digits] == '.';
}

/* The two words of a line, and the first letter of what follows them. @return
 * how many of the three there are */
static int split_line(const char *line, bool dotted, char field[2][48])
{
    char more[2] = "";
    int count = 0;

    if (!dotted)
        return sscanf(line, "%47s%47s%1s", field[0], field[1], more);
    count = sscanf(line, " %47[0123456789].%47[0123456789]%1s", field[0],
                   field[1], more);
    return count > 0 ? count : sscanf(line, "%1s", more);
}

/* The dof of one line, which may be blank or end in a comment. */
static ritz_status take_line(const char *path, int64_t number, bool dotted,
                             char *line, ritz_roster *named)
{
    char field[2][48] = {"", ""};
    ritz_dof dof = {0};
    int count = 0;

    if (!dotted && scan_plain_line(line, &dof)) {
        named->place[named->count++] = (ritz_row_place){dof, number};
        return RITZ_OK;
    }
    line[strcspn(line, "#")] = '\0';
    count = split_line(line, dotted, field);
    if (count < 1)
        return RITZ_OK;
    RITZ_REFUSE_IF(count != 2 || !ritz_text_whole(field[0], &dof.grid) ||
                       !ritz_text_whole(field[1], &dof.component),
                   RITZ_ERR_FORMAT,
                   "'%s', line %" PRId64 ": a grid and its direction are due, "
                   "such as '101%c3'",
                   path, number, dotted ? '.' : ' ');
    RITZ_REFUSE_IF(
        dof.grid < 1 || dof.component < 0 || dof.component > 6, RITZ_ERR_FORMAT,
        "'%s', line %" PRId64 ": '%s%c%s' is no dof: grids are from 1 "
        "on, directions 1 to 6, and 0 for a scalar point",
        path, number, field[0], dotted ? '.' : ' ', field[1]);
    named->place[named->count++] = (ritz_row_place){dof, number};
    return RITZ_OK;
}

/* The dof of one line of a mapping file of ANSYS. */
static ritz_status take_mapping(const char *path, int64_t number,
                                const char *line, ritz_roster *named)
{
    ritz_dof dof = {0};

    RITZ_CHECK(ritz_mapping_line(path, number, line, named->count + 1, &dof));
    if (dof.grid > 0)
        named->place[named->count++] = (ritz_row_place){dof, number};
    return RITZ_OK;
}

/* By dof, then line. */
static int compare_lines(const void *left, const void *right)
{
    const ritz_row_place *a = left;
    const ritz_row_place *b = right;
    int order = ritz_dof_compare(&a->dof, &b->dof);

    return order ? order : (a->row > b->row) - (a->row < b->row);
}

/* Say at which lines a dof stands twice. */
static ritz_status check_distinct(const char *path, const ritz_roster *named)
{
    char name[RITZ_DOF_NAME_SIZE];
    bool ascend = true;

    for (int64_t k = 1; k < named->count && ascend; k++)
        ascend = compare_lines(&named->place[k - 1], &named->place[k]) < 0;
    if (!ascend)
        qsort(named->place, (size_t)named->count, sizeof *named->place,
              compare_lines);
    for (int64_t k = 1; k < named->count; k++)
        RITZ_REFUSE_IF(
            ritz_dof_compare(&named->place[k - 1], &named->place[k]) == 0,
            RITZ_ERR_FORMAT,
            "'%s', line %" PRId64 ": '%s' was named at line %" PRId64
            " already",
            path, named->place[k].row, ritz_dof_name(named->place[k].dof, name),
            named->place[k - 1].row);
    return RITZ_OK;
}

ritz_status ritz_names_of_file(const char *path, ritz_row_names *out)
{
    RITZ_OWN(ritz_row_names) names = {0};
    RITZ_OWN(ritz_roster) named = {0}; /* at the numbers of their lines */
    RITZ_OWN_ARRAY char *text = NULL;
    bool dotted = false, mapping = false;
    int64_t lines = 1;
    int64_t number = 0;

    RITZ_CHECK(ritz_text_read(path, &text));
    dotted = is_dotted(text);
    if (!dotted)
        RITZ_CHECK_IN(path, ritz_unread_refuse(text, (int64_t)strlen(text)));
    mapping = !dotted && ritz_mapping_recognise(text);
    for (const char *c = text; *c; c++)
        lines += *c == '\n';
    RITZ_CHECK_NEW(names.dof, lines);
    RITZ_CHECK_NEW(named.place, lines);
    for (char *at = text; at;) {
        char *end = strchr(at, '\n');

        if (end)
            *end = '\0';
        number++;
        RITZ_CHECK(mapping ? take_mapping(path, number, at, &named)
                           : take_line(path, number, dotted, at, &named));
        at = end ? end + 1 : NULL;
    }
    for (; names.count < named.count; names.count++)
        names.dof[names.count] = named.place[names.count].dof;
    RITZ_CHECK(check_distinct(path, &named));
    snprintf(names.map, sizeof names.map, "--dofs");
    RITZ_MOVE(*out, names);
    return RITZ_OK;
}

void ritz_row_names_free(ritz_row_names *names)
{
    free(names->dof);
    *names = (ritz_row_names){0};
}
