#include "formats/bytes.h"

int64_t ritz_bytes_size(int type)
{
    static const int64_t sizes[] = {
        [RITZ_BYTES_INT8] = 1,   [RITZ_BYTES_UINT8] = 1,
        [RITZ_BYTES_INT16] = 2,  [RITZ_BYTES_UINT16] = 2,
        [RITZ_BYTES_INT32] = 4,  [RITZ_BYTES_UINT32] = 4,
        [RITZ_BYTES_SINGLE] = 4, [RITZ_BYTES_DOUBLE] = 8,
        [RITZ_BYTES_INT64] = 8,  [RITZ_BYTES_UINT64] = 8,
    };

    return type >= 0 && type <= RITZ_BYTES_UINT64 ? sizes[type] : 0;
}

double ritz_bytes_value(const unsigned char *at, int type, bool big_endian)
{
    uint64_t bits = ritz_bytes_bits(at, ritz_bytes_size(type), big_endian);

    switch (type) {
    case RITZ_BYTES_INT8:
        return (double)(int8_t)bits;
    case RITZ_BYTES_INT16:
        return (double)(int16_t)bits;
    case RITZ_BYTES_INT32:
        return (double)(int32_t)bits;
    case RITZ_BYTES_INT64:
        return (double)(int64_t)bits;
    case RITZ_BYTES_SINGLE:
        return ritz_bytes_single(at, big_endian);
    case RITZ_BYTES_DOUBLE:
        return ritz_bytes_double(at, big_endian);
    default:
        return (double)bits; /* unsigned */
    }
}
