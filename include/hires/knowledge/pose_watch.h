#pragma once

#include <map>
#include <string>
#include <vector>

#include "hires/knowledge/fluent.h"
#include "hires/knowledge/ontology.h"
#include "hires/knowledge/sparql.h"

namespace hires::knowledge {

/// What counts as moved.
struct PoseWatchParams {
  double distance{0.02};  ///< [m] more than the noise of an observation
  double angle{0.1};      ///< [rad] of the heading
};

/// Tells whose pose changed more than its noise: what was seen somewhere new, moved, or vanished.
/// Motions are measured from the pose that was told last, so that creeping shows, too. Of the robot
/// nothing is told, nor of what the robot carries (Holding, On its tray) as long as that is given
/// in a frame in which it moves with the robot: there its own motion would be told all the time.
class PoseWatch {
 public:
  /// @pre `ontology` outlives the watch.
  PoseWatch(const Ontology* ontology, const PoseWatchParams& params);

  /// Looks at the whole view. Nothing is told at the first time.
  /// @return Instances in lower case, sorted.
  std::vector<std::string> Update(const FluentView& view);

 private:
  struct Seen {
    double x, y, z, yaw;  // [m], [rad]
    std::string frame;
    bool is_carried;
  };

  std::map<std::string, Seen> PosesIn(const FluentView& view) const;
  bool HasMoved(const Seen& before, const Seen& now) const;

  const Ontology* ontology_;
  PoseWatchParams params_;
  bool is_first_{true};
  std::map<std::string, Seen> told_;  // by instance
};

}  // namespace hires::knowledge
