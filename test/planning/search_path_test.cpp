#include "planning/search/search_path.h"

#include <gtest/gtest.h>

#include <vector>

#include "planning/support/path_bench.h"

namespace hires::planning::search_path_test {
namespace {

using hires::test_support::PathBench;

const char* const kItems =
    "(:operator (!a) () () ((p)) 2) (:method (t) () ((!a) (t))) (:method (t) () ())";

/// A path on which the root was reduced to (t), and that to (!a) and (t).
class SearchPathTest : public ::testing::Test {
 protected:
  void Decompose(std::uint32_t node, const std::vector<Term>& tasks) {
    const CompiledMethod& method = *bench_.program.Methods(bench_.terms.Symbol("t")).at(0);
    path_.Decompose({node, &method, 0, 0, path_.num_steps()}, tasks, -1);
  }
  PathBench bench_{kItems, "((q))"};
  SearchPath& path_{bench_.path};
};

TEST_F(SearchPathTest, BeginsWithTheFactsOfTheProblem) {
  EXPECT_TRUE(bench_.Holds("(q)"));
  EXPECT_FALSE(bench_.Holds("(p)"));
  EXPECT_EQ(path_.depth(), 0);
  EXPECT_EQ(path_.num_steps(), 0u);
}

TEST_F(SearchPathTest, ReturnToTakesBackEverything) {
  const SearchPath::Moment start = path_.Now();
  path_.GoDeeper();
  Decompose(Network::kRoot, {bench_.Term("(!a)"), bench_.Term("(t)")});
  path_.state().Add(bench_.Term("(p)"));
  path_.bindings().Make(3);
  path_.Finish({path_.network().FirstReady(), &bench_.Operator("!a"), 0, 2.0});
  EXPECT_EQ(path_.cost(), 2.0);
  EXPECT_EQ(path_.num_steps(), 1u);

  path_.ReturnTo(start);
  EXPECT_FALSE(bench_.Holds("(p)"));
  EXPECT_EQ(path_.depth(), 0);
  EXPECT_EQ(path_.cost(), 0.0);
  EXPECT_TRUE(path_.steps().empty());
  EXPECT_TRUE(path_.decompositions().empty());
  EXPECT_EQ(path_.bindings().size(), 0u);
  EXPECT_EQ(path_.network().size(), Network::kRoot + 1);
}

TEST_F(SearchPathTest, UndoStepsKeepsBindings) {
  const std::uint32_t variable = path_.bindings().Make(1);
  const SearchPath::Moment moment = path_.Now();
  path_.bindings().Unify(Instantiator::Variable(variable, 0), bench_.Term("a"));
  path_.state().Add(bench_.Term("(p)"));
  path_.UndoSteps(moment);
  EXPECT_FALSE(bench_.Holds("(p)"));
  EXPECT_EQ(path_.bindings().Deref(Instantiator::Variable(variable, 0)), bench_.Term("a"));
}

TEST_F(SearchPathTest, WasHereKnowsTheSameStateAndTasks) {
  Decompose(Network::kRoot, {bench_.Term("(!a)"), bench_.Term("(t)")});
  const SearchPath::Moment before = path_.Now();
  EXPECT_FALSE(path_.WasHere());
  EXPECT_TRUE(path_.WasHere());
  path_.state().Add(bench_.Term("(p)"));
  EXPECT_FALSE(path_.WasHere());
  path_.ReturnTo(before);
  EXPECT_FALSE(path_.WasHere());
}

TEST_F(SearchPathTest, RepeatsAreAncestorsOfTheSameTaskInTheSameState) {
  path_.CountRepeats();
  Decompose(Network::kRoot, {bench_.Term("(t)"), bench_.Term("(!a)")});  // two, as the method has
  const std::uint32_t above = path_.network().FirstReady();
  EXPECT_EQ(path_.NumRepeats(above, bench_.Term("(t)")), 0);
  Decompose(above, {bench_.Term("(!a)"), bench_.Term("(t)")});
  const std::uint32_t step = path_.network().FirstReady();
  EXPECT_EQ(path_.NumRepeats(step, bench_.Term("(t)")), 1);
  EXPECT_EQ(path_.NumRepeats(step, bench_.Term("(u)")), 0);
  path_.state().Add(bench_.Term("(p)"));
  EXPECT_EQ(path_.NumRepeats(step, bench_.Term("(t)")), 0);
  path_.state().Remove(bench_.Term("(p)"));  // as it was, whatever happened in between
  path_.Finish({step, &bench_.Operator("!a"), 0, 0.0});
  Decompose(path_.network().FirstReady(), {bench_.Term("(t)"), bench_.Term("(!a)")});
  EXPECT_EQ(path_.NumRepeats(path_.network().FirstReady(), bench_.Term("(t)")), 2);
  EXPECT_EQ(path_.NumRepeats(path_.network().FirstReady(), bench_.Term("(t)"), false), 1)
      << "the other came before the step";
}

TEST_F(SearchPathTest, SituationsAreEqualOnWhateverPath) {
  const SearchPath::Moment start = path_.Now();
  Decompose(Network::kRoot, {bench_.Term("(!a)"), bench_.Term("(t)")});
  path_.Finish({path_.network().FirstReady(), &bench_.Operator("!a"), 0, 0.0});
  const std::uint64_t once = path_.situation();
  Decompose(path_.network().FirstReady(), {bench_.Term("(!a)"), bench_.Term("(t)")});
  EXPECT_NE(path_.situation(), once);
  path_.Finish({path_.network().FirstReady(), &bench_.Operator("!a"), 0, 0.0});
  EXPECT_EQ(path_.situation(), once) << "(t) is left, from other nodes";
  path_.state().Add(bench_.Term("(p)"));
  EXPECT_NE(path_.situation(), once);
  path_.ReturnTo(start);
  EXPECT_TRUE(path_.has_situation());
}

}  // namespace
}  // namespace hires::planning::search_path_test
