#include "robot/urdf_outline.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <set>
#include <vector>

#include "base/files/urdf_friction.h"
#include "hires/base/text.h"

namespace hires::robot {
namespace {

using tinyxml2::XMLElement;

class OutlineReader {
 public:
  OutlineReader(const std::string& xml, UrdfProblems* problems) : problems_(*problems) {
    document_.Parse(xml.data(), xml.size());
    const int line = document_.ErrorLineNum();
    if (document_.ErrorID() == tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED)
      problems_.Fail(line, "elements nest too deep for a URDF; flatten them");
    if (document_.Error()) {
      problems_.Fail(line,
                     fmt::format("no valid XML ({}); close every element and quote every attribute",
                                 document_.ErrorName()));
    }
    robot_ = document_.FirstChildElement("robot");
    if (robot_ == nullptr) {
      problems_.Fail(1, "there is no <robot> element; a URDF file holds exactly one");
    }
  }

  UrdfOutline Read() {
    CheckSize();
    ReadLinks();
    ReadJoints();
    CheckLoops();
    CheckOneRoot();
    ReadFriction();
    ReadPlugins();
    return std::move(outline_);
  }

 private:
  /// "" if it has none, which is told.
  std::string Attribute(const XMLElement& element, const char* attribute) {
    const char* value = element.Attribute(attribute);
    if (value != nullptr && *value != '\0') return value;
    problems_.Add(element.GetLineNum(),
                  fmt::format("<{}> has no attribute '{}'; add it", element.Name(), attribute));
    return "";
  }

  std::vector<std::string> LinkNames() const {
    std::vector<std::string> names;
    for (const auto& [name, line] : outline_.link_lines) names.push_back(name);
    return names;
  }

  static int CountIn(const XMLElement& element) {
    int count = 1;
    for (const auto* child = element.FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      count += CountIn(*child);
    }
    return count;
  }

  void CheckSize() {
    int num_links = 0, num_shapes = 0;
    for (const XMLElement* link = robot_->FirstChildElement("link"); link != nullptr;
         link = link->NextSiblingElement("link")) {
      ++num_links;
      for (const XMLElement* shape = link->FirstChildElement("collision"); shape != nullptr;
           shape = shape->NextSiblingElement("collision")) {
        ++num_shapes;
      }
    }
    const int num_elements = CountIn(*robot_);
    if (num_links <= kMostLinks && num_shapes <= kMostShapes && num_elements <= kMostElements)
      return;
    problems_.Fail(
        robot_->GetLineNum(),
        fmt::format("{} elements, {} links and {} collision shapes, at most {}, {} and {} are "
                    "read; join links that are fixed to each other, and shapes into meshes",
                    num_elements, num_links, num_shapes, kMostElements, kMostLinks, kMostShapes));
  }

  void ReadLinks() {
    int number = 0;
    for (const XMLElement* link = robot_->FirstChildElement("link"); link != nullptr;
         link = link->NextSiblingElement("link"), ++number) {
      const std::string name = Attribute(*link, "name");
      const auto [known, is_new] = outline_.link_lines.emplace(name, link->GetLineNum());
      if (is_new && !name.empty()) continue;
      outline_.useless_links.insert(number);
      if (name.empty()) {
        if (is_new) outline_.link_lines.erase(known);
        continue;
      }
      problems_.Add(link->GetLineNum(),
                    fmt::format("link '{}' is there twice, first in line {}; rename one", name,
                                known->second));
    }
    if (number == 0)
      problems_.Fail(robot_->GetLineNum(), "the robot has no <link>; add at least one");
    if (outline_.link_lines.empty()) problems_.ThrowIfAny();
  }

  void ReadJoints() {
    int number = 0;
    for (const XMLElement* joint = robot_->FirstChildElement("joint"); joint != nullptr;
         joint = joint->NextSiblingElement("joint"), ++number) {
      const std::string name = Attribute(*joint, "name");
      const std::string parent = LinkOf(*joint, name, "parent");
      const std::string child = LinkOf(*joint, name, "child");
      if (Take(*joint, number, name, parent, child)) continue;
      outline_.useless_joints.insert(number);
      if (child.empty()) {
        ++num_lost_;
      } else {
        loose_.insert(child);
      }
    }
  }

  bool Take(const XMLElement& joint, int number, const std::string& name, const std::string& parent,
            const std::string& child) {
    if (name.empty()) return false;
    const auto [known, is_new] = outline_.joint_lines.emplace(name, joint.GetLineNum());
    if (!is_new) {
      problems_.Add(joint.GetLineNum(),
                    fmt::format("joint '{}' is there twice, first in line {}; rename one", name,
                                known->second));
      return false;
    }
    if (parent.empty() || child.empty()) return false;
    const auto [carrier, is_first] = carriers_.emplace(child, Carrier{parent, name, number});
    if (is_first) return true;
    problems_.Add(joint.GetLineNum(),
                  fmt::format("link '{}' is the child of joint '{}' and of joint '{}'; a link "
                              "hangs on one joint, remove the other",
                              child, carrier->second.joint, name));
    return false;
  }

  /// "" if there is none, which is told.
  std::string LinkOf(const XMLElement& joint, const std::string& name, const char* role) {
    const XMLElement* element = joint.FirstChildElement(role);
    if (element == nullptr) {
      problems_.Add(joint.GetLineNum(),
                    fmt::format("joint '{0}' has no <{1}>; add <{1} link=\"...\"/>", name, role));
      return "";
    }
    const std::string link = Attribute(*element, "link");
    if (link.empty() || outline_.link_lines.count(link) > 0) return link;
    problems_.Add(element->GetLineNum(),
                  fmt::format("joint '{}': {}", name,
                              base::UnknownName(fmt::format("{} link", role), link, LinkNames())));
    return "";
  }

  /// Going up from a link ends at a root, or at a link where it was before.
  void CheckLoops() {
    std::map<std::string, int> met;  // link -> the walk that came there
    int walk = 0;
    for (const auto& [name, line] : outline_.link_lines) {
      ++walk;
      std::string at = name;
      auto up = carriers_.find(at);
      for (; up != carriers_.end() && met.emplace(at, walk).second; up = carriers_.find(at))
        at = up->second.parent;
      if (up == carriers_.end() || met[at] != walk) continue;
      problems_.Add(line, fmt::format("link '{}' is part of a loop of joints or hangs on one; "
                                      "remove the joint that closes it ('{}')",
                                      name, up->second.joint));
      outline_.useless_joints.insert(up->second.number);
      loose_.insert(at);
      carriers_.erase(up);
    }
  }

  /// What is loose by a joint that is wrong in itself is not told once more.
  void CheckOneRoot() {
    std::vector<std::string> told;
    for (const std::string& name : LinkNames()) {
      if (carriers_.count(name) > 0) continue;
      outline_.roots.push_back(name);
      if (loose_.count(name) == 0) told.push_back(name);
    }
    if (told.size() <= 1 + num_lost_) return;
    problems_.Add(outline_.link_lines.at(told[1]),
                  fmt::format("{} links hang on no joint: '{}'; keep one root and join the others "
                              "to it",
                              told.size(), base::Join(told, "', '")));
  }

  void ReadFriction() {
    base::UrdfFriction read = base::ReadUrdfFriction(*robot_);
    for (const auto& [link, mu] : read.of_links) {
      if (outline_.link_lines.count(link) > 0) outline_.friction[link] = mu;
    }
    for (const base::UrdfFriction::Place& place : read.endless) {
      if (outline_.link_lines.count(place.link) == 0 || !endless_.insert(place.link).second)
        continue;
      outline_.endless_friction.Add(place.line, place.link,
                                    fmt::format("<{}> is infinite or negative", place.element));
    }
    for (const base::UrdfFriction::Place& place : read.wrong) {
      if (outline_.link_lines.count(place.link) == 0) continue;
      problems_.Add(place.line, fmt::format("<{}> holds no friction coefficient; wanted a finite "
                                            "number of at least 0",
                                            place.element));
    }
  }

  void ReadPlugins() {
    for (const auto* gazebo = robot_->FirstChildElement("gazebo"); gazebo != nullptr;
         gazebo = gazebo->NextSiblingElement("gazebo")) {
      for (const auto* plugin = gazebo->FirstChildElement("plugin"); plugin != nullptr;
           plugin = plugin->NextSiblingElement("plugin")) {
        if (const char* file = plugin->Attribute("filename")) outline_.plugins.emplace_back(file);
      }
    }
  }

  struct Carrier {
    std::string parent, joint;
    int number;  ///< of the joint in the file
  };

  UrdfProblems& problems_;
  tinyxml2::XMLDocument document_;
  const XMLElement* robot_{nullptr};
  UrdfOutline outline_;
  std::map<std::string, Carrier> carriers_;  // by child
  std::set<std::string> endless_;            // links whose friction is told
  std::set<std::string> loose_;              // children of useless joints
  std::size_t num_lost_{0};                  // useless joints whose child is not known
};

}  // namespace

UrdfOutline ReadUrdfOutline(const std::string& xml, UrdfProblems* problems) {
  return OutlineReader(xml, problems).Read();
}

}  // namespace hires::robot
