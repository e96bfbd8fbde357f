# The program ritz_fuzz, and a test for each of its targets; one test that is
# skipped where there is no libFuzzer.
include(CheckCSourceCompiles)
set(CMAKE_REQUIRED_FLAGS -fsanitize=fuzzer)
check_c_source_compiles("
    int LLVMFuzzerTestOneInput(const unsigned char *bytes, unsigned long size);
    int LLVMFuzzerTestOneInput(const unsigned char *bytes, unsigned long size)
    { return bytes && size ? 0 : 0; }" compiler_has_fuzzer)
unset(CMAKE_REQUIRED_FLAGS)
set(script ${CMAKE_CURRENT_LIST_DIR}/fuzz.sh)
if(NOT compiler_has_fuzzer)
    ritz_test(fuzz fuzz sh ${script} ${PROJECT_BINARY_DIR} 0)
    return()
endif()

add_subdirectory(fuzz)
file(GLOB files CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/*.c)
add_executable(ritz_fuzz ${files} $<TARGET_OBJECTS:ritz_readers>)
target_include_directories(ritz_fuzz PRIVATE ${PROJECT_SOURCE_DIR}
    unit unit/fixtures)
target_compile_options(ritz_fuzz PRIVATE -g -O1
    -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all)
# what tracks are read for is not drawn
target_link_options(ritz_fuzz PRIVATE -fsanitize=fuzzer,address,undefined
    -Wl,--wrap=picture_draw -fuse-ld=bfd) # gold warns of the sanitizer
target_link_libraries(ritz_fuzz PRIVATE ritz_flags ritz_cli ritz hdf5::hdf5 m)

file(STRINGS ${CMAKE_CURRENT_LIST_DIR}/fuzz.c rows REGEX "^    {\"[a-z0-9-]+\",")
foreach(row ${rows})
    string(REGEX REPLACE "^ *{\"([^\"]+)\".*" "\\1" target "${row}")
    ritz_test(fuzz fuzz/${target} sh ${script} ${PROJECT_BINARY_DIR} 3 ${target})
endforeach()
