# SPDX-License-Identifier: Apache-2.0
# Every installed header alone, as C++17; the C header as C99 too.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
file(REMOVE_RECURSE ${WORK})
file(GLOB_RECURSE headers RELATIVE ${PREFIX}/include ${PREFIX}/include/*.h)
if(NOT headers)
  message(FATAL_ERROR "no headers in ${PREFIX}/include")
endif()
foreach(header IN LISTS headers)
  foreach(header IN ITEMS knead knead_haptics)
  file(WRITE ${WORK}/alone.c "#include \"knead/${header}.h\"\n")
  run(${CC} -std=c99 -Wall -Wextra -pedantic -Werror -fsyntax-only -I${PREFIX}/include ${WORK}/alone.c)
endforeach()
