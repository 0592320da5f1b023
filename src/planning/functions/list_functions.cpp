#include <fmt/format.h>

#include <algorithm>
#include <unordered_set>

#include "planning/functions/standard_functions.h"

// Lists, sets and tests. Sets keep the order of the first list, then that of the second.
namespace hires::planning {
namespace {

Term HeadOf(const Call& call, std::size_t i, Term list) {
  if (list.IsPair()) return call.terms->head(list);
  if (!list.IsNil()) RefuseArgument(call, i, "a list");
  return {};
}

Term TailOf(const Call& call, std::size_t i, Term list) {
  if (list.IsPair()) return call.terms->tail(list);
  if (!list.IsNil()) RefuseArgument(call, i, "a list");
  return {};
}

/// What is left of argument `i` after `count` elements.
Term Behind(const Call& call, std::size_t i, std::int64_t count) {
  Term rest = call[i];
  if (!rest.IsPair() && !rest.IsNil()) RefuseArgument(call, i, "a list");
  for (; count > 0 && !rest.IsNil(); --count) rest = TailOf(call, i, rest);
  return rest;
}

template <int n>
Term NthOf(const Call& call) {
  return HeadOf(call, 0, Behind(call, 0, n));
}

Term Cdr(const Call& call) { return TailOf(call, 0, call[0]); }
Term Cddr(const Call& call) { return Behind(call, 0, 2); }
Term Caar(const Call& call) { return HeadOf(call, 0, HeadOf(call, 0, call[0])); }
Term Cdar(const Call& call) { return TailOf(call, 0, HeadOf(call, 0, call[0])); }

std::int64_t CountAt(const Call& call, std::size_t i) {
  const std::int64_t count = IntegerAt(call, i);
  if (count < 0) RefuseArgument(call, i, "an integer of at least 0");
  return count;
}

Term Nth(const Call& call) { return HeadOf(call, 1, Behind(call, 1, CountAt(call, 0))); }
Term Nthcdr(const Call& call) { return Behind(call, 1, CountAt(call, 0)); }

std::int64_t LengthAt(const Call& call, std::size_t i) {
  std::int64_t length = 0;
  Term rest = call[i];
  for (; rest.IsPair(); rest = call.terms->tail(rest)) ++length;
  if (!rest.IsNil()) RefuseArgument(call, i, "a list");
  return length;
}

Term Length(const Call& call) { return call.terms->Integer(LengthAt(call, 0)); }

Term Last(const Call& call) {
  const std::int64_t count = call.size() > 1 ? CountAt(call, 1) : 1;
  return Behind(call, 0, std::max<std::int64_t>(0, LengthAt(call, 0) - count));
}

Term Butlast(const Call& call) {
  std::vector<Term> elements = Elements(call, 0);
  const auto count = static_cast<std::size_t>(call.size() > 1 ? CountAt(call, 1) : 1);
  elements.resize(elements.size() - std::min(elements.size(), count));
  return MakeBoundedList(call, elements);
}

Term List(const Call& call) { return MakeBoundedList(call, call.arguments); }
Term Cons(const Call& call) { return call.terms->Pair(call[0], call[1]); }

Term ListStar(const Call& call) {
  return MakeBoundedList(call, {call.arguments.begin(), call.arguments.end() - 1},
                         call.arguments.back());
}

Term Append(const Call& call) {
  if (call.size() == 0) return {};
  std::vector<Term> elements;
  for (std::size_t i = 0; i + 1 < call.size(); ++i) {
    const std::vector<Term> part = Elements(call, i);
    elements.insert(elements.end(), part.begin(), part.end());
    if (elements.size() > kMaxListElements) break;  // refused below
  }
  return MakeBoundedList(call, elements, call.arguments.back());
}

Term Reverse(const Call& call) {
  Term reversed;
  std::size_t length = 0;
  Term rest = call[0];
  for (; rest.IsPair() && length <= kMaxListElements; rest = call.terms->tail(rest), ++length) {
    reversed = call.terms->Pair(call.terms->head(rest), reversed);
  }
  if (rest.IsPair()) RefuseArgument(call, 0, fmt::format("{} elements at most", kMaxListElements));
  if (!rest.IsNil()) RefuseArgument(call, 0, "a list");
  return reversed;
}

/// Tells whether values are the same as one that is given once.
class SameAs {
 public:
  SameAs(const Call& call, Term value, Sameness sameness)
      : terms_(call.terms), sameness_(sameness), key_(KeyUnder(sameness, call.terms, value)) {}

  bool operator()(Term other) const {
    return key_.has_value() && KeyUnder(sameness_, terms_, other) == key_;
  }

 private:
  TermTable* terms_;
  Sameness sameness_;
  std::optional<Term> key_;
};

/// A set of values under a sameness.
class ValueSet {
 public:
  ValueSet(TermTable* terms, Sameness sameness) : terms_(terms), sameness_(sameness) {}

  void Insert(Term value) { InsertIsNew(value); }
  bool InsertIsNew(Term value) {
    const auto key = KeyUnder(sameness_, terms_, value);
    return !key || keys_.insert(key->bits()).second;
  }
  bool Has(Term value) const {
    const auto key = KeyUnder(sameness_, terms_, value);
    return key && keys_.count(key->bits()) > 0;
  }

 private:
  TermTable* terms_;
  Sameness sameness_;
  std::unordered_set<std::uint32_t> keys_;
};

ValueSet SetOf(const Call& call, const std::vector<Term>& values, Sameness sameness) {
  ValueSet set(call.terms, sameness);
  for (const Term value : values) set.Insert(value);
  return set;
}

Term Member(const Call& call) {
  const SameAs is_wanted(call, call[0], TestAt(call, 2));
  Term rest = call[1];
  for (; rest.IsPair(); rest = call.terms->tail(rest)) {
    if (is_wanted(call.terms->head(rest))) return rest;
  }
  if (!rest.IsNil()) RefuseArgument(call, 1, "a list");
  return {};
}

Term Assoc(const Call& call) {
  const SameAs is_wanted(call, call[0], TestAt(call, 2));
  for (const Term entry : Elements(call, 1)) {
    if (entry.IsNil()) continue;
    if (!entry.IsPair()) RefuseArgument(call, 1, "a list of pairs (key . value)");
    if (is_wanted(call.terms->head(entry))) return entry;
  }
  return {};
}

Term Find(const Call& call) {
  const Term found = Member(call);
  return found.IsPair() ? call.terms->head(found) : Term();
}

Term Position(const Call& call) {
  const Term found = Member(call);
  if (found.IsNil()) return {};
  std::int64_t behind = 0;
  for (Term rest = found; rest.IsPair(); rest = call.terms->tail(rest)) ++behind;
  return call.terms->Integer(LengthAt(call, 1) - behind);
}

Term Count(const Call& call) {
  const SameAs is_wanted(call, call[0], TestAt(call, 2));
  const std::vector<Term> elements = Elements(call, 1);
  return call.terms->Integer(std::count_if(elements.begin(), elements.end(), is_wanted));
}

Term Remove(const Call& call) {
  const SameAs is_wanted(call, call[0], TestAt(call, 2));
  std::vector<Term> elements = Elements(call, 1);
  elements.erase(std::remove_if(elements.begin(), elements.end(), is_wanted), elements.end());
  return MakeBoundedList(call, elements);
}

// As in Common Lisp, the last of equal elements stays.
Term RemoveDuplicates(const Call& call) {
  std::vector<Term> elements = Elements(call, 0);
  ValueSet seen(call.terms, TestAt(call, 1));
  std::vector<Term> kept;
  for (auto element = elements.rbegin(); element != elements.rend(); ++element) {
    if (seen.InsertIsNew(*element)) kept.push_back(*element);
  }
  std::reverse(kept.begin(), kept.end());
  return MakeBoundedList(call, kept);
}

/// The elements of the first list that are (or are not) in the second.
template <bool wanted>
Term Filter(const Call& call) {
  const ValueSet second = SetOf(call, Elements(call, 1), TestAt(call, 2));
  std::vector<Term> kept;
  for (const Term element : Elements(call, 0)) {
    if (second.Has(element) == wanted) kept.push_back(element);
  }
  return MakeBoundedList(call, kept);
}

Term Union(const Call& call) {
  std::vector<Term> all = Elements(call, 0);
  const ValueSet first = SetOf(call, all, TestAt(call, 2));
  for (const Term element : Elements(call, 1)) {
    if (!first.Has(element)) all.push_back(element);
  }
  return MakeBoundedList(call, all);
}

bool IsSubset(const Call& call) {
  const ValueSet second = SetOf(call, Elements(call, 1), TestAt(call, 2));
  const std::vector<Term> first = Elements(call, 0);
  return std::all_of(first.begin(), first.end(), [&](Term value) { return second.Has(value); });
}

template <Sameness sameness>
bool AreSame(const Call& call) {
  const auto key = KeyUnder(sameness, call.terms, call[0]);
  return key && key == KeyUnder(sameness, call.terms, call[1]);
}

bool IsNil(const Call& call) { return call[0].IsNil(); }
bool IsPair(const Call& call) { return call[0].IsPair(); }
bool IsList(const Call& call) { return call[0].IsPair() || call[0].IsNil(); }
bool IsAtom(const Call& call) { return !call[0].IsPair(); }
bool IsNumber(const Call& call) { return call[0].IsNumber(); }
bool IsInteger(const Call& call) { return call[0].kind() == Term::Kind::kInteger; }
bool IsSymbol(const Call& call) { return call[0].kind() == Term::Kind::kSymbol; }
bool IsString(const Call& call) { return call[0].kind() == Term::Kind::kString; }

using Adder = Term (*)(const Call&);

void AddParts(Functions* functions) {
  const auto add = [&](const char* name, int least, int most, Adder function) {
    functions->Add(name, least, most, StandardFunction{name, function});
  };
  for (const char* name : {"car", "first"}) add(name, 1, 1, NthOf<0>);
  for (const char* name : {"cadr", "second"}) add(name, 1, 1, NthOf<1>);
  for (const char* name : {"caddr", "third"}) add(name, 1, 1, NthOf<2>);
  add("fourth", 1, 1, NthOf<3>);
  add("fifth", 1, 1, NthOf<4>);
  for (const char* name : {"cdr", "rest"}) add(name, 1, 1, Cdr);
  add("cddr", 1, 1, Cddr);
  add("caar", 1, 1, Caar);
  add("cdar", 1, 1, Cdar);
  add("nth", 2, 2, Nth);
  add("nthcdr", 2, 2, Nthcdr);
  add("last", 1, 2, Last);
  add("butlast", 1, 2, Butlast);
  add("length", 1, 1, Length);
}

void AddMakers(Functions* functions) {
  const auto add = [&](const char* name, int least, int most, Adder function) {
    functions->Add(name, least, most, StandardFunction{name, function});
  };
  add("list", 0, kAnyNumber, List);
  add("list*", 1, kAnyNumber, ListStar);
  add("cons", 2, 2, Cons);
  add("append", 0, kAnyNumber, Append);
  add("reverse", 1, 1, Reverse);
}

void AddSets(Functions* functions) {
  const auto add = [&](const char* name, int least, Adder function) {
    functions->Add(name, least, least + 2, StandardFunction{name, function});
  };
  add("member", 2, Member);
  add("assoc", 2, Assoc);
  add("find", 2, Find);
  add("position", 2, Position);
  add("count", 2, Count);
  add("remove", 2, Remove);
  add("remove-duplicates", 1, RemoveDuplicates);
  add("union", 2, Union);
  add("intersection", 2, Filter<true>);
  add("set-difference", 2, Filter<false>);
  functions->Add("subsetp", 2, 4, StandardPredicate{"subsetp", IsSubset});
}

}  // namespace

void AddListFunctions(Functions* functions) {
  AddParts(functions);
  AddMakers(functions);
  AddSets(functions);
}

void AddTests(Functions* functions) {
  const auto add = [&](const char* name, int arguments, bool (*predicate)(const Call&)) {
    functions->Add(name, arguments, arguments, StandardPredicate{name, predicate});
  };
  add("not", 1, IsNil);
  add("null", 1, IsNil);
  add("eq", 2, AreSame<Sameness::kEq>);
  add("eql", 2, AreSame<Sameness::kEql>);
  add("equal", 2, AreSame<Sameness::kEqual>);
  add("equalp", 2, AreSame<Sameness::kEqualp>);
  add("listp", 1, IsList);
  add("consp", 1, IsPair);
  add("atom", 1, IsAtom);
  add("numberp", 1, IsNumber);
  add("integerp", 1, IsInteger);
  add("symbolp", 1, IsSymbol);
  add("stringp", 1, IsString);
}

}  // namespace hires::planning
