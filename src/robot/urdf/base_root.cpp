#include "robot/urdf/base_root.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

#include "hires/base/text.h"

namespace hires::robot {
namespace {

using geometry::Pose3;

constexpr double kBeside = 1e-6;  // [m] or [rad], from which on a link lies beside another

bool IsBesideRobot(const std::string& name) {
  const std::string lower = base::ToLower(name);
  return lower == "world" || lower == "map" || lower == "odom";
}

bool SaysBase(const std::string& name) {
  const std::string lower = base::ToLower(name);
  return lower.find("base") != std::string::npos || lower.find("footprint") != std::string::npos;
}

/// In the root's frame; nothing where a joint between them moves.
std::optional<Pose3> FixedPoseOf(const RobotModel& model, int link) {
  Pose3 X_RL;
  for (int at = link; at > 0; at = model.links[at].joint->parent) {
    if (model.links[at].joint->type != JointType::kFixed) return std::nullopt;
    X_RL = model.links[at].joint->X_PJ * X_RL;
  }
  return X_RL;
}

bool IsBeside(const Pose3& X_RL) {
  return X_RL.translation.head<2>().norm() > kBeside ||
         std::abs(geometry::YawOf(X_RL.rotation)) > kBeside;
}

struct Wheels {
  int below{0}, beside{0};  ///< joints that turn for ever
};

Wheels WheelsOf(const RobotModel& model, int link) {
  Wheels wheels;
  for (std::size_t i = 1; i < model.links.size(); ++i) {
    if (model.links[i].joint->type != JointType::kContinuous) continue;
    ++(IsBelow(model, static_cast<int>(i), link) ? wheels.below : wheels.beside);
  }
  return wheels;
}

/// The only one, or the one that carries all wheels.
std::optional<int> ChildOfRoot(const RobotModel& model) {
  std::vector<int> children;
  for (std::size_t i = 1; i < model.links.size(); ++i) {
    if (model.links[i].joint->parent == 0) children.push_back(static_cast<int>(i));
  }
  if (children.size() == 1) return children.front();
  for (const int child : children) {
    const Wheels wheels = WheelsOf(model, child);
    if (wheels.below > 0 && wheels.beside == 0) return child;
  }
  return std::nullopt;
}

std::optional<int> BaseOf(const RobotModel& model) {
  if (const auto footprint = model.FindLink("base_footprint")) return footprint;
  const Link& root = model.links.front();
  const bool is_of_no_use =
      IsBesideRobot(root.name) || (root.collisions.empty() && !SaysBase(root.name));
  if (const auto base = model.FindLink("base_link")) {
    const Wheels wheels = WheelsOf(model, *base);
    if (wheels.beside == 0 && (is_of_no_use || wheels.below > 0)) return base;
  }
  return is_of_no_use ? ChildOfRoot(model) : std::nullopt;
}

/// As the model is built: breadth first, children by name.
void TurnRound(int base, RobotModel* model) {
  const std::vector<Link>& old = model->links;
  std::vector<std::vector<std::pair<int, Joint>>> next(old.size());  // link and what carries it
  std::vector<bool> is_above(old.size(), false);
  for (int at = base; at > 0; at = old[at].joint->parent) {
    Joint joint = *old[at].joint;
    joint.X_PJ = joint.X_PJ.Inverse();
    next[at].emplace_back(old[at].joint->parent, std::move(joint));
    is_above[at] = true;
  }
  for (std::size_t i = 1; i < old.size(); ++i) {
    if (!is_above[i]) next[old[i].joint->parent].emplace_back(static_cast<int>(i), *old[i].joint);
  }
  std::vector<Link> links{old[base]};
  links.front().joint.reset();
  std::queue<std::pair<int, int>> waiting;  // index of before, index now
  waiting.emplace(base, 0);
  while (!waiting.empty()) {
    const auto [before, now] = waiting.front();
    waiting.pop();
    std::sort(next[before].begin(), next[before].end(),
              [&](const auto& a, const auto& b) { return old[a.first].name < old[b.first].name; });
    for (auto& [child, joint] : next[before]) {
      waiting.emplace(child, static_cast<int>(links.size()));
      links.push_back(old[child]);
      links.back().joint = std::move(joint);
      links.back().joint->parent = now;
    }
  }
  model->links = std::move(links);
}

std::string Offset(const Pose3& X_RB) {
  return fmt::format("x {:.3f} m, y {:.3f} m, yaw {:.1f} degrees", X_RB.translation.x(),
                     X_RB.translation.y(), geometry::YawOf(X_RB.rotation) * 180.0 / M_PI);
}

/// Where base_link lies beside a root that may be the base as well.
std::string DoubtedRoot(const RobotModel& model) {
  const auto base = model.FindLink("base_link");
  const Link& root = model.links.front();
  if (!base || SaysBase(root.name) || WheelsOf(model, *base).beside > 0) return "";
  const auto X_RB = FixedPoseOf(model, *base);
  if (!X_RB || !IsBeside(*X_RB)) return "";
  return fmt::format(
      "base_link: the root '{}' is taken for the base, though there is a link base_link beside it "
      "({}) that carries no wheels either; name the base in a profile",
      root.name, Offset(*X_RB));
}

}  // namespace

std::string RootAtBase(RobotModel* model) {
  const std::string root = model->links.front().name;
  if (SaysBase(root)) return "";
  const std::optional<int> base = BaseOf(*model);
  if (!base) return DoubtedRoot(*model);
  const std::optional<Pose3> X_RB = FixedPoseOf(*model, *base);
  if (!X_RB || !IsBeside(*X_RB)) return "";
  const std::string name = model->links[*base].name;
  TurnRound(*base, model);
  return fmt::format(
      "base_link: '{}' is the base, not the root '{}' of the URDF, beside which it lies ({}); "
      "poses of the robot are those of '{}'",
      name, root, Offset(*X_RB), name);
}

}  // namespace hires::robot
