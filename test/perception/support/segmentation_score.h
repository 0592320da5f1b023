#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "hires/perception/point_cloud.h"
#include "hires/perception/table.h"

namespace hires::test_support {

/// How well labels agree with those that people gave. Shares of all points of things (Richtsfeld et
/// al. 2012, "Segmentation of Unknown Objects in Indoor Environments", IROS; weighted overlap:
/// Silberman et al. 2012, ECCV): each thing's best segment is the one that has most of its points.
struct SegmentationScore {
  double num_points{0.0};
  double overlap{0.0};  ///< points of each thing times its best intersection over union
  double inside{0.0};   ///< points of things in their best segment
  double outside{0.0};  ///< points of the best segments beyond their thing

  double WeightedOverlap() const { return overlap / num_points; }
  double OverSegmentation() const { return 1.0 - inside / num_points; }
  double UnderSegmentation() const { return outside / num_points; }
  void Add(const SegmentationScore& other) {
    num_points += other.num_points;
    overlap += other.overlap;
    inside += other.inside;
    outside += other.outside;
  }
};

/// @param truth   of each point: 0 nothing is known, below 20 the table, above it tens are the
/// thing.
/// @param labels  0 nothing, 1 the table, 2, 3, ... things.
inline SegmentationScore ScoreOf(const std::vector<int>& truth, const std::vector<int>& labels) {
  std::map<int, double> of_thing, of_segment;
  std::map<int, std::map<int, double>> both;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (truth[i] == 0) continue;
    if (labels[i] > 1) ++of_segment[labels[i]];
    if (truth[i] < 20) continue;
    ++of_thing[truth[i] / 10];
    if (labels[i] > 1) ++both[truth[i] / 10][labels[i]];
  }
  SegmentationScore score;
  for (const auto& [thing, size] : of_thing) {
    double overlap = 0.0, inside = 0.0, outside = 0.0;
    for (const auto& [segment, common] : both[thing]) {
      overlap = std::max(overlap, common / (size + of_segment[segment] - common));
      if (common <= inside) continue;
      inside = common;
      outside = of_segment[segment] - common;
    }
    score.Add({size, size * overlap, inside, outside});
  }
  return score;
}

/// A plane is the table's if so many of the points that people labelled as the table are so near to
/// it.
constexpr double kTableTolerance = 0.02;  // [m]
constexpr double kMinTableShare = 0.9;

/// Of the points that people labelled as the table, the share within `distance` [m] of its plane; 0
/// if there are none.
/// @param truth  as ScoreOf takes it.
inline double ShareOfTableNear(const perception::Table& table, double distance,
                               const perception::PointCloud& cloud, const std::vector<int>& truth) {
  double near = 0.0, all = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (truth[i] == 0 || truth[i] >= 20 || !perception::IsMeasured(cloud.points[i])) continue;
    near += std::abs(table.HeightOf(cloud.points[i].cast<double>())) <= distance;
    ++all;
  }
  return all > 0.0 ? near / all : 0.0;
}

}  // namespace hires::test_support
