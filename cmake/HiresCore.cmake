# Gives who asked for hires the target hires::core, the library of all ROS-free layers, with the headers
# that it needs. Included by find_package(catkin COMPONENTS hires), whose catkin_LIBRARIES have it then,
# and, where hires was built without ROS, by find_package(hires).
include(CMakeFindDependencyMacro)
find_dependency(Threads)
find_dependency(Eigen3 NO_MODULE)
find_dependency(fmt)
find_dependency(yaml-cpp)
find_dependency(Boost)
find_dependency(nlohmann_json)
if(NOT TARGET hires::core)  # else hires is built in the same workspace
  include(${hires_DIR}/hiresTargets.cmake)
endif()
list(APPEND hires_LIBRARIES hires::core)

# hires_LIBRARY_DIR: where its libraries lie. hires_DATA_DIR: where config/, worlds/ and urdf/ lie.
if(TARGET hires_core)
  get_target_property(hires_LIBRARY_DIR hires_core LIBRARY_OUTPUT_DIRECTORY)
  set(hires_DATA_DIR ${hires_SOURCE_DIR})
else()
  get_target_property(hires_LIBRARY_DIR hires::core LOCATION)
  get_filename_component(hires_LIBRARY_DIR ${hires_LIBRARY_DIR} DIRECTORY)
  get_target_property(hires_DATA_DIR hires::core INTERFACE_INCLUDE_DIRECTORIES)
  get_filename_component(hires_DATA_DIR ${hires_DATA_DIR} DIRECTORY)
  if(NOT EXISTS ${hires_DATA_DIR}/config/scene.yaml)  # installed, and not a source tree
    set(hires_DATA_DIR ${hires_DATA_DIR}/share/hires)
  endif()
endif()
