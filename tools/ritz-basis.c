/* ritz-basis - find the subspace in which a component is reduced. */
#include "cli/libexec.h"
#include "print/print.h"

int main(int argc, char **argv)
{
    if (libexec_is_asked(argv, "--engine", "slepc"))
        return libexec_become("ritz-basis-slepc", argv, "ritz-basis",
                              "--engine slepc",
                              "slepc-dev, petsc-dev and mpi-default-dev");
    return basis_main(argc, argv, basis_run);
}
