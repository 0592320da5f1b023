#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "support/simulated_drive.h"

/// Rooms in which the filter's parameters were chosen, and others in which they are judged.
namespace hires::localisation_benchmarks {

struct Room {
  world::OccupancyGrid grid;
  std::vector<Eigen::Vector2d> course;
};

/// 10 m x 10 m without a corner, with a table.
inline world::OccupancyGrid RoomWithoutCorner() {
  world::OccupancyGrid grid{0.05, 200, 200, {-3.0, -2.0}, {}};
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      const bool is_border = row < 2 || column < 2 || row >= 198 || column >= 198;
      const bool is_corner = column >= 90 && row >= 100;
      const bool is_table = column >= 40 && column < 56 && row >= 50 && row < 62;
      grid.cells.push_back(is_border || is_corner || is_table ? world::Cell::kOccupied
                                                              : world::Cell::kFree);
    }
  }
  return grid;
}

/// Parameters were chosen here.
inline std::vector<Room> RoomsToChooseIn() {
  return {{test_support::TwoRooms(), test_support::CourseThroughTwoRooms()},
          {RoomWithoutCorner(),
           {{-2.0, -1.0},
            {5.5, -1.0},
            {5.5, 1.8},
            {-1.5, 2.2},
            {0.5, 4.0},
            {0.5, 6.8},
            {-2.0, 6.8},
            {-2.0, -1.0}}}};
}

/// None where the original maps are not there.
inline std::vector<Room> RoomsToJudgeIn() {
  std::vector<Room> rooms;
  for (const test_support::Course& course : test_support::OriginalCourses()) {
    const std::string file = std::string(HIRES_SOURCE_DIR) + "/../shared/data/" + course.map;
    if (std::filesystem::exists(file)) rooms.push_back({world::LoadMap(file), course.places});
  }
  return rooms;
}

}  // namespace hires::localisation_benchmarks
