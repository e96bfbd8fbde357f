/* Grids of bulk data, and the coordinate systems that place and turn them. */
#include "base/alloc.h"
#include "base/search.h"
#include "base/tolerances.h"
#include "base/vector.h"
#include "formats/bulk.h"

#include <inttypes.h>
#include <math.h>

/* ---- axes --------------------------------------------------------------- */

/*
 *     A origin, B on the z axis, C in the x-z plane:
 *     e_z = (B - A) / |B - A|,  e_y ~ e_z x (C - A),  e_x = e_y x e_z
 *
 *     coordinates        cylindrical r, theta, z     spherical r, theta, phi
 *     x                  r cos(theta)                r sin(theta) cos(phi)
 *     y                  r sin(theta)                r sin(theta) sin(phi)
 *     z                  z                           r cos(theta)
 *
 * with angles in degrees. Displacements are along the directions in which the
 * coordinates grow. Where these are not defined, on the z axis of either, they
 * are the frame's own axes x, y, z, which is what the public NASTRAN does.
 */

static double length_of(const double a[static 3])
{
    return hypot(hypot(a[0], a[1]), a[2]);
}

static void divide_vector(double a[static 3], double by)
{
    for (int k = 0; k < 3; k++)
        a[k] /= by;
}

/* sin and cos of an angle in degrees, exact where they are 0 or 1. */
static void turn_degrees(double degrees, double *sine, double *cosine)
{
    static const double EXACT[] = {0.0, 1.0, 0.0, -1.0, 0.0};
    double angle = degrees * (RITZ_PI / 180.0);
    double quarters = degrees / 90.0;
    int quarter = 0;

    *sine = sin(angle);
    *cosine = cos(angle);
    if (quarters == floor(quarters) && fabs(quarters) < 1e9) {
        quarter = (int)(((int64_t)quarters % 4 + 4) % 4);
        *sine = EXACT[quarter];
        *cosine = EXACT[quarter + 1];
    }
}

/* Coordinates of a kind of frame as x, y, z along its axes. */
static void straighten_point(int32_t kind, const double x[static 3],
                             double out[static 3])
{
    double s = 0.0;
    double c = 1.0;
    double s_phi = 0.0;
    double c_phi = 1.0;

    memcpy(out, x, 3 * sizeof *out);
    if (kind == RITZ_RECTANGULAR)
        return;
    turn_degrees(x[1], &s, &c);
    if (kind == RITZ_CYLINDRICAL) {
        out[0] = x[0] * c;
        out[1] = x[0] * s;
        return;
    }
    turn_degrees(x[2], &s_phi, &c_phi);
    out[0] = x[0] * s * c_phi;
    out[1] = x[0] * s * s_phi;
    out[2] = x[0] * c;
}

/* Coordinates @p x of a resolved frame, NULL the basic one, as a position. */
static void place_point(const ritz_bulk_frame *frame, const double x[static 3],
                        double out[static 3])
{
    double local[3];

    if (!frame) {
        memcpy(out, x, 3 * sizeof *out);
        return;
    }
    straighten_point(frame->kind, x, local);
    for (int j = 0; j < 3; j++)
        out[j] = frame->origin[j] + local[0] * frame->axes[j] +
                 local[1] * frame->axes[3 + j] + local[2] * frame->axes[6 + j];
}

/* Rows: directions of growing coordinates, along the frame's own axes. */
static void local_axes(int32_t kind, const double p[static 3], double r,
                       double out[static 9])
{
    double radius = length_of(p);
    double c_phi = p[0] / r;
    double s_phi = p[1] / r;
    double s = r / radius;
    double c = p[2] / radius;
    const double round[9] = {c_phi, s_phi, 0, -s_phi, c_phi, 0, 0, 0, 1};
    const double sphere[9] = {s * c_phi, s * s_phi, c,     c * c_phi, c * s_phi,
                              -s,        -s_phi,    c_phi, 0.0};

    memcpy(out, kind == RITZ_CYLINDRICAL ? round : sphere, sizeof round);
}

/* Displacement axes of a frame at a position of the basic frame. */
static void find_axes(const ritz_bulk_frame *frame,
                      const double position[static 3], double out[static 9])
{
    double p[3] = {0.0, 0.0, 0.0};
    double local[9];
    double scale = length_of(position) + length_of(frame->origin);
    double r = 0.0;

    memcpy(out, frame->axes, sizeof frame->axes);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            p[i] += frame->axes[3 * i + j] * (position[j] - frame->origin[j]);
    r = hypot(p[0], p[1]);
    if (frame->kind == RITZ_RECTANGULAR || r <= RITZ_TIE_ROUNDING * scale)
        return;
    local_axes(frame->kind, p, r, local);
    for (int64_t i = 0; i < 3; i++)
        for (int64_t j = 0; j < 3; j++)
            out[3 * i + j] = local[3 * i] * frame->axes[j] +
                             local[3 * i + 1] * frame->axes[3 + j] +
                             local[3 * i + 2] * frame->axes[6 + j];
}

/* Origin and axes of a frame by three points, which no line may hold. */
static ritz_status orient_frame(const ritz_bulk_cards *all,
                                const double A[static 3],
                                const double B[static 3],
                                const double C[static 3],
                                ritz_bulk_frame *frame)
{
    double *e_x = &frame->axes[0];
    double *e_y = &frame->axes[3];
    double *e_z = &frame->axes[6];
    double to_C[3];
    double z = 0.0;
    double y = 0.0;

    for (int k = 0; k < 3; k++) {
        frame->origin[k] = A[k];
        e_z[k] = B[k] - A[k];
        to_C[k] = C[k] - A[k];
    }
    z = length_of(e_z);
    if (z > 0.0)
        divide_vector(e_z, z);
    ritz_cross(e_z, to_C, e_y);
    y = length_of(e_y);
    if (!(z > 0.0 && y > RITZ_HALF_DIGITS * length_of(to_C) && isfinite(z) &&
          isfinite(y)))
        return ritz_cards_refuse(&all->cards, frame->line,
                                 "the three points of coordinate system "
                                 "%" PRId64 " lie on a line",
                                 frame->id);
    divide_vector(e_y, y);
    ritz_cross(e_y, e_z, e_x);
    return RITZ_OK;
}

/* ---- grids -------------------------------------------------------------- */

/*
 * GRID cards: where the grids are, and along which axes they move.
 *
 *     GRID   ID  CP  X1  X2  X3  CD  PS        GRDSET  -  CP  - - -  CD  PS
 *
 * A blank CP, CD or PS is that of GRDSET. Displacement frames of all grids that
 * have the same axes are one; those of curved frames belong to one grid each.
 */

/* CP, CD and PS, at fields 1, 5 and 6 of GRID and of GRDSET. */
static ritz_status take_frames(const ritz_card *card, ritz_bulk_grid *out)
{
    uint8_t mask = 0;

    RITZ_CHECK(ritz_card_whole(card, 1, RITZ_BULK_BLANK, &out->cp));
    RITZ_CHECK(ritz_card_whole(card, 5, RITZ_BULK_BLANK, &out->cd));
    RITZ_CHECK(ritz_card_whole(card, 6, RITZ_BULK_BLANK, &out->spc));
    if (*ritz_card_text(card, 1) && out->cp < 0)
        return ritz_card_refuse(card, 1, "a coordinate system");
    if (*ritz_card_text(card, 5) && out->cd < 0)
        return ritz_card_refuse(card, 5,
                                "a coordinate system in which a structure "
                                "moves");
    if (out->spc != RITZ_BULK_BLANK &&
        (!ritz_card_mask(out->spc, &mask) || (out->spc != 0 && (mask & 1))))
        return ritz_card_refuse(card, 6, "a list of directions 1 to 6");
    return RITZ_OK;
}

ritz_status ritz_bulk_take_grid(ritz_bulk_cards *all, const ritz_card *card,
                                int32_t how)
{
    ritz_bulk_grid new = {.line = card->entry->line};

    (void)how;
    RITZ_CHECK(ritz_card_id(card, 0, &new.id));
    RITZ_CHECK(take_frames(card, &new));
    for (int64_t k = 0; k < 3; k++)
        RITZ_CHECK(ritz_card_real(card, 2 + k, 0.0, &new.x[k]));
    RITZ_CHECK_ROOM(all->grid, all->num_grids, all->grids_room);
    all->grid[all->num_grids++] = new;
    return RITZ_OK;
}

ritz_status ritz_bulk_take_defaults(ritz_bulk_cards *all, const ritz_card *card,
                                    int32_t how)
{
    ritz_bulk_grid new = {.line = card->entry->line};

    (void)how;
    RITZ_CHECK(take_frames(card, &new));
    if (all->defaults.line >= 0 &&
        (new.cp != all->defaults.cp || new.cd != all->defaults.cd ||
         new.spc != all->defaults.spc))
        return ritz_cards_refuse(&all->cards, new.line,
                                 "there is another GRDSET before");
    all->defaults = new;
    return RITZ_OK;
}

/* Order of structs that begin with an id and the line of their card. */
static int compare_items(const void *left, const void *right)
{
    const int64_t *a = left;
    const int64_t *b = right;
    int order = ritz_ascending_index(a, b);

    return order ? order : ritz_ascending_index(a + 1, b + 1);
}

/* Sort such structs and keep each id once; what `same` finds to be another
 * definition of an id is refused. */
static ritz_status settle_items(const ritz_cards *cards, const char *noun,
                                int64_t *count, size_t size, void *items,
                                bool (*same)(const void *a, const void *b))
{
    char *first = items;
    char *last = NULL;
    int64_t kept = 0;

    if (*count > 1)
        qsort(items, (size_t)*count, size, compare_items);
    for (int64_t k = 0; k < *count; k++) {
        const char *item = first + (size_t)k * size;
        int64_t key[2];

        memcpy(key, item, sizeof key);
        if (kept > 0 && ritz_ascending_index(last, item) == 0) {
            if (!same(last, item))
                return ritz_cards_refuse(
                    cards, key[1], "%s %" PRId64 " is defined otherwise before",
                    noun, key[0]);
            continue;
        }
        last = first + (size_t)kept++ * size;
        memmove(last, item, size);
    }
    *count = kept;
    return RITZ_OK;
}

static void complete_field(int64_t *value, int64_t given)
{
    if (*value == RITZ_BULK_BLANK)
        *value = given == RITZ_BULK_BLANK ? 0 : given;
}

static bool is_same_grid(const void *left, const void *right)
{
    const ritz_bulk_grid *a = left;
    const ritz_bulk_grid *b = right;

    return a->cp == b->cp && a->cd == b->cd && a->spc == b->spc &&
           a->x[0] == b->x[0] && a->x[1] == b->x[1] && a->x[2] == b->x[2];
}

static ritz_status settle_grids(ritz_bulk_cards *all)
{
    for (int64_t k = 0; k < all->num_grids; k++) {
        complete_field(&all->grid[k].cp, all->defaults.cp);
        complete_field(&all->grid[k].cd, all->defaults.cd);
        complete_field(&all->grid[k].spc, all->defaults.spc);
    }
    return settle_items(&all->cards, "GRID", &all->num_grids, sizeof *all->grid,
                        all->grid, is_same_grid);
}

const ritz_bulk_grid *ritz_bulk_find_grid(const ritz_bulk_cards *all,
                                          int64_t id)
{
    if (all->num_grids == 0)
        return NULL;
    return bsearch(&id, all->grid, (size_t)all->num_grids, sizeof *all->grid,
                   ritz_ascending_index);
}

/* ---- coordinate systems ------------------------------------------------- */

/*
 * Frames and grids refer to each other in any order. They are resolved depth
 * first with a stack of their own, so that a chain of a million frames is no
 * deeper than the heap.
 */

enum { UNTOUCHED, OPEN, RESOLVED };

static ritz_status add_frame(ritz_bulk_cards *all, const ritz_bulk_frame *frame)
{
    RITZ_CHECK_ROOM(all->frame, all->num_frames, all->frames_room);
    all->frame[all->num_frames++] = *frame;
    return RITZ_OK;
}

/* CORD1: CID G1 G2 G3, twice on a card. */
ritz_status ritz_bulk_take_by_grids(ritz_bulk_cards *all, const ritz_card *card,
                                    int32_t how)
{
    int64_t last = card->count > 4 ? 4 : 0;

    for (int64_t from = 0; from <= last; from += 4) {
        ritz_bulk_frame new = {.line = card->entry->line, .kind = how};

        RITZ_CHECK(ritz_card_id(card, from, &new.id));
        for (int64_t k = 0; k < 3; k++)
            RITZ_CHECK(ritz_card_id(card, from + 1 + k, &new.grid[k]));
        RITZ_CHECK(add_frame(all, &new));
    }
    return RITZ_OK;
}

/* CORD2: CID RID A B C. */
ritz_status ritz_bulk_take_by_points(ritz_bulk_cards *all,
                                     const ritz_card *card, int32_t how)
{
    ritz_bulk_frame new = {.line = card->entry->line, .kind = how};

    RITZ_CHECK(ritz_card_id(card, 0, &new.id));
    RITZ_CHECK(ritz_card_whole(card, 1, 0, &new.base[0]));
    new.base[1] = new.base[2] = new.base[0];
    for (int64_t k = 0; k < 9; k++)
        RITZ_CHECK(ritz_card_real(card, 2 + k, 0.0, &new.point[k]));
    return add_frame(all, &new);
}

static bool is_same_frame(const void *left, const void *right)
{
    const ritz_bulk_frame *a = left;
    const ritz_bulk_frame *b = right;
    bool same = a->kind == b->kind && a->base[0] == b->base[0];

    for (int64_t k = 0; k < 3; k++)
        same = same && a->grid[k] == b->grid[k];
    for (int64_t k = 0; k < 9; k++)
        same = same && a->point[k] == b->point[k];
    return same;
}

/* Frame or grid by id; NULL if there is none. */
static ritz_bulk_frame *find_frame(const ritz_bulk_cards *all, int64_t id)
{
    if (all->num_frames == 0)
        return NULL;
    return bsearch(&id, all->frame, (size_t)all->num_frames, sizeof *all->frame,
                   ritz_ascending_index);
}

/* ---- resolving ---------------------------------------------------------- */

/* Where the grids are that define a frame. */
static ritz_status locate_grids(const ritz_bulk_cards *all,
                                ritz_bulk_frame *frame)
{
    for (int64_t k = 0; k < 3 && frame->grid[k]; k++) {
        const ritz_bulk_grid *grid = ritz_bulk_find_grid(all, frame->grid[k]);

        if (!grid)
            return ritz_cards_refuse(&all->cards, frame->line,
                                     "coordinate system %" PRId64
                                     " is defined by grid %" PRId64
                                     ", which there is not",
                                     frame->id, frame->grid[k]);
        frame->base[k] = grid->cp;
        memcpy(frame->point + 3 * k, grid->x, sizeof grid->x);
    }
    return RITZ_OK;
}

/* The next frame that must be resolved before this one; NULL if none must. */
static ritz_status next_open(const ritz_bulk_cards *all,
                             const ritz_bulk_frame *frame,
                             ritz_bulk_frame **out)
{
    *out = NULL;
    for (int k = 0; k < 3 && !*out; k++) {
        int64_t id = frame->base[k];
        ritz_bulk_frame *below = id ? find_frame(all, id) : NULL;

        if (id == 0)
            continue;
        if (!below || below->progress == OPEN)
            return ritz_cards_refuse(
                &all->cards, frame->line,
                below ? "coordinate system %" PRId64
                        " rests on itself by way of %" PRId64
                      : "coordinate system %" PRId64 " rests on %" PRId64
                        ", which there is not",
                frame->id, id);
        if (below->progress == UNTOUCHED)
            *out = below;
    }
    return RITZ_OK;
}

static ritz_status resolve_frame(const ritz_bulk_cards *all,
                                 ritz_bulk_frame *frame)
{
    double p[3][3];

    for (int64_t k = 0; k < 3; k++)
        place_point(frame->base[k] ? find_frame(all, frame->base[k]) : NULL,
                    &frame->point[3 * k], p[k]);
    frame->progress = RESOLVED;
    return orient_frame(all, p[0], p[1], p[2], frame);
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
            RITZ_CHECK(resolve_frame(all, &all->frame[stack[--depth]]));
        }
    }
    return RITZ_OK;
}

static ritz_status resolve_frames(ritz_bulk_cards *all)
{
    RITZ_OWN_ARRAY int64_t *stack = NULL;

    RITZ_CHECK_NEW(stack, all->num_frames);
    for (int64_t k = 0; k < all->num_frames; k++)
        RITZ_CHECK(locate_grids(all, &all->frame[k]));
    for (int64_t k = 0; k < all->num_frames; k++)
        RITZ_CHECK(resolve_from(all, k, stack));
    return RITZ_OK;
}

/* ---- putting them in place ---------------------------------------------- */

static ritz_status frame_of(const ritz_bulk_cards *all,
                            const ritz_bulk_grid *grid, int64_t id,
                            ritz_bulk_frame **out)
{
    *out = id ? find_frame(all, id) : NULL;
    if (id && !*out)
        return ritz_cards_refuse(&all->cards, grid->line,
                                 "GRID %" PRId64
                                 " uses coordinate system %" PRId64
                                 ", which there is not",
                                 grid->id, id);
    return RITZ_OK;
}

static ritz_status add_axes(const double axes[static 9], int64_t *room,
                            ritz_grids *grids, int64_t *out)
{
    double *more = NULL;

    if (ritz_axes_basic(axes))
        return RITZ_OK;
    more = ritz_array_grown(grids->axes, grids->num_frames, room,
                            9 * sizeof *axes);
    if (!more)
        return RITZ_ERR_MEMORY;
    grids->axes = more;
    memcpy(grids->axes + 9 * grids->num_frames, axes, 9 * sizeof *axes);
    *out = grids->num_frames++;
    return RITZ_OK;
}

static ritz_status place_grid(const ritz_bulk_cards *all, int64_t k,
                              int64_t *room, ritz_grids *out)
{
    const ritz_bulk_grid *grid = &all->grid[k];
    double *position = &out->position[3 * k];
    ritz_bulk_frame *frame = NULL;
    double axes[9];

    out->id[k] = grid->id;
    RITZ_CHECK(frame_of(all, grid, grid->cp, &frame));
    place_point(frame, grid->x, position);
    for (int j = 0; j < 3; j++)
        if (!isfinite(position[j]))
            return ritz_cards_refuse(&all->cards, grid->line,
                                     "GRID %" PRId64 " is infinitely far away",
                                     grid->id);
    RITZ_CHECK(frame_of(all, grid, grid->cd, &frame));
    if (!frame)
        return RITZ_OK;
    if (!frame->row) {
        find_axes(frame, position, axes);
        RITZ_CHECK(add_axes(axes, room, out, &out->frame[k]));
    } else {
        out->frame[k] = frame->row;
    }
    if (frame->kind == RITZ_RECTANGULAR)
        frame->row = out->frame[k];
    return RITZ_OK;
}

ritz_status ritz_bulk_place_grids(ritz_bulk_cards *all, ritz_grids *out)
{
    RITZ_OWN(ritz_grids) grids = {.num_frames = 1};
    int64_t room = 1;

    RITZ_CHECK(settle_grids(all));
    RITZ_CHECK(settle_items(&all->cards, "coordinate system", &all->num_frames,
                            sizeof *all->frame, all->frame, is_same_frame));
    RITZ_CHECK(resolve_frames(all));
    RITZ_CHECK_NEW(grids.id, all->num_grids);
    RITZ_CHECK_NEW(grids.position, 3 * all->num_grids);
    RITZ_CHECK_NEW(grids.frame, all->num_grids);
    RITZ_CHECK_NEW(grids.axes, 9);
    for (int k = 0; k < 9; k += 4)
        grids.axes[k] = 1.0;
    grids.count = all->num_grids;
    for (int64_t k = 0; k < all->num_grids; k++)
        RITZ_CHECK(place_grid(all, k, &room, &grids));
    RITZ_MOVE(*out, grids);
    return RITZ_OK;
}
