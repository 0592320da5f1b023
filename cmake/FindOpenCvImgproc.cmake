# Finds OpenCV's image processing as the target OpenCV::Imgproc. Debian's OpenCVConfig.cmake comes with
# libopencv-dev alone, which brings all of OpenCV with a hundred packages that it needs.
find_path(OpenCvImgproc_INCLUDE opencv2/imgproc.hpp PATH_SUFFIXES opencv4)
find_library(OpenCvImgproc_LIBRARY opencv_imgproc)
find_library(OpenCvImgproc_CORE_LIBRARY opencv_core)
mark_as_advanced(OpenCvImgproc_INCLUDE OpenCvImgproc_LIBRARY OpenCvImgproc_CORE_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenCvImgproc
  REQUIRED_VARS OpenCvImgproc_LIBRARY OpenCvImgproc_CORE_LIBRARY OpenCvImgproc_INCLUDE)

if(OpenCvImgproc_FOUND AND NOT TARGET OpenCV::Imgproc)
  add_library(OpenCV::Imgproc UNKNOWN IMPORTED)
  set_target_properties(OpenCV::Imgproc PROPERTIES
    IMPORTED_LOCATION ${OpenCvImgproc_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${OpenCvImgproc_INCLUDE}
    INTERFACE_LINK_LIBRARIES ${OpenCvImgproc_CORE_LIBRARY})
endif()
