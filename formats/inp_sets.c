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

/* Nodes that all lines may name through sets, and sets to look through. */
static const int64_t MOST_NAMED = 20000000;

/* ---- as they are written ------------------------------------------------- */

static int64_t find_set(const ritz_inp *all, ritz_piece name, bool inner)
{
    for (int64_t k = 0; k < all->num_sets; k++)
        if (all->set[k].inner == inner && ritz_inp_same(all->set[k].name, name))
            return k;
    return -1;
}

ritz_status ritz_inp_open_set(ritz_inp *all, ritz_piece name, int64_t *out)
{
    enum { MOST_SETS = 20000 };
    bool inner = all->open.number > 0;

    *out = find_set(all, name, inner);
    if (*out >= 0)
        return RITZ_OK;
    if (name.length == 0)
        return ritz_inp_refuse(all, all->keyword.place,
                               "'*%.*s' does not name its set",
                               RITZ_INP_QUOTED(all->keyword.name));
    if (all->num_sets == MOST_SETS)
        return ritz_inp_refuse(all, all->keyword.place,
                               "there are more than %d sets", MOST_SETS);
    RITZ_CHECK_ROOM(all->set, all->num_sets, all->sets_room);
    *out = all->num_sets;
    all->set[all->num_sets++] =
        (ritz_inp_set){.name = name, .inner = inner, .first = -1, .last = -1};
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

/* Nodes that get the bits of a mask. */
typedef struct ritz_inp_marking {
    const ritz_inp *all;
    const ritz_inp_named *named;
    uint8_t mask;
    int64_t *work;
    uint8_t *into; /* of each node */
    int64_t count; /* sets that are or were gone through, each once */
    int64_t *set;
    bool *among;
} ritz_inp_marking;

static void ritz_inp_marking_free(ritz_inp_marking *it)
{
    RITZ_FREE(it->set, it->among);
}

/* Sets may name each other, and each line may name all of them. */
static ritz_status spend(const ritz_inp_marking *it, int64_t work)
{
    *it->work += work;
    if (*it->work > MOST_NAMED)
        return ritz_inp_refuse(it->all, it->named->place,
                               "supports name more than %" PRId64
                               " nodes, most of them again and again",
                               MOST_NAMED);
    return RITZ_OK;
}

/* The nodes of a range that there are. */
static ritz_status mark_range(const ritz_inp_marking *it, int64_t from,
                              int64_t to, int64_t step)
{
    const ritz_inp *all = it->all;
    int64_t at = lower_node(all, from);

    for (; at < all->num_nodes && all->node[at].id <= to; at++) {
        RITZ_CHECK(spend(it, 1));
        if ((all->node[at].id - from) % step == 0)
            it->into[at] |= it->mask;
    }
    return RITZ_OK;
}

static ritz_status mark_named(const ritz_inp_named *named, ritz_inp_marking *it)
{
    const ritz_inp *all = it->all;
    const ritz_inp_named node = look_inside(all, named);
    int64_t set = -1;

    if (node.id > 0)
        return mark_range(it, node.id, node.id, 1);
    RITZ_CHECK(spend(it, all->num_sets));
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
    if (!it->among[set])
        it->set[it->count++] = set;
    it->among[set] = true;
    return RITZ_OK;
}

ritz_status ritz_inp_mark(const ritz_inp *all, const ritz_inp_named *named,
                          uint8_t mask, int64_t *work, uint8_t *into)
{
    int64_t done = *work;
    RITZ_OWN(ritz_inp_marking)
    it = {
        .all = all, .named = named, .mask = mask, .work = &done, .into = into};
    int64_t at = -1;

    if (look_inside(all, named).id > 0) {
        RITZ_CHECK(ritz_inp_locate(all, named, &at));
        into[at] |= mask;
        return RITZ_OK;
    }
    RITZ_CHECK_NEW(it.set, all->num_sets);
    RITZ_CHECK_NEW(it.among, all->num_sets);
    RITZ_CHECK(mark_named(named, &it));
    for (int64_t k = 0; k < it.count; k++)
        for (int64_t m = all->set[it.set[k]].first; m >= 0;
             m = all->member[m].next) {
            const ritz_inp_member *one = &all->member[m];

            RITZ_CHECK(spend(&it, 1));
            if (one->step > 0)
                RITZ_CHECK(mark_range(&it, one->from, one->to, one->step));
            else
                RITZ_CHECK(mark_named(&one->other, &it));
        }
    *work = done;
    return RITZ_OK;
}
