// Drives whose truth is known, and what a map of them must be like.
#pragma once

#include <gtest/gtest.h>

#include "hires/localisation/filtered_log.h"
#include "hires/mapping/map_doubt.h"
#include "hires/mapping/map_judge.h"
#include "hires/mapping/mapper.h"
#include "support/simulated_drive.h"

namespace hires::mapping::mapper_truth {

using test_support::DriveThrough;
using test_support::SimulatedDrive;
using test_support::SimulatedDriveParams;
using test_support::TwoRooms;

inline SimulatedDrive TwoRoomsDrive(const SimulatedDriveParams& params = {}, int seed = 1) {
  return DriveThrough(TwoRooms(), test_support::CourseThroughTwoRooms(), params, base::Rng(seed));
}

struct Errors {
  double rms;  // [m] of the trajectory
  WallErrors walls;
};

inline Errors ErrorsOf(const MapResult& result, const SimulatedDrive& drive,
                       const world::OccupancyGrid& world) {
  const localisation::PathError path = localisation::ErrorOf(result.trajectory, drive.truth);
  const auto seen =
      FacesThatWereSeen(world, drive.log.scans, drive.truth, MapperParams{}.max_range);
  return {path.rms, JudgeWalls(result.grid, world, path.X_TP, seen)};
}

/// Holds a map against the world that was driven through.
/// @param most  [m] that 95 % of the faces may be off, either way.
inline void ExpectTrue(const MapResult& result, const SimulatedDrive& drive,
                       const world::OccupancyGrid& world, double most = 0.06) {
  const Errors errors = ErrorsOf(result, drive, world);
  EXPECT_LE(errors.rms, 0.05);
  EXPECT_LE(errors.walls.to_world.median, 0.03);
  EXPECT_LE(errors.walls.to_world.most, most);
  EXPECT_LE(errors.walls.to_map.median, 0.03);
  EXPECT_LE(errors.walls.to_map.most, most);
  EXPECT_GT(errors.walls.to_map.count, 500u);
  EXPECT_EQ(WhyDoubtful(result, result.evidence), "");
}

}  // namespace hires::mapping::mapper_truth
