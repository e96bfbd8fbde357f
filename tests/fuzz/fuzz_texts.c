/* Texts: scenes, signals and values of options. */
#include "fuzz.h"

#include "base/alloc.h"
#include "import/import.h"

#include <ritz/basis.h>
#include <ritz/constrained.h>
#include <ritz/export.h>
#include <ritz/parts.h>
#include <ritz/ranking.h>
#include <ritz/recover.h>
#include <ritz/response.h>
#include <ritz/scene.h>
#include <ritz/simulate.h>
#include <ritz/verify.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- scenes --------------------------------------------------------------- */

/* A first line "# at: TEXT" is the value of --at. */
static void read_settings(const ritz_scene *scene, const char *bytes)
{
    static const char mark[] = "# at: ";
    const size_t length = sizeof mark - 1;
    double *setting = NULL;
    char *at = NULL;

    if (strncmp(bytes, mark, length) != 0)
        return;
    at = strndup(bytes + length, strcspn(bytes + length, "\n"));
    setting = calloc((size_t)scene->num_sweeps + 1, sizeof *setting);
    if (at && setting)
        fuzz_judge(ritz_scene_settings(scene, at, setting));
    free(setting);
    free(at);
}

void fuzz_scene(const char *bytes, int64_t size)
{
    ritz_scene scene = {0};
    ritz_status status = RITZ_OK;

    (void)size; /* text ends at its NUL */
    status = ritz_scene_parse("scene.yaml", bytes, &scene);
    fuzz_judge(status);
    if (status == RITZ_OK)
        read_settings(&scene, bytes);
    ritz_scene_free(&scene);
}

/* --- signals -------------------------------------------------------------- */

static void read_signal(const char *text)
{
    static const double times[] = {-1.0, 0.0, 0.01, 0.5, 1.0, 1e300};
    RITZ_OWN(ritz_signal) signal = {0};
    ritz_status status = ritz_signal_parse(text, &signal);

    fuzz_judge(status);
    for (size_t k = 0; status == RITZ_OK && k < sizeof times / sizeof *times;
         k++)
        (void)ritz_signal_at(&signal, times[k], 1.0);
}

/* "= WORDS" is a signal in words, all else is a table. */
void fuzz_signal(const char *bytes, int64_t size)
{
    if (strncmp(bytes, "= ", 2) != 0) {
        fuzz_store("table", bytes, size);
        read_signal("table");
    } else if (!strchr(bytes, '/')) { /* it may name a file */
        read_signal(bytes + 2);
    }
}

/* --- responses ------------------------------------------------------------ */

void fuzz_response_table(const char *bytes, int64_t size)
{
    RITZ_OWN(ritz_response) r = {0};

    fuzz_store("table", bytes, size);
    (void)ritz_response_table_seems("table");
    fuzz_judge(ritz_response_read_table("table", &r));
}

/* --- histories ------------------------------------------------------------ */

/* A first line "# q: COLUMNS" is the value of --q. */
void fuzz_history(const char *bytes, int64_t size)
{
    static const char mark[] = "# q: ";
    const size_t length = sizeof mark - 1;
    static const char input[1][RITZ_NAME_SIZE] = {"push"};
    RITZ_OWN(ritz_history) history = {0};
    ritz_history_request request = {
        .order = 2, .num_inputs = 1, .input = input, .step = 0.5};
    char *list = NULL;
    ritz_status status = RITZ_OK;
    bool more = true;

    if (strncmp(bytes, mark, length) == 0)
        list = strndup(bytes + length, strcspn(bytes + length, "\n"));
    request.q = list;
    fuzz_store("history", bytes, size);
    status = ritz_history_open("history", &request, &history);
    fuzz_judge(status);
    while (status == RITZ_OK && more) {
        ritz_instant now = {0};

        status = ritz_history_next(&history, &now, &more);
        fuzz_judge(status);
    }
    free(list);
}

/* --- tables of rows ------------------------------------------------------- */

void fuzz_row_table(const char *bytes, int64_t size)
{
    (void)size; /* text ends at its NUL */
    (void)ritz_row_table_recognise(bytes);
    for (int k = 0; ritz_quantity_kinds[k]; k++) {
        RITZ_OWN(ritz_row_table) table = {0};

        fuzz_judge(ritz_row_table_parse("part.pch", bytes,
                                        ritz_quantity_kinds[k], &table));
    }
}

/* --- frames --------------------------------------------------------------- */

/* A frame, or a list of them. */
void fuzz_frames(const char *bytes, int64_t size)
{
    RITZ_OWN(ritz_shapes) frame = {0};
    char name[RITZ_COLLECTION_NAME];
    double seconds = 0.0;
    bool more = ritz_collection_recognise(bytes);

    (void)size; /* text ends at its NUL */
    fuzz_judge(ritz_frame_parse(bytes, &frame));
    while (more) {
        ritz_status status =
            ritz_collection_next(&bytes, &seconds, name, &more);

        fuzz_judge(status);
        more = more && status == RITZ_OK;
    }
}

/* --- values of options ---------------------------------------------------- */

static void read_damping(const char *text)
{
    char printed[RITZ_DAMPING_SIZE];
    ritz_damping damping = {0};
    ritz_status status = ritz_damping_parse(text, &damping);

    fuzz_judge(status);
    if (status != RITZ_OK)
        return;
    ritz_damping_print(&damping, printed);
    for (int mode = -1; mode < 3; mode++)
        (void)ritz_damping_of_mode(&damping, mode, 1.0);
}

static void read_tolerance(const char *text)
{
    char printed[64];
    ritz_verify_request request = {0};

    for (int k = 0; k < RITZ_MEASURES; k++)
        request.limit[k] = nan("");
    fuzz_judge(ritz_tolerance_take(text, &request));
    ritz_tolerance_print(&request, sizeof printed, printed);
}

/* "KEY VALUE", such as "shift-hz 0,5". */
static void read_choice(const char *text)
{
    const size_t length = strcspn(text, " ");
    char printed[64];
    ritz_choice choice = {0};

    for (const ritz_choice_word *word = ritz_choice_words; word->key; word++)
        if (strlen(word->key) == length &&
            strncmp(word->key, text, length) == 0) {
            fuzz_judge(ritz_choice_take(
                word, text + length + (text[length] != '\0'), &choice));
            ritz_choice_print(&choice, sizeof printed, printed);
        }
}

static void read_weights(const char *text)
{
    RITZ_OWN(ritz_weights) weights = {0};

    fuzz_judge(ritz_weights_parse(text, text, &weights));
}

static void read_channels(const char *text)
{
    enum { COUNT = 3 };
    char name[COUNT][RITZ_NAME_SIZE] = {""};
    double limit[COUNT] = {0.0};

    fuzz_judge(ritz_import_channels(text, 'u', COUNT, name, NULL));
    fuzz_judge(ritz_import_channels(text, 'y', COUNT, name, limit));
}

static void read_damper(const char *text)
{
    double c[] = {1.0}, k[] = {2.0}, held_c[] = {0.0}, held_k[] = {0.0};
    char name[][RITZ_NAME_SIZE] = {"strut"};
    ritz_dampers dampers = {.count = 1,
                            .name = name,
                            .c = c,
                            .k = k,
                            .held_c = held_c,
                            .held_k = held_k};

    fuzz_judge(ritz_dampers_tune(&dampers, text));
}

static void read_units(const char *text)
{
    char units[RITZ_NAME_SIZE];
    bool want[7] = {false};

    fuzz_judge(ritz_import_units(text, units));
    fuzz_judge(ritz_import_directions(text, want));
}

static void read_constraints(const char *text)
{
    ritz_constrained_request how = {0};

    fuzz_judge(ritz_constrained_parse(text, &how));
}

static const struct option_reader {
    const char *word;
    void (*read)(const char *text);
} readers[] = {
    {"damping ", read_damping},   {"tolerance ", read_tolerance},
    {"choice ", read_choice},     {"weights ", read_weights},
    {"channels ", read_channels}, {"damper ", read_damper},
    {"units ", read_units},       {"constraints ", read_constraints},
};

/* Lines "READER TEXT": each names the reader of its text. */
void fuzz_texts(const char *bytes, int64_t size)
{
    char *text = strndup(bytes, (size_t)size);
    char *line = text;

    while (line) {
        char *end = strchr(line, '\n');

        if (end)
            *end = '\0';
        for (size_t k = 0; k < sizeof readers / sizeof *readers; k++) {
            const size_t length = strlen(readers[k].word);

            if (strncmp(line, readers[k].word, length) == 0)
                readers[k].read(line + length);
        }
        line = end ? end + 1 : NULL;
    }
    free(text);
}
