#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hires/knowledge/episode_diff.h"
#include "hires/knowledge/fluent_yaml.h"
#include "hires/knowledge/loading.h"
#include "hires/knowledge/query.h"
#include "hires/knowledge/store.h"

namespace CLI {
class App;
}

namespace hires::cli {

/// A Blackboard to talk to: a running node, or a file. All throw base::ConfigError.
class BlackboardAccess {
 public:
  virtual ~BlackboardAccess() = default;
  /// @param text  YAML; `path` stands for it in messages.
  virtual knowledge::LoadSummary Load(const std::string& text, const std::string& path,
                                      std::uint64_t seed) = 0;
  virtual knowledge::FluentPage Query(const knowledge::FluentQuery& query) = 0;
  virtual std::vector<knowledge::Episode> Episodes() = 0;
  virtual knowledge::Store::Statistics Stats() = 0;
  virtual std::string StorePath() = 0;  ///< of the file
  virtual knowledge::EpisodeDiff Compare(const knowledge::Episode& a, const knowledge::Episode& b,
                                         const knowledge::EpisodeDiffOptions& options) = 0;
};

using ConnectBlackboard = std::function<std::unique_ptr<BlackboardAccess>()>;

/// What was typed behind `hires blackboard`. Which verb it was, CLI11 knows.
struct BlackboardOptions {
  std::string store, config, json, file, output;
  std::uint64_t seed{1};
  std::string concept_name, instance, episode, sparql;
  std::vector<std::string> properties;
  std::optional<double> at;  ///< [s]
  bool exact{false}, ever{false}, imagined{false};
  std::uint64_t limit{0};                      ///< 0: all
  std::string first, second;                   ///< episodes to compare
  double tolerance{0.0}, time_tolerance{0.0};  ///< in the role's unit; [s]
  bool all{false};                             ///< also what is the same
  CLI::App *verb{nullptr}, *load{nullptr}, *query{nullptr}, *export_{nullptr};
  CLI::App *episodes{nullptr}, *diff{nullptr}, *stats{nullptr};
};

/// Adds the verb to the program.  @pre `options` outlives `app`.
void AddBlackboardVerb(CLI::App* app, BlackboardOptions* options);

/// "role" or "role=value". A whole number, a number, true and false are values of their kind;
/// anything else, or what stands in double quotes, is text.
/// @throws base::ConfigError where there is no role.
knowledge::FluentQuery::PropertyFilter ParsePropertyFilter(const std::string& text);

/// @param connect  To the running node; may be empty, then --store is needed.
/// @return 0.  @throws base::ConfigError for bad input, which ends the program with 1.
int RunBlackboardVerb(const BlackboardOptions& options, const std::string& package_folder,
                      const ConnectBlackboard& connect);

}  // namespace hires::cli
