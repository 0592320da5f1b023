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
  decompositions_.push_back(decomposition);
  network_.Decompose(decomposition.node, branch.subtasks, tasks, immediate);
}

void SearchPath::Finish(const Step& step) {
  cost_ += step.cost;
  steps_.push_back(step);
  network_.Finish(step.node);
}

bool SearchPath::WasHere() {
  if (!network_.all_ground()) return false;
  const std::uint64_t state = ages_count_ ? state_.ordered_hash() : state_.hash();
  return !visited_.Insert(Mix(Mix(state, network_.hash()), protections_.hash()));
}

bool SearchPath::IsLeftRecursion(std::uint32_t node, Term task) const {
  for (std::size_t i = decompositions_.size(); i-- > 0;) {
    const Decomposition& above = decompositions_[i];
    if (above.num_steps != steps_.size()) return false;
    if (network_.node(above.node).task != task) continue;
    for (std::uint32_t parent = network_.node(node).parent; parent != Network::kNone;
         parent = network_.node(parent).parent) {
      if (parent == above.node) return true;
    }
  }
  return false;
}

std::size_t SearchPath::bytes() const {
  return terms_.bytes() + bindings_.bytes() + instances_.bytes() + state_.bytes() +
         network_.bytes() + visited_.bytes() + prover_.bytes() + steps_.capacity() * sizeof(Step) +
         decompositions_.capacity() * sizeof(Decomposition);
}

}  // namespace hires::planning
