#include "planning/search/search_path.h"

#include "planning/proof/mix.h"

namespace hires::planning {

SearchPath::SearchPath(const Program& program, TermTable* terms)
    : terms_(*terms),
      // In SHOP2 the age of facts decides which binding comes first, and :first takes no other.
      ages_count_(program.domain().language == Domain::Language::kShop2),
      bindings_(terms),
      instances_(terms, &bindings_),
      state_(terms),
      network_(terms),
      protections_(terms),
      prover_(program, terms, &bindings_, &instances_, &state_) {
  for (const Term fact : program.facts()) state_.Add(fact);
  for (const Datum& atom : program.problem().protections) protections_.Add(terms->FromDatum(atom));
}

SearchPath::Moment SearchPath::Now() {
  return {bindings_.Remember(),
          prover_.Remember(),
          state_.Remember(),
          network_.Remember(),
          protections_.Remember(),
          visited_.Remember(),
          begun_.Remember(),
          terms_.Mark(),
          network_.size(),
          steps_.size(),
          decompositions_.size(),
          prover_.num_choices(),
          depth_,
          cost_};
}

void SearchPath::UndoSteps(const Moment& moment) {
  network_.Undo(moment.tasks, moment.nodes);
  state_.Undo(moment.state);
  protections_.Undo(moment.protections);
  visited_.Undo(moment.visited);
  begun_.Undo(moment.begun);
  steps_.resize(moment.num_steps);
  decompositions_.resize(moment.num_decompositions);
  depth_ = moment.depth;
  cost_ = moment.cost;
}

void SearchPath::ReturnTo(const Moment& moment) {
  UndoSteps(moment);
  bindings_.Undo(moment.bindings);
  terms_.Release(moment.pairs);
  prover_.Release(moment.prover);
}

void SearchPath::Decompose(const Decomposition& decomposition, const std::vector<Term>& tasks,
                           int immediate) {
  const CompiledBranch& branch = decomposition.method->branches[decomposition.branch];
  if (counts_repeats_) NoteBegun(decomposition.node);
  decompositions_.push_back(decomposition);
  network_.Decompose(decomposition.node, branch.subtasks, tasks, immediate);
  if (focuses_) focus_ = network_.FirstBelowOpen(decomposition.node);
}

void SearchPath::Finish(const Step& step) {
  cost_ += step.cost;
  steps_.push_back(step);
  network_.Finish(step.node);
  if (focuses_) focus_ = network_.FirstBelowOpen(step.node);
}

bool SearchPath::WasHere() {
  if (!network_.all_ground()) return false;
  const std::uint64_t state = ages_count_ ? state_.ordered_hash() : state_.hash();
  return !visited_.Insert(Mix(Mix(state, network_.hash()), protections_.hash()));
}

std::uint64_t SearchPath::situation() const {
  const std::uint64_t state = ages_count_ ? state_.ordered_hash() : state_.hash();
  const std::uint64_t situation = Mix(Mix(state, network_.content()), protections_.hash());
  return focus_ == 0 ? situation : Mix(situation, network_.ContentFrom(focus_));
}

void SearchPath::NoteBegun(std::uint32_t node) {
  if (begins_.size() <= node) begins_.resize(node + 1);
  begins_[node] = {state_.hash(), steps_.size()};
  begun_.Insert(Mix(terms_.Hash(network_.node(node).task), state_.hash()));
}

int SearchPath::NumRepeats(std::uint32_t node, Term task, bool across_steps) const {
  if (!begun_.Contains(Mix(terms_.Hash(task), state_.hash()))) return 0;
  int count = 0;
  for (std::uint32_t above = network_.node(node).parent; above != Network::kNone;
       above = network_.node(above).parent) {
    const bool counts = across_steps || begins_[above].num_steps == steps_.size();
    if (counts && network_.node(above).task == task && begins_[above].state == state_.hash())
      ++count;
  }
  return count;
}

std::uint32_t SearchPath::FirstReady() const {
  const std::uint32_t first = network_.FirstReady();
  return first == 0 || first >= focus_ ? first : NextReady(first, focus_);
}

std::uint32_t SearchPath::NextReady(std::uint32_t node, std::uint32_t focus) const {
  do {
    node = network_.NextReady(node);
  } while (node != 0 && node < focus);
  return node;
}

std::size_t SearchPath::bytes() const {
  return terms_.bytes() + bindings_.bytes() + instances_.bytes() + state_.bytes() +
         network_.bytes() + visited_.bytes() + begun_.bytes() + prover_.bytes() +
         steps_.capacity() * sizeof(Step) + decompositions_.capacity() * sizeof(Decomposition);
}

}  // namespace hires::planning
