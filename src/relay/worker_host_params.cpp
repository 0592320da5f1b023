#include "hires/relay/worker_host_params.h"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "hires/base/error.h"

namespace hires::relay {
namespace {

using base::ConfigError;
using base::ParamReader;

base::Bound<std::vector<std::string>> Command() {
  return {[](const std::vector<std::string>& words) {
            return !words.empty() && !words.front().empty();
          },
          "a program and its arguments"};
}

std::vector<std::string> ReadWords(const std::string& key,
                                   const base::Bound<std::vector<std::string>>& bound,
                                   ParamReader* in) {
  std::vector<std::string> words = in->GetStrings(key);
  if (!bound.holds(words)) in->Fail(key, "wanted " + bound.wanted);
  return words;
}

RestartLimits ReadRestartLimits(ParamReader in) {
  RestartLimits limits;
  limits.first_delay = in.Get("first_delay", base::Between(0.01, 60.0));
  limits.longest_delay = in.Get("longest_delay", base::Between(limits.first_delay, 3600.0));
  limits.stable_after = in.Get("stable_after", base::Between(0.0, 3600.0));
  limits.most_in_a_row = in.Get("most_in_a_row", base::Between(0, 1000));
  return limits;
}

std::optional<std::string> ValueOf(const std::string& placeholder, const WorkerHostParams& params) {
  if (placeholder == "index") return std::to_string(params.index);
  if (placeholder == "ns") return params.name_space();
  if (placeholder == "port") return std::to_string(params.port());
  if (placeholder == "address") return params.address;
  if (placeholder == "master") return params.master_uri();
  if (placeholder == "relay_config") return params.relay_config;
  return std::nullopt;
}

}  // namespace

base::Bound<std::string> WorkerAddress() {
  return {[](const std::string& text) {
            in_addr address{};
            return inet_pton(AF_INET, text.c_str(), &address) == 1 && address.s_addr != 0;
          },
          "an address of this computer in numbers, such as 127.0.0.1 or 192.168.1.20"};
}

base::Bound<std::vector<std::string>> WorkerVariables() {
  return {[](const std::vector<std::string>& entries) {
            return std::none_of(entries.begin(), entries.end(), [](const std::string& entry) {
              return entry.empty() || entry.front() == '=';
            });
          },
          "entries NAME=value, or NAME to remove one"};
}

WorkerHostParams ReadWorkerHostParams(ParamReader in, const std::string& folder) {
  WorkerHostParams params;
  params.index = in.Get("index", base::Between(1, 256));
  params.base_port = in.Get("base_port", base::Between(1024, 65000));
  params.address = in.Get("address", WorkerAddress());
  params.nice = in.Get("nice", base::Between(0, 19));
  params.master_command = ReadWords("master_command", Command(), &in);
  params.worker_command = ReadWords("worker_command", Command(), &in);
  params.worker_arguments = in.GetStrings("worker_arguments");
  params.relay_command = ReadWords("relay_command", Command(), &in);
  params.relay_config = in.GetString("relay_config");
  if (params.relay_config.rfind('/', 0) != 0) {
    params.relay_config = folder + "/" + params.relay_config;
  }
  params.environment = ReadWords("environment", WorkerVariables(), &in);
  params.start_timeout = in.Get("start_timeout", base::Between(0.5, 600.0));
  params.ready_timeout = in.Get("ready_timeout", base::Between(0.5, 3600.0));
  params.stop_grace = in.Get("stop_grace", base::Between(0.0, 60.0));
  params.main_master_timeout = in.Get("main_master_timeout", base::Between(0.5, 3600.0));
  params.restart = ReadRestartLimits(in.Sub("restart"));
  in.RejectUnknownKeys();
  return params;
}

std::string FillIn(const std::string& text, const WorkerHostParams& params) {
  std::string filled;
  for (std::size_t at = 0; at < text.size();) {
    const auto open = text.find('{', at);
    const auto close = open == std::string::npos ? open : text.find('}', open);
    if (close == std::string::npos) return filled + text.substr(at);
    const std::string name = text.substr(open + 1, close - open - 1);
    const auto value = ValueOf(name, params);
    if (!value) {
      throw ConfigError(fmt::format(
          "'{}': {{{}}} stands for nothing; {{index}}, {{ns}}, {{port}}, {{address}}, {{master}} "
          "and {{relay_config}} do",
          text, name));
    }
    filled += text.substr(at, open - at) + *value;
    at = close + 1;
  }
  return filled;
}

}  // namespace hires::relay
