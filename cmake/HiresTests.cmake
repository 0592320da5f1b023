# One test program per layer, one ctest entry per test file (<layer>.<name>):
# the entry runs the suites that stand in the file. A layer is linked once, and `ctest -R`, time-outs
# and reports are still per file. The target is hires_<layer>_test, the program <layer>_test.

# hires_test_folder(<folder>): what it builds is for tests alone. In a catkin workspace that is built by the
# target `tests`, as the tests of other packages are, and not by who builds the workspace.
function(hires_test_folder folder)
  if(NOT EXISTS ${PROJECT_SOURCE_DIR}/${folder}/CMakeLists.txt)
    return()
  endif()
  if(NOT HIRES_ROS)
    add_subdirectory(${folder})
    return()
  endif()
  add_subdirectory(${folder} EXCLUDE_FROM_ALL)
  hires_targets_below(${PROJECT_SOURCE_DIR}/${folder} targets)
  if(HIRES_TESTS AND targets)
    add_dependencies(tests ${targets})
  endif()
endfunction()

# hires_targets_below(<folder> <variable>): programs and libraries of a folder and of those below it.
function(hires_targets_below folder variable)
  get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  get_property(folders DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
  foreach(below IN LISTS folders)
    hires_targets_below(${below} more)
    list(APPEND targets ${more})
  endforeach()
  set(${variable} ${targets} PARENT_SCOPE)
endfunction()

# hires_short_name(<target> <name>): people may say less where no other package is built beside this one;
# in a workspace, targets of all packages share their names.
function(hires_short_name target name)
  if(CMAKE_SOURCE_DIR STREQUAL PROJECT_SOURCE_DIR)
    add_custom_target(${name} DEPENDS ${target})
  endif()
endfunction()

# hires_run_tests(): the target run_tests of catkin runs these, too, by ctest, which knows which may run side
# by side and when to give up. As with the tests of other packages, catkin_test_results tells the verdict.
function(hires_run_tests)
  if(NOT HIRES_ROS)
    return()
  endif()
  include(ProcessorCount)
  ProcessorCount(processors)
  math(EXPR halves "2 * ${processors}")
  set(results ${CATKIN_TEST_RESULTS_DIR}/${PROJECT_NAME}/ctest.xml)
  # A target whose name begins with _ runs when the old results are gone and the tests are built.
  foreach(prefix "" "_")
    add_custom_target(${prefix}run_tests_${PROJECT_NAME}
      COMMAND ${PYTHON_EXECUTABLE} -B ${PROJECT_SOURCE_DIR}/test/run_ctest.py ${results} ${PROJECT_BINARY_DIR}
        --parallel ${halves}
      USES_TERMINAL VERBATIM)
    add_dependencies(${prefix}run_tests_${PROJECT_NAME} tests)
  endforeach()
  add_custom_target(clean_test_results_${PROJECT_NAME} COMMAND ${PYTHON_EXECUTABLE}
    ${catkin_EXTRAS_DIR}/test/remove_test_results.py ${CATKIN_TEST_RESULTS_DIR}/${PROJECT_NAME} VERBATIM)
  add_dependencies(_run_tests_${PROJECT_NAME} clean_test_results_${PROJECT_NAME})
  add_dependencies(run_tests _run_tests_${PROJECT_NAME})
endfunction()

# Labels of tests (`scripts/test -L unit`): unit, node (one node or launch file, in a graph), scenario (whole
# tasks), install (as others have it) and nightly (what only `scripts/test --nightly` runs).

# ctest counts half processors (scripts/common.sh, RunTests): a test takes two of them, or one if it
# waits more than it computes.

# hires_test(<layer> <file without _test.cpp> [LINK more libraries ...] [TIMEOUT seconds] [BUSY] [LONG])
# LONG: it is always built, but run only with HIRES_LONG_TESTS, as `scripts/test --long` sets it.
# BUSY: the test's own code has so much to do that it is optimised, and compiled by itself. Call it in test/<layer>/CMakeLists.txt; the program links its layer and test/support. The target
# <layer>_<name>_test builds the program that the file is part of.
function(hires_test layer name)
  if(NOT HIRES_TESTS)
    return()
  endif()
  cmake_parse_arguments(TEST "BUSY;LONG" "TIMEOUT" "LINK" ${ARGN})
  set(target hires_${layer}_test)
  if(NOT TARGET ${target})
    hires_test_program_of_layer(${layer})
  endif()
  target_sources(${target} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/${name}_test.cpp)
  if(TEST_BUSY)
    set_source_files_properties(${CMAKE_CURRENT_SOURCE_DIR}/${name}_test.cpp PROPERTIES
      COMPILE_OPTIONS -O2 SKIP_UNITY_BUILD_INCLUSION ON)
  endif()
  target_link_libraries(${target} PRIVATE ${TEST_LINK})
  hires_short_name(${target} ${layer}_${name}_test)
  hires_test_suites(${target} ${CMAKE_CURRENT_SOURCE_DIR}/${name}_test.cpp filter)
  if(TEST_LONG AND NOT HIRES_LONG_TESTS)
    return()
  endif()
  add_test(NAME ${layer}.${name} COMMAND ${target} --gtest_filter=${filter})
  if(NOT TEST_TIMEOUT)
    set(TEST_TIMEOUT 120)
  endif()
  if(HIRES_SANITIZE)  # up to ten times slower, and nothing to do with hanging
    math(EXPR TEST_TIMEOUT "10 * ${TEST_TIMEOUT}")
  endif()
  set_tests_properties(${layer}.${name} PROPERTIES TIMEOUT ${TEST_TIMEOUT} PROCESSORS 2 LABELS unit
    FAIL_REGULAR_EXPRESSION "Running 0 tests from 0 test suites")
endfunction()

function(hires_test_program_of_layer layer)
  set(target hires_${layer}_test)
  add_executable(${target})
  set_target_properties(${target} PROPERTIES OUTPUT_NAME ${layer}_test)
  if(NOT HIRES_ROS)  # a folder in which no target is called as the program is
    set_target_properties(${target} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)
  endif()
  hires_short_name(${target} ${layer}_test)
  # What is tested is as fast as ever; the tests' own code is built in half the time so.
  target_compile_options(${target} PRIVATE ${HIRES_WARNINGS} -O0)
  hires_compile_together(${target})
  set_target_properties(${target} PROPERTIES UNITY_BUILD_BATCH_SIZE ${HIRES_LARGE_LOT})
  target_compile_definitions(${target} PRIVATE
    HIRES_SOURCE_DIR="${PROJECT_SOURCE_DIR}" HIRES_SHARED_DATA="${HIRES_SHARED_DATA}")
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/test ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(${target} PRIVATE hires_${layer} GTest::gmock_main)
  set_property(GLOBAL APPEND PROPERTY HIRES_TEST_PROGRAMS ${target})
endfunction()

# hires_test_suites(<target> <file> <filter>): the suites that the file defines, as a --gtest_filter.
# They are read while configuring, and again when the file changes.
function(hires_test_suites target file filter)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  file(READ ${file} text)
  string(REGEX MATCHALL
    "(TEST|TEST_F|TEST_P|TYPED_TEST|TYPED_TEST_P|HIRES_PROPERTY|RC_GTEST_[A-Z_]*PROP)\\([ \n]*[A-Za-z0-9_]+,"
    definitions "${text}")
  set(suites)
  foreach(definition IN LISTS definitions)
    if(definition MATCHES "^RC_GTEST")
      message(FATAL_ERROR "${file}: RC_GTEST_PROP takes its seed and the number of cases from what "
        "all files of a program share; use HIRES_PROPERTY of test/support/property.h")
    endif()
    string(REGEX REPLACE "^.*\\([ \n]*|,$" "" suite "${definition}")
    list(APPEND suites ${suite})
  endforeach()
  if(NOT suites)
    message(FATAL_ERROR "${file}: defines no test, so its ctest entry would run none; write a "
      "TEST(...), or take its hires_test(...) out of the CMakeLists.txt")
  endif()
  list(REMOVE_DUPLICATES suites)
  set(patterns)
  foreach(suite IN LISTS suites)
    get_property(owner GLOBAL PROPERTY HIRES_SUITE_${target}_${suite})
    if(owner)
      message(FATAL_ERROR "${file}: suite ${suite} stands in ${owner} too, and both are part of "
        "${target}; give it another name")
    endif()
    set_property(GLOBAL PROPERTY HIRES_SUITE_${target}_${suite} ${file})
    # Plain ones, those with parameters, those with types, and what gtest says of unused ones.
    list(APPEND patterns "${suite}.*" "*/${suite}.*" "${suite}/*" "*/${suite}/*"
      "GoogleTestVerification.*<${suite}>")
  endforeach()
  list(JOIN patterns ":" patterns)
  set_property(GLOBAL APPEND PROPERTY HIRES_FILTERS_${target} ${patterns})
  set(${filter} ${patterns} PARENT_SCOPE)
endfunction()

# hires_check_test_programs(): call it after all tests; for each program a test <layer>.all_listed that
# fails if the program has a test that no entry runs.
function(hires_check_test_programs)
  get_property(programs GLOBAL PROPERTY HIRES_TEST_PROGRAMS)
  foreach(program IN LISTS programs)
    get_property(filters GLOBAL PROPERTY HIRES_FILTERS_${program})
    list(JOIN filters ":" filters)
    string(REGEX REPLACE "^hires_(.*)_test$" "\\1.all_listed" name ${program})
    add_test(NAME ${name} COMMAND ${program} --gtest_filter=*-${filters})
    set_tests_properties(${name} PROPERTIES LABELS unit TIMEOUT 120
      PASS_REGULAR_EXPRESSION "Running 0 tests from 0 test suites")
  endforeach()
endfunction()
