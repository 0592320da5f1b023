#include "hires/planning/substitution.h"

#include <gtest/gtest.h>

#include "hires/base/rng.h"
#include "planning/support/conditions.h"

namespace hires::planning::substitution_test {
namespace {

using hires::test_support::Read;

/// What both become when they are made equal, "" where they cannot be.
std::string Unified(const std::string& a, const std::string& b) {
  Substitution values;
  if (!values.Unify(Read(a), Read(b))) return "";
  EXPECT_EQ(ToString(values.Apply(Read(a))), ToString(values.Apply(Read(b))));
  return ToString(values.Apply(Read(a)));
}

TEST(UnifyTest, BindsVariablesOnBothSides) {
  EXPECT_EQ(Unified("(on ?x b)", "(on a ?y)"), "(on a b)");
  EXPECT_EQ(Unified("(f ?x ?x)", "(f ?y a)"), "(f a a)");
  EXPECT_EQ(Unified("?x", "(a b)"), "(a b)");
  EXPECT_EQ(Unified("(f ?x b)", "(f ?x ?y)"), "(f ?x b)");
}

TEST(UnifyTest, RefusesWhatDiffers) {
  EXPECT_EQ(Unified("(on a b)", "(on a c)"), "");
  EXPECT_EQ(Unified("(on a)", "(on a b)"), "");
  EXPECT_EQ(Unified("(f ?x ?x)", "(f a b)"), "");
  EXPECT_EQ(Unified("a", "\"a\""), "");
  EXPECT_EQ(Unified("1", "1.0"), "");
}

TEST(UnifyTest, SplitsListsAtADot) {
  EXPECT_EQ(Unified("(g ?first . ?rest)", "(g a b c)"), "(g a b c)");
  EXPECT_EQ(Unified("(g ?first . ?rest)", "(g a)"), "(g a)");
  EXPECT_EQ(Unified("(g ?first . ?rest)", "(g)"), "");
  EXPECT_EQ(Unified("(?a . ?b)", "(?c ?d . ?e)"), "(?c ?d . ?e)");
  EXPECT_EQ(Unified("(a . ?b)", "(a . c)"), "(a . c)");
  EXPECT_EQ(Unified("(a b)", "(a . c)"), "");
}

TEST(UnifyTest, TheRestOfAListThatEndsIsNil) {
  Substitution values;
  ASSERT_TRUE(values.Unify(Read("(?first . ?rest)"), Read("(a)")));
  EXPECT_TRUE(values.Apply(MakeVariable("?rest")).IsNil());
  EXPECT_TRUE(values.Unify(MakeVariable("?rest"), MakeSymbol("nil")));
}

TEST(UnifyTest, ABoundTailIsPartOfTheList) {
  Substitution values;
  ASSERT_TRUE(values.Unify(MakeVariable("?rest"), Read("(b . ?more)")));
  ASSERT_TRUE(values.Unify(MakeVariable("?more"), Read("(c)")));
  EXPECT_EQ(ToString(values.Apply(Read("(a . ?rest)"))), "(a b c)");
  EXPECT_TRUE(values.Unify(Read("(a . ?rest)"), Read("(a b c)")));
}

TEST(UnifyTest, NeverBindsAVariableToATermThatHoldsIt) {
  EXPECT_EQ(Unified("?x", "(f ?x)"), "");
  EXPECT_EQ(Unified("(?x ?y)", "((f ?y) (f ?x))"), "");
  EXPECT_EQ(Unified("(a . ?x)", "?x"), "");
  EXPECT_EQ(Unified("?x", "?x"), "?x");
}

TEST(UnifyTest, LeavesNothingBehindWhereItFails) {
  Substitution values;
  EXPECT_FALSE(values.Unify(Read("(f ?x ?y b)"), Read("(f a ?x c)")));
  EXPECT_FALSE(values.IsBound("?x"));
  EXPECT_FALSE(values.IsBound("?y"));
  EXPECT_EQ(values.Mark(), 0u);
}

TEST(UnifyTest, UndoTakesBackWhatCameAfterTheMark) {
  Substitution values;
  ASSERT_TRUE(values.Unify(MakeVariable("?x"), MakeVariable("?y")));
  const std::size_t mark = values.Mark();
  ASSERT_TRUE(values.Unify(MakeVariable("?x"), MakeSymbol("a")));
  EXPECT_EQ(ToString(values.Apply(MakeVariable("?y"))), "a");
  values.Undo(mark);
  EXPECT_EQ(ToString(values.Apply(Read("(?x ?y)"))), "(?y ?y)");
}

/// Any datum of constants, variables and lists, dotted ones included.
Datum RandomDatum(base::Rng* rng, int depth) {
  const int choice = rng->Index(depth == 0 ? 2 : 4);
  if (choice == 0) return MakeSymbol(std::string(1, static_cast<char>('a' + rng->Index(2))));
  if (choice == 1) {
    return MakeVariable("?" + std::string(1, static_cast<char>('x' + rng->Index(3))));
  }
  Datum list;
  const int size = 1 + rng->Index(3);
  for (int i = 0; i < size; ++i) list.items.push_back(RandomDatum(rng, depth - 1));
  if (choice == 3) list.tail.push_back(RandomDatum(rng, 0));
  return list;
}

TEST(UnifyTest, WhatIsUnifiedIsEqualInEitherDirection) {
  int num_unified = 0;
  for (int seed = 0; seed < 2000; ++seed) {
    base::Rng rng(seed);
    const Datum a = RandomDatum(&rng, 2);
    const Datum b = RandomDatum(&rng, 2);
    Substitution forth;
    Substitution back;
    const bool is_unified = forth.Unify(a, b);
    EXPECT_EQ(is_unified, back.Unify(b, a)) << ToString(a) << " and " << ToString(b);
    if (!is_unified) continue;
    ++num_unified;
    EXPECT_EQ(forth.Apply(a), forth.Apply(b)) << ToString(a) << " and " << ToString(b);
  }
  EXPECT_GT(num_unified, 200);
}

TEST(RenameVariablesTest, LeavesConstantsAlone) {
  EXPECT_EQ(ToString(RenameVariables(Read("(f ?x (a . ?y))"), "#1")), "(f ?x#1 (a . ?y#1))");
}

}  // namespace
}  // namespace hires::planning::substitution_test
