#include "robot/urdf_conversion.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <queue>

#include "geometry/mesh_units.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/geometry/mesh_reader.h"
#include "robot/mesh_path.h"

namespace hires::robot {
namespace {

using geometry::Pose3;

constexpr double kMaxLength = 1e3;  // [m] of any offset or shape: beyond lies a slip of units
constexpr geometry::DoubtfulSize kDoubtful{50.0, 200.0, 10.0};  // of a part of a robot

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
               const ShapeLines& shape_lines, const std::string& where)
      : urdf_(urdf), outline_(outline), shape_lines_(shape_lines), where_(where) {}

  UrdfReading Build() {
    model_.name = urdf_.getName();
    ReadMeshes();
    AddTree();
    CheckMimics();
    return {std::move(model_), std::move(doubts_)};
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
    if (source.inertial) link.inertial = ToMass(*source.inertial);
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

  /// What no body can have was left out before.
  static geometry::MassProperties ToMass(const urdf::Inertial& in) {
    const Pose3 X_LI = ToPose(in.origin);
    Eigen::Matrix3d inertia;
    inertia << in.ixx, in.ixy, in.ixz, in.ixy, in.iyy, in.iyz, in.ixz, in.iyz, in.izz;
    const Eigen::Matrix3d turn = X_LI.rotation.toRotationMatrix();
    const Eigen::Matrix3d turned = turn * inertia * turn.transpose();
    return {in.mass, X_LI.translation, 0.5 * (turned + turned.transpose())};
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
        return meshes_.at(KeyOf(static_cast<const urdf::Mesh&>(source)));
    }
  }

  using MeshKey = std::pair<std::string, std::array<double, 3>>;  // URI and scale

  static MeshKey KeyOf(const urdf::Mesh& mesh) {
    return {mesh.filename, {mesh.scale.x, mesh.scale.y, mesh.scale.z}};
  }

  /// Of all links, so that all files which are missing or no meshes are told at once.
  void ReadMeshes() {
    std::multimap<int, std::string> problems;  // by line
    const base::PackageFinder packages;
    for (const auto& [name, link] : urdf_.links_) {
      for (std::size_t i = 0; i < link->collision_array.size(); ++i) {
        const urdf::GeometrySharedPtr& geometry = link->collision_array[i]->geometry;
        if (!geometry || geometry->type != urdf::Geometry::MESH) continue;
        try {
          ReadMesh(static_cast<const urdf::Mesh&>(*geometry), packages);
        } catch (const base::ConfigError& error) {
          const int line = shape_lines_.at(name).at(i);
          problems.emplace(line, fmt::format("link '{}': {}; line {}", name, error.what(), line));
        }
      }
    }
    if (problems.empty()) return;
    std::vector<std::string> texts;
    for (const auto& [line, text] : problems) texts.push_back(text);
    if (texts.size() == 1) throw base::ConfigError(where_ + ": " + texts.front());
    throw base::ConfigError(fmt::format("{}: {} meshes cannot be read:\n  {}", where_, texts.size(),
                                        base::Join(texts, "\n  ")));
  }

  void ReadMesh(const urdf::Mesh& source, const base::PackageFinder& packages) {
    MeshPtr& by_uri = meshes_[KeyOf(source)];
    if (by_uri) return;
    const std::string path =
        ResolveMesh(source.filename, std::filesystem::path(where_).parent_path(), packages);
    MeshPtr& by_path = files_[{path, KeyOf(source).second}];
    if (!by_path) {
      const Eigen::Vector3d scale = ToVector(source.scale);
      by_path = std::make_shared<geometry::TriangleMesh>(geometry::ReadMesh(path, scale));
      const std::string doubt =
          geometry::DoubtedUnit(path, *by_path, scale, kDoubtful, "scale=\"{}\"");
      if (!doubt.empty()) doubts_.push_back(doubt);
    }
    by_uri = by_path;
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

  using MeshPtr = std::shared_ptr<const geometry::TriangleMesh>;

  const urdf::ModelInterface& urdf_;
  const UrdfOutline& outline_;
  const ShapeLines& shape_lines_;
  std::string where_;
  RobotModel model_;
  std::map<MeshKey, MeshPtr> meshes_;  // by URI
  std::map<MeshKey, MeshPtr> files_;   // by path
  std::vector<std::string> doubts_;
};

}  // namespace

UrdfReading ConvertUrdf(const urdf::ModelInterface& urdf, const UrdfOutline& outline,
                        const ShapeLines& shape_lines, const std::string& where) {
  return ModelBuilder(urdf, outline, shape_lines, where).Build();
}

}  // namespace hires::robot
