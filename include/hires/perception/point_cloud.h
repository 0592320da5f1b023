#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

namespace hires::perception {

/// What a depth camera measured, in its optical frame (REP-103: z forward, x right, y down), seen
/// from the origin.
struct PointCloud {
  int width{0};   ///< [pixels] of an organised cloud, which is stored row by row from the top left
  int height{1};  ///< [pixels]; 1: not organised
  std::vector<Eigen::Vector3f> points{};  ///< [m], width * height; NaN: nothing measured there
};

inline bool IsMeasured(const Eigen::Vector3f& p_C) { return p_C.allFinite(); }

/// Takes for not measured what no camera measures: points in itself (how some drivers write that
/// nothing was measured) and behind it.
/// @return why the cloud can be of no optical frame: more than a tenth of its points lie behind, or
///         more than a fiftieth ahead but over 65 degrees off the z axis; empty: it may be.
std::string TakeOnlyAhead(PointCloud* cloud);

}  // namespace hires::perception
