#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "lab/src/place/pose_error_fit.h"
#include "reports/text/report_table.h"

namespace hires::lab {
namespace {

using nlohmann::ordered_json;

std::string SourceText(const PoseErrorReport& report) {
  return fmt::format("{} legs of {}, seeds {} to {}: the laser corrected {} times", report.num_legs,
                     report.drives, report.seed,
                     report.seed + static_cast<std::uint64_t>(report.series) - 1,
                     report.num_corrections);
}

std::vector<std::string> Row(const char* name, const PoseErrorFigures& of) {
  return {name,
          fmt::format("{:.3f} m", of.median),
          fmt::format("{:.3f} m", of.most),
          fmt::format("{:.3f} m", of.largest),
          fmt::format("{:.3f} m", of.rms),
          fmt::format("{:.4f} rad", of.rms_yaw),
          fmt::format("{:.3f} m", of.jump),
          fmt::format("{:.2f}", of.alike_after_1m),
          fmt::format("{:.2f}", of.alike_after_4m)};
}

std::string ChecksText(const PoseErrorReport& report) {
  return reports::FormatTable({{"position errs by", "median", "95 %", "largest", "rms", "heading, rms",
                       "a correction", "alike after 1 m", "after 4 m"},
                      Row("the filter", report.found),
                      Row("the fit", report.played)});
}

ordered_json Figures(const PoseErrorFigures& of) {
  return {{"median", of.median},
          {"most", of.most},
          {"largest", of.largest},
          {"rms", of.rms},
          {"rms_yaw", of.rms_yaw},
          {"jump", of.jump},
          {"alike_after_1m", of.alike_after_1m},
          {"alike_after_4m", of.alike_after_4m}};
}

}  // namespace

std::string ReportText(const PoseErrorReport& report) {
  return fmt::format("{}\n\n{}\n{} series of other seeds:\n\n{}", SourceText(report),
                     simulation::ToYaml(report.fit), report.held_out, ChecksText(report));
}

ordered_json ToJson(const PoseErrorReport& report) {
  return {{"schema", "hires/pose_error_fit"},
          {"version", 1},
          {"drives", report.drives},
          {"seed", report.seed},
          {"series", report.series},
          {"held_out", report.held_out},
          {"legs", report.num_legs},
          {"corrections", report.num_corrections},
          {"found", Figures(report.found)},
          {"played", Figures(report.played)},
          {"fit", simulation::ToYaml(report.fit)}};
}

std::string ToYaml(const PoseErrorReport& report) {
  std::string checks = ChecksText(report);
  std::string commented;
  for (std::size_t from = 0; from < checks.size();) {
    const std::size_t to = std::min(checks.find('\n', from), checks.size() - 1);
    commented += "#   " + checks.substr(from, to - from + 1);
    from = to + 1;
  }
  return fmt::format(
             "# How the place errs at which a robot takes itself to be that finds it by itself.\n"
             "# Written by `hires_lab experiment localisation`, not by hand.\n"
             "# {}.\n# {} series of other seeds, and the fit along the same ways:\n{}"
             "# Another world, laser, wheels or filters need another one: fitted_to tells.\n",
             SourceText(report), report.held_out, commented) +
         simulation::ToYaml(report.fit);
}

}  // namespace hires::lab
