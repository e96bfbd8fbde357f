/* Files of matrices and decks: recognised by content, and what a user may ask
 * of them. */
#include "base/alloc.h"
#include "base/bytes.h"
#include "base/draft.h"
#include "base/mapped.h"
#include "base/text.h"
#include "formats/matrix.h"

#include <ritz/import.h>

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

static const ritz_format *recognise_format(const char *bytes, int64_t size)
{
    for (int k = 0; ritz_formats[k]; k++)
        if (ritz_formats[k]->recognise(bytes, size))
            return ritz_formats[k];
    return NULL;
}

/* Map a file whose format allows that; others are copied. */
static ritz_status read_file(const char *path, ritz_foreign *file)
{
    file->mapped = ritz_mapped_new(path);
    if (file->mapped) {
        file->bytes = ritz_mapped_bytes(file->mapped, &file->size);
        file->format = recognise_format(file->bytes, file->size);
        if (file->format && file->format->maps)
            return ritz_draft_protect(path);
        ritz_mapped_free(&file->mapped);
    }
    RITZ_CHECK(ritz_bytes_read(path, &file->size, &file->owned));
    file->bytes = file->owned;
    file->format = recognise_format(file->bytes, file->size);
    return RITZ_OK;
}

ritz_status ritz_foreign_open(const char *path, ritz_foreign *out)
{
    RITZ_OWN(ritz_foreign) file = {0};

    RITZ_CHECK(read_file(path, &file));
    RITZ_CHECK(ritz_path_folder(path, &file.folder));
    RITZ_CHECK_COPY(file.path, path, (int64_t)strlen(path) + 1);
    RITZ_CHECK(ritz_digest_begin(file.bytes, file.size, &file.summing));
    if (file.format && file.format->admit)
        RITZ_CHECK(ritz_foreign_context(
            &file, file.format->admit(file.bytes, file.size)));
    RITZ_MOVE(*out, file);
    return RITZ_OK;
}

const char *ritz_foreign_digest(ritz_foreign *file)
{
    ritz_digest_end(&file->summing, file->digest);
    return file->digest;
}

/* What reading returned, unless the file was changed in the meantime. */
static ritz_status check_change(const ritz_foreign *file, ritz_status status)
{
    RITZ_REFUSE_IF(file->mapped && ritz_mapped_changed(file->mapped),
                   RITZ_ERR_FILE, "was changed while it was read");
    return status;
}

ritz_status ritz_foreign_list(ritz_foreign *file)
{
    char known[RITZ_MESSAGE_SIZE] = "";
    size_t used = 0;

    RITZ_REFUSE_IF(file->size == 0, RITZ_ERR_FORMAT, "is empty");
    for (int k = 0; ritz_formats[k] && used < sizeof known; k++)
        used += (size_t)snprintf(known + used, sizeof known - used, "%s%s",
                                 k > 0 ? ", " : "", ritz_formats[k]->name);
    if (!file->format)
        RITZ_CHECK(ritz_unread_refuse(file->bytes, file->size));
    RITZ_REFUSE_IF(!file->format, RITZ_ERR_FORMAT,
                   "holds no matrix in a format that is known: %s", known);
    if (file->listing.count > 0) /* it is there already */
        return RITZ_OK;
    return check_change(file, file->format->list(file, &file->listing));
}

ritz_status ritz_foreign_take(const ritz_foreign *file, int64_t k,
                              ritz_matrix *out)
{
    return check_change(file,
                        file->format->read(file, &file->listing.item[k], out));
}

/* A long path is cut to what leaves room for the rest of a sentence. */
ritz_status ritz_foreign_context(const ritz_foreign *file, ritz_status status)
{
    enum { MOST = 184 };
    char what[MOST + 8];
    size_t length = strlen(file->path);
    bool cut = length > MOST;

    snprintf(what, sizeof what, "'%s%s'", cut ? "..." : "",
             file->path + (cut ? length - MOST : 0));
    return ritz_context(status, what);
}

void ritz_foreign_free(ritz_foreign *file)
{
    ritz_digest_end(&file->summing, NULL);
    ritz_listing_clear(&file->listing);
    ritz_mapped_free(&file->mapped);
    RITZ_FREE(file->path, file->folder, file->owned, file->listing.item);
    *file = (ritz_foreign){0};
}

/* ---- one by name -------------------------------------------------------- */

static size_t padded_length(const char *text, size_t length)
{
    while (length > 0 && text[length - 1] == ' ')
        length--;
    return length;
}

/* Names are one if they differ by case and trailing blanks only. */
static bool same_name(const char *a, const char *b, size_t length)
{
    size_t n = padded_length(a, strlen(a));

    return n == padded_length(b, length) && strncasecmp(a, b, n) == 0;
}

/* A spec taken apart; `name` NULL where there is none. */
typedef struct spec {
    int64_t path; /* length of the file's name */
    const char *name;
    size_t length; /* of the name */
    int64_t which; /* K from 1, 0 where there is none */
} spec;

/* The last colon parts file and name, unless the whole is a file's name. */
static spec split_spec(const char *text)
{
    spec s = {.path = (int64_t)strlen(text)};
    const char *colon = strrchr(text, ':');
    const char *mark = NULL;
    struct stat there;

    if (!colon || colon == text || strchr(colon, '/') ||
        stat(text, &there) == 0)
        return s;
    s.path = colon - text;
    s.name = colon + 1;
    s.length = strlen(s.name);
    mark = strrchr(s.name, '#');
    if (mark && ritz_text_whole(mark + 1, &s.which) && s.which > 0)
        s.length = (size_t)(mark - s.name);
    else
        s.which = 0;
    return s;
}

ritz_status ritz_foreign_path(const char *spec_text, char **out)
{
    spec s = split_spec(spec_text);

    RITZ_CHECK_NEW(*out, s.path + 1);
    memcpy(*out, spec_text, (size_t)s.path);
    return RITZ_OK;
}

static bool has_name(const ritz_listed *item, const spec *s)
{
    return strlen(item->name) == s->length &&
           strncmp(item->name, s->name, s->length) == 0;
}

/* Names are compared as they stand; if none is equal, without their case. */
static bool is_named(const ritz_listed *item, const spec *s, bool exact)
{
    if (!s->name)
        return !item->other[0];
    return exact ? has_name(item, s)
                 : same_name(item->name, s->name, s->length);
}

static int64_t count_name(const ritz_listing *all, const char *name,
                          int64_t from)
{
    int64_t count = 0;

    for (int64_t k = from; k < all->count; k++)
        count += same_name(all->item[k].name, name, strlen(name));
    return count;
}

/* "KAA (3 times), MAA": each name once, in the file's order. */
static void list_names(const ritz_listing *all, char *text, size_t size)
{
    size_t used = 0;

    text[0] = '\0';
    for (int64_t k = 0; k < all->count; k++) {
        const char *name = all->item[k].name;
        int64_t times = count_name(all, name, 0);
        int more = 0;

        if (count_name(all, name, k) < times)
            continue;
        if (used + RITZ_NAME_SIZE + 32 > size) {
            snprintf(text + used, size - used, ", ...");
            return;
        }
        more = snprintf(text + used, size - used, "%s%s", used > 0 ? ", " : "",
                        name[0] ? name : "one without a name");
        used += (size_t)more;
        if (times > 1)
            used += (size_t)snprintf(text + used, size - used,
                                     " (%" PRId64 " times)", times);
    }
}

/* The index of the matrix that the spec names. */
static ritz_status find_index(const ritz_listing *all, const spec *s,
                              const char *file, int64_t *out)
{
    char holds[220];
    const char *first = all->item[0].name;
    const char *base = ritz_path_name(file);
    int64_t found = -1;
    int64_t times = 0;
    bool exact = false;

    for (int64_t k = 0; k < all->count && s->name && !exact; k++)
        exact = has_name(&all->item[k], s);
    for (int64_t k = 0; k < all->count; k++) {
        if (!is_named(&all->item[k], s, exact))
            continue;
        times++;
        if (times == 1 || times == s->which)
            found = k;
    }
    list_names(all, holds, sizeof holds);
    RITZ_REFUSE_IF(!s->name && times > 1, RITZ_ERR_ARGUMENT,
                   "'%.80s' holds %s: name one, as %.80s:%s%s", base, holds,
                   base, first, count_name(all, first, 0) > 1 ? "#1" : "");
    RITZ_REFUSE_IF(!s->name && times == 0, RITZ_ERR_FORMAT,
                   "'%.80s' holds no matrix, but %s", base, holds);
    RITZ_REFUSE_IF(times == 0, RITZ_ERR_ARGUMENT,
                   "'%.80s' holds no '%.*s', but %s", base,
                   (int)(s->length % 80), s->name, holds);
    RITZ_REFUSE_IF(s->which > times, RITZ_ERR_ARGUMENT,
                   "'%.80s' holds %.*s %" PRId64 " times, so that #%" PRId64
                   " is not among them",
                   base, (int)(s->length % 80), s->name, times, s->which);
    RITZ_REFUSE_IF(s->which == 0 && times > 1, RITZ_ERR_ARGUMENT,
                   "'%.80s' holds %s: say which, as %.80s:%.*s#1", base, holds,
                   base, (int)(s->length % 80), s->name);
    *out = found;
    return RITZ_OK;
}

/* The matrix that a spec of this file names. */
static ritz_status take_named(ritz_foreign *file, const char *spec_text,
                              ritz_matrix *out)
{
    spec s = split_spec(spec_text);
    int64_t which = 0;

    RITZ_CHECK(ritz_foreign_context(file, ritz_foreign_list(file)));
    RITZ_REFUSE_IF(!file->format || file->listing.count == 0, RITZ_ERR_FORMAT,
                   "'%.200s' holds no matrix", file->path);
    RITZ_CHECK(find_index(&file->listing, &s, file->path, &which));
    RITZ_REFUSE_IF(file->listing.item[which].other[0], RITZ_ERR_FORMAT,
                   "'%.200s' is %s", spec_text,
                   file->listing.item[which].other);
    return ritz_foreign_context(file, ritz_foreign_take(file, which, out));
}

/* ---- several ------------------------------------------------------------ */

ritz_status ritz_file_sums_add(ritz_file_sums *sums, const char *path,
                               const char digest[RITZ_DIGEST_SIZE])
{
    ritz_file_sum *sum = NULL;

    RITZ_CHECK_ROOM(sums->sum, sums->count, sums->room);
    sum = &sums->sum[sums->count];
    RITZ_CHECK_COPY(sum->path, path, (int64_t)strlen(path) + 1);
    memcpy(sum->digest, digest, RITZ_DIGEST_SIZE);
    sums->count++;
    return RITZ_OK;
}

void ritz_file_sums_free(ritz_file_sums *sums)
{
    for (int64_t k = 0; k < sums->count; k++)
        free(sums->sum[k].path);
    free(sums->sum);
    *sums = (ritz_file_sums){0};
}

/* True if a spec names a matrix of the file that is open. */
static bool is_of_file(const char *path, const char *spec_text)
{
    spec s = split_spec(spec_text);

    return strlen(path) == (size_t)s.path &&
           memcmp(path, spec_text, (size_t)s.path) == 0;
}

static ritz_status add_context(const char *what, ritz_status status)
{
    return what ? ritz_context(status, what) : status;
}

/* Take all that is wanted of the file of wanted[k]. */
static ritz_status take_of_file(int64_t k, int64_t count,
                                const ritz_wanted *wanted, bool *taken,
                                ritz_file_sums *sums)
{
    RITZ_OWN(ritz_foreign) file = {0};
    RITZ_OWN_ARRAY char *path = NULL;

    RITZ_CHECK(ritz_foreign_path(wanted[k].spec, &path));
    RITZ_CHECK(add_context(wanted[k].what, ritz_foreign_open(path, &file)));
    for (; k < count; k++) {
        if (taken[k] || !is_of_file(path, wanted[k].spec))
            continue;
        taken[k] = true;
        RITZ_CHECK(add_context(
            wanted[k].what, take_named(&file, wanted[k].spec, wanted[k].into)));
    }
    if (!sums)
        return RITZ_OK;
    RITZ_CHECK(ritz_file_sums_add(sums, path, ritz_foreign_digest(&file)));
    return ritz_foreign_context(&file, check_change(&file, RITZ_OK));
}

ritz_status ritz_foreign_collect(int64_t count, const ritz_wanted *wanted,
                                 ritz_file_sums *sums)
{
    RITZ_OWN_ARRAY bool *taken = NULL;

    RITZ_CHECK_NEW(taken, count);
    for (int64_t k = 0; k < count; k++)
        if (!taken[k])
            RITZ_CHECK(take_of_file(k, count, wanted, taken, sums));
    return RITZ_OK;
}

/* ---- decks -------------------------------------------------------------- */

const ritz_deck_format *ritz_deck_recognise(const char *bytes, int64_t size)
{
    for (int k = 0; ritz_decks[k]; k++)
        if (ritz_decks[k]->recognise(bytes, size))
            return ritz_decks[k];
    return NULL;
}

ritz_status ritz_deck_parse(const char *path, const char *bytes, int64_t size,
                            const char *folder, ritz_deck *out)
{
    const ritz_deck_format *format = ritz_deck_recognise(bytes, size);
    RITZ_OWN(ritz_deck) deck = {0};

    RITZ_CHECK_IN(path ? path : "the deck", ritz_unread_refuse(bytes, size));
    RITZ_REFUSE_IF(!format, RITZ_ERR_FORMAT,
                   "'%s' is not a text file, as all decks are that Ritz knows",
                   path ? path : "the deck");
    RITZ_CHECK(format->parse(path, bytes, size, folder, &deck));
    deck.format = format;
    RITZ_MOVE(*out, deck);
    return RITZ_OK;
}

ritz_status ritz_deck_read(const char *path, ritz_deck *out)
{
    RITZ_OWN_ARRAY char *bytes = NULL;
    RITZ_OWN_ARRAY char *folder = NULL;
    int64_t size = 0;

    RITZ_CHECK(ritz_path_folder(path, &folder));
    RITZ_CHECK(ritz_bytes_read(path, &size, &bytes));
    return ritz_deck_parse(path, bytes, size, folder, out);
}

void ritz_deck_free(ritz_deck *deck)
{
    ritz_grids_free(&deck->grids);
    RITZ_FREE(deck->point, deck->dof, deck->fixed);
    for (int k = 0; k < RITZ_NUM_SETS; k++)
        free(deck->set[k]);
    free(deck->constraint);
    ritz_equations_free(&deck->equations);
    ritz_elements_free(&deck->elements);
    RITZ_FREE(deck->external, deck->external_twice, deck->imposed,
              deck->unnumbered);
    *deck = (ritz_deck){0};
}
