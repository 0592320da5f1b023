# One test program per layer (target <layer>_test), one ctest entry per test file (<layer>.<name>):
# the entry runs the suites that stand in the file. A layer is linked once, and `ctest -R`, time-outs
# and reports are still per file.

# ctest counts half processors (scripts/common.sh, RunTests): a test takes two of them, or one if it
# waits more than it computes.

# hires_test(<layer> <file without _test.cpp> [LINK more libraries ...] [TIMEOUT seconds] [BUSY])
# BUSY: the test's own code has so much to do that it is optimised, and compiled by itself. Call it in test/<layer>/CMakeLists.txt; the program links its layer and test/support. The target
# <layer>_<name>_test builds the program that the file is part of.
function(hires_test layer name)
  if(NOT HIRES_TESTS)
    return()
  endif()
  cmake_parse_arguments(TEST "BUSY" "TIMEOUT" "LINK" ${ARGN})
  set(target ${layer}_test)
  if(NOT TARGET ${target})
    hires_test_program_of_layer(${layer})
  endif()
  target_sources(${target} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/${name}_test.cpp)
  if(TEST_BUSY)
    set_source_files_properties(${CMAKE_CURRENT_SOURCE_DIR}/${name}_test.cpp PROPERTIES
      COMPILE_OPTIONS -O2 SKIP_UNITY_BUILD_INCLUSION ON)
  endif()
  target_link_libraries(${target} PRIVATE ${TEST_LINK})
  add_custom_target(${layer}_${name}_test DEPENDS ${target})
  hires_test_suites(${target} ${CMAKE_CURRENT_SOURCE_DIR}/${name}_test.cpp filter)
  add_test(NAME ${layer}.${name} COMMAND ${target} --gtest_filter=${filter})
  if(NOT TEST_TIMEOUT)
    set(TEST_TIMEOUT 120)
  endif()
  if(HIRES_SANITIZE)  # up to ten times slower, and nothing to do with hanging
    math(EXPR TEST_TIMEOUT "10 * ${TEST_TIMEOUT}")
  endif()
  set_tests_properties(${layer}.${name} PROPERTIES TIMEOUT ${TEST_TIMEOUT} PROCESSORS 2
    FAIL_REGULAR_EXPRESSION "Running 0 tests from 0 test suites")
endfunction()

function(hires_test_program_of_layer layer)
  set(target ${layer}_test)
  add_executable(${target})
  # What is tested is as fast as ever; the tests' own code is built in half the time so.
  target_compile_options(${target} PRIVATE ${HIRES_WARNINGS} -O0)
  hires_compile_together(${target})
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
    string(REGEX REPLACE "_test$" ".all_listed" name ${program})
    add_test(NAME ${name} COMMAND ${program} --gtest_filter=*-${filters})
    set_tests_properties(${name} PROPERTIES TIMEOUT 120
      PASS_REGULAR_EXPRESSION "Running 0 tests from 0 test suites")
  endforeach()
endfunction()
