#include "testing.h"

#include "base/draft.h"

#include <stdio.h>
#include <sys/stat.h>
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

static void no_more_drafts_than_can_be_discarded(void **state)
{
    ritz_draft drafts[RITZ_MAX_DRAFTS + 1] = {{0}};

    (void)state;
    for (int k = 0; k < RITZ_MAX_DRAFTS; k++)
        assert_ok(ritz_draft_new(path, &drafts[k]));
    assert_fails(ritz_draft_new(path, &drafts[RITZ_MAX_DRAFTS]),
                 RITZ_ERR_ARGUMENT, "more than 16 files");
    ritz_draft_free(&drafts[3]); /* leaves a place */
    assert_ok(ritz_draft_new(path, &drafts[RITZ_MAX_DRAFTS]));
    for (int k = 0; k <= RITZ_MAX_DRAFTS; k++)
        ritz_draft_free(&drafts[k]);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(two_writers_do_not_meet),
    cmocka_unit_test(what_is_not_published_is_removed),
    cmocka_unit_test(permissions_are_those_of_any_new_file),
    cmocka_unit_test(devices_and_folders_stay),
    cmocka_unit_test(a_link_stays_and_what_it_names_is_replaced),
    cmocka_unit_test(unfinished_drafts_are_discarded_at_once),
    cmocka_unit_test(no_more_drafts_than_can_be_discarded),
};

TEST_MODULE(draft, tests, NULL, NULL)
