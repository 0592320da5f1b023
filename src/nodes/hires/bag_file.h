#pragma once

#include <rosbag/bag.h>

#include <functional>
#include <string>
#include <vector>

#include "reports/episode/episode_topics.h"

namespace hires_ros {

/// A topic of a bag; one that was recorded with several types stands there once for each.
struct BagTopic : hires::reports::BagTopic {
  std::string md5sum;
};

/// Of a bag that ends early or has no index what is whole is read, with a warning.
/// @throws hires::base::ConfigError: no such bag, no bag, one of which no message can be read, or
/// with lengths and offsets that lead out of it.
void OpenBag(const std::string& path, rosbag::Bag* bag);

std::vector<BagTopic> TopicsOfBag(const rosbag::Bag& bag);
std::vector<BagTopic> TopicsOfBagFile(const std::string& path);  ///< @throws as OpenBag and ReadBag

/// "in it are: ..." for messages.
std::string ListOfTopics(const std::vector<BagTopic>& topics);

/// Reads a bag, which is data from outside: it may take 2 GB of memory at most.
/// @throws hires::base::ConfigError saying what to do for a broken bag, and as `read`.
void ReadBag(const std::string& path, const std::function<void()>& read);

}  // namespace hires_ros
