# One library per layer (hires_<name>), or more where rooms have their own, one benchmark program per
# benchmark file; tests are in HiresTests.cmake. A layer's folders are include/hires/<name>, src/<name>, test/<name>. Headers that
# other layers and packages include are in the first, those of the layer alone beside its sources.

# hires_layer(<name> [SOURCES a.cpp ...] [DEPENDS lower layers and rooms ...] [LINK libraries ...]
#             [LITTLE_OPTIMISED])
# Call it in src/<name>/CMakeLists.txt. A room with a library of its own is <layer>/<room> in DEPENDS; a
# layer that names its own rooms there is linked with them, so that who takes the layer has them all.
function(hires_layer name)
  hires_library(hires_${name} ${ARGN})
endfunction()

# hires_room(<layer> <room> [SOURCES a.cpp ...] [DEPENDS layers and rooms ...] [LINK libraries ...]
# [LITTLE_OPTIMISED]): what stands in src/<layer>/<room>/ as the library hires_<layer>_<room>, for those who need no more of the layer.
function(hires_room layer room)
  cmake_parse_arguments(ROOM "LITTLE_OPTIMISED" "" "SOURCES;DEPENDS;LINK" ${ARGN})
  list(TRANSFORM ROOM_SOURCES PREPEND ${room}/)
  set(optimised)
  if(ROOM_LITTLE_OPTIMISED)
    set(optimised LITTLE_OPTIMISED)
  endif()
  hires_library(hires_${layer}_${room} SOURCES ${ROOM_SOURCES} DEPENDS ${ROOM_DEPENDS} LINK ${ROOM_LINK}
    ${optimised})
  set_property(GLOBAL APPEND PROPERTY HIRES_ROOMS_${layer} hires_${layer}_${room})
endfunction()

function(hires_library target)
  cmake_parse_arguments(LAYER "LITTLE_OPTIMISED" "" "SOURCES;DEPENDS;LINK" ${ARGN})
  set(scope PUBLIC)
  if(LAYER_SOURCES)
    add_library(${target} STATIC ${LAYER_SOURCES})
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    target_compile_options(${target} PRIVATE ${HIRES_WARNINGS})
    hires_compile_together(${target})
    if(LAYER_LITTLE_OPTIMISED)
      target_compile_options(${target} PRIVATE ${HIRES_LITTLE_OPTIMISED})
      set_target_properties(${target} PROPERTIES UNITY_BUILD_BATCH_SIZE ${HIRES_LARGE_LOT})
    endif()
    # Headers beside their sources are included by their path from src/.
    target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src>)
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  target_include_directories(${target} ${scope} ${PROJECT_SOURCE_DIR}/include)
  hires_library_names(depends ${LAYER_DEPENDS})
  target_link_libraries(${target} ${scope} ${depends} ${LAYER_LINK})
endfunction()

# hires_library_names(<variable> <layers and rooms ...>): "navigation/guard" is hires_navigation_guard.
function(hires_library_names variable)
  set(names ${ARGN})
  list(TRANSFORM names REPLACE "/" "_")
  list(TRANSFORM names PREPEND hires_)
  set(${variable} ${names} PARENT_SCOPE)
endfunction()

# hires_compile_together(<target>): its sources are compiled several at a time, in the order in which
# they are listed. Reading headers and instantiating what they define is most of the work, and is done
# once for each lot so.
function(hires_compile_together target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${HIRES_TOGETHER} UNITY_BUILD_BATCH_SIZE 12)
endfunction()

# hires_benchmark(<layer> <file without _benchmark.cpp> [LINK more libraries ...])
function(hires_benchmark layer name)
  if(NOT HIRES_BENCHMARKS)
    return()
  endif()
  cmake_parse_arguments(BENCH "" "FOLDER" "LINK" ${ARGN})
  if(NOT BENCH_FOLDER)
    set(BENCH_FOLDER .)
  endif()
  set(target ${layer}_${name}_benchmark)
  add_executable(${target} ${BENCH_FOLDER}/${name}_benchmark.cpp)
  target_compile_options(${target} PRIVATE ${HIRES_WARNINGS})
  target_compile_definitions(${target} PRIVATE HIRES_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/test
    ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(${target} PRIVATE hires_${layer} ${BENCH_LINK} benchmark::benchmark_main)
endfunction()
