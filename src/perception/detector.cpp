#include "hires/perception/detector.h"

#include <utility>

#include "hires/base/hash.h"
#include "hires/base/text.h"
#include "hires/world/unknown_box.h"

namespace hires::perception {
namespace {

using geometry::Pose3;

/// What the recogniser makes of the true pose.
Pose3 Blurred(const Pose3& X_CO, const DetectorParams& params, base::Rng* rng) {
  Pose3 blurred = X_CO;
  for (int axis = 0; axis < 3; ++axis) {
    blurred.translation[axis] += rng->Normal(0.0, params.position_noise);
  }
  const double turn = rng->Normal(0.0, params.yaw_noise);
  blurred.rotation = X_CO.rotation * geometry::RotationFromRpy(0.0, 0.0, turn);
  return blurred;
}

void CallWrongly(const LineOfSight& sight, const DetectorErrors& errors, const std::string& name,
                 const ThingInView& thing, Detection* detection) {
  detection->instance.reset();
  detection->size = thing.box;
  detection->confidence = errors.confidence;
  if (errors.doubt > 0.0 && !world::SaysUnknownBox(detection->label))
    detection->alternatives = {{detection->label, errors.doubt}};
  detection->label = sight.surroundings().Has(name) ? name : kUnknownLabel;
}

/// @return whether it is told at all.
bool Err(const LineOfSight& sight, const CameraView& view,
         const std::vector<world::ObjectState>& objects, std::size_t index, const VisiblePart& part,
         const DetectorParams& params, const base::Rng& look, Detection* detection) {
  base::Hasher name;
  name.Add(base::ToLower(objects[index].name));
  const ThingInView thing = LookAtThing(sight, view, objects, index, part);
  const Misjudgement wrong = Misjudge(*params.errors, detection->label, thing, params.errors_factor,
                                      look, base::Rng(params.errors_seed).Fork(name.value()));
  if (wrong.is_missed) return false;
  const Eigen::Vector3d up_C = view.X_MC.rotation.conjugate() * Eigen::Vector3d::UnitZ();
  Pose3* X_CO = &detection->X_CO;
  X_CO->translation += SightFrame(X_CO->translation, up_C) * wrong.offset;
  X_CO->rotation = X_CO->rotation * geometry::RotationFromRpy(0.0, 0.0, wrong.turn);
  if (!wrong.called.empty()) CallWrongly(sight, *params.errors, wrong.called, thing, detection);
  return true;
}

}  // namespace

std::vector<Detection> Detect(const LineOfSight& sight, const CameraView& true_view,
                              const std::vector<world::ObjectState>& objects,
                              const DetectorParams& params, base::Rng* rng) {
  std::vector<Detection> detections;
  const Pose3 X_CM = true_view.X_MC.Inverse();
  const bool errs = params.errors && params.errors_factor > 0.0;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const world::ObjectState& object = objects[i];
    const Pose3 X_CO = Blurred(X_CM * object.X_MO, params, rng);
    const base::Rng look = errs ? rng->Split() : base::Rng(0);
    const VisiblePart part = sight.Visible(true_view, object.name);
    if (part.share <= 0.0 || part.share < params.min_visible_share) continue;
    Detection detection;
    detection.instance = object.name;
    detection.label = object.model;
    detection.X_CO = X_CO;
    detection.visible_share = part.share;
    if (errs && !Err(sight, true_view, objects, i, part, params, look, &detection)) continue;
    detections.push_back(std::move(detection));
  }
  return detections;
}

}  // namespace hires::perception
