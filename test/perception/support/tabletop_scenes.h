#pragma once

#include <string>
#include <vector>

#include "hires/perception/point_cloud.h"

namespace hires::test_support {

/// A scene of the Object Segmentation Database as ../shared/data/tabletop has it.
struct TabletopScene {
  perception::PointCloud cloud;
  std::vector<int> truth;  ///< label of each point, as the database gives it; 0: not measured
};

struct TabletopKind {
  std::string name;
  int first, last;  ///< scene
};
inline const std::vector<TabletopKind> kTabletopKinds{{"boxes", 0, 16},
                                                      {"stacked boxes", 17, 24},
                                                      {"one hides another", 25, 32},
                                                      {"round things", 33, 44}};

/// Of its test scenes, those that are at hand.
inline const std::vector<TabletopKind> kTabletopTestKinds{{"one hides another", 24, 31},
                                                          {"round things", 32, 43},
                                                          {"mixed", 44, 55},
                                                          {"complex", 56, 65}};

/// @param stem  of the scene's pictures: folder/learn12 for learn12_depth.png and
/// learn12_label.png.
/// @throws std::runtime_error that names the file which cannot be read.
TabletopScene ReadTabletopScene(const std::string& stem);

}  // namespace hires::test_support
