# What only the ROS build needs: messages, nodes, rostests, installation.

find_package(catkin REQUIRED COMPONENTS
  actionlib actionlib_msgs diagnostic_msgs diagnostic_updater dynamic_reconfigure genmsg
  geometry_msgs message_generation move_base_msgs nav_msgs rosbag roscpp roslib rosgraph_msgs
  sensor_msgs std_msgs std_srvs tf2 tf2_msgs tf2_ros topic_tools trajectory_msgs visualization_msgs xmlrpcpp)

catkin_python_setup()  # python/hires; before the messages, whose Python module it shares
file(GLOB HIRES_MSG RELATIVE ${PROJECT_SOURCE_DIR}/msg CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/msg/*.msg)
file(GLOB HIRES_SRV RELATIVE ${PROJECT_SOURCE_DIR}/srv CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/srv/*.srv)
file(GLOB HIRES_ACTION RELATIVE ${PROJECT_SOURCE_DIR}/action CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/action/*.action)
add_message_files(DIRECTORY msg FILES ${HIRES_MSG})
if(HIRES_SRV)
  add_service_files(DIRECTORY srv FILES ${HIRES_SRV})
endif()
add_action_files(DIRECTORY action FILES ${HIRES_ACTION})
generate_messages(DEPENDENCIES actionlib_msgs geometry_msgs sensor_msgs std_msgs)

catkin_package(
  INCLUDE_DIRS include
  LIBRARIES hires_core
  CFG_EXTRAS HiresCore.cmake FindClassLoader.cmake HiresActionLibrary.cmake
  CATKIN_DEPENDS actionlib actionlib_msgs geometry_msgs message_runtime roscpp sensor_msgs std_msgs)

# Code that sees ROS converts and waits; what is to be fast lies below.
set(HIRES_ROS_OPTIONS ${HIRES_WARNINGS} ${HIRES_LITTLE_OPTIMISED})

# hires_sees_ros(<target>): a library that includes ROS and messages, which are made before it.
function(hires_sees_ros target)
  target_compile_options(${target} PRIVATE ${HIRES_ROS_OPTIONS})
  target_include_directories(${target} SYSTEM PUBLIC ${catkin_INCLUDE_DIRS})
  target_link_libraries(${target} PUBLIC ${catkin_LIBRARIES})
  add_dependencies(${target} ${${PROJECT_NAME}_EXPORTED_TARGETS} ${catkin_EXPORTED_TARGETS})
endfunction()

# hires_node(<name> SOURCES a.cpp ... DEPENDS layers and rooms ... [LINK libraries ...]): an executable that
# rosrun and roslaunch find as <name>, from <name>/<name>_main.cpp. The sources, in the same folder, are the
# static library hires_nodes_<name>, so that tests can link what the node is made of; it is added to
# HIRES_NODE_LIBRARIES of the caller. DEPENDS as in hires_layer: what the node includes, and nothing else. The
# target is hires_<name>_node, so that it cannot clash with a layer's.
function(hires_node name)
  cmake_parse_arguments(NODE "" "" "SOURCES;DEPENDS;LINK" ${ARGN})
  set(library hires_nodes_${name})
  list(TRANSFORM NODE_SOURCES PREPEND ${name}/)
  add_library(${library} STATIC ${NODE_SOURCES})
  hires_sees_ros(${library})
  hires_compile_together(${library})
  target_include_directories(${library} PUBLIC ${PROJECT_SOURCE_DIR}/src)
  hires_library_names(depends ${NODE_DEPENDS})
  target_link_libraries(${library} PUBLIC ${depends} ${NODE_LINK})
  set(HIRES_NODE_LIBRARIES ${HIRES_NODE_LIBRARIES} ${library} PARENT_SCOPE)
  set(target hires_${name}_node)
  add_executable(${target} ${name}/${name}_main.cpp)
  set_target_properties(${target} PROPERTIES
    OUTPUT_NAME ${name}
    RUNTIME_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/${CATKIN_PACKAGE_BIN_DESTINATION})
  target_compile_options(${target} PRIVATE ${HIRES_ROS_OPTIONS})
  target_link_libraries(${target} PRIVATE ${library})
  install(TARGETS ${target} RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
  add_dependencies(hires_run ${target})
  set_property(GLOBAL APPEND PROPERTY HIRES_NODES ${name})
endfunction()

# hires_write_node_links(<file>): one line for each node, its name and the libraries of this package that it is
# linked with, for a test that looks whether these are too many. Call it after all layers.
function(hires_write_node_links file)
  get_property(nodes GLOBAL PROPERTY HIRES_NODES)
  set(lines)
  foreach(node IN LISTS nodes)
    set(linked hires_nodes_${node})
    set(todo ${linked})
    while(todo)
      list(GET todo 0 next)
      list(REMOVE_AT todo 0)
      get_target_property(libraries ${next} INTERFACE_LINK_LIBRARIES)
      foreach(library IN LISTS libraries)
        if(library MATCHES "hires_[a-z_]+" AND NOT CMAKE_MATCH_0 IN_LIST linked)  # also in $<LINK_ONLY:...>
          list(APPEND linked ${CMAKE_MATCH_0})
          list(APPEND todo ${CMAKE_MATCH_0})
        endif()
      endforeach()
    endwhile()
    list(REMOVE_AT linked 0)  # the node's own
    list(SORT linked)
    list(JOIN linked " " libraries)
    string(APPEND lines "${node}: ${libraries}\n")
  endforeach()
  file(WRITE ${file} "${lines}")
endfunction()

# What running needs: all nodes, and the messages for those who look at topics.
add_custom_target(hires_run)
add_dependencies(hires_run hires_generate_messages_py)

# hires_rostest(<file.test> [TIMEOUT seconds] [BESIDE_OTHERS] [WAITS] [LONG|NIGHTLY] [SCENARIO]): a rostest that ctest runs and a
# user can run alone. Nothing else runs meanwhile, as each brings masters and worker processes of its
# own; BESIDE_OTHERS: it judges no times and takes no fixed ports, so that other tests may run too.
# WAITS: it takes half a processor at most, for it waits for time-outs and for what a robot does at
# the pace of time.
# LONG: only with HIRES_LONG_TESTS, as `scripts/test --long` sets it; NIGHTLY: only with HIRES_NIGHTLY_TESTS.
# SCENARIO: of whole tasks, for its label.
# Not in ${CATKIN_ENV}: that is a snapshot taken while configuring, and in a fresh folder it misses
# the Python messages built later.
function(hires_rostest file)
  if(NOT HIRES_TESTS)
    return()
  endif()
  cmake_parse_arguments(ROSTEST "BESIDE_OTHERS;WAITS;LONG;NIGHTLY;SCENARIO" "TIMEOUT" "ARGS" ${ARGN})
  if((ROSTEST_LONG AND NOT HIRES_LONG_TESTS) OR (ROSTEST_NIGHTLY AND NOT HIRES_NIGHTLY_TESTS))
    return()
  endif()
  if(NOT ROSTEST_TIMEOUT)
    set(ROSTEST_TIMEOUT 120)
  endif()
  get_filename_component(name ${file} NAME_WE)
  if(TEST ros.${name})  # a gtest of the same name
    string(APPEND name _nodes)
  endif()
  add_test(NAME ros.${name}
    COMMAND ${CATKIN_DEVEL_PREFIX}/env.sh rostest ${CMAKE_CURRENT_SOURCE_DIR}/${file} ${ROSTEST_ARGS}
    WORKING_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR})
  set(alone ON)
  if(ROSTEST_BESIDE_OTHERS)
    set(alone OFF)
  endif()
  set(processors 2)  # halves
  if(ROSTEST_WAITS)
    set(processors 1)
  endif()
  set(labels node)
  if(ROSTEST_SCENARIO)
    set(labels scenario)
  endif()
  if(ROSTEST_NIGHTLY)
    list(APPEND labels nightly)
  endif()
  set_tests_properties(ros.${name} PROPERTIES LABELS "${labels}"
    TIMEOUT ${ROSTEST_TIMEOUT} RUN_SERIAL ${alone} PROCESSORS ${processors}
    ENVIRONMENT "ROS_HOSTNAME=localhost;ROS_IP=")
endfunction()

install(DIRECTORY launch config worlds urdf
  DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION} USE_SOURCE_PERMISSIONS)
catkin_install_python(PROGRAMS examples/ask_before_driving.py DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
# What programs of the package start themselves, and the env-loader of launch files.
install(DIRECTORY scripts/report DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION}/scripts
  PATTERN __pycache__ EXCLUDE)
install(PROGRAMS scripts/on_host DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION}/scripts)
# A PR2 that is none, to try pr2.launch with; in one folder, from which they import each other.
set(fake_pr2 ${CATKIN_PACKAGE_SHARE_DESTINATION}/test/pr2)
install(FILES test/pr2/fake_pr2.launch test/ros/support/pr2_frames.py DESTINATION ${fake_pr2})
install(PROGRAMS test/pr2/fake_pr2.py test/pr2/fake_move_base.py test/pr2/without_tray.py DESTINATION ${fake_pr2})
install(DIRECTORY test/pr2/fake DESTINATION ${fake_pr2} FILES_MATCHING PATTERN "*.py")
