#include "robot/urdf_conversion.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <queue>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/text.h"
#include "hires/geometry/mesh_reader.h"
#include "robot/mesh_path.h"

namespace hires::robot {
namespace {

using geometry::Pose3;

constexpr double kMaxLength = 1e3;  // [m] of any offset or shape: beyond lies a slip of units

Eigen::Vector3d ToVector(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

Pose3 ToPose(const urdf::Pose& pose) {
  double x, y, z, w;
  pose.rotation.getQuaternion(x, y, z, w);
  return {ToVector(pose.position), Eigen::Quaterniond(w, x, y, z).normalized()};
}

/// Turns the parser's model into ours, checking what the parser lets pass.
class ModelBuilder {
 public:
  ModelBuilder(const urdf::ModelInterface& urdf, const UrdfOutline& outline,
               const std::string& where)
      : urdf_(urdf), outline_(outline), where_(where) {}

  RobotModel Build() {
    model_.name = urdf_.getName();
    AddTree();
    CheckMimics();
    WarnOfImpossibleInertias();
    return std::move(model_);
  }

 private:
  [[noreturn]] void FailLink(const std::string& link, const std::string& what) const {
    throw base::ConfigError(fmt::format("{}: link '{}': {}; line {}", where_, link, what,
                                        outline_.link_lines.at(link)));
  }
  [[noreturn]] void FailJoint(const std::string& joint, const std::string& what) const {
    throw base::ConfigError(fmt::format("{}: joint '{}': {}; line {}", where_, joint, what,
                                        outline_.joint_lines.at(joint)));
  }

  /// Breadth first, children by name: the order does not depend on the file's.
  void AddTree() {
    std::queue<std::pair<std::string, int>> waiting;  // link, index of its parent
    waiting.emplace(urdf_.getRoot()->name, -1);
    while (!waiting.empty()) {
      const auto [name, parent] = waiting.front();
      waiting.pop();
      const urdf::Link& source = *urdf_.getLink(name);
      model_.links.push_back(ToLink(source, parent));
      std::vector<std::string> children;
      for (const auto& child : source.child_links) children.push_back(child->name);
      std::sort(children.begin(), children.end());
      const int index = static_cast<int>(model_.links.size()) - 1;
      for (const std::string& child : children) waiting.emplace(child, index);
    }
  }

  Link ToLink(const urdf::Link& source, int parent) {
    Link link;
    link.name = source.name;
    if (source.parent_joint) link.joint = ToJoint(*source.parent_joint, parent);
    if (source.inertial) link.inertial = ToMass(source.name, *source.inertial);
    const auto friction = outline_.friction.find(source.name);
    for (const auto& collision : source.collision_array) {
      link.collisions.push_back(ToCollision(source.name, *collision));
      if (friction != outline_.friction.end()) link.collisions.back().friction = friction->second;
    }
    return link;
  }

  Joint ToJoint(const urdf::Joint& source, int parent) const {
    Joint joint;
    joint.name = source.name;
    joint.type = ToType(source);
    joint.parent = parent;
    joint.X_PJ = ToPose(source.parent_to_joint_origin_transform);
    const std::string far = WhyBadPose(joint.X_PJ);
    if (!far.empty()) FailJoint(joint.name, "its origin " + far);
    if (joint.type == JointType::kFixed) return joint;
    joint.axis = ToAxis(source);
    if (source.limits) joint.limits = ToLimits(source);
    if (source.mimic) {
      joint.mimics = source.mimic->joint_name;
      joint.mimic_multiplier = source.mimic->multiplier;
      joint.mimic_offset = source.mimic->offset;
    }
    return joint;
  }

  JointType ToType(const urdf::Joint& source) const {
    switch (source.type) {
      case urdf::Joint::FIXED:
        return JointType::kFixed;
      case urdf::Joint::REVOLUTE:
        return JointType::kRevolute;
      case urdf::Joint::CONTINUOUS:
        return JointType::kContinuous;
      case urdf::Joint::PRISMATIC:
        return JointType::kPrismatic;
      default:
        FailJoint(source.name,
                  "floating and planar joints are not supported; the base moves by itself, so "
                  "make it fixed, or revolute, continuous or prismatic");
    }
  }

  Eigen::Vector3d ToAxis(const urdf::Joint& source) const {
    const Eigen::Vector3d axis = ToVector(source.axis);
    const double length = axis.norm();
    if (!(length > 1e-6) || !std::isfinite(length)) {
      FailJoint(source.name,
                fmt::format("its axis is ({}, {}, {}), wanted a direction such as 0 0 1", axis.x(),
                            axis.y(), axis.z()));
    }
    return axis / length;
  }

  JointLimits ToLimits(const urdf::Joint& source) const {
    const urdf::JointLimits& in = *source.limits;
    if (!(in.lower <= in.upper)) {
      FailJoint(source.name,
                fmt::format("its lower limit {} is above its upper limit {}; swap them", in.lower,
                            in.upper));
    }
    if (!(in.velocity >= 0.0) || !(in.effort >= 0.0)) {
      FailJoint(source.name, fmt::format("its limits are velocity {} and effort {}, wanted numbers "
                                         "of at least 0",
                                         in.velocity, in.effort));
    }
    return {in.lower, in.upper, in.velocity, in.effort};
  }

  static std::string WhyBadPose(const Pose3& pose) {
    if (pose.IsFinite() && pose.translation.cwiseAbs().maxCoeff() <= kMaxLength) return "";
    return fmt::format("({}, {}, {}) is not finite or beyond {} m; lengths are metres",
                       pose.translation.x(), pose.translation.y(), pose.translation.z(),
                       kMaxLength);
  }

  geometry::MassProperties ToMass(const std::string& link, const urdf::Inertial& in) const {
    const Pose3 X_LI = ToPose(in.origin);
    Eigen::Matrix3d inertia;
    inertia << in.ixx, in.ixy, in.ixz, in.ixy, in.iyy, in.iyz, in.ixz, in.iyz, in.izz;
    const Eigen::Matrix3d turn = X_LI.rotation.toRotationMatrix();
    const Eigen::Matrix3d turned = turn * inertia * turn.transpose();
    const geometry::MassProperties mass{in.mass, X_LI.translation,
                                        0.5 * (turned + turned.transpose())};
    const std::string far = WhyBadPose(X_LI);
    if (!far.empty()) FailLink(link, "its centre of mass " + far);
    if (!(in.mass > 0.0) || !inertia.allFinite() ||
        Eigen::LLT<Eigen::Matrix3d>(inertia).info() != Eigen::Success) {
      FailLink(link,
               geometry::WhyUnphysical(mass) + "; a frame without mass has no <inertial> at all");
    }
    return mass;
  }

  geometry::Collision ToCollision(const std::string& link, const urdf::Collision& source) {
    if (!source.geometry) FailLink(link, "a <collision> has no <geometry>; add a shape");
    geometry::Collision collision;
    collision.name = source.name;
    collision.X_BS = ToPose(source.origin);
    const std::string far = WhyBadPose(collision.X_BS);
    if (!far.empty()) FailLink(link, "a <collision>'s origin " + far);
    collision.shape = ToShape(link, *source.geometry);
    return collision;
  }

  double Length(const std::string& link, const char* what, double value) const {
    if (value > 0.0 && value <= kMaxLength) return value;
    FailLink(link, fmt::format("a collision shape's {} is {} m, wanted above 0 and at most {}",
                               what, value, kMaxLength));
  }

  geometry::Shape ToShape(const std::string& link, const urdf::Geometry& source) {
    switch (source.type) {
      case urdf::Geometry::BOX: {
        const urdf::Vector3& size = static_cast<const urdf::Box&>(source).dim;
        return geometry::Box{{Length(link, "length", size.x), Length(link, "width", size.y),
                              Length(link, "height", size.z)}};
      }
      case urdf::Geometry::CYLINDER: {
        const auto& cylinder = static_cast<const urdf::Cylinder&>(source);
        return geometry::Cylinder{Length(link, "radius", cylinder.radius),
                                  Length(link, "length", cylinder.length)};
      }
      case urdf::Geometry::SPHERE:
        return geometry::Sphere{
            Length(link, "radius", static_cast<const urdf::Sphere&>(source).radius)};
      default:
        return ToMesh(link, static_cast<const urdf::Mesh&>(source));
    }
  }

  geometry::Shape ToMesh(const std::string& link, const urdf::Mesh& source) {
    const std::array<double, 3> scale{source.scale.x, source.scale.y, source.scale.z};
    try {
      const std::string path =
          ResolveMesh(source.filename, std::filesystem::path(where_).parent_path());
      std::shared_ptr<const geometry::TriangleMesh>& mesh = meshes_[{path, scale}];
      if (!mesh) {
        mesh = std::make_shared<geometry::TriangleMesh>(
            geometry::ReadMesh(path, ToVector(source.scale)));
      }
      return mesh;
    } catch (const base::ConfigError& error) {
      FailLink(link, error.what());
    }
  }

  void CheckMimics() const {
    std::map<std::string, const Joint*> joints;
    for (const Link& link : model_.links) {
      if (link.joint) joints[link.joint->name] = &*link.joint;
    }
    const std::vector<std::string> leaders = model_.JointNames();
    for (const auto& [name, joint] : joints) {
      if (joint->mimics.empty()) continue;
      if (joints.count(joint->mimics) == 0) {
        FailJoint(name, "it mimics a joint that is not there: " +
                            base::UnknownName("joint", joint->mimics, leaders));
      }
      const Joint& leader = *joints.at(joint->mimics);
      if (leader.type == JointType::kFixed || !leader.mimics.empty()) {
        FailJoint(name, fmt::format("it mimics '{}', which is fixed or mimics another; name the "
                                    "joint that leads",
                                    joint->mimics));
      }
    }
  }

  /// Descriptions of real robots hold invented inertias of tiny frames that no body can have; they
  /// do no harm where the mass is small, so they are told of and kept.
  void WarnOfImpossibleInertias() const {
    std::vector<std::string> names;
    for (const Link& link : model_.links) {
      if (link.inertial && !geometry::WhyUnphysical(*link.inertial).empty()) {
        names.push_back(link.name);
      }
    }
    if (names.empty()) return;
    base::Log(base::LogLevel::kWarn,
              fmt::format("urdf={} impossible_inertia={} reason=\"principal moments break the "
                          "triangle inequality\"",
                          where_, base::Join(names, ",")));
  }

  const urdf::ModelInterface& urdf_;
  const UrdfOutline& outline_;
  std::string where_;
  RobotModel model_;
  std::map<std::pair<std::string, std::array<double, 3>>,
           std::shared_ptr<const geometry::TriangleMesh>>
      meshes_;
};

}  // namespace

RobotModel ConvertUrdf(const urdf::ModelInterface& urdf, const UrdfOutline& outline,
                       const std::string& where) {
  return ModelBuilder(urdf, outline, where).Build();
}

}  // namespace hires::robot
