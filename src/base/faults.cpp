#include "hires/base/faults.h"

#include "hires/base/short_text.h"
#include "hires/base/text.h"

namespace hires::base {

void Faults::Require() const {
  if (texts_.empty()) return;
  throw ConfigError(Join(FirstLines(texts_), "\n"));
}

}  // namespace hires::base
