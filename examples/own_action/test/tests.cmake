# What the build of hires tests of this example.
add_executable(hires_own_action_test test/turn_towards_test.cpp src/turn_towards.cpp)
target_include_directories(hires_own_action_test PRIVATE src)
target_link_libraries(hires_own_action_test PRIVATE hires_skills GTest::gmock_main)
add_test(NAME examples.own_action COMMAND hires_own_action_test)
set_tests_properties(examples.own_action PROPERTIES LABELS unit TIMEOUT 60)

if(HIRES_ROS)
  set(hires $<TARGET_FILE:hires_hires_node>)
else()
  set(hires $<TARGET_FILE:hires_program>)
endif()
set(says ${PYTHON_EXECUTABLE} -B ${PROJECT_SOURCE_DIR}/../../test/run_says.py)
add_test(NAME examples.own_action_planned COMMAND ${says}
  "!turn_towards sittingareawesttable1 fast.*plan 1 is valid" ${hires} plan --validate
  --domain ${CMAKE_CURRENT_SOURCE_DIR}/config/greeting.lisp
  --problem ${CMAKE_CURRENT_SOURCE_DIR}/config/greeting_problem.lisp)
set_tests_properties(examples.own_action_planned PROPERTIES LABELS unit TIMEOUT 60)

# Without any master: slow and fast are played and ranked.
set(imagine imagine --local --quiet --seed 7 --rollouts 16
  --config ${PROJECT_SOURCE_DIR}/../../config/imagination_client.yaml
  --action turn_towards --arg sittingAreaWestTable1 --arg slow,fast
  --from preManipulationAreaEastCounter1 --object peppermill1 --actions)
if(NOT HIRES_ROS)
  add_test(NAME examples.own_action_imagined COMMAND
    ${says} "(ranked|close): turn_towards.sittingareawesttable1" ${hires} ${imagine} $<TARGET_FILE:hires_own_action>)
else()
  # Built as a user builds it, by a CMake that knows of hires only what catkin exports.
  add_test(NAME examples.own_action_imagined COMMAND
    ${says} "(ranked|close): turn_towards.sittingareawesttable1" ${CMAKE_CTEST_COMMAND}
    --build-and-test ${CMAKE_CURRENT_SOURCE_DIR} ${CMAKE_CURRENT_BINARY_DIR}/outside
    --build-generator ${CMAKE_GENERATOR}
    --build-options -DCMAKE_PREFIX_PATH=${CATKIN_DEVEL_PREFIX} -DCMAKE_BUILD_TYPE=${CMAKE_BUILD_TYPE}
    --test-command ${hires} ${imagine}
      ${CMAKE_CURRENT_BINARY_DIR}/outside/devel/lib/libown_action.so)
endif()
set_tests_properties(examples.own_action_imagined PROPERTIES LABELS unit TIMEOUT 300)

if(HIRES_ROS)  # the whole of it, executed by a simulated robot
  hires_rostest(../../test/ros/own_action.test TIMEOUT 300 ARGS actions:=$<TARGET_FILE:hires_own_action>)
endif()
