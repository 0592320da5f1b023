#pragma once

#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "hires/sensing/frame_tree.h"
#include "hires/sensing/history.h"

namespace hires::test_support {

/// Frames that a test tells of, one link at a time; chains of links are not followed.
class FakeFrameTree : public sensing::FrameTree {
 public:
  using Pose3 = geometry::Pose3;
  using Link = std::pair<std::string, std::string>;

  void Tell(const std::string& parent, const std::string& child, double stamp, const Pose3& X_PC) {
    Know(parent, child);
    moving_[{parent, child}].Insert(stamp, X_PC);
  }
  void TellFixed(const std::string& parent, const std::string& child, const Pose3& X_PC) {
    Know(parent, child);
    fixed_[{parent, child}] = X_PC;
  }

  sensing::FramePose Find(const std::string& parent, const std::string& child,
                          double time) const override {
    using sensing::FrameStatus;
    if (names_.count(parent) == 0 || names_.count(child) == 0) return {};
    if (const auto fixed = fixed_.find({parent, child}); fixed != fixed_.end()) {
      return {FrameStatus::kFound, fixed->second};
    }
    const auto moving = moving_.find({parent, child});
    if (moving == moving_.end()) return {FrameStatus::kNotConnected, {}};
    const auto* before = moving->second.Before(time);
    if (before == nullptr || time > moving->second.back().stamp) return {FrameStatus::kNotThen, {}};
    return {FrameStatus::kFound, before->value};
  }
  std::optional<double> NewestOf(const std::string& parent,
                                 const std::string& child) const override {
    if (fixed_.count({parent, child}) > 0) return std::numeric_limits<double>::infinity();
    const auto moving = moving_.find({parent, child});
    if (moving == moving_.end() || moving->second.empty()) return std::nullopt;
    return moving->second.back().stamp;
  }
  std::vector<std::string> Names() const override { return {names_.begin(), names_.end()}; }
  void ForgetMoving() override { moving_.clear(); }

 private:
  void Know(const std::string& parent, const std::string& child) {
    names_.insert(parent);
    names_.insert(child);
  }

  std::set<std::string> names_;
  std::map<Link, sensing::History<Pose3>> moving_;
  std::map<Link, Pose3> fixed_;
};

}  // namespace hires::test_support
