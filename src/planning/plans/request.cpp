#include "hires/planning/request.h"

#include <fmt/format.h>

#include <utility>

#include "hires/base/error.h"
#include "hires/base/short_text.h"
#include "hires/planning/shop2_reader.h"
#include "hires/planning/task_text.h"

namespace hires::planning {
namespace {

Datum FactOf(const base::Atom& atom, const std::string& where) {
  std::vector<Datum> items{ReadGroundTerm(atom.predicate, where + ".predicate")};
  if (items[0].kind != Datum::Kind::kSymbol) {
    throw base::ConfigError(
        fmt::format("{}.predicate: is {}, wanted a name, as `on` of (on mug1 table1)", where,
                    base::Shortened(atom.predicate)));
  }
  for (std::size_t i = 0; i < atom.arguments.size(); ++i) {
    items.push_back(ReadGroundTerm(atom.arguments[i], fmt::format("{}.arguments[{}]", where, i)));
  }
  return MakeList(std::move(items));
}

}  // namespace

void SetTasks(const std::string& tasks, const Domain& domain, Problem* problem) {
  problem->tasks = ReadTasks(tasks, "task");
  problem->parameters = {};
  problem->goal.reset();
  problem->source = "task";
  CheckTasks(*problem, domain);
}

void AppendFacts(const std::vector<base::Atom>& atoms, const std::string& field, Problem* problem) {
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    problem->facts.push_back(FactOf(atoms[i], fmt::format("{}[{}]", field, i)));
  }
}

}  // namespace hires::planning
