/* Warnings about axes in loops that a scene gives with too few digits. */
#include "print/print.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <math.h>
#include <stdio.h>

enum { AXIS_SIZE = 80 };

/* "[0, 0.5, 1]": the largest component is 1, as one writes axes. */
static const char *print_axis(const double axis[3], char out[AXIS_SIZE])
{
    double most = 0.0, x[3];

    for (int i = 0; i < 3; i++)
        most = fmax(most, fabs(axis[i]));
    for (int i = 0; i < 3; i++)
        x[i] = fabs(axis[i]) > RITZ_SAME * most ? axis[i] / most : 0.0;
    snprintf(out, AXIS_SIZE, "[%.12g, %.12g, %.12g]", x[0], x[1], x[2]);
    return out;
}

static void warn_of_one(cli_run *run, const ritz_joint *joint,
                        const ritz_near_axis *a)
{
    const char *which = a->which == 1 ? "second axis" : "axis";
    char text[AXIS_SIZE];

    print_axis(a->exact, text);
    if (a->taken)
        cli_warn(run,
                 "the %s of joint '%s' is taken as %s, because its loop could "
                 "not move with the given one, which is off by %.3g rad. Write "
                 "that axis in the scene, or lock the joint if the loop should "
                 "not move",
                 which, joint->name, text, a->angle);
    else
        cli_warn(run,
                 "the %s of joint '%s' locks a motion of its loop, because it "
                 "is off by %.3g rad from %s. Write that axis if the loop "
                 "should move",
                 which, joint->name, a->angle, text);
}

static void warn_of_several(cli_run *run, const ritz_joint *joint,
                            const ritz_near_axis *a)
{
    if (a->taken)
        cli_warn(run,
                 "the axes of joint '%s' and %ld more of its loop are turned "
                 "by up to %.3g rad, because the loop could not move "
                 "otherwise. Write axes with more digits, or lock a joint if "
                 "the loop should not move",
                 joint->name, a->others, a->angle);
    else
        cli_warn(run,
                 "the axes of joint '%s' and %ld more of its loop lock a "
                 "motion, because they are off by up to %.3g rad from "
                 "directions in which the loop could move. Write axes with "
                 "more digits if it should move",
                 joint->name, a->others, a->angle);
}

/* Keep the largest angle of each axis over all configurations. */
static ritz_status keep_worst(const ritz_near_axes *found, ritz_near_axes *all)
{
    for (int64_t k = 0; k < found->count; k++) {
        const ritz_near_axis *a = &found->item[k];
        int64_t at = 0;

        while (at < all->count && (all->item[at].joint != a->joint ||
                                   all->item[at].which != a->which ||
                                   all->item[at].taken != a->taken))
            at++;
        if (at == all->count) {
            RITZ_CHECK_ROOM(all->item, all->count, all->room);
            all->item[all->count++] = *a;
        } else if (a->angle > all->item[at].angle) {
            all->item[at] = *a;
        }
    }
    return RITZ_OK;
}

static void warn_of_all(cli_run *run, const ritz_scene *scene,
                        const ritz_near_axes *all)
{
    for (int64_t k = 0; k < all->count; k++)
        (all->item[k].others > 0 ? warn_of_several : warn_of_one)(
            run, &scene->joint[all->item[k].joint], &all->item[k]);
}

ritz_status axes_say(cli_run *run, const ritz_stage *stage, int64_t count,
                     const double *setting)
{
    RITZ_OWN(ritz_near_axes) all = {0};

    for (int64_t k = 0; k < count; k++) {
        RITZ_OWN(ritz_near_axes) found = {0};

        RITZ_CHECK(ritz_stage_near_axes(
            stage, setting + k * stage->scene->num_sweeps, &found));
        RITZ_CHECK(keep_worst(&found, &all));
    }
    warn_of_all(run, stage->scene, &all);
    return RITZ_OK;
}

ritz_status axes_say_full(cli_run *run, const ritz_scene *scene,
                          const double *setting)
{
    RITZ_OWN(ritz_near_axes) all = {0};

    RITZ_CHECK(ritz_scene_near_axes(scene, setting, &all));
    warn_of_all(run, scene, &all);
    return RITZ_OK;
}
