#include "geometry/mesh_units.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "hires/base/text.h"

namespace hires::geometry {
namespace {

constexpr double kMillimetre = 0.001, kCentimetre = 0.01;
constexpr double kLargestOfUnit = 100.0;  // [m] of what is no land
constexpr double kTiny = 0.1;  // [m] a thing that is less in millimetres may be in centimetres

std::string SizeText(const Eigen::Vector3d& size) {
  return fmt::format("{:.6g} x {:.6g} x {:.6g} m", size.x(), size.y(), size.z());
}

/// "scale="0.001 0.001 0.001"", on top of the scale that it has.
std::string ScaleText(const Eigen::Vector3d& scale, double factor, const std::string& write) {
  const Eigen::Vector3d wanted = factor * scale;
  const std::string numbers =
      fmt::format("{:.6g} {:.6g} {:.6g}", wanted.x(), wanted.y(), wanted.z());
  std::string text = write;
  return text.replace(text.find("{}"), 2, numbers);
}

}  // namespace

std::string DoubtedUnit(const std::string& path, const TriangleMesh& mesh,
                        const Eigen::Vector3d& scale, const DoubtfulSize& doubtful,
                        const std::string& write) {
  const std::string ending = base::ToLower(std::filesystem::path(path).extension().string());
  Aabb bounds;
  for (const Eigen::Vector3d& p : mesh.vertices) bounds.Include(p);
  const Eigen::Vector3d size = bounds.upper - bounds.lower;
  if (ending == ".dae") {
    if (size.maxCoeff() <= kLargestOfUnit) return "";
    return fmt::format(
        "mesh {} is {} large by the <unit> in it (the metre where it has none); if that is not "
        "meant, correct its <unit>, or write {}, as for mm",
        path, SizeText(size), ScaleText(scale, kMillimetre, write));
  }
  const double reach =
      bounds.lower.head<2>().cwiseAbs().cwiseMax(bounds.upper.head<2>().cwiseAbs()).maxCoeff();
  if (size.z() <= doubtful.height && reach <= doubtful.reach &&
      size.head<2>().maxCoeff() <= doubtful.width) {
    return "";
  }
  std::string text = fmt::format(
      "mesh {} is {} large, as if its unit were not the metre: in mm it would be {}, write {}",
      path, SizeText(size), SizeText(kMillimetre * size), ScaleText(scale, kMillimetre, write));
  if (kMillimetre * size.maxCoeff() < kTiny)
    text += fmt::format(" (in cm {})", ScaleText(scale, kCentimetre, write));
  return text;
}

}  // namespace hires::geometry
