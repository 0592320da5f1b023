#include "hires/execution/monitor_config.h"

#include <fmt/format.h>

#include <filesystem>
#include <set>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::execution {
namespace {

using base::Between;
using base::ParamReader;

constexpr double kLongest = 86400.0;  // [s]

std::string PathFrom(const std::string& config_path, const std::string& path) {
  return (std::filesystem::path(config_path).parent_path() / path).lexically_normal().string();
}

MonitorParams ReadMonitor(ParamReader in) {
  MonitorParams params;
  params.imagination = ReadImaginePolicy(in.Get("imagination", ImaginePolicyWord()));
  params.max_replans = in.Get("max_replans", Between(0, 1000));
  params.effect_timeout = in.Get("effect_timeout", Between(0.0, kLongest));
  params.observation_delay = in.Get("observation_delay", Between(0.0, kLongest));
  params.overdue_factor = in.Get("overdue_factor", Between(1.0, 1000.0));
  params.overdue_minimum = in.Get("overdue_minimum", Between(0.1, kLongest));
  params.planning_timeout = in.Get("planning_timeout", Between(0.1, kLongest));
  params.arrival_margin = in.Get("arrival_margin", Between(0.0, kLongest));
  params.answer_grace = in.Get("answer_grace", Between(0.0, kLongest));
  if (in.Has("late_wait")) params.late_wait = in.Get("late_wait", Between(0.0, kLongest));
  params.max_wait = in.Get("max_wait", Between(0.0, kLongest));
  params.retry_period = in.Get("retry_period", Between(0.1, kLongest));
  params.break_delay = in.Get("break_delay", Between(0.0, kLongest));
  params.stop_timeout = in.Get("stop_timeout", Between(0.1, kLongest));
  return params;
}

ImaginingParams ReadImagining(ParamReader in) {
  ImaginingParams params;
  params.rollouts = in.Get("rollouts", Between(1, 100'000));
  params.ranking = in.Get("ranking", base::OneOf({"", "cost", "risk", "thesis"}));
  params.seed = static_cast<std::uint64_t>(in.Get("seed", Between(0, 2'147'483'647)));
  return params;
}

ServerParams ReadServers(ParamReader in) {
  ServerParams params;
  params.server_wait = in.Get("server_wait", Between(0.1, 600.0));
  params.server_loss = in.Get("server_loss", Between(0.05, 600.0));
  params.silence = in.Get("silence", Between(0.5, 600.0));
  params.cancel_wait = in.Get("cancel_wait", Between(0.1, 600.0));
  return params;
}

}  // namespace

base::Bound<std::string> ImaginePolicyWord() { return base::OneOf({"domain", "thesis", "off"}); }

MonitorParams::ImaginePolicy ReadImaginePolicy(const std::string& word) {
  if (word == "domain") return MonitorParams::ImaginePolicy::kDomain;
  if (word == "thesis") return MonitorParams::ImaginePolicy::kThesis;
  if (word == "off") return MonitorParams::ImaginePolicy::kOff;
  throw base::ConfigError(
      fmt::format("imagination is '{}', wanted domain, thesis or off", word.substr(0, 200)));
}

std::map<std::string, std::string> ReadDefaults(const std::string& text,
                                                const planning::OperatorData& operators) {
  std::set<std::string> known;
  for (const auto& [name, entry] : operators.operators) {
    if (!entry.imagine) continue;
    known.insert(entry.imagine->parameters.begin(), entry.imagine->parameters.end());
  }
  std::map<std::string, std::string> defaults;
  std::vector<std::string> errors;
  for (const std::string& item : base::Split(base::ToLower(text), ',')) {
    if (item.empty()) continue;
    const std::size_t equals = item.find('=');
    const std::string name = item.substr(0, equals);
    if (equals == std::string::npos || equals + 1 == item.size()) {
      errors.push_back(fmt::format("'{}' is no PARAMETER=VALUE, e.g. motion_set=slow", item));
    } else if (known.count(name) == 0) {
      errors.push_back(base::UnknownName("imagined parameter", name, {known.begin(), known.end()}));
    } else {
      defaults[name] = item.substr(equals + 1);
    }
  }
  if (!errors.empty()) throw base::ConfigError("default: " + base::Join(errors, "; "));
  return defaults;
}

MonitorConfig ReadMonitorConfig(const std::string& path) {
  ParamReader in = ParamReader::FromFile(path);
  MonitorConfig config;
  config.domain = PathFrom(path, in.GetString("domain"));
  config.operators = PathFrom(path, in.GetString("operators"));
  for (const std::string& file : in.GetStrings("ontology")) {
    config.ontology.push_back(PathFrom(path, file));
  }
  if (in.Has("robot")) config.robot = PathFrom(path, in.GetString("robot"));
  config.monitor = ReadMonitor(in.Sub("monitor"));
  config.imagining = ReadImagining(in.Sub("imagining"));
  config.servers = ReadServers(in.Sub("servers"));
  config.start_wait = in.Get("start_wait", Between(0.1, 600.0));
  config.feedback_period = in.Get("feedback_period", Between(0.01, 10.0));
  config.pose_distance = in.Get("pose_distance", Between(0.0, 1000.0));
  config.pose_angle = in.Get("pose_angle", Between(0.0, 7.0));
  in.RejectUnknownKeys();
  return config;
}

}  // namespace hires::execution
