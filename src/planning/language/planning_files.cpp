#include "hires/planning/planning_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "hires/base/error.h"
#include "hires/base/param_reader.h"
#include "hires/base/text.h"
#include "hires/planning/datum_reader.h"
#include "hires/planning/operator_data.h"
#include "hires/planning/shop2_reader.h"
#include "planning/language/hddl_reader.h"

namespace hires::planning {
namespace {

std::string NameOf(Domain::Language language) {
  return language == Domain::Language::kShop2 ? "SHOP2's language" : "HDDL";
}

/// Empty where there is none.
std::string YamlBeside(const std::string& domain_path) {
  const auto path = std::filesystem::path(domain_path).replace_extension(".yaml");
  return std::filesystem::exists(path) ? path.string() : "";
}

/// Other programs keep files beside a domain under its name, too.
bool IsSidecar(const std::string& yaml) {
  static const std::set<std::string> kKeys{"subtask_order", "capacities", "operators", "legs"};
  const std::vector<std::string> keys = base::ParamReader::FromFile(yaml).Keys();
  return std::any_of(keys.begin(), keys.end(),
                     [](const std::string& key) { return kKeys.count(key) > 0; });
}

/// Published files differ in this now and then, and belong together nevertheless.
void WarnOfOtherDomain(const Domain& domain, Problem* problem) {
  if (problem->domain.empty() || problem->domain == domain.name) return;
  problem->warnings.push_back(
      Located(problem->source, problem->domain_place,
              fmt::format("problem '{}' is written for the domain '{}', the domain read is '{}' "
                          "({}); it is taken for a problem of that one; correct one of the names",
                          problem->name, problem->domain, domain.name, domain.source)));
}

/// A file that holds the domain, too, was warned of with it.
void DropKnownWarnings(const Domain& domain, Problem* problem) {
  std::vector<std::string>& warnings = problem->warnings;
  const auto is_known = [&](const std::string& warning) {
    return std::find(domain.warnings.begin(), domain.warnings.end(), warning) !=
           domain.warnings.end();
  };
  warnings.erase(std::remove_if(warnings.begin(), warnings.end(), is_known), warnings.end());
}

void NoteFaultyTasks(const Domain& domain, Problem* problem) {
  if (!problem->fault.empty()) return;
  try {
    CheckTasks(*problem, domain);
  } catch (const base::ConfigError& error) {
    problem->fault = error.what();
  }
}

/// Whoever plans for one problem of the file is told of the others.
void WarnOfFaults(std::vector<Problem>* problems) {
  const auto is_faulty = [](const Problem& problem) { return !problem.fault.empty(); };
  const auto first = std::find_if(problems->begin(), problems->end(), is_faulty);
  if (first == problems->end()) return;
  const auto count = std::count_if(first, problems->end(), is_faulty);
  const std::string more = count == 1 ? "" : fmt::format(" ({} such problems)", count);
  const std::string text =
      fmt::format("another problem of the file cannot be planned for: {}{}", first->fault, more);
  for (Problem& problem : *problems) {
    if (!is_faulty(problem)) problem.warnings.push_back(text);
  }
}

std::vector<Problem> ReadProblems(const std::string& path, const Domain& domain) {
  const std::string text = base::ReadTextFile(path);
  const Domain::Language language = LanguageOf(text, path);
  if (language != domain.language) {
    throw base::ConfigError(
        fmt::format("{}: is written in {}, the domain {} in {}; name files that belong together",
                    path, NameOf(language), domain.source, NameOf(domain.language)));
  }
  if (language == Domain::Language::kHddl) return {ReadHddlProblem(text, path, domain)};
  std::vector<Problem> problems = ReadShop2Problems(text, path);
  for (Problem& problem : problems) NoteFaultyTasks(domain, &problem);
  RequireOneWithoutFault(problems);
  WarnOfFaults(&problems);
  return problems;
}

/// Comments of other files, too, have `#-`.
bool NamesADefinition(std::string_view text) {
  const std::string lower = base::ToLower(text);
  return lower.find("defdomain") != lower.npos || lower.find("defproblem") != lower.npos ||
         lower.find("make-problem") != lower.npos;
}

std::string BeginOf(std::string_view text, const std::string& first_word) {
  if (!first_word.empty()) return "begins with (" + Excerpt(MakeSymbol(first_word));
  const bool is_blank = text.find_first_not_of(" \t\r\n\f\v\xEF\xBB\xBF") == text.npos;
  return is_blank ? "is empty" : "begins with no word in parentheses";
}

}  // namespace

Domain::Language LanguageOf(std::string_view text, const std::string& source) {
  base::RefuseUtf16(text, source);
  const std::string word = FirstWord(text, source);
  if (word == "define") return Domain::Language::kHddl;
  for (const char* known : {"defdomain", "defproblem", "make-problem", "in-package"}) {
    if (WithoutPackage(word) == known) return Domain::Language::kShop2;
  }
  // Other forms of Lisp may stand before, and so may a mark of its reader.
  const bool has_mark = text.find("#+") != text.npos || text.find("#-") != text.npos;
  const bool may_be_lisp = !word.empty() || (has_mark && NamesADefinition(text));
  if (may_be_lisp && IsShop2File(text, source)) return Domain::Language::kShop2;
  throw base::ConfigError(fmt::format(
      "{}: is no planning file: it {}, wanted (defdomain or (defproblem for SHOP2, (define for "
      "HDDL; name another file",
      source, BeginOf(text, word)));
}

Domain LoadDomain(const std::string& path) {
  const std::string text = base::ReadTextFile(path);
  const bool is_hddl = LanguageOf(text, path) == Domain::Language::kHddl;
  Domain domain = is_hddl ? ReadHddlDomain(text, path) : ReadShop2Domain(text, path);
  const std::string yaml = YamlBeside(path);
  if (yaml.empty()) return domain;
  if (IsSidecar(yaml)) {
    domain.subtask_order = LoadSubtaskOrder(yaml, domain.language);
  } else {
    domain.warnings.push_back(
        fmt::format("{}: stands beside the domain, but is no sidecar, as it has none of the keys "
                    "subtask_order, capacities, operators, legs: passed over",
                    yaml));
  }
  return domain;
}

void CheckSidecar(const std::string& domain_path, const Domain& domain) {
  const std::string sidecar = YamlBeside(domain_path);
  if (sidecar.empty() || !IsSidecar(sidecar)) return;
  const auto only_order = std::vector<std::string>{"subtask_order"};
  if (base::ParamReader::FromFile(sidecar).Keys() == only_order) return;
  LoadOperatorData(sidecar, domain);
}

std::vector<Problem> LoadProblems(const std::string& path, const Domain& domain) {
  std::vector<Problem> problems = ReadProblems(path, domain);
  for (Problem& problem : problems) {
    DropKnownWarnings(domain, &problem);
    WarnOfOtherDomain(domain, &problem);
  }
  return problems;
}

}  // namespace hires::planning
