#pragma once

#include <string>
#include <vector>

#include "hires/perception/point_cloud.h"

namespace hires::perception {

/// Reads x, y and z of a file of the Point Cloud Data format, version 0.7 or older: text, binary or
/// compressed; other fields are passed over, and so is the viewpoint: what counts is the frame that
/// the points are in. A file that says height > 1 is organised. What PCL's reader takes is taken,
/// but for text lines of too few or too many values, of which PCL makes points at the origin. More
/// points than the header says are left out with a warning; of fields of one name the first counts.
/// @throws base::ConfigError naming the file, and the line or field: no such file, not of this
/// format, lacking x, y or z, shorter than it says, of an absurd size.
PointCloud ReadPcd(const std::string& path);

/// Writes the points with a field `label`, binary; a file of that name is replaced only when the
/// new one is whole.
/// @param labels  of each point.
/// @throws base::ConfigError if the file cannot be written.
void WriteLabelledPcd(const PointCloud& cloud, const std::vector<int>& labels,
                      const std::string& path);

/// The same without labels.
void WritePcd(const PointCloud& cloud, const std::string& path);

}  // namespace hires::perception
