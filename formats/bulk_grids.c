/*
 * GRID cards: where the grids are, and along which axes they move.
 *
 *     GRID   ID  CP  X1  X2  X3  CD  PS        GRDSET  -  CP  - - -  CD  PS
 *
 * A blank CP, CD or PS is that of GRDSET. Displacement frames of all grids that
 * have the same axes are one; those of curved frames belong to one grid each.
 */
#include "formats/bulk_parts.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <math.h>

/* CP, CD and PS, at fields 1, 5 and 6 of GRID and of GRDSET. */
static ritz_status take_frames(const ritz_card *card, ritz_bulk_grid *out)
{
    uint8_t mask = 0;

    RITZ_CHECK(ritz_card_whole(card, 1, RITZ_BULK_BLANK, &out->cp));
    RITZ_CHECK(ritz_card_whole(card, 5, RITZ_BULK_BLANK, &out->cd));
    RITZ_CHECK(ritz_card_whole(card, 6, RITZ_BULK_BLANK, &out->spc));
    if (*ritz_card_text(card, 1) && out->cp < 0)
        RITZ_CHECK(ritz_card_refuse(card, 1, "a coordinate system"));
    if (*ritz_card_text(card, 5) && out->cd < 0)
        RITZ_CHECK(ritz_card_refuse(card, 5,
                                    "a coordinate system in which a structure "
                                    "moves"));
    if (out->spc != RITZ_BULK_BLANK &&
        (!ritz_bulk_mask(out->spc, &mask) || (out->spc != 0 && (mask & 1))))
        RITZ_CHECK(ritz_card_refuse(card, 6, "a list of directions 1 to 6"));
    return RITZ_OK;
}

ritz_status ritz_bulk_take_grid(ritz_bulk_cards *all, const ritz_card *card)
{
    ritz_bulk_grid new = {.line = card->entry->line};

    RITZ_CHECK(ritz_card_id(card, 0, &new.id));
    RITZ_CHECK(take_frames(card, &new));
    for (int64_t k = 0; k < 3; k++)
        RITZ_CHECK(ritz_card_real(card, 2 + k, 0.0, &new.x[k]));
    RITZ_CHECK_ROOM(all->grid, all->num_grids, all->grids_room);
    all->grid[all->num_grids++] = new;
    return RITZ_OK;
}

ritz_status ritz_bulk_take_defaults(ritz_bulk_cards *all, const ritz_card *card)
{
    ritz_bulk_grid new = {.line = card->entry->line};

    RITZ_CHECK(take_frames(card, &new));
    if (all->defaults.line >= 0 &&
        (new.cp != all->defaults.cp || new.cd != all->defaults.cd ||
         new.spc != all->defaults.spc))
        RITZ_CHECK(ritz_cards_refuse(&all->cards, new.line,
                                     "there is another GRDSET before"));
    all->defaults = new;
    return RITZ_OK;
}

static int compare_grids(const void *a, const void *b)
{
    const ritz_bulk_grid *left = a;
    const ritz_bulk_grid *right = b;
    int order = (left->id > right->id) - (left->id < right->id);

    return order ? order
                 : (left->line > right->line) - (left->line < right->line);
}

static void complete(int64_t *value, int64_t given)
{
    if (*value == RITZ_BULK_BLANK)
        *value = given == RITZ_BULK_BLANK ? 0 : given;
}

static bool same_grid(const ritz_bulk_grid *a, const ritz_bulk_grid *b)
{
    return a->cp == b->cp && a->cd == b->cd && a->spc == b->spc &&
           a->x[0] == b->x[0] && a->x[1] == b->x[1] && a->x[2] == b->x[2];
}

static bool is_sorted(const ritz_bulk_cards *all)
{
    for (int64_t k = 1; k < all->num_grids; k++)
        if (all->grid[k - 1].id > all->grid[k].id)
            return false;
    return true;
}

ritz_status ritz_bulk_settle_grids(ritz_bulk_cards *all)
{
    int64_t kept = 0;

    if (!is_sorted(all))
        qsort(all->grid, (size_t)all->num_grids, sizeof *all->grid,
              compare_grids);
    for (int64_t k = 0; k < all->num_grids; k++) {
        ritz_bulk_grid *grid = &all->grid[k];

        complete(&grid->cp, all->defaults.cp);
        complete(&grid->cd, all->defaults.cd);
        complete(&grid->spc, all->defaults.spc);
        if (kept == 0 || all->grid[kept - 1].id != grid->id) {
            all->grid[kept++] = *grid;
            continue;
        }
        if (!same_grid(&all->grid[kept - 1], grid))
            RITZ_CHECK(ritz_cards_refuse(
                &all->cards, grid->line,
                "GRID %" PRId64 " is defined otherwise before", grid->id));
    }
    all->num_grids = kept;
    return RITZ_OK;
}

const ritz_bulk_grid *ritz_bulk_find_grid(const ritz_bulk_cards *all,
                                          int64_t id)
{
    if (all->num_grids == 0)
        return NULL;
    return bsearch(&id, all->grid, (size_t)all->num_grids, sizeof *all->grid,
                   ritz_bulk_compare_ids);
}

/* ---- putting them in place --------------------------------------------- */

static ritz_status frame_of(const ritz_bulk_cards *all,
                            const ritz_bulk_grid *grid, int64_t id,
                            ritz_bulk_frame **out)
{
    *out = id ? ritz_bulk_find_frame(all, id) : NULL;
    if (id && !*out)
        return ritz_cards_refuse(&all->cards, grid->line,
                                 "GRID %" PRId64
                                 " uses coordinate system %" PRId64
                                 ", which there is not",
                                 grid->id, id);
    return RITZ_OK;
}

static bool is_identity(const double axes[static 9])
{
    for (int k = 0; k < 9; k++)
        if (axes[k] != (k % 4 == 0 ? 1.0 : 0.0))
            return false;
    return true;
}

/* Axes while they are collected. */
typedef struct builder {
    int64_t room;
    int64_t *row; /* of each rectangular frame, 0 until it has one */
    ritz_grids grids;
} builder;

static ritz_status add_axes(builder *build, const double axes[static 9],
                            int64_t *out)
{
    ritz_status status = RITZ_OK;
    ritz_grids *grids = &build->grids;
    double *more = NULL;

    *out = 0;
    if (is_identity(axes))
        goto done;
    more = ritz_array_grown(grids->axes, grids->num_frames, &build->room,
                            9 * sizeof *axes);
    if (!more) {
        status = RITZ_ERR_MEMORY;
        goto done;
    }
    grids->axes = more;
    memcpy(grids->axes + 9 * grids->num_frames, axes, 9 * sizeof *axes);
    *out = grids->num_frames++;
done:
    return status;
}

static ritz_status place(const ritz_bulk_cards *all, int64_t k, builder *build)
{
    const ritz_bulk_grid *grid = &all->grid[k];
    double *position = &build->grids.position[3 * k];
    ritz_bulk_frame *frame = NULL;
    double axes[9];
    int64_t *shared = NULL;

    build->grids.id[k] = grid->id;
    RITZ_CHECK(frame_of(all, grid, grid->cp, &frame));
    ritz_bulk_position(frame, grid->x, position);
    for (int j = 0; j < 3; j++)
        if (!isfinite(position[j]))
            RITZ_CHECK(ritz_cards_refuse(
                &all->cards, grid->line,
                "GRID %" PRId64 " is infinitely far away", grid->id));
    RITZ_CHECK(frame_of(all, grid, grid->cd, &frame));
    if (!frame)
        return RITZ_OK;
    if (frame->kind == RITZ_RECTANGULAR)
        shared = &build->row[frame - all->frame];
    if (shared && *shared) {
        build->grids.frame[k] = *shared;
        return RITZ_OK;
    }
    ritz_bulk_axes(frame, position, axes);
    RITZ_CHECK(add_axes(build, axes, &build->grids.frame[k]));
    if (shared)
        *shared = build->grids.frame[k];
    return RITZ_OK;
}

ritz_status ritz_bulk_place_grids(const ritz_bulk_cards *all, ritz_grids *out)
{
    ritz_status status = RITZ_OK;
    builder build = {.room = 1};

    RITZ_NEW(build.row, all->num_frames);
    RITZ_NEW(build.grids.id, all->num_grids);
    RITZ_NEW(build.grids.position, 3 * all->num_grids);
    RITZ_NEW(build.grids.frame, all->num_grids);
    RITZ_NEW(build.grids.axes, 9);
    for (int k = 0; k < 9; k += 4)
        build.grids.axes[k] = 1.0;
    build.grids.num_frames = 1;
    build.grids.count = all->num_grids;
    for (int64_t k = 0; k < all->num_grids; k++)
        RITZ_TRY(place(all, k, &build));
    *out = build.grids;
    build.grids = (ritz_grids){0};
done:
    free(build.row);
    ritz_grids_free(&build.grids);
    return status;
}
