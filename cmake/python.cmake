# The Python package: the module _core and links to the Python files, so that a changed one needs no build.
find_package(Python 3.11 REQUIRED COMPONENTS Interpreter Development.Module)
find_package(pybind11 2.10 REQUIRED)
set(LILYTANK_PYTHON_OUTPUT ${PROJECT_BINARY_DIR}/python CACHE PATH "where the Python package is built")
set(LILYTANK_PYTHON_DIR lib/python3/dist-packages CACHE STRING "where the Python package is installed")
set(package ${LILYTANK_PYTHON_OUTPUT}/lilytank)

file(GLOB python_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/python/*.cpp)
pybind11_add_module(lilytank_python MODULE NO_EXTRAS ${python_sources})
target_link_libraries(lilytank_python PRIVATE lilytank_cli)
set_target_properties(lilytank_python PROPERTIES OUTPUT_NAME _core LIBRARY_OUTPUT_DIRECTORY ${package}
  UNITY_BUILD ${LILYTANK_UNITY} UNITY_BUILD_BATCH_SIZE 5)
file(GLOB python_files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/python/lilytank/*.py*
     ${PROJECT_SOURCE_DIR}/src/python/lilytank/py.typed)
add_custom_command(TARGET lilytank_python POST_BUILD COMMAND ln -sfr ${python_files} ${package})
install(TARGETS lilytank_python LIBRARY DESTINATION ${LILYTANK_PYTHON_DIR}/lilytank COMPONENT python)
install(FILES ${python_files} DESTINATION ${LILYTANK_PYTHON_DIR}/lilytank COMPONENT python)

if(LILYTANK_TESTS)
  add_test(NAME python COMMAND ${Python_EXECUTABLE} -m unittest discover -p "*_test.py"
           -s ${PROJECT_SOURCE_DIR}/tests/python)
  set_tests_properties(python PROPERTIES LABELS "slow;program" TIMEOUT 600 COST 400 ENVIRONMENT
    "PYTHONPATH=${LILYTANK_PYTHON_OUTPUT};LILYTANK_PROGRAM=$<TARGET_FILE:lilytank>;PYTHONDONTWRITEBYTECODE=1")
endif()
