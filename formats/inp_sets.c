/*
 * Sets of nodes, and the nodes that a line names.
 *
 *     *NSET, NSET=NAME                 *NSET, NSET=NAME, GENERATE
 *     1, 2, OTHER, 7                   1, 9, 2
 *
 * A set of a part or of its instance is called NAME there, and INSTANCE.NAME in
 * the assembly. [Abaqus2016]
 */
#include "base/alloc.h"
#include "base/search.h"
#include "formats/inp.h"

#include <inttypes.h>
#include <string.h>

/* Limit of the nodes and sets that supports visit, each as often as named. */
static const int64_t MOST_NAMED = 20000000;

/* ---- as they are written ------------------------------------------------- */

/* Hash of a name in capitals, by FNV-1a [FowlerNollVo2019]. */
static uint64_t hash_name(ritz_piece name, bool inner)
{
    uint64_t hash = UINT64_C(14695981039346656037) + inner;

    for (int64_t k = 0; k < name.length; k++) {
        hash ^= (unsigned char)ritz_card_upper(name.text[k]);
        hash *= UINT64_C(1099511628211);
    }
    return hash;
}

/* Find a set in the hash table: its slot, or the empty slot to insert it at.
   The number of slots is a power of two, at least twice the number of sets. */
static int64_t *find_slot(const ritz_inp *all, ritz_piece name, bool inner)
{
    const uint64_t last = (uint64_t)all->num_slots - 1;
    uint64_t k = hash_name(name, inner) & last;

    while (all->slot[k] > 0) {
        const ritz_inp_set *set = &all->set[all->slot[k] - 1];

        if (set->inner == inner && ritz_inp_same(set->name, name))
            break;
        k = (k + 1) & last;
    }
    return &all->slot[k];
}

static int64_t find_set(const ritz_inp *all, ritz_piece name, bool inner)
{
    return all->num_slots > 0 ? *find_slot(all, name, inner) - 1 : -1;
}

/* Double the number of slots, and insert all sets again. */
static ritz_status grow_slots(ritz_inp *all)
{
    enum { FEWEST = 64 };

    RITZ_FREE(all->slot);
    all->slot = NULL;
    all->num_slots = all->num_slots > 0 ? 2 * all->num_slots : FEWEST;
    RITZ_CHECK_NEW(all->slot, all->num_slots);
    for (int64_t k = 0; k < all->num_sets; k++)
        *find_slot(all, all->set[k].name, all->set[k].inner) = k + 1;
    return RITZ_OK;
}

ritz_status ritz_inp_open_set(ritz_inp *all, ritz_piece name, int64_t *out)
{
    bool inner = all->open.number > 0;

    *out = find_set(all, name, inner);
    if (*out >= 0)
        return RITZ_OK;
    if (name.length == 0)
        return ritz_inp_refuse(all, all->keyword.place,
                               "'*%.*s' does not name its set",
                               RITZ_INP_QUOTED(all->keyword.name));
    if (2 * (all->num_sets + 1) > all->num_slots)
        RITZ_CHECK(grow_slots(all));
    RITZ_CHECK_ROOM(all->set, all->num_sets, all->sets_room);
    *out = all->num_sets++;
    all->set[*out] =
        (ritz_inp_set){.name = name, .inner = inner, .first = -1, .last = -1};
    *find_slot(all, name, inner) = *out + 1;
    return RITZ_OK;
}

static ritz_status add_member(ritz_inp *all, int64_t k, ritz_inp_member member)
{
    ritz_inp_set *set = &all->set[k];

    member.next = -1;
    RITZ_CHECK_ROOM(all->member, all->num_members, all->members_room);
    if (set->last >= 0)
        all->member[set->last].next = all->num_members;
    else
        set->first = all->num_members;
    set->last = all->num_members;
    all->member[all->num_members++] = member;
    return RITZ_OK;
}

ritz_status ritz_inp_add_range(ritz_inp *all, int64_t set, int64_t from,
                               int64_t to, int64_t step)
{
    return add_member(all, set,
                      (ritz_inp_member){.from = from, .to = to, .step = step});
}

ritz_status ritz_inp_take_members(ritz_inp *all)
{
    for (int64_t k = 0; k < all->fields.count; k++) {
        ritz_inp_named one = {0};

        if (ritz_inp_field(all, k).length == 0)
            continue;
        RITZ_CHECK(ritz_inp_name(all, k, &one));
        if (one.id > 0)
            RITZ_CHECK(ritz_inp_add_range(all, all->into, one.id, one.id, 1));
        else
            RITZ_CHECK(
                add_member(all, all->into, (ritz_inp_member){.other = one}));
    }
    return RITZ_OK;
}

ritz_status ritz_inp_take_ranges(ritz_inp *all)
{
    int64_t from = 0, to = 0, step = 1;

    RITZ_CHECK(ritz_inp_id(all, 0, &from));
    to = from;
    if (ritz_inp_field(all, 1).length > 0)
        RITZ_CHECK(ritz_inp_id(all, 1, &to));
    if (ritz_inp_field(all, 2).length > 0)
        RITZ_CHECK(ritz_inp_id(all, 2, &step));
    if (to < from)
        return ritz_inp_refuse(all, all->fields.place,
                               "GENERATE ends at %" PRId64
                               ", before it begins, at %" PRId64,
                               to, from);
    return ritz_inp_add_range(all, all->into, from, to, step);
}

/* ---- what they name ------------------------------------------------------ */

/* In the assembly INSTANCE.NAME is what the instance calls NAME: its set, or
   its node. */
static ritz_inp_named look_inside(const ritz_inp *all,
                                  const ritz_inp_named *named)
{
    int64_t length = all->instance_name.length, id = 0;
    ritz_inp_named inner = *named;
    ritz_piece front = named->name;

    if (named->id > 0 || named->inner || length == 0 ||
        front.length < length + 2 || front.text[length] != '.')
        return inner;
    front.length = length;
    if (!ritz_inp_same(front, all->instance_name))
        return inner;
    inner.inner = true;
    inner.name.text += length + 1;
    inner.name.length -= length + 1;
    inner.name = ritz_inp_unquote(inner.name);
    if (ritz_inp_whole(inner.name, &id) && id > 0)
        inner.id = id;
    return inner;
}

static int64_t lower_node(const ritz_inp *all, int64_t id)
{
    int64_t low = 0, high = all->num_nodes;

    while (low < high) {
        int64_t middle = low + (high - low) / 2;

        if (all->node[middle].id < id)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

int64_t ritz_inp_find(const ritz_inp *all, int64_t id)
{
    int64_t at = lower_node(all, id);

    return at < all->num_nodes && all->node[at].id == id ? at : -1;
}

ritz_status ritz_inp_locate(const ritz_inp *all, const ritz_inp_named *named,
                            int64_t *out)
{
    ritz_inp_named node = look_inside(all, named);

    if (node.id == 0)
        return ritz_inp_refuse(all, named->place,
                               "'%.*s' is a set, and equations between sets "
                               "are not read: name nodes",
                               RITZ_INP_QUOTED(named->name));
    *out = ritz_inp_find(all, node.id);
    if (*out < 0)
        return ritz_inp_refuse(all, named->place, "there is no node %" PRId64,
                               node.id);
    return RITZ_OK;
}

/* One call of ritz_inp_mark(). */
typedef struct inp_marking {
    const ritz_inp *all;
    const ritz_inp_named *named;
    uint8_t mask;
    uint8_t *into; /* bits of each node */
    int64_t count; /* of marks->set */
    ritz_inp_marks *marks;
} inp_marking;

void ritz_inp_marks_free(ritz_inp_marks *marks)
{
    RITZ_FREE(marks->set, marks->turn_of);
}

/* Count visits of nodes and sets, and refuse more than MOST_NAMED. */
static ritz_status count_visits(const inp_marking *it, int64_t work)
{
    it->marks->work += work;
    if (it->marks->work > MOST_NAMED)
        return ritz_inp_refuse(it->all, it->named->place,
                               "supports name more than %" PRId64
                               " nodes, most of them again and again",
                               MOST_NAMED);
    return RITZ_OK;
}

/* Mark the nodes of a range; numbers without a node are passed over. */
static ritz_status mark_range(const inp_marking *it, int64_t from, int64_t to,
                              int64_t step)
{
    const ritz_inp *all = it->all;
    int64_t at = lower_node(all, from);

    for (; at < all->num_nodes && all->node[at].id <= to; at++) {
        RITZ_CHECK(count_visits(it, 1));
        if ((all->node[at].id - from) % step == 0)
            it->into[at] |= it->mask;
    }
    return RITZ_OK;
}

static ritz_status mark_named(const ritz_inp_named *named, inp_marking *it)
{
    const ritz_inp *all = it->all;
    const ritz_inp_named node = look_inside(all, named);
    int64_t set = -1;

    if (node.id > 0)
        return mark_range(it, node.id, node.id, 1);
    RITZ_CHECK(count_visits(it, 1));
    set = find_set(all, node.name, node.inner);
    if (set < 0)
        return ritz_inp_refuse(all, named->place,
                               "there is no set '%.*s' of nodes",
                               RITZ_INP_QUOTED(named->name));
    if (all->set[set].of_elements)
        return ritz_inp_refuse(all, named->place,
                               "the set '%.*s' has the nodes of a set of "
                               "elements, which is not read",
                               RITZ_INP_QUOTED(named->name));
    if (it->marks->turn_of[set] != it->marks->turn)
        it->marks->set[it->count++] = set;
    it->marks->turn_of[set] = it->marks->turn;
    return RITZ_OK;
}

ritz_status ritz_inp_mark(const ritz_inp *all, const ritz_inp_named *named,
                          uint8_t mask, ritz_inp_marks *marks, uint8_t *into)
{
    inp_marking it = {
        .all = all, .named = named, .mask = mask, .into = into, .marks = marks};
    int64_t at = -1;

    if (look_inside(all, named).id > 0) {
        RITZ_CHECK(ritz_inp_locate(all, named, &at));
        into[at] |= mask;
        return RITZ_OK;
    }
    if (!marks->set)
        RITZ_CHECK_NEW(marks->set, all->num_sets);
    if (!marks->turn_of)
        RITZ_CHECK_NEW(marks->turn_of, all->num_sets);
    marks->turn++;
    RITZ_CHECK(mark_named(named, &it));
    for (int64_t k = 0; k < it.count; k++)
        for (int64_t m = all->set[marks->set[k]].first; m >= 0;
             m = all->member[m].next) {
            const ritz_inp_member *one = &all->member[m];

            RITZ_CHECK(count_visits(&it, 1));
            if (one->step > 0)
                RITZ_CHECK(mark_range(&it, one->from, one->to, one->step));
            else
                RITZ_CHECK(mark_named(&one->other, &it));
        }
    return RITZ_OK;
}
