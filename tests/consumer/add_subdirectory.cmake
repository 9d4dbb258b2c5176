# SPDX-License-Identifier: Apache-2.0
# Knead's source inside someone else's build, without tools and tests.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
file(REMOVE_RECURSE ${WORK})
file(WRITE ${WORK}/source/CMakeLists.txt
     "cmake_minimum_required(VERSION 3.25)\nproject(game LANGUAGES C CXX)\nset(KNEAD_BUILD_TOOLS OFF)\n"
     "add_subdirectory(${SOURCE} knead EXCLUDE_FROM_ALL)\n"
     "add_subdirectory(${SOURCE}/examples/haptic_loop app)\n"
     "if(CMAKE_RUNTIME_OUTPUT_DIRECTORY OR TARGET write_cube)\nmessage(FATAL_ERROR \"Knead changed its host\")\nendif()\n")
run(${CMAKE_COMMAND} -S ${WORK}/source -B ${WORK}/build -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE=-O1 -DCMAKE_C_COMPILER=${CC}
    -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_CXX_FLAGS=${FLAGS} -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER})
run(${CMAKE_COMMAND} --build ${WORK}/build --parallel 2)
run(${WORK}/build/app/haptic_loop ${ASSET})
expect_press("${run_output}")
