#include "hires/planning/fact_history.h"

#include "hires/base/check.h"

namespace hires::planning {
namespace {

const std::vector<int> kNone;

/// Name of the predicate, "" where it is not known.
std::string PredicateKey(const Datum& atom) {
  if (atom.kind == Datum::Kind::kSymbol) return atom.text;
  return std::string(atom.Head());
}

/// Predicate and first argument where that is a constant, else "".
std::string FirstArgumentKey(const Datum& atom) {
  if (atom.items.size() < 2 || atom.Head().empty()) return "";
  const Datum& first = atom.items[1];
  if (first.IsList() || first.kind == Datum::Kind::kVariable) return "";
  return atom.items[0].text + '\n' + ToString(first);
}

const std::vector<int>& Find(const std::unordered_map<std::string, std::vector<int>>& index,
                             const std::string& key) {
  const auto found = index.find(key);
  return found == index.end() ? kNone : found->second;
}

}  // namespace

bool FactHistory::Add(const Datum& atom, int moment) {
  HIRES_CHECK(IsGround(atom), "the fact " + ToString(atom) + " has variables");
  const int index = static_cast<int>(entries_.size());
  const auto [latest, is_new] = latest_.emplace(ToString(atom), index);
  if (!is_new && entries_[latest->second].HoldsAt(moment)) return false;
  latest->second = index;
  Entry entry;
  entry.atom = atom;
  entry.from = moment;
  entries_.push_back(std::move(entry));
  all_.push_back(index);
  by_predicate_[PredicateKey(atom)].push_back(index);
  const std::string key = FirstArgumentKey(atom);
  if (!key.empty()) by_first_argument_[key].push_back(index);
  return true;
}

bool FactHistory::Remove(const Datum& atom, int moment) {
  const auto latest = latest_.find(ToString(atom));
  if (latest == latest_.end() || !entries_[latest->second].HoldsAt(moment)) return false;
  entries_[latest->second].until = moment;
  return true;
}

bool FactHistory::Holds(const Datum& atom, int moment) const {
  for (const int index : Candidates(atom)) {
    if (entries_[index].HoldsAt(moment) && entries_[index].atom == atom) return true;
  }
  return false;
}

std::vector<Datum> FactHistory::FactsAt(int moment) const {
  std::vector<Datum> facts;
  for (const Entry& entry : entries_) {
    if (entry.HoldsAt(moment)) facts.push_back(entry.atom);
  }
  return facts;
}

const std::vector<int>& FactHistory::Candidates(const Datum& pattern) const {
  const std::string predicate = PredicateKey(pattern);
  if (predicate.empty()) return all_;
  const std::string key = FirstArgumentKey(pattern);
  return key.empty() ? Find(by_predicate_, predicate) : Find(by_first_argument_, key);
}

}  // namespace hires::planning
