#include "loop/area_fluents.h"

#include <gmock/gmock.h>

#include "loop/blackboard.h"
#include "loop/loop_parts.h"
#include "support/messages.h"
#include "translation/stated_pose.h"

namespace hires::loop::area_fluents_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const LoopSetup::Parts& Parts() {
  static const LoopSetup setup(HIRES_SOURCE_DIR "/config/loop.yaml");
  return setup.parts();
}

/// The restaurant's knowledge, and what is said of areas beside it.
class AreaFluentsTest : public testing::Test {
 protected:
  AreaFluentsTest() { blackboard_.Load({HIRES_SOURCE_DIR "/config/knowledge/restaurant.yaml"}, 1); }

  void Say(const std::vector<world::NamedArea>& areas) {
    blackboard_.Write(AreaFluents(areas, blackboard_.view(), *Parts().ontology), {}, {},
                      {knowledge::Source::kKnowledge, 0, -temporal::kForever});
  }
  Eigen::Vector3d Place(const std::string& area) const {
    const knowledge::Fluent* fluent = blackboard_.view().Find(area);
    return translation::PoseStatedBy(blackboard_.view(), *fluent)->X_FO.translation;
  }

  Blackboard blackboard_{Parts().ontology};
};

TEST_F(AreaFluentsTest, EachHasItsOwnPoseAndTheConceptOfItsName) {
  Say({{"dock_1", {1.0, 2.0, 0.0}},
       {"dock1", {3.0, 4.0, 0.0}},
       {"floorAreaHall", {5.0, 6.0, 0.0}},
       {"placingAreaShelf", {7.0, 8.0, 0.0}}});
  EXPECT_EQ(Place("dock_1").x(), 1.0);
  EXPECT_EQ(Place("dock1").x(), 3.0);
  EXPECT_EQ(blackboard_.view().Find("dock1")->concept_name, "Area");
  EXPECT_EQ(blackboard_.view().Find("floorAreaHall")->concept_name, "FloorArea");
  EXPECT_EQ(blackboard_.view().Find("placingAreaShelf")->concept_name, "PlacingArea");
}

// A map is another place: what it says of an area counts, and nothing else of it is lost.
TEST_F(AreaFluentsTest, WhereAKnownAreaStandsIsSaidAnew) {
  const std::string name = "preManipulationAreaEastCounter1";
  const knowledge::Fluent before = *blackboard_.view().Find(name);
  Say({{"premanipulationareaeastcounter1", {1.0, 2.0, 0.5}}});
  EXPECT_EQ(Place(name).x(), 1.0);
  EXPECT_EQ(Place(name).y(), 2.0);
  EXPECT_EQ(blackboard_.view().Find(name)->properties.size(), before.properties.size());
  EXPECT_EQ(blackboard_.view().Find(name)->concept_name, before.concept_name);
}

TEST_F(AreaFluentsTest, NamesThatATaskCannotNameAreRefusedAllAtOnce) {
  const std::string error = hires::test_support::ConfigErrorOf([&] {
    Say({{"Loading bay", {}},
         {"?where", {}},
         {"dock;1", {}},
         {"table1", {}},
         {"goal-1", {}},
         {"12", {}},
         {"nil", {}}});
  });
  EXPECT_THAT(error, AllOf(HasSubstr("'Loading bay'"), HasSubstr("'Loading_bay'"),
                           HasSubstr("'?where'"), HasSubstr("'dock;1'"), HasSubstr("'nil'"),
                           HasSubstr("'table1' is called as a Table"), Not(HasSubstr("goal-1")),
                           Not(HasSubstr("'12'"))));
}

}  // namespace
}  // namespace hires::loop::area_fluents_test
