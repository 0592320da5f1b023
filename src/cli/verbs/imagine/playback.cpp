#include "cli/verbs/imagine/playback.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"

namespace hires::cli {
namespace {

constexpr double kStep = 1.0;  // [s]
constexpr double kSlowest = 1.0 / 16, kFastest = 16.0;
constexpr double kAtEnd = 1e-9;  // [s]

}  // namespace

const char kPlaybackKeys[] =
    "space: pause, go on; left, right: 1 s; down, up: slower, faster; 0 .. 9: tenths; q: quit";

Playback::Playback(double begin, double end) : begin_(begin), end_(end), position_(begin) {
  HIRES_CHECK(begin <= end, "a recording does not end before it begins");
}

void Playback::Tick(double seconds) {
  if (is_paused_) return;
  position_ = std::min(position_ + rate_ * seconds, end_);
  if (position_ >= end_ - kAtEnd) is_paused_ = true;
}

void Playback::Type(std::string_view keys) {
  for (const char key : keys) {
    if (key == '\x1b') {
      escape_ = key;
    } else if (escape_ == "\x1b" && (key == '[' || key == 'O')) {
      escape_ += key;
    } else if (escape_.size() == 2) {
      escape_.clear();
      if (key == 'A') Press('+');
      if (key == 'B') Press('-');
      if (key == 'C') Press('.');
      if (key == 'D') Press(',');
    } else {
      escape_.clear();
      Press(key);
    }
  }
}

void Playback::Press(char key) {
  if (key == 'q') wants_to_quit_ = true;
  if (key == ',') Seek(position_ - kStep);
  if (key == '.') Seek(position_ + kStep);
  if (key == '-') rate_ = std::max(rate_ / 2, kSlowest);
  if (key == '+') rate_ = std::min(rate_ * 2, kFastest);
  if (key >= '0' && key <= '9') Seek(begin_ + 0.1 * (key - '0') * (end_ - begin_));
  if (key == ' ') {
    if (is_paused_ && position_ >= end_ - kAtEnd) Seek(begin_);
    is_paused_ = !is_paused_;
  }
}

void Playback::Seek(double position) {
  position_ = std::clamp(position, begin_, end_);
  has_jumped_ = true;
}

bool Playback::TakeJump() {
  const bool has_jumped = has_jumped_;
  has_jumped_ = false;
  return has_jumped;
}

std::string Playback::Slider(int width) const {
  HIRES_CHECK(width >= 2, "a bar with room in it");
  const double share = end_ > begin_ ? (position_ - begin_) / (end_ - begin_) : 1.0;
  const auto filled = static_cast<std::size_t>(std::lround(share * (width - 1)));
  return fmt::format("|{}>{}| {:6.2f} of {:.2f} s  x {}{}", std::string(filled, '='),
                     std::string(width - 1 - filled, ' '), position_, end_, rate_,
                     is_paused_ ? "  paused" : "");
}

}  // namespace hires::cli
