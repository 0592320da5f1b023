#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "hires/knowledge/fluent_yaml.h"
#include "hires/knowledge/store.h"

namespace hires::knowledge {

/// What the loading of a file came to.
struct LoadSummary {
  std::map<std::string, std::size_t> concepts;  ///< fluents of each that said something new
  std::size_t known{0};                         ///< fluents that were known already
  std::size_t modifications{0};                 ///< applied
  std::vector<std::string> topics;              ///< demand topics that the file asks for
};

/// The fluents of a file as they go into the store: moved as its modifications say. Poses that a
/// modification names and the file does not bring are those that the store holds.
/// @throws base::ConfigError as ApplyModifications; a pose that is in neither is named.
std::vector<Fluent> FluentsToLoad(const KnowledgeFile& file, base::Rng rng, const Store& store);

/// @param changes  What adding FluentsToLoad changed.
LoadSummary Summarize(const KnowledgeFile& file, std::size_t num_fluents,
                      const std::vector<Change>& changes);

/// Adds what the file says, all of it or nothing. Its topics are not opened.
LoadSummary Load(const KnowledgeFile& file, base::Rng rng, const Assertion& by, Store* store);

}  // namespace hires::knowledge
