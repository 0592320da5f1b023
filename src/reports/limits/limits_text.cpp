#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "hires/base/hash.h"
#include "hires/base/text.h"
#include "reports/limits/motion_limits.h"
#include "reports/text/report_table.h"

// What was found, for people and for machines.
namespace hires::reports {
namespace {

/// Rounded down: never more than what was borne.
double Floored(double value, double scale) { return std::floor(value * scale + 1e-9) / scale; }

std::string Amount(double value, const MotionBounds& limit) {
  if (std::isinf(value)) return "-";
  if (limit.motion == "together") {
    return fmt::format("{:.0f} % {}", 100.0 * Floored(value, 1e2), limit.unit);
  }
  return fmt::format("{:.3f} {}", Floored(value, 1e3), limit.unit);
}

/// "3 and 41", or "3" where the base cannot do more.
std::string Falls(const LimitCheck& check) {
  return check.falls_above ? fmt::format("{} and {}", check.falls_at, *check.falls_above)
                           : fmt::format("{}", check.falls_at);
}

/// The planner of a base that steers like a car; it turns less sharply where it drives slowly.
std::string CarYaml(double speed, double turning, double linear, double angular, double radius) {
  return fmt::format(
      "TebLocalPlannerROS:\n  max_vel_x: {0:g}\n  max_vel_x_backwards: {0:g}\n  max_vel_y: 0\n"
      "  max_vel_theta: {1:g}\n  acc_lim_x: {2:g}\n  acc_lim_theta: {3:g}\n"
      "  min_turning_radius: {4:g}\n",
      speed, turning, linear, angular, radius);
}

const char* OwnHeading(bool is_assumed) {
  return is_assumed ? "robot's own, ASSUMED" : "robot's own";
}

/// What these limits say nothing of.
std::vector<std::string> LeftOut(const LimitsReport& report) {
  std::vector<std::string> texts = report.hazards.left_out;
  texts.push_back("payloads that swing");
  return texts;
}

/// A line for each payload that extends beyond the plate by as much as two decimals show.
std::string OverhangText(const std::vector<PayloadSupport>& payloads) {
  std::string text;
  for (const PayloadSupport& payload : payloads) {
    const Eigen::Vector2d& over = payload.overhang;
    if (over.maxCoeff() < 0.005) continue;
    text += fmt::format("overhang: {} extends {:.2f} / {:.2f} m (x / y) beyond the tray's plate\n",
                        payload.name, over.x(), over.y());
  }
  return text;
}

/// Where several payloads are on the tray.
std::string PositionText(const std::vector<PayloadSupport>& payloads) {
  std::vector<std::string> places;
  for (const PayloadSupport& payload : payloads) {
    places.push_back(
        fmt::format("{} at ({:.2f}, {:.2f}) m", payload.name, payload.p_BO.x(), payload.p_BO.y()));
  }
  return places.size() < 2
             ? ""
             : "together on the tray (base frame): " + base::Join(places, ", ") + '\n';
}

nlohmann::ordered_json ToJson(const PayloadSupport& payload) {
  return {{"object", payload.name},
          {"position_m", {payload.p_BO.x(), payload.p_BO.y()}},
          {"overhang_m", {payload.overhang.x(), payload.overhang.y()}}};
}

nlohmann::ordered_json OrNull(double value) {
  return std::isinf(value) ? nlohmann::ordered_json() : nlohmann::ordered_json(value);
}

std::string Names(const LimitsRequest& request) { return base::Join(request.objects, ", "); }

/// Whether a limit was found at the speed limit, and another one holds at any speed.
bool HoldsUpToASpeed(const MotionBounds& limit) {
  return limit.motion == "acceleration" || limit.motion == "deceleration";
}

/// Up to which speed acceleration and deceleration hold, and what a faster robot has.
std::string ValidityText(const LimitsReport& report) {
  const MotionLimit& limit = report.Of("deceleration");
  const double any = limit.closed_form;
  return fmt::format(
      "acceleration, deceleration: hold up to the speed found ({}); a faster robot has {} ({}), "
      "for the model as it is.\n",
      Amount(report.Of("speed").value, report.Of("speed")), Amount(any, limit),
      any < 1e-9                                          ? "it rolls"
      : any < report.SlidingAcceleration() * (1.0 - 1e-9) ? "g b/c"
                                                          : "mu g");
}

/// When a slide counts, and the speed at which it stays small.
std::string SlideText(const LimitsReport& report) {
  std::string text = fmt::format(
      "slide: a payload counts as kept while it slides at most {:g} m in one motion (--max-slide); "
      "the largest at each limit is in the table.\n",
      report.max_slide);
  if (!report.careful) return text;
  const MotionLimit& speed = report.Of("speed");
  return text + (report.careful->value
                     ? fmt::format("speed for a slide of at most {:g} m: {}.\n",
                                   report.careful->slide, Amount(*report.careful->value, speed))
                     : fmt::format("speed for a slide of at most {:g} m: less than a 30th of the "
                                   "speed limit.\n",
                                   report.careful->slide));
}

/// Empty, or that a payload slides whenever the base speeds up by this [m/s^2] in the plane.
std::string SlidesAtEveryStart(double acceleration, double slides) {
  if (acceleration <= slides) return "";
  return fmt::format(
      "acc_lim allows {:.3f} m/s^2, above mu g = {:.3f} m/s^2: the payload slides at every "
      "start.\n",
      acceleration, slides);
}

nlohmann::ordered_json ToJson(const HazardLimits& limits) {
  nlohmann::ordered_json hazards = nlohmann::ordered_json::array();
  for (const MotionBounds& bound : limits.bounds) {
    hazards.push_back({{"hazard", bound.motion},
                       {"unit", bound.unit},
                       {"limit", OrNull(bound.closed_form)},
                       {"robots_own", bound.robots_own},
                       {"closed_form_states", bound.stated}});
  }
  return hazards;
}

}  // namespace

std::string ClosedFormText(const ClosedForms& forms, bool is_assumed) {
  std::vector<std::vector<std::string>> rows{
      {"motion", "closed form", OwnHeading(is_assumed), "why"}};
  for (const MotionBounds& motion : forms.weakest) {
    rows.push_back({motion.motion, Amount(motion.closed_form, motion),
                    Amount(motion.robots_own, motion), motion.stated});
  }
  return "closed forms: the model as it is, on an even floor and a base that follows exactly\n" +
         FormatTable(rows) + PositionText(forms.payloads) + OverhangText(forms.payloads);
}

std::string LimitsText(const LimitsReport& report) {
  const int num_checked = report.request.check_truths;
  std::vector<std::vector<std::string>> rows{{"motion", "limit",
                                              OwnHeading(report.request.is_controller_assumed),
                                              "closed form", "at any speed", "slide"}};
  if (num_checked > 0) rows[0].push_back(fmt::format("falls of {} new, 10 % above", num_checked));
  for (const MotionLimit& limit : report.limits) {
    const bool is_share = limit.motion == "together";
    rows.push_back({limit.motion, Amount(limit.value, limit),
                    is_share ? "-" : Amount(limit.robots_own, limit),
                    Amount(limit.closed_form, limit),
                    HoldsUpToASpeed(limit) ? Amount(limit.closed_form, limit) : "-",
                    fmt::format("{:.3f} m", limit.slide)});
    if (limit.check) rows.back().push_back(Falls(*limit.check));
  }
  std::string text =
      fmt::format("simulated, {} truths for each motion\n{}", report.num_truths, FormatTable(rows));
  text += fmt::format(
      "\nAt each limit {} falls in none of {} simulated truths: at least {:g} % keep it (95 % "
      "confidence, for each motion).\n{}{}"
      "speed, turning: from where the base may stop by itself, as when commands cease. together: "
      "on an arc, speeding up, then braking, or left without commands.\n"
      "truths: same (the uncertainty that imagination has: {}); empty floor; {}.\n",
      Names(report.request), report.num_truths, 100.0 * (1.0 - report.request.max_fall),
      ValidityText(report), SlideText(report), report.uncertainty,
      report.num_directions > 2
          ? fmt::format("driving into {} directions in turn", report.num_directions)
          : "driving forward and backward in turn");
  if (report.request.is_controller_assumed) {
    text +=
        "robot's own: ASSUMED to be a PR2's, as no file tells how this base is controlled; "
        "motion_sets or base_controller.limits of a profile do (config/robots/cart.yaml is "
        "one).\n";
  }
  text += "left out: " + base::Join(LeftOut(report), "; ") + ".\n";
  if (report.wall_seconds > 0.0) {
    text += fmt::format("{:.0f} s played in {:.1f} s, {:.0f} times as fast as real time\n",
                        report.simulated_seconds, report.wall_seconds,
                        report.simulated_seconds / report.wall_seconds);
  }
  return text;
}

std::string LimitsYaml(const LimitsReport& report) {
  const double share = report.Of("together").value;
  const auto part = [&](double value) { return Floored(share * value, 1e3); };
  const double speed = part(report.Of("speed").value);
  double linear = part(std::min(report.Of("acceleration").value, report.Of("deceleration").value));
  const bool is_cut = linear > report.hazards.MostAcceleration();
  if (is_cut) linear = Floored(report.hazards.MostAcceleration(), 1e3);
  // The local planner's limit is one of each axis: both together are sqrt(2) times as much.
  if (report.is_omnidirectional) linear = Floored(linear / std::sqrt(2.0), 1e3);
  std::string text = fmt::format(
      "# {} on the tray of {}: in simulation at least {:g} % of drives keep it (95 % confidence),\n"
      "# uncertainty {}, seed {}. For controller_frequency: {:g}.",
      Names(report.request), report.robot, 100.0 * (1.0 - report.request.max_fall),
      report.uncertainty, report.request.seed, 1.0 / report.request.command_period);
  text +=
      report.min_turning_radius > 0.0
          ? "\n"
          : " Before Noetic the keys are\n"
            "# max_trans_vel, max_rot_vel, acc_lim_th. min_vel_trans and min_vel_theta must not "
            "be larger.\n";
  if (report.request.is_controller_assumed) {
    text +=
        "# The base's controller is ASSUMED: limits and accelerations are cut off at a PR2's.\n";
  }
  text += fmt::format(
      "# acc_lim_x holds up to {:g} m/s; any speed: {}. Slides of up to {:g} m count as kept.\n",
      speed, Amount(report.Of("deceleration").closed_form, report.Of("deceleration")),
      report.max_slide);
  const std::string slides = SlidesAtEveryStart(
      report.is_omnidirectional ? std::sqrt(2.0) * linear : linear, report.SlidingAcceleration());
  if (!slides.empty()) text += "# " + slides;
  if (is_cut) text += "# Accelerations are cut off where the robot tips or the liquid spills.\n";
  text += "# Left out: " + base::Join(LeftOut(report), "; ") + ".\n";
  if (report.min_turning_radius > 0.0) {
    return text + CarYaml(speed, part(report.Of("turning").value), linear,
                          part(report.own_angular_acceleration), report.min_turning_radius);
  }
  const double sideways = report.is_omnidirectional ? speed : 0.0;
  return text +
         fmt::format(
             "DWAPlannerROS:\n  max_vel_trans: {0:g}\n  max_vel_x: {0:g}\n  max_vel_y: {1:g}\n"
             "  min_vel_y: {2:g}\n  max_vel_theta: {3:g}\n  acc_lim_x: {4:g}\n  acc_lim_y: {5:g}\n"
             "  acc_lim_theta: {6:g}\n",
             speed, sideways, sideways > 0.0 ? -sideways : 0.0, part(report.Of("turning").value),
             linear, report.is_omnidirectional ? linear : 0.0,
             part(report.own_angular_acceleration));
}

nlohmann::ordered_json ToJson(const LimitsReport& report) {
  nlohmann::ordered_json limits = nlohmann::ordered_json::array();
  for (const MotionLimit& limit : report.limits) {
    limits.push_back({{"motion", limit.motion},
                      {"unit", limit.motion == "together" ? "share" : limit.unit},
                      {"limit", limit.value},
                      {"robots_own", limit.robots_own},
                      {"closed_form", OrNull(limit.closed_form)},
                      {"closed_form_states", limit.stated},
                      {"slide_m", limit.slide}});
    if (HoldsUpToASpeed(limit)) {
      limits.back()["up_to_speed"] = report.Of("speed").value;
      limits.back()["at_any_speed"] = OrNull(limit.closed_form);
    }
    if (!limit.check) continue;
    limits.back()["check_falls"] = limit.check->falls_at;
    if (limit.check->falls_above) limits.back()["check_falls_above"] = *limit.check->falls_above;
  }
  nlohmann::ordered_json payloads = nlohmann::ordered_json::array();
  for (const PayloadSupport& payload : report.payloads) payloads.push_back(ToJson(payload));
  nlohmann::ordered_json careful;
  if (report.careful) {
    careful = {{"max_slide_m", report.careful->slide},
               {"speed", report.careful->value ? nlohmann::ordered_json(*report.careful->value)
                                               : nlohmann::ordered_json()}};
  }
  return {{"object", Names(report.request)},
          {"model", base::Join(report.models, ", ")},
          {"payloads", payloads},
          {"robot", report.robot},
          {"controller_assumed", report.request.is_controller_assumed},
          {"assumed", report.assumed},
          {"left_out", LeftOut(report)},
          {"hazards", ToJson(report.hazards)},
          {"directions", report.num_directions},
          {"own_angular_acceleration", report.own_angular_acceleration},
          {"max_fall", report.request.max_fall},
          {"max_slide_m", report.max_slide},
          {"sliding_acceleration", report.SlidingAcceleration()},
          {"careful_speed", careful},
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

}  // namespace hires::reports
