#include "print/print.h"

/* Tracks of each kind that are printed; JSON and the table have all. */
enum { MOST_SAID = 12 };

static const char *at_of(const ritz_system *system, int64_t k)
{
    const char *at = system->configuration[k].at;

    return *at ? at : "as joined";
}

/* Frequency of a flexible mode; NaN of none. */
static double hertz_of(const ritz_tracking *t, int64_t k, int64_t mode)
{
    return mode < 0 ? nan("") : t->hertz[t->first[k] + mode];
}

/* "clock=30": half way, where a mode might still be known. */
static void name_middle(const ritz_system *system, const ritz_track_event *e,
                        char out[RITZ_NAME_SIZE])
{
    enum { MOST = 1000 };
    const ritz_configuration *a = &system->configuration[e->from];
    const ritz_configuration *b = &system->configuration[e->to];
    double middle[MOST];
    int64_t count = a->num_settings < MOST ? a->num_settings : MOST;

    for (int64_t k = 0; k < count; k++)
        middle[k] = 0.5 * (a->setting[k] + b->setting[k]);
    ritz_configuration_name(count, (const char *)system->sweep, RITZ_NAME_SIZE,
                            middle, out);
}

static void say_swap(cli_run *run, const ritz_tracking *t,
                     const ritz_track_event *e)
{
    cli_say(run,
            "    modes %ld and %ld (%.5g, %.5g Hz) change places (%.5g, %.5g "
            "Hz), MAC %.2f and %.2f",
            e->mode[0] + 1, e->mode[1] + 1, e->hertz,
            hertz_of(t, e->from, e->mode[1]), hertz_of(t, e->to, e->other[0]),
            hertz_of(t, e->to, e->other[1]), e->mac[0], e->mac[1]);
}

static void say_tie(cli_run *run, const ritz_tracking *t,
                    const ritz_track_event *e)
{
    cli_say(
        run,
        "    mode %ld (%.5g Hz) is nearly as like %.5g Hz (MAC %.2f) as %.5g "
        "Hz (%.2f)",
        e->mode[0] + 1, e->hertz, hertz_of(t, e->to, e->other[1]), e->mac[1],
        hertz_of(t, e->to, e->other[0]), e->mac[0]);
}

static void say_avoided(cli_run *run, const ritz_tracking *t,
                        const ritz_track_event *e)
{
    cli_say(
        run,
        "    modes %ld and %ld (%.5g, %.5g Hz) mix as they avoid each other, "
        "MAC %.2f and %.2f, of their plane %.2f",
        e->mode[0] + 1, e->mode[1] + 1, e->hertz,
        hertz_of(t, e->from, e->mode[1]), e->mac[0], e->mac[1], e->shared);
}

static const struct kind {
    const char *key;   /* in JSON */
    const char *title; /* of its lines */
    void (*say)(cli_run *run, const ritz_tracking *t,
                const ritz_track_event *e); /* NULL: of a lost mode */
} kinds[] = {
    [RITZ_TRACK_SWAP] = {"swaps", "changes of order", say_swap},
    [RITZ_TRACK_TIE] = {"near_ties", "near-ties", say_tie},
    [RITZ_TRACK_AVOIDED] = {"avoided_crossings", "avoided crossings",
                            say_avoided},
    [RITZ_TRACK_LOST] = {"lost", "modes that are lost", NULL},
};

enum { NUM_KINDS = sizeof kinds / sizeof *kinds };

/* An event has one or two modes; a mode that is absent is below 0. */
static int64_t count_modes(const int64_t mode[2])
{
    return (mode[0] >= 0) + (mode[1] >= 0);
}

/* An event as an item, and as a line if it is one of the first. */
static void say_event(cli_run *run, const ritz_system *system,
                      const ritz_tracking *t, const ritz_track_event *e,
                      bool said)
{
    sink_object(run, NULL);
    sink_set(run, "from,to,hertz", "%s %s %g", at_of(system, e->from),
             at_of(system, e->to), e->hertz);
    sink_wholes(run, "modes", count_modes(e->mode), e->mode, 1);
    sink_wholes(run, "become", count_modes(e->other), e->other, 1);
    sink_reals(run, "mac", count_modes(e->other), e->mac);
    if (kinds[e->kind].say && said) {
        kinds[e->kind].say(run, t, e);
    } else if (!kinds[e->kind].say) {
        char middle[RITZ_NAME_SIZE];

        name_middle(system, e, middle);
        sink_set(run, "list", "%s", middle);
        if (said)
            cli_say(run,
                    "    mode %ld (%.5g Hz) is like none there, best MAC "
                    "%.2f: too far apart, list %s",
                    e->mode[0] + 1, e->hertz, e->mac[0], middle);
    }
    sink_end(run);
}

static void say_kind(cli_run *run, const ritz_system *system,
                     const ritz_tracking *t, int which)
{
    int64_t count = 0;
    int64_t from = -1, to = -1;

    SINK_EACH(run, kinds[which].key, k, t->num_events) {
        const ritz_track_event *e = &t->event[k];
        bool said = count < MOST_SAID;

        if ((int)e->kind != which)
            continue;
        count++;
        if (said && (e->from != from || e->to != to))
            cli_say(run, "  %s to %s, %s:", at_of(system, e->from),
                    at_of(system, e->to), kinds[which].title);
        from = e->from;
        to = e->to;
        say_event(run, system, t, e, said);
    }
    if (count > MOST_SAID)
        cli_say(run, "  and %ld more %s", (count - MOST_SAID),
                kinds[which].title);
}

/* Report the number of negative squares at the first configuration; others have
   about as many. */
static void say_squares(cli_run *run, const ritz_system *system,
                        const ritz_tracking *t)
{
    int64_t count =
        t->num_configurations > 0
            ? model_negative_squares(&system->configuration[0], NULL)
            : 0;

    if (count == 0)
        return;
    sink_set(run, "negative_squares", "%ld", count);
    cli_say(run,
            "  %ld negative squares of the forces that join bodies, no modes "
            "of these, have no track",
            count);
}

/* Track, configuration, mode, Hz, MAC with the preceding mode of the track;
   track 0 holds the negative squares. */
static ritz_status write_table(const char *path, const ritz_system *system,
                               const ritz_tracking *t)
{
    RITZ_OWN(cli_table) table = {0};

    RITZ_CHECK(cli_table_new(&table));
    fprintf(table.file, "track\tconfiguration\tmode\thertz\tmac\n");
    for (int64_t k = 0; k < t->num_configurations; k++)
        for (int64_t i = t->first[k]; i < t->first[k + 1]; i++)
            fprintf(table.file, "%ld\t%s\t%ld\t%.12g\t%.6g\n", t->track[i] + 1,
                    at_of(system, k), (i - t->first[k]) + 1, t->hertz[i],
                    t->mac[i]);
    return cli_table_save(&table, path);
}

ritz_status tracks_report(cli_run *run, const ritz_stage *stage,
                          const ritz_system *system, const char *path)
{
    RITZ_OWN(ritz_tracking) t = {0};

    sink_object(run, "tracking");
    RITZ_CHECK_IN("tracks", ritz_track(stage, system, system->band_hz[1], &t));
    sink_set(run, "tracks", "%ld", t.num_tracks);
    if (path)
        RITZ_CHECK(write_table(path, system, &t));
    if (t.num_configurations > 1)
        cli_say(run,
                "\nFlexible modes over %ld configurations: %ld tracks by "
                "MAC%s%s",
                t.num_configurations, t.num_tracks,
                t.num_events == 0 ? "; none changes places, ties or is lost"
                                  : "; events",
                system->band_hz[1] > 0.0 ? " in the band" : "");
    say_squares(run, system, &t);
    for (int k = 0; k < NUM_KINDS; k++)
        say_kind(run, system, &t, k);
    sink_end(run);
    return RITZ_OK;
}
