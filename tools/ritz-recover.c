/* ritz-recover - stresses and motion of a mesh from reduced coordinates. */
#include "print/print.h"

static void list_formats(void)
{
    printf("histories:\n  %-8s %s\n", "(ours)",
           "time response of ritz-simulate --coordinates");
    for (const ritz_history_format *const *f = ritz_history_formats; *f; f++)
        printf("  %-8s %-58s [%s]\n", (*f)->name, (*f)->summary,
               (*f)->reference);
    printf("series, of --to:\n");
    for (const ritz_series_format *const *f = ritz_series_formats; *f; f++)
        printf("  %-8s %-58s [%s]\n", (*f)->name, (*f)->summary,
               (*f)->reference);
}

static const cli_program program = {
    .name = "ritz-recover",
    .operands = {{"HISTORY",
                  "time response with --coordinates, or a table of Exudyn or "
                  "FMPy, or a file .mod of MBDyn",
                  false}},
    .summary = "Recover stresses, forces and the motion of the full mesh from "
               "the coordinates of a\nreduced component over time, and their "
               "maxima.",
    .example = "ritz-recover run.h5 --component rotor-reduced.h5 --table "
               "maxima.tsv -o motion.pvd",
    .output = "shapes over time, for viewers",
    .output_optional = true,
    .threads = true,
};

int main(int argc, char **argv)
{
    recover_options given = {.to = "pvd", .every = 1};
    const cli_option options[] = {
        CLI_TEXT("component", &given.component, "FILE",
                 "reduced component whose coordinates the history has"),
        CLI_TEXT("system", &given.system, "FILE",
                 "system whose coordinates the history has, of which the "
                 "component is a body"),
        CLI_TEXT("body", &given.body, "NAME",
                 "name of that body; a history of a scene with --constraints "
                 "or --sweep has the coordinates of all bodies, and needs no "
                 "--system"),
        CLI_WORD("modes", &given.modes, "displacement|acceleration",
                 "how rows are recovered [acceleration where the component "
                 "and the history allow it]"),
        CLI_WORD("to", &given.to, "pvd|xdmf", "format of the series"),
        CLI_INT("every", &given.every, "N", 1, 1e9,
                "write every N-th time; maxima are of all"),
        CLI_OUTPUT("maxima", &given.maxima, "FILE",
                   "container of the maxima of all rows"),
        CLI_OUTPUT("table", &given.table, "FILE", "the same as text with tabs"),
        CLI_TEXT("transform", &given.transform, "modes|floating|F",
                 "what the coordinates of the history are: those of modes, as "
                 "in an FMU; of a body in a moving frame (floating), as in "
                 "Exudyn and MBDyn; or x of q = V x, with the matrix V in F, "
                 "which is FILE[:NAME] [those of the model, q]"),
        CLI_TEXT("frame", &given.frame, "basic|centre|GRID",
                 "frame of --transform floating, as it was exported [basic]"),
        CLI_TEXT("reference", &given.reference, "none|mean-axis|tangent",
                 "how the modes moved with it, as they were exported [none]"),
        CLI_TEXT("q", &given.q, "COLUMNS",
                 "columns of a table that hold the coordinates: numbers as "
                 "2-9, names, or q* for all names that begin with q"),
        CLI_TEXT("v", &given.v, "COLUMNS",
                 "columns of the velocities, in the order of --q"),
        CLI_TEXT("a", &given.a, "COLUMNS",
                 "columns of the accelerations, in the order of --q"),
        CLI_TEXT("f", &given.f, "COLUMNS",
                 "columns of the inputs, in the order of the model"),
        CLI_REAL("step", &given.step, "H", 1e-15, 1e12,
                 "seconds between times of a file .mod"),
        CLI_INT("label", &given.label, "N", 1, 1e15,
                "body in a file .mod [the first]"),
        MODEL_OPTIONS(&given.model),
        CLI_ACTION("list", list_formats,
                   "list formats of histories and series"),
        {0},
    };
    cli_run run;

    cli_parse(&program, options, argc, argv, &run);
    return cli_finish(&run, recover_run(&run, &given));
}
