#include "world/maps/map_picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <jpeglib.h>
#include <png.h>

#include <cstdlib>

#include "hires/base/error.h"
#include "hires/base/rng.h"
#include "support/rounds.h"
#include "world/maps/bmp.h"
#include "world/maps/jpeg.h"
#include "world/maps/png.h"
#include "world/maps/pnm.h"
#include "world/temp_folder.h"

namespace hires::world::map_picture_test {
namespace {

using test_support::Rounds;
using testing::AllOf;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// --- writers of what others write ----------------------------------------------------------------

/// @param samples  row by row, each of depth 16 with the upper byte first.
std::string Png(int colour_type, int depth, int width, int height,
                const std::vector<std::uint8_t>& samples,
                const std::vector<png_color>& palette = {}, double gamma = 0.0) {
  std::string bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  const auto write = [](png_structp to, png_bytep data, png_size_t size) {
    static_cast<std::string*>(png_get_io_ptr(to))->append(reinterpret_cast<char*>(data), size);
  };
  png_set_write_fn(png, &bytes, write, [](png_structp) {});
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), depth,
               colour_type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  if (!palette.empty()) png_set_PLTE(png, info, palette.data(), static_cast<int>(palette.size()));
  if (gamma > 0.0) png_set_gAMA(png, info, gamma);
  png_write_info(png, info);
  const std::size_t row_bytes = samples.size() / static_cast<std::size_t>(height);
  for (int row = 0; row < height; ++row) png_write_row(png, samples.data() + row * row_bytes);
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

std::string Little(std::uint32_t number, int size) {
  std::string bytes;
  for (int k = 0; k < size; ++k) bytes += static_cast<char>(number >> 8 * k);
  return bytes;
}

/// @param tail  palette or masks, and then rows from the bottom, filled up to words.
std::string Bmp(int depth, int width, int height, std::uint32_t packing, std::uint32_t colours,
                const std::string& palette, const std::string& rows) {
  const auto begin = static_cast<std::uint32_t>(54 + palette.size());
  return "BM" + Little(begin + static_cast<std::uint32_t>(rows.size()), 4) + Little(0, 4) +
         Little(begin, 4) + Little(40, 4) + Little(static_cast<std::uint32_t>(width), 4) +
         Little(static_cast<std::uint32_t>(height), 4) + Little(1, 2) +
         Little(static_cast<std::uint32_t>(depth), 2) + Little(packing, 4) + Little(0, 12) +
         Little(colours, 4) + Little(0, 4) + palette + rows;
}

std::string Jpeg(int width, int height, const std::vector<std::uint8_t>& greys) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* out = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &out, &size);
  jpeg.image_width = static_cast<JDIMENSION>(width);
  jpeg.image_height = static_cast<JDIMENSION>(height);
  jpeg.input_components = 1;
  jpeg.in_color_space = JCS_GRAYSCALE;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, 100, TRUE);
  jpeg_start_compress(&jpeg, TRUE);
  for (int row = 0; row < height; ++row) {
    auto* data = const_cast<std::uint8_t*>(greys.data()) + static_cast<std::ptrdiff_t>(row) * width;
    jpeg_write_scanlines(&jpeg, &data, 1);
  }
  jpeg_finish_compress(&jpeg);
  std::string bytes(reinterpret_cast<char*>(out), size);
  jpeg_destroy_compress(&jpeg);
  std::free(out);
  return bytes;
}

std::vector<int> Greys(const MapPicture& picture) {
  std::vector<int> greys;
  for (const int sum : picture.colours) greys.push_back(sum / 3);
  return greys;
}

std::string ErrorOf(const std::string& bytes) {
  return MessageOf<base::ConfigError>([&] { ParseMapPicture(bytes, "a.map"); });
}

// --- PNG -----------------------------------------------------------------------------------------

TEST(PngTest, GreyStaysAsItIs) {
  const MapPicture picture =
      ParsePng(Png(PNG_COLOR_TYPE_GRAY, 8, 3, 2, {0, 1, 10, 205, 254, 255}), "a.png");
  EXPECT_EQ(picture.width, 3);
  EXPECT_EQ(picture.height, 2);
  EXPECT_THAT(Greys(picture), ElementsAre(0, 1, 10, 205, 254, 255));
  EXPECT_THAT(picture.alpha, IsEmpty());
}

TEST(PngTest, ColoursAreSummedAndTransparencyIsKeptApart) {
  EXPECT_THAT(ParsePng(Png(PNG_COLOR_TYPE_RGB, 8, 2, 1, {30, 60, 90, 255, 0, 0}), "a.png").colours,
              ElementsAre(180, 255));
  const MapPicture clear =
      ParsePng(Png(PNG_COLOR_TYPE_RGBA, 8, 2, 1, {9, 9, 9, 255, 254, 254, 254, 128}), "a.png");
  EXPECT_THAT(Greys(clear), ElementsAre(9, 254));
  EXPECT_THAT(clear.alpha, ElementsAre(255, 128));
}

TEST(PngTest, PalettesAreColoursAndFewBitsAreSpreadOverAll) {
  const std::vector<png_color> palette{{0, 0, 0}, {205, 205, 205}, {254, 254, 254}, {255, 0, 0}};
  EXPECT_THAT(
      ParsePng(Png(PNG_COLOR_TYPE_PALETTE, 8, 4, 1, {2, 1, 0, 3}, palette), "a.png").colours,
      ElementsAre(762, 615, 0, 255));
  EXPECT_THAT(Greys(ParsePng(Png(PNG_COLOR_TYPE_GRAY, 1, 4, 1, {0b01010000}), "a.png")),
              ElementsAre(0, 255, 0, 255));
}

TEST(PngTest, SixteenBitAreTheSameCellsAsEightWhateverTheGamma) {
  for (int seed = 0; seed < Rounds(80); ++seed) {
    base::Rng rng = base::Rng(16).Fork(seed);
    constexpr int kTypes[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                              PNG_COLOR_TYPE_RGBA};
    constexpr int kChannels[] = {1, 2, 3, 4};
    const int type = rng.Index(4), width = 1 + rng.Index(9), height = 1 + rng.Index(9);
    std::vector<std::uint8_t> narrow, wide;
    for (int i = 0; i < width * height * kChannels[type]; ++i) {
      const auto value = static_cast<std::uint8_t>(rng.Index(256));
      narrow.push_back(value);
      wide.insert(wide.end(), {value, value});  // v * 257
    }
    const double gamma = rng.Index(2) == 0 ? 0.0 : 1.0 / rng.Uniform(0.5, 2.5);
    const MapPicture a = ParsePng(Png(kTypes[type], 8, width, height, narrow), "a.png");
    const MapPicture b = ParsePng(Png(kTypes[type], 16, width, height, wide, {}, gamma), "b.png");
    EXPECT_EQ(a.colours, b.colours) << "seed " << seed;
    EXPECT_EQ(a.alpha, b.alpha) << "seed " << seed;
  }
}

TEST(PngTest, ABrokenFileIsNamedAtWhateverPlaceItIsCutShort) {
  const std::string whole = Png(PNG_COLOR_TYPE_GRAY, 8, 4, 4, std::vector<std::uint8_t>(16, 200));
  ASSERT_TRUE(IsPng(whole));
  for (std::size_t size = 4; size + 12 < whole.size(); ++size) {  // the last chunk says nothing
    EXPECT_THAT(ErrorOf(whole.substr(0, size)), AllOf(HasSubstr("a.map: "), HasSubstr("save")))
        << size;
  }
  EXPECT_FALSE(IsPng("P5 1 1 255 a"));
  EXPECT_FALSE(IsPng(""));
}

TEST(PngTest, AHugeImageIsRefusedBeforeItsPixelsAreRead) {
  std::string bytes = Png(PNG_COLOR_TYPE_GRAY, 8, 1, 1, {0});
  // Width and height in the header, then its checksum: libpng refuses either one or the other.
  for (const std::size_t place : {16u, 20u})
    bytes.replace(place, 4, std::string("\x00\x01\x00\x00", 4));
  EXPECT_THAT(ErrorOf(bytes), HasSubstr("a.map: "));
}

// --- netpbm --------------------------------------------------------------------------------------

std::string PnmError(const std::string& bytes) {
  return MessageOf<base::ConfigError>([&] { ParsePnm(bytes, "a.pgm"); });
}

TEST(PnmTest, PlainAndRawGiveTheSamePixels) {
  const std::string raw =
      std::string("P5\n# made by hand\n3 2\n255\n") + std::string("\x00\x01\x0a\x23\xfe\xff", 6);
  const MapPicture picture = ParsePnm(raw, "a.pgm");
  EXPECT_EQ(picture.width, 3);
  EXPECT_EQ(picture.height, 2);
  EXPECT_THAT(Greys(picture), ElementsAre(0, 1, 10, 35, 254, 255));
  EXPECT_EQ(ParsePnm("P2 3 #w\n2 255\n0 1 10\n35 # in between\n254 255", "a.pgm").colours,
            picture.colours);
}

TEST(PnmTest, ColoursAndBitsAreRead) {
  EXPECT_THAT(ParsePnm("P3 2 1 255 30 60 90 255 0 0", "a.ppm").colours, ElementsAre(180, 255));
  EXPECT_THAT(ParsePnm("P6 1 1 255 abc", "a.ppm").colours, ElementsAre('a' + 'b' + 'c'));
  EXPECT_THAT(Greys(ParsePnm("P1 3 2 010 1 1 0", "a.pbm")), ElementsAre(255, 0, 255, 0, 0, 255));
  EXPECT_THAT(Greys(ParsePnm(std::string("P4 9 1\n") + "\x41\x80", "a.pbm")),
              ElementsAre(255, 0, 255, 255, 255, 255, 255, 0, 0));
}

TEST(PnmTest, OtherMaximaAreScaledTo255) {
  EXPECT_THAT(Greys(ParsePnm("P2 3 1 15 0 7 15", "a.pgm")), ElementsAre(0, 119, 255));
  const std::string wide = std::string("P5 2 1 65535\n") + std::string("\xff\xff\x80\x00", 4);
  EXPECT_THAT(Greys(ParsePnm(wide, "a.pgm")), ElementsAre(255, 128));
}

TEST(PnmTest, FormattedImageReadsBackTheSame) {
  const GreyImage image{2, 3, {'#', '\n', ' ', 0, 255, 7}};
  EXPECT_THAT(Greys(ParsePnm(FormatPgm(image), "a.pgm")), ElementsAre('#', '\n', ' ', 0, 255, 7));
  EXPECT_THROW(FormatPgm({2, 2, {0}}), std::logic_error);
}

TEST(PnmTest, RefusesWhatIsNoImage) {
  EXPECT_THAT(PnmError("P5"), HasSubstr("width"));
  EXPECT_THAT(PnmError("P51 1 255 a"), HasSubstr("width"));
  EXPECT_THAT(PnmError("P5 -1 1 255 a"), HasSubstr("no number where the width belongs"));
  EXPECT_THAT(PnmError("P5 0 1 255 a"), HasSubstr("width 0"));
  EXPECT_THAT(PnmError("P5 1"), HasSubstr("height"));
  EXPECT_THAT(PnmError("P5 1 # only a comment"), HasSubstr("height"));
  EXPECT_THAT(PnmError("P5 1 1 0 a"), HasSubstr("maximum grey value 0"));
  EXPECT_THAT(PnmError("P5 1 1 70000 a"), HasSubstr("70000"));
  EXPECT_THAT(PnmError("P5 99999999999999999999 1 255 a"), HasSubstr("width above"));
  EXPECT_THAT(PnmError("P1 2 1 12"), HasSubstr("no 0 or 1"));
}

TEST(PnmTest, RefusesImagesThatAreLargerThanTheirFile) {
  EXPECT_THAT(PnmError("P5 2 2 255\nabc"), HasSubstr("ends before its 4 pixels"));
  EXPECT_THAT(PnmError("P5 2 1 65535\nabc"), HasSubstr("of 2 byte(s)"));
  EXPECT_THAT(PnmError("P6 2 1 255\nabc"), HasSubstr("of 3 byte(s)"));
  EXPECT_THAT(PnmError("P4 9 1\na"), HasSubstr("ends before its 9 pixels"));
  EXPECT_THAT(PnmError("P2 2 2 255 1 2 3"), HasSubstr("next pixel"));
  EXPECT_THAT(PnmError("P2 9999 9999 255 1"), HasSubstr("ends before"));
  EXPECT_THAT(PnmError("P1 9999 9999 1"), HasSubstr("ends before"));
  EXPECT_THAT(PnmError("P5 100000 100000 255\nabc"), HasSubstr("scale it down"));
}

TEST(PnmTest, RefusesValuesAboveTheMaximum) {
  EXPECT_THAT(PnmError("P2 1 1 15 16"), HasSubstr("grey value 16, above its maximum 15"));
  EXPECT_THAT(PnmError("P5 1 1 15\n\x10"), HasSubstr("above its maximum"));
  EXPECT_THAT(PnmError("P2 1 1 255 x"), HasSubstr("next pixel"));
}

// --- BMP and JPEG --------------------------------------------------------------------------------

const std::string kThreeGreys = "\xfe\xfe\xfe" + std::string(1, '\0') + "\xcd\xcd\xcd" +
                                std::string(5, '\0');  // 254, 205, 0: blue, green, red, nothing

TEST(BmpTest, PalettesOfEachDepthAreColoursFromTheBottom) {
  const std::string eight("\x00\x01\x02\x00\x02\x02\x01\x00", 8),
      four("\x01\x20\x00\x00\x22\x10\x00\x00", 8);
  for (const std::string& bytes :
       {Bmp(8, 3, 2, 0, 3, kThreeGreys, eight), Bmp(4, 3, 2, 0, 3, kThreeGreys, four)}) {
    const MapPicture picture = ParseBmp(bytes, "a.bmp");
    EXPECT_THAT(Greys(picture), ElementsAre(0, 0, 205, 254, 205, 0));
    EXPECT_THAT(picture.alpha, IsEmpty());
  }
  EXPECT_THAT(
      Greys(ParseBmp(Bmp(1, 3, 1, 0, 2, kThreeGreys, std::string("\x40\0\0\0", 4)), "a.bmp")),
      ElementsAre(254, 205, 254));
}

TEST(BmpTest, ANegativeHeightIsFromTheTop) {
  const std::string rows("\x00\x00\x00\x00\x02\x00\x00\x00", 8);
  EXPECT_THAT(Greys(ParseBmp(Bmp(8, 1, -2, 0, 3, kThreeGreys, rows), "a.bmp")),
              ElementsAre(254, 0));
}

TEST(BmpTest, PackedRunsAreUnpacked) {
  // 2 x colour 1; end of row; a stretch of 3 and its filler; end.
  const std::string rows("\x02\x01\x00\x00\x00\x03\x02\x01\x00\x00\x00\x01", 12);
  EXPECT_THAT(Greys(ParseBmp(Bmp(8, 3, 2, 1, 3, kThreeGreys, rows), "a.bmp")),
              ElementsAre(0, 205, 254, 205, 205, 254));
}

TEST(BmpTest, ColoursAreReadAndAnEmptyFourthByteIsNoTransparency) {
  const std::string row24 = std::string("\x5a\x3c\x1e\xff\x00\x00\x00\x00", 8);
  EXPECT_THAT(ParseBmp(Bmp(24, 2, 1, 0, 0, "", row24), "a.bmp").colours, ElementsAre(180, 255));
  const std::string without = std::string("\x5a\x3c\x1e\x00\xff\x00\x00\x00", 8);
  EXPECT_THAT(ParseBmp(Bmp(32, 2, 1, 0, 0, "", without), "a.bmp").alpha, IsEmpty());
  const std::string with = std::string("\x5a\x3c\x1e\x00\xff\x00\x00\xff", 8);
  const MapPicture picture = ParseBmp(Bmp(32, 2, 1, 0, 0, "", with), "a.bmp");
  EXPECT_THAT(picture.colours, ElementsAre(180, 255));
  EXPECT_THAT(picture.alpha, ElementsAre(0, 255));
  const std::string masks = Little(0xf800, 4) + Little(0x07e0, 4) + Little(0x001f, 4);
  EXPECT_THAT(
      ParseBmp(Bmp(16, 2, 1, 3, 0, masks, std::string("\xff\xff\x00\xf8", 4)), "a.bmp").colours,
      ElementsAre(765, 255));
}

TEST(JpegTest, GreysAreReadAndDamageIsRefused) {
  std::vector<std::uint8_t> greys(64 * 32, 254);
  for (std::size_t i = 0; i < greys.size(); ++i) greys[i] = i % 64 < 32 ? 254 : 0;
  const std::string whole = Jpeg(64, 32, greys);
  const MapPicture picture = ParseJpeg(whole, "a.jpg");
  EXPECT_EQ(picture.width, 64);
  EXPECT_EQ(picture.height, 32);
  for (std::size_t i = 0; i < greys.size(); ++i) {
    ASSERT_NEAR(picture.colours[i] / 3, greys[i], 2) << i;
  }
  EXPECT_THAT(ErrorOf(whole.substr(0, whole.size() / 2)), HasSubstr("a.map: is a broken JPEG"));
  EXPECT_THAT(ErrorOf(whole.substr(0, 20)), HasSubstr("a.map: is a broken JPEG"));
}

TEST(MapPictureTest, EachFormatGivesTheSameCells) {
  for (int seed = 0; seed < Rounds(40); ++seed) {
    base::Rng rng = base::Rng(5).Fork(seed);
    const int width = 4 * (1 + rng.Index(5)), height = 1 + rng.Index(9);  // rows of whole words
    std::vector<std::uint8_t> greys, indices;
    for (int i = 0; i < width * height; ++i) {
      indices.push_back(static_cast<std::uint8_t>(rng.Index(3)));
      constexpr std::uint8_t kGreys[] = {254, 205, 0};
      greys.push_back(kGreys[indices.back()]);
    }
    std::string rows;
    for (int row = height - 1; row >= 0; --row)
      rows.append(indices.begin() + row * width, indices.begin() + (row + 1) * width);
    const std::vector<png_color> palette{{254, 254, 254}, {205, 205, 205}, {0, 0, 0}};
    const auto expected = ParseMapPicture(FormatPgm({width, height, greys}), "a.pgm").colours;
    for (const std::string& bytes :
         {Png(PNG_COLOR_TYPE_GRAY, 8, width, height, greys),
          Png(PNG_COLOR_TYPE_PALETTE, 8, width, height, indices, palette),
          Bmp(8, width, height, 0, 3, kThreeGreys, rows)}) {
      EXPECT_EQ(ParseMapPicture(bytes, "a.png").colours, expected) << "seed " << seed;
    }
  }
}

TEST(MapPictureTest, OtherFormatsAreNamed) {
  EXPECT_THAT(ErrorOf("GIF89a"), AllOf(HasSubstr("a.map: is a GIF"), HasSubstr("convert it")));
  EXPECT_THAT(ErrorOf("II*"), HasSubstr("a TIFF"));
  EXPECT_THAT(ErrorOf(""), HasSubstr("is empty"));
  EXPECT_THAT(ErrorOf("version https://git-lfs.github.com/spec/v1"), HasSubstr("Git LFS"));
  EXPECT_THAT(ErrorOf("P7 1"), HasSubstr("wanted a PGM, PNG, BMP or JPEG"));
}

TEST(MapPictureTest, SurvivesEveryCutAndEveryChangedByte) {
  const std::vector<std::uint8_t> greys(64, 205);
  const std::string packed("\x02\x01\x00\x00\x00\x03\x02\x01\x00\x00\x00\x01", 12);
  base::Rng rng(11);
  for (const std::string& good :
       {std::string("P5\n# c\n3 2\n255\nabcdef"), Bmp(8, 3, 2, 1, 3, kThreeGreys, packed),
        Bmp(32, 2, 1, 0, 0, "", "abcdefgh"), Png(PNG_COLOR_TYPE_GRAY, 8, 8, 8, greys),
        Jpeg(8, 8, greys)}) {
    const int size = static_cast<int>(good.size());
    for (int i = 0; i < size + Rounds(2000); ++i) {
      std::string changed = good.substr(0, i < size ? i : size);
      if (i >= size) changed[rng.Index(size)] = static_cast<char>(rng.Index(256));
      try {
        const MapPicture picture = ParseMapPicture(changed, "a.map");
        EXPECT_EQ(picture.colours.size(), static_cast<std::size_t>(picture.width) * picture.height);
      } catch (const base::ConfigError&) {
      }
    }
  }
}

}  // namespace
}  // namespace hires::world::map_picture_test
