// The store against a list in memory that does the same in the most obvious way: after any sequence
// of writes, the state of every moment, the changes, and the answers to queries agree.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/knowledge/store.h"
#include "knowledge/support/store_world.h"
#include "support/property.h"

namespace hires::knowledge::store_properties_test {
namespace {

using temporal::Bounds;
using temporal::kForever;
using test_support::At;
using test_support::Ever;
using test_support::HoldsAt;
using test_support::MakeFluent;
using test_support::QueryAll;
using test_support::SmallOntology;

constexpr test_support::PropertyCases kPropertyCases{300};

const std::vector<std::string> kNames = {"mug1", "Mug2", "MUG1", "vase1", "a"};

struct Step {
  enum class Kind { kAdd, kUpdate, kRemove };
  Kind kind{Kind::kAdd};
  int name{0};
  bool is_vase{false};
  int count{0};  // of hasCount; 0: no such property
  std::string colour;
  double time{0.0};             // [s] of the assertion, after the step before
  std::optional<Bounds> start;  // relative to the assertion
  std::optional<Bounds> finish;
  bool imagined{false};
};

void showValue(const Step& step, std::ostream& out) {
  out << "kind " << static_cast<int>(step.kind) << " " << kNames[step.name] << " vase "
      << step.is_vase << " count " << step.count << " colour '" << step.colour << "' time "
      << step.time << " imagined " << step.imagined;
  if (step.start) out << " start " << step.start->earliest << ".." << step.start->latest;
  if (step.finish) out << " finish " << step.finish->earliest << ".." << step.finish->latest;
  out << "\n";
}

/// Any of from, ..., to - 1; `inRange` alone keeps to the low ones in small cases.
rc::Gen<int> Any(int from, int to) {
  return rc::gen::resize(rc::kNominalSize, rc::gen::inRange(from, to));
}

rc::Gen<std::optional<Bounds>> SomeBounds(int from, int to) {
  const auto bounds =
      rc::gen::map(rc::gen::pair(Any(from, to), Any(0, 3)), [](const std::pair<int, int>& ends) {
        return std::make_optional(Bounds{1.0 * ends.first, 1.0 * ends.first + ends.second});
      });
  return rc::gen::weightedOneOf<std::optional<Bounds>>(
      {{4, rc::gen::just(std::optional<Bounds>())}, {1, bounds}});
}

rc::Gen<Step> AnyStep() {
  using Kind = Step::Kind;
  return rc::gen::build<Step>(
      rc::gen::set(&Step::kind, rc::gen::weightedElement<Kind>(
                                    {{4, Kind::kAdd}, {2, Kind::kUpdate}, {2, Kind::kRemove}})),
      rc::gen::set(&Step::name, Any(0, static_cast<int>(kNames.size()))),
      rc::gen::set(&Step::is_vase, rc::gen::element(false, false, true)),
      rc::gen::set(&Step::count, Any(0, 3)),
      rc::gen::set(&Step::colour, rc::gen::element<std::string>("", "red", "Blue")),
      rc::gen::set(&Step::time, rc::gen::element(0.0, 1.0, 2.0, 5.0, -1.0)),
      rc::gen::set(&Step::start, SomeBounds(-3, 3)), rc::gen::set(&Step::finish, SomeBounds(-1, 8)),
      rc::gen::set(&Step::imagined, rc::gen::element(false, false, false, true)));
}

std::vector<Property> PropertiesOf(const Step& step) {
  std::vector<Property> properties;
  if (step.count != 0) {
    properties.push_back({"hasCount", "xsd:int", static_cast<std::int64_t>(step.count)});
  }
  if (!step.colour.empty()) properties.push_back({"hasColour", "xsd:string", step.colour});
  return properties;
}

Fluent FluentOf(const Step& step, double now) {
  Fluent fluent = MakeFluent(step.is_vase ? "Vase" : "Mug", kNames[step.name], PropertiesOf(step));
  if (step.start) fluent.start = {now + step.start->earliest, now + step.start->latest};
  if (step.finish) fluent.finish = {now + step.finish->earliest, now + step.finish->latest};
  return fluent;
}

/// The obvious way.
class Model {
 public:
  struct Row {
    Fluent fluent;
    Bounds given;
    bool imagined{false};
    bool open{true};
    std::size_t order{0};
  };

  /// False where the step is an error.
  bool Apply(const Step& step, double now) {
    Row* last = Last(step);
    if (step.kind == Step::Kind::kRemove) return Remove(last, now);
    if (step.kind == Step::Kind::kUpdate && (last == nullptr || !last->open)) return false;
    Row row;
    row.fluent = FluentOf(step, now);
    row.imagined = step.imagined;
    row.fluent.instance = Spelling(row.fluent.instance);
    row.given = row.fluent.finish;
    if (step.kind == Step::Kind::kUpdate) Merge(last->fluent.properties, &row.fluent);
    if (!step.start) row.fluent.start = {now, now};
    return Put(std::move(row), last, now);
  }

  const std::vector<Row>& rows() const { return rows_; }
  const std::vector<Change>& changes() const { return changes_; }

  template <typename Fits>
  std::vector<Fluent> Select(const Fits& fits) const {
    std::vector<const Row*> found;
    for (const Row& row : rows_) {
      if (fits(row)) found.push_back(&row);
    }
    std::sort(found.begin(), found.end(),
              [](const Row* a, const Row* b) { return Key(*a) < Key(*b); });
    std::vector<Fluent> fluents;
    for (const Row* row : found) fluents.push_back(row->fluent);
    return fluents;
  }

 private:
  static std::tuple<std::string, bool, double, std::size_t> Key(const Row& row) {
    return {base::ToLower(row.fluent.instance), row.imagined, row.fluent.start.earliest, row.order};
  }

  Row* Last(const Step& step) {
    for (auto row = rows_.rbegin(); row != rows_.rend(); ++row) {
      const bool same = base::ToLower(row->fluent.instance) == base::ToLower(kNames[step.name]);
      if (same && row->imagined == step.imagined) return &*row;
    }
    return nullptr;
  }

  std::string Spelling(const std::string& name) const {
    for (const Row& row : rows_) {
      if (base::ToLower(row.fluent.instance) == base::ToLower(name)) return row.fluent.instance;
    }
    return name;
  }

  static void Merge(const std::vector<Property>& old, Fluent* fluent) {
    std::vector<Property> given = fluent->properties;
    fluent->properties.clear();
    for (const Property& property : old) {
      const auto same = std::find_if(given.begin(), given.end(), [&](const Property& other) {
        return other.role == property.role;
      });
      fluent->properties.push_back(same == given.end() ? property : *same);
      if (same != given.end()) given.erase(same);
    }
    fluent->properties.insert(fluent->properties.end(), given.begin(), given.end());
  }

  void Tell(Change::Kind kind, const Row& row, double time) {
    Change change;
    change.sequence = changes_.size() + 1;
    change.kind = kind;
    change.fluent = row.fluent;
    change.time = time;
    change.label = row.imagined ? Episode::Label::kImagined : Episode::Label::kReal;
    changes_.push_back(change);
  }

  bool Remove(Row* last, double now) {
    if (last == nullptr || !last->open || now < last->fluent.start.earliest) return false;
    if (now <= last->fluent.finish.latest) last->fluent.finish = {now, now};
    last->open = false;
    Tell(Change::Kind::kRemoved, *last, now);
    return true;
  }

  bool Put(Row row, Row* last, double now) {
    const bool replaces = last != nullptr && last->open;
    const Bounds& start = row.fluent.start;
    if (replaces && last->fluent.concept_name == row.fluent.concept_name &&
        last->fluent.properties == row.fluent.properties && last->given == row.given) {
      return true;
    }
    const Bounds end{std::min(now, start.earliest), std::min(now, start.latest)};
    if (replaces && end.earliest < last->fluent.start.earliest) return false;
    if (last != nullptr && !replaces &&
        start.earliest < std::max(last->fluent.start.earliest, last->fluent.finish.earliest)) {
      return false;
    }
    if (start.earliest > row.fluent.finish.latest) return false;
    if (replaces && end.latest <= last->fluent.finish.latest) last->fluent.finish = end;
    if (replaces) last->open = false;
    row.order = rows_.size();
    Tell(replaces ? Change::Kind::kUpdated : Change::Kind::kAdded, row, start.earliest);
    rows_.push_back(std::move(row));
    return true;
  }

  std::vector<Row> rows_;
  std::vector<Change> changes_;
};

/// Store and model after the same steps.
class Both {
 public:
  Both() { episode_ = store.StartEpisode("imagine", Episode::Label::kImagined, 0, 0.0).id; }

  void Apply(const Step& step) {
    now_ += step.time;
    const bool possible = model.Apply(step, now_);
    const std::uint64_t before = store.last_sequence();
    std::vector<Change> told;
    bool done = true;
    try {
      told = Write(step);
    } catch (const base::ConfigError&) {
      done = false;
    }
    RC_ASSERT(done == possible);
    RC_ASSERT(store.last_sequence() == before + told.size());
    RC_ASSERT(store.last_sequence() == model.changes().size());
  }

  double now() const { return now_; }

  Model model;
  Store store{":memory:", SmallOntology()};

 private:
  std::vector<Change> Write(const Step& step) {
    const Assertion by = At(now_, step.imagined ? episode_ : 0);
    if (step.kind == Step::Kind::kRemove) return store.Remove({kNames[step.name]}, by);
    const Fluent fluent = FluentOf(step, now_);
    return step.kind == Step::Kind::kAdd ? store.Add({fluent}, by) : store.Update({fluent}, by);
  }

  std::int64_t episode_{0};
  double now_{0.0};
};

std::vector<Step> AnySteps() { return *rc::gen::container<std::vector<Step>>(AnyStep()); }

FluentQuery In(FluentQuery query, int worlds) {
  if (worlds == 1) query.label = Episode::Label::kImagined;
  if (worlds == 2) query.label.reset();
  return query;
}

bool IsIn(const Model::Row& row, int worlds) {
  return worlds == 2 || row.imagined == (worlds == 1);
}

/// The same query, instance by instance: another way through the file.
std::vector<Fluent> ByInstance(const Store& store, FluentQuery query) {
  std::vector<Fluent> all;
  for (const char* name : {"a", "mug1", "mug2", "vase1"}) {
    query.instance = name;
    for (Fluent& fluent : QueryAll(store, query)) all.push_back(std::move(fluent));
  }
  return all;
}

HIRES_PROPERTY(StoreProperties, TheStateOfEveryMomentIsRight, ()) {
  Both both;
  for (const Step& step : AnySteps()) both.Apply(step);
  const int worlds = *Any(0, 3);
  for (double at = -6.0; at < both.now() + 12.0; at += 0.5) {
    const auto holds = [&](const Model::Row& row) {
      return IsIn(row, worlds) && row.fluent.start.earliest <= at && at < row.fluent.finish.latest;
    };
    const std::vector<Fluent> expected = both.model.Select(holds);
    RC_ASSERT(QueryAll(both.store, In(HoldsAt(at), worlds)) == expected);
    RC_ASSERT(ByInstance(both.store, In(HoldsAt(at), worlds)) == expected);
  }
}

HIRES_PROPERTY(StoreProperties, NowAndEverAreRight, ()) {
  Both both;
  for (const Step& step : AnySteps()) both.Apply(step);
  const int worlds = *Any(0, 3);
  const auto open = [&](const Model::Row& row) { return row.open && IsIn(row, worlds); };
  RC_ASSERT(QueryAll(both.store, In(FluentQuery(), worlds)) == both.model.Select(open));
  RC_ASSERT(ByInstance(both.store, In(FluentQuery(), worlds)) == both.model.Select(open));
  const auto any = [&](const Model::Row& row) { return IsIn(row, worlds); };
  RC_ASSERT(QueryAll(both.store, In(Ever(), worlds)) == both.model.Select(any));
  FluentQuery vases = In(Ever(), worlds);
  vases.concepts = {{"Vase"}};
  const auto vase = [&](const Model::Row& row) {
    return IsIn(row, worlds) && row.fluent.concept_name == "Vase";
  };
  RC_ASSERT(QueryAll(both.store, vases) == both.model.Select(vase));
}

HIRES_PROPERTY(StoreProperties, ChangesAreRight, ()) {
  Both both;
  for (const Step& step : AnySteps()) both.Apply(step);
  const std::vector<Change> changes = both.store.ChangesSince(0, 1'000'000);
  RC_ASSERT(changes.size() == both.model.changes().size());
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const Change& told = both.model.changes()[i];
    RC_ASSERT(changes[i].sequence == i + 1);
    RC_ASSERT(changes[i].kind == told.kind);
    RC_ASSERT(changes[i].fluent == told.fluent);
    RC_ASSERT(changes[i].time == told.time);
    RC_ASSERT(changes[i].label == told.label);
  }
}

HIRES_PROPERTY(StoreProperties, AllensRelationsAreRight, ()) {
  using temporal::Allen;
  Both both;
  for (const Step& step : AnySteps()) both.Apply(step);
  FluentQuery query;
  query.time.kind = FluentQuery::TimeFilter::Kind::kAllen;
  const double start = *Any(-3, 20);
  query.time.interval = {start, start + *Any(1, 8)};
  for (int i = 0; i < temporal::kNumAllen; ++i) {
    query.time.relations = {static_cast<Allen>(i)};
    const auto stands = [&](const Model::Row& row) {
      const auto possible =
          PossibleRelations(row.fluent.start, row.fluent.finish, query.time.interval);
      return !row.imagined &&
             std::find(possible.begin(), possible.end(), static_cast<Allen>(i)) != possible.end();
    };
    query.instance.clear();
    RC_ASSERT(QueryAll(both.store, query) == both.model.Select(stands));
    RC_ASSERT(ByInstance(both.store, query) == both.model.Select(stands));
  }
}

HIRES_PROPERTY(StoreProperties, PropertiesAreRight, ()) {
  Both both;
  for (const Step& step : AnySteps()) both.Apply(step);
  const Property wanted = *rc::gen::element(
      Property{"hasCount", "xsd:int", std::int64_t{1}}, Property{"hasCount", "xsd:int", 2.0},
      Property{"hasColour", "xsd:string", std::string("blue")});
  const double at = *Any(-2, 30);
  const int worlds = *Any(0, 3);
  const bool only_vases = *rc::gen::element(false, true);
  const auto has = [&](const Model::Row& row) {
    if (!IsIn(row, worlds) || (only_vases && row.fluent.concept_name != "Vase")) return false;
    for (const Property& property : row.fluent.properties) {
      if (property.role != wanted.role) continue;
      if (property.filler == Filler(std::string("Blue"))) return wanted.role == "hasColour";
      if (wanted.filler == Filler(2.0)) return property.filler == Filler(std::int64_t{2});
      return property.filler == wanted.filler;
    }
    return false;
  };
  const auto ask = [&](FluentQuery query) {
    query.properties = {{wanted.role, wanted.filler}};
    if (only_vases) query.concepts = {{"Vase"}};
    return QueryAll(both.store, In(query, worlds));
  };
  RC_ASSERT(ask(Ever()) == both.model.Select(has));
  RC_ASSERT(ask(FluentQuery()) ==
            both.model.Select([&](const Model::Row& row) { return row.open && has(row); }));
  RC_ASSERT(ask(HoldsAt(at)) == both.model.Select([&](const Model::Row& row) {
    return row.fluent.start.earliest <= at && at < row.fluent.finish.latest && has(row);
  }));
}

HIRES_PROPERTY(StoreProperties, ConceptsAreRight, ()) {
  Both both;
  for (const Step& step : AnySteps()) both.Apply(step);
  const double at = *Any(-2, 30);
  const int worlds = *Any(0, 3);
  const auto vase = [&](const Model::Row& row) {
    return IsIn(row, worlds) && row.fluent.concept_name == "Vase";
  };
  const auto ask = [&](FluentQuery query) {
    query.concepts = {{"Vase"}};
    const std::vector<Fluent> found = QueryAll(both.store, In(query, worlds));
    RC_ASSERT(ByInstance(both.store, In(query, worlds)) == found);
    return found;
  };
  RC_ASSERT(ask(FluentQuery()) ==
            both.model.Select([&](const Model::Row& row) { return row.open && vase(row); }));
  RC_ASSERT(ask(HoldsAt(at)) == both.model.Select([&](const Model::Row& row) {
    return row.fluent.start.earliest <= at && at < row.fluent.finish.latest && vase(row);
  }));
}

HIRES_PROPERTY(StoreProperties, PagesShowTheFirstOnesMoment, ()) {
  Both both;
  for (const Step& step : AnySteps()) both.Apply(step);
  const double at = *Any(-2, 30);
  const int worlds = *Any(0, 3);
  const int filter = *Any(0, 3);
  for (FluentQuery query : {In(FluentQuery(), worlds), In(Ever(), worlds), In(HoldsAt(at), worlds),
                            In(HoldsAt(both.now()), worlds)}) {
    if (filter == 1) query.properties = {{"hasColour", Filler(std::string("blue"))}};
    if (filter == 2) query.concepts = {{"Mug"}};
    for (const char* instance : {"", "mug1"}) {
      query.instance = instance;
      query.limit = 1'000'000;
      query.cursor.clear();
      const std::vector<Fluent> whole = both.store.Query(query).fluents;
      query.limit = static_cast<std::size_t>(*Any(1, 4));
      std::vector<Fluent> paged;
      for (;;) {
        FluentPage page = both.store.Query(query);
        paged.insert(paged.end(), page.fluents.begin(), page.fluents.end());
        if (page.next.empty()) break;
        query.cursor = page.next;
        for (const Step& step : *rc::gen::container<std::vector<Step>>(3, AnyStep())) {
          both.Apply(step);
        }
      }
      RC_ASSERT(paged == whole);
    }
  }
}

}  // namespace
}  // namespace hires::knowledge::store_properties_test
