#include "lab/src/reproduce/judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "reports/text/known_number.h"
#include "reports/text/report_table.h"

namespace hires::lab {
namespace {

using nlohmann::ordered_json;

using Answers = std::map<std::string, ordered_json>;

bool IsJudged(const JudgedValue& judged) {
  return judged.value.acceptance.kind != Acceptance::Kind::kShown;
}

/// No value where it is divided by 0 or by what is not there. A quotient has no interval.
Reading ReadingOf(const ComparedValue& value, const Answers& answers) {
  const Reading reading = ReadingAt(value.at, answers.at(value.at.play));
  if (!value.over) return reading;
  const Reading divisor = ReadingAt(*value.over, answers.at(value.over->play));
  if (!reading.found) return reading;
  if (!divisor.found) return {std::nullopt, false};
  const double quotient = reading.found->number / divisor.found->number;
  if (!std::isfinite(quotient)) return {std::nullopt, false};
  return {FoundNumber{quotient}};
}

/// Whether its interval holds the bound, so that it speaks neither for nor against it.
bool HoldsBound(const Acceptance& acceptance, const FoundNumber& found) {
  const bool is_side =
      acceptance.kind == Acceptance::Kind::kAbove || acceptance.kind == Acceptance::Kind::kBelow;
  return is_side && found.lower && found.upper && *found.lower <= acceptance.bound &&
         acceptance.bound <= *found.upper;
}

JudgedValue JudgeValue(const ComparedValue& value, const Answers& answers) {
  const Reading reading = ReadingOf(value, answers);
  JudgedValue judged{value, reading.found};
  judged.is_undecided = !reading.has_value && IsJudged(judged);
  if (!judged.found) return judged;
  judged.holds = IsAccepted(value, *judged.found);
  judged.is_undecided = HoldsBound(value.acceptance, *judged.found);
  if (value.may_be_better && judged.holds) {
    judged.is_better = value.acceptance.kind == Acceptance::Kind::kAtLeast
                           ? judged.found->number > *value.published
                           : judged.found->number < *value.published;
  }
  return judged;
}

Verdict VerdictOf(const CatalogueItem& item, const std::vector<JudgedValue>& values) {
  if (item.plays.empty()) return Verdict::kDescribed;
  if (std::none_of(values.begin(), values.end(), IsJudged)) return Verdict::kShown;
  bool may_be_better = false, are_better = true, is_decided = true;
  for (const JudgedValue& judged : values) {
    if (!IsJudged(judged)) continue;
    is_decided = is_decided && !judged.is_undecided;
    if (judged.is_undecided) continue;
    if (!judged.holds) return item.is_own ? Verdict::kCheckFails : Verdict::kNotReproduced;
    may_be_better = may_be_better || judged.value.may_be_better;
    are_better = are_better && (!judged.value.may_be_better || judged.is_better);
  }
  if (!is_decided) return item.is_own ? Verdict::kCheckUndecided : Verdict::kUndecided;
  if (item.is_own) return Verdict::kCheckHolds;
  return may_be_better && are_better ? Verdict::kBetter : Verdict::kReproduced;
}

bool IsOpen(Verdict verdict) {
  return verdict == Verdict::kNotReproduced || verdict == Verdict::kCheckFails ||
         verdict == Verdict::kUndecided || verdict == Verdict::kCheckUndecided;
}

std::string Told(const JudgedValue& judged) {
  if (!judged.found) {
    return judged.is_undecided ? "no value, what it rests on never came" : "no number";
  }
  const FoundNumber& found = *judged.found;
  const std::string number = fmt::format("{:.4g}", found.number);
  if (!found.lower || !found.upper) return number;
  return fmt::format("{} ({:.3g} .. {:.3g})", number, *found.lower, *found.upper);
}

/// "slow EC1/ET2: 23.4 s (published 20.22, within 2.37)".
std::string ShortfallText(const JudgedValue& judged) {
  const ComparedValue& value = judged.value;
  std::string text = value.name + ": " + Told(judged);
  if (judged.found && !value.unit.empty()) text += " " + value.unit;
  const std::string published =
      value.published ? fmt::format("published {:.4g}, ", *value.published) : "";
  return text + fmt::format(" ({}{})", published, ToString(value.acceptance));
}

/// What is not as accepted, number by number, so that no prose has to say it.
std::string ShortfallsText(const std::vector<JudgedValue>& values) {
  std::vector<std::string> against, undecided;
  for (const JudgedValue& judged : values) {
    if (!IsJudged(judged) || judged.holds) continue;
    (judged.is_undecided ? undecided : against).push_back(ShortfallText(judged));
  }
  std::string text;
  if (!against.empty()) text += "Not as accepted: " + base::Join(against, "; ") + ". ";
  if (!undecided.empty()) text += "Not decided: " + base::Join(undecided, "; ") + ". ";
  return text;
}

int NumHolding(const std::vector<JudgedValue>& values) {
  return static_cast<int>(std::count_if(values.begin(), values.end(),
                                        [](const JudgedValue& judged) { return judged.holds; }));
}

ordered_json ValueJson(const JudgedValue& judged) {
  const std::optional<FoundNumber>& found = judged.found;
  return {{"name", judged.value.name},
          {"unit", judged.value.unit},
          {"at", ToString(judged.value.at)},
          {"over", judged.value.over ? ordered_json(ToString(*judged.value.over)) : ordered_json()},
          {"published", reports::NumberOrNull(judged.value.published)},
          {"found", found ? reports::NumberOrNull(found->number) : ordered_json()},
          {"lower", found ? reports::NumberOrNull(found->lower) : ordered_json()},
          {"upper", found ? reports::NumberOrNull(found->upper) : ordered_json()},
          {"accepted", ToString(judged.value.acceptance)},
          {"judged", IsJudged(judged)},
          {"holds", judged.holds},
          {"undecided", judged.is_undecided},
          {"better", judged.is_better}};
}

ordered_json ItemJson(const JudgedItem& judged) {
  ordered_json values = ordered_json::array();
  for (const JudgedValue& value : judged.values) values.push_back(ValueJson(value));
  return {{"item", judged.item.name},
          {"section", judged.item.section},
          {"title", judged.item.title},
          {"verdict", ToString(judged.verdict)},
          {"reason", judged.reason},
          {"plays", judged.item.plays},
          {"drawings", judged.item.drawings},
          {"bounds", judged.item.bounds},
          {"values", values}};
}

}  // namespace

const char* ToString(Verdict verdict) {
  switch (verdict) {
    case Verdict::kReproduced:
      return "reproduced";
    case Verdict::kBetter:
      return "better";
    case Verdict::kNotReproduced:
      return "not reproduced";
    case Verdict::kUndecided:
      return "undecided";
    case Verdict::kCheckHolds:
      return "check holds";
    case Verdict::kCheckFails:
      return "check fails";
    case Verdict::kCheckUndecided:
      return "check undecided";
    case Verdict::kShown:
      return "shown";
    case Verdict::kDescribed:
      return "described";
    case Verdict::kNotPlayed:
      return "not played";
  }
  return "";
}

bool IsAccepted(const ComparedValue& value, const FoundNumber& found) {
  const double bound = value.acceptance.bound, number = found.number;
  switch (value.acceptance.kind) {
    case Acceptance::Kind::kWithin:
      return std::abs(number - value.published.value()) <= bound;
    case Acceptance::Kind::kFactor:
      return number > 0.0 && number <= bound * value.published.value() &&
             number * bound >= value.published.value();
    case Acceptance::Kind::kAtLeast:
      return number >= bound;
    case Acceptance::Kind::kAtMost:
      return number <= bound;
    case Acceptance::Kind::kAbove:
      return found.lower && *found.lower > bound;
    case Acceptance::Kind::kBelow:
      return found.upper && *found.upper < bound;
    case Acceptance::Kind::kShown:
      return false;
  }
  return false;
}

std::string ToString(const Acceptance& acceptance) {
  switch (acceptance.kind) {
    case Acceptance::Kind::kWithin:
      return fmt::format("within {:.6g}", acceptance.bound);
    case Acceptance::Kind::kFactor:
      return fmt::format("by a factor of {:.6g} at most", acceptance.bound);
    case Acceptance::Kind::kAtLeast:
      return fmt::format("at least {:.6g}", acceptance.bound);
    case Acceptance::Kind::kAtMost:
      return fmt::format("at most {:.6g}", acceptance.bound);
    case Acceptance::Kind::kAbove:
      return fmt::format("interval above {:.6g}", acceptance.bound);
    case Acceptance::Kind::kBelow:
      return fmt::format("interval below {:.6g}", acceptance.bound);
    case Acceptance::Kind::kShown:
      return "not judged";
  }
  return "";
}

JudgedItem Judge(const CatalogueItem& item, const std::map<std::string, ordered_json>& answers,
                 const std::map<std::string, std::string>& missing) {
  JudgedItem judged;
  judged.item = item;
  for (const std::string& play : item.plays) {
    if (answers.count(play) > 0) continue;
    const auto why = missing.find(play);
    judged.reason =
        fmt::format("{}: {}", play, why == missing.end() ? "not asked for" : why->second);
    return judged;
  }
  try {
    for (const ComparedValue& value : item.values) {
      judged.values.push_back(JudgeValue(value, answers));
    }
  } catch (const base::ConfigError& error) {  // the others shall not be lost with it
    judged.reason = error.what();
    return judged;
  }
  judged.verdict = VerdictOf(item, judged.values);
  judged.reason = IsOpen(judged.verdict) ? ShortfallsText(judged.values) + item.fails : item.holds;
  return judged;
}

std::string VerdictTable(const std::vector<JudgedItem>& items) {
  std::vector<std::vector<std::string>> rows{
      {"section", "what", "verdict", "as accepted", "title"}};
  std::string reasons;
  for (const JudgedItem& judged : items) {
    const auto all = std::count_if(judged.values.begin(), judged.values.end(), IsJudged);
    rows.push_back({judged.item.section, judged.item.name, ToString(judged.verdict),
                    all == 0 ? "" : fmt::format("{} of {}", NumHolding(judged.values), all),
                    judged.item.title});
    const bool is_open = IsOpen(judged.verdict) || judged.verdict == Verdict::kNotPlayed;
    if (is_open) reasons += fmt::format("\n{}: {}\n", judged.item.name, judged.reason);
  }
  return reports::FormatTable(rows) + reasons;
}

ordered_json ToJson(const std::vector<JudgedItem>& items) {
  ordered_json list = ordered_json::array();
  for (const JudgedItem& judged : items) list.push_back(ItemJson(judged));
  return list;
}

}  // namespace hires::lab
