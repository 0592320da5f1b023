#include "hires/imagination/uncertainty.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hires/base/error.h"
#include "hires/base/hash.h"
#include "hires/base/param_reader.h"
#include "hires/base/text.h"

namespace hires::imagination {
namespace {

using simulation::Variation;

constexpr double kLargestScore = 3.0;  // what lies beyond is drawn again
constexpr char kCorrelation[] = "start_correlation";
constexpr char kOnly[] = "only";

/// Each quantity has its own.
base::Rng StreamOf(const std::string& quantity, const base::Rng& rng) {
  base::Hasher stream;
  stream.Add(quantity);
  return rng.Fork(stream.value());
}

struct Quantity {
  std::string name;
  std::string what;
  std::string unit;
  double lower, upper;  // what makes sense at all
  std::function<double&(Variation&)> slot;
  std::optional<Arrival> only_after{};
};

std::vector<Quantity> OfThingsAndStart() {
  return {
      {"object_mass", "mass of each loose object, times", "factor", 0.1, 10,
       [](Variation& v) -> double& { return v.mass_factor; }},
      {"object_radius", "radius of the face on which a round object stands, times", "factor", 0.2,
       2, [](Variation& v) -> double& { return v.radius_factor; }},
      {"object_com_height",
       "height of an object's centre of mass above the face it stands on, times", "factor", 0.2,
       1.8, [](Variation& v) -> double& { return v.com_height_factor; }},
      {"object_com_x", "centre of mass off its place, along the object's x axis", "m", -0.05, 0.05,
       [](Variation& v) -> double& { return v.com_offset.x(); }},
      {"object_com_y", "likewise, along its y axis", "m", -0.05, 0.05,
       [](Variation& v) -> double& { return v.com_offset.y(); }},
      {"object_friction", "friction of every contact with a loose object, times", "factor", 0.0, 10,
       [](Variation& v) -> double& { return v.friction_factor; }},
      {"object_x", "where objects stand on the tray, off along its x axis", "m", -0.2, 0.2,
       [](Variation& v) -> double& { return v.object_offset.x(); }},
      {"object_y", "likewise, along its y axis", "m", -0.5, 0.5,
       [](Variation& v) -> double& { return v.object_offset.y(); }},
      {"start_x", "where a robot that drove up really stands, off ahead", "m", -1, 1,
       [](Variation& v) -> double& { return v.start_offset.x; }, Arrival::kDriven},
      {"start_y", "likewise, to the left", "m", -1, 1,
       [](Variation& v) -> double& { return v.start_offset.y; }, Arrival::kDriven},
      {"start_yaw", "likewise, turned", "rad", -3.2, 3.2,
       [](Variation& v) -> double& { return v.start_offset.yaw; }, Arrival::kDriven},
      {"docked_x", "where a robot that docked (move_base_blind) really stands, off ahead", "m",
       -0.2, 0.2, [](Variation& v) -> double& { return v.start_offset.x; }, Arrival::kDocked},
      {"docked_y", "likewise, to the left", "m", -0.2, 0.2,
       [](Variation& v) -> double& { return v.start_offset.y; }, Arrival::kDocked},
      {"docked_yaw", "likewise, turned", "rad", -0.5, 0.5,
       [](Variation& v) -> double& { return v.start_offset.yaw; }, Arrival::kDocked},
  };
}

std::vector<Quantity> OfDriving() {
  return {
      {"localisation_x", "where it believes it is during the whole rollout, off ahead", "m", -1, 1,
       [](Variation& v) -> double& { return v.localisation_bias.x; }},
      {"localisation_y", "likewise, to the left", "m", -1, 1,
       [](Variation& v) -> double& { return v.localisation_bias.y; }},
      {"localisation_yaw", "likewise, turned", "rad", -1, 1,
       [](Variation& v) -> double& { return v.localisation_bias.yaw; }},
      {"localisation_noise", "sd of each believed x and y, anew in every cycle", "m", 0, 0.5,
       [](Variation& v) -> double& { return v.localisation_noise; }},
      {"localisation_noise_yaw", "sd of each believed heading, likewise", "rad", 0, 0.5,
       [](Variation& v) -> double& { return v.localisation_noise_yaw; }},
      {"ghost_rate", "obstacles seen that are not there", "1/s", 0, 10,
       [](Variation& v) -> double& { return v.ghost_rate; }},
      {"wheel_slip", "sd of the speed's relative error", "share", 0, 0.5,
       [](Variation& v) -> double& { return v.wheel_slip; }},
      {"floor_roughness", "sd of the floor's height", "m", 0, 0.02,
       [](Variation& v) -> double& { return v.floor_roughness; }},
      {"command_delay", "commands come later than the robot's own lag", "s", 0, 1,
       [](Variation& v) -> double& { return v.command_delay; }},
      {"late_cycle_probability", "control cycles that come late", "share", 0, 1,
       [](Variation& v) -> double& { return v.late_cycle_probability; }},
      {"late_cycle_delay", "by how much these are late", "s", 0, 5,
       [](Variation& v) -> double& { return v.late_cycle_delay; }},
      {"loop_damping", "damping of the base's velocity loop, times", "factor", 0.1, 10,
       [](Variation& v) -> double& { return v.loop_damping_factor; }},
      {"wheel_damping", "damping of wheels on casters, times", "factor", 0, 10,
       [](Variation& v) -> double& { return v.wheel_damping_factor; }},
      {"sway", "how far the base leans, times", "factor", 0, 10,
       [](Variation& v) -> double& { return v.sway_factor; }},
  };
}

std::vector<Quantity> OfSeeingAndGrasping() {
  return {
      {"detection_noise", "sd of each coordinate of an object that is seen", "m", 0, 0.2,
       [](Variation& v) -> double& { return v.detection_noise; }},
      {"detection_noise_yaw", "sd of its turn", "rad", 0, 1,
       [](Variation& v) -> double& { return v.detection_noise_yaw; }},
      {"recognition_errors", "how often and far the recogniser errs, times", "factor", 0, 10,
       [](Variation& v) -> double& { return v.recognition_errors; }},
      {"grasp_x", "held objects off their place, along the hand", "m", -0.05, 0.05,
       [](Variation& v) -> double& { return v.grasp_offset.x(); }},
      {"grasp_z", "likewise, across it", "m", -0.05, 0.05,
       [](Variation& v) -> double& { return v.grasp_offset.y(); }},
      {"grasp_turn", "likewise, turned from finger to finger", "rad", -0.5, 0.5,
       [](Variation& v) -> double& { return v.grasp_turn; }},
      {"scan_noise", "sd of each echo of the base's laser", "m", 0, 1,
       [](Variation& v) -> double& { return v.scan_noise; }},
      {"encoder_noise", "sd of each measured joint", "rad", 0, 0.1,
       [](Variation& v) -> double& { return v.encoder_noise; }},
  };
}

const std::vector<Quantity>& Quantities() {
  static const std::vector<Quantity> quantities = [] {
    std::vector<Quantity> all = OfThingsAndStart();
    for (const auto& more : {OfDriving(), OfSeeingAndGrasping()})
      all.insert(all.end(), more.begin(), more.end());
    return all;
  }();
  return quantities;
}

const Quantity& FindQuantity(const base::ParamReader& in, const std::string& name) {
  for (const Quantity& quantity : Quantities()) {
    if (quantity.name == name) return quantity;
  }
  in.Fail(name, base::UnknownName("quantity", name, QuantityNames()));
}

/// All that are missing at once.
void RequireNumbersOf(const std::string& kind, const base::ParamReader& in) {
  static const std::map<std::string, std::vector<std::string>> numbers{
      {"fixed", {"value"}},
      {"uniform", {"lower", "upper"}},
      {"normal", {"mean", "sd"}},
      {"lognormal", {"median", "log_sd"}},
      {"laplace", {"mean", "distance"}}};
  std::vector<std::string> needed = numbers.at(kind);
  needed.insert(needed.end(), {"unit", "source"});
  in.RequireKeys(needed);
}

Distribution ReadDistribution(base::ParamReader in, const Quantity& quantity) {
  const auto bound = base::Between(quantity.lower, quantity.upper);
  const std::string kind =
      in.Get("distribution", base::OneOf({"fixed", "uniform", "normal", "lognormal", "laplace"}));
  RequireNumbersOf(kind, in);
  in.Get("unit", base::OneOf({quantity.unit}));
  in.GetString("source");
  if (kind == "fixed") return {Distribution::Kind::kFixed, in.Get("value", bound), 0.0};
  const auto spread = base::Between(0.0, quantity.upper - quantity.lower);
  if (kind == "normal") {
    const double mean = in.Get("mean", bound);
    return {Distribution::Kind::kNormal, mean, in.Get("sd", spread)};
  }
  if (kind == "laplace") {
    const double mean = in.Get("mean", bound);
    return {Distribution::Kind::kLaplace, mean, in.Get("distance", spread)};
  }
  if (kind == "lognormal") {
    const double median = in.Get("median", bound);
    if (median <= 0.0) in.Fail("median", "wanted more than 0");
    return {Distribution::Kind::kLogNormal, median, in.Get("log_sd", base::Between(0.0, 3.0))};
  }
  const double lower = in.Get("lower", bound), upper = in.Get("upper", bound);
  if (lower > upper) in.Fail("upper", "wanted at least the lower end");
  return {Distribution::Kind::kUniform, lower, upper};
}

std::uint64_t HashOf(const std::map<std::string, Distribution>& quantities,
                     const std::optional<PoseCorrelation>& correlation = {}) {
  base::Hasher hasher;
  AddTo(&hasher, quantities);
  if (correlation) {
    hasher.Add(std::string(kCorrelation));
    for (const double value : {correlation->x_y, correlation->x_yaw, correlation->y_yaw})
      hasher.Add(value);
  }
  return hasher.value();
}

Eigen::Matrix3d MatrixOf(const PoseCorrelation& c) {
  Eigen::Matrix3d matrix;
  matrix << 1.0, c.x_y, c.x_yaw, c.x_y, 1.0, c.y_yaw, c.x_yaw, c.y_yaw, 1.0;
  return matrix;
}

PoseCorrelation ReadCorrelation(base::ParamReader in) {
  constexpr double kRounding = 1e-9;
  const auto bound = base::Between(-1.0, 1.0);
  const PoseCorrelation correlation{in.Get("x_y", bound), in.Get("x_yaw", bound),
                                    in.Get("y_yaw", bound)};
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(MatrixOf(correlation));
  if (solver.eigenvalues().minCoeff() < -kRounding)
    in.Fail("y_yaw", "no three numbers go together like that; wanted correlations of a covariance");
  return correlation;
}

/// Standard normal scores of a pose where arriving so, by quantity, that go together.
std::map<std::string, double> CorrelatedScores(const PoseCorrelation& correlation,
                                               const std::map<std::string, Distribution>& known,
                                               const base::Rng& rng, const std::string& arrival) {
  const std::array<std::string, 3> names{arrival + "_x", arrival + "_y", arrival + "_yaw"};
  Eigen::Vector3d own;
  for (int axis = 0; axis < 3; ++axis) {
    const auto found = known.find(names[axis]);
    if (found == known.end() || found->second.kind != Distribution::Kind::kNormal) return {};
    base::Rng stream = StreamOf(names[axis], rng);
    own[axis] = Distribution{Distribution::Kind::kNormal, 0.0, 1.0}.Sample(&stream);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(MatrixOf(correlation));
  const Eigen::Vector3d roots = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  const Eigen::Vector3d scores =
      solver.eigenvectors() * roots.asDiagonal() * (solver.eigenvectors().transpose() * own);
  std::map<std::string, double> together;
  for (int axis = 0; axis < 3; ++axis) together[names[axis]] = scores[axis];
  return together;
}

}  // namespace

void AddTo(base::Hasher* hasher, const std::map<std::string, Distribution>& quantities) {
  for (const auto& [name, distribution] : quantities) {
    hasher->Add(name);
    hasher->Add(static_cast<std::uint64_t>(distribution.kind));
    hasher->Add(distribution.first);
    hasher->Add(distribution.second);
  }
}

double Distribution::Sample(base::Rng* rng) const {
  if (kind == Kind::kFixed) return first;
  if (kind == Kind::kUniform) return rng->Uniform(first, second);
  if (kind != Kind::kNormal) {
    for (;;) {
      const double score = rng->Normal(0.0, 1.0);
      if (std::abs(score) <= kLargestScore) return AtScore(score);
    }
  }
  for (;;) {
    const double value = rng->Normal(first, second);
    if (std::abs(value - first) <= 3.0 * second) return value;
  }
}

double Distribution::AtScore(double score) const {
  const double below = 0.5 * std::erfc(-score / std::sqrt(2.0));  // share of smaller values
  switch (kind) {
    case Kind::kFixed:
      return first;
    case Kind::kUniform:
      return first + below * (second - first);
    case Kind::kNormal:
      return first + score * second;
    case Kind::kLogNormal:
      return first * std::exp(score * second);
    case Kind::kLaplace:
      break;
  }
  const double tail = std::min(below, 1.0 - below);
  return first + std::copysign(-second * std::log(2.0 * tail), score);
}

double Distribution::Largest() const {
  return kind == Kind::kUniform ? second : AtScore(kLargestScore);
}

std::map<std::string, Distribution> ReadQuantities(base::ParamReader* in) {
  std::map<std::string, Distribution> quantities;
  for (const std::string& name : in->Keys()) {
    if (name == kCorrelation || name == kOnly) continue;  // left to who has the reader
    const Quantity& quantity = FindQuantity(*in, name);
    quantities[name] = ReadDistribution(in->Sub(name), quantity);
  }
  return quantities;
}

Uncertainty ParseUncertainty(const std::string& yaml, const std::string& where) {
  base::ParamReader in = base::ParamReader::FromString(yaml, where);
  Uncertainty uncertainty;
  uncertainty.quantities = ReadQuantities(&in);
  if (in.Has(kCorrelation)) uncertainty.start_correlation = ReadCorrelation(in.Sub(kCorrelation));
  if (in.Has(kOnly)) uncertainty.is_only = in.GetBool(kOnly);
  in.RejectUnknownKeys();
  uncertainty.yaml = yaml;
  uncertainty.hash = HashOf(uncertainty.quantities, uncertainty.start_correlation);
  return uncertainty;
}

Uncertainty LoadUncertainty(const std::string& path) {
  return ParseUncertainty(base::ReadTextFile(path, 1u << 20), path);
}

Uncertainty NoUncertainty() { return {{}, {}, true, "none", HashOf({})}; }

std::string ToString(const Distribution& distribution) {
  const auto& [kind, first, second] = distribution;
  switch (kind) {
    case Distribution::Kind::kFixed:
      return fmt::format("{:g}", first);
    case Distribution::Kind::kUniform:
      return fmt::format("{:g} .. {:g}", first, second);
    case Distribution::Kind::kNormal:
      return fmt::format("normal {:g}, sd {:g}", first, second);
    case Distribution::Kind::kLogNormal:
      return fmt::format("lognormal {:g}, log_sd {:g}", first, second);
    case Distribution::Kind::kLaplace:
      return fmt::format("laplace {:g}, distance {:g}", first, second);
  }
  return "";
}

std::vector<QuantityInfo> KnownQuantities() {
  std::vector<QuantityInfo> infos;
  for (const Quantity& quantity : Quantities()) {
    infos.push_back({quantity.name, quantity.what, quantity.unit, quantity.lower, quantity.upper});
  }
  return infos;
}

std::vector<std::string> QuantityNames() {
  std::vector<std::string> names;
  for (const Quantity& quantity : Quantities()) names.push_back(quantity.name);
  return names;
}

Uncertainty UncertaintyFromText(const std::string& text, const std::string& where) {
  return text == "none" ? NoUncertainty() : ParseUncertainty(text, where);
}

simulation::Variation SampleVariation(const Uncertainty& uncertainty, const base::Rng& rng,
                                      Arrival arrival,
                                      const std::map<std::string, double>& scores) {
  Variation variation;
  std::map<std::string, double> known_scores;
  if (uncertainty.start_correlation) {
    known_scores = CorrelatedScores(*uncertainty.start_correlation, uncertainty.quantities, rng,
                                    arrival == Arrival::kDriven ? "start" : "docked");
  }
  for (const auto& [name, score] : scores) known_scores[name] = score;
  for (const Quantity& quantity : Quantities()) {
    const auto found = uncertainty.quantities.find(quantity.name);
    if (found == uncertainty.quantities.end()) continue;
    if (quantity.only_after && *quantity.only_after != arrival) continue;
    base::Rng own = StreamOf(quantity.name, rng);
    double& slot = quantity.slot(variation);
    // A normal distribution may reach beyond what makes sense at all (a negative noise, say).
    const auto score = known_scores.find(quantity.name);
    const double value = score == known_scores.end() ? found->second.Sample(&own)
                                                     : found->second.AtScore(score->second);
    slot = std::min(quantity.upper, std::max(quantity.lower, value));
  }
  return variation;
}

}  // namespace hires::imagination
