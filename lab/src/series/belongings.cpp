#include "lab/src/series/belongings.h"

#include <cmath>

#include "hires/base/text.h"

namespace hires::lab {
namespace {

using base::ToLower;
using knowledge::Fluent;
using knowledge::Property;

constexpr double kSunk = 0.02;  // [m] how far into a box something may stand on it
constexpr char kBox[] = "BoundingBox";
constexpr char kAreaRole[] = "Area";  // hasPlacingArea, hasSittingArea, ...

bool IsAreaRole(const std::string& role) {
  const std::size_t length = sizeof(kAreaRole) - 1;
  return role.size() > length && role.compare(role.size() - length, length, kAreaRole) == 0;
}

}  // namespace

Belongings::Belongings(const std::vector<Fluent>& fluents) {
  for (const Fluent& fluent : fluents) {
    Instance& instance = instances_[ToLower(fluent.instance)];
    instance = {fluent.instance, fluent.concept_name, {}, {}};  // what is said last counts
    for (const Property& property : fluent.properties) {
      if (property.IsLink()) {
        instance.links[property.role].push_back(std::get<std::string>(property.filler));
      } else if (const double* number = std::get_if<double>(&property.filler)) {
        instance.numbers[property.role] = *number;
      }
    }
  }
}

const Belongings::Instance* Belongings::Find(const std::string& instance) const {
  const auto found = instances_.find(ToLower(instance));
  return found == instances_.end() ? nullptr : &found->second;
}

bool Belongings::Has(const std::string& instance) const { return Find(instance) != nullptr; }

std::vector<std::string> Belongings::LinksOf(const std::string& instance,
                                             const std::string& role) const {
  const Instance* found = Find(instance);
  if (found == nullptr) return {};
  const auto links = found->links.find(role);
  return links == found->links.end() ? std::vector<std::string>() : links->second;
}

std::map<std::string, std::string> Belongings::OwnersOf(const std::string& pose) const {
  std::map<std::string, std::string> owners;
  for (const auto& [lower, instance] : instances_) {
    if (instance.concept_name == kBox) continue;
    for (const std::string& link : LinksOf(lower, "hasPose")) {
      if (ToLower(link) == ToLower(pose)) owners[instance.name] = instance.concept_name;
    }
  }
  return owners;
}

void Belongings::AddPosesOf(const std::string& instance, std::vector<std::string>* poses) const {
  for (const std::string& pose : LinksOf(instance, "hasPose")) poses->push_back(pose);
  for (const std::string& box : LinksOf(instance, "hasBoundingBox")) {
    for (const std::string& pose : LinksOf(box, "hasPose")) poses->push_back(pose);
  }
}

std::vector<std::string> Belongings::PosesWith(const std::string& pose) const {
  std::vector<std::string> poses, areas;
  for (const auto& [owner, concept_name] : OwnersOf(pose)) {
    AddPosesOf(owner, &poses);
    areas.push_back(owner);
    for (const auto& [role, links] : Find(owner)->links) {
      if (IsAreaRole(role)) areas.insert(areas.end(), links.begin(), links.end());
    }
  }
  for (const std::string& area : areas) AddPosesOf(area, &poses);
  for (const auto& [name, instance] : instances_) {
    if (instance.concept_name != "On") continue;
    for (const std::string& on : LinksOf(name, "hasArea")) {
      for (const std::string& area : areas) {
        if (ToLower(area) != ToLower(on)) continue;
        for (const auto& thing : LinksOf(name, "hasPhysicalEntity")) AddPosesOf(thing, &poses);
      }
    }
  }
  std::vector<std::string> others;
  for (const std::string& each : poses) {
    const bool is_pose = Has(each) && ToLower(each) != ToLower(pose);
    if (is_pose) others.push_back(each);
  }
  return others;
}

geometry::Pose3 Belongings::PoseOf(const std::string& pose) const {
  std::map<std::string, double> n = Find(pose)->numbers;
  return geometry::Lift({n["hasX"], n["hasY"], n["hasYaw"]}, n["hasZ"]);
}

bool Belongings::IsOn(const std::string& pose, const Eigen::Vector3d& p_M) const {
  for (const auto& [owner, concept_name] : OwnersOf(pose)) {
    for (const std::string& box : LinksOf(owner, "hasBoundingBox")) {
      std::map<std::string, double> size = Find(box)->numbers;
      const std::vector<std::string> stands = LinksOf(box, "hasPose");
      if (stands.empty() || !Has(stands[0])) continue;
      const Eigen::Vector3d p = PoseOf(stands[0]).Inverse() * p_M;
      if (std::abs(p.x()) <= size["hasXSize"] / 2.0 && std::abs(p.y()) <= size["hasYSize"] / 2.0 &&
          p.z() >= size["hasZSize"] - kSunk) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace hires::lab
