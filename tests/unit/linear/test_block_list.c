/* A list of blocks whose last ones are in a file: products have the same bits
   wherever a block is. */
#include "linear/block_list.h"

#include "base/team.h"
#include "testing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    B = RITZ_BLOCK,
    SQUARE = RITZ_SQUARE,
    N = 1000,
    BLOCKS = 6,
    KEPT = 4,
    WIDTH = 2,
};

/* What a list of blocks, with `held` of them in memory, makes of the same
   numbers. */
typedef struct results {
    double projected[WIDTH * BLOCKS * SQUARE];
    double X[WIDTH * N * B];
    double V[KEPT * N * B]; /* combined */
    double moved[N * B];
} results;

static void fill(int64_t count, double seed, double *x)
{
    for (int64_t i = 0; i < count; i++)
        x[i] = sin((double)(i + 1) * seed);
}

static void copy_block(const ritz_block_list *V, int64_t j, double *to)
{
    const double *block = NULL;

    assert_ok(ritz_block_list_look(V, j, &block));
    memcpy(to, block, (size_t)N * B * sizeof *to);
}

static void put_blocks(ritz_block_list *V)
{
    for (int64_t j = 0; j < BLOCKS; j++) {
        double *W = malloc((size_t)N * B * sizeof *W);

        assert_non_null(W);
        fill((int64_t)N * B, 1.0 + (double)j, W);
        assert_ok(ritz_block_list_put(V, j, j % 2 == 0, &W));
        free(W);
    }
}

static void compute(int64_t held, results *out)
{
    RITZ_OWN(ritz_block_list) V = {0};
    RITZ_OWN(ritz_blocks) on = {0};
    double C[KEPT * BLOCKS * SQUARE];
    double *room = NULL;

    assert_ok(ritz_blocks_new(N, ritz_team_ready(2), WIDTH * BLOCKS, &on));
    room = calloc((size_t)ritz_blocks_room(&on, KEPT), sizeof *room);
    assert_non_null(room);
    assert_ok(ritz_block_list_new(N, BLOCKS, &V));
    if (held < BLOCKS)
        assert_ok(ritz_block_list_limit(&V, held));
    put_blocks(&V);
    fill((int64_t)WIDTH * N * B, 0.3, out->X);
    assert_ok(ritz_block_list_project(&V, &on, 1, BLOCKS - 1, WIDTH, out->X,
                                      out->projected));
    assert_ok(ritz_block_list_add(&V, &on, 1, BLOCKS - 1, WIDTH, out->projected,
                                  out->X));
    fill((int64_t)KEPT * BLOCKS * SQUARE, 0.7, C);
    assert_ok(ritz_block_list_combine(&V, &on, BLOCKS, KEPT,
                                      (int64_t)BLOCKS * SQUARE, C, room));
    for (int64_t j = 0; j < KEPT; j++)
        copy_block(&V, j, out->V + j * N * B);
    assert_ok(ritz_block_list_move(&V, BLOCKS - 1, 1));
    copy_block(&V, 1, out->moved);
    ritz_block_list_shorten(&V, 0);
    free(room);
}

static void blocks_in_a_file_have_the_same_bits(void **state)
{
    static results all, some;

    (void)state;
    unsetenv("TMPDIR"); /* the user's may be in memory */
    ritz_set_threads(2);
    compute(BLOCKS, &all);
    for (int64_t held = 0; held < BLOCKS; held++) {
        memset(&some, 0, sizeof some);
        compute(held, &some);
        assert_memory_equal(all.projected + SQUARE, some.projected + SQUARE,
                            SQUARE * sizeof(double));
        assert_memory_equal(&all, &some, sizeof all);
    }
    ritz_set_threads(1);
    assert_true(ritz_disk_used() >= BLOCKS * N * B * (int64_t)sizeof(double));
}

static void a_folder_that_is_not_there_is_refused(void **state)
{
    RITZ_OWN(ritz_block_list) V = {0};

    (void)state;
    assert_ok(ritz_block_list_new(N, BLOCKS, &V));
    setenv("TMPDIR", "/nowhere", 1);
    assert_fails(ritz_block_list_limit(&V, 0), RITZ_ERR_MEMORY,
                 "the Lanczos basis cannot be written to '/nowhere'");
    unsetenv("TMPDIR");
    assert_int_equal(V.held, BLOCKS);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(blocks_in_a_file_have_the_same_bits),
    cmocka_unit_test(a_folder_that_is_not_there_is_refused),
};

TEST_MODULE(block_list, tests, NULL, NULL)
