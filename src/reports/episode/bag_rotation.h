#pragma once

#include <cstdint>
#include <string>

namespace hires::reports {

/// When a recorder begins its next bag.
struct BagLimits {
  std::uint64_t max_size{2048ULL << 20};  ///< [bytes]
  double max_duration{3600.0};            ///< [s] of the robot's clock
  std::uint64_t chunk{64ULL << 10};       ///< [bytes] that are not on disk yet, at most
};

/// Names and limits of the bags of one recording: FOLDER/hires_2026-11-21-20-41-00_0.bag,
/// ..._1.bag. While one is written, its name ends with `.active`, as that of `rosbag record` does.
class BagRotation {
 public:
  /// @param start  local date and time, as it shall stand in the names.
  BagRotation(std::string folder, std::string start, const BagLimits& limits);

  /// Whether the next message belongs into a new bag. A clock that began again begins one, too, as
  /// a bag is read in the order of its stamps.
  bool IsFull(std::uint64_t size, double now) const;
  /// The next bag begins.  @return its path while it is written.
  std::string Next(double now);

  bool has_begun() const { return number_ >= 0; }
  std::string active_path() const;
  std::string final_path() const;

 private:
  std::string folder_, start_;
  BagLimits limits_;
  int number_{-1};
  double begun_{0.0};  // [s] of the present bag
};

}  // namespace hires::reports
