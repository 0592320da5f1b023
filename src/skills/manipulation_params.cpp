#include "hires/skills/manipulation_params.h"

namespace hires::skills {
namespace {

using base::Between;
using base::ParamReader;

JointGoalParams ReadGoal(ParamReader in) {
  JointGoalParams p;
  p.torso_tolerance = in.Get("torso_tolerance", Between(1e-4, 0.1));
  p.arm_tolerance = in.Get("arm_tolerance", Between(1e-4, 0.5));
  p.head_tolerance = in.Get("head_tolerance", Between(1e-4, 0.5));
  p.settling_time = in.Get("settling_time", Between(0.0, 5.0));
  p.time_limit_factor = in.Get("time_limit_factor", Between(1.0, 100.0));
  p.time_limit_surplus = in.Get("time_limit_surplus", Between(0.1, 300.0));
  return p;
}

GripperParams ReadGripper(ParamReader in) {
  GripperParams p;
  p.gap_tolerance = in.Get("gap_tolerance", Between(1e-4, 0.05));
  p.min_held_gap = in.Get("min_held_gap", Between(1e-4, 0.05));
  p.rest_time = in.Get("rest_time", Between(0.05, 5.0));
  p.rest_motion = in.Get("rest_motion", Between(1e-5, 0.01));
  p.time_limit = in.Get("time_limit", Between(0.5, 60.0));
  return p;
}

LookParams ReadLook(ParamReader in) {
  LookParams p;
  p.dwell = in.Get("dwell", Between(0.0, 10.0));
  p.margin = in.Get("margin", Between(0.0, 0.3));
  p.time_limit = in.Get("time_limit", Between(0.1, 60.0));
  p.sightings = in.Get("sightings", Between(1, 100));
  p.search_distance = in.Get("search_distance", Between(0.1, 5.0));
  p.part_spacing = in.Get("part_spacing", Between(0.01, 1.0));
  return p;
}

PickParams ReadPick(ParamReader in) {
  PickParams p;
  p.max_grasps = in.Get("max_grasps", Between(1, 1000));
  p.lift = in.Get("lift", Between(0.01, 0.5));
  p.max_return_tries = in.Get("max_return_tries", Between(1, 100));
  return p;
}

PlaceParams ReadPlace(ParamReader in) {
  PlaceParams p;
  p.area_edge = in.Get("area_edge", Between(0.0, 1.0));
  p.spot_spacing = in.Get("spot_spacing", Between(0.005, 0.5));
  p.clearance = in.Get("clearance", Between(0.0, 0.5));
  p.max_spots = in.Get("max_spots", Between(1, 1000));
  p.headings = in.Get("headings", Between(1, 360));
  p.above = in.Get("above", Between(0.01, 0.5));
  p.release_height = in.Get("release_height", Between(0.0, 0.05));
  p.retreat = in.Get("retreat", Between(0.01, 0.5));
  p.standing_tolerance = in.Get("standing_tolerance", Between(0.001, 0.5));
  p.slot_distance = in.Get("slot_distance", Between(0.01, 1.0));
  return p;
}

manipulation::ArmPathParams ReadPath(ParamReader in) {
  manipulation::ArmPathParams p;
  p.max_iterations = in.Get("max_iterations", Between(1, 1000000));
  p.resolution = in.Get("resolution", Between(0.001, 1.0));
  p.max_goals = in.Get("max_goals", Between(1, 1000));
  p.max_simplifications = in.Get("max_simplifications", Between(0, 100000));
  p.max_held_tilt = in.Get("max_held_tilt", Between(0.01, 3.2));
  return p;
}

manipulation::InverseParams ReadInverse(ParamReader in) {
  manipulation::InverseParams p;
  p.max_tries = in.Get("max_tries", Between(1, 10000));
  p.max_iterations = in.Get("max_iterations", Between(1, 10000));
  p.position_tolerance = in.Get("position_tolerance", Between(1e-7, 0.01));
  p.angle_tolerance = in.Get("angle_tolerance", Between(1e-7, 0.1));
  return p;
}

manipulation::CollisionParams ReadCollision(ParamReader in) {
  manipulation::CollisionParams p;
  p.padding = in.Get("padding", Between(0.0, 0.1));
  p.num_samples = in.Get("num_samples", Between(1, 100000));
  return p;
}

}  // namespace

ManipulationParams ReadManipulationParams(ParamReader in) {
  ManipulationParams p;
  p.period = in.Get("period", Between(0.005, 1.0));
  p.seed = in.Get("seed", Between(0, 2147483647));
  p.speed = in.Get("speed", Between(0.01, 1.0));
  p.straight_speed = in.Get("straight_speed", Between(0.01, 1.0));
  p.straight_step = in.Get("straight_step", Between(0.001, 0.1));
  p.goal = ReadGoal(in.Sub("goal"));
  p.gripper = ReadGripper(in.Sub("gripper"));
  p.look = ReadLook(in.Sub("look"));
  p.pick = ReadPick(in.Sub("pick"));
  p.place = ReadPlace(in.Sub("place"));
  p.path = ReadPath(in.Sub("path"));
  p.inverse = ReadInverse(in.Sub("inverse"));
  p.collision = ReadCollision(in.Sub("collision"));
  return p;
}

}  // namespace hires::skills
