#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hires/knowledge/old_stores.h"
#include "hires/knowledge/ontology.h"
#include "hires/knowledge/store.h"

namespace hires::knowledge {

/// config/blackboard.yaml: where the Blackboard keeps what it is told, what it knows at first, and
/// how much it takes on at once.
struct BlackboardConfig {
  std::vector<std::string> ontology;   ///< paths, Turtle or RDF/XML
  std::string store;                   ///< path, or ":memory:"
  StoreOptions options;                ///< durability, cache, bound of the file
  OldStoreLimits old_runs;             ///< which stores of earlier runs are kept beside it
  std::vector<std::string> knowledge;  ///< paths, loaded into an empty store
  std::vector<std::string> topics;     ///< paths, their demand topics are opened
  int threads{8};                      ///< requests answered side by side
  int max_waiting{1000};               ///< writing requests that may wait
  int max_group{1000};                 ///< fluents that waiting requests share a transaction for
  int queue_size{1000};                ///< messages kept for a slow subscriber
  int history{10'000};                 ///< changes kept of each demand topic, for who missed some
  int max_topics{200};                 ///< demand topics
  bool imagined{false};                ///< changes of imagined episodes have a topic, too
};

/// Relative paths count from the folder of the file, but the store's from the working directory; ~
/// stands for the home folder.  @throws base::ConfigError naming file and key.
BlackboardConfig ReadBlackboardConfig(const std::string& path);

/// "~/x" with the home folder in place of ~, and "~/.ros/x" with $ROS_HOME in place of ~/.ros,
/// where that is set; anything else as it is.  @throws base::ConfigError where HOME is not set.
std::string ExpandHome(const std::string& path);

/// Makes the folder in which a store is to lie.  @throws base::ConfigError naming it.
void MakeFolderOf(const std::string& store);

}  // namespace hires::knowledge
