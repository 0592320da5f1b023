#include "hires/planning/planner_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "support/messages.h"
#include "support/temporary_folder.h"

namespace hires::planning::planner_config_test {
namespace {

using hires::test_support::ConfigErrorOf;
using hires::test_support::TemporaryFolder;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr char kConfig[] = R"(
domain: lamp.lisp
initial: [hall.lisp, kitchen.lisp]
threads: 3
max_waiting: 10
time_limit: 5.0
memory_limit: 100.0
max_depth: 1000
max_plans: 50
feedback_period: 0.1
)";

/// A folder with a configuration and the files that it names.
class Planner {
 public:
  Planner() {
    folder_.Write("lamp.lisp",
                  "(defdomain lamp ((:operator (!press ?s) () ((on ?s)))"
                  " (:method (light ?s) () ((!press ?s)))))");
    folder_.Write("hall.lisp", "(defproblem hall lamp () ((light s1)))");
    folder_.Write("kitchen.lisp", "(defproblem kitchen lamp ((dark)) ((light s2)))");
    path_ = folder_.Write("planner.yaml", kConfig);
  }

  std::string Write(const std::string& name, const std::string& text) {
    return folder_.Write(name, text);
  }
  /// The configuration with one line changed.
  std::string Changed(const std::string& from, const std::string& to) {
    std::string text = kConfig;
    text.replace(text.find(from), from.size(), to);
    return folder_.Write("changed.yaml", text);
  }
  const std::string& path() const { return path_; }
  std::string In(const std::string& name) const { return (folder_.path() / name).string(); }

 private:
  TemporaryFolder folder_;
  std::string path_;
};

TEST(PlannerConfigTest, PathsCountFromTheFolderOfTheFile) {
  const Planner planner;
  const PlannerConfig config = ReadPlannerConfig(planner.path());
  EXPECT_EQ(config.domain, planner.In("lamp.lisp"));
  EXPECT_THAT(config.initial, ElementsAre(planner.In("hall.lisp"), planner.In("kitchen.lisp")));
  EXPECT_EQ(config.threads, 3);
  EXPECT_EQ(config.max_waiting, 10);
  EXPECT_EQ(config.time_limit, 5.0);
  EXPECT_EQ(config.memory_limit, 100.0);
  EXPECT_EQ(config.max_depth, 1000);
  EXPECT_EQ(config.max_plans, 50);
  EXPECT_EQ(config.feedback_period, 0.1);
}

TEST(PlannerConfigTest, EachWrongKeyIsNamed) {
  Planner planner;
  const std::vector<std::array<std::string, 3>> cases{
      {"threads: 3", "threads: 0", "threads"},
      {"threads: 3", "", "threads"},
      {"time_limit: 5.0", "time_limit: 0", "time_limit"},
      {"memory_limit: 100.0", "memory_limit: .nan", "memory_limit"},
      {"max_plans: 50", "max_plans: many", "max_plans"},
      {"max_depth: 1000", "max_dpeth: 1000", "max_d"},
      {"initial: [hall.lisp, kitchen.lisp]", "initial: {}", "initial"}};
  for (const auto& [from, to, key] : cases) {
    const std::string path = planner.Changed(from, to);
    EXPECT_THAT(ConfigErrorOf([&] { ReadPlannerConfig(path); }),
                AllOf(HasSubstr("changed.yaml"), HasSubstr(key)))
        << to;
  }
}

TEST(PlannerConfigTest, KnowsTheProblemsInTheOrderOfTheFiles) {
  const Planner planner;
  const PlanningKnowledge knowledge = LoadPlanningKnowledge(ReadPlannerConfig(planner.path()));
  EXPECT_EQ(knowledge.domain.name, "lamp");
  ASSERT_EQ(knowledge.problems.size(), 2u);
  EXPECT_EQ(knowledge.problems[0].name, "hall");
  EXPECT_EQ(knowledge.problems[1].name, "kitchen");
}

TEST(PlannerConfigTest, WithoutProblemsTheDomainIsAllThatIsKnown) {
  Planner planner;
  const std::string path = planner.Changed("initial: [hall.lisp, kitchen.lisp]", "initial: []");
  EXPECT_TRUE(LoadPlanningKnowledge(ReadPlannerConfig(path)).problems.empty());
}

TEST(PlannerConfigTest, TwoProblemsOfOneNameAreRefused) {
  Planner planner;
  planner.Write("kitchen.lisp", "(defproblem hall lamp () ((light s1)))");
  EXPECT_THAT(ConfigErrorOf([&] { LoadPlanningKnowledge(ReadPlannerConfig(planner.path())); }),
              AllOf(HasSubstr("kitchen.lisp"), HasSubstr("problem 'hall' comes a second time"),
                    HasSubstr("hall.lisp"), HasSubstr("rename")));
}

TEST(PlannerConfigTest, AFileThatIsMissingOrBrokenIsNamed) {
  Planner planner;
  const auto error = [&] {
    return ConfigErrorOf([&] { LoadPlanningKnowledge(ReadPlannerConfig(planner.path())); });
  };
  planner.Write("hall.lisp", "(defproblem hall lamp () ((light s1))");
  EXPECT_THAT(error(), HasSubstr("hall.lisp:1:1"));
  planner.Write("lamp.lisp", "");
  EXPECT_THAT(error(), HasSubstr("lamp.lisp"));
}

}  // namespace
}  // namespace hires::planning::planner_config_test
