/*
 * The program: the two functions that libFuzzer calls, and the table of
 * targets.
 */
#include "fuzz.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* NOLINTBEGIN(readability-identifier-naming, readability-non-const-parameter) */
int LLVMFuzzerInitialize(int *argc, char ***argv);
int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

static const fuzz_target targets[] = {
    {"output4", "NASTRAN OUTPUT4, text and binary", fuzz_output4},
    {"matrix-market", "Matrix Market", fuzz_matrix_market},
    {"coordinates", "entries without a header", fuzz_coordinates},
    {"harwell-boeing", "Harwell-Boeing and Rutherford-Boeing",
     fuzz_harwell_boeing},
    {"dmig", "DMIG and punch files", fuzz_dmig},
    {"matrix-input", "MATRIX INPUT of Abaqus and CalculiX", fuzz_matrix_input},
    {"user-element", "substructures of Abaqus and CalculiX", fuzz_user_element},
    {"mat", "MAT level 5, compressed too", fuzz_mat},
    {"mat-hdf5", "MAT 7.3, sound HDF5 with any content", fuzz_mat_hdf5},
    {"matrices", "any file of matrices, and what is not read", fuzz_matrices},
    {"deck", "NASTRAN bulk data, input files of Abaqus, ANSYS and CalculiX",
     fuzz_deck},
    {"import", "options and files of ritz-import", fuzz_import},
    {"state-space", "the same of a state space", fuzz_state_space},
    {"container", "containers, sound HDF5 with any content", fuzz_container},
    {"fmu", "resources of FMUs, and a step of them", fuzz_fmu},
    {"scene", "scenes, and settings of --at", fuzz_scene},
    {"response-table", "measured responses as columns of text",
     fuzz_response_table},
    {"signal", "signals of ritz-simulate, and their tables", fuzz_signal},
    {"history", "coordinates over time, of Exudyn, FMPy and MBDyn",
     fuzz_history},
    {"frames", "collections of VTK and their frames, as charts draw them",
     fuzz_frames},
    {"row-table", "tables of NASTRAN that name rows", fuzz_row_table},
    {"texts", "values of options", fuzz_texts},
    {"claims", "claims files; no tool is run", fuzz_claims},
    {"records", "files of --record", fuzz_records},
    {"tracks", "tables of --tracks, as charts draw them", fuzz_tracks},
    {"commands", "command lines, with files that they name", fuzz_commands},
    {"initial", "values of --initial and --input, and their files",
     fuzz_initial},
    {"rank-tracks", "tables of --tracks, as ritz-rank takes them",
     fuzz_rank_tracks},
};

enum { NUM_TARGETS = sizeof targets / sizeof *targets };

static const fuzz_target *chosen;

void fuzz_judge(ritz_status status)
{
    if (status == RITZ_OK || *ritz_error_message())
        return;
    fprintf(stderr, "status %d without a sentence\n", (int)status);
    abort();
}

static void list_targets(void)
{
    for (int k = 0; k < NUM_TARGETS; k++)
        printf("%-14s %s\n", targets[k].name, targets[k].about);
    exit(0);
}

/* "--target=NAME" selects a target, and libFuzzer ignores it; "--list" lists
   the targets and ends. */
int LLVMFuzzerInitialize(int *argc, char ***argv)
{
    static const char option[] = "--target=";
    const size_t length = sizeof option - 1;
    const char *name = "";

    for (int k = 1; k < *argc; k++) {
        if (strcmp((*argv)[k], "--list") == 0)
            list_targets();
        if (strncmp((*argv)[k], option, length) == 0)
            name = (*argv)[k] + length;
    }
    for (int k = 0; k < NUM_TARGETS && !chosen; k++)
        if (strcmp(targets[k].name, name) == 0)
            chosen = &targets[k];
    if (chosen)
        return 0;
    fprintf(stderr, "there is no target '%s': --list has all\n", name);
    exit(2);
}

/* The copy is as long as the input, so that AddressSanitizer detects each
   overrun. */
int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    char *copy = malloc(size + 1);

    if (!copy)
        return 0;
    if (size > 0)
        memcpy(copy, bytes, size);
    copy[size] = '\0';
    ritz_record("%s", "");
    chosen->run(copy, (int64_t)size);
    free(copy);
    return 0;
}
/* NOLINTEND(readability-identifier-naming, readability-non-const-parameter) */
