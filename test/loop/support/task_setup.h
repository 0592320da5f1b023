#pragma once

#include <cmath>
#include <string>

#include "loop/task_loop.h"

namespace hires::test_support {

inline const std::string kConfig = HIRES_SOURCE_DIR "/config/";

/// What the package comes with, loaded once by each program.
inline const loop::LoopSetup& TheSetup() {
  static const loop::LoopSetup setup(kConfig + "loop.yaml");
  return setup;
}

inline bool StandsOnTable1(const loop::LoopRun& run, const std::string& object) {
  const simulation::ObjectFate& fate = run.truth.objects.at(object);
  return fate.stands && std::abs(fate.X_MO.translation.z() - 0.73) < 0.02;
}

}  // namespace hires::test_support
