#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "lab/src/experiment/braking.h"
#include "lab/src/statistics.h"

// What stops that were played come to.
namespace hires::lab {
namespace {

constexpr double kTipped = 0.005;  // [rad] more than contacts that settle; an edge has lifted

/// A share of all stops, or the extremes, of one cell.
struct Summary {
  int num{0}, falls{0};
  double max_tilt{0.0}, max_slide{0.0}, max_distance{0.0}, max_time{0.0};
  std::vector<double> distances, times;

  explicit Summary(const BrakingPlay& play) : num(static_cast<int>(play.stops.size())) {
    for (const BrakingStop& stop : play.stops) {
      falls += stop.fell;
      max_tilt = std::max(max_tilt, stop.max_tilt);
      max_slide = std::max(max_slide, stop.slide);
      max_distance = std::max(max_distance, stop.distance);
      max_time = std::max(max_time, stop.time);
      distances.push_back(stop.distance);
      times.push_back(stop.time);
    }
  }
};

std::string MotionText(const BrakingMotion& motion) {
  return motion.angular == 0.0
             ? fmt::format("{:.2f} m/s", motion.linear)
             : fmt::format("{:.2f} m/s, {:.2f} rad/s", motion.linear, motion.angular);
}

std::vector<std::string> StopRow(const BrakingPlay& play, const Summary& summary) {
  const BrakingCell& cell = play.cell;
  const Interval share = ShareInterval(summary.falls, summary.num);
  return {cell.load,
          MotionText(cell.motion),
          cell.way.name,
          fmt::format("{} of {}", summary.falls, summary.num),
          fmt::format("{:.3f} .. {:.3f}", share.lower, share.upper),
          fmt::format("{:.3f}", summary.max_tilt),
          fmt::format("{:.4f}", summary.max_slide),
          fmt::format("{:.3f} ({:.3f})", base::Mean(summary.distances), summary.max_distance),
          fmt::format("{:.3f}", cell.stated_distance),
          fmt::format("{:.2f} ({:.2f})", base::Mean(summary.times), summary.max_time),
          fmt::format("{:.2f}", cell.stated_time)};
}

const char* Verdict(bool tips, bool falls) { return falls ? "falls" : tips ? "rocks" : "stands"; }

std::vector<std::string> FormsRow(const BrakingPlay& play) {
  const BrakingCell& cell = play.cell;
  const bool tips = play.ideal->max_tilt > kTipped, falls = play.ideal->fell;
  return {cell.load,
          MotionText(cell.motion),
          cell.way.name,
          fmt::format("{:.3g}", cell.deceleration),
          Verdict(cell.is_predicted_to_tip, cell.is_predicted_to_fall),
          Verdict(tips, falls),
          fmt::format("{:.3f}", play.ideal->max_tilt)};
}

std::vector<std::string> LimitsRow(const BrakingCell& cell) {
  return {cell.load,
          fmt::format("{:.1f} mm / {:.1f} mm", 1000.0 * cell.standing.support,
                      1000.0 * cell.standing.com_height),
          fmt::format("{:.2f}", navigation::TippingAcceleration(cell.standing, 9.81)),
          fmt::format("{:.3f}", cell.limits.max_deceleration),
          fmt::format("{:.2f}", cell.limits.max_jerk)};
}

bool Disagrees(const BrakingPlay& play) {
  const bool falls = play.ideal->fell, tips = play.ideal->max_tilt > kTipped;
  return falls != play.cell.is_predicted_to_fall || tips != play.cell.is_predicted_to_tip;
}

nlohmann::ordered_json RowOf(const BrakingCell& cell, int index, const BrakingStop& stop) {
  return {{"load", cell.load},
          {"linear", cell.motion.linear},
          {"angular", cell.motion.angular},
          {"way", cell.way.name},
          {"rollout", index},
          {"fell", stop.fell},
          {"max_tilt", stop.max_tilt},
          {"tilt_before", stop.tilt_before},
          {"slide", stop.slide},
          {"distance", stop.distance},
          {"time", stop.time}};
}

/// What is expected of one way, over all loads and motions.
struct Worst {
  int falls{0};
  double max_tilt{0.0}, max_slide{0.0}, max_distance{0.0}, distance_error{0.0}, time_error{0.0};

  void Add(const BrakingCell& cell, const Summary& summary) {
    falls += summary.falls;
    max_tilt = std::max(max_tilt, summary.max_tilt);
    max_slide = std::max(max_slide, summary.max_slide);
    max_distance = std::max(max_distance, summary.max_distance);
    if (cell.motion.angular != 0.0) return;  // the distance is that of an arc
    distance_error =
        std::max(distance_error, std::abs(base::Mean(summary.distances) - cell.stated_distance));
    time_error = std::max(time_error, std::abs(base::Mean(summary.times) - cell.stated_time));
  }
};

void AddMeasures(const std::string& way, const Worst& worst, std::vector<Measure>* measures) {
  measures->push_back({"falls_" + way, static_cast<double>(worst.falls)});
  measures->push_back({"max_tilt_" + way, worst.max_tilt});
  measures->push_back({"max_slide_" + way, worst.max_slide});
  measures->push_back({"max_distance_" + way, worst.max_distance});
  measures->push_back({"distance_error_" + way, worst.distance_error});
  measures->push_back({"time_error_" + way, worst.time_error});
}

}  // namespace

Findings SumUpBraking(const BrakingConfig& braking, const std::vector<BrakingPlay>& plays) {
  Findings findings;
  TextTable stops{"Stops: mean (largest) distance [m] and time [s] beside the closed forms",
                  {{"load", "from", "way", "falls", "interval at 95 %", "max tilt", "max slide",
                    "distance", "stated", "time", "stated"}}};
  TextTable forms{"Closed forms: a base that follows exactly, no slip",
                  {{"load", "from", "way", "m/s^2", "predicted", "simulated", "max tilt"}}};
  TextTable limits{"What the ramp asks of each load",
                   {{"load", "support / height", "tips at [m/s^2]", "ramp [m/s^2]", "[m/s^3]"}}};
  std::map<std::string, Worst> worst;
  double disagreements = 0.0;
  for (const BrakingPlay& play : plays) {
    const Summary summary(play);
    stops.rows.push_back(StopRow(play, summary));
    worst[play.cell.way.name].Add(play.cell, summary);
    if (limits.rows.back().front() != play.cell.load) limits.rows.push_back(LimitsRow(play.cell));
    if (play.ideal) {
      forms.rows.push_back(FormsRow(play));
      disagreements += Disagrees(play);
    }
    for (std::size_t i = 0; i < play.stops.size(); ++i) {
      findings.rows.push_back(RowOf(play.cell, static_cast<int>(i), play.stops[i]));
      findings.simulated_seconds += play.stops[i].simulated;
    }
  }
  findings.measures = {{"rollouts", static_cast<double>(braking.rollouts)},
                       {"closed_form_disagreements", disagreements}};
  for (const BrakingWay& way : braking.ways)
    AddMeasures(way.name, worst[way.name], &findings.measures);
  findings.tables = {std::move(stops), std::move(forms), std::move(limits)};
  return findings;
}

}  // namespace hires::lab
