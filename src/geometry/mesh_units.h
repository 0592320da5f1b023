#pragma once

#include <Eigen/Core>
#include <string>

#include "hires/geometry/shape.h"

namespace hires::geometry {

/// From what size on a mesh is hardly meant to be in metres.
struct DoubtfulSize {
  double height{50.0};  ///< [m]
  double reach{200.0};  ///< [m] from its origin along x or y
  double width{1e300};  ///< [m] along x or y
};

/// Whether a mesh is so large that its file may be in millimetres or centimetres: a sentence with
/// file, size and the factor that would make sense; "" where it is not. One that says its unit
/// (.dae) is believed up to 100 m. Nothing is scaled.
/// @param mesh   as it was read with `scale`.
/// @param write  how the file that names it gives a scale, "{}" for the numbers:
/// "<scale>{}</scale>"
std::string DoubtedUnit(const std::string& path, const TriangleMesh& mesh,
                        const Eigen::Vector3d& scale, const DoubtfulSize& doubtful,
                        const std::string& write);

}  // namespace hires::geometry
