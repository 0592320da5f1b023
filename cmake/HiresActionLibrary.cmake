# How a library of actions is built, in the tree of hires and in packages that depend on it. Those get
# this file by find_package(catkin COMPONENTS hires), after FindClassLoader.cmake.

# hires_action_library(<target> a.cpp ...): actions that programs load when they are told to, see
# hires/skills/action_library.h. What else they need is linked by target_link_libraries.
function(hires_action_library target)
  add_library(${target} MODULE ${ARGN})
  if(TARGET hires_skills)
    target_compile_options(${target} PRIVATE ${HIRES_WARNINGS})
    target_link_libraries(${target} PRIVATE hires_skills)
    return()
  endif()
  find_package(Eigen3 REQUIRED NO_MODULE)
  find_package(fmt REQUIRED)
  find_package(yaml-cpp REQUIRED)
  find_package(Threads REQUIRED)
  target_compile_features(${target} PRIVATE cxx_std_17)
  target_compile_options(${target} PRIVATE -ffp-contract=off)
  target_include_directories(${target} SYSTEM PRIVATE ${hires_INCLUDE_DIRS})
  target_link_libraries(${target} PRIVATE ${hires_LIBRARIES}
    Eigen3::Eigen fmt::fmt yaml-cpp ClassLoader::ClassLoader Threads::Threads)
  # What is missing is told now, and not when a robot loads it.
  target_link_options(${target} PRIVATE -Wl,--no-undefined)
  set_target_properties(${target} PROPERTIES
    LIBRARY_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/${CATKIN_GLOBAL_LIB_DESTINATION})
  install(TARGETS ${target} LIBRARY DESTINATION ${CATKIN_GLOBAL_LIB_DESTINATION})
endfunction()
