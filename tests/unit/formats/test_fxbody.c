/*
 * Flexible bodies for Radioss. The tests read them in the order and the columns
 * of OpenRadioss's starter [OpenRadioss2026, hm_read_fxb.F], where lines that
 * begin with '#' are comments, and compare the inertia terms of a file with sums
 * over point masses that follow its nodes.
 */
#include "testing.h"

#include "base/vector.h"
#include "bodies.h"
#include "folder.h"
#include "moving_body.h"

#include <ritz/basis.h>
#include <ritz/export.h>

#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum {
    NODES = MOVING_GRIDS,
    ROWS = 6 * NODES,
    MODES = MOVING_MODES,
    MOST = ROWS, /* modes of a body that is not reduced */
    GLOBAL = 15,
    TEXT = 1 << 20
};

typedef struct fx_file {
    char *text, *next;
    int64_t Nbmod, Nbstat, Nbnod, Irot, Idamp, Iblo, Ifile;
    int64_t node[NODES];
    double P[9], freq, damping[2];
    int64_t num_global;
    double global[GLOBAL][NODES][6], local[MOST][NODES][6];
    double M[MOST], K[MOST];
    double M_R[GLOBAL][GLOBAL];
    double M_C[9][GLOBAL][MODES], K_C[9][GLOBAL][MODES];
} fx_file;

static void fx_file_free(fx_file *f)
{
    free(f->text);
    *f = (fx_file){0};
}

/* The next line that is neither empty nor a comment, at most 100 letters. */
static char *take_line(fx_file *f)
{
    char *line = NULL;

    do {
        line = f->next;
        f->next = strchr(line, '\n');
        assert_non_null(f->next);
        *f->next++ = '\0';
        assert_true(strlen(line) <= 100);
    } while (*line == '#' || *line == '$' || !*line);
    return line;
}

/* Fields of 8 columns. */
static void take_wholes(fx_file *f, int64_t count, int64_t per_line,
                        int64_t *out)
{
    const char *line = NULL;

    for (int64_t k = 0; k < count; k++) {
        char field[9] = "";
        char *end = NULL;

        if (k % per_line == 0)
            line = take_line(f);
        assert_non_null(line);
        assert_true(strlen(line) >= 8 * (size_t)(k % per_line + 1));
        memcpy(field, line + 8 * (k % per_line), 8);
        out[k] = strtoll(field, &end, 10);
        assert_true(*end == '\0');
    }
}

/* F16.0: a point, and an exponent that may lack its letter. */
static double scan_field(const char *at)
{
    char field[24] = "", number[24] = "";
    size_t used = 0;
    char *end = NULL;
    double x = 0.0;

    memcpy(field, at, 16);
    assert_non_null(strchr(field, '.'));
    for (const char *c = field; *c; c++) {
        bool sign = *c == '+' || *c == '-';

        if (*c == ' ')
            continue;
        if (sign && used > 0 && number[used - 1] != 'E')
            number[used++] = 'E';
        number[used++] = *c;
    }
    x = strtod(number, &end);
    assert_true(used > 0 && *end == '\0');
    return x;
}

/* Five fields of 16 columns a line. */
static void take_numbers(fx_file *f, int64_t count, double *out)
{
    const char *line = NULL;

    for (int64_t k = 0; k < count; k++) {
        const int64_t column = k % 5;

        if (column == 0) {
            line = take_line(f);
            assert_int_equal(strlen(line),
                             16 * (count - k < 5 ? count - k : 5));
        }
        assert_non_null(line);
        out[k] = scan_field(line + 16 * column);
    }
}

static void take_modes(fx_file *f, int64_t count, double (*out)[NODES][6])
{
    for (int64_t k = 0; k < count; k++)
        for (int64_t n = 0; n < NODES; n++) {
            take_numbers(f, 5, out[k][n]);
            take_numbers(f, 1, out[k][n] + 5);
        }
}

static void take_coupling(fx_file *f, double (*out)[GLOBAL][MODES])
{
    double rows[GLOBAL * MODES];

    for (int k = 0; k < 9; k++) {
        take_numbers(f, f->num_global * f->Nbmod, rows);
        for (int64_t p = 0; p < f->num_global; p++)
            for (int64_t i = 0; i < f->Nbmod; i++)
                out[k][p][i] = rows[p * f->Nbmod + i];
    }
}

static void take_inertia(fx_file *f)
{
    double upper[GLOBAL * (GLOBAL + 1) / 2];
    int64_t next = 0;

    take_numbers(f, f->num_global * (f->num_global + 1) / 2, upper);
    for (int64_t p = 0; p < f->num_global; p++)
        for (int64_t q = p; q < f->num_global; q++)
            f->M_R[p][q] = f->M_R[q][p] = upper[next++];
    assert_true(f->Nbmod <= MODES);
    take_coupling(f, f->M_C);
    take_coupling(f, f->K_C);
}

static void load_text(const char *path, fx_file *f)
{
    FILE *file = fopen(path, "r");

    assert_non_null(file);
    f->text = calloc(TEXT, 1);
    assert_non_null(f->text);
    assert_true(fread(f->text, 1, TEXT - 1, file) > 0);
    assert_int_equal(fclose(file), 0);
    f->next = f->text;
}

static void read_file(const char *path, fx_file *f)
{
    int64_t head[7];
    double frame[10];

    load_text(path, f);
    take_wholes(f, 7, 7, head);
    f->Nbmod = head[0];
    f->Nbstat = head[1];
    f->Nbnod = head[2];
    f->Irot = head[3];
    f->Idamp = head[4];
    f->Iblo = head[5];
    assert_true(f->Nbmod <= MOST && f->Nbstat == 0 && f->Nbnod == NODES);
    assert_int_equal(head[6], 0);
    take_wholes(f, NODES, 10, f->node);
    take_numbers(f, 10, frame);
    memcpy(f->P, frame, sizeof f->P);
    f->freq = frame[9];
    if (f->Idamp)
        take_numbers(f, 2, f->damping);
    f->num_global = f->Iblo ? 0 : f->Irot ? 15 : 12;
    take_modes(f, f->num_global, f->global);
    take_modes(f, f->Nbmod, f->local);
    take_numbers(f, f->Nbmod, f->M);
    take_numbers(f, f->Nbmod, f->K);
    if (!f->Iblo)
        take_inertia(f);
    assert_true(*f->next == '\0');
}

static void write_and_read(const moving_body *of, const char *frame,
                           const char *reference, fx_file *f)
{
    const char *path = folder_path("body.fxb");

    moving_body_write(of, &ritz_exporter_fxbody, path, frame, reference);
    read_file(path, f);
}

/* ---- motions ------------------------------------------------------------ */

/* Error of a sum of a few dozen terms, whose factors are below ten and have 13
   digits in the file. */
static const double digits = 1e-10;

/* Two orientations P of the frame: as it is written, and turned. */
static const double turned[9] = {0.8,  -0.6, 0.0,  0.48, 0.64,
                                 -0.6, 0.36, 0.48, 0.8}; /* by rows */
static const double straight[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

/* The motion: velocity of the origin, angular velocity, rates of the modes. */
static const double v0[3] = {0.5, -1.0, 2.0};
static const double *const w = moving_example.w;
static const double *const rate = moving_example.rate;

static void turn(const double *P, const double *x, double out[static 3])
{
    for (ptrdiff_t k = 0; k < 3; k++)
        out[k] = ritz_dot(P + 3 * k, x);
}

/* Rates of the global modes while the frame has the orientation P: velocities of
   its origin and of the ends of its three axes, then the angular velocity. */
static void move_frame(const double *P, double q[static GLOBAL])
{
    for (int i = 0; i < 4; i++) {
        const double unit[3] = {i == 0, i == 1, i == 2};
        double arm[3], spun[3];

        turn(P, unit, arm);
        ritz_cross(w, arm, spun);
        for (int a = 0; a < 3; a++)
            q[3 * i + a] = v0[a] + spun[a];
    }
    memcpy(q + 12, w, 3 * sizeof *w);
}

/* A global mode moves a node by a coordinate of its position x: the first nine
   modes give x in the axes of the frame. */
static void collect_nodes(const fx_file *f, moving_node *out)
{
    for (int n = 0; n < NODES; n++)
        for (int a = 0; a < 3; a++) {
            out[n].x[a] = f->global[3 * a][n][0];
            for (int k = 0; k < MODES; k++) {
                out[n].phi[k][a] = f->local[k][n][a];
                out[n].psi[k][a] = f->local[k][n][3 + a];
            }
        }
}

static void collect_points(const moving_body *of, const fx_file *f,
                           moving_point *out)
{
    moving_node node[NODES] = {0};

    collect_nodes(f, node);
    moving_body_points(of, node, out);
}

/* With the rates of a rigid motion, the global modes give each node the velocity
   v0 + w x r and the angular velocity w. */
static void global_modes_hold_rigid_motion(void **state)
{
    RITZ_OWN(fx_file) f = {0};
    moving_node node[NODES] = {0};
    double q[GLOBAL];

    write_and_read(*state, NULL, NULL, &f);
    collect_nodes(&f, node);
    assert_int_equal(f.Irot, 1);
    for (int k = 0; k < 9; k++)
        assert_true(f.P[k] == straight[k]);
    move_frame(straight, q);
    for (int n = 0; n < NODES; n++) {
        double moved[6] = {0}, spun[3];

        assert_int_equal(f.node[n], 21 + n);
        for (int p = 0; p < GLOBAL; p++)
            for (int a = 0; a < 6; a++)
                moved[a] += f.global[p][n][a] * q[p];
        ritz_cross(w, node[n].x, spun);
        for (int a = 0; a < 3; a++) {
            assert_near(moved[a], v0[a] + spun[a], digits);
            assert_near(moved[3 + a], w[a], digits);
        }
    }
}

static void rigid_inertia_is_that_of_the_points(void **state)
{
    RITZ_OWN(fx_file) f = {0};
    moving_point point[MOVING_POINTS] = {0};
    double q[GLOBAL], energy = 0.0, expected = 0.0;

    write_and_read(*state, "22", NULL, &f);
    collect_points(*state, &f, point);
    move_frame(straight, q);
    for (int a = 0; a < GLOBAL; a++)
        for (int b = 0; b < GLOBAL; b++)
            energy += q[a] * f.M_R[a][b] * q[b];
    for (int n = 0; n < MOVING_POINTS; n++) {
        double v[3];

        ritz_cross(w, point[n].x, v);
        for (int a = 0; a < 3; a++)
            v[a] += v0[a];
        expected += point[n].m * ritz_dot(v, v);
    }
    assert_near(energy, expected, 10.0 * digits);
}

/* q'M_C(P) alpha' = sum of m (v0 + w x P r) . P u for the velocity u of the
   modes. */
static void check_coupling(const fx_file *f, const moving_point *point,
                           const double *P)
{
    double q[GLOBAL], told = 0.0, expected = 0.0;

    move_frame(P, q);
    for (int k = 0; k < 9; k++)
        for (int p = 0; p < GLOBAL; p++)
            for (int i = 0; i < MODES; i++)
                told += P[k] * q[p] * f->M_C[k][p][i] * rate[i];
    for (int n = 0; n < MOVING_POINTS; n++) {
        double u[3], at[3], v[3], moved[3];

        moving_velocity(&point[n], rate, u);
        turn(P, point[n].x, at);
        turn(P, u, moved);
        ritz_cross(w, at, v);
        for (int a = 0; a < 3; a++)
            v[a] += v0[a];
        expected += point[n].m * ritz_dot(v, moved);
    }
    assert_near(told, expected, 10.0 * digits);
}

static void modes_have_their_momentum_wherever_the_frame_is(void **state)
{
    RITZ_OWN(fx_file) f = {0}, mean = {0};
    moving_point point[MOVING_POINTS] = {0};

    write_and_read(*state, "22", "tangent", &f);
    collect_points(*state, &f, point);
    check_coupling(&f, point, straight);
    check_coupling(&f, point, turned);
    write_and_read(*state, NULL, NULL, &mean);
    collect_points(*state, &mean, point);
    check_coupling(&mean, point, turned);
}

/* ---- forces ------------------------------------------------------------- */

/* Power of the elastic forces P K phi of a mode in a rigid motion of the frame.
   K is that of the model; the file has none at grids. */
static double power_of(const ritz_dense *K, const fx_file *f,
                       const moving_node *node, int mode)
{
    double u[ROWS], power = 0.0;

    for (int r = 0; r < ROWS; r++)
        u[r] = f->local[mode][r / 6][r % 6];
    for (int n = 0; n < NODES; n++) {
        double force[6] = {0}, at[3], v[3], global[6];

        for (int r = 0; r < 6; r++)
            for (int c = 0; c < ROWS; c++)
                force[r] += ritz_dense_col(K, c)[6 * n + r] * u[c];
        turn(turned, force, global);
        turn(turned, force + 3, global + 3);
        turn(turned, node[n].x, at);
        ritz_cross(w, at, v);
        for (int a = 0; a < 3; a++)
            v[a] += v0[a];
        power += ritz_dot(v, global) + ritz_dot(w, global + 3);
    }
    return power;
}

/* K_C enters the equations by this power alone. As the power is zero, K_C may be
   zero as well. */
static void deformation_does_no_work_in_rigid_motion(void **state)
{
    const moving_body *of = *state;
    RITZ_OWN(fx_file) f = {0};
    RITZ_OWN(ritz_dense) K = {0};
    moving_node node[NODES] = {0};

    write_and_read(of, "22", NULL, &f);
    collect_nodes(&f, node);
    assert_ok(ritz_sparse_dense(&of->body.K, &K));
    for (int i = 0; i < MODES; i++)
        assert_near(power_of(&K, &f, node, i), 0.0,
                    digits * ritz_dense_max(&K));
    for (int k = 0; k < 9; k++)
        for (int p = 0; p < GLOBAL; p++)
            for (int i = 0; i < MODES; i++)
                assert_true(f.K_C[k][p][i] == 0.0);
}

/* M and K of the free body near P = I, in six rigid motions and its local modes.
   R has the rates of the global modes in each rigid motion. */
static void assemble(const fx_file *f, ritz_dense *K, ritz_dense *M)
{
    double R[GLOBAL][6] = {{0}};

    for (int p = 0; p < 12; p++) {
        const double arm[3] = {p / 3 == 0, p / 3 == 1, p / 3 == 2};

        R[p][p % 3] = 1.0;
        for (int a = 0; a < 3; a++) {
            const double unit[3] = {a == 0, a == 1, a == 2};
            double spun[3];

            ritz_cross(unit, arm, spun);
            R[p][3 + a] = spun[p % 3];
        }
    }
    for (int p = 12; p < GLOBAL; p++)
        R[p][p - 9] = 1.0;
    assert_ok(ritz_dense_new(6 + MODES, 6 + MODES, K));
    assert_ok(ritz_dense_new(6 + MODES, 6 + MODES, M));
    for (int a = 0; a < 6; a++)
        for (int p = 0; p < GLOBAL; p++) {
            for (int b = 0; b < 6; b++)
                for (int q = 0; q < GLOBAL; q++)
                    ritz_dense_col(M, b)[a] += R[p][a] * f->M_R[p][q] * R[q][b];
            for (int k = 0; k < 9; k += 4) /* entries of P = I that are 1 */
                for (int i = 0; i < MODES; i++) {
                    ritz_dense_col(M, 6 + i)[a] += R[p][a] * f->M_C[k][p][i];
                    ritz_dense_col(M, a)[6 + i] += R[p][a] * f->M_C[k][p][i];
                }
        }
    for (int i = 0; i < MODES; i++) {
        ritz_dense_col(M, 6 + i)[6 + i] = f->M[i];
        ritz_dense_col(K, 6 + i)[6 + i] = f->K[i];
    }
}

static void a_free_body_vibrates_as_the_component(void **state)
{
    static const char *const frames[] = {NULL, "22", "24", "basic"};
    const moving_body *of = *state;
    RITZ_OWN(ritz_pairs) expected = {0};

    assert_ok(ritz_eigen_dense(&of->reduced.K, &of->reduced.M, &expected));
    for (size_t k = 0; k < sizeof frames / sizeof *frames; k++) {
        RITZ_OWN(fx_file) f = {0};
        RITZ_OWN(ritz_dense) K = {0}, M = {0};
        RITZ_OWN(ritz_pairs) pairs = {0};

        write_and_read(of, frames[k], NULL, &f);
        assert_near(f.freq, sqrt(f.K[MODES - 1]) / (2.0 * 3.14159265358979),
                    1e-12 * f.freq);
        assemble(&f, &K, &M);
        assert_ok(ritz_eigen_dense(&K, &M, &pairs));
        for (int64_t i = 6; i < 6 + MODES; i++)
            assert_near(pairs.lambda[i], expected.lambda[i],
                        digits * expected.lambda[5 + MODES]);
    }
}

/* ---- held bodies, damping, refusals ------------------------------------- */

static ritz_status write_body(const ritz_reduced *reduced, const char *path,
                              const char *frame, const char *reference,
                              ritz_export_report *report)
{
    const ritz_export_request request = {
        .output = path, .frame = frame, .reference = reference};

    return ritz_exporter_fxbody.write(&(ritz_export_object){.reduced = reduced},
                                      &request, report);
}

/* Reduce with the identity as basis, with springs to ground at the first dofs. */
static ritz_status hold_chain(const moving_body *of, int64_t springs,
                              ritz_reduced *out)
{
    ritz_component held = of->body; /* its own is K alone */
    RITZ_OWN(ritz_sparse) K = {0};
    RITZ_OWN(ritz_dense) dense = {0};
    RITZ_OWN(ritz_basis) basis = {0};

    RITZ_CHECK(ritz_sparse_dense(&of->body.K, &dense));
    for (int64_t i = 0; i < springs; i++)
        ritz_dense_col(&dense, i)[i] += 5000.0;
    RITZ_CHECK(ritz_sparse_from_dense(&dense, &K));
    held.K = K;
    RITZ_CHECK(ritz_basis_new(ROWS, ROWS, &basis));
    for (int64_t i = 0; i < ROWS; i++)
        ritz_dense_col(&basis.T, i)[i] = 1.0;
    return ritz_reduce(&held, &basis, out);
}

static void a_held_body_has_local_modes_alone(void **state)
{
    const char *path = folder_path("held.fxb");
    RITZ_OWN(ritz_reduced) held = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN(fx_file) f = {0};

    assert_ok(hold_chain(*state, 6, &held));
    assert_ok(ritz_eigen_dense(&held.K, &held.M, &pairs));
    assert_ok(write_body(&held, path, NULL, NULL, &report));
    read_file(path, &f);
    assert_int_equal(f.Iblo, 1);
    assert_int_equal(f.Nbmod, ROWS);
    for (int64_t i = 0; i < ROWS; i++) {
        assert_near(f.K[i], pairs.lambda[i], digits * pairs.lambda[ROWS - 1]);
        assert_true(f.M[i] == 1.0);
    }
}

static bool says(const ritz_export_report *report, const char *words)
{
    for (int64_t k = 0; k < report->count; k++)
        if (strstr(report->line[k], words))
            return true;
    return false;
}

/* The body has D = K: alpha = 0 and beta = 1. */
static void damping_is_that_of_rayleigh(void **state)
{
    const moving_body *of = *state;
    const char *path = folder_path("damped.fxb");
    ritz_reduced other = of->reduced; /* borrowed */
    RITZ_OWN(ritz_export_report) report = {0}, warned = {0}, large = {0};
    RITZ_OWN(fx_file) f = {0}, bare = {0};

    assert_ok(write_body(&of->reduced, path, NULL, NULL, &report));
    read_file(path, &f);
    assert_int_equal(f.Idamp, 1);
    assert_near(f.damping[0], 0.0, digits * f.K[MODES - 1]);
    assert_near(f.damping[1], 1.0, digits);
    assert_true(says(&report, "Rayleigh damping"));
    other.D = (ritz_dense){0};
    snprintf(other.damping, sizeof other.damping, "modal 0.01");
    assert_ok(write_body(&other, path, NULL, NULL, &warned));
    read_file(path, &bare);
    assert_int_equal(bare.Idamp, 0);
    assert_true(says(&warned, "warning: damping is not alpha M + beta K"));
    snprintf(other.damping, sizeof other.damping, "rayleigh 0 1e303");
    assert_ok(write_body(&other, path, NULL, NULL, &large));
    assert_true(says(&large, "warning: damping is not alpha M + beta K"));
}

static void assert_refused(const ritz_reduced *reduced, const char *reference,
                           const char *words)
{
    const char *path = folder_path("none.fxb");
    RITZ_OWN(ritz_export_report) report = {0};

    assert_fails(write_body(reduced, path, NULL, reference, &report),
                 RITZ_ERR_ARGUMENT, words);
    assert_int_equal(access(path, F_OK), -1);
}

static void what_radioss_cannot_take_is_refused(void **state)
{
    static const double at[NODES][3] = {
        {0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {2, 1, 1}};
    const moving_body *of = *state;
    moving_body far = {0};
    ritz_reduced other = of->reduced; /* borrowed */
    RITZ_OWN(ritz_reduced) hinged = {0}, many = {0};

    assert_ok(hold_chain(of, 3, &hinged));
    assert_refused(&hinged, "none", "3 of six rigid motions are free");
    assert_ok(body_chain(NODES, at, 99999998, 9, &far.body));
    assert_ok(hold_chain(&far, 0, &many));
    assert_refused(&many, NULL, "grid 100000001 has more");
    ritz_component_free(&far.body);
    other.T = (ritz_dense){0};
    assert_refused(&other, NULL, "--without-basis");
}

static ritz_status write_once(const moving_body *of, const char *path)
{
    RITZ_OWN(ritz_export_report) report = {0};

    return write_body(&of->reduced, path, "22", NULL, &report);
}

static void no_allocation_failure_leaks(void **state)
{
    assert_survives_every_allocation(
        write_once(*state, folder_path("body.fxb")));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(global_modes_hold_rigid_motion),
    cmocka_unit_test(rigid_inertia_is_that_of_the_points),
    cmocka_unit_test(modes_have_their_momentum_wherever_the_frame_is),
    cmocka_unit_test(deformation_does_no_work_in_rigid_motion),
    cmocka_unit_test(a_free_body_vibrates_as_the_component),
    cmocka_unit_test(a_held_body_has_local_modes_alone),
    cmocka_unit_test(damping_is_that_of_rayleigh),
    cmocka_unit_test(what_radioss_cannot_take_is_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(fxbody, tests, moving_body_set_up, moving_body_tear_down)
