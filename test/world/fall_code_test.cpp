#include "hires/world/fall_code.h"

#include <gtest/gtest.h>

namespace hires::world::fall_code_test {
namespace {

using base::FailureCode;

TEST(FallCodeTest, EveryFallHasItsCode) {
  struct Row {
    Fall fall;
    FailureCode load, handled, held;
  };
  const Row rows[] = {
      {Fall::kNone, FailureCode::kNone, FailureCode::kNone, FailureCode::kNone},
      {Fall::kLost, FailureCode::kObjectLost, FailureCode::kObjectLost, FailureCode::kObjectLost},
      {Fall::kToppled, FailureCode::kObjectFell, FailureCode::kObjectToppled,
       FailureCode::kObjectSlipped},
      {Fall::kDropped, FailureCode::kObjectFell, FailureCode::kObjectFell,
       FailureCode::kObjectSlipped},
      {Fall::kSlid, FailureCode::kObjectSlid, FailureCode::kObjectSlid,
       FailureCode::kObjectSlipped}};
  for (const Row& row : rows) {
    EXPECT_EQ(CodeOf(row.fall, FallenThing::kLoad), row.load);
    EXPECT_EQ(CodeOf(row.fall, FallenThing::kHandled), row.handled);
    EXPECT_EQ(CodeOf(row.fall, FallenThing::kHeld), row.held);
  }
}

}  // namespace
}  // namespace hires::world::fall_code_test
