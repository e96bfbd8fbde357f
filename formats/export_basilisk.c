/*
 * A spacecraft's flexible part for Basilisk [Basilisk2024], as a Python module
 * of state effectors: modes of the component whose port, one grid of the hub,
 * is held. With displacements u = R x + sum phi_k q_k, x the motion of the grid
 * and phi'M phi = 1,
 *
 *     q_k'' + d_k q_k' + w_k^2 q_k = -p_k . x_t'' - h_k . x_r'',
 *     p_k, h_k = phi_k'M R    participation in translation and rotation
 *
 * A mass m on a spring along the unit vector e, at r from the grid, obeys this
 * with q = sqrt(m) rho, p = sqrt(m) e and h = r x p. So a mode with h . p = 0
 * is written as a mass m = |p|^2 at r = p x h / |p|^2. A body with the inertia
 * I that spins about e obeys it with p = 0 and h = sqrt(I) e, and a mode with p
 * = 0 is written as that. No effector represents other modes.
 *
 * In Basilisk the mass of an effector moves with the hub in all directions. So
 * the mass and inertia of the effectors are subtracted from those of the
 * component; the rest is the hub, and hub and effectors together have the mass
 * properties of the component.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "base/vector.h"
#include "formats/certificate.h"
#include "formats/sink.h"
#include "linear/general.h"
#include "model/equations.h"
#include "model/interface_form.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOTIONS = RITZ_FRAME_MOTIONS };

/* The effector that represents a mode. */
typedef enum fit {
    FIT_SPRING,  /* a mass on a spring */
    FIT_SPINNER, /* a spinning body */
    FIT_NONE,    /* none, as h . p is not 0 */
    FIT_STILL,   /* none, as the mode does not act on the hub */
} fit;

typedef struct effector {
    double hertz, rate; /* rate: phi'D phi */
    double p[3], h[3];
    double skew; /* |h . p| / (|h| |p|) */
    fit kind;
} effector;

/* Moments of mass about the grid of the port. */
typedef struct rigid_part {
    double mass;
    double first[3];  /* mass times centre */
    double second[9]; /* inertia tensor, by rows */
} rigid_part;

typedef struct spacecraft {
    ritz_interface_form form;
    int64_t count;
    effector *effector;
    rigid_part hub;   /* the component without the effectors */
    double centre[3]; /* of the hub, from the grid of the port */
    double tensor[9]; /* inertia of the hub about its centre */
    char *certificate;
} spacecraft;

static void spacecraft_free(spacecraft *s)
{
    ritz_interface_form_free(&s->form);
    RITZ_FREE(s->effector, s->certificate);
}

/* ---- modes --------------------------------------------------------------- */

static fit choose_fit(const effector *e, const rigid_part *whole)
{
    const double p = sqrt(ritz_dot(e->p, e->p)), h = sqrt(ritz_dot(e->h, e->h));
    const double trace = whole->second[0] + whole->second[4] + whole->second[8];
    const bool moves = p > RITZ_NO_PARTICIPATION * sqrt(whole->mass);
    const bool turns = h > RITZ_NO_PARTICIPATION * sqrt(trace);

    /* an h that is rounding, as of a mode along the line to the grid, has any
       direction */
    if (moves)
        return !turns || e->skew <= RITZ_SKEW_PARTICIPATION ? FIT_SPRING
                                                            : FIT_NONE;
    return turns ? FIT_SPINNER : FIT_STILL;
}

static ritz_status list_effectors(const rigid_part *whole, spacecraft *s)
{
    const int64_t m = s->form.K.ncol - MOTIONS;
    RITZ_OWN(ritz_pairs) pairs = {0};
    RITZ_OWN(ritz_dense) coupling = {0}, part = {0}, D = {0}, rate = {0};

    RITZ_CHECK(ritz_interface_form_modes(&s->form, &pairs));
    RITZ_CHECK(ritz_dense_block(&s->form.M, 0, MOTIONS, MOTIONS, m, &coupling));
    RITZ_CHECK(ritz_dense_mul(&coupling, &pairs.Phi, &part));
    if (s->form.D.val) {
        RITZ_CHECK(ritz_dense_block(&s->form.D, MOTIONS, m, MOTIONS, m, &D));
        RITZ_CHECK(ritz_dense_project(&D, &pairs.Phi, &rate));
    }
    s->count = pairs.Phi.ncol;
    RITZ_CHECK_NEW(s->effector, s->count);
    for (int64_t k = 0; k < s->count; k++) {
        effector *e = &s->effector[k];
        double size = 0.0;

        e->hertz = ritz_eigen_hertz(pairs.lambda[k]);
        e->rate = rate.val ? ritz_dense_col(&rate, k)[k] : 0.0;
        memcpy(e->p, ritz_dense_col(&part, k), sizeof e->p);
        memcpy(e->h, ritz_dense_col(&part, k) + 3, sizeof e->h);
        size = sqrt(ritz_dot(e->p, e->p) * ritz_dot(e->h, e->h));
        e->skew = size > 0.0 ? fabs(ritz_dot(e->h, e->p)) / size : 0.0;
        e->kind = choose_fit(e, whole);
    }
    return RITZ_OK;
}

/* Position of the mass on the spring. @return the mass */
static double place_mass(const effector *e, double out[static 3])
{
    const double mass = ritz_dot(e->p, e->p);

    ritz_cross(e->p, e->h, out);
    for (int i = 0; i < 3; i++)
        out[i] /= mass;
    return mass;
}

/* ---- the hub ------------------------------------------------------------- */

/* J := J + mass (r'r I - r r') */
static void add_point_inertia(double mass, const double r[static 3],
                              double J[static 9])
{
    const double square = ritz_dot(r, r);

    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            J[3 * i + j] += mass * ((i == j ? square : 0.0) - r[i] * r[j]);
}

/* Mass and inertia of the component, from the mass matrix of six motions. */
static void read_whole(const ritz_dense *M, rigid_part *out)
{
    ritz_inertia inertia = {0};

    ritz_inertia_read(M, &inertia);
    out->mass = inertia.mass;
    for (int i = 0; i < 3; i++)
        out->first[i] = inertia.mass * inertia.centre[i];
    memcpy(out->second, inertia.tensor, sizeof out->second);
    add_point_inertia(inertia.mass, inertia.centre, out->second);
}

static void subtract_spring(const effector *e, rigid_part *hub)
{
    double r[3];
    const double mass = place_mass(e, r);

    hub->mass -= mass;
    for (int i = 0; i < 3; i++)
        hub->first[i] -= mass * r[i];
    add_point_inertia(-mass, r, hub->second);
}

static void subtract_effector(const effector *e, rigid_part *hub)
{
    if (e->kind == FIT_SPRING)
        subtract_spring(e, hub);
    for (int i = 0; e->kind == FIT_SPINNER && i < 3; i++)
        for (int j = 0; j < 3; j++)
            hub->second[3 * i + j] -= e->h[i] * e->h[j];
}

/* Centre of the hub, and its inertia about it, which must be positive. */
static ritz_status find_hub_inertia(spacecraft *s)
{
    const rigid_part *hub = &s->hub;
    const ritz_dense tensor = {3, 3, s->tensor};
    double least[3] = {0};

    RITZ_REFUSE_IF(hub->mass <= 0.0, RITZ_ERR_ARGUMENT,
                   "the effectors have more mass than the component, and leave "
                   "the hub %.6g: put the hub's own mass on the grid of the "
                   "port, or keep fewer modes",
                   hub->mass);
    for (int i = 0; i < 3; i++)
        s->centre[i] = hub->first[i] / hub->mass;
    memcpy(s->tensor, hub->second, sizeof s->tensor);
    add_point_inertia(-hub->mass, s->centre, s->tensor);
    RITZ_CHECK(ritz_general_symmetric_values(&tensor, least));
    RITZ_REFUSE_IF(least[0] <= 0.0, RITZ_ERR_ARGUMENT,
                   "the effectors leave the hub a moment of inertia of %.6g: "
                   "put the hub's own inertia on the grid of the port, or keep "
                   "fewer modes",
                   least[0]);
    return RITZ_OK;
}

static ritz_status check_interface(const spacecraft *s, const char *units)
{
    ritz_interface_ground ground = {0};

    RITZ_CHECK(ritz_export_demand_si(units, "Basilisk"));
    RITZ_REFUSE_IF(s->form.count != 1, RITZ_ERR_ARGUMENT,
                   "Basilisk holds a flexible part by one grid, and the ports "
                   "have %" PRId64 ": name the port at the hub with --port",
                   s->form.count);
    RITZ_CHECK(ritz_interface_form_ground(&s->form, &ground));
    RITZ_REFUSE_IF(ground.holds, RITZ_ERR_ARGUMENT,
                   "the body is held at the ground, at %.3g Hz, and a "
                   "spacecraft is free: import it without supports",
                   ground.rigid_hz);
    return RITZ_OK;
}

static ritz_status demand_effectors(const spacecraft *s)
{
    int64_t count = 0;

    for (int64_t k = 0; k < s->count; k++)
        count += s->effector[k].kind == FIT_SPRING ||
                 s->effector[k].kind == FIT_SPINNER;
    RITZ_REFUSE_IF(count == 0, RITZ_ERR_ARGUMENT,
                   "of %" PRId64 " modes none is a mass on a spring or a "
                   "spinning body, and without effectors the hub is rigid",
                   s->count);
    return RITZ_OK;
}

static ritz_status fill_spacecraft(const ritz_export_object *object,
                                   const ritz_export_request *request,
                                   spacecraft *s)
{
    rigid_part whole = {0};
    RITZ_OWN(ritz_dense) M = {0};

    RITZ_CHECK(
        ritz_interface_form_of(object->reduced, request->ports, &s->form));
    RITZ_CHECK(check_interface(s, object->reduced->units));
    RITZ_CHECK(ritz_dense_block(&s->form.M, 0, MOTIONS, 0, MOTIONS, &M));
    read_whole(&M, &whole);
    RITZ_CHECK(list_effectors(&whole, s));
    RITZ_CHECK(demand_effectors(s));
    s->hub = whole;
    for (int64_t k = 0; k < s->count; k++)
        subtract_effector(&s->effector[k], &s->hub);
    RITZ_CHECK(find_hub_inertia(s));
    return ritz_certificate(object, request->stamp, &s->certificate);
}

/* ---- the module ---------------------------------------------------------- */

static void put_vector(FILE *file, const double v[static 3])
{
    fprintf(file, "[%.17g, %.17g, %.17g]", v[0], v[1], v[2]);
}

static void put_hub(FILE *file, const spacecraft *s)
{
    fprintf(file,
            "# the hub without the effectors: centre from the grid of the "
            "port,\n# inertia about the centre\nHUB = {\"mass\": %.17g,\n"
            "       \"centre\": ",
            s->hub.mass);
    put_vector(file, s->centre);
    fputs(",\n       \"inertia\": [", file);
    for (int i = 0; i < 9; i += 3) {
        put_vector(file, s->tensor + i);
        fputs(i < 6 ? ",\n                   " : "]}\n", file);
    }
}

static void put_spring(FILE *file, const effector *e)
{
    const double lambda = ritz_eigen_lambda(e->hertz);
    double r[3], axis[3];
    const double mass = place_mass(e, r);

    for (int i = 0; i < 3; i++)
        axis[i] = e->p[i] / sqrt(mass);
    fprintf(file,
            "    {\"hertz\": %.17g, \"mass\": %.17g,\n     \"k\": %.17g, "
            "\"c\": %.17g,\n     \"place\": ",
            e->hertz, mass, lambda * mass, e->rate * mass);
    put_vector(file, r);
    fputs(",\n     \"axis\": ", file);
    put_vector(file, axis);
    fputs("},\n", file);
}

static void put_spinner(FILE *file, const effector *e)
{
    const double lambda = ritz_eigen_lambda(e->hertz);
    const double inertia = ritz_dot(e->h, e->h);
    double axis[3];

    for (int i = 0; i < 3; i++)
        axis[i] = e->h[i] / sqrt(inertia);
    fprintf(file,
            "    {\"hertz\": %.17g, \"inertia\": %.17g,\n     \"k\": %.17g, "
            "\"c\": %.17g,\n     \"axis\": ",
            e->hertz, inertia, lambda * inertia, e->rate * inertia);
    put_vector(file, axis);
    fputs("},\n", file);
}

static void put_list(FILE *file, const char *name, fit kind,
                     const spacecraft *s)
{
    fprintf(file, "%s = [\n", name);
    for (int64_t k = 0; k < s->count; k++)
        if (s->effector[k].kind == kind && kind == FIT_SPRING)
            put_spring(file, &s->effector[k]);
        else if (s->effector[k].kind == kind)
            put_spinner(file, &s->effector[k]);
    fputs("]\n", file);
}

static const char functions[] =
    "\n\ndef hub(bus=None, place=(0.0, 0.0, 0.0), turn=numpy.eye(3)):\n"
    "    \"\"\"Mass, centre and inertia about the centre of HUB and, if it is "
    "given, a\n    bus with the same keys, in the body frame: the grid of the "
    "port is at\n    `place`, and `turn` takes vectors of this module to "
    "vectors of the frame.\"\"\"\n"
    "    turn = numpy.asarray(turn, dtype=float)\n"
    "    mass = HUB[\"mass\"]\n"
    "    centre = numpy.asarray(place) + turn @ HUB[\"centre\"]\n"
    "    inertia = turn @ numpy.asarray(HUB[\"inertia\"]) @ turn.T\n"
    "    if bus is None:\n"
    "        return mass, centre, inertia\n"
    "    whole = mass + bus[\"mass\"]\n"
    "    middle = (mass * centre\n"
    "              + bus[\"mass\"] * numpy.asarray(bus[\"centre\"])) / whole\n"
    "    total = numpy.zeros((3, 3))\n"
    "    for m, c, J in ((mass, centre, inertia),\n"
    "                    (bus[\"mass\"], bus[\"centre\"], bus[\"inertia\"])):\n"
    "        r = numpy.asarray(c) - middle\n"
    "        total += J + m * (r @ r * numpy.eye(3) - numpy.outer(r, r))\n"
    "    return whole, middle, total\n"
    "\n\ndef attach(spacecraft, place=(0.0, 0.0, 0.0), turn=numpy.eye(3), "
    "bus=None):\n"
    "    \"\"\"Set the hub of a Basilisk spacecraft and add all effectors, "
    "which "
    "are\n    returned: add each to the task as a model, before the "
    "spacecraft.\"\"\"\n"
    "    from Basilisk.simulation import linearSpringMassDamper\n"
    "    from Basilisk.simulation import spinningBodyOneDOFStateEffector\n"
    "    turn = numpy.asarray(turn, dtype=float)\n"
    "    place = numpy.asarray(place, dtype=float)\n"
    "    column = lambda v: [[float(x)] for x in v]\n"
    "    mass, centre, inertia = hub(bus, place, turn)\n"
    "    spacecraft.hub.mHub = float(mass)\n"
    "    spacecraft.hub.r_BcB_B = column(centre)\n"
    "    spacecraft.hub.IHubPntBc_B = inertia.tolist()\n"
    "    effectors = []\n"
    "    for one in SPRINGS:\n"
    "        e = linearSpringMassDamper.LinearSpringMassDamper()\n"
    "        e.k, e.c, e.massInit = one[\"k\"], one[\"c\"], one[\"mass\"]\n"
    "        e.r_PB_B = column(place + turn @ one[\"place\"])\n"
    "        e.pHat_B = column(turn @ one[\"axis\"])\n"
    "        effectors.append(e)\n"
    "    for one in SPINNERS:\n"
    "        body = spinningBodyOneDOFStateEffector\n"
    "        e = body.SpinningBodyOneDOFStateEffector()\n"
    "        axis = turn @ one[\"axis\"]\n"
    "        e.mass, e.k, e.c = 0.0, one[\"k\"], one[\"c\"]\n"
    "        e.r_SB_B, e.r_ScS_S = column(place), column([0, 0, 0])\n"
    "        e.sHat_S = column(axis)\n"
    "        e.IPntSc_S = (one[\"inertia\"] * numpy.outer(axis, "
    "axis)).tolist()\n"
    "        effectors.append(e)\n"
    "    for e in effectors:\n"
    "        spacecraft.addStateEffector(e)\n"
    "    return effectors\n";

static ritz_status put_module(FILE *file, const void *what)
{
    const spacecraft *s = what;

    ritz_comment_put(file, "# ", 0,
                     "state effectors for Basilisk; kg m s, along basic axes, "
                     "from the grid of the port");
    ritz_comment_put(file, "# ", 0, s->certificate);
    fputs("import numpy\n\n", file);
    put_hub(file, s);
    fputs("# masses on springs\n", file);
    put_list(file, "SPRINGS", FIT_SPRING, s);
    fputs("# spinning bodies\n", file);
    put_list(file, "SPINNERS", FIT_SPINNER, s);
    fputs(functions, file);
    return RITZ_OK;
}

/* ---- the report ---------------------------------------------------------- */

static ritz_status say_mode(const effector *e, int64_t k,
                            ritz_export_report *report)
{
    switch (e->kind) {
    case FIT_SPRING:
        return ritz_export_say(report,
                               "mode %" PRId64 ", %.6g Hz: a mass of %.6g on a "
                               "spring",
                               k + 1, e->hertz, ritz_dot(e->p, e->p));
    case FIT_SPINNER:
        return ritz_export_say(report,
                               "mode %" PRId64 ", %.6g Hz: a spinning body of "
                               "inertia %.6g",
                               k + 1, e->hertz, ritz_dot(e->h, e->h));
    case FIT_NONE:
        return ritz_export_say(report,
                               "warning: mode %" PRId64 ", %.6g Hz, is left "
                               "out: it pushes the hub along an axis and turns "
                               "it about the same one (|h.p| is %.2g of "
                               "|h||p|), which no effector does",
                               k + 1, e->hertz, e->skew);
    default:
        return ritz_export_say(report,
                               "mode %" PRId64 ", %.6g Hz, is left out: it "
                               "does not act on the hub",
                               k + 1, e->hertz);
    }
}

static ritz_status say_spacecraft(const spacecraft *s,
                                  const ritz_reduced *reduced,
                                  ritz_export_report *report)
{
    RITZ_CHECK(ritz_export_say(
        report, "modes while grid %" PRId64 " of port %s is held; all digits",
        s->form.grid[0], s->form.port[0]));
    for (int64_t k = 0; k < s->count; k++)
        RITZ_CHECK(say_mode(&s->effector[k], k, report));
    RITZ_CHECK(
        ritz_export_say(report, "the hub keeps a mass of %.6g", s->hub.mass));
    if (reduced->K4.val)
        RITZ_CHECK(ritz_export_say(report, "structural damping is left out"));
    return ritz_export_say(report,
                           "left out: damping between modes, inputs, outputs "
                           "and shapes");
}

static ritz_status write_effectors(const ritz_export_object *object,
                                   const ritz_export_request *request,
                                   ritz_export_report *report)
{
    RITZ_OWN(spacecraft) s = {0};

    RITZ_CHECK(fill_spacecraft(object, request, &s));
    RITZ_CHECK(ritz_sink_write(request->output, put_module, &s));
    return say_spacecraft(&s, object->reduced, report);
}

const ritz_exporter ritz_exporter_basilisk = {
    .name = "basilisk",
    .summary = "state effectors of a spacecraft for Basilisk, Python",
    .reference = "Basilisk2024",
    .kind = "reduced",
    .takes = RITZ_EXPORT_REDUCED | RITZ_EXPORT_PORTS,
    .write = write_effectors,
};
