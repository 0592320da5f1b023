#include <algorithm>
#include <cmath>
#include <limits>

#include "base/averages.h"
#include "base/parallel.h"
#include "lab/src/recognition/fit_cases.h"
#include "lab/src/recognition/regression.h"

namespace hires::lab {
namespace {

using perception::DetectorErrors;
using perception::RecognitionScore;
using perception::ThingVerdict;
using Look = const ThingVerdict&;

/// @return by table.
std::optional<std::vector<std::vector<TwoLooks>>> LookTwice(const DetectorFitOrder& order,
                                                            const base::Crew& crew) {
  const int num_tables = order.tables + order.held_out;
  const perception::RandomTables tables(order.robot, order.recogniser, FitVariety());
  const auto recogniser = std::make_shared<const perception::Recogniser>(order.recogniser.catalogue,
                                                                         order.recogniser.params);
  std::vector<std::vector<TwoLooks>> seen(num_tables);
  const auto work = [&](int task, const base::Advance& advance) {
    const std::uint64_t own = order.seed + static_cast<std::uint64_t>(task);
    // A rollout is told of a thing where a robot would be, so by any detection that is of it.
    const RecognitionScore none(order.recogniser.catalogue, 1, perception::kToldOf);
    RecognitionScore scores[2]{none, none};
    for (int look = 0; look < 2; ++look) {
      const perception::RandomTable table = tables.Make(own, look);
      const base::Rng rng = base::Rng(own).Fork(static_cast<std::uint64_t>(look));
      scores[look].Add(table, perception::LookAtTable(recogniser, table, order.robot, rng));
    }
    for (std::size_t i = 0; i < scores[0].things().size(); ++i)
      seen[task].push_back({scores[0].things()[i], scores[1].things()[i]});
    advance(1.0);
  };
  if (!base::DoInParallel(num_tables, num_tables, crew, work)) return std::nullopt;
  return seen;
}

/// Not a number of no values.
double MedianOf(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  return base::Median(std::move(values));
}

FitCheck CheckOf(const std::string& part, const std::vector<TwoLooks>& things,
                 const DetectorErrors& errors, const LookTest& is_in) {
  constexpr double kBeyond = 1.6449;  // sd of the 95 % quantile
  FitCheck check;
  check.part = part;
  std::vector<double> lengths, expected;
  int num_beyond = 0;
  for (const TwoLooks& thing : things) {
    for (const ThingVerdict* look : {&thing.first, &thing.second}) {
      if (!is_in(*look)) continue;
      ++check.num_looks;
      check.found += ShareOf(errors.found.At(look->view));
      if (!look->is_found()) continue;
      ++check.num_found;
      check.num_named += look->is_right() ? 1 : 0;
      check.named += ShareOf(errors.named.At(look->view));
      if (!IsPlaced(*look)) continue;
      const double log = errors.position.log.At(look->view);
      lengths.push_back(look->error);
      expected.push_back(std::exp(log));
      num_beyond += std::log(look->error) > log + kBeyond * errors.position.spread ? 1 : 0;
    }
  }
  check.median_error = MedianOf(lengths);
  check.expected = MedianOf(expected);
  check.beyond = num_beyond / static_cast<double>(lengths.size());  // 0 / 0 is not a number
  return check;
}

/// Of all parts, those at which nobody looked, too.
std::vector<FitCheck> ChecksOf(const std::vector<TwoLooks>& things, const DetectorErrors& errors) {
  std::vector<FitCheck> checks;
  const auto add = [&](const char* part, const LookTest& is_in) {
    checks.push_back(CheckOf(part, things, errors, is_in));
  };
  add("all", [](Look) { return true; });
  add("nearer than 1.5 m", [](Look look) { return look.distance < 1.5; });
  add("1.5 m to 2 m", [](Look look) { return look.distance >= 1.5 && look.distance < 2.0; });
  add("2 m to 2.5 m", [](Look look) { return look.distance >= 2.0 && look.distance < 2.5; });
  add("2.5 m and farther", [](Look look) { return look.distance >= 2.5; });
  add("more than 30 % hidden", [](Look look) { return look.view.part.share < 0.7; });
  add("next thing within 0.02 m", [](Look look) { return look.view.gap < 0.02; });
  add("lower than 0.03 m", [](Look look) { return look.view.box.z() < 0.03; });
  add("fewer than 400 points", [](Look look) { return look.num_points < 400; });
  return checks;
}

/// Per look, against shares that are the same for all things.
double GainOf(const FitCases& cases, const FitCases& fitted_on, const perception::Regression& fit) {
  if (cases.y.size() == 0) return 0.0;
  const double share = std::clamp(fitted_on.y.mean(), 1e-6, 1.0 - 1e-6);
  const Eigen::VectorXd constant =
      Eigen::VectorXd::Constant(cases.y.size(), std::log(share / (1.0 - share)));
  const Eigen::VectorXd log_odds = cases.x * fit.weight;
  return (LogLikelihood(log_odds, cases.y) - LogLikelihood(constant, cases.y)) /
         static_cast<double>(cases.y.size());
}

}  // namespace

/// Farther away, more hidden and nearer to each other than those of the recognition experiment.
perception::TableVariety FitVariety() {
  perception::TableVariety variety;
  variety.farthest = 2.6;
  variety.most_hidden = 0.7;
  variety.gap = 0.0;
  return variety;
}

std::optional<DetectorFitReport> FitDetector(const DetectorFitOrder& order,
                                             const base::Crew& crew) {
  const auto seen = LookTwice(order, crew);
  if (!seen) return std::nullopt;
  std::vector<TwoLooks> all, others;
  for (std::size_t i = 0; i < seen->size(); ++i) {
    std::vector<TwoLooks>& part = static_cast<int>(i) < order.tables ? all : others;
    part.insert(part.end(), (*seen)[i].begin(), (*seen)[i].end());
  }
  const RecognitionScore kinds(order.recogniser.catalogue);
  DetectorFitReport report;
  report.tables = order.tables;
  report.held_out = order.held_out;
  report.seed = order.seed;
  report.hash = FitHashOf(order);
  report.errors = FitDetector(all, kinds);
  for (const TwoLooks& thing : all) {
    for (const ThingVerdict* look : {&thing.first, &thing.second}) {
      ++report.num_things;
      report.num_found += look->is_found() ? 1 : 0;
      report.num_named += look->is_right() ? 1 : 0;
      report.num_merged += look->is_merged ? 1 : 0;
    }
  }
  for (const FitCheck& check : ChecksOf(others, report.errors)) {
    if (check.num_looks > 0)
      report.checks.push_back(check);
    else
      report.empty_parts.push_back(check.part);
  }
  report.gain_found = GainOf(FoundCases(others), FoundCases(all), report.errors.found);
  report.gain_named = GainOf(NamedCases(others), NamedCases(all), report.errors.named);
  return report;
}

}  // namespace hires::lab
