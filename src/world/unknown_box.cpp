#include "hires/world/unknown_box.h"

#include <fmt/format.h>

#include <cmath>
#include <regex>
#include <string_view>

#include "hires/base/error.h"
#include "world/solid_object.h"

namespace hires::world {
namespace {

constexpr std::string_view kBegin = "unknown_";

bool IsSize(double length) { return length >= kSmallestSolid && length <= kLargestSolid; }

std::string Bounds() { return fmt::format("from {:g} to {:g} m", kSmallestSolid, kLargestSolid); }

}  // namespace

std::string UnknownBoxModel(const Eigen::Vector3d& size) {
  const Eigen::Vector3d rounded = (size * 1000.0).array().round() / 1000.0;
  for (int axis = 0; axis < 3; ++axis) {
    if (IsSize(rounded[axis])) continue;
    throw base::ConfigError(
        fmt::format("the box of an unknown thing is {:g} x {:g} x {:g} m, "
                    "wanted each {}",
                    size.x(), size.y(), size.z(), Bounds()));
  }
  return fmt::format("{}{:.3f}x{:.3f}x{:.3f}", kBegin, rounded.x(), rounded.y(), rounded.z());
}

bool SaysUnknownBox(const std::string& model) { return model.rfind(kBegin, 0) == 0; }

Eigen::Vector3d SizeOfUnknownBox(const std::string& model) {
  static const std::regex spelling(R"(unknown_(\d{1,2}\.\d{3})x(\d{1,2}\.\d{3})x(\d{1,2}\.\d{3}))");
  std::smatch parts;
  if (std::regex_match(model, parts, spelling)) {
    const Eigen::Vector3d size(std::stod(parts[1]), std::stod(parts[2]), std::stod(parts[3]));
    if (IsSize(size.x()) && IsSize(size.y()) && IsSize(size.z())) return size;
  }
  throw base::ConfigError(
      fmt::format("object model is '{}', wanted depth, width and height of a box, each {}, in "
                  "metres with three decimals, as in unknown_0.120x0.080x0.200",
                  model, Bounds()));
}

ObjectModel MakeUnknownBox(const std::string& model) {
  const Eigen::Vector3d size = SizeOfUnknownBox(model);
  ObjectModel box = SolidObject(geometry::Box{size}, size.z(), kUnknownDensity * size.prod());
  box.name = model;
  return box;
}

}  // namespace hires::world
