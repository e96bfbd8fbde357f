# The libraries that Ritz uses.
#
# libritz.so is linked with shared libraries (`ritz_shared_uses`). Tools and
# tests are linked with `ritz_uses`: static archives of those libraries that
# take most time when a program starts. As shared libraries these would load 50
# more, all of which the dynamic linker searches for each symbol (HDF5 alone
# loads libcurl, OpenSSL, GnuTLS and Kerberos for a driver that Ritz never
# calls). OpenBLAS stays shared, so that another BLAS can be used in its place.
find_package(PkgConfig REQUIRED)
find_package(HDF5 REQUIRED COMPONENTS C)
pkg_check_modules(ARPACK REQUIRED IMPORTED_TARGET arpack)
pkg_check_modules(BLAS REQUIRED IMPORTED_TARGET openblas)
pkg_check_modules(JANSSON REQUIRED IMPORTED_TARGET jansson)
pkg_check_modules(LAPACKE REQUIRED IMPORTED_TARGET lapacke)
pkg_check_modules(LIBARCHIVE REQUIRED IMPORTED_TARGET libarchive)
pkg_check_modules(MATIO REQUIRED IMPORTED_TARGET matio)
pkg_check_modules(NETTLE REQUIRED IMPORTED_TARGET nettle)
pkg_check_modules(NLOPT REQUIRED IMPORTED_TARGET nlopt)
pkg_check_modules(YAML REQUIRED IMPORTED_TARGET yaml-0.1)
pkg_check_modules(ZLIB REQUIRED IMPORTED_TARGET zlib)
find_library(CHOLMOD cholmod REQUIRED)
find_library(SUITESPARSE_CONFIG suitesparseconfig REQUIRED)
find_library(DMUMPS dmumps_seq REQUIRED)
find_library(ZMUMPS zmumps_seq REQUIRED)
find_library(SLICOT slicot REQUIRED)
# Their development packages may be missing; only the libraries that programs
# load are sure to be installed.
find_library(FORTRAN NAMES gfortran libgfortran.so.5)
find_library(OPENMP NAMES gomp libgomp.so.1)
find_library(METIS NAMES metis libmetis.so.5)
mark_as_advanced(CHOLMOD SUITESPARSE_CONFIG DMUMPS ZMUMPS SLICOT FORTRAN OPENMP
    METIS)

# Shared libraries that the archives call, as far as they are installed.
set(ritz_beneath PkgConfig::BLAS PkgConfig::ZLIB)
foreach(library FORTRAN OPENMP METIS)
    if(${library})
        list(APPEND ritz_beneath ${${library}})
    endif()
endforeach()
list(APPEND ritz_beneath m)

# prefer_archives(OUT FUNCTION SHARED ARCHIVE...) sets OUT to the list of
# archives, if all exist and a program that calls FUNCTION links with them;
# otherwise to the list SHARED. ARCHIVE is a path, or NAME for libNAME.a.
include(CheckFunctionExists)
function(prefer_archives out function shared)
    set(${out} ${shared} PARENT_SCOPE)
    set(archives)
    foreach(name ${ARGN})
        if(NOT IS_ABSOLUTE ${name})
            find_library(ARCHIVE_${name} lib${name}.a)
            mark_as_advanced(ARCHIVE_${name})
            set(name ${ARCHIVE_${name}})
        endif()
        if(NOT EXISTS "${name}")
            message(STATUS "${out}: shared libraries, as not all archives of"
                " ${ARGN} are there")
            return()
        endif()
        list(APPEND archives ${name})
    endforeach()
    set(CMAKE_REQUIRED_LIBRARIES ${archives} ${ritz_beneath})
    check_function_exists(${function} ${out}_ARCHIVES_LINK)
    if(${out}_ARCHIVES_LINK)
        set(${out} ${archives} PARENT_SCOPE)
    endif()
endfunction()

# Chosen together: a program must not contain the archive of HDF5 and load the
# shared library with matio.
set(hdf5 ${HDF5_C_LIBRARIES})
list(FILTER hdf5 INCLUDE REGEX "/libhdf5[^/]*\\.so$")
list(TRANSFORM hdf5 REPLACE "\\.so$" ".a")
prefer_archives(hdf5_uses Mat_VarWrite "PkgConfig::MATIO;hdf5::hdf5"
    matio ${hdf5} sz aec)
prefer_archives(cholmod_uses cholmod_l_factorize
    "${CHOLMOD};${SUITESPARSE_CONFIG}"
    cholmod amd colamd ccolamd camd suitesparseconfig)
prefer_archives(mumps_uses dmumps_c "${DMUMPS};${ZMUMPS}" dmumps_seq zmumps_seq
    mumps_common_seq pord_seq mpiseq_seq esmumps scotch scotcherr)
prefer_archives(lapacke_uses LAPACKE_dsyev PkgConfig::LAPACKE lapacke)
prefer_archives(arpack_uses dsaupd_ PkgConfig::ARPACK arpack)
prefer_archives(slicot_uses ab13ad_ ${SLICOT} slicot)
# Writes the zip files of FMUs, for ritz-export alone. It loads ten libraries, and
# its archive needs most of them as well: the linker names it in programs that call
# it, and in no other.
list(GET LIBARCHIVE_LINK_LIBRARIES 0 archive_uses)
set(archive_uses -Wl,--push-state,--as-needed,${archive_uses},--pop-state)

set(ritz_shared_uses hdf5::hdf5 PkgConfig::LAPACKE PkgConfig::BLAS
    PkgConfig::ARPACK PkgConfig::LIBARCHIVE PkgConfig::MATIO PkgConfig::NETTLE
    PkgConfig::NLOPT PkgConfig::YAML PkgConfig::ZLIB
    ${CHOLMOD} ${SUITESPARSE_CONFIG} ${DMUMPS} ${ZMUMPS} ${SLICOT} m)

# Include folders and definitions are the same for archives and shared
# libraries.
add_library(ritz_headers INTERFACE)
foreach(package hdf5::hdf5 PkgConfig::LAPACKE PkgConfig::BLAS PkgConfig::ARPACK
        PkgConfig::LIBARCHIVE PkgConfig::MATIO PkgConfig::NETTLE
        PkgConfig::NLOPT PkgConfig::YAML PkgConfig::ZLIB)
    target_include_directories(ritz_headers INTERFACE
        $<TARGET_PROPERTY:${package},INTERFACE_INCLUDE_DIRECTORIES>)
    target_compile_definitions(ritz_headers INTERFACE
        $<TARGET_PROPERTY:${package},INTERFACE_COMPILE_DEFINITIONS>)
endforeach()
add_library(ritz_hdf5 INTERFACE)
target_link_libraries(ritz_hdf5 INTERFACE ritz_headers ${hdf5_uses}
    PkgConfig::ZLIB m)
add_library(ritz_uses INTERFACE)
target_link_libraries(ritz_uses INTERFACE ritz_headers ${hdf5_uses}
    ${lapacke_uses} ${arpack_uses} ${cholmod_uses} ${mumps_uses} ${slicot_uses}
    PkgConfig::NETTLE PkgConfig::NLOPT PkgConfig::YAML ${archive_uses}
    ${ritz_beneath})

# For --engine slepc, if they are installed: PETSc and SLEPc with the shared
# libraries that they use; libraries that PETSc does not use are linked as above.
# Not with sanitizers, which report dozens of leaks and overlaps of MPI and
# PETSc: that build tests instead what is said where they are missing.
option(RITZ_WITH_SLEPC "build --engine slepc where PETSc and SLEPc are" ON)
set(RITZ_SLEPC OFF)
if(RITZ_WITH_SLEPC AND NOT RITZ_SANITIZE)
    pkg_check_modules(SLEPC QUIET IMPORTED_TARGET slepc petsc)
    pkg_check_modules(HDF5_MPI QUIET IMPORTED_TARGET hdf5-mpi)
    find_package(MPI QUIET COMPONENTS C)
    find_library(DMUMPS_MPI dmumps)
    find_library(ZMUMPS_MPI zmumps)
    mark_as_advanced(DMUMPS_MPI ZMUMPS_MPI)
    if(SLEPC_FOUND AND HDF5_MPI_FOUND AND MPI_C_FOUND AND DMUMPS_MPI
            AND ZMUMPS_MPI)
        set(RITZ_SLEPC ON)
    else()
        message(STATUS "without --engine slepc, as not all of"
            " slepc-dev petsc-dev libmumps-dev mpi-default-dev are there")
    endif()
endif()
if(RITZ_SLEPC)
    add_library(ritz_slepc INTERFACE)
    target_include_directories(ritz_slepc SYSTEM INTERFACE
        ${SLEPC_INCLUDE_DIRS} ${MPI_C_INCLUDE_DIRS})
    add_library(ritz_slepc_uses INTERFACE)
    target_link_libraries(ritz_slepc_uses INTERFACE PkgConfig::SLEPC
        MPI::MPI_C ${DMUMPS_MPI} ${ZMUMPS_MPI} ${HDF5_MPI_LINK_LIBRARIES}
        ${lapacke_uses} ${arpack_uses} ${slicot_uses} ${CHOLMOD}
        ${SUITESPARSE_CONFIG} PkgConfig::JANSSON PkgConfig::NETTLE
        PkgConfig::NLOPT PkgConfig::YAML ${ritz_beneath})
endif()
