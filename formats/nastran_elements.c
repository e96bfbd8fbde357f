/*
 * Rows y = ST q of a reduced component as rows of NASTRAN's MES1, MEF1 and MUG1.
 * NASTRAN prints whole elements, so that an element of which a row is missing
 * has no place there.
 */
#include "formats/nastran_elements.h"

#include "base/alloc.h"
#include "formats/nastran_items.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NAMES = 160 /* letters of a line of the report that name rows */ };

/* A row of a quantity, and what it is in NASTRAN. */
typedef struct item_row {
    int64_t type_place; /* of its type among those that occur */
    int64_t id;
    int64_t order; /* among all rows of the quantities of the kind */
    ritz_nastran_item item;
    const ritz_quantity *quantity;
    int64_t row;
} item_row;

typedef struct item_rows {
    int64_t count;
    item_row *at;
} item_rows;

static void item_rows_free(item_rows *list)
{
    free(list->at);
}

/* By type, number, place among the rows of the element, order. */
static int compare_item_rows(const void *left, const void *right)
{
    const item_row *a = left;
    const item_row *b = right;
    const int64_t key[][2] = {{a->type_place, b->type_place},
                              {a->id, b->id},
                              {a->item.index, b->item.index},
                              {a->order, b->order}};

    for (size_t k = 0; k < sizeof key / sizeof *key; k++)
        if (key[k][0] != key[k][1])
            return key[k][0] < key[k][1] ? -1 : 1;
    return 0;
}

static void leave_out(const item_row *c, ritz_nastran_elements *out)
{
    char name[RITZ_QUANTITY_NAME_SIZE];

    snprintf(out->left[out->num_left], sizeof out->left[0], "'%.50s' %.70s",
             c->quantity->name, ritz_quantity_name(c->quantity, c->row, name));
    out->num_left++;
}

/* The place of the type of the last row among those that occur. */
static int64_t place_type(const item_rows *list)
{
    const item_row *last = &list->at[list->count - 1];

    for (int64_t k = list->count - 2; k >= 0; k--)
        if (list->at[k].item.type == last->item.type)
            return list->at[k].type_place;
    return last->order;
}

static void add_rows(const ritz_quantity *quantity, int64_t *order,
                     item_rows *list, ritz_nastran_elements *out)
{
    for (int64_t i = 0; i < quantity->count; i++) {
        item_row *c = &list->at[list->count];

        *c = (item_row){.id = quantity->place[i],
                        .order = (*order)++,
                        .quantity = quantity,
                        .row = i};
        if (c->id < 1 || c->id > RITZ_NASTRAN_MOST_ID ||
            !ritz_nastran_item_find(quantity->kind, quantity->part[i],
                                    &c->item)) {
            leave_out(c, out);
            continue;
        }
        list->count++;
        c->type_place = place_type(list);
    }
}

/* Whether the rows from k to end are all rows of an element, each once. */
static bool is_whole(const item_rows *list, int64_t k, int64_t end)
{
    for (int64_t j = k; j < end; j++) {
        const ritz_nastran_item *item = &list->at[j].item;

        if (item->index != j - k || (item->rows > 0 && item->rows != end - k))
            return false;
    }
    return true;
}

static void take_elements(const item_rows *list, ritz_nastran_elements *out)
{
    int64_t end = 0;

    for (int64_t k = 0; k < list->count; k = end) {
        const item_row *first = &list->at[k];

        end = k + 1;
        while (end < list->count && list->at[end].id == first->id &&
               list->at[end].type_place == first->type_place)
            end++;
        if (!is_whole(list, k, end)) {
            for (int64_t j = k; j < end; j++)
                leave_out(&list->at[j], out);
            continue;
        }
        out->entry[out->count++] = (ritz_nastran_entry){
            first->item.type, first->id, out->num_rows, end - k};
        for (int64_t j = k; j < end; j++) {
            const item_row *c = &list->at[j];

            out->stride[out->num_rows] = c->quantity->ST.nrow;
            out->row[out->num_rows++] = c->quantity->ST.val + c->row;
        }
    }
}

static ritz_status make_elements(const ritz_reduced *reduced, const char *kind,
                                 int64_t rows, ritz_nastran_elements *out)
{
    RITZ_OWN(item_rows) list = {0};
    int64_t order = 0;

    RITZ_CHECK_NEW(list.at, rows);
    RITZ_CHECK_NEW(out->entry, rows);
    RITZ_CHECK_NEW(out->row, rows);
    RITZ_CHECK_NEW(out->stride, rows);
    RITZ_CHECK_NEW(out->left, rows);
    for (int64_t k = 0; k < reduced->num_quantities; k++)
        if (strcmp(reduced->quantity[k].kind, kind) == 0)
            add_rows(&reduced->quantity[k], &order, &list, out);
    if (list.count > 1)
        qsort(list.at, (size_t)list.count, sizeof *list.at, compare_item_rows);
    take_elements(&list, out);
    return RITZ_OK;
}

ritz_status ritz_nastran_elements_new(const ritz_reduced *reduced,
                                      const char *kind,
                                      ritz_nastran_elements *out)
{
    RITZ_OWN(ritz_nastran_elements) made = {0};
    int64_t rows = 0;

    for (int64_t k = 0; k < reduced->num_quantities; k++)
        if (strcmp(reduced->quantity[k].kind, kind) == 0) {
            rows += reduced->quantity[k].count;
            made.corrected =
                made.corrected || reduced->quantity[k].Q.val != NULL;
        }
    if (rows > 0)
        RITZ_CHECK(make_elements(reduced, kind, rows, &made));
    RITZ_MOVE(*out, made);
    return RITZ_OK;
}

ritz_status ritz_nastran_elements_matrix(const ritz_nastran_elements *elements,
                                         const ritz_nastran_rows *rows,
                                         ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(elements->num_rows, rows->order, out));
    for (int64_t k = 0; k < rows->order; k++)
        for (int64_t i = 0; i < elements->num_rows; i++)
            ritz_dense_col(out, k)[i] =
                elements->row[i][elements->stride[i] * rows->at[k]];
    return RITZ_OK;
}

/* "stresses of 3 elements, 27 rows, are MES1, named by TES1" */
static ritz_status say_written(const ritz_nastran_elements *elements,
                               const char *kind, const char *matrix,
                               ritz_export_report *report)
{
    if (elements->count == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_export_say(
        report,
        "%" PRId64 " rows of kind %s, of %" PRId64 " %s, are %s, named by %s",
        elements->num_rows, kind, elements->count,
        strcmp(kind, "displacement") == 0 ? "grids" : "elements", matrix,
        ritz_nastran_table_name(kind)));
    return elements->corrected
               ? ritz_export_say(report,
                                 "%s has these rows by mode displacement: it "
                                 "has no place for mode acceleration",
                                 matrix)
               : RITZ_OK;
}

ritz_status ritz_nastran_elements_say(const ritz_nastran_elements *elements,
                                      const char *kind, const char *matrix,
                                      ritz_export_report *report)
{
    char names[NAMES + 2 * RITZ_NAME_SIZE] = "";
    size_t used = 0;
    int64_t k = 0;

    RITZ_CHECK(say_written(elements, kind, matrix, report));
    if (elements->num_left == 0)
        return RITZ_OK;
    for (; k < elements->num_left &&
           (k == 0 || used + strlen(elements->left[k]) + 2 < NAMES);
         k++)
        used += (size_t)snprintf(names + used, sizeof names - used, "%s%s",
                                 k > 0 ? ", " : "", elements->left[k]);
    if (k < elements->num_left)
        snprintf(names + used, sizeof names - used, ", %" PRId64 " more",
                 elements->num_left - k);
    return ritz_export_say(report,
                           "%s lacks rows that are not whole elements: %.190s",
                           matrix, names);
}

void ritz_nastran_elements_free(ritz_nastran_elements *elements)
{
    RITZ_FREE(elements->entry, elements->row, elements->stride, elements->left);
    *elements = (ritz_nastran_elements){0};
}
