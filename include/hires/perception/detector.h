#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "hires/perception/detector_errors.h"
#include "hires/perception/line_of_sight.h"

namespace hires::perception {

struct DetectorParams {
  double min_visible_share{0.3};  ///< of its surface that faces the camera
  double position_noise{0.005};   ///< [m] sd of each coordinate
  double yaw_noise{0.02};         ///< [rad] sd, about the object's own z axis
  /// Besides that noise it errs as a recogniser was found to do; null: it does not.
  std::shared_ptr<const DetectorErrors> errors{};
  double errors_factor{1.0};     ///< of these: 0 does not err
  std::uint64_t errors_seed{0};  ///< of what stays the same at every look at a thing
};

/// Label of what is none of the known kinds.
inline constexpr char kUnknownLabel[] = "unknown";

struct LabelConfidence {
  std::string label;
  double confidence{0.0};  ///< 0 .. 1
};

/// What a recogniser says of one thing in a picture. It knows kinds; which one of them a thing is,
/// most do not know.
struct Detection {
  std::optional<std::string> instance;  ///< of those who really know
  std::string label;                    ///< kind: a key of World::models
  geometry::Pose3 X_CO;  ///< in the camera's frame: the localisation error is not the detector's
  double visible_share{0.0};
  std::string category{};  ///< concept of the ontology; empty: models that look so differ in it
  double confidence{1.0};  ///< 0 .. 1
  std::vector<LabelConfidence> alternatives{};    ///< what else it may be
  Eigen::Vector3d size{Eigen::Vector3d::Zero()};  ///< [m] of the box around it; 0: not told
  int num_points{0};                              ///< of the cloud that it was seen as
  bool may_be_beside{false};  ///< the table, see Segmentation; false: it is on it, or not told
  /// Of what a recogniser calls unknown: the kind that it is most like, and how good the picture
  /// would be (RecogniserParams::min_quality is wanted); empty: it is like none.
  std::string nearest_label{};
  double nearest_quality{0.0};
  /// Depths are so uncertain there that they tell no kinds apart: none is named.
  bool is_too_far{false};
};

/// What a recogniser says of one picture.
struct Sighting {
  std::vector<Detection> detections{};
  std::vector<Eigen::Vector3d> table{};  ///< corners of what was looked at, counter-clockwise from
                                         ///< above, in the detections' frame; empty: all in view
};

/// Stands in for a camera and a recogniser: which of the true objects are seen, and where.
/// @param objects  true poses; held ones included; all of them known to `sight`.
/// @param rng      the same number of draws for every object, seen or not, so that what hides one
///                 leaves the noise of the others alone.
/// @return in the order of `objects`. What is called by a wrong name, or unknown, has no instance.
std::vector<Detection> Detect(const LineOfSight& sight, const CameraView& true_view,
                              const std::vector<world::ObjectState>& objects,
                              const DetectorParams& params, base::Rng* rng);

}  // namespace hires::perception
