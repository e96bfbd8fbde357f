/*
 * The tables TUG1, TES1 and TEF1, which name the rows of MUG1, MES1 and MEF1:
 *
 *     DTI  TEF1  0  rows  columns  32767  0  1004  0
 *          TEF     4           REAL  1  ENDREC
 *     DTI  TEF1  1  1  0.  2  0.  ...  ENDREC                 for each column
 *     DTI  TEF1  2
 *          TYPE  ID  COMP  ROW  TYPE  ID  COMP  ROW
 *          34    10  8     1    34    97    8  9  ...  ENDREC
 *     DTI  TEF1  3                                  not of TUG1
 *          34    10
 *          34    97
 *          ENDREC
 *
 * An element has COMP rows from ROW on; its type is NASTRAN's number of it. The
 * types of TUG1 are 1 of grids and 2 of scalar points, both with six rows: those
 * of a point behind the first are zero. The tables are those of files that NX
 * and MSC NASTRAN wrote for EXTSEOUT, in the tests of pyYeti [Widrick2024] and
 * pyNastran [Doyle2024].
 */
#include "formats/nastran_tables.h"

#include "base/alloc.h"
#include "base/text.h"
#include "formats/cards.h"
#include "formats/nastran_items.h"
#include "formats/small_field.h"

#include <ritz/import.h>

#include <inttypes.h>
#include <string.h>
#include <strings.h>

enum {
    GROUP = 4,          /* TYPE ID COMP ROW */
    MOST_ROWS = 1000000 /* that COMP may add up to */
};

static const struct table_kind {
    const char *name, *kind, *title;
    int64_t code; /* 1000 + title_code of elements */
    const char *title_code;
    bool of_elements;
} tables[] = {
    {"TUG1", "displacement", "PHIP", 7, "7", false},
    {"TES1", "stress", "TES", 1005, "5", true},
    {"TEF1", "force", "TEF", 1004, "4", true},
};
enum { NUM_TABLES = sizeof tables / sizeof *tables };

static const struct table_kind *find_table(const char *kind)
{
    for (int k = 0; k < NUM_TABLES; k++)
        if (strcmp(tables[k].kind, kind) == 0)
            return &tables[k];
    return NULL;
}

const char *ritz_nastran_table_name(const char *kind)
{
    const struct table_kind *table = find_table(kind);

    return table ? table->name : NULL;
}

/* ---- writing ------------------------------------------------------------- */

static ritz_small_card begin_record(FILE *file, const struct table_kind *table,
                                    int64_t record)
{
    ritz_small_card card = ritz_small_begin(file, "DTI");

    ritz_small_text(&card, table->name);
    ritz_small_id(&card, record);
    return card;
}

static void put_head(FILE *file, const struct table_kind *table, int64_t rows,
                     int64_t columns)
{
    const char *const words[] = {"0", table->title, "",  table->title_code, "",
                                 "",  "REAL",       "1", "ENDREC"};
    ritz_small_card card = begin_record(file, table, 0);

    ritz_small_id(&card, rows);
    ritz_small_id(&card, columns);
    ritz_small_text(&card, "32767");
    ritz_small_text(&card, "0");
    ritz_small_id(&card, table->code);
    for (size_t k = 0; k < sizeof words / sizeof *words; k++)
        ritz_small_text(&card, words[k]);
    ritz_small_end(&card);
}

static void put_columns(FILE *file, const struct table_kind *table,
                        int64_t columns)
{
    ritz_small_card card = begin_record(file, table, 1);

    for (int64_t k = 1; k <= columns; k++) {
        ritz_small_id(&card, k);
        ritz_small_text(&card, "0.0");
    }
    ritz_small_text(&card, "ENDREC");
    ritz_small_end(&card);
}

static void put_rows(FILE *file, const struct table_kind *table, int64_t count,
                     const ritz_nastran_entry *entry)
{
    static const char *const titles[] = {"TYPE", "ID", "COMP", "ROW"};
    ritz_small_card card = begin_record(file, table, 2);

    ritz_small_skip(&card);
    for (int k = 0; k < 2 * GROUP; k++)
        ritz_small_text(&card, titles[k % GROUP]);
    for (int64_t k = 0; k < count; k++) {
        ritz_small_id(&card, entry[k].type);
        ritz_small_id(&card, entry[k].id);
        ritz_small_id(&card, entry[k].count);
        ritz_small_id(&card, entry[k].first + 1);
    }
    ritz_small_text(&card, "ENDREC");
    ritz_small_end(&card);
}

/* A line for each element. */
static void put_elements(FILE *file, const struct table_kind *table,
                         int64_t count, const ritz_nastran_entry *entry)
{
    ritz_small_card card = begin_record(file, table, 3);

    for (int64_t k = 0; k < count; k++) {
        ritz_small_skip(&card);
        ritz_small_id(&card, entry[k].type);
        ritz_small_id(&card, entry[k].id);
    }
    ritz_small_skip(&card);
    ritz_small_text(&card, "ENDREC");
    ritz_small_end(&card);
}

void ritz_nastran_table_put(FILE *file, const char *kind, int64_t rows,
                            int64_t columns, int64_t count,
                            const ritz_nastran_entry *entry)
{
    const struct table_kind *table = find_table(kind);

    if (!table)
        return;
    put_head(file, table, rows, columns);
    put_columns(file, table, columns);
    put_rows(file, table, count, entry);
    if (table->of_elements)
        put_elements(file, table, count, entry);
}

/* ---- reading ------------------------------------------------------------- */

/* Whole numbers of record 2, in its order. */
typedef struct table_numbers {
    int64_t count, room;
    int64_t *value;
} table_numbers;

static void table_numbers_free(table_numbers *list)
{
    free(list->value);
}

static bool is_title(const char *text)
{
    static const char *const titles[] = {"TYPE", "ID", "COMP", "ROW"};

    for (int k = 0; k < GROUP; k++)
        if (strcasecmp(text, titles[k]) == 0)
            return true;
    return false;
}

/* The numbers up to ENDREC; blank fields are none of the record. */
static ritz_status take_numbers(const ritz_card *card, table_numbers *out)
{
    for (int64_t k = 2; k < card->count; k++) {
        const char *text = ritz_card_text(card, k);
        int64_t value = 0;

        if (strcasecmp(text, "ENDREC") == 0)
            return out->count % GROUP == 0
                       ? RITZ_OK
                       : ritz_card_refuse(card, k,
                                          "behind TYPE, ID, COMP and "
                                          "ROW of a whole entry");
        if (!*text || is_title(text))
            continue;
        RITZ_CHECK(ritz_card_id(card, k, &value));
        RITZ_CHECK_ROOM(out->value, out->count, out->room);
        out->value[out->count++] = value;
    }
    return ritz_cards_refuse(card->cards, card->entry->line,
                             "record 2 of %s ends without ENDREC",
                             ritz_card_text(card, 0));
}

static bool is_record(const ritz_card *card, const struct table_kind *table)
{
    int64_t record = 0;

    return strcasecmp(ritz_card_text(card, 0), table->name) == 0 &&
           ritz_text_whole(ritz_card_text(card, 1), &record) && record == 2;
}

/* Refuse an entry that is none of this table, or whose rows do not follow those
 * of the one before. */
static ritz_status check_entry(const ritz_card *card,
                               const struct table_kind *table,
                               const int64_t *value, int64_t first)
{
    const ritz_cards *cards = card->cards;
    const int64_t line = card->entry->line;

    if (!table->of_elements && value[0] > RITZ_NASTRAN_SCALAR)
        return ritz_cards_refuse(cards, line,
                                 "%s has type %" PRId64 " of %" PRId64
                                 ", which is neither 1, a grid, nor 2, a "
                                 "scalar point",
                                 table->name, value[0], value[1]);
    if (value[3] != first + 1)
        return ritz_cards_refuse(cards, line,
                                 "%s has row %" PRId64 " for %" PRId64
                                 " where %" PRId64 " is due",
                                 table->name, value[3], value[1], first + 1);
    if (value[2] > MOST_ROWS - first)
        return ritz_cards_refuse(cards, line, "%s names more than %d rows",
                                 table->name, MOST_ROWS);
    return RITZ_OK;
}

static ritz_status name_rows(const struct table_kind *table,
                             const table_numbers *list, ritz_row_table *out)
{
    int64_t rows = 0;

    for (int64_t k = 0; k < list->count; k += GROUP)
        rows += list->value[k + 2];
    RITZ_CHECK_NEW(out->place, rows);
    RITZ_CHECK_NEW(out->part, rows);
    for (int64_t k = 0; k < list->count; k += GROUP) {
        const int64_t *value = list->value + k;
        ritz_nastran_item item = {.type = value[0], .rows = value[2]};

        for (; item.index < item.rows; item.index++) {
            out->place[out->count] = value[1];
            ritz_nastran_item_name(table->kind, &item, out->part[out->count++]);
        }
    }
    return RITZ_OK;
}

static ritz_status take_record(const ritz_card *card,
                               const struct table_kind *table,
                               ritz_row_table *out)
{
    RITZ_OWN(table_numbers) list = {0};
    int64_t first = 0;

    if (out->place)
        return ritz_cards_refuse(card->cards, card->entry->line,
                                 "%s is there twice: a file with one "
                                 "superelement alone must name its rows",
                                 table->name);
    RITZ_CHECK(take_numbers(card, &list));
    for (int64_t k = 0; k < list.count; k += GROUP) {
        RITZ_CHECK(check_entry(card, table, list.value + k, first));
        first += list.value[k + 2];
    }
    return name_rows(table, &list, out);
}

bool ritz_row_table_recognise(const char *text)
{
    for (const char *at = text; at; at = strchr(at, '\n')) {
        at += *at == '\n';
        if (strncasecmp(at, "DTI", 3) == 0 && at[3] && strchr(" \t,*", at[3]))
            return true;
    }
    return false;
}

ritz_status ritz_row_table_parse(const char *path, const char *text,
                                 const char *kind, ritz_row_table *out)
{
    const struct table_kind *table = find_table(kind);
    RITZ_OWN(ritz_row_table) found = {0};
    RITZ_OWN(ritz_cards) cards = {0};
    RITZ_OWN(ritz_card) card = {0};

    if (!table)
        return RITZ_OK;
    RITZ_CHECK(
        ritz_cards_parse(path, text, (int64_t)strlen(text), NULL, &cards));
    for (int64_t k = 0; k < cards.num_entries; k++) {
        if (strcmp(cards.entry[k].name, "DTI") != 0)
            continue;
        RITZ_CHECK(ritz_card_take(&cards, k, &card));
        if (is_record(&card, table))
            RITZ_CHECK(take_record(&card, table, &found));
    }
    RITZ_MOVE(*out, found);
    return RITZ_OK;
}

void ritz_row_table_free(ritz_row_table *table)
{
    RITZ_FREE(table->place, table->part);
    *table = (ritz_row_table){0};
}
