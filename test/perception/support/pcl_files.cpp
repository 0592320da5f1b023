#include "perception/support/pcl_files.h"

#include <pcl/console/print.h>
#include <pcl/conversions.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cstdint>

namespace hires::perception::test_support {

std::optional<PointCloud> ReadByPcl(const std::string& path) {
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);  // it writes of what it refuses
  pcl::PCLPointCloud2 blob;
  if (pcl::PCDReader().read(path, blob) != 0) return std::nullopt;
  if (blob.width * blob.height == 0) return std::nullopt;  // some of what it refuses is not told
  for (const char* axis : {"x", "y", "z"}) {
    const bool is_there =
        std::any_of(blob.fields.begin(), blob.fields.end(), [axis](const pcl::PCLPointField& f) {
          return f.name == axis && f.datatype == pcl::PCLPointField::FLOAT32 && f.count == 1;
        });
    if (!is_there) return std::nullopt;
  }
  pcl::PointCloud<pcl::PointXYZ> points;
  pcl::fromPCLPointCloud2(blob, points);
  PointCloud cloud;
  cloud.width = static_cast<int>(points.width);
  cloud.height = static_cast<int>(points.height);
  for (const pcl::PointXYZ& p : points.points) cloud.points.emplace_back(p.x, p.y, p.z);
  return cloud;
}

void WriteByPcl(const PointCloud& cloud, PclFormat format, const std::string& path) {
  pcl::PointCloud<pcl::PointXYZRGBNormal> points(static_cast<std::uint32_t>(cloud.width),
                                                 static_cast<std::uint32_t>(cloud.height));
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    points.points[i].getVector3fMap() = cloud.points[i];
    points.points[i].r = static_cast<std::uint8_t>(i);
    points.points[i].curvature = static_cast<float>(i);
  }
  constexpr int kDigits = 9;  // a float is the same after them
  pcl::PCDWriter writer;
  if (format == PclFormat::kText) {
    writer.writeASCII(path, points, kDigits);
  } else if (format == PclFormat::kBinary) {
    writer.writeBinary(path, points);
  } else {
    writer.writeBinaryCompressed(path, points);
  }
}

}  // namespace hires::perception::test_support
