#pragma once

#include "hires/base/rng.h"
#include "hires/perception/line_of_sight.h"
#include "hires/perception/pinhole_camera.h"
#include "hires/perception/point_cloud.h"
#include "hires/perception/range_picture.h"

namespace hires::perception {

/// Standard deviation [m] of a structured-light camera's depth along its axis, `z` [m] away, on a
/// surface whose normal stands at `incidence` [rad], 0 .. pi / 2, to the ray. [Nguyen, Izadi,
/// Lovell 2012, "Modeling Kinect Sensor Noise for Improved 3D Reconstruction and Tracking",
/// 3DIMPVT, Eq. 3; the second term from 60 degrees on, as there]
double DepthNoise(double z, double incidence = 0.0);

/// What a structured-light camera (Kinect, Asus Xtion) leaves out and blurs.
struct DepthSensorParams {
  double min_range{0.8};      ///< [m] along its axis: data sheet of the Asus Xtion PRO LIVE
  double max_range{3.5};      ///< [m] likewise
  double depth_noise{1.0};    ///< times DepthNoise; 0: depths are exact
  double lateral_noise{0.8};  ///< [pixels] sd by which edges flicker: Nguyen et al., Eq. 2
  double edge{0.03};          ///< [m] step of depth that counts as one
  double max_incidence{1.4};  ///< [rad] more grazing surfaces give nothing: Nguyen et al., Fig. 4
  double baseline{0.075};     ///< [m] from the camera to its projector, on its right
};

/// What the sensor measures of what is there: noise along its axis, edges that flicker, and nothing
/// where it is too near or far, where a surface is too grazing, and in the projector's shadow.
/// Shiny and transparent surfaces count as dull ones.
/// @param rng  the same number of draws for every pixel.
/// @return organised, in the optical frame.
/// @pre the picture is the camera's.
PointCloud Measure(const RangePicture& picture, const PinholeCamera& camera,
                   const DepthSensorParams& params, base::Rng* rng);

/// The same of what the camera looks at.
PointCloud Measure(const LineOfSight& sight, const PinholeCamera& camera,
                   const DepthSensorParams& params, base::Rng* rng);

}  // namespace hires::perception
