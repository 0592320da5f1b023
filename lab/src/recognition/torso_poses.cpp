#include "lab/src/recognition/torso_poses.h"

#include <algorithm>
#include <set>

#include "hires/base/error.h"
#include "base/parallel.h"
#include "hires/base/text.h"
#include "hires/geometry/angles.h"
#include "hires/perception/depth_sensor.h"
#include "hires/perception/line_of_sight.h"
#include "lab/src/trial/recognition_score.h"
#include "hires/perception/tabletop_recogniser.h"
#include "hires/skills/base_place.h"
#include "hires/skills/grasp_quality.h"
#include "hires/skills/head_aim.h"

namespace hires::lab {
namespace {

using base::Rng;
using geometry::Pose2;
using geometry::Pose3;
using robot::JointPositions;

constexpr const char* kTorsos[] = {"torsodownposture", "torsomiddleposture", "torsoupposture"};
constexpr const char* kArms = "armtosideposture";
constexpr double kAround = 0.05;  // [m] of the area's middle that things stand, each way

template <typename Map>
const typename Map::mapped_type& Find(const Map& map, const std::string& key, const char* what) {
  const auto found = map.find(base::ToLower(key));
  if (found != map.end()) return found->second;
  std::vector<std::string> known;
  for (const auto& one : map) known.push_back(one.first);
  throw base::ConfigError(std::string("torso_poses: ") + base::UnknownName(what, key, known));
}

/// What all trials share.
class PoseStage {
 public:
  explicit PoseStage(const TorsoPosesOrder& order);
  PoseTrial Try(int torso, int base, int kind, int look) const;
  std::vector<std::string> KindNames() const;
  int num_kinds() const { return static_cast<int>(kinds_.size()); }

 private:
  robot::Observation Stand(int torso, int base) const;
  world::ObjectState Put(int kind, int look) const;
  void Recognise(robot::Observation robot, const world::ObjectState& object, const Rng& rng,
                 PoseTrial* trial) const;

  const TorsoPosesOrder& order_;
  const robot::Robot& robot_;
  Pose3 X_MStand_, X_MArea_;
  std::vector<perception::KnownModel> kinds_;
  std::shared_ptr<const perception::Recogniser> recogniser_;
};

PoseStage::PoseStage(const TorsoPosesOrder& order)
    : order_(order),
      robot_(order.setup.scene->robot),
      X_MStand_(Find(order.setup.scene->world.frames, order.stand, "area")),
      X_MArea_(Find(order.setup.scene->world.frames, order.area, "area")),
      recogniser_(std::make_shared<const perception::Recogniser>(order.recogniser.catalogue,
                                                                 order.recogniser.params)) {
  if (!robot_.profile.upper_body || !order.setup.skills->manipulation) {
    throw base::ConfigError("torso_poses: robot '" + robot_.model.name +
                            "' has no arms and no camera (upper_body in its profile)");
  }
  // One of each form: others of it would be the same thing again.
  const perception::RecognitionScore kinds(order.recogniser.catalogue);
  for (const perception::KnownModel& known :
       perception::NoLargerThan(order.recogniser.params.max_extent, order.recogniser.catalogue)) {
    if (kinds.LabelsLike(known.label).front() == known.label) kinds_.push_back(known);
  }
}

std::vector<std::string> PoseStage::KindNames() const {
  std::vector<std::string> names;
  for (const perception::KnownModel& kind : kinds_) names.push_back(kind.label);
  return names;
}

robot::Observation PoseStage::Stand(int torso, int base) const {
  const robot::UpperBodyProfile& body = *robot_.profile.upper_body;
  robot::Observation robot;
  robot.X_MB = skills::AtBasePlace(geometry::Flatten(X_MStand_), skills::BasePlaces()[base].name);
  robot.joints = robot_.profile.joints;
  robot.joints[body.torso_joint] = Find(body.torso_postures, kTorsos[torso], "posture");
  for (const auto& [name, arm] : body.arms) {
    const std::vector<double>& side = Find(arm.postures, kArms, "posture").front();
    for (std::size_t j = 0; j < arm.joints.size(); ++j) robot.joints[arm.joints[j]] = side[j];
  }
  return robot;
}

/// Equal for all poses of the robot, so that they are compared on the same.
world::ObjectState PoseStage::Put(int kind, int look) const {
  Rng rng = Rng(order_.seed)
                .Fork(static_cast<std::uint64_t>(kind))
                .Fork(static_cast<std::uint64_t>(look));
  world::ObjectState object;
  object.name = "thing";
  object.model = kinds_[kind].model->name;
  const double x = rng.Uniform(-kAround, kAround), y = rng.Uniform(-kAround, kAround);
  object.X_MO = X_MArea_ * geometry::Lift(Pose2{x, y, rng.Uniform(-geometry::kPi, geometry::kPi)});
  return object;
}

/// Through the head's camera, turned to the area's middle, as one who does not know yet where on it
/// things stand; the robot's own arms may be in the way.
void PoseStage::Recognise(robot::Observation robot, const world::ObjectState& object,
                          const Rng& rng, PoseTrial* trial) const {
  const robot::UpperBodyProfile& body = *robot_.profile.upper_body;
  const auto head = skills::AimHead(robot_, robot.X_MB, robot.joints, X_MArea_.translation);
  if (!head) return;  // it cannot be looked at from here
  robot.joints[body.head_pan_joint] = head->at(0);
  robot.joints[body.head_tilt_joint] = head->at(1);
  const auto shapes_M = perception::ShapesOf(robot_, robot.X_MB, robot.joints);
  const perception::LineOfSight sight(order_.setup.scene->surroundings, {object}, shapes_M);
  perception::PinholeCamera camera = perception::CameraOf(640, 480, body.camera_width);
  camera.X_MC = perception::ViewOf(robot_, robot.X_MB, robot.joints).X_MC;
  perception::DepthSensorParams sensor;
  sensor.min_range = body.camera_min_range;
  sensor.max_range = body.camera_max_range;
  Rng noise = rng.Fork(0);
  const perception::PointCloud cloud =
      perception::Measure(sight.Look(camera, 2.0 * sensor.max_range), camera, sensor, &noise);
  const Pose3 X_MC = camera.X_MC * perception::OpticalFrame();
  perception::TabletopRecogniser recogniser(recogniser_, {});
  const auto view = recogniser.Look(cloud, X_MC, shapes_M, "", rng.Fork(1));
  if (!view) return;
  constexpr double kSame = 0.1;  // [m]
  for (const perception::Detection& seen : view->sighting.detections) {
    if (((X_MC * seen.X_CO).translation - object.X_MO.translation).norm() > kSame) continue;
    const bool is_right = recogniser_->AreAlike(seen.label, object.model);
    double confidence = is_right ? seen.confidence : 0.0;
    for (const perception::LabelConfidence& other : seen.alternatives)
      if (recogniser_->AreAlike(other.label, object.model)) confidence += other.confidence;
    if (seen.label == perception::kUnknownLabel) confidence = 0.0;
    trial->is_right = trial->is_right || is_right;
    trial->recognised = std::max(trial->recognised, std::min(1.0, confidence));
  }
}

PoseTrial PoseStage::Try(int torso, int base, int kind, int look) const {
  const robot::Observation robot = Stand(torso, base);
  const world::ObjectState object = Put(kind, look);
  const Rng rng = Rng(order_.seed).Fork(1000003u + static_cast<std::uint64_t>(look));
  PoseTrial trial;
  Recognise(robot, object, rng, &trial);
  for (const auto& [arm, profile] : robot_.profile.upper_body->arms) {
    const auto quality = skills::GraspQuality(*order_.setup.skills->manipulation, arm, robot,
                                              object, static_cast<std::uint64_t>(look));
    if (quality) trial.grasp = std::max(trial.grasp.value_or(0.0), *quality);
  }
  return trial;
}

}  // namespace

const PoseTrial& TorsoPosesReport::at(int torso, int base, int kind, int look) const {
  const std::size_t num_bases = bases.size(), num_kinds = kinds.size();
  return trials[((torso * num_bases + base) * num_kinds + kind) * looks + look];
}

std::optional<TorsoPosesReport> PlayTorsoPoses(const TorsoPosesOrder& order,
                                               const base::Crew& crew) {
  const PoseStage stage(order);
  TorsoPosesReport report;
  for (const char* torso : kTorsos) report.torsos.emplace_back(torso);
  for (const skills::BasePlace& place : skills::BasePlaces()) report.bases.push_back(place.name);
  report.kinds = stage.KindNames();
  report.looks = order.looks;
  const int per_base = stage.num_kinds() * order.looks;
  const int per_torso = per_base * static_cast<int>(report.bases.size());
  report.trials.resize(static_cast<std::size_t>(per_torso) * std::size(kTorsos));
  const auto work = [&](int task, const base::Advance& advance) {
    report.trials[task] = stage.Try(task / per_torso, task % per_torso / per_base,
                                    task % per_base / order.looks, task % order.looks);
    advance(1.0);
  };
  const int num_tasks = static_cast<int>(report.trials.size());
  if (!base::DoInParallel(num_tasks, num_tasks, crew, work)) return std::nullopt;
  return report;
}

}  // namespace hires::lab
