#include "sensing/anchoring.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "hires/base/rng.h"

namespace hires::sensing::anchoring_test {
namespace {

using Eigen::Vector3d;

constexpr double kReach = 0.1, kMargin = 0.03;

/// The least sum over all assignments, by trying each; of those without a pair, all but those in
/// which its thing stays alone and its instance is none.
double LeastSum(const std::vector<SeenThing>& things, const std::vector<Anchor>& anchors,
                std::pair<int, int> forbidden) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  std::vector<bool> is_taken(anchors.size(), false);
  bool is_alone = false;
  std::function<double(std::size_t)> best = [&](std::size_t i) {
    if (i == things.size())
      return is_alone && !is_taken[static_cast<std::size_t>(forbidden.second)] ? kNever : 0.0;
    const bool is_the_thing = forbidden.first == static_cast<int>(i);
    is_alone |= is_the_thing;
    double least = kReach + best(i + 1);
    if (is_the_thing) is_alone = false;
    for (std::size_t k = 0; k < anchors.size(); ++k) {
      double d = kNever;
      for (const SeenKind& one : things[i].kinds)
        if (one.kind == anchors[k].kind) d = one.doubt + (things[i].p_M - anchors[k].p_M).norm();
      if (is_taken[k] || d > kReach) continue;
      if (forbidden == std::pair<int, int>(static_cast<int>(i), static_cast<int>(k))) continue;
      is_taken[k] = true;
      least = std::min(least, d + best(i + 1));
      is_taken[k] = false;
    }
    return least;
  };
  return best(0);
}

TEST(AnchorThingsTest, TheBestAssignmentIsTheOneThatTryingAllFinds) {
  int num_anchored = 0, num_ambiguous = 0;
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    base::Rng rng(seed);
    const std::vector<std::string> kinds{"mug", "mill"};
    const auto place = [&] {
      return Vector3d(rng.Uniform(0.0, 0.25), rng.Uniform(0.0, 0.25), 0.7);
    };
    std::vector<SeenThing> things(rng.Index(6));
    for (SeenThing& thing : things) {
      const std::size_t first = rng.Index(2);
      thing.kinds = {{kinds[first], 0.0}};
      if (rng.Bernoulli(0.3)) thing.kinds.push_back({kinds[1 - first], rng.Uniform(0.0, 0.05)});
      thing.p_M = place();
    }
    std::vector<Anchor> anchors(rng.Index(6));
    for (Anchor& anchor : anchors) anchor = {kinds[rng.Index(2)], place()};
    const Anchoring out = AnchorThings(things, anchors, kReach, kMargin);
    const double least = LeastSum(things, anchors, {-1, -1});
    std::vector<int> used;
    for (std::size_t i = 0; i < things.size(); ++i) {
      num_ambiguous += out.is_ambiguous[i];
      if (out.anchor[i] < 0) continue;
      ++num_anchored;
      used.push_back(out.anchor[i]);
      // Without this pair it is worse by the margin: so it is in the best one, and certain.
      EXPECT_GE(LeastSum(things, anchors, {static_cast<int>(i), out.anchor[i]}) - least,
                kMargin - 1e-9)
          << seed;
    }
    std::sort(used.begin(), used.end());
    EXPECT_EQ(std::adjacent_find(used.begin(), used.end()), used.end()) << "one instance twice";
    // Each thing that is neither anchored nor ambiguous stays alone in some best assignment.
    for (std::size_t i = 0; i < things.size(); ++i) {
      if (out.anchor[i] >= 0 || out.is_ambiguous[i]) continue;
      std::vector<SeenThing> others = things;
      others.erase(others.begin() + static_cast<long>(i));
      EXPECT_NEAR(LeastSum(others, anchors, {-1, -1}) + kReach, least, 1e-9) << seed;
    }
  }
  EXPECT_GT(num_anchored, 200);
  EXPECT_GT(num_ambiguous, 50);
}

TEST(AnchorThingsTest, NeighboursThatMovedTogetherKeepTheirNames) {
  // Each is nearer to the other's place than to its own but for the last: one by one they would be
  // taken for each other.
  const std::vector<Anchor> anchors{{"mug", {0.0, 0.0, 0.0}}, {"mug", {0.09, 0.0, 0.0}}};
  const std::vector<SeenThing> things{{{{"mug"}}, {0.14, 0.0, 0.0}}, {{{"mug"}}, {0.05, 0.0, 0.0}}};
  EXPECT_EQ(AnchorThings(things, anchors, kReach, kMargin).anchor, (std::vector<int>{1, 0}));
}

// Localisation errs by some centimetres before a look and by others after a drive round the table.
TEST(AnchorThingsTest, AThingThatIsNoMoreThanWithinReachOfTheOnlyInstanceIsThatOne) {
  const std::vector<Anchor> anchors{{"mug", {0.0, 0.0, 0.0}}, {"mug", {0.0, 2.0, 0.0}}};
  const Anchoring out = AnchorThings({{{{"mug"}}, {0.095, 0.0, 0.0}}}, anchors, kReach, kMargin);
  EXPECT_EQ(out.anchor[0], 0);
  // Of two things beside it either may be it.
  const std::vector<SeenThing> two{{{{"mug"}}, {0.095, 0.0, 0.0}}, {{{"mug"}}, {-0.08, 0.0, 0.0}}};
  EXPECT_EQ(AnchorThings(two, anchors, kReach, kMargin).anchor, (std::vector<int>{-1, -1}));
}

TEST(AnchorThingsTest, WhatIsAsNearToBothIsSaidToBeEither) {
  const std::vector<Anchor> anchors{{"mug", {0.0, 0.05, 0.0}}, {"mug", {0.0, -0.05, 0.0}}};
  const Anchoring out = AnchorThings({{{{"mug"}}, {0.0, 0.005, 0.0}}}, anchors, kReach, kMargin);
  EXPECT_EQ(out.anchor[0], -1);
  EXPECT_TRUE(out.is_ambiguous[0]);
}

}  // namespace
}  // namespace hires::sensing::anchoring_test
