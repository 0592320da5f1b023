#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace hires_ros {

/// A number as bags have it, least significant byte first.  @pre at most 8 bytes
std::uint64_t NumberIn(std::string_view bytes);

/// What a record's header says, by name.
using BagFields = std::map<std::string, std::string>;

/// Of a header: a length each, then name=value; nothing where that does not hold.
std::optional<BagFields> FieldsOf(std::string_view header);

/// What could be read of a bag from its front, without an index.
struct Salvaged {
  std::string format;           ///< "2.0", "1.2"; empty: no bag
  std::size_t num_messages{0};  ///< that are whole
  std::size_t num_packed{0};    ///< chunks that are compressed, whose messages are left out
  bool ends_early{false};       ///< within a record
};

/// Copies all whole messages of a bag (format 2.0 or 1.2) to a new bag, with their times. Ends
/// where a record is cut off, or its lengths lead out of the file.
/// @throws ros::Exception, hires::base::ConfigError if `into` cannot be written.
Salvaged SalvageBag(const std::string& path, const std::string& into);

}  // namespace hires_ros
