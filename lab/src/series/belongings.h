#pragma once

#include <map>
#include <string>
#include <vector>

#include "hires/geometry/pose.h"
#include "hires/knowledge/fluent_yaml.h"

namespace hires::lab {

/// Which pose belongs to whom, as knowledge files say. Keys are in lower case, values as in the
/// files.
class Belongings {
 public:
  explicit Belongings(const std::vector<knowledge::Fluent>& fluents);

  bool Has(const std::string& instance) const;
  /// Whose pose it is, boxes left out; concept by instance.
  std::map<std::string, std::string> OwnersOf(const std::string& pose) const;
  /// Poses that move with it, though no modification attaches them: of its owner's box and areas,
  /// and of what stands on these.
  std::vector<std::string> PosesWith(const std::string& pose) const;
  /// Whether the point of the map [m] is on or above the box of one of the pose's owners.
  bool IsOn(const std::string& pose, const Eigen::Vector3d& p_M) const;
  /// x, y, z, yaw of a pose.  @pre it is a Pose
  geometry::Pose3 PoseOf(const std::string& pose) const;

 private:
  struct Instance {
    std::string name, concept_name;
    std::map<std::string, std::vector<std::string>> links;  ///< by role
    std::map<std::string, double> numbers;                  ///< likewise
  };
  const Instance* Find(const std::string& instance) const;
  std::vector<std::string> LinksOf(const std::string& instance, const std::string& role) const;
  void AddPosesOf(const std::string& instance, std::vector<std::string>* poses) const;

  std::map<std::string, Instance> instances_;
};

}  // namespace hires::lab
