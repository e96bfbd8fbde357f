/* Histories of coordinates that are read from files of simulators. */
#include "testing.h"

#include "damage.h"
#include "folder.h"

#include <ritz/recover.h>

#include <stdio.h>
#include <stdlib.h>

enum { MOST = 8 };

/* A history in memory: all of its times. */
typedef struct held {
    int64_t count;
    double seconds[MOST], q[MOST][4], v[MOST][4], a[MOST][4], f[MOST][2];
    bool has_v, has_a, has_f;
} held;

static ritz_status read_all(const char *path,
                            const ritz_history_request *request, held *out)
{
    RITZ_OWN(ritz_history) history = {0};
    const int64_t r = request->V ? request->V->nrow : request->order;
    bool more = true;

    *out = (held){0};
    RITZ_CHECK(ritz_history_open(path, request, &history));
    while (true) {
        ritz_instant now = {0};
        int64_t k = out->count;

        RITZ_CHECK(ritz_history_next(&history, &now, &more));
        if (!more || k == MOST)
            return RITZ_OK;
        out->seconds[k] = now.seconds;
        for (int64_t j = 0; j < r && j < 4; j++) {
            out->q[k][j] = now.q[j];
            out->v[k][j] = now.v ? now.v[j] : 0.0;
            out->a[k][j] = now.a ? now.a[j] : 0.0;
        }
        for (int64_t j = 0; now.f && j < request->num_inputs; j++)
            out->f[k][j] = now.f[j];
        out->has_v = now.v;
        out->has_a = now.a;
        out->has_f = now.f;
        out->count++;
    }
}

/* A file of a sensor, with the head that Exudyn 1.13 writes. */
static const char sensor[] =
    "#Exudyn Sensor 'coordinates', file format version 1\n"
    "#time,values\n"
    "0.000000,1.,2.,10.,20.,100.,200.\n"
    "0.5,-1.,-2.,-10.,-20.,-100.,-2e2\n";

/* A table as FMPy's write_csv writes it. */
static const char named[] = "\"time\",\"v[1]\",\"q[1]\",\"q[2]\",\"v[2]\","
                            "\"push\"\n"
                            "0.0,10,1,2,20,7\n"
                            "0.25, 11,1.5,2.5,21, 8\n";

/* What Exudyn 1.13 writes of a frame, two modes and a joint. */
#define SOLUTION(counts)                                                       \
    "#columns contain: time, ODE2 displacements, ODE2 velocities, ODE2 "       \
    "accelerations, AE coordinates\n"                                          \
    "#number of written coordinates [nODE2, nVel2, nAcc2, nODE1, nVel1, "      \
    "nAlgebraic, nData] = [" counts ",0,0,1,0]\n"

static const char solution[] =
    SOLUTION("9,9,9") "0,.1,.2,.3,.4,.5,.6,.7,1,2,0,0,0,0,0,0,0,10,20,"
                      "0,0,0,0,0,0,0,100,200,8\n"
                      "#simulation finished=2026-11-28,18:44:28\n";

static const char modal[] = "       2.1 1 10 100\n"
                            "       2.4 2 20 200\n"
                            "       3.1 9 9 9\n"
                            "       2.1 -1 -10 -100\n"
                            "       2.4 -2 -20 -200\n"
                            "       3.1 9 9 9\n";

static const char inputs[1][RITZ_NAME_SIZE] = {"push"};

static ritz_history_request of_two(void)
{
    return (ritz_history_request){
        .order = 2, .num_inputs = 1, .input = inputs, .step = 0.5};
}

static void a_table_has_blocks_of_columns(void **)
{
    const ritz_history_request request = of_two();
    held all;

    assert_ok(read_all(folder_write("s.txt", sensor), &request, &all));
    assert_int_equal(all.count, 2);
    assert_near(all.seconds[1], 0.5, 0.0);
    assert_near(all.q[0][1], 2.0, 0.0);
    assert_near(all.v[1][0], -10.0, 0.0);
    assert_near(all.a[1][1], -200.0, 0.0);
    assert_true(all.has_v && all.has_a && !all.has_f);
}

static void a_table_has_names(void **)
{
    const ritz_history_request request = of_two();
    held all;

    assert_ok(read_all(folder_write("n.csv", named), &request, &all));
    assert_int_equal(all.count, 2);
    assert_near(all.q[1][1], 2.5, 0.0);
    assert_near(all.v[1][1], 21.0, 0.0);
    assert_near(all.f[1][0], 8.0, 0.0);
    assert_true(all.has_v && !all.has_a && all.has_f);
}

static void columns_are_chosen(void **)
{
    ritz_history_request request = of_two();
    const char *const path = folder_write("n.csv", named);
    held all;

    request.q = "v*";
    request.v = "3-4";
    request.f = "push";
    assert_ok(read_all(path, &request, &all));
    assert_near(all.q[0][1], 20.0, 0.0);
    assert_near(all.v[0][0], 1.0, 0.0);
    assert_near(all.f[0][0], 7.0, 0.0);
    request.q = "2,push";
    assert_ok(read_all(path, &request, &all));
    assert_near(all.q[1][1], 8.0, 0.0);
    request.q = "2-9";
    assert_fails(read_all(path, &request, &all), RITZ_ERR_ARGUMENT,
                 "there is no column 9, there are 6");
    request.q = "2";
    assert_fails(read_all(path, &request, &all), RITZ_ERR_ARGUMENT,
                 "--q names 1 columns, 2 are due");
    request.q = "x[1],2";
    assert_fails(read_all(path, &request, &all), RITZ_ERR_ARGUMENT,
                 "there is no column 'x[1]'");
    request.q = "2,,3";
    assert_fails(read_all(path, &request, &all), RITZ_ERR_ARGUMENT,
                 "is no list of columns");
}

/* A name may be used that is longer than those of our own files, and a name
   that no one asks for may stand twice. */
static void columns_of_one_name_are_not_chosen_by_it(void **)
{
#define LONG                                                                   \
    "a.name.of.a.variable.that.is.longer.than.sixty.four.letters.in.all"
    ritz_history_request request = of_two();
    const char *const path = folder_write("t.csv", "time,x,y,x," LONG ".p," LONG
                                                   ".q\n0,1,2,3,4,5\n");
    held all;

    request.q = LONG ".p," LONG ".q";
    assert_ok(read_all(path, &request, &all));
    assert_near(all.q[0][0], 4.0, 0.0);
    assert_near(all.q[0][1], 5.0, 0.0);
    request.q = "2,4";
    assert_ok(read_all(path, &request, &all));
    assert_near(all.q[0][1], 3.0, 0.0);
    request.q = "x,y";
    assert_fails(read_all(path, &request, &all), RITZ_ERR_FORMAT,
                 "the columns 2 and 4 are both called 'x'");
    request.q = "x*";
    assert_fails(read_all(path, &request, &all), RITZ_ERR_FORMAT,
                 "the columns 2 and 4 are both called 'x'");
}

/* A frame has 7 coordinates, or 6, and they come first. */
static void a_solution_has_a_frame_in_front(void **)
{
    ritz_history_request request = of_two();
    held all;

    request.floating = true;
    assert_ok(read_all(folder_write("s.txt", solution), &request, &all));
    assert_int_equal(all.count, 1);
    assert_near(all.q[0][0], 1.0, 0.0);
    assert_near(all.v[0][1], 20.0, 0.0);
    assert_near(all.a[0][0], 100.0, 0.0);
    /* 14 columns are not two blocks of seven coordinates */
    assert_ok(read_all(
        folder_write("q.txt", SOLUTION("8,0,0") "0,1,2,3,4,5,6,7,8,9\n"),
        &request, &all));
    assert_near(all.q[0][1], 8.0, 0.0);
    assert_true(!all.has_v && !all.has_a);
    assert_ok(read_all(folder_write("n.txt", SOLUTION("2,2,0") "0,1,2,3,4,9\n"),
                       &request, &all));
    assert_near(all.v[0][1], 4.0, 0.0);
}

static void solutions_of_more_bodies_need_columns(void **)
{
    ritz_history_request request = of_two();
    const char *const path = folder_write("s.txt", solution);
    held all;

    assert_fails(read_all(path, &request, &all), RITZ_ERR_ARGUMENT,
                 "the solution has 9 coordinates of all bodies, 2 are due");
    request.q = "9-10";
    assert_ok(read_all(path, &request, &all));
    assert_near(all.q[0][1], 2.0, 0.0);
    request.q = NULL;
    request.floating = true;
    request.order = 4;
    assert_fails(read_all(path, &request, &all), RITZ_ERR_ARGUMENT,
                 "9 coordinates of all bodies, 4 are due: name their columns");
}

static void derivatives_of_an_fmu_are_rates(void **)
{
    const ritz_history_request request = of_two();
    held all;

    assert_ok(
        read_all(folder_write("d.csv", "\"time\",\"der(v[2])\",\"der(q[1])\","
                                       "\"q[2]\",\"q[1]\",\"der(v[1])\","
                                       "\"der(q[2])\"\n0,200,10,2,1,100,20\n"),
                 &request, &all));
    assert_near(all.q[0][0], 1.0, 0.0);
    assert_near(all.v[0][0], 10.0, 0.0);
    assert_near(all.v[0][1], 20.0, 0.0);
    assert_near(all.a[0][1], 200.0, 0.0);
}

static void a_body_of_mbdyn_is_chosen_by_its_label(void **)
{
    const char *const path = folder_write("b.mod", modal);
    ritz_history_request request = of_two();
    held all;

    assert_ok(read_all(path, &request, &all));
    assert_int_equal(all.count, 2);
    assert_near(all.seconds[1], 0.5, 0.0);
    assert_near(all.q[1][1], -2.0, 0.0);
    assert_near(all.a[0][1], 200.0, 0.0);
    request.order = 1;
    request.label = 3;
    assert_ok(read_all(path, &request, &all));
    assert_int_equal(all.count, 2);
    assert_near(all.v[1][0], 9.0, 0.0);
    request.label = 4;
    assert_fails(read_all(path, &request, &all), RITZ_ERR_FORMAT,
                 "holds no mode of body 4");
    request.label = 2;
    assert_fails(read_all(path, &request, &all), RITZ_ERR_FORMAT,
                 "line 2: mode 4 of body 2 where another is due");
    request.order = 3;
    assert_fails(read_all(path, &request, &all), RITZ_ERR_FORMAT,
                 "line 4: mode 1 of body 2 where another is due");
    request.step = 0.0;
    assert_fails(read_all(path, &request, &all), RITZ_ERR_ARGUMENT,
                 "has no times: give --step");
    request.step = 1.0;
    request.q = "2-4";
    assert_fails(read_all(path, &request, &all), RITZ_ERR_ARGUMENT,
                 "has columns of its own");
}

/* A matrix V of the user turns coordinates x of a file into q = V x, and
   their rates and accelerations likewise. */
static void coordinates_are_transformed(void **)
{
    double values[6] = {1.0, 0.0, 2.0, 0.0, -1.0, 3.0};
    const ritz_dense V = {3, 2, values};
    ritz_history_request request = of_two();
    held all;

    request.V = &V;
    assert_ok(read_all(folder_write("s.txt", sensor), &request, &all));
    assert_near(all.q[0][0], 1.0, 0.0);
    assert_near(all.q[0][1], -2.0, 0.0);
    assert_near(all.q[0][2], 8.0, 0.0);
    assert_near(all.a[0][2], 800.0, 0.0);
}

static void what_is_no_history_is_refused(void **)
{
    const struct {
        const char *text, *words;
    } bad[] = {
        {"", "is no history that is known"},
        {"# nothing\n", "is no history that is known"},
        {"word\n", "is no history that is known"},
        {"0 1 2 3\n", "4 columns are not times and one to three"},
        {"time,x,y\n0,1,2\n", "no column is called 'q[1]'"},
        {"time,q[1]\n0,1\n", "there is no column 'q[2]', of 2 coordinates"},
        {"0,1,2\n1,1\n", "line 2 has 2 columns, the first has 3"},
        {"0,1,2\n1,1,x\n", "line 2: 'x' is no finite number"},
        {"0,1,2\n1,1,inf\n", "line 2: 'inf' is no finite number"},
        {"0 1 2\n\n-1 1 2\n", "time 2, -1 s, comes before 0 s"},
        {SOLUTION("2,2,x") "0,1,2,3,4\n", "no counts follow '#number of"},
        {SOLUTION("2,-2,0") "0,1,2,3,4\n", "no counts follow"},
        {SOLUTION("2,99999999999999999999,0") "0,1\n", "no counts follow"},
        {"#number of written coordinates\n0,1,2\n", "no counts follow"},
        {SOLUTION("2,2,0") "0,1,2\n", "has 3 columns, its head says that"},
        {SOLUTION("2,2,2") "0,1,2\n", "has 3 columns, its head says that"},
        {"time,q[1],q[2],der(v[1])\n0,1,2,3\n",
         "there is no column 'der(v[2])', of 2 coordinates"},
        {"time,q[1],q[2],q[3]\n0,1,2,3\n",
         "there is a column 'q[3]', and 2 coordinates are due"},
        {"time,q[1],q[2],q[1]\n0,1,2,3\n",
         "the columns 2 and 4 are both called 'q[1]'"},
        {"time,q[1],q[2],v[1],v[2],v[2]\n0,1,2,3,4,5\n",
         "the columns 5 and 6 are both called 'v[2]'"},
        {"time,q[1],q[2],Time\n0,1,2,3\n",
         "the columns 1 and 4 are both called 'time'"},
        {"time,q[1],q[2],push,push\n0,1,2,3,4\n",
         "the columns 4 and 5 are both called 'push'"},
        {"1.1 1 2 3\n", "ends within time 1, after 1 of 2 modes"},
        {"1.1 1 2 3\n1.2 1 2\n", "line 2 has less than three numbers"},
        {"1.1 1 2 3\n1.2 1 2 3 4\n", "line 2 has more than three numbers"},
        {"1.1 1 2 3\nx 1 2 3\n", "line 2 does not begin with BODY.MODE"},
    };
    const ritz_history_request request = of_two();
    held all;

    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        ritz_status status =
            read_all(folder_write("bad.txt", bad[k].text), &request, &all);

        assert_true(status != RITZ_OK);
        if (!strstr(ritz_error_message(), bad[k].words))
            fail_msg("%s: not %s", ritz_error_message(), bad[k].words);
    }
    assert_fails(read_all(folder_path("none.csv"), &request, &all),
                 RITZ_ERR_FILE, "cannot be opened");
}

/* Whatever the bytes, reading succeeds or is refused with a sentence. */
static ritz_status read_bytes(const char *bytes, int64_t size)
{
    const ritz_history_request request = of_two();
    const char *const path = folder_path("damaged");
    FILE *file = fopen(path, "wb");
    held all;
    ritz_status status = RITZ_OK;

    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, (size_t)size, file), size);
    fclose(file);
    status = read_all(path, &request, &all);
    return status == RITZ_ERR_ARGUMENT ? RITZ_ERR_FORMAT : status;
}

static void damaged_files_are_refused(void **)
{
    const char *const files[] = {sensor, named, modal, solution};

    for (int k = 0; k < 4; k++) {
        damage_cut(read_bytes, files[k], (int64_t)strlen(files[k]));
        damage_corrupt(read_bytes, files[k], (int64_t)strlen(files[k]));
    }
}

static ritz_status read_once(const char *path)
{
    const ritz_history_request request = of_two();
    held all;

    return read_all(path, &request, &all);
}

static void all_allocations_may_fail(void **)
{
    const char *const paths[] = {
        folder_write("s.txt", sensor), folder_write("n.csv", named),
        folder_write("b.mod", modal),
        folder_write("w.txt", SOLUTION("2,2,0") "0,1,2,3,4,9\n")};

    for (int k = 0; k < 4; k++)
        assert_survives_every_allocation(read_once(paths[k]));
}

static void simulations_need_their_coordinates(void **)
{
    const ritz_history_request request = of_two();
    RITZ_OWN(ritz_history) history = {0};
    double seconds[2] = {0.0, 0.5}, q[4] = {1, 2, 3, 4}, u[2] = {5, 6};
    char name[1][RITZ_NAME_SIZE] = {"push"};
    ritz_simulation s = {
        .count = 2, .seconds = seconds, .num_inputs = 1, .input = name, .u = u};
    ritz_instant now = {0};
    bool more = false;

    assert_fails(ritz_history_of_simulation(&s, &request, &history),
                 RITZ_ERR_ARGUMENT, "has no coordinates: ritz-simulate");
    s.num_coordinates = 3;
    assert_fails(ritz_history_of_simulation(&s, &request, &history),
                 RITZ_ERR_ARGUMENT, "has 3 coordinates, the component 2");
    s.num_coordinates = 2;
    s.q = s.v = s.a = q;
    assert_ok(ritz_history_of_simulation(&s, &request, &history));
    assert_ok(ritz_history_next(&history, &now, &more));
    assert_ok(ritz_history_next(&history, &now, &more));
    assert_true(more);
    assert_near(now.q[1], 4.0, 0.0);
    assert_near(now.f[0], 6.0, 0.0);
    assert_ok(ritz_history_next(&history, &now, &more));
    assert_false(more);
    ritz_history_free(&history);
    snprintf(name[0], sizeof name[0], "pull");
    assert_ok(ritz_history_of_simulation(&s, &request, &history));
    assert_false(history.has_f);
}

/* Two bodies with a coordinate and two. */
static void simulations_have_coordinates_of_bodies(void **)
{
    ritz_block block[2] = {{.name = "rotor", .order = 1},
                           {.name = "stator", .first = 1, .order = 2}};
    double seconds[2] = {0.0, 0.5}, q[6] = {1, 2, 3, 4, 5, 6};
    const ritz_simulation s = {.count = 2,
                               .seconds = seconds,
                               .num_coordinates = 3,
                               .q = q,
                               .v = q,
                               .a = q,
                               .num_blocks = 2,
                               .block = block};
    ritz_history_request request = {.order = 2, .unforced = true};
    RITZ_OWN(ritz_history) history = {0};
    ritz_instant now = {0};
    bool more = false;

    assert_fails(ritz_history_of_simulation(&s, &request, &history),
                 RITZ_ERR_ARGUMENT, "of 2 bodies: of which one? name it by");
    request.body = "rotr";
    assert_fails(ritz_history_of_simulation(&s, &request, &history),
                 RITZ_ERR_ARGUMENT, "unknown body 'rotr', is 'rotor' meant?");
    request.body = "rotor";
    assert_fails(ritz_history_of_simulation(&s, &request, &history),
                 RITZ_ERR_ARGUMENT, "rotor has 1 coordinates, the component 2");
    request.body = "stator";
    assert_ok(ritz_history_of_simulation(&s, &request, &history));
    assert_ok(ritz_history_next(&history, &now, &more));
    assert_near(now.q[0], 2.0, 0.0);
    assert_ok(ritz_history_next(&history, &now, &more));
    assert_near(now.q[0], 5.0, 0.0);
    assert_near(now.a[1], 6.0, 0.0);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_table_has_blocks_of_columns),
    cmocka_unit_test(a_table_has_names),
    cmocka_unit_test(columns_are_chosen),
    cmocka_unit_test(columns_of_one_name_are_not_chosen_by_it),
    cmocka_unit_test(a_solution_has_a_frame_in_front),
    cmocka_unit_test(solutions_of_more_bodies_need_columns),
    cmocka_unit_test(derivatives_of_an_fmu_are_rates),
    cmocka_unit_test(a_body_of_mbdyn_is_chosen_by_its_label),
    cmocka_unit_test(coordinates_are_transformed),
    cmocka_unit_test(what_is_no_history_is_refused),
    cmocka_unit_test(damaged_files_are_refused),
    cmocka_unit_test(simulations_need_their_coordinates),
    cmocka_unit_test(simulations_have_coordinates_of_bodies),
    cmocka_unit_test(all_allocations_may_fail),
};

TEST_MODULE(history, tests, folder_make, folder_remove)
