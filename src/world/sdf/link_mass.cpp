#include "world/sdf/link_mass.h"

#include <fmt/format.h>

#include <cmath>
#include <locale>
#include <sdf/Box.hh>
#include <sdf/Collision.hh>
#include <sdf/Cylinder.hh>
#include <sdf/Element.hh>
#include <sdf/Geometry.hh>
#include <sdf/Sphere.hh>
#include <sstream>

#include "hires/base/error.h"
#include "hires/geometry/angles.h"
#include "world/sdf/prune_sdf.h"
#include "world/sdf_file.h"
#include "world/sdf_model.h"

namespace hires::world {
namespace {

/// Null if there is none.
sdf::ElementPtr ChildOf(const sdf::ElementPtr& parent, const char* name) {
  return parent != nullptr && parent->HasElement(name) ? parent->GetElement(name) : nullptr;
}

std::string ValueText(const sdf::ElementPtr& element) {
  return element == nullptr ? "" : element->Get<std::string>();
}

std::string WhereOf(const sdf::Link& link) {
  return fmt::format("{}: link '{}'", PlaceOf(link.Element()), link.Name());
}

std::vector<double> NumbersIn(const std::string& text, const char* name, const std::string& where) {
  std::vector<double> numbers;
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  for (double value = 0.0; in >> value;) numbers.push_back(value);
  if (in.eof()) return numbers;
  throw base::ConfigError(fmt::format(
      "{}: <{}> of its <inertial> is '{}', wanted numbers; correct it", where, name, text));
}

double NumberIn(const sdf::ElementPtr& parent, const char* name, const std::string& where) {
  const sdf::ElementPtr element = ChildOf(parent, name);
  if (element == nullptr) return 0.0;
  const std::vector<double> numbers = NumbersIn(ValueText(element), name, where);
  return numbers.size() == 1 ? numbers[0] : std::nan("");
}

bool Says(const sdf::ElementPtr& element, const char* attribute, const char* value) {
  return element->HasAttribute(attribute) &&
         element->GetAttribute(attribute)->GetAsString() == value;
}

/// "x y z roll pitch yaw", or as its attributes say.
geometry::Pose3 PoseOf(const sdf::ElementPtr& element, const std::string& where) {
  const std::vector<double> n = NumbersIn(ValueText(element), "pose", where);
  if (n.empty()) return {};
  const bool is_quaternion = Says(element, "rotation_format", "quat_xyzw");
  if (n.size() != (is_quaternion ? 7u : 6u)) {
    throw base::ConfigError(fmt::format("{}: <pose> of its <inertial> is '{}', wanted {} numbers",
                                        where, ValueText(element), is_quaternion ? 7 : 6));
  }
  geometry::Pose3 pose;
  pose.translation = {n[0], n[1], n[2]};
  if (is_quaternion) {
    pose.rotation = Eigen::Quaterniond(n[6], n[3], n[4], n[5]).normalized();
    return pose;
  }
  const double unit = Says(element, "degrees", "true") ? geometry::kPi / 180.0 : 1.0;
  pose.rotation = Eigen::AngleAxisd(unit * n[5], Eigen::Vector3d::UnitZ()) *
                  Eigen::AngleAxisd(unit * n[4], Eigen::Vector3d::UnitY()) *
                  Eigen::AngleAxisd(unit * n[3], Eigen::Vector3d::UnitX());
  return pose;
}

constexpr double kDefaultDensity = 1000.0;  // [kg/m^3] SDF's

/// About its centre; nothing of other shapes.
std::optional<geometry::MassProperties> SolidOf(const sdf::Geometry& shape, double density) {
  const auto solid = [&](const auto& of_shape, double volume) {
    geometry::MassProperties result;
    result.mass = density * volume;
    result.I_BBcm = geometry::SolidInertia(of_shape, result.mass);
    return result;
  };
  if (const sdf::Box* box = shape.BoxShape()) {
    const auto size = box->Size();
    return solid(geometry::Box{{size.X(), size.Y(), size.Z()}}, size.X() * size.Y() * size.Z());
  }
  if (const sdf::Cylinder* cylinder = shape.CylinderShape()) {
    const double radius = cylinder->Radius(), length = cylinder->Length();
    return solid(geometry::Cylinder{radius, length}, geometry::kPi * radius * radius * length);
  }
  if (const sdf::Sphere* sphere = shape.SphereShape()) {
    const double radius = sphere->Radius();
    return solid(geometry::Sphere{radius}, 4.0 / 3.0 * geometry::kPi * radius * radius * radius);
  }
  return std::nullopt;
}

sdf::ElementPtr InertialOf(const sdf::Link& link) { return ChildOf(link.Element(), kInertial); }

}  // namespace

bool HasWholeInertial(const sdf::Link& link) {
  const sdf::ElementPtr inertial = InertialOf(link), inertia = ChildOf(inertial, "inertia");
  if (ChildOf(inertial, "mass") == nullptr) return false;
  for (const char* moment : {"ixx", "iyy", "izz"}) {
    if (ChildOf(inertia, moment) == nullptr) return false;
  }
  return true;
}

bool HasMassAlone(const sdf::Link& link) {
  const sdf::ElementPtr inertial = InertialOf(link);
  return ChildOf(inertial, "mass") != nullptr && ChildOf(inertial, "inertia") == nullptr;
}

bool HasAutomaticInertia(const sdf::Link& link) {
  const sdf::ElementPtr inertial = InertialOf(link);
  return inertial != nullptr && (Says(inertial, "auto", "true") || Says(inertial, "auto", "1"));
}

geometry::MassProperties MassPropertiesOf(const sdf::Link& link, const geometry::Pose3& X_BL) {
  const std::string where = WhereOf(link);
  const sdf::ElementPtr inertial = InertialOf(link), inertia = ChildOf(inertial, "inertia");
  const sdf::ElementPtr pose = ChildOf(inertial, "pose");
  const geometry::Pose3 X_BI = X_BL * (pose == nullptr ? geometry::Pose3{} : PoseOf(pose, where));
  const char* names[3][3] = {{"ixx", "ixy", "ixz"}, {"ixy", "iyy", "iyz"}, {"ixz", "iyz", "izz"}};
  Eigen::Matrix3d I_I = Eigen::Matrix3d::Identity();
  for (int i = 0; i < 3 && inertia != nullptr; ++i) {
    for (int k = 0; k < 3; ++k) I_I(i, k) = NumberIn(inertia, names[i][k], where);
  }
  const Eigen::Matrix3d R_BI = X_BI.rotation.toRotationMatrix();
  const geometry::MassProperties result{NumberIn(inertial, "mass", where), X_BI.translation,
                                        R_BI * I_I * R_BI.transpose()};
  const std::string wrong = geometry::WhyUnphysical(result);
  if (!wrong.empty())
    throw base::ConfigError(fmt::format("{}: {}; correct its <inertial>", where, wrong));
  CheckPose(X_BI, where + ": centre of mass");
  return result;
}

std::optional<geometry::MassProperties> AutomaticMassOf(const sdf::Link& link,
                                                        const geometry::Pose3& X_BL) {
  const std::string where = WhereOf(link);
  const sdf::ElementPtr of_link = ChildOf(InertialOf(link), "density");
  std::vector<geometry::MassProperties> parts;
  for (std::uint64_t i = 0; i < link.CollisionCount(); ++i) {
    const sdf::Collision& collision = *link.CollisionByIndex(i);
    const sdf::ElementPtr own = ChildOf(collision.Element(), kDensity);
    const sdf::ElementPtr said = own != nullptr ? own : of_link;
    double density = kDefaultDensity;
    if (said != nullptr) {
      const std::vector<double> numbers = NumbersIn(ValueText(said), "density", where);
      density = numbers.size() == 1 ? numbers[0] : std::nan("");
    }
    if (!(density > 0.0) || !std::isfinite(density)) {
      throw base::ConfigError(
          fmt::format("{}: a <density> is '{}', wanted kg/m^3 above 0", where, ValueText(said)));
    }
    const auto solid = SolidOf(*collision.Geom(), density);
    if (!solid) return std::nullopt;
    const geometry::Pose3 X_BC = X_BL * PoseIn(collision.SemanticPose(), "", where);
    const Eigen::Matrix3d R_BC = X_BC.rotation.toRotationMatrix();
    parts.push_back({solid->mass, X_BC.translation, R_BC * solid->I_BBcm * R_BC.transpose()});
  }
  if (parts.empty()) return std::nullopt;
  return parts.size() == 1 ? parts.front() : geometry::Together(parts);
}

}  // namespace hires::world
