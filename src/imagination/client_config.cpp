#include "hires/imagination/client_config.h"

#include <filesystem>

#include "hires/base/param_reader.h"

namespace hires::imagination {

ClientConfig ReadClientConfig(const std::string& path) {
  base::ParamReader in = base::ParamReader::FromFile(path);
  ClientConfig config;
  const std::filesystem::path scene = in.GetString("scene");
  config.scene =
      scene.is_absolute()
          ? scene.string()
          : (std::filesystem::path(path).parent_path() / scene).lexically_normal().string();
  config.scheduler = ReadSchedulerParams(in.Sub("scheduler"));
  config.feedback_period = in.Get("feedback_period", base::Between(0.01, 10.0));
  config.worker_timeout = in.Get("worker_timeout", base::Between(0.1, 60.0));
  in.RejectUnknownKeys();
  return config;
}

}  // namespace hires::imagination
