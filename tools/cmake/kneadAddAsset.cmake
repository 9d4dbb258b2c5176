# SPDX-License-Identifier: Apache-2.0

# knead_add_asset(<target> SCENE <file> OUTPUT <file> [LEVEL <name>])
#
# Bakes OUTPUT from the scene whenever the scene or any file that it names has changed. <target> is a custom
# target that is part of "all"; make other targets depend on it with add_dependencies(). LEVEL may be left out
# when the scene has one level. Intermediate stages are kept in <target>.knead in the binary folder.
function(knead_add_asset target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "SCENE;OUTPUT;LEVEL" "")
  if(arg_UNPARSED_ARGUMENTS OR NOT arg_SCENE OR NOT arg_OUTPUT)
    message(FATAL_ERROR "knead_add_asset(<target> SCENE <file> OUTPUT <file> [LEVEL <name>])")
  endif()
  cmake_path(ABSOLUTE_PATH arg_SCENE BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} NORMALIZE)
  cmake_path(ABSOLUTE_PATH arg_OUTPUT BASE_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR} NORMALIZE)
  set(level)
  if(arg_LEVEL)
    set(level --level ${arg_LEVEL})
  endif()
  set(stages ${CMAKE_CURRENT_BINARY_DIR}/${target}.knead)
  add_custom_command(
    OUTPUT ${arg_OUTPUT}
    COMMAND knead::knead build ${arg_SCENE} --output ${stages} ${level} --asset ${arg_OUTPUT}
            --depfile ${stages}.d --quiet
    DEPENDS ${arg_SCENE} knead::knead
    DEPFILE ${stages}.d
    COMMENT "Baking ${arg_OUTPUT}"
    VERBATIM)
  add_custom_target(${target} ALL DEPENDS ${arg_OUTPUT})
endfunction()
