#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "hires/knowledge/fluent_yaml.h"
#include "hires/knowledge/live_view.h"
#include "hires/translation/translator.h"
#include "hires/world/object_catalogue.h"

/// The restaurant, the PR2 and what is known at first, as the package comes with them.
namespace hires::test_support {

inline std::shared_ptr<const knowledge::Ontology> RestaurantOntology() {
  static const auto ontology = std::make_shared<const knowledge::Ontology>(
      knowledge::Ontology::FromFiles({HIRES_SOURCE_DIR "/config/ontology/upper.ttl",
                                      HIRES_SOURCE_DIR "/config/ontology/race.ttl"}));
  return ontology;
}

inline std::vector<knowledge::Fluent> RestaurantFluents() {
  return knowledge::LoadKnowledge(HIRES_SOURCE_DIR "/config/knowledge/restaurant.yaml").fluents;
}

inline const translation::TranslatorContext& RestaurantContext() {
  static const translation::TranslatorContext context = [] {
    translation::TranslatorContext made = translation::MakeContext(
        world::LoadWorld(HIRES_SOURCE_DIR "/worlds/restaurant.world"),
        robot::LoadRobot(HIRES_SOURCE_DIR "/config/robots/pr2.yaml"),
        world::LoadCatalogueModels(HIRES_SOURCE_DIR "/worlds/objects.yaml"), RestaurantOntology());
    const knowledge::LiveView view(RestaurantFluents(), 1);
    made.areas = translation::WithKnowledge(made.areas, view, *made.ontology);
    return made;
  }();
  return context;
}

inline std::vector<std::string> Texts(const std::vector<base::Atom>& atoms) {
  std::vector<std::string> texts;
  for (const base::Atom& atom : atoms) texts.push_back(base::ToString(atom));
  std::sort(texts.begin(), texts.end());
  return texts;
}

}  // namespace hires::test_support
