#include "testing.h"

#include "faults.h"

#include "base/draft.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static const char path[] = "test_draft.out";

/* One letter into a file, and the first letter of one; 0 if it is not there. */
static void put(const char *name, char letter)
{
    FILE *file = fopen(name, "w");

    assert_non_null(file);
    fputc(letter, file);
    fclose(file);
}

static int get(const char *name)
{
    FILE *file = fopen(name, "r");
    int letter = file ? fgetc(file) : 0;

    if (file)
        fclose(file);
    return letter;
}

static void two_writers_do_not_meet(void **state)
{
    ritz_draft first = {0};
    ritz_draft second = {0};

    (void)state;
    assert_ok(ritz_draft_new(path, &first));
    assert_ok(ritz_draft_new(path, &second));
    put(first.name, '1');
    put(second.name, '2');
    assert_int_equal(get(path), 0);
    assert_ok(ritz_draft_publish(&second));
    assert_int_equal(get(path), '2');
    assert_ok(ritz_draft_publish(&first));
    assert_int_equal(get(path), '1');
    assert_null(first.name);
    remove(path);
}

static void what_is_not_published_is_removed(void **state)
{
    ritz_draft draft = {0};
    char name[4096];

    (void)state;
    put(path, 'x');
    assert_ok(ritz_draft_new(path, &draft));
    snprintf(name, sizeof name, "%s", draft.name);
    put(name, '1');
    ritz_draft_free(&draft);
    assert_int_equal(get(name), 0);
    assert_int_equal(get(path), 'x');
    remove(path);
}

static void permissions_are_those_of_any_new_file(void **state)
{
    RITZ_OWN(ritz_draft) draft = {0};
    struct stat made = {0};
    mode_t before = umask(027);

    (void)state;
    assert_ok(ritz_draft_new(path, &draft));
    umask(before);
    assert_int_equal(stat(draft.name, &made), 0);
    assert_int_equal(made.st_mode & 0777, 0640);
}

static void devices_and_folders_stay(void **state)
{
    ritz_draft draft = {0};

    (void)state;
    assert_fails(ritz_draft_new("/dev/null", &draft), RITZ_ERR_FILE,
                 "not a regular file");
    assert_fails(ritz_draft_new(".", &draft), RITZ_ERR_FILE,
                 "not a regular file");
    assert_fails(ritz_draft_new("nowhere/out", &draft), RITZ_ERR_FILE,
                 "No such file");
    assert_null(draft.name);
}

static void a_link_stays_and_what_it_names_is_replaced(void **state)
{
    static const char other[] = "test_draft.link";
    ritz_draft draft = {0};
    struct stat there = {0};

    (void)state;
    put(path, 'x');
    remove(other);
    assert_int_equal(symlink(path, other), 0);
    assert_ok(ritz_draft_new(other, &draft));
    put(draft.name, '1');
    assert_ok(ritz_draft_publish(&draft));
    assert_int_equal(lstat(other, &there), 0);
    assert_true(S_ISLNK(there.st_mode));
    assert_int_equal(get(path), '1');
    remove(other);
    remove(path);
}

/* What a signal handler calls; the drafts are then freed as ever. */
static void unfinished_drafts_are_discarded_at_once(void **state)
{
    ritz_draft kept = {0};
    ritz_draft drafts[2] = {{0}};

    (void)state;
    assert_ok(ritz_draft_new(path, &kept));
    put(kept.name, 'k');
    assert_ok(ritz_draft_publish(&kept));
    for (int k = 0; k < 2; k++) {
        assert_ok(ritz_draft_new(path, &drafts[k]));
        put(drafts[k].name, 'd');
    }
    ritz_draft_discard_all();
    assert_int_equal(get(drafts[0].name), 0);
    assert_int_equal(get(drafts[1].name), 0);
    assert_int_equal(get(path), 'k');
    ritz_draft_free(&drafts[0]);
    ritz_draft_free(&drafts[1]);
    remove(path);
}

static void any_number_of_drafts_is_discarded(void **state)
{
    enum { MANY = 40 };
    ritz_draft drafts[MANY] = {{0}};

    (void)state;
    for (int k = 0; k < MANY; k++)
        assert_ok(ritz_draft_new(path, &drafts[k]));
    ritz_draft_free(&drafts[3]); /* leaves a place */
    assert_ok(ritz_draft_new(path, &drafts[3]));
    ritz_draft_discard_all();
    for (int k = 0; k < MANY; k++) {
        assert_int_not_equal(access(drafts[k].name, F_OK), 0);
        ritz_draft_free(&drafts[k]);
    }
}

static void permissions_of_a_replaced_file_stay(void **state)
{
    static const mode_t modes[] = {0600, 0640, 0444, 0755};
    struct stat there = {0};

    (void)state;
    for (size_t k = 0; k < sizeof modes / sizeof *modes; k++) {
        ritz_draft draft = {0};

        put(path, 'x');
        assert_int_equal(chmod(path, modes[k]), 0);
        assert_ok(ritz_draft_new(path, &draft));
        assert_int_equal(stat(draft.name, &there), 0);
        /* no access for others while it is written */
        assert_int_equal(there.st_mode & 077, 0);
        put(draft.name, '1');
        assert_ok(ritz_draft_publish(&draft));
        assert_int_equal(stat(path, &there), 0);
        assert_int_equal(there.st_mode & 0777, modes[k]);
        assert_int_equal(get(path), '1');
        remove(path);
    }
}

/* Two links in a row, the second one in a folder. */
static void a_dangling_link_stays_and_its_target_is_made(void **state)
{
    static const char link[] = "test_draft.link";
    static const char folder[] = "test_draft.d";
    static const char inner[] = "test_draft.d/link";
    ritz_draft draft = {0};
    struct stat there = {0};

    (void)state;
    mkdir(folder, 0777);
    remove(path);
    assert_int_equal(symlink("../test_draft.out", inner), 0);
    assert_int_equal(symlink(inner, link), 0);
    assert_true(ritz_draft_same(link, path));
    assert_ok(ritz_draft_new(link, &draft));
    put(draft.name, '1');
    assert_ok(ritz_draft_publish(&draft));
    assert_int_equal(lstat(link, &there), 0);
    assert_true(S_ISLNK(there.st_mode));
    assert_int_equal(lstat(inner, &there), 0);
    assert_true(S_ISLNK(there.st_mode));
    assert_int_equal(get(path), '1');
    remove(inner);
    assert_int_equal(symlink("link", inner), 0); /* a link to itself */
    assert_fails(ritz_draft_new(inner, &draft), RITZ_ERR_FILE,
                 "Too many levels");
    remove(inner);
    remove(link);
    remove(folder);
    remove(path);
}

static void one_file_has_many_names(void **state)
{
    static const char other[] = "test_draft.two";

    (void)state;
    remove(path);
    remove(other);
    assert_true(ritz_draft_same(path, "./test_draft.out"));
    assert_false(ritz_draft_same(path, other));
    assert_false(ritz_draft_same("nowhere/a", "nowhere/a"));
    put(path, 'x');
    assert_false(ritz_draft_same(path, other));
    assert_int_equal(link(path, other), 0);
    assert_true(ritz_draft_same(path, other));
    remove(other);
    put(other, 'x');
    assert_false(ritz_draft_same(path, other));
    remove(other);
    remove(path);
}

/* Write and publish drafts of two paths while the program holds published
   drafts back. */
static void hold_two(const char *first, const char *second)
{
    const char *const paths[] = {first, second};

    for (int k = 0; k < 2; k++) {
        ritz_draft draft = {0};

        assert_ok(ritz_draft_new(paths[k], &draft));
        put(draft.name, (char)('1' + k));
        assert_ok(ritz_draft_publish(&draft));
        assert_null(draft.name);
    }
}

static void held_drafts_appear_together_or_not_at_all(void **state)
{
    static const char other[] = "test_draft.two";
    char name[64];

    (void)state;
    put(path, 'x');
    for (int keep = 0; keep < 2; keep++) {
        ritz_draft_hold();
        hold_two(path, other);
        assert_int_equal(get(path), 'x');
        assert_int_equal(get(other), 0);
        assert_ok(ritz_draft_settle(keep == 1));
        assert_int_equal(get(path), keep == 1 ? '1' : 'x');
        assert_int_equal(get(other), keep == 1 ? '2' : 0);
        snprintf(name, sizeof name, "%s.%ld-0.part", path, (long)getpid());
        assert_int_equal(get(name), 0);
    }
    /* ritz_draft_discard_all, which signal handlers call, removes drafts that
       are held back too */
    ritz_draft_hold();
    hold_two(path, other);
    ritz_draft_discard_all();
    assert_fails(ritz_draft_settle(true), RITZ_ERR_FILE, "No such file");
    assert_int_equal(get(path), '1');
    remove(other);
    remove(path);
}

static void a_failed_rename_removes_the_other_held_file(void **state)
{
    static const char other[] = "test_draft.two";

    (void)state;
    ritz_draft_hold();
    hold_two(path, other);
    assert_int_equal(mkdir(other, 0777), 0);
    assert_fails(ritz_draft_settle(true), RITZ_ERR_FILE, "cannot replace");
    assert_int_equal(get(path), 0);
    rmdir(other);
}

static void files_that_belong_together_appear_all_or_none(void **state)
{
    static const char other[] = "test_draft.two";

    (void)state;
    for (int fails = 0; fails < 2; fails++) {
        ritz_draft first = {0}, second = {0};

        assert_ok(ritz_draft_new(path, &first));
        assert_ok(ritz_draft_new(other, &second));
        put(first.name, '1');
        put(second.name, '2');
        if (fails) {
            remove(other);
            assert_int_equal(mkdir(other, 0777), 0);
            assert_fails(
                ritz_draft_publish_all(2, (ritz_draft *[]){&first, &second}),
                RITZ_ERR_FILE, "cannot replace");
        } else {
            assert_ok(
                ritz_draft_publish_all(2, (ritz_draft *[]){&first, &second}));
        }
        assert_int_equal(get(path), fails ? 0 : '1');
        assert_null(first.name);
        assert_null(second.path);
    }
    rmdir(other);
}

static void inputs_are_not_replaced(void **state)
{
    static const char other[] = "test_draft.two";
    static const char sentence[] = "would overwrite the input 'test_draft.out'";
    ritz_draft draft = {0};

    (void)state;
    put(path, 'x');
    assert_ok(ritz_draft_protect(path)); /* without effect before the hold */
    assert_ok(ritz_draft_check(path));
    ritz_draft_hold();
    assert_ok(ritz_draft_protect(path));
    assert_ok(ritz_draft_protect(path));
    assert_ok(ritz_draft_protect("/dev/null"));
    assert_fails(ritz_draft_new(path, &draft), RITZ_ERR_ARGUMENT, sentence);
    ritz_draft_unprotect(path);
    assert_ok(ritz_draft_check(path));
    assert_ok(ritz_draft_protect(path));
    assert_int_equal(link(path, other), 0);
    assert_fails(ritz_draft_new(other, &draft), RITZ_ERR_ARGUMENT, sentence);
    remove(other);
    assert_int_equal(symlink(path, other), 0);
    assert_fails(ritz_draft_new(other, &draft), RITZ_ERR_ARGUMENT, sentence);
    remove(other);
    put(other, 'y');
    assert_ok(ritz_draft_new(other, &draft));
    /* an input now, while its draft is open */
    assert_ok(ritz_draft_protect(other));
    assert_fails(ritz_draft_publish(&draft), RITZ_ERR_ARGUMENT,
                 "would overwrite the input 'test_draft.two'");
    ritz_draft_free(&draft);
    assert_ok(ritz_draft_settle(true));
    assert_ok(ritz_draft_check(path));
    assert_int_equal(get(other), 'y');
    remove(other);
    remove(path);
}

static void no_file_is_written_twice_by_one_program(void **state)
{
    static const char other[] = "test_draft.two";
    ritz_draft draft = {0};

    (void)state;
    ritz_draft_hold();
    hold_two(path, other);
    assert_fails(ritz_draft_new("./test_draft.two", &draft), RITZ_ERR_ARGUMENT,
                 "written twice");
    assert_ok(ritz_draft_settle(false));
}

static ritz_status hold_one(void)
{
    ritz_draft draft = {0};
    ritz_status status = RITZ_OK;

    ritz_draft_hold();
    status = ritz_draft_protect("test_draft.two");
    if (status == RITZ_OK)
        status = ritz_draft_new(path, &draft);
    if (status == RITZ_OK)
        status = ritz_draft_publish(&draft);
    ritz_draft_free(&draft);
    assert_ok(ritz_draft_settle(false));
    return status;
}

static void survives_every_allocation(void **state)
{
    (void)state;
    put("test_draft.two", 'x');
    assert_survives_every_allocation(hold_one());
    remove("test_draft.two");
}

/* --- a disk that fails ---------------------------------------------------- */

static ritz_status write_one(const void *)
{
    RITZ_OWN(ritz_draft) draft = {0};

    RITZ_CHECK(ritz_draft_new(path, &draft));
    put(draft.name, '1');
    return ritz_draft_publish(&draft);
}

static ritz_status write_two(const void *)
{
    RITZ_OWN(ritz_draft) first = {0}, second = {0};

    remove("test_draft.out.h5");
    RITZ_CHECK(ritz_draft_new(path, &first));
    RITZ_CHECK(ritz_draft_new("test_draft.out.h5", &second));
    put(first.name, '1');
    put(second.name, '2');
    ritz_draft_hold();
    assert_ok(ritz_draft_publish(&first));
    assert_ok(ritz_draft_publish(&second));
    return ritz_draft_settle(true);
}

/* The three calls in their order: fsync of the file, rename, fsync of the
   folder. */
static void a_failed_sync_or_rename_leaves_no_file(void **)
{
    setenv("RITZ_SYNC", "1", 1);
    assert_int_equal(faults_try_each(write_one, NULL, path), 3);
}

static void a_failure_leaves_neither_of_two_held_files(void **)
{
    setenv("RITZ_SYNC", "1", 1);
    assert_int_equal(faults_try_each(write_two, NULL, path), 6);
    remove("test_draft.out.h5");
}

static void a_failure_before_the_rename_leaves_the_old_file(void **)
{
    setenv("RITZ_SYNC", "1", 1);
    for (int k = 1; k <= 2; k++) {
        put(path, 'x');
        faults_begin(k, false);
        assert_fails(write_one(NULL), RITZ_ERR_FILE, "Input/output error");
        assert_true(faults_end());
        assert_int_equal(get(path), 'x');
    }
    remove(path);
}

static void end_process(int number)
{
    ritz_draft_discard_all();
    _exit(number);
}

/* The signal comes before the first rename, and the process ends after the
   last one. */
static void a_signal_leaves_all_files_of_a_set(void **state)
{
    const struct sigaction action = {.sa_handler = end_process};
    int outcome = 0;
    pid_t writer = fork();

    (void)state;
    if (writer == 0) {
        sigaction(SIGTERM, &action, NULL);
        faults_signal = SIGTERM;
        _exit(write_two(NULL) == RITZ_OK ? 0 : 1);
    }
    assert_int_equal(waitpid(writer, &outcome, 0), writer);
    assert_true(WIFEXITED(outcome));
    assert_int_equal(WEXITSTATUS(outcome), SIGTERM);
    assert_int_equal(get(path), '1');
    assert_int_equal(get("test_draft.out.h5"), '2');
    remove("test_draft.out.h5");
    remove(path);
}

/* Number of calls of fsync when one file is published. */
static int count_syncs(void)
{
    faults_begin(1000, false);
    assert_ok(write_one(NULL));
    assert_false(faults_end());
    return faults_syncs();
}

static void syncs_are_left_out_on_request(void **)
{
    setenv("RITZ_SYNC", "0", 1);
    assert_int_equal(count_syncs(), 0);
    setenv("RITZ_SYNC", "1", 1);
    assert_int_equal(count_syncs(), 2);
    unsetenv("RITZ_SYNC");
    assert_int_equal(count_syncs(), 2);
    remove(path);
}

/* --- drafts of killed writers --------------------------------------------- */

/* Name of the first draft of `path` by the process `writer`. */
static void name_draft(pid_t writer, char name[64])
{
    snprintf(name, 64, "%s.%ld-0.part", path, (long)writer);
}

static void drafts_of_killed_writers_are_swept(void **state)
{
    ritz_draft draft = {0};
    char left[64];
    int outcome = 0;
    pid_t writer = fork();

    (void)state;
    if (writer == 0) {
        if (ritz_draft_new(path, &draft) == RITZ_OK)
            raise(SIGKILL);
        _exit(1);
    }
    assert_int_equal(waitpid(writer, &outcome, 0), writer);
    assert_true(WIFSIGNALED(outcome));
    name_draft(writer, left);
    assert_int_equal(get(left), EOF); /* the draft exists and is empty */
    assert_ok(ritz_draft_new(path, &draft));
    assert_int_equal(get(left), 0);
    assert_int_equal(get(draft.name), EOF);
    ritz_draft_free(&draft);
}

/* Two writers of one file, as under make -j: neither removes the other's
   draft. */
static void drafts_of_living_writers_stay(void **state)
{
    ritz_draft draft = {0};
    char theirs[64];
    char letter = 'w';
    int ready[2], done[2];
    int outcome = 0;
    pid_t writer = -1;

    (void)state;
    assert_int_equal(pipe(ready), 0);
    assert_int_equal(pipe(done), 0);
    writer = fork();
    if (writer == 0) {
        bool made = ritz_draft_new(path, &draft) == RITZ_OK;

        close(done[1]); /* so that read ends if the test fails */
        made = write(ready[1], &letter, 1) == 1 && made;
        made = read(done[0], &letter, 1) == 1 && made;
        _exit(made && ritz_draft_publish(&draft) == RITZ_OK ? 0 : 1);
    }
    name_draft(writer, theirs);
    assert_int_equal(read(ready[0], &letter, 1), 1);
    assert_ok(ritz_draft_new(path, &draft));
    ritz_draft_free(&draft);
    assert_int_equal(get(theirs), EOF);
    assert_int_equal(write(done[1], &letter, 1), 1);
    assert_int_equal(waitpid(writer, &outcome, 0), writer);
    assert_true(WIFEXITED(outcome) && WEXITSTATUS(outcome) == 0);
    for (int k = 0; k < 2; k++) {
        close(ready[k]);
        close(done[k]);
    }
    assert_int_equal(remove(path), 0);
}

static void files_of_other_names_are_not_swept(void **state)
{
    static const char *const names[] = {
        "test_draft.out.part",         "test_draft.out.1.part",
        "test_draft.out.x-0.part",     "test_draft.out.1-.part",
        "test_draft.out.1-0.part.old", "test_draft.out2.1-0.part",
        "Test_draft.out.1-0.part",     "test_draft.out.1-0x.part",
    };
    static const char linked[] = "test_draft.out.1-0.part";
    static const char pipe_name[] = "test_draft.out.1-1.part";
    static const char folder[] = "test_draft.out.1-2.part";
    enum { COUNT = sizeof names / sizeof *names };
    struct stat there = {0};
    ritz_draft draft = {0};

    (void)state;
    for (int k = 0; k < COUNT; k++)
        put(names[k], 'n');
    remove(linked); /* may be left by an earlier run */
    remove(pipe_name);
    remove(folder);
    assert_int_equal(symlink(names[0], linked), 0);
    assert_int_equal(mkfifo(pipe_name, 0600), 0);
    assert_int_equal(mkdir(folder, 0700), 0);
    assert_ok(ritz_draft_new(path, &draft));
    ritz_draft_free(&draft);
    for (int k = 0; k < COUNT; k++) {
        assert_int_equal(get(names[k]), 'n');
        assert_int_equal(remove(names[k]), 0);
    }
    assert_int_equal(lstat(linked, &there), 0);
    assert_int_equal(remove(linked), 0);
    assert_int_equal(remove(pipe_name), 0);
    assert_int_equal(remove(folder), 0);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(two_writers_do_not_meet),
    cmocka_unit_test(what_is_not_published_is_removed),
    cmocka_unit_test(permissions_are_those_of_any_new_file),
    cmocka_unit_test(devices_and_folders_stay),
    cmocka_unit_test(a_link_stays_and_what_it_names_is_replaced),
    cmocka_unit_test(unfinished_drafts_are_discarded_at_once),
    cmocka_unit_test(any_number_of_drafts_is_discarded),
    cmocka_unit_test(permissions_of_a_replaced_file_stay),
    cmocka_unit_test(a_dangling_link_stays_and_its_target_is_made),
    cmocka_unit_test(one_file_has_many_names),
    cmocka_unit_test(held_drafts_appear_together_or_not_at_all),
    cmocka_unit_test(a_failed_rename_removes_the_other_held_file),
    cmocka_unit_test(files_that_belong_together_appear_all_or_none),
    cmocka_unit_test(inputs_are_not_replaced),
    cmocka_unit_test(no_file_is_written_twice_by_one_program),
    cmocka_unit_test(survives_every_allocation),
    cmocka_unit_test(a_failed_sync_or_rename_leaves_no_file),
    cmocka_unit_test(a_failure_leaves_neither_of_two_held_files),
    cmocka_unit_test(a_failure_before_the_rename_leaves_the_old_file),
    cmocka_unit_test(a_signal_leaves_all_files_of_a_set),
    cmocka_unit_test(syncs_are_left_out_on_request),
    cmocka_unit_test(drafts_of_killed_writers_are_swept),
    cmocka_unit_test(drafts_of_living_writers_stay),
    cmocka_unit_test(files_of_other_names_are_not_swept),
};

TEST_MODULE(draft, tests, NULL, NULL)
