# Installs the program, headers, scenarios with the pages about them, and the package that
# find_package(lilytank) finds. Components: program, development, python (cmake/deb.cmake).
include(CMakePackageConfigHelpers)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME program)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/lilytank)

install(TARGETS lilytank RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
set(without_render)
if(NOT LILYTANK_HAS_RENDER)
  set(without_render PATTERN render.hpp EXCLUDE)
endif()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/lilytank DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        COMPONENT development FILES_MATCHING PATTERN "*.hpp" ${without_render})
# Scenarios and pages lie as in the sources, so that links from one to another hold; scripts among them
# can be run.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/scenarios ${PROJECT_SOURCE_DIR}/docs
        DESTINATION ${CMAKE_INSTALL_DATADIR}/lilytank USE_SOURCE_PERMISSIONS)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/README.md
              ${PROJECT_SOURCE_DIR}/CHANGELOG.md ${PROJECT_SOURCE_DIR}/CITATION.cff
              ${PROJECT_SOURCE_DIR}/CONTRIBUTING.md
        DESTINATION ${CMAKE_INSTALL_DATADIR}/lilytank)
install(FILES ${PROJECT_SOURCE_DIR}/bench/README.md DESTINATION ${CMAKE_INSTALL_DATADIR}/lilytank/bench)

install(EXPORT lilytankTargets NAMESPACE lilytank:: DESTINATION ${package_dir} COMPONENT development)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/lilytankConfig.cmake.in
  ${PROJECT_BINARY_DIR}/lilytankConfig.cmake INSTALL_DESTINATION ${package_dir}
  PATH_VARS CMAKE_INSTALL_DATADIR)
# Before 1.0, a minor version may change what a program sees.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/lilytankConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/lilytankConfig.cmake
              ${PROJECT_BINARY_DIR}/lilytankConfigVersion.cmake DESTINATION ${package_dir}
        COMPONENT development)
install(SCRIPT ${PROJECT_SOURCE_DIR}/cmake/shell_files.cmake COMPONENT program)
