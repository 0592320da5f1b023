#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "hires/base/error.h"
#include "hires/base/rng.h"
#include "hires/perception/pcd_file.h"
#include "perception/support/pcl_files.h"
#include "support/rounds.h"
#include "support/temporary_folder.h"

// What PCL's reader makes of a file, ours does.
namespace hires::perception::pcd_beside_pcl_test {
namespace {

using hires::test_support::Rounds;
using test_support::PclFormat;

struct Field {
  std::string name;
  int size{4};
  char type{'F'};
  int count{1};
};

/// A file as some program writes it, and what is unusual about it.
struct DrawnFile {
  std::vector<Field> fields;
  PointCloud cloud;
  bool is_binary{false};
  bool has_returns{false};  // lines end as on Windows
  std::string header, body;
};

PointCloud DrawCloud(base::Rng* rng) {
  PointCloud cloud;
  cloud.width = 1 + rng->Index(9);
  cloud.height = rng->Bernoulli(0.5) ? 1 : 1 + rng->Index(5);
  for (int i = 0; i < cloud.width * cloud.height; ++i) {
    Eigen::Vector3f p;
    for (int axis = 0; axis < 3; ++axis) {
      p[axis] = static_cast<float>(rng->Normal(0.0, std::pow(10.0, rng->Uniform(-6.0, 6.0))));
      if (rng->Bernoulli(0.05)) p[axis] = std::numeric_limits<float>::quiet_NaN();
    }
    cloud.points.push_back(p);
  }
  return cloud;
}

std::vector<Field> DrawFields(base::Rng* rng) {
  constexpr const char* kTypes = "FIU";
  constexpr int kSizes[] = {1, 2, 4, 8};
  std::vector<Field> fields;
  for (const char* axis : {"x", "y", "z"}) {
    for (int extra = rng->Index(3); extra > 0; --extra) {
      const char type = kTypes[rng->Index(3)];
      const int size = type == 'F' ? kSizes[2 + rng->Index(2)] : kSizes[rng->Index(3)];
      fields.push_back({fmt::format("f{}", fields.size()), size, type, 1 + rng->Index(3)});
    }
    fields.push_back({axis});
  }
  return fields;
}

std::string LineOf(const std::string& key, const std::vector<std::string>& words) {
  std::string line = key;
  for (const std::string& word : words) line += " " + word;
  return line + "\n";
}

/// Lines that a file may lack are left out at times, each by itself.
std::string HeaderOf(const DrawnFile& file, base::Rng* rng) {
  std::vector<std::string> names, sizes, types, counts;
  bool is_plain = true;  // SIZE, TYPE and COUNT are what a reader takes for granted
  for (const Field& field : file.fields) {
    names.push_back(field.name);
    sizes.push_back(std::to_string(field.size));
    types.push_back(std::string(1, field.type));
    counts.push_back(std::to_string(field.count));
    is_plain = is_plain && field.size == 4 && field.type == 'F' && field.count == 1;
  }
  std::string text = rng->Bernoulli(0.7) ? "# .PCD v0.7 - Point Cloud Data file format\n" : "";
  if (rng->Bernoulli(0.7)) text += rng->Bernoulli(0.5) ? "VERSION 0.7\n" : "VERSION .5\n";
  text += LineOf(rng->Bernoulli(0.8) ? "FIELDS" : "COLUMNS", names);
  if (!is_plain || rng->Bernoulli(0.5)) {
    text += LineOf("SIZE", sizes) + LineOf("TYPE", types) + LineOf("COUNT", counts);
  }
  if (rng->Bernoulli(0.2)) text += "# by hand\n\n";
  const bool is_row = file.cloud.height == 1;
  const bool has_width = !is_row || rng->Bernoulli(0.5);
  if (has_width) text += fmt::format("WIDTH {}\n", file.cloud.width);
  if (!is_row || (has_width && rng->Bernoulli(0.5)))
    text += fmt::format("HEIGHT {}\n", file.cloud.height);
  if (rng->Bernoulli(0.5)) text += "VIEWPOINT 0 0 0 1 0 0 0\n";
  return text + fmt::format("POINTS {}\nDATA {}\n", file.cloud.points.size(),
                            file.is_binary        ? "binary"
                            : rng->Bernoulli(0.2) ? "ASCII"
                                                  : "ascii");
}

std::string BodyOf(const DrawnFile& file, base::Rng* rng) {
  std::string body;
  for (const Eigen::Vector3f& p : file.cloud.points) {
    // Of a line of blanks PCL makes a point at the origin, of an empty one none.
    if (!file.is_binary && !file.has_returns && rng->Bernoulli(0.1)) body += "\n";
    for (const Field& field : file.fields) {
      const char* axis = field.name.size() == 1 ? std::strchr("xyz", field.name[0]) : nullptr;
      const float number = axis == nullptr ? 0.0F : p[*axis - 'x'];
      if (file.is_binary && axis != nullptr) {
        body.append(reinterpret_cast<const char*>(&number), sizeof(number));
      } else if (file.is_binary) {
        body.append(static_cast<std::size_t>(field.size * field.count), '\x3f');
      } else if (axis != nullptr) {
        body += std::isnan(number) ? "nan " : fmt::format("{:.9g} ", number);
      } else {
        for (int i = 0; i < field.count; ++i) body += field.type == 'F' ? "0.5 " : "7 ";
      }
    }
    if (!file.is_binary) body += "\n";
  }
  return body;
}

std::string ReplaceAll(const std::string& text, const std::string& by) {
  std::string replaced;
  for (const char c : text) replaced += c == '\n' ? by : std::string(1, c);
  return replaced;
}

DrawnFile DrawFile(base::Rng rng) {
  DrawnFile file;
  file.fields = DrawFields(&rng);
  file.cloud = DrawCloud(&rng);
  file.is_binary = rng.Bernoulli(0.5);
  file.has_returns = !file.is_binary && rng.Bernoulli(0.2);
  file.header = HeaderOf(file, &rng);
  file.body = BodyOf(file, &rng);
  if (file.has_returns) {
    file.header = ReplaceAll(file.header, "\r\n");
    file.body = ReplaceAll(file.body, "\r\n");
  }
  return file;
}

bool IsSame(float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }

void ExpectSame(const PointCloud& ours, const PointCloud& theirs, const std::string& what) {
  EXPECT_EQ(ours.width, theirs.width) << what;
  EXPECT_EQ(ours.height, theirs.height) << what;
  ASSERT_EQ(ours.points.size(), theirs.points.size()) << what;
  for (std::size_t i = 0; i < ours.points.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis)
      ASSERT_TRUE(IsSame(ours.points[i][axis], theirs.points[i][axis]))
          << what << "\npoint " << i << ": " << ours.points[i].transpose() << " / "
          << theirs.points[i].transpose();
  }
}

class PcdBesidePclTest : public testing::Test {
 protected:
  const hires::test_support::TemporaryFolder folder_;
  const std::string path_{(folder_.path() / "cloud.pcd").string()};
};

TEST_F(PcdBesidePclTest, WhatItReadsIsReadAlike) {
  int num_read = 0;
  const int rounds = Rounds(2000);
  for (int i = 0; i < rounds; ++i) {
    const DrawnFile file = DrawFile(base::Rng(1).Fork(i));
    std::ofstream(path_, std::ios::binary) << file.header << file.body;
    const std::optional<PointCloud> theirs = test_support::ReadByPcl(path_);
    if (!theirs) continue;
    ++num_read;
    SCOPED_TRACE(fmt::format("draw {}", i));
    PointCloud ours;
    ASSERT_NO_THROW(ours = ReadPcd(path_)) << file.header;
    ExpectSame(ours, *theirs, file.header);
    if (HasFailure()) return;
  }
  EXPECT_GT(num_read, rounds * 9 / 10) << "most of what is drawn is a file to PCL";
}

TEST_F(PcdBesidePclTest, WhatItWritesIsReadAndTheOtherWayRound) {
  for (int i = 0; i < Rounds(400); ++i) {
    base::Rng rng = base::Rng(2).Fork(i);
    const PointCloud cloud = DrawCloud(&rng);
    for (const PclFormat format : {PclFormat::kText, PclFormat::kBinary, PclFormat::kCompressed}) {
      test_support::WriteByPcl(cloud, format, path_);
      ExpectSame(ReadPcd(path_), cloud, fmt::format("draw {}, format {}", i, int(format)));
    }
    WritePcd(cloud, path_);
    const std::optional<PointCloud> theirs = test_support::ReadByPcl(path_);
    ASSERT_TRUE(theirs.has_value());
    ExpectSame(*theirs, cloud, fmt::format("draw {}, ours", i));
    if (HasFailure()) return;
  }
}

}  // namespace
}  // namespace hires::perception::pcd_beside_pcl_test
