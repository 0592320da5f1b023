#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <filesystem>
#include <mutex>
#include <queue>

#include "hires/base/error.h"
#include "hires/base/hash.h"
#include "hires/base/log.h"
#include "hires/base/text.h"
#include "hires/geometry/mesh_reader.h"
#include "hires/robot/robot_model.h"
#include "mesh_path.h"
#include "urdf_outline.h"

namespace hires::robot {
namespace {

using geometry::Pose3;

constexpr std::size_t kMaxUrdfBytes = 16u << 20;
constexpr double kMaxLength = 1e3;  // [m] of any offset or shape: beyond lies a slip of units

/// While it lives, what the URDF parser prints to the console comes here instead. One at a time in
/// the process, because the console's handler is.
class ConsoleCatcher : public console_bridge::OutputHandler {
 public:
  ConsoleCatcher() : lock_(mutex()) { console_bridge::useOutputHandler(this); }
  ~ConsoleCatcher() override { console_bridge::restorePreviousOutputHandler(); }

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR ? errors_ : warnings_).push_back(text);
  }

  const std::vector<std::string>& errors() const { return errors_; }
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  static std::mutex& mutex() {
    static std::mutex the_mutex;
    return the_mutex;
  }

  std::lock_guard<std::mutex> lock_;
  std::vector<std::string> errors_;
  std::vector<std::string> warnings_;
};

urdf::ModelInterfaceSharedPtr ParseUrdf(const std::string& xml, const std::string& where) {
  ConsoleCatcher console;
  urdf::ModelInterfaceSharedPtr model;
  std::string thrown;
  try {
    model = urdf::parseURDF(xml);
  } catch (const std::exception& error) {
    thrown = error.what();
  }
  if (!model || !console.errors().empty()) {
    std::vector<std::string> reasons = console.errors();
    if (!thrown.empty()) reasons.push_back(thrown);
    throw base::ConfigError(fmt::format("{}: no valid URDF: {}; correct that element", where,
                                        base::Join(reasons, "; ")));
  }
  for (const std::string& warning : console.warnings()) {
    base::Log(base::LogLevel::kWarn, fmt::format("urdf={} warning=\"{}\"", where, warning));
  }
  return model;
}

Eigen::Vector3d ToVector(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

Pose3 ToPose(const urdf::Pose& pose) {
  double x, y, z, w;
  pose.rotation.getQuaternion(x, y, z, w);
  return {ToVector(pose.position), Eigen::Quaterniond(w, x, y, z).normalized()};
}

/// Turns the parser's model into ours, checking what the parser lets pass.
class ModelBuilder {
 public:
  ModelBuilder(const urdf::ModelInterface& urdf, UrdfOutline outline, const std::string& where)
      : urdf_(urdf), outline_(std::move(outline)), where_(where) {}

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
  UrdfOutline outline_;
  std::string where_;
  RobotModel model_;
  std::map<std::pair<std::string, std::array<double, 3>>,
           std::shared_ptr<const geometry::TriangleMesh>>
      meshes_;
};

void AddTo(base::Hasher* hash, const Eigen::Vector3d& v) {
  for (int i = 0; i < 3; ++i) hash->Add(v[i]);
}

void AddTo(base::Hasher* hash, const Pose3& pose) {
  AddTo(hash, pose.translation);
  for (int i = 0; i < 4; ++i) hash->Add(pose.rotation.coeffs()[i]);
}

void AddTo(base::Hasher* hash, const geometry::TriangleMesh& mesh) {
  hash->Add(static_cast<std::uint64_t>(mesh.vertices.size()));
  for (const Eigen::Vector3d& vertex : mesh.vertices) AddTo(hash, vertex);
  for (const auto& triangle : mesh.triangles) {
    for (const int corner : triangle) hash->Add(static_cast<std::uint64_t>(corner));
  }
}

void AddTo(base::Hasher* hash, const geometry::Collision& collision) {
  hash->Add(collision.name);
  AddTo(hash, collision.X_BS);
  hash->Add(collision.friction);
  hash->Add(collision.restitution);
  hash->Add(static_cast<std::uint64_t>(collision.shape.index()));
  if (const auto* box = std::get_if<geometry::Box>(&collision.shape)) AddTo(hash, box->size);
  if (const auto* cylinder = std::get_if<geometry::Cylinder>(&collision.shape)) {
    hash->Add(cylinder->radius);
    hash->Add(cylinder->length);
  }
  if (const auto* sphere = std::get_if<geometry::Sphere>(&collision.shape)) {
    hash->Add(sphere->radius);
  }
  using MeshPtr = std::shared_ptr<const geometry::TriangleMesh>;
  if (const auto* mesh = std::get_if<MeshPtr>(&collision.shape)) AddTo(hash, **mesh);
}

void AddTo(base::Hasher* hash, const Joint& joint) {
  hash->Add(joint.name);
  hash->Add(static_cast<std::uint64_t>(joint.type));
  hash->Add(static_cast<std::uint64_t>(joint.parent));
  AddTo(hash, joint.X_PJ);
  AddTo(hash, joint.axis);
  hash->Add(static_cast<std::uint64_t>(joint.limits.has_value()));
  const JointLimits limits = joint.limits.value_or(JointLimits{});
  for (const double value : {limits.lower, limits.upper, limits.velocity, limits.effort,
                             joint.mimic_multiplier, joint.mimic_offset}) {
    hash->Add(value);
  }
  hash->Add(joint.mimics);
}

void AddTo(base::Hasher* hash, const geometry::MassProperties& mass) {
  hash->Add(mass.mass);
  AddTo(hash, mass.p_BBcm);
  for (int column = 0; column < 3; ++column) {
    AddTo(hash, Eigen::Vector3d(mass.I_BBcm.col(column)));
  }
}

std::uint64_t HashOf(const RobotModel& model) {
  base::Hasher hash;
  hash.Add(model.name);
  for (const Link& link : model.links) {
    hash.Add(link.name);
    if (link.joint) AddTo(&hash, *link.joint);
    hash.Add(static_cast<std::uint64_t>(link.inertial.has_value()));
    if (link.inertial) AddTo(&hash, *link.inertial);
    hash.Add(static_cast<std::uint64_t>(link.collisions.size()));
    for (const geometry::Collision& collision : link.collisions) AddTo(&hash, collision);
  }
  return hash.value();
}

}  // namespace

RobotModel LoadRobotModel(const std::string& urdf_path) {
  return ParseRobotModel(base::ReadTextFile(urdf_path, kMaxUrdfBytes), urdf_path);
}

RobotModel ParseRobotModel(const std::string& urdf_xml, const std::string& where) {
  UrdfOutline outline = ReadUrdfOutline(urdf_xml, where);
  const urdf::ModelInterfaceSharedPtr urdf = ParseUrdf(urdf_xml, where);
  RobotModel model = ModelBuilder(*urdf, std::move(outline), where).Build();
  model.hash = HashOf(model);
  return model;
}

}  // namespace hires::robot
