#pragma once

#include <array>
#include <string>
#include <vector>

#include "lab/src/durations/duration_fit.h"
#include "lab/src/experiment/kinds.h"

// What the experiment `durations` found, under both readings of the published names of routes.
namespace hires::lab {

/// A row that is read as to/from is compared with the way back of what it says from/to.
struct DurationReading {
  const char* title;
  const char* measure;  ///< ending of names of measures
  bool reversed;
};
constexpr std::array<DurationReading, 2> kDurationReadings{
    {{"from/to", "_from_to", false}, {"to/from", "_to_from", true}}};

/// Actions are summed up apart.
struct DurationAction {
  const char* name;
  const char* title;
  const char* measure;  ///< part of names of measures
};
constexpr DurationAction kDurationDrives{"move_base_param", "drives", ""};
constexpr std::array<DurationAction, 2> kDurationPostures{
    {{"move_torso", "torso", "_torso"}, {"tuck_arms", "arms", "_arms"}}};

/// What one row found with one planner.
struct TimedRuns {
  std::vector<double> durations;  ///< [s] of runs that reached their goal
  std::size_t runs{0};

  double mean() const;  ///< not a number where none reached its goal
};

/// Everything that was found. Refers to the configuration that it is made of.
class FoundDurations {
 public:
  FoundDurations(const DurationsConfig& durations, const DurationPlays& plays);

  const DurationsConfig& durations() const { return durations_; }
  const TimedRuns& At(std::size_t planner, std::size_t row) const;
  /// [s] What a published row is to be compared with.
  double MeanOf(std::size_t planner, std::size_t row, const DurationReading& reading) const;
  std::vector<std::size_t> RowsOf(const DurationAction& action) const;
  /// The rows of an action for prediction; what was measured is the real robot's.
  DurationRows DataOf(const DurationAction& action, std::size_t planner,
                      const DurationReading& reading) const;

 private:
  const DurationsConfig& durations_;
  std::vector<std::vector<TimedRuns>> timed_;
};

std::string DurationRoute(const DurationsConfig::Row& row);  ///< "EC1/ET2"
std::string DurationName(const DurationsConfig::Row& row);   ///< motion set, or action
std::string WithSigma(double mean, double sigma);            ///< "14.04 ± 0.45"
double WorseOf(double a, double b);                          ///< the larger; no number wins

/// Tables and measures of drives, torso and arms that are predicted from other routes.
void AddDurationPredictions(const FoundDurations& found, Findings* findings);

}  // namespace hires::lab
