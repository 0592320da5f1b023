#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace hires::knowledge {

/// Which of its three states a carried object is in (dissertation, Eq. 5.1).
enum class ToppleState : std::uint8_t { kNoTopple, kShaking, kTopple };
const char* ToString(ToppleState state);  ///< "notopple", "shaking", "topple"
/// @throws base::ConfigError for another word.
ToppleState ParseToppleState(const std::string& text);

constexpr double kExperiencePeriod = 0.05;  ///< [s] between two parts: 20 Hz, as the dissertation
/// [s] Moments that are farther apart do not follow each other: something is missing between them.
constexpr double kExperienceGap = 1.5 * kExperiencePeriod;
/// [s] by which dynamics are older than their part: to the middle of the four samples that they are
/// made of.
constexpr double kDynamicsDelay = 1.5 * kExperiencePeriod;

/// Motion of a body in the map, from positions (dissertation, Eq. 5.6). Speeds are not negative;
/// accelerations and jerks are their derivatives: negative where it slows down.
struct Dynamics {
  double v{0.0}, a{0.0}, j{0.0};                          ///< [m/s], [m/s^2], [m/s^3]
  double angular_v{0.0}, angular_a{0.0}, angular_j{0.0};  ///< [rad/s], ...
};

/// One sample of what a carried object went through (dissertation, Listing 5.3).
struct ToppleEpisodePart {
  double time{0.0};          ///< [s] of its run
  std::uint32_t episode{0};  ///< of its run: a fall ends one
  ToppleState state{ToppleState::kNoTopple};
  double alpha{0.0};      ///< [rad] tilt from the vertical
  double deviation{0.0};  ///< [m] across, from where it was put on the tray
  /// Of object and base, at `time` less kDynamicsDelay. The object's angular part is that of its
  /// tilt.
  Dynamics object, base;
  double x{0.0}, y{0.0}, yaw{0.0};  ///< [m, m, rad] of the base in the map
};

/// Parts that belong together: of one run, while one action lasts.
struct ExperienceBatch {
  std::string run;     ///< "fast/3"
  std::string action;  ///< "move_base_param(nt1, fast)"
  std::vector<ToppleEpisodePart> parts;
};

/// Which parts are wanted; what is not set does not matter.
struct ExperienceQuery {
  std::optional<ToppleState> state;
  std::optional<std::uint32_t> episode;
  double from{-std::numeric_limits<double>::infinity()};  ///< [s] included
  double to{std::numeric_limits<double>::infinity()};     ///< [s] included
  std::string run, action;  ///< empty: any; an action matches by any part of its text
};

/// Experiences in an SQLite file of their own (the Blackboard's store has one writer, which is the
/// Blackboard). Numbers are kept as 32-bit floats: 68 bytes of content each part. One object
/// writes; others may read meanwhile. An object belongs to one thread at a time.
class ExperienceStore {
 public:
  enum class Mode {
    kRead,
    kWrite,   ///< adds to what is there
    kReplace  ///< writes beside the file, which Finish() replaces
  };
  /// Opens, or makes, the file; one object on this computer writes it at a time.
  /// @throws base::ConfigError naming the path: no such file, no folder, another kind of file, who
  /// writes it, or that another program holds what shall be replaced.
  ExperienceStore(const std::string& path, Mode mode);
  ExperienceStore(ExperienceStore&&) noexcept;
  ~ExperienceStore();

  /// All of the batch or nothing; it survives the death of the process.
  /// @throws base::ConfigError if it cannot be written.
  void Write(const ExperienceBatch& batch);

  /// What was written takes the place of the file, all at once. Where the object or its process
  /// ends before, the file is as it was. Afterwards the object reads the file.
  /// @pre opened by kReplace, not yet finished.  @throws base::ConfigError if the file cannot be
  /// replaced; the object is of no use then.
  void Finish();

  /// A part and what it belongs to.
  struct Stored {
    ToppleEpisodePart part;
    const std::string* run{nullptr};
    const std::string* action{nullptr};
  };
  /// Parts in the order they were written.
  void ForEach(const ExperienceQuery& query, const std::function<void(const Stored&)>& take) const;

  std::uint64_t num_parts() const;
  std::uint64_t bytes() const;  ///< of the file that is written or read, and its log

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// A line of Listing 5.4, without a line's end: %time, header, episode, state, object's deviation
/// with its header, object's dynamics with theirs and without a pose, the base's with its pose.
/// Times in ns. The file has no heads, as there.
std::string CsvOf(const ToppleEpisodePart& part);

}  // namespace hires::knowledge
