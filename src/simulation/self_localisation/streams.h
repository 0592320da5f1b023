#pragma once

#include <cstdint>

/// Forks of the generator of a robot that finds its place by itself.
namespace hires::simulation::place_stream {

enum Stream : std::uint64_t { kWheels, kGyro, kScans, kFilter, kStart, kCarried, kFloor };

}  // namespace hires::simulation::place_stream
