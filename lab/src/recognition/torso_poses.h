#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "lab/src/experiment/experiment.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/perception/recogniser_config.h"

namespace hires::lab {

/// From where things on a table are recognised and grasped best: torso down, in the middle and up,
/// at four places in front of it (dissertation, section 6.2.1, Figures 6.5 and 6.6).
struct TorsoPosesOrder {
  imagination::ImaginationSetup setup;
  perception::RecogniserConfig recogniser;
  std::string stand{"manipulationAreaSouthTable1"};  ///< the default place of the base
  std::string area{"placingAreaWestRightTable1"};    ///< where things stand
  int looks{10};  ///< of each thing from each pose; its place and heading differ
  std::uint64_t seed{1};
};

/// One thing once, from one pose.
struct PoseTrial {
  double recognised{0.0};  ///< confidence in what it is, models of its geometry together; 0 .. 1
  bool is_right{false};    ///< and that is its label
  std::optional<double> grasp;  ///< quality of the best grasp that can be carried out
};

struct TorsoPosesReport {
  std::vector<std::string> torsos, bases, kinds;
  int looks{0};
  std::vector<PoseTrial> trials;  ///< by torso, base, kind, look; the last runs fastest

  const PoseTrial& at(int torso, int base, int kind, int look) const;
};

/// The same bits for any number of threads.
/// @return nothing when it was cancelled.
/// @throws base::ConfigError for a robot without arms, or places that the world does not have.
std::optional<TorsoPosesReport> PlayTorsoPoses(const TorsoPosesOrder& order,
                                               const base::Crew& crew);

/// A table over poses, one over things, and the findings of Figure 6.6 with 95 % intervals.
std::string ReportText(const TorsoPosesReport& report);
nlohmann::ordered_json ToJson(const TorsoPosesReport& report);

}  // namespace hires::lab
