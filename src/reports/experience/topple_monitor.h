#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "hires/geometry/pose.h"
#include "hires/imagination/rollout.h"
#include "hires/knowledge/experience.h"

namespace hires::reports {

/// Where base and load were, at one moment.
struct ToppleSample {
  double time{0.0};      ///< [s] of the run
  geometry::Pose2 X_MB;  ///< base in the map
  geometry::Pose3 X_MO;  ///< load in the map
  geometry::Pose3 X_BO;  ///< load in the base, whose leaning included
};

/// Makes of samples of one run what the dissertation calls ToppleEpisodePart (section 5.8): state,
/// deviation and dynamics. Derivatives are differences over the last four samples, centred in
/// their middle, so that v, a and j belong to one moment:
///   v = (s2 - s1) / dt,  a = (v3 - v1) / (2 dt),  j = (v3 - 2 v2 + v1) / dt^2.
/// An episode lasts until the load topples (Eq. 5.1); the next begins with the first sample in
/// which it stands again, from which on differences are taken anew.
class ToppleMonitor {
 public:
  /// @param params  whose thresholds of Eq. 5.1 sort the samples.
  explicit ToppleMonitor(const imagination::RolloutParams& params) : params_(params) {}

  /// The run goes on elsewhere: no difference is taken across. The load's place on the tray counts
  /// anew.
  void Begin();

  /// @pre times grow.  @return nothing for the first three samples after Begin(), and after the
  /// load was put back.
  std::optional<knowledge::ToppleEpisodePart> Add(const ToppleSample& sample);

 private:
  static constexpr std::size_t kSamples = 4;

  bool IsPutBack(knowledge::ToppleState state);

  imagination::RolloutParams params_;
  std::array<ToppleSample, kSamples> last_;
  std::size_t num_samples_{0};  // since Begin()
  geometry::Pose3 X_BO_start_;
  std::uint32_t episode_{0};
  bool has_fallen_{false};
};

}  // namespace hires::reports
