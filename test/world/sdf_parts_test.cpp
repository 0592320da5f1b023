// The small parts of which worlds are read.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hires/base/error.h"
#include "hires/base/rng.h"
#include "hires/geometry/angles.h"
#include "world/sdf/load_notes.h"
#include "world/sdf/model_folders.h"
#include "world/sdf/polygon_cut.h"
#include "world/temp_folder.h"

namespace hires::world::sdf_parts_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(LoadNotesTest, EachKindIsSaidOnceWithCountAndFirstPlace) {
  LoadNotes notes;
  notes.Add("model", "with joints", "a:1 'x'");
  notes.Add("actor", "left out", "a:2");
  notes.Add("model", "with joints", "a:3 'y'", 2);
  EXPECT_THAT(notes.Sentences(),
              ElementsAre("3 models with joints; first a:1 'x'", "1 actor left out; a:2"));
  EXPECT_NO_THROW(notes.ThrowIfProblems("a"));
  notes.AddProblem("a:4: wrong");
  notes.AddProblem("a:4: wrong");
  notes.AddProblem("a:5: bad");
  EXPECT_THAT(MessageOf<base::ConfigError>([&] { notes.ThrowIfProblems("a"); }),
              AllOf(HasSubstr("a:4: wrong"), HasSubstr("a:5: bad"), HasSubstr("3 models")));
}

TEST(FuelNameTest, IsWhatStandsBehindModels) {
  const std::string server = "https://fuel.gazebosim.org/1.0/OpenRobotics/models/";
  EXPECT_EQ(FuelNameOf(server + "Ground Plane").model, "Ground Plane");
  EXPECT_EQ(FuelNameOf(server + "Ground Plane/").model, "Ground Plane");
  EXPECT_EQ(FuelNameOf(server + "Chair/3").model, "Chair");
  EXPECT_EQ(FuelNameOf(server + "Chair/3").inside, "");
  EXPECT_EQ(FuelNameOf(server + "Chair/tip/files/meshes/a.dae").inside, "meshes/a.dae");
  EXPECT_EQ(FuelNameOf("https://example.com/chair").model, "chair");
  EXPECT_EQ(AlikeName("Ground%20Plane"), AlikeName("ground_plane"));
}

double TwiceArea(const std::array<Eigen::Vector2d, 3>& t) {
  const Eigen::Vector2d a = t[1] - t[0], b = t[2] - t[0];
  return a.x() * b.y() - a.y() * b.x();
}

/// Star-shaped, round a centre.
std::vector<Eigen::Vector2d> Star(const Eigen::Vector2d& centre, double least, double most,
                                  base::Rng* rng) {
  const int corners = 3 + rng->Index(12);
  std::vector<Eigen::Vector2d> line;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * geometry::kPi * i / corners, far = rng->Uniform(least, most);
    line.push_back(centre + far * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return line;
}

double AreaOf(const std::vector<Eigen::Vector2d>& line) {
  double sum = 0.0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Eigen::Vector2d &a = line[i], &b = line[(i + 1) % line.size()];
    sum += a.x() * b.y() - a.y() * b.x();
  }
  return std::abs(sum) / 2.0;
}

TEST(CutIntoTrianglesTest, TrianglesCoverTheAreaBetweenTheLinesAndNoMore) {
  base::Rng rng(7);
  for (int round = 0; round < 300; ++round) {
    // Each hole lies within 0.4 of a place that is 1 from the middle; the outer line beyond 2.
    std::vector<std::vector<Eigen::Vector2d>> lines{Star({0, 0}, 4.0, 7.0, &rng)};
    double wanted = AreaOf(lines[0]);
    const bool may_have_holes = lines[0].size() > 5;  // else its edges come nearer
    const int num_holes = may_have_holes ? rng.Index(5) : 0;
    for (int i = 0; i < num_holes; ++i) {
      const double angle = 2.0 * geometry::kPi * i / num_holes;
      lines.push_back(Star({std::cos(angle), std::sin(angle)}, 0.1, 0.4, &rng));
      wanted -= AreaOf(lines.back());
      if (rng.Bernoulli(0.5)) std::reverse(lines.back().begin(), lines.back().end());
    }
    const auto triangles = CutIntoTriangles(lines);
    double area = 0.0;
    for (const auto& triangle : triangles) {
      EXPECT_GT(TwiceArea(triangle), 0.0);
      area += TwiceArea(triangle) / 2.0;
    }
    EXPECT_NEAR(area, wanted, 1e-6) << "round " << round;
  }
}

TEST(CutIntoTrianglesTest, LinesThatCrossGiveNothing) {
  EXPECT_TRUE(CutIntoTriangles({{{0, 0}, {1, 1}, {1, 0}, {0, 1}}}).empty());
  EXPECT_TRUE(CutIntoTriangles({{{0, 0}, {1, 1}}}).empty());
}

}  // namespace
}  // namespace hires::world::sdf_parts_test
