/*
 * What a method is told beside how many vectors it makes: one table of words
 * that options (--shift-hz 0,5) and scenes (shift_hz: [0, 5]) share.
 */
#ifndef RITZ_CHOICE_H
#define RITZ_CHOICE_H

#include <ritz/damping.h>
#include <ritz/status.h>

#include <stdint.h>

enum { RITZ_MOST_SHIFTS = 16 };

/* What a method heeds of a request; the rest must be left alone. */
enum {
    RITZ_USES_MODES = 1,
    RITZ_USES_ATTACHED = 2,
    RITZ_USES_SHIFTS = 4,
    RITZ_USES_LOADS = 8,
    RITZ_USES_INNER = 16,
    RITZ_USES_INTERFACE = 32,
    RITZ_USES_GRAMIAN = 64,
    RITZ_USES_OPERATOR = 128,
    RITZ_USES_DAMPING = 256,
    RITZ_USES_NEIGHBOUR = 512,
};

/* Forces that vectors answer; what is read gives as many: H K^-1 F. */
enum {
    RITZ_LOADS_ATTACHED = 1, /* unit forces at the attached dofs */
    RITZ_LOADS_INPUTS = 2,
    RITZ_LOADS_OUTPUTS = 4, /* rows of C, Cv and Ca */
    RITZ_LOADS_DAMPERS = 8, /* influence vectors of discrete dampers */
};

typedef enum ritz_inner {
    RITZ_INNER_STIFFNESS, /* v' K v = 1, or K - sigma M with a shift */
    RITZ_INNER_MASS,      /* v' M v = 1 */
} ritz_inner;

typedef enum ritz_gramian {
    RITZ_GRAMIAN_INPUTS,  /* controllability */
    RITZ_GRAMIAN_OUTPUTS, /* observability */
} ritz_gramian;

typedef struct ritz_choice {
    int given; /* RITZ_USES_... of the words that were given */
    int64_t num_shifts;
    double shift_hz[RITZ_MOST_SHIFTS]; /* expansion points, each once */
    int loads;                         /* sum of RITZ_LOADS_... */
    ritz_inner inner;
    int64_t interface_modes; /* instead of all attached dofs */
    ritz_gramian gramian;
    bool inverse;         /* Lanczos on A^-1 instead of A */
    ritz_damping damping; /* instead of the component's own */
} ritz_choice;

/* A word, and how its value is taken from a text. */
typedef struct ritz_choice_word {
    const char *key;      /* "shift_hz" in scenes, --shift-hz as option */
    const char *argument; /* of the option: "F[,F]" */
    const char *help;
    int uses; /* bit of a method that heeds it */
    ritz_status (*take)(const char *text, ritz_choice *choice);
} ritz_choice_word;

/* All words, ended by one without a key. */
extern const ritz_choice_word ritz_choice_words[];

/**
 * Take a value: "0,5" for shift_hz, "inputs,outputs" for loads, "mass" or
 * "stiffness" for inner, "8" for interface_modes, "inputs" or "outputs" for
 * gramian, "state" or "inverse" for operator, "modal 0.01" for damping.
 *
 * @return RITZ_ERR_ARGUMENT with what is wrong
 */
ritz_status ritz_choice_take(const ritz_choice_word *word, const char *text,
                             ritz_choice *choice);

/** Words that were given, as "shift-hz 0,5 inner mass"; cut to fit. */
void ritz_choice_print(const ritz_choice *choice, int64_t size, char *out);

#endif
