#include "hires/planning/shop2_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "hires/planning/datum_reader.h"
#include "planning/language/shop2_parts.h"

namespace hires::planning {
namespace {

using shop2::Construct;

constexpr std::string_view kDomainWanted = "(defdomain name (items...))";
constexpr std::string_view kProblemWanted = "(defproblem name [domain] (facts...) (tasks...))";

bool IsDomain(const Datum& form) { return form.Head() == "defdomain"; }
bool IsProblem(const Datum& form) {
  return form.Head() == "defproblem" || form.Head() == "make-problem";
}

/// The forms of a file, with anything that is neither domain nor problem refused.
std::vector<Datum> ReadForms(std::string_view text, const std::string& source) {
  std::vector<Datum> forms = ReadData(text, source);
  for (const Datum& form : forms) {
    if (IsDomain(form) || IsProblem(form) || form.Head() == "in-package") continue;
    FailAt(source, form.place,
           fmt::format("came {}, wanted {} or {}; a planning file holds nothing else and runs no "
                       "code, so take this away",
                       Excerpt(form), kDomainWanted, kProblemWanted));
  }
  return forms;
}

/// `name` or `(name options...)`.
const Datum& NameIn(const Construct& in, const Datum& datum) {
  const Datum& name = datum.IsList() && !datum.items.empty() ? datum.items[0] : datum;
  if (name.kind != Datum::Kind::kSymbol || name.IsNil()) {
    shop2::FailAbout(in, datum, "a name, or (name options...)");
  }
  return name;
}

// ------------------------------------------------------------------------------------------
// domains

void ReadItem(const Construct& in, const Datum& item, Domain* domain) {
  const std::string_view head = item.Head();
  if (head == ":operator" || head == ":op") {
    domain->operators.push_back(shop2::ReadOperator(in.source, shop2::WithOwnNames(item)));
  } else if (head == ":method") {
    domain->methods.push_back(shop2::ReadMethod(in.source, shop2::WithOwnNames(item)));
  } else if (head == ":-") {
    domain->axioms.push_back(shop2::ReadAxiom(in.source, shop2::WithOwnNames(item)));
  } else {
    shop2::FailAbout(in, item, "(:operator ...), (:op ...), (:method ...) or (:- ...)");
  }
}

Domain ReadDomain(const Datum& form, const std::string& source) {
  const Construct unnamed{source, "domain"};
  if (form.items.size() < 3 || !form.tail.empty()) {
    shop2::FailAbout(unnamed, form, kDomainWanted);
  }
  Domain domain;
  domain.name = NameIn(unnamed, form.items[1]).text;
  domain.source = source;
  const Construct in{source, fmt::format("domain '{}'", domain.name)};
  const Datum& items = form.items[2];
  if (form.items.size() > 3 || !items.Head().empty()) {
    shop2::Fail(in, items.place,
                fmt::format("the items must stand in one list of their own: {}", kDomainWanted));
  }
  if (!(items.IsList() && items.tail.empty()) && !items.IsNil()) {
    shop2::FailAbout(in, items, "a list of operators, methods and axioms");
  }
  for (const Datum& item : items.items) ReadItem(in, item, &domain);
  shop2::CheckDomain(&domain);
  return domain;
}

// -----------------------------------------------------------------------------------------
// problems

/// make-problem is a function, so that its arguments come quoted.
const Datum& WithoutQuote(const Datum& datum) {
  return datum.Head() == "quote" && datum.items.size() == 2 ? datum.items[1] : datum;
}

/// The value of `:domain` in (name options...), nil if there is none.
Datum DomainOption(const Datum& name) {
  for (std::size_t i = 1; i + 1 < name.items.size(); i += 2) {
    if (name.items[i].IsSymbol(":domain")) return name.items[i + 1];
  }
  return {};
}

std::vector<Datum> ReadFacts(const Construct& in, const Datum& facts) {
  constexpr std::string_view kFactWanted = "a fact (predicate arguments...) without variables";
  const bool is_list = facts.IsNil() || (facts.IsList() && facts.tail.empty());
  if (!is_list || !facts.Head().empty()) {
    shop2::FailAbout(in, facts, "a list of facts, as in ((on a b) (clear a)), or nil");
  }
  std::vector<Datum> atoms;
  for (const Datum& fact : facts.items) {
    shop2::CheckAtom(in, fact, kFactWanted);
    if (!fact.tail.empty() || !IsGround(fact)) shop2::FailAbout(in, fact, kFactWanted);
    atoms.push_back(shop2::Unquoted(fact));
  }
  return atoms;
}

Problem ReadProblem(const Datum& form, const std::string& source) {
  const std::size_t size = form.items.size();
  const Construct unnamed{source, "problem"};
  if ((size != 4 && size != 5) || !form.tail.empty()) {
    shop2::FailAbout(unnamed, form, kProblemWanted);
  }
  const Datum& name = WithoutQuote(form.items[1]);
  Problem problem;
  problem.name = NameIn(unnamed, name).text;
  problem.source = source;
  const Construct in{source, fmt::format("problem '{}'", problem.name)};
  const Datum domain = size == 5 ? NameIn(in, WithoutQuote(form.items[2])) : DomainOption(name);
  problem.domain = domain.text;
  problem.domain_place = domain.place;
  problem.facts = ReadFacts(in, WithoutQuote(form.items[size - 2]));
  problem.tasks = shop2::ReadNetwork(in, shop2::WithOwnNames(WithoutQuote(form.items[size - 1])));
  return problem;
}

}  // namespace

Domain ReadShop2Domain(std::string_view text, const std::string& source) {
  const std::vector<Datum> forms = ReadForms(text, source);
  const auto domain = std::find_if(forms.begin(), forms.end(), IsDomain);
  if (domain == forms.end()) {
    FailAt(source, {1, 1},
           fmt::format("holds no domain, wanted {}; name another file", kDomainWanted));
  }
  const auto second = std::find_if(domain + 1, forms.end(), IsDomain);
  if (second != forms.end()) {
    FailAt(source, second->place,
           fmt::format("a second domain, the first stands in line {}; keep one in a file",
                       domain->place.line));
  }
  return ReadDomain(*domain, source);
}

std::vector<Problem> ReadShop2Problems(std::string_view text, const std::string& source) {
  std::vector<Problem> problems;
  for (const Datum& form : ReadForms(text, source)) {
    if (IsProblem(form)) problems.push_back(ReadProblem(form, source));
  }
  if (problems.empty()) {
    FailAt(source, {1, 1},
           fmt::format("holds no problem, wanted {}; name another file", kProblemWanted));
  }
  return problems;
}

}  // namespace hires::planning
