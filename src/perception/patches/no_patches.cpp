#include "hires/base/error.h"
#include "perception/patches/convex_patches.h"
#include "perception/patches/ransac_plane.h"

namespace hires::perception {
namespace {

[[noreturn]] void RefuseWithoutPcl() {
  throw base::ConfigError(
      "this program is built without PCL, which tells things on tables apart; ask `hires`, or "
      "install libpcl-dev and build again (scripts/build)");
}

}  // namespace

std::vector<int> FindConvexPatches(const std::vector<Eigen::Vector3f>& /*points*/, int /*width*/,
                                   int /*height*/, const std::vector<int>& /*indices*/,
                                   const PatchParams& /*params*/) {
  RefuseWithoutPcl();
}

std::optional<Eigen::Vector4d> FindPlaneByRansac(const std::vector<Eigen::Vector3d>& /*points*/,
                                                 const Eigen::Vector3d& /*up*/,
                                                 const RansacPlaneParams& /*params*/) {
  RefuseWithoutPcl();
}

}  // namespace hires::perception
