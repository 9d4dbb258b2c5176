# SPDX-License-Identifier: Apache-2.0
# The lean preset on a machine that has none of what the tools need: it must not even look for it. Its build type
# and strictness are those of the build under test: under a sanitizer -O3 takes the compiler more than ten minutes, and it
# warns of what is right.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
file(REMOVE_RECURSE ${WORK})
set(absent)
foreach(package IN ITEMS CGAL Boost TBB METIS tomlplusplus nlohmann_json SuiteSparse OpenMP GTest)
  list(APPEND absent -DCMAKE_DISABLE_FIND_PACKAGE_${package}=ON)
endforeach()
execute_process(COMMAND ${CMAKE_COMMAND} --preset lean -S ${SOURCE} -B ${WORK} ${absent}
                        -DCMAKE_C_COMPILER=${CC} -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_CXX_FLAGS=${FLAGS}
                        -DCMAKE_BUILD_TYPE=${TYPE} -DKNEAD_WARNINGS_AS_ERRORS=${STRICT}
                        -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}
                WORKING_DIRECTORY ${SOURCE} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE errors)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "cmake --preset lean:\n${output}\n${errors}")
endif()
run(${CMAKE_COMMAND} --build ${WORK} --parallel 2)
foreach(made IN ITEMS lib/libknead_runtime.so bin/knead-asset)
  if(NOT EXISTS ${WORK}/${made})
    message(FATAL_ERROR "the lean build has no ${made}")
  endif()
endforeach()
run(${WORK}/bin/knead-asset validate ${ASSET})
run(${CMAKE_COMMAND} --install ${WORK} --component runtime --prefix ${WORK}/prefix)
