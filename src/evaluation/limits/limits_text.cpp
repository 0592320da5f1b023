#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "hires/base/hash.h"
#include "hires/evaluation/motion_limits.h"
#include "hires/evaluation/report_table.h"

// What was found, for people and for machines.
namespace hires::evaluation {
namespace {

std::string Amount(double value, const MotionLimit& limit) {
  if (std::isinf(value)) return "-";
  if (limit.motion == "together") return fmt::format("{:.0f} % {}", 100.0 * value, limit.unit);
  return fmt::format("{:.2f} {}", value, limit.unit);
}

std::string ClosedForm(const MotionLimit& limit) {
  if (std::isinf(limit.closed_form)) return limit.stated.empty() ? "-" : limit.stated;
  return fmt::format("{}: {}", limit.stated, Amount(limit.closed_form, limit));
}

/// "3 and 41", or "3" where the base cannot do more.
std::string Falls(const LimitCheck& check) {
  return check.falls_above ? fmt::format("{} and {}", check.falls_at, *check.falls_above)
                           : fmt::format("{}", check.falls_at);
}

/// As a number to be pasted: rounded down.
double Floored(double value) { return std::floor(value * 1e3) / 1e3; }

nlohmann::ordered_json OrNull(double value) {
  return std::isinf(value) ? nlohmann::ordered_json() : nlohmann::ordered_json(value);
}

}  // namespace

std::string LimitsText(const LimitsReport& report) {
  const int num_checked = report.request.check_truths;
  std::vector<std::vector<std::string>> rows{{"motion", "limit", "robot's own", "closed form"}};
  if (num_checked > 0) rows[0].push_back(fmt::format("falls of {} new, 10 % above", num_checked));
  for (const MotionLimit& limit : report.limits) {
    const bool is_share = limit.motion == "together";
    rows.push_back({limit.motion, Amount(limit.value, limit),
                    is_share ? "-" : Amount(limit.robots_own, limit), ClosedForm(limit)});
    if (limit.check) rows.back().push_back(Falls(*limit.check));
  }
  std::string text = FormatTable(rows);
  text += fmt::format(
      "\n{} falls in none of {} simulated truths at these limits: at least {:g} % of such drives "
      "keep it "
      "(95 % confidence).\n"
      "speed, turning: from where the base may stop by itself, as when commands cease. together: "
      "speeding "
      "up on an arc, and braking at once.\n"
      "truths: same (the uncertainty that imagination has: {}), empty floor. closed form: the "
      "model as it "
      "is, on a base that follows exactly.\n",
      report.request.object, report.num_truths, 100.0 * (1.0 - report.request.max_fall),
      report.uncertainty);
  if (report.wall_seconds > 0.0) {
    text += fmt::format("{:.0f} s played in {:.1f} s, {:.0f} times as fast as real time\n",
                        report.simulated_seconds, report.wall_seconds,
                        report.simulated_seconds / report.wall_seconds);
  }
  return text;
}

std::string LimitsYaml(const LimitsReport& report) {
  const double share = report.Of("together").value;
  const double speed = Floored(share * report.Of("speed").value);
  const double turning = Floored(share * report.Of("turning").value);
  const double linear =
      Floored(share * std::min(report.Of("acceleration").value, report.Of("deceleration").value));
  const double angular = Floored(share * report.own_angular_acceleration);
  std::string text = fmt::format(
      "# {} on the tray, seed {}, at most {:g} of drives lose it\nDWAPlannerROS:\n"
      "  max_vel_trans: {:g}\n  max_vel_x: {:g}\n  max_vel_theta: {:g}\n  acc_lim_x: {:g}\n",
      report.request.object, report.request.seed, report.request.max_fall, speed, speed, turning,
      linear);
  if (report.is_omnidirectional) {
    text += fmt::format("  max_vel_y: {:g}\n  min_vel_y: {:g}\n  acc_lim_y: {:g}\n", speed, -speed,
                        linear);
  }
  return text + fmt::format("  acc_lim_theta: {:g}\n", angular);
}

nlohmann::ordered_json ToJson(const LimitsReport& report) {
  nlohmann::ordered_json limits = nlohmann::ordered_json::array();
  for (const MotionLimit& limit : report.limits) {
    limits.push_back({{"motion", limit.motion},
                      {"unit", limit.motion == "together" ? "share" : limit.unit},
                      {"limit", limit.value},
                      {"robots_own", limit.robots_own},
                      {"closed_form", OrNull(limit.closed_form)},
                      {"closed_form_states", limit.stated}});
    if (!limit.check) continue;
    limits.back()["check_falls"] = limit.check->falls_at;
    if (limit.check->falls_above) limits.back()["check_falls_above"] = *limit.check->falls_above;
  }
  return {{"object", report.request.object},
          {"model", report.model},
          {"max_fall", report.request.max_fall},
          {"confidence", 0.95},
          {"seed", report.request.seed},
          {"command_period_s", report.request.command_period},
          {"truths", report.num_truths},
          {"falls", 0},
          {"check_truths", report.request.check_truths},
          {"uncertainty", report.uncertainty},
          {"world_hash", base::HexOf(report.world_hash)},
          {"robot_hash", base::HexOf(report.robot_hash)},
          {"physics_hash", base::HexOf(report.physics_hash)},
          {"simulated_s", report.simulated_seconds},
          {"limits", limits}};
}

}  // namespace hires::evaluation
