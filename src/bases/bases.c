#include <ritz/method.h>

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* A new method is a new file that defines one descriptor, and one line here. */
const ritz_method *const ritz_methods[] = {
    &ritz_method_balanced,
    &ritz_method_balanced_band,
    &ritz_method_balanced_position,
    &ritz_method_balanced_velocity,
    &ritz_method_craig_bampton,
    &ritz_method_dual_craig_bampton,
    &ritz_method_full,
    &ritz_method_guyan,
    &ritz_method_inertia_relief,
    &ritz_method_irs,
    &ritz_method_krylov,
    &ritz_method_krylov_cms_fixed,
    &ritz_method_krylov_cms_free,
    &ritz_method_krylov_damped,
    &ritz_method_lanczos_one_sided,
    &ritz_method_lanczos_two_sided,
    &ritz_method_loaded_interface,
    &ritz_method_macneal,
    &ritz_method_macneal_rubin,
    &ritz_method_modal_balanced,
    &ritz_method_normal_modes,
    &ritz_method_rigid,
    &ritz_method_rubin,
    &ritz_method_serep,
    &ritz_method_tangential,
    NULL,
};

enum { MOST = 64 };

const ritz_method *ritz_method_find(const char *name)
{
    char names[MOST][RITZ_NAME_SIZE];
    const char *near = NULL;
    int64_t count = 0;

    for (; ritz_methods[count] && count < MOST; count++) {
        if (strcmp(ritz_methods[count]->name, name) == 0)
            return ritz_methods[count];
        snprintf(names[count], RITZ_NAME_SIZE, "%s", ritz_methods[count]->name);
    }
    near = ritz_text_nearest(name, count, names[0], sizeof names[0]);
    ritz_record(near ? "there is no method '%s', is '%s' meant?"
                     : "there is no method '%s'",
                name, near ? near : "");
    return NULL;
}

ritz_status ritz_request_check(const ritz_method *method,
                               const ritz_request *request)
{
    bool by_number = request->modes >= 0;
    bool by_frequency = request->up_to_hz > 0.0;

    if (method->uses & RITZ_USES_MODES)
        RITZ_REFUSE_IF(by_number == by_frequency, RITZ_ERR_ARGUMENT,
                       "%s takes either a number of modes or a frequency",
                       method->name);
    else
        RITZ_REFUSE_IF(by_number || by_frequency, RITZ_ERR_ARGUMENT,
                       "%s has no modes to choose", method->name);
    for (const ritz_choice_word *word = ritz_choice_words; word->key; word++)
        RITZ_REFUSE_IF(request->choice.given & word->uses & ~method->uses,
                       RITZ_ERR_ARGUMENT, "%s has no '%s' to choose",
                       method->name, word->key);
    RITZ_REFUSE_IF(request->neighbour && !(method->uses & RITZ_USES_NEIGHBOUR),
                   RITZ_ERR_ARGUMENT, "%s loads nothing on its interface",
                   method->name);
    return RITZ_OK;
}

static void sign(const ritz_method *method, const ritz_request *request,
                 ritz_origin *origin)
{
    snprintf(origin->method, RITZ_NAME_SIZE, "%s", method->name);
    snprintf(origin->reference, RITZ_NAME_SIZE, "%s", method->reference);
    if (request->modes >= 0)
        snprintf(origin->options, RITZ_NAME_SIZE, "modes %" PRId64,
                 request->modes);
    else if (request->up_to_hz > 0.0)
        snprintf(origin->options, RITZ_NAME_SIZE, "up-to-hz %.17g",
                 request->up_to_hz);
    ritz_choice_print(&request->choice, RITZ_NAME_SIZE, origin->options);
}

ritz_status ritz_basis_make(const ritz_method *method,
                            const ritz_request *request, ritz_basis *out)
{
    RITZ_CHECK(ritz_request_check(method, request));
    RITZ_CHECK_IN(method->name, method->make(request, out));
    sign(method, request, &out->origin);
    return RITZ_OK;
}
