#include "reports/film/picture_text.h"

#include <opencv2/imgproc.hpp>

namespace hires::reports {
namespace {

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kScale = 0.42;

}  // namespace

int WidthOf(const std::string& text) {
  return cv::getTextSize(text, kFont, kScale, 1, nullptr).width;
}

void WriteLine(const std::string& text, int column, int row, int right_end,
               const perception::Colour& colour, perception::Picture* picture) {
  std::string fitting = text;
  while (column + WidthOf(fitting) > right_end && fitting.size() > 3) {
    fitting = fitting.substr(0, fitting.size() - 4) + "...";
  }
  cv::Mat pixels(picture->height, picture->width, CV_8UC3, picture->pixels.data());
  cv::putText(pixels, fitting, {column, row + 14}, kFont, kScale,
              cv::Scalar(colour[0], colour[1], colour[2]), 1, cv::LINE_AA);
}

}  // namespace hires::reports
