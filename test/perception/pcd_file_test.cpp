#include "hires/perception/pcd_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "hires/base/error.h"
#include "support/log_catcher.h"
#include "support/temporary_folder.h"

namespace hires::perception::pcd_file_test {
namespace {

const char* const kHeader =
    "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\n"
    "TYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\n";

class PcdFileTest : public testing::Test {
 protected:
  std::string Write(const std::string& text) const {
    std::ofstream(path_, std::ios::binary) << text;
    return path_;
  }
  std::string ErrorOf(const std::string& text) const {
    try {
      ReadPcd(Write(text));
    } catch (const base::ConfigError& error) {
      return error.what();
    }
    return "";
  }

  const test_support::TemporaryFolder folder_;
  const std::string path_{(folder_.path() / "cloud.pcd").string()};
};

TEST_F(PcdFileTest, TextIsReadWithWhatWasNotMeasured) {
  const PointCloud cloud =
      ReadPcd(Write(std::string(kHeader) + "DATA ascii\n1 -2.5 3e-1 7\nnan nan nan 0\n"));
  ASSERT_EQ(cloud.points.size(), 2u);
  EXPECT_EQ(cloud.width, 2);
  EXPECT_EQ(cloud.height, 1);
  EXPECT_EQ(cloud.points[0], Eigen::Vector3f(1.0F, -2.5F, 0.3F));
  EXPECT_FALSE(IsMeasured(cloud.points[1]));
}

TEST_F(PcdFileTest, WhatWindowsWritesForNoNumberWasNotMeasured) {
  for (const char* word : {"1.#QNAN", "-1.#IND", "1.#INF00", "-nan(ind)", "-nan"}) {
    SCOPED_TRACE(word);
    const PointCloud cloud =
        ReadPcd(Write(std::string(kHeader) + "DATA ascii\n1 2 " + word + " 7\n1 2 3 0\n"));
    EXPECT_FALSE(IsMeasured(cloud.points[0]));
    EXPECT_TRUE(IsMeasured(cloud.points[1]));
  }
  EXPECT_NE(ErrorOf(std::string(kHeader) + "DATA ascii\n1 2 2.#QNAN 7\n1 2 3 0\n"), "");
}

TEST_F(PcdFileTest, OfFieldsOfOneNameTheFirstCounts) {
  const std::string text =
      "FIELDS x y z x z\nSIZE 4 4 4 4 4\nTYPE F F F F F\nCOUNT 1 1 1 1 1\nWIDTH 1\nHEIGHT 1\n"
      "POINTS 1\nDATA ascii\n1 2 3 4 5\n";
  EXPECT_EQ(ReadPcd(Write(text)).points.at(0), Eigen::Vector3f(1.0F, 2.0F, 3.0F));
}

TEST_F(PcdFileTest, PointsBehindTheLastOneAreWarnedOf) {
  const auto warning = [&](const std::string& rest) {
    const test_support::LogCatcher log;
    EXPECT_EQ(ReadPcd(Write(std::string(kHeader) + rest)).points.size(), 2u);
    return log.lines.empty() ? std::string() : log.lines.front();
  };
  const std::string two = "DATA ascii\n1 2 3 7\n4 5 6 0\n";
  EXPECT_EQ(warning(two + " \r\n\n"), "");
  EXPECT_NE(warning(two + "7 8 9 0\n\n7 8 9 0\n").find("2 more points follow the 2"),
            std::string::npos);
  const std::string points(2 * 16, 'a');
  EXPECT_EQ(warning("DATA binary\n" + points + std::string(64, '\0')), "");  // padding
  EXPECT_NE(warning("DATA binary\n" + points + points).find("2 more points"), std::string::npos);
}

TEST_F(PcdFileTest, WhatIsWrittenIsReadAgain) {
  PointCloud cloud;
  cloud.width = 3;
  cloud.height = 2;
  for (int i = 0; i < 6; ++i) cloud.points.emplace_back(0.1F * i, -1.0F, 2.0F + i);
  cloud.points[4].setConstant(std::nanf(""));
  WriteLabelledPcd(cloud, {0, 1, 2, 3, 4, 5}, path_);
  const PointCloud again = ReadPcd(path_);
  EXPECT_EQ(again.width, 3);
  EXPECT_EQ(again.height, 2);
  for (const int i : {0, 1, 2, 3, 5}) EXPECT_EQ(again.points[i], cloud.points[i]);
  EXPECT_FALSE(IsMeasured(again.points[4]));
}

TEST_F(PcdFileTest, DoublesAndFieldsOfSeveralNumbersArePassed) {
  std::string text =
      "VERSION .7\nFIELDS normal z y x\nSIZE 4 8 8 8\nTYPE F F F F\nCOUNT 3 1 1 1\nWIDTH 1\nHEIGHT "
      "1\n"
      "POINTS 1\nDATA binary\n";
  const float normal[] = {9.0F, 9.0F, 9.0F};
  const double zyx[] = {3.0, 2.0, 1.0};
  text.append(reinterpret_cast<const char*>(normal), sizeof(normal));
  text.append(reinterpret_cast<const char*>(zyx), sizeof(zyx));
  EXPECT_EQ(ReadPcd(Write(text)).points.at(0), Eigen::Vector3f(1.0F, 2.0F, 3.0F));
}

// Written by PCL.
TEST_F(PcdFileTest, RealPackedCloudsAreRead) {
  const std::string folder = std::string(HIRES_SHARED_DATA) + "/tabletop";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  for (const char* name : {"/learn0.pcd", "/table_scene_mug_stereo_textured.pcd"}) {
    const PointCloud cloud = ReadPcd(folder + name);
    EXPECT_EQ(cloud.width, 640);
    EXPECT_EQ(cloud.height, 480);
    int num_measured = 0;
    for (const Eigen::Vector3f& p : cloud.points) {
      num_measured += IsMeasured(p);
      EXPECT_TRUE(!IsMeasured(p) || (p.z() > 0.3F && p.z() < 12.0F)) << p.transpose();
    }
    EXPECT_GT(num_measured, 100000) << name;
  }
}

TEST_F(PcdFileTest, AByteOrderMarkBeforeTheHeaderIsPassedOver) {
  const PointCloud cloud =
      ReadPcd(Write("\xEF\xBB\xBF" + std::string(kHeader) + "DATA ascii\n1 2 3 7\n4 5 6 0\n"));
  EXPECT_EQ(cloud.points.at(1), Eigen::Vector3f(4.0F, 5.0F, 6.0F));
}

TEST_F(PcdFileTest, AMessageIsWholeWhateverTheFileHolds) {
  EXPECT_EQ(ErrorOf(std::string("\x01\x02\x00\x03 and more", 13)),
            path_ + ": is no text, wanted a header of the Point Cloud Data format (.pcd)");
  EXPECT_EQ(ErrorOf("VERSION 0.7\nFIE" + std::string(1, '\0') + "LDS x y z\n"),
            path_ +
                ": line 2: 'FIE\\x00LDS' begins no line of a header of the Point Cloud Data format "
                "(.pcd)");
  EXPECT_EQ(ErrorOf("VERSION 0.7\nWIDTH 1" + std::string(1, '\0') + "0\n"),
            path_ + ": line 2: '1\\x000' is no whole number from 0 to 50000000");
}

struct Damage {
  std::string text, said;
};

TEST_F(PcdFileTest, DamageIsSaidWithItsPlace) {
  const std::string head = kHeader;
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = head;
    return text.replace(text.find(from), from.size(), to);
  };
  const std::vector<Damage> damages{
      {"", "is an empty file"},
      {"solid brick\n", "line 1: 'solid' begins no line"},
      {head, "no line DATA"},
      {head + "DATA zipped\n", "line 11: DATA is 'zipped'"},
      {head + "DATA ascii\n1 2 3 4\n", "ends after 1 of 2 points"},
      {head + "DATA ascii\n1 2 3 4\n1 2 3\n", "line 13: has 3 values; wanted 4"},
      {head + "DATA ascii\n1 2 3 4\n1 two 3 4\n", "line 13: y is 'two', no number"},
      {head + "DATA binary\n0123456789012345678901234567890", "too early for 2 points"},
      {with("x y z", "x y w") + "DATA ascii\n", "has no field z; it has x, y, w, rgb"},
      {with("SIZE 4 4 4 4", "SIZE 4 4 4") + "DATA ascii\n", "line 4: SIZE says 3 values for 4"},
      {with("F F F U", "I F F U") + "DATA ascii\n", "field x is of TYPE I, SIZE 4"},
      {with("WIDTH 2", "WIDTH 3") + "DATA ascii\n", "WIDTH 3 times HEIGHT 1 are not the 2 POINTS"},
      {with("WIDTH 2", "WIDTH -2") + "DATA ascii\n", "line 7: '-2' is no whole number"},
      {with("WIDTH 2", "WIDTH 10000")
               .replace(with("WIDTH 2", "WIDTH 10000").find("POINTS 2"), 8, "") +
           "HEIGHT 10000\nDATA binary_compressed\n",
       "WIDTH 10000 times HEIGHT 10000 are 100000000 points; at most 50000000 are read"},
      {with("COUNT 1 1 1 1", "COUNT 1 1 1 100000") +
           "SIZE 4 4 4 8\nCOUNT 1 1 100000 100000\nDATA binary_compressed\n",
       "a point has more than 1000000 bytes; check COUNT"},
      {with("POINTS 2", "POINTS 99999999999999999999") + "DATA ascii\n", "is no whole number"},
      {head + "DATA binary_compressed\n" + std::string("\x05\x00\x00\x00\x20\x00\x00\x00", 8) +
           "ab",
       "ends after 2 of 5 bytes"},
      {head + "DATA binary_compressed\n" + std::string("\x02\x00\x00\x00\x21\x00\x00\x00", 8) +
           "ab",
       "unpacks to 33 bytes; 2 points of 16 bytes are 32"},
      // As from a computer whose numbers begin at the other end.
      {head + "DATA binary_compressed\n" + std::string("\x00\x00\x00\x02\x00\x00\x00\x20", 8) +
           "ab",
       "unpacks to 536870912 bytes"},
      {head + "DATA binary_compressed\n" + std::string("\x02\x00\x00\x00\x20\x00\x00\x00", 8) +
           "\xff\xff",
       "packed points are damaged"}};
  for (const Damage& damage : damages) {
    const std::string error = ErrorOf(damage.text);
    EXPECT_NE(error.find(damage.said), std::string::npos) << error << "\nwanted: " << damage.said;
    EXPECT_EQ(error.find(path_), 0u) << error;
  }
  EXPECT_THROW(ReadPcd((folder_.path() / "none.pcd").string()), base::ConfigError);
  EXPECT_THROW(ReadPcd(folder_.path().string()), base::ConfigError);
}

TEST_F(PcdFileTest, AFileThatCannotBeWrittenIsSaid) {
  EXPECT_THROW(WriteLabelledPcd({}, {}, (folder_.path() / "none" / "labels.pcd").string()),
               base::ConfigError);
}

}  // namespace
}  // namespace hires::perception::pcd_file_test
