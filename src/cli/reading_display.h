#pragma once

#include <functional>
#include <ostream>

#include "hires/base/progress.h"

namespace hires::cli {

/// Writes what comes when it is due (base::ProgressPace): "reading hall.world: 43 %".
/// @param is_drawn_over  one line that is drawn over itself, and removed at the end.
/// @param now            [s] of a clock that never goes back.
base::ProgressSink ShowReadingOn(std::ostream* out, bool is_drawn_over,
                                 const std::function<double()>& now);

/// While it lives, what takes long to read (base::ReportProgress) is shown on standard error.
class ReadingDisplay {
 public:
  /// @param is_quiet  show nothing.
  explicit ReadingDisplay(bool is_quiet);
  ~ReadingDisplay();
  ReadingDisplay(const ReadingDisplay&) = delete;
  ReadingDisplay& operator=(const ReadingDisplay&) = delete;
};

}  // namespace hires::cli
