#include "reports/text/report_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "hires/base/text.h"

namespace hires::reports {
namespace {

/// Characters as a terminal shows them: UTF-8 continuation bytes take no place.
std::size_t Width(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](unsigned char c) { return (c & 0xC0) != 0x80; }));
}

bool IsNumber(const std::string& text) {
  return !text.empty() && (std::isdigit(static_cast<unsigned char>(text[0])) || text[0] == '-');
}

/// A cell has no room for a sentence, nor for where things touch: that stands below the table.
bool HasSentence(const base::Failure& failure) {
  constexpr std::size_t kLongestInCell = 48;
  return failure.detail.size() > kLongestInCell ||
         failure.code == base::FailureCode::kRobotCollision;
}

std::string InCell(const base::Failure& failure) {
  if (!HasSentence(failure)) return base::ToString(failure);
  base::Failure shown(failure.code, failure.subjects);
  const bool is_touch = failure.code == base::FailureCode::kRobotCollision;
  if (is_touch && failure.subjects.size() == 2)
    shown.detail = failure.subjects[0] + " touches " + failure.subjects[1];
  return base::ToString(shown);
}

std::string Failures(const imagination::Evidence& evidence) {
  std::vector<std::string> parts;
  for (const auto& [failure, count] : evidence.failures) {
    parts.push_back(fmt::format("{} {}", InCell(failure), count));
  }
  return base::Join(parts, ", ");
}

std::vector<std::string> Heads(bool with_cost) {
  std::vector<std::string> heads{"",           "action",  "success",  "95 % interval",
                                 "confidence", "falls",   "duration", "tilt p95",
                                 "n",          "failures"};
  if (with_cost) heads.insert(heads.begin() + 4, {"cost", "95 % interval"});
  return heads;
}

/// Expected cost and its interval.
std::vector<std::string> CostCells(const std::optional<imagination::ExpectedCost>& cost) {
  if (!cost) return {"-", "-"};
  return {fmt::format("{:.1f} s", cost->mean),
          fmt::format("{:.1f} .. {:.1f} s", cost->lower, cost->upper)};
}

std::vector<std::string> Row(const imagination::Prediction& prediction, bool is_recommended,
                             bool with_cost) {
  const imagination::Evidence& e = prediction.evidence;
  std::vector<std::string> row{
      is_recommended ? ">" : "",
      base::ToString(prediction.action),
      fmt::format("{:.1f} %", 100.0 * e.success.share),
      fmt::format("{:.1f} .. {:.1f} %", 100.0 * e.success.lower, 100.0 * e.success.upper),
      fmt::format("{:.3f}", e.confidence_mean),
      fmt::format("{}", e.falls),
      e.duration.mean > 0.0 ? fmt::format("{:.1f} ± {:.1f} s", e.duration.mean, e.duration.sd)
                            : "-",
      fmt::format("{:.4f} rad", e.max_tilt.p95),
      fmt::format("{}", e.num_rollouts),
      Failures(e)};
  const std::vector<std::string> cost = CostCells(e.cost);
  if (with_cost) row.insert(row.begin() + 4, cost.begin(), cost.end());
  return row;
}

/// In words, how the intervals of success were made: all of one ranking are of one kind.
std::string KindLine(const std::vector<imagination::Prediction>& ranking) {
  if (ranking.empty()) return "";
  const imagination::IntervalKind kind = ranking.front().evidence.success.kind;
  return fmt::format("95 % intervals: {} ({})\n", imagination::ToString(kind),
                     kind == imagination::IntervalKind::kClopperPearson
                         ? "the number of rollouts was fixed beforehand"
                         : "valid whenever imagination stopped");
}

}  // namespace

std::string FormatTable(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], Width(row[i]));
  }
  std::string text;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    std::string line;
    for (std::size_t i = 0; i < rows[r].size(); ++i) {
      const std::string pad(widths[i] - Width(rows[r][i]), ' ');
      line += IsNumber(rows[r][i]) ? pad + rows[r][i] : rows[r][i] + pad;
      line += "  ";
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
    if (r == 0) {
      std::size_t total = 0;
      for (const std::size_t width : widths) total += width + 2;
      text += std::string(total - 2, '-') + '\n';
    }
  }
  return text;
}

std::string RankingTable(const std::vector<imagination::Prediction>& ranking, int recommended,
                         bool with_cost, const std::string& prices) {
  std::vector<std::vector<std::string>> rows{Heads(with_cost)};
  for (std::size_t i = 0; i < ranking.size(); ++i) {
    rows.push_back(Row(ranking[i], static_cast<int>(i) == recommended, with_cost));
  }
  const std::string price_line = prices.empty() ? "" : "cost: seconds; " + prices + '\n';
  return FormatTable(rows) + KindLine(ranking) + price_line;
}

std::string FailureLines(const std::vector<imagination::Prediction>& ranking) {
  struct Told {
    const base::Failure* failure;
    std::vector<std::string> actions;
  };
  std::vector<Told> told;
  for (const imagination::Prediction& prediction : ranking) {
    for (const auto& [failure, count] : prediction.evidence.failures) {
      if (!HasSentence(failure) || failure.detail.empty()) continue;
      const base::Failure& now = failure;
      auto same = std::find_if(told.begin(), told.end(), [&](const Told& before) {
        return before.failure->code == now.code && before.failure->detail == now.detail;
      });
      if (same == told.end()) same = told.insert(same, {&failure, {}});
      same->actions.push_back(base::ToString(prediction.action));
    }
  }
  std::string lines;
  for (const auto& [failure, actions] : told) {
    lines += fmt::format("{}: {}: {}\n", base::ToString(failure->code), base::Join(actions, ", "),
                         failure->detail);
  }
  return lines;
}

std::string ProgressLine(const imagination::Progress& progress, int width) {
  constexpr int kBar = 24;
  const int filled = std::clamp(static_cast<int>(progress.fraction * kBar + 0.5), 0, kBar);
  std::string line = fmt::format("[{}{}] {:3.0f} %  {} of {} rollouts", std::string(filled, '#'),
                                 std::string(kBar - filled, '.'), 100.0 * progress.fraction,
                                 progress.done, progress.total);
  if (progress.time_left) line += fmt::format(", {:.0f} s left", *progress.time_left);
  line.resize(std::min<std::size_t>(line.size(), width));
  return line;
}

}  // namespace hires::reports
