#pragma once

#include <yaml-cpp/yaml.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace hires::imagination::area_keys {

// How files of goals call what makes up a goal. Case is ignored in all keys; what is not there is
// an undefined node.

/// Of an angle, and its unit.
struct Angle {
  YAML::Node value{YAML::NodeType::Undefined};
  double factor{1.0};     ///< to radians
  bool says_unit{false};  ///< the key does; else UnitIn() may say another
};

/// The value of the first of these keys, in lower case, that a map has.
YAML::Node Find(const YAML::Node& map, const std::vector<std::string>& keys);

/// A finite number, or nothing.
std::optional<double> NumberIn(const YAML::Node& node);

/// The numbers of a list or of a text ("1 2 0.5", or with commas), or nothing where it has anything
/// else.
std::vector<double> NumbersOf(const YAML::Node& list);

/// How many of the words of a text are numbers.
int CountNumbers(const YAML::Node& scalar);

/// Name, label, room and the like that stand beside a pose; or empty.
std::string NameIn(const YAML::Node& map);

/// Whether it is a collection of GeoJSON, which has goals as "features".
bool IsGeoJson(const YAML::Node& map);

/// A frame beside or in the header.
YAML::Node FrameIn(const YAML::Node& map);

/// x, y and z of a position beside each other (x, px, position_x, ...): x and y are scalars, or all
/// three are undefined.
std::array<YAML::Node, 3> FlatPositionIn(const YAML::Node& map);

/// x, y, z and w of a quaternion beside each other (qx, orientation_x, ...), where w is one.
std::array<YAML::Node, 4> FlatQuaternionIn(const YAML::Node& map);

/// A position under a key of its own: `position`, or what looks like one (location, coords, pos,
/// ...) where a name, a yaw or an orientation stands beside it.
YAML::Node PositionIn(const YAML::Node& map);

/// Whether the third number of a list under that key is surely a height, and no yaw.
bool HasHeight(const YAML::Node& map);

/// Orientation under a key of its own, in whatever form; the unit is that of its angles.
Angle OrientationIn(const YAML::Node& map);

Angle AngleIn(const YAML::Node& map);

/// In which unit the angles of a map and of all in it are.
struct Unit {
  YAML::Node said{YAML::NodeType::Undefined};  ///< where; undefined: nowhere
  std::optional<double> factor;                ///< to radians; nothing: it is none of an angle
  bool is_of_angles{true};                     ///< its key says so
};
Unit UnitIn(const YAML::Node& map);

/// Whether a key says that what it holds is no place: xy_tolerance, color, speed_limits, size.
bool IsNoGoal(const std::string& key);

/// Keys of a goal that say nothing of it, as far as is known here.
std::vector<std::string> UnknownIn(const YAML::Node& map);

/// Lists of numbers, of goals that stand in them one beside the other: goals_x, goals_y and maybe
/// goals_yaw.
struct ParallelLists {
  std::string x_key;
  YAML::Node x, y;
  Angle yaw;                      ///< value undefined: none
  std::vector<std::string> keys;  ///< all three
};
std::vector<ParallelLists> ParallelListsIn(const YAML::Node& map);

}  // namespace hires::imagination::area_keys
