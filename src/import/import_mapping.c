/*
 * The mapping file of ANSYS' HBMAT: a head of words, then a line for each row of
 * the matrix with its equation, its node and the label of its direction
 * [AnsysHbmat2024].
 */
#include "base/text.h"
#include "import/import.h"

#include <ctype.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

static const char *const labels[] = {"UX", "UY", "UZ", "ROTX", "ROTY", "ROTZ"};

enum { NUM_LABELS = sizeof labels / sizeof *labels };

/* Whether the line begins with a letter, as a head does. */
static bool is_word(const char *line)
{
    return isalpha((unsigned char)line[strspn(line, " \t\r\n")]) != 0;
}

bool ritz_mapping_recognise(const char *text)
{
    char field[3][32] = {"", "", ""};
    int64_t number = 0;

    while (text && (is_word(text) || !text[strspn(text, " \t\r")] ||
                    text[strspn(text, " \t\r")] == '\n')) {
        text = strchr(text, '\n');
        text = text ? text + 1 : NULL;
    }
    return text &&
           sscanf(text, "%31s%31s%31s", field[0], field[1], field[2]) == 3 &&
           ritz_text_whole(field[0], &number) &&
           ritz_text_whole(field[1], &number) &&
           isalpha((unsigned char)field[2][0]);
}

ritz_status ritz_mapping_line(const char *path, int64_t number,
                              const char *line, int64_t equation, ritz_dof *out)
{
    char field[3][32] = {"", "", ""}, more[2] = "";
    ritz_dof dof = {0};
    int64_t found = 0;
    const int count =
        sscanf(line, "%31s%31s%31s%1s", field[0], field[1], field[2], more);

    *out = dof;
    if (count < 1 || (equation == 1 && is_word(line)))
        return RITZ_OK;
    RITZ_REFUSE_IF(count != 3 || !ritz_text_whole(field[0], &found) ||
                       !ritz_text_whole(field[1], &dof.grid) || dof.grid < 1,
                   RITZ_ERR_FORMAT,
                   "'%s', line %" PRId64 ": an equation, its node and its "
                   "direction are due, such as '7 101 UZ'",
                   path, number);
    RITZ_REFUSE_IF(found != equation, RITZ_ERR_FORMAT,
                   "'%s', line %" PRId64 ": equation %" PRId64
                   " is due, not '%s'",
                   path, number, equation, field[0]);
    for (int k = 0; k < NUM_LABELS; k++)
        if (strcasecmp(field[2], labels[k]) == 0)
            dof.component = k + 1;
    RITZ_REFUSE_IF(dof.component == 0, RITZ_ERR_FORMAT,
                   "'%s', line %" PRId64 ": '%s' is none of the directions UX "
                   "UY UZ ROTX ROTY ROTZ",
                   path, number, field[2]);
    *out = dof;
    return RITZ_OK;
}
