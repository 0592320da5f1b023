#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "lab/src/interval_json.h"
#include "lab/src/ladder/ladder.h"
#include "reports/text/known_number.h"
#include "reports/text/report_table.h"

namespace hires::lab {
namespace {

using nlohmann::ordered_json;

ordered_json SideJson(const LadderSide& side) {
  return {{"what", side.what},
          {"facts", side.facts},
          {"values", side.values},
          {"mean", base::Mean(side.values)}};
}

ordered_json PairJson(const LadderPair& pair) {
  return {{"threads", pair.threads},
          {"rounds", pair.rounds},
          {"before", SideJson(pair.before)},
          {"after", SideJson(pair.after)},
          {"ratio", IntervalJson(pair.ratio)}};
}

ordered_json RungJson(const LadderRung& rung) {
  ordered_json json{{"id", rung.id},
                    {"title", rung.title},
                    {"unit", "real-time factor"},
                    {"published",
                     {{"before", reports::NumberOrNull(rung.published_before)},
                      {"after", reports::NumberOrNull(rung.published_after)},
                      {"text", rung.published}}}};
  json.update(PairJson(rung.one_core));
  json["all_cores"] = rung.all_cores ? PairJson(*rung.all_cores) : ordered_json(nullptr);
  json["apart"] = reports::NumberOrNull(rung.apart);
  json["note"] = rung.note;
  return json;
}

ordered_json OwnJson(const LadderOwn& own) {
  return {{"id", own.id},
          {"title", own.title},
          {"unit", own.unit},
          {"values", own.values},
          {"mean", own.mean.estimate},
          {"lower", reports::NumberOrNull(own.mean.lower)},
          {"upper", reports::NumberOrNull(own.mean.upper)}};
}

/// Three digits that count, whatever the size.
std::string Short(double value) {
  return std::abs(value) >= 100.0 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

std::string IntervalText(const Interval& interval) {
  return fmt::format("{} ({} .. {})", Short(interval.estimate), Short(interval.lower),
                     Short(interval.upper));
}

std::vector<std::string> Row(const std::string& title, const LadderPair& pair,
                             const std::string& published) {
  return {title, Short(base::Mean(pair.before.values)), Short(base::Mean(pair.after.values)),
          IntervalText(pair.ratio), published};
}

std::string PublishedText(const LadderRung& rung) {
  const auto text = [](const std::optional<double>& value) {
    return value ? fmt::format("{:.2f}", *value) : std::string("?");
  };
  if (!rung.published_before && !rung.published_after) return "";
  return text(rung.published_before) + " -> " + text(rung.published_after);
}

std::string RungTable(const LadderReport& report) {
  std::vector<std::vector<std::string>> rows{
      {"real-time factor", "before", "after", "after / before", "dissertation"}};
  for (const LadderRung& rung : report.rungs) {
    rows.push_back(Row(rung.title, rung.one_core, PublishedText(rung)));
    if (rung.all_cores)
      rows.push_back(
          Row(fmt::format("  ... on {} threads", rung.all_cores->threads), *rung.all_cores, ""));
  }
  return reports::FormatTable(rows);
}

std::string OwnTable(const LadderReport& report) {
  std::vector<std::vector<std::string>> rows{{"one step to a ranked answer", "mean", "unit"}};
  for (const LadderOwn& own : report.own)
    rows.push_back({own.title, IntervalText(own.mean), own.unit});
  return reports::FormatTable(rows);
}

}  // namespace

std::string ReportText(const LadderReport& report) {
  std::string notes;
  for (const LadderRung& rung : report.rungs) {
    notes +=
        fmt::format("{}: {}; dissertation: {}\n", rung.title,
                    rung.one_core.before.what + " -> " + rung.one_core.after.what, rung.published);
    if (!rung.note.empty()) notes += "  " + rung.note + "\n";
    if (rung.apart) notes += fmt::format("  objects end {:.1g} m apart at most\n", *rung.apart);
  }
  return fmt::format("{}\n{}\n{}\nat most {} repeats, {:.0f} s in all\n", RungTable(report), notes,
                     OwnTable(report), report.repeats, report.wall_seconds);
}

ordered_json ToJson(const LadderReport& report) {
  ordered_json json{{"schema", "hires/ladder"},
                    {"version", 1},
                    {"cores", report.cores},
                    {"seed", report.seed},
                    {"seconds", report.seconds},
                    {"repeats", report.repeats},
                    {"wall_seconds", report.wall_seconds}};
  json["rungs"] = ordered_json::array();
  for (const LadderRung& rung : report.rungs) json["rungs"].push_back(RungJson(rung));
  json["own"] = ordered_json::array();
  for (const LadderOwn& own : report.own) json["own"].push_back(OwnJson(own));
  return json;
}

}  // namespace hires::lab
