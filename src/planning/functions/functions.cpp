#include "hires/planning/functions.h"

#include <algorithm>
#include <utility>

#include "hires/base/check.h"
#include "hires/base/text.h"
#include "planning/functions/expression_node.h"
#include "planning/functions/standard_functions.h"

namespace hires::planning {
namespace {

Functions MakeStandard() {
  Functions functions;
  AddNumberFunctions(&functions);
  AddListFunctions(&functions);
  AddTests(&functions);
  // SHOP3's own, which prints for people there: it holds, and says nothing here.
  functions.Add("print-current-state", 0, -1,
                [](TermTable* terms, const std::vector<Term>&) { return terms->Symbol("t"); });
  return functions;
}

bool NameIsLess(const Functions::Entry& entry, std::string_view name) { return entry.name < name; }

}  // namespace

const Functions& Functions::Standard() {
  static const Functions standard = MakeStandard();
  return standard;
}

void Functions::Add(std::string name, int min_arguments, int max_arguments, Function function) {
  name = base::ToLower(name);
  HIRES_CHECK(!name.empty() && function, "a function needs a name and something to call");
  HIRES_CHECK(min_arguments >= 0 && (max_arguments == -1 || max_arguments >= min_arguments),
              "function '" + name + "': the numbers of arguments contradict each other");
  HIRES_CHECK(!IsForm(name), "function '" + name + "': the name is a form of the language");
  const auto place = std::lower_bound(entries_.begin(), entries_.end(), name, NameIsLess);
  HIRES_CHECK(place == entries_.end() || place->name != name,
              "function '" + name + "': the name is taken");
  entries_.insert(place, {std::move(name), min_arguments, max_arguments, std::move(function)});
}

const Functions::Entry* Functions::Find(std::string_view name) const {
  const auto place = std::lower_bound(entries_.begin(), entries_.end(), name, NameIsLess);
  return place != entries_.end() && place->name == name ? &*place : nullptr;
}

std::vector<std::string> Functions::Names() const {
  std::vector<std::string> names;
  names.reserve(entries_.size());
  for (const Entry& entry : entries_) names.push_back(entry.name);
  return names;
}

}  // namespace hires::planning
