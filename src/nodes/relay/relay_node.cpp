#include "nodes/relay/relay_node.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <diagnostic_updater/DiagnosticStatusWrapper.h>
#include <fmt/format.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/this_node.h>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/process.h"
#include "hires/ros/node/private_params.h"

namespace hires_ros {
namespace {

using hires::relay::Kind;
using hires::relay::Registration;
using hires::relay::RelayParams;
using hires::relay::RelayStatus;

constexpr double kDiagnosticsPeriod = 1.0;  // [s]

int Count(const std::vector<Registration>& registrations, Kind kind) {
  return static_cast<int>(std::count_if(registrations.begin(), registrations.end(),
                                        [kind](const Registration& r) { return r.kind == kind; }));
}

void AddSummary(const RelayStatus& status, diagnostic_updater::DiagnosticStatusWrapper* out) {
  if (!status.local_answers) out->mergeSummary(out->WARN, "the main master does not answer");
  if (!status.foreign_answers) out->mergeSummary(out->WARN, "the foreign master does not answer");
  if (!status.refused.empty()) out->mergeSummary(out->WARN, "some listed names are refused");
}

diagnostic_updater::DiagnosticStatusWrapper ToDiagnostics(const RelayStatus& status,
                                                          const RelayParams& params) {
  diagnostic_updater::DiagnosticStatusWrapper out;
  out.name = ros::this_node::getName().substr(1) + ": mirrors";
  out.hardware_id = hires::relay::TagOf(params.name_space);
  out.summary(out.OK, "relaying");
  AddSummary(status, &out);
  out.add("main master", ros::master::getURI());
  out.add("foreign master", params.foreign_master);
  out.add("topics mirrored at main", Count(status.at_local, Kind::kTopic));
  out.add("services mirrored at main", Count(status.at_local, Kind::kService));
  out.add("topics mirrored at foreign", Count(status.at_foreign, Kind::kTopic));
  out.add("services mirrored at foreign", Count(status.at_foreign, Kind::kService));
  for (const auto& refusal : status.refused) {
    out.add("refused " + refusal.name, refusal.node + ": " + refusal.reason);
  }
  return out;
}

}  // namespace

RelayParams LoadRelayParams() {
  RejectUnknownPrivate({"config", "foreign_master", "namespace"});
  const hires::relay::RelayOverrides overrides{PrivateText("foreign_master").value_or(""),
                                               PrivateText("namespace").value_or("")};
  const RelayParams params = hires::relay::ReadRelayParams(
      hires::base::ParamReader::FromFile(ConfigPath("relay")), overrides);
  const auto main = hires::relay::RequireMasterUri(ros::master::getURI(), "ROS_MASTER_URI");
  const auto foreign = hires::relay::RequireMasterUri(params.foreign_master, "foreign_master");
  if (main.port == foreign.port &&
      hires::relay::IsSamePlace(main.host, foreign.host, NamesOfThisHost())) {
    throw hires::base::ConfigError(
        fmt::format("foreign_master {} is the relay's own master; give the address of the other",
                    params.foreign_master));
  }
  return params;
}

RelayNode::RelayNode(const RelayParams& params, ros::NodeHandle* nh)
    : params_(params),
      local_(ros::master::getURI(), ros::this_node::getName(), params.call_timeout),
      foreign_(params.foreign_master, ros::this_node::getName(), params.call_timeout),
      pinger_(ros::this_node::getName(), params.call_timeout),
      relay_(params, NamesOfThisHost(), &local_, &foreign_, &pinger_),
      diagnostics_(nh->advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 10)) {}

void RelayNode::Run(const MasterWatch& master_watch) {
  // roscpp asks the master for a parameter before its first log line; that must not happen at the
  // moment at which the master hangs.
  hires::base::Log(hires::base::LogLevel::kInfo,
                   fmt::format("relay={} state=started foreign_master={}",
                               hires::relay::TagOf(params_.name_space), params_.foreign_master));
  double next_diagnostics = hires::base::SteadyNow();
  while (ros::ok()) {
    const double begin = hires::base::SteadyNow();
    relay_.Tick(begin);
    if (begin >= next_diagnostics) {
      PublishDiagnostics();
      next_diagnostics = begin + kDiagnosticsPeriod;
    }
    const double rest = params_.poll_period - (hires::base::SteadyNow() - begin);
    if (rest > 0.0) ros::WallDuration(rest).sleep();
  }
  if (!master_watch.is_replaced()) relay_.WithdrawAll();
}

void RelayNode::PublishDiagnostics() {
  diagnostic_msgs::DiagnosticArray array;
  array.header.stamp = ros::Time::now();
  array.status.push_back(ToDiagnostics(relay_.status(), params_));
  diagnostics_.publish(array);
}

}  // namespace hires_ros
