#include "translation/stated_pose.h"

#include <cctype>
#include <cmath>

#include "hires/base/text.h"

namespace hires::translation {
namespace {

constexpr double kNoAngle = 1e-9;  // [rad]

const knowledge::Property* Find(const knowledge::Fluent& fluent, const std::string& role) {
  for (const knowledge::Property& property : fluent.properties) {
    if (property.role == role) return &property;
  }
  return nullptr;
}

std::string TextOf(const knowledge::Fluent& fluent, const std::string& role) {
  const knowledge::Property* property = Find(fluent, role);
  const auto* text = property ? std::get_if<std::string>(&property->filler) : nullptr;
  return text ? *text : "";
}

void AddNumber(const std::string& role, double value, knowledge::Fluent* fluent) {
  fluent->properties.push_back({role, "xsd:float", value});
}

}  // namespace

std::string LinkOf(const knowledge::Fluent& fluent, const std::string& role) {
  const knowledge::Property* property = Find(fluent, role);
  return property && property->IsLink() ? std::get<std::string>(property->filler) : "";
}

std::optional<double> NumberOf(const knowledge::Fluent& fluent, const std::string& role) {
  const knowledge::Property* property = Find(fluent, role);
  if (property == nullptr) return std::nullopt;
  if (const auto* real = std::get_if<double>(&property->filler)) return *real;
  if (const auto* whole = std::get_if<std::int64_t>(&property->filler)) {
    return static_cast<double>(*whole);
  }
  return std::nullopt;
}

std::optional<StatedPose> PoseStatedBy(const knowledge::FluentView& view,
                                       const knowledge::Fluent& fluent) {
  const std::string instance = LinkOf(fluent, "hasPose");
  const knowledge::Fluent* pose = instance.empty() ? nullptr : view.Find(instance);
  if (pose == nullptr) return std::nullopt;
  const auto x = NumberOf(*pose, "hasX"), y = NumberOf(*pose, "hasY"), z = NumberOf(*pose, "hasZ");
  if (!x || !y || !z) return std::nullopt;
  StatedPose stated;
  stated.instance = pose->instance;
  stated.frame = TextOf(*pose, "hasFrame");
  if (base::ToLower(stated.frame) == "map") stated.frame.clear();
  stated.X_FO.translation = {*x, *y, *z};
  stated.X_FO.rotation = geometry::RotationFromRpy(NumberOf(*pose, "hasRoll").value_or(0.0),
                                                   NumberOf(*pose, "hasPitch").value_or(0.0),
                                                   NumberOf(*pose, "hasYaw").value_or(0.0));
  if (!stated.X_FO.IsFinite()) return std::nullopt;
  return stated;
}

std::optional<StatedPose> PoseStatedOf(const knowledge::FluentView& view,
                                       const std::string& instance) {
  const knowledge::Fluent* fluent = view.Find(instance);
  return fluent ? PoseStatedBy(view, *fluent) : std::nullopt;
}

knowledge::Fluent PoseFluent(const StatedPose& pose) {
  knowledge::Fluent fluent;
  fluent.concept_name = "Pose";
  fluent.instance = pose.instance;
  const Eigen::Vector3d& p = pose.X_FO.translation;
  AddNumber("hasX", p.x(), &fluent);
  AddNumber("hasY", p.y(), &fluent);
  AddNumber("hasZ", p.z(), &fluent);
  const Eigen::Matrix3d R = pose.X_FO.rotation.toRotationMatrix();
  const double roll = std::atan2(R(2, 1), R(2, 2));
  const double pitch = std::atan2(-R(2, 0), std::hypot(R(2, 1), R(2, 2)));
  AddNumber("hasYaw", std::atan2(R(1, 0), R(0, 0)), &fluent);
  if (std::abs(roll) > kNoAngle) AddNumber("hasRoll", roll, &fluent);
  if (std::abs(pitch) > kNoAngle) AddNumber("hasPitch", pitch, &fluent);
  if (!pose.frame.empty()) fluent.properties.push_back({"hasFrame", "xsd:string", pose.frame});
  return fluent;
}

std::string NameFor(const std::string& word, const std::string& thing) {
  std::string name = word;
  for (const std::string& part : base::Split(thing, '_')) {
    if (part.empty()) continue;
    name += static_cast<char>(std::toupper(static_cast<unsigned char>(part[0])));
    name += part.substr(1);
  }
  return name;
}

}  // namespace hires::translation
