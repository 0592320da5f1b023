#include "reports/film/label_layout.h"

#include <algorithm>

#include "reports/film/picture_text.h"

namespace hires::reports {
namespace {

constexpr int kLabelGap = 8;     // [pixels] between a point and its label
constexpr int kPointRadius = 4;  // [pixels] radius of a point
constexpr int kMostLines = 8;    // that a label may lie above or below its point

/// [pixels], its ends excluded.
struct Rectangle {
  int left, top, right, bottom;
  bool Overlaps(const Rectangle& other) const {
    return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
  }
};

Rectangle RectangleOf(const LabelPlace& place, int width) {
  return {place.column, place.row, place.column + width, place.row + kTextHeight};
}

class Layout {
 public:
  Layout(const std::vector<Labelled>& points, int picture_width, int picture_height)
      : width_(picture_width), height_(picture_height) {
    for (const Labelled& p : points)
      taken_.push_back(
          {p.x - kPointRadius, p.y - kPointRadius, p.x + kPointRadius, p.y + kPointRadius});
  }

  LabelPlace Take(const Labelled& point) {
    LabelPlace place = Inside(point, point.x + kLabelGap, point.y);
    FindFree(point, &place);
    taken_.push_back(RectangleOf(place, point.width));
    return place;
  }

 private:
  LabelPlace Inside(const Labelled& point, int column, int row) const {
    return {std::clamp(column, 0, std::max(0, width_ - point.width)),
            std::clamp(row, 0, std::max(0, height_ - kTextHeight))};
  }

  bool IsFree(const Rectangle& wanted) const {
    return std::none_of(taken_.begin(), taken_.end(),
                        [&](const Rectangle& one) { return one.Overlaps(wanted); });
  }

  void FindFree(const Labelled& point, LabelPlace* place) const {
    for (int line = 0; line <= kMostLines; ++line) {
      for (const int down : {line, -line}) {
        for (const int column : {point.x + kLabelGap, point.x - kLabelGap - point.width}) {
          const LabelPlace tried = Inside(point, column, point.y + down * kTextHeight);
          if (!IsFree(RectangleOf(tried, point.width))) continue;
          *place = tried;
          return;
        }
      }
    }
  }

  int width_, height_;
  std::vector<Rectangle> taken_;
};

}  // namespace

std::vector<LabelPlace> PlaceLabels(const std::vector<Labelled>& points, int picture_width,
                                    int picture_height) {
  Layout layout(points, picture_width, picture_height);
  std::vector<LabelPlace> places;
  for (const Labelled& point : points) places.push_back(layout.Take(point));
  return places;
}

}  // namespace hires::reports
