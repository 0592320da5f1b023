#include "hires/base/error.h"
#include "perception/patches/convex_patches.h"

namespace hires::perception {

std::vector<int> FindConvexPatches(const std::vector<Eigen::Vector3f>& /*points*/, int /*width*/,
                                   int /*height*/, const std::vector<int>& /*indices*/,
                                   const PatchParams& /*params*/) {
  throw base::ConfigError(
      "this program is built without PCL, which tells things on tables apart; ask `hires`, or "
      "install libpcl-dev and build again (scripts/build)");
}

}  // namespace hires::perception
