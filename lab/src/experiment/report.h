#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "hires/base/param_reader.h"
#include "lab/src/statistics.h"

namespace hires::lab {

/// A number that an experiment found, by name: "reached_share".
struct Measure {
  std::string name;
  double value{0.0};
};

/// A number with its 95 % interval, by name. Where it is a measure, too, both have one name.
struct NamedInterval {
  std::string name;
  Interval interval;
};

/// What must hold about a measure for the experiment to count as passed. A measure that is no
/// number (0 / 0) holds nothing.
struct Expectation {
  enum class Relation { kAtLeast, kAtMost, kAbove, kBelow };
  std::string measure;
  Relation relation{Relation::kAtLeast};
  double bound{0.0};

  bool HoldsFor(double value) const;
};
std::string ToString(const Expectation& expectation);  ///< "reached_share at least 1"

/// Reads the list `expect`; each entry has `measure` and one of at_least, at_most, above, below.
/// @throws base::ConfigError naming the entry.
std::vector<Expectation> ReadExpectations(base::ParamReader* in);

/// A table for people, the first row being the heads.
struct TextTable {
  std::string title;
  std::vector<std::vector<std::string>> rows;
};

/// What the kind of an experiment makes of what was played.
struct Findings {
  std::vector<TextTable> tables;
  std::vector<Measure> measures;         ///< names and order do not depend on what was played
  std::vector<NamedInterval> intervals;  ///< likewise; of kinds that have none, empty
  /// One flat object per leg, rollout or run, all with the same keys. Who makes or copies Findings
  /// includes nlohmann/json.hpp.
  std::vector<nlohmann::ordered_json> rows;
  double simulated_seconds{0.0};
};

struct CheckedExpectation {
  Expectation expectation;
  double value{0.0};
  bool holds{false};
};

struct ExperimentReport {
  std::string name;  ///< of the file, without folder and ending
  std::string kind;
  std::uint64_t seed{0};
  std::uint64_t experiment_hash{0};  ///< of the experiment's own file, and what overrode it
  std::uint64_t params_hash{0};      ///< of world or map, robot, driving, physics, uncertainty
  Findings findings;
  std::vector<CheckedExpectation> checks;
  double wall_seconds{0.0};

  bool passed() const;
};

/// @throws base::ConfigError if an expectation names a measure that is not among these.
std::vector<CheckedExpectation> CheckExpectations(const std::vector<Expectation>& expectations,
                                                  const std::vector<Measure>& measures);

/// "durations (durations), seed 1, parameters ..., experiment ...": by which a printed report is
/// told from one of other parameters.
std::string HeadText(const ExperimentReport& report);
std::string ReportText(const ExperimentReport& report);  ///< for people; HeadText comes first
std::string ReportCsv(const ExperimentReport& report);   ///< the rows, with heads
/// The expectations as JUnit XML, as build servers read it: a suite of the experiment's name, a
/// test case for each expectation, a `failure` in those that do not hold. Seed and hashes are the
/// suite's properties. Equal reports give equal text but for the suite's `time`.
std::string JunitXml(const ExperimentReport& report);
/// The report for machines. Equal reports give equal text but for `wall_seconds`. Numbers that are
/// not finite become null.
nlohmann::ordered_json ToJson(const ExperimentReport& report);

}  // namespace hires::lab
