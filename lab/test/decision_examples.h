#pragma once

#include <string>

#include "lab/src/decision/decision.h"
#include "lab/src/decision/decision_report.h"

namespace hires::lab {

/// Fast takes 10 s, slow 20 s; the load falls or not. The oracle saw each four times: fast fell in
/// one of them, slow never.
inline DecisionRecord DecisionOf(int number, const std::string& choice, bool falls_when_fast) {
  using imagination::ImaginationOutcome;
  DecisionRecord record;
  record.task.number = number;
  record.task.load = "book";
  record.task.from = "here";
  record.task.to = "there";
  record.task.torso = "up";
  const TruthPlay slow{{}, 20.0, 25.0, 0.5}, fast{{}, 10.0, 15.0, 0.25};
  TruthPlay fallen = fast;
  fallen.failures = {base::FailureCode::kObjectFell};
  record.plays = {{"slow", slow}, {"fast", falls_when_fast ? fallen : fast}};
  record.oracle = {{"slow", {slow, slow, slow, slow}}, {"fast", {fast, fast, fast, fallen}}};
  ImaginedTask& imagined = record.imagined;
  imagined.drives["slow"] = {4, 4, 0.4, 1.0, 20.0, {19.0, 19.5, 20.5, 21.0}};
  imagined.drives["fast"] = {4, 3, 0.2, 0.99, 35.0, {9.0, 9.5, 10.5}};
  const Advice advice = choice.empty() ? Advice{ImaginationOutcome::kAllFailed, "slow"}
                                       : Advice{ImaginationOutcome::kRanked, choice};
  const Advice fastest{ImaginationOutcome::kRanked, "fast"};
  imagined.decided[kImaginationArm] = {{advice, advice, advice}, 128.0, 1.5, 1.25};
  imagined.decided[kDissertationArm] = {{fastest, fastest, fastest}, 32.0, 0.25, 0.2};
  return record;
}

/// A fall costs 100 s, lateness 2 s per second, a task that is not begun 60 s.
inline imagination::Prices SimplePrices() {
  imagination::Prices prices;
  prices.of = {{base::FailureCode::kObjectFell, 100.0},
               {base::FailureCode::kObjectSlid, 30.0},
               {base::FailureCode::kKnockedOver, 300.0},
               {base::FailureCode::kRobotCollision, 900.0},
               {base::FailureCode::kOther, 50.0}};
  prices.late = 2.0;
  prices.not_done = 60.0;
  return prices;
}

}  // namespace hires::lab
