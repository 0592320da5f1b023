#include "nodes/hires/bag_file.h"

#include <fmt/format.h>
#include <rosbag/view.h>
#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <new>
#include <stdexcept>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires_ros {
namespace {

using hires::base::ConfigError;

constexpr rlim_t kMostMemory = rlim_t{2} << 30;  // [bytes] for reading one bag
constexpr std::size_t kMostListed = 30;          // topics in a message

/// Lets this process grow by at most `bytes` while it lives. A few bytes of a broken message can
/// claim to be the length of a list of billions.
class ScopedMemoryLimit {
 public:
  explicit ScopedMemoryLimit(rlim_t bytes) {
    is_set_ = getrlimit(RLIMIT_AS, &before_) == 0;
    rlimit now = before_;
    const rlim_t wanted = UsedMemory() + bytes;
    if (wanted < before_.rlim_cur) now.rlim_cur = wanted;
    is_set_ = is_set_ && setrlimit(RLIMIT_AS, &now) == 0;
  }
  ~ScopedMemoryLimit() {
    if (is_set_) setrlimit(RLIMIT_AS, &before_);
  }
  ScopedMemoryLimit(const ScopedMemoryLimit&) = delete;
  ScopedMemoryLimit& operator=(const ScopedMemoryLimit&) = delete;

 private:
  static rlim_t UsedMemory() {
    rlim_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    return pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
  }

  rlimit before_{};
  bool is_set_{false};
};

void RequireBagFile(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    throw ConfigError(fmt::format(
        "{}: no such bag; name a file that `rosbag record` (for `hires replay`) or `hires imagine "
        "--save-rollout worst --bag FILE` (for `hires watch`) wrote",
        path));
  }
  std::string begin(4, '\0');
  std::ifstream file(path, std::ios::binary);
  if (!std::filesystem::is_regular_file(path, error) || !file.read(begin.data(), 4) ||
      begin != "#ROS") {
    throw ConfigError(fmt::format(
        "{}: is no ROS bag, or cannot be read: wanted a file that begins with '#ROSBAG'; name one "
        "that `rosbag record` wrote",
        path));
  }
}

[[noreturn]] void FailBroken(const std::string& path, const std::string& what) {
  throw ConfigError(fmt::format(
      "{}: is broken ({}); try `rosbag reindex {}`, which keeps what can be read, or record again",
      path, what, path));
}

}  // namespace

void OpenBag(const std::string& path, rosbag::Bag* bag) {
  RequireBagFile(path);
  try {
    bag->open(path, rosbag::bagmode::Read);
  } catch (const rosbag::BagUnindexedException&) {
    throw ConfigError(
        fmt::format("{}: has no index, because its recording goes on or was cut off; end the "
                    "recording (Ctrl-C), or mend the bag with `rosbag reindex {}`",
                    path, path));
  }
}

std::vector<BagTopic> TopicsOfBag(const rosbag::Bag& bag) {
  std::map<std::string, BagTopic> topics;
  for (const rosbag::ConnectionInfo* info : rosbag::View(bag).getConnections()) {
    const auto is_this = [&](const rosbag::ConnectionInfo* other) { return other->id == info->id; };
    const BagTopic topic{{info->topic, info->datatype, 0}, info->md5sum};
    auto& kept =
        topics.emplace(topic.name + ' ' + topic.type + ' ' + topic.md5sum, topic).first->second;
    kept.num_messages += rosbag::View(bag, is_this).size();
  }
  std::vector<BagTopic> out;
  for (auto& [key, topic] : topics) out.push_back(std::move(topic));
  return out;
}

std::vector<BagTopic> TopicsOfBagFile(const std::string& path) {
  std::vector<BagTopic> topics;
  ReadBag(path, [&] {
    rosbag::Bag bag;
    OpenBag(path, &bag);
    topics = TopicsOfBag(bag);
  });
  return topics;
}

std::string ListOfTopics(const std::vector<BagTopic>& topics) {
  if (topics.empty()) return "it is empty";
  std::vector<std::string> lines;
  for (const BagTopic& topic : topics) {
    if (lines.size() == kMostListed) break;
    lines.push_back(fmt::format("\n  {} ({})", topic.name, topic.type));
  }
  const std::size_t left = topics.size() - lines.size();
  if (left > 0) lines.push_back(fmt::format("\n  and {} more", left));
  return "in it are:" + hires::base::Join(lines, "");
}

void ReadBag(const std::string& path, const std::function<void()>& read) {
  const ScopedMemoryLimit limit(kMostMemory);
  try {
    read();
  } catch (const ConfigError&) {
    throw;
  } catch (const ros::Exception& error) {  // of rosbag, and of messages that end too early
    FailBroken(path, error.what());
  } catch (const std::bad_alloc&) {
    FailBroken(path, "something in it claims to be larger than 2 GB");
  } catch (const std::length_error&) {
    FailBroken(path, "something in it claims to be larger than any memory");
  }
}

}  // namespace hires_ros
