#pragma once

#include <map>
#include <string>
#include <vector>

#include "hires/actions/action_spec.h"

namespace hires::actions {

/// Actions by name. Names compare without regard to case, and with the planner's `!` or without.
class Catalogue {
 public:
  /// @throws base::ConfigError as CheckSpec, or if there is an action of that name.
  void Add(ActionSpec spec);

  const ActionSpec* Find(const std::string& name) const;  ///< null if there is none
  /// @throws base::ConfigError with names like it.
  const ActionSpec& Get(const std::string& name) const;

  const std::map<std::string, ActionSpec>& specs() const { return specs_; }

 private:
  std::map<std::string, ActionSpec> specs_;
};

/// Whether nothing else may turn the head while an action of this name runs; so it is for an action
/// that the catalogue does not know.
bool MayUseHead(const Catalogue& catalogue, const std::string& name);

/// What the robot can do without libraries from elsewhere, in the words of
/// config/domains/restaurant.lisp.
const Catalogue& OwnActions();

}  // namespace hires::actions
