# What other packages link: one shared library of all ROS-free layers. They need nothing for it but what its
# headers include.

# hires_export_core(): the target hires_core, for others hires::core; call it after all layers.
function(hires_export_core)
  set(layers ${HIRES_LAYERS})
  list(REMOVE_ITEM layers cli ros nodes)  # `cli` is a program, and the others need ROS
  set(archives)
  set(libraries)
  foreach(layer IN LISTS layers)
    get_property(rooms GLOBAL PROPERTY HIRES_ROOMS_${layer})
    foreach(library IN ITEMS hires_${layer} ${rooms})
      get_target_property(type ${library} TYPE)
      if(type STREQUAL "STATIC_LIBRARY")
        list(APPEND archives $<TARGET_FILE:${library}>)
      endif()
      list(APPEND libraries ${library})
    endforeach()
  endforeach()
  # A library has to have a source; all that this one is made of comes from the layers.
  file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/hires_core.cpp CONTENT "// See cmake/HiresExport.cmake.\n")
  add_library(hires_core SHARED ${PROJECT_BINARY_DIR}/hires_core.cpp)
  add_library(hires::core ALIAS hires_core)
  set_target_properties(hires_core PROPERTIES EXPORT_NAME core VERSION ${PROJECT_VERSION}
    SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  # Whole, as nothing in it needs itself; calls within it go straight, as in a program.
  target_link_libraries(hires_core
    PRIVATE -Wl,--whole-archive ${archives} -Wl,--no-whole-archive ${libraries}
    INTERFACE Eigen3::Eigen fmt::fmt yaml-cpp Boost::boost nlohmann_json::nlohmann_json Threads::Threads)
  target_link_options(hires_core PRIVATE -Wl,-Bsymbolic-functions)
  target_compile_features(hires_core INTERFACE cxx_std_17)
  target_include_directories(hires_core INTERFACE
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:include>)
  hires_install_core()
endfunction()

# hires_install_core(): library, headers and what CMake has to know of them, in catkin's folders or, without
# ROS, in the usual ones.
function(hires_install_core)
  if(HIRES_ROS)
    set(library_folder ${CATKIN_GLOBAL_LIB_DESTINATION})
    set(config_folder share/hires/cmake)
    if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")  # as catkin_package does for its part
      set(config_folder ${library_folder}/cmake/hires)
    endif()
    export(TARGETS hires_core NAMESPACE hires:: FILE ${CATKIN_DEVEL_PREFIX}/share/hires/cmake/hiresTargets.cmake)
    list(TRANSFORM HIRES_ACTION_LAYERS PREPEND hires_ OUTPUT_VARIABLE archives)
    install(TARGETS ${archives} ARCHIVE DESTINATION ${library_folder})
  else()
    include(GNUInstallDirs)
    include(CMakePackageConfigHelpers)
    set(library_folder ${CMAKE_INSTALL_LIBDIR})
    set(config_folder ${library_folder}/cmake/hires)
    write_basic_package_version_file(${PROJECT_BINARY_DIR}/hiresConfigVersion.cmake
      COMPATIBILITY SameMinorVersion)
    install(FILES cmake/HiresCore.cmake DESTINATION ${config_folder} RENAME hiresConfig.cmake)
    install(FILES ${PROJECT_BINARY_DIR}/hiresConfigVersion.cmake DESTINATION ${config_folder})
    install(DIRECTORY config worlds urdf DESTINATION share/hires USE_SOURCE_PERMISSIONS)
    install(TARGETS hires_program hires_local RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  endif()
  install(TARGETS hires_core EXPORT hires LIBRARY DESTINATION ${library_folder})
  install(EXPORT hires NAMESPACE hires:: FILE hiresTargets.cmake DESTINATION ${config_folder})
  # Headers of what is linked; the others are for the nodes and the program.
  install(DIRECTORY include/hires DESTINATION include
    PATTERN include/hires/cli EXCLUDE PATTERN include/hires/ros EXCLUDE)
endfunction()
