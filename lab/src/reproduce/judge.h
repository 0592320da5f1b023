#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lab/src/reproduce/catalogue.h"

namespace hires::lab {

enum class Verdict {
  kReproduced,     ///< all numbers are as accepted
  kBetter,         ///< likewise, and those that may be better than published are
  kNotReproduced,  ///< a number is not as accepted, or is none
  /// None is against it, but an interval is too wide to say so, or a number has no value: it is a
  /// ratio to what never came.
  kUndecided,
  kCheckHolds,  ///< as kReproduced, where the dissertation has no number (CatalogueItem::is_own)
  kCheckFails,  ///< as kNotReproduced, likewise
  kCheckUndecided,  ///< as kUndecided, likewise
  kShown,      ///< nothing to compare: a picture or numbers of ours stand beside the published one
  kDescribed,  ///< nothing that is played: words alone
  kNotPlayed   ///< an answer, or a field of one, that it needs is missing
};
const char* ToString(Verdict verdict);  ///< "not reproduced"

struct JudgedValue {
  ComparedValue value;
  /// Nothing: the answer has null there, or there is no value, by dividing by 0 or by null.
  std::optional<FoundNumber> found;
  bool holds{false};         ///< false for what is only shown
  bool is_undecided{false};  ///< its interval holds the bound, or there is no value
  bool is_better{false};
};

struct JudgedItem {
  CatalogueItem item;
  Verdict verdict{Verdict::kNotPlayed};
  std::vector<JudgedValue> values;
  std::string reason;  ///< begins with the numbers that are not as accepted
};

/// Whether ours is as accepted.  @param found  NaN never is, and what has no interval is neither
/// above nor below.
bool IsAccepted(const ComparedValue& value, const FoundNumber& found);
std::string ToString(const Acceptance& acceptance);  ///< "within 3", "by a factor of 1.5 at most"

/// @param answers  of the plays that were played, by name.
/// @param missing  why the others were not, by name.
JudgedItem Judge(const CatalogueItem& item,
                 const std::map<std::string, nlohmann::ordered_json>& answers,
                 const std::map<std::string, std::string>& missing);

/// A line for each item: verdict, and how many numbers are as accepted; below, why some are not
/// reproduced or not played.
std::string VerdictTable(const std::vector<JudgedItem>& items);

/// [{"item", "section", "title", "verdict", "reason", "plays", "drawings", "bounds", "values"}].
nlohmann::ordered_json ToJson(const std::vector<JudgedItem>& items);

}  // namespace hires::lab
