/*
 * Coordinate systems of bulk data: their cards, and the order in which they are
 * resolved.
 *
 * Frames and grids refer to each other in any order. They are resolved depth
 * first with a stack of their own, so that a chain of a million frames is no
 * deeper than the heap.
 */
#include "formats/bulk_parts.h"

#include "base/alloc.h"

#include <inttypes.h>

enum { UNTOUCHED, OPEN, RESOLVED };

static int compare_frames(const void *a, const void *b)
{
    const ritz_bulk_frame *left = a;
    const ritz_bulk_frame *right = b;
    int order = (left->id > right->id) - (left->id < right->id);

    return order ? order
                 : (left->line > right->line) - (left->line < right->line);
}

/* CORD1: CID G1 G2 G3, twice on a card. */
static ritz_status take_by_grids(ritz_bulk_cards *all, const ritz_card *card,
                                 int64_t from, int32_t kind)
{
    ritz_bulk_frame new = {
        .line = card->entry->line, .kind = kind, .by_grids = true};

    RITZ_CHECK(ritz_card_id(card, from, &new.id));
    for (int64_t k = 0; k < 3; k++)
        RITZ_CHECK(ritz_card_id(card, from + 1 + k, &new.grid[k]));
    RITZ_CHECK_ROOM(all->frame, all->num_frames, all->frames_room);
    all->frame[all->num_frames++] = new;
    return RITZ_OK;
}

/* CORD2: CID RID A B C. */
static ritz_status take_by_points(ritz_bulk_cards *all, const ritz_card *card,
                                  int32_t kind)
{
    ritz_bulk_frame new = {.line = card->entry->line, .kind = kind};

    RITZ_CHECK(ritz_card_id(card, 0, &new.id));
    RITZ_CHECK(ritz_card_whole(card, 1, 0, &new.base));
    for (int64_t k = 0; k < 9; k++)
        RITZ_CHECK(ritz_card_real(card, 2 + k, 0.0, &new.point[k]));
    RITZ_CHECK_ROOM(all->frame, all->num_frames, all->frames_room);
    all->frame[all->num_frames++] = new;
    return RITZ_OK;
}

ritz_status ritz_bulk_take_frame(ritz_bulk_cards *all, const ritz_card *card,
                                 int32_t kind, bool by_grids)
{
    if (!by_grids)
        return take_by_points(all, card, kind);
    RITZ_CHECK(take_by_grids(all, card, 0, kind));
    if (card->count > 4)
        RITZ_CHECK(take_by_grids(all, card, 4, kind));
    return RITZ_OK;
}

static bool same_frame(const ritz_bulk_frame *a, const ritz_bulk_frame *b)
{
    bool same =
        a->kind == b->kind && a->by_grids == b->by_grids && a->base == b->base;

    for (int64_t k = 0; k < 3; k++)
        same = same && a->grid[k] == b->grid[k];
    for (int64_t k = 0; k < 9; k++)
        same = same && a->point[k] == b->point[k];
    return same;
}

ritz_status ritz_bulk_settle_frames(ritz_bulk_cards *all)
{
    int64_t kept = 0;

    if (all->num_frames > 1)
        qsort(all->frame, (size_t)all->num_frames, sizeof *all->frame,
              compare_frames);
    for (int64_t k = 0; k < all->num_frames; k++) {
        ritz_bulk_frame *frame = &all->frame[k];

        if (kept == 0 || all->frame[kept - 1].id != frame->id) {
            all->frame[kept++] = *frame;
            continue;
        }
        if (!same_frame(&all->frame[kept - 1], frame))
            RITZ_CHECK(ritz_cards_refuse(&all->cards, frame->line,
                                         "coordinate system %" PRId64
                                         " is defined otherwise before",
                                         frame->id));
    }
    all->num_frames = kept;
    return RITZ_OK;
}

ritz_bulk_frame *ritz_bulk_find_frame(const ritz_bulk_cards *all, int64_t id)
{
    if (all->num_frames == 0)
        return NULL;
    return bsearch(&id, all->frame, (size_t)all->num_frames, sizeof *all->frame,
                   ritz_bulk_compare_ids);
}

/* ---- resolving --------------------------------------------------------- */

/* Id of the k-th frame that a frame rests on, 0 for none or the basic one. */
static ritz_status rests_on(const ritz_bulk_cards *all,
                            const ritz_bulk_frame *frame, int k, int64_t *out)
{
    const ritz_bulk_grid *grid = NULL;

    *out = 0;
    if (!frame->by_grids) {
        *out = k == 0 ? frame->base : 0;
        return RITZ_OK;
    }
    grid = ritz_bulk_find_grid(all, frame->grid[k]);
    if (!grid)
        return ritz_cards_refuse(&all->cards, frame->line,
                                 "coordinate system %" PRId64
                                 " is defined by grid %" PRId64
                                 ", which there is not",
                                 frame->id, frame->grid[k]);
    *out = grid->cp;
    return RITZ_OK;
}

/* The next frame that must be resolved before this one; NULL if none must. */
static ritz_status next_open(const ritz_bulk_cards *all,
                             const ritz_bulk_frame *frame,
                             ritz_bulk_frame **out)
{
    ritz_status status = RITZ_OK;

    *out = NULL;
    for (int k = 0; k < 3 && !*out; k++) {
        ritz_bulk_frame *below = NULL;
        int64_t id = 0;

        RITZ_TRY(rests_on(all, frame, k, &id));
        if (id == 0)
            continue;
        below = ritz_bulk_find_frame(all, id);
        if (!below) {
            status =
                ritz_cards_refuse(&all->cards, frame->line,
                                  "coordinate system %" PRId64
                                  " rests on %" PRId64 ", which there is not",
                                  frame->id, id);
            goto done;
        }
        if (below->progress == OPEN)
            RITZ_TRY(ritz_cards_refuse(&all->cards, frame->line,
                                       "coordinate system %" PRId64
                                       " rests on itself by way of %" PRId64,
                                       frame->id, id));
        if (below->progress == UNTOUCHED)
            *out = below;
    }
done:
    return status;
}

static ritz_status resolve(const ritz_bulk_cards *all, ritz_bulk_frame *frame)
{
    double p[3][3];

    for (int64_t k = 0; k < 3; k++) {
        const double *x = &frame->point[3 * k];
        int64_t base = frame->base;

        if (frame->by_grids) {
            const ritz_bulk_grid *grid =
                ritz_bulk_find_grid(all, frame->grid[k]);

            x = grid->x;
            base = grid->cp;
        }
        ritz_bulk_position(base ? ritz_bulk_find_frame(all, base) : NULL, x,
                           p[k]);
    }
    frame->progress = RESOLVED;
    return ritz_bulk_orient(all, p[0], p[1], p[2], frame);
}

/* Resolve one frame, and before it what it rests on. */
static ritz_status resolve_from(const ritz_bulk_cards *all, int64_t first,
                                int64_t *stack)
{
    int64_t depth = 0;

    if (all->frame[first].progress == RESOLVED)
        return RITZ_OK;
    all->frame[first].progress = OPEN;
    stack[depth++] = first;
    while (depth > 0) {
        ritz_bulk_frame *below = NULL;

        RITZ_CHECK(next_open(all, &all->frame[stack[depth - 1]], &below));
        if (below) {
            below->progress = OPEN;
            stack[depth++] = below - all->frame;
        } else {
            RITZ_CHECK(resolve(all, &all->frame[stack[--depth]]));
        }
    }
    return RITZ_OK;
}

ritz_status ritz_bulk_resolve_frames(ritz_bulk_cards *all)
{
    ritz_status status = RITZ_OK;
    int64_t *stack = NULL;

    RITZ_NEW(stack, all->num_frames);
    for (int64_t k = 0; k < all->num_frames; k++)
        RITZ_TRY(resolve_from(all, k, stack));
done:
    free(stack);
    return status;
}
