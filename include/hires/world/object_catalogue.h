#pragma once

#include <map>
#include <memory>
#include <string>

#include "hires/world/world.h"

namespace hires::world {

/// Reads which model folder each instance name stands for ("peppermill1: peppermill_thesis").
/// Keys are as in the file; they compare without regard to case. The key `concepts` is no instance:
/// its block says which concept of the ontology a model folder is ("peppermill_thesis:
/// Peppermill"), and `liquids` what a model folder holds ("coffee_cup: {radius: 0.036, fill: 0.07,
/// rim: 0.08}", world::Liquid); models read by the functions below know both.
/// @throws base::ConfigError: no map of text to text, two names that differ in case only, a value
/// that is no plain folder name.
std::map<std::string, std::string> LoadObjectCatalogue(const std::string& path);

/// The model of each instance of the catalogue. A model that several instances name is read once
/// and shared.
/// @throws base::ConfigError as LoadObjectCatalogue and FindObjectModel; for a concept of a folder
/// that is not there.
std::map<std::string, std::shared_ptr<const ObjectModel>> LoadCatalogueModels(
    const std::string& catalogue_path);

/// The object that a user means: an instance name of the catalogue (case ignored), a folder of
/// models/ beside the catalogue, or a path as of LoadObjectModel.
/// @throws base::ConfigError naming what is known that comes near; as LoadObjectModel.
ObjectModel FindObjectModel(const std::string& name_or_path, const std::string& catalogue_path);

}  // namespace hires::world
