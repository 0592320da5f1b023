#include <fmt/format.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "lab/src/interval_json.h"
#include "lab/src/recognition/torso_poses.h"
#include "lab/src/statistics.h"
#include "reports/text/known_number.h"
#include "reports/text/report_table.h"

namespace hires::lab {
namespace {

using nlohmann::ordered_json;

/// What is measured of a trial; a grasp that there is none of counts as quality 0.
using Indicator = std::function<double(const PoseTrial&)>;
double Recognised(const PoseTrial& trial) { return trial.recognised; }
double Quality(const PoseTrial& trial) { return trial.grasp.value_or(0.0); }

using Pose = std::pair<int, int>;  // torso, base

/// Each form counts once: the mean over its looks.
std::vector<double> ByKind(const TorsoPosesReport& report, const std::vector<Pose>& poses,
                           const Indicator& measure) {
  std::vector<double> means;
  for (int kind = 0; kind < static_cast<int>(report.kinds.size()); ++kind) {
    double sum = 0.0;
    for (const auto& [torso, base] : poses)
      for (int look = 0; look < report.looks; ++look)
        sum += measure(report.at(torso, base, kind, look));
    means.push_back(sum / (poses.size() * report.looks));
  }
  return means;
}

std::vector<Pose> PosesOf(const TorsoPosesReport& report, int torso, int base) {
  std::vector<Pose> poses;
  for (int t = 0; t < static_cast<int>(report.torsos.size()); ++t)
    for (int b = 0; b < static_cast<int>(report.bases.size()); ++b)
      if ((torso < 0 || t == torso) && (base < 0 || b == base)) poses.emplace_back(t, b);
  return poses;
}

std::string IntervalText(const Interval& value) {
  return fmt::format("{:.2f} ({:.2f} .. {:.2f})", value.estimate, value.lower, value.upper);
}

Interval IntervalOf(const TorsoPosesReport& report, int torso, int base, const Indicator& measure) {
  return BootstrapInterval(ByKind(report, PosesOf(report, torso, base), measure), base::Rng(1));
}

/// Of a measure at some poses less at others, thing by thing.
Interval DifferenceOf(const TorsoPosesReport& report, const std::vector<Pose>& first,
                      const std::vector<Pose>& second, const Indicator& measure) {
  std::vector<double> one = ByKind(report, first, measure);
  const std::vector<double> other = ByKind(report, second, measure);
  for (std::size_t i = 0; i < one.size(); ++i) one[i] -= other[i];
  return BootstrapInterval(one, base::Rng(1));
}

int NumGrasps(const TorsoPosesReport& report, const std::vector<Pose>& poses) {
  int count = 0;
  for (const auto& [torso, base] : poses)
    for (int kind = 0; kind < static_cast<int>(report.kinds.size()); ++kind)
      for (int look = 0; look < report.looks; ++look)
        count += report.at(torso, base, kind, look).grasp.has_value();
  return count;
}

struct Finding {
  std::string what;
  Interval difference;
  double from;  ///< mean of what is subtracted
};

std::vector<Finding> FindingsOf(const TorsoPosesReport& report) {
  const int up = static_cast<int>(report.torsos.size()) - 1;
  const auto torso = [&](int t) { return PosesOf(report, t, -1); };
  std::vector<Finding> findings{
      {"recognition, torso down less up", DifferenceOf(report, torso(0), torso(up), Recognised),
       base::Mean(ByKind(report, torso(up), Recognised))},
      {"grasp quality, torso up less down", DifferenceOf(report, torso(up), torso(0), Quality),
       base::Mean(ByKind(report, torso(0), Quality))}};
  for (int base = 1; base < static_cast<int>(report.bases.size()); ++base) {
    findings.push_back(
        {fmt::format("recognition, base {} less default", report.bases[base]),
         DifferenceOf(report, PosesOf(report, -1, base), PosesOf(report, -1, 0), Recognised),
         base::Mean(ByKind(report, PosesOf(report, -1, 0), Recognised))});
  }
  return findings;
}

}  // namespace

std::string ReportText(const TorsoPosesReport& report) {
  const int trials = static_cast<int>(report.kinds.size()) * report.looks;
  std::vector<std::vector<std::string>> rows{
      {"torso", "base", "recognition", "grasp quality", "can be grasped [%]"}};
  for (const auto& [torso, base] : PosesOf(report, -1, -1)) {
    rows.push_back({report.torsos[torso], report.bases[base],
                    IntervalText(IntervalOf(report, torso, base, Recognised)),
                    IntervalText(IntervalOf(report, torso, base, Quality)),
                    fmt::format("{:.0f}", 100.0 * NumGrasps(report, {{torso, base}}) / trials)});
  }
  std::string text = fmt::format(
      "{} forms of things, {} looks at each from each pose; simulated; means over forms with 95 % "
      "intervals [bootstrap, percentiles]\n\n{}\n",
      report.kinds.size(), report.looks, reports::FormatTable(rows));
  std::vector<std::vector<std::string>> kinds{{"thing"}};
  for (const std::string& torso : report.torsos) kinds[0].push_back("recognition " + torso);
  for (const std::string& torso : report.torsos) kinds[0].push_back("grasp " + torso);
  for (const std::string& kind : report.kinds) kinds.push_back({kind});
  for (const Indicator& measure : {Indicator(Recognised), Indicator(Quality)}) {
    for (int torso = 0; torso < static_cast<int>(report.torsos.size()); ++torso) {
      const auto means = ByKind(report, PosesOf(report, torso, -1), measure);
      for (std::size_t k = 0; k < means.size(); ++k)
        kinds[k + 1].push_back(fmt::format("{:.2f}", means[k]));
    }
  }
  text += reports::FormatTable(kinds) + "\n";
  for (const Finding& finding : FindingsOf(report))
    text += fmt::format("{}: {}\n", finding.what, IntervalText(finding.difference));
  return text;
}

ordered_json ToJson(const TorsoPosesReport& report) {
  ordered_json poses = ordered_json::array(), findings = ordered_json::array();
  for (const auto& [torso, base] : PosesOf(report, -1, -1)) {
    ordered_json kinds = ordered_json::array();
    const auto recognised = ByKind(report, {{torso, base}}, Recognised);
    const auto quality = ByKind(report, {{torso, base}}, Quality);
    for (std::size_t k = 0; k < report.kinds.size(); ++k) {
      kinds.push_back({{"kind", report.kinds[k]},
                       {"recognition", recognised[k]},
                       {"grasp_quality", quality[k]}});
    }
    poses.push_back({{"torso", report.torsos[torso]},
                     {"base", report.bases[base]},
                     {"recognition", IntervalJson(IntervalOf(report, torso, base, Recognised))},
                     {"grasp_quality", IntervalJson(IntervalOf(report, torso, base, Quality))},
                     {"grasps", NumGrasps(report, {{torso, base}})},
                     {"kinds", kinds}});
  }
  for (const Finding& finding : FindingsOf(report))
    findings.push_back(
        {{"finding", finding.what},
         {"difference", IntervalJson(finding.difference)},
         {"relative", reports::NumberOrNull(finding.difference.estimate / finding.from)}});
  return {{"schema", "hires/torso_poses"},
          {"version", 1},
          {"looks", report.looks},
          {"poses", poses},
          {"findings", findings}};
}

}  // namespace hires::lab
