#include "linear/lanczos_room.h"

#include "linear/block_basis.h"
#include "linear/folded.h"

enum {
    B = RITZ_BLOCK,
    SQUARE = RITZ_SQUARE,
    WIDEST = RITZ_STEP_WIDEST,
    MORE_BLOCKS = 12, /* room in addition to 4 k vectors, for small k */
    MANY = 100,       /* pairs from which steps of two blocks are faster */
};

int64_t ritz_lanczos_width(const ritz_lanczos_plan *plan)
{
    const int64_t usual = plan->k < MANY ? 1 : WIDEST;

    return plan->width > 0 ? plan->width : usual;
}

int64_t ritz_lanczos_blocks(const ritz_lanczos_plan *plan, int64_t n)
{
    const int64_t width = ritz_lanczos_width(plan);
    const int64_t most = (n + B - 1) / B;
    int64_t room = plan->room > 0 ? plan->room / B
                                  : (4 * plan->k + B - 1) / B + MORE_BLOCKS;

    room = room < most ? room : most;
    return (room + width - 1) / width * width;
}

int64_t ritz_lanczos_found(int64_t k)
{
    return (k + RITZ_LANCZOS_SPARES + B - 1) / B;
}

int64_t ritz_lanczos_meanwhile(int64_t n, int64_t k, int64_t room)
{
    enum { THREADS = 4 }; /* more make little difference */
    const int64_t order = room * B;
    const int64_t coefficients =
        2 * (order + (int64_t)WIDEST * B) * (k + RITZ_LANCZOS_SPARES) +
        room * (1 + THREADS) * WIDEST * SQUARE;

    return (int64_t)sizeof(double) *
           (order * (2 * order + 9) + coefficients + 2 * n * B);
}

int64_t ritz_block_lanczos_needs(const ritz_shifted *S, int64_t k, bool folded)
{
    const ritz_lanczos_plan plan = {.k = k};
    const int64_t n = S->K->nrow;
    const int64_t room = ritz_lanczos_blocks(&plan, n);
    const int64_t order = room * B;
    const int64_t width = ritz_lanczos_width(&plan);
    const int64_t few = ritz_lanczos_found(k) + 1 + RITZ_BLOCK_WINDOW;
    const int64_t blocks = (few < room ? few : room) + (width + 1) * width;
    const int64_t entries = S->M->colptr[n];
    int64_t bytes =
        (int64_t)sizeof(double) * (blocks * n * B + 2 * order * order) +
        ritz_lanczos_meanwhile(n, k, room) + 12 * entries;

    if (folded)
        bytes -= ritz_folded_saves(n, S->K->colptr[n]) + 16 * entries;
    return bytes > 0 ? bytes : 0;
}
