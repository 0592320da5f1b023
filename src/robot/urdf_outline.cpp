#include "robot/urdf_outline.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::robot {
namespace {

using tinyxml2::XMLElement;

class OutlineReader {
 public:
  OutlineReader(const std::string& xml, const std::string& where) : where_(where) {
    document_.Parse(xml.data(), xml.size());
    if (document_.Error()) {
      Fail(document_.ErrorLineNum(),
           fmt::format("no valid XML ({}); close every element and quote every attribute",
                       document_.ErrorName()));
    }
    robot_ = document_.FirstChildElement("robot");
    if (robot_ == nullptr) {
      Fail(1, "there is no <robot> element; a URDF file holds exactly one");
    }
  }

  UrdfOutline Read() {
    ReadLinks();
    ReadJoints();
    CheckOneRoot();
    CheckReachable();
    ReadFriction();
    return std::move(outline_);
  }

 private:
  [[noreturn]] void Fail(int line, const std::string& what) const {
    throw base::ConfigError(fmt::format("{}: {}; line {}", where_, what, line));
  }

  std::string Attribute(const XMLElement& element, const char* attribute) const {
    const char* value = element.Attribute(attribute);
    if (value == nullptr || *value == '\0') {
      Fail(element.GetLineNum(),
           fmt::format("<{}> has no attribute '{}'; add it", element.Name(), attribute));
    }
    return value;
  }

  std::vector<std::string> LinkNames() const {
    std::vector<std::string> names;
    for (const auto& [name, line] : outline_.link_lines) names.push_back(name);
    return names;
  }

  void ReadLinks() {
    for (const XMLElement* link = robot_->FirstChildElement("link"); link != nullptr;
         link = link->NextSiblingElement("link")) {
      const std::string name = Attribute(*link, "name");
      if (!outline_.link_lines.emplace(name, link->GetLineNum()).second) {
        Fail(link->GetLineNum(),
             fmt::format("link '{}' is there twice, first in line {}; rename one", name,
                         outline_.link_lines[name]));
      }
    }
    if (outline_.link_lines.empty()) {
      Fail(robot_->GetLineNum(), "the robot has no <link>; add at least one");
    }
  }

  void ReadJoints() {
    for (const XMLElement* joint = robot_->FirstChildElement("joint"); joint != nullptr;
         joint = joint->NextSiblingElement("joint")) {
      const std::string name = Attribute(*joint, "name");
      if (!outline_.joint_lines.emplace(name, joint->GetLineNum()).second) {
        Fail(joint->GetLineNum(),
             fmt::format("joint '{}' is there twice, first in line {}; rename one", name,
                         outline_.joint_lines[name]));
      }
      AddEdge(name, LinkOf(*joint, name, "parent"), LinkOf(*joint, name, "child"));
    }
  }

  std::string LinkOf(const XMLElement& joint, const std::string& name, const char* role) const {
    const XMLElement* element = joint.FirstChildElement(role);
    if (element == nullptr) {
      Fail(joint.GetLineNum(),
           fmt::format("joint '{0}' has no <{1}>; add <{1} link=\"...\"/>", name, role));
    }
    const std::string link = Attribute(*element, "link");
    if (outline_.link_lines.count(link) == 0) {
      Fail(element->GetLineNum(),
           fmt::format("joint '{}': {}", name,
                       base::UnknownName(fmt::format("{} link", role), link, LinkNames())));
    }
    return link;
  }

  void AddEdge(const std::string& joint, const std::string& parent, const std::string& child) {
    const auto [carrier, is_new] = carriers_.emplace(child, std::make_pair(parent, joint));
    if (is_new) return;
    Fail(outline_.joint_lines[joint],
         fmt::format("link '{}' is the child of joint '{}' and of joint '{}'; a link hangs on one "
                     "joint, remove the other",
                     child, carrier->second.second, joint));
  }

  void CheckOneRoot() const {
    std::vector<std::string> roots;
    for (const std::string& name : LinkNames()) {
      if (carriers_.count(name) == 0) roots.push_back(name);
    }
    if (roots.empty()) {
      Fail(robot_->GetLineNum(),
           "every link is some joint's child, so the joints form a loop; remove the joint that "
           "closes it");
    }
    if (roots.size() > 1) {
      Fail(outline_.link_lines.at(roots[1]),
           fmt::format("{} links hang on no joint: '{}'; keep one root and join the others to it",
                       roots.size(), base::Join(roots, "', '")));
    }
  }

  /// Going up from a link ends at the root, or never where joints form a loop beside the tree.
  void CheckReachable() const {
    for (const auto& [name, line] : outline_.link_lines) {
      std::string at = name;
      std::size_t num_steps = 0;
      for (auto up = carriers_.find(at); up != carriers_.end(); up = carriers_.find(at)) {
        at = up->second.first;
        if (++num_steps > carriers_.size()) {
          Fail(line, fmt::format("link '{}' is part of a loop of joints or hangs on one; remove "
                                 "the joint that closes it ('{}')",
                                 name, carriers_.at(at).second));
        }
      }
    }
  }

  /// The friction coefficient in <mu1>0.5</mu1> or, in older files, <mu1 value="0.5"/>.
  std::optional<double> FrictionIn(const XMLElement& gazebo, const char* tag) const {
    const XMLElement* element = gazebo.FirstChildElement(tag);
    if (element == nullptr) return std::nullopt;
    double mu = 0.0;
    const bool read = element->Attribute("value") != nullptr
                          ? element->QueryDoubleAttribute("value", &mu) == tinyxml2::XML_SUCCESS
                          : element->QueryDoubleText(&mu) == tinyxml2::XML_SUCCESS;
    if (!read || !std::isfinite(mu) || mu < 0.0) {
      Fail(element->GetLineNum(),
           fmt::format("<{}> holds no friction coefficient; wanted a finite number of at least 0",
                       tag));
    }
    return mu;
  }

  void ReadFriction() {
    for (const XMLElement* gazebo = robot_->FirstChildElement("gazebo"); gazebo != nullptr;
         gazebo = gazebo->NextSiblingElement("gazebo")) {
      const char* link = gazebo->Attribute("reference");
      if (link == nullptr || outline_.link_lines.count(link) == 0) continue;
      for (const char* tag : {"mu1", "mu2"}) {
        const std::optional<double> mu = FrictionIn(*gazebo, tag);
        if (!mu) continue;
        const auto [known, is_new] = outline_.friction.emplace(link, *mu);
        if (!is_new) known->second = std::min(known->second, *mu);
      }
    }
  }

  std::string where_;
  tinyxml2::XMLDocument document_;
  const XMLElement* robot_{nullptr};
  UrdfOutline outline_;
  std::map<std::string, std::pair<std::string, std::string>> carriers_;  // child: parent, joint
};

}  // namespace

UrdfOutline ReadUrdfOutline(const std::string& xml, const std::string& where) {
  return OutlineReader(xml, where).Read();
}

}  // namespace hires::robot
