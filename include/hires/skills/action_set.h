#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hires/actions/catalogue.h"
#include "hires/base/action.h"
#include "hires/skills/skill.h"

namespace hires::skills {

struct SkillSet;

/// Makes the skill for a call whose number of arguments is right.
/// @throws base::ConfigError for an argument that names nothing.
using SkillMaker =
    std::function<std::unique_ptr<Skill>(const SkillSet& skills, const base::ActionCall& call)>;

/// Which of its places an action's skill goes by.
enum class GoesBy {
  kToldPlace,
  kSeenPlace  ///< where the base's laser sees the robot beside furniture, in scenes that ask for it
};

/// How an action is done.
struct Way {
  SkillMaker make;
  GoesBy goes_by{GoesBy::kToldPlace};
};

/// An action: what it is, and how it is done.
struct Action {
  actions::ActionSpec spec;
  SkillMaker make;
  GoesBy goes_by{GoesBy::kToldPlace};
};

/// A file that actions came from.
struct LibraryOfActions {
  std::string path;
  std::uint64_t hash{0};  ///< of its bytes
};
/// "libown_action.so 00ab..." of each, or "no library", for messages.
std::string ToString(const std::vector<LibraryOfActions>& libraries);

/// All actions that a robot, or a simulation of it, can do. Constant once made.
class ActionSet {
 public:
  /// @throws base::ConfigError as actions::Catalogue::Add, or without a maker.
  void Add(Action action);
  void Note(LibraryOfActions library) { libraries_.push_back(std::move(library)); }

  const actions::Catalogue& catalogue() const { return catalogue_; }
  /// @throws base::ConfigError with names like it.
  const Way& WayOf(const std::string& name) const;
  const std::vector<LibraryOfActions>& libraries() const { return libraries_; }

  /// Of all descriptions, and of the bytes of all libraries: who has another one may do something
  /// else under the same name.
  std::uint64_t hash() const;

 private:
  actions::Catalogue catalogue_;
  std::map<std::string, Way> ways_;
  std::vector<LibraryOfActions> libraries_;
};

/// actions::OwnActions() with the skills of this layer.
std::shared_ptr<const ActionSet> OwnActionSet();

}  // namespace hires::skills
