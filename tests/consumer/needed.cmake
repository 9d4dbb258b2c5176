# SPDX-License-Identifier: Apache-2.0
# What the installed libraries need of the system, and what of them can be seen.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

# check_library(<name> <libraries that may be needed beside the C and C++ runtime>)
function(check_library name others)
  set(library ${PREFIX}/${LIBDIR}/lib${name}.so)
  run(readelf -d ${library})
  string(REGEX MATCHALL "\\(NEEDED\\)[^\n]*\\[[^]\n]+\\]" entries "${run_output}")
  if(NOT entries)
    message(FATAL_ERROR "no NEEDED entries in:\n${run_output}")
  endif()
  set(allowed "^(${others}|libstdc\\+\\+|libc\\+\\+|libm|libgcc_s|libc|ld-linux-[a-z0-9-]+)\\.so")
  if(FLAGS MATCHES "-fsanitize")
    set(allowed "${allowed}|^lib(a|ub|t)san\\.so")
  endif()
  foreach(entry IN LISTS entries)
    string(REGEX REPLACE ".*\\[([^]]+)\\].*" "\\1" needed "${entry}")
    if(NOT needed MATCHES "${allowed}")
      message(FATAL_ERROR "${name} needs ${needed}")
    endif()
  endforeach()

  # What it offers: the C functions and public classes, nothing of its inside.
  run(nm -DC --defined-only ${library})
  string(REGEX MATCHALL "[^\n]*(knead::(core|h5|read_|validate)|Eigen::)[^\n]*" leaks "${run_output}")
  if(leaks)
    list(JOIN leaks "\n" leaks)
    message(FATAL_ERROR "visible in ${name}, but private:\n${leaks}")
  endif()
endfunction()

check_library(knead_runtime "libhdf5(_serial)?")
check_library(knead_haptics "libknead_runtime|libpthread")
