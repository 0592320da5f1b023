#include "imagination/area_keys.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "hires/base/text.h"

namespace hires::imagination::area_keys {
namespace {

using Keys = std::vector<std::string>;

const Keys kNames{"name", "label", "id", "title", "room", "place", "location", "zone", "station"};
const Keys kFrames{"frame_id", "frame"};
const Keys kPositions{"position"};
const Keys kMaybePositions{"translation", "location", "coordinates", "coordinate", "coords",
                           "coord",       "pos",      "point",       "xyz",        "xy"};
const Keys kHeights{"position", "translation", "point", "xyz"};
const Keys kOrientations{"orientation", "rotation", "quaternion", "quat"};
const Keys kRadians{"yaw", "theta", "th", "heading", "angle", "yaw_rad"};
const Keys kDegrees{"yaw_deg", "theta_deg", "heading_deg", "angle_deg", "degrees"};
const Keys kPositionPrefixes{"", "p", "pos_", "position_", "position.", "pose_", "location_"};
const Keys kQuaternionPrefixes{"q", "o", "q_", "quat_", "orientation_", "orientation."};
const Keys kOfNoMatter{"pose",  "header", "stamp",       "seq",     "covariance", "roll",
                       "pitch", "type",   "description", "comment", "w"};

/// A key that ends with one of these holds no place; nor does one that begins so and ends with an
/// axis or a unit.
const std::set<std::string> kNoGoals{
    "tolerance",  "tolerances", "size",       "sizes",   "color",      "colour",   "colors",
    "colours",    "limit",      "limits",     "scale",   "covariance", "rgb",      "rgba",
    "speed",      "speeds",     "velocity",   "polygon", "polygons",   "vertices", "verts",
    "footprint",  "dimension",  "dimensions", "extent",  "extents",    "bounds",   "range",
    "resolution", "gain",       "gains",      "weights", "threshold",  "inflation"};
const std::set<std::string> kUnits{"x", "y", "z", "xy", "xyz", "yaw", "rgb", "rgba", "m", "rad"};

std::string KeyOf(const YAML::Node& key) {
  return key.IsScalar() ? base::ToLower(key.Scalar()) : "";
}

YAML::Node Undefined() { return YAML::Node(YAML::NodeType::Undefined); }

bool Has(const Keys& keys, const std::string& key) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

/// What stands before the last letter, if it is one of these.
std::optional<std::string> PrefixOf(const std::string& key, char last, const Keys& prefixes) {
  if (key.empty() || key.back() != last) return std::nullopt;
  const std::string prefix = key.substr(0, key.size() - 1);
  return Has(prefixes, prefix) ? std::make_optional(prefix) : std::nullopt;
}

bool LooksLikePosition(const YAML::Node& node) {
  if (node.IsMap()) return FlatPositionIn(node)[0].IsDefined();
  const std::size_t size = node.IsSequence() ? NumbersOf(node).size() : 0;
  return size == 2 || size == 3;
}

std::string PositionKeyIn(const YAML::Node& map) {
  if (Find(map, kPositions)) return kPositions[0];
  if (!Find(map, kMaybePositions)) return "";
  const bool is_one =
      !NameIn(map).empty() || OrientationIn(map) || AngleIn(map).value || FlatQuaternionIn(map)[3];
  for (const std::string& key : kMaybePositions) {
    const YAML::Node value = Find(map, {key});
    if (is_one && value && LooksLikePosition(value)) return key;
  }
  return "";
}

Keys With(const Keys& prefixes, const char* end) {
  Keys keys;
  for (const std::string& prefix : prefixes) keys.push_back(prefix + end);
  return keys;
}

bool IsListOfNumbers(const YAML::Node& node) {
  return node.IsDefined() && node.IsSequence() && node.size() > 0 &&
         NumbersOf(node).size() == node.size();
}

/// "goals_" of "goals_x", where there is a list of y, too.
std::optional<std::string> StemOf(const YAML::Node& map, const std::string& key) {
  if (key.empty() || key.back() != 'x') return std::nullopt;
  const std::string stem = key.substr(0, key.size() - 1);
  if (!stem.empty() && stem.back() != '_' && stem.back() != '.') return std::nullopt;
  return IsListOfNumbers(Find(map, {stem + "y"})) ? std::make_optional(stem) : std::nullopt;
}

Keys Known() {
  Keys known = kOfNoMatter;
  for (const Keys& more :
       {kNames, kFrames, kPositions, kMaybePositions, kOrientations, kRadians, kDegrees}) {
    known.insert(known.end(), more.begin(), more.end());
  }
  for (const char* end : {"x", "y", "z"}) {
    for (const std::string& key : With(kPositionPrefixes, end)) known.push_back(key);
  }
  for (const char* end : {"x", "y", "z", "w"}) {
    for (const std::string& key : With(kQuaternionPrefixes, end)) known.push_back(key);
  }
  return known;
}

}  // namespace

YAML::Node Find(const YAML::Node& map, const Keys& keys) {
  std::size_t best = keys.size();
  YAML::Node found = Undefined();
  for (const auto& entry : map) {
    const auto at = std::find(keys.begin(), keys.end(), KeyOf(entry.first));
    const auto rank = static_cast<std::size_t>(at - keys.begin());
    if (rank >= best) continue;
    best = rank;
    found.reset(entry.second);
  }
  return found;
}

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

std::string NameIn(const YAML::Node& map) {
  for (const std::string& key : kNames) {
    const YAML::Node name = Find(map, {key});
    if (name && name.IsScalar()) return name.Scalar();
  }
  return "";
}

YAML::Node FrameIn(const YAML::Node& map) {
  const YAML::Node header = Find(map, {"header"});
  const YAML::Node frame = Find(header && header.IsMap() ? header : map, kFrames);
  return frame && frame.IsScalar() ? frame : Undefined();
}

std::array<YAML::Node, 3> FlatPositionIn(const YAML::Node& map) {
  for (const auto& entry : map) {
    const auto prefix = PrefixOf(KeyOf(entry.first), 'x', kPositionPrefixes);
    if (!prefix || !entry.second.IsScalar()) continue;
    const YAML::Node y = Find(map, {*prefix + "y"});
    if (y && y.IsScalar()) return {entry.second, y, Find(map, {*prefix + "z"})};
  }
  return {Undefined(), Undefined(), Undefined()};
}

std::array<YAML::Node, 4> FlatQuaternionIn(const YAML::Node& map) {
  for (const auto& entry : map) {
    const auto prefix = PrefixOf(KeyOf(entry.first), 'w', kQuaternionPrefixes);
    if (!prefix) continue;
    return {Find(map, {*prefix + "x"}), Find(map, {*prefix + "y"}), Find(map, {*prefix + "z"}),
            entry.second};
  }
  return {Undefined(), Undefined(), Undefined(), Undefined()};
}

YAML::Node PositionIn(const YAML::Node& map) {
  const std::string key = PositionKeyIn(map);
  return key.empty() ? Undefined() : Find(map, {key});
}

bool HasHeight(const YAML::Node& map) { return Has(kHeights, PositionKeyIn(map)); }

YAML::Node OrientationIn(const YAML::Node& map) { return Find(map, kOrientations); }

Angle AngleIn(const YAML::Node& map) {
  if (const YAML::Node radians = Find(map, kRadians)) return {radians, 1.0};
  return {Find(map, kDegrees), M_PI / 180.0};
}

bool IsNoGoal(const std::string& key) {
  const std::string lower = base::ToLower(key);
  const std::size_t first = lower.find_first_of("_-. "), last = lower.find_last_of("_-. ");
  if (first == std::string::npos) return kNoGoals.count(lower) > 0;
  const std::string begin = lower.substr(0, first), end = lower.substr(last + 1);
  return kNoGoals.count(end) > 0 || (kNoGoals.count(begin) > 0 && kUnits.count(end) > 0);
}

std::vector<std::string> UnknownIn(const YAML::Node& map) {
  static const Keys known = Known();
  Keys unknown;
  for (const auto& entry : map) {
    if (entry.first.IsScalar() && !Has(known, KeyOf(entry.first)))
      unknown.push_back(entry.first.Scalar());
  }
  return unknown;
}

std::vector<ParallelLists> ParallelListsIn(const YAML::Node& map) {
  std::vector<ParallelLists> all;
  for (const auto& entry : map) {
    const auto stem =
        IsListOfNumbers(entry.second) ? StemOf(map, KeyOf(entry.first)) : std::nullopt;
    if (!stem) continue;
    ParallelLists lists{entry.first.Scalar(), entry.second, Find(map, {*stem + "y"}), {}, {}};
    Keys radians, degrees;
    for (const std::string& key : kRadians) radians.push_back(*stem + key);
    for (const std::string& key : kDegrees) degrees.push_back(*stem + key);
    lists.yaw.value.reset(Find(map, radians));
    if (!lists.yaw.value) {
      lists.yaw.value.reset(Find(map, degrees));
      lists.yaw.factor = M_PI / 180.0;
    }
    lists.keys = {*stem + "x", *stem + "y"};
    lists.keys.insert(lists.keys.end(), radians.begin(), radians.end());
    lists.keys.insert(lists.keys.end(), degrees.begin(), degrees.end());
    all.push_back(lists);
  }
  return all;
}

}  // namespace hires::imagination::area_keys
