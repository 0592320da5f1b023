#pragma once

#include <map>
#include <string>
#include <vector>

#include "hires/sensing/object_memory.h"

namespace hires::sensing {

inline constexpr double kFloor = 0.3;  ///< [m] up to which an object stands on it

geometry::Aabb BoundsOf(const std::vector<geometry::Collision>& collisions);
bool Contains(const std::vector<std::string>& names, const std::string& name);

/// Where the robot's links are in the map; worked out when somebody asks for one of them, as
/// most moments change nothing.
class ObjectMemory::Links {
 public:
  /// Both outlive it.
  Links(const robot::Robot& robot, const BodyReading& body) : robot_(robot), body_(body) {}

  geometry::Pose3 X_ML(const std::string& link) const;

 private:
  void Place() const;

  const robot::Robot& robot_;
  const BodyReading& body_;
  mutable std::vector<geometry::Pose3> X_RL_;
  mutable geometry::Pose3 X_MR_;
};

/// What a detection is given to; no name: to nobody.
struct ObjectMemory::Named {
  std::string name{}, model{};
  bool is_ambiguous{false};
};

struct ObjectMemory::LookedAt {
  geometry::Pose3 X_MO(std::size_t i) const { return view.X_MC * detections[i].X_CO; }
  bool Covers(const Eigen::Vector3d& p_M) const;

  const perception::CameraView& view;
  const std::vector<perception::Detection>& detections;
  std::vector<Eigen::Vector3d> table_M;
};

}  // namespace hires::sensing
