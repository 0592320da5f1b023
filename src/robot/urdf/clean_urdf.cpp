#include "robot/urdf/clean_urdf.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <sstream>

#include "hires/base/check.h"
#include "hires/base/text.h"
#include "hires/geometry/inertia.h"
#include "hires/geometry/pose.h"
#include "robot/urdf/told.h"
#include "robot/urdf/xml_numbers.h"

namespace hires::robot {
namespace {

using tinyxml2::XMLElement;

/// By parent: the elements that are kept.
const std::map<std::string, std::set<std::string>>& Kept() {
  static const std::map<std::string, std::set<std::string>> kept{
      {"robot", {"link", "joint"}},
      {"link", {"inertial", "collision"}},
      {"joint", {"origin", "axis", "parent", "child", "limit", "mimic"}}};
  return kept;
}

constexpr char kNoEnd[] = "1e16", kNoEndBelow[] = "-1e16";  // as others write joints without end
constexpr double kManyTurns = 1e3;  // [rad] that a joint may turn to both sides, and so on and on
constexpr double kFarthestCentre = 1e3;  // [m] of a centre of mass: beyond lies a slip of units

/// Whether a shape is a point or a line. A plate of no height is another thing: something lies on
/// it.
bool IsOfNoSize(const XMLElement& shape) {
  const std::string kind = shape.Name();
  if (kind == "box") {
    const auto size = NumbersIn(shape.Attribute("size"), 3);
    return size && std::count(size->begin(), size->end(), 0.0) >= 2;
  }
  return (kind == "sphere" || kind == "cylinder" || kind == "capsule") &&
         NumberIn(&shape, "radius") == 0.0;
}

/// What makes an <inertial> one that no body has.
struct Doubt {
  std::string why;         ///< empty: none
  bool is_useless{false};  ///< the parser, or what weighs a link, would refuse it
};

Doubt DoubtOf(const XMLElement& inertial) {
  const auto mass = NumberIn(inertial.FirstChildElement("mass"), "value");
  if (!mass) return {"it has no mass that is a number", true};
  const XMLElement* inertia = inertial.FirstChildElement("inertia");
  std::array<double, 6> moments{};
  const char* const names[] = {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"};
  for (int i = 0; i < 6; ++i) {
    const auto moment = NumberIn(inertia, names[i]);
    if (!moment) return {fmt::format("its {} is no number", names[i]), true};
    moments[i] = *moment;
  }
  const auto origin = OriginOf(inertial);
  if (!origin || !origin->IsFinite() ||
      origin->translation.cwiseAbs().maxCoeff() > kFarthestCentre) {
    return {"its origin is not three numbers of metres", true};
  }
  geometry::MassProperties properties;
  properties.mass = *mass;
  properties.I_BBcm << moments[0], moments[1], moments[2], moments[1], moments[3], moments[4],
      moments[2], moments[4], moments[5];
  const bool is_useless =
      !(*mass > 0.0) || Eigen::LLT<Eigen::Matrix3d>(properties.I_BBcm).info() != Eigen::Success;
  return {geometry::WhyUnphysical(properties), is_useless};
}

std::string NameOf(const XMLElement& element) {
  const char* name = element.Attribute("name");
  return name == nullptr ? "" : name;
}

class UrdfCleaner {
 public:
  UrdfCleaner(const std::string& xml, const UrdfOutline& outline, const std::string& where,
              UrdfProblems* problems)
      : where_(where), outline_(outline), problems_(*problems) {
    document_.Parse(xml.data(), xml.size());
    robot_ = document_.FirstChildElement("robot");
    HIRES_CHECK(!document_.Error() && robot_ != nullptr, "the outline was read before");
  }

  CleanUrdf Clean() {
    robot_->DeleteAttribute("version");  // newer ones are refused, whatever stands in them
    DeleteAllBut(Kept().at("robot"), robot_);
    DeleteThose("link", outline_.useless_links);
    DeleteThose("joint", outline_.useless_joints);
    JoinRoots();
    for (XMLElement* link = robot_->FirstChildElement("link"); link != nullptr;
         link = link->NextSiblingElement("link")) {
      CleanLink(link);
    }
    for (XMLElement* joint = robot_->FirstChildElement("joint"); joint != nullptr;
         joint = joint->NextSiblingElement("joint")) {
      CleanJoint(joint);
    }
    Tell();
    tinyxml2::XMLPrinter printer(nullptr, true);
    document_.Print(&printer);
    clean_.xml = printer.CStr();
    return std::move(clean_);
  }

 private:
  static void DeleteAllBut(const std::set<std::string>& kept, XMLElement* parent) {
    for (XMLElement* child = parent->FirstChildElement(); child != nullptr;) {
      XMLElement* next = child->NextSiblingElement();
      if (kept.count(child->Name()) == 0) parent->DeleteChild(child);
      child = next;
    }
  }

  /// @param numbers  which of that name
  void DeleteThose(const char* name, const std::set<int>& numbers) {
    int number = 0;
    for (XMLElement* child = robot_->FirstChildElement(name); child != nullptr; ++number) {
      XMLElement* next = child->NextSiblingElement(name);
      if (numbers.count(number) > 0) robot_->DeleteChild(child);
      child = next;
    }
  }

  void JoinRoots() {
    for (std::size_t i = 1; i < outline_.roots.size(); ++i) {
      XMLElement* joint = robot_->InsertNewChildElement("joint");
      joint->SetAttribute("name", fmt::format("hires_loose_{}", i).c_str());
      joint->SetAttribute("type", "fixed");
      joint->InsertNewChildElement("parent")->SetAttribute("link", outline_.roots[0].c_str());
      joint->InsertNewChildElement("child")->SetAttribute("link", outline_.roots[i].c_str());
    }
  }

  /// Whether an attribute that is there holds `count` numbers; it is told and replaced if not.
  void CheckNumbers(XMLElement* element, const char* attribute, std::size_t count,
                    const std::string& owner, const char* instead) {
    const char* text = element == nullptr ? nullptr : element->Attribute(attribute);
    if (text == nullptr || NumbersIn(text, count)) return;
    problems_.Add(element->GetLineNum(),
                  fmt::format("no valid URDF: {}: {} of its <{}> is '{}', wanted {}", owner,
                              attribute, element->Name(), text,
                              count == 1 ? "a number" : fmt::format("{} numbers", count)));
    element->SetAttribute(attribute, instead);
  }

  /// The same of one that must be there.
  void RequireNumbers(XMLElement* element, const char* attribute, std::size_t count,
                      const std::string& owner, const char* instead) {
    if (element->Attribute(attribute) != nullptr)
      return CheckNumbers(element, attribute, count, owner, instead);
    problems_.Add(element->GetLineNum(),
                  fmt::format("no valid URDF: {}: its <{}> has no {}; add it", owner,
                              element->Name(), attribute));
    element->SetAttribute(attribute, instead);
  }

  void CheckOrigin(XMLElement* element, const std::string& owner) {
    XMLElement* origin = element->FirstChildElement("origin");
    CheckNumbers(origin, "xyz", 3, owner, "0 0 0");
    CheckNumbers(origin, "rpy", 3, owner, "0 0 0");
  }

  /// @return false: of no kind that is known.
  bool CheckShape(XMLElement* shape, const std::string& owner) {
    const std::string kind = shape->Name();
    if (kind == "box") {
      RequireNumbers(shape, "size", 3, owner, "1 1 1");
    } else if (kind == "cylinder") {
      RequireNumbers(shape, "radius", 1, owner, "1");
      RequireNumbers(shape, "length", 1, owner, "1");
    } else if (kind == "sphere") {
      RequireNumbers(shape, "radius", 1, owner, "1");
    } else if (kind == "mesh") {
      CheckNumbers(shape, "scale", 3, owner, "1 1 1");
      if (shape->Attribute("filename") != nullptr) return true;
      problems_.Add(shape->GetLineNum(),
                    fmt::format("no valid URDF: {}: its <mesh> has no filename; add it", owner));
      Stand(shape);
    } else {
      return false;
    }
    return true;
  }

  /// Puts a box in the place of a shape that cannot be read.
  static void Stand(XMLElement* shape) {
    shape->SetName("box");
    shape->SetAttribute("size", "1 1 1");
  }

  void CleanLink(XMLElement* link) {
    DeleteAllBut(Kept().at("link"), link);
    if (XMLElement* inertial = link->FirstChildElement("inertial")) CheckInertial(link, inertial);
    std::vector<int>& lines = clean_.shape_lines[NameOf(*link)];
    const std::string owner = fmt::format("link '{}'", NameOf(*link));
    LeaveOutNothing(link);
    for (XMLElement* collision = link->FirstChildElement("collision"); collision != nullptr;
         collision = collision->NextSiblingElement("collision")) {
      CheckOrigin(collision, owner);
      XMLElement* shape = collision->FirstChildElement("geometry")->FirstChildElement();
      const int line = shape->GetLineNum();
      lines.push_back(line);
      const std::string kind = shape->Name();
      if (kind == "capsule") {
        XMLElement* last = SplitCapsule(link, collision);
        if (last != collision) lines.resize(lines.size() + 2, line);
        collision = last;
      } else if (!CheckShape(shape, owner)) {
        problems_.Add(line, fmt::format("no valid URDF: {}: the collision shape <{}> is not "
                                        "supported; use box, cylinder, sphere, capsule or mesh",
                                        owner, kind));
        Stand(shape);
      }
    }
  }

  /// Collisions that occupy nothing.
  void LeaveOutNothing(XMLElement* link) {
    for (XMLElement* collision = link->FirstChildElement("collision"); collision != nullptr;) {
      XMLElement* next = collision->NextSiblingElement("collision");
      const XMLElement* geometry = collision->FirstChildElement("geometry");
      const XMLElement* shape = geometry == nullptr ? nullptr : geometry->FirstChildElement();
      if (shape == nullptr) {
        shapeless_.Add(collision->GetLineNum(), NameOf(*link), "");
      } else if (IsOfNoSize(*shape)) {
        sizeless_.Add(shape->GetLineNum(), NameOf(*link), shape->Name());
      }
      if (shape == nullptr || IsOfNoSize(*shape)) link->DeleteChild(collision);
      collision = next;
    }
  }

  void CheckInertial(XMLElement* link, XMLElement* inertial) {
    const Doubt doubt = DoubtOf(*inertial);
    if (doubt.why.empty()) return;
    inertials_.Add(inertial->GetLineNum(), NameOf(*link), doubt.why);
    if (doubt.is_useless) link->DeleteChild(inertial);
  }

  void TellCapsule(const XMLElement& link, XMLElement* capsule) {
    problems_.Add(capsule->GetLineNum(),
                  fmt::format("link '{}': a <capsule> has no radius above 0 and length of at least "
                              "0; wanted <capsule radius=\"0.1\" length=\"0.5\"/>",
                              NameOf(link)));
    Stand(capsule);
  }

  /// @return the last of the three that take its place, or itself where it is none.
  XMLElement* SplitCapsule(XMLElement* link, XMLElement* collision) {
    XMLElement* geometry = collision->FirstChildElement("geometry");
    XMLElement* capsule = geometry->FirstChildElement("capsule");
    const auto radius = NumberIn(capsule, "radius"), length = NumberIn(capsule, "length");
    const auto X_LS = OriginOf(*collision);
    if (!radius || !(*radius > 0.0) || !length || *length < 0.0 || !X_LS) {
      TellCapsule(*link, capsule);
      return collision;
    }
    const std::string name = NameOf(*collision);
    const std::string text = fmt::format("{}", *radius);
    // A ball has both ends where there is nothing between them.
    const auto set_shape = [&](XMLElement* in, const char* kind, const std::string& part) {
      XMLElement* shapes = in->FirstChildElement("geometry");
      shapes->DeleteChildren();
      XMLElement* shape = shapes->InsertNewChildElement(kind);
      shape->SetAttribute("radius", text.c_str());
      if (!name.empty()) in->SetAttribute("name", (name + part).c_str());
      return shape;
    };
    XMLElement* last = collision;
    for (const double side : {0.5, -0.5}) {
      XMLElement* ball = collision->DeepClone(&document_)->ToElement();
      link->InsertAfterChild(last, ball);
      set_shape(ball, "sphere", side > 0.0 ? "_top" : "_bottom");
      MoveTo(*X_LS * geometry::Pose3{{0.0, 0.0, side * *length}, Eigen::Quaterniond::Identity()},
             ball);
      last = ball;
    }
    if (*length > 0.0) {
      set_shape(collision, "cylinder", "")
          ->SetAttribute("length", fmt::format("{}", *length).c_str());
    } else {
      set_shape(collision, "sphere", "");
    }
    return last;
  }

  /// A sphere lies the same however it is turned.
  void MoveTo(const geometry::Pose3& pose, XMLElement* collision) {
    XMLElement* origin = collision->FirstChildElement("origin");
    if (origin == nullptr) origin = collision->InsertNewChildElement("origin");
    const Eigen::Vector3d& p = pose.translation;
    origin->SetAttribute("xyz", fmt::format("{} {} {}", p.x(), p.y(), p.z()).c_str());
    origin->DeleteAttribute("rpy");
  }

  void CleanJoint(XMLElement* joint) {
    DeleteAllBut(Kept().at("joint"), joint);
    const std::string owner = fmt::format("joint '{}'", NameOf(*joint));
    const char* type = joint->Attribute("type");
    const std::string kind = type == nullptr ? "" : type;
    CheckOrigin(joint, owner);
    static const std::set<std::string> known{"fixed",      "revolute", "prismatic",
                                             "continuous", "floating", "planar"};
    if (known.count(kind) == 0) {
      problems_.Add(joint->GetLineNum(),
                    fmt::format("no valid URDF: {}: its type is '{}', wanted fixed, revolute, "
                                "continuous or prismatic",
                                owner, kind));
    }
    if (kind == "floating" || kind == "planar")
      loose_.Add(joint->GetLineNum(), NameOf(*joint), kind);
    if (kind != "revolute" && kind != "prismatic" && kind != "continuous") return Fix(joint);
    CheckNumbers(joint->FirstChildElement("axis"), "xyz", 3, owner, "0 0 1");
    for (const char* key : {"multiplier", "offset"})
      CheckNumbers(joint->FirstChildElement("mimic"), key, 1, owner, "1");
    const XMLElement* axis = joint->FirstChildElement("axis");
    if (axis != nullptr && !IsDirection(*axis)) {
      axisless_.Add(axis->GetLineNum(), NameOf(*joint), "");
      return Fix(joint);
    }
    CleanLimit(joint, kind);
  }

  /// What is left of a joint that does not move.
  static void Fix(XMLElement* joint) {
    joint->SetAttribute("type", "fixed");
    DeleteAllBut({"origin", "parent", "child"}, joint);
  }

  static bool IsDirection(const XMLElement& axis) {
    const auto xyz = NumbersIn(axis.Attribute("xyz"), 3);
    if (!xyz) return false;
    const double length = Eigen::Vector3d((*xyz)[0], (*xyz)[1], (*xyz)[2]).norm();
    return length > 1e-6 && std::isfinite(length);
  }

  void CleanLimit(XMLElement* joint, const std::string& kind) {
    XMLElement* limit = joint->FirstChildElement("limit");
    if (limit == nullptr) {
      if (kind == "continuous") return;
      unlimited_.Add(joint->GetLineNum(), NameOf(*joint), kind);
      limit = joint->InsertNewChildElement("limit");
    }
    std::string unusable;
    for (const char* key : {"effort", "velocity"}) {
      const char* text = limit->Attribute(key);
      const auto value = NumberIn(limit, key);
      if (value && *value >= 0.0) continue;
      if (text != nullptr && unusable.empty()) unusable = fmt::format("{} is '{}'", key, text);
      limit->SetAttribute(key, "0");
    }
    if (!unusable.empty()) unusable_.Add(limit->GetLineNum(), NameOf(*joint), unusable);
    if (kind != "continuous") {
      CleanRange(NameOf(*joint), limit);
      if (kind == "revolute" && TurnsOn(*limit)) joint->SetAttribute("type", "continuous");
      return;
    }
    const bool is_range = IsNumberOrLeftOut(*limit, "lower") &&
                          IsNumberOrLeftOut(*limit, "upper") && !IsSwapped(*limit);
    if (is_range) return;
    limit->DeleteAttribute("lower");  // it turns without end
    limit->DeleteAttribute("upper");
  }

  static bool IsNumberOrLeftOut(const XMLElement& element, const char* attribute) {
    return element.Attribute(attribute) == nullptr || NumberIn(&element, attribute).has_value();
  }

  static bool IsSwapped(const XMLElement& limit) {
    return NumberIn(&limit, "lower").value_or(0.0) > NumberIn(&limit, "upper").value_or(0.0);
  }

  /// Limits that no joint reaches: other tools write wheels so.
  static bool TurnsOn(const XMLElement& limit) {
    return NumberIn(&limit, "lower").value_or(0.0) <= -kManyTurns &&
           NumberIn(&limit, "upper").value_or(0.0) >= kManyTurns;
  }

  /// Makes numbers of the lower and the upper end, in this order.
  void CleanRange(const std::string& name, XMLElement* limit) {
    const int line = limit->GetLineNum();
    std::string endless;
    for (const char* key : {"lower", "upper"}) {
      const char* text = limit->Attribute(key);
      const int side = text == nullptr ? 0 : SideWithoutEnd(text);
      if (side == 0) continue;
      if (endless.empty()) endless = fmt::format("{} is '{}'", key, text);
      limit->SetAttribute(key, side > 0 ? kNoEnd : kNoEndBelow);
    }
    if (!endless.empty()) endless_.Add(line, name, endless);
    for (const char* key : {"lower", "upper"}) {
      if (IsNumberOrLeftOut(*limit, key)) continue;
      wordy_.Add(line, name, fmt::format("{} is '{}'", key, limit->Attribute(key)));
      limit->DeleteAttribute("lower");  // both are 0 then
      limit->DeleteAttribute("upper");
    }
    if (!IsSwapped(*limit)) return;
    const double lower = NumberIn(limit, "lower").value_or(0.0);
    const double upper = NumberIn(limit, "upper").value_or(0.0);
    swapped_.Add(line, name, fmt::format("lower is {} and upper {}", lower, upper));
    limit->SetAttribute("lower", fmt::format("{}", upper).c_str());
    limit->SetAttribute("upper", fmt::format("{}", lower).c_str());
  }

  /// 1 for "inf", -1 for "-inf", 0 for all else, in any spelling that a number may have.
  static int SideWithoutEnd(const std::string& text) {
    std::istringstream in(base::ToLower(text));
    std::string word, more;
    in >> word;
    if (in >> more) return 0;
    const bool is_below = !word.empty() && word[0] == '-';
    if (!word.empty() && (word[0] == '-' || word[0] == '+')) word.erase(0, 1);
    if (word != "inf" && word != "infinity" && word != ".inf") return 0;
    return is_below ? -1 : 1;
  }

  void Tell() const {
    inertials_.Tell(where_, "impossible_inertia",
                    "no body has such masses or inertias; nothing here uses them");
    shapeless_.Tell(where_, "without_shape",
                    "a <collision> whose <geometry> has no shape is left out");
    sizeless_.Tell(where_, "without_size", "a shape of size 0 occupies nothing and is left out");
    loose_.Tell(where_, "taken_as_fixed", "the base moves by itself, such joints do not");
    unlimited_.Tell(where_, "held_at_0",
                    "a joint that turns or slides needs a <limit>, which these have not");
    wordy_.Tell(where_, "unreadable_limits",
                "a limit that is no number says nothing, so that such a joint is held at 0");
    swapped_.Tell(where_, "limits_swapped", "a lower limit above the upper one changes with it");
    endless_.Tell(where_, "without_end", "a joint without end may go to 1e16, or turns on and on");
    unusable_.Tell(
        where_, "unusable_limits",
        "efforts and velocities that are no numbers of at least 0 are taken as not said");
    axisless_.Tell(where_, "without_axis", "a joint whose axis is no direction does not move");
  }

  std::string where_;
  const UrdfOutline& outline_;
  UrdfProblems& problems_;
  tinyxml2::XMLDocument document_;
  XMLElement* robot_{nullptr};
  CleanUrdf clean_;
  Told inertials_, shapeless_, sizeless_, loose_, unlimited_;
  Told wordy_, swapped_, endless_, unusable_, axisless_;
};

}  // namespace

bool IsKept(const std::string& parent, const std::string& child) {
  const auto kept = Kept().find(parent);
  return kept == Kept().end() || kept->second.count(child) > 0;
}

CleanUrdf CleanedUrdf(const std::string& xml, const UrdfOutline& outline, const std::string& where,
                      UrdfProblems* problems) {
  return UrdfCleaner(xml, outline, where, problems).Clean();
}

}  // namespace hires::robot
