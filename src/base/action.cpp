#include "hires/base/action.h"

#include <fmt/format.h>

#include <algorithm>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::base {
namespace {

std::vector<std::string> Distinct(const std::vector<std::string>& names) {
  std::vector<std::string> distinct;
  for (const std::string& name : names) {
    const std::string lower = ToLower(name);
    if (std::find(distinct.begin(), distinct.end(), lower) == distinct.end()) {
      distinct.push_back(lower);
    }
  }
  return distinct;
}

bool EqualIgnoringCase(const std::string& a, const std::string& b) {
  return ToLower(a) == ToLower(b);
}

}  // namespace

std::string CanonicalName(const std::string& name) {
  return ToLower(!name.empty() && name.front() == '!' ? name.substr(1) : name);
}

bool IsAmong(const ActionCall& call, const ActionTemplate& action) {
  const auto has = [](const std::string& argument, const std::vector<std::string>& alternatives) {
    return std::any_of(
        alternatives.begin(), alternatives.end(),
        [&](const std::string& alternative) { return EqualIgnoringCase(argument, alternative); });
  };
  return CanonicalName(call.name) == CanonicalName(action.name) &&
         std::equal(call.arguments.begin(), call.arguments.end(), action.alternatives.begin(),
                    action.alternatives.end(), has);
}

bool ActionCall::operator==(const ActionCall& other) const {
  return CanonicalName(name) == CanonicalName(other.name) &&
         std::equal(arguments.begin(), arguments.end(), other.arguments.begin(),
                    other.arguments.end(), EqualIgnoringCase);
}

std::string ToString(const ActionCall& call) {
  return fmt::format("{}({})", call.name, Join(call.arguments, ", "));
}

std::string ToString(const ActionTemplate& action) {
  std::vector<std::string> arguments;
  for (const auto& list : action.alternatives) arguments.push_back(Join(list, "|"));
  return fmt::format("{}({})", action.name, Join(arguments, ", "));
}

std::string ToString(const Atom& atom) {
  return fmt::format("{}({})", atom.predicate, Join(atom.arguments, ", "));
}

std::vector<ActionCall> Combinations(const ActionTemplate& action, std::size_t at_most) {
  std::vector<ActionCall> calls{{CanonicalName(action.name), {}}};
  for (std::size_t i = 0; i < action.alternatives.size(); ++i) {
    const std::vector<std::string> alternatives = Distinct(action.alternatives[i]);
    if (alternatives.empty()) {
      throw ConfigError(fmt::format(
          "action '{}': argument {} has no alternatives, at least one is wanted; name a value",
          action.name, i + 1));
    }
    if (calls.size() * alternatives.size() > at_most) {
      throw ConfigError(fmt::format(
          "action '{}': more than {} combinations of alternatives; ask in smaller parts",
          action.name, at_most));
    }
    std::vector<ActionCall> longer;
    longer.reserve(calls.size() * alternatives.size());
    for (const ActionCall& call : calls) {
      for (const std::string& alternative : alternatives) {
        longer.push_back(call);
        longer.back().arguments.push_back(alternative);
      }
    }
    calls = std::move(longer);
  }
  return calls;
}

}  // namespace hires::base
