// Limits of the simulator against the planar oracle, over friction and aspect ratio.
#include "physics/friction_grid.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>
#include <map>

#include "support/rounds.h"

namespace hires::physics::friction_grid_test {
namespace {

using namespace test_support;  // NOLINT

constexpr double kHeight = 0.1;  // [m] of the center of mass

/// The largest error among the cells of one row of the table.
struct Row {
  int cells{0}, chaotic{0}, unlimited{0}, beyond_goal{0};
  double largest{0.0};
  std::string where{"-"};
};

struct Cell {
  std::string kind;
  double friction{0.0}, ratio{0.0};
};

/// Fills the row and fails the test where a cell misses its goal.
void Compare(const Cell& cell, const GridMotion& motion, int num_headings, Row* row) {
  const GridBody body = MakeGridBody(cell.kind, cell.ratio, kHeight, cell.friction);
  const std::string where =
      fmt::format("{}, friction {}, b/c {}, {}", cell.kind, cell.friction, cell.ratio, motion.name);
  const OracleLimit limit = FindOracleLimit(body.planar, cell.friction, motion);
  ++row->cells;
  if (!limit.value) {
    ++row->unlimited;
    EXPECT_EQ(GridScene(body, cell.friction, motion.at(0.9 * motion.upper), 0.3).Play(),
              PlanarVerdict::kStays)
        << where << ": no limit";
    return;
  }
  if (limit.goal == 0.0) {
    ++row->chaotic;
    return;
  }
  const double error = GridError(body, cell.friction, motion, *limit.value, num_headings);
  if (error > row->largest) {
    row->largest = error;
    row->where = fmt::format("{}, limit {:.4g} {}", where, *limit.value, motion.unit);
  }
  if (error > limit.goal) ++row->beyond_goal;
  EXPECT_LE(error, limit.goal) << where << ": limit " << *limit.value << " " << motion.unit;
}

void Print(const std::map<std::string, Row>& rows) {
  for (const auto& [name, row] : rows) {
    std::cout << fmt::format(
        "{}: {} cells, {} without a limit, {} chaotic, {} beyond the goal; largest error {} % "
        "({})\n",
        name, row.cells, row.unlimited, row.chaotic, row.beyond_goal, 100.0 * row.largest,
        row.where);
  }
}

/// All cells of one kind of body.
void CompareAll(const char* kind) {
  const char* given = std::getenv("HIRES_GRID_HEADINGS");  // fewer for a quick look
  const int num_headings = given != nullptr ? std::atoi(given) : 36;
  std::map<std::string, Row> rows;
  for (const GridMotion& motion : GridMotions()) {
    // None of them is equal to a ratio: there a body that slides is about to tip at any speed, and
    // rounding decides.
    for (const double friction : {0.02, 0.05, 0.12, 0.25, 0.4, 0.8, 1.5, 3.0}) {
      for (const double ratio : {0.1, 0.2, 0.33, 0.5, 0.9, 1.4, 2.0}) {
        Compare({kind, friction, ratio}, motion, num_headings,
                &rows[std::string(kind) + ", " + motion.name]);
      }
    }
  }
  Print(rows);
}

TEST(FrictionGridTest, FewCellsMeetTheOracle) {
  const Cell cells[] = {{"cylinder", 0.4, 0.33}, {"box", 0.1, 0.33}, {"cone", 0.9, 0.5},
                        {"stack", 0.5, 0.33},    {"box", 3.0, 0.5},  {"cylinder", 0.2, 2.0}};
  std::map<std::string, Row> rows;
  const std::vector<GridMotion> motions = GridMotions();
  for (std::size_t i = 0; i < motions.size(); ++i) {
    for (const std::size_t k : {i, i + 1, i + 3})
      Compare(cells[k % std::size(cells)], motions[i], 2, &rows[motions[i].name]);
  }
  Print(rows);
}

TEST(FrictionGridTest, BoxesMeetTheOracleAt36Headings) {
  HIRES_LONG_CASE();
  CompareAll("box");
}

TEST(FrictionGridTest, CylindersMeetTheOracleAt36Headings) {
  HIRES_LONG_CASE();
  CompareAll("cylinder");
}

TEST(FrictionGridTest, ConesMeetTheOracleAt36Headings) {
  HIRES_LONG_CASE();
  CompareAll("cone");
}

TEST(FrictionGridTest, StacksMeetTheOracleAt36Headings) {
  HIRES_LONG_CASE();
  CompareAll("stack");
}

}  // namespace
}  // namespace hires::physics::friction_grid_test
