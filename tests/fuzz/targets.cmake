# The program ritz_fuzz and a test for each of its targets; without libFuzzer a
# single test, which is skipped.
include(CheckCSourceCompiles)
set(CMAKE_REQUIRED_FLAGS -fsanitize=fuzzer)
check_c_source_compiles("
    int LLVMFuzzerTestOneInput(const unsigned char *bytes, unsigned long size);
    int LLVMFuzzerTestOneInput(const unsigned char *bytes, unsigned long size)
    { return bytes && size ? 0 : 0; }" compiler_has_fuzzer)
unset(CMAKE_REQUIRED_FLAGS)
set(script ${CMAKE_CURRENT_LIST_DIR}/fuzz.sh)
if(NOT compiler_has_fuzzer)
    add_custom_target(ritz_fuzz) # empty; fuzz.sh says that it is skipped
    ritz_test(fuzz fuzz sh ${script} ${PROJECT_BINARY_DIR} 0)
    return()
endif()

add_subdirectory(fuzz)
file(GLOB files CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/*.c)
# rows of targets and names of stand-ins are read from these files
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${files})
add_executable(ritz_fuzz ${files} $<TARGET_OBJECTS:ritz_readers>)
target_include_directories(ritz_fuzz PRIVATE ${PROJECT_SOURCE_DIR}
    unit unit/fixtures)
target_compile_options(ritz_fuzz PRIVATE -g -O1
    -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all)
# Tools draw and compute nothing, and an exit returns to the fuzzer: each
# __wrap_NAME in these files replaces NAME.
set(wrapped)
foreach(file ${files})
    file(STRINGS ${file} lines REGEX "__wrap_[a-z]|^(PASSES|REFUSES)")
    foreach(line ${lines})
        if(line MATCHES "(__wrap_|^PASSES.|^REFUSES.)([a-z_0-9]+)")
            list(APPEND wrapped -Wl,--wrap=${CMAKE_MATCH_2})
        endif()
    endforeach()
endforeach()
list(REMOVE_DUPLICATES wrapped)
target_link_options(ritz_fuzz PRIVATE -fsanitize=fuzzer,address,undefined
    ${wrapped} -fuse-ld=bfd) # gold warns of the sanitizer
target_link_libraries(ritz_fuzz PRIVATE ritz_flags ritz_cli ritz ritz_uses)

# libFuzzer ends a second after the time it is given: these run for 3 s
file(STRINGS ${CMAKE_CURRENT_LIST_DIR}/fuzz.c rows REGEX "^    {\"[a-z0-9-]+\",")
foreach(row ${rows})
    string(REGEX REPLACE "^ *{\"([^\"]+)\".*" "\\1" target "${row}")
    ritz_test(fuzz fuzz/${target} sh ${script} ${PROJECT_BINARY_DIR} 2 ${target})
endforeach()
