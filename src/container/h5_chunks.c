/*
 * The values of a vector, written and read chunk by chunk as HDF5 itself would
 * do it, but with a checksum that takes a tenth of the time. The calling thread
 * moves the chunks, since HDF5 may be called by one thread only. Another thread
 * computes the checksums of a large vector: of chunks that are written next, or
 * of chunks that were read last.
 *
 * Fletcher-32 of the 16-bit words w_0 ... w_(n-1), big-endian, is
 *
 *     s_1 = sum w_i,   s_2 = sum (n - i) w_i,   modulo 2^16 - 1,
 *
 * where a sum that is not zero but a multiple of 2^16 - 1 is stored as 2^16 - 1.
 * To swap the bytes of a word is to multiply it by 256 modulo
 * 2^16 - 1, so the words are added as they lie in memory and the sums are
 * multiplied at the end. Four words are added at a time, in the halves of two
 * 64-bit numbers: with r rows of four words, of which word l of row k is
 * w_(4 k + l),
 *
 *     a_l = sum_k w_(4 k + l),   b_l = sum_k (r - k) w_(4 k + l),
 *     s_1 = sum_l a_l,           s_2 = sum_l (4 b_l - l a_l).
 *
 * After m more words, s_2 has grown by m s_1 and by their own s_2.
 */
#include "container/h5.h"

#include "base/alloc.h"
#include "base/team.h"

#include <pthread.h>
#include <string.h>

enum {
    MODULUS = 65535,
    WORD = 8,        /* bytes of a row of four words */
    ROWS = 256,      /* added before halves of 32 bits could overflow: at most
                   MODULUS (1 + ... + ROWS) < 2^32 */
    LARGE = 4 << 20, /* bytes of values from which two threads gain */
    AHEAD = 4,       /* chunks that the faster thread may be ahead */
};

/* Both sums of Fletcher-32 while words are added. */
typedef struct fletcher {
    uint64_t sum[2];
    bool nonzero;
} fletcher;

/*
 * Add at most ROWS rows to both sums, and to *total as ritz_h5_sum() adds them,
 * and copy the rows unless @p to is NULL. All of this is one pass, because each
 * step of ritz_h5_sum() waits for the step before, while the others do not.
 */
static void add_rows(int64_t rows, const unsigned char *at, unsigned char *to,
                     uint64_t *total, fletcher *f)
{
    const uint64_t half = UINT64_C(0x0000ffff0000ffff);
    const uint64_t low = UINT64_C(0xffffffff);
    uint64_t a[2] = {0, 0}, b[2] = {0, 0}, s[2] = {0, 0}, h = *total;

    for (int64_t k = 0; k < rows; k++) {
        uint64_t w = 0;

        memcpy(&w, at + WORD * k, WORD);
        if (to)
            memcpy(to + WORD * k, &w, WORD);
        h = ritz_h5_sum_word(h, w);
        a[0] += w & half;
        a[1] += (w >> 16) & half;
        b[0] += a[0];
        b[1] += a[1];
    }
    s[0] = (a[0] & low) + (a[1] & low) + (a[0] >> 32) + (a[1] >> 32);
    s[1] = 4 * ((b[0] & low) + (b[1] & low) + (b[0] >> 32) + (b[1] >> 32)) -
           (a[1] & low) - 2 * (a[0] >> 32) - 3 * (a[1] >> 32);
    f->nonzero = f->nonzero || s[0] != 0;
    f->sum[1] = (f->sum[1] + 4 * (uint64_t)rows * f->sum[0] + s[1]) % MODULUS;
    f->sum[0] = (f->sum[0] + s[0]) % MODULUS;
    *total = h;
}

/* Add rows, any number of them; s[1] of ROWS rows is less than 2^42. */
static void add_all(int64_t bytes, const unsigned char *at, unsigned char *to,
                    uint64_t *total, fletcher *f)
{
    for (int64_t from = 0; from < bytes; from += (int64_t)ROWS * WORD) {
        const int64_t left = (bytes - from) / WORD;

        add_rows(left < ROWS ? left : ROWS, at + from, to ? to + from : NULL,
                 total, f);
    }
}

static uint32_t end_fletcher(const fletcher *f)
{
    uint32_t out[2] = {0, 0};

    for (int k = 0; k < 2; k++) {
        out[k] = (uint32_t)(256 * f->sum[k] % MODULUS);
        if (out[k] == 0 && f->nonzero)
            out[k] = MODULUS;
    }
    return out[1] << 16 | out[0];
}

uint32_t ritz_h5_fletcher32(int64_t bytes, const void *values)
{
    fletcher f = {0};
    uint64_t unused = 0;

    add_all(bytes, values, NULL, &unused, &f);
    return end_fletcher(&f);
}

/* ---- chunks that pass from one thread to the other ----------------------- */

typedef struct relay {
    pthread_mutex_t lock;
    pthread_cond_t changed;
    hsize_t given, taken; /* chunks */
    bool stopped;         /* no more are given, or none are taken */
} relay;

static void relay_init(relay *r)
{
    *r = (relay){0};
    pthread_mutex_init(&r->lock, NULL);
    pthread_cond_init(&r->changed, NULL);
}

static void relay_end(relay *r)
{
    pthread_cond_destroy(&r->changed);
    pthread_mutex_destroy(&r->lock);
}

/* Wait until a further chunk may be given. @return false if none is taken */
static bool await_room(relay *r)
{
    bool stopped = false;

    pthread_mutex_lock(&r->lock);
    while (!r->stopped && r->given - r->taken == AHEAD)
        pthread_cond_wait(&r->changed, &r->lock);
    stopped = r->stopped;
    pthread_mutex_unlock(&r->lock);
    return !stopped;
}

/* Wait until a further chunk can be taken. @return false if none is given */
static bool await_chunk(relay *r)
{
    bool there = false;

    pthread_mutex_lock(&r->lock);
    while (!r->stopped && r->given == r->taken)
        pthread_cond_wait(&r->changed, &r->lock);
    there = r->given > r->taken;
    pthread_mutex_unlock(&r->lock);
    return there;
}

/* Count a chunk that was given or taken. */
static void count_chunk(relay *r, hsize_t *count)
{
    pthread_mutex_lock(&r->lock);
    ++*count;
    pthread_cond_signal(&r->changed);
    pthread_mutex_unlock(&r->lock);
}

static void stop_relay(relay *r)
{
    pthread_mutex_lock(&r->lock);
    r->stopped = true;
    pthread_cond_signal(&r->changed);
    pthread_mutex_unlock(&r->lock);
}

/* ---- vectors in chunks --------------------------------------------------- */

/* A vector while it is written or read. */
typedef struct vector_in_chunks {
    hid_t set;
    hsize_t count, chunk;   /* values, and values of a chunk */
    unsigned char *values;  /* not written to where they are only read */
    unsigned char *buffer;  /* written: AHEAD chunks, each with its checksum;
                              read: the last chunk */
    uint32_t stored[AHEAD]; /* checksums of the chunks that were read */
    uint64_t sum;           /* of all values, as ritz_h5_sum() */
    bool damaged;           /* the checksum of a chunk does not fit */
    relay relay;
    pthread_t other;
} vector_in_chunks;

hsize_t ritz_h5_chunk(hid_t set, hid_t memory, const ritz_h5_shape *shape)
{
    RITZ_OWN(hid_t) plan = H5Dget_create_plist(set);
    RITZ_OWN(hid_t) type = H5Dget_type(set);
    unsigned flags = 0;
    size_t none = 0;
    hsize_t chunk = 0;

    if (__BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__ || shape->rank != 1 ||
        H5Pget_layout(plan) != H5D_CHUNKED || H5Pget_nfilters(plan) != 1 ||
        H5Pget_filter2(plan, 0, &flags, &none, NULL, 0, NULL, NULL) !=
            H5Z_FILTER_FLETCHER32 ||
        H5Tget_size(type) != WORD || H5Tequal(type, memory) <= 0 ||
        H5Pget_chunk(plan, 1, &chunk) != 1)
        return 0;
    return chunk;
}

bool ritz_h5_chunks_usual(hid_t set, hsize_t chunk, hsize_t count)
{
    for (hsize_t from = 0; from < count; from += chunk) {
        hsize_t stored = 0;

        if (chunk > SIZE_MAX / WORD - 1 ||
            H5Dget_chunk_storage_size(set, &from, &stored) < 0 ||
            stored != WORD * chunk + sizeof(uint32_t))
            return false;
    }
    return true;
}

static hsize_t count_chunks(const vector_in_chunks *v)
{
    return (v->count + v->chunk - 1) / v->chunk;
}

static size_t chunk_bytes(const vector_in_chunks *v)
{
    return (size_t)(WORD * v->chunk);
}

/* Bytes of the values of chunk @p k: fewer than its size in the last one. */
static size_t used_bytes(const vector_in_chunks *v, hsize_t k)
{
    const hsize_t left = v->count - k * v->chunk;

    return (size_t)(WORD * (left < v->chunk ? left : v->chunk));
}

static unsigned char *chunk_values(const vector_in_chunks *v, hsize_t k)
{
    return v->values + k * chunk_bytes(v);
}

/* Start the other thread if the vector is large. */
static bool start_other(vector_in_chunks *v, void *(*run)(void *))
{
    relay_init(&v->relay);
    return WORD * v->count >= LARGE && ritz_team_ready(2) > 1 &&
           ritz_team_start(run, v, &v->other);
}

/* ---- writing ------------------------------------------------------------- */

static unsigned char *chunk_buffer(const vector_in_chunks *v, hsize_t k)
{
    return v->buffer + k % AHEAD * (chunk_bytes(v) + sizeof(uint32_t));
}

/* A last chunk that is not full is filled with zeros, as HDF5 fills it. */
static void prepare_chunk(vector_in_chunks *v, hsize_t k)
{
    const size_t size = chunk_bytes(v), used = used_bytes(v, k);
    unsigned char *to = chunk_buffer(v, k);
    fletcher f = {0};
    uint64_t unused = 0;
    uint32_t sum = 0;

    add_all((int64_t)used, chunk_values(v, k), to, &v->sum, &f);
    memset(to + used, 0, size - used);
    add_all((int64_t)(size - used), to + used, NULL, &unused, &f);
    sum = end_fletcher(&f);
    memcpy(to + size, &sum, sizeof sum);
}

static herr_t write_chunk(const vector_in_chunks *v, hsize_t k)
{
    const hsize_t from = k * v->chunk;

    return H5Dwrite_chunk(v->set, H5P_DEFAULT, 0, &from,
                          chunk_bytes(v) + sizeof(uint32_t),
                          chunk_buffer(v, k));
}

static void *prepare_chunks(void *argument)
{
    vector_in_chunks *v = argument;
    const hsize_t chunks = count_chunks(v);

    ritz_team_member();
    for (hsize_t k = 0; k < chunks && await_room(&v->relay); k++) {
        prepare_chunk(v, k);
        count_chunk(&v->relay, &v->relay.given);
    }
    return NULL;
}

static herr_t write_prepared(vector_in_chunks *v)
{
    const hsize_t chunks = count_chunks(v);
    herr_t result = 0;

    for (hsize_t k = 0; k < chunks && result >= 0; k++) {
        (void)await_chunk(&v->relay);
        result = write_chunk(v, k);
        count_chunk(&v->relay, &v->relay.taken);
    }
    stop_relay(&v->relay);
    pthread_join(v->other, NULL);
    return result;
}

static herr_t write_chunks(vector_in_chunks *v)
{
    const hsize_t chunks = count_chunks(v);
    herr_t result = 0;

    if (start_other(v, prepare_chunks))
        return write_prepared(v);
    for (hsize_t k = 0; k < chunks && result >= 0; k++) {
        prepare_chunk(v, k);
        result = write_chunk(v, k);
    }
    return result;
}

ritz_status ritz_h5_write_chunks(hid_t set, const char *name, hsize_t chunk,
                                 hsize_t count, const void *values,
                                 uint64_t *sum)
{
    vector_in_chunks v = {
        .set = set, .count = count, .chunk = chunk, .sum = RITZ_H5_SUM};
    RITZ_OWN_ARRAY unsigned char *buffer = NULL;
    herr_t result = 0;

    memcpy(&v.values, &values, sizeof v.values); /* they are only read */
    RITZ_CHECK_RAW(buffer,
                   AHEAD * (int64_t)(chunk_bytes(&v) + sizeof(uint32_t)));
    v.buffer = buffer;
    result = write_chunks(&v);
    relay_end(&v.relay);
    RITZ_REFUSE_IF(result < 0, RITZ_ERR_FILE,
                   "cannot write '%s', is the disk full?", name);
    *sum = v.sum;
    return RITZ_OK;
}

/* ---- reading ------------------------------------------------------------- */

/*
 * A chunk is read to its place among the values. Its checksum comes to the
 * place of the next chunk, which is read later; a last chunk is read to the
 * buffer, and its values are copied.
 */
static herr_t read_chunk(vector_in_chunks *v, hsize_t k)
{
    const hsize_t from = k * v->chunk;
    const bool last = k + 1 == count_chunks(v);
    const size_t size = chunk_bytes(v);
    unsigned char *to = last ? v->buffer : chunk_values(v, k);
    hsize_t stored = 0;
    uint32_t filters = 0;

    if (H5Dget_chunk_storage_size(v->set, &from, &stored) < 0 ||
        stored != size + sizeof(uint32_t) ||
        H5Dread_chunk(v->set, H5P_DEFAULT, &from, &filters, to) < 0 ||
        filters != 0)
        return -1;
    memcpy(&v->stored[k % AHEAD], to + size, sizeof *v->stored);
    if (last)
        memcpy(chunk_values(v, k), to, used_bytes(v, k));
    return 0;
}

static void verify_chunk(vector_in_chunks *v, hsize_t k)
{
    const bool last = k + 1 == count_chunks(v);
    const unsigned char *at = last ? v->buffer : chunk_values(v, k);

    const size_t used = used_bytes(v, k);
    fletcher f = {0};
    uint64_t unused = 0;

    add_all((int64_t)used, at, NULL, &v->sum, &f);
    add_all((int64_t)(chunk_bytes(v) - used), at + used, NULL, &unused, &f);
    v->damaged = v->damaged || end_fletcher(&f) != v->stored[k % AHEAD];
}

static void *verify_chunks(void *argument)
{
    vector_in_chunks *v = argument;

    ritz_team_member();
    for (hsize_t k = 0; await_chunk(&v->relay); k++) {
        verify_chunk(v, k);
        count_chunk(&v->relay, &v->relay.taken);
    }
    return NULL;
}

static herr_t read_chunks(vector_in_chunks *v)
{
    const bool apart = start_other(v, verify_chunks);
    const hsize_t chunks = count_chunks(v);
    herr_t result = 0;

    for (hsize_t k = 0; k < chunks && result >= 0; k++) {
        if (apart)
            (void)await_room(&v->relay);
        result = read_chunk(v, k);
        if (result >= 0 && apart)
            count_chunk(&v->relay, &v->relay.given);
        else if (result >= 0)
            verify_chunk(v, k);
    }
    if (apart) {
        stop_relay(&v->relay);
        pthread_join(v->other, NULL);
    }
    return v->damaged ? -1 : result;
}

ritz_status ritz_h5_read_chunks(hid_t set, const char *name, hsize_t chunk,
                                hsize_t count, void *values, uint64_t *sum)
{
    vector_in_chunks v = {.set = set,
                          .count = count,
                          .chunk = chunk,
                          .values = values,
                          .sum = RITZ_H5_SUM};
    RITZ_OWN_ARRAY unsigned char *buffer = NULL;
    herr_t result = 0;

    RITZ_CHECK_RAW(buffer, (int64_t)(chunk_bytes(&v) + sizeof(uint32_t)));
    v.buffer = buffer;
    result = read_chunks(&v);
    relay_end(&v.relay);
    RITZ_REFUSE_IF(result < 0, RITZ_ERR_FORMAT, "'%s' is damaged", name);
    *sum = v.sum;
    return RITZ_OK;
}
