#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "hires/planning/term.h"

namespace hires::planning {

/// The facts that hold now, in the order of their age, and the way back to those that held before.
/// Facts of one predicate are chained by age; those that share their first or their second argument
/// are too, and, where the first argument is a list like in (goal (on b1 b2)), those that share its
/// first and second or its first and third item. So a goal walks along the shortest chain that can
/// answer it.
class State {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  explicit State(TermTable* terms);

  /// @pre `atom` is a ground list that begins with a symbol. A fact that holds keeps its age.
  void Add(Term atom);
  void Remove(Term atom);  ///< no effect where it does not hold
  bool Holds(Term atom) const;

  std::size_t Remember() const { return trail_.size(); }
  void Undo(std::size_t mark);

  /// A chain of facts, walked from the oldest (Next) or the newest (Previous).
  struct Chain {
    std::uint32_t oldest{kNone};
    std::uint32_t newest{kNone};
    std::uint8_t key{0};  ///< which links
  };
  /// The shortest chain on which every fact `(predicate arguments...)` lies. Arguments that are not
  /// ground may be anything.
  Chain Candidates(Term predicate, const Term* arguments, std::size_t count) const;
  std::uint32_t Next(std::uint32_t fact, std::uint8_t key) const {
    return facts_[fact].links[key].next;
  }
  std::uint32_t Previous(std::uint32_t fact, std::uint8_t key) const {
    return facts_[fact].links[key].previous;
  }
  std::size_t Arity(std::uint32_t fact) const { return facts_[fact].arity; }
  const Term* Arguments(std::uint32_t fact) const { return &arguments_[facts_[fact].arguments]; }

  std::uint64_t hash() const { return hash_; }  ///< of the set of facts, whatever their age
  /// Of the facts in the order of their age within each predicate, which decides about bindings.
  std::uint64_t ordered_hash() const { return ordered_hash_; }
  std::size_t bytes() const;

 private:
  static constexpr std::uint8_t kNumKeys = 5;
  /// What the facts of a chain have in common; unused parts are nil.
  struct ChainName {
    Term predicate, a, b;
    std::uint8_t key{0};
    bool used{false};
    bool operator==(const ChainName& other) const {
      return predicate == other.predicate && a == other.a && b == other.b && key == other.key &&
             used == other.used;
    }
  };
  struct Links {
    std::uint32_t previous;
    std::uint32_t next;
    std::uint32_t chain;
  };
  struct Fact {
    Term atom;
    std::uint32_t arguments;
    std::uint32_t arity;
    Links links[kNumKeys];
  };
  struct Ends {
    std::uint32_t oldest{kNone};
    std::uint32_t newest{kNone};
    std::uint32_t length{0};
  };
  struct Change {
    std::uint32_t fact;
    bool added;
  };

  std::uint32_t Find(Term atom) const;
  bool NameChain(std::uint8_t key, Term predicate, const Term* arguments, std::size_t count,
                 ChainName* name) const;
  std::uint32_t ChainOf(const ChainName& name);
  void Link(std::uint32_t fact);  ///< in the place that its links name
  void Unlink(std::uint32_t fact);
  std::uint64_t Joint(std::uint32_t older, std::uint32_t newer) const;
  std::uint64_t Place(std::uint32_t fact) const;
  void SetPresent(Term atom, std::uint32_t fact);

  struct Slot {
    ChainName name;
    std::uint32_t chain{kNone};
  };
  std::size_t SlotOf(const ChainName& name) const;

  TermTable* terms_;
  std::vector<Fact> facts_;
  std::vector<Term> arguments_;
  std::vector<Ends> chains_;
  std::vector<std::uint32_t> of_predicate_;  ///< symbol -> its chain of all facts, or kNone
  std::vector<Slot> slots_;  ///< other chains by name: open addressing, never shrinks
  std::size_t used_slots_{0};
  std::vector<std::uint32_t> present_;  ///< pair index of an atom -> its fact, or kNone
  std::vector<Change> trail_;
  std::uint64_t hash_{0};
  std::uint64_t ordered_hash_{0};
};

}  // namespace hires::planning
