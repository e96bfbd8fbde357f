/*
 * What a method is told beside how many vectors it makes: one table of words
 * that options (--shift-hz 0,5) and scenes (shift_hz: [0, 5]) share.
 */
#ifndef RITZ_CHOICE_H
#define RITZ_CHOICE_H

#include <ritz/damping.h>
#include <ritz/status.h>

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#pragma GCC visibility push(default)

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
    RITZ_USES_ENGINE = 1024,
    RITZ_USES_AMONG = 2048,
    RITZ_USES_BAND = 4096,
    RITZ_USES_REMAINDER = 8192,
    RITZ_USES_SIDES = 16384,
    RITZ_USES_SPACE = 32768, /* a state space in the place of a component */
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

/* How Gramians are found: see gramians.h. */
typedef enum ritz_engine {
    RITZ_ENGINE_AUTO,
    RITZ_ENGINE_DENSE,
    RITZ_ENGINE_MODAL,
    RITZ_ENGINE_LOW_RANK,
} ritz_engine;

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
    ritz_engine engine;
    double among_hz;   /* modal engine: modes up to here */
    double band_hz[2]; /* where the response matters */
    bool perturb;      /* the remainder answers statically, it is not dropped */
    bool one_sided;    /* of second order: W = T, which keeps symmetry */
} ritz_choice;

/* What the value of a word is. */
typedef enum ritz_choice_kind {
    RITZ_CHOICE_SHIFTS,
    RITZ_CHOICE_SET,   /* some of its words, as bits of an int */
    RITZ_CHOICE_ENUM,  /* one of its words, as an int */
    RITZ_CHOICE_FLAG,  /* the first of two words is false */
    RITZ_CHOICE_COUNT, /* int64_t, 1 or more */
    RITZ_CHOICE_HERTZ, /* above 0 */
    RITZ_CHOICE_BAND,
    RITZ_CHOICE_DAMPING,
} ritz_choice_kind;

/* A word, and what it sets. */
typedef struct ritz_choice_word {
    const char *key;      /* "shift_hz" in scenes, --shift-hz as option */
    const char *argument; /* of the option: "F[,F]" */
    const char *help;
    int uses; /* bit of a method that heeds it */
    ritz_choice_kind kind;
    size_t offset;           /* of the field in ritz_choice */
    const char *what;        /* what sentences call a value */
    const char (*value)[16]; /* words that it can be */
    int64_t num_values;
} ritz_choice_word;

/* All words, ended by one without a key. */
extern const ritz_choice_word ritz_choice_words[];

/**
 * Take a value: "0,5" for shift_hz, "inputs,outputs" for loads, "mass" or
 * "stiffness" for inner, "8" for interface_modes, "inputs" or "outputs" for
 * gramian, "state" or "inverse" for operator, "modal 0.01" for damping, "auto",
 * "dense", "modal" or "low-rank" for engine, "50" for among_hz, "0,10" for
 * band_hz, "dropped" or "static" for remainder, "one" or "two" for sides.
 *
 * @return RITZ_ERR_ARGUMENT with what is wrong
 */
ritz_status ritz_choice_take(const ritz_choice_word *word, const char *text,
                             ritz_choice *choice);

/** Words that were given, as "shift-hz 0,5 inner mass"; cut to fit. */
void ritz_choice_print(const ritz_choice *choice, int64_t size, char *out);

#pragma GCC visibility pop

#endif
