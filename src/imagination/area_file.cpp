#include "imagination/area_file.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/radians.h"
#include "hires/base/short_text.h"
#include "hires/base/text.h"
#include "imagination/area_keys.h"

namespace hires::imagination {
namespace {

using area_keys::Find;
using area_keys::NumbersOf;

constexpr double kLengthSlack = 0.1;  // of a quaternion, which people round
constexpr char kNoTurn[] = "goals without an orientation have a yaw of 0";
constexpr int kDeepest = 16;         // maps and lists in one another
constexpr int kMostNodes = 200'000;  // an alias may stand for many
constexpr std::size_t kMostAreas = 2000, kMostNamed = 10;
constexpr double kSamePose = 1e-9;  // [m], [rad]

/// What a goal is wrapped in.
const std::vector<std::string> kWrappers{"target_pose", "goal_pose", "pose",  "goal",
                                         "node",        "waypoint",  "target"};

int LineOf(const YAML::Node& node) { return node.Mark().line + 1; }

/// Of a turn about z alone, where its numbers are all there is of it.
struct Quaternion {
  double x, y, z, w;

  double length() const { return std::sqrt(x * x + y * y + z * z + w * w); }
  double yaw() const { return std::atan2(2.0 * (w * z + x * y), w * w + x * x - y * y - z * z); }
  /// How far up the robot's z axis points, from -1 to 1.
  double up() const { return 1.0 - 2.0 * (x * x + y * y) / (length() * length()); }
};

/// Of a quaternion in a list, which number is w. Nav2's panel for RViz writes it first.
enum class Order { kWFirst, kWLast };

Quaternion InOrder(const std::vector<double>& q, Order order) {
  return order == Order::kWFirst ? Quaternion{q[1], q[2], q[3], q[0]}
                                 : Quaternion{q[0], q[1], q[2], q[3]};
}

/// The order in which all of a file's quaternions turn robots that stand on the floor. Near 0 and
/// near a half turn they do so in both: then the one in which they turn about z more exactly, and
/// of numbers that leave it open, (0, 0, 0, 1), the order in which they turn nothing.
/// @return nothing: there is none.
std::optional<Order> OrderOf(const std::vector<std::vector<double>>& turns) {
  double tilt[2] = {0.0, 0.0};
  bool fits[2] = {true, true};
  for (const std::vector<double>& turn : turns) {
    for (const Order order : {Order::kWFirst, Order::kWLast}) {
      const Quaternion q = InOrder(turn, order);
      tilt[static_cast<int>(order)] += (q.x * q.x + q.y * q.y) / (q.length() * q.length());
      fits[static_cast<int>(order)] &= q.up() > 0.5;
    }
  }
  if (!fits[0] && !fits[1]) return std::nullopt;
  const bool is_open = fits[0] && fits[1] && !turns.empty();
  if (!is_open) return fits[0] ? Order::kWFirst : Order::kWLast;
  return tilt[0] < tilt[1] ? Order::kWFirst : Order::kWLast;
}

/// Where names may begin and numbers do not.
bool BeginsAsName(const YAML::Node& node) {
  if (!node.IsScalar() || node.Scalar().empty()) return false;
  return node.Scalar().find_first_of("0123456789+-.[{") != 0;
}

/// {x, y, z} or [x, y, z] before {x, y, z, w}, [x, y, z, w] or [roll, pitch, yaw] of one goal.
/// @param is_named  by a word for one goal; else lists of three are goals.
bool IsPair(const YAML::Node& node, bool is_named) {
  if (!node.IsSequence() || node.size() != 2) return false;
  const YAML::Node p = node[0], turn = node[1];
  if (p.IsMap() && turn.IsMap())
    return area_keys::FlatPositionIn(p)[0] && !Find(p, {"w"}) && Find(turn, {"w"}) &&
           Find(turn, {"z"});
  if (!p.IsSequence() || !turn.IsSequence()) return false;
  const std::vector<double> numbers = NumbersOf(p), angles = NumbersOf(turn);
  if (numbers.size() != 2 && numbers.size() != 3) return false;
  if (angles.size() == 4) return true;
  return is_named && numbers.size() == 3 && numbers[2] == 0.0 && angles.size() == 3 &&
         angles[0] == 0.0 && angles[1] == 0.0;
}

/// Of one goal, by its name: "goals" and "patrol" hold several.
bool NamesOne(const std::string& name) {
  const std::string lower = base::ToLower(name);
  if (lower.empty() || lower.back() == 's') return false;
  constexpr const char* kOfSeveral[] = {"list",    "patrol",   "route", "path", "tour",
                                        "mission", "sequence", "loop",  "round"};
  return std::none_of(std::begin(kOfSeveral), std::end(kOfSeveral),
                      [&](const char* word) { return lower.find(word) != std::string::npos; });
}

bool LooksLikePose(const YAML::Node& node) {
  if (node.IsScalar()) {
    const std::size_t size = NumbersOf(node).size();
    return size == 3 || size == 7;
  }
  if (node.IsSequence()) {
    const std::size_t size = node.size();
    return size > 0 && node[0].IsScalar() && NumbersOf(node).size() == size;
  }
  if (!node.IsMap()) return false;
  if (area_keys::FlatPositionIn(node)[0] || area_keys::PositionIn(node)) return true;
  const YAML::Node pose = Find(node, {"pose"});
  return pose && (pose.IsSequence() || LooksLikePose(pose));
}

/// Whether it is a goal, or has one in it: then what stands beside it is not all there is.
bool HoldsPose(const YAML::Node& node) {
  if (LooksLikePose(node)) return true;
  if (node.IsSequence()) return std::any_of(node.begin(), node.end(), LooksLikePose);
  return node.IsMap() && std::any_of(node.begin(), node.end(),
                                     [](const auto& entry) { return LooksLikePose(entry.second); });
}

/// [dock, 1, 2, 0.5], or [dock, [1, 2, 0.5]] with any pose.
bool IsNamedList(const YAML::Node& node) {
  if (!node.IsSequence() || node.size() < 2 || !BeginsAsName(node[0])) return false;
  if (node.size() == 2) return !node[1].IsScalar() && LooksLikePose(node[1]);
  return node.size() == 4 || node.size() == 8;
}

class AreaReader {
 public:
  explicit AreaReader(const std::string& path) : path_(path) {}

  std::vector<NamedArea> Read() {
    const std::vector<YAML::Node> documents = Documents();
    AreaReader first(path_);  // the order of a quaternion's numbers is one for the whole file
    first.WalkAll(documents);
    order_ = OrderOf(first.turns_);
    WalkAll(documents);
    for (const auto& [what, places] : noted_) {
      base::Log(base::LogLevel::kWarn,
                fmt::format("{}:{}: {} ({} in all)", path_, places.first, what, places.count));
    }
    passed_keys_.Tell(path_, "which say nothing of a goal; wanted x, y [m] and yaw [rad]");
    passed_parts_.Tell(path_, "which by their names hold no goals");
    beside_.Tell(path_, "which stand beside the one place of a goal");
    unread_.Tell(path_,
                 "of which no goal could be made; wanted name: [x, y, yaw] [m, m, rad], in numbers "
                 "alone");
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

  /// Keys that are left aside, told in one sentence.
  struct Passed {
    std::vector<std::string> keys;
    int first{0};

    void Add(const std::string& key, int line) {
      if (keys.empty()) first = line;
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
    }
    void Tell(const std::string& path, const char* why) const {
      if (keys.empty()) return;
      const std::size_t num_named = std::min(keys.size(), kMostNamed);
      const std::string more =
          keys.size() > num_named ? fmt::format(" and {} more", keys.size() - num_named) : "";
      base::Log(
          base::LogLevel::kWarn,
          fmt::format("{}:{}: passes over '{}'{}, {}", path, first,
                      base::Join({keys.begin(), keys.begin() + num_named}, "', '"), more, why));
    }
  };

  void WalkAll(const std::vector<YAML::Node>& documents) {
    for (const YAML::Node& document : documents) {
      RefuseMap(document);
      Walk(document, "", 0);
    }
  }

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
    if (!node.IsMap()) return WalkInside(node, name, depth);
    if (area_keys::IsGeoJson(node)) return WalkGeoJson(node);
    CheckFrame(node);
    const double outer = unit_;
    const int num_before = num_goals_;
    const area_keys::Unit unit = area_keys::UnitIn(node);
    if (unit.factor) {
      unit_ = *unit.factor;
    } else if (unit.said) {
      Fail(LineOf(unit.said), fmt::format("'{}' is no unit of angles, wanted rad or deg",
                                          unit.said.IsScalar() ? unit.said.Scalar() : "a list"));
    }
    WalkInside(node, name, depth);
    if (unit.factor && unit_ != 1.0 && num_goals_ == num_before) {
      const std::string what = "says degrees where no goal is; write it beside the goals or above";
      unit.is_of_angles ? Fail(LineOf(unit.said), what) : Note(LineOf(unit.said), what);
    }
    unit_ = outer;
  }

  /// Its points, as of Nav2's graphs of routes; the lines between them are no goals.
  void WalkGeoJson(const YAML::Node& collection) {
    const auto part = [](const YAML::Node& node, const char* key) {
      return node.IsMap() ? Find(node, {key}) : YAML::Node(YAML::NodeType::Undefined);
    };
    for (const YAML::Node& feature : Find(collection, {"features"})) {
      const YAML::Node form = part(feature, "geometry"), kind = part(form, "type");
      const std::string name = kind && kind.IsScalar() ? kind.Scalar() : "features";
      const int line = LineOf(feature);
      if (name != "Point") {
        passed_parts_.Add(name, line);
        continue;
      }
      const std::vector<double> p = NumbersOf(part(form, "coordinates"));
      if (p.size() != 2 && p.size() != 3) {
        Fail(line, "a Point without coordinates in numbers, wanted [x, y] [m]");
        continue;
      }
      Note(line, "coordinates of GeoJSON are taken for metres in the map");
      const YAML::Node properties = part(feature, "properties");
      Keep(properties.IsMap() ? area_keys::NameIn(properties) : "", line,
           Pose(line, p[0], p[1], std::nullopt));
    }
  }

  void WalkInside(const YAML::Node& node, const std::string& name, int depth) {
    if (LooksLikePose(node)) return Add(node, name);
    if (node.IsScalar()) num_numbers_ += area_keys::CountNumbers(node);
    if (node.IsMap()) return WalkMap(node, name, depth);
    if (!node.IsSequence()) return;
    if (IsPair(node, NamesOne(name))) return Keep(name, LineOf(node), PoseOfPair(node));
    if (IsNamedList(node)) {
      const std::string own = node[0].Scalar();
      if (node.size() == 2) return Walk(node[1], own, depth + 1);
      const std::vector<double> numbers = NumbersAfterName(node);
      if (!numbers.empty()) return Keep(own, LineOf(node), PoseOfNumbers(numbers, LineOf(node)));
    }
    for (const YAML::Node& item : node) WalkPart(item, "", LineOf(item), depth + 1);
  }

  /// Says of it if it holds numbers, and no goal comes of them.
  /// @param name  that it gives its goal; empty: it is an item of a list.
  void WalkPart(const YAML::Node& part, const std::string& name, int line, int depth) {
    const int num_goals = num_goals_, num_numbers = num_numbers_;
    const std::size_t num_unread = unread_.keys.size();
    Walk(part, name, depth);
    if (num_goals_ != num_goals || num_numbers_ - num_numbers < 2) return;
    unread_.keys.resize(num_unread);  // they lie within it
    unread_.Add(fmt::format("{} (line {})", name.empty() ? "an item" : name, line), line);
  }

  static std::vector<double> NumbersAfterName(const YAML::Node& list) {
    std::vector<double> numbers;
    for (std::size_t i = 1; i < list.size(); ++i) {
      const auto number = area_keys::NumberIn(list[i]);
      if (!number) return {};
      numbers.push_back(*number);
    }
    return numbers;
  }

  /// What a goal is wrapped in says nothing; beside it may stand what only looks like goals. Where
  /// no name stands beside it, and other goals do, it is a name itself.
  static YAML::Node WrappedIn(const YAML::Node& map, int depth) {
    for (const std::string& wrapper : kWrappers) {
      const YAML::Node inner = Find(map, {wrapper});
      const bool is_named = !area_keys::NameIn(map).empty();
      if (!inner || !(inner.IsMap() || (LooksLikePose(inner) && (depth > 0 || is_named)))) continue;
      const bool is_one = std::none_of(map.begin(), map.end(), [&](const auto& entry) {
        return !entry.second.is(inner) && !area_keys::IsNoGoal(entry.first.Scalar()) &&
               HoldsPose(entry.second);
      });
      if (is_named || is_one) return inner;
    }
    return YAML::Node(YAML::NodeType::Undefined);
  }

  void WalkMap(const YAML::Node& map, const std::string& name, int depth) {
    const std::string own = OwnName(map, name);
    if (const YAML::Node inner = WrappedIn(map, depth)) {
      for (const auto& entry : map) {
        if (entry.second.is(inner) || !HoldsPose(entry.second)) continue;
        const std::string key = entry.first.Scalar();
        (area_keys::IsNoGoal(key) ? passed_parts_ : beside_).Add(key, LineOf(entry.first));
      }
      return Walk(inner, own, depth + 1);
    }
    std::set<std::string> done{"header", "info"};
    for (const area_keys::ParallelLists& lists : area_keys::ParallelListsIn(map)) {
      AddParallel(lists);
      done.insert(lists.keys.begin(), lists.keys.end());
    }
    for (const auto& entry : map) {
      const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "";
      if (done.count(base::ToLower(key)) > 0) continue;
      if (area_keys::IsNoGoal(key)) {
        if (!entry.second.IsScalar()) passed_parts_.Add(key, LineOf(entry.first));
      } else {
        WalkPart(entry.second, key, LineOf(entry.first), depth + 1);
      }
    }
  }

  void AddParallel(const area_keys::ParallelLists& lists) {
    const std::vector<double> x = NumbersOf(lists.x), y = NumbersOf(lists.y);
    const std::vector<double> yaw =
        lists.yaw.value ? NumbersOf(lists.yaw.value) : std::vector<double>(x.size(), 0.0);
    const int line = LineOf(lists.x);
    if (x.size() != y.size() || x.size() != yaw.size()) {
      return Fail(line, fmt::format("'{}' and the lists of y and yaw beside it have {}, {} and {} "
                                    "numbers, wanted as many in each",
                                    lists.x_key, x.size(), y.size(), yaw.size()));
    }
    for (std::size_t i = 0; i < x.size(); ++i) {
      const auto turn =
          lists.yaw.value ? std::make_optional(FactorOf(lists.yaw) * yaw[i]) : std::nullopt;
      Keep("", line, Pose(line, x[i], y[i], turn));
    }
  }

  static std::string OwnName(const YAML::Node& map, const std::string& otherwise) {
    const std::string own = area_keys::NameIn(map);
    return own.empty() ? otherwise : own;
  }

  /// Numbers mean something else in other frames.
  void CheckFrame(const YAML::Node& map) {
    const YAML::Node frame = area_keys::FrameIn(map);
    if (!frame) return;
    std::string name = frame.Scalar();
    if (!name.empty() && name[0] == '/') name.erase(0, 1);
    if (name.empty() || name == "map") return;
    const std::string last = name.substr(name.rfind('/') + 1);  // robots put their names before it
    if (last == "odom" || last == "odom_combined" || last.rfind("base_", 0) == 0) {
      Fail(LineOf(frame), fmt::format("frame_id is '{}', wanted map: odometry drifts and the base "
                                      "moves; give the goals in the map",
                                      name));
    } else {
      Note(LineOf(frame), fmt::format("frame '{}' is taken for the map's", name));
    }
  }

  void Add(const YAML::Node& node, const std::string& given) {
    const std::string own = node.IsMap() ? OwnName(node, given) : given;
    Keep(own, LineOf(node), node.IsMap() ? PoseOfMap(node) : PoseOfList(node));
  }

  /// @param pose  nothing where an error says why.
  void Keep(const std::string& own, int line, const std::optional<geometry::Pose2>& pose) {
    ++num_goals_;
    const std::string name = own.empty() ? fmt::format("goal{}", ++num_unnamed_) : own;
    if (name.find_first_of(",:()") != std::string::npos) {
      Fail(line, fmt::format("'{}' is called with one of , : ( ), which mean something else in "
                             "options; rename it",
                             name));
    }
    const auto [known, is_new] = lines_.emplace(base::ToLower(name), line);
    if (!is_new && pose && IsKept(name, *pose)) {
      height_.reset();
      return Note(line, "goals that are there again, with the same name and pose, are kept once");
    }
    if (!is_new) {
      Fail(line, fmt::format("'{}' is there twice, first in line {} (case is ignored)", name,
                             known->second));
    }
    if (lines_.size() > kMostAreas) {
      throw base::ConfigError(
          fmt::format("{}:{}: has more than {} goals; leave those out that are no question", path_,
                      line, kMostAreas));
    }
    if (pose) {
      kept_.emplace(base::ToLower(name), areas_.size());
      areas_.push_back({name, *pose, height_});
    }
    height_.reset();
  }

  /// As a round comes back to where it began.
  bool IsKept(const std::string& name, const geometry::Pose2& pose) const {
    const auto kept = kept_.find(base::ToLower(name));
    if (kept == kept_.end()) return false;
    const NamedArea& area = areas_[kept->second];
    return area.z == height_ && std::abs(area.X_MA.x - pose.x) < kSamePose &&
           std::abs(area.X_MA.y - pose.y) < kSamePose &&
           std::abs(area.X_MA.yaw - pose.yaw) < kSamePose;
  }

  std::optional<geometry::Pose2> PoseOfList(const YAML::Node& list) {
    return PoseOfNumbers(NumbersOf(list), LineOf(list));
  }

  std::optional<geometry::Pose2> PoseOfNumbers(const std::vector<double>& n, int line) {
    if (n.size() == 2) return Pose(line, n[0], n[1], std::nullopt);
    if (n.size() == 3) return Checked(line, {n[0], n[1], unit_ * n[2]});
    if (n.size() == 7) {
      const std::optional<double> yaw = YawOf({n[3], n[4], n[5], n[6]}, false, line);
      if (!yaw) return std::nullopt;
      TakeHeight(line, n[2]);
      return Pose(line, n[0], n[1], yaw);
    }
    Fail(line, fmt::format("a list of {} numbers, wanted [x, y, yaw] [m, m, rad], or 7: position "
                           "and quaternion (x, y, z, w)",
                           n.size()));
    return std::nullopt;
  }

  /// @param is_called_so  then it may have any length, and 0 in messages that were never filled.
  /// @return nothing where an error says why.
  std::optional<double> YawOf(const Quaternion& q, bool is_called_so, int line) {
    if (is_called_so && q.length() == 0.0) {
      Note(line, kNoTurn);
      return 0.0;
    }
    if (!is_called_so && std::abs(q.length() - 1.0) > kLengthSlack) {
      Fail(line, fmt::format("({:g}, {:g}, {:g}, {:g}) is no quaternion x, y, z, w: its length is "
                             "{:.3g}, wanted 1",
                             q.x, q.y, q.z, q.w, q.length()));
      return std::nullopt;
    }
    if (q.up() > 0.5) return q.yaw();
    Fail(line, fmt::format("quaternion ({:g}, {:g}, {:g}, {:g}) turns the robot over; wanted its "
                           "numbers in the order x, y, z, w",
                           q.x, q.y, q.z, q.w));
    return std::nullopt;
  }

  std::optional<geometry::Pose2> PoseOfMap(const YAML::Node& map) {
    const int line = LineOf(map);
    for (const std::string& key : area_keys::UnknownIn(map)) passed_keys_.Add(key, line);
    const YAML::Node inner = Find(map, {"pose"}), own = area_keys::PositionIn(map);
    if (inner && !own && !area_keys::FlatPositionIn(map)[0]) {
      if (!inner.IsMap()) return PoseOfPanel(map, inner);
      CheckFrame(inner);
      return PoseOfMap(inner);
    }
    if (own && own.IsMap()) CheckFrame(own);
    const auto position = PositionOf(own ? own : map);
    if (!position) return std::nullopt;
    bool is_wrong = false;
    auto yaw = TurnOf(map, own.IsDefined(), &is_wrong);
    if (!yaw && !is_wrong && own && own.IsMap()) yaw = TurnOf(own, false, &is_wrong);
    if (is_wrong) return std::nullopt;
    if (position->size() == 3 && !IsOfQuaternion(own ? own : map)) {
      if (!yaw && own && own.IsSequence() && !area_keys::HasHeight(map) && (*position)[2] != 0.0) {
        Fail(line, fmt::format("its third number, {:g}, is a yaw or a height; write x, y and yaw "
                               "[m, m, rad] by name",
                               (*position)[2]));
        return std::nullopt;
      }
      TakeHeight(LineOf(own ? own : map), (*position)[2]);
    }
    return Pose(line, (*position)[0], (*position)[1], yaw);
  }

  /// {pose: [x, y, z], orientation: [w, x, y, z]} of Nav2's panel, or a list alone, or with
  /// another turn beside it.
  std::optional<geometry::Pose2> PoseOfPanel(const YAML::Node& map, const YAML::Node& list) {
    const int line = LineOf(map);
    const YAML::Node beside = area_keys::OrientationIn(map).value;
    std::optional<double> yaw;
    bool is_wrong = false;
    if (beside && beside.IsSequence() && NumbersOf(beside).size() == 4) {
      yaw = YawOfPanel(NumbersOf(beside), line);
      is_wrong = !yaw;
    } else {
      yaw = TurnOf(map, true, &is_wrong);
      if (!yaw && !is_wrong) return IsPair(list, true) ? PoseOfPair(list) : PoseOfList(list);
    }
    if (is_wrong) return std::nullopt;
    const std::vector<double> p = NumbersOf(list);
    if (p.size() != 2 && p.size() != 3) {
      Fail(line, "wanted pose: [x, y, z] with orientation: [w, x, y, z]");
      return std::nullopt;
    }
    if (p.size() == 3) TakeHeight(line, p[2]);
    return Pose(line, p[0], p[1], yaw);
  }

  std::optional<double> YawOfPanel(const std::vector<double>& q, int line) {
    const Quaternion turn = InOrder(q, order_.value_or(Order::kWFirst));
    if (turn.length() == 0.0) return YawOf(turn, true, line);
    turns_.push_back(q);
    if (order_ == Order::kWLast) {
      Note(line,
           "orientations beside pose: [x, y, z] are taken in the order x, y, z, w, which suits all "
           "of them as well or better; Nav2's panel writes w first: write a yaw [rad] if that is "
           "meant");
    }
    if (order_ || turn.up() > 0.5) return YawOf(turn, true, line);
    Fail(line, fmt::format("orientation [{:g}, {:g}, {:g}, {:g}] turns the robot over in the order "
                           "w, x, y, z, which is wanted, and in no other do all of the file turn "
                           "it about z; write yaw [rad] instead",
                           q[0], q[1], q[2], q[3]));
    return std::nullopt;
  }

  /// @pre IsPair(pair, ...).
  std::optional<geometry::Pose2> PoseOfPair(const YAML::Node& pair) {
    const int line = LineOf(pair);
    const auto position = PositionOf(pair[0]);
    bool is_wrong = false;
    const auto yaw = OrientationOf({pair[1], 1.0, false}, &is_wrong);
    if (!position || is_wrong) return std::nullopt;
    Note(line, "two parts of a list are taken for the position and the orientation of one goal");
    if (position->size() == 3) TakeHeight(line, (*position)[2]);
    return Pose(line, (*position)[0], (*position)[1], yaw);
  }

  /// Two numbers, or three.
  std::optional<std::vector<double>> PositionOf(const YAML::Node& node) {
    std::vector<double> p;
    if (node.IsSequence()) {
      p = NumbersOf(node);
    } else if (node.IsMap()) {
      YAML::Node list(YAML::NodeType::Sequence);
      for (const YAML::Node& number : area_keys::FlatPositionIn(node)) {
        if (number) list.push_back(number);
      }
      p = NumbersOf(list);
    }
    if (p.size() == 2 || p.size() == 3) return p;
    Fail(LineOf(node), "has no position in numbers, wanted x and y [m]");
    return std::nullopt;
  }

  /// Whether z and w beside x and y are of a turn about z: w is of nothing else.
  static bool IsOfQuaternion(const YAML::Node& map) {
    return map.IsMap() && Find(map, {"w"}) && Find(map, {"x"});
  }

  /// @param[out] is_wrong  there is one, and it cannot be read; an error says so.
  std::optional<double> TurnOf(const YAML::Node& map, bool has_position, bool* is_wrong) {
    if (const auto own = area_keys::OrientationIn(map); own.value)
      return OrientationOf(own, is_wrong);
    if (const area_keys::Angle angle = area_keys::AngleIn(map); angle.value)
      return Read(angle.value, FactorOf(angle), is_wrong);
    const auto beside = area_keys::FlatQuaternionIn(map);
    if (beside[3]) return QuaternionOf(beside, true, is_wrong);
    const YAML::Node none(YAML::NodeType::Undefined);
    if (!has_position && IsOfQuaternion(map))
      return QuaternionOf({none, none, Find(map, {"z"}), Find(map, {"w"})}, false, is_wrong);
    return std::nullopt;
  }

  /// To radians.
  double FactorOf(const area_keys::Angle& angle) const {
    return angle.says_unit ? angle.factor : angle.factor * unit_;
  }

  std::optional<double> OrientationOf(const area_keys::Angle& own, bool* is_wrong) {
    const YAML::Node& turn = own.value;
    const double factor = FactorOf(own);
    if (turn.IsScalar()) return Read(turn, factor, is_wrong);
    if (turn.IsSequence()) {
      const std::vector<double> q = NumbersOf(turn);
      if (q.size() == 3) return YawOfAngles(q, factor, LineOf(turn), is_wrong);
      if (q.size() == 1) return factor * q[0];
      if (q.size() == 4) {
        const auto yaw = YawOf({q[0], q[1], q[2], q[3]}, true, LineOf(turn));
        *is_wrong |= !yaw;
        return yaw;
      }
    } else if (turn.IsMap()) {
      if (const area_keys::Angle angle = area_keys::AngleIn(turn); angle.value)
        return Read(angle.value, own.says_unit && !angle.says_unit ? factor : FactorOf(angle),
                    is_wrong);
      const std::array<YAML::Node, 4> xyzw{Find(turn, {"x", "qx"}), Find(turn, {"y", "qy"}),
                                           Find(turn, {"z", "qz"}), Find(turn, {"w", "qw"})};
      if (xyzw[2] || xyzw[3]) return QuaternionOf(xyzw, true, is_wrong);
    }
    *is_wrong = true;
    Fail(LineOf(turn),
         "has no orientation in numbers, wanted x, y, z, w of a quaternion, or a yaw");
    return std::nullopt;
  }

  /// @param angles  roll, pitch and yaw.
  std::optional<double> YawOfAngles(const std::vector<double>& angles, double factor, int line,
                                    bool* is_wrong) {
    if (std::cos(factor * angles[0]) * std::cos(factor * angles[1]) > 0.5)
      return factor * angles[2];
    *is_wrong = true;
    Fail(line, fmt::format("roll {:g} and pitch {:g} turn the robot over; wanted [roll, pitch, "
                           "yaw] [rad], as it stands on the floor",
                           angles[0], angles[1]));
    return std::nullopt;
  }

  /// What is not there is 0.
  std::optional<double> QuaternionOf(const std::array<YAML::Node, 4>& xyzw, bool is_called_so,
                                     bool* is_wrong) {
    std::array<double, 4> q{};
    int line = 0;
    for (int i = 0; i < 4; ++i) {
      if (!xyzw[i]) continue;
      line = LineOf(xyzw[i]);
      const auto number = Read(xyzw[i], 1.0, is_wrong);
      if (!number) return std::nullopt;
      q[i] = *number;
    }
    const std::optional<double> yaw = YawOf({q[0], q[1], q[2], q[3]}, is_called_so, line);
    *is_wrong |= !yaw;
    return yaw;
  }

  std::optional<double> Read(const YAML::Node& node, double factor, bool* is_wrong) {
    double value = 0.0;
    if (node.IsScalar() && YAML::convert<double>::decode(node, value) && std::isfinite(value))
      return factor * value;
    *is_wrong = true;
    Fail(LineOf(node),
         "has no orientation in numbers, wanted a yaw [rad], or x, y, z, w of a quaternion");
    return std::nullopt;
  }

  /// Tools write 0 where nobody means a height.
  void TakeHeight(int line, double z) {
    if (std::abs(z) <= 1e-3) return;
    height_ = z;
    Note(line,
         "heights (z) of goals say no more than which one is meant of floors that lie over "
         "one another: robots stand on the floor");
  }

  std::optional<geometry::Pose2> Pose(int line, double x, double y, std::optional<double> yaw) {
    if (!yaw) Note(line, kNoTurn);
    return Checked(line, {x, y, yaw.value_or(0.0)});
  }

  std::optional<geometry::Pose2> Checked(int line, const geometry::Pose2& X_MA) {
    const std::optional<std::string> why = base::WhyNoRadians(X_MA.yaw);
    if (!why) return X_MA;
    Fail(line, "its yaw " + *why);
    return std::nullopt;
  }

  const std::string& path_;
  std::vector<NamedArea> areas_;
  std::vector<std::string> errors_;
  std::map<std::string, Places> noted_;
  Passed passed_keys_, passed_parts_, beside_, unread_;
  std::map<std::string, int> lines_;         // of names, in lower case
  std::map<std::string, std::size_t> kept_;  // of names likewise, in areas_
  std::optional<double> height_;             // [m] of the goal that is being read
  std::optional<Order> order_{Order::kWFirst};
  std::vector<std::vector<double>> turns_;  // that YawOfPanel() was asked for, as written
  double unit_{1.0};                        // of angles, to radians
  int num_nodes_{0}, num_unnamed_{0};
  int num_goals_{0}, num_numbers_{0};  // read well or not; in what is no goal
};

}  // namespace

std::vector<NamedArea> ReadAreaFile(const std::string& path) { return AreaReader(path).Read(); }

}  // namespace hires::imagination
