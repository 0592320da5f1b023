#include "hires/perception/recogniser_config.h"

#include <filesystem>
#include <map>

#include "hires/base/param_reader.h"
#include "hires/base/text.h"
#include "hires/world/object_catalogue.h"

namespace hires::perception {
namespace {

using base::Between;
using base::ParamReader;

void ReadTable(ParamReader in, TableParams* table) {
  table->min_height = in.Get("min_height", Between(0.0, 3.0));
  table->max_height = in.Get("max_height", Between(0.0, 3.0));
  if (table->max_height <= table->min_height) in.Fail("max_height", "wanted more than min_height");
  table->max_inclination = in.Get("max_inclination", Between(0.0, 1.5));
}

void ReadThings(ParamReader in, SegmentationParams* params) {
  params->max_above = in.Get("max_above", Between(0.01, 3.0));
  params->max_beside = in.Get("max_beside", Between(0.0, 1.0));
  params->parts.min_points = in.Get("min_points", Between(10, 1000000));
}

void ReadRecognition(ParamReader in, RecogniserParams* params) {
  params->max_extent = in.Get("max_extent", Between(0.01, 3.0));
  params->min_quality = in.Get("min_quality", Between(0.0, 1.0));
  params->sharpness = in.Get("sharpness", Between(0.0, 1000.0));
}

void ReadAge(ParamReader in, CloudAgeParams* age) {
  age->max_age = in.Get("max_age", Between(0.1, 60.0));
  age->max_ahead = in.Get("max_ahead", Between(0.0, 10.0));
}

std::string BesideFile(const std::string& file, const std::string& path) {
  return (std::filesystem::path(file).parent_path() / path).lexically_normal().string();
}

}  // namespace

RecogniserConfig ReadRecogniserConfig(const std::string& path, const std::string& objects) {
  ParamReader in = ParamReader::FromFile(path);
  RecogniserConfig config;
  const std::string listed = BesideFile(path, in.GetString("objects"));
  config.objects = objects.empty() ? listed : objects;
  std::map<std::string, KnownModel> known;
  for (const auto& [instance, model] : world::LoadCatalogueModels(config.objects)) {
    known[base::ToLower(model->name)] = {model->name, model->concept_name, model};
  }
  if (in.Has("categories"))
    in.Fail("categories", "which is said in the block `concepts` of the catalogue of objects (" +
                              listed + "); move it there");
  ReadTable(in.Sub("table"), &config.params.segmentation.table);
  ReadThings(in.Sub("things"), &config.params.segmentation);
  ReadRecognition(in.Sub("recognition"), &config.params);
  ReadAge(in.Sub("clouds"), &config.age);
  in.RejectUnknownKeys();
  for (auto& one : known) config.catalogue.push_back(std::move(one.second));
  return config;
}

}  // namespace hires::perception
