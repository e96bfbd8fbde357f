/*
 * Targets of the fuzzer: every reader of files and texts that others wrote. A
 * target gets bytes, hands them to a reader and drops what it read; what must
 * not happen is a signal, a report of a sanitizer, a leak, a refusal without a
 * sentence, more memory or more time than such an input deserves.
 *
 * The working folder is the fuzzer's own, and may be written to.
 */
#ifndef RITZ_TESTS_FUZZ_H
#define RITZ_TESTS_FUZZ_H

#include <ritz/base.h>

#include <stdint.h>

/* Reads @p size bytes, which a NUL follows. */
typedef void fuzz_run(const char *bytes, int64_t size);

typedef struct fuzz_target {
    const char *name;
    const char *about; /* what is read, for the list */
    fuzz_run *run;
} fuzz_target;

fuzz_run fuzz_output4, fuzz_matrix_market, fuzz_dmig, fuzz_mat, fuzz_matrices,
    fuzz_deck;
fuzz_run fuzz_import, fuzz_state_space;
fuzz_run fuzz_scene, fuzz_signal, fuzz_texts;
fuzz_run fuzz_claims, fuzz_records, fuzz_tracks;
fuzz_run fuzz_container, fuzz_mat_hdf5;
fuzz_run fuzz_commands, fuzz_initial, fuzz_rank_tracks;

/** A reader ended so: abort unless it worked or says why not. */
void fuzz_judge(ritz_status status);

/** Write a file into the working folder, which replaces one of that name. */
void fuzz_store(const char *name, const char *bytes, int64_t size);

/** Write the files of a text that begins with '>', and take away those of a text
 * again: they are no part of the next input. */
void fuzz_store_files(const char *text);
void fuzz_remove_files(const char *text);

/** Remove the files of a folder. */
void fuzz_empty(const char *folder);

#endif
