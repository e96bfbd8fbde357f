# What Ritz is made of: the libraries of other people.
#
# `ritz_shared_uses` are shared libraries, for libritz.so. `ritz_uses` is what
# the tools and tests are linked with: archives of the libraries that cost a
# program most of its start. Shared, these bring 50 more that the dynamic linker
# must search for each symbol (HDF5 alone brings libcurl, OpenSSL, GnuTLS and
# Kerberos for a driver that Ritz never calls). OpenBLAS stays shared, so that
# another BLAS can take its place.
find_package(PkgConfig REQUIRED)
find_package(HDF5 REQUIRED COMPONENTS C)
pkg_check_modules(ARPACK REQUIRED IMPORTED_TARGET arpack)
pkg_check_modules(BLAS REQUIRED IMPORTED_TARGET openblas)
pkg_check_modules(JANSSON REQUIRED IMPORTED_TARGET jansson)
pkg_check_modules(LAPACKE REQUIRED IMPORTED_TARGET lapacke)
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
# Of compilers that may not be here: only their libraries for programs are sure.
find_library(FORTRAN NAMES gfortran libgfortran.so.5)
find_library(OPENMP NAMES gomp libgomp.so.1)
find_library(METIS NAMES metis libmetis.so.5)
mark_as_advanced(CHOLMOD SUITESPARSE_CONFIG DMUMPS ZMUMPS SLICOT FORTRAN OPENMP
    METIS)

# What archives call that stays shared, if it is there.
set(ritz_beneath PkgConfig::BLAS PkgConfig::ZLIB)
foreach(library FORTRAN OPENMP METIS)
    if(${library})
        list(APPEND ritz_beneath ${${library}})
    endif()
endforeach()
list(APPEND ritz_beneath m)

# prefer_archives(OUT FUNCTION SHARED ARCHIVE...): OUT becomes the archives, if
# all are there and a program that calls FUNCTION can be linked with them, and
# the list SHARED otherwise. An archive is libNAME.a, or a path.
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

# one HDF5 in a program: matio's too
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

set(ritz_shared_uses hdf5::hdf5 PkgConfig::LAPACKE PkgConfig::BLAS
    PkgConfig::ARPACK PkgConfig::MATIO PkgConfig::NETTLE PkgConfig::NLOPT
    PkgConfig::YAML PkgConfig::ZLIB
    ${CHOLMOD} ${SUITESPARSE_CONFIG} ${DMUMPS} ${ZMUMPS} ${SLICOT} m)

# Headers come from packages, whichever libraries are linked.
add_library(ritz_headers INTERFACE)
foreach(package hdf5::hdf5 PkgConfig::LAPACKE PkgConfig::BLAS PkgConfig::ARPACK
        PkgConfig::MATIO PkgConfig::NETTLE PkgConfig::NLOPT PkgConfig::YAML
        PkgConfig::ZLIB)
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
    PkgConfig::NETTLE PkgConfig::NLOPT PkgConfig::YAML ${ritz_beneath})
