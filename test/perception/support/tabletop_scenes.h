#pragma once

#include <string>
#include <vector>

#include "hires/perception/point_cloud.h"

namespace hires::test_support {

/// A scene of the Object Segmentation Database as ../shared/data/tabletop has it.
struct TabletopScene {
  perception::PointCloud cloud;
  std::vector<int> truth;  ///< label of each point, as the database gives it
};

struct TabletopKind {
  std::string name;
  int first, last;  ///< scene
};
inline const std::vector<TabletopKind> kTabletopKinds{{"boxes", 0, 16},
                                                      {"stacked boxes", 17, 24},
                                                      {"one hides another", 25, 32},
                                                      {"round things", 33, 44}};

/// @throws std::runtime_error that names the file which cannot be read.
TabletopScene ReadTabletopScene(const std::string& folder, int index);

}  // namespace hires::test_support
