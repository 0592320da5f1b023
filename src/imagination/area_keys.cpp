#include "imagination/area_keys.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <sstream>
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
const Keys kOrientations{"orientation", "rotation", "quaternion",  "quat",
                         "rpy",         "euler",    "euler_angles"};
const Keys kOrientationsInDegrees{"rpy_deg", "rpy_degrees", "euler_deg", "euler_degrees"};
const Keys kAngles{"yaw", "theta", "th", "heading", "angle", "rz", "phi"};  // in the file's unit
const Keys kUnitsOfAngles{"angle_unit", "angle_units", "yaw_unit", "yaw_units"};
const Keys kUnitsOfMore{"units", "unit"};
const Keys kSaysDegrees{"in_degrees", "use_degrees"};
const Keys kPositionPrefixes{"", "p", "pos_", "position_", "position.", "pose_", "location_"};
const Keys kQuaternionPrefixes{"q", "o", "q_", "quat_", "orientation_", "orientation."};
const Keys kOfNoMatter{"pose",  "header", "stamp",       "seq",     "covariance", "roll",
                       "pitch", "type",   "description", "comment", "w"};

/// A key that ends with one of these holds no place; nor does one that begins so and ends with an
/// axis or a unit.
const std::set<std::string> kNoGoals{
    "tolerance",   "tolerances",     "size",      "sizes",       "color",      "colour",
    "colors",      "colours",        "limit",     "limits",      "scale",      "covariance",
    "rgb",         "rgba",           "speed",     "speeds",      "velocity",   "polygon",
    "polygons",    "vertices",       "verts",     "footprint",   "dimension",  "dimensions",
    "extent",      "extents",        "bounds",    "range",       "resolution", "gain",
    "gains",       "weights",        "threshold", "inflation",   "transform",  "transforms",
    "offset",      "offsets",        "corners",   "velocities",  "vel",        "vels",
    "translation", "transformation", "acc",       "acceleration"};
const std::set<std::string> kUnits{"x", "y", "z", "xy", "xyz", "yaw", "rgb", "rgba", "m", "rad"};

constexpr std::size_t kLongestNumbers = 500;  // letters of a goal that is written as text

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

/// What blanks, commas and semicolons part; nothing of prose, which an alias may repeat.
Keys WordsOf(const std::string& written) {
  if (written.size() > kLongestNumbers) return {};
  std::string text = written;
  for (char& c : text) c = c == ',' || c == ';' ? ' ' : c;
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

bool LooksLikePosition(const YAML::Node& node) {
  if (node.IsMap()) return FlatPositionIn(node)[0].IsDefined();
  const std::size_t size = node.IsSequence() ? NumbersOf(node).size() : 0;
  return size == 2 || size == 3;
}

std::string PositionKeyIn(const YAML::Node& map) {
  if (Find(map, kPositions)) return kPositions[0];
  if (!Find(map, kMaybePositions)) return "";
  const bool is_one = map.size() == 1 || !NameIn(map).empty() || OrientationIn(map).value ||
                      AngleIn(map).value || FlatQuaternionIn(map)[3];
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

Keys AnglesIn(const Keys& units) {
  Keys keys;
  for (const std::string& unit : units) {
    for (const std::string& key : kAngles) keys.push_back(key + "_" + unit);
  }
  return keys;
}

const Keys& InRadians() {
  static const Keys keys = AnglesIn({"rad", "radians"});
  return keys;
}

const Keys& InDegrees() {
  static const Keys keys = [] {
    Keys all = AnglesIn({"deg", "degrees"});
    all.push_back("degrees");
    return all;
  }();
  return keys;
}

/// An angle under one of its keys, after this stem: "goals_".
Angle AngleAfter(const std::string& stem, const YAML::Node& map) {
  const auto find = [&](const Keys& keys) {
    Keys whole;
    for (const std::string& key : keys) whole.push_back(stem + key);
    return Find(map, whole);
  };
  if (const YAML::Node angle = find(kAngles)) return {angle, 1.0, false};
  if (const YAML::Node radians = find(InRadians())) return {radians, 1.0, true};
  return {find(InDegrees()), M_PI / 180.0, true};
}

/// To radians, where it is a unit of an angle.
std::optional<double> FactorOf(const YAML::Node& unit) {
  if (!unit.IsDefined() || !unit.IsScalar()) return std::nullopt;
  const std::string name = base::ToLower(unit.Scalar());
  if (name == "rad" || name == "radian" || name == "radians") return 1.0;
  if (name == "deg" || name == "degree" || name == "degrees") return M_PI / 180.0;
  return std::nullopt;
}

Keys Known() {
  Keys known = kOfNoMatter;
  for (const Keys& more :
       {kNames, kFrames, kPositions, kMaybePositions, kOrientations, kOrientationsInDegrees,
        kAngles, InRadians(), InDegrees(), kUnitsOfAngles, kUnitsOfMore, kSaysDegrees}) {
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

std::optional<double> NumberIn(const YAML::Node& node) {
  double number = 0.0;
  const bool is_one = node.IsScalar() && YAML::convert<double>::decode(node, number);
  return is_one && std::isfinite(number) ? std::make_optional(number) : std::nullopt;
}

std::vector<double> NumbersOf(const YAML::Node& list) {
  std::vector<double> numbers;
  if (list.IsScalar()) {
    const std::vector<std::string> words = WordsOf(list.Scalar());
    for (const std::string& word : words) {
      if (const auto number = NumberIn(YAML::Node(word))) numbers.push_back(*number);
    }
    return numbers.size() == words.size() ? numbers : std::vector<double>{};
  }
  for (const YAML::Node& item : list) {
    const auto number = NumberIn(item);
    if (!number) return {};
    numbers.push_back(*number);
  }
  return numbers;
}

int CountNumbers(const YAML::Node& scalar) {
  const std::vector<std::string> words = WordsOf(scalar.Scalar());
  return static_cast<int>(std::count_if(words.begin(), words.end(), [](const std::string& word) {
    return NumberIn(YAML::Node(word));
  }));
}

std::string NameIn(const YAML::Node& map) {
  for (const std::string& key : kNames) {
    const YAML::Node name = Find(map, {key});
    if (name && name.IsScalar()) return name.Scalar();
  }
  return "";
}

bool IsGeoJson(const YAML::Node& map) {
  const YAML::Node type = Find(map, {"type"}), features = Find(map, {"features"});
  return type && type.IsScalar() && type.Scalar() == "FeatureCollection" && features &&
         features.IsSequence();
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

Angle OrientationIn(const YAML::Node& map) {
  if (const YAML::Node turn = Find(map, kOrientations)) return {turn, 1.0, false};
  return {Find(map, kOrientationsInDegrees), M_PI / 180.0, true};
}

Angle AngleIn(const YAML::Node& map) { return AngleAfter("", map); }

Unit UnitIn(const YAML::Node& map) {
  for (const std::string& key : kSaysDegrees) {
    bool is_so = false;
    const YAML::Node value = Find(map, {key});
    if (value && YAML::convert<bool>::decode(value, is_so) && is_so)
      return {value, M_PI / 180.0, true};
  }
  if (const YAML::Node own = Find(map, kUnitsOfAngles)) return {own, FactorOf(own), true};
  const YAML::Node more = Find(map, kUnitsOfMore);
  const YAML::Node unit =
      more && more.IsMap() ? Find(more, {"angle", "angles", "yaw", "rotation"}) : more;
  const auto factor = FactorOf(unit);  // else it is of lengths
  return {factor ? unit : Undefined(), factor, false};
}

bool IsNoGoal(const std::string& key) {
  const std::string lower = base::ToLower(key);
  const std::size_t first = lower.find_first_of("_-. "), last = lower.find_last_of("_-. ");
  if (first == std::string::npos) return kNoGoals.count(lower) > 0;
  const std::string begin = lower.substr(0, first), end = lower.substr(last + 1);
  const bool is_setting = begin == "max" || begin == "min" || begin == "vel";
  if (is_setting && lower[first] == '_') return true;  // "Max Room" is a room
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
    const Angle yaw = AngleAfter(*stem, map);
    lists.yaw.value.reset(yaw.value);
    lists.yaw.factor = yaw.factor;
    lists.yaw.says_unit = yaw.says_unit;
    lists.keys = {*stem + "x", *stem + "y"};
    for (const Keys& angles : {kAngles, InRadians(), InDegrees()}) {
      for (const std::string& key : angles) lists.keys.push_back(*stem + key);
    }
    all.push_back(lists);
  }
  return all;
}

}  // namespace hires::imagination::area_keys
