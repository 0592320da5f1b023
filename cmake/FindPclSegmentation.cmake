# Finds PCL's segmentation as the target PCL::Segmentation, and where it is there the reader of its files, which
# links VTK, as PCL::Io. Debian's PCLConfig.cmake wants VTK and Qt, too.
find_path(PclSegmentation_INCLUDE pcl/segmentation/lccp_segmentation.h
  PATH_SUFFIXES pcl-1.14 pcl-1.13 pcl-1.12 pcl-1.11 pcl-1.10)
set(PclSegmentation_LIBRARIES)
foreach(part segmentation sample_consensus search kdtree octree common)
  find_library(PclSegmentation_${part}_LIBRARY pcl_${part})
  mark_as_advanced(PclSegmentation_${part}_LIBRARY)
  list(APPEND PclSegmentation_LIBRARIES ${PclSegmentation_${part}_LIBRARY})
endforeach()
mark_as_advanced(PclSegmentation_INCLUDE)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(PclSegmentation
  REQUIRED_VARS PclSegmentation_segmentation_LIBRARY PclSegmentation_sample_consensus_LIBRARY
    PclSegmentation_search_LIBRARY PclSegmentation_kdtree_LIBRARY PclSegmentation_octree_LIBRARY
    PclSegmentation_common_LIBRARY PclSegmentation_INCLUDE)

if(PclSegmentation_FOUND AND NOT TARGET PCL::Segmentation)
  add_library(PCL::Segmentation INTERFACE IMPORTED)
  set_target_properties(PCL::Segmentation PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES ${PclSegmentation_INCLUDE}
    INTERFACE_LINK_LIBRARIES "${PclSegmentation_LIBRARIES};Eigen3::Eigen")
endif()

find_library(PclSegmentation_io_LIBRARY pcl_io)
mark_as_advanced(PclSegmentation_io_LIBRARY)
if(PclSegmentation_FOUND AND PclSegmentation_io_LIBRARY AND NOT TARGET PCL::Io)
  add_library(PCL::Io INTERFACE IMPORTED)
  set_target_properties(PCL::Io PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES ${PclSegmentation_INCLUDE}
    INTERFACE_LINK_LIBRARIES "${PclSegmentation_io_LIBRARY};PCL::Segmentation")
endif()
