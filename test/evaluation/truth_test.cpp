#include "hires/evaluation/truth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "hires/base/text.h"
#include "support/messages.h"
#include "support/temporary_folder.h"

namespace hires::evaluation::truth_test {
namespace {

using test_support::ConfigErrorOf;
using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string kTruths = HIRES_SOURCE_DIR "/config/truths";

TEST(TruthPathTest, ANameIsAFileOfTheFolderAndAPathItself) {
  EXPECT_EQ(TruthPath("", kTruths), kTruths + "/same.yaml");
  EXPECT_EQ(TruthPath("same", kTruths), kTruths + "/same.yaml");
  EXPECT_EQ(TruthPath("here/own.yaml", kTruths), "here/own.yaml");
}

TEST(TruthPathTest, AnUnknownNameIsRefusedWithNamesLikeIt) {
  EXPECT_THAT(ConfigErrorOf([] { TruthPath("sane", kTruths); }),
              AllOf(HasSubstr(kTruths), HasSubstr("'sane'"), HasSubstr("'same'")));
}

/// What is said of the file of `same` with one text in another's place.
class TruthFileTest : public ::testing::Test {
 protected:
  std::string ErrorAfter(const std::string& from, const std::string& to) {
    std::string text = base::ReadTextFile(kTruths + "/same.yaml");
    const std::size_t at = text.find(from);
    if (at == std::string::npos) return "same.yaml has no " + from;
    const std::string path = folder_.Write("truth.yaml", text.replace(at, from.size(), to));
    return ConfigErrorOf([&] { ReadTruth(path); });
  }
  test_support::TemporaryFolder folder_;
};

TEST_F(TruthFileTest, AnEngineThatDoesNotExistIsRefusedWithThoseThatDo) {
  EXPECT_THAT(ErrorAfter("engine: ode", "engine: bullet"),
              AllOf(HasSubstr("truth.yaml: engine is 'bullet'"), HasSubstr("ode")));
}

TEST_F(TruthFileTest, ABadKeyIsNamed) {
  EXPECT_THAT(ErrorAfter("sensing: fitted", "sensing: pictures"), HasSubstr("sensing is"));
  EXPECT_THAT(ErrorAfter("localisation:", "lokalisation:"), HasSubstr("localisation"));
  EXPECT_THAT(ErrorAfter("changes: {}", "changes: {object_mas: {}}"),
              AllOf(HasSubstr("uncertainty.changes"), HasSubstr("'object_mass'")));
}

TEST(TruthTest, SameChangesNothing) {
  imagination::ImaginationSetup imagined;
  imagined.uncertainty =
      std::make_shared<const imagination::Uncertainty>(imagination::NoUncertainty());
  const auto setup = SetupOf(ReadTruth(kTruths + "/same.yaml"), imagined);
  EXPECT_EQ(setup.uncertainty, imagined.uncertainty);
  EXPECT_EQ(setup.scene, imagined.scene);
}

}  // namespace
}  // namespace hires::evaluation::truth_test
