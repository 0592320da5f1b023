#include <initializer_list>

#include "hires/base/hash.h"
#include "hires/perception/depth_sensor.h"
#include "hires/world/world.h"
#include "lab/src/recognition/detector_fit.h"

namespace hires::lab {
namespace {

class FitHash {
 public:
  void Add(std::initializer_list<double> values) {
    for (const double value : values) hasher_.Add(value);
  }
  void Add(const perception::RecogniserConfig& recogniser);
  void Add(const perception::SegmentationParams& params);
  void AddSensor();
  void Add(const perception::TableVariety& variety);
  void Add(const robot::Robot& robot);
  std::uint64_t value() const { return hasher_.value(); }

 private:
  base::Hasher hasher_;
};

/// What is seen of the robot and from where; how it drives and grasps is nothing to a fit.
void FitHash::Add(const robot::Robot& robot) {
  hasher_.Add(robot.model.hash);
  const robot::UpperBodyProfile& body = *robot.profile.upper_body;
  Add({body.camera_width, body.camera_height, body.camera_min_range, body.camera_max_range});
  hasher_.Add(body.camera_link);
  hasher_.Add(robot.profile.tray_link);
  for (const auto* numbers : {&body.torso_postures, &robot.profile.joints}) {
    for (const auto& [name, value] : *numbers) {
      hasher_.Add(name);
      hasher_.Add(value);
    }
  }
}

// All members by name: one that is added to a struct and not here does not compile.

void FitHash::Add(const perception::SegmentationParams& params) {
  const auto& [table, surfels, parts, smooth_borders, joining, surface_tolerance, max_below,
               max_above, max_beside] = params;
  Add({surface_tolerance, max_below, max_above, max_beside});
  const auto& [num_samples, tolerance, min_share, max_inclination, min_height, max_height] = table;
  Add({static_cast<double>(num_samples), tolerance, min_share, max_inclination, min_height,
       max_height});
  const auto& [cell, many, max_cell, normal_radius, border_radius] = surfels;
  Add({cell, static_cast<double>(many), max_cell, normal_radius, border_radius});
  const auto& [voxel, seed, max_concavity, max_step, min_supervoxels, min_points] = parts;
  Add({voxel, seed, max_concavity, max_step, static_cast<double>(min_supervoxels),
       static_cast<double>(min_points)});
  const auto& [border_concavity, share, min_bend, min_pairs] = smooth_borders;
  Add({border_concavity, share, min_bend, static_cast<double>(min_pairs)});
  const auto& [min_inward, rim_tolerance, min_same_width, max_rim_gap, min_inner_share, min_floor,
               min_flatness, face_tolerance, same_face, min_same_face, min_gap, min_hidden] =
      joining;
  Add({min_inward, rim_tolerance, min_same_width, max_rim_gap, min_inner_share, min_floor,
       min_flatness, face_tolerance, same_face, min_same_face, min_gap, min_hidden});
}

void FitHash::Add(const perception::RecogniserConfig& recogniser) {
  world::World models;
  for (const perception::KnownModel& known : recogniser.catalogue)
    models.models[known.label] = known.model;
  hasher_.Add(models.ComputeHash());
  const auto& [segmentation, min_quality, sharpness, max_extent] = recogniser.params;
  Add({min_quality, sharpness, max_extent});
  Add(segmentation);
}

void FitHash::AddSensor() {
  const auto& [min_range, max_range, depth_noise, lateral_noise, edge, max_incidence, baseline] =
      perception::DepthSensorParams();
  Add({min_range, max_range, depth_noise, lateral_noise, edge, max_incidence, baseline});
  for (const double z : {1.0, 2.0, 3.0})
    for (const double incidence : {0.0, 1.2}) Add({perception::DepthNoise(z, incidence)});
  const auto& [padding, jump] = perception::SelfFilterParams();
  Add({padding, jump});
}

void FitHash::Add(const perception::TableVariety& variety) {
  const auto& [farthest, most_hidden, gap, table, mount_angle, mount_position] = variety;
  Add({farthest, most_hidden, gap, table.x(), table.y(), table.z(), mount_angle, mount_position});
}

}  // namespace

std::string FitHashOf(const DetectorFitOrder& order) {
  FitHash hash;
  hash.Add(order.robot);
  hash.Add(order.recogniser);
  hash.AddSensor();
  hash.Add(FitVariety());
  return base::HexOf(hash.value());
}

}  // namespace hires::lab
