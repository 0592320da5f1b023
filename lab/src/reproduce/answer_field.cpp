#include "lab/src/reproduce/answer_field.h"

#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "hires/base/error.h"

namespace hires::lab {
namespace {

using nlohmann::ordered_json;

/// The first entry whose key has that value, or null.
const ordered_json* EntryOf(const ordered_json& list, const std::string& key,
                            const std::string& value) {
  for (const ordered_json& entry : list) {
    if (!entry.is_object() || !entry.contains(key)) continue;
    const ordered_json& found = entry.at(key);
    if ((found.is_string() ? found.get<std::string>() : found.dump()) == value) return &entry;
  }
  return nullptr;
}

/// One step of a pointer down from `at`; null where there is nothing.
const ordered_json* Step(const ordered_json& at, const std::string& step) {
  const std::size_t equals = step.find('=');
  if (at.is_array() && equals != std::string::npos) {
    return EntryOf(at, step.substr(0, equals), step.substr(equals + 1));
  }
  ordered_json::json_pointer pointer;
  pointer.push_back(step);
  return at.contains(pointer) ? &at.at(pointer) : nullptr;
}

/// What a field points at, or null.
const ordered_json* Find(const ordered_json& answer, ordered_json::json_pointer pointer) {
  std::vector<std::string> steps;
  for (; !pointer.empty(); pointer.pop_back()) steps.push_back(pointer.back());
  const ordered_json* at = &answer;
  for (auto step = steps.rbegin(); at != nullptr && step != steps.rend(); ++step) {
    at = Step(*at, *step);
  }
  return at;
}

bool IsNumberOrNull(const ordered_json& entry, const char* key) {
  return entry.contains(key) && (entry.at(key).is_number() || entry.at(key).is_null());
}

/// {"estimate": 1.2, "lower": 1.0, "upper": 1.4}; nothing where it is none. An end that is null is
/// not finite: the interval has no end there.
std::optional<Reading> IntervalIn(const ordered_json& entry) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (!IsNumberOrNull(entry, "lower") || !IsNumberOrNull(entry, "upper")) return std::nullopt;
  const auto end = [&](const char* key, double none) {
    return entry.at(key).is_null() ? none : entry.at(key).get<double>();
  };
  for (const char* key : {"estimate", "mean", "share"}) {
    if (!IsNumberOrNull(entry, key)) continue;
    if (entry.at(key).is_null()) return Reading{std::nullopt, false};
    return Reading{FoundNumber{entry.at(key).get<double>(), end("lower", -kInfinity),
                               end("upper", kInfinity)}};
  }
  return std::nullopt;
}

}  // namespace

std::string ToString(const AnswerField& field) { return field.play + ":" + field.pointer; }

Reading ReadingAt(const AnswerField& field, const ordered_json& answer) {
  const ordered_json* found = Find(answer, ordered_json::json_pointer(field.pointer));
  if (found != nullptr && found->is_null()) return {};
  if (found != nullptr && found->is_boolean()) return {FoundNumber{found->get<bool>() ? 1.0 : 0.0}};
  if (found != nullptr && found->is_number()) return {FoundNumber{found->get<double>()}};
  const auto interval = found != nullptr && found->is_object() ? IntervalIn(*found) : std::nullopt;
  if (interval) return *interval;
  throw base::ConfigError(
      fmt::format("{}: the answer has {} there; wanted a number: the catalogue asks for another "
                  "field than this version writes",
                  ToString(field), found ? found->dump().substr(0, 40) : "nothing"));
}

}  // namespace hires::lab
