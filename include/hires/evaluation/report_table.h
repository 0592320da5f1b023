#pragma once

#include <string>
#include <vector>

#include "hires/imagination/report.h"

namespace hires::evaluation {

/// Columns of text, the first row underlined as heads; numbers to the right.
std::string FormatTable(const std::vector<std::vector<std::string>>& rows);

/// The ranking as a table for people, the recommended line marked.
std::string RankingTable(const std::vector<imagination::Prediction>& ranking, int recommended);

/// "[#####.....]  52 %  33 of 64 rollouts, 4 s left" in at most `width` characters.
std::string ProgressLine(const imagination::Progress& progress, int width = 78);

}  // namespace hires::evaluation
