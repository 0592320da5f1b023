#include "planning/check/reference_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "hires/base/error.h"

namespace hires::planning {
namespace {

const ValueMap kNothingExpected;

/// Marks what is asked as something that decides the answer and cannot be a causal link.
class ReadingScope {
 public:
  explicit ReadingScope(ProofSession* session) : session_(session) {
    ++session_->reading;
    ++session_->nesting;
  }
  ~ReadingScope() {
    --session_->reading;
    --session_->nesting;
  }
  ReadingScope(const ReadingScope&) = delete;
  ReadingScope& operator=(const ReadingScope&) = delete;

 private:
  ProofSession* session_;
};

/// Sends the atoms that nothing matches to a place of its own for a while.
class FailureScope {
 public:
  FailureScope(ProofSession* session, std::vector<Literal>* failures)
      : session_(session), before_(session->failures) {
    session_->failures = failures;
  }
  ~FailureScope() { session_->failures = before_; }
  FailureScope(const FailureScope&) = delete;
  FailureScope& operator=(const FailureScope&) = delete;

 private:
  ProofSession* session_;
  std::vector<Literal>* before_;
};

Datum RenameOnly(const Datum& datum, const std::string& suffix, const std::set<std::string>* only) {
  if (only == nullptr) return RenameVariables(datum, suffix);
  Datum renamed = datum;
  if (datum.kind == Datum::Kind::kVariable && only->count(datum.text) > 0) renamed.text += suffix;
  for (Datum& item : renamed.items) item = RenameOnly(item, suffix, only);
  for (Datum& tail : renamed.tail) tail = RenameOnly(tail, suffix, only);
  return renamed;
}

/// A copy whose quantified variables are known nowhere else.
Formula WithOwnVariables(const Formula& formula, const std::string& suffix) {
  const std::set<std::string> own(formula.variables.begin(), formula.variables.end());
  return RenameFormula(formula, suffix, &own);
}

std::string PredicateOf(const Datum& atom) {
  return atom.kind == Datum::Kind::kSymbol ? atom.text : std::string(atom.Head());
}

bool AreSameMembers(std::vector<Datum> a, std::vector<Datum> b) {
  const auto less = [](const Datum& x, const Datum& y) { return ToString(x) < ToString(y); };
  std::sort(a.begin(), a.end(), less);
  std::sort(b.begin(), b.end(), less);
  return a == b;
}

}  // namespace

Formula RenameFormula(const Formula& formula, const std::string& suffix,
                      const std::set<std::string>* only) {
  Formula renamed = formula;
  for (Formula& part : renamed.parts) part = RenameFormula(part, suffix, only);
  for (std::string& variable : renamed.variables) {
    variable = RenameOnly(MakeVariable(variable), suffix, only).text;
  }
  renamed.term = RenameOnly(formula.term, suffix, only);
  renamed.expression = RenameOnly(formula.expression, suffix, only);
  return renamed;
}

ReferenceSolver::ReferenceSolver(ProofSession* session, const Formula& formula, bool newest_first,
                                 int depth, const ValueMap* expected)
    : session_(session), expected_(expected != nullptr ? expected : &kNothingExpected) {
  start_ = Here();
  Cell first;
  first.formula = &formula;
  first.depth = depth;
  first.newest_first = newest_first;
  goal_ = Push(first);
}

ReferenceSolver::~ReferenceSolver() { GoBack(start_); }

ReferenceSolver::Marks ReferenceSolver::Here() const {
  return {cells_.size(), session_->values.Mark(), session_->support.size(), session_->reads.size(),
          formulas_.size()};
}

void ReferenceSolver::GoBack(const Marks& marks) {
  cells_.resize(marks.cells);
  session_->values.Undo(marks.values);
  session_->support.resize(marks.support);
  formulas_.resize(marks.formulas);
}

int ReferenceSolver::Push(Cell cell) {
  cells_.push_back(cell);
  return static_cast<int>(cells_.size()) - 1;
}

int ReferenceSolver::PushGoal(const Formula& formula, const Cell& like, int next) {
  Cell cell = like;
  cell.formula = &formula;
  cell.next = next;
  return Push(cell);
}

const Formula& ReferenceSolver::Keep(Formula formula) {
  formulas_.push_back(std::make_unique<Formula>(std::move(formula)));
  return *formulas_.back();
}

std::string ReferenceSolver::FreshSuffix() { return '#' + std::to_string(++session_->num_clauses); }

bool ReferenceSolver::Next() {
  bool forward = !started_;
  started_ = true;
  while (forward || Backtrack()) {
    forward = true;
    while (forward && goal_ != kNoGoal) forward = Step();
    if (forward && EndsAsExpected()) return true;
    forward = false;
  }
  return false;
}

bool ReferenceSolver::Backtrack() {
  while (!choices_.empty()) {
    GoBack(choices_.back().marks);
    // Under a `not` what failed decides too; outside of it only the way that led to the proof does.
    if (session_->reading == 0) session_->reads.resize(choices_.back().marks.reads);
    if (TryNext(&choices_.back())) return true;
    NoteFailure(choices_.back());
    choices_.pop_back();
  }
  return false;
}

bool ReferenceSolver::EndsAsExpected() {
  return std::all_of(expected_->begin(), expected_->end(),
                     [this](const auto& value) { return Agrees(value.first); });
}

/// False where the goal at hand fails.
bool ReferenceSolver::Step() {
  const Cell cell = cells_[goal_];
  if (cell.formula == nullptr) return Commit(cell);
  switch (cell.formula->kind) {
    case Formula::Kind::kSequence:
    case Formula::Kind::kAnd:
      return PushAll(cell);
    case Formula::Kind::kOr:
    case Formula::Kind::kImply:
      return Begin(cell, Choice());
    case Formula::Kind::kNot:
      return TestNot(cell);
    case Formula::Kind::kForall:
      return TestForall(cell);
    case Formula::Kind::kExists:
      return PushExists(cell);
    case Formula::Kind::kAtom:
    case Formula::Kind::kGoal:
      return BeginAtom(cell, cell.formula->term);
    case Formula::Kind::kEqual:
      return TestEqual(cell);
    case Formula::Kind::kAssign:
      return Assign(cell);
    case Formula::Kind::kAssignEach:
      return BeginAssignEach(cell);
    case Formula::Kind::kEval:
      return TestEval(cell);
    case Formula::Kind::kSetOf:
    case Formula::Kind::kBagOf:
      return Collect(cell);
  }
  return false;
}

bool ReferenceSolver::Begin(const Cell&, Choice choice) {
  choice.cell = goal_;
  choice.marks = Here();
  choices_.push_back(std::move(choice));
  if (TryNext(&choices_.back())) return true;
  NoteFailure(choices_.back());
  choices_.pop_back();
  return false;
}

bool ReferenceSolver::TryNext(Choice* choice) {
  switch (cells_[choice->cell].formula->kind) {
    case Formula::Kind::kOr:
      return NextPart(choice);
    case Formula::Kind::kImply:
      return NextImplied(choice);
    case Formula::Kind::kAssignEach:
      return NextMember(choice);
    default:
      return NextFact(choice) || NextAxiom(choice);
  }
}

bool ReferenceSolver::BeginAtom(const Cell& cell, const Datum& term) {
  Choice choice;
  choice.atom = session_->prover.evaluator().Instantiate(term, session_->values);
  if (choice.atom.kind == Datum::Kind::kVariable) {
    Fail(cell.formula->place, fmt::format("the goal {} is not bound when it is reached; bind it by "
                                          "the head or by a goal before it",
                                          ToString(cell.formula->term)));
  }
  if (session_->explain && session_->reading > 0) session_->reads.push_back(choice.atom);
  choice.guided = Guided(choice.atom);
  choice.facts = &session_->facts.Candidates(choice.guided);
  choice.axioms = &session_->prover.AxiomsFor(PredicateOf(choice.atom));
  return Begin(cell, std::move(choice));
}

Datum ReferenceSolver::Guided(const Datum& atom) const {
  if (expected_->empty() || IsGround(atom)) return atom;
  std::set<std::string> variables;
  CollectVariables(atom, &variables);
  Substitution values;
  for (const std::string& variable : variables) {
    const auto expected = expected_->find(variable);
    if (expected != expected_->end()) values.Unify(MakeVariable(variable), expected->second);
  }
  return values.Apply(atom);
}

bool ReferenceSolver::NextFact(Choice* choice) {
  const Cell cell = cells_[choice->cell];
  const std::size_t count = choice->facts->size();
  while (choice->position < count) {
    const std::size_t position = choice->position++;
    const int index = (*choice->facts)[cell.newest_first ? count - 1 - position : position];
    const FactHistory::Entry& fact = session_->facts.entry(index);
    if (!fact.HoldsAt(session_->moment)) continue;
    if (session_->values.Unify(choice->guided, fact.atom) &&
        session_->values.Unify(choice->atom, fact.atom)) {
      choice->had_proof = true;
      session_->support.push_back({fact.atom, true});
      goal_ = cell.next;
      return true;
    }
    session_->values.Undo(choice->marks.values);
  }
  return false;
}

bool ReferenceSolver::NextAxiom(Choice* choice) {
  while (choice->axiom < choice->axioms->size()) {
    const Axiom& axiom = *(*choice->axioms)[choice->axiom];
    const std::string suffix = FreshSuffix();
    if (choice->branch < axiom.branches.size() &&
        session_->values.Unify(choice->atom, RenameVariables(axiom.head, suffix))) {
      return EnterBranch(*choice, axiom, axiom.branches[choice->branch++], suffix);
    }
    ++choice->axiom;
    choice->branch = 0;
  }
  return false;
}

bool ReferenceSolver::EnterBranch(const Choice& choice, const Axiom& axiom,
                                  const Axiom::Branch& branch, const std::string& suffix) {
  Cell done = cells_[choice.cell];
  if (++done.depth > session_->prover.limits().max_axiom_depth) {
    Fail(axiom.place, fmt::format("axioms call each other more than {} levels deep, last {}; give "
                                  "the axiom of {} a branch that ends",
                                  session_->prover.limits().max_axiom_depth, ToString(choice.atom),
                                  ToString(axiom.head)));
  }
  done.formula = nullptr;
  done.choice = static_cast<int>(&choice - choices_.data());
  done.resume = choice.axiom + 1;
  done.only_one = branch.first;
  const int end = Push(done);
  Cell body = done;
  body.newest_first = done.newest_first || branch.first;
  goal_ = PushGoal(Keep(RenameFormula(branch.condition, suffix)), body, end);
  return true;
}

/// An axiom's branch has a proof: its later branches are out.
bool ReferenceSolver::Commit(const Cell& cell) {
  Choice& choice = choices_[cell.choice];
  choice.axiom = cell.resume;
  choice.branch = 0;
  choice.had_proof = true;
  goal_ = cell.next;
  std::set<std::string> variables;
  if (!expected_->empty()) CollectVariables(choice.atom, &variables);
  if (cell.only_one) choices_.resize(static_cast<std::size_t>(cell.choice) + 1);
  return std::all_of(variables.begin(), variables.end(),
                     [this](const std::string& variable) { return Agrees(variable); });
}

bool ReferenceSolver::Agrees(const std::string& variable) {
  const auto expected = expected_->find(variable);
  return expected == expected_->end() ||
         session_->values.Unify(MakeVariable(variable), expected->second);
}

bool ReferenceSolver::NextPart(Choice* choice) {
  const Cell cell = cells_[choice->cell];
  if (choice->position >= cell.formula->parts.size()) return false;
  goal_ = PushGoal(cell.formula->parts[choice->position++], cell, cell.next);
  return true;
}

bool ReferenceSolver::BeginAssignEach(const Cell& cell) {
  const Datum value =
      session_->prover.evaluator().Evaluate(cell.formula->expression, session_->values);
  if (!value.IsNil() && !value.IsList()) {
    Fail(cell.formula->place, fmt::format("assign* needs a list, {} has the value {}",
                                          ToString(cell.formula->expression), ToString(value)));
  }
  Choice choice;
  choice.members = value.items;
  return Begin(cell, std::move(choice));
}

bool ReferenceSolver::NextMember(Choice* choice) {
  const Cell cell = cells_[choice->cell];
  while (choice->position < choice->members.size()) {
    const Datum& member = choice->members[choice->position++];
    if (session_->values.Unify(cell.formula->term, member)) {
      goal_ = cell.next;
      return true;
    }
  }
  return false;
}

/// Nothing matched this atom: a reason why the whole did not hold.
void ReferenceSolver::NoteFailure(const Choice& choice) {
  if (session_->failures == nullptr || choice.had_proof || choice.axioms == nullptr) return;
  if (choice.axioms->empty()) session_->failures->push_back({choice.atom, false});
}

bool ReferenceSolver::PushAll(const Cell& cell) {
  goal_ = cell.next;
  const std::vector<Formula>& parts = cell.formula->parts;
  for (auto part = parts.rbegin(); part != parts.rend(); ++part) {
    goal_ = PushGoal(*part, cell, goal_);
  }
  return true;
}

/// Whether `formula` has a proof. Binds nothing; tells what it rested on.
bool ReferenceSolver::FindsProof(const Formula& formula, const Cell& cell,
                                 std::vector<Literal>* why, std::vector<Literal>* why_not) {
  CheckNesting(cell);
  const ReadingScope reading(session_);
  std::vector<Literal> failures;
  const FailureScope scope(session_, session_->explain ? &failures : nullptr);
  const std::size_t begin = session_->support.size();
  ReferenceSolver solver(session_, formula, cell.newest_first, cell.depth, nullptr);
  if (!solver.Next()) {
    why_not->insert(why_not->end(), failures.begin(), failures.end());
    return false;
  }
  why->insert(why->end(), session_->support.begin() + static_cast<std::ptrdiff_t>(begin),
              session_->support.end());
  return true;
}

void ReferenceSolver::AddSupport(const std::vector<Literal>& literals) {
  session_->support.insert(session_->support.end(), literals.begin(), literals.end());
}

bool ReferenceSolver::TestNot(const Cell& cell) {
  std::vector<Literal> why;
  std::vector<Literal> why_not;
  if (FindsProof(cell.formula->parts.at(0), cell, &why, &why_not)) {
    if (session_->failures != nullptr) {
      session_->failures->insert(session_->failures->end(), why.begin(), why.end());
    }
    return false;
  }
  AddSupport(why_not);
  goal_ = cell.next;
  return true;
}

/// The first part does not hold; or the second does, which may bind variables.
bool ReferenceSolver::NextImplied(Choice* choice) {
  const Cell cell = cells_[choice->cell];
  if (choice->position > 1) return false;
  std::vector<Literal> why;
  std::vector<Literal> why_not;
  const bool holds = FindsProof(cell.formula->parts.at(0), cell, &why, &why_not);
  AddSupport(holds ? why : why_not);
  if (choice->position == 0 && !holds) {
    choice->position = 1;
    goal_ = cell.next;
    return true;
  }
  choice->position = 2;
  goal_ = PushGoal(cell.formula->parts.at(1), cell, cell.next);
  return true;
}

bool ReferenceSolver::TestForall(const Cell& cell) {
  CheckNesting(cell);
  const Formula formula = WithOwnVariables(*cell.formula, FreshSuffix());
  std::vector<Literal> reasons;
  {
    const ReadingScope reading(session_);
    std::vector<Literal> failures;
    const FailureScope scope(session_, session_->explain ? &failures : nullptr);
    const std::size_t begin = session_->support.size();
    ReferenceSolver instances(session_, formula.parts.at(0), cell.newest_first, cell.depth,
                              nullptr);
    bool any = false;
    for (; instances.Next(); any = true) {
      reasons.insert(reasons.end(), session_->support.begin() + static_cast<std::ptrdiff_t>(begin),
                     session_->support.end());
      std::vector<Literal> why_not;
      if (!FindsProof(formula.parts.at(1), cell, &reasons, &why_not)) return false;
    }
    if (!any) reasons = failures;
  }
  AddSupport(reasons);
  goal_ = cell.next;
  return true;
}

/// Binds nothing that is seen from outside.
bool ReferenceSolver::PushExists(const Cell& cell) {
  Formula inner = *cell.formula;
  for (const std::string& variable : VariablesOf(inner)) {
    if (!session_->values.IsBound(variable)) inner.variables.push_back(variable);
  }
  const Formula& formula = Keep(WithOwnVariables(inner, FreshSuffix()));
  goal_ = cell.next;
  for (auto part = formula.parts.rbegin(); part != formula.parts.rend(); ++part) {
    goal_ = PushGoal(*part, cell, goal_);
  }
  return true;
}

bool ReferenceSolver::TestEqual(const Cell& cell) {
  goal_ = cell.next;
  const std::vector<Datum>& items = cell.formula->term.items;
  return session_->values.Unify(items.at(1), items.at(2));
}

bool ReferenceSolver::Assign(const Cell& cell) {
  goal_ = cell.next;
  const Datum value =
      session_->prover.evaluator().Evaluate(cell.formula->expression, session_->values);
  return session_->values.Unify(cell.formula->term, value);
}

bool ReferenceSolver::TestEval(const Cell& cell) {
  goal_ = cell.next;
  return !session_->prover.evaluator().Evaluate(cell.formula->expression, session_->values).IsNil();
}

bool ReferenceSolver::Collect(const Cell& cell) {
  CheckNesting(cell);
  std::vector<Datum> found;
  std::vector<Literal> reasons;
  {
    const ReadingScope reading(session_);
    const FailureScope scope(session_, nullptr);
    const std::size_t begin = session_->support.size();
    std::set<std::string> seen;
    ReferenceSolver instances(session_, cell.formula->parts.at(0), cell.newest_first, cell.depth,
                              nullptr);
    while (instances.Next()) {
      const Datum instance = session_->values.Apply(cell.formula->term);
      const bool is_new = seen.insert(ToString(instance)).second;
      if (!is_new && cell.formula->kind == Formula::Kind::kSetOf) continue;
      found.push_back(instance);
      reasons.insert(reasons.end(), session_->support.begin() + static_cast<std::ptrdiff_t>(begin),
                     session_->support.end());
    }
  }
  if (found.empty()) return false;
  AddSupport(reasons);
  goal_ = cell.next;
  // The order of the members says nothing, so an expected list may have any.
  const auto expected = expected_->find(cell.formula->expression.text);
  if (expected != expected_->end() && AreSameMembers(found, expected->second.items)) {
    found = expected->second.items;
  }
  return session_->values.Unify(cell.formula->expression, MakeList(found));
}

void ReferenceSolver::CheckNesting(const Cell& cell) const {
  if (session_->nesting < session_->prover.limits().max_nesting) return;
  Fail(cell.formula->place, fmt::format("conditions within conditions more than {} levels deep; "
                                        "does an axiom call itself under a not or forall?",
                                        session_->prover.limits().max_nesting));
}

void ReferenceSolver::Fail(Place place, const std::string& text) const {
  throw base::ConfigError(At(session_->prover.source(), place) + text);
}

}  // namespace hires::planning
