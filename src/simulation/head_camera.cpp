#include "simulation/head_camera.h"

#include <utility>

#include "hires/base/text.h"
#include "hires/perception/depth_sensor.h"
#include "hires/perception/line_of_sight.h"
#include "simulation/start_checks.h"
#include "simulation/varied.h"

namespace hires::simulation {
namespace {

using geometry::Pose2;
using geometry::Pose3;

constexpr double kLookPeriod = 0.5;                       // [s] between two looks of the camera
constexpr double kStillHead = 0.02;                       // [rad/s] faster than this pictures blur
constexpr int kPictureWidth = 640, kPictureHeight = 480;  // [pixels] of the Asus Xtion

sensing::ObjectMemory EmptyMemory(const std::shared_ptr<const Scene>& scene) {
  return {scene->surroundings, std::shared_ptr<const robot::Robot>(scene, &scene->robot),
          scene->memory};
}

}  // namespace

HeadCamera::HeadCamera(std::shared_ptr<const Scene> scene, const Variation& variation,
                       const PlanarRobot* robot, const base::Rng& rng)
    : scene_(std::move(scene)),
      variation_(variation),
      robot_(robot),
      state_{rng, EmptyMemory(scene_)} {
  if (scene_->sight.recogniser)
    eye_.emplace(scene_->sight.recogniser, perception::SelfFilterParams());
}

sensing::BodyReading HeadCamera::FeltBody(double time, const Pose2& X_MBbelieved) const {
  return {time, X_MBbelieved, robot_->Joints()};
}

bool HeadCamera::IsHeld(const std::string& name) const {
  const auto known = state_.memory.objects().find(base::ToLower(name));
  return known != state_.memory.objects().end() && known->second.is_held;
}

void HeadCamera::Remember(const std::vector<robot::SeenObject>& objects,
                          const Pose2& X_MBbelieved) {
  for (const robot::SeenObject& object : objects) {
    if (IsHeld(object.name)) continue;
    const Pose3 X_BO = geometry::Lift(X_MBbelieved).Inverse() * object.X_MO;
    const auto model = scene_->world.RequireModel(object.model);
    const bool rides_along = StandsOn(scene_->base_shapes_B, model->collisions, X_BO);
    state_.memory.Believe(object.name, object.model,
                          rides_along ? scene_->robot.profile.base_link : "",
                          rides_along ? X_BO : object.X_MO);
  }
}

void HeadCamera::KnowHeld(const std::string& name, const std::string& model,
                          const std::string& link, const Pose3& X_LO) {
  state_.memory.Believe(name, model, link, X_LO);
}

void HeadCamera::Feel(double time, const Pose2& X_MBbelieved) {
  state_.memory.Feel(FeltBody(time, X_MBbelieved));
}

bool HeadCamera::MayLook(double time) const {
  return time - state_.last_look >= kLookPeriod && !robot_->IsHeadFaster(kStillHead);
}

perception::Sighting HeadCamera::Detect(const perception::LineOfSight& sight, const Pose3& X_MC,
                                        const std::vector<world::ObjectState>& objects) {
  perception::DetectorParams params;
  params.position_noise = variation_.detection_noise;
  params.yaw_noise = variation_.detection_noise_yaw;
  params.errors = scene_->sight.errors;
  params.errors_factor = variation_.recognition_errors;
  params.errors_seed = state_.rng.seed();
  const perception::CameraView view = perception::ViewFrom(scene_->robot, X_MC);
  return {perception::Detect(sight, view, objects, params, &state_.rng), {}};
}

/// The camera is where it really is; what the robot makes of its cloud stands where it believes
/// itself and its joints to be.
perception::Sighting HeadCamera::Recognise(const perception::LineOfSight& sight, const Pose3& X_MC,
                                           const sensing::BodyReading& body, base::Rng rng) {
  const robot::Robot& robot = scene_->robot;
  const robot::UpperBodyProfile& upper = *robot.profile.upper_body;
  perception::PinholeCamera camera =
      perception::CameraOf(kPictureWidth, kPictureHeight, upper.camera_width);
  camera.X_MC = X_MC;
  perception::DepthSensorParams sensor;
  sensor.min_range = upper.camera_min_range;
  sensor.max_range = upper.camera_max_range;
  sensor.depth_noise *= variation_.recognition_errors;
  sensor.lateral_noise *= variation_.recognition_errors;
  const Pose3 X_CO = perception::OpticalFrame();
  auto seen =
      eye_->Look(Measure(sight, camera, sensor, &rng),
                 perception::ViewOf(robot, body.X_MB, body.joints).X_MC * X_CO,
                 perception::ShapesOf(robot, body.X_MB, body.joints), robot.profile.tray_link, rng);
  return seen ? perception::SeenFrom(X_CO, std::move(seen->sighting)) : perception::Sighting();
}

void HeadCamera::Look(double time, const Pose2& X_MB, const std::optional<Pose2>& error,
                      const std::vector<world::ObjectState>& objects) {
  state_.last_look = time;
  const Pose3 X_MC = robot_->X_MLink(scene_->robot.profile.upper_body->camera_link);
  const perception::LineOfSight sight(scene_->surroundings, objects, robot_->ShapesInMap());
  perception::Sighting seen;
  if (!eye_) seen = Detect(sight, X_MC, objects);
  const sensing::BodyReading body =
      FeltBody(time, error ? X_MB * *error : BelievedPose(X_MB, variation_, &state_.rng));
  if (eye_) seen = Recognise(sight, X_MC, body, state_.rng.Split());
  if (eye_ && seen.table.empty()) return;  // no table is in sight: it says nothing of things
  state_.memory.Look(body, seen.detections, seen.table);
}

std::vector<robot::SeenObject> HeadCamera::Known(double time, const Pose2& X_MBbelieved) const {
  return state_.memory.Known(FeltBody(time, X_MBbelieved));
}

}  // namespace hires::simulation
