/*
 * Writes a series as a collection of VTK [Schroeder2006]: each frame is a file
 * with an unstructured grid in the folder NAME.frames, and NAME.pvd, next to
 * the folder, lists the times and files of all frames. Each frame gets its name
 * when it is complete, the list when all frames are. Later frames of an earlier
 * series of this name are removed then.
 */
#include "base/alloc.h"
#include "formats/certificate.h"
#include "formats/sink.h"

#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { NAME_ROOM = 32 }; /* bytes for "/000000.vtu" */

typedef struct pvd {
    char *folder; /* "motion.frames" */
    char *path;   /* of the present frame */
    bool made;    /* this series made the folder */
    bool finished;
} pvd;

/* Name the folder "motion.frames" after "motion.pvd". */
static ritz_status name_folder(const char *path, char **out)
{
    static const char ending[] = ".pvd";
    size_t length = strlen(path);
    const size_t end = sizeof ending - 1;
    int64_t room = 0;
    char *folder = NULL;

    if (length > end && strcmp(path + length - end, ending) == 0)
        length -= end;
    room = (int64_t)length + (int64_t)sizeof ".frames";
    RITZ_CHECK_NEW(folder, room);
    snprintf(folder, (size_t)room, "%.*s.frames", (int)length, path);
    *out = folder;
    return RITZ_OK;
}

static ritz_status begin(const char *path, const ritz_shapes *mesh,
                         ritz_series *series)
{
    pvd *p = NULL;

    (void)mesh; /* each frame contains the mesh */
    RITZ_CHECK_NEW(p, 1);
    series->own = p;
    RITZ_CHECK(name_folder(path, &p->folder));
    RITZ_CHECK_NEW(p->path, (int64_t)strlen(p->folder) + NAME_ROOM);
    p->made = mkdir(p->folder, 0777) == 0;
    RITZ_REFUSE_IF(!p->made && errno != EEXIST, RITZ_ERR_FILE,
                   "cannot make the folder '%s': %s", p->folder,
                   strerror(errno));
    return RITZ_OK;
}

static void name_frame(pvd *p, int64_t k)
{
    snprintf(p->path, strlen(p->folder) + NAME_ROOM, "%s/%06" PRId64 ".vtu",
             p->folder, k);
}

static ritz_status frame(ritz_series *series, const ritz_shapes *shapes)
{
    const ritz_vtu_parts parts = {shapes, series->comment};
    pvd *p = series->own;
    RITZ_OWN(ritz_draft) draft = {0};

    name_frame(p, series->count);
    RITZ_CHECK_IN(p->path, ritz_draft_new(p->path, &draft));
    RITZ_CHECK(ritz_sink_fill(&draft, ritz_vtu_print, &parts));
    return ritz_draft_publish_now(&draft);
}

/* Names of files are relative to the folder that contains the list. */
static ritz_status print_list(FILE *file, const void *what)
{
    const ritz_series *series = what;
    const pvd *p = series->own;
    const char *slash = strrchr(p->folder, '/');

    fputs("<?xml version=\"1.0\"?>\n", file);
    ritz_comment_put_xml(file, series->comment);
    fputs("<VTKFile type=\"Collection\" version=\"0.1\" "
          "byte_order=\"LittleEndian\">\n<Collection>\n",
          file);
    for (int64_t k = 0; k < series->count; k++) {
        fprintf(file, "<DataSet timestep=\"%.17g\" part=\"0\" file=\"",
                series->seconds[k]);
        ritz_xml_put(file, slash ? slash + 1 : p->folder);
        fprintf(file, "/%06" PRId64 ".vtu\"/>\n", k);
    }
    fputs("</Collection>\n</VTKFile>\n", file);
    return RITZ_OK;
}

/* Whether a file of the folder is frame `count` or a later one. */
static bool is_later_frame(const char *file, int64_t count)
{
    const size_t digits = strspn(file, "0123456789");

    return digits >= 6 && strcmp(file + digits, ".vtu") == 0 &&
           strtoll(file, NULL, 10) >= count;
}

/* Remove the frames that an earlier, longer series left in the folder. */
static void remove_later_frames(pvd *p, int64_t count)
{
    DIR *folder = opendir(p->folder);

    if (!folder)
        return;
    for (const struct dirent *file; (file = readdir(folder));)
        if (is_later_frame(file->d_name, count))
            (void)unlinkat(dirfd(folder), file->d_name, 0);
    (void)closedir(folder);
}

static ritz_status finish(ritz_series *series, const char *path)
{
    pvd *p = series->own;

    RITZ_CHECK(ritz_sink_write(path, print_list, series));
    p->finished = true;
    if (!p->made)
        remove_later_frames(p, series->count);
    return RITZ_OK;
}

static void end(ritz_series *series)
{
    pvd *p = series->own;

    for (int64_t k = 0; !p->finished && p->path && k < series->count; k++) {
        name_frame(p, k);
        (void)remove(p->path);
    }
    if (!p->finished && p->made)
        (void)rmdir(p->folder);
    RITZ_FREE(p->folder, p->path, p);
}

const ritz_series_format ritz_series_format_pvd = {
    .name = "pvd",
    .summary = "a list of VTK files, one for each time, in a folder beside it",
    .reference = "Schroeder2006",
    .begin = begin,
    .frame = frame,
    .finish = finish,
    .end = end,
};
