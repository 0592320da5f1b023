#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "hires/knowledge/fluent_yaml.h"

// Series of runs of one scenario that differ in where things stand, in what the robot is told to do
// and in how well it senses (dissertation, section 5.7.2).
namespace hires::lab {

/// What takes one choice together.
struct SeriesGroup {
  std::string name;
  int choices{1};
  std::vector<std::string> members;  ///< instances of poses; keys, as Instruction
};

/// A file of `!FluentPoseModification` and `!Scenario` documents.
struct ScenarioSeries {
  std::string path, name;                                  ///< name: of the file, without ending
  std::vector<knowledge::PoseModification> modifications;  ///< hasZ without what ZOrigin says
  std::vector<knowledge::ScenarioSetting> settings;
  std::vector<SeriesGroup> groups;  ///< as they first appear: those of poses, then the others
};

/// @throws base::ConfigError as knowledge::LoadKnowledge, and naming document and line: nothing to
/// vary and nothing to begin from, documents of other kinds, a key that two documents give, groups
/// of one name with different numbers of choices.
ScenarioSeries ReadScenarioSeries(const std::string& path);

/// In which order runs go through the combinations of choices.
enum class SeriesOrder {
  kAll,   ///< each once, the first group's choice changing fastest, and then again from the first
  kDrawn  ///< each group of each run draws its own
};

/// How many combinations there are, at most 10^9.
std::int64_t NumCombinations(const ScenarioSeries& series);

/// Choice of each group, from 0, in the order of `groups`.
/// @param run  1, 2, ...
std::vector<int> ChoicesOfRun(const ScenarioSeries& series, SeriesOrder order, std::uint64_t seed,
                              int run);

/// Choice by group.
std::map<std::string, int> ByGroup(const ScenarioSeries& series, const std::vector<int>& choices);

/// What a run begins from, as the file says; empty where it does not.
struct SeriesStart {
  std::string scenario;     ///< name of config/scenarios, or file
  std::string instruction;  ///< "achieve serve_coffee_to_guest_Task guest1"
  std::string truth;        ///< name of config/truths, or file
  std::string world;        ///< file
  /// Where it says so: document and line by key ("Instruction").
  std::map<std::string, std::string> places;
};
/// Relative files count from the folder of the series.
SeriesStart StartOfRun(const ScenarioSeries& series, const std::vector<int>& choices);

/// The task that `hires achieve` takes: without the word "achieve" and without the original's
/// "_Task" behind the task's name.
std::string TaskOfInstruction(const std::string& instruction);

}  // namespace hires::lab
