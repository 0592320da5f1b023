#include "world/maps/bmp.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "hires/base/error.h"

namespace hires::world {
namespace {

constexpr std::uint32_t kPlain = 0, kPacked8 = 1, kPacked4 = 2, kMasks = 3, kMasksWithAlpha = 6;

/// Where a colour's bits are in a pixel of 16 or 32.
struct Mask {
  std::uint32_t bits{0};
  std::uint8_t Of(std::uint32_t pixel) const {
    if (bits == 0) return 0;
    const std::uint32_t lowest = bits & (~bits + 1);
    const std::uint64_t most = bits / lowest;
    return static_cast<std::uint8_t>((std::uint64_t{(pixel & bits) / lowest} * 255 + most / 2) /
                                     most);
  }
};

class BmpReader {
 public:
  BmpReader(const std::string& bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  MapPicture Read() {
    ReadHeader();
    const bool is_packed = packing_ == kPacked8 || packing_ == kPacked4;
    if (!is_packed) RowBegin(picture_.height - 1);  // a short file must not claim much memory
    picture_.colours.assign(static_cast<std::size_t>(picture_.width) * picture_.height, 0);
    if (is_packed) {
      Unpack();
    } else if (depth_ <= 8) {
      ReadIndices();
    } else {
      ReadColours();
    }
    return std::move(picture_);
  }

 private:
  [[noreturn]] void Fail(const std::string& what) const {
    throw base::ConfigError(
        fmt::format("{}: is a BMP that {}; save the image again, as PNG best", name_, what));
  }

  std::uint32_t Number(std::size_t at, int size) const {
    if (at + size > bytes_.size()) Fail("ends before its pixels do");
    std::uint32_t number = 0;
    for (int k = size - 1; k >= 0; --k) {
      number = number << 8 | static_cast<unsigned char>(bytes_[at + k]);
    }
    return number;
  }

  void ReadHeader() {
    begin_ = Number(10, 4);
    const std::uint32_t header = Number(14, 4);
    const bool is_old = header == 12;
    if (!is_old && header < 40) Fail(fmt::format("has a header of {} bytes", header));
    const auto size = [&](std::size_t old_at, std::size_t at) -> std::int64_t {
      if (is_old) return Number(old_at, 2);
      return static_cast<std::int32_t>(Number(at, 4));
    };
    const std::int64_t width = size(18, 18);
    std::int64_t height = size(20, 22);
    is_from_top_ = height < 0;
    height = std::abs(height);
    RequirePictureSize(width, height, name_);
    picture_.width = static_cast<int>(width);
    picture_.height = static_cast<int>(height);
    depth_ = static_cast<int>(Number(is_old ? 24 : 28, 2));
    packing_ = is_old ? kPlain : Number(30, 4);
    constexpr std::array<int, 6> kDepths{1, 4, 8, 16, 24, 32};
    if (std::count(kDepths.begin(), kDepths.end(), depth_) == 0)
      Fail(fmt::format("has {} bit a pixel", depth_));
    const bool fits =
        (packing_ == kPacked8 && depth_ == 8) || (packing_ == kPacked4 && depth_ == 4);
    has_masks_ = (packing_ == kMasks || packing_ == kMasksWithAlpha) && depth_ % 16 == 0;
    if (packing_ != kPlain && !fits && !has_masks_)
      Fail(fmt::format("is packed in a way that is not read ({})", packing_));
    if (depth_ <= 8) ReadPalette(14 + header, is_old ? 3 : 4, is_old ? 0 : Number(46, 4));
    if (depth_ == 16 || depth_ == 32) ReadMasks(header);
  }

  void ReadPalette(std::size_t at, int entry_bytes, std::uint32_t count) {
    const std::uint32_t most = 1u << depth_;
    if (count == 0 || count > most) count = most;
    for (std::uint32_t i = 0; i < count && at + 3 <= begin_; ++i, at += entry_bytes) {
      palette_.push_back(
          static_cast<std::uint16_t>(Number(at, 1) + Number(at + 1, 1) + Number(at + 2, 1)));
    }
  }

  void ReadMasks(std::uint32_t header) {
    if (!has_masks_) {
      red_.bits = depth_ == 16 ? 0x7c00 : 0xff0000;
      green_.bits = depth_ == 16 ? 0x03e0 : 0x00ff00;
      blue_.bits = depth_ == 16 ? 0x001f : 0x0000ff;
      alpha_.bits = depth_ == 16 ? 0 : 0xff000000;
      return;
    }
    red_.bits = Number(54, 4);
    green_.bits = Number(58, 4);
    blue_.bits = Number(62, 4);
    if (header >= 56 || packing_ == kMasksWithAlpha) alpha_.bits = Number(66, 4);
  }

  std::uint16_t& At(int column, int row) {
    const int from_top = is_from_top_ ? row : picture_.height - 1 - row;
    return picture_.colours[static_cast<std::size_t>(from_top) * picture_.width + column];
  }
  std::uint16_t Colour(std::uint32_t index) const {
    if (index >= palette_.size())
      Fail(fmt::format("names colour {} of a palette of {}", index, palette_.size()));
    return palette_[index];
  }

  /// Rows are filled up to whole words of 4 bytes.
  std::size_t RowBegin(int row) const {
    const std::size_t row_bytes = (static_cast<std::size_t>(picture_.width) * depth_ + 31) / 32 * 4;
    const std::size_t at = begin_ + row_bytes * row;
    if (at + (static_cast<std::size_t>(picture_.width) * depth_ + 7) / 8 > bytes_.size())
      Fail("ends before its pixels do");
    return at;
  }

  void ReadIndices() {
    const int per_byte = 8 / depth_;
    const std::uint32_t mask = (1u << depth_) - 1;
    for (int row = 0; row < picture_.height; ++row) {
      const std::size_t begin = RowBegin(row);
      for (int column = 0; column < picture_.width; ++column) {
        const std::uint32_t byte = static_cast<unsigned char>(bytes_[begin + column / per_byte]);
        const int shift = (per_byte - 1 - column % per_byte) * depth_;
        At(column, row) = Colour(byte >> shift & mask);
      }
    }
  }

  void ReadColours() {
    const int pixel_bytes = depth_ / 8;
    std::vector<std::uint8_t> alpha;
    if (alpha_.bits != 0) alpha.assign(picture_.colours.size(), 0);
    for (int row = 0; row < picture_.height; ++row) {
      const std::size_t begin = RowBegin(row);
      for (int column = 0; column < picture_.width; ++column) {
        const std::uint32_t pixel =
            Number(begin + static_cast<std::size_t>(column) * pixel_bytes, pixel_bytes);
        std::uint16_t& colour = At(column, row);
        colour = static_cast<std::uint16_t>(
            depth_ == 24 ? (pixel & 255) + (pixel >> 8 & 255) + (pixel >> 16)
                         : red_.Of(pixel) + green_.Of(pixel) + blue_.Of(pixel));
        if (!alpha.empty()) alpha[&colour - picture_.colours.data()] = alpha_.Of(pixel);
      }
    }
    const bool is_used = has_masks_ || std::any_of(alpha.begin(), alpha.end(),
                                                   [](std::uint8_t a) { return a != 0; });
    if (is_used) picture_.alpha = std::move(alpha);
  }

  /// Runs of equal pixels and stretches of different ones; what is left out has colour 0.
  void Unpack() {
    std::fill(picture_.colours.begin(), picture_.colours.end(), Colour(0));
    std::size_t at = begin_;
    column_ = row_ = 0;
    while (true) {
      const std::uint32_t count = Number(at, 1), value = Number(at + 1, 1);
      at += 2;
      if (count > 0) {
        for (std::uint32_t i = 0; i < count; ++i) Put(depth_ == 8 ? value : Half(value, i));
      } else if (value == 0) {
        column_ = 0;
        ++row_;
      } else if (value == 1) {
        return;
      } else if (value == 2) {
        column_ += static_cast<int>(Number(at, 1));
        row_ += static_cast<int>(Number(at + 1, 1));
        at += 2;
      } else {
        at = UnpackStretch(at, value);
      }
    }
  }
  static std::uint32_t Half(std::uint32_t byte, std::uint32_t i) {
    return i % 2 == 0 ? byte >> 4 : byte & 15;
  }
  void Put(std::uint32_t index) {
    if (column_ >= picture_.width || row_ >= picture_.height) Fail("has pixels beside its rows");
    At(column_++, row_) = Colour(index);
  }
  std::size_t UnpackStretch(std::size_t at, std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) {
      Put(depth_ == 8 ? Number(at + i, 1) : Half(Number(at + i / 2, 1), i));
    }
    const std::size_t used = depth_ == 8 ? count : (count + 1) / 2;
    return at + used + used % 2;  // to a whole word of 2 bytes
  }

  const std::string& bytes_;
  const std::string& name_;
  MapPicture picture_;
  std::size_t begin_{0};
  int depth_{0}, column_{0}, row_{0};
  std::uint32_t packing_{kPlain};
  bool is_from_top_{false}, has_masks_{false};
  std::vector<std::uint16_t> palette_;
  Mask red_, green_, blue_, alpha_;
};

}  // namespace

bool IsBmp(const std::string& bytes) { return bytes.size() > 26 && bytes.compare(0, 2, "BM") == 0; }

MapPicture ParseBmp(const std::string& bytes, const std::string& name) {
  return BmpReader(bytes, name).Read();
}

}  // namespace hires::world
