# How a library of actions is built, in the tree of hires and in packages that depend on it. Those get
# this file by find_package(catkin COMPONENTS hires), after HiresCore.cmake and FindClassLoader.cmake.

# What such a library takes with it of hires, each before what it needs itself. Its bytes are then all that
# an action is, and those who imagine can compare them.
set(HIRES_ACTION_LAYERS skills manipulation perception perception_no_pcl navigation navigation_guard world robot actions
  geometry base)

# hires_action_library(<target> a.cpp ...): actions that programs load when they are told to, see
# hires/skills/action_library.h. What else they need is linked by target_link_libraries. In the tree of
# hires the target is hires_<target>; the file is lib<target>.so everywhere.
function(hires_action_library target)
  if(HIRES_OWN_BUILD)
    add_library(hires_${target} MODULE ${ARGN})
    set_target_properties(hires_${target} PROPERTIES OUTPUT_NAME ${target} HIRES_WITHOUT_PCL ON)
    target_compile_options(hires_${target} PRIVATE ${HIRES_WARNINGS})
    target_link_libraries(hires_${target} PRIVATE hires_skills)
    if(HIRES_ROS)  # apart from a library of the same name of another package
      set_target_properties(hires_${target} PROPERTIES
        LIBRARY_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/${CATKIN_PACKAGE_BIN_DESTINATION})
    endif()
    return()
  endif()
  hires_action_archives(archives)
  add_library(${target} MODULE ${ARGN})
  if(TARGET hires_skills)  # built in the same workspace
    add_dependencies(${target} hires_skills)
  endif()
  target_compile_features(${target} PRIVATE cxx_std_17)
  target_compile_options(${target} PRIVATE -ffp-contract=off)
  target_include_directories(${target} SYSTEM PRIVATE ${hires_INCLUDE_DIRS})
  target_link_libraries(${target} PRIVATE ${archives}
    Eigen3::Eigen fmt::fmt yaml-cpp ClassLoader::ClassLoader Threads::Threads)
  # What is missing is told now, and not when a robot loads it.
  target_link_options(${target} PRIVATE -Wl,--no-undefined)
  set_target_properties(${target} PROPERTIES
    LIBRARY_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/${CATKIN_GLOBAL_LIB_DESTINATION})
  install(TARGETS ${target} LIBRARY DESTINATION ${CATKIN_GLOBAL_LIB_DESTINATION})
endfunction()

# hires_action_archives(<variable>): the static libraries of HIRES_ACTION_LAYERS, in the order of linking.
function(hires_action_archives variable)
  set(archives)
  foreach(layer IN LISTS HIRES_ACTION_LAYERS)
    if(TARGET hires_${layer})
      list(APPEND archives $<TARGET_FILE:hires_${layer}>)
    else()
      find_library(hires_${layer}_ARCHIVE NAMES libhires_${layer}.a
        PATHS ${hires_LIBRARY_DIR} NO_DEFAULT_PATH)
      if(NOT hires_${layer}_ARCHIVE)
        message(FATAL_ERROR "hires_action_library: libhires_${layer}.a is not in '${hires_LIBRARY_DIR}', "
          "where the rest of hires is; build or install hires as a whole")
      endif()
      mark_as_advanced(hires_${layer}_ARCHIVE)
      list(APPEND archives ${hires_${layer}_ARCHIVE})
    endif()
  endforeach()
  set(${variable} ${archives} PARENT_SCOPE)
endfunction()
