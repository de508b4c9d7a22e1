# Makes a C source of a shader, with its includes resolved.
#   cmake -DSHADER=name.frag -DFOLDERS=dir;dir -DOUTPUT=name.c -P embed_shader.cmake
# `#include "file"` is replaced by that file, once, from the first of FOLDERS that has it. #line
# directives number the files, so that a fault of the compiler can be told by file and line.
cmake_minimum_required(VERSION 3.25)

function(find_shader name)
    foreach(folder ${FOLDERS})
        if(EXISTS ${folder}/${name})
            set(path ${folder}/${name} PARENT_SCOPE)
            return()
        endif()
    endforeach()
    message(FATAL_ERROR "${SHADER}: there is no \"${name}\" in ${FOLDERS}")
endfunction()

# Appends the text of file `name` to ${OUTPUT}.glsl. A text may hold ; and [ and is never a list.
function(append_file name)
    get_property(names GLOBAL PROPERTY names)
    list(LENGTH names number)
    set_property(GLOBAL APPEND PROPERTY names ${name})
    find_shader(${name})
    file(READ ${path} rest)
    set(done "")
    while(TRUE)
        string(FIND "${rest}" "#include \"" at)
        if(at EQUAL -1)
            break()
        endif()
        string(SUBSTRING "${rest}" 0 ${at} before)
        math(EXPR from "${at} + 10")
        string(SUBSTRING "${rest}" ${from} -1 rest)
        string(FIND "${rest}" "\"" end)
        string(SUBSTRING "${rest}" 0 ${end} included)
        math(EXPR from "${end} + 1")
        string(SUBSTRING "${rest}" ${from} -1 rest)
        string(APPEND done "${before}")
        file(APPEND ${OUTPUT}.glsl "${before}")
        get_property(known GLOBAL PROPERTY names)
        if(NOT included IN_LIST known)
            get_property(next GLOBAL PROPERTY names)
            list(LENGTH next next)
            file(APPEND ${OUTPUT}.glsl "#line 1 ${next}\n")
            append_file(${included})
        endif()
        string(REGEX REPLACE "[^\n]" "" lines "${done}")
        string(LENGTH "${lines}" line)
        math(EXPR line "${line} + 1")
        file(APPEND ${OUTPUT}.glsl "#line ${line} ${number}")
    endwhile()
    file(APPEND ${OUTPUT}.glsl "${rest}")
endfunction()

file(WRITE ${OUTPUT}.glsl "")
append_file(${SHADER})
file(READ ${OUTPUT}.glsl bytes HEX)
string(REPEAT "." 32 row)
string(REGEX REPLACE "(${row})" "\\1\n    " bytes "${bytes}")
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
get_property(names GLOBAL PROPERTY names)
list(JOIN names "\", \"" files)
string(MAKE_C_IDENTIFIER ${SHADER} identifier)
file(WRITE ${OUTPUT} "// Made by embed_shader.cmake.
#include \"gl/gl_program.h\"

static const unsigned char text[] = {
    ${bytes}0};
static const char *const files[] = {\"${files}\"};

const gl_shader shader_${identifier} = {(const char *)text, files, sizeof files / sizeof *files};
")
