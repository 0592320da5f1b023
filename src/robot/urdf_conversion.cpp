#include "robot/urdf_conversion.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <queue>
#include <set>

#include "geometry/mesh_units.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/geometry/mesh_reader.h"
#include "robot/limit_stop.h"
#include "robot/mesh_path.h"
#include "robot/urdf/told.h"

namespace hires::robot {
namespace {

using geometry::Pose3;

constexpr double kMaxLength = 1e3;       // [m] of any offset or shape: beyond lies a slip of units
constexpr std::size_t kMostFailed = 60;  // meshes; for each, names near to it are looked for
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
               const ShapeLines& shape_lines, const std::string& where, UrdfProblems* problems)
      : urdf_(urdf),
        outline_(outline),
        shape_lines_(shape_lines),
        where_(where),
        problems_(*problems) {}

  UrdfReading Build() {
    model_.name = urdf_.getName();
    model_.plugins = outline_.plugins;
    ReadMeshes();
    AddTree();
    ResolveMimics();
    outline_.endless_friction.Tell(where_, "endless_friction",
                                   "a friction that is infinite or negative is taken as 1000");
    return {std::move(model_), std::move(doubts_)};
  }

 private:
  void TellLink(const std::string& link, const std::string& what) {
    problems_.Add(outline_.link_lines.at(link), fmt::format("link '{}': {}", link, what));
  }
  void TellJoint(const std::string& joint, const std::string& what) {
    problems_.Add(LineOf(joint), fmt::format("joint '{}': {}", joint, what));
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
      auto converted = ToCollision(source.name, *collision);
      if (!converted) continue;
      link.collisions.push_back(*std::move(converted));
      if (friction != outline_.friction.end()) link.collisions.back().friction = friction->second;
    }
    return link;
  }

  Joint ToJoint(const urdf::Joint& source, int parent) {
    Joint joint;
    joint.name = source.name;
    joint.type = ToType(source);
    joint.parent = parent;
    joint.X_PJ = ToPose(source.parent_to_joint_origin_transform);
    const std::string far = WhyBadPose(joint.X_PJ);
    if (!far.empty()) TellJoint(joint.name, "its origin " + far);
    if (joint.type == JointType::kFixed) return joint;
    joint.axis = ToVector(source.axis).normalized();
    if (source.limits) {
      const urdf::JointLimits& in = *source.limits;
      joint.limits = JointLimits{in.lower, in.upper, in.velocity, in.effort};
    }
    if (source.mimic) {
      joint.mimics = source.mimic->joint_name;
      joint.mimic_multiplier = source.mimic->multiplier;
      joint.mimic_offset = source.mimic->offset;
    }
    return joint;
  }

  JointType ToType(const urdf::Joint& source) {
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
        TellJoint(source.name,
                  "floating and planar joints are not supported; the base moves by itself, so "
                  "make it fixed, or revolute, continuous or prismatic");
        return JointType::kFixed;
    }
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

  /// Nothing where it cannot be read, which is told.
  std::optional<geometry::Collision> ToCollision(const std::string& link,
                                                 const urdf::Collision& source) {
    geometry::Collision collision;
    collision.name = source.name;
    collision.X_BS = ToPose(source.origin);
    const std::string far = WhyBadPose(collision.X_BS);
    if (!far.empty()) TellLink(link, "a <collision>'s origin " + far);
    auto shape = ToShape(link, *source.geometry);
    if (!shape) return std::nullopt;
    collision.shape = *std::move(shape);
    return collision;
  }

  double Length(const std::string& link, const char* what, double value) {
    if (value > 0.0 && value <= kMaxLength) return value;
    TellLink(link, fmt::format("a collision shape's {} is {} m, wanted above 0 and at most {}",
                               what, value, kMaxLength));
    return 1.0;
  }

  /// Nothing for a mesh that could not be read.
  std::optional<geometry::Shape> ToShape(const std::string& link, const urdf::Geometry& source) {
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
      default: {
        const auto mesh = meshes_.find(KeyOf(static_cast<const urdf::Mesh&>(source)));
        return mesh != meshes_.end() && mesh->second
                   ? std::make_optional<geometry::Shape>(mesh->second)
                   : std::nullopt;
      }
    }
  }

  using MeshKey = std::pair<std::string, std::array<double, 3>>;  // URI and scale

  static MeshKey KeyOf(const urdf::Mesh& mesh) {
    return {mesh.filename, {mesh.scale.x, mesh.scale.y, mesh.scale.z}};
  }

  /// Of all links, so that all files which are missing or no meshes are told at once.
  void ReadMeshes() {
    const base::PackageFinder packages;
    std::map<MeshKey, std::string> failed;
    for (const auto& [name, link] : urdf_.links_) {
      for (std::size_t i = 0; i < link->collision_array.size(); ++i) {
        const urdf::GeometrySharedPtr& geometry = link->collision_array[i]->geometry;
        if (!geometry || geometry->type != urdf::Geometry::MESH) continue;
        const auto& mesh = static_cast<const urdf::Mesh&>(*geometry);
        const int line = shape_lines_.at(name).at(i);
        auto why = failed.find(KeyOf(mesh));
        if (why == failed.end() && failed.size() >= kMostFailed) {
          problems_.Add(line, fmt::format("link '{}': so many meshes cannot be read that this one "
                                          "and later ones are not looked at",
                                          name));
          return;
        }
        try {
          if (why == failed.end()) ReadMesh(mesh, packages);
        } catch (const base::ConfigError& error) {
          why = failed.emplace(KeyOf(mesh), error.what()).first;
        }
        if (why != failed.end())
          problems_.Add(line, fmt::format("link '{}': {}", name, why->second));
      }
    }
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

  /// What a joint follows in the end.
  struct Following {
    const Joint* leader{nullptr};  // null: nobody that moves
    double multiplier{1.0}, offset{0.0};
  };

  /// Along a chain of joints that follow each other; nothing where it leads to a joint that is not
  /// there. One that comes back to where it was stands at 0.
  static std::optional<Following> FollowedBy(const Joint& joint,
                                             const std::map<std::string, Joint>& joints) {
    Following following{nullptr, joint.mimic_multiplier, joint.mimic_offset};
    std::set<std::string> met{joint.name};
    for (std::string at = joint.mimics; met.insert(at).second;) {
      const auto next = joints.find(at);
      if (next == joints.end()) return std::nullopt;
      if (next->second.type == JointType::kFixed) return following;
      if (next->second.mimics.empty()) {
        following.leader = &next->second;
        return following;
      }
      following.offset += following.multiplier * next->second.mimic_offset;
      following.multiplier *= next->second.mimic_multiplier;
      at = next->second.mimics;
    }
    return Following{};
  }

  static double Stopped(const Joint& joint, double position) {
    if (!joint.limits || joint.type == JointType::kContinuous) return position;
    return StoppedAt(joint.limits->lower, joint.limits->upper, position);
  }

  /// Fixes a joint where it stands.
  static void Hold(double position, Joint* joint) {
    const Pose3 X_JC = joint->type == JointType::kPrismatic
                           ? Pose3{position * joint->axis, Eigen::Quaterniond::Identity()}
                           : Pose3{Eigen::Vector3d::Zero(),
                                   Eigen::Quaterniond(Eigen::AngleAxisd(position, joint->axis))};
    Joint fixed;
    fixed.name = joint->name;
    fixed.parent = joint->parent;
    fixed.X_PJ = position == 0.0 ? joint->X_PJ : joint->X_PJ * X_JC;
    *joint = fixed;
  }

  /// Has each joint that follows another follow one that leads, or stand where it is put.
  void ResolveMimics() {
    std::map<std::string, Joint> joints;
    for (const Link& link : model_.links)
      if (link.joint) joints.emplace(link.joint->name, *link.joint);
    const std::vector<std::string> leaders = model_.JointNames();
    Told held, stopped;
    for (auto& [name, before] : joints) {
      if (before.mimics.empty()) continue;
      if (joints.count(before.mimics) == 0) {
        if (outline_.joint_lines.count(before.mimics) > 0) continue;  // left out as wrong itself
        TellJoint(name, "it mimics a joint that is not there: " +
                            base::UnknownName("joint", before.mimics, leaders));
        continue;
      }
      const auto following = FollowedBy(before, joints);
      if (!following) continue;  // the one before the last of the chain is told
      Joint& joint = *model_.links[*FindLinkOf(model_, name)].joint;
      const double led = following->leader ? RestOf(*following->leader) : 0.0;
      const double wanted = following->multiplier * led + following->offset;
      if (Stopped(joint, wanted) != wanted)
        stopped.Add(LineOf(name), name, fmt::format("it would be at {}", wanted));
      if (!following->leader) {
        held.Add(LineOf(name), name, fmt::format("follows '{}'", before.mimics));
        Hold(Stopped(joint, wanted), &joint);
        continue;
      }
      joint.mimics = following->leader->name;
      joint.mimic_multiplier = following->multiplier;
      joint.mimic_offset = following->offset;
    }
    held.Tell(where_, "follow_nothing_that_moves",
              "a joint that follows a fixed one, or itself, does not move");
    stopped.Tell(where_, "stopped_at_limits", "a joint that follows another stops at its limits");
  }

  static double RestOf(const Joint& joint) {
    if (!joint.limits || joint.type == JointType::kContinuous) return 0.0;
    return std::clamp(0.0, joint.limits->lower, joint.limits->upper);
  }

  int LineOf(const std::string& joint) const {
    const auto line = outline_.joint_lines.find(joint);  // what joins loose links is in no line
    return line == outline_.joint_lines.end() ? 0 : line->second;
  }

  using MeshPtr = std::shared_ptr<const geometry::TriangleMesh>;

  const urdf::ModelInterface& urdf_;
  const UrdfOutline& outline_;
  const ShapeLines& shape_lines_;
  std::string where_;
  UrdfProblems& problems_;
  RobotModel model_;
  std::map<MeshKey, MeshPtr> meshes_;  // by URI
  std::map<MeshKey, MeshPtr> files_;   // by path
  std::vector<std::string> doubts_;
};

}  // namespace

UrdfReading ConvertUrdf(const urdf::ModelInterface& urdf, const UrdfOutline& outline,
                        const ShapeLines& shape_lines, const std::string& where,
                        UrdfProblems* problems) {
  return ModelBuilder(urdf, outline, shape_lines, where, problems).Build();
}

}  // namespace hires::robot
