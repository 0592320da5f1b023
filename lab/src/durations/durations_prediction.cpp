#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

#include "lab/src/durations/durations_found.h"

namespace hires::lab {
namespace {

constexpr std::array<DurationModel, 4> kPhysical{
    DurationModel::kAsPlayed, DurationModel::kStartTime, DurationModel::kTimeScale,
    DurationModel::kStartAndScale};

/// All ways of predicting an action, each planner with each model.
std::vector<DurationPredictor> PredictorsOf(const FoundDurations& found,
                                            const DurationAction& action,
                                            const DurationReading& reading) {
  std::vector<DurationPredictor> predictors;
  for (std::size_t p = 0; p < found.durations().planners.size(); ++p) {
    for (const DurationModel model : kPhysical) {
      predictors.push_back(
          {ToString(found.durations().planners[p]), model, found.DataOf(action, p, reading)});
    }
  }
  return predictors;
}

std::string FitText(const DurationFit& fit) {
  return fmt::format("{:.2f} s + {:.2f} t", fit.start_time, fit.time_scale);
}

/// One way of predicting the drives, under both readings.
struct Predicted {
  std::string planner, model;
  int fitted{0};
  std::array<LeftOutPredictions, 2> by_reading;
  std::array<std::vector<DurationPredictor>, 2> predictors;

  double worse() const { return WorseOf(by_reading[0].mean_error, by_reading[1].mean_error); }
};

std::vector<Predicted> PredictDrives(const FoundDurations& found) {
  std::array<std::vector<DurationPredictor>, 2> all;
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i] = PredictorsOf(found, kDurationDrives, kDurationReadings[i]);
  }
  std::vector<Predicted> out;
  const auto add = [&](const std::string& planner, const std::string& model, int fitted,
                       const std::array<std::vector<DurationPredictor>, 2>& by) {
    out.push_back({planner, model, fitted, {PredictLeftOut(by[0]), PredictLeftOut(by[1])}, by});
  };
  add("any of these", "chosen in each fold", -1, all);
  for (std::size_t p = 0; p < all[0].size(); ++p) {
    const DurationModel model = all[0][p].model;
    add(all[0][p].planner, ToString(model), NumFitted(model), {{{all[0][p]}, {all[1][p]}}});
  }
  auto constant = std::array<std::vector<DurationPredictor>, 2>{{{all[0][0]}, {all[1][0]}}};
  for (auto& one : constant) one[0].model = DurationModel::kConstant;
  add("", ToString(DurationModel::kConstant), 1, constant);
  return out;
}

TextTable TableOfPredictors(const std::vector<Predicted>& all) {
  TextTable table{
      "The real robot's drives predicted, each route by numbers fitted on the other routes: mean "
      "absolute error [s], 95 % over routes",
      {{"planner", "fitted", "numbers", "from/to", "95 %", "largest", "to/from", "95 %", "largest",
        "worse"}}};
  for (const Predicted& one : all) {
    std::vector<std::string> line{one.planner, one.model,
                                  one.fitted < 0 ? "0 to 2" : std::to_string(one.fitted)};
    for (const LeftOutPredictions& predictions : one.by_reading) {
      line.push_back(fmt::format("{:.2f}", predictions.mean_error));
      line.push_back(
          fmt::format("{:.2f} .. {:.2f}", predictions.error.lower, predictions.error.upper));
      line.push_back(fmt::format("{:.2f}", predictions.largest_error));
    }
    line.push_back(fmt::format("{:.2f}", one.worse()));
    table.rows.push_back(std::move(line));
  }
  return table;
}

TextTable TableOfFolds(const std::vector<Predicted>& all) {
  TextTable table{
      "What was fitted where a route was left out: start time + time scale x played time t",
      {{"planner", "fitted", "read as"}}};
  for (const DurationFold& fold : all.front().by_reading[0].folds) {
    table.rows[0].push_back("without " + fold.route);
  }
  for (const Predicted& one : all) {
    for (std::size_t i = 0; i < kDurationReadings.size(); ++i) {
      std::vector<std::string> line{one.planner, one.model, kDurationReadings[i].title};
      for (const DurationFold& fold : one.by_reading[i].folds) {
        const std::string who = one.fitted < 0 ? one.predictors[i][fold.predictor].planner : "";
        line.push_back(who.empty() ? FitText(fold.fit) : who + ": " + FitText(fold.fit));
      }
      if (one.fitted != 0) table.rows.push_back(std::move(line));
    }
  }
  return table;
}

/// Rows of an action, each predicted from the others, beside what was measured.
void AddPredictions(const FoundDurations& found, const DurationAction& action,
                    const std::array<LeftOutPredictions, 2>& by_reading, TextTable* table) {
  const std::vector<std::size_t> rows = found.RowsOf(action);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const DurationsConfig::Row& row = found.durations().rows[rows[i]];
    std::vector<std::string> line{DurationName(row), DurationRoute(row),
                                  WithSigma(row.real.mean, row.real.sigma)};
    for (const LeftOutPredictions& predictions : by_reading) {
      const double predicted = predictions.predicted[i];
      line.push_back(WithSigma(predicted, predictions.FoldOf(DurationRoute(row)).fit.noise));
      line.push_back(fmt::format("{:.2f}", predicted - row.real.mean));
    }
    table->rows.push_back(std::move(line));
  }
}

TextTable PredictionsTable(const std::string& title) {
  return {title, {{"action", "route", "real, 6.2", "from/to", "error", "to/from", "error"}}};
}

void AddMeasures(const std::string& name, const std::array<LeftOutPredictions, 2>& by_reading,
                 Findings* findings) {
  double worse = 0.0;
  for (std::size_t i = 0; i < kDurationReadings.size(); ++i) {
    findings->measures.push_back({name + kDurationReadings[i].measure, by_reading[i].mean_error});
    worse = WorseOf(by_reading[i].mean_error, worse);
  }
  findings->measures.push_back({name + "_worse", worse});
}

void AddDrivePredictions(const FoundDurations& found, Findings* findings) {
  const std::vector<Predicted> all = PredictDrives(found);
  const Predicted& chosen = all.front();
  findings->tables.push_back(TableOfPredictors(all));
  findings->tables.push_back(TableOfFolds(all));
  TextTable table = PredictionsTable(
      "Drives predicted by what was chosen and fitted on the other routes [s], ± noise of one run "
      "(root mean square sigma of the rows fitted on)");
  AddPredictions(found, kDurationDrives, chosen.by_reading, &table);
  findings->tables.push_back(std::move(table));
  AddMeasures("predicted_error", chosen.by_reading, findings);
}

/// Torso and arms: a start time and a noise of their own, each direction's from the other one.
void AddPosturePredictions(const FoundDurations& found, Findings* findings) {
  TextTable table = PredictionsTable(
      "Torso and arms predicted [s], start time and noise fitted on the other direction");
  for (const DurationAction& action : kDurationPostures) {
    if (found.RowsOf(action).empty()) continue;
    std::array<LeftOutPredictions, 2> by_reading;
    for (std::size_t i = 0; i < kDurationReadings.size(); ++i) {
      by_reading[i] = PredictLeftOut(
          {{"", DurationModel::kStartTime, found.DataOf(action, 0, kDurationReadings[i])}});
    }
    AddPredictions(found, action, by_reading, &table);
    AddMeasures(std::string("predicted_error") + action.measure, by_reading, findings);
  }
  findings->tables.push_back(std::move(table));
}

}  // namespace

void AddDurationPredictions(const FoundDurations& found, Findings* findings) {
  if (!found.RowsOf(kDurationDrives).empty()) AddDrivePredictions(found, findings);
  AddPosturePredictions(found, findings);
}

}  // namespace hires::lab
