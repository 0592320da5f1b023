#include "nodes/blackboard/blackboard_topics.h"

#include <fmt/format.h>
#include <ros/init.h>
#include <ros/names.h>

#include <algorithm>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/short_text.h"
#include "hires/base/text.h"
#include "hires/ros/knowledge/blackboard_messages.h"
#include "hires/ros/names/topic_names.h"

namespace hires_ros {
namespace {

namespace knowledge = hires::knowledge;
using hires::base::ConfigError;
using hires::base::Log;
using hires::base::LogLevel;
using knowledge::Change;

std::string TopicName(const std::string& name) { return kBlackboard + ("/" + name); }

bool SameFilter(const knowledge::DemandTopic& a, const knowledge::DemandTopic& b) {
  return a.exact == b.exact && a.below == b.below && a.above == b.above &&
         a.properties == b.properties && a.all_properties == b.all_properties &&
         a.queries == b.queries;
}

bool IsName(const std::string& name) {
  std::string ignored;
  return !name.empty() && name.front() != '/' && name.front() != '~' && name.back() != '/' &&
         name.size() <= 200 && ros::names::validate(name, ignored);
}

void CheckName(const std::string& name) {
  if (!IsName(name)) {
    throw ConfigError(
        fmt::format("topic '{}': no name; wanted a letter, then letters, digits and _",
                    hires::base::Shortened(name)));
  }
  if (TopicName(name) == kBlackboardChanges || TopicName(name) == kImaginedChanges) {
    throw ConfigError(
        fmt::format("topic '{}': is the topic of all changes; choose another name", name));
  }
}

std::vector<Change> OfLabel(const std::vector<Change>& changes, knowledge::Episode::Label label) {
  std::vector<Change> chosen;
  std::copy_if(changes.begin(), changes.end(), std::back_inserter(chosen),
               [label](const Change& change) { return change.label == label; });
  return chosen;
}

}  // namespace

BlackboardTopics::BlackboardTopics(const knowledge::BlackboardConfig& config,
                                   std::shared_ptr<const knowledge::Ontology> ontology,
                                   std::uint64_t last, ros::NodeHandle* nh,
                                   OnStoreThread on_store_thread)
    : config_(config),
      ontology_(std::move(ontology)),
      nh_(nh),
      on_store_thread_(std::move(on_store_thread)),
      pace_(config.queue_size, [] { return ros::isShuttingDown(); }),
      rounds_(&pace_) {
  const std::uint32_t queue = pace_.queue_size();
  changes_ = {nh->advertise<hires::FluentChanges>(kBlackboardChanges, queue), last};
  if (!config.imagined) return;
  imagined_ = {nh->advertise<hires::FluentChanges>(kImaginedChanges, queue), last};
}

void BlackboardTopics::Check(const std::vector<knowledge::DemandTopic>& topics) const {
  int count = static_cast<int>(topics_.size());
  for (const knowledge::DemandTopic& topic : topics) {
    CheckName(topic.name);
    const knowledge::Demand demand(topic, ontology_);
    const auto open = topics_.find(topic.name);
    if (open != topics_.end() && !SameFilter(open->second.wanted, topic)) {
      throw ConfigError(
          fmt::format("topic '{}': is open with another filter; choose another name", topic.name));
    }
    if (open == topics_.end() && ++count > config_.max_topics) {
      throw ConfigError(
          fmt::format("topic '{}': there are {} topics already; raise max_topics, or share one",
                      topic.name, config_.max_topics));
    }
  }
}

std::string BlackboardTopics::Open(const knowledge::DemandTopic& topic,
                                   const knowledge::Store& store) {
  Check({topic});
  const std::string name = TopicName(topic.name);
  if (topics_.count(topic.name) > 0) return nh_->resolveName(name);
  Topic opened{topic,
               knowledge::Demand(topic, ontology_),
               store.last_sequence(),
               {},
               {},
               0,
               store.last_sequence()};
  opened.demand.Snapshot(store);
  Topic& kept = topics_.emplace(topic.name, std::move(opened)).first->second;
  kept.publisher = nh_->advertise<hires::FluentChanges>(
      name, pace_.queue_size(),
      [this, wanted = topic.name](const ros::SingleSubscriberPublisher& subscriber) {
        OnSubscriber(wanted, subscriber);
      });
  return nh_->resolveName(name);
}

void BlackboardTopics::OnSubscriber(const std::string& name,
                                    const ros::SingleSubscriberPublisher& subscriber) {
  on_store_thread_([this, &name, &subscriber](const knowledge::Store& store) {
    Topic* topic = Find(name);
    const hires::FluentChanges snapshot = SnapshotOf(topic, store);
    subscriber.publish(snapshot);
  });
}

/// All up to now, numbered as the topic's last message, so that the next one follows on it.
hires::FluentChanges BlackboardTopics::SnapshotOf(Topic* topic,
                                                  const knowledge::Store& store) const {
  hires::FluentChanges snapshot = ToMessage(topic->demand.Snapshot(store));
  snapshot.snapshot = true;
  snapshot.first_sequence = 0;
  snapshot.last_sequence = topic->last;
  snapshot.previous = 0;
  return snapshot;
}

void BlackboardTopics::Publish(const std::vector<Change>& changes, const knowledge::Store& store) {
  pace_.Await();
  is_heard_ = false;
  const auto real = OfLabel(changes, knowledge::Episode::Label::kReal);
  if (config_.imagined) {
    PublishAll(OfLabel(changes, knowledge::Episode::Label::kImagined), &imagined_);
  }
  if (!real.empty()) {
    PublishAll(real, &changes_);
    for (auto& [name, topic] : topics_) PublishDemand(real, store, &topic);
  }
  if (is_heard_) pace_.Count();
}

void BlackboardTopics::PublishAll(const std::vector<Change>& changes, Stream* stream) {
  if (changes.empty()) return;
  hires::FluentChanges message;
  message.first_sequence = changes.front().sequence;
  message.last_sequence = changes.back().sequence;
  message.previous = std::exchange(stream->last, message.last_sequence);
  if (stream->publisher.getNumSubscribers() == 0) return;
  message.changes.reserve(changes.size());
  for (const Change& change : changes) message.changes.push_back(ToMessage(change));
  PublishTo(stream->publisher, message);
}

void BlackboardTopics::PublishTo(const ros::Publisher& publisher,
                                 const hires::FluentChanges& message) {
  if (publisher.getNumSubscribers() == 0) return;
  is_heard_ = true;
  publisher.publish(message);
}

void BlackboardTopics::PublishDemand(const std::vector<Change>& changes,
                                     const knowledge::Store& store, Topic* topic) {
  try {
    const knowledge::DemandUpdate update = topic->demand.Apply(changes, store);
    if (!update.changes.empty()) Send(ToMessage(update), topic);
  } catch (const std::exception& error) {
    Log(LogLevel::kError,
        fmt::format("topic={} lost={} {}", topic->wanted.name, changes.size(), error.what()));
    Lose(changes.back().sequence, store, topic);
  }
}

void BlackboardTopics::Send(hires::FluentChanges message, Topic* topic) {
  message.previous = std::exchange(topic->last, message.last_sequence);
  PublishTo(topic->publisher, message);
  topic->num_kept += message.changes.size();
  topic->kept.push_back(std::move(message));
  while (topic->num_kept > static_cast<std::size_t>(config_.history)) {
    topic->num_kept -= topic->kept.front().changes.size();
    topic->kept_from = topic->kept.front().last_sequence;
    topic->kept.pop_front();
  }
}

/// What came until now could not be told: readers will see a gap and get a snapshot.
void BlackboardTopics::Lose(std::uint64_t sequence, const knowledge::Store& store, Topic* topic) {
  topic->last = sequence;
  topic->kept.clear();
  topic->num_kept = 0;
  topic->kept_from = sequence;
  try {
    topic->demand.Snapshot(store);
  } catch (const std::exception&) {  // the same trouble; the next change says so again
  }
}

BlackboardTopics::Missed BlackboardTopics::Since(const std::string& name, std::uint64_t sequence,
                                                 std::size_t limit, const knowledge::Store& store) {
  Topic* topic = Find(name);
  if (sequence < topic->kept_from) return {{SnapshotOf(topic, store)}, false};
  Missed missed;
  std::size_t count = 0;
  for (const hires::FluentChanges& message : topic->kept) {
    if (message.last_sequence <= sequence) continue;
    count += message.changes.size();
    if (!missed.messages.empty() && count > limit) {
      missed.more = true;
      break;
    }
    missed.messages.push_back(message);
  }
  return missed;
}

BlackboardTopics::Topic* BlackboardTopics::Find(const std::string& name) {
  const auto topic = topics_.find(name);
  if (topic == topics_.end()) {
    throw ConfigError(hires::base::UnknownName("topic", hires::base::Shortened(name), names()) +
                      "; the service demand opens it");
  }
  return &topic->second;
}

std::vector<std::string> BlackboardTopics::names() const {
  std::vector<std::string> names;
  for (const auto& [name, topic] : topics_) names.push_back(name);
  return names;
}

}  // namespace hires_ros
