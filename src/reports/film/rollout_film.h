#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "hires/imagination/rollout_recording.h"
#include "hires/perception/picture.h"

namespace hires::reports {

struct FilmParams {
  int view_width{336}, view_height{300};  ///< [pixels] of each of the two views
  int most_frames{150};                   ///< a longer rollout is shown with fewer a second
  int threads{2};
};

/// Draws moments of a recorded rollout: on the left a camera that drives along and looks at the
/// load from beside, on the right one that looks over the whole drive. Once the load is off the
/// robot the first camera stops and looks after it. What is higher than 1.7 m is glass.
class RolloutFilm {
 public:
  /// @param setup      that the rollout was recorded with.
  /// @param recording  outlives this.
  /// @throws base::ConfigError for a rollout that could not begin, so that there is nothing to see.
  RolloutFilm(const imagination::RolloutSetup& setup,
              const imagination::RolloutRecording& recording, const FilmParams& params = {});
  ~RolloutFilm();

  int num_samples() const;
  /// Both views at a sample of the recording; above what is done, below time, speed, tilt and what
  /// has just happened. @pre 0 <= sample < num_samples()
  perception::Picture FrameAt(int sample) const;
  /// The first view alone, the time below. @pre as FrameAt
  perception::Picture CloseUpAt(int sample) const;
  /// The first view alone with all that FrameAt says, the last line below. @pre as FrameAt
  perception::Picture StoryAt(int sample) const;

  const FilmParams& params() const;
  const imagination::RolloutRecording& recording() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The rollout in real time, the last frame for two seconds.
/// @throws base::ConfigError if the file cannot be written, as below.
void WriteGif(const RolloutFilm& film, const std::string& path);

/// Two rollouts beside each other, each by its first view, in real time from the same begin; the
/// shorter one stands still at its end.  @pre both have the same params.  @throws as above.
void WriteGif(const RolloutFilm& left, const RolloutFilm& right, const std::string& path);

/// Samples at which to look at a rollout that is to be told in `count` pictures: from begin to end
/// or, where something falls, from half a second before it
/// begins to tip (1.5 s before it falls at most) to a second after it fell.
/// @pre count >= 2
std::vector<int> MomentsOf(const imagination::RolloutRecording& recording, int count);

/// `count` close-ups side by side, as PNG.  @pre count >= 2
void WriteStrip(const RolloutFilm& film, int count, const std::string& path);

}  // namespace hires::reports
