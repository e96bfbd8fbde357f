# ninja style: clang-format and clang-tidy, each file with a stamp of its own.
#
# A stamp of clang-tidy hangs on the object of its file, which is made anew when
# the file, a header that it includes or a flag has changed. A process takes one
# file: with several its va_list checker errs.
find_program(CLANG_FORMAT clang-format)
find_program(CLANG_TIDY clang-tidy)
if(NOT CLANG_FORMAT OR NOT CLANG_TIDY OR NOT CMAKE_GENERATOR MATCHES Ninja)
    return()
endif()
set(quietly sh ${CMAKE_CURRENT_SOURCE_DIR}/quietly.sh)
set(stamps "")
set(seen "")

# style_stamp(FOLDER FILE INPUTS COMMAND...)
macro(style_stamp folder file inputs)
    cmake_path(RELATIVE_PATH file BASE_DIRECTORY ${PROJECT_SOURCE_DIR}
        OUTPUT_VARIABLE name)
    set(stamp ${PROJECT_BINARY_DIR}/${folder}/${name}.stamp)
    add_custom_command(OUTPUT ${stamp} COMMAND ${quietly} ${stamp} ${ARGN}
        DEPENDS ${file} ${inputs} VERBATIM COMMENT "${folder} ${name}")
    list(APPEND stamps ${stamp})
endmacro()

foreach(folder ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
    get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
    foreach(target ${targets})
        get_target_property(type ${target} TYPE)
        if(NOT type MATCHES "LIBRARY|EXECUTABLE" OR type MATCHES INTERFACE)
            continue()
        endif()
        get_target_property(binary ${target} BINARY_DIR)
        get_target_property(files ${target} SOURCES)
        foreach(file ${files})
            cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY ${folder} NORMALIZE)
            cmake_path(IS_PREFIX PROJECT_BINARY_DIR ${file} made)
            if(made OR NOT file MATCHES "\\.c$")
                continue()
            endif()
            cmake_path(RELATIVE_PATH file BASE_DIRECTORY ${folder}
                OUTPUT_VARIABLE name)
            if(${file} IN_LIST seen)
                continue() # a file of two programs is checked once
            endif()
            list(APPEND seen ${file})
            style_stamp(tidy ${file}
                "${PROJECT_SOURCE_DIR}/.clang-tidy;\
${CMAKE_CURRENT_SOURCE_DIR}/unit/.clang-tidy;\
${binary}/CMakeFiles/${target}.dir/${name}.o"
                ${CLANG_TIDY} --quiet -p ${PROJECT_BINARY_DIR} ${file})
        endforeach()
    endforeach()
endforeach()

# examples are compiled by a test alone: flags are those of the nearest file
file(GLOB headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/include/ritz/*.h
    ${PROJECT_SOURCE_DIR}/examples/*.h)
file(GLOB files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/examples/*.c)
foreach(file ${files})
    style_stamp(tidy ${file} "${PROJECT_SOURCE_DIR}/.clang-tidy;${headers}"
        ${CLANG_TIDY} --quiet -p ${PROJECT_BINARY_DIR} ${file})
endforeach()

file(GLOB_RECURSE files CONFIGURE_DEPENDS
    ${PROJECT_SOURCE_DIR}/include/*.h ${PROJECT_SOURCE_DIR}/examples/*.[ch]
    ${PROJECT_SOURCE_DIR}/src/*.[ch] ${PROJECT_SOURCE_DIR}/formats/*.[ch]
    ${PROJECT_SOURCE_DIR}/tools/*.[ch] ${PROJECT_SOURCE_DIR}/libexec/*.[ch]
    ${PROJECT_SOURCE_DIR}/tests/*.[ch])
# not fmu/fmi, which are others' headers
file(GLOB more CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/fmu/*.[ch])
foreach(file ${files} ${more})
    style_stamp(format ${file} ${PROJECT_SOURCE_DIR}/.clang-format
        ${CLANG_FORMAT} --dry-run -Werror ${file})
endforeach()
add_custom_target(style DEPENDS ${stamps})
