#pragma once

#include <string>
#include <vector>

#include "hires/imagination/report.h"

namespace hires::reports {

/// Columns of text, the first row underlined as heads; numbers to the right.
std::string FormatTable(const std::vector<std::vector<std::string>>& rows);

/// What the table has no room for: a line for each sentence about a failure, with the actions that
/// it is about; of the first rollout that failed so. Empty where there is none.
std::string FailureLines(const std::vector<imagination::Prediction>& ranking);

/// The ranking as a table for people, the recommended line marked, and below it in words what kind
/// of intervals it shows.
/// @param with_cost  a column of expected costs where they are known.
/// @param prices  what failures cost, as PriceSentence says it, for a line below; or empty.
std::string RankingTable(const std::vector<imagination::Prediction>& ranking, int recommended,
                         bool with_cost = false, const std::string& prices = "");

/// "[#####.....]  52 %  33 of 64 rollouts, 4 s left" in at most `width` characters.
std::string ProgressLine(const imagination::Progress& progress, int width = 78);

}  // namespace hires::reports
