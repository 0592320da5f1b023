#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hires/geometry/pose.h"

namespace hires::sensing {

enum class FrameStatus {
  kFound,
  kUnknown,       ///< one of the frames was never received
  kNotConnected,  ///< both are known, and nothing leads from one to the other
  kNotThen,       ///< they are connected, but not known at that time
  kInLoop         ///< above one of the frames the links lead in a circle
};

struct FramePose {
  FrameStatus status{FrameStatus::kUnknown};
  geometry::Pose3 X_PC;  ///< of the child in the parent, where it was found
  bool is_found() const { return status == FrameStatus::kFound; }
};

/// What is known of how frames move against each other. On a robot that is tf.
class FrameTree {
 public:
  virtual ~FrameTree() = default;
  /// Between two moments that are known it is interpolated. Frames are named without a slash.
  virtual FramePose Find(const std::string& parent, const std::string& child,
                         double time) const = 0;
  /// The newest moment [s] for which Find works; infinity if the two never move against each other,
  /// nothing if they are not connected.
  virtual std::optional<double> NewestOf(const std::string& parent,
                                         const std::string& child) const = 0;
  /// Of all frames that it was told of, in any order.
  virtual std::vector<std::string> Names() const = 0;
  /// The clock began again: what moves is unknown, what never does stays.
  virtual void ForgetMoving() = 0;
};

/// The frame without the slash that old nodes put in front.
std::string BareFrame(const std::string& frame);

/// The velocity of a frame B that is fixed to C, in B's axes; V_C is in C's.
geometry::Twist2 MovedTo(const geometry::Pose2& X_CB, const geometry::Twist2& V_C);

}  // namespace hires::sensing
