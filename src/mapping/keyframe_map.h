#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "hires/mapping/mapper.h"
#include "mapping/pose_graph.h"
#include "mapping/scan_matcher.h"

namespace hires::mapping {

/// Scans that later ones are matched with, where they were made, and what ties them together.
class KeyframeMap {
 public:
  explicit KeyframeMap(const MapperParams& params) : params_(params) {}

  /// Where a scan was made, by the latest keyframes; tried around the prior first, then farther
  /// away. Nothing if it fits nothing, or there is nothing yet to fit.
  std::optional<ScanMatch> Match(const SurfacePoints& few, const PosePrior& prior) const;

  /// Whether a scan from there would show enough that is new.
  bool IsDue(const geometry::Pose2& X_MB) const;

  /// Adds a scan, and closes the loop where it shows a place seen before, which moves poses.
  /// @param few    those of its points that are matched.
  /// @param match  where it was made.
  /// @param way    [m] driven until then.
  /// @return where it stands then.
  geometry::Pose2 Add(SurfacePoints points, SurfacePoints few, const ScanMatch& match, double way);

  const geometry::Pose2& pose(int i) const { return graph_.pose(i); }
  int size() const { return graph_.size(); }
  int num_loops() const { return num_loops_; }
  int num_breaks() const { return static_cast<int>(breaks_.size()); }
  /// Judges the places that the drive came back to, as they are now, whenever it is called; another
  /// thread may do so.
  std::function<MapReturns()> Returns() const;

  /// What is added from now on may stand wrongly beside what is there, until a place seen before
  /// ties the two together.
  void NoteBreak();
  /// The laser contradicted the odometry after the newest keyframe.
  void NoteSlip();

 private:
  struct Keyframe {
    SurfacePoints points, few;
    double way{0.0};
  };
  /// A large step that one place seen before asked for.
  struct Correction {
    geometry::Pose2 step;  // from old to new poses, in map
    int keyframe{0};
  };

  std::vector<PlacedPoints> Placed(int first, int last) const;
  void RebuildLocalMap();
  void CloseLoop();
  double UntiedWay(int i) const;
  template <typename RadiusOf>
  std::optional<int> NearestBefore(int k, bool same_heading, const RadiusOf& radius_of) const;
  std::optional<int> PlaceSeenBefore(bool same_heading) const;
  SurfaceMap MapAround(int place, int half, int k) const;
  std::optional<ScanMatch> MatchWithPlace(int place) const;
  bool MayBeBentSince(int place) const;
  bool FitsWhereItIs(const SurfaceMap& map, int place, const ScanMatch& match) const;
  bool TellsWhere(const SurfacePoints& few) const;
  MapReturns CountReturns() const;
  bool IsWitnessed(const geometry::Pose2& X_before, const geometry::Pose2& X_after);

  MapperParams params_;
  std::vector<std::shared_ptr<const Keyframe>> keyframes_;
  PoseGraph graph_;
  std::optional<SurfaceMap> local_;  // of the latest keyframes
  std::optional<Correction> asked_;  // not yet believed
  double way_at_loop_{0.0};          // [m] when the map was last tied together
  int num_loops_{0};
  std::vector<int> breaks_;  // keyframes before which the map may be broken
  std::vector<int> slips_;   // keyframes before which the laser contradicted the odometry
};

}  // namespace hires::mapping
