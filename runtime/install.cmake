# SPDX-License-Identifier: Apache-2.0
# Install component `runtime`: its libraries, their headers, and how others find it (CMake package, pkg-config).
set(KNEAD_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/knead)

install(TARGETS knead_runtime knead_haptics EXPORT kneadRuntimeTargets
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime NAMELINK_COMPONENT runtime)
install(DIRECTORY include/knead DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT runtime
        FILES_MATCHING PATTERN "*.h")
# Those headers of the formats that the runtime's own include: plain data and the error type.
foreach(header IN ITEMS asset.h result.h session_log.h tet_mesh.h version.h)
  install(FILES ${PROJECT_SOURCE_DIR}/formats/include/knead/formats/${header}
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/knead/formats COMPONENT runtime)
endforeach()

install(FILES data/devices.toml DESTINATION ${CMAKE_INSTALL_DATADIR}/knead COMPONENT runtime)

install(EXPORT kneadRuntimeTargets NAMESPACE knead:: DESTINATION ${KNEAD_PACKAGE_DIR} COMPONENT runtime)
configure_package_config_file(cmake/kneadConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/kneadConfig.cmake
                              INSTALL_DESTINATION ${KNEAD_PACKAGE_DIR} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/kneadConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
# Both components need the package files; whichever is installed brings them.
foreach(component IN ITEMS runtime tools)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/kneadConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/kneadConfigVersion.cmake
          DESTINATION ${KNEAD_PACKAGE_DIR} COMPONENT ${component})
endforeach()

cmake_path(IS_ABSOLUTE CMAKE_INSTALL_LIBDIR KNEAD_LIBDIR_IS_ABSOLUTE)
set(KNEAD_PC_LIBDIR "\${prefix}/${CMAKE_INSTALL_LIBDIR}")
if(KNEAD_LIBDIR_IS_ABSOLUTE)
  set(KNEAD_PC_LIBDIR ${CMAKE_INSTALL_LIBDIR})
endif()
cmake_path(IS_ABSOLUTE CMAKE_INSTALL_INCLUDEDIR KNEAD_INCLUDEDIR_IS_ABSOLUTE)
set(KNEAD_PC_INCLUDEDIR "\${prefix}/${CMAKE_INSTALL_INCLUDEDIR}")
if(KNEAD_INCLUDEDIR_IS_ABSOLUTE)
  set(KNEAD_PC_INCLUDEDIR ${CMAKE_INSTALL_INCLUDEDIR})
endif()
# The prefix is taken from where the .pc file lies, so that an installed tree can be moved.
cmake_path(RELATIVE_PATH CMAKE_INSTALL_PREFIX
           BASE_DIRECTORY ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig OUTPUT_VARIABLE KNEAD_PC_PREFIX)
foreach(library IN ITEMS runtime haptics)
  configure_file(cmake/knead-${library}.pc.in ${CMAKE_CURRENT_BINARY_DIR}/knead-${library}.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/knead-${library}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
          COMPONENT runtime)
endforeach()
