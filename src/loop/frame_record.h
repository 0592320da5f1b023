#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hires/sensing/frame_tree.h"
#include "hires/sensing/history.h"

namespace hires::loop {

/// A tree of frames for one process: told of pairs of frames, and asked for the same pairs. The
/// robot's links are not in it: its estimator knows them by its joints.
class FrameRecord : public sensing::FrameTree {
 public:
  /// @param history  [s] that is kept before the newest.
  explicit FrameRecord(double history) : history_(history) {}

  void Tell(const std::string& parent, const std::string& child, double time,
            const geometry::Pose3& X_PC);

  sensing::FramePose Find(const std::string& parent, const std::string& child,
                          double time) const override;
  std::optional<double> NewestOf(const std::string& parent,
                                 const std::string& child) const override;
  std::vector<std::string> Names() const override;
  void ForgetMoving() override { poses_.clear(); }

 private:
  const double history_;
  std::map<std::pair<std::string, std::string>, sensing::History<geometry::Pose3>> poses_;
};

}  // namespace hires::loop
