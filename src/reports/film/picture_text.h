#pragma once

#include <string>

#include "hires/perception/picture.h"

namespace hires::reports {

constexpr int kTextHeight = 20;  ///< [pixels] of a line

/// Writes one line in strokes (OpenCV), its left end at `column`, in the line of `kTextHeight` rows
/// from `row` on. What does not fit before `right_end` ends with dots. Characters are those of
/// ASCII; others become question marks.
void WriteLine(const std::string& text, int column, int row, int right_end,
               const perception::Colour& colour, perception::Picture* picture);

/// [pixels]
int WidthOf(const std::string& text);

}  // namespace hires::reports
