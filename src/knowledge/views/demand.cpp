#include "hires/knowledge/demand.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_set>
#include <utility>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "knowledge/views/demand_filter.h"
#include "knowledge/views/store_view.h"

namespace hires::knowledge {
namespace {

/// Instances whose membership has to be looked at, by name in lower case, each with the change that
/// makes it so: its own if it has one, else the last that reaches it.
struct Candidate {
  const Change* change{nullptr};
  bool is_own{false};
};
using Candidates = std::map<std::string, Candidate>;
/// What a query selects, in lower case; only of those that were asked as a whole.
using Selections = std::map<const QueryFilter*, std::set<std::string>>;

void Note(const std::string& key, const Change& change, bool is_own, Candidates* candidates) {
  Candidate& candidate = (*candidates)[key];
  if (candidate.is_own && !is_own) return;
  candidate = {&change, is_own};
}

/// Those that link to `key` over the chain of roles, in lower case.
std::set<std::string> GoBack(const StoreView& view, const std::string& key,
                             const std::vector<std::string>& chain) {
  std::set<std::string> reached{key};
  for (auto role = chain.rbegin(); role != chain.rend(); ++role) {
    std::set<std::string> linking;
    for (const std::string& name : reached) {
      view.WithFiller(*role, name, [&](const Fluent& fluent) {
        linking.insert(base::ToLower(fluent.instance));
        return true;
      });
    }
    reached = std::move(linking);
  }
  return reached;
}

bool IsEmpty(const DemandTopic& topic) {
  return topic.exact.empty() && topic.below.empty() && topic.above.empty() &&
         topic.properties.empty() && topic.queries.empty();
}

}  // namespace

struct Demand::Implementation {
  Implementation(const DemandTopic& topic, std::shared_ptr<const Ontology> the_ontology);

  template <typename Function>
  auto Named(const Function& function) const -> decltype(function());

  DemandUpdate Snapshot(const Store& store);
  std::map<std::string, Fluent> Collect(const Store& store) const;
  DemandUpdate Apply(const std::vector<Change>& changes, const Store& store);
  std::vector<const Change*> News(const std::vector<Change>& changes) const;
  void ApplyOne(const Change& change, DemandUpdate* update);
  void ApplyTogether(const std::vector<const Change*>& changes, const Store& store,
                     DemandUpdate* update);
  Candidates FindCandidates(const std::vector<const Change*>& changes, const StoreView& view,
                            Selections* selections);
  void NoteDifference(const std::set<std::string>& selected, const Change& change,
                      Candidates* candidates) const;
  void Trace(const QueryFilter& query, const Change& change, const StoreView& view,
             Candidates* candidates) const;
  void Tell(const std::string& key, const Candidate& candidate, bool matches, const Fluent* fluent,
            DemandUpdate* update);
  bool Matches(const Fluent& fluent, const FluentView& view, const Selections& selections) const;
  /// Keeps whether it is a member, and what that is called. Nothing if it was none and is none.
  std::optional<Change::Kind> Move(const std::string& key, bool matches);

  std::string name;
  std::shared_ptr<const Ontology> ontology;
  std::optional<FluentFilter> filter;
  std::vector<QueryFilter> queries;
  bool is_local{true};  // no fluent enters or leaves by a change of another one
  bool is_ready{false};
  std::unordered_set<std::string> members;  // in lower case
  std::uint64_t looked_at{0};               // sequence of the last change that `members` knows of
  std::uint64_t told{0};                    // last_sequence of the last message
};

template <typename Function>
auto Demand::Implementation::Named(const Function& function) const -> decltype(function()) {
  try {
    return function();
  } catch (const base::ConfigError& error) {
    throw base::ConfigError(fmt::format("topic '{}': {}", name, error.what()));
  }
}

Demand::Implementation::Implementation(const DemandTopic& topic,
                                       std::shared_ptr<const Ontology> the_ontology)
    : name(topic.name), ontology(std::move(the_ontology)) {
  if (name.empty()) throw base::ConfigError("a topic without a name; wanted one below blackboard/");
  Named([&] {
    if (IsEmpty(topic)) {
      throw base::ConfigError(
          "no filter; wanted at least one of ClassFilter, SubclassFilter, "
          "SuperclassFilter, PropertyFilter, QueryFilter");
    }
    filter.emplace(topic, *ontology);
    for (const std::string& text : topic.queries) queries.emplace_back(text, ontology);
  });
  is_local = std::all_of(queries.begin(), queries.end(),
                         [](const QueryFilter& query) { return query.reach().is_local; });
}

bool Demand::Implementation::Matches(const Fluent& fluent, const FluentView& view,
                                     const Selections& selections) const {
  const Ontology::ConceptId concept_id = ontology->Find(fluent.concept_name);
  return filter->Matches(fluent, concept_id) ||
         std::any_of(queries.begin(), queries.end(), [&](const QueryFilter& query) {
           const auto selected = selections.find(&query);
           if (selected == selections.end()) return query.Matches(fluent, concept_id, view);
           return selected->second.count(base::ToLower(fluent.instance)) > 0;
         });
}

std::map<std::string, Fluent> Demand::Implementation::Collect(const Store& store) const {
  std::map<std::string, Fluent> matching;
  const StoreView view(store);
  if (filter->is_given()) {
    view.ForEach(filter->query(), [&](const Fluent& fluent) {
      matching.emplace(base::ToLower(fluent.instance), fluent);
      return true;
    });
  }
  for (const QueryFilter& query : queries) {
    for (const std::string& instance : query.Instances(view)) {
      const Fluent* fluent = view.Find(instance);
      if (fluent != nullptr) matching.emplace(base::ToLower(instance), *fluent);
    }
  }
  return matching;
}

DemandUpdate Demand::Implementation::Snapshot(const Store& store) {
  const std::uint64_t sequence = store.last_sequence();
  DemandUpdate update;
  update.snapshot = true;
  update.previous = told;
  std::map<std::string, Fluent> matching = Collect(store);
  for (QueryFilter& query : queries) query.FindParts(StoreView(store));
  members.clear();
  for (auto& [key, fluent] : matching) {
    Change change;
    change.time = fluent.start.earliest;
    change.fluent = std::move(fluent);
    members.insert(key);
    update.changes.push_back(std::move(change));
  }
  if (!is_ready || sequence != looked_at) looked_at = told = sequence;
  is_ready = true;
  update.last_sequence = told;
  return update;
}

std::vector<const Change*> Demand::Implementation::News(const std::vector<Change>& changes) const {
  std::vector<const Change*> news;
  for (const Change& change : changes) {
    const bool is_real = change.label == Episode::Label::kReal;
    if (is_real && change.sequence > looked_at) news.push_back(&change);
  }
  return news;
}

DemandUpdate Demand::Implementation::Apply(const std::vector<Change>& changes, const Store& store) {
  HIRES_CHECK(is_ready, "Demand::Apply before the first Snapshot of topic '" + name + "'");
  DemandUpdate update;
  update.previous = told;
  const std::vector<const Change*> news = News(changes);
  if (is_local) {
    for (const Change* change : news) ApplyOne(*change, &update);
  } else if (!news.empty()) {
    ApplyTogether(news, store, &update);
  }
  if (!changes.empty()) looked_at = std::max(looked_at, changes.back().sequence);
  update.last_sequence = looked_at;
  if (update.changes.empty()) return update;
  update.first_sequence = update.changes.front().sequence;
  told = looked_at;
  return update;
}

std::optional<Change::Kind> Demand::Implementation::Move(const std::string& key, bool matches) {
  if (!matches) {
    if (members.erase(key) == 0) return std::nullopt;
    return Change::Kind::kRemoved;
  }
  return members.insert(key).second ? Change::Kind::kAdded : Change::Kind::kUpdated;
}

/// No store is asked: the fluent says it all.
void Demand::Implementation::ApplyOne(const Change& change, DemandUpdate* update) {
  class NoView : public FluentView {
    const Fluent* Find(const std::string&) const override { return nullptr; }
    void OfConcept(const std::string&, const std::function<bool(const Fluent&)>&) const override {}
    void All(const std::function<bool(const Fluent&)>&) const override {}
    void WithFiller(const std::string&, const Filler&,
                    const std::function<bool(const Fluent&)>&) const override {}
  };
  const bool matches =
      change.kind != Change::Kind::kRemoved && Matches(change.fluent, NoView(), {});
  const auto kind = Move(base::ToLower(change.fluent.instance), matches);
  if (!kind) return;
  update->changes.push_back(change);
  update->changes.back().kind = *kind;
}

void Demand::Implementation::ApplyTogether(const std::vector<const Change*>& changes,
                                           const Store& store, DemandUpdate* update) {
  StoreView view(store);
  for (const Change* change : changes) view.Remember(*change);
  // All questions first: where one of them throws, nothing has moved.
  std::vector<bool> matching;
  Selections selections;
  const Candidates candidates = FindCandidates(changes, view, &selections);
  for (const auto& [key, candidate] : candidates) {
    const Fluent* fluent = view.Find(key);
    matching.push_back(fluent != nullptr && Matches(*fluent, view, selections));
  }
  auto matches = matching.begin();
  for (const auto& [key, candidate] : candidates) {
    Tell(key, candidate, *matches++, view.Find(key), update);
  }
  std::stable_sort(update->changes.begin(), update->changes.end(),
                   [](const Change& a, const Change& b) { return a.sequence < b.sequence; });
}

Candidates Demand::Implementation::FindCandidates(const std::vector<const Change*>& changes,
                                                  const StoreView& view, Selections* selections) {
  Candidates candidates;
  for (const Change* change : changes) {
    Note(base::ToLower(change->fluent.instance), *change, true, &candidates);
    for (const QueryFilter& query : queries) Trace(query, *change, view, &candidates);
  }
  for (QueryFilter& query : queries) {
    const Change* last = nullptr;
    for (const Change* change : changes) {
      if (query.NoticePart(*change)) last = change;
    }
    if (last == nullptr) continue;
    std::set<std::string>& selected = (*selections)[&query];
    for (const std::string& name : query.Instances(view)) selected.insert(base::ToLower(name));
    NoteDifference(selected, *last, &candidates);
  }
  return candidates;
}

void Demand::Implementation::NoteDifference(const std::set<std::string>& selected,
                                            const Change& change, Candidates* candidates) const {
  for (const std::string& key : members) {
    if (selected.count(key) == 0) Note(key, change, false, candidates);
  }
  for (const std::string& key : selected) {
    if (members.count(key) == 0) Note(key, change, false, candidates);
  }
}

void Demand::Implementation::Trace(const QueryFilter& query, const Change& change,
                                   const StoreView& view, Candidates* candidates) const {
  const std::string key = base::ToLower(change.fluent.instance);
  for (const std::vector<std::string>& chain : query.reach().chains) {
    for (const std::string& root : GoBack(view, key, chain)) Note(root, change, false, candidates);
  }
}

void Demand::Implementation::Tell(const std::string& key, const Candidate& candidate, bool matches,
                                  const Fluent* fluent, DemandUpdate* update) {
  const auto kind = Move(key, matches);
  if (!kind || (*kind == Change::Kind::kUpdated && !candidate.is_own)) return;
  Change change = *candidate.change;
  change.kind = *kind;
  if (!candidate.is_own) {
    change.fluent = fluent != nullptr ? *fluent : Fluent();
    if (fluent == nullptr) change.fluent.instance = key;  // only if the store is ahead
  }
  update->changes.push_back(std::move(change));
}

Demand::Demand(const DemandTopic& topic, std::shared_ptr<const Ontology> ontology)
    : implementation_(std::make_unique<Implementation>(topic, std::move(ontology))) {}
Demand::Demand(Demand&&) noexcept = default;
Demand& Demand::operator=(Demand&&) noexcept = default;
Demand::~Demand() = default;

const std::string& Demand::name() const { return implementation_->name; }

DemandUpdate Demand::Snapshot(const Store& store) {
  return implementation_->Named([&] { return implementation_->Snapshot(store); });
}

DemandUpdate Demand::Apply(const std::vector<Change>& changes, const Store& store) {
  return implementation_->Named([&] { return implementation_->Apply(changes, store); });
}

}  // namespace hires::knowledge
