# Packages for Debian: cpack --config build/CPackConfig.cmake -B <folder> makes lilytank, liblilytank-dev and, with
# LILYTANK_PYTHON, python3-lilytank.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The lilytank authors")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

# lilytank_deb(<component> <package> <section> <text>): a package, with the licence.
macro(lilytank_deb component package section text)
  list(APPEND CPACK_COMPONENTS_ALL ${component})
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${package})
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section})
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${text}")
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION share/doc/${package} RENAME copyright
          COMPONENT ${component})
endmacro()

lilytank_deb(program lilytank science "The program with its manual pages, scenarios and documentation.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "ffmpeg, fonts-dejavu-core")

lilytank_deb(development liblilytank-dev libdevel "Headers and static libraries for C++20, found by CMake.")
set(needed libeigen3-dev libhwy-dev libtomlplusplus-dev libboost-dev nlohmann-json3-dev zlib1g-dev libssl-dev
    libtbb-dev)
if(NETCDF_FOUND)
  list(APPEND needed libnetcdf-dev)
endif()
if(box2d_FOUND)
  list(APPEND needed libbox2d-dev)
endif()
if(LILYTANK_HAS_RENDER)
  list(APPEND needed libcairo2-dev)
endif()
list(APPEND needed pkg-config)
list(JOIN needed ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS lilytank)

if(LILYTANK_PYTHON)
  lilytank_deb(python python3-lilytank python "The module for Python ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}.")
  math(EXPR next "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
      "python3 (>= 3.${Python_VERSION_MINOR}), python3 (<< 3.${next}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "lilytank, ffmpeg, fonts-dejavu-core")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-pandas, python3-xarray")
endif()
include(CPack)
