#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hires/knowledge/fluent.h"
#include "knowledge/store/store_names.h"

namespace hires::knowledge {

/// Properties as bytes: their number, then of each the words of role and type, a tag and the
/// filler. Numbers have seven bits a byte, the lowest first. The same properties give the same
/// bytes, other ones others.
std::string EncodeProperties(const std::vector<Property>& properties, Words* words);
/// What was encoded.  @throws SQLite::Exception (damaged) where the bytes are none of that.
std::vector<Property> DecodeProperties(std::string_view bytes, Words* words);

/// By which a validity is found that has `text` in `role`, whatever the case of its letters. Kept
/// in files: never change it without a migration.
std::int64_t FillerHash(std::string_view role, std::string_view text);
/// Of all properties that have a text.
std::vector<std::int64_t> TextHashes(const std::vector<Property>& properties);

}  // namespace hires::knowledge
