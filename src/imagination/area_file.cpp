#include "imagination/area_file.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <optional>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/short_text.h"
#include "hires/base/text.h"

namespace hires::imagination {
namespace {

constexpr double kFarthest = 1000.0;  // [m] of an area, as in an SDF world
constexpr int kDeepest = 16;          // maps and lists in one another
constexpr int kMostNodes = 200'000;   // an alias may stand for many
constexpr std::size_t kMostAreas = 2000;

int LineOf(const YAML::Node& node) { return node.Mark().line + 1; }

/// The value of the first of these keys that is there; else an undefined node.
YAML::Node Find(const YAML::Node& map, std::initializer_list<const char*> keys) {
  for (const char* key : keys) {
    if (const YAML::Node value = map[key]) return value;
  }
  return YAML::Node(YAML::NodeType::Undefined);
}

/// The numbers of a list, or nothing where it has anything else.
std::vector<double> NumbersOf(const YAML::Node& list) {
  std::vector<double> numbers;
  for (const YAML::Node& item : list) {
    double number = 0.0;
    if (!item.IsScalar() || !YAML::convert<double>::decode(item, number) || !std::isfinite(number))
      return {};
    numbers.push_back(number);
  }
  return numbers;
}

/// About z, of a quaternion of any length; nothing where all its numbers are 0.
std::optional<double> YawOf(double x, double y, double z, double w) {
  if (x == 0.0 && y == 0.0 && z == 0.0 && w == 0.0) return std::nullopt;
  return std::atan2(2.0 * (w * z + x * y), w * w + x * x - y * y - z * z);
}

bool LooksLikePose(const YAML::Node& node) {
  if (node.IsSequence()) {
    const std::size_t size = node.size();
    return size > 0 && node[0].IsScalar() && NumbersOf(node).size() == size;
  }
  if (!node.IsMap()) return false;
  return (node["x"] && node["y"]) || node["position"] ||
         (node["pose"] && (node["pose"].IsSequence() || LooksLikePose(node["pose"])));
}

class AreaReader {
 public:
  explicit AreaReader(const std::string& path) : path_(path) {}

  std::vector<NamedArea> Read() {
    for (const YAML::Node& document : Documents()) {
      RefuseMap(document);
      Walk(document, "", 0);
    }
    for (const auto& [what, places] : noted_) {
      base::Log(base::LogLevel::kWarn,
                fmt::format("{}:{}: {} ({} in all)", path_, places.first, what, places.count));
    }
    if (areas_.empty() && errors_.empty()) {
      errors_.push_back(fmt::format(
          "{}: has no goal; wanted name: [x, y, yaw] [m, m, rad], or poses with position and "
          "orientation, in a list or by name",
          path_));
    }
    if (!errors_.empty()) throw base::ConfigError(base::AllThatIsWrong(path_, errors_));
    return std::move(areas_);
  }

 private:
  struct Places {
    int first, count;
  };

  void Fail(int line, const std::string& what) {
    errors_.push_back(fmt::format("{}:{}: {}", path_, line, what));
  }
  void Note(int line, const std::string& what) {
    ++noted_.emplace(what, Places{line, 0}).first->second.count;
  }

  std::vector<YAML::Node> Documents() const {
    try {
      return YAML::LoadAll(base::ReadTextFile(path_, 4u << 20));
    } catch (const YAML::Exception& error) {
      throw base::ConfigError(
          fmt::format("{}:{}: no valid YAML: {}", path_, error.mark.line + 1, error.msg));
    }
  }

  void RefuseMap(const YAML::Node& document) const {
    if (!document.IsMap() || !document["image"] || !document["resolution"]) return;
    throw base::ConfigError(path_ + ": is a map_server map and no file of goals; --map takes it");
  }

  /// @param name  that a key or a sibling gives what stands here; or empty.
  void Walk(const YAML::Node& node, const std::string& name, int depth) {
    if (depth > kDeepest || ++num_nodes_ > kMostNodes) {
      throw base::ConfigError(
          fmt::format("{}:{}: is too deep or too long for a file of goals", path_, LineOf(node)));
    }
    if (node.IsMap()) CheckFrame(node);
    if (LooksLikePose(node)) return Add(node, name);
    if (node.IsSequence()) {
      for (const YAML::Node& item : node) Walk(item, "", depth + 1);
    }
    if (node.IsMap()) WalkMap(node, name, depth);
  }

  void WalkMap(const YAML::Node& map, const std::string& name, int depth) {
    const std::string own = OwnName(map, name);
    // What a goal is wrapped in says nothing; beside it may stand what only looks like goals.
    for (const char* wrapper : {"target_pose", "goal_pose", "pose", "goal", "node", "waypoint"}) {
      const YAML::Node inner = map[wrapper];
      if (inner && inner.IsMap()) return Walk(inner, own, depth + 1);
    }
    for (const auto& entry : map) {
      if (!entry.second.IsMap() && !entry.second.IsSequence()) continue;
      const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "";
      if (key != "header" && key != "info") Walk(entry.second, key, depth + 1);
    }
  }

  static std::string OwnName(const YAML::Node& map, const std::string& otherwise) {
    const YAML::Node own = Find(map, {"name", "label", "id"});
    return own && own.IsScalar() ? own.Scalar() : otherwise;
  }

  /// Numbers mean something else in other frames.
  void CheckFrame(const YAML::Node& map) {
    const YAML::Node header = map["header"];
    const YAML::Node frame = header && header.IsMap() ? header["frame_id"] : map["frame_id"];
    if (!frame || !frame.IsScalar()) return;
    std::string name = frame.Scalar();
    if (!name.empty() && name[0] == '/') name.erase(0, 1);
    if (name.empty() || name == "map") return;
    if (name == "odom" || name.rfind("base_", 0) == 0) {
      Fail(LineOf(frame), fmt::format("frame_id is '{}', wanted map: odometry drifts and the base "
                                      "moves; give the goals in the map",
                                      name));
    } else {
      Note(LineOf(frame), fmt::format("frame '{}' is taken for the map's", name));
    }
  }

  void Add(const YAML::Node& node, const std::string& given) {
    const std::string own = node.IsMap() ? OwnName(node, given) : given;
    const std::string name = own.empty() ? fmt::format("goal{}", ++num_unnamed_) : own;
    const int line = LineOf(node);
    if (name.find_first_of(",:()") != std::string::npos) {
      Fail(line, fmt::format("'{}' is called with one of , : ( ), which mean something else in "
                             "options; rename it",
                             name));
    }
    const auto [known, is_new] = lines_.emplace(base::ToLower(name), line);
    if (!is_new) {
      Fail(line, fmt::format("'{}' is there twice, first in line {} (case is ignored)", name,
                             known->second));
    }
    if (lines_.size() > kMostAreas) {
      throw base::ConfigError(
          fmt::format("{}:{}: has more than {} goals; leave those out that are no question", path_,
                      line, kMostAreas));
    }
    const auto pose = node.IsMap() ? PoseOfMap(node) : PoseOfList(node);
    if (pose) areas_.push_back({name, *pose});  // else an error says why
  }

  std::optional<geometry::Pose2> PoseOfList(const YAML::Node& list) {
    const std::vector<double> n = NumbersOf(list);
    const int line = LineOf(list);
    if (n.size() == 2) return Pose(line, n[0], n[1], std::nullopt);
    if (n.size() == 3) return Checked(line, {n[0], n[1], n[2]});
    if (n.size() == 7) {
      NoteHeight(line, n[2]);
      return Pose(line, n[0], n[1], YawOf(n[3], n[4], n[5], n[6]));
    }
    Fail(line, fmt::format("a list of {} numbers, wanted [x, y, yaw] [m, m, rad], or 7: position "
                           "and quaternion (x, y, z, w)",
                           n.size()));
    return std::nullopt;
  }

  std::optional<geometry::Pose2> PoseOfMap(const YAML::Node& map) {
    const int line = LineOf(map);
    const YAML::Node inner = map["pose"];
    if (inner && !map["position"] && !(map["x"] && map["y"])) {
      if (inner.IsMap()) return PoseOfMap(inner);
      const YAML::Node turn = map["orientation"];
      if (!turn) return PoseOfList(inner);
      const std::vector<double> p = NumbersOf(inner), q = NumbersOf(turn);
      if ((p.size() == 2 || p.size() == 3) && q.size() == 4) {  // the panel writes w first
        if (p.size() == 3) NoteHeight(line, p[2]);
        return Pose(line, p[0], p[1], YawOf(q[1], q[2], q[3], q[0]));
      }
      Fail(line, "wanted pose: [x, y, z] with orientation: [w, x, y, z]");
      return std::nullopt;
    }
    const auto position = PositionOf(map["position"] ? map["position"] : map);
    if (!position) return std::nullopt;
    bool is_wrong = false;
    const auto yaw = TurnOf(map, &is_wrong);
    if (is_wrong) return std::nullopt;
    return Pose(line, position->x(), position->y(), yaw);
  }

  std::optional<Eigen::Vector2d> PositionOf(const YAML::Node& node) {
    std::vector<double> p;
    if (node.IsSequence()) {
      p = NumbersOf(node);
    } else if (node.IsMap() && node["x"] && node["y"]) {
      YAML::Node list(YAML::NodeType::Sequence);
      for (const char* key : {"x", "y", "z"}) {
        if (node[key]) list.push_back(node[key]);
      }
      p = NumbersOf(list);
    }
    if (p.size() != 2 && p.size() != 3) {
      Fail(LineOf(node), "has no position in numbers, wanted x and y [m]");
      return std::nullopt;
    }
    if (p.size() == 3) NoteHeight(LineOf(node), p[2]);
    return Eigen::Vector2d(p[0], p[1]);
  }

  /// @param[out] is_wrong  there is one, and it cannot be read; an error says so.
  std::optional<double> TurnOf(const YAML::Node& map, bool* is_wrong) {
    const YAML::Node own = Find(map, {"orientation", "rotation", "quaternion"});
    const YAML::Node turn = own ? own : map;
    if (turn.IsSequence()) {
      const std::vector<double> q = NumbersOf(turn);
      if (q.size() == 4) return YawOf(q[0], q[1], q[2], q[3]);
      if (q.size() == 3) return q[2];  // roll, pitch, yaw
      if (q.size() == 1) return q[0];
    } else if (turn.IsMap()) {
      const auto number = [&](const char* key) {
        double value = 0.0;
        if (turn[key]) *is_wrong |= !YAML::convert<double>::decode(turn[key], value);
        return value;
      };
      for (const char* key : {"yaw", "theta", "th", "heading", "angle"}) {
        if (turn[key]) return Read(turn[key], 1.0, is_wrong);
      }
      for (const char* key : {"yaw_deg", "theta_deg", "degrees"}) {
        if (turn[key]) return Read(turn[key], M_PI / 180.0, is_wrong);
      }
      if (!turn["w"]) return std::nullopt;
      // Beside the position only z and w of the quaternion could stand, and z is its height.
      const auto yaw = YawOf(number("x"), number("y"), number("z"), number("w"));
      if (own && !*is_wrong) return yaw;
    } else {
      return Read(turn, 1.0, is_wrong);
    }
    *is_wrong = true;
    Fail(LineOf(turn),
         "has no orientation in numbers, wanted x, y, z, w of a quaternion, or a yaw");
    return std::nullopt;
  }

  std::optional<double> Read(const YAML::Node& node, double factor, bool* is_wrong) {
    double value = 0.0;
    if (node.IsScalar() && YAML::convert<double>::decode(node, value) && std::isfinite(value))
      return factor * value;
    *is_wrong = true;
    Fail(LineOf(node), "has no yaw in numbers, wanted radians");
    return std::nullopt;
  }

  void NoteHeight(int line, double z) {
    if (std::abs(z) > 1e-3)
      Note(line, "heights (z) of goals are left out: robots stand on the floor");
  }

  std::optional<geometry::Pose2> Pose(int line, double x, double y, std::optional<double> yaw) {
    if (!yaw) Note(line, "goals without an orientation have a yaw of 0");
    return Checked(line, {x, y, yaw.value_or(0.0)});
  }

  std::optional<geometry::Pose2> Checked(int line, const geometry::Pose2& X_MA) {
    if (std::abs(X_MA.yaw) > 2.0 * M_PI) {
      Fail(line, fmt::format("yaw is in radians, wanted between -2 pi and 2 pi; {:g} degrees are "
                             "{:.5g}",
                             X_MA.yaw, X_MA.yaw * M_PI / 180.0));
      return std::nullopt;
    }
    return X_MA;
  }

  const std::string& path_;
  std::vector<NamedArea> areas_;
  std::vector<std::string> errors_;
  std::map<std::string, Places> noted_;
  std::map<std::string, int> lines_;  // of names, in lower case
  int num_nodes_{0}, num_unnamed_{0};
};

}  // namespace

std::vector<NamedArea> ReadAreaFile(const std::string& path) { return AreaReader(path).Read(); }

void AddAreas(const std::vector<NamedArea>& areas, world::World* world) {
  for (const NamedArea& area : areas) {
    const std::string key = base::ToLower(area.name);
    if (std::max(std::abs(area.X_MA.x), std::abs(area.X_MA.y)) > kFarthest) {
      throw base::ConfigError(
          fmt::format("area '{}' lies at {:g}, {:g} m, wanted at most {:g} m away", area.name,
                      area.X_MA.x, area.X_MA.y, kFarthest));
    }
    if (!world->frames.emplace(key, geometry::Lift(area.X_MA)).second) {
      throw base::ConfigError(fmt::format(
          "area '{}' is there already, wanted a new name; call it otherwise", area.name));
    }
    world->frame_names[key] = area.name;
  }
}

}  // namespace hires::imagination
