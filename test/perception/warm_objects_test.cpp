#include "hires/perception/warm_objects.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "hires/base/error.h"
#include "hires/geometry/angles.h"
#include "hires/perception/line_of_sight.h"
#include "support/sight_scenes.h"

namespace hires::perception::warm_objects_test {
namespace {

using test_support::At;
using test_support::Thing;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr double kRoom = 293.15;  // [K]

/// Rows of letters: '.' is as warm as the room, a digit d is 300 + 10 d kelvin.
HeatPicture Drawn(const std::vector<std::string>& rows) {
  HeatPicture heat{static_cast<int>(rows[0].size()), static_cast<int>(rows.size()), {}};
  for (const std::string& row : rows) {
    for (const char c : row) {
      heat.centikelvin.push_back(c == '.' ? 29315
                                          : static_cast<std::uint16_t>(30000 + 1000 * (c - '0')));
    }
  }
  return heat;
}

/// Rows of letters: each small letter is an object of that name, '.' is nothing.
RangePicture Owners(const std::vector<std::string>& rows) {
  RangePicture seen;
  seen.width = static_cast<int>(rows[0].size());
  seen.height = static_cast<int>(rows.size());
  seen.names = {"a", "b", "c"};
  for (const std::string& row : rows) {
    for (const char c : row) seen.owner.push_back(c == '.' ? RangePicture::kNothing : c - 'a');
  }
  return seen;
}

const WarmParams kFewPixels{308.15, 3, 0.2};

TEST(WarmObjectsTest, ARegionHasItsContourItsHottestPixelAndItsMedian) {
  const HeatReading reading =
      ReadHeat(Drawn({"......",  //
                      ".133..",  //
                      ".135..",  //
                      "....1."}),
               Owners({"......", "......", "......", "......"}), {}, kFewPixels);
  ASSERT_THAT(reading.regions, SizeIs(1));  // one corner joins the last pixel
  const WarmRegion& region = reading.regions[0];
  EXPECT_EQ(region.num_pixels, 7);
  EXPECT_DOUBLE_EQ(region.hottest, 350.0);
  EXPECT_DOUBLE_EQ(region.median, 330.0);
  EXPECT_THAT(region.contour, SizeIs(8));  // there and back to the corner that hangs on
  EXPECT_THAT(region.objects, IsEmpty());
}

TEST(WarmObjectsTest, AnObjectIsAsWarmAsItsRegionAndAColdOneAsAllOfIt) {
  const HeatReading reading =
      ReadHeat(Drawn({"......", ".33...", ".33...", "......"}),
               Owners({".aa...", ".aa.bb", ".aa.bb", "......"}), {"a", "b", "c"}, kFewPixels);
  ASSERT_THAT(reading.objects, SizeIs(2));  // of c there is nothing to be seen
  EXPECT_EQ(reading.objects[0].name, "a");
  EXPECT_DOUBLE_EQ(reading.objects[0].temperature, 330.0);
  EXPECT_EQ(reading.objects[0].num_pixels, 4);
  EXPECT_FALSE(reading.objects[0].is_ambiguous());
  EXPECT_EQ(reading.objects[1].name, "b");
  EXPECT_DOUBLE_EQ(reading.objects[1].temperature, kRoom);
  EXPECT_THAT(reading.regions[0].objects, ElementsAre("a"));
}

TEST(WarmObjectsTest, ARegionOverTwoObjectsIsAmbiguous) {
  const HeatReading reading =
      ReadHeat(Drawn({"......", ".3333.", ".3333.", "......"}),
               Owners({"......", ".aabb.", ".aabb.", "......"}), {"a", "b"}, kFewPixels);
  EXPECT_THAT(reading.regions[0].objects, ElementsAre("a", "b"));
  EXPECT_THAT(reading.objects[0].mixed_with, ElementsAre("b"));
  EXPECT_THAT(reading.objects[1].mixed_with, ElementsAre("a"));
}

TEST(WarmObjectsTest, ARegionThatTouchesAnObjectByFewPixelsIsNotIts) {
  const HeatReading reading =
      ReadHeat(Drawn({".......", ".333...", ".333...", "......."}),
               Owners({".......", ".aabbbb", ".aabbbb", "..bbbbb"}), {"a", "b"}, kFewPixels);
  EXPECT_THAT(reading.regions[0].objects, ElementsAre("a"));
  EXPECT_FALSE(reading.objects[0].is_ambiguous());
  EXPECT_DOUBLE_EQ(reading.objects[1].temperature, kRoom);
}

TEST(WarmObjectsTest, SpecksAreNoRegions) {
  const HeatReading reading =
      ReadHeat(Drawn({"3.....", "....3.", "....3.", "......"}),
               Owners({"......", "......", "......", "......"}), {}, kFewPixels);
  EXPECT_THAT(reading.regions, IsEmpty());
}

TEST(WarmObjectsTest, PicturesOfTwoSizesAreRefused) {
  EXPECT_THROW(ReadHeat(Drawn({"..", ".."}), Owners({"...", "..."}), {}, {}), std::logic_error);
}

/// Mugs of random temperatures on a shelf before the camera, recognised with an error of some
/// millimetres: each that stands apart is as warm as it is.
TEST(WarmObjectsTest, RandomMugsAreAsWarmAsTheyAreHoweverRecognised) {
  const auto models = test_support::EmptyRoom();
  int num_warm = 0, num_cold = 0;
  for (int seed = 0; seed < 40; ++seed) {
    base::Rng rng(seed);
    std::vector<world::ObjectState> truth, recognised;
    std::map<std::string, double> temperatures;
    std::vector<std::string> names;
    for (int i = 0; i < 4; ++i) {
      const std::string name = "mug" + std::to_string(i);
      truth.push_back(Thing(name, "mug", At(1.0, 0.2 * i - 0.3 + rng.Uniform(-0.03, 0.03), 0.8)));
      recognised.push_back(truth.back());
      for (int axis = 0; axis < 3; ++axis) {
        recognised.back().X_MO.translation[axis] += rng.Normal(0.0, 0.005);
      }
      temperatures[name] = rng.Bernoulli(0.5) ? rng.Uniform(312.0, 360.0) : kRoom;
      names.push_back(name);
    }
    const PinholeCamera camera = [] {  // 90 degrees, as the Flir A615 of the robot
      PinholeCamera flir{At(0.0, 0.0, 1.1), 640, 480, 320.0};
      flir.X_MC.rotation = geometry::RotationFromRpy(0.0, 0.25, 0.0);
      return flir;
    }();
    const HeatPicture heat =
        MeasureHeat(LineOfSight(models, truth).Look(camera, 5.0), temperatures, {}, &rng);
    const HeatReading reading =
        ReadHeat(heat, LineOfSight(models, recognised).Look(camera, 5.0), names, {});
    ASSERT_THAT(reading.objects, SizeIs(4));
    for (const ObjectHeat& object : reading.objects) {
      const double wanted = temperatures[object.name];
      ASSERT_NEAR(object.temperature, wanted, 0.1) << "seed " << seed << ", " << object.name;
      ASSERT_FALSE(object.is_ambiguous()) << "seed " << seed << ", " << object.name;
      ++(wanted > kRoom ? num_warm : num_cold);
    }
  }
  EXPECT_GT(num_warm, 50);
  EXPECT_GT(num_cold, 50);
}

/// A picture of these things, each as warm as told, by a camera that looks along x.
HeatView Pictured(const std::shared_ptr<const Surroundings>& room,
                  const std::vector<world::ObjectState>& things,
                  const std::map<std::string, double>& temperatures) {
  HeatView view;
  view.camera = {At(0.0, 0.0, 0.85), 640, 480, 320.0};
  base::Rng rng(5);
  view.heat = MeasureHeat(LineOfSight(room, things).Look(view.camera, 5.0), temperatures, {}, &rng);
  return view;
}

TEST(WarmObjectsTest, OfKnownObjectsThoseAreMeasuredThatAreInPictureNearAndNotHiddenOrCarried) {
  const auto room = test_support::EmptyRoom();
  std::vector<world::ObjectState> known{
      Thing("near", "mug", At(1.0, 0.0, 0.8)), Thing("far", "mug", At(2.5, 0.5, 0.8)),
      Thing("hidden", "mug", At(1.2, 0.0, 0.8)), Thing("behind", "mug", At(-1.0, 0.0, 0.8)),
      Thing("carried", "mug", At(1.0, 0.3, 0.8))};
  known.back().attached_to = "palm";
  const HeatView view = Pictured(room, known, {{"near", 335.65}, {"carried", 330.0}});
  WarmParams params;
  params.max_range = 2.0;
  const auto degrees = SureDegrees(ReadHeat(view, room, known, params));
  ASSERT_THAT(degrees, SizeIs(1));
  EXPECT_NEAR(degrees.at("near"), 62.5, 0.1);
  params.max_range = 4.0;
  EXPECT_THAT(SureDegrees(ReadHeat(view, room, known, params)), SizeIs(2));
}

TEST(WarmObjectsTest, WhoMayBeTheWarmOneOfTwoIsNotSure) {
  HeatReading reading;
  reading.objects = {{"mug1", 335.65, 336.0, 100, {"mug2"}}, {"mug2", 293.15, 294.0, 100, {}}};
  EXPECT_THAT(SureDegrees(reading),
              ElementsAre(testing::Pair("mug2", testing::DoubleNear(20.0, 1e-9))));
}

TEST(WarmObjectsTest, ParametersAreReadAndUnknownOnesRefused) {
  const auto read = [](const std::string& text) {
    return ReadWarmParams(base::ParamReader::FromString(text, "heat"));
  };
  const std::string good =
      "{threshold: 310, min_pixels: 20, min_share: 0.3, max_range: 2, period: 1}";
  EXPECT_EQ(read(good).threshold, 310.0);
  EXPECT_EQ(read(good).max_range, 2.0);
  EXPECT_THROW(read("{threshold: 310, min_pixels: 20, min_share: 3, max_range: 2, period: 1}"),
               base::ConfigError);
  EXPECT_THROW(
      read("{threshold: 310, min_pixels: 20, min_share: 0.3, max_range: 2, period: 1, x: 1}"),
      base::ConfigError);
}

}  // namespace
}  // namespace hires::perception::warm_objects_test
