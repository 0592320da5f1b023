#pragma once

#include <tinyxml2.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hires/geometry/pose.h"
#include "hires/knowledge/pose_moves.h"

namespace hires::lab {

/// Moves a pose; what is tilted stays so.
geometry::Pose3 Moved(const geometry::Pose3& X_MB, const std::vector<knowledge::PoseMove>& moves);
geometry::Pose2 Moved(const geometry::Pose2& X_MB, const std::vector<knowledge::PoseMove>& moves);

/// The text of an SDF world, in which models and frames can be moved. All else stays as it is.
class WorldFile {
 public:
  /// A map (.yaml) has nothing that could be moved.
  /// @throws base::ConfigError naming the file, where it is no XML or has no world.
  explicit WorldFile(const std::string& path);

  std::vector<std::string> Names() const;  ///< as the file spells them
  bool Has(const std::string& name) const { return things_.count(name) > 0; }  ///< lower case
  bool IsFrame(const std::string& name) const;                                 ///< @pre Has(name)

  /// @pre Has(name).  @throws base::ConfigError naming file and line, for a pose that is not simply
  /// six numbers in the frame of the world.
  geometry::Pose3 PoseOf(const std::string& name) const;
  void Move(const std::string& name, const std::vector<knowledge::PoseMove>& moves);

  /// Writes it beside a link to the models that it includes. @return the file: a map's own path.
  std::string WriteTo(const std::string& folder) const;

 private:
  tinyxml2::XMLElement* PoseElementOf(const std::string& name) const;
  std::vector<double> NumbersOf(const std::string& name) const;
  [[noreturn]] void Fail(const tinyxml2::XMLElement& element, const std::string& what) const;

  std::string path_;
  std::unique_ptr<tinyxml2::XMLDocument> document_;  // null for a map
  std::map<std::string, tinyxml2::XMLElement*> things_;
};

}  // namespace hires::lab
