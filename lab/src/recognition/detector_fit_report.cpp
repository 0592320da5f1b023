#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "reports/text/known_number.h"
#include "hires/base/text.h"
#include "lab/src/recognition/detector_fit.h"
#include "reports/text/report_table.h"

namespace hires::lab {
namespace {

using nlohmann::ordered_json;
using perception::DetectorErrors;
using perception::Regression;

std::string Percent(double number, int of) { return reports::NumberText(100.0 * number / of, 1); }

std::string WeightsText(const DetectorErrors& errors) {
  const std::pair<const char*, const Regression*> all[]{{"found (log odds)", &errors.found},
                                                        {"named rightly (log odds)", &errors.named},
                                                        {"position (log m)", &errors.position.log},
                                                        {"turn (log rad)", &errors.turn.log}};
  std::vector<std::vector<std::string>> rows{{"regression"}};
  for (const char* name : perception::kRegressorNames) rows.front().emplace_back(name);
  rows.front().emplace_back("repeats");
  for (const auto& [name, one] : all) {
    rows.push_back({name});
    for (Eigen::Index i = 0; i < one->weight.size(); ++i)
      rows.back().push_back(fmt::format("{:+.2f} ({:.2f})", one->weight[i], one->error[i]));
    rows.back().push_back(fmt::format("{:.2f}", one->repeats));
  }
  return reports::FormatTable(rows);
}

std::string ChecksText(const std::vector<FitCheck>& checks) {
  std::vector<std::vector<std::string>> rows{{"held-out looks at", "number", "found [%]",
                                              "by the fit", "named rightly [%]", "by the fit",
                                              "median [mm]", "by the fit", "beyond its 95 % [%]"}};
  for (const FitCheck& one : checks) {
    rows.push_back({one.part, std::to_string(one.num_looks), Percent(one.num_found, one.num_looks),
                    Percent(one.found, one.num_looks), Percent(one.num_named, one.num_found),
                    Percent(one.named, one.num_found), reports::NumberText(1e3 * one.median_error, 2),
                    reports::NumberText(1e3 * one.expected, 2), reports::NumberText(100.0 * one.beyond, 1)});
  }
  return reports::FormatTable(rows);
}

std::string SourceText(const DetectorFitReport& report) {
  return fmt::format(
      "{} random tables from seed {} on, each looked at twice: {} looks at things, {} found, {} "
      "named rightly, {} seen as one with a neighbour",
      report.tables, report.seed, report.num_things, report.num_found, report.num_named,
      report.num_merged);
}

std::string GainText(const DetectorFitReport& report) {
  return fmt::format(
      "log likelihood per look against shares that are the same for all: found {:+.3f}, named "
      "{:+.3f}",
      report.gain_found, report.gain_named);
}

}  // namespace

std::string ReportText(const DetectorFitReport& report) {
  std::string text = SourceText(report) + "; weights with their standard errors\n\n" +
                     WeightsText(report.errors) + "\n";
  text += fmt::format(
      "spread of lengths: position {:.2f}, turn {:.2f}; direction away {:.2f}, "
      "across {:.2f}, up {:.2f}\n",
      report.errors.position.spread, report.errors.turn.spread, report.errors.direction.x(),
      report.errors.direction.y(), report.errors.direction.z());
  text += fmt::format("confidence in wrong names {:.2f}, in what it is {:.2f}\n\n",
                      report.errors.confidence, report.errors.doubt);
  text += fmt::format("{} other tables:\n\n", report.held_out) + ChecksText(report.checks);
  if (!report.empty_parts.empty())
    text += "left out, as no look was so: " + base::Join(report.empty_parts, ", ") + "\n";
  text += fmt::format(
      "distances are from the camera to the thing, the robot's base stands up to {:.1f} m before "
      "the table's middle\n\n",
      FitVariety().farthest);
  return text + GainText(report) + "\n";
}

ordered_json ToJson(const DetectorFitReport& report) {
  ordered_json checks = ordered_json::array();
  for (const FitCheck& one : report.checks) {
    checks.push_back({{"part", one.part},
                      {"looks", one.num_looks},
                      {"found", one.num_found},
                      {"found_by_fit", one.found},
                      {"named", one.num_named},
                      {"named_by_fit", one.named},
                      {"median_error", reports::NumberOrNull(one.median_error)},
                      {"median_error_by_fit", reports::NumberOrNull(one.expected)},
                      {"beyond_95", reports::NumberOrNull(one.beyond)}});
  }
  return {{"schema", "hires/detector_fit"},
          {"version", 1},
          {"tables", report.tables},
          {"seed", report.seed},
          {"looks", report.num_things},
          {"found", report.num_found},
          {"named", report.num_named},
          {"merged", report.num_merged},
          {"held_out_tables", report.held_out},
          {"checks", checks},
          {"gain_found", report.gain_found},
          {"gain_named", report.gain_named},
          {"errors", perception::ToYaml(report.errors)}};
}

std::string ToYaml(const DetectorFitReport& report) {
  std::string checks;
  for (const FitCheck& one : report.checks) {
    checks += fmt::format(
        "#   {}: {} looks, found {} % (fit {}), named {} % (fit {}), median {} mm (fit {})\n",
        one.part, one.num_looks, Percent(one.num_found, one.num_looks),
        Percent(one.found, one.num_looks), Percent(one.num_named, one.num_found),
        Percent(one.named, one.num_found), reports::NumberText(1e3 * one.median_error, 2),
        reports::NumberText(1e3 * one.expected, 2));
  }
  return fmt::format(
             "# How the head camera's recogniser errs. Written by `hires_lab experiment detector`, not "
             "by hand.\n"
             "# {},\n# {}.\n"
             "# Models, robot, parameters, sensor: {}; another one means that it is out of date.\n"
             "# {}.\n# {} other tables:\n{}"
             "# Regressors: docs/sources_perception.md.\n",
             report.objects, report.recogniser, report.hash, SourceText(report), report.held_out,
             checks) +
         perception::ToYaml(report.errors);
}

}  // namespace hires::lab
