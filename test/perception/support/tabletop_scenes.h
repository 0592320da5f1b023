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

/// @param stem  of the scene's pictures: folder/learn12 for learn12_depth.png and
/// learn12_label.png.
/// @throws std::runtime_error that names the file which cannot be read.
TabletopScene ReadTabletopScene(const std::string& stem);

}  // namespace hires::test_support
