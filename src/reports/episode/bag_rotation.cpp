#include "reports/episode/bag_rotation.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

namespace hires::reports {

BagRotation::BagRotation(std::string folder, std::string start, const BagLimits& limits)
    : folder_(std::move(folder)), start_(std::move(start)), limits_(limits) {}

bool BagRotation::IsFull(std::uint64_t size, double now) const {
  return size >= limits_.max_size || now - begun_ >= limits_.max_duration || now < begun_;
}

std::string BagRotation::Next(double now) {
  ++number_;
  begun_ = now;
  return active_path();
}

std::string BagRotation::active_path() const { return final_path() + ".active"; }

std::string BagRotation::final_path() const {
  const std::string name = fmt::format("hires_{}_{}.bag", start_, number_);
  return (std::filesystem::path(folder_) / name).string();
}

}  // namespace hires::reports
