#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "hires/base/error.h"
#include "hires/base/files/named_file.h"
#include "hires/base/hash.h"
#include "hires/base/param_reader.h"
#include "hires/base/text.h"
#include "sim_robot/controller_changes.h"
#include "sim_robot/truth.h"

namespace hires::sim_robot {
namespace {

namespace fs = std::filesystem;
using base::Between;
using base::ParamReader;
using imagination::Uncertainty;

constexpr double kFarthest = 1000.0;  // [m] worlds are not larger

// What is drawn
// -----------------------------------------------------------------------------------

void ReadCorrelations(ParamReader* in, Truth* truth) {
  std::set<std::string> seen;
  for (ParamReader& entry : in->SubList("correlations")) {
    const std::vector<std::string> pair = entry.GetStrings("between");
    if (pair.size() != 2) entry.Fail("between", "wanted the names of two quantities");
    for (const std::string& name : pair) {
      if (truth->changes.count(name) == 0) {
        entry.Fail("between", "'" + name + "' is not in `changes`; say there how it is spread");
      }
      if (!seen.insert(name).second) entry.Fail("between", "wanted every quantity in one pair");
    }
    entry.GetString("source");
    truth->correlations.push_back({pair[0], pair[1], entry.Get("coefficient", Between(-1.0, 1.0))});
  }
}

void ReadUncertainty(ParamReader in, const std::string& path, Truth* truth) {
  const std::string file = in.GetString("file");
  if (file == "none") {
    truth->uncertainty = std::make_shared<const Uncertainty>(imagination::NoUncertainty());
  } else if (file != Truth{}.name) {
    truth->uncertainty = std::make_shared<const Uncertainty>(
        imagination::LoadUncertainty(imagination::ResolvePath(file, path)));
  }
  ParamReader changes = in.Sub("changes");
  truth->changes = imagination::ReadQuantities(&changes);
  ReadCorrelations(&in, truth);
}

const std::map<std::string, Sensing> kSensing{
    {"fitted", Sensing::kFitted}, {"ideal", Sensing::kIdeal}, {"pictures", Sensing::kPictures}};

const std::map<std::string, Localisation> kLocalisation{{"fitted", Localisation::kFitted},
                                                        {"ideal", Localisation::kIdeal},
                                                        {"filter", Localisation::kFilter}};

Sensing ReadSensing(ParamReader* in) {
  return kSensing.at(in->Get("sensing", base::OneOf({"fitted", "ideal", "pictures"})));
}

void ReadLocalisation(const std::string& path, ParamReader* in, Truth* truth) {
  truth->localisation =
      kLocalisation.at(in->Get("localisation", base::OneOf({"fitted", "ideal", "filter"})));
  if (truth->localisation != Localisation::kFilter) return;
  const std::string file = imagination::ResolvePath(in->GetString("self_localisation"), path);
  truth->self_localisation = std::make_shared<const simulation::SelfLocalisationParams>(
      simulation::LoadSelfLocalisation(file));
}

// Events
// ------------------------------------------------------------------------------------------

Eigen::Vector2d ReadPoint(const std::string& key, ParamReader* in) {
  const std::vector<double> xy = in->GetNumbers(key, 2);
  if (std::abs(xy[0]) > kFarthest || std::abs(xy[1]) > kFarthest)
    in->Fail(key, "wanted within 1000 m");
  return {xy[0], xy[1]};
}

simulation::Sill ReadSill(ParamReader* in) {
  simulation::Sill sill;
  sill.from_M = ReadPoint("from", in);
  sill.to_M = ReadPoint("to", in);
  if ((sill.to_M - sill.from_M).norm() < 0.01) in->Fail("to", "wanted at least 0.01 m from `from`");
  sill.width = in->Get("width", Between(0.0, 10.0));
  sill.height = in->Get("height", Between(0.0, 0.05));
  in->GetString("source");
  return sill;
}

simulation::SlipperyPatch ReadPatch(ParamReader* in) {
  simulation::SlipperyPatch patch;
  patch.center_M = ReadPoint("center", in);
  patch.radius = in->Get("radius", Between(0.0, 100.0));
  patch.traction = in->Get("traction", Between(0.05, 20.0));
  in->GetString("source");
  return patch;
}

Bumps ReadBumps(ParamReader in) {
  Bumps bumps;
  bumps.mean_interval = in.Get("mean_interval", Between(1.0, 1e6));
  const std::vector<double> speed = in.GetNumbers("speed", 2);
  if (speed[0] < 0.0 || speed[1] < speed[0] || speed[1] > 1.0) {
    in.Fail("speed", "wanted the least and the greatest, between 0 and 1 m/s");
  }
  bumps.least_speed = speed[0];
  bumps.greatest_speed = speed[1];
  bumps.duration = in.Get("duration", Between(0.02, 2.0));
  in.GetString("source");
  return bumps;
}

MovedBody ReadMoved(ParamReader* in) {
  MovedBody moved;
  moved.body = in->GetString("body");
  const std::vector<double> by = in->GetNumbers("by", 3);
  if (std::abs(by[0]) > kFarthest || std::abs(by[1]) > kFarthest || std::abs(by[2]) > 6.3) {
    in->Fail("by", "wanted x and y within 1000 m, yaw within 6.3 rad");
  }
  moved.by = {by[0], by[1], by[2]};
  moved.probability = in->Get("probability", Between(0.0, 1.0));
  in->GetString("source");
  return moved;
}

LocalisationWalk ReadWalk(ParamReader in) {
  LocalisationWalk walk;
  walk.sd = in.Get("sd", Between(0.0, 1.0));
  walk.sd_yaw = in.Get("sd_yaw", Between(0.0, 1.0));
  walk.time = in.Get("time", Between(0.1, 1e4));
  in.GetString("source");
  return walk;
}

Recogniser ReadRecogniser(ParamReader in) {
  Recogniser recogniser;
  recogniser.bias = in.Get("bias", Between(0.0, 0.2));
  recogniser.bias_yaw = in.Get("bias_yaw", Between(0.0, 1.0));
  recogniser.missed = in.Get("missed", Between(0.0, 0.99));
  in.GetString("source");
  return recogniser;
}

/// What a truth does not name does not happen.
void ReadEvents(ParamReader in, Truth* truth) {
  if (in.Has("sills")) {
    for (ParamReader& entry : in.SubList("sills")) truth->floor.sills.push_back(ReadSill(&entry));
  }
  if (in.Has("patches")) {
    for (ParamReader& entry : in.SubList("patches")) {
      truth->floor.patches.push_back(ReadPatch(&entry));
    }
  }
  if (in.Has("bumps")) truth->bumps = ReadBumps(in.Sub("bumps"));
  if (in.Has("moved")) {
    for (ParamReader& entry : in.SubList("moved")) truth->moved.push_back(ReadMoved(&entry));
  }
  if (in.Has("localisation_walk")) truth->walk = ReadWalk(in.Sub("localisation_walk"));
  if (in.Has("recogniser")) truth->recogniser = ReadRecogniser(in.Sub("recogniser"));
}

}  // namespace

std::string TruthPath(const std::string& name, const std::string& folder) {
  const fs::path path(name);
  if (path.has_parent_path() || path.extension() == ".yaml") return name;
  return base::FileNamed("truth", name.empty() ? Truth{}.name : name, folder);
}

Truth WithSensing(Truth truth, const std::string& sensing) {
  if (sensing.empty()) return truth;
  const auto found = kSensing.find(sensing);
  if (found == kSensing.end())
    throw base::ConfigError(base::UnknownName("sensing", sensing, {"fitted", "ideal", "pictures"}));
  if (truth.sensing != found->second) truth.name += ", sensing " + sensing;
  truth.sensing = found->second;
  return truth;
}

Truth ReadTruth(const std::string& path) {
  ParamReader in = ParamReader::FromFile(path);
  Truth truth;
  truth.name = fs::path(path).stem().string();
  in.Get("engine", base::OneOf({"ode"}));
  in.Get("level", base::OneOf({"planar"}));
  ReadControllerChanges(in.Sub("controller"), &truth);
  ReadUncertainty(in.Sub("uncertainty"), path, &truth);
  truth.sensing = ReadSensing(&in);
  ReadLocalisation(path, &in, &truth);
  ReadEvents(in.Sub("events"), &truth);
  in.RejectUnknownKeys();
  return truth;
}

Truth FindTruth(const std::string& name, const std::string& folder) {
  const std::string path = TruthPath(name, folder);
  Truth truth = ReadTruth(path);
  const auto folder_of = [](const fs::path& file) {
    return fs::weakly_canonical(file).parent_path();
  };
  if (folder_of(path) == fs::weakly_canonical(folder)) return truth;
  base::Hasher text;
  text.Add(base::ReadTextFile(path));
  truth.name = fmt::format("{}#{}", path, base::HexOf(text.value()).substr(0, 8));
  return truth;
}

}  // namespace hires::sim_robot
