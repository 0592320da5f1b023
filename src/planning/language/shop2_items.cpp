#include <fmt/format.h>

#include <utility>

#include "hires/planning/datum_reader.h"
#include "planning/language/shop2_parts.h"

namespace hires::planning::shop2 {
namespace {

constexpr std::string_view kOperatorWanted =
    "(:operator (!name arguments...) [precondition] deletes adds [cost])";
constexpr std::string_view kOpWanted =
    "(:op (!name arguments...) [:precond goals] [:delete atoms] [:add atoms] [:cost expression])";
constexpr std::string_view kMethodWanted =
    "(:method [name] (task arguments...) [label] precondition tasks, then further branches)";
constexpr std::string_view kAxiomWanted =
    "(:- (predicate arguments...) [label] goals, then further tails)";

bool IsNumber(const Datum& datum) {
  return datum.kind == Datum::Kind::kInteger || datum.kind == Datum::Kind::kReal;
}

/// A word in front of something; nil and variables are something themselves.
bool IsLabel(const Datum& datum) { return datum.kind == Datum::Kind::kSymbol && !datum.IsNil(); }

/// "method 'serve_cup'", as far as the item has a name.
Construct ConstructOf(const std::string& source, std::string_view kind, const Datum& item,
                      std::size_t head) {
  const std::string_view name = item.items.size() > head ? item.items[head].Head() : "";
  return {source, fmt::format("{} '{}'", kind, name.empty() ? "without a name" : name)};
}

/// The head at `index`, checked.
Datum HeadAt(const Construct& in, const Datum& item, std::size_t index, std::string_view wanted) {
  if (!item.tail.empty() || item.items.size() <= index) FailAbout(in, item, wanted);
  const Datum& head = item.items[index];
  CheckTerm(in, head, fmt::format("a head (name arguments...) as in {}", wanted));
  return Unquoted(head);
}

// ----------------------------------------------------------------------------------------
// operators

void CheckOperatorName(const Construct& in, const Datum& head) {
  if (head.Head()[0] == '!') return;
  Fail(
      in, head.place,
      fmt::format("the name of an operator begins with '!', so that it differs from a task that is "
                  "taken apart; write '!{}' here and where it is used",
                  head.Head()));
}

/// Parts after the head: SHOP tells the forms apart by their number, and three of them by whether
/// the last is a number.
/// @param warnings  takes what is passed over.
void ReadParts(const Construct& in, const Datum& item, Operator* op,
               std::vector<std::string>* warnings) {
  const std::size_t count = item.items.size() - 2;
  if (count < 2 || count > 4) {
    Fail(in, item.place,
         fmt::format("number of parts after its head: {}, wanted 2 to 4 as in {}", count,
                     kOperatorWanted));
  }
  const bool is_old_with_cost = count == 3 && IsNumber(item.items[4]);
  const bool has_precondition = count == 4 || (count == 3 && !is_old_with_cost);
  std::size_t next = 2;
  if (has_precondition) op->precondition = ReadPrecondition(in, item.items[next++]);
  op->deletes = ReadDeletes(in, item.items[next++], warnings);
  op->adds = ReadEffects(in, item.items[next++]);
  if (next < item.items.size()) op->cost = ReadExpression(item.items[next]);
}

/// The value after a keyword of `:op`; null if the keyword is missing.
const Datum* Find(const Datum& item, std::string_view keyword) {
  for (std::size_t i = 2; i + 1 < item.items.size(); i += 2) {
    if (item.items[i].IsSymbol(keyword)) return &item.items[i + 1];
  }
  return nullptr;
}

void CheckKeywords(const Construct& in, const Datum& item) {
  for (std::size_t i = 2; i < item.items.size(); i += 2) {
    const Datum& key = item.items[i];
    const bool is_known = key.IsSymbol(":precond") || key.IsSymbol(":delete") ||
                          key.IsSymbol(":add") || key.IsSymbol(":cost");
    if (!is_known || i + 1 == item.items.size()) FailAbout(in, key, kOpWanted);
    if (Find(item, key.text) != &item.items[i + 1]) {
      Fail(in, key.place, fmt::format("'{}' stands here a second time; keep one", key.text));
    }
  }
}

void ReadKeywordParts(const Construct& in, const Datum& item, Operator* op,
                      std::vector<std::string>* warnings) {
  CheckKeywords(in, item);
  if (const Datum* goals = Find(item, ":precond")) op->precondition = ReadConjunction(in, *goals);
  if (const Datum* atoms = Find(item, ":delete")) op->deletes = ReadDeletes(in, *atoms, warnings);
  if (const Datum* atoms = Find(item, ":add")) op->adds = ReadEffects(in, *atoms);
  if (const Datum* cost = Find(item, ":cost")) op->cost = ReadExpression(*cost);
}

// ----------------------------------------------------------------------------- methods and
// branches

/// "method 'm', branch 2", plain where there is only one.
Construct BranchOf(const Construct& in, std::size_t number, bool is_only) {
  return {in.source, is_only ? in.name : fmt::format("{}, branch {}", in.name, number)};
}

/// Reads the branch that begins at `next` and moves there behind it.
Branch ReadBranch(const Construct& in, const Datum& item, std::size_t* next) {
  Branch branch;
  branch.place = item.items[*next].place;
  if (IsLabel(item.items[*next])) branch.label = item.items[(*next)++].text;
  if (item.items.size() - *next < 2) {
    Fail(in, branch.place,
         fmt::format("a precondition and tasks were wanted here, one of them is missing; write nil "
                     "for a precondition that always holds or for no tasks: {}",
                     kMethodWanted));
  }
  branch.precondition = ReadPrecondition(in, item.items[(*next)++]);
  branch.subtasks = ReadNetwork(in, item.items[(*next)++]);
  return branch;
}

// -------------------------------------------------------------------------------------------
// axioms

Axiom::Branch ReadTail(const Construct& in, const Datum& item, std::size_t* next) {
  Axiom::Branch branch;
  const Datum& begin = item.items[*next];
  if (IsLabel(begin)) branch.label = item.items[(*next)++].text;
  if (*next == item.items.size()) FailAbout(in, begin, "goals after this label");
  const Datum& tail = item.items[(*next)++];
  if (tail.Head() == ":sort-by") FailAbout(in, tail, "goals; an axiom's proofs are not sorted");
  Precondition precondition = ReadConjunction(in, tail);
  branch.first = precondition.order == Precondition::Order::kFirst;
  branch.condition = std::move(precondition.condition);
  return branch;
}

}  // namespace

Operator ReadOperator(const std::string& source, const Datum& item,
                      std::vector<std::string>* warnings) {
  const Construct in = ConstructOf(source, "operator", item, 1);
  const bool has_keywords = item.Head() == ":op";
  Operator op;
  op.place = item.place;
  op.cost = MakeInteger(1);
  op.head = HeadAt(in, item, 1, has_keywords ? kOpWanted : kOperatorWanted);
  CheckOperatorName(in, op.head);
  if (has_keywords) {
    ReadKeywordParts(in, item, &op, warnings);
  } else {
    ReadParts(in, item, &op, warnings);
  }
  return op;
}

Method ReadMethod(const std::string& source, const Datum& item) {
  const std::size_t head = item.items.size() > 1 && IsLabel(item.items[1]) ? 2 : 1;
  const Construct in = ConstructOf(source, "method", item, head);
  Method method;
  method.place = item.place;
  if (head == 2) method.name = item.items[1].text;
  method.head = HeadAt(in, item, head, kMethodWanted);
  if (method.head.Head()[0] == '!') {
    Fail(in, method.head.place,
         "a task with '!' is done by an operator and cannot be taken apart by a method; take the "
         "'!' "
         "away here and where the task is used");
  }
  std::size_t next = head + 1;
  if (next == item.items.size()) FailAbout(in, item, kMethodWanted);
  while (next < item.items.size()) {
    const bool is_only = method.branches.empty() && item.items.size() - next <= 3;
    method.branches.push_back(
        ReadBranch(BranchOf(in, method.branches.size() + 1, is_only), item, &next));
  }
  return method;
}

Axiom ReadAxiom(const std::string& source, const Datum& item) {
  const Construct in = ConstructOf(source, "axiom", item, 1);
  Axiom axiom;
  axiom.place = item.place;
  axiom.head = HeadAt(in, item, 1, kAxiomWanted);
  CheckAtom(in, axiom.head, kAxiomWanted);
  std::size_t next = 2;
  if (next == item.items.size()) {
    FailAbout(in, item, fmt::format("{}; write nil for goals that always hold", kAxiomWanted));
  }
  while (next < item.items.size()) {
    axiom.branches.push_back(ReadTail(in, item, &next));
  }
  return axiom;
}

}  // namespace hires::planning::shop2
