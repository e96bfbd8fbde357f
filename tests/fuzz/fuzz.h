/*
 * Targets of the fuzzer: every reader of files and texts from elsewhere. A
 * target passes bytes to a reader and frees what was read. A finding is a
 * signal, a report of a sanitizer, a leak, a refusal without a sentence, or
 * more memory or time than such an input needs.
 *
 * The working folder belongs to the fuzzer, and targets may write to it.
 */
#ifndef RITZ_TESTS_FUZZ_H
#define RITZ_TESTS_FUZZ_H

#include <ritz/base.h>

#include <stdint.h>

/* Read @p size bytes, which are followed by a NUL. */
typedef void fuzz_run(const char *bytes, int64_t size);

typedef struct fuzz_target {
    const char *name;
    const char *about; /* what is read, for the list */
    fuzz_run *run;
} fuzz_target;

fuzz_run fuzz_output4, fuzz_matrix_market, fuzz_coordinates, fuzz_dmig,
    fuzz_mat, fuzz_matrices, fuzz_deck;
fuzz_run fuzz_matrix_input, fuzz_user_element, fuzz_harwell_boeing;
fuzz_run fuzz_import, fuzz_state_space;
fuzz_run fuzz_scene, fuzz_signal, fuzz_history, fuzz_frames, fuzz_texts;
fuzz_run fuzz_row_table, fuzz_response_table;
fuzz_run fuzz_claims, fuzz_records, fuzz_tracks;
fuzz_run fuzz_container, fuzz_mat_hdf5;
fuzz_run fuzz_fmu;
fuzz_run fuzz_commands, fuzz_initial, fuzz_rank_tracks;

/** Abort unless a reader that ended with @p status succeeded or left a
 * sentence. */
void fuzz_judge(ritz_status status);

/** Write a file into the working folder, in place of any file of that name. */
void fuzz_store(const char *name, const char *bytes, int64_t size);

/** Write the files that a text contains (from its first '>' on), and remove
 * them again, so that the next input does not find them. */
void fuzz_store_files(const char *text);
void fuzz_remove_files(const char *text);

/** Remove the files of a folder. */
void fuzz_empty(const char *folder);

#endif
