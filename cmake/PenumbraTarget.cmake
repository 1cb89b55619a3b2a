# penumbra_library(NAME SOURCES … PUBLIC … PRIVATE …): a static library penumbra_NAME, alias penumbra::NAME, with
# the project's language level, warnings and sanitizers. PUBLIC and PRIVATE are libraries to link.
# penumbra_executable(NAME SOURCES … PRIVATE …): a program with the same flags.
include_guard()

add_library(penumbra_flags INTERFACE)
target_compile_features(penumbra_flags INTERFACE cxx_std_20)
# -ffp-contract=off: the same bits for every vector width and build type, which asset bytes and replays rely on.
target_compile_options(penumbra_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
    -Woverloaded-virtual -Wno-missing-field-initializers -ffp-contract=off $<$<BOOL:${PENUMBRA_WERROR}>:-Werror>)
target_include_directories(penumbra_flags INTERFACE ${PROJECT_SOURCE_DIR})
if(PENUMBRA_SANITIZE)
    target_compile_options(penumbra_flags INTERFACE -fsanitize=${PENUMBRA_SANITIZE} -fno-omit-frame-pointer)
    target_link_options(penumbra_flags INTERFACE -fsanitize=${PENUMBRA_SANITIZE})
endif()

function(penumbra_library NAME)
    cmake_parse_arguments(PARSE_ARGV 1 ARG "" "" "SOURCES;PUBLIC;PRIVATE")
    add_library(penumbra_${NAME} STATIC ${ARG_SOURCES})
    add_library(penumbra::${NAME} ALIAS penumbra_${NAME})
    target_link_libraries(penumbra_${NAME} PUBLIC penumbra_flags ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
endfunction()

function(penumbra_executable NAME)
    cmake_parse_arguments(PARSE_ARGV 1 ARG "" "" "SOURCES;PRIVATE")
    add_executable(${NAME} ${ARG_SOURCES})
    target_link_libraries(${NAME} PRIVATE penumbra_flags ${ARG_PRIVATE})
endfunction()
