#pragma once

#include <class_loader/register_macro.hpp>
#include <cstddef>
#include <vector>

#include "hires/base/log.h"
#include "hires/robot/observation.h"
#include "hires/skills/action_set.h"
#include "hires/skills/skill_factory.h"

namespace hires::skills {

/// What a package of its own implements to bring actions along: one class in a shared library, and
/// behind it the line `HIRES_REGISTER_ACTIONS(MyActions)`. examples/own_action shows one.
class ActionLibrary {
 public:
  virtual ~ActionLibrary() = default;

  /// Sizes of what goes to and fro between program and library. Where they differ, the library was
  /// built with other headers. Not to be overridden.
  virtual std::vector<std::size_t> Layout() const {
    return {sizeof(ActionLibrary),       sizeof(Action),          sizeof(SkillSet),
            sizeof(robot::Observation),  sizeof(robot::Command),  sizeof(Status),
            sizeof(actions::ActionSpec), sizeof(base::ActionCall)};
  }

  /// Where log lines of the library go. Not to be overridden.
  virtual void SetLog(base::LogSink sink) const { base::SetLogSink(std::move(sink)); }

  virtual std::vector<Action> Actions() const = 0;
};

}  // namespace hires::skills

/// In a source file, outside of any namespace; once for each class.
#define HIRES_REGISTER_ACTIONS(Library) \
  CLASS_LOADER_REGISTER_CLASS(Library, hires::skills::ActionLibrary)
