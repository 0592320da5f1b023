#include <fmt/format.h>

#include <cmath>

#include "hires/base/text.h"
#include "reports/limits/motion_limits.h"
#include "reports/text/report_table.h"

// Which of the given limits each payload survives, for people and for machines.
namespace hires::reports {
namespace {

std::string ShownAs(double value, const MotionBounds& bounds) {
  if (std::isinf(value)) return "-";
  return bounds.motion == "together" ? "all" : fmt::format("{:.3f} {}", value, bounds.unit);
}

/// "DWAPlannerROS: max_vel_x, acc_lim_x", a line for each section.
std::string KeyLines(const char* heading, const std::vector<std::string>& sections) {
  std::string text;
  for (const std::string& section : sections) text += fmt::format("{}: {}\n", heading, section);
  return text;
}

}  // namespace

std::string GivenText(const GivenReport& report, const GivenLimits& given) {
  std::vector<std::vector<std::string>> rows{
      {"object", "motion", "limit", "source", "closed form", "slide", "survives"}};
  for (const GivenVerdict& verdict : report.verdicts) {
    rows.push_back({verdict.object, verdict.bounds.motion, ShownAs(verdict.value, verdict.bounds),
                    verdict.source, ShownAs(verdict.bounds.closed_form, verdict.bounds),
                    fmt::format("{:.3f} m", verdict.slide),
                    verdict.survives()
                        ? "yes"
                        : fmt::format("no: {} of {} fail", verdict.falls, report.num_truths)});
  }
  std::string text = KeyLines("used", given.used) + KeyLines("not used", given.unused) +
                     fmt::format("\ngiven limits, {} truths for each motion\n", report.num_truths) +
                     FormatTable(rows);
  text += fmt::format(
      "\nsurvives: fails in none of {} simulated truths, so at least {:g} % keep it (95 % "
      "confidence). A slide of more than {:g} m is a failure (--max-slide).\n"
      "acceleration, deceleration: to and from the speed of this table. together: all limits at "
      "once, on an arc. robot's own: the file has no such limit, or a larger one.\n",
      report.num_truths, 100.0 * (1.0 - report.request.max_fall), report.max_slide);
  const auto acceleration = given.values.find("acceleration");
  if (acceleration != given.values.end() && acceleration->second > report.sliding_acceleration) {
    text += fmt::format(
        "The acceleration of {:g} m/s^2 is above mu g = {:.3f} m/s^2: the payload "
        "slides at every start.\n",
        acceleration->second, report.sliding_acceleration);
  }
  return text;
}

std::string GivenCsv(const GivenReport& report) {
  std::string csv = "object,motion,unit,limit,source,closed_form,slide_m,falls,truths,survives\n";
  for (const GivenVerdict& verdict : report.verdicts) {
    const MotionBounds& bounds = verdict.bounds;
    const double form = bounds.closed_form;
    csv += fmt::format("{},{},{},{:.6g},{},{},{:.6g},{},{},{}\n", verdict.object, bounds.motion,
                       bounds.motion == "together" ? "share" : bounds.unit, verdict.value,
                       verdict.source, std::isinf(form) ? "" : fmt::format("{:.6g}", form),
                       verdict.slide, verdict.falls, report.num_truths, verdict.survives() ? 1 : 0);
  }
  return csv;
}

}  // namespace hires::reports
