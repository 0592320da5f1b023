#include "hires/control/move_base_keeper.h"

#include <fmt/format.h>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/text.h"

namespace hires::control {
namespace {

using base::ConfigError;
using base::Log;
using base::LogLevel;

/// What a journal says was there first, else what is there.
PlannerValues OriginalsOf(const PlannerValues& wanted, const PlannerValues& having,
                          const std::optional<MoveBaseJournal>& journal) {
  PlannerValues originals = journal ? journal->original : PlannerValues{};
  for (const auto& [name, value] : wanted) originals.emplace(name, having.at(name));
  return originals;
}

/// What is to be put back, given what is there.
PlannerValues ToPutBack(const MoveBaseJournal& journal, const PlannerValues& having) {
  PlannerValues values;
  for (const auto& [name, original] : journal.original) {
    const auto now = having.find(name);
    if (now == having.end()) {
      Log(LogLevel::kWarn, fmt::format("{}: {} is gone; it was {:g} before the drive",
                                       journal.server, name, original));
    } else if (WhatDiffers({{name, journal.in_force.at(name)}}, having).empty()) {
      values[name] = original;
    } else if (!WhatDiffers({{name, original}}, having).empty()) {
      Log(LogLevel::kWarn,
          fmt::format(
              "{}: {} was set to {:g} by another program during the drive, and stays so; it "
              "was {:g} before",
              journal.server, name, now->second, original));
    }
  }
  return values;
}

}  // namespace

MotionSetKeeper::MotionSetKeeper(const RobotNames::MoveBase& names, std::string journal_path,
                                 Reconfigure reconfigure)
    : names_(names), path_(std::move(journal_path)), reconfigure_(std::move(reconfigure)) {}

PlannerValues MotionSetKeeper::Call(const std::string& server, const PlannerValues& changes) const {
  try {
    return reconfigure_(server, changes);
  } catch (const ConfigError& error) {
    throw ConfigError(fmt::format("{}: {}", server, error.what()));
  }
}

void MotionSetKeeper::Apply(const std::string& set_name, const robot::MotionSet& set) {
  in_force_.clear();
  std::optional<MoveBaseJournal> before = ReadJournal(path_);
  if (before && before->server != names_.planner) {  // the robot's names have changed since
    Restore();
    before.reset();
  }
  const PlannerValues having = Call(names_.planner, {});
  MoveBaseJournal journal;
  journal.server = names_.planner;
  journal.set_name = set_name;
  try {
    journal.in_force = InWordsOf(having, names_, set);
  } catch (const ConfigError& error) {
    throw ConfigError(fmt::format("{}: {}", names_.planner, error.what()));
  }
  journal.original = OriginalsOf(journal.in_force, having, before);
  for (const auto& [name, value] : journal.original) journal.in_force.emplace(name, value);
  Change(journal, having);
}

/// @param having  all that the server has before.
void MotionSetKeeper::Change(const MoveBaseJournal& journal, const PlannerValues& having) {
  WriteJournal(path_, journal);
  const PlannerValues got = Call(journal.server, journal.in_force);
  const std::string differs = WhatDiffers(journal.in_force, got);
  if (differs.empty()) {
    in_force_ = journal.in_force;
    Log(LogLevel::kInfo,
        fmt::format("motion_set={} server={} values=\"{}\" before=\"{}\"", journal.set_name,
                    journal.server, ToText(journal.in_force), ToText(journal.original)));
    return;
  }
  // What the server made of it is what has to be undone.
  MoveBaseJournal made = journal;
  for (auto& [name, value] : made.in_force) {
    const auto now = got.find(name);
    value = now != got.end() ? now->second : having.at(name);
  }
  WriteJournal(path_, made);
  Restore();
  throw ConfigError(
      fmt::format("{}: did not take motion set {}: {}; give the planner limits that allow it, or "
                  "the robot another motion set",
                  journal.server, journal.set_name, differs));
}

void MotionSetKeeper::Restore() {
  in_force_.clear();
  const std::optional<MoveBaseJournal> journal = ReadJournal(path_);
  if (!journal) return;
  const PlannerValues originals = ToPutBack(*journal, Call(journal->server, {}));
  if (!originals.empty()) {
    const std::string differs = WhatDiffers(originals, Call(journal->server, originals));
    if (!differs.empty()) {
      throw ConfigError(
          fmt::format("{}: did not take back what it had before the drive: {}; {} keeps it",
                      journal->server, differs, path_));
    }
  }
  RemoveJournal(path_);
  Log(LogLevel::kInfo, fmt::format("motion_set={} server={} ended, put back: \"{}\"",
                                   journal->set_name, journal->server, ToText(originals)));
}

void MotionSetKeeper::Verify() const {
  const std::optional<MoveBaseJournal> journal = ReadJournal(path_);
  if (!journal) throw ConfigError(fmt::format("{}: is gone in the middle of a drive", path_));
  const std::string differs = WhatDiffers(journal->in_force, Call(journal->server, {}));
  if (!differs.empty()) {
    throw ConfigError(
        fmt::format("{}: was changed by another program: {}", journal->server, differs));
  }
}

}  // namespace hires::control
