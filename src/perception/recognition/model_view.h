#pragma once

#include <vector>

#include "hires/geometry/pose.h"
#include "perception/recognition/cloud_picture.h"
#include "perception/recognition/distance_field.h"

namespace hires::perception {

/// A cloud whose points have labels, as a picture.
struct LabelledPicture {
  const PointCloud& cloud;
  const CloudPicture& picture;
  const std::vector<int>& labels;
};

/// Borders of what is looked at [pixels], the last ones included.
struct PixelWindow {
  void Include(const Eigen::Vector2d& pixel);
  int left{1 << 30}, top{1 << 30}, right{-1}, bottom{-1};
};

struct ModelView {
  double quality{0.0};  ///< 1: the cloud is just what the camera would measure of the model there
  double visible_share{0.0};  ///< of the pixels that the model would cover, not hidden by others
};

/// Compares a cloud with what a camera would measure of a model. Of each pixel that the model would
/// cover, or that a point of the thing lies in, the squared difference in standard deviations of
/// the sensor counts (DepthNoise along the axis; kLateralNoise across), up to 9: the quality is 1
/// minus their mean / 9. Pixels in which something else stands nearer, or nothing was measured, say
/// nothing.
/// @param label   of the thing's points.
/// @param window  around the thing.
ModelView CompareView(const LabelledPicture& seen, int label, PixelWindow window,
                      const DistanceField& model, const geometry::Pose3& X_CO);

/// [pixels] sd by which edges flicker: Nguyen et al. 2012, as DepthSensorParams.
inline constexpr double kLateralNoise = 0.8;

}  // namespace hires::perception
