# SPDX-License-Identifier: Apache-2.0
# Only the runtime is installed: asking for the tools, or for something that is not, must end with a clear word.
file(REMOVE_RECURSE ${WORK})
foreach(component IN ITEMS tools nonsense)
  file(WRITE ${WORK}/${component}/CMakeLists.txt
       "cmake_minimum_required(VERSION 3.25)\nproject(c LANGUAGES NONE)\nfind_package(knead REQUIRED COMPONENTS ${component})\n")
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${WORK}/${component} -B ${WORK}/${component}/build
                          -DCMAKE_PREFIX_PATH=${PREFIX}
                  RESULT_VARIABLE result OUTPUT_QUIET ERROR_VARIABLE errors)
  string(REGEX REPLACE "[ \n]+" " " errors "${errors}")
  if(result EQUAL 0 OR NOT errors MATCHES "component '${component}'")
    message(FATAL_ERROR "component '${component}': result ${result}, message:\n${errors}")
  endif()
endforeach()
# Without components: what is installed.
file(WRITE ${WORK}/any/CMakeLists.txt
     "cmake_minimum_required(VERSION 3.25)\nproject(c LANGUAGES CXX)\nfind_package(knead REQUIRED)\n"
     "if(NOT TARGET knead::runtime OR NOT knead_runtime_FOUND)\nmessage(FATAL_ERROR \"no runtime\")\nendif()\n")
execute_process(COMMAND ${CMAKE_COMMAND} -S ${WORK}/any -B ${WORK}/any/build -DCMAKE_PREFIX_PATH=${PREFIX}
                        -DCMAKE_CXX_COMPILER=${CXX} RESULT_VARIABLE result OUTPUT_QUIET ERROR_VARIABLE errors)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "find_package(knead) without components:\n${errors}")
endif()
