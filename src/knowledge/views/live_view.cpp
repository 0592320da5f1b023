#include "hires/knowledge/live_view.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>

#include "hires/base/text.h"
#include "knowledge/state/live_view_match.h"

namespace hires::knowledge {

/// Orders what a live view holds by its instance, in lower case.
struct LiveEntryLess {
  using Entry = std::map<std::string, Fluent>::const_pointer;
  bool operator()(Entry a, Entry b) const { return a->first < b->first; }
};

namespace {

using Visit = std::function<bool(const Fluent&)>;
using Entries = std::map<std::string, Fluent>;  // by lower-case instance
using Entry = LiveEntryLess::Entry;
using EntrySet = std::set<Entry, LiveEntryLess>;
using Index = std::unordered_map<std::string, EntrySet>;

/// What the index knows of a property: all numbers of a role are one.
std::string KeyOf(const std::string& role, const Filler& filler) {
  constexpr char kEndOfRole = '\0';
  if (const auto* text = std::get_if<std::string>(&filler)) {
    return role + kEndOfRole + "text " + base::ToLower(*text);
  }
  if (const bool* truth = std::get_if<bool>(&filler)) {
    return role + kEndOfRole + (*truth ? "true" : "false");
  }
  return role + kEndOfRole + "number";
}

bool HasSameKey(const Property& a, const Property& b) {
  if (a.role != b.role) return false;
  return (IsNumber(a.filler) && IsNumber(b.filler)) || SameFiller(a.filler, b.filler);
}

/// Looks first where the property stands in the other fluent, for most changes keep the order.
bool HasKeyOf(const Fluent& fluent, const Property& property, std::size_t place) {
  const auto& all = fluent.properties;
  if (place < all.size() && HasSameKey(all[place], property)) return true;
  return std::any_of(all.begin(), all.end(),
                     [&](const Property& other) { return HasSameKey(other, property); });
}

bool Has(const Fluent& fluent, const std::string& role, const Filler& filler) {
  return std::any_of(fluent.properties.begin(), fluent.properties.end(),
                     [&](const Property& property) {
                       return property.role == role && SameFiller(property.filler, filler);
                     });
}

void Erase(const std::string& key, Entry entry, Index* index) {
  const auto found = index->find(key);
  if (found == index->end()) return;  // a role that is given twice with one filler
  found->second.erase(entry);
  if (found->second.empty()) index->erase(found);
}

void VisitSome(const Index& index, const std::string& key, const Visit& visit) {
  const auto found = index.find(key);
  if (found == index.end()) return;
  for (const Entry entry : found->second) {
    if (!visit(entry->second)) return;
  }
}

}  // namespace

struct LiveView::Implementation {
  void Read(const Store& store, FluentQuery query) {
    query.limit = 10000;
    do {
      FluentPage page = store.Query(query);
      for (Fluent& fluent : page.fluents) Put(std::move(fluent));
      sequence = page.sequence;
      query.cursor = page.next;
    } while (!query.cursor.empty());
  }

  void Put(Fluent fluent) {
    const auto [place, is_new] = entries.try_emplace(base::ToLower(fluent.instance));
    const Fluent old = std::exchange(place->second, std::move(fluent));
    if (!is_new) Forget(&*place, old, place->second);
    Note(&*place, old);
  }

  void Remove(const std::string& instance) {
    const auto place = entries.find(base::ToLower(instance));
    if (place == entries.end()) return;
    Forget(&*place, place->second, Fluent());
    entries.erase(place);
  }

  /// Takes the entry out of where `old` was and `fluent` is not.
  void Forget(Entry entry, const Fluent& old, const Fluent& fluent) {
    if (old.concept_name != fluent.concept_name) Erase(old.concept_name, entry, &by_concept);
    for (std::size_t i = 0; i < old.properties.size(); ++i) {
      const Property& property = old.properties[i];
      if (HasKeyOf(fluent, property, i)) continue;
      Erase(KeyOf(property.role, property.filler), entry, &by_filler);
    }
  }

  /// Puts the entry where `old` was not.
  void Note(Entry entry, const Fluent& old) {
    const Fluent& fluent = entry->second;
    if (old.concept_name != fluent.concept_name) by_concept[fluent.concept_name].insert(entry);
    for (std::size_t i = 0; i < fluent.properties.size(); ++i) {
      const Property& property = fluent.properties[i];
      if (HasKeyOf(old, property, i)) continue;
      by_filler[KeyOf(property.role, property.filler)].insert(entry);
    }
  }

  Entries entries;
  Index by_concept, by_filler;
  std::uint64_t sequence{0};
};

LiveView::LiveView(const Store& store) : implementation_(std::make_unique<Implementation>()) {
  implementation_->Read(store, FluentQuery());
}

LiveView::LiveView(const Store& store, double at)
    : implementation_(std::make_unique<Implementation>()) {
  FluentQuery query;
  query.time.kind = FluentQuery::TimeFilter::Kind::kAt;
  query.time.at = at;
  implementation_->Read(store, query);
}

LiveView::LiveView(std::vector<Fluent> fluents, std::uint64_t sequence)
    : implementation_(std::make_unique<Implementation>()) {
  for (Fluent& fluent : fluents) implementation_->Put(std::move(fluent));
  implementation_->sequence = sequence;
}

LiveView::LiveView(LiveView&&) noexcept = default;
LiveView& LiveView::operator=(LiveView&&) noexcept = default;
LiveView::~LiveView() = default;

void LiveView::Apply(const Change& change) {
  if (change.sequence <= implementation_->sequence) return;
  implementation_->sequence = change.sequence;
  if (change.label == Episode::Label::kImagined) return;
  if (change.kind == Change::Kind::kRemoved) {
    implementation_->Remove(change.fluent.instance);
  } else {
    implementation_->Put(change.fluent);
  }
}

std::uint64_t LiveView::sequence() const { return implementation_->sequence; }
std::size_t LiveView::size() const { return implementation_->entries.size(); }

const Fluent* LiveView::Find(const std::string& instance) const {
  const auto place = implementation_->entries.find(base::ToLower(instance));
  return place == implementation_->entries.end() ? nullptr : &place->second;
}

void LiveView::OfConcept(const std::string& concept_name, const Visit& visit) const {
  VisitSome(implementation_->by_concept, concept_name, visit);
}

void LiveView::All(const Visit& visit) const {
  for (const auto& [name, fluent] : implementation_->entries) {
    if (!visit(fluent)) return;
  }
}

void LiveView::WithFiller(const std::string& role, const Filler& filler, const Visit& visit) const {
  const std::string key = KeyOf(role, filler);
  if (!IsNumber(filler)) return VisitSome(implementation_->by_filler, key, visit);
  VisitSome(implementation_->by_filler, key,
            [&](const Fluent& fluent) { return !Has(fluent, role, filler) || visit(fluent); });
}

}  // namespace hires::knowledge
