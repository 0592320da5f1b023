#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "hires/imagination/imagination_setup.h"

namespace hires::evaluation {

/// What robot and world are really like where a robot is played that tests imagination. Imagination
/// is told nothing of it. As it is made, it is `same`: imagination's own model, which tests that
/// all parts work together, and nothing else.
struct Truth {
  std::string name{"same"};  ///< as results name it
  /// What all hidden quantities are drawn from; null: what imagination draws from.
  std::shared_ptr<const imagination::Uncertainty> uncertainty;
  /// Quantities that are drawn from something else than `uncertainty` says.
  std::map<std::string, imagination::Distribution> changes;
  bool senses_ideally{false};     ///< laser, camera and encoders do not err
  bool localises_ideally{false};  ///< nor does localisation
};

/// The file of a truth. @param name  of a file in `folder`, without .yaml; or a path. Empty: same.
/// @throws base::ConfigError for an unknown name, with names like it.
std::string TruthPath(const std::string& name, const std::string& folder);

/// Reads a file like config/truths/same.yaml.  @throws base::ConfigError naming file and key.
Truth ReadTruth(const std::string& path);

/// What a robot is played in under this truth. @param imagined  what imagination has.
imagination::ImaginationSetup SetupOf(const Truth& truth,
                                      const imagination::ImaginationSetup& imagined);

}  // namespace hires::evaluation
