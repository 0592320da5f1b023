#pragma once

#include <optional>
#include <string>

#include "hires/perception/point_cloud.h"

// Files of the Point Cloud Data format as PCL itself reads and writes them: a second road.
namespace hires::perception::test_support {

/// Nothing where PCL refuses the file or finds no points in it, or no x, y and z of floats.
std::optional<PointCloud> ReadByPcl(const std::string& path);

enum class PclFormat { kText, kBinary, kCompressed };

/// With a colour and an intensity of each point beside x, y and z, in fields as PCL pads them.
/// @pre width times height points.
void WriteByPcl(const PointCloud& cloud, PclFormat format, const std::string& path);

}  // namespace hires::perception::test_support
