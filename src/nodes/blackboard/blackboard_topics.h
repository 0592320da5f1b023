#pragma once

#include <hires/FluentChanges.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/single_subscriber_publisher.h>

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hires/knowledge/blackboard_config.h"
#include "hires/knowledge/demand.h"
#include "hires/knowledge/store.h"
#include "nodes/blackboard/publishing_pace.h"

namespace hires_ros {

/// The topics of the Blackboard: all changes, and one topic for each demand. Lives on the thread
/// that owns the store; only Subscribed comes from elsewhere.
///
/// A subscriber of a demand topic gets a snapshot alone, and then every change once. It may see a
/// message from before its snapshot after it, because roscpp sends the one directly and the others
/// through a queue; sequence numbers tell. `last_sequence` of a snapshot is that of the topic's
/// last message, which nothing that matches has followed.
class BlackboardTopics {
 public:
  /// Called on a thread that spins: has `task` run on the thread of the store, and waits for it.
  using OnStoreThread = std::function<void(std::function<void(const hires::knowledge::Store&)>)>;

  /// @param last  Sequence of the last change in the store.
  BlackboardTopics(const hires::knowledge::BlackboardConfig& config,
                   std::shared_ptr<const hires::knowledge::Ontology> ontology, std::uint64_t last,
                   ros::NodeHandle* nh, OnStoreThread on_store_thread);

  /// Whether Open would do.  @throws ConfigError: the name is no name, or stands for another
  /// filter; the filter is wrong; there are too many.
  void Check(const std::vector<hires::knowledge::DemandTopic>& topics) const;
  /// Opens a topic, unless it is open already.  @return its resolved name.  @throws as Check.
  std::string Open(const hires::knowledge::DemandTopic& topic,
                   const hires::knowledge::Store& store);

  /// Tells what one transaction changed. Waits, and so slows down who writes, while roscpp is
  /// behind by half a queue: a subscriber that keeps up gets every change, however fast they come.
  void Publish(const std::vector<hires::knowledge::Change>& changes,
               const hires::knowledge::Store& store);

  struct Missed {
    std::vector<hires::FluentChanges> messages;
    bool more{false};  ///< beyond the limit
  };
  /// The messages of a topic after `sequence`; a snapshot where they are not kept any more.
  /// @param limit  Changes; one message comes in any case.
  /// @throws ConfigError where there is no such topic.
  Missed Since(const std::string& name, std::uint64_t sequence, std::size_t limit,
               const hires::knowledge::Store& store);

  std::vector<std::string> names() const;  ///< of demand topics

 private:
  struct Topic {
    hires::knowledge::DemandTopic wanted;
    hires::knowledge::Demand demand;
    std::uint64_t last{0};  ///< last_sequence of its last message
    ros::Publisher publisher;
    std::deque<hires::FluentChanges> kept;
    std::size_t num_kept{0};     ///< changes in them
    std::uint64_t kept_from{0};  ///< a subscriber that knows this, or more, is served from `kept`
  };
  /// A topic of unfiltered changes.
  struct Stream {
    ros::Publisher publisher;
    std::uint64_t last{0};
  };

  void OnSubscriber(const std::string& name, const ros::SingleSubscriberPublisher& subscriber);
  hires::FluentChanges SnapshotOf(Topic* topic, const hires::knowledge::Store& store) const;
  void PublishAll(const std::vector<hires::knowledge::Change>& changes, Stream* stream);
  void PublishDemand(const std::vector<hires::knowledge::Change>& changes,
                     const hires::knowledge::Store& store, Topic* topic);
  void Send(hires::FluentChanges message, Topic* topic);
  void PublishTo(const ros::Publisher& publisher, const hires::FluentChanges& message);
  void Lose(std::uint64_t sequence, const hires::knowledge::Store& store, Topic* topic);
  Topic* Find(const std::string& name);

  const hires::knowledge::BlackboardConfig config_;
  const std::shared_ptr<const hires::knowledge::Ontology> ontology_;
  ros::NodeHandle* const nh_;
  const OnStoreThread on_store_thread_;
  PublishingPace pace_;
  RoscppRounds rounds_;
  bool is_heard_{false};  ///< there is a subscriber to what the transaction at hand changed
  Stream changes_;
  Stream imagined_;
  std::map<std::string, Topic> topics_;
};

}  // namespace hires_ros
