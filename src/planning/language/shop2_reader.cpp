#include "hires/planning/shop2_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/faults.h"
#include "hires/base/spelling.h"
#include "hires/base/text.h"
#include "hires/planning/datum_reader.h"
#include "planning/language/shop2_parts.h"

namespace hires::planning {
namespace {

using shop2::Construct;

constexpr std::array<std::string_view, 3> kDefinitions{"defdomain", "defproblem", "make-problem"};
constexpr std::string_view kDomainWanted = "(defdomain name (items...))";
constexpr std::string_view kProblemWanted = "(defproblem name [domain] (facts...) (tasks...))";

bool IsDomain(const Datum& form) { return form.Head() == "defdomain"; }
bool IsProblem(const Datum& form) {
  return form.Head() == "defproblem" || form.Head() == "make-problem";
}
bool IsDefinition(std::string_view head) {
  return std::find(kDefinitions.begin(), kDefinitions.end(), head) != kDefinitions.end();
}

/// What stands before the body of a form of Lisp that may hold definitions; 0: it is none.
std::size_t BodyOf(std::string_view head) {
  if (head == "progn" || head == "locally") return 1;
  return head == "let" || head == "let*" || head == "eval-when" ? 2 : 0;
}

/// The definitions of a file, and what of its rest is told.
class FormCollector {
 public:
  FormCollector(std::string_view text, const std::string& source) : source_(source) {
    file_.definitions.assign(kDefinitions.begin(), kDefinitions.end());
    for (Datum& form : ReadLispFile(text, source, &file_)) {
      Require(form);
      Collect(std::move(form));
    }
  }

  std::vector<Datum>& definitions() { return definitions_; }
  /// Nothing but definitions stands in it.
  bool is_plain() const { return is_plain_; }

  /// One for each kind of thing that is left out.
  std::vector<std::string> Warnings() const {
    std::vector<std::string> warnings;
    if (!passed_over_.empty()) {
      std::vector<std::string> forms;
      for (const auto& [name, places] : passed_over_) {
        forms.push_back(fmt::format("({} ...) in {}", Excerpt(MakeSymbol(name)), LinesOf(places)));
      }
      warnings.push_back(Located(source_, first_passed_over_,
                                 "no code is run, so that these forms are passed over, and what "
                                 "they would define is missing: " +
                                     Shortened(std::move(forms), ", ")));
    }
    AddMarks(file_.skipped, "left out, as no feature is there: the form after #+ or #- in ",
             &warnings);
    AddMarks(file_.kept, "read, as no feature is there: the form after #+ or #- in ", &warnings);
    return warnings;
  }

 private:
  static constexpr std::size_t kMostTold = 8;

  static std::string Shortened(std::vector<std::string> parts, const std::string& between) {
    const std::size_t count = parts.size();
    if (count > kMostTold) {
      parts.resize(kMostTold);
      parts.push_back(fmt::format("{} more", count - kMostTold));
    }
    return base::Join(parts, between);
  }

  static std::string LinesOf(const std::vector<Place>& places) {
    std::vector<std::string> lines;
    for (const Place& place : places) lines.push_back(std::to_string(place.line));
    const std::string noun = lines.size() == 1 ? "line " : "lines ";
    return noun + Shortened(std::move(lines), ", ");
  }

  void AddMarks(const std::vector<Place>& places, const std::string& what,
                std::vector<std::string>* warnings) const {
    if (places.empty()) return;
    warnings->push_back(Located(source_, places.front(), what + LinesOf(places)));
  }

  /// Refuses what is no form of Lisp, and what is likely to be a definition, or a part of one, that
  /// went wrong: it must not be lost.
  void Require(const Datum& form) const {
    const std::string head(WithoutPackage(form.Head()));
    const bool is_slip =
        !IsDefinition(head) &&
        std::any_of(kDefinitions.begin(), kDefinitions.end(), [&](std::string_view known) {
          return base::AreSpeltAlike(head, std::string(known));
        });
    if (!head.empty() && head.front() != ':' && head != "define" && !is_slip) return;
    FailAt(source_, form.place,
           fmt::format("came {}, wanted {} or {}; correct it, look for a ')' too many above, or "
                       "take it away",
                       Excerpt(form), kDomainWanted, kProblemWanted));
  }

  void Collect(Datum form) {
    const std::string head(WithoutPackage(form.Head()));
    is_plain_ = is_plain_ && IsDefinition(head);
    if (IsDefinition(head)) {
      form.items[0].text = head;
      definitions_.push_back(std::move(form));
      return;
    }
    if (const std::size_t body = BodyOf(head); body > 0) {
      for (std::size_t i = body; i < form.items.size(); ++i) Collect(std::move(form.items[i]));
      return;
    }
    if (head.empty() || head == "in-package") return;
    if (passed_over_.empty()) first_passed_over_ = form.place;
    const std::string name(form.Head());
    const auto same = std::find_if(passed_over_.begin(), passed_over_.end(),
                                   [&](const auto& other) { return other.first == name; });
    auto& places = same == passed_over_.end()
                       ? passed_over_.emplace_back(name, std::vector<Place>()).second
                       : same->second;
    places.push_back(form.place);
  }

  const std::string& source_;
  LispFile file_;
  std::vector<Datum> definitions_;
  bool is_plain_{true};
  Place first_passed_over_;
  std::vector<std::pair<std::string, std::vector<Place>>> passed_over_;  // by name, in order
};

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
    domain->operators.push_back(
        shop2::ReadOperator(in.source, shop2::WithOwnNames(item), &domain->warnings));
  } else if (head == ":method") {
    domain->methods.push_back(shop2::ReadMethod(in.source, shop2::WithOwnNames(item)));
  } else if (head == ":-") {
    domain->axioms.push_back(shop2::ReadAxiom(in.source, shop2::WithOwnNames(item)));
  } else {
    shop2::FailAbout(in, item, "(:operator ...), (:op ...), (:method ...) or (:- ...)");
  }
}

Domain ReadDomain(Datum form, bool is_plain, const std::string& source) {
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
  // Only Lisp has other forms.
  if (is_plain) shop2::WriteBareTerms(source, &form.items[2], &domain.warnings);
  base::Faults faults;
  for (const Datum& item : items.items) faults.Collect([&] { ReadItem(in, item, &domain); });
  faults.Require();
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

/// SHOP takes an atom that is named like a logical word for a fact that nothing can ask for.
void WarnOfInertFacts(const Construct& in, const std::vector<const Datum*>& facts,
                      std::vector<std::string>* warnings) {
  if (facts.empty()) return;
  const std::string more = facts.size() == 1 ? "" : fmt::format(" ({} such)", facts.size());
  warnings->push_back(Located(
      in.source, facts.front()->place,
      fmt::format("{}: the fact {}{} begins with a logical word, so that no condition can ask for "
                  "it, and is passed over; take it away",
                  in.name, Excerpt(*facts.front()), more)));
}

std::vector<Datum> ReadFacts(const Construct& in, const Datum& facts,
                             std::vector<std::string>* warnings) {
  constexpr std::string_view kFactWanted = "a fact (predicate arguments...) without variables";
  const bool is_list = facts.IsNil() || (facts.IsList() && facts.tail.empty());
  const std::string_view head = facts.Head();
  if (!is_list || (!head.empty() && head != "nil")) {
    shop2::FailAbout(in, facts, "a list of facts, as in ((on a b) (clear a)), or nil");
  }
  std::vector<Datum> atoms;
  std::vector<const Datum*> inert;
  for (const Datum& fact : facts.items) {
    if (fact.IsNil()) continue;
    if (shop2::IsLogicalWord(fact.Head())) {
      inert.push_back(&fact);
      continue;
    }
    shop2::CheckAtom(in, fact, kFactWanted);
    if (!fact.tail.empty() || !IsGround(fact)) shop2::FailAbout(in, fact, kFactWanted);
    atoms.push_back(shop2::Unquoted(fact));
  }
  WarnOfInertFacts(in, inert, warnings);
  return atoms;
}

/// The name and the domain of a (defproblem ...), and where its facts and tasks begin.
struct ProblemHead {
  std::string name;
  Datum domain;
  std::size_t next{0};
};

ProblemHead ReadProblemHead(const Datum& form, const std::string& source) {
  const std::size_t size = form.items.size();
  const Construct unnamed{source, "problem"};
  const bool has_domain = size % 2 == 1;
  const bool is_whole = has_domain || size == 4 || (size > 4 && form.items[2].IsList());
  if (size < 4 || !is_whole || !form.tail.empty()) {
    shop2::FailAbout(unnamed, form, kProblemWanted);
  }
  const Datum& name = WithoutQuote(form.items[1]);
  ProblemHead head;
  head.name = NameIn(unnamed, name).text;
  const Construct in{source, fmt::format("problem '{}'", head.name)};
  head.domain = has_domain ? NameIn(in, WithoutQuote(form.items[2])) : DomainOption(name);
  head.next = has_domain ? 3 : 2;
  return head;
}

/// The `number`-th pair of facts and tasks of a form, counted from 0.
Problem ReadProblem(const Datum& form, const ProblemHead& head, std::size_t number,
                    const std::string& source) {
  Problem problem;
  problem.name = number == 0 ? head.name : fmt::format("{}-{}", head.name, number + 1);
  problem.source = source;
  problem.domain = head.domain.text;
  problem.domain_place = head.domain.place;
  const Construct in{source, fmt::format("problem '{}'", problem.name)};
  const std::size_t facts = head.next + 2 * number;
  try {
    problem.facts = ReadFacts(in, WithoutQuote(form.items[facts]), &problem.warnings);
    problem.tasks =
        shop2::ReadNetwork(in, shop2::WithOwnNames(WithoutQuote(form.items[facts + 1])));
  } catch (const base::ConfigError& error) {
    problem.fault = error.what();
  }
  return problem;
}

/// JSHOP2 allows several pairs of facts and tasks in one form.
void ReadProblemForm(const Datum& form, const std::string& source, std::vector<Problem>* problems) {
  try {
    const ProblemHead head = ReadProblemHead(form, source);
    for (std::size_t i = 0; head.next + 2 * i < form.items.size(); ++i) {
      problems->push_back(ReadProblem(form, head, i, source));
    }
  } catch (const base::ConfigError& error) {
    problems->emplace_back().fault = error.what();
  }
}

/// A definition at any place where FormCollector finds one.
bool HoldsDefinition(const Datum& form) {
  const std::string_view head = WithoutPackage(form.Head());
  if (IsDefinition(head) || head == "in-package") return true;
  const std::size_t body = BodyOf(head);
  if (body == 0 || body > form.items.size()) return false;
  return std::any_of(form.items.begin() + static_cast<std::ptrdiff_t>(body), form.items.end(),
                     HoldsDefinition);
}

}  // namespace

void RequireOneWithoutFault(const std::vector<Problem>& problems) {
  base::Faults faults;
  for (const Problem& problem : problems) {
    if (problem.fault.empty()) return;
    faults.Add(problem.fault);
  }
  faults.Require();
}

bool IsShop2File(std::string_view text, const std::string& source) {
  LispFile file;
  file.definitions.assign(kDefinitions.begin(), kDefinitions.end());
  const std::vector<Datum> forms = ReadLispFile(text, source, &file);
  return std::any_of(forms.begin(), forms.end(), HoldsDefinition);
}

Domain ReadShop2Domain(std::string_view text, const std::string& source) {
  FormCollector file(text, source);
  std::vector<Datum>& forms = file.definitions();
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
  Domain read = ReadDomain(std::move(*domain), file.is_plain(), source);
  for (const std::string& warning : file.Warnings()) read.warnings.push_back(warning);
  return read;
}

std::vector<Problem> ReadShop2Problems(std::string_view text, const std::string& source) {
  std::vector<Problem> problems;
  FormCollector file(text, source);
  for (const Datum& form : file.definitions()) {
    if (IsProblem(form)) ReadProblemForm(form, source, &problems);
  }
  const std::vector<std::string> warnings = file.Warnings();
  for (Problem& problem : problems) {
    problem.warnings.insert(problem.warnings.begin(), warnings.begin(), warnings.end());
  }
  if (problems.empty()) {
    FailAt(source, {1, 1},
           fmt::format("holds no problem, wanted {}; name another file", kProblemWanted));
  }
  RequireOneWithoutFault(problems);
  return problems;
}

}  // namespace hires::planning
