# Tests with RITZ_TEST_ENGINE, which makes an engine find modes that LAPACK finds
# otherwise. Allocations fail in the usual tests of the modules.

# What an engine cannot hold, and why: ENGINE TEST REASON. Files of claims and
# cases of failure have their ending.
set(exceptions
    # Eigenvalues to 1e-8, where the row asks for 1e-11; claims/bounds has them
    # to the accuracy stated.
    amls pairs.claims
    # K Psi of a residual mode to 1e-13 of its terms: modes have residuals of 1e-5
    amls macneal_rubin
    # six digits of a singular value of 1e-6: vectors are accurate to 1e-5
    amls serep)

# engine_test(ENGINE NAME COMMAND...)
function(engine_test engine name)
    ritz_test(engines ${name}/${engine} ${ARGN})
    if(engines IN_LIST RITZ_TESTS)
        set_property(TEST ${RITZ_TEST_PREFIX}${name}/${engine} APPEND PROPERTY
            ENVIRONMENT RITZ_TEST_ENGINE=${engine} RITZ_TEST_ALLOCATIONS=0)
    endif()
endfunction()

# without_exceptions(ENGINE NAMES...): sets `rest`.
function(without_exceptions engine)
    set(rest)
    foreach(item ${ARGN})
        cmake_path(GET item FILENAME name)
        if(NOT ";${exceptions};" MATCHES ";${engine};${name};")
            list(APPEND rest ${item})
        endif()
    endforeach()
    set(rest ${rest} PARENT_SCOPE)
endfunction()

foreach(engine lanczos arpack slices amls)
    without_exceptions(${engine} ${claims})
    if(engine STREQUAL amls)
        list(APPEND rest ${CMAKE_CURRENT_SOURCE_DIR}/claims/bounds/amls.claims)
    endif()
    engine_test(${engine} claims ${PROJECT_BINARY_DIR}/bin/ritz-claims ${rest})
    engine_test(${engine} failures /usr/bin/python3 -s -B
        ${CMAKE_CURRENT_SOURCE_DIR}/failures/run ${PROJECT_BINARY_DIR}/bin)
    foreach(room bases estimate check)
        without_exceptions(${engine} ${modules_of_${room}})
        engine_test(${engine} ${room} test_${room} ${rest})
    endforeach()
endforeach()
