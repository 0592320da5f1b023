#include "hires/planning/term.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "planning/proof/mix.h"

namespace hires::planning {
namespace {

constexpr std::uint32_t kEnd = 0xffffffffu;
constexpr std::size_t kMaxIndex = (std::size_t{1} << 29) - 1;  // what Term has bits for
constexpr std::size_t kFirstBuckets = 1024;
constexpr unsigned kMaxTermDepth = 1000;

std::uint32_t CheckedIndex(std::size_t index) {
  if (index > kMaxIndex) {
    throw base::ConfigError(
        "planning: more than 536 million different terms; give the search a memory limit");
  }
  return static_cast<std::uint32_t>(index);
}

/// The index of `key` in `values`, appended where it is new.
template <typename Values, typename Index, typename Key, typename Value>
std::uint32_t Intern(Values* values, Index* index, const Key& key, Value&& value) {
  const auto found = index->find(key);
  if (found != index->end()) return found->second;
  const std::uint32_t fresh = CheckedIndex(values->size());
  values->push_back(std::forward<Value>(value));
  index->emplace(key, fresh);
  return fresh;
}

std::uint64_t BitsOf(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

}  // namespace

TermTable::TermTable() : buckets_(kFirstBuckets, kEnd) { Symbol("nil"); }

Term TermTable::Symbol(std::string_view name) {
  const std::string key = base::ToLower(name);
  const std::size_t before = symbols_.size();
  const Term term(Term::Kind::kSymbol, Intern(&symbols_, &symbol_index_, key, key));
  if (symbols_.size() != before) text_bytes_ += 2 * key.size();
  return term;
}

Term TermTable::String(std::string_view text) {
  const std::string key(text);
  const std::size_t before = strings_.size();
  const Term term(Term::Kind::kString, Intern(&strings_, &string_index_, key, key));
  if (strings_.size() != before) text_bytes_ += 2 * key.size();
  return term;
}

Term TermTable::Integer(std::int64_t value) {
  return {Term::Kind::kInteger, Intern(&integers_, &integer_index_, value, value)};
}

Term TermTable::Real(double value) {
  return {Term::Kind::kReal, Intern(&reals_, &real_index_, BitsOf(value), value)};
}

std::size_t TermTable::Bucket(Term head, Term tail) const {
  std::uint64_t key = (std::uint64_t{head.bits()} << 32) | tail.bits();
  key *= 0x9e3779b97f4a7c15ULL;
  return (key >> 32) & (buckets_.size() - 1);
}

std::uint64_t TermTable::HashOfAtom(Term term) const { return Mix(term.bits() + 1, 0); }

Term TermTable::FindPair(Term head, Term tail) const {
  for (std::uint32_t i = buckets_[Bucket(head, tail)]; i != kEnd; i = pairs_[i].next) {
    if (pairs_[i].head == head && pairs_[i].tail == tail) return {Term::Kind::kPair, i};
  }
  return {};
}

Term TermTable::Pair(Term head, Term tail) {
  const Term known = FindPair(head, tail);
  if (known.IsPair()) return known;
  const unsigned depth = std::max(Depth(head) + 1, Depth(tail));
  if (depth > kMaxTermDepth) {
    throw base::ConfigError(
        "planning: a list nests deeper than 1000; look for a method or axiom "
        "that wraps its own argument without end");
  }
  const std::uint32_t fresh = CheckedIndex(pairs_.size());
  const std::size_t bucket = Bucket(head, tail);
  pairs_.push_back({head, tail, buckets_[bucket], static_cast<std::uint16_t>(depth),
                    IsGround(head) && IsGround(tail), Mix(Hash(head), Hash(tail))});
  buckets_[bucket] = fresh;
  if (pairs_.size() > buckets_.size()) Grow();
  return {Term::Kind::kPair, fresh};
}

// Oldest first, so that in every bucket the newest pair comes first and Release can pop it.
void TermTable::Grow() {
  buckets_.assign(2 * buckets_.size(), kEnd);
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const std::size_t bucket = Bucket(pairs_[i].head, pairs_[i].tail);
    pairs_[i].next = buckets_[bucket];
    buckets_[bucket] = static_cast<std::uint32_t>(i);
  }
}

void TermTable::Release(std::size_t mark) {
  while (pairs_.size() > mark) {
    const PairCell& last = pairs_.back();
    buckets_[Bucket(last.head, last.tail)] = last.next;
    pairs_.pop_back();
  }
}

Term TermTable::List(const Term* begin, const Term* end) {
  Term list;
  while (end != begin) list = Pair(*--end, list);
  return list;
}

Term TermTable::FromDatum(const Datum& datum) {
  switch (datum.kind) {
    case Datum::Kind::kSymbol:
      return Symbol(datum.text);
    case Datum::Kind::kInteger:
      return Integer(datum.integer);
    case Datum::Kind::kReal:
      return Real(datum.real);
    case Datum::Kind::kString:
      return String(datum.text);
    case Datum::Kind::kVariable:
      HIRES_CHECK(false, "a variable is no ground term: " + datum.text);
    case Datum::Kind::kList:
      break;
  }
  Term list = datum.tail.empty() ? Term() : FromDatum(datum.tail.front());
  for (std::size_t i = datum.items.size(); i-- > 0;) list = Pair(FromDatum(datum.items[i]), list);
  return list;
}

const std::string& TermTable::text(Term term) const {
  return term.kind() == Term::Kind::kString ? strings_[term.index()] : symbols_[term.index()];
}

std::int64_t TermTable::integer(Term term) const { return integers_[term.index()]; }

double TermTable::number(Term term) const {
  return term.kind() == Term::Kind::kReal ? reals_[term.index()]
                                          : static_cast<double>(integers_[term.index()]);
}

Datum TermTable::ToDatum(Term term) const {
  Datum datum;
  Write(term, &datum);
  return datum;
}

// In place: plans hold long lists many times over.
void TermTable::Write(Term term, Datum* datum) const {
  switch (term.kind()) {
    case Term::Kind::kSymbol:
      if (term.IsNil()) return;
      datum->kind = Datum::Kind::kSymbol;
      datum->text = text(term);
      return;
    case Term::Kind::kInteger:
      *datum = MakeInteger(integer(term));
      return;
    case Term::Kind::kReal:
      *datum = MakeReal(number(term));
      return;
    case Term::Kind::kString:
      *datum = MakeString(text(term));
      return;
    case Term::Kind::kVariable:
      *datum = MakeVariable("?" + std::to_string(term.index()));
      return;
    case Term::Kind::kPair:
      break;
  }
  std::size_t length = 0;
  for (Term rest = term; rest.IsPair(); rest = tail(rest)) ++length;
  datum->items.resize(length);
  for (Datum& item : datum->items) {
    Write(head(term), &item);
    term = tail(term);
  }
  if (!term.IsNil()) Write(term, &datum->tail.emplace_back());
}

std::string TermTable::ToString(Term term) const { return planning::ToString(ToDatum(term)); }

std::size_t TermTable::bytes() const {
  constexpr std::size_t kIndexNode = 48;  // about what a node of the hash maps takes
  return pairs_.capacity() * sizeof(PairCell) + buckets_.capacity() * sizeof(std::uint32_t) +
         text_bytes_ +
         (symbols_.size() + strings_.size() + integers_.size() + reals_.size()) *
             (kIndexNode + sizeof(std::string));
}

}  // namespace hires::planning
