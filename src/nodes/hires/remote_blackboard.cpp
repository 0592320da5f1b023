#include "nodes/hires/remote_blackboard.h"

#include <fmt/format.h>
#include <hires/BlackboardStatistics.h>
#include <hires/ChangesSince.h>
#include <hires/ListEpisodes.h>
#include <hires/LoadKnowledge.h>
#include <hires/QueryFluents.h>
#include <ros/ros.h>

#include "hires/base/error.h"
#include "hires/ros/knowledge/blackboard_messages.h"
#include "hires/ros/names/topic_names.h"
#include "hires/ros/node/service_links.h"
#include "nodes/hires/remote_server.h"

namespace hires_ros {
namespace {

namespace knowledge = hires::knowledge;
using hires::base::ConfigError;

constexpr std::uint32_t kPage = 10'000;  // changes

/// All of them, since the node's services cannot say which episode.
std::vector<knowledge::Change> ChangesOf(const hires::ChangesSince::Response& answer,
                                         std::int64_t episode) {
  std::vector<knowledge::Change> changes;
  for (const hires::FluentChanges& message : answer.messages) {
    for (const hires::FluentChange& change : message.changes) {
      if (change.episode == episode) changes.push_back(FromMessage(change));
    }
  }
  return changes;
}

class RemoteBlackboard : public hires::cli::BlackboardAccess {
 public:
  knowledge::LoadSummary Load(const std::string& text, const std::string& path,
                              std::uint64_t seed) override {
    hires::LoadKnowledge call;
    call.request.path = path;
    call.request.text = text;
    call.request.seed = seed;
    call.request.by = ToMessage(
        knowledge::Assertion{knowledge::Source::kKnowledge, 0, -hires::temporal::kForever});
    Ask("load", &call);
    knowledge::LoadSummary summary;
    for (std::size_t i = 0; i < call.response.concepts.size(); ++i) {
      summary.concepts[call.response.concepts[i]] = call.response.counts.at(i);
    }
    summary.known = call.response.known;
    summary.modifications = call.response.modifications;
    summary.topics = call.response.topics;
    return summary;
  }

  knowledge::FluentPage Query(const knowledge::FluentQuery& query) override {
    hires::QueryFluents call;
    call.request.query = ToMessage(query);
    Ask("query", &call);
    return {FromMessages(call.response.fluents), call.response.next, call.response.sequence};
  }

  std::vector<knowledge::Episode> Episodes() override {
    hires::ListEpisodes call;
    Ask("list_episodes", &call);
    std::vector<knowledge::Episode> episodes;
    for (const hires::Episode& episode : call.response.episodes) {
      episodes.push_back(FromMessage(episode));
    }
    return episodes;
  }

  knowledge::Store::Statistics Stats() override {
    const hires::BlackboardStatistics::Response answer = Statistics();
    return {answer.fluents,  answer.instances, answer.changes,
            answer.episodes, answer.bytes,     answer.schema};
  }

  std::string StorePath() override { return Statistics().store; }

  knowledge::EpisodeDiff Compare(const knowledge::Episode& a, const knowledge::Episode& b,
                                 const knowledge::EpisodeDiffOptions& options) override {
    return knowledge::Compare(a, AllChangesOf(a.id), b, AllChangesOf(b.id), options);
  }

 private:
  template <typename Service>
  void Ask(const char* service, Service* call) {
    // Over a connection that lasts: else the server closes it behind its answer.
    if (!links_.Call(service, call)) {
      throw ConfigError(fmt::format(
          "{} does not answer: the Blackboard went away; see its log, or add --store FILE",
          links_.NameOf(service)));
    }
    if (call->response.error.code != hires::BlackboardError::NONE) {
      throw ConfigError(call->response.error.message);
    }
  }

  hires::BlackboardStatistics::Response Statistics() {
    hires::BlackboardStatistics call;
    Ask("statistics", &call);
    return call.response;
  }

  std::vector<knowledge::Change> AllChangesOf(std::int64_t episode) {
    std::vector<knowledge::Change> changes;
    hires::ChangesSince call;
    call.request.limit = kPage;
    do {
      Ask("changes_since", &call);
      const auto some = ChangesOf(call.response, episode);
      changes.insert(changes.end(), some.begin(), some.end());
      if (!call.response.messages.empty()) {
        call.request.sequence = call.response.messages.back().last_sequence;
      }
    } while (call.response.more);
    return changes;
  }

  const ros::NodeHandle nh_;  // keeps ROS up
  ServiceLinks links_{nh_, kBlackboard + std::string("/")};
};

}  // namespace

std::unique_ptr<hires::cli::BlackboardAccess> ConnectBlackboard() {
  int no_arguments = 0;
  ros::init(no_arguments, nullptr, "hires_blackboard",
            ros::init_options::AnonymousName | ros::init_options::NoRosout);
  RequireMaster("blackboard.launch", "add --store FILE");
  if (!ros::service::exists(kBlackboard + std::string("/statistics"), false)) {
    throw ConfigError(
        fmt::format("no Blackboard is running at {}; start it (roslaunch hires blackboard.launch), "
                    "or add --store FILE",
                    ros::master::getURI()));
  }
  return std::make_unique<RemoteBlackboard>();
}

}  // namespace hires_ros
