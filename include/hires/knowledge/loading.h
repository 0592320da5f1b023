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

/// Adds what the file says, all of it or nothing: poses moved as its modifications say. Poses that
/// a modification names and the file does not bring are those that the store holds. Topics are not
/// opened.
/// @param changes  may be null: what it changed.
/// @throws base::ConfigError naming the file: what Store::Add refuses, or ApplyModifications; a
/// pose that is in neither is named. All fluents that the ontology does not allow, or whose angles
/// are more than a turn, are told at once, with their places.
LoadSummary Load(const KnowledgeFile& file, base::Rng rng, const Assertion& by, Store* store,
                 std::vector<Change>* changes = nullptr);

}  // namespace hires::knowledge
