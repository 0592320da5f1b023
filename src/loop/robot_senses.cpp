#include "loop/robot_senses.h"

#include <utility>

namespace hires::loop {
namespace {

using imagination::ImaginationSetup;

std::shared_ptr<const robot::Robot> RobotOf(const ImaginationSetup& setup) {
  return {setup.scene, &setup.scene->robot};
}

std::string CameraOf(const robot::Robot& robot) {
  return robot.profile.upper_body ? robot.profile.upper_body->camera_link : "";
}

}  // namespace

sensing::FrameNames FramesOf(const robot::Robot& robot) {
  return {"map", "odom", robot.profile.base_link};
}

RobotSenses::RobotSenses(const ImaginationSetup& setup, const sensing::FrameNames& frames,
                         std::shared_ptr<const perception::Surroundings> surroundings)
    : names_(frames),
      base_link_(setup.scene->robot.profile.base_link),
      camera_link_(CameraOf(setup.scene->robot)),
      frames_(std::make_shared<FrameRecord>(setup.sensing.robot_state.history)),
      state_(RobotOf(setup), frames, setup.sensing.robot_state, {}, frames_) {
  if (!surroundings) return;
  objects_ = std::make_unique<sensing::ObjectEstimator>(std::move(surroundings), RobotOf(setup),
                                                        setup.sensing.memory, &state_);
}

void RobotSenses::See(double stamp, const perception::Sighting& seen) {
  if (objects_) objects_->OnLook({stamp, camera_link_, seen.detections, seen.table});
}

void RobotSenses::Hear(const SensorNews& news) {
  const auto& readings = news.readings;
  if (news.is_tick) {
    frames_->Tell(names_.map, names_.odometry, news.stamp, geometry::Lift(readings.X_MO));
    state_.OnTransforms(news.stamp);
  }
  if (news.seen) See(news.stamp, *news.seen);
  if (news.tray && objects_) {
    objects_->OnTrayScan(news.stamp, news.tray->frame, news.tray->reading);
  }
  state_.OnJoints(news.stamp, readings.joints);
  state_.OnOdometry(news.stamp, names_.odometry, base_link_, readings.odometry);
}

}  // namespace hires::loop
