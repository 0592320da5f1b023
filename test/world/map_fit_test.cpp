#include "hires/world/map_fit.h"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>

#include "hires/base/error.h"
#include "hires/base/rng.h"
#include "hires/world/world.h"

namespace hires::world::map_fit_test {
namespace {

using geometry::MapToWorld;
using geometry::ParseMapToWorld;
using ::testing::HasSubstr;

constexpr double kLaserHeight = 0.303;  // [m]

OccupancyGrid Restaurant() {
  return SliceWorld(LoadWorld(HIRES_SOURCE_DIR "/worlds/restaurant.world"), kLaserHeight,
                    kLaserHeight);
}

/// What a robot would have mapped whose map lies so in the world.
OccupancyGrid MapOf(const OccupancyGrid& slice, const MapToWorld& map_to_world) {
  OccupancyGrid map = slice;
  map.origin -= Eigen::Vector2d(3.0, 3.0);
  map.width += 120;
  map.height += 120;
  map.cells.assign(static_cast<std::size_t>(map.width) * map.height, Cell::kFree);
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      const Eigen::Vector2d p_W = map_to_world.ToWorld(map.CentreOf(column, row));
      const Eigen::Vector2d cell = (p_W - slice.origin) / slice.resolution;
      const int x = static_cast<int>(std::floor(cell.x()));
      const int y = static_cast<int>(std::floor(cell.y()));
      const bool inside = x >= 0 && y >= 0 && x < slice.width && y < slice.height;
      if (inside) map.cells[static_cast<std::size_t>(row) * map.width + column] = slice.at(x, y);
    }
  }
  return map;
}

std::string ErrorOf(const std::function<void()>& act) {
  try {
    act();
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(FitMapTest, AMapOfTheWorldFitsWhereverItLies) {
  const OccupancyGrid slice = Restaurant();
  for (const char* text : {"0 0 0 1", "0.7 -0.4 0.2 1", "0.5 0.5 0 1.05"}) {
    const MapToWorld m = ParseMapToWorld(text, "here");
    const MapFit fit = FitMap(MapOf(slice, m), slice, m, 0.15);
    EXPECT_GT(fit.score, 0.97) << text;
    EXPECT_LE(fit.score, 1.0) << text;
  }
}

TEST(FitMapTest, AShiftCostsAgreement) {
  const OccupancyGrid slice = Restaurant();
  const double right = FitMap(slice, slice, {}, 0.15).score;
  const double shifted = FitMap(slice, slice, {{0.6, 0.3, 0.0}, 1.0}, 0.15).score;
  EXPECT_EQ(right, 1.0);
  EXPECT_LT(shifted, right - 0.3);
}

TEST(FitMapTest, WhatTheMapDoesNotKnowIsNotAskedOf) {
  const OccupancyGrid slice = Restaurant();
  OccupancyGrid half = slice;
  for (int row = 0; row < half.height; ++row) {
    for (int column = half.width / 2; column < half.width; ++column) {
      half.cells[static_cast<std::size_t>(row) * half.width + column] = Cell::kUnknown;
    }
  }
  EXPECT_GT(FitMap(half, slice, {}, 0.15).score, 0.98);
}

TEST(RequireMapFitsTest, SaysHowFarOffItIs) {
  const OccupancyGrid slice = Restaurant();
  const OccupancyGrid map = MapOf(slice, ParseMapToWorld("0.7 -0.4 0.1 1", "here"));
  const std::string error =
      ErrorOf([&] { RequireMapFits(map, slice, ParseMapToWorld("0.3 -0.4 0.1", "here"), {}); });
  EXPECT_THAT(error, HasSubstr("map_to_world '0.30 -0.40 0.100 1'"));
  EXPECT_THAT(error, ::testing::ContainsRegex("off by 0\\.(39|4[0-3])"));
  const auto advice = error.find("with '");
  ASSERT_NE(advice, std::string::npos) << error;
  const std::string better = error.substr(advice + 6, error.find('\'', advice + 6) - advice - 6);
  EXPECT_GT(RequireMapFits(map, slice, ParseMapToWorld(better, "advice"), {}).score, 0.9) << error;
}

TEST(RequireMapFitsTest, TheRightTransformationIsAccepted) {
  const OccupancyGrid slice = Restaurant();
  const MapToWorld m = ParseMapToWorld("0.7 -0.4 0.1 1", "here");
  EXPECT_GT(RequireMapFits(MapOf(slice, m), slice, m, {}).score, 0.97);
}

TEST(RequireMapFitsTest, AForeignMapIsRefused) {
  const OccupancyGrid slice = Restaurant();
  OccupancyGrid foreign = slice;
  base::Rng rng(3);
  for (Cell& cell : foreign.cells) cell = rng.Uniform(0, 1) < 0.02 ? Cell::kOccupied : Cell::kFree;
  EXPECT_THAT(ErrorOf([&] { RequireMapFits(foreign, slice, {}, {}); }),
              HasSubstr("is it the world of this laboratory?"));
}

TEST(RequireMapFitsTest, AnEmptyMapIsRefused) {
  OccupancyGrid empty = Restaurant();
  for (Cell& cell : empty.cells) cell = Cell::kFree;
  EXPECT_THAT(ErrorOf([&] { RequireMapFits(empty, Restaurant(), {}, {}); }),
              HasSubstr("no obstacle at all"));
}

/// The map that a real robot made of the restaurant, and the one that was made in its simulation.
TEST(RequireMapFitsTest, TheOriginalMapsBelongToTheirRestaurant) {
  const std::string folder = std::string(HIRES_SHARED_DATA) + "/";
  if (!std::filesystem::exists(folder + "map_sim_origin.yaml")) {
    GTEST_SKIP() << "the original maps are missing (HIRES_SHARED_DATA)";
  }
  const OccupancyGrid slice = Restaurant();
  for (const char* name : {"map_sim_origin.yaml", "map_pr2_origin.yaml"}) {
    const OccupancyGrid map = LoadMap(folder + name);
    const MapFit fit = FitMap(map, slice, {}, MapFitParams().tolerance);
    RecordProperty(name, std::to_string(fit.score));
    EXPECT_EQ(ErrorOf([&] { RequireMapFits(map, slice, {}, {}); }), "")
        << name << " explained " << fit.explained << " found " << fit.found;
  }
}

}  // namespace
}  // namespace hires::world::map_fit_test
