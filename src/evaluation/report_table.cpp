#include "hires/evaluation/report_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "hires/base/text.h"

namespace hires::evaluation {
namespace {

/// Characters as a terminal shows them: UTF-8 continuation bytes take no place.
std::size_t Width(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](unsigned char c) { return (c & 0xC0) != 0x80; }));
}

bool IsNumber(const std::string& text) {
  return !text.empty() && (std::isdigit(static_cast<unsigned char>(text[0])) || text[0] == '-');
}

std::string Failures(const imagination::Evidence& evidence) {
  std::vector<std::string> parts;
  for (const auto& [failure, count] : evidence.failures) {
    parts.push_back(fmt::format("{} {}", base::ToString(failure), count));
  }
  return base::Join(parts, ", ");
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

std::string RankingTable(const std::vector<imagination::Prediction>& ranking, int recommended) {
  std::vector<std::vector<std::string>> rows{{"", "action", "success", "95 % interval",
                                              "confidence", "falls", "duration", "tilt p95", "n",
                                              "failures"}};
  for (std::size_t i = 0; i < ranking.size(); ++i) {
    const imagination::Evidence& e = ranking[i].evidence;
    rows.push_back(
        {static_cast<int>(i) == recommended ? ">" : "", base::ToString(ranking[i].action),
         fmt::format("{:.1f} %", 100.0 * e.success.share),
         fmt::format("{:.1f} .. {:.1f} %", 100.0 * e.success.lower, 100.0 * e.success.upper),
         fmt::format("{:.3f}", e.confidence_mean), fmt::format("{}", e.falls),
         fmt::format("{:.1f} ± {:.1f} s", e.duration.mean, e.duration.sd),
         fmt::format("{:.4f} rad", e.max_tilt.p95), fmt::format("{}", e.num_rollouts),
         Failures(e)});
  }
  return FormatTable(rows);
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

}  // namespace hires::evaluation
