#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "hires/planning/term.h"

namespace hires::planning {

/// What the variables of a search stand for. Variables are made and forgotten like a stack; what
/// was bound after a mark is undone on the way back. A younger variable is bound to an older one,
/// never the other way round, so forgetting the younger leaves nothing dangling.
class Bindings {
 public:
  explicit Bindings(TermTable* terms) : terms_(terms) {}

  struct Mark {
    std::uint32_t variables;
    std::uint32_t trail;
  };
  /// Everything bound from now on can be undone to here.
  Mark Remember() {
    floor_ = static_cast<std::uint32_t>(values_.size());
    return {floor_, static_cast<std::uint32_t>(trail_.size())};
  }
  void Undo(const Mark& mark);

  /// The first of `count` new unbound variables, numbered one after the other.
  std::uint32_t Make(std::uint32_t count);
  std::uint32_t size() const { return static_cast<std::uint32_t>(values_.size()); }
  /// Forgets variables from `size` on. @pre nothing older refers to them.
  void Shrink(std::uint32_t size) {
    values_.resize(size);
    if (floor_ > size) floor_ = size;
  }

  /// What `term` stands for: never a bound variable itself, though it may contain some.
  Term Deref(Term term) const {
    while (term.IsVariable()) {
      const Term value = values_[term.index()];
      if (value == term) return term;
      term = value;
    }
    return term;
  }
  Term Resolve(Term term);  ///< with all bound variables in it replaced
  bool Unify(Term a, Term b);

  std::size_t bytes() const {
    return values_.capacity() * sizeof(Term) + trail_.capacity() * sizeof(std::uint32_t);
  }

 private:
  void Bind(Term variable, Term value);
  bool Occurs(Term variable, Term term) const;

  TermTable* terms_;
  std::vector<Term> values_;          ///< an unbound variable's value is itself
  std::vector<std::uint32_t> trail_;  ///< variables older than floor_ that were bound
  std::uint32_t floor_{0};
};

}  // namespace hires::planning
