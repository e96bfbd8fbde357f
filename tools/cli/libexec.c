#include "cli/libexec.h"

#include "base/text.h"
#include "cli/cli.h"
#include "cli/cores.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The path to libexec/ritz from the folder of the running program: that of the
   tools, or libexec/ritz itself, which is recognised by its last name. */
static const char *choose_way(const char *folder)
{
    static const char from_tools[] = "/" RITZ_LIBEXEC "/";
    const char *last = strrchr(folder, '/');

    return last && strcmp(last, strrchr("/" RITZ_LIBEXEC, '/')) == 0
               ? "/"
               : from_tools;
}

ritz_status libexec_find(const char *name, char out[PATH_MAX])
{
    char self[PATH_MAX];
    const ssize_t length = readlink("/proc/self/exe", self, sizeof self - 1);
    char *slash = NULL;

    RITZ_REFUSE_IF(length <= 0, RITZ_ERR_FILE, "there is no /proc: %s",
                   strerror(errno));
    self[length] = '\0';
    slash = strrchr(self, '/');
    if (slash)
        *slash = '\0';
    RITZ_REFUSE_IF(!slash || snprintf(out, PATH_MAX, "%s%s%s", self,
                                      choose_way(self), name) >= PATH_MAX,
                   RITZ_ERR_FILE, "the path to '%s' is too long", name);
    RITZ_REFUSE_IF(access(out, X_OK) != 0, RITZ_ERR_FILE,
                   "'%s', which is installed with the tools, cannot be run: "
                   "%s",
                   out, strerror(errno));
    return RITZ_OK;
}

bool libexec_is_asked(char **argv, const char *option, const char *value)
{
    const size_t length = strlen(option);

    for (char **word = argv; *word; word++) {
        const char *text = *word + length; /* behind the option */

        if (strncmp(*word, option, length) != 0)
            continue;
        if (*text == '\0' && word[1] && strcmp(word[1], value) == 0)
            return true;
        if (*text == '=' && strcmp(text + 1, value) == 0)
            return true;
    }
    return false;
}

/* The text before the first "(" or ",", as a whole number; -1: it is none.
   SLURM writes "4(x2)" for four tasks on each of two machines, and "4(x2),3" if
   a third one has three. */
static int64_t read_number(const char *text)
{
    char first[24];
    const size_t length = strcspn(text, "(,");
    int64_t number = 0;

    if (length >= sizeof first)
        return -1;
    memcpy(first, text, length);
    first[length] = '\0';
    return ritz_text_whole(first, &number) ? number : -1;
}

/* The number in the first of some environment variables that has one; -1: none
   has. */
static int64_t find_number(const char *const *names)
{
    for (; *names; names++) {
        const char *text = getenv(*names);
        const int64_t number = text ? read_number(text) : -1;

        if (number >= 0)
            return number;
    }
    return -1;
}

/* Variables in which Open MPI, MPICH and SLURM tell a process its rank, and how
   many processes they started on this machine. */
static const char *const ranks[] = {"OMPI_COMM_WORLD_RANK", "PMI_RANK",
                                    "SLURM_PROCID", NULL};
static const char *const neighbours[] = {"OMPI_COMM_WORLD_LOCAL_SIZE",
                                         "MPI_LOCALNRANKS",
                                         "SLURM_TASKS_PER_NODE", NULL};

/* How many cores this rank may use, no more than an equal share of the
   machine. */
static int64_t count_cores(void)
{
    const int64_t processes = find_number(neighbours);
    const int64_t all = sysconf(_SC_NPROCESSORS_ONLN);
    const int64_t part = processes > 1 ? all / processes : all;
    const int64_t cores = cli_cores();

    if (cores <= part)
        return cores;
    return part > 1 ? part : 1;
}

/* Set the number of threads of the program that execv() is about to start. Its
   OpenMP reads these variables once, before main(), so that it is too late to
   set them there. Variables that the user has set are kept. */
static bool set_threads(void)
{
    char cores[24];

    snprintf(cores, sizeof cores, "%lld", (long long)count_cores());
    return setenv("OMP_THREAD_LIMIT", cores, 0) == 0 &&
           setenv("OMP_NUM_THREADS", cores, 0) == 0 &&
           setenv("OMP_WAIT_POLICY", "passive", 0) == 0;
}

/*
 * If mpirun has started all ranks on this machine, they exchange messages by
 * shared memory. Open MPI is told so, and does not look for networks, which
 * takes it 0.2 s. A variable that the user has set is kept.
 */
static bool stay_on_machine(void)
{
    static const char *const all[] = {"OMPI_COMM_WORLD_SIZE", NULL};
    static const char *const here[] = {"OMPI_COMM_WORLD_LOCAL_SIZE", NULL};
    const int64_t ranks_here = find_number(here);

    if (ranks_here < 1 || ranks_here != find_number(all))
        return true;
    return setenv("OMPI_MCA_pml", "ob1", 0) == 0;
}

int libexec_become(const char *program, char **argv, const char *tool,
                   const char *option, const char *packages)
{
    char path[PATH_MAX];

    if (libexec_find(program, path) == RITZ_OK && set_threads() &&
        stay_on_machine())
        execv(path, argv);
    if (find_number(ranks) <= 0)
        cli_complain("%s: %s needs %s, which is built where Debian's packages "
                     "%s are installed, and cannot be run here\n",
                     tool, option, program, packages);
    return EXIT_FAILURE;
}
