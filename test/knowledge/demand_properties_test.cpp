#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <map>
#include <string>
#include <vector>

#include "hires/base/text.h"
#include "hires/knowledge/demand.h"
#include "knowledge/support/random_world.h"
#include "support/property.h"

namespace hires::knowledge::demand_properties_test {
namespace {

using test_support::At;
using test_support::Pick;
using test_support::PickFluent;
using test_support::PickName;
using test_support::RestaurantOntology;

constexpr test_support::PropertyCases kPropertyCases{60};

DemandTopic Topic(std::vector<std::string> below, std::vector<std::string> queries) {
  DemandTopic topic;
  topic.name = "wanted";
  topic.below = std::move(below);
  topic.queries = std::move(queries);
  return topic;
}

/// One topic of every kind that `Demand` treats in another way.
std::vector<DemandTopic> Topics() {
  DemandTopic with_box = Topic({"Area", "Mug"}, {});
  with_box.properties = {"hasBoundingBox"};
  return {
      Topic({"Area"}, {}),
      with_box,
      // decided by concept, by concept and properties
      Topic({}, {"select ?x {{?x a race:Mug} union {?x a ?c. ?c rdfs:subClassOf+ upper:Area}}"}),
      Topic({}, {"select ?x {?x upper:hasBoundingBox ?b; a ?c. ?c rdfs:subClassOf* upper:Area}"}),
      // links lead from the instance
      Topic({}, {"select ?x {?x upper:hasBoundingBox ?b. ?b upper:hasPose ?p. ?p upper:hasZ 0}"}),
      Topic({"Book"}, {"select ?x {?x a upper:On; upper:hasPhysicalEntity ?y; upper:hasArea ?z. "
                       "{?y a race:Mug} union {?z a race:FloorArea; upper:hasBoundingBox ?b. "
                       "?b a upper:BoundingBox}}"}),
      Topic({}, {"select ?x {?x upper:hasBoundingBox ?x}"}),
      // links lead to it, or both ways
      Topic({}, {"select ?x {?on a upper:On; upper:hasPhysicalEntity ?x}"}),
      Topic({}, {"select ?x {?x upper:hasBoundingBox ?b. ?y upper:hasBoundingBox ?b; a race:Mug}"}),
      Topic({}, {"select ?x {race:n1 upper:hasPose ?x}", "select ?x {?x a race:Mug}"}),
      Topic({}, {"select ?x {{?x a race:FloorArea} union {?o upper:hasArea ?x. ?o "
                 "upper:hasPhysicalEntity ?m. ?m a race:Mug}}"}),
      // nothing joins: one pose anywhere decides about all mugs
      Topic({}, {"select ?x {?x a race:Mug. ?p upper:hasZ 1}"}),
  };
}

/// A reader of a topic, who goes by its messages alone.
struct Reader {
  std::map<std::string, Fluent> set;  // by name in lower case
  std::uint64_t last{0};

  void Read(const DemandUpdate& update) {
    if (!update.snapshot) {
      RC_ASSERT(update.previous == last);
      RC_ASSERT(update.last_sequence > last);
      RC_ASSERT(update.first_sequence == update.changes.front().sequence);
    }
    std::uint64_t sequence = 0;
    for (const Change& change : update.changes) {
      RC_ASSERT(change.sequence >= sequence);
      RC_ASSERT(update.snapshot || change.sequence > last);
      RC_ASSERT(change.sequence <= update.last_sequence);
      sequence = change.sequence;
      Take(change);
    }
    last = update.last_sequence;
  }

  void Take(const Change& change) {
    const std::string key = base::ToLower(change.fluent.instance);
    RC_ASSERT((set.count(key) > 0) == (change.kind != Change::Kind::kAdded));
    set.erase(key);
    if (change.kind != Change::Kind::kRemoved) set.emplace(key, change.fluent);
  }
};

std::map<std::string, Fluent> Fresh(const DemandTopic& topic, const Store& store) {
  Reader reader;
  reader.Read(Demand(topic, RestaurantOntology()).Snapshot(store));
  return reader.set;
}

std::vector<Fluent> PickFluents() {
  std::vector<Fluent> fluents;
  for (int i = Pick(4); i >= 0; --i) fluents.push_back(PickFluent(PickName()));
  return fluents;
}

std::vector<Change> PickTransaction(double time, Store* store) {
  const std::string name = PickName();
  if (Pick(3) > 0 || !store->Find(name)) return store->Add(PickFluents(), At(time));
  return store->Remove({name}, At(time));
}

class DemandProperty : public ::testing::TestWithParam<DemandTopic> {};

std::string NamesOf(const std::map<std::string, Fluent>& set) {
  std::string names;
  for (const auto& [key, fluent] : set) names += key + " ";
  return names;
}

void CheckAgainstFreshSnapshots(const DemandTopic& topic) {
  Store store(":memory:", RestaurantOntology());
  store.Add(PickFluents(), At(0.0));
  Demand demand(topic, RestaurantOntology());
  Reader reader;
  reader.Read(demand.Snapshot(store));
  for (int i = 1; i <= 15; ++i) {
    const DemandUpdate update = demand.Apply(PickTransaction(i, &store), store);
    if (!update.changes.empty()) reader.Read(update);
    const std::map<std::string, Fluent> fresh = Fresh(topic, store);
    RC_LOG() << "transaction " << i << ": has " << NamesOf(reader.set) << ", wants "
             << NamesOf(fresh) << "\n";
    RC_ASSERT(reader.set == fresh);
  }
}

TEST_P(DemandProperty, MessagesFromASnapshotOnGiveWhatAFreshSnapshotGives) {
  test_support::CheckProperty(kPropertyCases, [] { CheckAgainstFreshSnapshots(GetParam()); });
}

std::string NameOfCase(const ::testing::TestParamInfo<DemandTopic>& info) {
  return "Topic" + std::to_string(info.index);
}

INSTANTIATE_TEST_SUITE_P(EveryKind, DemandProperty, ::testing::ValuesIn(Topics()), &NameOfCase);

}  // namespace
}  // namespace hires::knowledge::demand_properties_test
