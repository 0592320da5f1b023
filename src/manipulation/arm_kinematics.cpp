#include "hires/manipulation/arm_kinematics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <limits>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/rng.h"
#include "hires/base/text.h"
#include "hires/geometry/angles.h"
#include "manipulation/inverse_iteration.h"
#include "manipulation/kdl_conversions.h"
#include "manipulation/link_tree.h"

namespace hires::manipulation {
namespace {

using geometry::Pose3;
using robot::Joint;
using robot::JointType;

constexpr double kSameSolution = 0.05;  // [rad] largest joint difference of two that count as one

[[noreturn]] void Fail(const robot::Robot& robot, const std::string& arm, const std::string& what) {
  throw base::ConfigError(fmt::format("robot '{}', arm '{}': {}", robot.model.name, arm, what));
}

const robot::ArmProfile& FindArm(const robot::Robot& robot, const std::string& arm) {
  if (!robot.profile.upper_body) Fail(robot, arm, "the profile has no upper_body: it has no arms");
  const auto& arms = robot.profile.upper_body->arms;
  const auto found = arms.find(arm);
  if (found != arms.end()) return found->second;
  std::vector<std::string> known;
  for (const auto& [name, profile] : arms) known.push_back(name);
  Fail(robot, arm, base::UnknownName("arm", arm, known));
}

int LinkIndex(const robot::Robot& robot, const std::string& arm, const std::string& link) {
  const auto index = robot.model.FindLink(link);
  if (!index) Fail(robot, arm, base::UnknownName("link", link, robot.model.LinkNames()));
  return *index;
}

/// Links from the one that the arm's first joint moves to the tool.
std::vector<int> LinksToTool(const robot::Robot& robot, const std::string& arm,
                             const robot::ArmProfile& profile) {
  std::vector<int> links;
  for (int i = LinkIndex(robot, arm, profile.tool_link);;) {
    const auto& joint = robot.model.links[i].joint;
    if (!joint || profile.joints.empty()) break;
    links.insert(links.begin(), i);
    if (joint->name == profile.joints.front()) return links;
    i = joint->parent;
  }
  Fail(robot, arm,
       fmt::format("tool link '{}' does not hang on the arm's first joint '{}'; list the joints "
                   "from the shoulder to the wrist",
                   profile.tool_link, profile.joints.empty() ? "" : profile.joints.front()));
}

KDL::Segment SegmentOf(const robot::Link& link) {
  const Joint& joint = *link.joint;
  const KDL::Frame X_PJ = ToKdl(joint.X_PJ);
  if (joint.type == JointType::kFixed) {
    return KDL::Segment(link.name, KDL::Joint(KDL::Joint::None), X_PJ);
  }
  const auto type =
      joint.type == JointType::kPrismatic ? KDL::Joint::TransAxis : KDL::Joint::RotAxis;
  return KDL::Segment(link.name, KDL::Joint(joint.name, X_PJ.p, X_PJ.M * ToKdl(joint.axis), type),
                      X_PJ);
}

double Distance(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return (a - b).lpNorm<Eigen::Infinity>();
}

ArmJoints ToJoints(const Eigen::VectorXd& v) { return {v.data(), v.data() + v.size()}; }

Eigen::VectorXd ToVector(const ArmJoints& joints) {
  return Eigen::Map<const Eigen::VectorXd>(joints.data(), joints.size());
}

}  // namespace

struct ArmKinematics::Impl {
  Impl(const robot::Robot& robot_in, const std::string& arm_in);
  void AddJoint(const Joint& joint);
  /// Root of the chain (the torso) in the base frame.
  Pose3 RootPose(const robot::JointPositions& posture) const;
  Eigen::VectorXd DrawStart(const Eigen::VectorXd& near, base::Rng* rng) const;
  /// Continuous joints at the turn that is nearest to `near`.
  Eigen::VectorXd Wrapped(Eigen::VectorXd joints, const Eigen::VectorXd& near) const;
  void CheckSize(const ArmJoints& given) const {
    HIRES_CHECK(given.size() == joints.size(), "one value per joint of the arm");
  }

  LinkTree tree;
  std::string arm;
  std::vector<std::string> joints;
  int root{0};  // link that carries the first joint
  int base{0};
  KDL::Chain chain;
  ArmJoints lower, upper;
};

ArmKinematics::Impl::Impl(const robot::Robot& robot, const std::string& arm_in)
    : tree(robot.model), arm(arm_in) {
  const robot::ArmProfile& profile = FindArm(robot, arm);
  const std::vector<int> links = LinksToTool(robot, arm, profile);
  root = robot.model.links[links.front()].joint->parent;
  base = LinkIndex(robot, arm, robot.profile.base_link);
  for (const int i : links) {
    const robot::Link& link = robot.model.links[i];
    chain.addSegment(SegmentOf(link));
    if (link.joint->type != JointType::kFixed) AddJoint(*link.joint);
  }
  if (joints == profile.joints) return;
  Fail(robot, arm,
       fmt::format("joints are listed as {}, the way to '{}' passes {}; list exactly these",
                   base::Join(profile.joints, " "), profile.tool_link, base::Join(joints, " ")));
}

void ArmKinematics::Impl::AddJoint(const Joint& joint) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const bool is_limited = joint.type != JointType::kContinuous && joint.limits;
  joints.push_back(joint.name);
  lower.push_back(is_limited ? joint.limits->lower : -kInfinity);
  upper.push_back(is_limited ? joint.limits->upper : kInfinity);
}

Pose3 ArmKinematics::Impl::RootPose(const robot::JointPositions& posture) const {
  std::vector<Eigen::Isometry3d> X_R;
  tree.Compute(posture, &X_R);
  const Eigen::Isometry3d X_BS = X_R[base].inverse() * X_R[root];
  return {X_BS.translation(), Eigen::Quaterniond(X_BS.linear()).normalized()};
}

Eigen::VectorXd ArmKinematics::Impl::DrawStart(const Eigen::VectorXd& near, base::Rng* rng) const {
  Eigen::VectorXd start(near.size());
  for (Eigen::Index i = 0; i < start.size(); ++i) {
    const bool is_limited = std::isfinite(lower[i]);
    start[i] = is_limited ? rng->Uniform(lower[i], upper[i])
                          : rng->Uniform(near[i] - geometry::kPi, near[i] + geometry::kPi);
  }
  return start;
}

Eigen::VectorXd ArmKinematics::Impl::Wrapped(Eigen::VectorXd q, const Eigen::VectorXd& near) const {
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    if (!std::isfinite(lower[i])) q[i] = near[i] + geometry::WrapToPi(q[i] - near[i]);
  }
  return q;
}

ArmKinematics::ArmKinematics(const robot::Robot& robot, const std::string& arm)
    : impl_(std::make_unique<Impl>(robot, arm)) {}
ArmKinematics::~ArmKinematics() = default;
ArmKinematics::ArmKinematics(ArmKinematics&&) noexcept = default;

const std::string& ArmKinematics::arm() const { return impl_->arm; }
const std::vector<std::string>& ArmKinematics::joint_names() const { return impl_->joints; }
const ArmJoints& ArmKinematics::lower() const { return impl_->lower; }
const ArmJoints& ArmKinematics::upper() const { return impl_->upper; }

Pose3 ArmKinematics::ToolPose(const robot::JointPositions& posture, const ArmJoints& joints) const {
  impl_->CheckSize(joints);
  const KDL::Chain chain = impl_->chain;  // of this call alone: see InverseIteration
  KDL::ChainFkSolverPos_recursive forward(chain);
  KDL::JntArray q(joints.size());
  q.data = ToVector(joints);
  KDL::Frame X_ST;
  forward.JntToCart(q, X_ST);
  return impl_->RootPose(posture) * FromKdl(X_ST);
}

std::vector<ArmJoints> ArmKinematics::Solve(const robot::JointPositions& posture, const Pose3& X_BT,
                                            const ArmJoints& near, std::uint64_t seed,
                                            const InverseParams& params) const {
  impl_->CheckSize(near);
  const Eigen::VectorXd lower = ToVector(impl_->lower), upper = ToVector(impl_->upper);
  const Eigen::VectorXd near_v = ToVector(near).cwiseMax(lower).cwiseMin(upper);
  const KDL::Frame goal = ToKdl(impl_->RootPose(posture).Inverse() * X_BT);
  InverseIteration iteration(impl_->chain, lower, upper, params);
  base::Rng rng(seed);
  std::vector<Eigen::VectorXd> found;
  for (int i = 0; i < params.max_tries; ++i) {
    const auto q = iteration.Run(goal, i == 0 ? near_v : impl_->DrawStart(near_v, &rng));
    if (!q) continue;
    const Eigen::VectorXd wrapped = impl_->Wrapped(*q, near_v);
    const auto is_same = [&](const auto& v) { return Distance(v, wrapped) < kSameSolution; };
    if (std::none_of(found.begin(), found.end(), is_same)) found.push_back(wrapped);
  }
  std::stable_sort(found.begin(), found.end(), [&](const auto& a, const auto& b) {
    return Distance(a, near_v) < Distance(b, near_v);
  });
  std::vector<ArmJoints> solutions;
  for (const Eigen::VectorXd& q : found) solutions.push_back(ToJoints(q));
  return solutions;
}

ArmJoints ArmKinematics::JointsOf(const robot::JointPositions& posture) const {
  ArmJoints joints;
  for (std::size_t i = 0; i < impl_->joints.size(); ++i) {
    const auto found = posture.find(impl_->joints[i]);
    joints.push_back(found == posture.end() ? std::clamp(0.0, impl_->lower[i], impl_->upper[i])
                                            : found->second);
  }
  return joints;
}

void ArmKinematics::SetJoints(const ArmJoints& joints, robot::JointPositions* posture) const {
  impl_->CheckSize(joints);
  for (std::size_t i = 0; i < joints.size(); ++i) (*posture)[impl_->joints[i]] = joints[i];
}

}  // namespace hires::manipulation
