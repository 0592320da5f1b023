#include "hires/imagination/client_config.h"

#include <filesystem>

#include "hires/base/param_reader.h"
#include "hires/imagination/imagination_setup.h"

namespace hires::imagination {
namespace {

/// A file that the file `path` names under `key`.
base::ParamReader FileAt(const std::string& key, const std::string& path, base::ParamReader* in) {
  return base::ParamReader::FromFile(ResolvePath(in->GetString(key), path));
}

/// A ranking by cost needs prices; a file that names none has those of the scene that it names.
base::ParamReader PricesOf(const std::string& path, const std::string& scene,
                           base::ParamReader* in) {
  if (in->Has("prices")) return FileAt("prices", path, in);
  const std::string beside_scene = ResolvePath("prices.yaml", scene);
  return base::ParamReader::FromFile(
      std::filesystem::exists(beside_scene) ? beside_scene : ResolvePath("prices.yaml", path));
}

}  // namespace

ClientConfig ReadClientConfig(const std::string& path) {
  base::ParamReader in = base::ParamReader::FromFile(path);
  ClientConfig config;
  config.scene = ResolvePath(in.GetString("scene"), path);
  config.scheduler = ReadSchedulerParams(in.Sub("scheduler"));
  config.scheduler.criteria.prices = ReadPrices(PricesOf(path, config.scene, &in));
  config.validated = ReadValidated(FileAt("validated", path, &in));
  config.kept_rollouts = in.Get("kept_rollouts", base::Between(0, 1000000));
  config.feedback_period = in.Get("feedback_period", base::Between(0.01, 10.0));
  config.worker_timeout = in.Get("worker_timeout", base::Between(0.1, 60.0));
  in.RejectUnknownKeys();
  return config;
}

}  // namespace hires::imagination
