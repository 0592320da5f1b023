#include "world/png.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include "hires/base/error.h"
#include "hires/world/occupancy_grid.h"
#include "world/temp_folder.h"

namespace hires::world::png_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

std::string Png(int format, int width, int height, const std::vector<std::uint8_t>& pixels) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = static_cast<png_uint_32>(format);
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string bytes(size, '\0');
  EXPECT_NE(png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels.data(), 0, nullptr), 0)
      << image.message;
  bytes.resize(size);
  return bytes;
}

std::string ErrorOf(const std::string& bytes) {
  return MessageOf<base::ConfigError>([&] { ParsePng(bytes, "a.png"); });
}

TEST(PngTest, GreyStaysAsItIs) {
  const GreyImage image = ParsePng(Png(PNG_FORMAT_GRAY, 3, 2, {0, 1, 10, 205, 254, 255}), "a.png");
  EXPECT_EQ(image.width, 3);
  EXPECT_EQ(image.height, 2);
  EXPECT_THAT(image.pixels, ElementsAre(0, 1, 10, 205, 254, 255));
}

TEST(PngTest, ColoursCountByTheirMeanAndTransparencyDoesNot) {
  EXPECT_THAT(ParsePng(Png(PNG_FORMAT_RGB, 2, 1, {30, 60, 90, 255, 0, 0}), "a.png").pixels,
              ElementsAre(60, 85));
  EXPECT_THAT(
      ParsePng(Png(PNG_FORMAT_RGBA, 2, 1, {9, 9, 9, 255, 254, 254, 254, 128}), "a.png").pixels,
      ElementsAre(9, 254));
}

TEST(PngTest, AMapMayHaveOne) {
  TempFolder folder;
  folder.Write("m.png", Png(PNG_FORMAT_GRAY, 2, 1, {254, 0}));
  const OccupancyGrid grid =
      LoadMap(folder.Write("m.yaml",
                           "image: m.png\nresolution: 0.1\norigin: [0.0, 0.0, 0.0]\nnegate: 0\n"
                           "occupied_thresh: 0.65\nfree_thresh: 0.196\n"));
  EXPECT_THAT(grid.cells, ElementsAre(Cell::kFree, Cell::kOccupied));
}

TEST(PngTest, ABrokenFileIsNamedAtWhateverPlaceItIsCutShort) {
  const std::string whole = Png(PNG_FORMAT_GRAY, 4, 4, std::vector<std::uint8_t>(16, 200));
  ASSERT_TRUE(IsPng(whole));
  for (std::size_t size = 4; size + 12 < whole.size(); ++size) {  // the last chunk says nothing
    EXPECT_THAT(ErrorOf(whole.substr(0, size)), AllOf(HasSubstr("a.png: "), HasSubstr("save")))
        << size;
  }
  EXPECT_FALSE(IsPng("P5 1 1 255 a"));
  EXPECT_FALSE(IsPng(""));
}

TEST(PngTest, AHugeImageIsRefusedBeforeItsPixelsAreRead) {
  std::string bytes = Png(PNG_FORMAT_GRAY, 1, 1, {0});
  // Width and height in the header, then its checksum: libpng refuses either one or the other.
  for (const std::size_t place : {16u, 20u})
    bytes.replace(place, 4, std::string("\x00\x01\x00\x00", 4));
  EXPECT_THAT(ErrorOf(bytes), HasSubstr("a.png: "));
}

}  // namespace
}  // namespace hires::world::png_test
