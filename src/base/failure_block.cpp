#include "hires/base/failure_block.h"

namespace hires::base {
namespace {

constexpr int kLastOfThings = 99;

}  // namespace

bool IsOfThings(FailureCode code) {
  return code != FailureCode::kNone && static_cast<int>(code) <= kLastOfThings;
}

}  // namespace hires::base
