#include "nodes/hires/bag_salvage.h"

#include <rosbag/bag.h>
#include <topic_tools/shape_shifter.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <cstdint>
#include <fstream>
#include <string_view>
#include <vector>

namespace hires_ros {
namespace {

constexpr std::uint64_t kMostRecord = 1 << 29;  // [bytes]
enum Op { kDefinition = 1, kMessage = 2, kChunk = 5, kConnection = 7 };

using Fields = BagFields;

/// Takes lengths and what is as long from the front of some bytes.
class Cursor {
 public:
  explicit Cursor(std::string_view bytes) : left_(bytes) {}

  /// Nothing where fewer bytes are left than it claims.
  std::optional<std::string_view> TakeSized() {
    if (left_.size() < 4) return std::nullopt;
    const std::uint64_t size = NumberIn(left_.substr(0, 4));
    if (size > left_.size() - 4) return std::nullopt;
    const std::string_view taken = left_.substr(4, size);
    left_.remove_prefix(4 + size);
    return taken;
  }
  bool is_empty() const { return left_.empty(); }

 private:
  std::string_view left_;
};

struct Record {
  Fields fields;
  std::string_view data;

  std::string Of(const std::string& name) const {
    const auto field = fields.find(name);
    return field == fields.end() ? "" : field->second;
  }
  int op() const { return static_cast<int>(NumberIn(Of("op"))); }
};

std::optional<Record> TakeRecord(Cursor* cursor) {
  const auto header = cursor->TakeSized();
  const auto data = header ? cursor->TakeSized() : std::nullopt;
  auto fields = data ? FieldsOf(*header) : std::nullopt;
  if (!fields) return std::nullopt;
  return Record{std::move(*fields), *data};
}

/// What a topic's messages are.
struct Connection {
  std::string topic, type, md5sum, definition;
};

class Salvage {
 public:
  Salvage(const std::string& path, const std::string& into)
      : file_(path, std::ios::binary), bag_(into, rosbag::bagmode::Write) {}

  Salvaged Run() {
    std::string line;
    std::getline(file_, line);
    for (const char* format : {"2.0", "1.2"})
      if (line == std::string("#ROSBAG V") + format) result_.format = format;
    if (!result_.format.empty()) TakeAll();
    bag_.close();
    return result_;
  }

 private:
  void TakeAll() {
    while (file_.peek() != std::ifstream::traits_type::eof()) {
      const auto header = ReadSized();
      const auto fields = header ? FieldsOf(*header) : std::nullopt;
      // Of a chunk that is cut off what is there is taken.
      const auto data = fields ? ReadSized(/*may_be_cut=*/true) : std::nullopt;
      if (!data) {
        result_.ends_early = true;
        return;
      }
      Take({*fields, *data});
      if (result_.ends_early) return;
    }
  }

  /// Nothing where the file ends before.
  std::optional<std::string> ReadSized(bool may_be_cut = false) {
    std::string size(4, '\0');
    if (!file_.read(size.data(), 4)) return std::nullopt;
    const std::uint64_t wanted = NumberIn(size);
    if (wanted > kMostRecord) return std::nullopt;
    std::string bytes(wanted, '\0');
    file_.read(bytes.data(), static_cast<std::streamsize>(wanted));
    const auto got = static_cast<std::uint64_t>(file_.gcount());
    if (got == wanted) return bytes;
    result_.ends_early = true;
    if (!may_be_cut) return std::nullopt;
    bytes.resize(got);
    return bytes;
  }

  void Take(const Record& record) {
    switch (record.op()) {
      case kChunk:
        return TakeChunk(record);
      case kDefinition:  // of format 1.2, whose records lie side by side
        connections_[record.Of("topic")] = {record.Of("topic"), record.Of("type"), record.Of("md5"),
                                            record.Of("def")};
        return;
      case kMessage:
        if (result_.format == "2.0" || result_.ends_early) return;
        return Write(record.Of("topic"),
                     ros::Time(NumberIn(record.Of("sec")), NumberIn(record.Of("nsec"))),
                     record.data);
      case kConnection:
        return TakeConnection(record);
      default:
        return;
    }
  }

  void TakeChunk(const Record& chunk) {
    if (chunk.Of("compression") != "none") {
      ++result_.num_packed;
      return;
    }
    for (Cursor cursor(chunk.data); !cursor.is_empty();) {
      const auto record = TakeRecord(&cursor);
      if (!record) {
        result_.ends_early = true;
        return;
      }
      if (record->op() == kConnection) TakeConnection(*record);
      if (record->op() != kMessage) continue;
      const std::string time = record->Of("time");
      if (time.size() != 8) continue;
      Write(record->Of("conn"),
            ros::Time(NumberIn(std::string_view(time).substr(0, 4)),
                      NumberIn(std::string_view(time).substr(4))),
            record->data);
    }
  }

  void TakeConnection(const Record& record) {
    const auto fields = FieldsOf(record.data);
    if (!fields) return;
    const Record told{*fields, {}};
    connections_[record.Of("conn")] = {record.Of("topic"), told.Of("type"), told.Of("md5sum"),
                                       told.Of("message_definition")};
  }

  void Write(const std::string& key, const ros::Time& time, std::string_view bytes) {
    const auto found = connections_.find(key);
    if (found == connections_.end() || time < ros::TIME_MIN) return;
    const Connection& connection = found->second;
    topic_tools::ShapeShifter message;
    message.morph(connection.md5sum, connection.type, connection.definition, "");
    std::vector<std::uint8_t> copy(bytes.begin(), bytes.end());
    ros::serialization::IStream stream(copy.data(), static_cast<std::uint32_t>(copy.size()));
    message.read(stream);
    bag_.write(connection.topic, time, message);
    ++result_.num_messages;
  }

  std::ifstream file_;
  rosbag::Bag bag_;
  Salvaged result_;
  std::map<std::string, Connection> connections_;  // by id, or by topic
};

}  // namespace

std::optional<BagFields> FieldsOf(std::string_view header) {
  BagFields fields;
  for (Cursor cursor(header); !cursor.is_empty();) {
    const auto field = cursor.TakeSized();
    const std::size_t equals = field ? field->find('=') : std::string_view::npos;
    if (equals == std::string_view::npos) return std::nullopt;
    fields[std::string(field->substr(0, equals))] = field->substr(equals + 1);
  }
  return fields;
}

std::uint64_t NumberIn(std::string_view bytes) {
  std::uint64_t number = 0;
  for (std::size_t i = bytes.size(); i > 0; --i)
    number = number << 8 | static_cast<unsigned char>(bytes[i - 1]);
  return number;
}

Salvaged SalvageBag(const std::string& path, const std::string& into) {
  return Salvage(path, into).Run();
}

}  // namespace hires_ros
