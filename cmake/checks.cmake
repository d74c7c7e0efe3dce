# Tests of the tree itself: its layers, its layout, its words, the links and commands of its documentation, and
# that another project can use what it installs.
add_test(NAME layers COMMAND bash ${PROJECT_SOURCE_DIR}/.ci/layers.sh)
add_test(NAME style COMMAND bash ${PROJECT_SOURCE_DIR}/.ci/style.sh)
set_tests_properties(style PROPERTIES SKIP_RETURN_CODE 77)
add_test(NAME words COMMAND bash ${PROJECT_SOURCE_DIR}/.ci/words.sh)
add_test(NAME links COMMAND bash ${PROJECT_SOURCE_DIR}/.ci/links.sh $<TARGET_FILE:lilytank>)
add_test(NAME options COMMAND bash ${PROJECT_SOURCE_DIR}/.ci/options.sh $<TARGET_FILE:lilytank>)

# The same program inside and outside the tree; both must print the same fingerprint.
add_executable(package_inside ${PROJECT_SOURCE_DIR}/tests/package/main.cpp)
target_link_libraries(package_inside PRIVATE lilytank_study)
add_test(NAME package COMMAND ${CMAKE_COMMAND} -DBUILD=${PROJECT_BINARY_DIR}
  -DSOURCE=${PROJECT_SOURCE_DIR}/tests/package -DINSIDE=$<TARGET_FILE:package_inside>
  -DGENERATOR=${CMAKE_GENERATOR} -DCOMPILER=${CMAKE_CXX_COMPILER} -DRENDER=${LILYTANK_HAS_RENDER}
  -P ${PROJECT_SOURCE_DIR}/tests/package/run.cmake)
set_tests_properties(layers style words links options package PROPERTIES LABELS tree TIMEOUT 300)

# The Debian packages: their files, and the libraries that they depend on.
add_test(NAME deb COMMAND bash ${PROJECT_SOURCE_DIR}/tests/package/deb.sh ${PROJECT_BINARY_DIR}
         ${LILYTANK_PYTHON})
set_tests_properties(deb PROPERTIES LABELS tree SKIP_RETURN_CODE 77 TIMEOUT 300)

# The recipe for conda and the Dockerfile against the build.
add_test(NAME recipes COMMAND bash ${PROJECT_SOURCE_DIR}/tests/package/recipes.sh ${PROJECT_SOURCE_DIR})
set_tests_properties(recipes PROPERTIES LABELS tree SKIP_RETURN_CODE 77)

# "Adding a force" of docs/structure.md, followed in a copy of the tree, which is built: minutes.
add_test(NAME new_force COMMAND bash ${PROJECT_SOURCE_DIR}/tests/new_force/run.sh ${PROJECT_SOURCE_DIR}
         ${CMAKE_CXX_COMPILER} ${CMAKE_GENERATOR})
set_tests_properties(new_force PROPERTIES LABELS "long;tree" TIMEOUT 3600)

# Studies under a real Slurm of one node; skipped, with the reason, where only root could start one or
# the package is not to be had. It mostly waits for Slurm, so it goes first and beside other tests.
add_test(NAME slurm COMMAND bash ${PROJECT_SOURCE_DIR}/tests/slurm/run.sh $<TARGET_FILE:lilytank>)
set_tests_properties(slurm PROPERTIES LABELS slurm SKIP_RETURN_CODE 77 TIMEOUT 900 COST 1000)
