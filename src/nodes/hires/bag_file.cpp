#include "nodes/hires/bag_file.h"

#include <fmt/format.h>
#include <rosbag/view.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <tf2_msgs/TFMessage.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <new>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/text.h"
#include "nodes/hires/bag_salvage.h"

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
        "{}: no such bag; name a file that `rosbag record` (for `hires replay`, `map`, `localise`) "
        "or `hires imagine --save-rollout worst --bag FILE` (for `hires watch`) wrote",
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

std::uint64_t NumberAt(const std::string& bytes, std::size_t at, std::size_t size) {
  return NumberIn(std::string_view(bytes).substr(at, size));
}

/// It stops within a record, as a copy that was cut off does, or a recording that goes on.
struct EndsEarly {};

/// Walks through a bag of format 2.0 before rosbag does, which believes what stands in it: a wrong
/// length or offset makes it read beyond its buffers.
class BagCheck {
 public:
  explicit BagCheck(const std::string& path) : path_(path), file_(path, std::ios::binary) {
    file_.seekg(0, std::ios::end);
    size_ = static_cast<std::uint64_t>(file_.tellg());
  }

  /// @throws ConfigError for what no recorder writes, EndsEarly.
  void Run() {
    const std::string line = Read(0, std::min<std::uint64_t>(size_, kFirstLine.size()));
    if (line != kFirstLine) return;  // rosbag itself refuses what it does not know
    for (std::uint64_t at = kFirstLine.size(); at < size_;) {
      at = TakeRecord(at);
      if (index_at_ == 0) throw EndsEarly();  // there is no index
    }
    if (index_at_ == 0 || index_at_ > size_ || indexed_.size() < num_chunks_) throw EndsEarly();
    const bool ends_well = index_at_ == size_ || records_.count(index_at_) > 0;
    if (!ends_well) Fail("its index is not where its header says");
    for (const std::uint64_t chunk : indexed_) {
      if (chunks_.count(chunk) == 0) Fail("its index names a chunk that is not there");
    }
  }

 private:
  using Fields = BagFields;
  static constexpr std::uint64_t kMostHeader = 1 << 20;  // [bytes]
  static constexpr std::uint64_t kMostChunk = 1 << 29;   // [bytes]
  static constexpr std::size_t kIndexEntry = 12;         // [bytes]
  static inline const std::string kFirstLine = "#ROSBAG V2.0\n";
  enum Op { kMessage = 2, kFileHeader = 3, kIndex = 4, kChunk = 5, kChunkInfo = 6 };

  [[noreturn]] void Fail(const std::string& what) const { FailBroken(path_, what); }

  std::string Read(std::uint64_t at, std::uint64_t size) {
    if (at > size_ || size > size_ - at) throw EndsEarly();
    std::string bytes(size, '\0');
    file_.clear();
    file_.seekg(static_cast<std::streamoff>(at));
    if (!file_.read(bytes.data(), static_cast<std::streamsize>(size))) Fail("it cannot be read");
    return bytes;
  }

  Fields FieldsAt(const std::string& bytes, std::size_t at, std::size_t size) const {
    const auto fields = FieldsOf(std::string_view(bytes).substr(at, size));
    if (!fields) Fail("a header's field is no field");
    return *fields;
  }

  std::uint64_t NumberOf(const Fields& fields, const std::string& name, std::size_t size) const {
    const auto field = fields.find(name);
    if (field == fields.end() || field->second.size() != size)
      Fail(fmt::format("a header's {} has not {} bytes", name, size));
    return NumberAt(field->second, 0, size);
  }

  static bool IsPacked(const Fields& chunk) {
    const auto compression = chunk.find("compression");
    return compression == chunk.end() || compression->second != "none";
  }

  /// @return where the next one begins.
  std::uint64_t TakeRecord(std::uint64_t at) {
    const std::uint64_t header_size = NumberAt(Read(at, 4), 0, 4);
    if (header_size > kMostHeader) Fail("a header claims to be larger than 1 MB");
    const Fields fields = FieldsAt(Read(at + 4, header_size), 0, header_size);
    const std::uint64_t data_at = at + 8 + header_size;
    const bool is_index = NumberOf(fields, "op", 1) == kIndex;
    // Recorders of 2010 wrote another length than that of the entries that they count.
    const std::uint64_t data_size = is_index ? NumberOf(fields, "count", 4) * kIndexEntry
                                             : NumberAt(Read(data_at - 4, 4), 0, 4);
    if (data_size > size_ - data_at) throw EndsEarly();
    records_.insert(at);
    switch (NumberOf(fields, "op", 1)) {
      case kFileHeader:
        index_at_ = NumberOf(fields, "index_pos", 8);
        num_chunks_ = NumberOf(fields, "chunk_count", 4);
        break;
      case kChunk:
        chunks_.insert(at);
        if (std::max(data_size, NumberOf(fields, "size", 4)) > kMostChunk)
          Fail("a chunk claims to be larger than 512 MB");
        chunk_ = IsPacked(fields) ? "" : Read(data_at, data_size);
        chunk_size_ = chunk_.empty() ? NumberOf(fields, "size", 4) : data_size;
        break;
      case kIndex:
        CheckIndex(Read(data_at, data_size), NumberOf(fields, "count", 4));
        break;
      case kChunkInfo:
        indexed_.push_back(NumberOf(fields, "chunk_pos", 8));
        break;
    }
    return data_at + data_size;
  }

  /// Of the chunk before it: time and place of each message of a connection.
  void CheckIndex(const std::string& entries, std::uint64_t count) const {
    constexpr std::size_t kTime = 8;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t at = NumberAt(entries, i * kIndexEntry + kTime, 4);
      if (at + 8 > chunk_size_) Fail("a message begins beyond its chunk");
      if (!chunk_.empty()) CheckMessage(at);
    }
  }

  void CheckMessage(std::size_t at) const {
    const auto size_at = [&](std::size_t place) {
      if (place + 4 > chunk_.size()) Fail("a message ends beyond its chunk");
      const std::size_t size = NumberAt(chunk_, place, 4);
      if (size > chunk_.size() - place - 4) Fail("a message ends beyond its chunk");
      return size;
    };
    // Where a connection's record comes first, the message follows.
    for (Fields fields; fields.empty() || NumberOf(fields, "op", 1) != kMessage;) {
      const std::size_t header_size = size_at(at);
      fields = FieldsAt(chunk_, at + 4, header_size);
      at += 4 + header_size;
      at += 4 + size_at(at);
    }
  }

  const std::string& path_;
  std::ifstream file_;
  std::uint64_t size_{0};               // [bytes]
  std::uint64_t index_at_{0};           // by the file's header
  std::uint64_t num_chunks_{0};         // likewise
  std::set<std::uint64_t> records_;     // where they begin
  std::set<std::uint64_t> chunks_;      // likewise
  std::vector<std::uint64_t> indexed_;  // chunks by the index
  std::string chunk_;                   // read last; "" where it is compressed
  std::uint64_t chunk_size_{0};         // [bytes] unpacked
};

/// A file that is gone with this, though not for who has opened it.
class ScopedFile {
 public:
  ScopedFile() {
    path_ = (std::filesystem::temp_directory_path() / "hires_bag_XXXXXX").string();
    const int descriptor = mkstemp(path_.data());
    if (descriptor < 0)
      throw ConfigError(fmt::format("{}: cannot be written; free some space there", path_));
    close(descriptor);
  }
  ~ScopedFile() { unlink(path_.c_str()); }
  ScopedFile(const ScopedFile&) = delete;
  ScopedFile& operator=(const ScopedFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// What is whole of a bag that ends early, or has no index.
void OpenSalvaged(const std::string& path, rosbag::Bag* bag) {
  const ScopedFile file;
  const Salvaged salvaged = SalvageBag(path, file.path());
  if (salvaged.format.empty()) {
    throw ConfigError(fmt::format(
        "{}: is a bag of a format that is not read; wanted 2.0 (since 2010) or 1.2", path));
  }
  const std::string what = fmt::format(
      "{} (format {}): {}", path, salvaged.format,
      salvaged.ends_early ? "ends within a record, as a copy that was cut off, or a recording that "
                            "goes on or was killed"
                          : "has no index, as a recording that was killed");
  const std::string packed =
      salvaged.num_packed == 0
          ? ""
          : fmt::format("; {} compressed parts are left out", salvaged.num_packed);
  if (salvaged.num_messages == 0) {
    throw ConfigError(fmt::format(
        "{}; no whole message is in it{}; copy it once more, or record again{}", what, packed,
        salvaged.num_packed == 0 ? "" : fmt::format(", or try `rosbag reindex {}`", path)));
  }
  hires::base::Log(hires::base::LogLevel::kWarn, fmt::format("{}: {} whole messages are read{}",
                                                             what, salvaged.num_messages, packed));
  bag->open(file.path(), rosbag::bagmode::Read);
}

/// Types are judged by their definition: some had other names before.
std::string TypeOf(const rosbag::ConnectionInfo& info) {
  using Transforms = tf2_msgs::TFMessage;
  if (info.md5sum == ros::message_traits::md5sum<Transforms>())
    return ros::message_traits::datatype<Transforms>();
  return info.datatype;
}

}  // namespace

void OpenBag(const std::string& path, rosbag::Bag* bag) {
  RequireBagFile(path);
  try {
    BagCheck(path).Run();
    bag->open(path, rosbag::bagmode::Read);
  } catch (const EndsEarly&) {
    OpenSalvaged(path, bag);
  } catch (const rosbag::BagUnindexedException&) {
    bag->close();
    OpenSalvaged(path, bag);
  }
}

std::vector<BagTopic> TopicsOfBag(const rosbag::Bag& bag) {
  std::map<std::string, BagTopic> topics;
  for (const rosbag::ConnectionInfo* info : rosbag::View(bag).getConnections()) {
    const auto is_this = [&](const rosbag::ConnectionInfo* other) { return other->id == info->id; };
    const BagTopic topic{{info->topic, TypeOf(*info), 0}, info->md5sum};
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
