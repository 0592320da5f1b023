#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace hires::cli {

/// What was typed behind `hires limits`.
struct LimitsOptions {
  std::vector<std::string> payloads;  ///< together on the tray
  std::string robot, objects, uncertainty, scene, json, yaml, given, csv;
  std::optional<double> max_slide;  ///< [m]
  double max_fall{0.01};
  std::uint64_t seed{1};
  int threads{0}, check_truths{0};
  bool quiet{false};
  CLI::App* verb{nullptr};
};

/// Adds the verb to the program.  @pre `options` outlives `app`.
void AddLimitsVerb(CLI::App* app, LimitsOptions* options);

/// Looks for the limits, or checks given ones, prints and writes them.
/// @return kExitRecommended, kExitCancelled, or kExitBadInput: some of the payloads were refused,
/// which is printed on standard error, the others are answered.
/// @throws base::ConfigError for bad input that leaves nothing to answer.
int RunLimitsVerb(const LimitsOptions& options, const std::string& package_folder,
                  const std::function<bool()>& cancelled);

}  // namespace hires::cli
