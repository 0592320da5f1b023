#include "hires/planning/fact_history.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "hires/base/rng.h"
#include "planning/support/conditions.h"

namespace hires::planning::fact_history_test {
namespace {

using hires::test_support::FactsOf;
using hires::test_support::Read;
using hires::test_support::Text;

TEST(FactHistoryTest, KeepsEveryMoment) {
  FactHistory facts = FactsOf("((p a) (p b))");
  EXPECT_TRUE(facts.Remove(Read("(p a)"), 1));
  EXPECT_TRUE(facts.Add(Read("(q)"), 2));
  EXPECT_EQ(Text(facts.FactsAt(0)), "(p a) (p b)");
  EXPECT_EQ(Text(facts.FactsAt(1)), "(p b)");
  EXPECT_EQ(Text(facts.FactsAt(2)), "(p b) (q)");
  EXPECT_TRUE(facts.Holds(Read("(p a)"), 0));
  EXPECT_FALSE(facts.Holds(Read("(p a)"), 1));
}

TEST(FactHistoryTest, AFactThatIsThereKeepsItsAge) {
  FactHistory facts = FactsOf("((p a) (p b))");
  EXPECT_FALSE(facts.Add(Read("(p a)"), 1));
  EXPECT_EQ(Text(facts.FactsAt(1)), "(p a) (p b)");
}

TEST(FactHistoryTest, AFactThatComesBackIsNew) {
  FactHistory facts = FactsOf("((p a) (p b))");
  EXPECT_TRUE(facts.Remove(Read("(p a)"), 1));
  EXPECT_TRUE(facts.Add(Read("(p a)"), 1));
  EXPECT_EQ(Text(facts.FactsAt(1)), "(p b) (p a)");
  EXPECT_EQ(Text(facts.FactsAt(0)), "(p a) (p b)");
}

TEST(FactHistoryTest, WhatIsNotThereCannotBeRemoved) {
  FactHistory facts = FactsOf("((p a))");
  EXPECT_FALSE(facts.Remove(Read("(p b)"), 1));
  EXPECT_TRUE(facts.Remove(Read("(p a)"), 1));
  EXPECT_FALSE(facts.Remove(Read("(p a)"), 1));
}

TEST(FactHistoryTest, CandidatesAreFoundByPredicateAndFirstArgument) {
  const FactHistory facts = FactsOf("((on a b) (on b c) (clear a) (goal (on a b)) (on 1 2))");
  EXPECT_EQ(facts.Candidates(Read("(on ?x ?y)")).size(), 3u);
  EXPECT_EQ(facts.Candidates(Read("(on b ?y)")).size(), 1u);
  EXPECT_EQ(facts.Candidates(Read("(on 1 ?y)")).size(), 1u);
  EXPECT_EQ(facts.Candidates(Read("(goal (on ?x ?y))")).size(), 1u);
  EXPECT_EQ(facts.Candidates(Read("(below ?x)")).size(), 0u);
  EXPECT_EQ(facts.Candidates(Read("(?p a)")).size(), 5u);
}

TEST(FactHistoryTest, AFactWithVariablesIsRefused) {
  FactHistory facts;
  EXPECT_THROW(facts.Add(Read("(p ?x)"), 0), std::logic_error);
}

TEST(FactHistoryTest, EqualsAListThatIsChangedStepByStep) {
  for (int seed = 0; seed < 50; ++seed) {
    base::Rng rng(seed);
    FactHistory history;
    std::vector<Datum> list;
    for (int moment = 0; moment < 60; ++moment) {
      const Datum atom = MakeList({MakeSymbol("p"), MakeInteger(rng.Index(6))});
      const auto found = std::find(list.begin(), list.end(), atom);
      if (rng.Index(2) == 0) {
        EXPECT_EQ(history.Remove(atom, moment), found != list.end());
        if (found != list.end()) list.erase(found);
      } else {
        EXPECT_EQ(history.Add(atom, moment), found == list.end());
        if (found == list.end()) list.push_back(atom);
      }
      ASSERT_EQ(Text(history.FactsAt(moment)), Text(list)) << "seed " << seed;
    }
  }
}

}  // namespace
}  // namespace hires::planning::fact_history_test
