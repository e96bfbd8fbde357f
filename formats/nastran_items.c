/*
 * The rows that an element has in MES1 and MEF1 are the words of its record in
 * the tables of printed output, OES1 and OEF1, in their order, less those that
 * are no linear function of displacements: grids and distances along a beam,
 * largest and smallest stresses, margins, principal and equivalent stresses.
 *
 * Files that NX NASTRAN wrote have 8 rows of forces of CBAR and 9 of its
 * stresses, of which the fifth is the axial one; a table of pyYeti's tests has
 * 77 rows of forces of CBEAM, 7 at each of 11 stations [Widrick2024]. The other
 * elements follow from the same rule and the words that pyNastran reads
 * [Doyle2024]. Rows of elements whose number differs are numbered.
 */
#include "formats/nastran_items.h"

#include "base/text.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { MOST_ITEMS = 9, MOST_TYPES = 3, MOST_NUMBER = 99999999 };

/* Elements by NASTRAN's numbers [Doyle2024]. */
static const struct {
    int64_t type;
    const char *card;
} cards[] = {
    {1, "crod"},    {2, "cbeam"},   {3, "ctube"},   {4, "cshear"},
    {10, "conrod"}, {11, "celas1"}, {12, "celas2"}, {13, "celas3"},
    {33, "cquad4"}, {34, "cbar"},   {39, "ctetra"}, {64, "cquad8"},
    {67, "chexa"},  {68, "cpenta"}, {69, "cbend"},  {70, "ctriar"},
    {74, "ctria3"}, {75, "ctria6"}, {82, "cquadr"}, {102, "cbush"},
};
enum { NUM_CARDS = sizeof cards / sizeof *cards };

/* Rows of elements, the same at each station; these are numbered from 1. */
typedef struct item_list {
    int64_t type[MOST_TYPES]; /* 0: none */
    const char *kind;
    int64_t stations, count;
    const char *name[MOST_ITEMS];
} item_list;

static const item_list lists[] = {
    {{34},
     "force",
     1,
     8,
     {"m1a", "m2a", "m1b", "m2b", "v1", "v2", "axial", "torque"}},
    {{34},
     "stress",
     1,
     9,
     {"sa1", "sa2", "sa3", "sa4", "axial", "sb1", "sb2", "sb3", "sb4"}},
    {{2},
     "force",
     11,
     7,
     {"m1", "m2", "v1", "v2", "axial", "torque", "warping"}},
    {{1, 3, 10}, "force", 1, 2, {"axial", "torque"}},
    {{1, 3, 10}, "stress", 1, 2, {"axial", "torsion"}},
    {{11, 12, 13}, "force", 1, 1, {"f"}},
    {{11, 12, 13}, "stress", 1, 1, {"s"}},
    {{33, 74},
     "force",
     1,
     8,
     {"fx", "fy", "fxy", "mx", "my", "mxy", "qx", "qy"}},
    {{33, 74}, "stress", 1, 6, {"sx1", "sy1", "txy1", "sx2", "sy2", "txy2"}},
    {{102}, "force", 1, 6, {"fx", "fy", "fz", "mx", "my", "mz"}},
    {{102}, "stress", 1, 6, {"tx", "ty", "tz", "rx", "ry", "rz"}},
    {{RITZ_NASTRAN_GRID},
     "displacement",
     1,
     RITZ_NASTRAN_DOFS,
     {"T1", "T2", "T3", "R1", "R2", "R3"}},
};
enum { NUM_LISTS = sizeof lists / sizeof *lists };

static const item_list *find_list(const char *kind, int64_t type)
{
    for (int k = 0; k < NUM_LISTS; k++)
        for (int t = 0; strcmp(lists[k].kind, kind) == 0 && t < MOST_TYPES; t++)
            if (lists[k].type[t] == type)
                return &lists[k];
    return NULL;
}

static bool is_of_grids(const char *kind)
{
    return strcmp(kind, "displacement") == 0;
}

/* "cbar", "type95", "point" */
static void name_type(const char *kind, int64_t type, char out[RITZ_NAME_SIZE])
{
    snprintf(out, RITZ_NAME_SIZE, "type%" PRId64, type);
    if (is_of_grids(kind))
        snprintf(out, RITZ_NAME_SIZE, "%s",
                 type == RITZ_NASTRAN_GRID ? "grid" : "point");
    for (int k = 0; !is_of_grids(kind) && k < NUM_CARDS; k++)
        if (cards[k].type == type)
            snprintf(out, RITZ_NAME_SIZE, "%s", cards[k].card);
}

void ritz_nastran_item_name(const char *kind, const ritz_nastran_item *item,
                            char out[RITZ_NAME_SIZE])
{
    const item_list *list = find_list(kind, item->type);
    char type[RITZ_NAME_SIZE];

    name_type(kind, item->type, type);
    if (!list || list->count * list->stations != item->rows)
        snprintf(out, RITZ_NAME_SIZE, "%.24s.%" PRId64, type, item->index + 1);
    else if (is_of_grids(kind))
        snprintf(out, RITZ_NAME_SIZE, "%s", list->name[item->index]);
    else if (list->stations == 1)
        snprintf(out, RITZ_NAME_SIZE, "%.24s.%s", type,
                 list->name[item->index]);
    else
        snprintf(out, RITZ_NAME_SIZE, "%.24s.%s.%" PRId64, type,
                 list->name[item->index % list->count],
                 item->index / list->count + 1);
}

/* A number from 1 to MOST_NUMBER, written without anything else. */
static bool take_number(const char *text, int64_t *out)
{
    return *text >= '1' && *text <= '9' && ritz_text_whole(text, out) &&
           *out <= MOST_NUMBER;
}

static bool take_type(const char *kind, const char *word, int64_t *out)
{
    if (is_of_grids(kind)) {
        *out = strcasecmp(word, "grid") == 0 ? RITZ_NASTRAN_GRID
                                             : RITZ_NASTRAN_SCALAR;
        return *out == RITZ_NASTRAN_GRID || strcasecmp(word, "point") == 0;
    }
    for (int k = 0; k < NUM_CARDS; k++)
        if (strcasecmp(word, cards[k].card) == 0) {
            *out = cards[k].type;
            return true;
        }
    return strncasecmp(word, "type", 4) == 0 && take_number(word + 4, out);
}

/* "m1a", or "m1.3" at a station. */
static bool take_item(const item_list *list, const char *text,
                      ritz_nastran_item *out)
{
    const char *point = strchr(text, '.');
    const size_t length = point ? (size_t)(point - text) : strlen(text);
    int64_t station = 1;

    if ((point != NULL) != (list->stations > 1) ||
        (point && !take_number(point + 1, &station)) ||
        station > list->stations)
        return false;
    for (int64_t k = 0; k < list->count; k++) {
        if (strlen(list->name[k]) != length ||
            strncasecmp(list->name[k], text, length) != 0)
            continue;
        out->index = (station - 1) * list->count + k;
        out->rows = list->stations * list->count;
        return true;
    }
    return false;
}

bool ritz_nastran_item_find(const char *kind, const char *name,
                            ritz_nastran_item *out)
{
    const char *point = strchr(name, '.');
    const item_list *list = NULL;
    char word[RITZ_NAME_SIZE];
    ritz_nastran_item found = {.type = RITZ_NASTRAN_GRID};

    if (is_of_grids(kind) && !point) {
        list = find_list(kind, RITZ_NASTRAN_GRID);
        *out = found;
        return take_item(list, name, out);
    }
    if (!point || point - name >= RITZ_NAME_SIZE)
        return false;
    snprintf(word, sizeof word, "%.*s", (int)(point - name), name);
    if (!take_type(kind, word, &found.type))
        return false;
    *out = found;
    if (take_number(point + 1, &out->index)) {
        out->index--;
        return true;
    }
    list = find_list(kind, found.type);
    return list && take_item(list, point + 1, out);
}
