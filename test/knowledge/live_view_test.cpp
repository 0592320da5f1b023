#include "hires/knowledge/live_view.h"

#include <gmock/gmock.h>
#include <rapidcheck.h>

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "knowledge/support/store_world.h"
#include "support/property.h"

namespace hires::knowledge::live_view_test {
namespace {

using test_support::At;
using test_support::HoldsAt;
using test_support::MakeFluent;
using test_support::PoseAt;
using test_support::QueryAll;
using test_support::SmallOntology;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr test_support::PropertyCases kPropertyCases{200, 60};

std::vector<Fluent> Everything(const FluentView& view) {
  std::vector<Fluent> fluents;
  view.All([&](const Fluent& fluent) {
    fluents.push_back(fluent);
    return true;
  });
  return fluents;
}

std::vector<std::string> OfConcept(const FluentView& view, const std::string& concept_name) {
  std::vector<std::string> names;
  view.OfConcept(concept_name, [&](const Fluent& fluent) {
    names.push_back(fluent.instance);
    return true;
  });
  return names;
}

std::vector<std::string> WithFiller(const FluentView& view, const std::string& role,
                                    const Filler& filler) {
  std::vector<std::string> names;
  view.WithFiller(role, filler, [&](const Fluent& fluent) {
    names.push_back(fluent.instance);
    return true;
  });
  return names;
}

Fluent Mug(const std::string& instance, const std::string& colour) {
  return MakeFluent("Mug", instance, {{"hasColour", "xsd:string", colour}});
}

Change Added(const Fluent& fluent, std::uint64_t sequence,
             Episode::Label label = Episode::Label::kReal) {
  Change change;
  change.sequence = sequence;
  change.fluent = fluent;
  change.label = label;
  return change;
}

class LiveViewTest : public ::testing::Test {
 protected:
  void ApplyAll(const std::vector<Change>& changes) {
    for (const Change& change : changes) view_.Apply(change);
  }
  Store store_{":memory:", SmallOntology()};
  LiveView view_{store_};
};

TEST_F(LiveViewTest, IsEmptyOverAnEmptyStore) {
  EXPECT_EQ(view_.size(), 0u);
  EXPECT_EQ(view_.sequence(), 0u);
  EXPECT_EQ(view_.Find("mug1"), nullptr);
  EXPECT_THAT(Everything(view_), IsEmpty());
  EXPECT_THAT(OfConcept(view_, "Mug"), IsEmpty());
  EXPECT_THAT(WithFiller(view_, "hasX", 1.0), IsEmpty());
}

TEST_F(LiveViewTest, FindsByInstanceConceptAndFillerWithoutRegardToCase) {
  ApplyAll(store_.Add({Mug("mug1", "Red"), PoseAt("poseMug1", 1.0),
                       MakeFluent("On", "onMug1", {{"hasObject", "Mug", "mug1"}})},
                      At(1.0)));
  ASSERT_NE(view_.Find("MUG1"), nullptr);
  EXPECT_EQ(view_.Find("MUG1")->instance, "mug1");
  EXPECT_THAT(OfConcept(view_, "Mug"), ElementsAre("mug1"));
  EXPECT_THAT(OfConcept(view_, "Object"), IsEmpty()) << "exactly that concept";
  EXPECT_THAT(WithFiller(view_, "hasColour", "RED"), ElementsAre("mug1"));
  EXPECT_THAT(WithFiller(view_, "hasObject", "Mug1"), ElementsAre("onMug1"));
  EXPECT_THAT(WithFiller(view_, "hasArea", "Mug1"), IsEmpty());
}

TEST_F(LiveViewTest, NumbersAreTheSameWhateverTheirTypeAndTruthValuesAreNone) {
  constexpr std::int64_t kBig = (std::int64_t{1} << 53) + 1;  // no double is the same
  ApplyAll(
      store_.Add({MakeFluent("Mug", "a", {{"hasCount", "xsd:int", std::int64_t{1}}}),
                  PoseAt("p", 1.0), MakeFluent("Mug", "b", {{"isClean", "xsd:boolean", true}})},
                 At(1.0)));
  EXPECT_THAT(WithFiller(view_, "hasCount", 1.0), ElementsAre("a"));
  EXPECT_THAT(WithFiller(view_, "hasX", std::int64_t{1}), ElementsAre("p"));
  EXPECT_THAT(WithFiller(view_, "hasX", 1.5), IsEmpty());
  EXPECT_THAT(WithFiller(view_, "hasCount", true), IsEmpty());
  EXPECT_THAT(WithFiller(view_, "isClean", true), ElementsAre("b"));
  EXPECT_THAT(WithFiller(view_, "isClean", false), IsEmpty());
  EXPECT_THAT(WithFiller(view_, "isClean", std::int64_t{1}), IsEmpty());
  view_.Apply(Added(MakeFluent("Mug", "c", {{"hasCount", "xsd:integer", kBig}}), 4));
  EXPECT_THAT(WithFiller(view_, "hasCount", kBig), ElementsAre("c"));
  EXPECT_THAT(WithFiller(view_, "hasCount", kBig - 1), IsEmpty());
}

TEST_F(LiveViewTest, VisitsByNameWithoutRegardToCaseAndStopsWhenTold) {
  ApplyAll(store_.Add({Mug("b", "red"), Mug("A", "red"), Mug("C", "red")}, At(1.0)));
  EXPECT_THAT(OfConcept(view_, "Mug"), ElementsAre("A", "b", "C"));
  EXPECT_THAT(WithFiller(view_, "hasColour", "red"), ElementsAre("A", "b", "C"));
  std::vector<std::string> seen;
  const auto two = [&](const Fluent& fluent) {
    seen.push_back(fluent.instance);
    return seen.size() % 2 != 0;
  };
  view_.All(two);
  view_.OfConcept("Mug", two);
  view_.WithFiller("hasColour", "red", two);
  EXPECT_THAT(seen, ElementsAre("A", "b", "A", "b", "A", "b"));
}

TEST_F(LiveViewTest, AnUpdateTakesTheFluentOutOfWhereItWas) {
  ApplyAll(store_.Add({Mug("mug1", "red")}, At(1.0)));
  ApplyAll(
      store_.Add({MakeFluent("Vase", "mug1", {{"hasColour", "xsd:string", "blue"}})}, At(2.0)));
  EXPECT_THAT(OfConcept(view_, "Mug"), IsEmpty());
  EXPECT_THAT(OfConcept(view_, "Vase"), ElementsAre("mug1"));
  EXPECT_THAT(WithFiller(view_, "hasColour", "red"), IsEmpty());
  EXPECT_THAT(WithFiller(view_, "hasColour", "blue"), ElementsAre("mug1"));
  ApplyAll(store_.Remove({"mug1"}, At(3.0)));
  EXPECT_EQ(view_.size(), 0u);
  EXPECT_THAT(WithFiller(view_, "hasColour", "blue"), IsEmpty());
}

TEST_F(LiveViewTest, ARoleWithOneFillerTwiceIsForgottenAsAWhole) {
  const Property red{"hasColour", "xsd:string", "red"};
  view_.Apply(Added(MakeFluent("Mug", "mug1", {red, red}), 1));
  EXPECT_THAT(WithFiller(view_, "hasColour", "red"), ElementsAre("mug1"));
  view_.Apply(Added(MakeFluent("Mug", "mug1", {red}), 2));
  EXPECT_THAT(WithFiller(view_, "hasColour", "red"), ElementsAre("mug1")) << "one is left";
  view_.Apply(Added(MakeFluent("Mug", "mug1"), 3));
  EXPECT_THAT(WithFiller(view_, "hasColour", "red"), IsEmpty());
}

TEST_F(LiveViewTest, BeginsWithGivenFluentsAndGoesOnFromTheirChange) {
  LiveView view({Mug("mug2", "blue"), Mug("mug1", "red")}, 7);
  EXPECT_EQ(view.sequence(), 7u);
  EXPECT_THAT(OfConcept(view, "Mug"), ElementsAre("mug1", "mug2"));
  view.Apply(Added(Mug("mug1", "green"), 7));  // known already
  view.Apply(Added(Mug("mug2", "green"), 8));
  EXPECT_THAT(WithFiller(view, "hasColour", "red"), ElementsAre("mug1"));
  EXPECT_THAT(WithFiller(view, "hasColour", "green"), ElementsAre("mug2"));
}

TEST_F(LiveViewTest, ImaginedChangesAreIgnored) {
  const Episode episode = store_.StartEpisode("dream", Episode::Label::kImagined, 0, 1.0);
  ApplyAll(store_.Add({Mug("mug1", "red")}, At(2.0, episode.id)));
  EXPECT_EQ(view_.size(), 0u);
  EXPECT_EQ(view_.sequence(), 1u) << "it was looked at";
}

TEST_F(LiveViewTest, ChangesThatItKnowsAreIgnored) {
  const auto red = store_.Add({Mug("mug1", "red")}, At(1.0));
  const auto blue = store_.Add({Mug("mug1", "blue")}, At(2.0));
  LiveView view(store_);
  EXPECT_EQ(view.sequence(), 2u);
  view.Apply(red.front());
  EXPECT_EQ(view.Find("mug1")->properties, blue.front().fluent.properties);
}

TEST_F(LiveViewTest, ShowsWhatHeldAtATime) {
  store_.Add({Mug("mug1", "red"), Mug("mug2", "red")}, At(1.0));
  store_.Add({Mug("mug1", "blue")}, At(3.0));
  store_.Remove({"mug2"}, At(5.0));
  EXPECT_EQ(LiveView(store_, 0.5).size(), 0u);
  EXPECT_THAT(WithFiller(LiveView(store_, 2.0), "hasColour", "red"), ElementsAre("mug1", "mug2"));
  EXPECT_THAT(WithFiller(LiveView(store_, 3.0), "hasColour", "red"), ElementsAre("mug2"));
  EXPECT_THAT(Everything(LiveView(store_, 5.0)), Everything(LiveView(store_)));
}

TEST_F(LiveViewTest, OfTwoValiditiesThatMayHoldTheLaterOneCounts) {
  store_.Add({Mug("mug1", "red")}, At(1.0));
  Fluent blue = Mug("mug1", "blue");
  blue.start = {3.0, 6.0};  // somewhere between
  store_.Add({blue}, At(6.0));
  EXPECT_EQ(QueryAll(store_, HoldsAt(4.0)).size(), 2u);
  EXPECT_THAT(WithFiller(LiveView(store_, 4.0), "hasColour", "blue"), ElementsAre("mug1"));
  EXPECT_EQ(LiveView(store_, 4.0).size(), 1u);
}

TEST_F(LiveViewTest, ATimeThatIsNoneIsRefused) {
  EXPECT_THROW(LiveView(store_, std::numeric_limits<double>::quiet_NaN()), base::ConfigError);
}

TEST_F(LiveViewTest, ReadsMoreThanOnePage) {
  std::vector<Fluent> poses;
  for (int i = 0; i < 10'500; ++i) poses.push_back(PoseAt("pose" + std::to_string(i), 1.0 * i));
  store_.Add(poses, At(1.0));
  const LiveView view(store_);
  EXPECT_EQ(view.size(), poses.size());
  EXPECT_EQ(view.sequence(), poses.size());
  EXPECT_THAT(WithFiller(view, "hasX", 10'400.0), ElementsAre("pose10400"));
}

TEST_F(LiveViewTest, MovesWithAllItHolds) {
  ApplyAll(store_.Add({Mug("mug1", "red")}, At(1.0)));
  LiveView moved = std::move(view_);
  EXPECT_NE(moved.Find("mug1"), nullptr);
  view_ = LiveView(store_);
  EXPECT_THAT(Everything(view_), Everything(moved));
}

// Property ----------------------------------------------------------------------------------------

struct Write {
  enum class Kind { kAdd, kUpdate, kRemove };
  Kind kind{Kind::kAdd};
  std::string instance, concept_name;
  std::vector<std::string> colours;
  int count{0};
  bool imagined{false};
};

void showValue(const Write& write, std::ostream& out) {
  out << static_cast<int>(write.kind) << ' ' << write.instance << ' ' << write.concept_name << ' '
      << base::Join(write.colours, ",") << ' ' << write.count
      << (write.imagined ? " imagined\n" : "\n");
}

rc::Gen<Write> AnyWrite() {
  using Kind = Write::Kind;
  return rc::gen::build<Write>(
      rc::gen::set(&Write::kind,
                   rc::gen::element(Kind::kAdd, Kind::kAdd, Kind::kUpdate, Kind::kRemove)),
      rc::gen::set(&Write::instance, rc::gen::element<std::string>("a", "B", "b", "c1", "C2")),
      rc::gen::set(&Write::concept_name, rc::gen::element<std::string>("Mug", "Vase")),
      rc::gen::set(&Write::colours, rc::gen::container<std::vector<std::string>>(
                                        rc::gen::element<std::string>("red", "Red", "blue"))),
      rc::gen::set(&Write::count, rc::gen::inRange(0, 3)),
      rc::gen::set(&Write::imagined, rc::gen::element(false, false, true)));
}

Fluent FluentOf(const Write& write) {
  Fluent fluent = MakeFluent(write.concept_name, write.instance);
  for (const std::string& colour : write.colours) {
    fluent.properties.push_back({"hasColour", "xsd:string", colour});
  }
  if (write.count > 0) {
    fluent.properties.push_back({"hasCount", "xsd:int", static_cast<std::int64_t>(write.count)});
  }
  return fluent;
}

/// None where the write is an error, as to remove what does not hold.
std::vector<Change> Do(const Write& write, const Assertion& by, Store* store) {
  try {
    if (write.kind == Write::Kind::kRemove) return store->Remove({write.instance}, by);
    if (write.kind == Write::Kind::kUpdate) return store->Update({FluentOf(write)}, by);
    return store->Add({FluentOf(write)}, by);
  } catch (const base::ConfigError&) {
    return {};
  }
}

void ExpectSame(const FluentView& view, const FluentView& fresh) {
  RC_ASSERT(Everything(view) == Everything(fresh));
  for (const char* concept_name : {"Mug", "Vase", "Object"}) {
    RC_ASSERT(OfConcept(view, concept_name) == OfConcept(fresh, concept_name));
  }
  for (const char* colour : {"red", "BLUE", "green"}) {
    RC_ASSERT(WithFiller(view, "hasColour", colour) == WithFiller(fresh, "hasColour", colour));
  }
  for (const double count : {1.0, 2.0, 2.5}) {
    RC_ASSERT(WithFiller(view, "hasCount", count) == WithFiller(fresh, "hasCount", count));
  }
}

/// The index against a search through everything.
void ExpectIndexIsRight(const FluentView& view) {
  for (const Fluent& fluent : Everything(view)) {
    RC_ASSERT(*view.Find(fluent.instance) == fluent);
    std::vector<std::string> alike;
    view.All([&](const Fluent& other) {
      if (other.concept_name == fluent.concept_name) alike.push_back(other.instance);
      return true;
    });
    RC_ASSERT(OfConcept(view, fluent.concept_name) == alike);
    for (const Property& property : fluent.properties) {
      const auto found = WithFiller(view, property.role, property.filler);
      RC_ASSERT(std::count(found.begin(), found.end(), fluent.instance) == 1);
    }
  }
}

HIRES_PROPERTY(LiveViewProperty, ChangesKeepItEqualToAFreshViewOfTheStore, ()) {
  Store store(":memory:", SmallOntology());
  const Episode dream = store.StartEpisode("dream", Episode::Label::kImagined, 0, 0.0);
  LiveView view(store);
  double now = 1.0;
  for (const Write& write : *rc::gen::container<std::vector<Write>>(AnyWrite())) {
    for (const Change& change : Do(write, At(now, write.imagined ? dream.id : 0), &store)) {
      view.Apply(change);
    }
    now += 1.0;
  }
  const LiveView fresh(store);
  RC_ASSERT(view.size() == fresh.size());
  ExpectSame(view, fresh);
  ExpectIndexIsRight(view);
  RC_ASSERT(Everything(LiveView(store, now / 2.0)) == QueryAll(store, HoldsAt(now / 2.0)));
}

}  // namespace
}  // namespace hires::knowledge::live_view_test
