#pragma once

#include <vector>

namespace hires::reports {

/// What a label belongs to, and how wide its text is. [pixels]
struct Labelled {
  int x, y;
  int width;
};

/// Upper left corner of a label. [pixels]
struct LabelPlace {
  int column, row;
  bool operator==(const LabelPlace& other) const {
    return column == other.column && row == other.row;
  }
};

/// Places labels of kTextHeight beside their points: right of them where there is room, else left,
/// else in the nearest line above or below, so that no label lies on another one or on a point. In
/// the order given; where there is no room at all, right of the point. All lie in the picture if
/// they are no wider.
std::vector<LabelPlace> PlaceLabels(const std::vector<Labelled>& points, int picture_width,
                                    int picture_height);

}  // namespace hires::reports
