#pragma once

#include <cstdint>

#include "hires/knowledge/fluent.h"
#include "knowledge/store/store_episodes.h"
#include "knowledge/store/store_names.h"
#include "knowledge/store/store_validity.h"

namespace hires::knowledge {

/// What writing, reading and querying a store work on.
struct StoreParts {
  explicit StoreParts(StoreFile* opened)
      : file(opened),
        words(&opened->database(), opened->read_only()),
        instances(opened),
        validities(opened),
        episodes(opened) {}

  StoreFile* file;
  Words words;
  Instances instances;
  Validities validities;
  Episodes episodes;
};

/// What a validity is as a fluent, told as of a change: what was ended later is still open.
Fluent ToFluent(const Validity& validity, std::int64_t as_of, StoreParts* parts);

}  // namespace hires::knowledge
