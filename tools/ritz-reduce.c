/* ritz-reduce - a component in the subspace of a basis, with estimates. */
#include "cli/libexec.h"
#include "print/print.h"

int main(int argc, char **argv)
{
    if (libexec_is_asked(argv, "--engine", "slepc"))
        return libexec_become("ritz-reduce-slepc", argv, "ritz-reduce",
                              "--engine slepc",
                              "slepc-dev, petsc-dev and mpi-default-dev");
    return reduce_main(argc, argv, reduce_run);
}
