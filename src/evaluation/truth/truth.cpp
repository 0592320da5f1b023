#include "hires/evaluation/truth.h"

#include <algorithm>
#include <filesystem>
#include <vector>

#include "hires/base/error.h"
#include "hires/base/param_reader.h"
#include "hires/base/text.h"

namespace hires::evaluation {
namespace {

namespace fs = std::filesystem;
using base::ParamReader;
using imagination::Distribution;
using imagination::Uncertainty;

constexpr char kSame[] = "same";
constexpr const char* kOfSensors[] = {"detection_noise", "detection_noise_yaw", "encoder_noise"};
constexpr const char* kOfLocalisation[] = {"localisation_x",         "localisation_y",
                                           "localisation_yaw",       "localisation_noise",
                                           "localisation_noise_yaw", "ghost_rate"};

std::vector<std::string> NamesIn(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

void ReadUncertainty(ParamReader in, const std::string& path, Truth* truth) {
  const std::string file = in.GetString("file");
  if (file != kSame) {
    const std::string resolved = imagination::ResolvePath(file, path);
    truth->uncertainty = std::make_shared<const Uncertainty>(
        file == "none" ? imagination::NoUncertainty() : imagination::LoadUncertainty(resolved));
  }
  ParamReader changes = in.Sub("changes");
  truth->changes = imagination::ReadQuantities(&changes);
}

bool ReadIdeally(const std::string& key, ParamReader* in) {
  return in->Get(key, base::OneOf({"fitted", "ideal"})) == "ideal";
}

bool ChangesWhatIsDrawn(const Truth& truth) {
  return truth.uncertainty || !truth.changes.empty() || truth.senses_ideally ||
         truth.localises_ideally;
}

Uncertainty UncertaintyOf(const Truth& truth, const Uncertainty& imagined) {
  Uncertainty drawn = truth.uncertainty ? *truth.uncertainty : imagined;
  for (const auto& [name, distribution] : truth.changes) drawn.quantities[name] = distribution;
  if (truth.senses_ideally) {
    for (const char* name : kOfSensors) drawn.quantities.erase(name);
  }
  if (truth.localises_ideally) {
    for (const char* name : kOfLocalisation) drawn.quantities.erase(name);
  }
  return drawn;
}

}  // namespace

std::string TruthPath(const std::string& name, const std::string& folder) {
  const fs::path path(name);
  if (path.has_parent_path() || path.extension() == ".yaml") return name;
  const std::string wanted = name.empty() ? kSame : name;
  const std::vector<std::string> names = NamesIn(folder);
  if (std::find(names.begin(), names.end(), wanted) == names.end()) {
    throw base::ConfigError(folder + ": " + base::UnknownName("truth", wanted, names) +
                            "; or give a path");
  }
  return folder + "/" + wanted + ".yaml";
}

Truth ReadTruth(const std::string& path) {
  ParamReader in = ParamReader::FromFile(path);
  Truth truth;
  truth.name = fs::path(path).stem().string();
  in.Get("engine", base::OneOf({"ode"}));
  in.Get("level", base::OneOf({"planar"}));
  in.Sub("controller");
  ReadUncertainty(in.Sub("uncertainty"), path, &truth);
  truth.senses_ideally = ReadIdeally("sensing", &in);
  truth.localises_ideally = ReadIdeally("localisation", &in);
  in.Sub("events");
  in.RejectUnknownKeys();
  return truth;
}

imagination::ImaginationSetup SetupOf(const Truth& truth,
                                      const imagination::ImaginationSetup& imagined) {
  imagination::ImaginationSetup setup = imagined;
  if (ChangesWhatIsDrawn(truth)) {
    setup.uncertainty =
        std::make_shared<const Uncertainty>(UncertaintyOf(truth, *imagined.uncertainty));
  }
  return setup;
}

}  // namespace hires::evaluation
