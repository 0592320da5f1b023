#include "hires/knowledge/blackboard_config.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>

#include "hires/base/error.h"
#include "hires/base/param_reader.h"

namespace hires::knowledge {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> PathsFrom(const std::string& config_path,
                                   const std::vector<std::string>& paths) {
  std::vector<std::string> found;
  for (const std::string& path : paths) {
    found.push_back((fs::path(config_path).parent_path() / path).lexically_normal().string());
  }
  return found;
}

StoreOptions ReadOptions(base::ParamReader* in) {
  StoreOptions options;
  const std::string durability = in->Get("durability", base::OneOf({"process", "power"}));
  options.durability = durability == "power" ? Durability::kPower : Durability::kProcess;
  options.cache_bytes = static_cast<std::size_t>(in->Get("cache", base::Between(1, 100'000))) << 20;
  options.max_bytes = static_cast<std::uint64_t>(in->Get("max_size", base::Between(0, 100'000'000)))
                      << 20;
  return options;
}

OldStoreLimits ReadOldRuns(base::ParamReader in) {
  OldStoreLimits limits;
  limits.max_age = in.Get("max_age", base::Between(0.0, 36'500.0));
  limits.max_bytes = static_cast<std::uint64_t>(in.Get("max_size", base::Between(0, 100'000'000)))
                     << 20;
  return limits;
}

}  // namespace

BlackboardConfig ReadBlackboardConfig(const std::string& path) {
  base::ParamReader in = base::ParamReader::FromFile(path);
  BlackboardConfig config;
  config.ontology = PathsFrom(path, in.GetStrings("ontology"));
  if (config.ontology.empty()) in.Fail("ontology", "wanted paths of Turtle or RDF/XML files");
  config.store = ExpandHome(in.GetString("store"));
  if (config.store.empty()) in.Fail("store", "wanted a path, or :memory:");
  config.options = ReadOptions(&in);
  if (in.Has("old_runs")) config.old_runs = ReadOldRuns(in.Sub("old_runs"));
  config.knowledge = PathsFrom(path, in.GetStrings("knowledge"));
  config.topics = PathsFrom(path, in.GetStrings("topics"));
  config.threads = in.Get("threads", base::Between(1, 256));
  config.max_waiting = in.Get("max_waiting", base::Between(1, 100'000));
  config.max_group = in.Get("max_group", base::Between(1, 100'000));
  config.queue_size = in.Get("queue_size", base::Between(1, 1'000'000));
  config.history = in.Get("history", base::Between(0, 10'000'000));
  config.max_topics = in.Get("max_topics", base::Between(0, 100'000));
  config.imagined = in.GetBool("imagined");
  in.RejectUnknownKeys();
  return config;
}

std::string ExpandHome(const std::string& path) {
  if (path.compare(0, 2, "~/") != 0) return path;
  const char* ros_home = std::getenv("ROS_HOME");
  if (path.compare(0, 7, "~/.ros/") == 0 && ros_home != nullptr && *ros_home != '\0') {
    return ros_home + path.substr(6);
  }
  const char* home = std::getenv("HOME");
  if (home == nullptr || *home == '\0') {
    throw base::ConfigError(
        fmt::format("{}: HOME is not set; set it, or write the whole path", path));
  }
  return home + path.substr(1);
}

void MakeFolderOf(const std::string& store) {
  const fs::path folder = fs::path(store).parent_path();
  if (store == ":memory:" || folder.empty()) return;
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error) return;
  throw base::ConfigError(
      fmt::format("{}: cannot make its folder: {}; name another place", store, error.message()));
}

}  // namespace hires::knowledge
