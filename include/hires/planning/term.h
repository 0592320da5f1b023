#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "hires/planning/datum.h"

namespace hires::planning {

/// A term of the search in 32 bits: symbol, number, string, pair or variable. Two terms of one
/// table are equal if and only if their bits are (pairs are hash-consed), so comparing is one
/// instruction.
class Term {
 public:
  enum class Kind : std::uint32_t { kSymbol, kInteger, kReal, kString, kPair, kVariable };

  constexpr Term() = default;  ///< nil
  constexpr Term(Kind kind, std::uint32_t index)
      : bits_(index << 3 | static_cast<std::uint32_t>(kind)) {}

  constexpr Kind kind() const { return static_cast<Kind>(bits_ & 7u); }
  constexpr std::uint32_t index() const { return bits_ >> 3; }
  constexpr std::uint32_t bits() const { return bits_; }
  constexpr bool IsNil() const { return bits_ == 0; }
  constexpr bool IsPair() const { return kind() == Kind::kPair; }
  constexpr bool IsVariable() const { return kind() == Kind::kVariable; }
  constexpr bool IsNumber() const { return kind() == Kind::kInteger || kind() == Kind::kReal; }
  friend constexpr bool operator==(Term a, Term b) { return a.bits_ == b.bits_; }
  friend constexpr bool operator!=(Term a, Term b) { return a.bits_ != b.bits_; }

 private:
  std::uint32_t bits_{0};
};

/// Owns what terms refer to. Pairs can be given back in the order of a stack (Mark, Release), so a
/// search that backtracks does not grow; symbols, numbers and strings stay.
class TermTable {
 public:
  TermTable();

  Term Symbol(std::string_view name);  ///< lower-case; "nil" is the empty list
  Term Integer(std::int64_t value);
  Term Real(double value);
  Term String(std::string_view text);
  /// @throws ConfigError when lists nest deeper than 1000.
  Term Pair(Term head, Term tail);
  /// The pair if it was ever made, else nil.
  Term FindPair(Term head, Term tail) const;
  Term List(const Term* begin, const Term* end);
  Term FromDatum(const Datum& datum);  ///< @pre ground

  const std::string& text(Term symbol_or_string) const;
  std::int64_t integer(Term integer) const;
  double number(Term number) const;  ///< integer or real
  Term head(Term pair) const { return pairs_[pair.index()].head; }
  Term tail(Term pair) const { return pairs_[pair.index()].tail; }
  /// Holds no variable. Constant time.
  bool IsGround(Term term) const {
    return term.IsPair() ? pairs_[term.index()].ground : !term.IsVariable();
  }
  /// The same for equal content, whenever and wherever it was made; variables count by number.
  std::uint64_t Hash(Term term) const {
    return term.IsPair() ? pairs_[term.index()].hash : HashOfAtom(term);
  }
  Datum ToDatum(Term term) const;  ///< variables become ?1, ?2, ...
  std::string ToString(Term term) const;

  std::size_t Mark() const { return pairs_.size(); }
  void Release(std::size_t mark);  ///< forgets the pairs made since
  std::size_t bytes() const;

 private:
  struct PairCell {
    Term head;
    Term tail;
    std::uint32_t next;  ///< in its bucket
    std::uint16_t depth;
    bool ground;
    std::uint64_t hash;
  };
  void Write(Term term, Datum* datum) const;
  std::uint64_t HashOfAtom(Term term) const;
  unsigned Depth(Term term) const { return term.IsPair() ? pairs_[term.index()].depth : 0; }
  std::size_t Bucket(Term head, Term tail) const;
  void Grow();

  std::vector<std::string> symbols_;
  std::unordered_map<std::string, std::uint32_t> symbol_index_;
  std::vector<std::string> strings_;
  std::unordered_map<std::string, std::uint32_t> string_index_;
  std::vector<std::int64_t> integers_;
  std::unordered_map<std::int64_t, std::uint32_t> integer_index_;
  std::vector<double> reals_;
  std::unordered_map<std::uint64_t, std::uint32_t> real_index_;
  std::vector<PairCell> pairs_;
  std::vector<std::uint32_t> buckets_;
  std::size_t text_bytes_{0};
};

}  // namespace hires::planning
