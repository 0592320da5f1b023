#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hires/base/hash.h"
#include "hires/base/param_reader.h"
#include "hires/base/rng.h"
#include "hires/simulation/variation.h"

namespace hires::imagination {

/// How one uncertain quantity is spread.
struct Distribution {
  enum class Kind { kFixed, kUniform, kNormal, kLogNormal, kLaplace };
  Kind kind{Kind::kFixed};
  double first{0.0};   ///< fixed: the value; uniform: lower end; normal, laplace: mean; else median
  double second{0.0};  ///< uniform: upper end; normal: standard deviation; lognormal: of the
                       ///< logarithm; laplace: mean distance from the mean

  double Sample(base::Rng* rng) const;  ///< a normal one is drawn again beyond 3 deviations
  double AtScore(double score) const;   ///< the quantile of a standard normal score
  double Largest() const;               ///< no value that is drawn is larger
};

/// How x, y and yaw of a pose go together: correlations in [-1, 1].
struct PoseCorrelation {
  double x_y{0.0}, x_yaw{0.0}, y_yaw{0.0};
  bool is_none() const { return x_y == 0.0 && x_yaw == 0.0 && y_yaw == 0.0; }
};

/// What is uncertain about world, robot and control. A quantity for each number of
/// simulation::Variation (two for where the robot starts: see Arrival); a quantity that is not
/// named keeps its nominal value.
struct Uncertainty {
  std::map<std::string, Distribution> quantities;
  /// Of start_x, start_y, start_yaw, and of docked_x, ... likewise, where these are normal.
  std::optional<PoseCorrelation> start_correlation;
  /// It says `only: true`, or is "none": what it does not name is certain. Else it lies over
  /// another one where there is one: LaidOver in imagination/uncertainty_layers.h.
  bool is_only{false};
  std::string yaml;       ///< the text it was read from; "none" if nothing is uncertain
  std::uint64_t hash{0};  ///< of names, distributions and correlations
};

/// Reads `config/uncertainty.yaml` or a file like it. Each quantity is a map with `distribution`
/// (fixed, uniform, normal, lognormal, laplace), its numbers (`value`; `lower`, `upper`; `mean`,
/// `sd`; `median`, `log_sd`; `mean`, `distance`), `unit` (must be the quantity's own) and `source`
/// (why these numbers). Beside them may stand `start_correlation`, a map with `x_y`, `x_yaw`,
/// `y_yaw`, and `only`, true or false.
/// @throws base::ConfigError naming file, key and line.
Uncertainty LoadUncertainty(const std::string& path);
Uncertainty ParseUncertainty(const std::string& yaml, const std::string& where);
Uncertainty NoUncertainty();  ///< everything exactly nominal
/// The quantities of such a map, or of one inside another file.
std::map<std::string, Distribution> ReadQuantities(base::ParamReader* in);

/// What makes two uncertainties the same: names and distributions.
void AddTo(base::Hasher* hasher, const std::map<std::string, Distribution>& quantities);

/// All that a distribution may be given for.
std::vector<std::string> QuantityNames();

/// The same, in words.
struct QuantityInfo {
  std::string name;
  std::string what;     ///< "friction of every contact with a loose object, times"
  std::string unit;     ///< "m", "factor", ...
  double lower, upper;  ///< that it may be given at all, in this unit
};
std::vector<QuantityInfo> KnownQuantities();

/// "0.4 .. 1", "normal 0, sd 0.03", "0.002", ...
std::string ToString(const Distribution& distribution);

/// `text` is "none", or YAML as above.
Uncertainty UncertaintyFromText(const std::string& text, const std::string& where);

/// How the robot came to where an action begins. It tells which quantities say how far it may be
/// off: start_x, start_y, start_yaw, or docked_x, docked_y, docked_yaw.
enum class Arrival {
  kDriven,  ///< by move_base, within its goal tolerance
  kDocked   ///< by move_base_blind, straight up to furniture
};

/// Draws one truth. Each quantity has a stream of its own, so that one more or less uncertain
/// quantity leaves the draws of the others alone (common random numbers).
/// @param scores  by quantity: where a standard normal score was drawn already.
simulation::Variation SampleVariation(const Uncertainty& uncertainty, const base::Rng& rng,
                                      Arrival arrival = Arrival::kDriven,
                                      const std::map<std::string, double>& scores = {});

}  // namespace hires::imagination
