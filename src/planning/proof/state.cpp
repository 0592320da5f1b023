#include "planning/proof/state.h"

#include <algorithm>

#include "hires/base/check.h"
#include "planning/proof/mix.h"

namespace hires::planning {
namespace {

constexpr std::size_t kFirstSlots = 1024;
constexpr std::uint32_t kShort = 3;  // walking so many facts is cheaper than looking for fewer

}  // namespace

State::State(TermTable* terms) : terms_(terms), slots_(kFirstSlots) {}

// A pair's number is never given back while a fact refers to it, so it finds the fact directly.
std::uint32_t State::Find(Term atom) const {
  return atom.IsPair() && atom.index() < present_.size() ? present_[atom.index()] : kNone;
}

bool State::Holds(Term atom) const { return Find(atom) != kNone; }

void State::SetPresent(Term atom, std::uint32_t fact) {
  if (atom.index() >= present_.size()) {
    present_.resize(std::max<std::size_t>(atom.index() + 1, 2 * present_.size()), kNone);
  }
  present_[atom.index()] = fact;
}

std::size_t State::SlotOf(const ChainName& name) const {
  std::uint64_t hash = name.predicate.bits();
  hash = hash * 0x9e3779b97f4a7c15ULL + name.a.bits();
  hash = (hash * 0x9e3779b97f4a7c15ULL + name.b.bits()) * 8 + name.key;
  hash *= 0xd6e8feb86659fd93ULL;
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = (hash >> 32) & mask;
  while (slots_[slot].name.used && !(slots_[slot].name == name)) slot = (slot + 1) & mask;
  return slot;
}

std::uint32_t State::ChainOf(const ChainName& name) {
  if (name.key == 0) {
    const std::uint32_t symbol = name.predicate.index();
    if (symbol >= of_predicate_.size()) of_predicate_.resize(symbol + 1, kNone);
    if (of_predicate_[symbol] == kNone) {
      of_predicate_[symbol] = static_cast<std::uint32_t>(chains_.size());
      chains_.emplace_back();
    }
    return of_predicate_[symbol];
  }
  std::size_t slot = SlotOf(name);
  if (slots_[slot].name.used) return slots_[slot].chain;
  if (2 * (used_slots_ + 1) > slots_.size()) {
    std::vector<Slot> old(2 * slots_.size());
    old.swap(slots_);
    for (const Slot& entry : old) {
      if (entry.name.used) slots_[SlotOf(entry.name)] = entry;
    }
    slot = SlotOf(name);
  }
  slots_[slot] = {name, static_cast<std::uint32_t>(chains_.size())};
  chains_.emplace_back();
  ++used_slots_;
  return slots_[slot].chain;
}

/// The chain of kind `key` on which a fact, or every answer to a goal, lies. False: there is none
/// of that kind, or the goal does not say which.
bool State::NameChain(std::uint8_t key, Term predicate, const Term* arguments, std::size_t count,
                      ChainName* name) const {
  *name = {predicate, Term(), Term(), key, true};
  if (key == 0) return true;
  if (key <= 2) {
    if (key > count || !terms_->IsGround(arguments[key - 1])) return false;
    name->a = arguments[key - 1];
    return true;
  }
  if (count == 0 || !arguments[0].IsPair()) return false;
  name->a = terms_->head(arguments[0]);
  Term rest = terms_->tail(arguments[0]);
  if (key == 4 && rest.IsPair()) rest = terms_->tail(rest);
  if (!rest.IsPair()) return false;
  name->b = terms_->head(rest);
  return terms_->IsGround(name->a) && terms_->IsGround(name->b);
}

/// What two neighbours of the predicate's chain add to the ordered hash: the sum over all
/// neighbours changes in three terms when one comes or goes.
std::uint64_t State::Joint(std::uint32_t older, std::uint32_t newer) const {
  const std::uint64_t a = older == kNone ? 1 : terms_->Hash(facts_[older].atom);
  const std::uint64_t b = newer == kNone ? 2 : terms_->Hash(facts_[newer].atom);
  return Mix(a, b);
}

/// What the ordered hash gains when the fact stands between its neighbours.
std::uint64_t State::Place(std::uint32_t fact) const {
  const Links& links = facts_[fact].links[0];
  return Joint(links.previous, fact) + Joint(fact, links.next) - Joint(links.previous, links.next);
}

void State::Link(std::uint32_t fact) {
  for (std::uint8_t key = 0; key < kNumKeys; ++key) {
    const Links& links = facts_[fact].links[key];
    if (links.chain == kNone) continue;
    Ends& ends = chains_[links.chain];
    (links.previous == kNone ? ends.oldest : facts_[links.previous].links[key].next) = fact;
    (links.next == kNone ? ends.newest : facts_[links.next].links[key].previous) = fact;
    ++ends.length;
  }
  SetPresent(facts_[fact].atom, fact);
  hash_ += terms_->Hash(facts_[fact].atom);
  ordered_hash_ += Place(fact);
}

void State::Unlink(std::uint32_t fact) {
  for (std::uint8_t key = 0; key < kNumKeys; ++key) {
    const Links& links = facts_[fact].links[key];
    if (links.chain == kNone) continue;
    Ends& ends = chains_[links.chain];
    (links.previous == kNone ? ends.oldest : facts_[links.previous].links[key].next) = links.next;
    (links.next == kNone ? ends.newest : facts_[links.next].links[key].previous) = links.previous;
    --ends.length;
  }
  present_[facts_[fact].atom.index()] = kNone;
  hash_ -= terms_->Hash(facts_[fact].atom);
  ordered_hash_ -= Place(fact);
}

void State::Add(Term atom) {
  HIRES_CHECK(atom.IsPair() && terms_->IsGround(atom), "a fact is a ground list");
  if (Holds(atom)) return;
  const std::uint32_t fact = static_cast<std::uint32_t>(facts_.size());
  const Term predicate = terms_->head(atom);
  Fact fresh{atom, static_cast<std::uint32_t>(arguments_.size()), 0, {}};
  for (Term rest = terms_->tail(atom); rest.IsPair(); rest = terms_->tail(rest)) {
    arguments_.push_back(terms_->head(rest));
    ++fresh.arity;
  }
  for (std::uint8_t key = 0; key < kNumKeys; ++key) {
    ChainName name;
    const Term* arguments = arguments_.data() + fresh.arguments;
    const bool chained = NameChain(key, predicate, arguments, fresh.arity, &name);
    const std::uint32_t chain = chained ? ChainOf(name) : kNone;
    fresh.links[key] = {chained ? chains_[chain].newest : kNone, kNone, chain};
  }
  facts_.push_back(fresh);
  Link(fact);
  trail_.push_back({fact, true});
}

void State::Remove(Term atom) {
  const std::uint32_t fact = Find(atom);
  if (fact == kNone) return;
  Unlink(fact);
  trail_.push_back({fact, false});
}

// In reverse order, so that every fact finds its neighbours as they were when it left.
void State::Undo(std::size_t mark) {
  while (trail_.size() > mark) {
    const Change change = trail_.back();
    trail_.pop_back();
    if (!change.added) {
      Link(change.fact);
      continue;
    }
    Unlink(change.fact);
    arguments_.resize(facts_.back().arguments);
    facts_.pop_back();
  }
}

State::Chain State::Candidates(Term predicate, const Term* arguments, std::size_t count) const {
  const std::uint32_t symbol = predicate.index();
  std::uint32_t best = symbol < of_predicate_.size() ? of_predicate_[symbol] : kNone;
  if (best == kNone || chains_[best].length == 0) return {};
  std::uint8_t best_key = 0;
  for (std::uint8_t key = 1; key < kNumKeys && chains_[best].length > kShort; ++key) {
    ChainName name;
    if (!NameChain(key, predicate, arguments, count, &name)) continue;
    const std::uint32_t chain = slots_[SlotOf(name)].chain;
    if (chain == kNone || chains_[chain].length == 0) return {};
    if (chains_[chain].length < chains_[best].length) {
      best = chain;
      best_key = key;
    }
  }
  return {chains_[best].oldest, chains_[best].newest, best_key};
}

std::size_t State::bytes() const {
  return facts_.capacity() * sizeof(Fact) + arguments_.capacity() * sizeof(Term) +
         chains_.capacity() * sizeof(Ends) + slots_.capacity() * sizeof(Slot) +
         present_.capacity() * sizeof(std::uint32_t) + trail_.capacity() * sizeof(Change);
}

}  // namespace hires::planning
