/* Where the first ladder of a scene, or the first stage of COMPARE, is too
   poor for a tolerance, it is made richer, or the reason is said. */
#include "testing.h"

#include "answers.h"
#include "fit_scenes.h"
#include "folder.h"

#include "fit/fitter.h"

static const ritz_method *const fixed[] = {&ritz_method_craig_bampton};
static const ritz_method *const compare[] = {&ritz_fit_compare};

static void open_beams(const ritz_method *const *method, const char *tolerance,
                       answer *out)
{
    const ritz_fit_request request = fit_scenes_by(method, 1, tolerance);

    fit_scenes_store_beams(10, 12);
    answer_open(fit_scenes_beams, &request, out);
}

static int64_t search(answer *a)
{
    assert_ok(ritz_fitter_search(a->fitter, &a->fit));
    return answer_chosen(a)->order;
}

/* Of three rungs, and of as many as it usually has. */
static void a_ladder_that_is_too_short_is_made_longer(void **state)
{
    static const char *const tolerance[] = {"frequency=1e-4", "response=1e-5",
                                            "frequency=1e-7"};
    enum { SHORT = 3 };

    (void)state;
    for (size_t k = 0; k < sizeof tolerance / sizeof *tolerance; k++) {
        RITZ_OWN(answer) usual = {0}, less = {0};
        int64_t order = 0;

        open_beams(fixed, tolerance[k], &usual);
        order = search(&usual);
        open_beams(fixed, tolerance[k], &less);
        assert_true(less.fitter->num_first > SHORT);
        less.fitter->num_first = less.fitter->num_steps = SHORT;
        assert_in_range(search(&less), order - 1, order + 1);
        assert_true(less.fitter->num_steps > SHORT);
    }
}

/* Every step more belongs behind those that were; at the end all modes of both
   bodies are there, of which the right one has three that are rigid. */
static void it_goes_on_to_the_last_mode(void **state)
{
    RITZ_OWN(answer) a = {0};
    ritz_fit_end end = RITZ_FIT_END_NONE;
    int64_t before = 0;

    (void)state;
    open_beams(fixed, "frequency=1e-3", &a);
    while (end == RITZ_FIT_END_NONE) {
        const double last = a.fitter->num_steps > 0
                                ? a.fitter->step[a.fitter->num_steps - 1].hertz
                                : 0.0;

        before = a.fitter->num_steps;
        assert_ok(ritz_fit_extend(a.fitter, &end));
        assert_true(a.fitter->num_steps >= before);
        for (int64_t t = before; t < a.fitter->num_steps; t++)
            assert_true(a.fitter->step[t].hertz >= last * (1.0 - 1e-9));
    }
    assert_int_equal(end, RITZ_FIT_END_WHOLE);
    assert_int_equal(a.fitter->num_steps, a.fitter->model[0].num_dofs +
                                              a.fitter->model[1].num_dofs - 3);
}

/* A first stage to the end of the band leaves too much. */
static void a_first_stage_that_is_too_poor_is_made_richer(void **state)
{
    RITZ_OWN(answer) usual = {0}, poor = {0};
    int64_t order = 0;
    double hertz = 0.0;

    (void)state;
    open_beams(compare, "frequency=1e-4,response=1e-3", &usual);
    order = search(&usual);
    open_beams(compare, "frequency=1e-4,response=1e-3", &poor);
    hertz = poor.fitter->request.tolerance.band_hz[1];
    poor.fitter->rich_hz = hertz;
    assert_in_range(search(&poor), order - 1, order + 1);
    assert_true(poor.fitter->second.rich_hz > hertz);
}

/* One that is rich enough stays as it is. */
static void one_that_is_rich_enough_stays(void **state)
{
    RITZ_OWN(answer) a = {0};
    ritz_fit_end end = RITZ_FIT_END_WHOLE;

    (void)state;
    open_beams(compare, "response=1e-1", &a);
    assert_ok(ritz_fit_enrich(a.fitter, &end));
    assert_int_equal(end, RITZ_FIT_END_NONE);
    assert_near(a.fitter->second.rich_hz, a.fitter->rich_hz, 0.0);
}

static void assert_ends(const char *tolerance, int64_t largest,
                        ritz_fit_end end, const char *words)
{
    ritz_fit_request request = fit_scenes_by(fixed, 1, tolerance);
    RITZ_OWN(answer) a = {0};

    request.largest = largest;
    fit_scenes_store_beams(4, 4);
    answer_search(fit_scenes_beams, &request, &a);
    assert_int_equal(a.fit.chosen, -1);
    assert_int_equal(a.fit.end[0], end);
    if (!strstr(a.fit.why, words))
        fail_msg("'%s' says nothing of '%s'", a.fit.why, words);
}

static void it_is_said_what_ended_the_search(void **state)
{
    (void)state;
    assert_ends("frequency=1e-9", 9, RITZ_FIT_END_LARGEST,
                "; more than 9 columns were not tried (--largest)");
    /* less than rounding: the whole model does not meet it */
    assert_ends("response=1e-30", 0, RITZ_FIT_END_WHOLE,
                "; there are no more modes to be had");
}

static ritz_status extend(const answer *a)
{
    ritz_fit_end end = RITZ_FIT_END_NONE;

    return ritz_fit_extend(a->fitter, &end);
}

static void a_ladder_survives_every_allocation(void **state)
{
    RITZ_OWN(answer) a = {0};

    (void)state;
    open_beams(fixed, "frequency=1e-3", &a);
    assert_survives_every_allocation(extend(&a));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_ladder_that_is_too_short_is_made_longer),
    cmocka_unit_test(it_goes_on_to_the_last_mode),
    cmocka_unit_test(a_first_stage_that_is_too_poor_is_made_richer),
    cmocka_unit_test(one_that_is_rich_enough_stays),
    cmocka_unit_test(it_is_said_what_ended_the_search),
    cmocka_unit_test(a_ladder_survives_every_allocation),
};

TEST_MODULE(fit_ladder, tests, folder_make, folder_remove)
