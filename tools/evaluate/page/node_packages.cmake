# SPDX-License-Identifier: GPL-3.0-or-later
# knead_node_packages(<target> FROM <folder with package.json and its lock> INTO <folder of the build tree>):
# installs exactly what the lock file says, again only when it changes. Sets <target>_STAMP.
function(knead_node_packages target)
  cmake_parse_arguments(ARG "" "FROM;INTO" "" ${ARGN})
  set(stamp ${ARG_INTO}/packages.stamp)
  set(manifests ${ARG_FROM}/package.json ${ARG_FROM}/package-lock.json ${ARG_FROM}/.npmrc)
  # No package may run a script of its own: none of ours needs one.
  add_custom_command(
    OUTPUT ${stamp}
    COMMAND ${CMAKE_COMMAND} -E copy ${manifests} ${ARG_INTO}
    COMMAND ${KNEAD_NPM} ci --ignore-scripts --no-audit --no-fund --loglevel=error
    COMMAND ${CMAKE_COMMAND} -E touch ${stamp}
    DEPENDS ${manifests}
    WORKING_DIRECTORY ${ARG_INTO}
    COMMENT "Installing the packages of ${target} (without: -DKNEAD_REPORT_PAGE=OFF)" VERBATIM)
  add_custom_target(${target} DEPENDS ${stamp})
  set(${target}_STAMP ${stamp} PARENT_SCOPE)
endfunction()
