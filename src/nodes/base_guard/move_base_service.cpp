#include "nodes/base_guard/move_base_service.h"

#include <dynamic_reconfigure/Reconfigure.h>
#include <fmt/format.h>
#include <ros/ros.h>

#include <future>
#include <thread>

#include "hires/base/error.h"

namespace hires_ros {
namespace {

using hires::base::ConfigError;
using Steady = std::chrono::steady_clock;

constexpr auto kRetryPeriod = std::chrono::milliseconds(1000);
constexpr auto kPatience = std::chrono::milliseconds(3000);  // with a planner that does not answer
constexpr auto kFarewell = std::chrono::milliseconds(8000);  // two calls, and what they follow

dynamic_reconfigure::Config ToMsg(const hires::control::PlannerValues& values) {
  dynamic_reconfigure::Config config;
  for (const auto& [name, value] : values) {
    dynamic_reconfigure::DoubleParameter parameter;
    parameter.name = name;
    parameter.value = value;
    config.doubles.push_back(parameter);
  }
  return config;
}

void AwaitService(const std::string& service, std::chrono::milliseconds patience) {
  std::string why_not;
  if (!ros::names::validate(service, why_not)) throw ConfigError(why_not);
  const auto end = Steady::now() + patience;
  while (!ros::service::exists(service, false)) {
    if (Steady::now() >= end || ros::isShuttingDown()) {
      throw ConfigError(
          fmt::format("there is no service {}; start move_base, or give the name of its local "
                      "planner as move_base.planner in the file of the robot's names",
                      service));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

struct Answer {
  bool was_given;
  hires::control::PlannerValues values;
};

Answer Ask(const std::string& service, const hires::control::PlannerValues& changes) {
  dynamic_reconfigure::Reconfigure call;
  call.request.config = ToMsg(changes);
  if (!ros::service::call(service, call)) return {false, {}};
  return {true, FromMsg(call.response.config)};
}

hires::control::PlannerValues Reconfigured(const std::string& service,
                                           const hires::control::PlannerValues& changes,
                                           std::chrono::milliseconds patience) {
  AwaitService(service, patience);
  // A server that hangs would hang its caller for good: roscpp knows no time limit for services.
  std::promise<Answer> promise;
  std::future<Answer> answer = promise.get_future();
  std::thread([promise = std::move(promise), service, changes]() mutable {
    promise.set_value(Ask(service, changes));
  }).detach();
  if (answer.wait_for(patience) != std::future_status::ready) {
    throw ConfigError(fmt::format("{} does not answer within {:g} s; look at move_base", service,
                                  std::chrono::duration<double>(patience).count()));
  }
  const Answer given = answer.get();
  if (!given.was_given) {
    throw ConfigError(
        fmt::format("{} refused, or ended, when asked for {}; look at move_base's log", service,
                    hires::control::ToText(changes)));
  }
  return given.values;
}

}  // namespace

hires::control::PlannerValues FromMsg(const dynamic_reconfigure::Config& config) {
  hires::control::PlannerValues values;
  for (const auto& parameter : config.ints) values[parameter.name] = parameter.value;
  for (const auto& parameter : config.doubles) values[parameter.name] = parameter.value;
  return values;
}

hires::control::Reconfigure ReconfigureByService(std::chrono::milliseconds patience) {
  return [patience](const std::string& server, const hires::control::PlannerValues& changes) {
    return Reconfigured(server + "/set_parameters", changes, patience);
  };
}

std::unique_ptr<hires::control::MoveBaseTuner> MakeMoveBaseTuner(
    const hires::control::RobotNames::MoveBase& names, const std::string& journal) {
  hires::control::RobotNames::MoveBase resolved = names;
  resolved.planner = ros::names::resolve(names.planner);
  return std::make_unique<hires::control::MoveBaseTuner>(
      hires::control::MotionSetKeeper(
          resolved, journal.empty() ? hires::control::DefaultJournalPath() : journal,
          ReconfigureByService(kPatience)),
      kRetryPeriod, kFarewell);
}

}  // namespace hires_ros
