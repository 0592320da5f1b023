# Finds class_loader as the target ClassLoader::ClassLoader. Debian's own CMake files of it want
# ament, which belongs to ROS 2; those of ROS 1 know no target.
find_library(ClassLoader_LIBRARY class_loader)
find_path(ClassLoader_INCLUDE class_loader/class_loader.hpp PATH_SUFFIXES class_loader)
find_path(ClassLoader_RCPPUTILS_INCLUDE rcpputils/shared_library.hpp PATH_SUFFIXES rcpputils)
find_path(ClassLoader_RCUTILS_INCLUDE rcutils/shared_library.h PATH_SUFFIXES rcutils)
find_library(ClassLoader_RCPPUTILS_LIBRARY rcpputils)
find_library(ClassLoader_CONSOLE_BRIDGE_LIBRARY console_bridge)
mark_as_advanced(ClassLoader_LIBRARY ClassLoader_INCLUDE ClassLoader_RCPPUTILS_INCLUDE
  ClassLoader_RCUTILS_INCLUDE ClassLoader_RCPPUTILS_LIBRARY
  ClassLoader_CONSOLE_BRIDGE_LIBRARY)

include(FindPackageHandleStandardArgs)
set(FPHSA_NAME_MISMATCHED ON)  # catkin includes this file where it looks for hires
find_package_handle_standard_args(ClassLoader
  REQUIRED_VARS ClassLoader_LIBRARY ClassLoader_INCLUDE ClassLoader_CONSOLE_BRIDGE_LIBRARY)
unset(FPHSA_NAME_MISMATCHED)

if(ClassLoader_FOUND AND NOT TARGET ClassLoader::ClassLoader)
  set(folders ${ClassLoader_INCLUDE})
  set(libraries ${ClassLoader_CONSOLE_BRIDGE_LIBRARY})
  if(ClassLoader_RCPPUTILS_INCLUDE)  # from version 1.3 on
    list(APPEND folders ${ClassLoader_RCPPUTILS_INCLUDE} ${ClassLoader_RCUTILS_INCLUDE})
    list(APPEND libraries ${ClassLoader_RCPPUTILS_LIBRARY})
  endif()
  add_library(ClassLoader::ClassLoader UNKNOWN IMPORTED)
  set_target_properties(ClassLoader::ClassLoader PROPERTIES
    IMPORTED_LOCATION ${ClassLoader_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES "${folders}"
    INTERFACE_LINK_LIBRARIES "${libraries}")
endif()
