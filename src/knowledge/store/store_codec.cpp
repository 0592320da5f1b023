#include "knowledge/store/store_codec.h"

#include <cstring>

#include "hires/base/hash.h"
#include "hires/base/overloaded.h"
#include "hires/base/text.h"
#include "knowledge/store/store_error.h"

namespace hires::knowledge {
namespace {

enum Tag : char { kText, kReal, kInteger, kFalse, kTrue };

void PutNumber(std::uint64_t number, std::string* bytes) {
  for (; number >= 0x80; number >>= 7) bytes->push_back(static_cast<char>(number | 0x80));
  bytes->push_back(static_cast<char>(number));
}

void PutReal(double value, std::string* bytes) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof(bits));
  for (int shift = 0; shift < 64; shift += 8) bytes->push_back(static_cast<char>(bits >> shift));
}

/// Small negative numbers are short as well: 0, -1, 1, -2, ... become 0, 1, 2, 3, ...
std::uint64_t Zigzag(std::int64_t value) {
  return (static_cast<std::uint64_t>(value) << 1) ^ (value < 0 ? ~std::uint64_t{0} : 0);
}

std::int64_t Unzigzag(std::uint64_t number) {
  return static_cast<std::int64_t>((number >> 1) ^ (~(number & 1) + 1));
}

void PutFiller(const Filler& filler, std::string* bytes) {
  std::visit(base::Overloaded{[&](const std::string& text) {
                                bytes->push_back(kText);
                                PutNumber(text.size(), bytes);
                                *bytes += text;
                              },
                              [&](double value) {
                                bytes->push_back(kReal);
                                PutReal(value, bytes);
                              },
                              [&](std::int64_t value) {
                                bytes->push_back(kInteger);
                                PutNumber(Zigzag(value), bytes);
                              },
                              [&](bool value) { bytes->push_back(value ? kTrue : kFalse); }},
             filler);
}

/// Takes bytes from the front.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}

  bool AtEnd() const { return bytes_.empty(); }
  std::size_t size() const { return bytes_.size(); }

  std::string_view Take(std::uint64_t size) {
    if (size > bytes_.size()) FailDamaged("properties end too early");
    const std::string_view taken = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return taken;
  }

  std::uint64_t Number() {
    std::uint64_t number = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      const auto byte = static_cast<unsigned char>(Take(1)[0]);
      number |= static_cast<std::uint64_t>(byte & 0x7f) << shift;
      if (byte < 0x80) return number;
    }
    FailDamaged("a number in properties does not end");
  }

  double Real() {
    std::uint64_t bits = 0;
    int shift = 0;
    for (const char byte : Take(8)) {
      bits |= static_cast<std::uint64_t>(static_cast<unsigned char>(byte)) << shift;
      shift += 8;
    }
    double value = 0.0;
    std::memcpy(&value, &bits, sizeof(value));
    return value;
  }

  Filler TakeFiller() {
    switch (Take(1)[0]) {
      case kText:
        return std::string(Take(Number()));
      case kReal:
        return Real();
      case kInteger:
        return Unzigzag(Number());
      case kFalse:
        return false;
      case kTrue:
        return true;
      default:
        FailDamaged("a filler is of no known kind");
    }
  }

 private:
  std::string_view bytes_;
};

}  // namespace

std::string EncodeProperties(const std::vector<Property>& properties, Words* words) {
  std::string bytes;
  PutNumber(properties.size(), &bytes);
  for (const Property& property : properties) {
    PutNumber(static_cast<std::uint64_t>(words->Intern(property.role)), &bytes);
    PutNumber(static_cast<std::uint64_t>(words->Intern(property.type)), &bytes);
    PutFiller(property.filler, &bytes);
  }
  return bytes;
}

std::vector<Property> DecodeProperties(std::string_view bytes, Words* words) {
  Reader reader(bytes);
  const std::uint64_t count = reader.Number();
  if (count > reader.size()) FailDamaged("more properties than bytes");
  std::vector<Property> properties;
  properties.reserve(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    Property& property = properties.emplace_back();
    property.role = words->Text(static_cast<std::int64_t>(reader.Number()));
    property.type = words->Text(static_cast<std::int64_t>(reader.Number()));
    property.filler = reader.TakeFiller();
  }
  if (!reader.AtEnd()) FailDamaged("bytes after the last property");
  return properties;
}

std::int64_t FillerHash(std::string_view role, std::string_view text) {
  base::Hasher hasher;
  hasher.Add(role);
  hasher.Add(base::ToLower(text));
  return static_cast<std::int64_t>(hasher.value());
}

std::vector<std::int64_t> TextHashes(const std::vector<Property>& properties) {
  std::vector<std::int64_t> hashes;
  for (const Property& property : properties) {
    const auto* text = std::get_if<std::string>(&property.filler);
    if (text != nullptr) hashes.push_back(FillerHash(property.role, *text));
  }
  return hashes;
}

}  // namespace hires::knowledge
