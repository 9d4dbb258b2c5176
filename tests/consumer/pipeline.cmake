# SPDX-License-Identifier: Apache-2.0
# The pipeline example against both installed components: bakes its asset while it builds, bakes it again only
# when the scene changes, and runs.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
file(REMOVE_RECURSE ${WORK})
foreach(component IN ITEMS runtime tools)
  run(${CMAKE_COMMAND} --install ${BUILD} --component ${component} --prefix ${WORK}/prefix)
endforeach()
file(COPY ${SOURCE}/examples/pipeline DESTINATION ${WORK})
run(${CMAKE_COMMAND} -S ${WORK}/pipeline -B ${WORK}/build -G Ninja -DCMAKE_BUILD_TYPE=Release
    -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_CXX_FLAGS=${FLAGS} -DCMAKE_PREFIX_PATH=${WORK}/prefix)
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${CMAKE_COMMAND} -E chdir ${WORK}/build ./find_lump)
message(STATUS "${run_output}")

run(${CMAKE_COMMAND} --build ${WORK}/build)
if(run_output MATCHES "Baking")
  message(FATAL_ERROR "baked again although nothing changed:\n${run_output}")
endif()
file(READ ${WORK}/pipeline/lump.toml scene)
string(REPLACE "60000" "80000" scene "${scene}")
file(WRITE ${WORK}/pipeline/lump.toml "${scene}")
run(${CMAKE_COMMAND} --build ${WORK}/build)
if(NOT run_output MATCHES "Baking")
  message(FATAL_ERROR "not baked again although the scene changed:\n${run_output}")
endif()
