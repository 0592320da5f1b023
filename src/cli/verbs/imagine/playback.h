#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace hires::cli {

/// Where one is in something recorded that is played, and what keys do about it. Time is handed in.
class Playback {
 public:
  /// From `begin` to `end` [s] of the recording, at first playing from its begin.
  /// @pre begin <= end
  Playback(double begin, double end);

  /// So much time has passed for who looks [s]. At the end it pauses.
  void Tick(double seconds);
  /// What was typed; escape sequences of cursor keys may come in parts.
  ///   space         pauses, goes on; at the end from the begin
  ///   left, right   a second back and forth, pausing none; also , and .
  ///   down, up      half and twice as fast; also - and +
  ///   0 .. 9        to the begin, to a tenth, ... to nine tenths of the whole
  ///   q             quits
  /// Other keys do nothing.
  void Type(std::string_view keys);

  double position() const { return position_; }  ///< [s] of the recording
  double rate() const { return rate_; }          ///< recorded seconds a second
  bool is_paused() const { return is_paused_; }
  bool wants_to_quit() const { return wants_to_quit_; }
  /// Whether it went elsewhere by a key since this was asked last.
  bool TakeJump();

  /// A line that shows where it is: "|=====>         |  4.20 of 12.05 s  x 1  paused".
  /// @param width  characters of the bar, at least 2
  std::string Slider(int width) const;

 private:
  void Press(char key);
  void Seek(double position);

  double begin_, end_, position_, rate_{1.0};  // [s]
  bool is_paused_{false}, wants_to_quit_{false}, has_jumped_{false};
  std::string escape_;  // begin of an escape sequence
};

/// For `--help` and the first line.
extern const char kPlaybackKeys[];

}  // namespace hires::cli
