#include "hires/perception/tabletop_recogniser.h"

#include <gtest/gtest.h>

#include <memory>

#include "hires/perception/depth_sensor.h"
#include "hires/perception/line_of_sight.h"

namespace hires::perception::tabletop_recogniser_test {
namespace {

constexpr char kTrayLink[] = "tray_link";
constexpr double kPlateTop = 0.9;  // [m] above the floor

geometry::Collision Plate() {
  geometry::Collision plate;
  plate.name = kTrayLink;
  plate.shape = geometry::Box{{0.4, 0.4, 0.02}};
  plate.X_BS.translation = {0.9, 0.0, kPlateTop - 0.01};
  return plate;
}

/// The camera of a robot whose base is F, 1.4 m above the floor, and what it measures without
/// noise.
class TabletopRecogniserTest : public testing::Test {
 protected:
  PointCloud See(const std::vector<geometry::Collision>& things, double max_range = 3.0) const {
    world::World world;
    for (const geometry::Collision& thing : things) {
      world.statics.emplace_back();
      world.statics.back().name = "body" + std::to_string(world.statics.size());
      world.statics.back().collisions.push_back(thing);
    }
    const LineOfSight sight(std::make_shared<Surroundings>(world), {});
    DepthSensorParams sensor;
    sensor.max_range = max_range;
    base::Rng rng(1);
    return Measure(sight.Look(camera_, 5.0), camera_, sensor, &rng);
  }
  std::optional<TabletopView> Look(const PointCloud& cloud, const std::string& tray_link) {
    return recogniser_.Look(cloud, camera_.X_MC * OpticalFrame(), {Plate()}, tray_link,
                            base::Rng(1));
  }

  const PinholeCamera camera_{LookAt({0.0, 0.0, 1.4}, {0.9, 0.0, kPlateTop}, 640, 480, 1.0)};
  TabletopRecogniser recogniser_{
      std::make_shared<Recogniser>(std::vector<KnownModel>{}, RecogniserParams{}),
      SelfFilterParams{}};
};

TEST_F(TabletopRecogniserTest, ATrayOutOfThePictureIsNotSeen) {
  PointCloud nothing = See({});
  EXPECT_FALSE(Look(nothing, kTrayLink)) << "a picture in which nothing was measured";
  EXPECT_FALSE(Look({}, kTrayLink)) << "no picture";
  geometry::Collision floor;
  floor.shape = geometry::Box{{9.0, 9.0, 0.02}};
  floor.X_BS.translation.z() = -0.01;
  EXPECT_FALSE(Look(See({floor}), kTrayLink)) << "the floor, where the tray should hide it";
}

TEST_F(TabletopRecogniserTest, TheTrayIsSeenWithWhatStandsOnIt) {
  geometry::Collision box;
  box.shape = geometry::Box{{0.08, 0.08, 0.12}};
  box.X_BS.translation = {0.92, 0.05, kPlateTop + 0.06};
  const auto seen = Look(See({Plate(), box}), kTrayLink);
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->sighting.table.size(), 4u);
  ASSERT_EQ(seen->sighting.detections.size(), 1u);
  EXPECT_FALSE(Look(See({Plate(), box}), "")) << "a robot without tray cuts its plate out";
}

}  // namespace
}  // namespace hires::perception::tabletop_recogniser_test
