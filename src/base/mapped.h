/*
 * Large files mapped into memory: their pages are those of the system's cache,
 * and neither copied nor cleared.
 *
 * If another program shortens a mapped file, the system sends SIGBUS to a thread
 * that reads what is gone. A handler puts zeros there, and notes it.
 */
#ifndef RITZ_BASE_MAPPED_H
#define RITZ_BASE_MAPPED_H

#include <ritz/base.h>

/**
 * Let files be mapped from now on, by a handler of SIGBUS for the whole process,
 * which calls the handler before it for all other faults. A program that sets a
 * handler of its own later calls this again. Until then no file is mapped.
 */
void ritz_map_files(void);

typedef struct ritz_mapped ritz_mapped;

/**
 * Map a regular file of 4 MiB or more.
 *
 * @return freed by ritz_mapped_free(); NULL if the file is to be copied instead:
 *         it is small, no NUL would follow its bytes, or eight are mapped
 */
ritz_mapped *ritz_mapped_new(const char *path);

/** Its bytes, which a NUL follows as long as the file is not changed. */
const char *ritz_mapped_bytes(const ritz_mapped *mapped, int64_t *size);

/** Whether the file was changed since it was mapped, as far as its size, its
 * time of modification and faults tell. */
bool ritz_mapped_changed(const ritz_mapped *mapped);

/** *mapped may be NULL, and becomes NULL. */
void ritz_mapped_free(ritz_mapped **mapped);

#endif
