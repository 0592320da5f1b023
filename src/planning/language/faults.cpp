#include "planning/language/faults.h"

#include "hires/base/short_text.h"
#include "hires/base/text.h"

namespace hires::planning {

void Faults::Require() const {
  if (texts_.empty()) return;
  throw base::ConfigError(base::Join(base::FirstLines(texts_), "\n"));
}

}  // namespace hires::planning
